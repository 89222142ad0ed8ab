//! Types of numbers, as reflection names them.

/// A scalar, a vector or a matrix.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NumberType {
    pub is_integer: bool,
    /// 1 for a scalar and a vector.
    pub columns: usize,
    /// 1 for a scalar.
    pub rows: usize,
}

impl NumberType {
    /// The type of this name in WGSL, such as `f32`, `vec3<f32>` or `mat4x4<f32>`.
    pub fn of(ty: &str) -> Self {
        let digit = |at: usize| {
            let digit = ty.as_bytes().get(at).map_or(1, |one| usize::from(one.wrapping_sub(b'0')));
            digit.clamp(1, 4)
        };
        let is_integer = !ty.contains('f');
        let (columns, rows) = match ty {
            _ if ty.starts_with("mat") => (digit(3), digit(5)),
            _ if ty.starts_with("vec") => (1, digit(3)),
            _ => (1, 1),
        };
        Self { is_integer, columns, rows }
    }

    /// How many numbers it has.
    pub fn count(self) -> usize {
        self.columns * self.rows
    }

    pub fn is_matrix(self) -> bool {
        self.columns > 1
    }
}

/// A type as people write it: `vec3f` and not `vec3<f32>`.
pub fn short_type(ty: &str) -> String {
    let (base, scalar) = match ty.strip_suffix('>').and_then(|ty| ty.split_once('<')) {
        Some((base, scalar)) if base.starts_with("vec") || base.starts_with("mat") => {
            (base, scalar)
        }
        _ => return ty.to_owned(),
    };
    match scalar {
        "f32" | "f16" | "i32" | "u32" => {
            let letter = if scalar == "f16" { "h" } else { &scalar[..1] };
            format!("{base}{letter}")
        }
        _ => ty.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::{NumberType, short_type};

    #[test]
    fn types_of_numbers() {
        for (ty, integer, columns, rows, short) in [
            ("f32", false, 1, 1, "f32"),
            ("u32", true, 1, 1, "u32"),
            ("vec3<f32>", false, 1, 3, "vec3f"),
            ("vec2<i32>", true, 1, 2, "vec2i"),
            ("mat4x3<f32>", false, 4, 3, "mat4x3f"),
            ("texture_2d<f32>", false, 1, 1, "texture_2d<f32>"),
        ] {
            let expected = NumberType { is_integer: integer, columns, rows };
            assert_eq!(NumberType::of(ty), expected, "{ty}");
            assert_eq!(short_type(ty), short);
        }
    }
}
