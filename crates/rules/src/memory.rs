//! Memory: what atomics may be in, and which stages may reach what.

use std::collections::BTreeSet;

use super::names::{Module, Uses, stage_of};
use super::syntax::{Declaration, ExprId, ExprKind, Tree};
use super::{Place, Problem, Rule};

pub fn check(tree: &Tree<'_>, module: &Module<'_, '_>) -> Vec<Problem> {
    let mut problems = Vec::new();
    for declaration in &tree.declarations {
        check_variable(module, declaration, &mut problems);
        check_words(module, &declaration.template, &mut problems);
    }
    for expression in &tree.expressions {
        match &expression.kind {
            ExprKind::Name { name: "ptr", template, local: _ } => {
                let words = template.iter().copied().step_by(2).collect::<Vec<ExprId>>();
                check_words(module, &words, &mut problems);
            }
            ExprKind::Name { name, template, local: _ } if name.starts_with("texture_storage_") => {
                check_words(module, template, &mut problems);
            }
            _ => {}
        }
        if let ExprKind::Name { name: "ptr", template, local: _ } = &expression.kind {
            check_pointer(module, template, expression.place, &mut problems);
        }
        if let ExprKind::Name { name: "atomic", template, local: _ } = &expression.kind {
            let of = template.first().and_then(|id| module.type_of(*id));
            if !of.is_some_and(|(name, _)| matches!(name, "i32" | "u32")) {
                let message = "`atomic` takes `i32` or `u32`".to_owned();
                problems.push(Problem::new(Rule::Memory, expression.place, message));
            }
        }
    }
    check_stages(tree, module, &mut problems);
    problems
}

/// Address spaces, access modes and formats that are names of the module here.
fn check_words(module: &Module<'_, '_>, words: &[ExprId], problems: &mut Vec<Problem>) {
    for id in words {
        let ExprKind::Name { name, template: _, local: _ } = module.tree.kind(*id) else {
            continue;
        };
        if module.find(name).is_some() {
            let message = format!("`{name}` is a declaration of the module here");
            problems.push(Problem::new(Rule::Memory, module.tree.place(*id), message));
        }
    }
}

fn check_variable(
    module: &Module<'_, '_>,
    declaration: &Declaration<'_>,
    problems: &mut Vec<Problem>,
) {
    let Some(of_type) = declaration.of_type else { return };
    let space = module.template_word(&declaration.template, 0);
    let access = module.template_word(&declaration.template, 1);
    if has_atomic(module, of_type, 0) {
        problems.extend(misplaced_atomic(space, access, declaration.place));
    }
    if space == Some("immediate") && has_array(module, of_type, 0) {
        let message = "immediates have no arrays".to_owned();
        problems.push(Problem::new(Rule::Memory, declaration.place, message));
    }
}

/// Why atomics cannot be in an address space.
fn misplaced_atomic(space: Option<&str>, access: Option<&str>, place: Place) -> Option<Problem> {
    let message = match (space, access) {
        (Some("workgroup"), _) | (Some("storage"), Some("read_write")) => return None,
        (Some("storage"), _) => "atomics in a storage buffer need `read_write`",
        _ => "atomics can only be in the address spaces `storage` and `workgroup`",
    };
    Some(Problem::new(Rule::Memory, place, message.to_owned()))
}

fn check_pointer(
    module: &Module<'_, '_>,
    template: &[ExprId],
    place: Place,
    problems: &mut Vec<Problem>,
) {
    let space = module.template_word(template, 0);
    let access = module.template_word(template, 2);
    if space == Some("storage") && access == Some("write") {
        let message = "the address space `storage` has no access mode `write`".to_owned();
        problems.push(Problem::new(Rule::Memory, place, message));
    }
    if template.get(1).is_some_and(|id| has_atomic(module, *id, 0)) {
        problems.extend(misplaced_atomic(space, access, place));
    }
}

/// Whether a type has atomics within.
pub fn has_atomic(module: &Module<'_, '_>, id: ExprId, depth: usize) -> bool {
    // Types cannot contain themselves; naga says so where they do.
    if depth > 64 {
        return false;
    }
    match module.type_of(id) {
        Some(("atomic", _)) => true,
        Some(("array", template)) => {
            template.first().is_some_and(|of| has_atomic(module, *of, depth + 1))
        }
        _ => module.structure(id).is_some_and(|structure| {
            let mut members = module.tree.structs[structure].members.iter();
            members.any(|member| has_atomic(module, member.of_type, depth + 1))
        }),
    }
}

/// Whether a type has arrays within.
fn has_array(module: &Module<'_, '_>, id: ExprId, depth: usize) -> bool {
    if depth > 64 {
        return false;
    }
    match module.type_of(id) {
        Some(("array", _)) => true,
        _ => module.structure(id).is_some_and(|structure| {
            let mut members = module.tree.structs[structure].members.iter();
            members.any(|member| has_array(module, member.of_type, depth + 1))
        }),
    }
}

/// Where a stage reaches memory that it must not.
fn check_stages(tree: &Tree<'_>, module: &Module<'_, '_>, problems: &mut Vec<Problem>) {
    if tree.functions.iter().all(|function| matches!(stage_of(function), None | Some("compute"))) {
        return;
    }
    for (entry, function) in tree.functions.iter().enumerate() {
        let Some(stage @ ("vertex" | "fragment")) = stage_of(function) else { continue };
        for variable in reached_variables(&module.uses, entry) {
            let declaration = &tree.declarations[variable];
            let Some(what) = forbidden(module, declaration, stage) else { continue };
            let message = format!("the {stage} stage cannot use `{}`: {what}", declaration.name);
            let mut problem = Problem::new(Rule::Memory, function.place, message);
            problem.notes.push((declaration.place, "declared here".to_owned()));
            problems.push(problem);
        }
    }
}

fn forbidden(
    module: &Module<'_, '_>,
    declaration: &Declaration<'_>,
    stage: &str,
) -> Option<&'static str> {
    let space = module.template_word(&declaration.template, 0);
    let access = module.template_word(&declaration.template, 1);
    if space == Some("workgroup") {
        return Some("it belongs to a workgroup");
    }
    if stage != "vertex" {
        return None;
    }
    if space == Some("storage") && access == Some("read_write") {
        return Some("it is a storage buffer that can be written");
    }
    let (kind, template) = declaration.of_type.and_then(|id| module.type_of(id))?;
    let access = module.template_word(template, 1);
    let is_written = kind.starts_with("texture_storage_") && access != Some("read");
    is_written.then_some("it is a storage texture that can be written")
}

fn reached_variables(uses: &[Uses], entry: usize) -> BTreeSet<usize> {
    let (mut reached, mut seen) = (BTreeSet::new(), vec![false; uses.len()]);
    let mut open = vec![entry];
    while let Some(function) = open.pop() {
        if !std::mem::replace(&mut seen[function], true) {
            reached.extend(&uses[function].variables);
            open.extend(&uses[function].functions);
        }
    }
    reached
}
