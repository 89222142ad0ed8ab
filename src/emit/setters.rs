//! Repairs stores to matrices of two rows within structures. For these, naga's HLSL calls a
//! function that takes the structure by value, so the store is lost. Here the structure becomes an
//! `inout` parameter.

/// How the names of these functions begin. No name of an author's begins so in HLSL.
const START: &str = "void SetMat";
/// The parameter with the structure.
const OBJECT: &str = " obj, ";

/// The text with structures passed by reference to the functions that change them.
pub fn by_reference(text: &str) -> String {
    if !text.contains(START) {
        return text.to_owned();
    }
    let mut changed = String::with_capacity(text.len());
    for line in text.split_inclusive('\n') {
        match line.split_once('(').filter(|(name, _)| name.starts_with(START)) {
            Some((name, rest)) if rest.contains(OBJECT) => {
                changed.push_str(name);
                changed.push_str("(inout ");
                changed.push_str(rest);
            }
            _ => changed.push_str(line),
        }
    }
    changed
}
