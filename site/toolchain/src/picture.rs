//! Pictures that the page draws: the toolchain says what to draw, and gets back what was drawn.
//!
//! A picture has passes, and each pass needs what the one before it drew. The devices of a page
//! answer asynchronously. So after each answer the passes are computed again from the first, with
//! the frames that are there. That stops at the first frame that is missing, and returns the
//! drawing for it. Once all passes but the last are drawn, what was prepared is kept. The rest of
//! the code is that of `lamplight render`.
//!
//! A pass that draws the same as in an earlier picture, such as a shadow map while materials change,
//! is not drawn again.

mod author;
mod controls;
mod drawing;
pub mod exchange;
mod seen;
pub mod sketch;

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

use lamplight::LIBRARY_FILES;
use lamplight::bundle::{Language, Target};
use lamplight::diagnostic::{self, Diagnostics, codes};
use lamplight::source::SourceSet;
use lamplight_catalogue::preset::{self, Preset, PresetNumber};
use lamplight_catalogue::probe::{self, Probe};
use lamplight_execute::Session;
use lamplight_execute::frame::{self, Frame};
use lamplight_execute::kernel::Kernel;
use lamplight_picture::frame::Programs;
use lamplight_picture::{self as picture, Plan, PreparedPass, Shot, Surroundings};
use lamplight_scenes::{ENVIRONMENTS, sets};
use tsify::Ts;
use wasm_bindgen::prelude::wasm_bindgen;

use crate::diagnostic::{Diagnostic, diagnostics};
use crate::{Answer, answer};
use drawing::described;
use exchange::{Drawing, Named, PictureRequest, Pixels, PresetInfo, Step, Studio};
use seen::Known;

/// What is the same for all pictures.
struct Kept {
    programs: Programs,
    presets: Vec<Preset>,
    probes: Vec<Probe>,
}

/// The picture that is being drawn.
struct Current {
    work: Work,
    /// What was drawn so far, by the place of the drawing in the picture.
    given: BTreeMap<usize, Arc<Vec<Frame>>>,
    /// What the page draws now.
    wanted: Option<RequestedDrawing>,
    /// The last pass, once all frames before it are there.
    ready: Option<Ready>,
}

/// A drawing that the page was asked for.
struct RequestedDrawing {
    place: usize,
    layout: Layout,
    known: Option<Known>,
}

/// The last pass.
struct Ready {
    prepared: Box<PreparedPass>,
    shot: Shot,
    /// Whether the rows of the picture come in the other order.
    is_upside_down: bool,
    /// How many drawings come before it.
    before: usize,
}

enum Work {
    Picture(Box<PictureRequest>),
    /// Its target. All passes but the last are drawn.
    Sketch(String),
}

impl Work {
    fn target(&self) -> Result<Target, Diagnostics> {
        let name = match self {
            Self::Picture(request) => &request.target,
            Self::Sketch(target) => target,
        };
        let target = Target::ALL.iter().copied().find(|known| known.name() == name);
        target.ok_or_else(|| vec![refused("pages draw with `wgsl` or `essl300`")])
    }
}

/// Sizes of the frames of a drawing.
#[derive(Clone, Copy)]
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
    answer(&begun(Work::Picture(Box::new(request.to_rust()?)), None))
}

fn begun(work: Work, ready: Option<Ready>) -> Step {
    CURRENT.set(Some(Current { work, given: BTreeMap::new(), wanted: None, ready }));
    step()
}

