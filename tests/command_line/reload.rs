//! A bundle that is replaced while an engine has it open.

use std::fs;

use lamplight::bundle::{Bundle, Target};

use super::package::{Package, equal};
use super::{Case, Outcome};

pub const CASES: &[Case] = &[
    ("reload_of_a_folder", || reloads("live")),
    ("reload_of_a_file", || reloads("live.lamplight")),
];

const MANIFEST: &str = "[program.p]\nwesl = \"p.wesl\"\ntargets = [\"wgsl\", \"glsl330\"]\n\
    [program.p.axis]\nfog = { values = [false, true] }\n";

fn shader(clear: &str, foggy: &str) -> String {
    format!(
        "@fragment fn m(@location(0) x: f32) -> @location(0) vec4f {{\n\
         @if(fog) {{ return vec4f(x * {foggy}); }}\n@else {{ return vec4f(x * {clear}); }}\n}}\n"
    )
}

/// `reload` says which permutations changed. Another reader that has the bundle open keeps the older
/// bytes. A reload that fails changes nothing.
fn reloads(out: &str) -> Outcome {
    let package =
        Package::new(&[("lamplight.toml", MANIFEST), ("p.wesl", &shader("0.5", "0.25"))])?;
    let generate = format!("gen --cache cache -o {out}");
    package.run(&generate)?.ends(0)?;
    let path = package.path(out);
    let mut bundle = Bundle::open(&path)?;
    let reader = Bundle::open(&path)?;
    equal(bundle.reload()?.is_empty(), true)?;
    package.write("p.wesl", &shader("0.5", "0.125"))?;
    package.run(&generate)?.ends(0)?;
    let changed = bundle.reload()?;
    let keys: Vec<(&str, &str)> =
        changed.permutations.iter().map(|change| (change.key.as_str(), change.kind)).collect();
    equal(keys, vec![("fog", "changed")])?;
    equal(changed.permutations[0].parts.clone(), vec!["glsl330".to_owned(), "wgsl".to_owned()])?;
    equal(text(&bundle, "fog")?.contains("0.125"), true)?;
    // A reader that does not reload still finds all of the older bundle.
    equal(text(&reader, "fog")?.contains("0.25"), true)?;
    equal(text(&reader, "default")?.contains("0.5"), true)?;
    // A permutation that is excluded is removed.
    package.write(
        "lamplight.toml",
        &MANIFEST.replace("[program.p.axis]", "exclude = [{ fog = true }]\n[program.p.axis]"),
    )?;
    package.run(&format!("{generate} --force"))?.ends(0)?;
    let changed = bundle.reload()?;
    equal(changed.permutations.iter().map(|change| change.kind).collect(), vec!["removed"])?;
    damaged(&package, out, &mut bundle)
}

/// A bundle that cannot be read is not loaded, and the one in memory stays.
fn damaged(package: &Package, out: &str, bundle: &mut Bundle) -> Outcome {
    let path = package.path(out);
    let file = if path.is_dir() { path.join("index.bin") } else { path };
    let other = package.path("damaged");
    fs::write(&other, b"{ \"format\": ")?;
    fs::rename(&other, &file)?;
    if bundle.reload().is_ok() {
        return Err("a damaged bundle was loaded".into());
    }
    equal(text(bundle, "default")?.contains("0.5"), true)
}

fn text(bundle: &Bundle, key: &str) -> Result<String, libtest_mimic::Failed> {
    let found = bundle.program("p")?.shader("m")?.get(key, Target::WGSL)?;
    Ok(String::from_utf8(found.bytes)?)
}
