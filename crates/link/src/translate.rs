//! Translates one unit for every target: naga writes its canonical text, of which the unit's own
//! part is kept.

use std::collections::BTreeMap;
use std::sync::Arc;

use naga::front::wgsl;
use naga::valid::ModuleInfo;
use naga::{Function, GlobalVariable, Handle, Module};
use rustc_hash::FxHashSet;

use super::canonical::{IDLE, Recipe, UnitId};
use super::cut::{self, Cut, TextFragment};
use super::marked::mark_module;
use super::outline::Outline;
use super::reason::Reason;
use super::summary::{FunctionSummary, summarise_function, used_globals};
use super::uses::{call_function, show_stubs};
use lamplight_bundle::Language;
use lamplight_bundle::{Conventions, Native, Reflection, Target};
use lamplight_compose::Composed;
use lamplight_emit as emit;
use lamplight_emit::spirv::words;
use lamplight_validate::{
    Validated, functions, guard, has_changed_shapes, has_lost_alignments, info_of, is_bounded,
    is_small, may_alias, on_large_stack, prepare_part,
};

/// A unit in every target.
pub struct Translated {
    pub summary: FunctionSummary,
    /// One result for each target, in their order. Where one output cannot be cut, only that target
    /// is compiled as a whole.
    pub targets: Vec<Result<WrittenUnit, Reason>>,
    /// The reflection, for an entry point.
    pub reflection: Option<Arc<Reflection>>,
}

/// A unit in one target.
pub enum WrittenUnit {
    /// Text, with references for the author's names; `native` is the native names as JSON.
    Text { cut: Cut, native: Option<TextFragment> },
    /// A SPIR-V module, in which names stay as they are.
    Words { words: Vec<u32>, native: Native },
}

/// The module of a canonical text.
struct ParsedRecipe {
    validated: Validated,
    entry: String,
    /// The author's names, indexed by the number of their mark.
    names: Vec<String>,
    marked: Validated,
}

/// Translates a unit for some targets.
///
/// # Errors
/// The reason why texts with the unit are compiled as a whole.
pub fn translate_unit(
    outline: &Outline<'_>,
    recipe: &Recipe<'_>,
    targets: &[Target],
    conventions: Conventions,
) -> Result<Translated, Reason> {
    let text = recipe.text(outline)?;
    let composed = Composed::of_text(Language::Wesl, None, text);
    if !is_small(&composed).map_err(|_| Reason::Refused)? {
        return Err(Reason::Large);
    }
    on_large_stack(|| {
        guard(&composed.text, || translate_inner(outline, recipe, &composed, targets, conventions))
    })
    .unwrap_or(Err(Reason::Refused))
}

fn translate_inner(
    outline: &Outline<'_>,
    recipe: &Recipe<'_>,
    composed: &Composed,
    targets: &[Target],
    conventions: Conventions,
) -> Result<Translated, Reason> {
    let mut module = parse_recipe(&composed.text)?;
    if !is_bounded(&module) {
        return Err(Reason::Refused);
    }
    prepare_part(&mut module).then_some(()).ok_or(Reason::Refused)?;
    show_stubs(outline, recipe, &mut module)?;
    call_function(outline, recipe, &mut module)?;
    let info = info_of(&module).map_err(|_| Reason::Refused)?;
    if has_changed_shapes(&composed.text, &module, &info) {
        return Err(Reason::Refused);
    }
    if aliases(&module, &info) {
        return Err(Reason::Alias);
    }
    let summary = checked_summary(outline, recipe, &module, &info)?;
    let summary = with_rules(outline, recipe, composed, summary).with_key();
    let is_entry = recipe.unit == UnitId::Entry;
    if is_entry && !summary.is_for(outline.stage) {
        return Err(Reason::Stage);
    }
    let entry = module.entry_points.first().ok_or(Reason::EntryPoint)?.name.clone();
    let (marked, names) = mark_module(outline, recipe, &module)?;
    let marked = Validated { module: marked, info: info.clone(), portable: true };
    let validated = Validated { module, info, portable: true };
    let reflection = is_entry.then(|| emit::reflect(&validated, &entry).map(Arc::new));
    let reflection = reflection.transpose().map_err(|_| Reason::Refused)?;
    let parsed = ParsedRecipe { validated, entry, names, marked };
    let targets =
        targets.iter().map(|target| write_target(outline, recipe, &parsed, *target, conventions));
    Ok(Translated { summary, targets: targets.collect(), reflection })
}

/// Whether two pointers of a call may lead to one variable. What a stub does to it is not known.
fn aliases(module: &Module, info: &ModuleInfo) -> bool {
    let names =
        |callee: Handle<Function>, global: Handle<GlobalVariable>| !info[callee][global].is_empty();
    functions(module).any(|function| may_alias(module, function, &names))
}

fn parse_recipe(text: &str) -> Result<Module, Reason> {
    let module = wgsl::parse_str(text).map_err(|_| Reason::Refused)?;
    if has_lost_alignments(text, &module) { Err(Reason::Refused) } else { Ok(module) }
}

