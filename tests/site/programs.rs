//! The page of programs.

use lamplight::browser::BrowserPage;
use serde_json::Value;

use super::{Opened, Outcome, PATIENCE, text, wait, without_errors};

const PICTURE: &str = "document.querySelector('canvas').toDataURL()";

/// Whether the last picture has come, with smooth edges: it follows a quick one.
const SMOOTH: &str = "document.querySelector('canvas')?.dataset.smooth !== undefined
    && document.querySelector('canvas').dataset.coarse === undefined
    && document.querySelector('canvas').dataset.smooth === document.querySelector('canvas').dataset.drawn";

/// Whether there is another picture. A slow device shows a coarse one first, which does not count.
fn other_picture(than: String) -> String {
    format!("{SMOOTH} && {PICTURE} !== {}", Value::from(than))
}

/// Switching an axis changes the picture and the outputs, and the axis says what it costs. Values
/// that are impossible say why. A moved lamp and the number of a uniform change the picture. The link
/// has the choices, and a page that is opened with it shows the same picture.
pub fn programs() -> Outcome {
    let opened = Opened::new()?;
    let mut page = opened.page("#/programs/forward?scene=casters")?;
    wait(&page, SMOOTH)?;
    let before = text(&page, PICTURE)?;
    let greyed = "[...document.querySelectorAll('[data-axis=shadow_light] option, [data-axis=frequency] option, [data-axis=lights] option')]
        .filter((it) => it.disabled && it.title.endsWith('.')).length";
    let choose = |axis: &str, value: &str| {
        format!(
            "(() => {{ const it = document.querySelector('[data-axis={axis}]');
                it.value = [...it.options].find((one) => one.textContent === '{value}').value;
                it.dispatchEvent(new Event('change')); }})()"
        )
    };
    let outputs = "[...document.querySelectorAll('.texts pre')].map((it) => it.textContent).join()";
    wait(&page, &format!("{outputs}.includes('fn vs_main')"))?;
    let written = text(&page, outputs)?;
    page.evaluate(&choose("shadow", "hard"), PATIENCE)?;
    wait(&page, "document.querySelector('canvas').dataset.key?.includes('shadow=hard')")?;
    assert_ne!(before, text(&page, PICTURE)?, "the shadow does not change the picture");
    assert!(page.evaluate(greyed, PATIENCE)?.as_u64() > Some(0), "no value says why it is greyed");
    wait(&page, &format!("{outputs} !== {}", Value::from(written)))?;
    wait(&page, SMOOTH)?;
    let shadowed = text(&page, PICTURE)?;
    let cost = "document.querySelector('[data-axis=shadow]').closest('label').textContent";
    assert!(text(&page, cost)?.contains("cycles"), "the axis `shadow` says no cost");
    wait(&page, "document.querySelectorAll('.lamp').length > 1")?;
    page.evaluate(
        "document.querySelector('.lamp').dispatchEvent(new KeyboardEvent('keydown', { key: 'ArrowDown' }))",
        PATIENCE,
    )?;
    wait(&page, &other_picture(shadowed))?;
    let lit = text(&page, PICTURE)?;
    page.evaluate(
        "(() => { const it = document.querySelector('[data-path$=\".strength\"] input[type=number]');
            it.value = '0.25'; it.dispatchEvent(new Event('input')); })()",
        PATIENCE,
    )?;
    wait(&page, &other_picture(lit))?;
    let moved = text(&page, PICTURE)?;
    let link = text(&page, "location.hash")?;
    without_errors(&mut page)?;
    let again = opened.page(&link)?;
    wait(&again, &format!("{PICTURE} === {}", Value::from(moved)))?;
    compared(&again, &choose("shadow", "none"))?;
    enabled(&opened)
}

/// Axes are in groups. A value that needs others has a button that sets all of them.
fn enabled(opened: &Opened) -> Outcome {
    let mut page = opened.page("#/programs/forward")?;
    let groups = "[...document.querySelectorAll('form legend')].map((it) => it.textContent).join()";
    wait(&page, &format!("{groups} !== ''"))?;
    let found = text(&page, groups)?;
    assert!(found.starts_with("Light,Surface,Layers of glTF,Shadow"), "found `{found}`");
    let axis = "document.querySelector('[data-axis=clearcoat]')";
    assert_eq!(text(&page, &format!("String({axis}.value.includes('clearcoat'))"))?, "false");
    page.evaluate(
        &format!("{axis}.closest('div').querySelector('.blocked').open = true"),
        PATIENCE,
    )?;
    let button = format!("{axis}.closest('div').querySelector('.blocked button')");
    wait(&page, &format!("{button} !== null"))?;
    let words = text(&page, &format!("{button}.textContent"))?;
    assert!(words.contains("metallic_roughness") && words.contains("specular = ggx"), "{words}");
    assert!(words.starts_with("needs ") && words.ends_with(": set"), "found `{words}`");
    page.evaluate(&format!("{button}.click()"), PATIENCE)?;
    wait(&page, "document.querySelector('canvas').dataset.key?.includes('clearcoat')")?;
    without_errors(&mut page)
}

/// After a comparison begins and an axis is switched, the lines that only one text has are marked.
fn compared(page: &BrowserPage, switch: &str) -> Outcome {
    page.evaluate("document.querySelector('[aria-pressed]').click()", PATIENCE)?;
    wait(page, "document.querySelector('[aria-pressed=true]') !== null")?;
    page.evaluate(switch, PATIENCE)?;
    wait(page, "document.querySelector('.differences del') !== null")?;
    let removed =
        "[...document.querySelectorAll('.differences del')].map((it) => it.textContent).join('')";
    let removed = text(page, removed)?;
    assert!(removed.contains("shadow"), "expected code of the shadow among {removed}");
    assert!(removed.lines().all(|line| line.starts_with("- ")), "a line has no sign: {removed}");
    Ok(())
}
