//! Values of a pixel, at the lines of the text that made it.

use lamplight::browser::BrowserPage;
use libtest_mimic::Failed;
use serde_json::{Value, json};

use super::keys::{focus, press};
use super::{Opened, Outcome, PATIENCE, text, wait, without_errors};

/// The edges of the picture of the playground, and of those of programs.
const SKETCH: f64 = 320.0;
const PROGRAM: f64 = 384.0;

/// A stage whose values are known by hand: the middle of a pixel is half a pixel after its edge. The
/// root has no result left of the column 200.
const WESL: &str = "fn twice(x: f32) -> f32 {
    return 2.0 * x;
}
@fragment
fn fs_main(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let column = floor(at.x);
    let double = twice(column);
    let side = column - 200.0;
    let root = sqrt(side);
    return vec4f(double, side, 0.25, 1.0);
}
";

const GLSL: &str = "#version 450
layout(location = 0) out vec4 color;
float twice(float x) {
    return 2.0 * x;
}
void main() {
    float column = floor(gl_FragCoord.x);
    float doubled = twice(column);
    color = vec4(doubled, 0.5, 0.0, 1.0);
}
";

/// WGSL knows that a loop without `break` does not end, so this has one that nothing reaches.
const ENDLESS: &str = "@fragment
fn fs_main(@builtin(position) at: vec4f) -> @location(0) vec4f {
    var sum = at.x;
    while sum > 0.0 {
        sum = at.x;
    }
    return vec4f(sum);
}
";

/// A click on a pixel shows what each line of the author's text computed there, in WESL and in GLSL.
/// A bar goes through the run, neighbours have their own values, and keys do the same as a pointer. A
/// map shows all pixels with a kind of marks. Runs without an end and texts with mistakes say so. On
/// the page of a program, the run ends in the colour of the picture.
pub fn pixels() -> Outcome {
    let opened = Opened::new()?;
    let mut page = opened.page("#/playground")?;
    page.call("Emulation.setDeviceMetricsOverride", wide())?;
    drawn_anew(&page, WESL)?;
    lines(&page)?;
    neighbours(&page)?;
    map(&page)?;
    translated(&page)?;
    unfinished(&page)?;
    mistaken(&page)?;
    without_errors(&mut page)?;
    program(&opened)
}

/// A screen on which no pixel of a picture is smaller than one of the screen.
fn wide() -> Value {
    json!({ "width": 1280, "height": 900, "deviceScaleFactor": 1, "mobile": false })
}

/// Types a text over that of the editor, and waits for its picture.
fn drawn_anew(page: &BrowserPage, shader: &str) -> Outcome {
    let drawn = "document.querySelector('.sketch canvas')?.dataset.drawn";
    wait(page, &format!("{drawn} !== undefined"))?;
    let runs = "document.querySelector('main').dataset.runs";
    let (before, pictures) = (text(page, runs)?, text(page, drawn)?);
    replace(page, shader)?;
    wait(page, &format!("{runs} !== '{before}' && {drawn} !== '{pictures}'"))
}

fn replace(page: &BrowserPage, shader: &str) -> Outcome {
    let typed = format!(
        "(() => {{ document.querySelector('.cm-content').focus(); document.execCommand('selectAll');
            document.execCommand('insertText', false, {}); }})()",
        Value::from(shader)
    );
    page.evaluate(&typed, PATIENCE)?;
    Ok(())
}

/// Clicks the middle of a pixel of a picture, as a mouse does.
fn click(page: &BrowserPage, canvas: &str, [x, y]: [u32; 2], size: f64) -> Outcome {
    let place = format!(
        "(() => {{ const it = document.querySelector('{canvas}'); it.scrollIntoView({{ block: 'center' }});
            const box = it.getBoundingClientRect();
            return [box.left + {x}.5 / {size} * box.width, box.top + {y}.5 / {size} * box.height]; }})()"
    );
    let [left, top]: [f64; 2] = serde_json::from_value(page.evaluate(&place, PATIENCE)?)?;
    for kind in ["mousePressed", "mouseReleased"] {
        let event = json!({ "type": kind, "x": left, "y": top, "button": "left", "clickCount": 1 });
        page.call("Input.dispatchMouseEvent", event)?;
    }
    wait(page, &format!("document.querySelector('.pixel').dataset.pixel === '{x},{y}'"))
}

/// What stands at the end of the line that has some words; empty if nothing does.
fn ending(words: &str) -> String {
    format!(
        "([...document.querySelectorAll('.cm-line')].find((it) => it.textContent.includes({}))
            ?.querySelector('.ending')?.textContent ?? '')",
        Value::from(words)
    )
}

