//! Pictures that the page draws: the toolchain says what to draw, and gets back what was drawn.
//!
//! A picture has passes, and each pass needs what the one before it drew. The devices of a page
//! answer asynchronously. So after each answer the picture is computed again from its beginning,
//! with the frames that are there. It stops at the first frame that is missing, and returns the
//! drawing for it. The rest of the code is that of `lamplight render`.

mod controls;
mod drawing;
mod sketch;
mod told;

use std::cell::RefCell;
use std::sync::Mutex;

use lamplight::bundle::{Language, Target};
use lamplight::catalogue::preset::{self, Number, Preset};
use lamplight::catalogue::probe::{self, Probe};
use lamplight::diagnostic::{self, Diagnostics, codes};
use lamplight::execute::Session;
use lamplight::execute::frame::{self, Frame};
use lamplight::execute::kernel::Kernel;
use lamplight::picture::frame::Programs;
use lamplight::picture::{self, Plan, Prepared, Shot, Surroundings};
use lamplight::scene::{ENVIRONMENTS, environment, sets};
use tsify::Ts;
use wasm_bindgen::prelude::wasm_bindgen;

use crate::diagnostic::{Diagnostic, diagnostics};
use crate::{Answer, answer};
use drawing::described;
use told::{Drawing, Named, PictureRequest, Pixels, PresetInfo, Step, Studio};

/// What is the same for all pictures.
struct Kept {
    programs: Programs,
    presets: Vec<Preset>,
    probes: Vec<Probe>,
}

/// The picture that is being drawn.
struct Current {
    work: Work,
    /// What was drawn so far, in order.
    given: Vec<Vec<Frame>>,
    wanted: Layout,
}

enum Work {
    Picture(PictureRequest),
    /// With the shot and the target.
    Sketch(Box<Prepared>, Shot, String),
}

/// Sizes of the frames of a drawing.
#[derive(Clone, Copy, Default)]
struct Layout {
    views: usize,
    targets: usize,
    pixels: usize,
    depth: bool,
}

thread_local! {
    static KEPT: RefCell<Option<Kept>> = const { RefCell::new(None) };
    static CURRENT: RefCell<Option<Current>> = const { RefCell::new(None) };
}

/// Scenes, environments and published examples.
#[wasm_bindgen]
pub fn studio() -> Answer<Studio> {
    let scenes = sets::ALL
        .iter()
        .map(|set| Named { name: set.name.to_owned(), about: set.about.to_owned() });
    let preset = |preset: &Preset| PresetInfo {
        name: preset.name.clone(),
        doc: preset.doc.clone(),
        source: preset.source.clone(),
        program: preset.program.clone(),
        key: preset.key.clone(),
        scene: preset.scene.clone(),
        deviations: preset.deviations.clone(),
    };
    let presets = with_kept(|kept| kept.presets.iter().map(preset).collect::<Vec<_>>());
    answer(&Studio {
        scenes: scenes.collect(),
        environments: ENVIRONMENTS.iter().map(|(name, ..)| (*name).to_owned()).collect(),
        presets: presets.unwrap_or_default(),
    })
}

/// Begins a picture, and forgets the one before it.
#[wasm_bindgen(js_name = pictureStart)]
pub fn picture_start(request: Ts<PictureRequest>) -> Answer<Step> {
    answer(&begun(Work::Picture(request.to_rust()?)))
}

fn begun(work: Work) -> Step {
    CURRENT.set(Some(Current { work, given: Vec::new(), wanted: Layout::default() }));
    step()
}

/// Continues with what was drawn: for each view, the words of all its targets. Then the depths of
/// each view, if they were to be kept.
#[wasm_bindgen(js_name = pictureFrames)]
pub fn picture_frames(words: Vec<u32>, depths: Vec<f32>) -> Answer<Step> {
    CURRENT.with_borrow_mut(|current| {
        let Some(current) = current else { return };
        let Layout { views, targets, pixels, depth } = current.wanted;
        let target = |view: usize, index: usize| {
            let start = 4 * pixels * (view * targets + index);
            words.get(start..start + 4 * pixels).unwrap_or_default().to_vec()
        };
        let frame = |view: usize| Frame {
            targets: (0..targets).map(|index| target(view, index)).collect(),
            depth: if depth {
                depths.get(pixels * view..pixels * (view + 1)).unwrap_or_default().to_vec()
            } else {
                Vec::new()
            },
            detour: None,
        };
        current.given.push((0..views).map(frame).collect());
    });
    answer(&step())
}

fn with_kept<T>(run: impl FnOnce(&Kept) -> T) -> Result<T, Vec<Diagnostic>> {
    KEPT.with_borrow_mut(|kept| {
        if kept.is_none() {
            *kept = Some(load()?);
        }
        kept.as_ref().map(run).ok_or_else(Vec::new)
    })
}

fn load() -> Result<Kept, Vec<Diagnostic>> {
    let programs =
        Programs::load().map_err(|(sources, problems)| diagnostics(&sources, &problems))?;
    let read = programs.with_texts(|texts| {
        let probes = probe::library(texts)?;
        Ok((preset::library_presets(texts, programs.manifest(), &probes)?, probes))
    });
    match read {
        Ok((presets, probes)) => Ok(Kept { presets, probes, programs }),
        Err(problems) => Err(diagnostics(&programs.texts(), &problems)),
    }
}

fn step() -> Step {
    let found = with_kept(|kept| {
        CURRENT.with_borrow_mut(|current| {
            let Some(current) = current else { return Err(Vec::new()) };
            advance(kept, current)
                .map_err(|problems| diagnostics(&kept.programs.texts(), &problems))
        })
    });
    match found.and_then(|found| found) {
        Ok(step) => step,
        Err(diagnostics) => Step { drawing: None, picture: None, diagnostics },
    }
}

