//! How constants lie in a `cbuffer`: Microsoft's "Packing rules for constant variables".
//!
//! - Registers have 16 bytes. A vector that would cross the end of one begins in the next.
//! - Arrays, structures and matrices begin in a new register, and so does each element of an array
//!   and each vector of a matrix.
//! - What follows them may begin in what the last element, member or vector leaves of its register.
//!
//! glslang cannot be asked: it lays blocks of HLSL out by the rules of std140, in which nothing
//! follows in the last register of a matrix.

use std::collections::BTreeMap;

use super::reading::{MOST_LEVELS, ReadMember, ReadType};
use super::text::{Statement, member_tokens, number_of};

const REGISTER: u32 = 16;

/// No `cbuffer` has so many. Numbers in a text may be anything.
const MOST_BYTES: u32 = u32::MAX / 2;
const TOO_LARGE: &str = "its types are too large";

/// The structures of a text: the members of each.
pub struct HlslStructs<'t>(BTreeMap<&'t str, Vec<HlslMember<'t>>>);

/// A declared member or variable.
#[derive(Debug)]
pub struct HlslMember<'t> {
    /// Its name.
    pub name: &'t str,
    ty: &'t str,
    is_row_major: bool,
    dimensions: Vec<u32>,
}

/// A type with its place.
struct Packed {
    ty: ReadType,
    size: u32,
    /// The bytes that it must not cross a register with; `None` where it begins a register.
    unit: Option<u32>,
}

impl<'t> HlslMember<'t> {
    /// Reads `row_major float3x3 name[2]`, and leaves out what stands behind a colon.
    pub fn read(tokens: &[&'t str]) -> Option<Self> {
        let end = tokens.iter().position(|token| *token == ":").unwrap_or(tokens.len());
        let is_modifier =
            |token: &&&str| !["row_major", "column_major", "precise"].contains(*token);
        let plain: Vec<&'t str> = tokens[..end].iter().filter(is_modifier).copied().collect();
        let [ty, name, rest @ ..] = plain.as_slice() else { return None };
        let dimensions =
            rest.split(|token| *token == "[").filter_map(|part| number_of(part.first()?));
        let is_row_major = tokens.contains(&"row_major");
        Some(Self { name, ty, is_row_major, dimensions: dimensions.collect() })
    }

    /// Whether naga put it there to move what follows.
    fn is_padding(&self) -> bool {
        let is_numbered = self.name.ends_with(|last: char| last.is_ascii_digit());
        self.ty == "int"
            && is_numbered
            && (self.name.starts_with("_pad") || self.name.starts_with("_end_pad_"))
    }
}

impl<'t> HlslStructs<'t> {
    /// The structures that some declarations have.
    pub fn of(statements: &[Statement<'t>]) -> Self {
        let one = |statement: &Statement<'t>| {
            let name = match statement.head.as_slice() {
                ["typedef", "struct"] => statement.instance?,
                _ => statement.block_name(&["struct"])?,
            };
            let members = member_tokens(statement.body.as_ref()?).filter_map(HlslMember::read);
            Some((name, members.collect()))
        };
        Self(statements.iter().filter_map(one).collect())
    }

    /// The layout of what a `cbuffer` holds.
    pub fn layout(&self, held: &HlslMember<'_>) -> Result<ReadType, String> {
        Ok(self.pack(held, &held.dimensions, MOST_LEVELS)?.ty)
    }

    fn pack(
        &self,
        member: &HlslMember<'_>,
        dimensions: &[u32],
        levels: usize,
    ) -> Result<Packed, String> {
        let levels = levels.checked_sub(1).ok_or("its types are nested too deep")?;
        if let [count, inner @ ..] = dimensions {
            let element = self.pack(member, inner, levels)?;
            let stride = element.size.next_multiple_of(REGISTER);
            let size = stride.saturating_mul(count.saturating_sub(1)).saturating_add(element.size);
            if size > MOST_BYTES {
                return Err(TOO_LARGE.to_owned());
            }
            let (element, stride) = (Box::new(element.ty), Some(stride));
            return Ok(Packed {
                ty: ReadType::Array { element, count: *count, stride },
                size,
                unit: None,
            });
        }
        match self.0.get(member.ty) {
            Some(members) => self.pack_struct(members, levels),
            None => pack_number(member),
        }
    }

