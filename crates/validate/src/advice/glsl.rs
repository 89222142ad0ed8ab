//! Advice for GLSL, whose errors are our own sentences.

use std::ops::Range;

use super::Mistake;
use super::convert::{common_operand, converted, factor_of_matrix, is_number, of_numbers};
use super::names::component_names;

/// Types of GLSL, as [`converted`] knows them, and what their constructors are called there.
const TYPES: [(&str, &str, &str); 22] = [
    ("float", "f32", "f32("),
    ("int", "i32", "i32("),
    ("uint", "u32", "u32("),
    ("bool", "bool", "bool("),
    ("vec2", "vec2<f32>", "vec2f("),
    ("vec3", "vec3<f32>", "vec3f("),
    ("vec4", "vec4<f32>", "vec4f("),
    ("ivec2", "vec2<i32>", "vec2i("),
    ("ivec3", "vec3<i32>", "vec3i("),
    ("ivec4", "vec4<i32>", "vec4i("),
    ("uvec2", "vec2<u32>", "vec2u("),
    ("uvec3", "vec3<u32>", "vec3u("),
    ("uvec4", "vec4<u32>", "vec4u("),
    ("bvec2", "vec2<bool>", "vec2<bool>("),
    ("bvec3", "vec3<bool>", "vec3<bool>("),
    ("bvec4", "vec4<bool>", "vec4<bool>("),
    ("mat2", "mat2x2<f32>", "mat2x2f("),
    ("mat3", "mat3x3<f32>", "mat3x3f("),
    ("mat4", "mat4x4<f32>", "mat4x4f("),
    ("mat4x3", "mat4x3<f32>", "mat4x3f("),
    ("mat3x4", "mat3x4<f32>", "mat3x4f("),
    ("mat2x3", "mat2x3<f32>", "mat2x3f("),
];

fn shader_type(name: &str) -> Option<&'static str> {
    TYPES.iter().find(|(glsl, ..)| *glsl == name).map(|(_, wgsl, _)| *wgsl)
}

/// A value with a conversion, as GLSL writes it.
fn as_type(value: &str, found: &str, wanted: &str) -> Option<String> {
    as_shader_type(value, found, shader_type(wanted)?)
}

fn as_shader_type(value: &str, found: &str, wanted: &str) -> Option<String> {
    let text = converted(value, shader_type(found)?, wanted)?;
    let call = TYPES.iter().find(|(.., call)| text.starts_with(call) && !value.starts_with(call));
    Some(match call {
        Some((glsl, _, call)) => format!("{glsl}({}", &text[call.len()..]),
        None => text,
    })
}

/// Adds what to write to an error about GLSL.
pub fn advise_glsl(text: &str, mistake: &mut Mistake) {
    let Some(at) = mistake.labels.first().map(|(range, _)| range.clone()) else {
        return unclosed(text, mistake);
    };
    let value = text.get(at.clone()).unwrap_or_default().to_owned();
    let message = mistake.message.clone();
    let quoted: Vec<&str> = message.split('`').skip(1).step_by(2).collect();
    match quoted.as_slice() {
        [found, wanted] if message.contains(" and should be ") => {
            write(as_type(&value, found, wanted), mistake);
        }
        [_, found] if message.starts_with("a condition is ") => {
            write(as_type(&value, found, "bool"), mistake);
        }
        [operator, left, right] if message.contains(" does not take `") => {
            operands(&value, operator, left, right, mistake);
        }
        [name] if message.contains(" does not take (") => {
            arguments(text, &value, name, &message, mistake);
        }
        [of_type, name] if message.contains(" has no components ") => {
            components(text, &at, of_type, name, mistake);
        }
        [name] if message.ends_with(" is a reserved word of GLSL") => {
            mistake.help(format!("take another name, such as `{name}_`"));
        }
        [name] if message.ends_with(", and cannot be written to") => {
            read_only(text, &at, name, &message, mistake);
        }
        [name] if message.ends_with(" is declared twice in this scope") => {
            mistake.help(format!("write `{name} = ...;` without a type, or take another name"));
        }
        [_] if message.ends_with(" calls itself") => mistake.help(
            "shaders have no recursion; write a loop: `int result = 1;` and `for (int i = 2; i <= n; \
             i++) { result *= i; }`",
        ),
        [";", ..] if message.starts_with("expected ") => semicolon(text, &at, mistake),
        [",", found] if message.starts_with("expected ") => comma(text, &at, found, mistake),
        _ => statements(text, &at, &message, &quoted, mistake),
    }
}

