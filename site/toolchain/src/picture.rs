//! Pictures that the page draws: the toolchain says what to draw, and gets back what was drawn.
//!
//! A picture has passes, and each pass needs what the one before it drew. The devices of a page
//! answer asynchronously. So after each answer the picture is computed again from its beginning,
//! with the frames that are there. It stops at the first frame that is missing, and returns the
//! drawing for it. The rest of the code is that of `lamplight render`.

mod told;

use std::cell::RefCell;
use std::sync::Mutex;

use lamplight::bundle::{Language, Target};
use lamplight::catalogue::preset::{self, Number, Preset};
use lamplight::catalogue::probe::{self, Probe};
use lamplight::diagnostic::{self, Diagnostics, codes};
use lamplight::execute::Session;
use lamplight::execute::fixture::{Address, Compare, Fixture, Sampler, Texture, TextureKind};
use lamplight::execute::frame::{self, Buffers, EntryPoint, Frame, Side, VertexFormat};
use lamplight::execute::kernel::Kernel;
use lamplight::execute::shipped::Shipped;
use lamplight::picture::frame::Programs;
use lamplight::picture::{self, Plan, Shot, Surroundings};
use lamplight::scene::{ENVIRONMENTS, environment, sets};
use tsify::Ts;
use wasm_bindgen::prelude::wasm_bindgen;

use crate::diagnostic::{Diagnostic, diagnostics};
use crate::{Answer, answer};
use told::{
    Attribute, Buffer, Drawing, Level, Mesh, Named, PictureRequest, Pixels, PresetInfo,
    SamplerInfo, Stage, Step, Studio, TextureInfo,
};

/// What is the same for all pictures.
struct Kept {
    programs: Programs,
    presets: Vec<Preset>,
    probes: Vec<Probe>,
}

/// The picture that is being drawn.
struct Current {
    request: PictureRequest,
    /// What was drawn so far, in order.
    given: Vec<Vec<Frame>>,
    wanted: Layout,
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
    let request = request.to_rust()?;
    let current = Current { request, given: Vec::new(), wanted: Layout::default() };
    CURRENT.set(Some(current));
    answer(&step())
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
    let request = &current.request;
    let target = Target::ALL.iter().copied().find(|target| target.name() == request.target);
    let target = target.ok_or_else(|| vec![refused("the page draws with `wgsl` or `essl300`")])?;
    let (plan, shot) = (plan(kept, request)?, shot(request)?);
    let page = Page { given: &current.given, state: Mutex::default(), target };
    let rendered = picture::render_plan(&page, &kept.programs, &plan, &shot);
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

fn described(
    drawing: &frame::Drawing<'_>,
    target: Target,
) -> Result<Drawing, diagnostic::Diagnostic> {
    let state = drawing.state;
    let (textures, samplers) = fixtures(drawing);
    Ok(Drawing {
        vertex: stage(drawing.vertex, target)?,
        fragment: drawing.fragment.map(|entry| stage(entry, target)).transpose()?,
        targets: drawing.targets,
        meshes: drawing.items.iter().map(mesh).collect(),
        views: drawing.views.iter().map(buffers).collect(),
        buffers: buffers(drawing.buffers),
        textures,
        samplers,
        width: drawing.size[0],
        height: drawing.size[1],
        depth_test: state.depth_test,
        keep_depth: state.keep_depth,
        cull: match state.cull {
            None => "none",
            Some(Side::Front) => "front",
            Some(Side::Back) => "back",
        }
        .to_owned(),
        mirrored: state.mirrored,
        offset: state.offset,
    })
}

fn stage(entry: EntryPoint<'_>, target: Target) -> Result<Stage, diagnostic::Diagnostic> {
    let Shipped { bytes, native, reflection, .. } = Shipped::of(entry, target)?;
    Ok(Stage { text: String::from_utf8_lossy(&bytes).into_owned(), native, reflection })
}

fn mesh(item: &frame::Item<'_>) -> Mesh {
    let bytes = |words: &[u32]| words.iter().flat_map(|word| word.to_le_bytes()).collect();
    let attribute = |(attribute, offset): (frame::Attribute, u64)| Attribute {
        location: attribute.location,
        format: match attribute.format {
            VertexFormat::Uint32 => "uint32",
            VertexFormat::Float32 => "float32",
            VertexFormat::Float32x2 => "float32x2",
            VertexFormat::Float32x3 => "float32x3",
            VertexFormat::Float32x4 => "float32x4",
        }
        .to_owned(),
        offset: offset as u32,
    };
    Mesh {
        attributes: item.mesh.layout().into_iter().map(attribute).collect(),
        stride: item.mesh.stride() as u32,
        vertices: item.mesh.vertices(),
        words: bytes(&item.mesh.words),
        indices: bytes(&item.mesh.indices),
        buffers: buffers(item.buffers),
    }
}

fn buffers(buffers: &Buffers) -> Vec<Buffer> {
    let one = |((group, binding), bytes): (&(u32, u32), &Vec<u8>)| Buffer {
        group: *group,
        binding: *binding,
        bytes: bytes.clone(),
    };
    buffers.iter().map(one).collect()
}

fn fixtures(drawing: &frame::Drawing<'_>) -> (Vec<TextureInfo>, Vec<SamplerInfo>) {
    let (mut textures, mut samplers) = (Vec::new(), Vec::new());
    for (place, fixture) in drawing.fixtures {
        match &**fixture {
            Fixture::Texture(texture) => {
                let smaller = drawing.levels.get(place).map_or(&[][..], Vec::as_slice);
                let levels = std::iter::once(texture).chain(smaller).map(level);
                textures.push(TextureInfo {
                    group: place.0,
                    binding: place.1,
                    depth: texture.kind.is_depth(),
                    cube: matches!(texture.kind, TextureKind::DepthCube | TextureKind::ColorCube),
                    levels: levels.collect(),
                });
            }
            Fixture::Sampler(sampler) => samplers.push(sampling(*place, *sampler)),
        }
    }
    (textures, samplers)
}

fn level(texture: &Texture) -> Level {
    Level {
        width: texture.width,
        height: texture.height,
        bytes: texture.texels.iter().flat_map(|texel| texel.to_le_bytes()).collect(),
    }
}

fn sampling((group, binding): (u32, u32), sampler: Sampler) -> SamplerInfo {
    let compare = sampler.compare.map(|compare| match compare {
        Compare::Less => "less",
        Compare::LessEqual => "less-equal",
        Compare::Greater => "greater",
        Compare::GreaterEqual => "greater-equal",
    });
    let address = match sampler.address {
        Address::Clamp => "clamp-to-edge",
        Address::Repeat => "repeat",
        Address::Mirror => "mirror-repeat",
    };
    SamplerInfo {
        group,
        binding,
        compare: compare.map(str::to_owned),
        linear: sampler.linear,
        address: address.to_owned(),
    }
}
