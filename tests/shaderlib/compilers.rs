//! Compilers of GLSL read the modules: glslc compiles to SPIR-V, and glslangValidator reads the
//! texts that no SPIR-V is made from. One run compiles the texts of all modules, since most of a
//! run with one text is its start.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use libtest_mimic::Failed;
use rayon::prelude::*;

use super::emits::{self, VERSIONS};
use super::{called_wesl, fragment, include, modules};
use crate::glslang::{COMPILED, refused_by_glslc, refused_by_version};

/// A version of GLSL: the lines before the module, and the declaration of an output.
pub struct Dialect {
    pub head: &'static str,
    pub output: &'static str,
    compiler: Compiler,
}

#[derive(Clone, Copy)]
enum Compiler {
    /// With this folder for includes.
    Glslc(Option<&'static str>),
    GlslangValidator,
}

pub const DIALECTS: [Dialect; 4] = [
    Dialect {
        head: "#version 450\n",
        output: "layout(location = 0) out vec4 colour;\n",
        compiler: Compiler::Glslc(None),
    },
    Dialect {
        head: "#version 330 core\n#define LAMPLIGHT_COMBINED_SAMPLERS 1\n",
        output: "out vec4 colour;\n",
        compiler: Compiler::GlslangValidator,
    },
    Dialect { head: ES_300, output: "out vec4 colour;\n", compiler: Compiler::GlslangValidator },
    Dialect { head: ES_310, output: "out vec4 colour;\n", compiler: Compiler::GlslangValidator },
];

impl Dialect {
    /// The options of glslangValidator for one text. By the rules of Vulkan it makes SPIR-V.
    pub fn options(&self) -> &'static [&'static str] {
        match self.compiler {
            Compiler::Glslc(_) => COMPILED,
            Compiler::GlslangValidator => &[],
        }
    }
}

const ES_300: &str = "#version 300 es\n#define LAMPLIGHT_COMBINED_SAMPLERS 1\nprecision highp float;\nprecision highp int;\n";
const ES_310: &str = "#version 310 es\n#define LAMPLIGHT_COMBINED_SAMPLERS 1\nprecision highp float;\nprecision highp int;\n";

/// What a compiler says about each module's text, or why there is no text.
type Verdicts = BTreeMap<String, Result<(), String>>;

/// A module's texts, or why it has none.
type Texts<const N: usize> = Result<[String; N], String>;

/// The module compiles in a dialect.
pub fn in_dialect(module: &str, index: usize) -> Result<(), Failed> {
    static VERDICTS: [OnceLock<Verdicts>; DIALECTS.len()] =
        [const { OnceLock::new() }; DIALECTS.len()];
    let dialect = &DIALECTS[index];
    let verdicts = VERDICTS[index].get_or_init(|| {
        let text = |module: &str| Ok([fragment(&include(module), dialect)?]);
        verdicts_of(&text, [dialect.compiler])
    });
    look_up(verdicts, module)
}

/// The module compiles without our composer, with the include path of glslc.
pub fn with_include_path(module: &str) -> Result<(), Failed> {
    static VERDICTS: OnceLock<Verdicts> = OnceLock::new();
    const PATH: &str = concat!("-I", env!("CARGO_MANIFEST_DIR"), "/shaderlib");
    let Dialect { head, output, .. } = &DIALECTS[0];
    let text = |module: &str| {
        Ok([format!(
            "{head}#extension GL_GOOGLE_include_directive : require\n#include \"{module}.glsl\"\n\
             {output}void main() {{\n    colour = vec4(1.0);\n}}\n"
        )])
    };
    look_up(VERDICTS.get_or_init(|| verdicts_of(&text, [Compiler::Glslc(Some(PATH))])), module)
}

/// What naga writes for the module compiles, for every kind of target with such a compiler.
pub fn in_every_target(module: &str) -> Result<(), Failed> {
    static VERDICTS: OnceLock<Verdicts> = OnceLock::new();
    let texts = |module: &str| emits::emits(&called_wesl(module)?);
    let verdicts =
        VERDICTS.get_or_init(|| verdicts_of(&texts, [Compiler::GlslangValidator; VERSIONS.len()]));
    look_up(verdicts, module)
}

/// Of two texts in each dialect, only the one with a mistake is refused.
pub fn see_mistakes() -> Result<(), Failed> {
    for Dialect { head, output, compiler } in &DIALECTS {
        let text =
            |value: &str| format!("{head}{output}void main() {{\n    colour = {value};\n}}\n");
        let (right, wrong) = (text("vec4(1.0)"), text("undeclared"));
        let refused = refused_texts(*compiler, vec![("right", &right), ("wrong", &wrong)]);
        match refused.as_slice() {
            [("wrong", words)] if words.contains("undeclared") => {}
            _ => return Err(format!("{head}: expected the second text, found {refused:?}").into()),
        }
    }
    Ok(())
}

fn look_up(verdicts: &Verdicts, module: &str) -> Result<(), Failed> {
    let verdict = verdicts.get(module).ok_or_else(|| format!("`{module}` was not compiled"))?;
    Ok(verdict.clone()?)
}

/// Compiles the texts of all modules. The compiler at an index reads the text at this index.
fn verdicts_of<const N: usize>(
    texts: &(dyn Fn(&str) -> Result<[String; N], Failed> + Sync),
    compilers: [Compiler; N],
) -> Verdicts {
    let made = modules().into_par_iter().map(|module| {
        let texts = texts(&module);
        (module, texts.map_err(|error| error.message().unwrap_or_default().to_owned()))
    });
    let made: BTreeMap<String, Texts<N>> = made.collect();
    let refused = compilers.par_iter().enumerate().map(|(index, compiler)| {
        let texts = made.iter().filter_map(|(module, texts)| {
            Some((module.as_str(), texts.as_ref().ok()?[index].as_str()))
        });
        refused_texts(*compiler, texts.collect())
    });
    let refused: Vec<(&str, String)> = refused.flatten_iter().collect();
    let verdict = |(module, texts): (&String, &Texts<N>)| {
        let words = refused.iter().find(|(refused, _)| refused == module);
        let refusal = words.map(|(_, words)| words.clone());
        let made = texts.as_ref().map(|_| ()).map_err(String::clone);
        (module.clone(), made.and_then(|()| refusal.map_or(Ok(()), Err)))
    };
    made.iter().map(verdict).collect()
}

/// The modules whose texts are refused, with the compiler's words and the text.
fn refused_texts<'m>(compiler: Compiler, texts: Vec<(&'m str, &str)>) -> Vec<(&'m str, String)> {
    let compiled = || -> std::io::Result<Vec<(usize, String)>> {
        let folder = tempfile::tempdir()?;
        let mut files = Vec::new();
        for (index, (_, text)) in texts.iter().enumerate() {
            let path = folder.path().join(format!("{index}.frag"));
            std::fs::write(&path, text)?;
            files.push((index, path.to_string_lossy().into_owned()));
        }
        Ok(match compiler {
            Compiler::Glslc(include) => refused_by_glslc(folder.path(), include.as_slice(), &files),
            Compiler::GlslangValidator => refused_by_version(folder.path(), "frag", &files),
        })
    };
    match compiled() {
        Ok(refused) => refused
            .into_iter()
            .map(|(index, words)| (texts[index].0, format!("{words}\n{}", texts[index].1)))
            .collect(),
        Err(error) => texts.iter().map(|(module, _)| (*module, error.to_string())).collect(),
    }
}
