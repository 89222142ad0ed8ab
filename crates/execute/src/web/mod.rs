//! Runs emitted WGSL and GLSL ES unchanged in a page of a browser, on WebGPU and WebGL2.
//!
//! The page's script (`webgpu.js`, `webgl2.js`) keeps kernels and draws; frames are drawn from the
//! bytes of a bundle. Its arguments and results are JSON, with textures and words as base64. A page
//! that is lost is opened again. So a kernel that crashes its page fails, and the kernels after it
//! still run.

use crate::fixture::{Fixture, FixtureSampler, FixtureTexture};
use crate::frame::{BindingPlace, Buffers, DrawItem, Drawing, Frame, Mesh, VertexAttribute};
use crate::gpu::run_batches;
use crate::kernel::{Kernel, kernels_to_compile};
use crate::shipped::{ColorFormat, Shipped};
use crate::{Session, ShippedPair, emitted, executor_failed};
use base64::Engine as _;
use base64::prelude::BASE64_STANDARD;
use lamplight_bundle::{ClipSpace, Combined, FrontFace, Target};
use lamplight_diagnostic::{Diagnostic, codes};
use lamplight_emit::Emitted;
use lamplight_tools::browser::serve::{HttpServer, ServedFiles};
use lamplight_tools::browser::{Browser, BrowserPage, PATIENCE, Problem};
use lamplight_validate::on_large_stack;
use rayon::prelude::*;
use serde::Deserialize;
use serde_json::{Map, Value, json};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// The longest wait for one draw, or for compiling some kernels.
const LONGEST: Duration = Duration::from_secs(60);
/// How many kernels are compiled at once.
const AT_ONCE: usize = 32;

const COMMON: &str = include_str!("common.js");

/// An interface that a page offers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum WebApi {
    WebGpu,
    WebGl2,
}

impl WebApi {
    fn name(self) -> &'static str {
        match self {
            Self::WebGpu => "WebGPU",
            Self::WebGl2 => "WebGL2",
        }
    }

    fn target(self) -> Target {
        match self {
            Self::WebGpu => Target::WGSL,
            Self::WebGl2 => Target::ESSL300,
        }
    }

    fn script(self) -> &'static str {
        match self {
            Self::WebGpu => include_str!("webgpu.js"),
            Self::WebGl2 => include_str!("webgl2.js"),
        }
    }
}

/// Starts the browser of a session.
pub type Start = Box<dyn Fn() -> Result<Arc<Browser>, Problem> + Send>;

/// A session: a page, which is opened again if it is lost.
pub struct Web {
    api: WebApi,
    start: Start,
    server: HttpServer,
    patience: Duration,
    adapter: String,
    state: Mutex<WebState>,
}

#[derive(Default)]
struct WebState {
    page: Option<BrowserPage>,
    /// The kernels that the page has compiled, or why it could not.
    kept: HashMap<u64, Result<(), Diagnostic>>,
}

/// An answer of the script.
#[derive(Deserialize)]
#[serde(rename_all = "lowercase")]
enum Answer {
    Value(Value),
    /// What is needed and not supported here, as a message.
    Lacks(String),
    /// What went wrong with one kernel or frame.
    Error(String),
    /// The device was lost, and everything on it.
    Lost(String),
}

impl Web {
    /// Opens a page.
    ///
    /// # Errors
    /// A message: there is no browser, or it does not have the interface.
    pub fn open(api: WebApi) -> Result<Self, String> {
        Self::open_in(Box::new(Browser::shared), api, LONGEST)
    }

    /// Opens a page of a browser, which may take `patience` for each answer.
    ///
    /// # Errors
    /// Those of [`Self::open`].
    pub fn open_in(start: Start, api: WebApi, patience: Duration) -> Result<Self, String> {
        let page = "<!doctype html><title>kernels</title><link rel=icon href=data:,>
            <script src=common.js></script><script src=script.js></script>";
        let files = [("index.html", page), ("common.js", COMMON), ("script.js", api.script())];
        let files = files.map(|(path, text)| (path.to_owned(), text.as_bytes().to_vec()));
        let server = HttpServer::start(ServedFiles::Memory(BTreeMap::from(files)));
        let server = server.map_err(|error| format!("nothing can be served: {error}"))?;
        let state = Mutex::default();
        let mut web = Self { api, start, server, patience, adapter: String::new(), state };
        let (page, adapter) = web.opened().map_err(|problem| problem.to_string())?;
        web.adapter = adapter;
        web.state = Mutex::new(WebState { page: Some(page), ..WebState::default() });
        Ok(web)
    }

