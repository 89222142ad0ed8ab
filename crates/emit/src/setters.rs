//! Repairs stores to matrices of two rows within structures and arrays. For these, naga's HLSL
//! calls functions that take what they change by value, so the store is lost. Here that becomes an
//! `inout` parameter.

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
