//! Writes arrays of zeros in HLSL.
//!
//! naga writes an array of zeros as `(float3[9])0`. fxc and dxc accept that, glslang does not. All
//! three accept a list of elements where a variable is declared, and assignments to elements.

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
