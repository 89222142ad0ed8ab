//! An npm package with a node of TSL for each function, for three.js.

use std::collections::BTreeMap;
use std::path::Path;

use super::{PackageContents, license_files};
use crate::LIBRARY_FILES;
pub use crate::catalogue::three::LeftOut;
use crate::catalogue::three::three_package;
use crate::catalogue::{own_modules, package_modules};
use crate::cli::failure::Failure;
use crate::permute::Settings;
use crate::project::{self, LIBRARY, library_packages};
use crate::source::SourceSet;

/// A package, and what is not in it.
pub struct ThreeContents {
    /// The folder's name.
    pub name: String,
    pub files: PackageContents,
    pub functions: usize,
    pub left_out: Vec<LeftOut>,
}

/// The functions of the package in a folder, or those of the library.
pub fn three_contents(package: Option<&Path>) -> Result<ThreeContents, Failure> {
    let mut sources = SourceSet::default();
    let made = match package {
        None => {
            let modules = package_modules(&LIBRARY_FILES);
            let packages = library_packages();
            three_package(packages, &modules, LIBRARY, &Settings::default(), &mut sources)
                .map(|made| (LIBRARY.to_owned(), made))
        }
        Some(folder) => own_package(folder, &mut sources),
    };
    let (name, made) = made.map_err(|problems| Failure::Input(sources, problems))?;
    let mut files: BTreeMap<String, String> = made.files;
    if package.is_none() {
        files.extend(license_files());
    }
    files.insert("package.json".to_owned(), package_json(&name, package.is_none()));
    files.insert("README.md".to_owned(), readme_text(&name, made.functions, made.left_out.len()));
    Ok(ThreeContents {
        name: format!("{name}_three"),
        files,
        functions: made.functions,
        left_out: made.left_out,
    })
}

/// The functions of a folder's package, with the defaults of its settings.
fn own_package(
    folder: &Path,
    sources: &mut SourceSet,
) -> Result<(String, crate::catalogue::three::ThreePackage), crate::diagnostic::Diagnostics> {
    let root = project::package_at(folder).unwrap_or_else(|| folder.to_owned());
    let packages = project::packages(&root, sources)?;
    let mut settings = Settings::default();
    project::features(&root, sources)?.complete(&mut settings);
    let modules = own_modules(&*packages.root.files);
    let name = package_name(folder);
    let made = three_package(packages, &modules, &name, &settings, sources)?;
    Ok((name, made))
}

/// A name for shaders and for npm, from that of the folder.
fn package_name(folder: &Path) -> String {
    let full = std::fs::canonicalize(folder).unwrap_or_else(|_| folder.to_owned());
    let name = full.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
    let word = |letter: char| if letter.is_ascii_alphanumeric() { letter } else { '_' };
    let plain: String = name.chars().map(word).collect();
    let plain = plain.trim_matches(|letter: char| letter == '_' || letter.is_ascii_digit());
    let parts: Vec<&str> = plain.split('_').filter(|part| !part.is_empty()).collect();
    if parts.is_empty() { "own".to_owned() } else { parts.join("_") }
}

fn package_json(name: &str, is_library: bool) -> String {
    let (version, license) = (env!("CARGO_PKG_VERSION"), env!("CARGO_PKG_LICENSE"));
    let about = match is_library {
        true => format!("\n  \"version\": \"{version}\",\n  \"license\": \"({license})\","),
        false => "\n  \"private\": true,\n  \"version\": \"0.0.0\",".to_owned(),
    };
    format!(
        r#"{{
  "name": "{name}-three",{about}
  "description": "Shader functions of {name} as nodes of TSL and as chunks of GLSL, for three.js",
  "type": "module",
  "sideEffects": false,
  "exports": {{
    "./tsl/*.js": {{ "types": "./tsl/*.d.ts", "default": "./tsl/*.js" }},
    "./parts/*.js": {{ "types": "./parts/*.d.ts", "default": "./parts/*.js" }},
    "./chunk.js": {{ "types": "./chunk.d.ts", "default": "./chunk.js" }},
    "./package.json": "./package.json"
  }},
  "peerDependencies": {{ "three": ">=0.180.0" }}
}}
"#
    )
}

fn readme_text(name: &str, functions: usize, left_out: usize) -> String {
    format!(
        "# {name}-three\n\n{functions} functions for three.js. For `WebGPURenderer`, with either of its \
         backends, each is a function of TSL in the module `{name}-three/tsl/PATH.js`, and takes its \
         parameters in their order. A material has each helper once, whichever functions share it.\n\n\
         For `ShaderMaterial`, `chunk` of `{name}-three/chunk.js` puts parts of \
         `{name}-three/parts/PATH.js` and all that they need into a text in GLSL. There the names of \
         functions begin with `{name}_`.\n\n\
         [left_out.md](left_out.md) lists {left_out} functions that are not here, or not for WebGL, \
         with the reason of each.\n"
    )
}