/// Continues with what was drawn: for each view, the words of all its targets. Then the depths of
/// each view, if they were to be kept.
#[wasm_bindgen(js_name = pictureFrames)]
pub fn picture_frames(words: Vec<u32>, depths: Vec<f32>) -> Answer<Step> {
    CURRENT.with_borrow_mut(|current| {
        let Some(current) = current else { return };
        let Some(RequestedDrawing { place, layout, known }) = current.wanted.take() else { return };
        let Layout { views, targets, pixels, depth } = layout;
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
        let frames: Arc<Vec<Frame>> = Arc::new((0..views).map(frame).collect());
        if let Some(known) = known {
            seen::keep(known, frames.clone());
        }
        current.given.insert(place, frames);
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

/// Calls a function with the texts of the library's programs.
pub fn with_texts<T>(run: impl FnOnce(&SourceSet) -> T) -> Result<T, Vec<Diagnostic>> {
    with_kept(|kept| run(&kept.programs.texts()))
}

/// Calls a function with the picture that was drawn last; `None` if it was another one.
pub fn with_last_picture<T>(
    request: &PictureRequest,
    run: impl FnOnce(&PreparedPass, &Shot) -> T,
) -> Option<T> {
    CURRENT.with_borrow(|current| {
        let current = current.as_ref()?;
        let is_it = matches!(&current.work, Work::Picture(last) if **last == *request);
        let Ready { prepared, shot, .. } = current.ready.as_ref().filter(|_| is_it)?;
        Some(run(prepared, shot))
    })
}

fn load() -> Result<Kept, Vec<Diagnostic>> {
    let programs = Programs::load(LIBRARY_FILES)
        .map_err(|(sources, problems)| diagnostics(&sources, &problems))?;
    let read = programs.with_texts(|texts| {
        let probes = probe::library_probes(LIBRARY_FILES, texts)?;
        Ok((preset::library_presets(LIBRARY_FILES, texts, programs.manifest(), &probes)?, probes))
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

/// Computes the picture up to the first frame that is missing, or to its end.
fn advance(kept: &Kept, current: &mut Current) -> Result<Step, Diagnostics> {
    let target = current.work.target()?;
    if let (None, Work::Picture(request)) = (&current.ready, &current.work) {
        let page = Page { given: &current.given, state: Mutex::default(), target };
        let (plan, shot) = (plan(kept, request)?, shot(request)?);
        let prepared = picture::prepare_passes(&page, &kept.programs, &plan, &shot);
        let PageState { count, wanted } = page.into_state();
        if let Some(wanted) = wanted {
            return Ok(request_drawing(current, wanted));
        }
        let prepared = Box::new(prepared?);
        current.ready = Some(Ready { prepared, shot, is_upside_down: false, before: count });
    }
    let Ready { prepared, shot, is_upside_down, before } =
        current.ready.as_ref().ok_or_else(Vec::new)?;
    let state = Mutex::new(PageState { count: *before, wanted: None });
    let page = Page { given: &current.given, state, target };
    let photographed = prepared.photograph(&page, shot);
    if let Some(wanted) = page.into_state().wanted {
        return Ok(request_drawing(current, wanted));
    }
    let picture = photographed?.develop();
    let picture = if *is_upside_down { picture.upside_down() } else { picture };
    let mut rgba = Vec::with_capacity(picture.pixels.len() / 3 * 4);
    for [r, g, b] in picture.pixels.as_chunks::<3>().0 {
        rgba.extend([*r, *g, *b, 255]);
    }
    let pixels = Pixels { width: picture.width, height: picture.height, rgba };
    Ok(Step { drawing: None, picture: Some(pixels), diagnostics: Vec::new() })
}

/// Asks the page for a drawing.
fn request_drawing(
    current: &mut Current,
    (drawing, requested): (Drawing, RequestedDrawing),
) -> Step {
    current.wanted = Some(requested);
    Step { drawing: Some(drawing), picture: None, diagnostics: Vec::new() }
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
    plan.changes.turn = request.turn;
    for (index, place) in &request.lamps {
        if let (Ok(index), Ok(place)) = (index.parse(), <[f64; 3]>::try_from(&place[..])) {
            plan.changes.lamps.insert(index, place.into());
        }
    }
    Ok(plan)
}

fn number_of(components: &[f64]) -> PresetNumber {
    match components {
        [one] => PresetNumber::Scalar(*one),
        more => PresetNumber::Vector(more.to_vec()),
    }
}

fn shot(request: &PictureRequest) -> Result<Shot, Diagnostics> {
    const LARGEST: u32 = 2048;
    let surroundings = match request.environment.as_deref() {
        None => Surroundings::Usual,
        Some(name) => Surroundings::named(name)
            .ok_or_else(|| vec![refused(&format!("there is no environment `{name}`"))])?,
    };
    Ok(Shot {
        size: [request.width, request.height].map(|side| side.clamp(1, LARGEST)),
        samples: request.samples.clamp(1, 64),
        exposure: request.exposure.clamp(-32.0, 32.0),
        cascades: 1,
        language: if request.glsl { Language::Glsl } else { Language::Wesl },
        surroundings,
    })
}

/// A session that returns frames which were drawn before, and asks the page for the next ones.
struct Page<'a> {
    given: &'a BTreeMap<usize, Arc<Vec<Frame>>>,
    state: Mutex<PageState>,
    target: Target,
}

#[derive(Default)]
struct PageState {
    /// How many drawings there were.
    count: usize,
    wanted: Option<(Drawing, RequestedDrawing)>,
}

impl Page<'_> {
    fn into_state(self) -> PageState {
        self.state.into_inner().unwrap_or_default()
    }
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
        let mut state = self.state.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        let place = state.count;
        state.count += 1;
        if let Some(frames) = self.given.get(&place) {
            return Ok(frames.to_vec());
        }
        let known = seen::known(drawing, self.target);
        if let Some(frames) = known.as_ref().and_then(seen::find) {
            return Ok(frames.to_vec());
        }
        if state.wanted.is_none() {
            let requested = RequestedDrawing { place, layout: layout(drawing), known };
            state.wanted = Some((described(drawing, self.target)?, requested));
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
