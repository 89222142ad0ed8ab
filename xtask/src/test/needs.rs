//! What the groups of tests need that is not in the repository.

use super::binaries::TestBinary;

/// Debian packages of compilers and validators of GLSL and SPIR-V.
const VALIDATORS: &[&str] = &["glslang-tools", "glslc", "spirv-tools"];

/// Groups of the root package that need less than everything, and which packages they need. A group
/// that is not listed needs every one.
const OF_GROUPS: &[(&str, &[&str])] = &[
    ("bounds", VALIDATORS),
    ("catalogue", &[]),
    ("conventions", VALIDATORS),
    ("determinism", &[]),
    ("diagnostics", &[]),
    ("differential", &[]),
    ("emit", VALIDATORS),
    ("energy", &[]),
    ("hostile", &[]),
    ("keys", &["nodejs"]),
    ("migrate", &[]),
    ("new", &[]),
    ("one_meaning", &[]),
    ("packages", &["nodejs"]),
    ("plain", &[]),
    ("programs", VALIDATORS),
    ("published", &[]),
    ("robust", &[]),
    ("scale", &[]),
    ("shaderlib", VALIDATORS),
    ("tables", &[]),
    ("traps", &[]),
];

/// The packages that the groups of some binaries need; `None` if that is every one. Packages below
/// `crates/` need none for their own tests.
pub fn of_groups(binaries: &[TestBinary]) -> Option<Vec<&'static str>> {
    let mut needed = Vec::new();
    for binary in binaries.iter().filter(|binary| binary.package == "lamplight") {
        for group in &binary.groups {
            let (_, packages) = OF_GROUPS.iter().find(|(name, _)| name == group)?;
            needed.extend_from_slice(packages);
        }
    }
    Some(needed)
}