/// Errors about statements and declarations.
fn statements(
    text: &str,
    at: &Range<usize>,
    message: &str,
    quoted: &[&str],
    mistake: &mut Mistake,
) {
    match quoted {
        ["break", ..] => mistake.help("write `return` with a value to leave the function"),
        ["continue", ..] => mistake.help("write `return` to leave the function"),
        ["flat"] => mistake.write(flat_line(text, at)),
        ["discard"] => mistake.help("write `return` in the stages before it"),
        [name] if message.starts_with("the constant `") => {
            mistake.write(format!("{name} = ...;"));
        }
        _ if message == "a texture or sampler is not in a block" => {
            let line = line_around(text, at.start).trim();
            mistake.help(format!(
                "it is a uniform of its own: write `layout(set = 0, binding = 0) uniform {line}`"
            ));
        }
        _ if message == "the function returns a value, and this gives none" => {
            mistake.help("write a value after `return`");
        }
        _ => {}
    }
}

fn write(code: Option<String>, mistake: &mut Mistake) {
    if let Some(code) = code {
        mistake.write(code);
    }
}

/// A text in two at the last operator outside of brackets.
fn sides<'t>(text: &'t str, operator: &str) -> Option<(&'t str, &'t str)> {
    let mut depth = 0_i32;
    let mut found = None;
    for (at, letter) in text.char_indices() {
        match letter {
            '(' | '[' => depth += 1,
            ')' | ']' => depth -= 1,
            _ if depth == 0 && text[at..].starts_with(operator) => found = Some(at),
            _ => {}
        }
    }
    let at = found?;
    Some((text[..at].trim(), text[at + operator.len()..].trim()))
}

fn operands(value: &str, operator: &str, left: &str, right: &str, mistake: &mut Mistake) {
    let Some((left_text, right_text)) = sides(value, operator) else { return };
    let compared = match operator {
        "<" => Some("lessThan"),
        ">" => Some("greaterThan"),
        "<=" => Some("lessThanEqual"),
        ">=" => Some("greaterThanEqual"),
        _ => None,
    };
    if let Some(function) = compared.filter(|_| left == right && left.contains("vec")) {
        mistake.write(format!("all({function}({left_text}, {right_text}))"));
        return;
    }
    if operator == "%" {
        mistake.write(format!("mod({left_text}, {right_text})"));
        return;
    }
    let (Some(first), Some(second)) = (shader_type(left), shader_type(right)) else { return };
    if operator != "*" && (first.starts_with("mat") || second.starts_with("mat")) {
        return;
    }
    let wanted = if first.starts_with("mat") && second.starts_with("vec") {
        factor_of_matrix(first, true).map(|wanted| (false, wanted))
    } else if first.starts_with("vec") && second.starts_with("mat") {
        factor_of_matrix(second, false).map(|wanted| (true, wanted))
    } else {
        common_operand(first, second).and_then(|left_stays| {
            let (from, to) = if left_stays { (second, first) } else { (first, second) };
            let both = from.starts_with("vec") && to.starts_with("vec");
            let wanted = if both { Some(to.to_owned()) } else { of_numbers(from, to) };
            Some((!left_stays, wanted?))
        })
    };
    let Some((is_left, wanted)) = wanted else { return };
    let code = match is_left {
        true => as_shader_type(left_text, left, &wanted)
            .map(|text| format!("{text} {operator} {right_text}")),
        false => as_shader_type(right_text, right, &wanted)
            .map(|text| format!("{left_text} {operator} {text}")),
    };
    write(code, mistake);
}

/// Samplers, with the type of their coordinates.
const SAMPLERS: [(&str, &str); 5] = [
    ("sampler2D", "vec2"),
    ("sampler3D", "vec3"),
    ("samplerCube", "vec3"),
    ("sampler2DArray", "vec3"),
    ("sampler2DShadow", "vec3"),
];

/// A call of a function of the language whose arguments do not go together.
fn arguments(text: &str, call: &str, name: &str, message: &str, mistake: &mut Mistake) {
    let types = message.split_once('(').map_or("", |(_, rest)| rest.trim_end_matches(')'));
    let types: Vec<&str> = types.split(", ").collect();
    let Some(mut values) = call_arguments(call, name) else { return };
    if values.len() != types.len() {
        return;
    }
    let first = types.first().copied().unwrap_or_default();
    if let Some(of) = first.strip_prefix("texture") {
        let sampler = sampler_name(text).unwrap_or("s");
        values[0] = format!("sampler{of}({}, {sampler})", values[0]);
        mistake.help(format!(
            "a texture is looked up with a sampler: write `{name}({})`",
            values.join(", ")
        ));
        return;
    }
    if let Some((_, wanted)) = SAMPLERS.iter().find(|(known, _)| *known == first) {
        if let (Some(found), Some(value)) = (types.get(1), values.get(1).cloned())
            && let Some(code) = as_type(&value, found, wanted)
        {
            values[1] = code;
            mistake.write(format!("{name}({})", values.join(", ")));
        }
        return;
    }
    if text.contains(&format!(" {name}(")) && shader_type(first).is_none() {
        return;
    }
    let Some(smallest) = types.iter().filter(|of| of.contains("vec")).min() else { return };
    let mut changed = false;
    for (value, found) in values.iter_mut().zip(&types).filter(|(_, found)| found != &smallest) {
        if found.contains("vec")
            && let Some(code) = as_type(value, found, smallest)
        {
            (*value, changed) = (code, true);
        }
    }
    if changed {
        mistake.write(format!("{name}({})", values.join(", ")));
    }
}

