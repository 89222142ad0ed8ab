//! The options for conventions of outputs.

use crate::bundle::{
    BoundsChecks, ClipConvention, Convention, RequestedConventions, SourceClip, SpirvForm,
};

#[derive(Debug, Clone, Copy, clap::Args)]
pub struct ConventionArguments {
    /// Clip space: `wgpu`, the same for all targets, or `native`, as each API has it [default: that
    /// of the program in the manifest, or else `wgpu`].
    #[arg(long, value_name = "SPACE", value_parser = parse_convention::<ClipConvention>)]
    clip: Option<ClipConvention>,
    /// Clip space of vertex shaders in GLSL: `opengl`, `vulkan`, `webgpu`, or `auto`, which is
    /// `opengl` for versions below 4.50 without features of Vulkan, else `webgpu` [default: that of
    /// the program in the manifest, or else `auto`].
    #[arg(long, value_name = "SPACE", value_parser = parse_convention::<SourceClip>)]
    source_clip: Option<SourceClip>,
    /// Checks: `restrict` clamps indices and coordinates and ends endless loops, `unchecked` adds
    /// nothing [default: those of the program in the manifest, or else `unchecked`].
    #[arg(long, value_name = "CHECKS", value_parser = parse_convention::<BoundsChecks>)]
    bounds: Option<BoundsChecks>,
}

impl ConventionArguments {
    pub fn chosen(self) -> RequestedConventions {
        let Self { clip, source_clip, bounds } = self;
        RequestedConventions { clip, source_clip, bounds, spirv: None }
    }
}

/// The option for the form of SPIR-V, of commands that write outputs.
#[derive(Debug, Clone, Copy, clap::Args)]
pub struct SpirvArguments {
    /// SPIR-V with `names` for debuggers, `stripped` of them, or also `optimised` by `spirv-opt`,
    /// which must be installed [default: that of the program in the manifest, or else `names`].
    #[arg(long, value_name = "FORM", value_parser = parse_convention::<SpirvForm>)]
    spirv: Option<SpirvForm>,
}

impl SpirvArguments {
    /// All conventions that are asked for.
    pub fn with(self, others: ConventionArguments) -> RequestedConventions {
        RequestedConventions { spirv: self.spirv, ..others.chosen() }
    }
}

/// A convention by name, as an option's value.
pub fn parse_convention<C: Convention>(name: &str) -> Result<C, String> {
    C::find(name).ok_or_else(|| {
        let names: Vec<&str> = C::names().collect();
        format!("expected one of: {}", names.join(", "))
    })
}
