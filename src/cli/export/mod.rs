//! `lamplight export DIR`: the library for other tools, as files and as packages to publish.

mod cargo;
mod npm;
mod three;

use std::collections::BTreeMap;
use std::io::Write;
use std::path::PathBuf;

use clap::{Args, ValueEnum};
use lamplight_translate::print::Dialect;

use super::failure::Failure;
use super::overwrite::Overwrite;
use super::terminal::stdout;
use crate::LIBRARY_FILES;
use crate::catalogue::translated::module_files;
use crate::output;
use crate::project::LIBRARY;
use crate::source::{Files as _, SourceSet};

/// Write the shader library for other tools, or the readers of bundles.
#[derive(Args)]
pub struct Arguments {
    /// The folder to write to. Give it to a compiler as its include path: `glslangValidator -IDIR`.
    folder: PathBuf,
    /// What to write: the library's files, a package that is ready to publish, or the headers that
    /// read bundles.
    #[arg(long, value_enum, default_value_t)]
    form: ExportForm,
    /// The version of the `wesl` crate that the crate of `--form cargo` is for. Since 0.6, items
    /// that others may import are `public`; 0.4 does not read this word.
    #[arg(long, value_enum, value_name = "VERSION", default_value_t)]
    wesl: WeslVersion,
    /// The folder of the package whose functions `--form three` writes, in the place of the library's.
    #[arg(long, value_name = "DIR")]
    package: Option<PathBuf>,
    #[command(flatten)]
    overwrite: Overwrite,
}

#[derive(Clone, Copy, Default, ValueEnum)]
enum ExportForm {
    /// `DIR/lamplight`: WESL and GLSL, for compilers with an include path.
    #[default]
    Files,
    /// `DIR/lamplight_wgsl`: a crate that contains the package `lamplight` for the `wesl` crate.
    Cargo,
    /// `DIR/lamplight`: an npm package that exports a `weslBundle`, and also contains the GLSL.
    Npm,
    /// `DIR/lamplight`: the functions in HLSL, for Direct3D, Unity and Unreal Engine.
    Hlsl,
    /// `DIR/lamplight`: the functions in MSL, for Metal.
    Metal,
    /// `DIR/lamplight_three`: an npm package with a node of TSL for each function, and with chunks of
    /// GLSL, for three.js.
    Three,
    /// `DIR/lamplight_c`: headers that read bundles in C and C++, and a package for CMake.
    C,
}

/// Versions of the `wesl` crate.
#[derive(Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
enum WeslVersion {
    /// It reads no visibility.
    #[default]
    #[value(name = "0.4")]
    Four,
    /// It demands that items of other packages are public. It needs Rust 1.97.1.
    #[value(name = "0.6")]
    Six,
}

/// Path below the package's folder and text.
type PackageContents = BTreeMap<String, String>;

const LICENSES: [(&str, &str); 2] = [
    ("LICENSE-MIT", include_str!("../../../LICENSE-MIT")),
    ("LICENSE-APACHE", include_str!("../../../LICENSE-APACHE")),
];

/// The reader of bundles in C, and what makes bundles in a build with CMake.
const HEADERS: [(&str, &str); 5] = [
    ("cmake/LamplightConfig.cmake", include_str!("../../../cmake/LamplightConfig.cmake")),
    ("include/lamplight.h", include_str!("../../../include/lamplight.h")),
    ("include/lamplight_gl.h", include_str!("../../../include/lamplight_gl.h")),
    ("include/lamplight_vk.h", include_str!("../../../include/lamplight_vk.h")),
    ("include/lamplight_zstd.h", include_str!("../../../include/lamplight_zstd.h")),
];

/// Keywords for search. The first three are the community's for shader packages.
const KEYWORDS: [&str; 5] = ["WGSL", "WESL", "WebGPU", "lighting", "shadow"];

const DESCRIPTION: &str = "Lighting and shadow functions for WGSL, tested function by function";

pub fn run_export(arguments: Arguments) -> Result<(), Failure> {
    if arguments.wesl != WeslVersion::default() && !matches!(arguments.form, ExportForm::Cargo) {
        return Err(Failure::usage("`--wesl` is for `--form cargo`"));
    }
    if arguments.package.is_some() && !matches!(arguments.form, ExportForm::Three) {
        let own = match arguments.form {
            ExportForm::Hlsl => "; `lamplight translate FILE --to hlsl` writes one of your modules",
            ExportForm::Metal => "; `lamplight translate FILE --to msl` writes one of your modules",
            _ => "",
        };
        return Err(Failure::usage(format!("`--package` is for `--form three`{own}")));
    }
    let (name, contents) = match arguments.form {
        ExportForm::Three => return export_three(&arguments),
        ExportForm::Files => (LIBRARY, exported_files()?),
        ExportForm::Cargo => {
            (cargo::NAME, cargo::crate_contents(library_modules()?, arguments.wesl)?)
        }
        ExportForm::Npm => {
            (npm::NAME, npm::npm_contents(library_modules()?, library_texts(&["glsl"])?))
        }
        ExportForm::Hlsl => (LIBRARY, translated_library(Dialect::Hlsl)?),
        ExportForm::Metal => (LIBRARY, translated_library(Dialect::Msl)?),
        ExportForm::C => ("lamplight_c", headers()),
    };
    let count = write_package(&arguments, name, contents)?;
    let folder = arguments.folder.join(name);
    Ok(writeln!(stdout(), "{}: {count} files", folder.display())?)
}