/// The texts of the arguments of a call.
fn call_arguments(call: &str, name: &str) -> Option<Vec<String>> {
    let inside = call.strip_prefix(name)?.trim().strip_prefix('(')?.strip_suffix(')')?;
    let mut depth = 0_i32;
    let mut found = vec![String::new()];
    for letter in inside.chars() {
        depth += i32::from(matches!(letter, '(' | '[')) - i32::from(matches!(letter, ')' | ']'));
        match letter {
            ',' if depth == 0 => found.push(String::new()),
            _ => found.last_mut()?.push(letter),
        }
    }
    Some(found.into_iter().map(|text| text.trim().to_owned()).collect())
}

/// The first sampler that a text declares by itself.
fn sampler_name(text: &str) -> Option<&str> {
    let rest = text.split_once("uniform sampler ")?.1;
    rest.split(';').next().map(str::trim)
}

fn components(text: &str, at: &Range<usize>, of_type: &str, name: &str, mistake: &mut Mistake) {
    let before = text.get(..at.start).unwrap_or_default().trim_end().trim_end_matches('.');
    let base = crate::hints::last_word(before);
    let base = if base.is_empty() { "v" } else { base };
    let size = of_type.chars().last().and_then(|digit| digit.to_digit(10)).unwrap_or(4) as usize;
    match component_names(name, size) {
        Some(swizzle) => mistake.help(format!(
            "components are `xyzw`, `rgba` or `stpq`, not mixed: write `{base}.{swizzle}`"
        )),
        None => {
            let all: Vec<String> =
                "xyzw"[..size.min(4)].chars().map(|one| format!("`{base}.{one}`")).collect();
            mistake.help(format!("it has {}", all.join(", ")));
        }
    }
}

fn read_only(text: &str, at: &Range<usize>, name: &str, message: &str, mistake: &mut Mistake) {
    // A member of a block is called by its own name.
    let name = text.get(at.clone()).filter(|text| !text.is_empty()).unwrap_or(name);
    let name = name.split(['.', '[']).next().unwrap_or(name);
    if message.contains(" is a constant") {
        mistake.help("leave `const` out where it is declared");
        return;
    }
    let of_type = declared_type(text, name).unwrap_or("vec4");
    mistake
        .help(format!("copy it: `{of_type} changed = {name};`, and write `changed = ...;` here"));
}

/// The word before the first place of a name that follows a word.
fn declared_type<'t>(text: &'t str, name: &str) -> Option<&'t str> {
    text.match_indices(name).find_map(|(at, _)| {
        let word = crate::hints::last_word(text.get(..at)?);
        shader_type(word).map(|_| word)
    })
}

/// The declaration of an input with `flat`.
fn flat_line(text: &str, at: &Range<usize>) -> String {
    let line = line_around(text, at.start).trim().to_owned();
    match line.find(" in ") {
        Some(found) => format!("{} flat{}", &line[..found], &line[found..]),
        None => format!("flat {line}"),
    }
}

fn line_around(text: &str, at: usize) -> &str {
    let before = text.get(..at).unwrap_or_default();
    let start = before.rfind('\n').map_or(0, |found| found + 1);
    text.get(start..).and_then(|rest| rest.lines().next()).unwrap_or_default()
}

/// `;` is missing at the end of the line before.
fn semicolon(text: &str, at: &Range<usize>, mistake: &mut Mistake) {
    let before = text.get(..at.start).unwrap_or_default().trim_end();
    // A structure without it takes the next word for the name of a variable.
    let word = crate::hints::last_word(before);
    let without = before.strip_suffix(word).unwrap_or(before).trim_end();
    let before = if without.ends_with('}') && !word.is_empty() { without } else { before };
    mistake.missing_semicolon(text, before.len(), at);
}

