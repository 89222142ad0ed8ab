//! The pages, used without a pointer.

use std::time::Duration;

use lamplight::browser::BrowserPage;
use serde_json::{Value, json};

use super::{Opened, Outcome, PATIENCE, text, wait, without_errors};

/// Names of keys, their numbers for Chromium, and what they type.
const KEYS: [(&str, u32, Option<&str>); 5] = [
    ("Tab", 9, None),
    ("Enter", 13, Some("\r")),
    ("Escape", 27, None),
    ("ArrowRight", 39, None),
    ("ArrowDown", 40, None),
];

/// How soon after a key the focus is shown.
const SOON: Duration = Duration::from_secs(10);

/// Every control of the main pages is reached by Tab, in the order of the page, and the focus can be
/// seen. Keys move sliders, lamps, models and tabs. The editor can be left, and links lead to what
/// they open.
pub fn keys() -> Outcome {
    let opened = Opened::new()?;
    catalogue(&opened)?;
    programs(&opened)?;
    playground(&opened)
}

/// Presses a key, as a keyboard does.
pub fn press(page: &BrowserPage, key: &str) -> Outcome {
    let found = KEYS.iter().find(|(name, ..)| *name == key);
    let (_, code, typed) = found.ok_or_else(|| format!("the table has no key {key}"))?;
    let mut event = json!({ "key": key, "code": key, "windowsVirtualKeyCode": code });
    event["type"] = json!(if typed.is_some() { "keyDown" } else { "rawKeyDown" });
    if let Some(typed) = typed {
        event["text"] = json!(typed);
    }
    page.call("Input.dispatchKeyEvent", event.clone())?;
    event["type"] = json!("keyUp");
    page.call("Input.dispatchKeyEvent", event)?;
    Ok(())
}

pub fn focus(page: &BrowserPage, selector: &str) -> Outcome {
    let there = format!("document.querySelector({})", Value::from(selector));
    wait(page, &format!("{there} !== null"))?;
    page.evaluate(&format!("{there}.focus()"), PATIENCE)?;
    Ok(())
}

/// What can be focused and is shown.
const CONTROLS: &str = "[...document.querySelectorAll('a[href], button, input, select, summary, [tabindex=\"0\"], .cm-content')]
    .filter((it) => it.tabIndex >= 0 && !it.disabled && it.checkVisibility())";

/// Whether the focused element has an outline and is not outside of the page.
const SEEN: &str = "(() => {
    const it = document.activeElement;
    if (it === document.body) return true;
    const { outlineStyle, outlineWidth } = getComputedStyle(it.closest('.cm-editor') ?? it);
    const { width, left, right } = it.getBoundingClientRect();
    return outlineStyle !== 'none' && outlineWidth !== '0px' && width > 0 && right > 0 && left < innerWidth;
})()";

/// Visits every control of the page by Tab. In the editor, where Tab types, Escape is pressed
/// first.
fn reached(page: &BrowserPage, name: &str) -> Outcome {
    page.evaluate(
        "(() => { document.activeElement?.blur(); getSelection().removeAllRanges(); window.reached = [];
            document.addEventListener('focusin', ({ target }) => window.reached.push(target)); })()",
        PATIENCE,
    )?;
    let count = page.evaluate(&format!("{CONTROLS}.length"), PATIENCE)?.as_u64().unwrap_or(0);
    assert!(count > 20, "{name} has {count} controls");
    let is_end = format!("document.activeElement === {CONTROLS}.at(-1)");
    // Chromium stops at some elements that are no controls.
    for _ in 0..2 * count {
        if page.evaluate(&is_end, PATIENCE)? == json!(true) {
            break;
        }
        press(page, "Tab")?;
        page.until(SEEN, SOON).map_err(|_| {
            let it = text(page, "document.activeElement.outerHTML.slice(0, 200)");
            format!("{name}: focused, and nobody sees it: {}", it.unwrap_or_default())
        })?;
        let typing = "document.activeElement.matches('.cm-content')";
        if page.evaluate(typing, PATIENCE)? == json!(true) {
            press(page, "Escape")?;
        }
    }
    let missing = format!(
        "{CONTROLS}.filter((it) => !window.reached.includes(it)).map((it) => it.outerHTML.slice(0, 200))"
    );
    assert_eq!(page.evaluate(&missing, PATIENCE)?, json!([]), "{name}: not reached by Tab");
    let disordered = "window.reached.some((it, index, all) => index > 0
        && all[index - 1].compareDocumentPosition(it) & Node.DOCUMENT_POSITION_PRECEDING)";
    assert_eq!(page.evaluate(disordered, PATIENCE)?, json!(false), "{name}: another order");
    Ok(())
}