/// Writes a package's files below its name, and gives their number.
fn write_package(
    arguments: &Arguments,
    name: &str,
    contents: PackageContents,
) -> Result<usize, Failure> {
    let files: PackageContents =
        contents.into_iter().map(|(path, text)| (format!("{name}/{path}"), text)).collect();
    let files_as_bytes = files.iter().map(|(path, text)| (path.as_str(), text.as_bytes()));
    output::write_folder(&arguments.folder, files_as_bytes, arguments.overwrite.replace())?;
    Ok(files.len())
}

fn export_three(arguments: &Arguments) -> Result<(), Failure> {
    let made = three::three_contents(arguments.package.as_deref())?;
    let count = write_package(arguments, &made.name, made.files)?;
    let folder = arguments.folder.join(&made.name);
    writeln!(stdout(), "{}: {count} files, {} functions", folder.display(), made.functions)?;
    for three::LeftOut { path, reason } in &made.left_out {
        writeln!(stdout(), "left out: {path}: {reason}")?;
    }
    Ok(())
}

fn headers() -> PackageContents {
    HEADERS.into_iter().chain(LICENSES).map(|(path, text)| (path.into(), text.into())).collect()
}

fn exported_files() -> Result<PackageContents, Failure> {
    let mut contents = library_texts(&["wesl", "wgsl", "glsl"])?;
    contents.extend(library_texts(&["toml"])?.into_iter().filter(|(path, _)| path == "wesl.toml"));
    contents.extend(license_files());
    contents.insert("README.md".to_owned(), readme_text());
    Ok(contents)
}

/// The functions in another language, as files that include each other.
fn translated_library(dialect: Dialect) -> Result<PackageContents, Failure> {
    let mut sources = SourceSet::default();
    let mut contents = module_files(&LIBRARY_FILES, dialect, &mut sources)
        .map_err(|problems| Failure::Input(sources, problems))?;
    contents.extend(license_files());
    let readme = format!(
        "# lamplight {}\n\nLighting and shadow functions in {}, tested function by function.\n\n\
         Licence: {}. Source: {}\n",
        env!("CARGO_PKG_VERSION"),
        dialect.name(),
        env!("CARGO_PKG_LICENSE"),
        env!("CARGO_PKG_REPOSITORY")
    );
    contents.insert("README.md".to_owned(), readme);
    Ok(contents)
}

/// Describes the files and their version.
fn readme_text() -> String {
    let version = env!("CARGO_PKG_VERSION");
    let (license, repository) = (env!("CARGO_PKG_LICENSE"), env!("CARGO_PKG_REPOSITORY"));
    format!(
        "# lamplight {version}\n\n{DESCRIPTION}, with the same functions in GLSL.\n\n\
         A compiler's include path is the folder above this one:\n\
         `#include \"lamplight/brdf/specular.glsl\"`.\n\n\
         Licence: {license}. Source: {repository}\n"
    )
}

/// The modules that others can import. Programs are left out: they are entry points with conditions
/// over axes of Lamplight.
fn library_modules() -> Result<PackageContents, Failure> {
    Ok(library_texts(&["wesl", "wgsl"])?
        .into_iter()
        .filter(|(path, _)| !path.starts_with("programs/"))
        .collect())
}

fn library_texts(extensions: &[&str]) -> Result<PackageContents, Failure> {
    let text = |path: String| match LIBRARY_FILES.read(&path) {
        Ok(Some(text)) => Ok((path, text)),
        _ => Err(Failure::environment(format!("the binary carries no `{path}`"))),
    };
    LIBRARY_FILES.list(extensions).into_iter().map(text).collect()
}

/// The files below a folder of the package.
fn files_below(folder: &str, files: PackageContents) -> impl Iterator<Item = (String, String)> {
    files.into_iter().map(move |(path, text)| (format!("{folder}/{path}"), text))
}

fn license_files() -> impl Iterator<Item = (String, String)> {
    LICENSES.into_iter().map(|(path, text)| (path.to_owned(), text.to_owned()))
}

/// A package's `wesl.toml`. Its keys are in a table, as the specification has it, and also at the
/// top for older tools.
fn wesl_toml(manager: &str, root: &str) -> String {
    let keys = format!(
        "edition = \"{EDITION}\"\npackage-manager = \"{manager}\"\nroot = \"{root}\"\ninclude = [\"**/*.wesl\"]\n"
    );
    format!("{keys}\n[package]\nname = \"{LIBRARY}\"\n{keys}")
}

/// The edition of WESL the library is written in.
const EDITION: &str = "2026_pre";
