//! A crate that carries the library as a package for the `wesl` crate.

use super::{DESCRIPTION, KEYWORDS, PackageContents, files_below, license_files, wesl_toml};

/// The crate's name, with the suffix that shader packages have; imports begin with the package's,
/// `lamplight`.
pub const NAME: &str = "lamplight_wgsl";

const ROOT: &str = "src/shaders";

pub fn crate_contents(modules: PackageContents) -> PackageContents {
    let own = [
        ("Cargo.toml", cargo_manifest()),
        ("build.rs", BUILD.to_owned()),
        ("src/lib.rs", LIB.to_owned()),
        ("README.md", README.to_owned()),
        ("wesl.toml", wesl_toml("cargo", ROOT)),
    ];
    own.into_iter()
        .map(|(path, text)| (path.to_owned(), text))
        .chain(license_files())
        .chain(files_below(ROOT, modules))
        .collect()
}

/// The manifest. It is a workspace of its own, so that the crate builds wherever it is written.
fn cargo_manifest() -> String {
    format!(
        r#"[package]
name = "{NAME}"
version = "{version}"
edition = "2024"
rust-version = "1.87"
description = "{DESCRIPTION}"
license = "{license}"
repository = "{repository}"
readme = "README.md"
keywords = {KEYWORDS:?}
categories = ["graphics", "rendering"]

[workspace]

[dependencies]
wesl = "0.4.0"

[build-dependencies]
wesl = {{ version = "0.4.0", features = ["package"] }}
"#,
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
    let package = wesl::PkgBuilder::new("lamplight").scan_toml(".")?;
    let package = package.validate().map_err(|error| error.to_string())?;
    Ok(package.build_artifact()?)
}
"#;

const LIB: &str = r#"//! Lighting and shadow functions for WGSL, as a package for the `wesl` crate.
//!
//! ```
//! let mut compiler = wesl::Wesl::new("src/shaders");
//! compiler.add_package(&lamplight_wgsl::lamplight::PACKAGE);
//! ```

wesl::wesl_pkg!(pub lamplight);
"#;

const README: &str = r#"# lamplight_wgsl

The shader library of [Lamplight](https://crates.io/crates/lamplight) for the
[`wesl`](https://crates.io/crates/wesl) crate: attenuation, spot cones, classic and microfacet
highlights, ambient light, shadow filters, and what they need.

```toml
[dependencies]
lamplight_wgsl = "0.1"
wesl = "0.4"
```

```rust
let mut compiler = wesl::Wesl::new("src/shaders");
compiler.add_package(&lamplight_wgsl::lamplight::PACKAGE);
```

```wgsl
import lamplight::brdf::specular::blinn_phong;
```

Each function says in its comment what it computes, the space, unit and range of its parameters,
its source, what happens at its edges, and how large its error may be. Functions are pure: no
bindings, no globals.
"#;
