//! Runs the passes of a plan in order.

use std::cell::OnceCell;
use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DMat4;

use super::Shot;
use super::light::LightView;
use super::mesh::{self, vertex_attributes};
use super::pixels::Background;
use super::plan::{Pass, Plan};
use super::prepared::{PreparedPass, no_frame, pixel_color};
use super::textures::{Left, TextureLibrary, binding_sampler};
use super::values::{PassCamera, UniformValues, eye_projection};
use crate::frame::{Programs, ReadyStage, Stages, pack_buffer};
use crate::light::{quartered_map, slices_of};
use lamplight_bundle::{Binding, BindingKind};
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_execute::Session;
use lamplight_execute::fixture::{Fixture, FixtureTexture, TextureKind};
use lamplight_execute::frame::{Buffers, Face, Frame, Mesh, PipelineState};
use lamplight_permute::Setting;
use lamplight_scenes::sets::{Eye, Lamp, Object, Scene};

/// What all objects and views of a pass share, by group and binding.
#[derive(Default)]
struct PassBindings {
    buffers: Buffers,
    fixtures: BTreeMap<(u32, u32), Arc<Fixture>>,
    /// Levels of textures after the first.
    levels: BTreeMap<(u32, u32), Vec<FixtureTexture>>,
}

/// What the passes share.
struct Studio<'a> {
    painter: &'a dyn Session,
    programs: &'a Programs,
    values: UniformValues<'a>,
}

/// Which objects a pass draws.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Part {
    All,
    Opaque,
    Blended,
}

/// The smallest and the largest shadow map, in texels along an edge. In between, a map has twice
/// the picture's size. Maps of moments are blurred, so half of that is enough. The third size is
/// the largest that a preset may ask for.
const MAP_SIZES: (u32, u32, u32) = (256, 1024, 4096);

/// The scene of a plan with what lights it.
pub(super) struct Lit<'p> {
    pub scene: Scene,
    /// The lamp that casts the shadow.
    pub key: Lamp,
    pub last: &'p Pass,
    /// The pass that lights the scene.
    pub lit: &'p Pass,
    /// Texels along an edge of the shadow map.
    pub size: u32,
}

impl<'p> Lit<'p> {
    /// # Errors
    /// Those of [`Plan::staged`], and a plan without passes.
    pub fn of(plan: &'p Plan, shot: &Shot) -> Result<Self, Diagnostics> {
        let scene = plan.staged()?;
        let (Some(last), Some(lit), Some(key)) = (plan.last(), plan.lit(), scene.lamps.first())
        else {
            return Err(vec![no_frame()]);
        };
        let twice = (2 * shot.size[0].max(shot.size[1])).next_power_of_two();
        let published = plan.number("depth_pass", "size").and_then(|size| size.first().copied());
        let published = published.map(|size| size.clamp(1.0, f64::from(MAP_SIZES.2)) as u32);
        let fitting = || twice.clamp(MAP_SIZES.0, MAP_SIZES.1);
        let size = published.or(scene.map_size).unwrap_or_else(fitting);
        Ok(Self { key: *key, scene, last, lit, size })
    }
}

/// Draws all passes of a plan but the last, and prepares that one.
///
/// # Errors
/// Those of compositions and of the painter.
pub fn prepare_passes(
    painter: &dyn Session,
    programs: &Programs,
    plan: &Plan,
    shot: &Shot,
) -> Result<PreparedPass, Diagnostics> {
    let Lit { mut scene, key, last, lit, size } = Lit::of(plan, shot)?;
    let fine = fineness(last, shot);
    let shot = &finer_shot(shot, &scene, fine);
    let slice = |scene: &Scene, light: LightView| {
        let values = UniformValues {
            plan,
            scene,
            lit,
            light: &light,
            shot,
            clusters: OnceCell::new(),
            probes: OnceCell::new(),
        };
        let with_lamps = values.with_bulbs()?;
        let values = UniformValues { scene: with_lamps.as_ref().unwrap_or(scene), ..values };
        let studio = Studio { painter, programs, values };
        let mut left = Left::default();
        for pass in &plan.passes[..plan.passes.len() - 1] {
            studio.draw(pass, &mut left)?;
        }
        Ok(PreparedPass { fine, ..studio.with_blended(last, &left)? })
    };
    if shot.cascades <= 1 {
        let eye = eye_projection(&scene.eye, shot);
        let light = LightView::new(&scene, &key, plan, lit, size, eye);
        return slice(&scene, light);
    }
    if !last.needs.takes_cascades() {
        return Err(vec![no_cascades(last)]);
    }
    // Each part of the viewer's depth is a separate frame, clipped by its planes.
    let whole = scene.eye;
    let mut slices = Vec::new();
    for (near, far) in slices_of(&scene, shot.cascades) {
        scene.eye = Eye { near, far, ..whole };
        let clip_from_world = PassCamera::of_viewer(&scene.eye, shot).clip_from_world;
        let light = LightView::cascade(&scene, &key, clip_from_world, size);
        slices.push(slice(&scene, light)?);
    }
    let mut slices = slices.into_iter();
    let nearest = slices.next().ok_or_else(|| vec![no_frame()])?;
    Ok(PreparedPass { farther: slices.collect(), ..nearest })
}

