//! How the pages look.

use std::path::Path;

use image::RgbImage;
use image::imageops::{FilterType, resize};
use lamplight::browser::{BrowserPage, Screenshot};
use libtest_mimic::Failed;
use serde_json::{Value, json};

use super::named::named;
use super::{Opened, Outcome, PATIENCE, text, wait, without_errors};

/// The widths of a phone and of a desktop screen.
const WIDTHS: [u32; 2] = [360, 1280];

/// The width of the pages in dark.
const DARK: u32 = 1280;

/// The most bytes that a page loads before the toolchain, not compressed.
const FIRST_VIEW: u64 = 1_000_000;

/// The smallest contrast of text that WCAG 2.2 accepts (1.4.3).
const CONTRAST: f64 = 4.5;

/// A page by its name, its address, and what is there once it is complete.
type Shown = (&'static str, &'static str, &'static str);

const PAGES: [Shown; 6] = [
    ("home", "", "document.querySelector('.stage canvas').dataset.drawn"),
    (
        "catalogue",
        "#/catalogue/brdf::specular::blinn_phong",
        "document.querySelector('.live')?.dataset.device",
    ),
    (
        "programs",
        "#/programs/forward?key=shadow=pcf_3x3",
        "document.querySelector('canvas').dataset.controls && document.querySelector('.texts pre')",
    ),
    (
        "playground",
        "#/playground",
        "document.querySelector('.texts pre') && document.querySelector('.sketch canvas').dataset.drawn",
    ),
    ("gallery", "#/gallery", "document.querySelector('canvas').dataset.drawn"),
    ("guide", "#/guide", "document.querySelector('.guide h1')"),
];

/// The main pages at the widths of a phone and of a desktop screen, and in dark, look as they did
/// when somebody looked at them. No page is wider than the screen, every control has a name for
/// screen readers, and texts can be read in light and dark. Before the toolchain, a page loads
/// little, and only the site's own files.
pub fn seen() -> Outcome {
    let opened = Opened::new()?;
    let mut wrong = Vec::new();
    for (name, address, there) in PAGES {
        let mut page = opened.page(address)?;
        wait(&page, &format!("!!({there})"))?;
        named(&page, name)?;
        small_and_own(&page, name)?;
        for width in WIDTHS {
            wrong.extend(as_reviewed(&page, &format!("{name}-{width}"), width)?);
        }
        in_scheme(&page, "dark")?;
        wrong.extend(as_reviewed(&page, &format!("{name}-dark"), DARK)?);
        in_scheme(&page, "light")?;
        page.screenshot(Screenshot { width: 360, height: 900, whole: false })?;
        let wide = page.evaluate("document.documentElement.scrollWidth", PATIENCE)?;
        assert!(wide.as_u64().is_some_and(|found| found <= 360), "{name} is {wide} pixels wide");
        without_errors(&mut page)?;
    }
    readable(&opened)?;
    match wrong.is_empty() {
        true => Ok(()),
        false => Err(wrong.join("\n").into()),
    }
}

/// A page loads only the site's own files, and few bytes before the toolchain.
fn small_and_own(page: &BrowserPage, name: &str) -> Outcome {
    let loaded = page.evaluate(
        "performance.getEntriesByType('resource').map((it) => [it.name, it.encodedBodySize])",
        PATIENCE,
    )?;
    let origin = text(page, "location.origin")?;
    let mut first = 0;
    for entry in loaded.as_array().into_iter().flatten() {
        let (Some(file), Some(bytes)) = (entry[0].as_str(), entry[1].as_u64()) else { continue };
        assert!(file.starts_with(&origin), "{name} loads {file}");
        let is_toolchain = file.ends_with(".wasm") || file.ends_with(".packed");
        first += if is_toolchain { 0 } else { bytes };
    }
    assert!(first > 0, "{name} loads nothing");
    assert!(first < FIRST_VIEW, "{name} loads {first} bytes before the toolchain");
    Ok(())
}

/// Whether a line number of the editor is not beside its line.
const SHIFTED: &str = "[...document.querySelectorAll('.cm-lineNumbers .cm-gutterElement')]
    .filter((it) => it.style.visibility !== 'hidden').some((it, index) => {
        const line = document.querySelectorAll('.cm-line')[index];
        return Math.abs(line.getBoundingClientRect().top - it.getBoundingClientRect().top) > 2;
    })";

/// What differs from run to run, or with every new axis, is not compared. The pictures of the
/// gallery are drawn one after another, and compared in `site::pictures`.
const HIDE: &str = "document.head.insertAdjacentHTML('beforeend',
    '<style>.status, .note, .axes, .cm-cursorLayer, .texts, .card canvas, .card img, .stage canvas { visibility: hidden }</style>')";

