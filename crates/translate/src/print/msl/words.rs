//! Words of the Metal Shading Language: those of C++14 and its own, from the specification.

use super::super::dialect::{is_listed, is_shape};

/// Keywords, types and macros that a name in WGSL may have.
const KEYWORDS: &str = "
    INFINITY M_PI_F NAN alignas alignof and and_eq array asm atomic_int atomic_uint auto bitand bitor
    bool break case catch char class compl const const_cast constant constexpr continue decltype
    default delete depth2d depth2d_array depthcube depthcube_array device do double dynamic_cast else
    enum explicit export extern false float for fragment friend goto half if inline int kernel long
    metal mutable namespace new noexcept not not_eq nullptr operator or or_eq private protected public
    ptrdiff_t register reinterpret_cast return sampler short signed size_t sizeof static static_assert
    static_cast struct switch template texture1d texture1d_array texture2d texture2d_array texture3d
    texturecube texturecube_array this thread thread_local threadgroup throw true try typedef typeid
    typename uchar uint ulong union unsigned ushort using vec vertex virtual void volatile while xor
    xor_eq";

/// Functions of the standard library, whose namespace is open.
const FUNCTIONS: &str = "
    abs absdiff access acos acosh addsat all any as_type asin asinh atan atan2 atanh bias ceil clamp
    clz copysign cos cosh cospi cross ctz degrees determinant dfdx dfdy discard_fragment distance
    distance_squared divide dot exp exp10 exp2 extract_bits fabs faceforward fdim filter floor fma fmax
    fmax3 fmedian3 fmin fmin3 fmod fract frexp fwidth gradient2d gradient3d gradientcube hadd ilogb
    insert_bits isfinite isinf isnan isnormal isordered isunordered ldexp length length_squared level
    log log10 log2 mad24 madhi madsat max max3 median3 min min3 mix modf mulhi nan norm normalize
    popcount pow powr precise quad_sum radians reflect refract reverse_bits rhadd rint rotate round
    rsqrt saturate select sign signbit simd_sum sin sincos sinh sinpi smoothstep sqrt step subsat tan
    tanh tanpi transpose trunc";

/// What the names of vectors and matrices begin with, such as `float3` and `half2x2`, and the sizes.
const SCALARS: [&str; 11] =
    ["float", "half", "int", "uint", "short", "ushort", "char", "uchar", "bool", "long", "ulong"];
const SIZES: [&str; 3] = ["2", "3", "4"];

/// Whether a word can be no name.
pub fn is_keyword(word: &str) -> bool {
    is_listed(KEYWORDS, word) || is_shape(word, &SCALARS, &SIZES)
}

/// Whether a word is a function of the standard library.
pub fn is_function(word: &str) -> bool {
    is_listed(FUNCTIONS, word)
}

#[cfg(test)]
mod tests {
    use super::{is_function, is_keyword};

    #[test]
    fn words_are_known() {
        assert!(is_keyword("thread") && is_keyword("float3") && is_keyword("half4x2"));
        assert!(is_function("rint") && is_function("level"));
        assert!(!is_keyword("float1") && !is_keyword("roughness") && !is_function("lambert"));
    }
}