/// The shot with `fine` times the pixels along each side, and with the surroundings of the scene.
fn finer_shot(shot: &Shot, scene: &Scene, fine: u32) -> Shot {
    let size = shot.size.map(|side| side * fine);
    Shot { size, surroundings: shot.surroundings.around_scene(scene), ..shot.clone() }
}

/// By how much the passes of the viewer are supersampled, along each side. What a pass reads at a
/// pixel of an earlier one must be of the same point of the scene. So samples cannot be moved
/// within a pixel, and smaller pixels are averaged instead.
fn fineness(last: &Pass, shot: &Shot) -> u32 {
    /// More would take too much memory: a picture of the gallery has 100 MB for each colour.
    const FINEST: u32 = 3;
    /// Texels along an edge that every GPU can draw into.
    const WIDEST: u32 = 8192;
    if last.needs.seen_before() == 0 {
        return 1;
    }
    let side = shot.size[0].max(shot.size[1]).max(1);
    shot.samples.isqrt().min(WIDEST / side).clamp(1, FINEST)
}

fn no_cascades(pass: &Pass) -> Diagnostic {
    let key = &pass.key;
    if pass.needs.cascades {
        let message = format!("`{key}` has cascades of its own");
        return Diagnostic::error(codes::PICTURE_INVALID, message);
    }
    let message = format!("`{key}` has no cascades: they are of the shadow of a directional light");
    Diagnostic::error(codes::PICTURE_INVALID, message)
        .note("choose `shadow_light=directional` and a `shadow`")
}

