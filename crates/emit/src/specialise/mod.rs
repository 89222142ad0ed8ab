//! Overrides that stay open in languages whose writers know only constants.
//!
//! naga replaces overrides by their values before it writes anything but WGSL. Here they become
//! private variables instead, which every writer knows. Their names are found again in the output,
//! where each variable becomes what the language has for overrides: a specialisation constant in
//! SPIR-V, a function constant in MSL, a macro elsewhere.

mod computed;
mod fixed;
mod kept;
mod spirv;
mod text;

pub use fixed::{default_values, is_length, keep_variables_only, with_constants, with_defaults};
pub use kept::{with_expressions, written_module};

use std::collections::BTreeSet;

use naga::back::wgsl::{WriterFlags, write_string};
use naga::{Expression, Handle, Literal, Module, Override, Scalar, ScalarKind, TypeInner};

use super::sized::with_sizes;
use super::{EmitSource, Emitted, Overrides, TargetEntry, isolate, targets};
use lamplight_bundle::{OverrideChoice, Target};
use lamplight_compose::Composed;
use lamplight_diagnostic::Diagnostics;
use lamplight_validate::{Validated, info_unchecked};

/// An override that stays open.
struct OpenOverride {
    /// As the author calls it.
    name: String,
    /// Name of the variable that stands for it.
    variable: String,
    kind: ScalarKind,
    /// Its number in SPIR-V and MSL: the author's, or the first that is free.
    id: u32,
    /// The bits of its default, and the default as C-like languages write it.
    bits: u32,
    text: String,
}

impl OpenOverride {
    /// The name of the macro, or of the function constant, that chooses the value.
    fn symbol(&self) -> String {
        format!("LAMPLIGHT_{}", self.name.to_uppercase())
    }
}

/// Refuses overrides without a value, where a target or the size of a workgroup needs one.
///
/// # Errors
/// `override-without-value` for each, in the author's place where `composed` knows it.
pub fn check_overrides(
    composed: &Composed,
    validated: &Validated,
    targets: &[Target],
) -> Result<(), Diagnostics> {
    let module = &validated.module;
    let entries = targets::ALL.iter().filter(|entry| targets.contains(&entry.target));
    let mut closed = entries.filter(|entry| entry.overrides != Overrides::Kept);
    let target = closed.next().map(|entry| format!("target `{}`", entry.target));
    let sizes = module.entry_points.iter().flat_map(|point| fixed::deciding_size(module, point));
    let sizes: BTreeSet<Handle<Override>> = sizes.collect();
    let without = module.overrides.iter().filter(|(_, one)| one.init.is_none());
    let found = without.filter_map(|(handle, _)| {
        let needed = match &target {
            _ if sizes.contains(&handle) => "the size of a workgroup",
            Some(target) => target.as_str(),
            None => return None,
        };
        let error = fixed::missing_value(fixed::shown_name(module, handle), needed);
        let place = module.overrides.get_span(handle).to_range();
        let place = place.and_then(|range| composed.map.lookup(range));
        Some(place.into_iter().fold(error, |error, span| error.at(span, "it has no default")))
    });
    let found: Diagnostics = found.collect();
    if found.is_empty() { Ok(()) } else { Err(found) }
}

/// The value of an expression that is a literal, a zero value, or a constant with such a value.
pub fn literal_of(module: &Module, expression: Handle<Expression>) -> Option<Literal> {
    match module.global_expressions[expression] {
        Expression::Literal(literal) => Some(literal),
        // A constant can only use earlier ones, so this recursion ends.
        Expression::Constant(constant) => {
            literal_before(module, module.constants[constant].init, expression)
        }
        Expression::ZeroValue(ty) => match module.types[ty].inner {
            TypeInner::Scalar(scalar) => Literal::zero(scalar),
            _ => None,
        },
        _ => None,
    }
}

fn literal_before(
    module: &Module,
    expression: Handle<Expression>,
    user: Handle<Expression>,
) -> Option<Literal> {
    if expression < user { literal_of(module, expression) } else { None }
}