fn expect_endings(page: &BrowserPage, wanted: &[(&str, &str)]) -> Outcome {
    for (line, values) in wanted {
        let found = text(page, &ending(line))?;
        assert_eq!(found, *values, "at the line `{line}`");
    }
    Ok(())
}

/// Moves the bar to a step, counted from 0.
fn step_to(page: &BrowserPage, step: u32) -> Outcome {
    let script = format!(
        "(() => {{ const it = document.querySelector('.run input[type=range]'); it.value = {step};
            it.dispatchEvent(new Event('input')); }})()"
    );
    page.evaluate(&script, PATIENCE)?;
    Ok(())
}

fn lines(page: &BrowserPage) -> Outcome {
    click(page, ".sketch canvas", [160, 150], SKETCH)?;
    let domain = " ▲ outside the domain";
    expect_endings(
        page,
        &[
            ("fn twice", "x 160"),
            ("return 2.0", "return 320 → returns"),
            ("let column", "column 160"),
            ("let double", "double 320"),
            ("let side", "side -40"),
            ("let root", &format!("root NaN{domain}")),
            ("return vec4f", "return 320 -40 0.25 1 → returns"),
        ],
    )?;
    let took = text(page, "document.querySelector('.pixel').dataset.took")?;
    println!("the answer for a pixel came after {took} ms");
    // The call of the stage, `column`, and the call of `twice`.
    step_to(page, 2)?;
    expect_endings(page, &[("fn twice", "x 160"), ("let column", "column 160")])?;
    expect_endings(page, &[("let double", ""), ("let root", ""), ("return vec4f", "")])?;
    let now = text(page, "document.querySelector('.cm-now').textContent")?;
    assert!(now.starts_with("fn twice"), "the run is at `{now}`");
    // The mark leads to its line.
    page.evaluate("document.querySelector('.found button').click()", PATIENCE)?;
    expect_endings(page, &[("let root", &format!("root NaN{domain}")), ("return vec4f", "")])?;
    let now = text(page, "document.querySelector('.now').textContent")?;
    assert!(now.contains("lit.wesl:9") && now.contains("negative number"), "found `{now}`");
    Ok(())
}

fn neighbours(page: &BrowserPage) -> Outcome {
    // The pixel is the upper left one of its quad.
    page.evaluate("document.querySelectorAll('.quad button')[3].click()", PATIENCE)?;
    wait(page, "document.querySelector('.pixel').dataset.lane === '3'")?;
    expect_endings(page, &[("let column", "column 161"), ("let side", "side -39")])?;
    let both = text(page, "document.querySelector('.run tbody tr').textContent")?;
    assert_eq!(both, "return322 -39 0.25 1the same0320 -40 0.25 1");
    focus(page, ".sketch canvas")?;
    press(page, "ArrowRight")?;
    wait(page, "document.querySelector('.pixel').dataset.pixel === '161,150'")?;
    press(page, "ArrowDown")?;
    wait(page, "document.querySelector('.pixel').dataset.pixel === '161,151'")?;
    expect_endings(page, &[("let column", "column 161")])?;
    press(page, "Escape")?;
    wait(page, "document.querySelector('.ending') === null")?;
    assert_eq!(text(page, "document.querySelector('.run').checkVisibility()")?, "false");
    press(page, "Enter")?;
    wait(page, "document.querySelector('.pixel').dataset.pixel === '160,160'")
}

/// All pixels left of the column 200 have the mark, and no others.
fn map(page: &BrowserPage) -> Outcome {
    show_where(page, "Argument outside of the domain")?;
    let counted = "(() => {
        const it = document.querySelector('.picture .over');
        const { data, width } = it.getContext('2d').getImageData(0, 0, it.width, it.height);
        const counts = { marked: [0, 0], plain: [0, 0] };
        for (let at = 0; at < data.length / 4; at++) {
            if (data[4 * at + 3] === 0) continue;
            counts[data[4 * at] > 200 ? 'marked' : 'plain'][at % width < 200 ? 0 : 1]++;
        }
        return counts;
    })()";
    let found: Value = page.evaluate(counted, PATIENCE)?;
    let count = |kind: &str, side: usize| found[kind][side].as_u64().unwrap_or(0);
    assert!(count("marked", 0) > 1000 && count("plain", 1) > 1000, "found {found}");
    assert_eq!((count("marked", 1), count("plain", 0)), (0, 0), "found {found}");
    show_where(page, "Division by zero")?;
    let marked = text(page, "document.querySelector('.picture .over').dataset.marked")?;
    assert_eq!(marked, "0");
    Ok(())
}

fn show_where(page: &BrowserPage, title: &str) -> Outcome {
    choose_mark(page, title)?;
    wait(page, "document.querySelector('.picture .over').dataset.looked !== undefined")
}