/// A list of arguments or parameters that goes on strangely.
fn comma(text: &str, at: &Range<usize>, found: &str, mistake: &mut Mistake) {
    let line = line_around(text, at.start).trim();
    if found == ":" && line.starts_with("fn ") {
        mistake.help(format!(
            "functions of GLSL begin with their type: write `{}`",
            function_head(line).unwrap_or_else(|| "float f(float x) {".to_owned())
        ));
    } else if found == ";" {
        let before = text.get(..at.start).unwrap_or_default();
        let line = before.rsplit('\n').next().unwrap_or_default().trim();
        mistake.message = "`)` is missing".to_owned();
        mistake.labels = vec![(at.clone(), "before this".to_owned())];
        mistake.write(format!("{line});"));
    }
}

/// `fn f(x: f32) -> f32 {` as GLSL.
fn function_head(line: &str) -> Option<String> {
    let glsl = |name: &str| {
        let name = name.trim();
        crate::foreign::native_text(lamplight_bundle::Language::Glsl, name)
            .unwrap_or_else(|| name.to_owned())
    };
    let rest = line.strip_prefix("fn ")?;
    let (name, rest) = rest.split_once('(')?;
    let (parameters, rest) = rest.split_once(')')?;
    let result = rest.split_once("->").map(|(_, result)| result.trim_end_matches(['{', ' ']));
    let parameters: Vec<String> = parameters
        .split(',')
        .filter_map(|one| one.split_once(':'))
        .map(|(name, of)| format!("{} {}", glsl(of), name.trim()))
        .collect();
    let result = result.map_or_else(|| "void".to_owned(), glsl);
    Some(format!("{result} {name}({}) {{", parameters.join(", ")))
}

/// A brace that is not closed, by the indentation of what follows.
fn unclosed(text: &str, mistake: &mut Mistake) {
    if !mistake.message.starts_with("expected `}`, found the end") {
        return;
    }
    let mut open: Vec<usize> = Vec::new();
    let mut pairs = Vec::new();
    for (at, letter) in text.char_indices() {
        match letter {
            '{' => open.push(at),
            '}' => pairs.extend(open.pop().map(|open| (open, at))),
            _ => {}
        }
    }
    mistake.message = "`{` is never closed".to_owned();
    let found = lamplight_syntax::wesl::unclosed_by_indentation(text, pairs.into_iter());
    match (found, open.last()) {
        (Some((open, _)), _) => {
            mistake.labels = vec![(
                open..open + 1,
                "what closes it stands further left than this line".to_owned(),
            )];
            mistake.help("write `}` where it ends");
        }
        (None, Some(open)) => {
            mistake.labels = vec![(*open..open + 1, "opened here".to_owned())];
            mistake.help("write `}` where it ends");
        }
        (None, None) => {}
    }
}

/// What an unknown name of GLSL may be: a word of WGSL, or a macro.
pub fn note_unknown_glsl(text: &str, name: &str, at: usize) -> Option<String> {
    if matches!(name, "let" | "var") {
        let line = line_around(text, at).trim();
        let value = line.split_once('=').map_or("", |(_, value)| value.trim());
        let declared = line.strip_prefix(name)?.split('=').next()?.trim();
        let declared = declared.split(':').next()?.trim();
        let of_type = if is_number(value.trim_end_matches(';')) && !value.contains('.') {
            "int"
        } else {
            "float"
        };
        return Some(format!(
            "help: GLSL declares with the type in front: `{of_type} {declared} = {value}` for a \
             `{of_type}`"
        ));
    }
    let is_macro = name.len() > 1
        && name.chars().all(|one| one.is_ascii_uppercase() || one.is_ascii_digit() || one == '_');
    is_macro.then(|| format!("help: write `#define {name} ...` before it, or a `const`"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn advice(text: &str, part: &str, message: &str) -> String {
        let start = text.find(part).unwrap_or_default();
        let mut mistake = Mistake {
            message: message.to_owned(),
            labels: vec![(start..start + part.len(), "here".to_owned())],
            notes: Vec::new(),
        };
        advise_glsl(text, &mut mistake);
        mistake.notes.join("\n")
    }

    #[test]
    fn values_and_operators() {
        for (text, part, message, expected) in [
            ("vec3 c = x;", "x", "the initial value is `float` and should be `vec3`", "vec3(x)"),
            ("v * p", "v * p", "`*` does not take `mat4` and `vec3`", "v * vec4(p, 1.0)"),
            ("a % b", "a % b", "`%` does not take `float` and `float`", "mod(a, b)"),
            ("a < b", "a < b", "`<` does not take `vec2` and `vec2`", "all(lessThan(a, b))"),
            ("dot(u, p)", "dot(u, p)", "`dot` does not take (vec2, vec3)", "dot(u, p.xy)"),
            (
                "texture(t, p)",
                "texture(t, p)",
                "`texture` does not take (sampler2D, vec3)",
                "texture(t, p.xy)",
            ),
        ] {
            assert_eq!(advice(text, part, message), format!("help: write `{expected}`"));
        }
    }
}