impl Studio<'_> {
    /// Draws a pass before the last one, and keeps what later passes read.
    fn draw(&self, pass: &Pass, left: &mut Left) -> Result<(), Diagnostics> {
        // What can be seen through hides nothing from the passes that read depths, either.
        let is_before = self.values.plan.is_of_viewer(pass) && self.blends();
        let part = if is_before { Part::Opaque } else { Part::All };
        let prepared = self.ready(pass, left, part)?;
        if self.values.plan.is_of_viewer(pass) {
            return match pass.needs.screen {
                true => self.draw_over(pass, &prepared, left),
                false => self.draw_seen(&prepared, left),
            };
        }
        let light = self.values.light;
        let views: Vec<Buffers> = match prepared.camera {
            Some(_) => light
                .clip_from_world
                .iter()
                .map(|matrix| prepared.view(&self.light_camera(*matrix)))
                .collect::<Result<_, _>>()
                .map_err(|problem| vec![problem])?,
            None => vec![Buffers::new()],
        };
        let side = if pass.program == "depth" { light.size } else { (light.size / 2).max(1) };
        if prepared.targets() == 0 {
            let frames = prepared.draw(self.painter, &views, [side; 2], None)?;
            let depths: Vec<_> = frames.into_iter().map(|frame| frame.depth).collect();
            left.map = Some(match light.parts {
                Some(_) => (vec![quartered_map(&depths, side)], 2 * side),
                None => (depths, side),
            });
            return Ok(());
        }
        let frames = prepared.draw_colors(self.painter, &views, [side; 2], 0)?;
        let cleared = self.values.cleared_moments();
        left.moments = Some(color_texture(&frames, [side; 2], |_| cleared)?);
        Ok(())
    }

    /// Draws a full-screen pass, and keeps its colours by the name of its program. What earlier
    /// passes have drawn is kept too.
    fn draw_over(
        &self,
        pass: &Pass,
        prepared: &PreparedPass,
        left: &mut Left,
    ) -> Result<(), Diagnostics> {
        let mut drawn = Left::default();
        self.draw_seen(prepared, &mut drawn)?;
        left.over.extend(drawn.colors.into_iter().next().map(|over| (pass.program.clone(), over)));
        Ok(())
    }

    /// Draws what the viewer sees: depths, colours, or several targets. Where nothing is drawn, a
    /// single target has the background, and several targets have zeros.
    fn draw_seen(&self, prepared: &PreparedPass, left: &mut Left) -> Result<(), Diagnostics> {
        let size = self.values.shot.size;
        let views = [prepared.eye_view([0.0; 2], size).map_err(|problem| vec![problem])?];
        let targets = prepared.targets();
        let [width, height] = size.map(f64::from);
        let behind = |index: usize| {
            let (x, y) = (index as u32 % size[0], index as u32 / size[0]);
            let (u, v) = ((f64::from(x) + 0.5) / width, (f64::from(y) + 0.5) / height);
            prepared.background.color(u, v).extend(1.0).as_vec4().to_array()
        };
        let cleared = |index| if targets == 1 { behind(index) } else { [0.0; 4] };
        left.colors.clear();
        if targets == 0 {
            let frames = prepared.draw(self.painter, &views, size, None)?;
            left.seen = frames.into_iter().next().map(|frame| (frame.depth, size));
        }
        for location in 0..targets {
            let frames = prepared.draw_colors(self.painter, &views, size, location)?;
            left.colors.push(color_texture(&frames, size, cleared)?);
            left.seen = frames.into_iter().next().map(|frame| (frame.depth, size));
        }
        Ok(())
    }

    fn light_camera(&self, clip_from_world: DMat4) -> PassCamera {
        PassCamera { clip_from_world, world_from_view: DMat4::IDENTITY }
    }

    /// A pass with its uniforms, textures and meshes.
    fn ready(&self, pass: &Pass, left: &Left, part: Part) -> Result<PreparedPass, Diagnostics> {
        let unknown = || {
            vec![Diagnostic::error(
                codes::UNKNOWN_PROGRAM,
                format!("there is no program `{}`", pass.program),
            )]
        };
        let program = self.programs.manifest().program(&pass.program).ok_or_else(unknown)?;
        let mut settings = pass.settings.clone();
        if part == Part::Blended {
            // Points of any alpha are blended, also where others are left out by theirs.
            settings.values.entry("alpha_test".to_owned()).and_modify(|test| {
                *test = Setting::Bool(false);
            });
        }
        let stages = self.programs.stages(program, &settings, self.values.shot.language)?;
        let bindings = stage_bindings(&stages);
        let camera = bindings.iter().find(|binding| binding.name == "camera").cloned();
        let has_objects = !vertex_attributes(&stages.vertex.reflection).is_empty();
        let shared = bindings.iter().filter(|binding| !is_own(&binding.name, has_objects));
        let PassBindings { buffers, fixtures, levels } = self.bound(shared, left)?;
        let plain =
            PLAIN.iter().filter_map(|name| bindings.iter().find(|binding| binding.name == *name));
        let plain = plain.map(|binding| (binding.group, binding.binding)).collect();
        let items = self.items(pass, &stages, &bindings, part).map_err(|problem| vec![problem])?;
        let eye = PassCamera::of_viewer(&self.values.scene.eye, self.values.shot);
        let background = Background::new(&self.values, eye);
        let mut state = self.state(pass, camera.is_some());
        state.keep_depth |= part != Part::All;
        let encoded = pass.needs.encoded;
        Ok(PreparedPass {
            stages,
            items,
            buffers,
            fixtures,
            levels,
            state,
            plain,
            camera,
            eye,
            background,
            encoded,
            fine: 1,
            farther: Vec::new(),
            blended: None,
        })
    }

    /// The pass that draws the picture, with a second one for objects that are blended.
    fn with_blended(&self, last: &Pass, left: &Left) -> Result<PreparedPass, Diagnostics> {
        if !self.blends() {
            return self.ready(last, left, Part::All);
        }
        let blended = Some(Box::new(self.ready(last, left, Part::Blended)?));
        Ok(PreparedPass { blended, ..self.ready(last, left, Part::Opaque)? })
    }

    /// Whether objects are blended: there are some, and the last pass draws objects.
    fn blends(&self) -> bool {
        let draws_objects = self.values.plan.passes.last().is_some_and(|last| !last.needs.screen);
        draws_objects && self.values.scene.objects.iter().any(|object| object.is_blended)
    }

    /// What all objects and views of a pass share.
    fn bound<'b>(
        &self,
        bindings: impl Iterator<Item = &'b Binding>,
        left: &Left,
    ) -> Result<PassBindings, Diagnostics> {
        let mut bound = PassBindings::default();
        let mut library = TextureLibrary::new(self.programs.library(), &self.values, left);
        for binding in bindings {
            let place = (binding.group, binding.binding);
            match binding.kind {
                BindingKind::Uniform => {
                    let bytes = pack_buffer(binding, &|path| self.values.number(path));
                    bound.buffers.insert(place, bytes.map_err(|problem| vec![problem])?);
                }
                BindingKind::Sampler | BindingKind::ComparisonSampler => {
                    bound.fixtures.insert(place, Arc::new(binding_sampler(binding)));
                }
                _ => {
                    let mut chain = library.texture(&binding.name)?;
                    bound.fixtures.insert(place, Arc::new(Fixture::Texture(chain.remove(0))));
                    if !chain.is_empty() {
                        bound.levels.insert(place, chain);
                    }
                }
            }
        }
        Ok(bound)
    }

    fn state(&self, pass: &Pass, has_camera: bool) -> PipelineState {
        let of_viewer = self.values.plan.is_of_viewer(pass);
        if of_viewer || !has_camera {
            // A pass over the screen may read the depths of the pass before it.
            let is_read = of_viewer && !self.values.plan.is_last(pass);
            return PipelineState {
                depth_test: has_camera,
                keep_depth: is_read,
                ..PipelineState::default()
            };
        }
        let is_map = pass.program == "depth";
        PipelineState {
            depth_test: true,
            keep_depth: is_map,
            cull: self.values.culls_front().then_some(Face::Front),
            mirrored: self.values.light.is_cube(),
            offset: if is_map { self.values.offset() } else { [0.0; 2] },
        }
    }

    /// A mesh for each object, with the object's own blocks; one triangle if the stage has no
    /// attributes.
    fn items(
        &self,
        pass: &Pass,
        stages: &Stages,
        bindings: &[Binding],
        part: Part,
    ) -> Result<Vec<(Mesh, Buffers)>, Diagnostic> {
        let vertex = &stages.vertex.reflection;
        if vertex_attributes(vertex).is_empty() {
            return Ok(vec![(Mesh::default(), Buffers::new())]);
        }
        let own: Vec<&Binding> = bindings
            .iter()
            .filter(|binding| matches!(binding.name.as_str(), "object" | "materials" | "layers"))
            .collect();
        let faceted = pass.needs.faceted;
        let of_light = !self.values.plan.is_of_viewer(pass);
        let eye = (!of_light).then_some(self.values.scene.eye.position);
        let item = |object: &Object| {
            let buffer = |binding: &&Binding| {
                let bytes = pack_buffer(binding, &|path| self.values.object(object, path))?;
                Ok(((binding.group, binding.binding), bytes))
            };
            let mesh = mesh::object_mesh(object, vertex, faceted, eye);
            // A mesh without indices would be drawn as a list of corners.
            if mesh.indices.is_empty() {
                return Ok(None);
            }
            let buffers = own.iter().map(buffer).collect::<Result<_, Diagnostic>>()?;
            Ok(Some((mesh, buffers)))
        };
        let objects = self.values.scene.objects.iter();
        let drawn =
            objects.filter(|object| object.casts || !of_light).filter(|object| match part {
                Part::All => true,
                Part::Opaque => !object.is_blended,
                Part::Blended => object.is_blended,
            });
        let Some(eye) = eye.filter(|_| part == Part::Blended) else {
            return drawn.filter_map(|object| item(object).transpose()).collect();
        };
        // The backs of an object may be behind its fronts.
        let sides = drawn.flat_map(|object| object.sides_from(eye));
        sides.filter_map(|object| item(&object).transpose()).collect()
    }
}

