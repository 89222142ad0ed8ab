//! The filters of WGSL's own diagnostics, such as `diagnostic(off, derivative_uniformity)`. Without
//! them a browser refuses what the author allowed. naga reads them and does not write them.

use naga::diagnostic_filter::{
    DiagnosticFilter, DiagnosticFilterNode, FilterableTriggeringRule, Severity,
    StandardFilterableTriggeringRule,
};
use naga::{Function, Handle, Module};

use lamplight_validate::functions;

type Leaf = Option<Handle<DiagnosticFilterNode>>;

/// The text that naga wrote of a module, with the filters of the module and of its functions.
///
/// # Errors
/// A message, where the text has another number of functions than the module.
pub fn with_filters(text: &str, module: &Module) -> Result<String, String> {
    if module.diagnostic_filters.is_empty() {
        return Ok(text.to_owned());
    }
    let own = written(module, module.diagnostic_filter_leaf, None);
    let directives: String = own.iter().map(|filter| format!("diagnostic{filter};\n")).collect();
    let mut functions = functions(module);
    let (mut out, mut has_directives) = (String::with_capacity(text.len()), false);
    for line in text.split_inclusive('\n') {
        // Directives come after `enable` and before all declarations.
        if !has_directives && !super::is_header_line(line) {
            out.push_str(&directives);
            has_directives = true;
        }
        if line.starts_with("fn ") {
            // naga adds functions of its own behind those of the module.
            if let Some(function) = functions.next() {
                out.push_str(&attributes(module, function));
            }
        }
        out.push_str(line);
    }
    match functions.next() {
        None => Ok(out),
        Some(_) => Err("a function was not written".to_owned()),
    }
}

/// A text that naga wrote, with derivatives allowed in any control flow, whatever its own filters say.
pub fn without_derivative_rule(text: &str) -> String {
    let text = without_derivative_filters(text);
    let header = text.split_inclusive('\n').take_while(|line| super::is_header_line(line));
    let (directives, rest) = text.split_at(header.map(str::len).sum());
    format!("{directives}diagnostic(off, derivative_uniformity);\n{rest}")
}

/// The text without the filters of this rule, which [`with_filters`] has put at the beginnings of
/// lines.
fn without_derivative_filters(text: &str) -> String {
    const RULE: &str = ", derivative_uniformity)";
    let mut changed = String::with_capacity(text.len());
    for line in text.split_inclusive('\n') {
        let mut rest = line;
        while let Some((filter, behind)) = rest
            .split_once(RULE)
            .filter(|(filter, _)| filter.trim_start_matches('@').starts_with("diagnostic("))
            .filter(|(filter, _)| !filter.contains(')'))
        {
            rest = if filter.starts_with('@') { behind.trim_start_matches(' ') } else { "" };
        }
        changed.push_str(rest);
    }
    changed
}

fn attributes(module: &Module, function: &Function) -> String {
    let own = written(module, function.diagnostic_filter_leaf, module.diagnostic_filter_leaf);
    own.iter().map(|filter| format!("@diagnostic{filter} ")).collect()
}

/// The filters between two nodes, the outermost first, as WGSL writes their arguments.
fn written(module: &Module, leaf: Leaf, end: Leaf) -> Vec<String> {
    let (mut next, mut found) = (leaf, Vec::new());
    while let Some(handle) = next.filter(|_| next != end) {
        let DiagnosticFilterNode { inner, parent } = &module.diagnostic_filters[handle];
        let DiagnosticFilter { new_severity, triggering_rule } = inner;
        let rule = rule_name(triggering_rule);
        found.push(format!("({}, {rule})", severity_name(*new_severity)));
        next = *parent;
    }
    found.reverse();
    found
}

fn severity_name(severity: Severity) -> &'static str {
    match severity {
        Severity::Off => "off",
        Severity::Info => "info",
        Severity::Warning => "warning",
        Severity::Error => "error",
    }
}

fn rule_name(rule: &FilterableTriggeringRule) -> String {
    match rule {
        FilterableTriggeringRule::Standard(
            StandardFilterableTriggeringRule::DerivativeUniformity,
        ) => "derivative_uniformity".to_owned(),
        FilterableTriggeringRule::Unknown(name) => name.to_string(),
        FilterableTriggeringRule::User(names) => names.join("."),
    }
}

#[cfg(test)]
mod tests {
    use super::without_derivative_rule;

    #[test]
    fn filters_of_the_rule_are_replaced_and_others_stay() {
        let text = "enable f16;\n\
            diagnostic(error, derivative_uniformity);\n\
            diagnostic(warning, subgroup_uniformity);\n\
            @diagnostic(error, derivative_uniformity) @diagnostic(off, other) fn f() {\n}\n";
        let expected = "enable f16;\n\
            diagnostic(warning, subgroup_uniformity);\n\
            diagnostic(off, derivative_uniformity);\n\
            @diagnostic(off, other) fn f() {\n}\n";
        assert_eq!(without_derivative_rule(text), expected);
    }
}
