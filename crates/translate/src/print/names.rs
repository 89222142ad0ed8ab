//! The names of all that is global in GLSL: ASCII, no words of the language, each with one meaning.
//!
//! A name stays as its author wrote it where that is possible. A name that changes, or that is made
//! here, is none that anything else has.

use std::collections::{BTreeMap, BTreeSet};

use super::dialect::Dialect;
use super::words::{macro_name, scalar_name, texture_name, vector_name};
use crate::tree::{Count, Item, ItemPath, Module, Scalar, Type};
use crate::wesl::untranslated;
use lamplight_diagnostic::Diagnostic;
use lamplight_diagnostic::source::Span;

/// The names of the items of all modules, and of their members.
#[derive(Debug)]
pub struct Names {
    pub dialect: Dialect,
    items: BTreeMap<ItemPath, String>,
    members: BTreeMap<(ItemPath, String), String>,
    zeros: BTreeMap<ItemPath, String>,
    makers: BTreeMap<ItemPath, String>,
    /// Structures of what stages take and return: they have no declaration in GLSL.
    stages: BTreeSet<ItemPath>,
    /// The names that something has.
    taken: BTreeSet<String>,
}

impl Names {
    /// Names all items. `macros` are names that the preprocessor replaces.
    pub fn of<'a>(
        modules: &[Module],
        macros: impl Iterator<Item = &'a String>,
        dialect: Dialect,
    ) -> Self {
        let mut names = Self {
            dialect,
            items: BTreeMap::new(),
            members: BTreeMap::new(),
            zeros: BTreeMap::new(),
            makers: BTreeMap::new(),
            stages: BTreeSet::new(),
            taken: macros.cloned().collect(),
        };
        let items = || {
            modules
                .iter()
                .flat_map(|module| module.items.iter().map(move |node| (module, &node.body)))
        };
        names.taken.extend(items().map(|(_, item)| item.name().to_owned()));
        for (module, item) in items() {
            let path = ItemPath { module: module.path.clone(), name: item.name().to_owned() };
            if !names.items.contains_key(&path) {
                let name = changed_name(&path.name, |word| dialect.is_reserved(word));
                let name = name.map_or_else(|| path.name.clone(), |name| names.claimed(&name));
                names.items.insert(path.clone(), name);
            }
            if let Item::Structure(structure) = item {
                let members = structure.members.iter().map(|node| node.body.name.as_str());
                if structure.members.iter().any(|node| node.body.binding.is_some()) {
                    names.stages.insert(path.clone());
                }
                names.name_members(&path, members);
                if !names.zeros.contains_key(&path) {
                    let zero = names.claimed(&snake_name("zero", &names.items[&path]));
                    names.zeros.insert(path.clone(), zero);
                    if dialect == Dialect::Hlsl {
                        let maker = names.claimed(&snake_name("make", &names.items[&path]));
                        names.makers.insert(path, maker);
                    }
                }
            }
        }
        names
    }

    fn name_members<'a>(
        &mut self,
        path: &ItemPath,
        members: impl Iterator<Item = &'a str> + Clone,
    ) {
        let mut taken: BTreeSet<String> = members.clone().map(str::to_owned).collect();
        let dialect = self.dialect;
        for member in members {
            let key = (path.clone(), member.to_owned());
            let name = match changed_name(member, |word| dialect.is_hidden(word)) {
                Some(name) => free_name(&name, &taken),
                None => member.to_owned(),
            };
            taken.insert(name.clone());
            self.members.entry(key).or_insert(name);
        }
    }

    fn claimed(&mut self, wanted: &str) -> String {
        let name = free_name(wanted, &self.taken);
        self.taken.insert(name.clone());
        name
    }

    /// The name of an item, which is one of the modules.
    pub fn item(&self, path: &ItemPath) -> &str {
        self.items.get(path).map_or("", String::as_str)
    }

    /// The name of a member of a structure.
    pub fn member<'a>(&'a self, path: &ItemPath, member: &'a str) -> &'a str {
        let key = (path.clone(), member.to_owned());
        self.members.get(&key).map_or(member, String::as_str)
    }

    /// The name of the function that makes a structure of zeros.
    pub fn zero(&self, path: &ItemPath) -> &str {
        self.zeros.get(path).map_or("", String::as_str)
    }

    /// The name of the function that makes a structure of its members, in HLSL.
    pub fn maker(&self, path: &ItemPath) -> &str {
        self.makers.get(path).map_or("", String::as_str)
    }

    pub fn zeros(&self) -> impl Iterator<Item = &String> {
        self.zeros.values()
    }

    /// A name for something that has none in WGSL.
    pub fn invented(&self, wanted: &str) -> String {
        let wanted = changed_name(wanted, |word| self.dialect.is_reserved(word))
            .unwrap_or_else(|| wanted.to_owned());
        free_name(&wanted, &self.taken)
    }

    /// A type and the lengths that stand behind the declared name, such as `vec3` and `[9]`.
    pub fn declared_type(&self, ty: &Type, span: Span) -> Result<(String, String), Diagnostic> {
        match ty {
            Type::Array(..) if self.dialect == Dialect::Msl => {
                Ok((self.type_name(ty, span)?, String::new()))
            }
            Type::Array(element, count) => {
                let (name, inner) = self.declared_type(element, span)?;
                Ok((name, format!("[{}]{inner}", self.count(count, span)?)))
            }
            other => Ok((self.type_name(other, span)?, String::new())),
        }
    }

    /// A type as one word, such as `vec3[9]`.
    pub fn type_name(&self, ty: &Type, span: Span) -> Result<String, Diagnostic> {
        Ok(match ty {
            Type::Nothing => "void".to_owned(),
            Type::Scalar(scalar) => scalar_name(*scalar, span)?.to_owned(),
            Type::Vector(size, scalar) => vector_name(self.dialect, *size, *scalar, span)?,
            Type::Matrix { scalar, .. } if *scalar != Scalar::F32 => {
                return Err(untranslated(span, "a matrix of abstract numbers"));
            }
            // The rows of HLSL are the columns of WGSL.
            Type::Matrix { columns, rows, scalar: _ } if self.dialect != Dialect::Glsl => {
                format!("float{columns}x{rows}")
            }
            Type::Matrix { columns, rows, scalar: _ } if columns == rows => format!("mat{columns}"),
            Type::Matrix { columns, rows, scalar: _ } => format!("mat{columns}x{rows}"),
            Type::Array(element, count) if self.dialect == Dialect::Msl => {
                let element = self.type_name(element, span)?;
                format!("array<{element}, {}>", self.count(count, span)?)
            }
            Type::Array(..) => {
                let (name, lengths) = self.declared_type(ty, span)?;
                format!("{name}{lengths}")
            }
            Type::Structure(path) if self.stages.contains(path) => {
                return Err(untranslated(span, "a value of what a stage takes or returns"));
            }
            Type::Structure(path) => self.item(path).to_owned(),
            Type::Pointer(_, target) => self.type_name(target, span)?,
            Type::Texture(texture) => texture_name(self.dialect, texture, "texture", span)?,
            Type::Sampler { compares } => match (self.dialect, compares) {
                (Dialect::Glsl, true) => "samplerShadow".to_owned(),
                (Dialect::Glsl, false) | (Dialect::Msl, _) => "sampler".to_owned(),
                (Dialect::Hlsl, true) => "SamplerComparisonState".to_owned(),
                (Dialect::Hlsl, false) => "SamplerState".to_owned(),
            },
            Type::Atomic(_) => return Err(untranslated(span, "an atomic type")),
            other => return Err(untranslated(span, format!("the type {other}"))),
        })
    }

    /// The name of an array's type, for a function that returns one: `float3_9`.
    pub fn returned_type(&self, ty: &Type, span: Span) -> Result<String, Diagnostic> {
        match (self.dialect, ty) {
            (Dialect::Hlsl, Type::Array(element, count)) => {
                let element = self.returned_type(element, span)?;
                Ok(format!("{element}_{}", self.count(count, span)?))
            }
            _ => self.type_name(ty, span),
        }
    }

    fn count(&self, count: &Count, span: Span) -> Result<String, Diagnostic> {
        Ok(match count {
            Count::Fixed(count) => count.to_string(),
            Count::Axis(name) => macro_name(name),
            Count::Constant(path) => self.item(path).to_owned(),
            Count::Named(name) => return Err(untranslated(span, format!("the length `{name}`"))),
            Count::Runtime => String::new(),
        })
    }
}

