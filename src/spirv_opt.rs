//! `spirv-opt`, which optimises outputs in SPIR-V.

use crate::generate::Optimiser;
use crate::tools::SPIRV_OPT;

/// What the program does to a module. The passes are those for speed, of any version. The host
/// binds by number and sets constants by id, so bindings and constants stay, even if nothing uses
/// them any more.
const ARGUMENTS: &[&str] = &[
    "-O",
    "--strip-debug",
    "--compact-ids",
    "--preserve-bindings",
    "--preserve-spec-constants",
    "-",
    "-o",
    "-",
];

/// The program `spirv-opt` of this machine.
#[derive(Debug, Clone, Copy, Default)]
pub struct SpirvOpt;

impl Optimiser for SpirvOpt {
    fn version(&self) -> Result<String, String> {
        if SPIRV_OPT.path().is_none() {
            return Err(SPIRV_OPT.missing());
        }
        match SPIRV_OPT.version().trim() {
            "" => Err(format!("`{}` does not tell its version", SPIRV_OPT.program)),
            version => Ok(format!("{} {version}", SPIRV_OPT.program)),
        }
    }

    fn optimise(&self, module: &[u8]) -> Result<Vec<u8>, String> {
        SPIRV_OPT.pipe(ARGUMENTS, module)
    }
}
