//! Writes arrays and matrices of zeros in HLSL.
//!
//! naga writes an array of zeros as `(float3[9])0`. fxc and dxc accept that, glslang does not. All
//! three accept a list of elements where a variable is declared, and assignments to elements.
//!
//! It writes a matrix of zeros as `(float3x3)0`. glslang 12 takes the numbers of that from memory
//! that it has not written: some became infinities. `(float3x3)0.0` is right in all three.

/// The most elements for which a list is written.
const MOST_LISTED: usize = 1024;

/// The text without casts of a number to an array.
pub fn without_casts(text: &str) -> String {
    let line = |line: &str| {
        let changed = zero_declaration(line).or_else(|| zero_assignment(line));
        changed.or_else(|| zero_return(line)).unwrap_or_else(|| line.to_owned())
    };
    if text.contains("])0;") {
        text.split_inclusive('\n').map(line).collect()
    } else {
        text.to_owned()
    }
}

/// The text with a float for each integer that is cast to a matrix.
pub fn with_float_zeros(text: &str) -> String {
    let mut pieces = text.split(")0");
    let mut out = pieces.next().unwrap_or_default().to_owned();
    for piece in pieces {
        let is_number = piece.starts_with(|next: char| next == '.' || next.is_alphanumeric());
        let is_matrix = !is_number && ends_with_matrix(&out);
        out.push_str(if is_matrix { ")0.0" } else { ")0" });
        out.push_str(piece);
    }
    out
}

/// Whether a text ends with `(float4x3` or another matrix after a bracket.
fn ends_with_matrix(text: &str) -> bool {
    let Some((_, ty)) = text.rsplit_once('(') else { return false };
    let letters = ty.trim_end_matches(|letter: char| letter.is_ascii_digit() || letter == 'x');
    let [columns, b'x', rows] = ty.as_bytes()[letters.len()..] else { return false };
    let is_size = |size: u8| (b'2'..=b'4').contains(&size);
    ["float", "half", "double"].contains(&letters) && is_size(columns) && is_size(rows)
}

/// `float3 a[2] = (float3[2])0;` with a list instead.
fn zero_declaration(line: &str) -> Option<String> {
    let (declaration, cast) = line.split_once(" = (")?;
    let zeros = Zeros::read(cast)?;
    if !declaration.ends_with(']') {
        return None;
    }
    let indent = &line[..line.len() - line.trim_start().len()];
    let name = declaration.split_whitespace().last()?.split('[').next()?;
    Some(match zeros.list() {
        Some(list) => format!("{declaration} = {list};{}", zeros.end),
        // Static variables are zero unless they are given a value.
        None if declaration.starts_with("static ") => format!("{declaration};{}", zeros.end),
        None => format!("{declaration};\n{}{}", zeros.assigned(indent, name), zeros.end),
    })
}

/// `a = (float3[2])0;` with assignments to elements instead. So naga clears what a workgroup shares.
fn zero_assignment(line: &str) -> Option<String> {
    let (variable, cast) = line.split_once(" = (")?;
    let zeros = Zeros::read(cast)?;
    let name = variable.trim_start();
    let indent = &variable[..variable.len() - name.len()];
    let is_name = name.chars().all(|letter| letter == '_' || letter.is_alphanumeric());
    is_name.then(|| format!("{}{}", zeros.assigned(indent, name), zeros.end))
}

/// `return (float3[2])0;` with a variable that is returned instead.
fn zero_return(line: &str) -> Option<String> {
    let (indent, cast) = line.split_once("return (")?;
    let zeros = Zeros::read(cast)?;
    let sizes: String = zeros.sizes.iter().map(|size| format!("[{size}]")).collect();
    let declaration = format!("{indent}{} zeros{sizes}", zeros.element);
    let filled = match zeros.list() {
        Some(list) => format!("{declaration} = {list};\n"),
        None => format!("{declaration};\n{}\n", zeros.assigned(indent, "zeros")),
    };
    Some(format!("{filled}{indent}return zeros;{}", zeros.end))
}

/// An array of zeros.
struct Zeros<'t> {
    element: &'t str,
    /// The outermost size first.
    sizes: Vec<usize>,
    /// What follows the semicolon.
    end: &'t str,
}

impl<'t> Zeros<'t> {
    /// Reads `float3[2])0;`.
    fn read(cast: &'t str) -> Option<Self> {
        let (ty, end) = cast.split_once(")0;")?;
        let (element, sizes) = ty.split_at(ty.find('[')?);
        let sizes = sizes.strip_prefix('[')?.strip_suffix(']')?.split("][");
        let sizes = sizes.map(|size| size.parse().ok()).collect::<Option<_>>()?;
        Some(Self { element, sizes, end })
    }

    fn list(&self) -> Option<String> {
        let multiply = |count: usize, size: &usize| count.checked_mul(*size);
        let count = self.sizes.iter().try_fold(1, multiply)?;
        let zero = format!("({})0", self.element);
        let nest = |inner: String, size: &usize| format!("{{ {} }}", vec![inner; *size].join(", "));
        (count <= MOST_LISTED).then(|| self.sizes.iter().rev().fold(zero, nest))
    }

    /// A loop that assigns to the elements. Its counter cannot clash: naga writes no name that ends
    /// with the digit 0.
    fn assigned(&self, indent: &str, name: &str) -> String {
        let counters = |at: usize| format!("zero_{at}_0");
        let head = |(at, size): (usize, &usize)| {
            let counter = counters(at);
            format!("for (uint {counter} = 0u; {counter} < {size}u; {counter}++) ")
        };
        let heads: String = self.sizes.iter().enumerate().map(head).collect();
        let place: String = (0..self.sizes.len()).map(|at| format!("[{}]", counters(at))).collect();
        format!("{indent}{heads}{{ {name}{place} = ({})0; }}", self.element)
    }
}

#[cfg(test)]
mod tests {
    use super::with_float_zeros;

    #[test]
    fn only_matrices_have_floats() {
        let text = "float2x2 a = (float2x2)0;\nS b = { (half4x3)0, (float4)0, (float2x2)0 };\n";
        let wanted =
            "float2x2 a = (float2x2)0.0;\nS b = { (half4x3)0.0, (float4)0, (float2x2)0.0 };\n";
        assert_eq!(with_float_zeros(text), wanted);
        for same in ["(float2x2)0.5", "(my_float2x2)0", "f(float2x2)0u", "(float5x2)0", ")0", ""] {
            assert_eq!(with_float_zeros(same), same);
        }
    }
}