    /// Opens a page and its device; also returns the device's name.
    fn opened(&self) -> Result<(BrowserPage, String), Problem> {
        let browser = (self.start)()?;
        let page = browser.open(&self.server.address(""))?;
        page.loaded(PATIENCE)?;
        let device = page.evaluate("lamplight.open()", PATIENCE)?;
        let device = device.as_str().unwrap_or_default();
        let adapter = format!("{}, {} on {device}", browser.version(), self.api.name());
        Ok((page, adapter))
    }

    /// Asks the script. If the page is lost, it is closed.
    fn ask(&self, state: &mut WebState, call: &str) -> Result<Value, WebFailure> {
        let page = match &state.page {
            Some(page) => page,
            None => {
                let (page, _) = self.opened().map_err(WebFailure::lost)?;
                state.page.insert(page)
            }
        };
        let answer = page.evaluate(call, self.patience).and_then(|answer| {
            serde_json::from_value(answer).map_err(|error| Problem::Refused(error.to_string()))
        });
        let failure = match answer {
            Ok(Answer::Value(value)) => return Ok(value),
            Ok(Answer::Lacks(words)) => {
                return Err(WebFailure::Of(Diagnostic::error(codes::EXECUTOR_LACKS, words)));
            }
            Ok(Answer::Error(words)) => return Err(WebFailure::Of(executor_failed(words))),
            Err(Problem::Threw(words)) => return Err(WebFailure::Of(executor_failed(words))),
            Ok(Answer::Lost(words)) => WebFailure::Lost(executor_failed(words)),
            // A page that was slow once is slow again. Its work may continue in the process that
            // draws for all pages, where nothing stops it but the end of the browser.
            Err(problem @ Problem::Late { .. }) => {
                page.end_browser();
                WebFailure::Of(executor_failed(problem.to_string()))
            }
            Err(problem) => WebFailure::lost(problem),
        };
        *state = WebState::default();
        Err(failure)
    }

    /// Runs a job, and runs it once more if the page is lost: another page may have caused that.
    fn twice<T>(
        &self,
        mut job: impl FnMut(&Self, &mut WebState) -> Result<T, WebFailure>,
    ) -> Result<T, Diagnostic> {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        let result = match job(self, &mut state) {
            Err(WebFailure::Lost(_)) => job(self, &mut state),
            other => other,
        };
        result.map_err(|failure| match failure {
            WebFailure::Of(error) | WebFailure::Lost(error) => error,
        })
    }

    /// Gives the page the kernels that are new to it, some at a time.
    fn compile(&self, state: &mut WebState, kernels: &[&Kernel]) -> Result<(), WebFailure> {
        let new = kernels_to_compile(kernels, |code| state.kept.contains_key(&code));
        let target = self.api.target();
        for some in new.chunks(AT_ONCE) {
            let emit =
                |kernel: &&Kernel| kernel_json(kernel, &emitted::emit_kernel(kernel, target)?);
            let made: Vec<Result<Value, Diagnostic>> =
                on_large_stack(|| some.par_iter().map(emit).collect());
            let texts: Vec<&Value> = made.iter().flatten().collect();
            let answers = match texts.is_empty() {
                true => Value::Array(Vec::new()),
                false => self.ask(state, &format!("lamplight.prepare({})", json!(texts)))?,
            };
            let answers: Vec<Answer> = serde_json::from_value(answers)
                .map_err(|error| WebFailure::Of(executor_failed(error.to_string())))?;
            if let Some(Answer::Lost(words)) =
                answers.iter().find(|one| matches!(one, Answer::Lost(_)))
            {
                let lost = executor_failed(words.clone());
                *state = WebState::default();
                return Err(WebFailure::Lost(lost));
            }
            let mut answers = answers.into_iter();
            for (kernel, made) in some.iter().zip(&made) {
                let result =
                    made.as_ref().map_err(Clone::clone).and_then(|_| check_kept(answers.next()));
                state.kept.insert(kernel.code, result);
            }
        }
        Ok(())
    }

    /// One draw: the words of the target.
    fn draw(&self, kernel: &Kernel, texels: &[u32], rows: u32) -> Result<Vec<u32>, Diagnostic> {
        let texels = base64_of_words(texels);
        let question = json!({ "id": kernel.code, "rows": rows, "texels": texels });
        let call = format!("lamplight.run({question})");
        let answer = self.twice(|web, state| {
            web.compile(state, &[kernel])?;
            match state.kept.get(&kernel.code) {
                Some(Err(error)) => Err(WebFailure::Of(error.clone())),
                _ => web.ask(state, &call),
            }
        })?;
        words_of_answer(&answer).map_err(executor_failed)
    }
}

