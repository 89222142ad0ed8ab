//! Words of HLSL, from its grammar and the list of its intrinsic functions
//! (<https://learn.microsoft.com/windows/win32/direct3dhlsl/dx-graphics-hlsl-appendix-keywords>).

use super::super::dialect::{is_listed, is_shape};

/// Keywords and reserved words that a name in WGSL may have.
const KEYWORDS: &str = "
    AppendStructuredBuffer BlendState Buffer ByteAddressBuffer CompileShader ComputeShader
    ConsumeStructuredBuffer DepthStencilState DepthStencilView DomainShader GeometryShader Hullshader
    InputPatch LineStream NULL OutputPatch PixelShader PointStream RWBuffer RWByteAddressBuffer
    RWStructuredBuffer RWTexture1D RWTexture1DArray RWTexture2D RWTexture2DArray RWTexture3D
    RasterizerState RenderTargetView SamplerComparisonState SamplerState StructuredBuffer Texture1D
    Texture1DArray Texture2D Texture2DArray Texture2DMS Texture2DMSArray Texture3D TextureCube
    TextureCubeArray TriangleStream VertexShader asm asm_fragment auto bool break case catch cbuffer
    centroid char class column_major compile compile_fragment const const_cast continue default delete
    discard do double dword dynamic_cast else enum explicit export extern false float for friend
    fxgroup goto groupshared half if in inline inout int interface line lineadj linear long matrix
    min10float min12int min16float min16int min16uint mutable namespace new nointerpolation
    noperspective operator out packoffset pass pixelfragment point precise private protected public
    register reinterpret_cast return row_major sample sampler sampler1D sampler2D sampler3D
    samplerCUBE sampler_state shared short signed sizeof snorm stateblock stateblock_state static
    static_cast string struct switch tbuffer technique technique10 technique11 template texture
    texture1D texture2D texture3D textureCUBE this throw triangle triangleadj true try typedef typename
    uint uniform union unorm unsigned using vector vertexfragment virtual void volatile while";

/// Intrinsic functions.
const FUNCTIONS: &str = "
    D3DCOLORtoUBYTE4 EvaluateAttributeAtCentroid GetRenderTargetSampleCount abort abs acos all any
    asdouble asfloat asin asint asuint atan atan2 ceil clamp clip cos cosh countbits cross ddx
    ddx_coarse ddx_fine ddy ddy_coarse ddy_fine degrees determinant distance dot dst errorf exp exp2
    f16tof32 f32tof16 faceforward firstbithigh firstbitlow floor fma fmod frac frexp fwidth isfinite
    isinf isnan ldexp length lerp lit log log10 log2 mad max min modf msad4 mul noise normalize pow
    printf radians rcp reflect refract reversebits round rsqrt saturate select sign sin sincos sinh
    smoothstep sqrt step tan tanh tex1D tex2D tex3D texCUBE transpose trunc";

/// What the names of vectors and matrices begin with, such as `float3` and `uint2x2`, and the sizes.
const SCALARS: [&str; 7] = ["float", "int", "uint", "bool", "half", "double", "dword"];
const SIZES: [&str; 4] = ["1", "2", "3", "4"];

/// Whether a word can be no name.
pub fn is_keyword(word: &str) -> bool {
    is_listed(KEYWORDS, word) || is_shape(word, &SCALARS, &SIZES)
}

/// Whether a word is a function of the language.
pub fn is_function(word: &str) -> bool {
    is_listed(FUNCTIONS, word)
}

#[cfg(test)]
mod tests {
    use super::{is_function, is_keyword};

    #[test]
    fn words_are_known() {
        assert!(is_keyword("linear") && is_keyword("float3") && is_keyword("uint4x2"));
        assert!(is_function("lit") && is_function("dst"));
        assert!(!is_keyword("float5") && !is_keyword("roughness") && !is_function("lambert"));
    }
}