fn catalogue(opened: &Opened) -> Outcome {
    let mut page = opened.page("#/catalogue/brdf::specular::blinn_phong")?;
    wait(&page, "document.querySelector('.live')?.dataset.device !== undefined")?;
    // The preview is drawn where it is seen, and has its controls then.
    page.evaluate("document.querySelector('.sketch canvas').scrollIntoView()", PATIENCE)?;
    wait(&page, "document.querySelector('.sketch canvas').dataset.drawn !== undefined")?;
    reached(&page, "catalogue")?;
    let address = text(&page, "location.hash")?;
    focus(&page, ".skip")?;
    press(&page, "Enter")?;
    wait(&page, "document.activeElement === document.querySelector('main')")?;
    assert_eq!(text(&page, "location.hash")?, address, "the skip link leads to another page");
    let numbers = "document.querySelector('.numbers').textContent";
    let before = text(&page, numbers)?;
    focus(&page, ".live input[type=range]")?;
    press(&page, "ArrowRight")?;
    wait(&page, &format!("{numbers} !== {}", Value::from(before)))?;
    focus(&page, ".list a[href$='/specular/phong.html']")?;
    press(&page, "Enter")?;
    wait(&page, "document.activeElement.matches('h1') && document.title.startsWith('phong ')")?;
    wait(&page, "document.querySelector('.list [aria-current]').textContent === 'phong'")?;
    page.evaluate("history.back()", PATIENCE)?;
    wait(&page, "document.querySelector('article h1')?.textContent === 'blinn_phong'")?;
    without_errors(&mut page)
}

fn programs(opened: &Opened) -> Outcome {
    let mut page = opened.page("#/programs/forward?scene=casters")?;
    wait(&page, "document.querySelectorAll('.lamp').length > 1")?;
    wait(&page, "document.querySelector('.texts pre') !== null")?;
    reached(&page, "programs")?;
    let drawn = "document.querySelector('canvas').dataset.drawn";
    let pictures = text(&page, drawn)?;
    focus(&page, ".lamp")?;
    press(&page, "ArrowDown")?;
    wait(&page, "location.hash.includes('lamps=0%3A')")?;
    wait(&page, &format!("{drawn} !== {}", Value::from(pictures)))?;
    without_errors(&mut page)
}

fn playground(opened: &Opened) -> Outcome {
    let mut page = opened.page("#/playground")?;
    let drawn = "document.querySelector('.sketch canvas').dataset.drawn";
    wait(&page, &format!("{drawn} !== undefined"))?;
    wait(&page, "document.querySelector('.texts pre') !== null")?;
    reached(&page, "playground")?;
    let pictures = text(&page, drawn)?;
    focus(&page, ".sketch canvas")?;
    press(&page, "ArrowRight")?;
    wait(&page, &format!("{drawn} !== {}", Value::from(pictures)))?;
    focus(&page, "[role=tab][aria-selected=true]")?;
    press(&page, "ArrowRight")?;
    wait(&page, "document.activeElement.matches('[role=tab][aria-selected=true]')")?;
    wait(&page, "document.activeElement.textContent === 'lamp.wesl'")?;
    wait(&page, "document.querySelector('.cm-content').textContent.includes('fn falloff')")?;
    // A file without an entry point is not an error.
    wait(&page, "document.querySelector('.status').textContent.startsWith('no errors')")?;
    wait(&page, "document.querySelector('.texts').textContent.includes('fn falloff')")?;
    let indented = "document.querySelector('.cm-line').textContent.startsWith('  ')";
    focus(&page, ".cm-content")?;
    // Escape is forgotten after another key.
    press(&page, "ArrowRight")?;
    press(&page, "Tab")?;
    wait(&page, indented)?;
    press(&page, "Escape")?;
    press(&page, "Tab")?;
    wait(&page, "!document.activeElement.closest('.cm-editor')")?;
    without_errors(&mut page)
}
