//! naga's HLSL stores to a matrix of two rows within a structure by a function of its own, which
//! takes the structure by value: the store is lost. Here the structure is passed to be changed.

/// How these functions begin: no name of an author's does in HLSL.
const START: &str = "void SetMat";
/// The structure, in the list of parameters.
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
