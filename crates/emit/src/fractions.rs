//! `modf` of `f16`, in Metal. naga declares its function for `float`, which neither takes nor makes
//! what stands in the structure for `half`.

/// What the name of the structure begins with, and what of an `f16` it ends with.
const RESULT: &str = "_modf_result_";
const HALVES: &str = "f16_ naga_modf(";

/// The text with the functions for `f16` in its own type.
pub fn with_halves(text: &str) -> String {
    if !text.contains(HALVES) {
        return text.to_owned();
    }
    let mut is_within = false;
    let one = |line: &str| {
        is_within |= line.starts_with(RESULT) && line.contains(HALVES);
        let changed = match is_within {
            true => line.replace("float", "half"),
            false => line.to_owned(),
        };
        is_within &= !line.starts_with('}');
        changed
    };
    text.split_inclusive('\n').map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_functions_of_halves_change() {
        let one = |result: &str, ty: &str| {
            format!(
                "{result} naga_modf(metal::{ty}2 arg) {{\n    metal::{ty}2 other;\n    \
                 return {result}{{ arg, other }};\n}}\nfloat f() {{\n}}\n"
            )
        };
        let (halves, floats) = ("_modf_result_vec2_f16_", "_modf_result_vec2_f32_");
        let text = one(halves, "float") + &one(floats, "float");
        assert_eq!(with_halves(&text), one(halves, "half") + &one(floats, "float"));
    }
}
