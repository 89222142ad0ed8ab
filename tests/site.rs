//! The site in a browser. Its pages open, its pictures are those of `lamplight render`, its controls
//! change them, mistakes are underlined at their place, and links keep the user's choices.
//! `cargo xtask test` builds the site first.

mod files;
mod keys;
mod links;
mod lost;
mod named;
mod pictures;
mod pixels;
mod playground;
mod policy;
mod programs;
mod seen;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use lamplight::LIBRARY_FILES;
use lamplight::browser::serve::{HttpServer, ServedFiles};
use lamplight::browser::{Browser, BrowserPage};
use lamplight::catalogue;
use libtest_mimic::{Failed, Trial};
use serde_json::{Value, json};

type Outcome = Result<(), Failed>;
type Case = (&'static str, fn() -> Outcome);

/// The longest wait for a page. It is large, since software draws and other tests run at the same
/// time.
const PATIENCE: Duration = Duration::from_secs(120);

pub fn tests() -> Vec<Trial> {
    let cases: [Case; 12] = [
        ("catalogue", catalogue),
        ("files", files::files),
        ("arrival", files::arrival),
        ("pictures", pictures::pictures),
        ("pixels", pixels::pixels),
        ("programs", programs::programs),
        ("playground", playground::playground),
        ("seen", seen::seen),
        ("keys", keys::keys),
        ("lost", lost::lost),
        ("links", links::links),
        ("policy", policy::policy),
    ];
    cases.into_iter().map(|(name, case)| Trial::test(format!("site::{name}"), case)).collect()
}

fn site() -> Result<PathBuf, Failed> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("target/site");
    match folder.join("index.html").is_file() {
        true => Ok(folder),
        false => Err("there is no site: run `cargo xtask site --quick`".into()),
    }
}

/// The served site, and a browser.
struct Opened {
    server: HttpServer,
    browser: Arc<Browser>,
}

impl Opened {
    fn new() -> Result<Self, Failed> {
        let server = HttpServer::start(ServedFiles::Folder(site()?))?;
        Ok(Self { server, browser: Browser::shared()? })
    }

    /// Opens a page, and waits until it is ready.
    fn page(&self, address: &str) -> Result<BrowserPage, Failed> {
        let page = self.browser.open(&self.server.address(address))?;
        page.until("document.body?.dataset.ready !== undefined", PATIENCE)?;
        Ok(page)
    }
}

/// Waits for something. The error has the words that the page says meanwhile.
fn wait(page: &BrowserPage, expression: &str) -> Outcome {
    let messages = "[document.visibilityState, ...[...document.querySelectorAll('#notice, .status, .wrong, .problems, .eval output')]
        .map((it) => it.textContent)].join('; ')";
    page.until(expression, PATIENCE).map_err(|problem| match text(page, messages) {
        Ok(words) => format!("{problem}; the page says: {words}").into(),
        Err(_) => problem.into(),
    })
}

fn text(page: &BrowserPage, expression: &str) -> Result<String, Failed> {
    let found = page.evaluate(expression, PATIENCE)?;
    Ok(found.as_str().map_or_else(|| found.to_string(), str::to_owned))
}

fn without_errors(page: &mut BrowserPage) -> Outcome {
    match page.errors() {
        [] => Ok(()),
        errors => Err(format!("the page has errors:\n{}", errors.join("\n")).into()),
    }
}

/// Every entry of the catalogue opens and shows its source.
fn catalogue() -> Outcome {
    let opened = Opened::new()?;
    let mut page = opened.page("#/catalogue")?;
    let modules = catalogue::library_modules(LIBRARY_FILES);
    let items = modules.iter().flat_map(|module| &module.items);
    let paths: Vec<Value> = items.map(|item| json!([item.path(), item.name])).collect();
    let script = format!(
        "(async () => {{
            const wrong = [];
            for (const [path, name] of {}) {{
                location.hash = `#/catalogue/${{path}}`;
                const end = performance.now() + 60000;
                const there = () => document.querySelector('article h1')?.textContent === name
                    && document.querySelector('article .path')?.textContent === path
                    && document.querySelector('pre[aria-label=\"WESL source\"]')?.textContent.includes(name)
                    && document.body.dataset.ready === 'catalogue';
                while (!there() && performance.now() < end) {{
                    await new Promise((next) => setTimeout(next, 5));
                    // Chromium takes no more than 200 changes of an address in ten seconds.
                    if (!location.hash.startsWith(`#/catalogue/${{path}}`)) location.hash = `#/catalogue/${{path}}`;
                }}
                if (!there()) wrong.push(path);
            }}
            return wrong;
        }})()",
        Value::from(paths)
    );
    assert_eq!(page.evaluate(&script, PATIENCE)?, json!([]), "these entries do not open");
    plotted(&mut page)?;
    textured(&mut page)
}

/// A plot has the values of the GPU, and changes with its slider. The search finds an entry.
fn plotted(page: &mut BrowserPage) -> Outcome {
    page.evaluate("location.hash = '#/catalogue/brdf::specular::blinn_phong'", PATIENCE)?;
    page.until("document.querySelectorAll('.live .curve').length > 0", PATIENCE)?;
    page.until("document.querySelector('.live').dataset.device === 'WebGPU'", PATIENCE)?;
    let outside = "document.querySelector('.live').dataset.outside";
    assert_eq!(text(page, outside)?, "0", "the GPU's values are not within WGSL's bounds");
    let curve = "document.querySelector('.live .curve').getAttribute('points')";
    let before = text(page, curve)?;
    page.evaluate(
        "(() => { const it = document.querySelectorAll('.live input')[1]; it.value = it.min;
            it.dispatchEvent(new Event('input')); })()",
        PATIENCE,
    )?;
    page.until(&format!("{curve} !== {}", Value::from(before)), PATIENCE)?;
    page.evaluate(
        "(() => { const it = document.querySelector('input[type=search]'); it.value = 'schlick fresnel';
            it.dispatchEvent(new Event('input')); })()",
        PATIENCE,
    )?;
    page.until(
        "[...document.querySelectorAll('.list a')].some((it) => it.textContent === 'f_schlick')",
        PATIENCE,
    )?;
    without_errors(page)
}

/// A function that reads a texture of depths is drawn partly lit and partly in shadow.
fn textured(page: &mut BrowserPage) -> Outcome {
    page.evaluate("location.hash = '#/catalogue/shadow::compare::hard'", PATIENCE)?;
    page.until("document.querySelector('article h1')?.textContent === 'hard'", PATIENCE)?;
    let canvas = "document.querySelector('.sketch canvas')";
    wait(page, &format!("{canvas} !== null"))?;
    page.evaluate(&format!("{canvas}.scrollIntoView()"), PATIENCE)?;
    wait(page, &format!("{canvas}?.dataset.drawn !== undefined"))?;
    let shares = format!(
        "(() => {{
            const it = {canvas};
            const {{ data }} = it.getContext('2d').getImageData(it.width / 4, it.height / 4, it.width / 2, it.height / 2);
            const greens = data.filter((_, index) => index % 4 === 1);
            return [greens.filter((one) => one > 250).length, greens.filter((one) => one < 5).length]
                .map((count) => count / greens.length);
        }})()"
    );
    let found: [f64; 2] = serde_json::from_value(page.evaluate(&shares, PATIENCE)?)?;
    assert!(found.iter().all(|share| *share > 0.1), "lit and in shadow are {found:?}");
    without_errors(page)
}
