//! What capabilities instructions need, and what extensions those come from.

use std::collections::BTreeSet;

use super::operands::Inst;
use lamplight_emit::spirv::op;

/// The capability that every graphics module has.
pub const SHADER: u32 = 1;
pub const STORAGE_IMAGE_WRITE_WITHOUT_FORMAT: u32 = 56;
const STORAGE_IMAGE_EXTENDED_FORMATS: u32 = 49;
/// The decoration `BuiltIn`, whose operand names the built-in variable.
const BUILT_IN: u32 = 11;

/// For each capability that needs an extension, the extension.
const EXTENSIONS: [(u32, &str); 7] = [
    (4427, "SPV_KHR_shader_draw_parameters"),
    (4439, "SPV_KHR_multiview"),
    (5284, "SPV_KHR_fragment_shader_barycentric"),
    (5301, "SPV_EXT_descriptor_indexing"),
    (5379, "SPV_EXT_demote_to_helper_invocation"),
    (6033, "SPV_EXT_shader_atomic_float_add"),
    (6019, "SPV_KHR_integer_dot_product"),
];

/// The extensions that capabilities need, sorted by name.
pub fn required_extensions(needs: &BTreeSet<u32>) -> BTreeSet<&'static str> {
    EXTENSIONS.iter().filter(|row| needs.contains(&row.0)).map(|row| row.1).collect()
}

/// Adds the capabilities that an instruction needs to `needs`. `Module::require` adds those that
/// depend on another instruction too.
pub fn require_capabilities(inst: &Inst, needs: &mut BTreeSet<u32>) -> Result<(), String> {
    match inst.op {
        op::TYPE_INT if inst.word(2)? == 8 => needs.extend([39]), // Int8
        op::TYPE_IMAGE => require_image(inst, needs)?,
        op::DECORATE => require_decoration(inst, 2, needs)?,
        op::MEMBER_DECORATE => require_decoration(inst, 3, needs)?,
        103..=107 => needs.extend([50]), // image queries: ImageQuery
        210..=215 => needs.extend([51]), // fine and coarse derivatives: DerivativeControl
        334 | 335 => needs.extend([62]), // GroupNonUniformVote
        338 | 339 => needs.extend([64]), // GroupNonUniformBallot
        345 | 346 => needs.extend([65]), // GroupNonUniformShuffle
        347 | 348 => needs.extend([66]), // GroupNonUniformShuffleRelative
        349..=364 => needs.extend([63]), // GroupNonUniformArithmetic
        365 | 366 => needs.extend([68]), // GroupNonUniformQuad
        4450 | 4451 => needs.extend([6018, 6019]), // SDot, UDot: DotProductInput4x8BitPacked, DotProduct
        5380 => needs.extend([5379]),              // DemoteToHelperInvocation
        6035 => needs.extend([6033]),              // AtomicFloat32AddEXT
        _ => {}
    }
    Ok(())
}

fn require_image(inst: &Inst, needs: &mut BTreeSet<u32>) -> Result<(), String> {
    let (dimension, arrayed, sampled, format) =
        (inst.word(3)?, inst.word(5)?, inst.word(7)?, inst.word(8)?);
    needs.extend(match (dimension, arrayed, sampled) {
        (0, _, 1) => Some(43), // Sampled1D
        (0, _, 2) => Some(44), // Image1D
        (3, 1, 1) => Some(45), // SampledCubeArray
        (3, 1, 2) => Some(34), // ImageCubeArray
        _ => None,
    });
    if sampled == 2 && matches!(format, 6..=20 | 25..=29 | 34..=39) {
        needs.insert(STORAGE_IMAGE_EXTENDED_FORMATS);
    }
    Ok(())
}

fn require_decoration(inst: &Inst, at: usize, needs: &mut BTreeSet<u32>) -> Result<(), String> {
    needs.extend(match inst.word(at)? {
        BUILT_IN => built_in(inst.word(at + 1)?),
        17 => Some(35),     // Sample: SampleRateShading
        5285 => Some(5284), // PerVertexKHR: FragmentBarycentricKHR
        5300 => Some(5301), // NonUniform: ShaderNonUniform
        _ => None,
    });
    Ok(())
}

/// The capability of a built-in variable.
fn built_in(which: u32) -> Option<u32> {
    match which {
        3 => Some(32),                 // ClipDistance
        4 => Some(33),                 // CullDistance
        7 => Some(2),                  // PrimitiveId: Geometry
        18 => Some(35),                // SampleId: SampleRateShading
        36 | 38 | 40 | 41 => Some(61), // SubgroupSize, NumSubgroups, SubgroupId, SubgroupLocalInvocationId: GroupNonUniform
        4426 => Some(4427),            // DrawIndex: DrawParameters
        4440 => Some(4439),            // ViewIndex: MultiView
        5286 | 5287 => Some(5284),     // BaryCoordKHR, BaryCoordNoPerspKHR: FragmentBarycentricKHR
        _ => None,
    }
}
