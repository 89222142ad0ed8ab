//! Reads MSL: the entry point and its arguments by their words, and layouts by assertions, which
//! clang checks with the declarations of the text.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use lamplight_bundle::{Binding, BindingKind, BindingSlot, Member, Shape, Stage};

use super::compare::{Differences, SlotRules, compare_reading};
use super::described::Described;
use super::reading::{ReadBinding, Reading};
use super::text::{Statement, member_tokens, number_of, read_statements, without_functions};

const STAGES: [(&str, Stage); 3] =
    [("vertex", Stage::Vertex), ("fragment", Stage::Fragment), ("kernel", Stage::Compute)];

/// What differs between a text and what a bundle says of it, but for layouts.
pub fn msl_differences(text: &str, described: Described<'_>) -> Result<Vec<String>, String> {
    let statements = read_statements(text);
    let entry = MslEntry::of(&statements).ok_or("it has no entry point")?;
    let mut found = Differences::default();
    let sizes = described.native.buffer_sizes.as_ref().map(|sizes| sizes.index);
    // An author may give a type this name.
    let is_sizes =
        |one: &&MslArgument<'_>| one.ty.contains(&"_mslBufferSizes") && one.name == "_buffer_sizes";
    let read_sizes = entry.arguments.iter().find(is_sizes).map(|one| one.index);
    found.same("the buffer with the sizes of buffers is", &read_sizes, &sizes);
    let own = entry.arguments.iter().filter(|one| !is_sizes(one));
    let reading = Reading {
        entry: Some(entry.name.to_owned()),
        stage: Some(entry.stage),
        // The host chooses it.
        workgroup_size: described.reflection.workgroup_size,
        bindings: own.map(MslArgument::reading).collect(),
    };
    found.0.extend(compare_reading(&reading, described, &SlotRules { is_at, leaves_out: false }));
    Ok(found.0)
}

/// Slots have no table: it is that of the kind. Arrays of bindings are in argument buffers.
fn is_at(binding: &Binding, slot: &BindingSlot, found: &ReadBinding) -> bool {
    let table = match binding.kind {
        _ if binding.count.is_some() => "buffer",
        BindingKind::Uniform | BindingKind::Storage | BindingKind::Immediate => "buffer",
        BindingKind::Texture | BindingKind::StorageTexture => "texture",
        BindingKind::Sampler | BindingKind::ComparisonSampler => "sampler",
    };
    found.register.as_deref() == Some(table) && found.index == slot.index
}

/// The entry point of a text.
struct MslEntry<'t> {
    name: &'t str,
    stage: Stage,
    arguments: Vec<MslArgument<'t>>,
}

/// An argument that the host binds.
struct MslArgument<'t> {
    name: &'t str,
    /// The tokens of its type.
    ty: Vec<&'t str>,
    /// `buffer`, `texture` or `sampler`.
    table: &'t str,
    index: u32,
}

impl<'t> MslEntry<'t> {
    fn of(statements: &[Statement<'t>]) -> Option<Self> {
        statements.iter().find_map(|statement| {
            let (name, arguments) = statement.function()?;
            let stage = |token: &&str| STAGES.iter().find(|(word, _)| word == token);
            let (_, stage) = statement.head.iter().find_map(stage)?;
            let arguments = split_arguments(arguments).into_iter();
            Some(Self {
                name,
                stage: *stage,
                arguments: arguments.filter_map(MslArgument::of).collect(),
            })
        })
    }
}

/// The tokens of each argument, split where no bracket is open.
fn split_arguments<'a, 't>(tokens: &'a [&'t str]) -> Vec<&'a [&'t str]> {
    let mut depth = 0i32;
    let parts = tokens.split(|token| {
        match *token {
            "(" | "[" | "<" => depth += 1,
            ")" | "]" | ">" => depth -= 1,
            _ => {}
        }
        *token == "," && depth == 0
    });
    parts.collect()
}