    fn pack_struct(&self, members: &[HlslMember<'_>], levels: usize) -> Result<Packed, String> {
        let (mut placed, mut end) = (Vec::new(), 0u32);
        for member in members {
            let packed = self.pack(member, &member.dimensions, levels)?;
            let offset = match packed.unit {
                Some(unit) => {
                    let at = end.next_multiple_of(unit);
                    let crosses = at % REGISTER + packed.size > REGISTER;
                    if crosses { at.next_multiple_of(REGISTER) } else { at }
                }
                None => end.next_multiple_of(REGISTER),
            };
            end = offset.saturating_add(packed.size);
            if end > MOST_BYTES {
                return Err(TOO_LARGE.to_owned());
            }
            if !member.is_padding() {
                placed.push(ReadMember { offset: Some(offset), ty: packed.ty });
            }
        }
        // naga fills structures up to their size.
        let ty = ReadType::Struct { members: placed, size: Some(end) };
        Ok(Packed { ty, size: end, unit: None })
    }
}

/// `float`, `uint3` or `float4x3`.
fn pack_number(member: &HlslMember<'_>) -> Result<Packed, String> {
    let unknown = || format!("the type `{}` is not known", member.ty);
    let word = member.ty.trim_end_matches(|last: char| last.is_ascii_digit() || last == 'x');
    let (scalar, width) = match word {
        "float" => ("f32", 4),
        "int" => ("i32", 4),
        "uint" => ("u32", 4),
        "half" => ("f16", 2),
        _ => return Err(unknown()),
    };
    let scalar = scalar.to_owned();
    let sizes: Vec<u32> =
        member.ty[word.len()..].split('x').filter_map(|size| size.parse().ok()).collect();
    if !sizes.iter().all(|size| (1..=4).contains(size)) {
        return Err(unknown());
    }
    let packed = |rows, columns, size, unit| Packed {
        ty: ReadType::Number { scalar: scalar.clone(), width, rows, columns },
        size,
        unit,
    };
    match *sizes.as_slice() {
        [] => Ok(packed(None, None, width, Some(width))),
        [rows] => Ok(packed(Some(rows), None, width * rows, Some(width))),
        // What WGSL calls a column, HLSL calls a row here.
        [columns, rows] if member.is_row_major => {
            let size = (columns - 1) * REGISTER + width * rows;
            Ok(packed(Some(rows), Some((columns, Some(REGISTER))), size, None))
        }
        _ => Err(unknown()),
    }
}

#[cfg(test)]
mod tests {
    use super::super::text::read_statements;
    use super::*;

    fn offsets(members: &str) -> (Vec<Option<u32>>, u32) {
        let text = format!("struct In {{ float3 x; }};\nstruct S {{ {members} }};");
        let structs = HlslStructs::of(&read_statements(&text));
        let held = HlslMember::read(&["S", "s"]).unwrap();
        let layout = structs.layout(&held).unwrap();
        let places = layout.members().iter().map(|member| member.offset).collect();
        (places, layout.size().bytes())
    }

    /// Another compiler's layouts, of which the file has 300.
    #[test]
    fn layouts_of_slangc() {
        const NESTED: &str = "struct A { float3 x; };
            struct B { float a; float3 b; float c[2]; };
            struct C { row_major float3x3 m; float t; A n[2]; };";
        let lines = include_str!("hlsl_packing.txt").lines().filter(|line| !line.starts_with('#'));
        let mut wrong = Vec::new();
        for line in lines.clone() {
            let parts: Vec<&str> = line.split('|').map(str::trim).collect();
            let [members, offsets, size] = parts[..] else { panic!("{line}") };
            let text = format!("{NESTED} struct S {{ {members} }};");
            let structs = HlslStructs::of(&read_statements(&text));
            let layout = structs.layout(&HlslMember::read(&["S", "s"]).unwrap()).unwrap();
            let places: Vec<String> = layout
                .members()
                .iter()
                .map(|member| member.offset.unwrap_or_default().to_string())
                .collect();
            let found = (places.join(" "), layout.size().bytes().to_string());
            if found != (offsets.to_owned(), size.to_owned()) {
                wrong.push(format!("{line}: found {found:?}"));
            }
        }
        assert!(
            wrong.is_empty(),
            "{} wrong: {}",
            wrong.len(),
            wrong[..wrong.len().min(8)].join("\n")
        );
        assert_eq!(lines.count(), 300);
    }

    #[test]
    fn vectors_do_not_cross_registers() {
        assert_eq!(offsets("float3 a; float b;"), (vec![Some(0), Some(12)], 16));
        assert_eq!(offsets("float a; float3 b;"), (vec![Some(0), Some(4)], 16));
        assert_eq!(offsets("float2 a; float3 b;"), (vec![Some(0), Some(16)], 28));
        assert_eq!(offsets("float a; float4 b;"), (vec![Some(0), Some(16)], 32));
    }

    #[test]
    fn what_follows_may_share_the_last_register() {
        assert_eq!(offsets("float a[2]; float b;"), (vec![Some(0), Some(20)], 24));
        assert_eq!(offsets("row_major float3x3 a; float b;"), (vec![Some(0), Some(44)], 48));
        assert_eq!(offsets("float a; In b; float c;"), (vec![Some(0), Some(16), Some(28)], 32));
    }

    #[test]
    fn sizes_beyond_all_bounds() {
        for ty in
            ["float4294967295", "float0", "row_major float9x4", "float a[4000000000][9] ; int"]
        {
            let text = format!("struct S {{ {ty} x; float y; }};");
            let structs = HlslStructs::of(&read_statements(&text));
            assert!(structs.layout(&HlslMember::read(&["S", "s"]).unwrap()).is_err(), "{ty}");
        }
    }

    #[test]
    fn padding_is_no_member() {
        let padded = "row_major float3x3 a; int _pad1_0; float b; int _end_pad_0;";
        assert_eq!(offsets(padded), (vec![Some(0), Some(48)], 56));
        // An author's name that ends with a digit gets an underscore.
        assert_eq!(offsets("float a; int _pad1_;").0, [Some(0), Some(4)]);
    }
}
