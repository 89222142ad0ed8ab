//! What a bundle says of a program, in the form in which every language writes it.

use std::collections::{BTreeMap, BTreeSet};

use lamplight_bundle::{BindingKind, Bundle, Error, Language, LayoutBinding, Member, Stage};

/// One program.
#[derive(Debug)]
pub struct ProgramModel {
    pub name: String,
    pub bindings: Vec<LayoutBinding>,
    /// Structures of blocks and of what is in them, each after those that it uses.
    pub structs: Vec<StructModel>,
    /// For each binding that is a block, the index of its structure.
    pub blocks: BTreeMap<usize, usize>,
    /// Locations and names of the inputs of vertex stages.
    pub inputs: BTreeMap<u32, String>,
}

/// A structure.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StructModel {
    pub name: String,
    pub size: u32,
    pub fields: Vec<FieldModel>,
}

/// A member, or padding, whose name is then empty.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FieldModel {
    pub name: String,
    pub offset: u32,
    pub size: u32,
    pub kind: FieldKind,
}

/// What a member is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum FieldKind {
    /// Numbers of a scalar type: how many arrays of how many, from the outside. The innermost ones
    /// count the padding of a column or an element.
    Numbers { scalar: String, lengths: Vec<u32> },
    /// Structures: the index of the type, and how many there are in an array.
    Struct { index: usize, count: Option<u32> },
    /// What has no form of its own, and padding.
    Bytes,
}

impl ProgramModel {
    pub fn of(bundle: &Bundle, name: &str, source: Option<Language>) -> Result<Self, Error> {
        let program = bundle.program(name)?;
        let languages: BTreeSet<Language> = program.entries().map(|(found, _)| found).collect();
        let wesl = languages.contains(&Language::Wesl).then_some(Language::Wesl);
        let language = source.or(wesl).unwrap_or(Language::Glsl);
        if source.is_some() && !languages.contains(&language) {
            let known = languages.iter().map(|known| known.name().to_owned()).collect();
            let name = language.name().to_owned();
            return Err(Error::NotFound { what: "source language", name, known });
        }
        let mut model = Self {
            name: name.to_owned(),
            bindings: program.layout(language).to_vec(),
            structs: Vec::new(),
            blocks: BTreeMap::new(),
            inputs: BTreeMap::new(),
        };
        for (index, found) in model.bindings.clone().iter().enumerate() {
            let binding = &found.binding;
            let is_block = matches!(binding.kind, BindingKind::Uniform | BindingKind::Immediate)
                && !binding.members.is_empty();
            if let (true, Some(size)) = (is_block, binding.size) {
                let block = model.structure(&binding.name, size, &binding.members);
                model.blocks.insert(index, block);
            }
        }
        for (_, entry) in program.entries().filter(|(found, _)| *found == language) {
            let shader = program.entry(language, entry)?;
            let mut seen = BTreeSet::new();
            for key in shader.keys()? {
                if seen.insert(shader.find(&key)?) {
                    model.add_inputs(&*shader.reflection(&key)?);
                }
            }
        }
        Ok(model)
    }

    fn add_inputs(&mut self, reflection: &lamplight_bundle::Reflection) {
        if reflection.stage != Stage::Vertex {
            return;
        }
        for input in &reflection.inputs {
            if let (Some(location), Some(name)) = (input.location, &input.name) {
                self.inputs.entry(location).or_insert_with(|| name.clone());
            }
        }
    }

    /// The index of a structure with these members. Equal ones are one.
    fn structure(&mut self, name: &str, size: u32, members: &[Member]) -> usize {
        let mut fields = Vec::new();
        let mut end = 0;
        for member in members {
            let Some(kind) = self.kind_of(member) else { continue };
            pad_fields(&mut fields, end, member.offset);
            end = member.offset.saturating_add(member.size);
            let (offset, size) = (member.offset, member.size);
            fields.push(FieldModel { name: member.name.clone(), offset, size, kind });
        }
        pad_fields(&mut fields, end, size);
        let found = StructModel { name: name.to_owned(), size, fields };
        if let Some(index) = self.structs.iter().position(|known| *known == found) {
            return index;
        }
        self.structs.push(found);
        self.structs.len() - 1
    }

    /// What a member is. `None` for an array whose length the buffer decides.
    fn kind_of(&mut self, member: &Member) -> Option<FieldKind> {
        let shape = member.shape.clone().unwrap_or_default();
        if shape.count == Some(0) || member.size == 0 {
            return None;
        }
        if !member.members.is_empty() {
            let size = member.stride.unwrap_or(member.size);
            let index = self.structure(&element_name(&member.ty), size, &member.members);
            return Some(FieldKind::Struct { index, count: shape.count });
        }
        let Some(scalar) = shape.scalar else { return Some(FieldKind::Bytes) };
        let Some(width) = scalar_bytes(&scalar) else { return Some(FieldKind::Bytes) };
        // What one column, vector or number takes, with the padding after it.
        let inner = shape.matrix_stride.or(member.stride).unwrap_or(member.size) / width;
        let is_scalar = shape.rows.is_none() && member.stride.is_none();
        let lengths = [shape.count, shape.columns, Some(inner).filter(|_| !is_scalar)];
        Some(FieldKind::Numbers { scalar, lengths: lengths.into_iter().flatten().collect() })
    }
}

fn pad_fields(fields: &mut Vec<FieldModel>, end: u32, next: u32) {
    if next > end {
        let (offset, size, kind) = (end, next - end, FieldKind::Bytes);
        fields.push(FieldModel { name: String::new(), offset, size, kind });
    }
}

/// Bytes of a scalar type; `None` for one that no language has.
pub fn scalar_bytes(scalar: &str) -> Option<u32> {
    match scalar {
        "f32" | "i32" | "u32" => Some(4),
        "f16" | "u16" | "i16" => Some(2),
        "f64" | "u64" | "i64" => Some(8),
        _ => None,
    }
}

/// The name of a structure, or of the elements of an array: `Lamp` for `array<Lamp, 4>`.
fn element_name(ty: &str) -> String {
    let inner = ty.rsplit('<').next().unwrap_or(ty);
    inner.split([',', '>']).next().unwrap_or(inner).trim().to_owned()
}

/// A name of the author as an identifier.
pub fn identifier(name: &str) -> String {
    let letter = |letter: char| if letter.is_ascii_alphanumeric() { letter } else { '_' };
    let found: String = name.chars().map(letter).collect();
    match found.starts_with(|first: char| first.is_ascii_digit()) || found.is_empty() {
        true => format!("n{found}"),
        false => found,
    }
}
