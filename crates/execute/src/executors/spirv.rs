//! Runs the emitted SPIR-V unchanged, on the driver of `vulkan`. Files of bundles are drawn on
//! SwiftShader.
//!
//! Runs on: every system but WebAssembly

use super::{ExecutorEntry, Shipping, swiftshader};
use crate::dispatch::ComputeForm;
use crate::gpu::{AdapterName, Shaders};
use lamplight_bundle::Target;

pub const EXECUTOR: ExecutorEntry = ExecutorEntry {
    name: "spirv",
    about: "the emitted SPIR-V as it is, on Vulkan, Mesa's lavapipe preferred",
    needs: &["mesa-vulkan-drivers", "libvulkan1"],
    before_threads: None,
    samples: None,
    open: || {
        super::open_vulkan(AdapterName::Without(swiftshader::NAME), Shaders::Emitted(Target::SPIRV))
    },
    shipping: Some(Shipping {
        target: Target::SPIRV,
        // lavapipe crashes where a stage has four uniform blocks.
        open: || {
            swiftshader::installed()?;
            super::open_vulkan(
                AdapterName::With(swiftshader::NAME),
                Shaders::Emitted(Target::SPIRV),
            )
        },
    }),
    reads_glsl: false,
    compute: Some(ComputeForm::Output(Target::SPIRV)),
};
