//! The site in a browser. Its pages open, its pictures are those of `lamplight render`, its controls
//! change them, mistakes are underlined at their place, and links keep the user's choices.
//! `cargo xtask test` builds the site first.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use lamplight::browser::serve::{Files, Server};
use lamplight::browser::{Browser, Page, Screenshot};
use lamplight::bundle::Language;
use lamplight::catalogue;
use lamplight::diagnostic::Diagnostics;
use lamplight::execute::{executors, on_thread};
use lamplight::picture::frame::Programs;
use lamplight::picture::{self, Picture, Plan, Shot, Surroundings};
use lamplight::scene::environment;
use libtest_mimic::{Failed, Trial};
use serde_json::{Value, json};

type Outcome = Result<(), Failed>;
type Case = (&'static str, fn() -> Outcome);

/// The longest wait for a page. It is large, since software draws and other trials run at the same
/// time.
const PATIENCE: Duration = Duration::from_secs(120);

pub fn trials() -> Vec<Trial> {
    let cases: [Case; 5] = [
        ("catalogue", catalogue),
        ("pictures", pictures),
        ("programs", programs),
        ("playground", playground),
        ("seen", seen),
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
    server: Server,
    browser: Arc<Browser>,
}

impl Opened {
    fn new() -> Result<Self, Failed> {
        let server = Server::start(Files::Folder(site()?))?;
        Ok(Self { server, browser: Browser::shared()? })
    }

    /// Opens a page, and waits until it is ready.
    fn page(&self, address: &str) -> Result<Page, Failed> {
        let page = self.browser.open(&self.server.address(address))?;
        page.until("document.body?.dataset.ready !== undefined", PATIENCE)?;
        Ok(page)
    }
}

fn text(page: &Page, expression: &str) -> Result<String, Failed> {
    let found = page.evaluate(expression, PATIENCE)?;
    Ok(found.as_str().map_or_else(|| found.to_string(), str::to_owned))
}

fn without_errors(page: &mut Page) -> Outcome {
    match page.errors() {
        [] => Ok(()),
        errors => Err(format!("the page has errors:\n{}", errors.join("\n")).into()),
    }
}

/// Every entry of the catalogue opens and shows its source. A plot changes with its slider, and the
/// search finds an entry.
fn catalogue() -> Outcome {
    let opened = Opened::new()?;
    let mut page = opened.page("#/catalogue")?;
    let modules = catalogue::library_modules();
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
    page.evaluate("location.hash = '#/catalogue/brdf::specular::blinn_phong'", PATIENCE)?;
    page.until("document.querySelectorAll('.live .curve').length > 0", PATIENCE)?;
    let curve = "document.querySelector('.live .curve').getAttribute('points')";
    let before = text(&page, curve)?;
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
    without_errors(&mut page)
}

/// Presets of several kinds: without shadow, with a shadow map, with blurred moments, with a cube
/// map.
const PRESETS: [&str; 4] = ["oglpg_7_4", "hpg_5_shadow", "hpg_7_vsm", "oglpg_7_13"];

/// The largest mean distance over all channels of all pixels, in steps of 255, and the largest share
/// of channels that differ by more than eight. Devices draw edges by different rules.
const TOLERANCE: (f64, f64) = (1.0, 0.02);

/// The page's pictures look like those of `lamplight render`, on WebGPU and on WebGL2. Without either,
/// the page says so.
fn pictures() -> Outcome {
    let opened = Opened::new()?;
    for (address, device) in [("#/gallery", "WebGPU"), ("?device=webgl2#/gallery", "WebGL2")] {
        let mut page = opened.page(address)?;
        for preset in PRESETS {
            let canvas = format!("document.querySelector('canvas[data-preset={preset}]')");
            page.evaluate(&format!("{canvas}.scrollIntoView()"), PATIENCE)?;
            page.until(&format!("{canvas}?.dataset.drawn === '1'"), PATIENCE)?;
            let pixels = text(&page, &format!("{canvas}.toDataURL('image/png')"))?;
            let name = format!("{preset} at {address}");
            compare(&name, &pixels, preset)?;
        }
        assert_eq!(text(&page, "document.body.dataset.device")?, device);
        without_errors(&mut page)?;
    }
    let mut page = opened.page("?device=none#/programs")?;
    let said = "document.querySelector('[role=status].status').textContent";
    page.until(&format!("{said}.includes('neither WebGPU nor WebGL2')"), PATIENCE)?;
    without_errors(&mut page)
}

fn compare(name: &str, data: &str, preset: &str) -> Outcome {
    let data = data.strip_prefix("data:image/png;base64,").ok_or("no picture")?;
    let bytes = BASE64_STANDARD.decode(data)?;
    let found = image::load_from_memory(&bytes)?.into_rgb8();
    let wanted = rendered(preset)?;
    assert_eq!(found.dimensions(), (wanted.width, wanted.height), "{name}");
    let distances: Vec<u8> =
        found.as_raw().iter().zip(&wanted.pixels).map(|(a, b)| a.abs_diff(*b)).collect();
    let count = distances.len() as f64;
    let mean = distances.iter().map(|one| f64::from(*one)).sum::<f64>() / count;
    let far = distances.iter().filter(|one| **one > 8).count() as f64 / count;
    println!("{name}: mean distance {mean:.3} steps, {:.2} % farther than 8", 100.0 * far);
    if mean > TOLERANCE.0 || far > TOLERANCE.1 {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("target/tmp/site");
        std::fs::create_dir_all(&folder)?;
        found.save(folder.join(format!("wrong-{preset}.png")))?;
        let (most, share) = TOLERANCE;
        let what = format!("the mean distance is {mean:.3}, at most {most}");
        let what = format!("{what}; {:.2} % are farther than 8, at most {share}", 100.0 * far);
        return Err(format!("{name}: {what}; see target/tmp/site/wrong-{preset}.png").into());
    }
    Ok(())
}

/// The picture of `lamplight render PRESET --size 192x192 --samples 4`.
fn rendered(preset: &str) -> Result<Picture, Failed> {
    let drawn = on_thread(|| {
        let programs = Programs::load().map_err(|(_, problems)| problems)?;
        let (presets, probes) =
            programs.with_texts(|texts| catalogue::library_examples(texts, programs.manifest()))?;
        let found = presets.iter().find(|one| one.name == preset).ok_or_else(Vec::new)?;
        let plan = Plan::of_preset(&programs, found, &probes)?;
        let sky = environment("studio").ok_or_else(Vec::new)?;
        let shot = Shot {
            size: [192; 2],
            samples: 4,
            exposure: 0.0,
            cascades: 1,
            language: Language::Wesl,
            surroundings: Surroundings::Formula(sky),
        };
        let painter = executors::vulkan::EXECUTOR.start().map_err(|_| Vec::new())?;
        picture::render_plan(painter.as_ref(), &programs, &plan, &shot)
    });
    let drawn = drawn.ok_or("the renderer stopped")?;
    drawn.map_err(|problems: Diagnostics| format!("{preset}: {problems:?}").into())
}

/// Switching an axis changes the picture and the outputs. Values that are impossible say why. The
/// link has the choices, and a page that is opened with it shows the same picture.
fn programs() -> Outcome {
    let opened = Opened::new()?;
    let mut page = opened.page("#/programs/forward?scene=casters")?;
    page.until("document.querySelector('canvas').dataset.drawn !== undefined", PATIENCE)?;
    let picture = "document.querySelector('canvas').toDataURL()";
    let before = text(&page, picture)?;
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
    page.until(&format!("{outputs}.includes('fn vs_main')"), PATIENCE)?;
    let written = text(&page, outputs)?;
    page.evaluate(&choose("shadow", "hard"), PATIENCE)?;
    page.until("document.querySelector('canvas').dataset.key?.includes('shadow=hard')", PATIENCE)?;
    assert_ne!(before, text(&page, picture)?, "the shadow does not change the picture");
    assert!(page.evaluate(greyed, PATIENCE)?.as_u64() > Some(0), "no value says why it is greyed");
    page.until(&format!("{outputs} !== {}", Value::from(written)), PATIENCE)?;
    let shadowed = text(&page, picture)?;
    page.evaluate(
        "document.querySelector('canvas').dispatchEvent(new KeyboardEvent('keydown', { key: 'ArrowLeft' }))",
        PATIENCE,
    )?;
    page.until(&format!("{picture} !== {}", Value::from(shadowed)), PATIENCE)?;
    let moved = text(&page, picture)?;
    let link = text(&page, "location.hash")?;
    without_errors(&mut page)?;
    let again = opened.page(&link)?;
    again.until(&format!("{picture} === {}", Value::from(moved)), PATIENCE)?;
    Ok(())
}

/// The playground shows outputs and a value for its first text, and underlines a mistake that is
/// typed, at its column.
fn playground() -> Outcome {
    let opened = Opened::new()?;
    let mut page = opened.page("#/playground")?;
    page.until(
        "document.querySelector('.texts pre')?.textContent.includes('fn lambert')",
        PATIENCE,
    )?;
    page.until("document.querySelector('.eval output').textContent === '0.25'", PATIENCE)?;
    // Types a text at the end of the line with `let n`.
    let typed = |text: &str| {
        format!(
            "(() => {{ const it = document.querySelector('.cm-content'); it.focus();
                const lines = [...document.querySelectorAll('.cm-line')];
                const line = lines.find((one) => one.textContent.includes('let n ='));
                const range = document.createRange(); range.selectNodeContents(line); range.collapse(false);
                getSelection().removeAllRanges(); getSelection().addRange(range);
                document.execCommand('insertText', false, {}); }})()",
            Value::from(text)
        )
    };
    page.evaluate(&typed(" let m = nowhere(n);"), PATIENCE)?;
    let mark = "document.querySelector('.cm-lintRange-error')?.textContent";
    page.until(&format!("{mark} === 'nowhere'"), PATIENCE)?;
    let problem = text(&page, "document.querySelector('.problems').textContent")?;
    assert!(problem.contains("lit.wesl:7:40: "), "expected lit.wesl:7:40 in `{problem}`");
    without_errors(&mut page)
}

