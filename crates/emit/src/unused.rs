//! Bindings that an entry point does not use.
//!
//! A text may declare them where a name in it means something else. naga writes them for WGSL alone,
//! and tools that list the bindings of a text would find more than its reflection has. A function
//! that nothing calls is written too, and keeps the bindings that it names.

use naga::{GlobalVariable, Handle};

use super::EmitSource;

/// What the declaration of a binding begins with.
const ATTRIBUTES: &str = "@group(";

/// The text in WGSL without the declarations of bindings that are not used.
pub fn without_unused_bindings(text: String, source: &EmitSource<'_>) -> String {
    let info = source.info.get_entry_point(source.index);
    let bound = source.module.global_variables.iter().filter(|(_, one)| one.binding.is_some());
    let functions: Vec<_> =
        source.module.functions.iter().map(|(handle, _)| &source.info[handle]).collect();
    let is_used = |variable: Handle<GlobalVariable>| {
        !info[variable].is_empty() || functions.iter().any(|info| !info[variable].is_empty())
    };
    let used: Vec<bool> = bound.map(|(handle, _)| is_used(handle)).collect();
    if used.iter().all(|used| *used) {
        return text;
    }
    let (mut to, mut used, mut is_left_out) = (String::new(), used.into_iter(), false);
    for line in text.split_inclusive('\n') {
        if line.starts_with(ATTRIBUTES) {
            is_left_out = used.next() == Some(false);
        }
        if !is_left_out {
            to += line;
        }
        is_left_out &= !line.trim_end().ends_with(';');
    }
    to
}
