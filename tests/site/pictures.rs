//! The pictures of the pages, compared with those of the native tool.

use std::collections::BTreeMap;
use std::path::Path;

use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use lamplight::LIBRARY_FILES;
use lamplight::browser::BrowserPage;
use lamplight::bundle::Language;
use lamplight::catalogue;
use lamplight::compose::{self, Options};
use lamplight::diagnostic::Diagnostics;
use lamplight::execute::{executors, on_thread};
use lamplight::permute::Settings;
use lamplight::picture::frame::Programs;
use lamplight::picture::sketch::{Sketch, SketchOptions};
use lamplight::picture::{self, Picture, Plan, Shot, Surroundings};
use lamplight::project;
use lamplight::resolve::{self, Packages};
use lamplight::source::SourceSet;
use lamplight::validate::validate;
use libtest_mimic::Failed;

use super::{Opened, Outcome, PATIENCE, text, wait, without_errors};

/// Presets of several kinds: without shadow, with a shadow map, with blurred moments, with a cube
/// map.
const PRESETS: [&str; 4] = ["oglpg_7_4", "hpg_5_shadow", "hpg_7_vsm", "oglpg_7_13"];

/// The largest mean distance over all channels of all pixels, in steps of 255, and the largest share
/// of channels that differ by more than eight. Devices draw edges by different rules.
const TOLERANCE: (f64, f64) = (1.0, 0.02);

/// The page's pictures look like those of `lamplight render`, on WebGPU and on WebGL2. Without either,
/// the page says so.
pub fn pictures() -> Outcome {
    let opened = Opened::new()?;
    for (address, device) in [("#/gallery", "WebGPU"), ("?device=webgl2#/gallery", "WebGL2")] {
        let mut page = opened.page(address)?;
        for preset in PRESETS {
            let canvas = format!("document.querySelector('canvas[data-preset={preset}]')");
            // The canvas is hidden until it is drawn; its card is there.
            let card = format!("{canvas}.closest('article')");
            page.evaluate(&format!("{card}.scrollIntoView({{ block: 'center' }})"), PATIENCE)?;
            wait(&page, &format!("{canvas}?.dataset.drawn === '1'"))?;
            let pixels = text(&page, &format!("{canvas}.toDataURL('image/png')"))?;
            let name = format!("{preset} at {address}");
            compare(&name, &pixels, &rendered(preset)?)?;
        }
        assert_eq!(text(&page, "document.body.dataset.device")?, device);
        preview(&page, device)?;
        without_errors(&mut page)?;
    }
    let mut page = opened.page("?device=none#/programs")?;
    let status = "document.querySelector('[role=status].status').textContent";
    wait(&page, &format!("{status}.includes('neither WebGPU nor WebGL2')"))?;
    without_errors(&mut page)
}

fn compare(name: &str, data: &str, wanted: &Picture) -> Outcome {
    let data = data.strip_prefix("data:image/png;base64,").ok_or("no picture")?;
    let bytes = BASE64_STANDARD.decode(data)?;
    let found = image::load_from_memory(&bytes)?.into_rgb8();
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
        let file = format!("wrong-{}.png", name.split(' ').next().unwrap_or_default());
        found.save(folder.join(&file))?;
        let (most, share) = TOLERANCE;
        let what = format!("the mean distance is {mean:.3}, at most {most}");
        let what = format!("{what}; {:.2} % are farther than 8, at most {share}", 100.0 * far);
        return Err(format!("{name}: {what}; see target/tmp/site/{file}").into());
    }
    Ok(())
}

