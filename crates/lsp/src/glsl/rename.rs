//! Renames symbols of GLSL, where no condition and no macro can make that wrong.

use crate::failure::RequestError;
use std::collections::BTreeSet;

use serde_json::Value;

use super::references::{PLACES, RequestedSymbol, places_of_dependents, requested_symbol};
use super::text_of;
use super::units::{Meant, NamePlace, Units, Use};
use crate::place::Lines;
use crate::{LanguageServer, report};
use lamplight_compose::resolve::glsl::IncludeTarget;
use lamplight_syntax::glsl::words::is_reserved;
use lamplight_syntax::glsl::{Directive, FilePart, Symbol};
use lamplight_syntax::words::has_word;

/// The letters of swizzles.
const SWIZZLES: [&str; 3] = ["xyzw", "rgba", "stpq"];

/// `textDocument/prepareRename`.
pub fn prepare_rename(
    server: &mut LanguageServer,
    parameters: &Value,
) -> Result<Value, RequestError> {
    let Some(requested) = requested_symbol(server, parameters)? else { return Ok(Value::Null) };
    let places = renamed_places(&requested)?;
    refuse_dependents(server, &requested, &places)?;
    let lines = Lines::new(&requested.whole.units.module(requested.file).text);
    Ok(lines.range(requested.range.start as usize..requested.range.end as usize))
}

/// `textDocument/rename`: in all files of the package.
pub fn rename_symbol(
    server: &mut LanguageServer,
    parameters: &Value,
) -> Result<Value, RequestError> {
    let new = parameters
        .get("newName")
        .and_then(Value::as_str)
        .ok_or(RequestError::Parameter("newName"))?
        .to_owned();
    let requested = requested_symbol(server, parameters)?.ok_or(RequestError::NoName)?;
    let places = renamed_places(&requested)?;
    refuse_dependents(server, &requested, &places)?;
    check_new(&requested, &places, &new)?;
    let texts = server.places(&requested.whole.opened.sources);
    let spans = places.iter().map(|place| (&texts, requested.whole.span(place)));
    report::rename_json(&new, spans)
}

/// Every place that writes the name.
///
/// # Errors
/// Why the symbol cannot be renamed.
fn renamed_places(requested: &RequestedSymbol) -> Result<Vec<NamePlace>, String> {
    let units = &requested.whole.units;
    let (all, declared) = units.places(&requested.meant, requested.file);
    if all.len() > PLACES {
        return Err(format!("more than {PLACES} places name it"));
    }
    let Some(first) = declared.first() else {
        let is_axis = !all.is_empty();
        let axis = "it is a macro that no file defines, such as an axis, which is named in more \
                    than these files";
        let unknown = "no file of the package declares it";
        return Err(if is_axis { axis } else { unknown }.to_owned());
    };
    if let Some(place) = all.iter().chain(&declared).find(|place| !units.is_own(place.file)) {
        let path = &units.names.graph.paths[place.file];
        return Err(format!("it is also a name of another package, in `{path}`"));
    }
    let files: BTreeSet<usize> = all.iter().map(|place| place.file).collect();
    check_readable(units, &files)?;
    let name = spelt_at(units, first);
    if let Some(reason) = why_fixed(requested, &name, &all, &declared) {
        return Err(reason);
    }
    check_locals(requested, &files)?;
    Ok(all)
}

/// The most files that a refusal names.
const NAMED: usize = 8;