/// What GLSL needs instead of a name; nothing where it can stay.
pub fn changed_name(name: &str, is_word: impl Fn(&str) -> bool) -> Option<String> {
    let is_macro = name.starts_with("GL_") || name.starts_with("LAMPLIGHT_");
    if name.is_ascii() && !is_word(name) && !is_macro {
        return None;
    }
    let mut text = String::new();
    for letter in name.trim_start_matches("gl_").chars() {
        match letter.is_ascii() {
            true => text.push(letter),
            false => text += &format!("u{:04x}", u32::from(letter)),
        }
    }
    let text = if is_macro { text.to_lowercase() } else { text };
    let words: Vec<&str> = text.split('_').filter(|word| !word.is_empty()).collect();
    Some(format!("{}_", words.join("_")))
}

/// A name, or the first like it that is not taken.
pub fn free_name(wanted: &str, taken: &BTreeSet<String>) -> String {
    let stem = wanted.trim_end_matches('_');
    let others = (2_u32..).map(|number| format!("{stem}_{number}"));
    let mut names = std::iter::once(wanted.to_owned()).chain(others);
    names.find(|name| !taken.contains(name)).unwrap_or_default()
}

/// `zero_complex_ior` for `ComplexIor`.
fn snake_name(first: &str, structure: &str) -> String {
    let mut name = first.to_owned();
    for letter in structure.chars() {
        if letter.is_uppercase() && !name.ends_with('_') || name == first {
            name.push('_');
        }
        name.extend(letter.to_lowercase());
    }
    name
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reserved_words_are_renamed() {
        let changed = |name: &str| changed_name(name, |word| Dialect::Glsl.is_reserved(word));
        assert_eq!(changed("sample").as_deref(), Some("sample_"));
        assert_eq!(changed("gl_Position").as_deref(), Some("Position_"));
        assert_eq!(changed("a__b").as_deref(), Some("a_b_"));
        assert_eq!(changed("Δ").as_deref(), Some("u0394_"));
        assert_eq!(changed("roughness"), None);
    }

    #[test]
    fn names_are_not_taken_twice() {
        let taken = ["sample_", "sample_2"].map(str::to_owned).into();
        assert_eq!(free_name("sample_", &taken), "sample_3");
    }
}