/// Blocks of `forward` that only affect colours.
const PLAIN: &[&str] = &["materials", "layers", "haze", "surroundings"];

/// Whether the block is filled for each view or for each object, and not once for the pass. A pass
/// over the screen has no objects, so that all materials are in one block.
fn is_own(name: &str, has_objects: bool) -> bool {
    name == "camera" || has_objects && matches!(name, "object" | "materials" | "layers")
}

/// The first target of the first frame as a texture. `cleared` gives the texels that nothing was
/// drawn into, by their index.
fn color_texture(
    frames: &[Frame],
    [width, height]: [u32; 2],
    cleared: impl Fn(usize) -> [f32; 4],
) -> Result<FixtureTexture, Diagnostics> {
    let words = frames.first().and_then(|frame| frame.targets.first());
    let words = words.ok_or_else(|| vec![no_frame()])?;
    let texels = words.chunks(4).enumerate();
    let texels = texels
        .flat_map(|(index, pixel)| pixel_color(pixel).unwrap_or_else(|| cleared(index)))
        .collect();
    Ok(FixtureTexture { kind: TextureKind::Color2d, width, height, texels })
}

/// The bindings of both stages, each once. If both stages have a binding, it is that of the
/// fragment stage.
pub(super) fn stage_bindings(stages: &Stages) -> Vec<Binding> {
    let of = |stage: &ReadyStage| stage.reflection.bindings.clone();
    let all = of(&stages.vertex).into_iter().chain(stages.fragment.iter().flat_map(of));
    let by_place: BTreeMap<_, _> =
        all.map(|binding| ((binding.group, binding.binding), binding)).collect();
    by_place.into_values().collect()
}