impl Session for Web {
    fn adapter(&self) -> String {
        self.adapter.clone()
    }

    fn prepare(&mut self, kernels: &[&Kernel]) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        // If the page is lost over some of them, each is tried by itself when it is run.
        let _ = self.compile(&mut state, kernels);
    }

    fn run(&mut self, kernel: &Kernel, inputs: &[u32]) -> Result<Vec<u32>, Diagnostic> {
        run_batches(kernel, inputs, |texels, rows| self.draw(kernel, texels, rows))
    }

    fn draw_shipped(
        &self,
        pair: ShippedPair<'_>,
        drawing: &Drawing<'_>,
    ) -> Result<Vec<Frame>, Diagnostic> {
        let question = frames_question(self.api, pair, drawing)?;
        let call = format!("lamplight.frames({question})");
        let answer = self.twice(|web, state| web.ask(state, &call))?;
        frames_answer(&answer).map_err(executor_failed)
    }
}

/// Whether the page has a kernel, or why not.
fn check_kept(answer: Option<Answer>) -> Result<(), Diagnostic> {
    match answer {
        Some(Answer::Value(_)) => Ok(()),
        Some(Answer::Lacks(words)) => Err(Diagnostic::error(codes::EXECUTOR_LACKS, words)),
        Some(Answer::Error(words) | Answer::Lost(words)) => Err(executor_failed(words)),
        None => Err(executor_failed("the page has forgotten a kernel")),
    }
}

/// Why there is no answer.
enum WebFailure {
    /// Because of what was asked.
    Of(Diagnostic),
    /// Because the page was lost, perhaps through another page.
    Lost(Diagnostic),
}

impl WebFailure {
    fn lost(problem: Problem) -> Self {
        Self::Lost(executor_failed(problem.to_string()))
    }
}

/// The argument of the script's function `frames`.
///
/// # Errors
/// The drawing needs something that is not supported here.
fn frames_question(
    api: WebApi,
    pair: ShippedPair<'_>,
    drawing: &Drawing<'_>,
) -> Result<Value, Diagnostic> {
    for stage in [pair.vertex, pair.fragment] {
        if stage.target != api.target() {
            return Err(executor_failed(format!("this executor draws no {}", stage.target)));
        }
    }
    let lacks = pair.fragment.lacks_of_webgpu().filter(|_| api.target() == Target::WGSL);
    if let Some(reason) = lacks {
        return Err(Diagnostic::error(codes::EXECUTOR_LACKS, reason));
    }
    if !drawing.state.is_plain() || !drawing.levels.is_empty() {
        let message = "shipped texts are drawn without culling and smaller levels";
        return Err(executor_failed(message));
    }
    let formats = pair.fragment.targets().map_err(executor_failed)?;
    let places = read_places(pair);
    let fixtures: Vec<(BindingPlace, &Fixture)> =
        places.iter().filter_map(|place| Some((*place, &**drawing.fixtures.get(place)?))).collect();
    let views = drawing.views.iter().map(|view| {
        let items = drawing.items.iter();
        items.map(|item| buffers_json(drawing, view, item, &places)).collect::<Result<Vec<_>, _>>()
    });
    let views = views.collect::<Result<Vec<_>, _>>().map_err(executor_failed)?;
    let reversed = |clip: &ClipSpace| clip.front_face == FrontFace::Reversed;
    Ok(json!({
        "size": drawing.size,
        "tested": drawing.state.depth_test,
        "formats": formats.iter().map(|one| *one == ColorFormat::Float).collect::<Vec<_>>(),
        "vertex": stage_json(pair.vertex),
        "fragment": stage_json(pair.fragment),
        "layout": layout_json(drawing, &places, &fixtures),
        "fixtures": fixtures.iter().map(|(place, one)| fixture_json(*place, one)).collect::<Vec<_>>(),
        "units": units_json(pair),
        "blocks": blocks_json(pair).map_err(executor_failed)?,
        "reversed": pair.vertex.native.clip.as_ref().is_some_and(reversed),
        "meshes": drawing.items.iter().map(|item| mesh_json(item.mesh)).collect::<Vec<_>>(),
        "views": views,
    }))
}