/// Writes an entry point with its overrides open; `None` where one of them is not a scalar with a
/// default.
pub fn write_open(
    source: &EmitSource<'_>,
    writer: &TargetEntry,
) -> Option<Result<Emitted, String>> {
    let opens = open_overrides(source.module)?;
    Some(opened_module(source, &opens).and_then(|(module, info)| {
        let point = module.entry_points.get(source.index).ok_or("the entry point was lost")?;
        let source = EmitSource {
            module: &module,
            info: &info,
            stage: source.stage,
            entry: &point.name,
            index: source.index,
            conventions: source.conventions,
        };
        finish_open((writer.write)(&source)?, &opens, writer)
    }))
}

fn finish_open(
    mut emitted: Emitted,
    opens: &[OpenOverride],
    writer: &TargetEntry,
) -> Result<Emitted, String> {
    // Writers leave out a variable that the entry point does not use.
    let choices = match writer.overrides {
        Overrides::Specialised => spirv::open_words(&mut emitted.bytes, opens)?,
        _ => text::open_text(&mut emitted.bytes, opens, writer)?,
    };
    emitted.native.choices = choices;
    Ok(emitted)
}

fn choice_of(open: &OpenOverride, id: bool) -> OverrideChoice {
    OverrideChoice {
        name: open.name.clone(),
        id: id.then_some(open.id),
        symbol: (!id).then(|| open.symbol()),
    }
}

fn open_overrides(module: &Module) -> Option<Vec<OpenOverride>> {
    let mut taken: Vec<u32> =
        module.overrides.iter().filter_map(|(_, found)| found.id).map(u32::from).collect();
    module.overrides.iter().map(|(_, found)| open_override(module, found, &mut taken)).collect()
}

fn open_override(module: &Module, found: &Override, taken: &mut Vec<u32>) -> Option<OpenOverride> {
    let name = found.name.clone()?;
    let TypeInner::Scalar(Scalar { kind, width: 1 | 4 }) = module.types[found.ty].inner else {
        return None;
    };
    let (bits, text) = match literal_of(module, found.init?)? {
        Literal::Bool(value) => (u32::from(value), value.to_string()),
        Literal::I32(value) => (
            value.cast_unsigned(),
            if value == i32::MIN { "(-2147483647 - 1)".to_owned() } else { value.to_string() },
        ),
        Literal::U32(value) => (value, format!("{value}u")),
        Literal::F32(value) => (value.to_bits(), format!("{value:?}")),
        _ => return None,
    };
    let id = match found.id {
        Some(id) => id.into(),
        None => (0..).find(|id| !taken.contains(id))?,
    };
    taken.push(id);
    Some(OpenOverride {
        variable: format!("lamplight_{}_open", name.trim_matches('_')),
        name,
        kind,
        id,
        bits,
        text,
    })
}

/// The module with private variables for its overrides. It is written as WGSL for this, where only
/// one word of each declaration changes.
fn opened_module(
    source: &EmitSource<'_>,
    opens: &[OpenOverride],
) -> Result<(Module, naga::valid::ModuleInfo), String> {
    let mut named = source.module.clone();
    for ((_, found), open) in named.overrides.iter_mut().zip(opens) {
        found.name = Some(open.variable.clone());
        found.id = None;
    }
    let text = write_string(&named, source.info, WriterFlags::empty())
        .map_err(|error| error.to_string())?;
    let text = with_sizes(text, &named)?;
    let text: Vec<String> = text.lines().map(declared_variable).collect();
    let mut module =
        naga::front::wgsl::parse_str(&text.join("\n")).map_err(|error| error.to_string())?;
    for (point, original) in module.entry_points.iter_mut().zip(&source.module.entry_points) {
        point.name.clone_from(&original.name);
    }
    let info = info_unchecked(&module).map_err(|error| error.to_string())?;
    Ok((module, info))
}

/// Whether a line of naga's WGSL declares an override.
pub fn is_override_line(line: &str) -> bool {
    let behind_id = line.strip_prefix("@id(").and_then(|line| line.split_once(") "));
    behind_id.map_or(line, |(_, rest)| rest).starts_with("override ")
}

fn declared_variable(line: &str) -> String {
    line.strip_prefix("override ")
        .map_or_else(|| line.to_owned(), |rest| format!("var<private> {rest}"))
}
