//! Writes a module for every kind of target, with an entry point that calls every function.

use std::collections::BTreeMap;

use libtest_mimic::Failed;
use naga::back::{glsl, hlsl, msl, spv};
use naga::proc::BoundsCheckPolicies;
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use naga::{Module, ShaderStage};

/// The versions of GLSL that naga writes.
pub const VERSIONS: [glsl::Version; 4] = [
    glsl::Version::Desktop(330),
    glsl::Version::Desktop(450),
    glsl::Version::new_gles(300),
    glsl::Version::new_gles(310),
];

/// Writes a module, given as WGSL, for every kind of target. Gives the texts of [`VERSIONS`].
pub fn emits(text: &str) -> Result<[String; VERSIONS.len()], Failed> {
    let module = naga::front::wgsl::parse_str(text).map_err(|error| error.emit_to_string(text))?;
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .map_err(|error| format!("{error:?}"))?;
    spv::write_vec(&module, &info, &spv::Options::default(), None)?;
    let options = msl::Options { fake_missing_bindings: true, ..Default::default() };
    msl::write_string(&module, &info, &options, &msl::PipelineOptions::default())?;
    let mut hlsl = String::new();
    hlsl::Writer::new(&mut hlsl, &hlsl::Options::default(), &hlsl::PipelineOptions::default())
        .write(&module, &info, None)?;
    let mut texts = VERSIONS.map(|_| String::new());
    for (text, version) in texts.iter_mut().zip(VERSIONS) {
        *text = write_glsl(&module, &info, version)?;
    }
    Ok(texts)
}

fn write_glsl(
    module: &Module,
    info: &ModuleInfo,
    version: glsl::Version,
) -> Result<String, Failed> {
    let options = glsl::Options { version, ..Default::default() };
    let pipeline = glsl::PipelineOptions {
        shader_stage: ShaderStage::Fragment,
        entry_point: "main".into(),
        multiview: None,
    };
    let mut text = String::new();
    glsl::Writer::new(
        &mut text,
        module,
        info,
        &options,
        &pipeline,
        BoundsCheckPolicies::default(),
    )?
    .write()?;
    Ok(text)
}

/// An entry point that calls each function with zeros, or with textures and samplers.
pub fn entry(functions: &[(String, Vec<String>)]) -> String {
    let mut resources = BTreeMap::new();
    let mut calls = String::new();
    for (name, types) in functions {
        let arguments: Vec<String> = types
            .iter()
            .enumerate()
            .map(|(index, ty)| argument(ty, index, &mut resources))
            .collect();
        calls += &format!("    _ = {name}({});\n", arguments.join(", "));
    }
    let declared = resources
        .iter()
        .enumerate()
        .map(|(binding, (name, ty))| format!("@group(0) @binding({binding}) var {name}: {ty};\n"));
    format!(
        "{}@fragment\nfn main() -> @location(0) vec4f {{\n{calls}    return vec4f();\n}}\n",
        declared.collect::<String>()
    )
}

/// A zero, or the name of a texture or sampler. Each position in a list of parameters has its own,
/// because GL pairs each texture with only one sampler.
fn argument(ty: &str, index: usize, resources: &mut BTreeMap<String, String>) -> String {
    if !ty.starts_with("texture") && !ty.starts_with("sampler") {
        return format!("{ty}()");
    }
    let name = format!(
        "resource_{index}_{}",
        ty.replace(|letter: char| !letter.is_ascii_alphanumeric(), "_")
    );
    resources.insert(name.clone(), ty.to_owned());
    name
}