/// Pictures are compared in cells of this many pixels, so that the edges of letters do not count.
const CELL: u32 = 8;
/// The largest share of cells that differ by more than a number of steps. Devices draw edges by
/// different rules, and a list may get one more line.
const TOLERANCE: (f64, u8) = (0.04, 24);

/// Compares a page with its reference in `tests/site/reviewed/`, or writes the reference.
fn as_reviewed(page: &BrowserPage, name: &str, width: u32) -> Result<Option<String>, Failed> {
    page.evaluate(HIDE, PATIENCE)?;
    let shot = Screenshot { width, height: 900, whole: false };
    page.screenshot(shot)?;
    // The editor measures its lines anew after the width has changed.
    wait(page, &format!("!({SHIFTED})"))?;
    let bytes = page.screenshot(shot)?;
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let reference = root.join(format!("tests/site/reviewed/{name}.png"));
    if std::env::var_os("UPDATE_EXPECT").is_some() {
        std::fs::write(reference, bytes)?;
        return Ok(None);
    }
    let found = image::load_from_memory(&bytes)?.into_rgb8();
    let folder = root.join("target/tmp/site");
    std::fs::create_dir_all(&folder)?;
    std::fs::write(folder.join(format!("{name}.png")), bytes)?;
    let wanted = image::open(&reference)
        .map_err(|error| {
            format!("{}: {error}; run `cargo xtask record site::seen`", reference.display())
        })?
        .into_rgb8();
    if found.dimensions() != wanted.dimensions() {
        return Ok(Some(format!("{name} has another size than its reference")));
    }
    let (most, steps) = TOLERANCE;
    let share = different_cells(&found, &wanted, steps);
    println!("{name}: {:.2} % of the cells differ", 100.0 * share);
    let what = || {
        format!(
            "{:.1} % of the cells of {name} differ from the reference, at most {:.0} %; look at \
             target/tmp/site/{name}.png, then run `cargo xtask record site::seen`",
            100.0 * share,
            100.0 * most
        )
    };
    Ok((share > most).then(what))
}

fn different_cells(one: &RgbImage, other: &RgbImage, steps: u8) -> f64 {
    let cells = |picture: &RgbImage| {
        resize(picture, picture.width() / CELL, picture.height() / CELL, FilterType::Triangle)
    };
    let (one, other) = (cells(one), cells(other));
    let is_far = |(a, b): (&image::Rgb<u8>, &image::Rgb<u8>)| {
        a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > steps)
    };
    let far = one.pixels().zip(other.pixels()).filter(|pair| is_far(*pair)).count();
    far as f64 / f64::from(one.width() * one.height())
}

/// Shows a page as somebody sees it who prefers light or dark.
fn in_scheme(page: &BrowserPage, scheme: &str) -> Outcome {
    let features = json!([{ "name": "prefers-color-scheme", "value": scheme }]);
    page.call("Emulation.setEmulatedMedia", json!({ "features": features }))?;
    Ok(())
}

/// The colours of texts, those of code among them.
const INKS: [&str; 11] = [
    "--ink",
    "--quiet",
    "--accent",
    "--wrong",
    "--added",
    "--tok-keyword",
    "--tok-type",
    "--tok-number",
    "--tok-string",
    "--tok-attribute",
    "--tok-function",
];

/// Every colour of text has enough contrast with what is behind it, in light and dark.
fn readable(opened: &Opened) -> Outcome {
    let page = opened.page("#/guide")?;
    for scheme in ["light", "dark"] {
        in_scheme(&page, scheme)?;
        let color = |name: &str| -> Result<f64, Failed> {
            let value = format!(
                "getComputedStyle(document.documentElement).getPropertyValue({}).trim()",
                Value::from(name)
            );
            let value = text(&page, &value)?;
            luminance(&value).ok_or_else(|| format!("{name} is `{value}`").into())
        };
        for ink in INKS {
            for paper in ["--paper", "--card"] {
                let (a, b) = (color(ink)?, color(paper)?);
                let contrast = (a.max(b) + 0.05) / (a.min(b) + 0.05);
                assert!(contrast >= CONTRAST, "{scheme}: {ink} on {paper} has {contrast:.2}");
            }
        }
    }
    Ok(())
}

/// Relative luminance of a colour in six hexadecimal digits, as WCAG defines it.
fn luminance(color: &str) -> Option<f64> {
    let digits = color.strip_prefix('#').filter(|digits| digits.len() == 6)?;
    let linear = |at: usize| {
        let code = f64::from(u8::from_str_radix(digits.get(at..at + 2)?, 16).ok()?) / 255.0;
        Some(if code <= 0.04045 { code / 12.92 } else { ((code + 0.055) / 1.055).powf(2.4) })
    };
    Some(0.2126 * linear(0)? + 0.7152 * linear(2)? + 0.0722 * linear(4)?)
}
