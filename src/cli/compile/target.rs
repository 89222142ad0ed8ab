//! Targets by name.

use crate::bundle::Target;
use crate::diagnostic::nearest_name;

/// What `--target` may name.
#[derive(Debug, Clone, Copy)]
pub enum TargetChoice {
    All,
    One(Target),
}

/// The help of an option that names targets.
pub fn wanted_help() -> String {
    let names: Vec<&str> = Target::ALL.iter().map(|target| target.name()).collect();
    format!("Output languages: {}, or all of them [default: wgsl]", names.join(", "))
}

/// `all`, or a target.
pub fn wanted_one(name: &str) -> Result<TargetChoice, String> {
    if name == "all" { Ok(TargetChoice::All) } else { parse_target(name).map(TargetChoice::One) }
}

/// Every target that is wanted, once, in the order of naming.
pub fn wanted_targets(chosen: &[TargetChoice]) -> Vec<Target> {
    let mut targets: Vec<Target> = Vec::new();
    for one in chosen {
        let named = match one {
            TargetChoice::All => Target::ALL,
            TargetChoice::One(target) => std::slice::from_ref(target),
        };
        targets.extend(named.iter().filter(|target| !targets.contains(target)).collect::<Vec<_>>());
    }
    targets
}

/// The target that other tools have another name for.
fn alias_of(name: &str) -> Option<&'static str> {
    match name {
        "spv" | "spir-v" | "vulkan" => Some("spirv"),
        "metal" => Some("msl"),
        "dx12" | "d3d12" => Some("hlsl"),
        "glsl" | "opengl" | "gl" => Some("glsl450"),
        "essl" | "webgl" | "webgl2" | "gles" => Some("essl300"),
        "webgpu" => Some("wgsl"),
        _ => None,
    }
}

/// A target by name, as an option's value.
pub fn parse_target(name: &str) -> Result<Target, String> {
    Target::find(name).ok_or_else(|| {
        let names: Vec<&str> = Target::ALL.iter().map(|target| target.name()).collect();
        let hint = alias_of(name)
            .or_else(|| nearest_name(name, names.iter().copied()))
            .map_or(String::new(), |near| format!("; did you mean `{near}`?"));
        format!("no such target{hint} (targets: {})", names.join(", "))
    })
}
