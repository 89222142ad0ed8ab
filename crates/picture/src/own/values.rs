//! What an author gives: numbers and colours by the names of uniforms.

use std::collections::{BTreeMap, BTreeSet};

use lamplight_diagnostic::source::Span;
use lamplight_diagnostic::{Diagnostic, Diagnostics};
use lamplight_scenes::linear_from_srgb;

use super::shape::{NumberType, short_type};
use super::table::Origin;
use super::{at_given, refused};

/// A value as somebody wrote it.
#[derive(Debug, Clone, PartialEq)]
pub struct GivenValue {
    /// A uniform's name, or `block.member`.
    pub name: String,
    pub value: UniformValue,
    pub origin: Origin,
    /// Its place in a file.
    pub span: Option<Span>,
}

/// The value of a uniform.
#[derive(Debug, Clone, PartialEq)]
pub enum UniformValue {
    Numbers(Vec<f64>),
    /// Three or four numbers from 0 to 1, as they are encoded for a display.
    Color(Vec<f64>),
}

/// Reads `1,2,3`, `true`, `#f80`, `#ff8800` or `#ff8800c0`.
///
/// # Errors
/// In words.
pub fn parse_value(text: &str) -> Result<UniformValue, String> {
    let text = text.trim();
    if let Some(digits) = text.strip_prefix('#') {
        return hex_color(digits).map(UniformValue::Color);
    }
    let number = |part: &str| match part.trim() {
        "true" => Some(1.0),
        "false" => Some(0.0),
        part => part.parse::<f64>().ok().filter(|number| number.is_finite()),
    };
    let numbers: Option<Vec<f64>> = text.split(',').map(number).collect();
    let wrong =
        || format!("`{text}` is no number, no list such as `1,2,3`, no colour such as `#ff8800`");
    numbers.map(UniformValue::Numbers).ok_or_else(wrong)
}

fn hex_color(digits: &str) -> Result<Vec<f64>, String> {
    let wrong = || format!("`#{digits}` is no colour: `#` has 3, 4, 6 or 8 digits after it");
    let values: Option<Vec<u32>> = digits.chars().map(|digit| digit.to_digit(16)).collect();
    let values = values.ok_or_else(wrong)?;
    let parts: Vec<u32> = match values.len() {
        3 | 4 => values.iter().map(|value| value * 17).collect(),
        6 | 8 => values.chunks(2).map(|pair| pair[0] * 16 + pair[1]).collect(),
        _ => return Err(wrong()),
    };
    Ok(parts.into_iter().map(|part| f64::from(part) / 255.0).collect())
}

impl UniformValue {
    /// The numbers for a shader that counts in linear light, or in what a display shows; and for a
    /// colour alpha, if the type has it.
    fn numbers(&self, ty: NumberType, linear: bool) -> Vec<f64> {
        match self {
            Self::Numbers(numbers) => numbers.clone(),
            Self::Color(parts) => {
                let decoded = |part: f64| if linear { linear_from_srgb(part) } else { part };
                let mut numbers: Vec<f64> = parts[..3].iter().map(|part| decoded(*part)).collect();
                numbers.extend(parts.get(3));
                if ty.rows == 4 && numbers.len() == 3 {
                    numbers.push(1.0);
                }
                numbers
            }
        }
    }
}

/// A uniform that can be given a value.
#[derive(Debug, Clone, PartialEq)]
pub struct Leaf {
    /// As the author writes it, such as `light.position` or `weights[2]`.
    pub path: String,
    /// Type in WGSL.
    pub ty: String,
}

/// The numbers of uniforms by their paths, with where they come from.
pub type Chosen = BTreeMap<String, (Vec<f64>, Origin)>;

