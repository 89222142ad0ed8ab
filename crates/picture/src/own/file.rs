//! The settings of a picture in a file beside the shader: `lamp.uniforms.toml` for `lamp.wesl`.

use std::collections::BTreeMap;

use serde::Deserialize;
use toml::{Spanned, Value};

use lamplight_catalogue::reader;
use lamplight_diagnostic::source::{SourceId, SourceSet, Span};
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};

use super::table::Origin;
use super::values::{GivenValue, UniformValue, parse_value};

/// What a settings file says.
#[derive(Debug, Default)]
pub struct OwnSettings {
    pub model: Option<String>,
    pub time: Option<f64>,
    pub given: Vec<GivenValue>,
    /// Textures by name: what they hold, and where that is said.
    pub textures: BTreeMap<String, (String, Span)>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SettingsFile {
    model: Option<String>,
    time: Option<f64>,
    #[serde(default)]
    uniforms: BTreeMap<Spanned<String>, Spanned<Value>>,
    #[serde(default)]
    textures: BTreeMap<Spanned<String>, Spanned<String>>,
}

/// Reads a settings file that is in the set.
///
/// # Errors
/// `data-syntax` at the place of what is not as expected.
pub fn read_settings(sources: &SourceSet, id: SourceId) -> Result<OwnSettings, Diagnostics> {
    let file: SettingsFile = reader::read_data(sources, id)?;
    let (mut given, mut errors) = (Vec::new(), Diagnostics::new());
    for (name, value) in &file.uniforms {
        let span = Span::new(id, value.span());
        add_values(name.get_ref(), value.get_ref(), span, &mut given, &mut errors);
    }
    if !errors.is_empty() {
        return Err(errors);
    }
    let texture = |(name, content): (Spanned<String>, Spanned<String>)| {
        let span = Span::new(id, content.span());
        (name.into_inner(), (content.into_inner(), span))
    };
    let textures = file.textures.into_iter().map(texture).collect();
    Ok(OwnSettings { model: file.model, time: file.time, given, textures })
}

/// Adds a value, or those of a table: `[uniforms.light]` has the members of `light`.
fn add_values(
    name: &str,
    value: &Value,
    span: Span,
    given: &mut Vec<GivenValue>,
    errors: &mut Diagnostics,
) {
    if let Value::Table(members) = value {
        for (member, value) in members {
            add_values(&format!("{name}.{member}"), value, span, given, errors);
        }
        return;
    }
    let read = match value {
        Value::String(text) => parse_value(text),
        other => flat_numbers(other).map(UniformValue::Numbers).ok_or_else(|| {
            format!("`{name}` is a number, a boolean, a list of numbers, or a colour in quotes")
        }),
    };
    match read {
        Ok(value) => {
            let (name, origin, span) = (name.to_owned(), Origin::File, Some(span));
            given.push(GivenValue { name, value, origin, span });
        }
        Err(message) => {
            errors.push(Diagnostic::error(codes::DATA_SYNTAX, message).at(span, "given here"));
        }
    }
}

/// The numbers of a value, and of lists within it.
fn flat_numbers(value: &Value) -> Option<Vec<f64>> {
    match value {
        Value::Integer(number) => Some(vec![*number as f64]),
        Value::Float(number) => Some(vec![*number]).filter(|_| number.is_finite()),
        Value::Boolean(is_true) => Some(vec![f64::from(u8::from(*is_true))]),
        Value::Array(parts) => {
            let parts: Option<Vec<Vec<f64>>> = parts.iter().map(flat_numbers).collect();
            parts.map(|parts| parts.concat())
        }
        Value::String(_) | Value::Datetime(_) | Value::Table(_) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::{OwnSettings, read_settings};
    use crate::own::values::UniformValue;
    use lamplight_diagnostic::Diagnostics;
    use lamplight_diagnostic::source::SourceSet;

    fn read(text: &str) -> Result<OwnSettings, Diagnostics> {
        let mut sources = SourceSet::default();
        let id = sources.add("lamp.uniforms.toml", text.to_owned());
        read_settings(&sources, id)
    }

    #[test]
    fn settings_of_a_file() -> Result<(), String> {
        let text = "model = 'torus'\ntime = 2.5\n[uniforms]\ntint = '#ff0000'\nrows = [[1, 2], [3, 4.5]]\n\
            [uniforms.lamp]\non = true\n[textures]\nalbedo = 'noise'\n";
        let settings = read(text).map_err(|errors| format!("{errors:?}"))?;
        assert_eq!((settings.model.as_deref(), settings.time), (Some("torus"), Some(2.5)));
        let given: Vec<_> = settings.given.into_iter().map(|one| (one.name, one.value)).collect();
        let numbers = |numbers: &[f64]| UniformValue::Numbers(numbers.to_vec());
        let expected = [
            ("lamp.on".to_owned(), numbers(&[1.0])),
            ("rows".to_owned(), numbers(&[1.0, 2.0, 3.0, 4.5])),
            ("tint".to_owned(), UniformValue::Color(vec![1.0, 0.0, 0.0])),
        ];
        assert_eq!(given, expected);
        assert_eq!(settings.textures["albedo"].0, "noise");
        Ok(())
    }

    #[test]
    fn wrong_settings() {
        for (text, expected) in [
            ("modle = 'torus'", "unknown field `modle`"),
            ("[uniforms]\ntint = 'red'", "`red` is no number"),
            ("[uniforms]\ntint = 1979-05-27", "`tint` is a number, a boolean"),
            ("[uniforms\n", "unclosed table"),
        ] {
            let errors = read(text).err().unwrap_or_default();
            let message: String = errors.iter().map(|error| error.message.clone()).collect();
            assert!(message.contains(expected), "{text}: {message}");
            assert!(errors.iter().all(|error| !error.labels.is_empty()), "{text}");
        }
    }
}
