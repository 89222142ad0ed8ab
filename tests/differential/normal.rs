//! Gives texts of the same meaning the same canonical text. Its declarations are in the order of
//! their first use from an entry point, and named by that order. Comments and unused parts are left
//! out.

use std::collections::{BTreeMap, VecDeque};
use std::fmt::Write as _;

use naga::back::wgsl::WriterFlags;
use naga::compact::{KeepUnused, compact};
use naga::valid::{Capabilities, ValidationFlags, Validator};
use naga::{Block, Module, Statement};

/// The canonical texts of every entry point, sorted by name.
pub fn normal(text: &str) -> Result<String, String> {
    let module = naga::front::wgsl::parse_str(text).map_err(|error| error.emit_to_string(text))?;
    validate(&module)?;
    let mut order: Vec<usize> = (0..module.entry_points.len()).collect();
    order.sort_by_key(|index| module.entry_points[*index].name.clone());
    order.into_iter().map(|index| entry(&module, index)).collect()
}

/// The canonical texts of functions, as if each were an entry point.
pub fn normal_functions(text: &str, names: &[String]) -> Result<String, String> {
    let mut module =
        naga::front::wgsl::parse_str(text).map_err(|error| error.emit_to_string(text))?;
    let mut roots = Vec::new();
    for name in names {
        let found =
            module.functions.iter().position(|(_, function)| function.name.as_ref() == Some(name));
        roots.push(global("fn", found.ok_or_else(|| format!("no function `{name}`"))?));
    }
    flatten_all(&mut module);
    rename(&mut module);
    let info = validate(&module)?;
    let text = naga::back::wgsl::write_string(&module, &info, WriterFlags::empty())
        .map_err(|error| error.to_string())?;
    Ok(ordered(&text, |declaration| {
        roots.iter().position(|root| defined(declaration) == Some(root))
    }))
}

/// Removes braces that are only a scope. The specification removes the braces of `@if(...) { }`, and
/// this version of `wesl` keeps them. That is safe here, since [`rename`] makes all names unique.
fn flatten_all(module: &mut Module) {
    for (_, function) in module.functions.iter_mut() {
        flatten(&mut function.body);
    }
    for entry in &mut module.entry_points {
        flatten(&mut entry.function.body);
    }
}

fn flatten(block: &mut Block) {
    for (mut statement, span) in std::mem::take(block).span_into_iter() {
        match &mut statement {
            Statement::Block(inner) => {
                flatten(inner);
                block.extend_block(std::mem::take(inner));
            }
            Statement::If { accept, reject, .. } => [accept, reject].into_iter().for_each(flatten),
            Statement::Switch { cases, .. } => {
                cases.iter_mut().for_each(|case| flatten(&mut case.body));
            }
            Statement::Loop { body, continuing, .. } => {
                [body, continuing].into_iter().for_each(flatten);
            }
            _ => {}
        }
        if !matches!(statement, Statement::Block(_)) {
            block.push(statement, span);
        }
        // Statements after this one are never reached.
        if matches!(
            block.last(),
            Some(
                Statement::Return { .. } | Statement::Kill | Statement::Break | Statement::Continue
            )
        ) {
            return;
        }
    }
}

fn validate(module: &Module) -> Result<naga::valid::ModuleInfo, String> {
    Validator::new(ValidationFlags::all(), Capabilities::all())
        .validate(module)
        .map_err(|error| format!("{error:?}"))
}

fn entry(module: &Module, index: usize) -> Result<String, String> {
    let mut module = module.clone();
    module.entry_points = vec![module.entry_points.swap_remove(index)];
    flatten_all(&mut module);
    compact(&mut module, KeepUnused::No);
    rename(&mut module);
    let info = validate(&module)?;
    let text = naga::back::wgsl::write_string(&module, &info, WriterFlags::empty())
        .map_err(|error| error.to_string())?;
    let is_entry =
        |text: &str| ["@vertex", "@fragment", "@compute"].iter().any(|stage| text.contains(stage));
    Ok(ordered(&text, |declaration| is_entry(declaration).then_some(0)))
}