/// The picture of `lamplight render PRESET --size 256x192 --samples 4`.
fn rendered(preset: &str) -> Result<Picture, Failed> {
    let drawn = on_thread(|| {
        let programs = Programs::load(LIBRARY_FILES).map_err(|(_, problems)| problems)?;
        let (presets, probes) = programs.with_texts(|texts| {
            catalogue::library_examples(LIBRARY_FILES, texts, programs.manifest())
        })?;
        let found = presets.iter().find(|one| one.name == preset).ok_or_else(Vec::new)?;
        let plan = Plan::of_preset(&programs, found, &probes)?;
        let shot = Shot { size: [256, 192], ..shot(192).ok_or_else(Vec::new)? };
        let painter = executors::vulkan::EXECUTOR.start().map_err(|_| Vec::new())?;
        picture::render_plan(painter.as_ref(), &programs, &plan, &shot)
    });
    let drawn = drawn.ok_or("the renderer stopped")?;
    drawn.map_err(|problems: Diagnostics| format!("{preset}: {problems:?}").into())
}

/// The function whose preview is compared. It has parameters of the surface, and one that is a
/// uniform.
const FUNCTION: &str = "brdf::diffuse::oren_nayar";

/// The preview of a function in the catalogue is the picture of its stage, which the link to the
/// playground has.
fn preview(page: &BrowserPage, device: &str) -> Outcome {
    page.evaluate(&format!("location.hash = '#/catalogue/{FUNCTION}'"), PATIENCE)?;
    let canvas = "document.querySelector('.sketch canvas')";
    wait(page, &format!("{canvas} !== null"))?;
    page.evaluate(&format!("{canvas}.scrollIntoView({{ block: 'center' }})"), PATIENCE)?;
    wait(page, &format!("{canvas}?.dataset.drawn !== undefined"))?;
    let pixels = text(page, &format!("{canvas}.toDataURL('image/png')"))?;
    let link = "(async () => {
        const packed = document.querySelector('.live a').href.split('state=')[1];
        const bytes = Uint8Array.from(atob(packed.replaceAll('-', '+').replaceAll('_', '/')), (one) => one.charCodeAt(0));
        const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate-raw'));
        const { files, look } = JSON.parse(await new Response(stream).text());
        return [Object.values(files)[0], look.uniforms];
    })()";
    let (stage, uniforms): (String, _) = serde_json::from_value(page.evaluate(link, PATIENCE)?)?;
    assert!(stage.contains("oren_nayar(n, l, v, knobs.sigma)"), "the stage is {stage}");
    compare(&format!("{FUNCTION} on {device}"), &pixels, &sketched(&stage, uniforms)?)
}

/// The picture of a fragment stage as the catalogue shows it first.
fn sketched(stage: &str, uniforms: BTreeMap<String, Vec<f64>>) -> Result<Picture, Failed> {
    const PATH: &str = "stage.wesl";
    let mut packages = Packages::of_text(PATH, stage.to_owned());
    packages.add(project::library_package());
    let draw = || {
        let mut sources = SourceSet::default();
        let graph = resolve::load(&mut sources, &packages, PATH, Language::Wesl)?;
        let composed = compose::compose(&graph, &Settings::default(), &Options::default())?;
        let sketch = Sketch::new(validate(&composed)?, None).map_err(|problem| vec![problem])?;
        let (turn, lamp) = ([0.0, 0.3], [1.6, 2.0, 2.4].into());
        let setting = SketchOptions { turn, lamp, uniforms, ..SketchOptions::default() };
        let shot = shot(320).ok_or_else(Vec::new)?;
        let painter = executors::vulkan::EXECUTOR.start().map_err(|_| Vec::new())?;
        let picture = sketch.prepare(&setting, &shot)?.photograph(painter.as_ref(), &shot)?;
        Ok(picture.develop())
    };
    let drawn = on_thread(draw).ok_or("the renderer stopped")?;
    drawn.map_err(|problems: Diagnostics| format!("{stage}: {problems:?}").into())
}

/// How pages take pictures, without an environment of their own.
fn shot(size: u32) -> Option<Shot> {
    Some(Shot {
        size: [size; 2],
        samples: 4,
        exposure: 0.0,
        cascades: 1,
        language: Language::Wesl,
        surroundings: Surroundings::Usual,
    })
}