/// The frames in an answer: the words of each target for each view.
fn frames_answer(answer: &Value) -> Result<Vec<Frame>, String> {
    let list = |value: &Value| match value {
        Value::Array(list) => Ok(list.clone()),
        other => Err(format!("no frames: {other}")),
    };
    let frame = |answer: &Value| {
        let targets = list(answer)?.iter().map(words_of_answer).collect::<Result<_, String>>()?;
        Ok(Frame { targets, depth: Vec::new(), detour: None })
    };
    list(answer)?.iter().map(frame).collect()
}

fn stage_json(shipped: &Shipped) -> Value {
    json!({ "code": shipped.text(), "entry": shipped.native.entry_name })
}

/// The bindings of both stages.
fn read_places(pair: ShippedPair<'_>) -> BTreeSet<BindingPlace> {
    let stages = [pair.vertex, pair.fragment].into_iter();
    let bindings = stages.flat_map(|stage| &stage.reflection.bindings);
    bindings.map(|binding| (binding.group, binding.binding)).collect()
}

/// The layout of each bind group, by the group's index.
fn layout_json(
    drawing: &Drawing<'_>,
    places: &BTreeSet<BindingPlace>,
    fixtures: &[(BindingPlace, &Fixture)],
) -> Vec<Vec<Value>> {
    let filters = are_filtered(fixtures.iter().map(|(_, fixture)| *fixture));
    let groups = places.iter().map(|(group, _)| group + 1).max().unwrap_or(0);
    let entry = |place: &BindingPlace| {
        let fixture = drawing.fixtures.get(place).map(|fixture| &**fixture);
        layout_entry(*place, fixture, filters)
    };
    (0..groups)
        .map(|group| places.iter().filter(|place| place.0 == group).map(entry).collect())
        .collect()
}

/// The uniform buffers of an item in a view.
fn buffers_json(
    drawing: &Drawing<'_>,
    view: &Buffers,
    item: &DrawItem<'_>,
    places: &BTreeSet<BindingPlace>,
) -> Result<Value, String> {
    let mut found = Map::new();
    for place in places.iter().filter(|place| !drawing.fixtures.contains_key(place)) {
        let bytes = drawing.buffer(view, item, *place);
        let bytes = bytes.ok_or_else(|| format!("nothing is given for {place:?}"))?;
        found.insert(binding_key(*place), base64_of_bytes(bytes).into());
    }
    Ok(Value::Object(found))
}

/// The combined samplers of both stages of GLSL.
fn units_json(pair: ShippedPair<'_>) -> Vec<Value> {
    let stages = [pair.vertex, pair.fragment].into_iter();
    stages.flat_map(|stage| &stage.native.combined).map(unit_json).collect()
}

/// The uniform blocks of both stages of GLSL by name, with a number for each group and binding.
fn blocks_json(pair: ShippedPair<'_>) -> Result<Vec<Value>, String> {
    let mut numbers: BTreeMap<BindingPlace, usize> = BTreeMap::new();
    let mut found = Vec::new();
    for stage in [pair.vertex, pair.fragment] {
        for place in stage.blocks() {
            let slots = &stage.native.slots;
            let slot = slots.iter().find(|slot| (slot.group, slot.binding) == place);
            let next = numbers.len();
            let number = *numbers.entry(place).or_insert(next);
            let name = slot.and_then(|slot| slot.name.as_deref());
            found.push(json!({ "name": name, "place": binding_key(place), "number": number }));
        }
    }
    Ok(found)
}

fn mesh_json(mesh: &Mesh) -> Value {
    let attribute = |(one, offset): (VertexAttribute, u64)| {
        json!({
            "shaderLocation": one.location,
            "offset": offset,
            // WebGPU calls `Float32x3` `float32x3`.
            "format": format!("{:?}", one.format).to_lowercase(),
            "words": one.format.words(),
        })
    };
    json!({
        "stride": mesh.stride(),
        "attributes": mesh.layout().into_iter().map(attribute).collect::<Vec<_>>(),
        "words": base64_of_words(&mesh.words),
        "indices": base64_of_words(&mesh.indices),
        "count": if mesh.indices.is_empty() { mesh.vertices() } else { mesh.indices.len() as u32 },
    })
}

/// The stages that may read a binding, as WebGPU's bits.
const VERTEX_AND_FRAGMENT: u32 = 3;

/// Bytes as base64.
fn base64_of_bytes(bytes: &[u8]) -> String {
    BASE64_STANDARD.encode(bytes)
}

/// Words as base64.
fn base64_of_words(words: &[u32]) -> String {
    let all: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    base64_of_bytes(&all)
}