/// Gives values to uniforms. A name is a whole path, or the end of one that no other has.
///
/// # Errors
/// A name that no uniform has, or that several have; the wrong number of numbers; a name that is
/// given twice.
pub fn assign_values(
    leaves: &[Leaf],
    given: &[GivenValue],
    linear: bool,
) -> Result<Chosen, Diagnostics> {
    // Stages of GLSL have blocks of their own, with uniforms of the same names.
    let mut known = BTreeSet::new();
    let leaves: Vec<&Leaf> = leaves.iter().filter(|leaf| known.insert(&leaf.path)).collect();
    let (mut chosen, mut errors) = (Chosen::new(), Diagnostics::new());
    let files = given.iter().filter(|value| value.origin == Origin::File);
    let options = given.iter().filter(|value| value.origin != Origin::File);
    for value in files.chain(options) {
        match assign_one(&leaves, value, linear) {
            Ok(found) => chosen.extend(found),
            Err(error) => errors.push(at_given(error, value.span)),
        }
    }
    if errors.is_empty() { Ok(chosen) } else { Err(errors) }
}

fn assign_one(leaves: &[&Leaf], given: &GivenValue, linear: bool) -> Result<Chosen, Diagnostic> {
    let found = find_leaves(leaves, &given.name)?;
    let types: Vec<NumberType> = found.iter().map(|leaf| NumberType::of(&leaf.ty)).collect();
    let total: usize = types.iter().map(|ty| ty.count()).sum();
    let numbers = given.value.numbers(types[0], linear);
    if numbers.len() != total {
        let (name, ty) = (&found[0].path, short_type(&found[0].ty));
        let what = match found.len() {
            1 => format!("`{name}: {ty}`"),
            count => format!("`{}`, {count} elements of {ty},", given.name),
        };
        let message = format!(
            "{what} takes {}, and {} given",
            counted(total),
            match numbers.len() {
                1 => "1 is".to_owned(),
                count => format!("{count} are"),
            }
        );
        return Err(refused(&message));
    }
    let mut rest = numbers.as_slice();
    let parts = found.iter().zip(types).map(|(leaf, ty)| {
        let (own, others) = rest.split_at(ty.count());
        rest = others;
        (leaf.path.clone(), (own.to_vec(), given.origin))
    });
    Ok(parts.collect())
}

fn counted(count: usize) -> String {
    if count == 1 { "1 number".to_owned() } else { format!("{count} numbers") }
}

/// The uniforms of a name: one, or the elements of an array.
fn find_leaves<'l>(leaves: &[&'l Leaf], name: &str) -> Result<Vec<&'l Leaf>, Diagnostic> {
    let array = format!("{name}[");
    let is_it = |path: &str| path == name || path.starts_with(&array) && path.ends_with(']');
    let whole: Vec<&Leaf> = leaves.iter().copied().filter(|leaf| is_it(&leaf.path)).collect();
    if !whole.is_empty() {
        return Ok(whole);
    }
    // The member of the only block that has one of this name.
    let bases = leaves.iter().copied().filter_map(|leaf| {
        let at = leaf.path.rfind(&format!(".{name}"))?;
        let rest = &leaf.path[at + 1 + name.len()..];
        (rest.is_empty() || rest.starts_with('[') && !rest.contains('.'))
            .then(|| (leaf.path[..at].to_owned(), leaf))
    });
    let bases: Vec<(String, &Leaf)> = bases.collect();
    let mut blocks: Vec<&str> = bases.iter().map(|(block, _)| block.as_str()).collect();
    blocks.dedup();
    match blocks.as_slice() {
        [_] => Ok(bases.into_iter().map(|(_, leaf)| leaf).collect()),
        [] => Err(unknown_uniform(leaves, name)),
        several => {
            let names: Vec<String> =
                several.iter().map(|block| format!("`{block}.{name}`")).collect();
            Err(refused(&format!("`{name}` is one of several: {}", names.join(", "))))
        }
    }
}

fn unknown_uniform(leaves: &[&Leaf], name: &str) -> Diagnostic {
    let known: Vec<&str> = leaves.iter().map(|leaf| leaf.path.as_str()).collect();
    let ends: Vec<&str> = known.iter().filter_map(|path| path.rsplit('.').next()).collect();
    let error = refused(&format!("no stage reads a uniform `{name}`"));
    let error = error.suggest(name, known.iter().copied().chain(ends));
    match known.is_empty() {
        true => error.note("help: there are no uniforms"),
        false => error.note(format!("uniforms: {}", known.join(", "))),
    }
}

