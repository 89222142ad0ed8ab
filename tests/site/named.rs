//! What screen readers announce of a page.

use lamplight::browser::BrowserPage;
use serde_json::{Value, json};

use super::{Outcome, PATIENCE};

/// Roles that say nothing without a name.
const NAMED: [&str; 16] = [
    "button",
    "checkbox",
    "combobox",
    "DisclosureTriangle",
    "form",
    "heading",
    "image",
    "link",
    "navigation",
    "region",
    "searchbox",
    "slider",
    "spinbutton",
    "tab",
    "tablist",
    "textbox",
];

/// In Chromium's accessibility tree, everything that can be focused or that needs a name has one. There
/// is one main heading, and a place where changes are announced.
pub fn named(page: &BrowserPage, name: &str) -> Outcome {
    page.call("Accessibility.enable", json!({}))?;
    let tree = page.call("Accessibility.getFullAXTree", json!({}))?;
    page.call("Accessibility.disable", json!({}))?;
    let nodes: Vec<&Value> = tree["nodes"].as_array().into_iter().flatten().collect();
    let shown = nodes.into_iter().filter(|node| node["ignored"] != true);
    let (mut nameless, mut main_headings, mut live, mut count) = (Vec::new(), 0, 0, 0);
    for node in shown {
        let role = node["role"]["value"].as_str().unwrap_or_default();
        let is_named = node["name"]["value"].as_str().is_some_and(|name| !name.trim().is_empty());
        let has = |name: &str, value: &Value| {
            let properties = node["properties"].as_array();
            properties.is_some_and(|all| {
                all.iter().any(|one| one["name"] == name && one["value"]["value"] == *value)
            })
        };
        count += 1;
        live += usize::from(has("live", &json!("polite")));
        main_headings += usize::from(role == "heading" && has("level", &json!(1)));
        // A click into the page focuses its main part, or what scrolls: these are no controls.
        let is_control = has("focusable", &json!(true)) && !["main", "generic"].contains(&role);
        if !is_named && (is_control || NAMED.contains(&role)) {
            nameless.push(role);
        }
    }
    let plain = "[...document.querySelectorAll(':is(div, span, pre, p, section)[tabindex=\"0\"]:not([role])')]
        .map((it) => it.outerHTML.slice(0, 200))";
    assert_eq!(page.evaluate(plain, PATIENCE)?, json!([]), "{name}: controls without a role");
    assert!(count > 50, "{name}: the accessibility tree has {count} nodes");
    assert_eq!(nameless, [] as [&str; 0], "{name}: nodes without a name");
    assert_eq!(main_headings, 1, "{name}: main headings");
    assert!(live > 0, "{name}: nothing announces changes");
    Ok(())
}