/// Fails where other packages of the workspace name what would be renamed: what these names mean
/// may depend on more than their files.
fn refuse_dependents(
    server: &mut LanguageServer,
    requested: &RequestedSymbol,
    places: &[NamePlace],
) -> Result<(), String> {
    let (dependents, unread) = places_of_dependents(server, requested, places);
    if let Some(reason) = unread.first() {
        return Err(format!("uses may be missed: {reason}"));
    }
    let files: BTreeSet<String> = dependents
        .iter()
        .flat_map(|(whole, places)| {
            let paths = &whole.units.names.graph.paths;
            places.iter().map(|place| paths[place.file].clone())
        })
        .collect();
    if files.is_empty() {
        return Ok(());
    }
    let named: Vec<String> = files.iter().take(NAMED).map(|file| format!("`{file}`")).collect();
    let more = match files.len() - named.len() {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    Err(format!("other packages name it: {}{more}", named.join(", ")))
}

fn spelt_at(units: &Units, place: &NamePlace) -> String {
    text_of(units.module(place.file), &(place.start..place.end)).to_owned()
}

/// A place as messages name it.
fn shown_place(units: &Units, file: usize, byte: u32) -> String {
    let path = &units.names.graph.paths[file];
    let name = path.rsplit_once('/').map_or(path.as_str(), |(_, name)| name);
    format!("`{name}:{}`", units.module(file).line(byte))
}

/// Fails if a file of the package that may name the symbol has syntax errors, or includes a file
/// that cannot be read: uses of the name could be missed.
fn check_readable(units: &Units, files: &BTreeSet<usize>) -> Result<(), String> {
    for file in units.seen_files(files).into_iter().filter(|file| units.is_own(*file)) {
        let module = units.module(file);
        if let Some(error) = module.errors.first() {
            let byte = error.labels.first().map_or(0, |label| label.span.start);
            return Err(format!(
                "fix this first: {}: {}",
                shown_place(units, file, byte),
                error.message
            ));
        }
        for (include, target) in module.includes.iter().zip(&units.names.graph.targets[file]) {
            if let IncludeTarget::Missing(_) = target {
                let place = shown_place(units, file, include.span.start);
                return Err(format!("the `#include` in {place} leads to no file that can be read"));
            }
        }
    }
    Ok(())
}

/// Why the symbol cannot be renamed; `None` if it can.
fn why_fixed(
    requested: &RequestedSymbol,
    name: &str,
    all: &[NamePlace],
    declared: &[NamePlace],
) -> Option<String> {
    let units = &requested.whole.units;
    let symbol = units.names.graph.symbols.find(name)?;
    if name == "main" && matches!(requested.meant, Meant::Global(_)) {
        return Some("`main` is the entry point of a stage".to_owned());
    }
    let files: BTreeSet<usize> = all.iter().map(|place| place.file).collect();
    if let Some(reason) = named_by_macro(units, &units.seen_files(&files), symbol) {
        return Some(reason);
    }
    match &requested.meant {
        Meant::Local(file, _, function) => {
            let text = text_of(units.module(*file), function);
            let words = "a struct is declared in this function, and its members cannot be told \
                         apart from variables";
            has_word(text, "struct").then(|| words.to_owned())
        }
        Meant::Member(_) => why_member_fixed(units, name, declared),
        Meant::Global(_) => declared.iter().find_map(|place| {
            let found = units.names.outlines[place.file].declarations.iter();
            let mut found = found.filter(|found| found.place.start == place.start);
            why_interface_fixed(text_of(units.module(place.file), &found.next()?.range))
        }),
    }
}

/// Why a directive prevents renaming: it names the symbol, or may build the name from parts.
fn named_by_macro(units: &Units, files: &BTreeSet<usize>, symbol: Symbol) -> Option<String> {
    for file in files {
        let own = units.is_own(*file);
        for at in units.tokens_of(*file, symbol) {
            if own && units.use_of(*file, at) == Use::Directive {
                let place = shown_place(units, *file, units.module(*file).tokens[at].start);
                return Some(format!(
                    "the directive in {place} names it, and the preprocessor reads that without \
                     regard to what it means"
                ));
            }
        }
        for part in &units.module(*file).parts {
            if let FilePart::Directive(Directive::Define(found), span) = part
                && found.body.iter().any(|token| token.pasted)
            {
                let place = shown_place(units, *file, span.start);
                return Some(format!("the macro in {place} puts names together with `##`"));
            }
        }
    }
    None
}

/// Why a member cannot be renamed. Members of one name cannot be told apart, since the type of the
/// expression before the dot is not known.
fn why_member_fixed(units: &Units, name: &str, declared: &[NamePlace]) -> Option<String> {
    let is_swizzle = |letters: &&str| name.chars().all(|letter| letters.contains(letter));
    if name.len() <= 4 && SWIZZLES.iter().any(is_swizzle) {
        return Some("it may also be a part of a vector".to_owned());
    }
    if name == "length" {
        return Some("it may also be the length of an array".to_owned());
    }
    let [first, second, ..] = declared else { return None };
    Some(format!(
        "members of {} and {} have this name, and their uses cannot be told apart",
        shown_place(units, first.file, first.start),
        shown_place(units, second.file, second.start)
    ))
}

/// Why a variable cannot be renamed that others find by its name: another stage, or the host.
fn why_interface_fixed(text: &str) -> Option<String> {
    let head = text.split(['=', '{']).next().unwrap_or_default();
    let is_called = text.contains('(') && !text.contains("layout");
    let layout = text.split_once("layout").and_then(|(_, rest)| rest.split_once(')'));
    let layout = layout.map_or("", |(inside, _)| inside);
    if is_called {
        return None;
    }
    let stages = ["in", "out", "varying", "attribute"];
    if stages.iter().any(|word| has_word(head, word)) && !has_word(layout, "location") {
        return Some("another stage finds it by its name: it has no `location`".to_owned());
    }
    if ["uniform", "buffer"].iter().any(|word| has_word(text, word))
        && !["binding", "location", "push_constant"].iter().any(|word| has_word(layout, word))
    {
        return Some("the host finds it by its name: it has no `binding`".to_owned());
    }
    None
}

/// Fails if conditions of the preprocessor decide whether a use refers to a local or to something
/// else.
fn check_locals(requested: &RequestedSymbol, files: &BTreeSet<usize>) -> Result<(), String> {
    let units = &requested.whole.units;
    let refuse = |file: usize, byte: u32| {
        let place = shown_place(units, file, byte);
        Err(format!("whether {place} declares it for its uses depends on a condition"))
    };
    match &requested.meant {
        Meant::Member(_) => Ok(()),
        Meant::Global(name) => {
            for file in files {
                let locals = units.names.outlines[*file].locals.iter();
                let mut same = locals.filter(|local| local.name == *name);
                if let Some(local) = same.find(|local| units.is_conditional(*file, &local.place)) {
                    return refuse(*file, local.place.start);
                }
            }
            Ok(())
        }
        Meant::Local(file, places, function) => {
            let conditional = places.iter().find(|place| units.is_conditional(*file, place));
            let Some(place) = conditional else { return Ok(()) };
            let name =
                spelt_at(units, &NamePlace { file: *file, start: place.start, end: place.end });
            let Some(symbol) = units.names.graph.symbols.find(&name) else { return Ok(()) };
            // Without the condition it would be the global of that name, if there is one.
            let seen = units.seen_files(&BTreeSet::from([*file]));
            let is_global = seen
                .iter()
                .any(|file| units.declarations_in(*file, symbol, &Use::Global).next().is_some());
            let mut uses = units.tokens_of(*file, symbol);
            let is_outside = uses.any(|at| {
                let start = units.module(*file).tokens[at].start;
                function.contains(&start) && units.use_of(*file, at) == Use::Global
            });
            if is_global || is_outside || is_reserved(&name) {
                return refuse(*file, place.start);
            }
            Ok(())
        }
    }
}

/// Fails unless the new name is a valid name that means nothing yet where the old one is used.
fn check_new(requested: &RequestedSymbol, places: &[NamePlace], new: &str) -> Result<(), String> {
    let units = &requested.whole.units;
    let is_name = new.starts_with(|letter: char| letter.is_ascii_alphabetic() || letter == '_')
        && new.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_');
    if !is_name {
        return Err(format!("`{new}` is not a name in GLSL"));
    }
    if is_reserved(new) {
        return Err(format!("GLSL has a meaning for `{new}`, or reserves it"));
    }
    if is_axis(requested, new) {
        return Err(format!("`{new}` is the macro of an axis"));
    }
    let Some(symbol) = units.names.graph.symbols.find(new) else { return Ok(()) };
    let files: BTreeSet<usize> = places.iter().map(|place| place.file).collect();
    for file in units.seen_files(&files) {
        for at in units.tokens_of(file, symbol) {
            let token = units.module(file).tokens[at];
            let found = units.use_of(file, at);
            let is_taken = match &requested.meant {
                _ if found == Use::Directive => true,
                Meant::Member(_) => found == Use::Member,
                Meant::Local(own, _, function) => {
                    found != Use::Member && *own == file && function.contains(&token.start)
                }
                Meant::Global(_) => !matches!(found, Use::Member | Use::Bound),
            };
            if is_taken {
                return Err(format!("`{new}` is already a name in {}", {
                    shown_place(units, file, token.start)
                }));
            }
        }
    }
    Ok(())
}

/// Whether a name is the macro of an axis or of one of its values.
fn is_axis(requested: &RequestedSymbol, name: &str) -> bool {
    let programs = requested.whole.opened.manifest.iter().flat_map(|manifest| &manifest.programs);
    let mut axes = programs.flat_map(|program| program.space.axes());
    axes.any(|axis| super::is_macro_of(axis, name))
}