#[cfg(test)]
mod tests {
    use super::{Chosen, GivenValue, Leaf, UniformValue, assign_values, parse_value};
    use crate::own::table::Origin;

    fn leaves() -> Vec<Leaf> {
        let leaf = |path: &str, ty: &str| Leaf { path: path.to_owned(), ty: ty.to_owned() };
        vec![
            leaf("light.position", "vec3<f32>"),
            leaf("light.power", "f32"),
            leaf("camera.position", "vec3<f32>"),
            leaf("tint", "vec4<f32>"),
            leaf("weights[0]", "f32"),
            leaf("weights[1]", "f32"),
        ]
    }

    fn assigned(name: &str, text: &str) -> Result<Chosen, String> {
        let value = parse_value(text)?;
        let given = GivenValue { name: name.to_owned(), value, origin: Origin::Option, span: None };
        assign_values(&leaves(), &[given], true)
            .map_err(|errors| errors.iter().map(|error| error.message.clone()).collect())
    }

    #[test]
    fn values_by_name() -> Result<(), String> {
        let numbers = |name: &str, text: &str| {
            assigned(name, text)
                .map(|found| found.into_iter().map(|(path, one)| (path, one.0)).collect::<Vec<_>>())
        };
        let row = |path: &str, numbers: &[f64]| (path.to_owned(), numbers.to_vec());
        assert_eq!(numbers("power", "2.5")?, [row("light.power", &[2.5])]);
        let place = row("light.position", &[1.0, -2.0, 3.0]);
        assert_eq!(numbers("light.position", "1, -2,3")?, [place]);
        let halves = [row("weights[0]", &[0.5]), row("weights[1]", &[0.25])];
        assert_eq!(numbers("weights", "0.5,0.25")?, halves);
        assert_eq!(numbers("weights[1]", "0.25")?, halves[1..]);
        // 0x80 of sRGB is 0.2158605 in linear light (IEC 61966-2-1), alpha is not encoded.
        let tint = numbers("tint", "#ff800080")?.remove(0).1;
        let expected = [1.0, 0.215_860_5, 0.0, 128.0 / 255.0];
        assert!(tint.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6), "{tint:?}");
        assert_eq!(parse_value("#f00")?, UniformValue::Color(vec![1.0, 0.0, 0.0]));
        Ok(())
    }

    /// Two stages of GLSL that declare the same uniforms get the same numbers.
    #[test]
    fn values_of_both_stages() -> Result<(), String> {
        let both = [leaves(), leaves()].concat();
        for (name, text, count) in [("tint", "1,2,3,4", 1), ("weights", "0.5,0.25", 2)] {
            let (name, value) = (name.to_owned(), parse_value(text)?);
            let given = GivenValue { name, value, origin: Origin::Option, span: None };
            let found = assign_values(&both, &[given], true).map_err(|all| format!("{all:?}"))?;
            assert_eq!(found.len(), count, "{text}");
        }
        Ok(())
    }

    #[test]
    fn wrong_values() {
        for (name, text, expected) in [
            ("position", "1,2,3", "`position` is one of several"),
            ("lihgt.power", "1", "no stage reads a uniform `lihgt.power`"),
            ("power", "1,2", "`light.power: f32` takes 1 number, and 2 are given"),
            ("tint", "1", "`tint: vec4f` takes 4 numbers, and 1 is given"),
            ("weights", "1,2,3", "`weights`, 2 elements of f32, takes 2 numbers, and 3 are given"),
            ("power", "#ff8800", "takes 1 number, and 3 are given"),
            ("power", "red", "`red` is no number"),
            ("tint", "#12345", "3, 4, 6 or 8 digits"),
        ] {
            let message = assigned(name, text).err().unwrap_or_default();
            assert!(message.contains(expected), "{name}={text}: {message}");
        }
    }
}