/// Gives everything a unique name, so that naga's writer keeps it and [`ordered`] recognises it.
/// Members and entry points keep their names, which are the same in both texts.
fn rename(module: &mut Module) {
    let named: Vec<_> = module
        .types
        .iter()
        .enumerate()
        .filter(|(_, (_, ty))| ty.name.is_some())
        .map(|(place, (handle, ty))| (place, handle, ty.clone()))
        .collect();
    for (place, handle, ty) in named {
        module.types.replace(handle, naga::Type { name: Some(global("type", place)), ..ty });
    }
    module
        .constants
        .iter_mut()
        .enumerate()
        .for_each(|(place, (_, constant))| constant.name = Some(global("const", place)));
    module
        .overrides
        .iter_mut()
        .enumerate()
        .for_each(|(place, (_, constant))| constant.name = Some(global("over", place)));
    module
        .global_variables
        .iter_mut()
        .enumerate()
        .for_each(|(place, (_, variable))| variable.name = Some(global("var", place)));
    module
        .functions
        .iter_mut()
        .enumerate()
        .for_each(|(place, (_, function))| function.name = Some(global("fn", place)));
    let mut next = 0..;
    let entries = module.entry_points.iter_mut().map(|entry| &mut entry.function);
    for function in module.functions.iter_mut().map(|(_, function)| function).chain(entries) {
        let mut local = || Some(format!("{LOCAL}{}", letters(next.next().unwrap())));
        function.arguments.iter_mut().for_each(|argument| argument.name = local());
        function.local_variables.iter_mut().for_each(|(_, variable)| variable.name = local());
        function.named_expressions.iter_mut().for_each(|(_, name)| *name = local().unwrap());
    }
}

const GLOBAL: &str = "zg_";
const LOCAL: &str = "zl_";

fn global(kind: &str, place: usize) -> String {
    format!("{GLOBAL}{kind}_{}", letters(place))
}

/// The number as letters: naga's writer adds an underscore to names that end in a digit.
fn letters(number: usize) -> String {
    number.to_string().bytes().map(|digit| char::from(digit - b'0' + b'a')).collect()
}

/// The declarations of naga's output in the order of use from the roots, with names replaced by that
/// order. `root` gives the position of a root, and nothing for other declarations.
fn ordered(text: &str, root: impl Fn(&str) -> Option<usize>) -> String {
    let declarations = declarations(text);
    let mut roots: Vec<(usize, &str)> =
        declarations.iter().filter_map(|text| Some((root(text)?, *text))).collect();
    roots.sort_unstable();
    let mut by_name: BTreeMap<&str, &str> =
        declarations.iter().filter_map(|text| Some((defined(text)?, *text))).collect();
    by_name.retain(|_, text| root(text).is_none());
    let mut names: BTreeMap<String, String> = BTreeMap::new();
    let mut queue: VecDeque<&str> = roots.into_iter().map(|(_, text)| text).collect();
    let mut output = String::new();
    while let Some(declaration) = queue.pop_front() {
        for piece in pieces(declaration) {
            if !piece.starts_with(GLOBAL) && !piece.starts_with(LOCAL) {
                output += piece;
                continue;
            }
            if !names.contains_key(piece) {
                names.insert(piece.to_owned(), format!("n{}", names.len()));
                queue.extend(by_name.get(piece));
            }
            let _ = write!(output, "{}", names[piece]);
        }
        output += "\n";
    }
    output
}

/// The top-level declarations. Each ends with the `;` or `}` that closes it.
fn declarations(text: &str) -> Vec<&str> {
    let (mut found, mut depth, mut start) = (Vec::new(), 0, 0);
    for (at, byte) in text.bytes().enumerate() {
        match byte {
            b'{' | b'(' | b'[' => depth += 1,
            b')' | b']' => depth -= 1,
            b'}' => depth -= 1,
            _ => {}
        }
        if depth == 0 && (byte == b'}' || byte == b';') {
            found.push(text[start..=at].trim());
            start = at + 1;
        }
    }
    found
}

/// The text divided into words and what is between them, in order.
fn pieces(text: &str) -> impl Iterator<Item = &str> {
    let is_word = |byte: u8| byte.is_ascii_alphanumeric() || byte == b'_';
    let mut rest = text;
    std::iter::from_fn(move || {
        let first = is_word(*rest.as_bytes().first()?);
        let end = rest.bytes().position(|byte| is_word(byte) != first).unwrap_or(rest.len());
        let (piece, after) = rest.split_at(end);
        rest = after;
        Some(piece)
    })
}

/// The name that a declaration defines: the first global name in it.
fn defined(declaration: &str) -> Option<&str> {
    pieces(declaration).find(|piece| piece.starts_with(GLOBAL))
}