fn choose_mark(page: &BrowserPage, title: &str) -> Outcome {
    let script = format!(
        "(() => {{ const it = document.querySelector('.marks select'); it.value = {};
            it.dispatchEvent(new Event('change')); }})()",
        Value::from(title)
    );
    page.evaluate(&script, PATIENCE)?;
    Ok(())
}

/// The same in GLSL, whose values are those of the translation, at the author's lines.
fn translated(page: &BrowserPage) -> Outcome {
    choose_mark(page, "nothing")?;
    page.evaluate(
        "[...document.querySelectorAll('[role=tab]')].find((it) => it.textContent === 'lit.frag.glsl').click()",
        PATIENCE,
    )?;
    wait(page, "document.querySelector('.cm-content').textContent.includes('#version')")?;
    drawn_anew(page, GLSL)?;
    click(page, ".sketch canvas", [170, 150], SKETCH)?;
    expect_endings(
        page,
        &[
            ("float twice", "x 170"),
            ("return 2.0", "return 340 → returns"),
            ("float column", "column 170"),
            ("float doubled", "doubled 340"),
            ("color = vec4", "color 340 0.5 0 1"),
        ],
    )
}

fn unfinished(page: &BrowserPage) -> Outcome {
    page.evaluate(
        "[...document.querySelectorAll('[role=tab]')].find((it) => it.textContent === 'lit.wesl').click()",
        PATIENCE,
    )?;
    wait(page, "document.querySelector('.cm-content').textContent.includes('fn twice')")?;
    drawn_anew(page, ENDLESS)?;
    let why = "document.querySelector('.run .problems').textContent";
    wait(page, &format!("{why}.includes('trips')"))?;
    let found = text(page, why)?;
    assert!(found.starts_with("lit.wesl:4: "), "expected the line of the loop in `{found}`");
    expect_endings(page, &[("var sum", "sum 170.5")])
}

fn mistaken(page: &BrowserPage) -> Outcome {
    replace(page, &WESL.replace("2.0 * x", "2.0 * y"))?;
    let status = "document.querySelector('.pixel > .note').textContent";
    wait(page, &format!("{status}.startsWith('The text has mistakes')"))?;
    assert_eq!(text(page, "document.querySelector('.ending')")?, "null");
    // Once it has none, the same pixel has values again.
    replace(page, WESL)?;
    wait(page, &format!("{} === 'column 170'", ending("let column")))
}

/// The last values of a program's run are the colour of the picture, before a display's coding.
fn program(opened: &Opened) -> Outcome {
    let mut page = opened.page("#/programs/forward?scene=casters&key=shadow=hard")?;
    page.call("Emulation.setDeviceMetricsOverride", wide())?;
    wait(&page, "document.querySelector('canvas').dataset.drawn !== undefined")?;
    click(&page, "canvas", [192, 230], PROGRAM)?;
    wait(&page, "document.querySelector('.listing .ending') !== null")?;
    let returned = "document.querySelector('.run tbody td').textContent";
    let colour = numbers(&text(&page, returned)?)?;
    let shown: Vec<f64> = serde_json::from_value(page.evaluate(
        "[...document.querySelector('canvas').getContext('2d').getImageData(192, 230, 1, 1).data].slice(0, 3)",
        PATIENCE,
    )?)?;
    for (linear, code) in colour.iter().zip(&shown) {
        let linear = linear.clamp(0.0, 1.0);
        let coded = match linear <= 0.0031308 {
            true => 12.92 * linear,
            false => 1.055 * linear.powf(1.0 / 2.4) - 0.055,
        };
        assert!(
            (255.0 * coded - code).abs() <= 2.0,
            "the run gives {colour:?}, shown is {shown:?}"
        );
    }
    let file = text(&page, "document.querySelector('.listing figcaption').textContent")?;
    assert_eq!(file, "lamplight/programs/forward.wesl");
    let took = text(&page, "document.querySelector('.pixel').dataset.took")?;
    println!("the answer for a pixel of `forward` came after {took} ms");
    let phone = json!({ "width": 390, "height": 844, "deviceScaleFactor": 1, "mobile": false });
    page.call("Emulation.setDeviceMetricsOverride", phone)?;
    let wide = page.evaluate("document.documentElement.scrollWidth", PATIENCE)?;
    assert_eq!(wide, json!(390), "with a run, the page is wider than a phone");
    without_errors(&mut page)
}

fn numbers(text: &str) -> Result<Vec<f64>, Failed> {
    text.split(' ').map(|one| one.parse().map_err(|_| format!("`{text}`").into())).collect()
}
