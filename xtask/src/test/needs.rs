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
    ("dap", &["nodejs", "npm"]),
    ("determinism", &[]),
    ("diagnostics", &[]),
    ("differential", &[]),
    ("emit", VALIDATORS),
    ("energy", &[]),
    ("heat", &[]),
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
    ("spirv_forms", VALIDATORS),
    ("tables", &[]),
    ("three", &["nodejs", "npm", "chromium"]),
    ("traps", &[]),
    ("vite", &["nodejs", "npm", "chromium"]),
];

/// Packages below `crates/` whose own tests need more than the repository: their readers and bindings
/// are compiled and run.
const OF_PACKAGES: &[(&str, &[&str])] = &[
    ("lamplight-bundle", &["gcc", "g++", "clang", "nodejs"]),
    ("lamplight-keys", &["gcc", "g++", "clang"]),
];

/// What the packages of some binaries need for their own tests.
pub fn of_packages<'a>(
    binaries: impl IntoIterator<Item = &'a TestBinary>,
) -> impl Iterator<Item = &'static str> {
    let packages = binaries.into_iter().filter_map(|binary| {
        OF_PACKAGES.iter().find(|(name, _)| *name == binary.package).map(|(_, needed)| *needed)
    });
    packages.flatten().copied()
}

/// The packages that the groups of some binaries need; `None` if that is every one.
pub fn of_groups(binaries: &[TestBinary]) -> Option<Vec<&'static str>> {
    let mut needed = Vec::new();
    for binary in binaries.iter().filter(|binary| binary.package == "lamplight") {
        for group in &binary.groups {
            let (_, packages) = OF_GROUPS.iter().find(|(name, _)| name == group)?;
            needed.extend_from_slice(packages);
        }
    }
    needed.extend(of_packages(binaries));
    Some(needed)
}