fn words_of_answer(value: &Value) -> Result<Vec<u32>, String> {
    let text = value.as_str().ok_or_else(|| format!("no words: {value}"))?;
    let bytes = BASE64_STANDARD.decode(text).map_err(|error| error.to_string())?;
    Ok(bytes.as_chunks::<4>().0.iter().map(|bytes| u32::from_le_bytes(*bytes)).collect())
}

/// A kernel with everything that it is bound to.
fn kernel_json(kernel: &Kernel, emitted: &Emitted) -> Result<Value, Diagnostic> {
    let code =
        str::from_utf8(&emitted.bytes).map_err(|error| executor_failed(error.to_string()))?;
    let fixtures: Vec<((u32, u32), &Fixture)> =
        kernel.resources().map(|resource| ((0, resource.binding), &*resource.fixture)).collect();
    let filters = are_filtered(fixtures.iter().map(|(_, fixture)| *fixture));
    let inputs = json!({
        "binding": 0,
        "visibility": VERTEX_AND_FRAGMENT,
        "texture": { "sampleType": "uint", "viewDimension": "2d" },
    });
    let layout =
        fixtures.iter().map(|(place, fixture)| layout_entry(*place, Some(fixture), filters));
    let units: Vec<Value> = emitted.native.combined.iter().map(unit_json).collect();
    Ok(json!({
        "id": kernel.code,
        "code": code,
        "entry": emitted.native.entry_name,
        "layout": std::iter::once(inputs).chain(layout).collect::<Vec<_>>(),
        "fixtures": fixtures.iter().map(|(place, one)| fixture_json(*place, one)).collect::<Vec<_>>(),
        "units": units,
    }))
}

/// The key of a binding in the JSON for the scripts.
fn binding_key((group, binding): (u32, u32)) -> String {
    format!("{group}/{binding}")
}

/// A combined sampler of GLSL.
fn unit_json(combined: &Combined) -> Value {
    let key_of = |place: [u32; 2]| binding_key((place[0], place[1]));
    json!({
        "name": combined.name,
        "texture": key_of(combined.texture),
        "sampler": combined.sampler.map(key_of),
    })
}

/// Whether a sampler filters colour textures. Not every device can filter f32 textures.
fn are_filtered<'a>(mut fixtures: impl Iterator<Item = &'a Fixture>) -> bool {
    fixtures.any(|one| matches!(one, Fixture::Sampler(one) if one.linear && one.compare.is_none()))
}

/// The layout of a binding in WebGPU. Without a fixture it is a uniform buffer.
fn layout_entry((_, binding): (u32, u32), fixture: Option<&Fixture>, filters: bool) -> Value {
    let mut entry = json!({ "binding": binding, "visibility": VERTEX_AND_FRAGMENT });
    match fixture {
        Some(Fixture::Texture(texture)) => {
            let sample = match (texture.kind.is_depth(), filters) {
                (true, _) => "depth",
                (false, true) => "float",
                (false, false) => "unfilterable-float",
            };
            let dimension = if texture.kind.layers() == 6 { "cube" } else { "2d" };
            entry["texture"] = json!({ "sampleType": sample, "viewDimension": dimension });
        }
        Some(Fixture::Sampler(sampler)) => {
            let kind = match sampler {
                FixtureSampler { compare: Some(_), .. } => "comparison",
                FixtureSampler { linear: true, .. } => "filtering",
                _ => "non-filtering",
            };
            entry["sampler"] = json!({ "type": kind });
        }
        None => entry["buffer"] = json!({ "type": "uniform" }),
    }
    entry
}

/// A texture or a sampler with its binding.
fn fixture_json(place: (u32, u32), fixture: &Fixture) -> Value {
    match fixture {
        Fixture::Texture(texture) => {
            json!({ "place": binding_key(place), "texture": image_json(texture) })
        }
        Fixture::Sampler(one) => {
            json!({ "place": binding_key(place), "sampler": sampler_json(*one) })
        }
    }
}

fn image_json(texture: &FixtureTexture) -> Value {
    let texels: Vec<u32> = texture.texels.iter().map(|texel| texel.to_bits()).collect();
    json!({
        "width": texture.width,
        "height": texture.height,
        "layers": texture.kind.layers(),
        "depth": texture.kind.is_depth(),
        "texels": base64_of_words(&texels),
    })
}

/// The sampler in WebGPU's terms.
fn sampler_json(sampler: FixtureSampler) -> Value {
    let (address, compare) = sampler.web_words();
    let filter = if sampler.linear { "linear" } else { "nearest" };
    json!({ "address": address, "filter": filter, "compare": compare })
}
