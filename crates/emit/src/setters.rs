//! Repairs stores to matrices of two rows within structures and arrays. For these, naga's HLSL
//! calls functions that take what they change by value, so the store is lost. Here that becomes an
//! `inout` parameter.
//!
//! naga writes such functions too for a structure that is only in a buffer of bytes. Nothing calls
//! them, and the structure is not declared, so they are left out.

/// How the declarations of these functions begin, and the parameter that they change. In HLSL no
/// author's name begins like theirs.
const SETTERS: [(&str, &str); 3] = [
    ("void SetMat", " obj, "),
    ("void __set_col_of_mat", " mat, "),
    ("void __set_el_of_mat", " mat, "),
];

/// The text with `inout` before the first parameter of these functions, which they change.
pub fn by_reference(text: &str) -> String {
    if !SETTERS.iter().any(|(start, _)| text.contains(start)) {
        return text.to_owned();
    }
    let mut changed = String::with_capacity(text.len());
    for line in text.split_inclusive('\n') {
        let setter = SETTERS.iter().find(|(start, _)| line.starts_with(start));
        match setter.and_then(|(_, object)| Some((line.split_once('(')?, object))) {
            Some(((name, rest), object)) if rest.contains(object) => {
                changed.push_str(name);
                changed.push_str("(inout ");
                changed.push_str(rest);
            }
            _ => changed.push_str(line),
        }
    }
    changed
}

/// The text without functions on matrices of structures that it does not declare.
pub fn without_undeclared(text: &str) -> String {
    let is_undeclared =
        |line: &str| parent(line).is_some_and(|name| !text.contains(&format!("struct {name} {{")));
    if !text.lines().any(is_undeclared) {
        return text.to_owned();
    }
    let (mut changed, mut is_left_out) = (String::with_capacity(text.len()), false);
    for line in text.split_inclusive('\n') {
        is_left_out |= is_undeclared(line);
        if !is_left_out {
            changed += line;
        }
        is_left_out &= !line.starts_with('}');
    }
    changed
}

/// The structure that a function reads or changes a matrix of, if the line begins such a function.
fn parent(line: &str) -> Option<&str> {
    let (head, parameters) = line.split_once('(')?;
    let (_, name) = head.split_once(' ')?;
    if !name.starts_with("GetMat") && !name.starts_with("SetMat") {
        return None;
    }
    let (ty, rest) = parameters.trim_start_matches("inout ").split_once(' ')?;
    rest.starts_with("obj").then_some(ty)
}

#[cfg(test)]
mod tests {
    use super::without_undeclared;

    #[test]
    fn functions_of_undeclared_structures_are_left_out() {
        let kept = "struct Cell {\n    int a;\n};\n\nfloat2x2 GetMata_OnCell(Cell obj) {\n    return x;\n}\n";
        let lost = "void SetMata_OnData(inout Data obj, float2x2 mat) {\n    if (x) {\n    }\n}\n";
        assert_eq!(without_undeclared(&format!("{kept}{lost}")), kept);
    }
}
