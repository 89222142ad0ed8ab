//! The table `glsl` of a manifest: what files in GLSL of the package find, as `-I` and `-D` give it on
//! the command line.
//!
//! ```toml
//! [glsl]
//! include = ["../common"]               # where `#include` looks last, from the manifest's folder
//! define = { LIGHTS = 4, USE_FOG = "" } # macros, before every file
//! ```

use toml::de::{DeTable, DeValue};

use super::reader::{ManifestReader, TomlValue};
use crate::quoted::Quoted;
use lamplight_diagnostic::source::{SourceId, SourceSet};
use lamplight_diagnostic::{Diagnostic, codes};
use lamplight_syntax::words::is_word;

/// What files in GLSL find.
#[derive(Debug, Clone, Default)]
pub struct GlslSettings {
    /// Folders, from the manifest's folder.
    pub include: Vec<Quoted>,
    /// Names of macros with their texts, by name.
    pub define: Vec<(String, String)>,
}

/// The table of a text that may have mistakes elsewhere, which are reported where the whole manifest
/// is read.
pub fn read_file(sources: &SourceSet, id: SourceId) -> GlslSettings {
    let text = &sources.get(id).text;
    // Most manifests have no such table, and large ones take long to parse.
    if !text.contains("glsl]") && !text.contains("glsl.") {
        return GlslSettings::default();
    }
    let (document, _) = DeTable::parse_recoverable(text);
    read_glsl(&mut ManifestReader::new(sources, id), document.get_ref())
}

pub fn read_glsl(reader: &mut ManifestReader, document: &DeTable) -> GlslSettings {
    let Some(table) = document.get("glsl").and_then(|found| reader.table(found, "`glsl`")) else {
        return GlslSettings::default();
    };
    reader.check_keys(table, &["include", "define"], "`[glsl]`");
    let folders = table.get("include").and_then(|list| reader.array(list, "`include`"));
    let folders = folders.into_iter().flatten();
    let include = folders.filter_map(|folder| reader.string(folder, "a folder")).collect();
    let macros = table.get("define").and_then(|found| reader.table(found, "`define`"));
    let macros = macros.into_iter().flatten();
    let define = macros.filter_map(|(name, value)| {
        let place = reader.span(name.span());
        let name = name.get_ref().to_string();
        if !is_word(&name) || name == "defined" || name.starts_with("GL_") {
            let message = format!("`{name}` cannot name a macro");
            let error = Diagnostic::error(codes::BAD_NAME, message);
            reader.problems.push(error.at(place, "not a name that GLSL lets a text define"));
            return None;
        }
        Some((name, macro_text(reader, value)?))
    });
    GlslSettings { include, define: define.collect() }
}

/// The text of a macro: a number, 1 or 0 for a boolean, or a string as it is.
fn macro_text(reader: &mut ManifestReader, value: &TomlValue) -> Option<String> {
    let text = match value.get_ref() {
        DeValue::Boolean(value) => u8::from(*value).to_string(),
        DeValue::Integer(_) | DeValue::Float(_) => {
            reader.sources.text(reader.span(value.span())).to_owned()
        }
        _ => reader.string(value, "a macro")?.text,
    };
    if text.contains(['\n', '\r', '\\']) {
        let error = Diagnostic::error(codes::WRONG_TYPE, "the text of a macro is one line");
        reader
            .problems
            .push(error.at(reader.span(value.span()), "has a line break or a backslash"));
        return None;
    }
    Some(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> (GlslSettings, Vec<String>) {
        let mut sources = SourceSet::default();
        let id = sources.add("lamplight.toml", text);
        let mut reader = ManifestReader::new(&sources, id);
        let (document, _) = DeTable::parse_recoverable(text);
        let found = read_glsl(&mut reader, document.get_ref());
        let problems = reader.problems.iter().map(|problem| {
            let place = sources.text(problem.labels[0].span);
            format!("{} at {place}", problem.code.name)
        });
        (found, problems.collect())
    }

    #[test]
    fn macros_are_texts() {
        let (found, problems) = read(
            "[glsl]\ninclude = [\"../common\"]\n\
             define = { A = 4, B = true, C = 0.50, D = \"(x)\", E = \"\" }\n",
        );
        assert_eq!(problems, Vec::<String>::new());
        let folders: Vec<&str> = found.include.iter().map(|folder| folder.text.as_str()).collect();
        assert_eq!(folders, ["../common"]);
        let texts = [("A", "4"), ("B", "1"), ("C", "0.50"), ("D", "(x)"), ("E", "")];
        assert_eq!(found.define, texts.map(|(name, text)| (name.to_owned(), text.to_owned())));
    }

    #[test]
    fn mistakes_have_places() {
        let (found, problems) = read(
            "glsl = { include = [1], macros = 2, define = { defined = 1, GL_X = 1, X = [1], \
             Y = \"a\\nb\" } }\n",
        );
        assert!(found.include.is_empty() && found.define.is_empty());
        let expected = [
            "unknown-key at macros",
            "wrong-type at 1",
            "bad-name at GL_X",
            "wrong-type at [1]",
            "wrong-type at \"a\\nb\"",
            "bad-name at defined",
        ];
        assert_eq!(problems, expected.map(str::to_owned));
    }
}