impl<'t> MslArgument<'t> {
    fn of(tokens: &[&'t str]) -> Option<Self> {
        let at = tokens.windows(2).position(|pair| pair == ["[", "["])?;
        let [_, _, table, "(", index, ")", ..] = tokens.get(at..)? else { return None };
        let is_bound = ["buffer", "texture", "sampler"].contains(table);
        let (name, ty) = tokens[..at].split_last()?;
        is_bound.then_some(Self { name, ty: ty.to_vec(), table, index: number_of(index)? })
    }

    fn reading(&self) -> ReadBinding {
        let has = |word: &str| self.ty.contains(&word);
        let kind = match self.table {
            // A pointer leads to an argument buffer.
            "buffer" if has("*") => None,
            "buffer" if has("constant") => Some(BindingKind::Uniform),
            "buffer" => Some(BindingKind::Storage),
            "sampler" => Some(BindingKind::Sampler),
            // `access::read` stands for both kinds.
            _ if has("sample") => Some(BindingKind::Texture),
            _ if has("write") || has("read_write") => Some(BindingKind::StorageTexture),
            _ => None,
        };
        ReadBinding {
            index: Some(self.index),
            register: Some(self.table.to_owned()),
            kind,
            dimension: self.ty.iter().find_map(|token| dimension(token)),
            ..ReadBinding::default()
        }
    }

    /// The type behind the reference of a buffer, as it is written.
    fn pointee(&self) -> Option<String> {
        let is_reference = self.ty.contains(&"&") && !self.ty.contains(&"*");
        let spaces = ["constant", "device", "const", "&", "volatile", "coherent"];
        let plain = self.ty.iter().filter(|token| !spaces.contains(*token)).copied();
        is_reference.then(|| plain.collect())
    }
}

/// `texturecube_array` -> `cube_array`
fn dimension(token: &str) -> Option<String> {
    let rest = token.strip_prefix("texture").or_else(|| token.strip_prefix("depth"))?;
    let known =
        ["1d", "1d_array", "2d", "2d_array", "2d_ms", "2d_ms_array", "3d", "cube", "cube_array"];
    known.contains(&rest).then(|| rest.replace("_ms", ""))
}

/// The declarations of a text, followed by an assertion for each offset, stride and size of the
/// reflection.
pub fn asserted_declarations(text: &str, described: Described<'_>) -> Result<String, String> {
    let statements = read_statements(text);
    let entry = MslEntry::of(&statements).ok_or("it has no entry point")?;
    let (structs, arrays) = (read_structs(&statements), read_arrays(&statements));
    let mut assertions = MslAssertions { structs, arrays, text: String::new() };
    for binding in &described.reflection.bindings {
        let Some(slot) = described.slot(binding) else { continue };
        let argument = entry.arguments.iter().find(|one| is_at(binding, slot, &one.reading()));
        if let (Some(size), Some(ty)) = (binding.size, argument.and_then(MslArgument::pointee)) {
            assertions.add_buffer(binding, size, &ty)?;
        }
    }
    Ok(without_functions(text) + "\n" + &assertions.text)
}

/// Scalar type, rows and columns of a type: `metal::float4x3` has 4 columns of 3 rows.
fn declared_number(ty: &str) -> Option<(&'static str, Option<u32>, Option<u32>)> {
    let plain = ty.strip_prefix("metal::").unwrap_or(ty);
    let plain =
        plain.strip_prefix("packed_").or_else(|| plain.strip_prefix("atomic_")).unwrap_or(plain);
    let word = plain.trim_end_matches(|last: char| last.is_ascii_digit() || last == 'x');
    let scalar = match word {
        "float" => "f32",
        "half" => "f16",
        "int" => "i32",
        "uint" => "u32",
        _ => return None,
    };
    let mut sizes = plain[word.len()..].split('x').filter_map(number_of);
    match (sizes.next(), sizes.next()) {
        (Some(columns), Some(rows)) => Some((scalar, Some(rows), Some(columns))),
        (rows, _) => Some((scalar, rows, None)),
    }
}

/// The type and the name of each member, by structure.
type MslStructs<'t> = BTreeMap<&'t str, Vec<(String, &'t str)>>;

fn read_structs<'t>(statements: &[Statement<'t>]) -> MslStructs<'t> {
    let one = |statement: &Statement<'t>| {
        let name = statement.block_name(&["struct"])?;
        let members = member_tokens(statement.body.as_ref()?).filter_map(|tokens| {
            let end = tokens.iter().position(|token| *token == "[").unwrap_or(tokens.len());
            let (name, ty) = tokens[..end].split_last()?;
            Some((ty.concat(), *name))
        });
        Some((name, members.collect()))
    };
    statements.iter().filter_map(one).collect()
}

/// The type of the elements of each array without a length: `typedef metal::float4 name[1]`.
fn read_arrays<'t>(statements: &[Statement<'t>]) -> BTreeMap<&'t str, String> {
    let one = |statement: &Statement<'t>| {
        let [typedef, element @ .., name, "[", "1", "]"] = statement.head.as_slice() else {
            return None;
        };
        (*typedef == "typedef").then(|| (*name, element.concat()))
    };
    statements.iter().filter_map(one).collect()
}

/// Assertions about the types of a text.
struct MslAssertions<'t> {
    structs: MslStructs<'t>,
    arrays: BTreeMap<&'t str, String>,
    text: String,
}

