//! Arguments that contradict documentation, and those that do not.

use std::collections::BTreeMap;

use lamplight_compose::resolve::Packages;
use lamplight_diagnostic::Severity;
use lamplight_diagnostic::source::{Memory, Package, SourceSet};
use lamplight_lint::{Request, lint};
use lamplight_permute::Settings;
use libtest_mimic::{Failed, Trial};

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("lint::documented_found", found),
        Trial::test("lint::documented_silent", silent),
        Trial::test("lint::documented_allowed", allowed),
    ]
}

/// A module whose functions are documented in the library's form.
const HEAD: &str = "\
/// A cone.
///
/// Parameters: `c` cosine of the angle, [-1, 1]; `inner` and `outer` cosines of the half angles, `inner` \
above `outer`.
/// Returns: 0 or 1.
fn cone(c: f32, inner: f32, outer: f32) -> f32 { return c * inner * outer; }

/// Light.
///
/// Parameters: `n`, `l` unit, one space; `w` wrap, [0, 1]: 0 is none; `d2` squared distance, at least 0; \
`angle` of the lamp, radians; `tilt` degrees.
fn lit(n: vec3f, l: vec3f, w: f32, d2: f32, angle: f32, tilt: f32) -> f32 {
    return dot(n, l) * w * d2 * angle * tilt;
}

/// The distance alone.
///
/// Parameters: `d` distance to the light, above 0.
fn near(d: f32) -> f32 { return d; }

// Parameters: `x` cosine of an angle.
fn undocumented(x: f32) -> f32 { return x; }
";

/// The names of the lints that a statement of a function gives.
fn lints_of(statement: &str) -> Result<Vec<&'static str>, Failed> {
    let text = format!(
        "{HEAD}\nconst far = 40.0;\nfn f(n: vec3f, p: vec3f, q: vec3f, x: f32) -> f32 {{\n{statement}\n}}\n"
    );
    let files = Memory(BTreeMap::from([("a.wesl".to_owned(), text)]));
    let root = Package { name: "package".to_owned(), files: Box::new(files) };
    let packages = Packages::new(root, Vec::new());
    let (settings, paths) = (Settings::default(), ["a.wesl".to_owned()]);
    let request =
        Request { packages: &packages, manifest: None, settings: &settings, paths: &paths };
    let found = lint(&mut SourceSet::default(), &request).diagnostics;
    if let Some(error) = found.iter().find(|one| one.severity == Severity::Error) {
        return Err(format!("{statement}: {error:?}").into());
    }
    Ok(found.into_iter().map(|one| one.code.name).collect())
}

fn found() -> Result<(), Failed> {
    for (statement, expected) in [
        ("return cone(x, 45.0, 30.0);", &["argument-unit", "argument-unit"][..]),
        ("return cone(x, 0.5, 0.6);", &["argument-range"]),
        ("return cone(2.0, 0.6, 0.5);", &["argument-unit"]),
        ("return lit(n, p - q, 0.5, x, x, x);", &["argument-length"]),
        ("let l = p - q; return lit(n, l, 0.5, x, x, x);", &["argument-length"]),
        ("return lit(vec3f(1.0), n, 0.5, x, x, x);", &["argument-length"]),
        ("return lit(n, n, 1.5, x, x, x);", &["argument-range"]),
        ("return lit(n, n, -0.5, x, x, x);", &["argument-range"]),
        ("return lit(n, n, 0.5, -far, x, x);", &["argument-range"]),
        ("return lit(n, n, 0.5, length(p), x, x);", &["argument-unit"]),
        ("return lit(n, n, 0.5, distance(p, q), x, x);", &["argument-unit"]),
        ("return lit(n, n, 0.5, x, 90.0, x);", &["argument-unit"]),
        ("return lit(n, n, 0.5, x, degrees(x), x);", &["argument-unit"]),
        ("return lit(n, n, 0.5, x, x, radians(x));", &["argument-unit"]),
        ("return near(dot(p, p));", &["argument-unit"]),
        ("return near(0.0);", &["argument-range"]),
        ("return cos(45.0) + sin(-90.0);", &["argument-unit", "argument-unit"]),
    ] {
        let found = lints_of(statement)?;
        if found != expected {
            return Err(format!("{statement}: {found:?}, not {expected:?}").into());
        }
    }
    Ok(())
}

/// What is as it is documented, or cannot be known.
fn silent() -> Result<(), Failed> {
    for statement in [
        "return cone(x, cos(radians(30.0)), cos(radians(45.0)));",
        "return cone(1.0, 0.9, 0.9 - 0.1);",
        "return cone(x, x, 0.5);",
        "return lit(n, normalize(p - q), 1.0, dot(p, p), 1.5707963, 45.0);",
        // A reflection of unit vectors has unit length.
        "return lit(n, 2.0 * dot(n, p) * n - p, 0.0, x, x, x);",
        "return lit(vec3f(0.0, 0.6, 0.8), vec3f(0.577, 0.577, 0.577), 0.5, 0.0, x, 90.0);",
        "var l = p - q; l = normalize(l); return lit(n, l, 0.5, x, x, x);",
        "return near(length(p)) + near(dot(p, q));",
        "return undocumented(45.0);",
        "return cos(3.14159265) + sin(12.9898) + tan(x * 45.0);",
    ] {
        let found = lints_of(statement)?;
        if !found.is_empty() {
            return Err(format!("{statement}: {found:?}").into());
        }
    }
    Ok(())
}

/// A comment turns a lint off, on its line and on the one below, and no other lint.
fn allowed() -> Result<(), Failed> {
    for (statement, expected) in [
        ("return near(0.0); // lamplight: allow argument-range", 0),
        ("// lamplight: allow argument-range\nreturn near(0.0);", 0),
        ("// lamplight: allow argument-unit, argument-range\nreturn near(0.0);", 0),
        ("// lamplight: allow argument-unit\nreturn near(0.0);", 1),
        ("// lamplight: allow argument-range\n\nreturn near(0.0);", 1),
        ("return cos(30.0); // lamplight: allow argument-unit", 0),
    ] {
        let found = lints_of(statement)?;
        if found.len() != expected {
            return Err(format!("{statement}: {found:?}").into());
        }
    }
    Ok(())
}
