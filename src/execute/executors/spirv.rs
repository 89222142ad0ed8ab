//! Runs the emitted SPIR-V unchanged, on the driver of `vulkan`. Files of bundles are drawn on
//! SwiftShader.
//!
//! Runs on: every system but WebAssembly

use super::{Entry, Shipping, swiftshader};
use crate::bundle::Target;
use crate::execute::gpu::{Named, Shaders};

pub const EXECUTOR: Entry = Entry {
    name: "spirv",
    about: "the emitted SPIR-V as it is, on Vulkan, Mesa's lavapipe preferred",
    needs: &["mesa-vulkan-drivers", "libvulkan1"],
    before_threads: None,
    samples: None,
    open: || super::open_vulkan(Named::Without(swiftshader::NAME), Shaders::Emitted(Target::SPIRV)),
    shipping: Some(Shipping {
        target: Target::SPIRV,
        // lavapipe crashes where a stage has four uniform blocks.
        open: || {
            swiftshader::installed()?;
            super::open_vulkan(Named::With(swiftshader::NAME), Shaders::Emitted(Target::SPIRV))
        },
    }),
};
