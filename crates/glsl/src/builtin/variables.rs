//! Variables and constants of the language.

use crate::tree::Stage;

/// What a variable of the language is in WGSL.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Meaning {
    /// A built-in value of that name and type.
    Value(&'static str, &'static str),
    /// An output that has no word in WGSL and is only reported.
    Dropped(&'static str),
    /// The output with that location: `gl_FragColor`, `gl_FragData`.
    Color,
    /// Refused, for the reason.
    Refused(&'static str),
}

/// A variable of the language.
#[derive(Debug, PartialEq, Eq)]
pub struct Builtin {
    /// Its name.
    pub name: &'static str,
    /// Its type in GLSL.
    pub ty: &'static str,
    /// `Some(0)` for an array whose size the text decides.
    pub array: Option<u32>,
    /// The stage that has it.
    pub stage: Stage,
    /// Whether the stage writes it.
    pub output: bool,
    /// What it is in WGSL.
    pub meaning: Meaning,
}

const fn input(
    stage: Stage,
    name: &'static str,
    ty: &'static str,
    value: &'static str,
    wgsl: &'static str,
) -> Builtin {
    let meaning = Meaning::Value(value, wgsl);
    Builtin { name, ty, array: None, stage, output: false, meaning }
}

const fn output(
    stage: Stage,
    name: &'static str,
    ty: &'static str,
    array: Option<u32>,
    meaning: Meaning,
) -> Builtin {
    Builtin { name, ty, array, stage, output: true, meaning }
}

const fn refused(
    stage: Stage,
    name: &'static str,
    ty: &'static str,
    array: Option<u32>,
    reason: &'static str,
) -> Builtin {
    Builtin { name, ty, array, stage, output: false, meaning: Meaning::Refused(reason) }
}

use Stage::{Compute, Fragment, Vertex};

const NO_WORD: &str = "WGSL has no word for it";
const COMPATIBILITY: &str = "it belongs to the compatibility profile";

/// All of them.
pub static BUILTINS: &[Builtin] = &[
    output(Vertex, "gl_Position", "vec4", None, Meaning::Value("position", "vec4f")),
    output(Vertex, "gl_PointSize", "float", None, Meaning::Dropped("point_size")),
    output(
        Vertex,
        "gl_ClipDistance",
        "float",
        Some(0),
        Meaning::Value("clip_distances", "array<f32>"),
    ),
    output(Vertex, "gl_CullDistance", "float", Some(0), Meaning::Dropped("cull_distance")),
    input(Vertex, "gl_VertexIndex", "int", "vertex_index", "u32"),
    input(Vertex, "gl_VertexID", "int", "vertex_index", "u32"),
    input(Vertex, "gl_InstanceIndex", "int", "instance_index", "u32"),
    input(Vertex, "gl_InstanceID", "int", "instance_index", "u32"),
    refused(Vertex, "gl_BaseVertex", "int", None, NO_WORD),
    refused(Vertex, "gl_BaseInstance", "int", None, NO_WORD),
    refused(Vertex, "gl_DrawID", "int", None, NO_WORD),
    refused(Vertex, "gl_DrawIDARB", "int", None, NO_WORD),
    refused(Vertex, "gl_BaseVertexARB", "int", None, NO_WORD),
    refused(Vertex, "gl_BaseInstanceARB", "int", None, NO_WORD),
    refused(Vertex, "gl_ViewIndex", "int", None, NO_WORD),
    refused(Vertex, "gl_Layer", "int", None, NO_WORD),
    refused(Vertex, "gl_ViewportIndex", "int", None, NO_WORD),
    refused(Vertex, "gl_Vertex", "vec4", None, COMPATIBILITY),
    refused(Vertex, "gl_Normal", "vec3", None, COMPATIBILITY),
    refused(Vertex, "gl_Color", "vec4", None, COMPATIBILITY),
    refused(Vertex, "gl_MultiTexCoord0", "vec4", None, COMPATIBILITY),
    refused(Vertex, "gl_ModelViewMatrix", "mat4", None, COMPATIBILITY),
    refused(Vertex, "gl_ProjectionMatrix", "mat4", None, COMPATIBILITY),
    refused(Vertex, "gl_ModelViewProjectionMatrix", "mat4", None, COMPATIBILITY),
    refused(Vertex, "gl_NormalMatrix", "mat3", None, COMPATIBILITY),
    refused(Vertex, "gl_TexCoord", "vec4", Some(8), COMPATIBILITY),
    input(Fragment, "gl_FragCoord", "vec4", "position", "vec4f"),
    input(Fragment, "gl_FrontFacing", "bool", "front_facing", "bool"),
    input(Fragment, "gl_SampleID", "int", "sample_index", "u32"),
    input(Fragment, "gl_SampleMaskIn", "int", "sample_mask", "u32"),
    output(Fragment, "gl_FragDepth", "float", None, Meaning::Value("frag_depth", "f32")),
    output(Fragment, "gl_FragDepthEXT", "float", None, Meaning::Value("frag_depth", "f32")),
    output(Fragment, "gl_SampleMask", "int", Some(1), Meaning::Value("sample_mask", "u32")),
    output(Fragment, "gl_FragColor", "vec4", None, Meaning::Color),
    output(Fragment, "gl_FragData", "vec4", Some(8), Meaning::Color),
    refused(Fragment, "gl_PointCoord", "vec2", None, NO_WORD),
    refused(Fragment, "gl_SamplePosition", "vec2", None, NO_WORD),
    refused(Fragment, "gl_PrimitiveID", "int", None, NO_WORD),
    refused(Fragment, "gl_Layer", "int", None, NO_WORD),
    refused(Fragment, "gl_ViewportIndex", "int", None, NO_WORD),
    refused(Fragment, "gl_ViewIndex", "int", None, NO_WORD),
    refused(Fragment, "gl_HelperInvocation", "bool", None, NO_WORD),
    refused(Fragment, "gl_ClipDistance", "float", Some(8), NO_WORD),
    refused(Fragment, "gl_CullDistance", "float", Some(8), NO_WORD),
    refused(Fragment, "gl_Color", "vec4", None, COMPATIBILITY),
    refused(Fragment, "gl_TexCoord", "vec4", Some(8), COMPATIBILITY),
    input(Compute, "gl_NumWorkGroups", "uvec3", "num_workgroups", "vec3u"),
    input(Compute, "gl_WorkGroupID", "uvec3", "workgroup_id", "vec3u"),
    input(Compute, "gl_LocalInvocationID", "uvec3", "local_invocation_id", "vec3u"),
    input(Compute, "gl_GlobalInvocationID", "uvec3", "global_invocation_id", "vec3u"),
    input(Compute, "gl_LocalInvocationIndex", "uint", "local_invocation_index", "u32"),
    refused(Compute, "gl_SubgroupSize", "uint", None, "subgroups are not translated"),
    refused(Compute, "gl_SubgroupInvocationID", "uint", None, "subgroups are not translated"),
    refused(Compute, "gl_SubgroupID", "uint", None, "subgroups are not translated"),
    refused(Compute, "gl_NumSubgroups", "uint", None, "subgroups are not translated"),
];

/// The variable of that name in a stage.
pub fn find_builtin(name: &str, stage: Stage) -> Option<&'static Builtin> {
    BUILTINS.iter().find(|builtin| builtin.name == name && builtin.stage == stage)
}

/// Constants of the implementation, with the smallest values that the specifications allow.
pub const CONSTANTS: &[(&str, i32)] = &[
    ("gl_MaxVertexAttribs", 16),
    ("gl_MaxVertexUniformVectors", 256),
    ("gl_MaxVertexUniformComponents", 1024),
    ("gl_MaxVertexOutputComponents", 64),
    ("gl_MaxVaryingVectors", 15),
    ("gl_MaxVaryingComponents", 60),
    ("gl_MaxVaryingFloats", 60),
    ("gl_MaxVertexTextureImageUnits", 16),
    ("gl_MaxCombinedTextureImageUnits", 80),
    ("gl_MaxTextureImageUnits", 16),
    ("gl_MaxFragmentUniformVectors", 224),
    ("gl_MaxFragmentUniformComponents", 1024),
    ("gl_MaxFragmentInputComponents", 128),
    ("gl_MaxDrawBuffers", 8),
    ("gl_MaxClipDistances", 8),
    ("gl_MaxCullDistances", 8),
    ("gl_MaxSamples", 4),
    ("gl_MinProgramTexelOffset", -8),
    ("gl_MaxProgramTexelOffset", 7),
    ("gl_MaxImageUnits", 8),
];
