//! Bounds the size of constants.
//!
//! naga copies the whole value of a constant to every place that names it. So a chain of constants,
//! each of which names the one before twice, grows exponentially. Here the words of each constant
//! are counted, and the counts of the constants that it names are added.

use std::collections::HashMap;

use super::limits::Excess;
use lamplight_bundle::Language;
use lamplight_files::limits::{CONSTANT_PARTS, CONSTANT_USES};
use lamplight_syntax::words::{Lexeme, LexemeKind, Word, pieces, words};

/// A constant: its name, the names that it uses, and how many words it has itself.
struct SizedConstant<'a> {
    name: &'a str,
    uses: Vec<&'a str>,
    own: u64,
    offset: usize,
    /// Whether it is outside of functions, where the order does not matter.
    is_global: bool,
}

/// The first place where constants exceed their bounds, divided by `part`.
pub fn scan_constants(text: &str, language: Language, part: u64) -> Option<Excess> {
    let (most_parts, most_uses) = (CONSTANT_PARTS / part, CONSTANT_USES / part);
    let constants = find_constants(text, language);
    // A single constant cannot multiply anything.
    if constants.len() < 2 {
        return None;
    }
    let costs = match constant_costs(&constants, most_parts) {
        Ok(costs) => costs,
        Err(offset) => {
            let limit = most_parts as usize;
            return Some(Excess { offset, what: "parts in one constant", limit });
        }
    };
    let mut uses = 0u64;
    for Word { text: word, at: offset, .. } in words(text) {
        let cost = costs.get(word).copied().unwrap_or(0);
        uses = uses.saturating_add(if cost > 1 { cost } else { 0 });
        if uses > most_uses {
            let what = "parts of constants, wherever they are named";
            return Some(Excess { offset, what, limit: most_uses as usize });
        }
    }
    None
}

/// The size of every constant, by name; or the place of one that is too large.
fn constant_costs<'a>(
    constants: &[SizedConstant<'a>],
    most: u64,
) -> Result<HashMap<&'a str, u64>, usize> {
    let mut costs: HashMap<&str, u64> = HashMap::new();
    let globals: HashMap<&str, usize> = (0..constants.len())
        .filter(|index| constants[*index].is_global)
        .map(|index| (constants[index].name, index))
        .collect();
    for index in use_order(constants, &globals) {
        add_cost(&constants[index], &mut costs, most)?;
    }
    for constant in constants.iter().filter(|constant| !constant.is_global) {
        add_cost(constant, &mut costs, most)?;
    }
    Ok(costs)
}

/// Adds a size. Local constants of several functions may share a name, for which the largest
/// counts.
fn add_cost<'a>(
    constant: &SizedConstant<'a>,
    costs: &mut HashMap<&'a str, u64>,
    most: u64,
) -> Result<(), usize> {
    let used = constant.uses.iter().map(|name| costs.get(name).copied().unwrap_or(0));
    let cost = used.fold(constant.own, u64::saturating_add);
    if cost > most {
        return Err(constant.offset);
    }
    let known = costs.entry(constant.name).or_default();
    *known = cost.max(*known);
    Ok(())
}

/// The global constants, each after those that it names. naga itself refuses cycles.
fn use_order(constants: &[SizedConstant<'_>], globals: &HashMap<&str, usize>) -> Vec<usize> {
    let mut state = vec![0usize; constants.len()];
    let mut order = Vec::new();
    for root in (0..constants.len()).filter(|index| constants[*index].is_global) {
        let mut open = vec![root];
        while let Some(&index) = open.last() {
            // The state is one more than the number of names that were visited.
            let at = state[index];
            match constants[index].uses.get(at) {
                Some(name) => {
                    state[index] += 1;
                    let next = globals.get(name).copied();
                    open.extend(next.filter(|next| state[*next] == 0 && *next != index));
                }
                None => {
                    open.pop();
                    if at < usize::MAX {
                        state[index] = usize::MAX;
                        order.push(index);
                    }
                }
            }
        }
    }
    order
}

/// Every constant of a text. Its name is the first word in WGSL, where a type may follow it, and in
/// GLSL the last word before the `=` that is outside of brackets. Comments are not skipped, which can
/// only make the count larger.
fn find_constants(text: &str, language: Language) -> Vec<SizedConstant<'_>> {
    let mut found: Vec<SizedConstant<'_>> = Vec::new();
    let (mut depth, mut open, mut start) = (0usize, None::<SizedConstant<'_>>, 0usize);
    let mut in_value = false;
    for Lexeme { kind, text: word, at: offset } in pieces(text) {
        let here = depth.saturating_sub(start);
        match (word, &mut open) {
            ("const", None) => {
                open = Some(SizedConstant {
                    name: "",
                    uses: Vec::new(),
                    own: 1,
                    offset,
                    is_global: depth == 0,
                });
                (in_value, start) = (false, depth);
            }
            ("=", Some(_)) if here == 0 => in_value = true,
            (";", Some(_)) if here == 0 => found.extend(open.take()),
            (",", Some(constant)) if here == 0 && language == Language::Glsl && in_value => {
                let (offset, is_global) = (constant.offset, constant.is_global);
                let next = SizedConstant { name: "", uses: Vec::new(), own: 1, offset, is_global };
                found.extend(open.replace(next));
                in_value = false;
            }
            // In GLSL a parameter can be `const` too. It ends with the list of parameters.
            (")" | "}", Some(_)) if here == 0 => open = None,
            // In WGSL it may be in a type: `array<f32, 2>`.
            (",", Some(_)) if here == 0 && !in_value && language == Language::Glsl => open = None,
            ("{", Some(_)) if here == 0 && !in_value => open = None,
            (word, Some(constant)) if matches!(kind, LexemeKind::Word | LexemeKind::Number) => {
                if in_value {
                    constant.own += 1;
                    constant.uses.push(word);
                } else if here == 0 && (language == Language::Glsl || constant.name.is_empty()) {
                    constant.name = word;
                }
            }
            (",", Some(constant)) => constant.own += 1,
            _ => {}
        }
        match word {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => depth = depth.saturating_sub(1),
            _ => {}
        }
    }
    found.retain(|constant| !constant.name.is_empty());
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(text: &str, language: Language) -> Vec<&str> {
        find_constants(text, language).iter().map(|constant| constant.name).collect()
    }

    #[test]
    fn types_are_no_names() {
        let wgsl = "const a: vec2<f32> = vec2<f32>(1f); const b: array<f32, 2> = c; const d = a;";
        assert_eq!(names(wgsl, Language::Wesl), ["a", "b", "d"]);
        let glsl = "const vec2 a[2] = vec2[2](b, b), c[] = a; void f(const int d, int e) {}";
        assert_eq!(names(glsl, Language::Glsl), ["a", "c"]);
    }

    /// Constants of one type do not name each other.
    #[test]
    fn many_constants_of_a_type() {
        let line = |at: usize| format!("const a{at}: mat2x2<f32> = mat2x2<f32>(1f, 2f, 3f, 4f);\n");
        let text: String = (0..1000).map(line).collect();
        assert!(scan_constants(&text, Language::Wesl, 1).is_none());
        let chain = |at: usize| format!("const a{}: f32 = a{at} + a{at};\n", at + 1);
        let text: String = (0..40).map(chain).collect();
        assert!(
            scan_constants(&format!("const a0: f32 = 1.0;\n{text}"), Language::Wesl, 1).is_some()
        );
    }
}
