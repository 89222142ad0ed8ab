//! Runs the emitted HLSL on SwiftShader, compiled to SPIR-V by glslangValidator. Its sampler heaps
//! are arrays that are indexed with a number from a buffer, which lavapipe does not support.
//!
//! Runs on: every system but WebAssembly

use super::{ExecutorEntry, Shipping, Unavailable, swiftshader};
use crate::dispatch::ComputeForm;
use crate::Session;
use crate::gpu::{AdapterName, Shaders};
use lamplight_bundle::Target;
use lamplight_tools::{GLSLANG, SPIRV_OPT};

pub const EXECUTOR: ExecutorEntry = ExecutorEntry {
    name: "hlsl",
    about: "the emitted HLSL by way of glslangValidator's SPIR-V, on Chromium's SwiftShader",
    needs: &["glslang-tools", "spirv-tools", "chromium", "libvulkan1"],
    before_threads: Some(swiftshader::announce),
    samples: None,
    open,
    shipping: Some(Shipping { target: Target::HLSL, open }),
    reads_glsl: false,
    compute: Some(ComputeForm::Output(Target::HLSL)),
};

fn open() -> Result<Box<dyn Session>, Unavailable> {
    if let Some(tool) = [GLSLANG, SPIRV_OPT].iter().find(|tool| tool.path().is_none()) {
        return Err(format!("`{}` is not installed", tool.program).into());
    }
    swiftshader::installed()?;
    super::open_vulkan(AdapterName::With(swiftshader::NAME), Shaders::Emitted(Target::HLSL))
}
