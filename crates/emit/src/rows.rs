//! Arrays of matrices in HLSL. naga declares those in structures as `row_major` and all others
//! without a word, which is column-major, and assigns one to the other. Compilers for Direct3D copy
//! the numbers of such an array without turning the matrices round. So all have the word.

const SCALARS: [&str; 5] = ["float", "half", "double", "int", "uint"];
const WORD: &str = "row_major ";

/// The text in which every array of matrices is declared row by row.
pub fn with_major_rows(text: &str) -> String {
    let mut changed = String::with_capacity(text.len());
    for line in text.split_inclusive('\n') {
        let mut rest = line;
        while let Some(at) = first_array(rest) {
            let (before, after) = rest.split_at(at);
            changed += before;
            if !before.ends_with(WORD) {
                changed += WORD;
            }
            let name = after.find(' ').unwrap_or(after.len());
            changed += &after[..name];
            rest = &after[name..];
        }
        changed += rest;
    }
    changed
}

/// Where the type of the first declared array of matrices begins.
fn first_array(line: &str) -> Option<usize> {
    line.match_indices('x').find_map(|(cross, _)| {
        let is_size = |at: Option<usize>| {
            at.and_then(|at| line.as_bytes().get(at))
                .is_some_and(|byte| (b'2'..=b'4').contains(byte))
        };
        let columns = cross.checked_sub(1)?;
        if !is_size(Some(columns)) || !is_size(Some(cross + 1)) {
            return None;
        }
        // `uint` ends as `int` does.
        let start = SCALARS.iter().find_map(|scalar| {
            let start = columns.checked_sub(scalar.len())?;
            let is_whole = !line.get(..start)?.ends_with(is_word);
            (is_whole && line.get(start..columns) == Some(*scalar)).then_some(start)
        })?;
        let name = line.get(cross + 2..)?.strip_prefix(' ')?;
        let end = name.find(|c| !is_word(c)).filter(|end| *end > 0)?;
        name[end..].starts_with('[').then_some(start)
    })
}

fn is_word(c: char) -> bool {
    c == '_' || c.is_alphanumeric()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_declared_arrays_of_matrices_have_the_word() {
        for (line, expected) in [
            ("typedef float4x4 ret_C[1];\n", "typedef row_major float4x4 ret_C[1];\n"),
            ("    row_major float3x3 other[2];\n", "    row_major float3x3 other[2];\n"),
            (
                "S C(float4x4 a[1], uint2x2 b[2][3], float2x3 c) {",
                "S C(row_major float4x4 a[1], row_major uint2x2 b[2][3], float2x3 c) {",
            ),
            ("    float4x4 c[1] = e.color;", "    row_major float4x4 c[1] = e.color;"),
            ("    float3 d = mul(float3x3(a[0], a[1], a[2]), b);", ""),
            ("    Myfloat4x4 e[2]; float3 f[3x3]; float5x4 g[2];", ""),
        ] {
            let expected = if expected.is_empty() { line } else { expected };
            assert_eq!(with_major_rows(line), expected);
        }
    }
}
