//! What a browser may load and run for a page: its content security policy.

use std::path::{Path, PathBuf};
use std::process::Command;

use lamplight::browser::serve::{HttpServer, ServedFiles};
use lamplight::browser::{Browser, BrowserPage};
use lamplight::picture::gallery::{html_page, strip_file};
use libtest_mimic::Failed;
use serde_json::json;

use super::{Outcome, PATIENCE, site, text, wait, without_errors};
use crate::render;

/// Pages of the site, each with what is there once it is complete.
const PAGES: [(&str, &str); 11] = [
    ("", "document.querySelector('.stage canvas').dataset.drawn"),
    ("functions/brdf/specular/d_ggx.html", "document.querySelector('.live')?.dataset.device"),
    ("guide/cases.html", "document.querySelector('.neighbours')"),
    ("#/catalogue/brdf::specular::blinn_phong", "document.querySelector('.live')?.dataset.device"),
    (
        "#/programs/forward?key=shadow=pcf_3x3",
        "document.querySelector('canvas').dataset.controls && document.querySelector('.texts pre')",
    ),
    (
        "?device=webgl2#/programs/forward",
        "document.querySelector('canvas').dataset.controls && document.querySelector('.texts pre')",
    ),
    (
        "#/playground",
        "document.querySelector('.texts pre') && document.querySelector('.sketch canvas').dataset.drawn",
    ),
    ("#/gallery", "document.querySelector('canvas').dataset.drawn"),
    ("#/guide", "document.querySelector('.guide h1')"),
    ("#/speed", "document.querySelector('tbody tr')"),
    ("#/nowhere", "document.querySelector('main h1')"),
];

/// Keeps what the policy forbids, from the first line of the page on.
const WATCH: &str = "addEventListener('securitypolicyviolation', (event) => {
    (window.forbidden ??= []).push(`${event.effectiveDirective} ${event.blockedURI}`); });";

/// What was forbidden so far.
const FORBIDDEN: &str = "(window.forbidden ?? []).join('; ')";

/// What an attacker would try in a page. None of it may happen.
const ATTACK: &str = "(async () => {
    const script = document.createElement('script');
    script.textContent = 'window.ran = true';
    document.body.append(script);
    const picture = document.createElement('img');
    picture.src = 'http://127.0.0.1:9/picture.png';
    document.body.append(picture);
    const frame = document.createElement('iframe');
    frame.src = 'http://127.0.0.1:9/';
    document.body.append(frame);
    try { await fetch('http://127.0.0.1:9/'); } catch { }
    // Not at once, since Chromium allows this to a debugger's own call.
    setTimeout(() => { try { window.ran = (0, eval)('true'); } catch { } });
    for (let turn = 0; turn < 500 && (window.forbidden ?? []).length < 5; turn++) await new Promise((next) => setTimeout(next, 10));
    return [...new Set((window.forbidden ?? []).map((one) => one.split(' ')[0]))].sort().join(' ');
})()";

/// What the policy of every page forbids of that.
const REFUSED: &str = "connect-src frame-src img-src script-src script-src-elem";

/// Every page of the site, the report of a check and the gallery's page load under their policies
/// without a violation. The policies forbid scripts in the page, and whatever is elsewhere.
pub fn policy() -> Outcome {
    let server = HttpServer::start(ServedFiles::Folder(site()?))?;
    for (address, there) in PAGES {
        let mut page = watched(&server.address(address))?;
        wait(&page, &format!("!!({there})"))?;
        kept(&mut page, address)?;
    }
    let folder = tempfile::tempdir()?;
    let report = report(folder.path())?;
    let mut page = watched(&format!("file://{}", report.display()))?;
    page.until(
        "getComputedStyle(document.querySelector('table')).borderCollapse === 'collapse'",
        PATIENCE,
    )?;
    kept(&mut page, "the report")?;
    let gallery = gallery(folder.path())?;
    let mut page = watched(&format!("file://{}", gallery.display()))?;
    page.until("document.querySelector('img')?.naturalWidth > 0", PATIENCE)?;
    kept(&mut page, "the gallery")
}

/// A page that keeps what its policy forbids.
fn watched(address: &str) -> Result<BrowserPage, Failed> {
    let page = Browser::shared()?.open("about:blank")?;
    page.call("Page.addScriptToEvaluateOnNewDocument", json!({ "source": WATCH }))?;
    page.go(address)?;
    page.loaded(PATIENCE)?;
    Ok(page)
}

/// Nothing was forbidden so far, and an attack is.
fn kept(page: &mut BrowserPage, name: &str) -> Outcome {
    assert_eq!(text(page, FORBIDDEN)?, "", "{name}: its policy forbids what it does");
    without_errors(page)?;
    assert_eq!(text(page, ATTACK)?, REFUSED, "{name}: what its policy forbids of an attack");
    assert_eq!(text(page, "String(window.ran)")?, "undefined", "{name}: a script ran");
    Ok(())
}

/// The page of the gallery, beside the comparisons.
fn gallery(folder: &Path) -> Result<PathBuf, Failed> {
    let (cards, strips) = render::gallery_cards()?;
    let cards: Vec<_> = cards.iter().collect();
    let compared = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/gallery");
    std::fs::create_dir(folder.join("compared"))?;
    for card in &strips {
        let file = strip_file(&card.comparison.name);
        std::fs::copy(compared.join(&file), folder.join(&file))?;
    }
    let page = folder.join("index.html");
    std::fs::write(&page, html_page(&cards, &strips))?;
    Ok(page)
}

/// The page of a check of a module whose name is markup, with lines and a map.
fn report(folder: &Path) -> Result<PathBuf, Failed> {
    let name = "<img src=http://127.0.0.1:9>";
    let name = name.replace('/', "&");
    std::fs::write(
        folder.join(format!("{name}.wesl")),
        "fn product(x: f32, y: f32) -> f32 { return x * y; }\n",
    )?;
    std::fs::write(
        folder.join(format!("{name}.toml")),
        "[[case]]\nfunction = \"product\"\nformula = \"x * y\"\n[case.inputs]\n\
         x = { grid = [0, 1], count = 9 }\ny = { grid = [0, 1], count = 9 }\n",
    )?;
    let mut check = Command::new(env!("CARGO_BIN_EXE_lamplight"));
    let ran = check.args(["check", ".", "--report", "out"]).current_dir(folder).output()?;
    let page = folder.join("out/index.html");
    match page.is_file() {
        true => Ok(page),
        false => Err(String::from_utf8_lossy(&ran.stderr).into()),
    }
}
