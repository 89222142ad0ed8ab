//! A crate that carries the library as a package for the `wesl` crate.

use super::{
    DESCRIPTION, KEYWORDS, PackageContents, WeslVersion, files_below, license_files, wesl_toml,
};
use crate::cli::failure::Failure;
use crate::parse::wesl::{ItemKind, Names, split_module};
use crate::source::SourceSet;

/// The crate's name, with the suffix that shader packages have; imports begin with the package's,
/// `lamplight`.
pub const NAME: &str = "lamplight_wgsl";

const ROOT: &str = "src/shaders";

/// What the crate for a version of the `wesl` crate says otherwise than that for another one.
struct CrateTexts {
    version: &'static str,
    rust: &'static str,
    /// The crate that has the macro for packages, and its version.
    library: [&'static str; 2],
    builder: &'static str,
    compiler: &'static str,
}

fn texts_for(version: WeslVersion) -> CrateTexts {
    match version {
        WeslVersion::Four => CrateTexts {
            version: "0.4.0",
            rust: "1.87",
            library: ["wesl", "0.4.0"],
            builder: "PkgBuilder::new(\"lamplight\").scan_toml(\".\")",
            compiler: "let mut compiler = wesl::Wesl::new(\"src/shaders\");\n\
                compiler.add_package(&lamplight_wgsl::lamplight::PACKAGE);",
        },
        WeslVersion::Six => CrateTexts {
            version: "0.6.0",
            rust: "1.97.1",
            library: ["wesl-core", "0.1.0"],
            builder: "package::PackageBuilder::new(\"lamplight\").scan_root(\"src/shaders\")",
            compiler: "let mut options = wesl::CompileOptions::default();\n\
                options.dependencies.push(&lamplight_wgsl::lamplight::PACKAGE);\n\
                let compiler = wesl::Compiler::new(options);",
        },
    }
}

pub fn crate_contents(
    modules: PackageContents,
    version: WeslVersion,
) -> Result<PackageContents, Failure> {
    let texts = texts_for(version);
    let modules = match version {
        WeslVersion::Four => modules,
        WeslVersion::Six => {
            let public = |(path, text): (String, String)| {
                let text = with_public_items(&path, text)?;
                Ok((path, text))
            };
            modules.into_iter().map(public).collect::<Result<_, Failure>>()?
        }
    };
    let own = [
        ("Cargo.toml", cargo_manifest(&texts)),
        ("build.rs", BUILD.replace("BUILDER", texts.builder)),
        ("src/lib.rs", lib_text(&texts)),
        ("README.md", README.replace("COMPILER", texts.compiler).replace("VERSION", minor(&texts))),
        ("wesl.toml", wesl_toml("cargo", ROOT)),
    ];
    let own = own.into_iter().map(|(path, text)| (path.to_owned(), text));
    Ok(own.chain(license_files()).chain(files_below(ROOT, modules)).collect())
}

fn minor(texts: &CrateTexts) -> &'static str {
    texts.version.rsplit_once('.').map_or(texts.version, |(minor, _)| minor)
}

/// A module of the library, whose items get the word `public`.
fn with_public_items(path: &str, text: String) -> Result<String, Failure> {
    let mut sources = SourceSet::default();
    let source = sources.add(path.to_owned(), text.clone());
    let split = split_module(source, text.as_str().into(), &mut Names::default())
        .map_err(|errors| Failure::Input(sources, errors))?;
    let mut public = text;
    let items = split.module.items.iter().zip(&split.places);
    for (_, place) in items.rev().filter(|(item, _)| item.kind != ItemKind::ConstAssert) {
        public.insert_str(split.tokens[place.keyword].start as usize, "public ");
    }
    Ok(public)
}

/// The manifest. It is a workspace of its own, so that the crate builds wherever it is written.
fn cargo_manifest(texts: &CrateTexts) -> String {
    format!(
        r#"[package]
name = "{NAME}"
version = "{version}"
edition = "2024"
rust-version = "{rust}"
description = "{DESCRIPTION}"
license = "{license}"
repository = "{repository}"
readme = "README.md"
keywords = {KEYWORDS:?}
categories = ["graphics", "rendering"]

[workspace]

[dependencies]
{library} = "{library_version}"

[build-dependencies]
wesl = {{ version = "{wesl}", features = ["package"] }}
"#,
        rust = texts.rust,
        library = texts.library[0],
        library_version = texts.library[1],
        wesl = texts.version,
        version = env!("CARGO_PKG_VERSION"),
        license = env!("CARGO_PKG_LICENSE"),
        repository = env!("CARGO_PKG_REPOSITORY"),
    )
}

const BUILD: &str = r#"//! Reads the shaders that `wesl.toml` lists and writes them as Rust constants.

use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=wesl.toml");
    println!("cargo::rerun-if-changed=src/shaders");
    let package = wesl::BUILDER?;
    let package = package.validate().map_err(|error| error.to_string())?;
    Ok(package.build_artifact()?)
}
"#;

fn lib_text(texts: &CrateTexts) -> String {
    let compiler: String = texts.compiler.lines().map(|line| format!("//! {line}\n")).collect();
    format!(
        "//! Lighting and shadow functions for WGSL, as a package for the `wesl` crate.\n//!\n\
         //! ```\n{compiler}//! ```\n\n{}::wesl_pkg!(pub lamplight);\n",
        texts.library[0].replace('-', "_")
    )
}

const README: &str = r#"# lamplight_wgsl

The shader library of [Lamplight](https://crates.io/crates/lamplight) for the
[`wesl`](https://crates.io/crates/wesl) crate: attenuation, spot cones, classic and microfacet
highlights, ambient light, shadow filters, and what they need.

```toml
[dependencies]
lamplight_wgsl = "0.1"
wesl = "VERSION"
```

```rust
COMPILER
```

```wgsl
import lamplight::brdf::specular::blinn_phong;
```

Each function says in its comment what it computes, the space, unit and range of its parameters,
its source, what happens at its edges, and how large its error may be. Functions are pure: no
bindings, no globals.
"#;
