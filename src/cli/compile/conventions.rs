//! The options for conventions of outputs.

use crate::bundle::{BoundsChecks, ClipConvention, Convention, RequestedConventions};

#[derive(Debug, Clone, Copy, clap::Args)]
pub struct ConventionArguments {
    /// Clip space: `wgpu`, the same for all targets, or `native`, as each API has it [default: that
    /// of the program in the manifest, or else `wgpu`].
    #[arg(long, value_name = "SPACE", value_parser = parse_convention::<ClipConvention>)]
    clip: Option<ClipConvention>,
    /// Checks: `restrict` clamps indices and coordinates and ends endless loops, `unchecked` adds
    /// nothing [default: those of the program in the manifest, or else `unchecked`].
    #[arg(long, value_name = "CHECKS", value_parser = parse_convention::<BoundsChecks>)]
    bounds: Option<BoundsChecks>,
}

impl ConventionArguments {
    pub fn chosen(self) -> RequestedConventions {
        RequestedConventions { clip: self.clip, bounds: self.bounds }
    }
}

/// A convention by name, as an option's value.
fn parse_convention<C: Convention>(name: &str) -> Result<C, String> {
    C::find(name).ok_or_else(|| {
        let names: Vec<&str> = C::names().collect();
        format!("expected one of: {}", names.join(", "))
    })
}