/// The main pages at the widths of a phone and of a desktop screen. No page is wider than the screen,
/// and every control has a name for screen readers. Screenshots are left in `target/tmp/site/`.
fn seen() -> Outcome {
    let opened = Opened::new()?;
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("target/tmp/site");
    std::fs::create_dir_all(&folder)?;
    let pages = [
        (
            "catalogue",
            "#/catalogue/brdf::specular::blinn_phong",
            "document.querySelector('.live svg')",
        ),
        (
            "programs",
            "#/programs/forward?key=shadow=pcf_3x3",
            "document.querySelector('canvas').dataset.drawn",
        ),
        ("playground", "#/playground", "document.querySelector('.texts pre')"),
        ("gallery", "#/gallery", "document.querySelector('canvas').dataset.drawn"),
    ];
    for (name, address, there) in pages {
        let mut page = opened.page(address)?;
        page.until(&format!("!!{there}"), PATIENCE)?;
        let nameless = "[...document.querySelectorAll('input, select, button, a, canvas')].filter((it) =>
            !(it.getAttribute('aria-label') || it.labels?.length || it.textContent.trim())).map((it) => it.outerHTML)";
        assert_eq!(page.evaluate(nameless, PATIENCE)?, json!([]), "{name}: controls without name");
        for width in [360, 1280] {
            let bytes = page.screenshot(Screenshot { width, height: 900, whole: false })?;
            std::fs::write(folder.join(format!("{name}-{width}.png")), bytes)?;
        }
        page.screenshot(Screenshot { width: 360, height: 900, whole: false })?;
        let wide = "document.documentElement.scrollWidth";
        assert!(
            page.evaluate(wide, PATIENCE)?.as_u64().is_some_and(|found| found <= 360),
            "{name} is wider than a screen of 360 pixels"
        );
        without_errors(&mut page)?;
    }
    Ok(())
}