impl MslAssertions<'_> {
    fn add_buffer(&mut self, binding: &Binding, size: u32, ty: &str) -> Result<(), String> {
        let (place, what) = (format!("(*({ty}*)0)"), format!("`{}`", binding.name));
        self.expect(&format!("sizeof({place})"), size, &format!("the size of {what}"));
        let is_array = binding.shape.as_ref().is_some_and(|shape| shape.count.is_some());
        let (ty, place) =
            if is_array { self.element(ty, &place) } else { (Some(ty.to_owned()), place) };
        self.add_members(ty.as_deref(), &place, &what, &binding.members)
    }

    /// The type of an array's elements, if it is known, and an expression for one of them. Arrays
    /// with a length are wrapped in structures.
    fn element(&self, ty: &str, place: &str) -> (Option<String>, String) {
        match self.structs.get(ty).map(Vec::as_slice) {
            Some([(element, inner)]) => (Some(element.clone()), format!("{place}.{inner}[0]")),
            _ => (self.arrays.get(ty).cloned(), format!("{place}[0]")),
        }
    }

    fn add_members(
        &mut self,
        ty: Option<&str>,
        place: &str,
        what: &str,
        members: &[Member],
    ) -> Result<(), String> {
        if members.is_empty() {
            return Ok(());
        }
        let declared = ty.and_then(|ty| self.structs.get(ty));
        let declared = declared.ok_or_else(|| format!("the type of {what} is no structure"))?;
        let is_padding = |(ty, name): &&(String, &str)| ty == "char" && name.starts_with("_pad");
        let own: Vec<(String, String)> = declared
            .iter()
            .filter(|one| !is_padding(one))
            .map(|(ty, name)| (ty.clone(), (*name).to_owned()))
            .collect();
        if own.len() != members.len() {
            return Err(format!(
                "{what} has {} members, {} in the reflection",
                own.len(),
                members.len()
            ));
        }
        for ((ty, name), member) in own.iter().zip(members) {
            self.add_member(ty, place, name, what, member)?;
        }
        Ok(())
    }

    fn add_member(
        &mut self,
        ty: &str,
        outer: &str,
        declared: &str,
        what: &str,
        member: &Member,
    ) -> Result<(), String> {
        let Member { name, ty: _, offset, size, stride, shape, members } = member;
        let what = format!("`{name}` of {what}");
        let place = format!("{outer}.{declared}");
        let offset_of = format!("__builtin_offsetof(__typeof__({outer}), {declared})");
        self.expect(&offset_of, *offset, &format!("the offset of {what}"));
        // Where the fourth component's room is free, Metal's vectors of three take it.
        let is_three = |shape: &Shape| {
            shape.rows == Some(3) && shape.columns.is_none() && shape.count.is_none()
        };
        if !shape.as_ref().is_some_and(is_three) {
            self.expect(&format!("sizeof({place})"), *size, &format!("the size of {what}"));
        }
        let count = shape.as_ref().and_then(|shape| shape.count);
        let (ty, place) = match stride {
            Some(stride) => {
                let (ty, element) = self.element(ty, &place);
                let ratio = format!("sizeof({place}) / sizeof({element})");
                // An array without a length is declared with one element.
                let count = count.map_or(1, |count| count.max(1));
                self.expect(&ratio, count, &format!("the number of elements of {what}"));
                let place = element;
                self.expect(&format!("sizeof({place})"), *stride, &format!("the stride of {what}"));
                (ty, place)
            }
            None => (Some(ty.to_owned()), place),
        };
        if let Some(shape) = shape {
            self.add_shape(shape, ty.as_deref(), &place, &what)?;
        }
        self.add_members(ty.as_deref(), &place, &what, members)
    }

    /// Compares a number, or the numbers that are elements of an array. `ty` is as it is declared.
    fn add_shape(
        &mut self,
        shape: &Shape,
        ty: Option<&str>,
        place: &str,
        what: &str,
    ) -> Result<(), String> {
        let Shape { scalar, rows, columns, matrix_stride, count: _ } = shape;
        // Arrays of structures and of arrays have no numbers of their own.
        let Some(scalar) = scalar else { return Ok(()) };
        let found = ty.and_then(declared_number);
        let reflected = (scalar.as_str(), *rows, *columns);
        if found != Some(reflected) {
            return Err(format!("{what} is {ty:?} in the output, {reflected:?} in the reflection"));
        }
        if let Some(stride) = matrix_stride {
            let column = format!("sizeof({place}[0])");
            self.expect(&column, *stride, &format!("the matrix stride of {what}"));
        }
        Ok(())
    }

    fn expect(&mut self, value: &str, expected: u32, what: &str) {
        let _ = writeln!(
            self.text,
            "static_assert({value} == {expected}, \"{what} is {expected} in the reflection\");"
        );
    }
}
