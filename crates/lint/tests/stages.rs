//! Mistakes of the stages of GLSL that no front end reports.

use std::collections::BTreeMap;

use lamplight_compose::resolve::Packages;
use lamplight_diagnostic::Severity;
use lamplight_diagnostic::source::{Memory, Package, SourceSet};
use lamplight_lint::{Request, lint};
use lamplight_permute::Settings;
use libtest_mimic::{Failed, Trial};

pub fn tests() -> Vec<Trial> {
    vec![Trial::test("lint::stages_of_glsl", stages_of_glsl)]
}

/// What is found, and where.
type Finding = (Severity, &'static str);

/// A name, the text below its version, and what is found.
const STAGES: &[(&str, &str, Option<Finding>)] = &[
    ("a.vert", "void main() {}", Some((Severity::Warning, "main"))),
    ("a.vert", "void main() { gl_Position = vec4(1.0); }", None),
    (
        "a.vert",
        "shared int a;\nvoid main() { gl_Position = vec4(1.0); }",
        Some((Severity::Error, "shared")),
    ),
    ("a.frag", "shared int a;\nvoid main() {}", Some((Severity::Error, "shared"))),
    ("a.frag", "layout(shared, binding = 0) uniform A { int a; };\nvoid main() {}", None),
    ("a.vs", "void main() {}", Some((Severity::Warning, "main"))),
    ("a.comp", "shared int a;\nlayout(local_size_x = 1) in;\nvoid main() { a = 1; }", None),
    ("a.glsl", "shared int a;\nint f() { return a; }", None),
];

fn stages_of_glsl() -> Result<(), Failed> {
    for (name, text, expected) in STAGES {
        let files = BTreeMap::from([((*name).to_owned(), format!("#version 450\n{text}\n"))]);
        let files = Box::new(Memory(files));
        let packages = Packages::new(Package { name: "package".to_owned(), files }, Vec::new());
        let mut sources = SourceSet::default();
        let settings = Settings::default();
        let paths = [(*name).to_owned()];
        let request =
            Request { packages: &packages, manifest: None, settings: &settings, paths: &paths };
        let found = lint(&mut sources, &request).diagnostics;
        let listed = found.iter().map(|one| (one.severity, sources.text(one.labels[0].span)));
        let listed: Vec<_> = listed.collect();
        if listed != expected.as_slice() {
            return Err(format!("{name}: `{text}` gives {found:#?}").into());
        }
    }
    Ok(())
}