/// Computes the picture from its beginning, up to the first frame that is missing or to its end.
fn advance(kept: &Kept, current: &mut Current) -> Result<Step, Diagnostics> {
    let page = |target: &str| {
        let target = Target::ALL.iter().copied().find(|known| known.name() == target);
        let target = target.ok_or_else(|| vec![refused("pages draw with `wgsl` or `essl300`")])?;
        Ok::<_, Diagnostics>(Page { given: &current.given, state: Mutex::default(), target })
    };
    let (page, rendered) = match &current.work {
        Work::Picture(request) => {
            let page = page(&request.target)?;
            let (plan, shot) = (plan(kept, request)?, shot(request)?);
            let rendered = picture::render_plan(&page, &kept.programs, &plan, &shot);
            (page, rendered)
        }
        Work::Sketch(prepared, shot, target) => {
            let page = page(target)?;
            let rendered = prepared.photograph(&page, shot).map(|picture| picture.develop());
            (page, rendered)
        }
    };
    let state = page.state.into_inner().unwrap_or_default();
    if let Some((drawing, layout)) = state.wanted {
        current.wanted = layout;
        return Ok(Step { drawing: Some(drawing), picture: None, diagnostics: Vec::new() });
    }
    let picture = rendered?;
    let rgba = picture.pixels.chunks(3).flat_map(|rgb| [rgb[0], rgb[1], rgb[2], 255]).collect();
    let pixels = Pixels { width: picture.width, height: picture.height, rgba };
    Ok(Step { drawing: None, picture: Some(pixels), diagnostics: Vec::new() })
}

fn refused(message: &str) -> diagnostic::Diagnostic {
    diagnostic::Diagnostic::error(codes::PICTURE_INVALID, message)
}

fn plan(kept: &Kept, request: &PictureRequest) -> Result<Plan, Diagnostics> {
    let preset = match &request.preset {
        None => None,
        Some(name) => {
            let found = kept.presets.iter().find(|preset| preset.name == *name);
            Some(found.ok_or_else(|| vec![refused(&format!("there is no preset `{name}`"))])?)
        }
    };
    let of_preset =
        preset.map(|preset| Plan::of_preset(&kept.programs, preset, &kept.probes)).transpose()?;
    let mut plan = match (of_preset, &request.key) {
        (Some(plan), None) => plan,
        (of_preset, key) => {
            let name = request.program.as_deref().or(preset.map(|preset| preset.program.as_str()));
            let key = key.as_deref().unwrap_or("");
            let point = Plan::of_key(&kept.programs, name.unwrap_or("forward"), key)?;
            match of_preset {
                Some(plan) => Plan { passes: point.passes, ..plan },
                None => point,
            }
        }
    };
    if let Some(scene) = &request.scene {
        plan.scene.clone_from(scene);
    }
    for (group, fields) in &request.numbers {
        let fields = fields.iter().map(|(field, number)| (field.clone(), number_of(number)));
        plan.numbers.entry(group.clone()).or_default().extend(fields);
    }
    plan.changes.uniforms.clone_from(&request.uniforms);
    for (index, place) in &request.lamps {
        if let (Ok(index), Ok(place)) = (index.parse(), <[f64; 3]>::try_from(&place[..])) {
            plan.changes.lamps.insert(index, place.into());
        }
    }
    Ok(plan)
}

fn number_of(components: &[f64]) -> Number {
    match components {
        [one] => Number::Scalar(*one),
        more => Number::Vector(more.to_vec()),
    }
}

fn shot(request: &PictureRequest) -> Result<Shot, Diagnostics> {
    const LARGEST: u32 = 2048;
    let name = request.environment.as_deref().unwrap_or("studio");
    let formula = environment(name)
        .ok_or_else(|| vec![refused(&format!("there is no environment `{name}`"))])?;
    Ok(Shot {
        size: [request.width, request.height].map(|side| side.clamp(1, LARGEST)),
        samples: request.samples.clamp(1, 64),
        exposure: request.exposure.clamp(-32.0, 32.0),
        cascades: 1,
        language: if request.glsl { Language::Glsl } else { Language::Wesl },
        surroundings: Surroundings::Formula(formula),
    })
}

/// A session that returns frames which were drawn before, and asks the page for the next ones.
struct Page<'a> {
    given: &'a [Vec<Frame>],
    state: Mutex<Told>,
    target: Target,
}

#[derive(Default)]
struct Told {
    used: usize,
    wanted: Option<(Drawing, Layout)>,
}

impl Session for Page<'_> {
    fn adapter(&self) -> String {
        "the page".to_owned()
    }

    fn run(&mut self, _: &Kernel, _: &[u32]) -> Result<Vec<u32>, diagnostic::Diagnostic> {
        Err(refused("the page runs no kernels"))
    }

    fn draw_frames(
        &self,
        drawing: &frame::Drawing<'_>,
    ) -> Result<Vec<Frame>, diagnostic::Diagnostic> {
        let mut told = self.state.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        if let Some(frames) = self.given.get(told.used) {
            told.used += 1;
            return Ok(frames.clone());
        }
        if told.wanted.is_none() {
            told.wanted = Some((described(drawing, self.target)?, layout(drawing)));
        }
        Err(refused("not drawn yet"))
    }
}

fn layout(drawing: &frame::Drawing<'_>) -> Layout {
    Layout {
        views: drawing.views.len(),
        targets: drawing.targets as usize,
        pixels: drawing.size[0] as usize * drawing.size[1] as usize,
        depth: drawing.state.keep_depth,
    }
}