/// The summary of the unit, after a check that every stub uses the same variables as its function.
fn checked_summary(
    outline: &Outline<'_>,
    recipe: &Recipe<'_>,
    module: &Module,
    info: &ModuleInfo,
) -> Result<FunctionSummary, Reason> {
    let mut stubs = BTreeMap::new();
    for (handle, function) in module.functions.iter() {
        let name = function.name.as_deref();
        let is_it = |(stub, _): &&(usize, &FunctionSummary)| {
            name == Some(outline.declarations[*stub].name())
        };
        if let Some((_, summary)) = recipe.stubs.iter().find(is_it) {
            if used_globals(module, &info[handle]).as_ref() != Some(&summary.globals) {
                return Err(Reason::Stub);
            }
            stubs.insert(handle, *summary);
        }
    }
    let callee = |handle| stubs.get(&handle).copied();
    let found = match recipe.unit {
        UnitId::Function(index) => {
            let name = Some(outline.declarations[index].name());
            let mut functions = module.functions.iter();
            let found = functions.find(|(_, function)| function.name.as_deref() == name);
            let (handle, function) = found.ok_or(Reason::Refused)?;
            summarise_function(module, &info[handle], function, &callee)
        }
        UnitId::Entry => {
            let point = module.entry_points.first().ok_or(Reason::EntryPoint)?;
            summarise_function(module, info.get_entry_point(0), &point.function, &callee)
        }
    };
    found.ok_or(Reason::Sampling)
}

/// The summary with what the rules of WGSL say of the unit.
fn with_rules(
    outline: &Outline<'_>,
    recipe: &Recipe<'_>,
    composed: &Composed,
    summary: FunctionSummary,
) -> FunctionSummary {
    let function = recipe.function;
    let stub = |name: &str| {
        let mut stubs = recipe.stubs.iter();
        stubs.find(|(stub, _)| outline.declarations[*stub].name() == name)
    };
    let known = |name: &str| stub(name).map(|(_, summary)| &summary.rules);
    let name = outline.declarations[function].name();
    let (rules, is_clean) = lamplight_rules::summarise(&composed.text, name, &known);
    let breaks_rules = !is_clean || recipe.stubs.iter().any(|(_, stub)| stub.breaks_rules);
    FunctionSummary { rules, breaks_rules, ..summary }
}

fn write_target(
    outline: &Outline<'_>,
    recipe: &Recipe<'_>,
    parsed: &ParsedRecipe,
    target: Target,
    conventions: Conventions,
) -> Result<WrittenUnit, Reason> {
    if target == Target::SPIRV {
        let emitted = emit::emit_for(&parsed.validated, &parsed.entry, target, conventions);
        let emitted = emitted.map_err(|_| Reason::Refused)?;
        let words = words(&emitted.bytes);
        return Ok(WrittenUnit::Words { words, native: emitted.native });
    }
    let entry = parsed.marked.module.entry_points.first().map_or(IDLE, |point| &point.name);
    let emitted = emit::emit_for(&parsed.marked, entry, target, conventions);
    let emitted = emitted.map_err(|_| Reason::Refused)?;
    let text = String::from_utf8(emitted.bytes).map_err(|_| Reason::Shape)?;
    let function = match recipe.unit {
        UnitId::Function(index) => Some(outline.declarations[index].name()),
        UnitId::Entry => None,
    };
    let wanted =
        cut::WantedParts { function, entry: &emitted.native.entry_name, names: &parsed.names };
    let mut cut = cut::cut_output(&text, &wanted)?;
    cut.add_locals(&local_names(recipe, &parsed.validated.module, function), wanted.entry);
    let native = match recipe.unit {
        UnitId::Function(_) => None,
        UnitId::Entry => {
            let native = serde_json::to_string(&emitted.native).map_err(|_| Reason::Shape)?;
            Some(TextFragment::read(&native, &parsed.names)?)
        }
    };
    Ok(WrittenUnit::Text { cut, native })
}

/// Names that the author gave within the unit's function, to which naga may append numbers.
fn local_names<'m>(
    recipe: &Recipe<'_>,
    module: &'m Module,
    name: Option<&str>,
) -> FxHashSet<&'m str> {
    let function = match recipe.unit {
        UnitId::Entry => module.entry_points.first().map(|point| &point.function),
        UnitId::Function(_) => {
            let mut functions = module.functions.iter().map(|(_, function)| function);
            functions.find(|function| function.name.as_deref() == name)
        }
    };
    let of = |function: &'m Function| {
        let arguments = function.arguments.iter().filter_map(|argument| argument.name.as_deref());
        let variables =
            function.local_variables.iter().filter_map(|(_, local)| local.name.as_deref());
        let values = function.named_expressions.values().map(String::as_str);
        arguments.chain(variables).chain(values)
    };
    function.into_iter().flat_map(of).map(|name| name.trim_end_matches('_')).collect()
}
