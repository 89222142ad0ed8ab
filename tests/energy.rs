//! The white furnace test of the whole program `forward` with `metallic_roughness`: the radiance
//! that a white surface reflects under light of radiance 1 from all directions. It is 1 if no
//! energy is lost or gained.
//!
//! The evaluator runs the fragment stage once for each direction of the light. The directions are
//! those of several strategies, weighted by the balance heuristic (Veach, *Robust Monte Carlo
//! Methods for Light Transport Simulation*, 1997, chapter 9), at points of a lattice.
//! `docs/energy.md` has all results. The test computes some of them again, and all with
//! `UPDATE_EXPECT=1`.

mod page;

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::f64::consts::PI;

use glam::{DQuat, DVec2, DVec3};
use lamplight::LIBRARY_FILES;
use lamplight::bundle::{BindingKind, Language};
use lamplight::diagnostic::render::{Form, render};
use lamplight::eval::{FunctionId, Machine, Program, Resources};
use lamplight::permute::{Quoted, key};
use lamplight::picture::frame::{Programs, ReadyStage, pack_buffer};
use lamplight::scene::Layers;
use lamplight::source::SourceSet;
use libtest_mimic::{Failed, Trial};

use crate::{fragments, snapshot};

/// Every 11th cell is computed again.
const STEP: usize = 11;
/// How far a cell may be from the page, which has three digits: half of the last one, and as much for
/// the rounding of other machines' functions.
const SLACK: f64 = 1e-3;

/// Perceptual roughness of the rows.
const ROUGHNESS: [f64; 5] = [0.2, 0.4, 0.6, 0.8, 1.0];
/// Angles of the viewer to the normal, degrees.
const ANGLES: [f64; 3] = [0.0, 60.0, 80.0];

/// Layers over a white base: the axes, the page's words about their factors, and the factors for a
/// roughness of the base.
struct Case {
    axes: &'static str,
    about: &'static str,
    layers: fn(f64) -> Layers,
    /// Whether a metal has the layer too.
    on_metal: bool,
}

const CASES: [Case; 8] = [
    Case { axes: "", about: "no extension", layers: |_| Layers::default(), on_metal: true },
    Case {
        axes: "clearcoat",
        about: "a full coat of roughness 0.1",
        layers: |_| Layers { clearcoat: 1.0, clearcoat_roughness: 0.1, ..Layers::default() },
        on_metal: true,
    },
    Case {
        axes: "sheen",
        about: "a white sheen that is as rough as the base",
        layers: |roughness| Layers {
            sheen_color: DVec3::ONE,
            sheen_roughness: roughness,
            ..Layers::default()
        },
        on_metal: true,
    },
    Case {
        axes: "iridescence",
        about: "a film of index 1.3 and 400 nm; the mean of the channels",
        layers: |_| Layers { iridescence: 1.0, ..Layers::default() },
        on_metal: true,
    },
    Case {
        axes: "anisotropy",
        about: "strength 0.5, seen along the tangent",
        layers: |_| Layers { anisotropy: 0.5, ..Layers::default() },
        on_metal: true,
    },
    Case {
        axes: "transmission",
        about: "all that is not reflected passes a thin sheet",
        layers: |_| Layers { transmission: 1.0, ..Layers::default() },
        on_metal: false,
    },
    Case {
        axes: "transmission,volume",
        about: "all that is not reflected passes a body of index 1.5 that absorbs nothing",
        layers: |_| Layers { transmission: 1.0, thickness: 1.0, ..Layers::default() },
        on_metal: false,
    },
    Case {
        axes: "diffuse_transmission",
        about: "half of the scattered light leaves on the other side, white",
        layers: |_| Layers { diffuse_transmission: 0.5, ..Layers::default() },
        on_metal: false,
    },
];

/// A place in the tables: the case, whether the base is a metal, the roughness, the angle.
type Place = (usize, bool, usize, usize);

/// The radiance that a white surface reflects: under lamps, and under ambient light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cell {
    lamps: f64,
    ambient: f64,
}

pub fn tests() -> Vec<Trial> {
    vec![Trial::test("energy::white_furnace", white_furnace)]
}

fn places() -> Vec<Place> {
    let of = |case: usize| {
        let bases = if CASES[case].on_metal { &[false, true][..] } else { &[false] };
        let rows = bases
            .iter()
            .flat_map(|metal| (0..ROUGHNESS.len()).map(move |roughness| (*metal, roughness)));
        rows.flat_map(move |(metal, roughness)| {
            (0..ANGLES.len()).map(move |angle| (case, metal, roughness, angle))
        })
        .collect::<Vec<_>>()
    };
    (0..CASES.len()).flat_map(of).collect()
}

fn white_furnace() -> Result<(), Failed> {
    let file = snapshot::root().join("docs/energy.md");
    let is_updated = std::env::var_os("UPDATE_EXPECT").is_some();
    let step = if is_updated { 1 } else { STEP };
    let found = computed_cells(places().into_iter().step_by(step))?;
    if is_updated {
        return Ok(std::fs::write(file, page::written(&found))?);
    }
    let text = std::fs::read_to_string(file)?;
    let recorded = page::read_cells(&text)?;
    if page::written(&recorded) != text {
        return Err(
            "docs/energy.md is not what its own numbers give: cargo xtask record energy::white_furnace writes it".into()
        );
    }
    let far = found.iter().filter(|(place, cell)| {
        recorded.get(place).is_none_or(|known| {
            (known.lamps - cell.lamps).abs() > SLACK || (known.ambient - cell.ambient).abs() > SLACK
        })
    });
    let far: Vec<String> = far
        .map(|(place, cell)| format!("{place:?}: {cell:?}, not {:?}", recorded.get(place)))
        .collect();
    println!("{} of {} cells computed again", found.len(), recorded.len());
    if far.is_empty() && !found.is_empty() { Ok(()) } else { Err(far.join("\n").into()) }
}

fn computed_cells(places: impl Iterator<Item = Place>) -> Result<BTreeMap<Place, Cell>, String> {
    let programs = Programs::load(LIBRARY_FILES)
        .map_err(|(sources, problems)| render(&sources, &problems, Form::Human))?;
    let mut furnaces: BTreeMap<(usize, bool), Furnace> = BTreeMap::new();
    let mut cells = BTreeMap::new();
    for place @ (case, metal, roughness, angle) in places {
        for ambient in [false, true] {
            if let Entry::Vacant(entry) = furnaces.entry((case, ambient)) {
                let stage = fragment_stage(&programs, CASES[case].axes, ambient)?;
                entry.insert(Furnace::new(stage)?);
            }
        }
        let layers = Layers {
            metallic: f64::from(u8::from(metal)),
            ..(CASES[case].layers)(ROUGHNESS[roughness])
        };
        let surface = Surface { layers, roughness: ROUGHNESS[roughness], angle: ANGLES[angle] };
        let cell = Cell {
            lamps: surface.lit_by_lamps(&furnaces[&(case, false)])?,
            ambient: surface.lit_by_ambient(&furnaces[&(case, true)])?,
        };
        cells.insert(place, cell);
    }
    Ok(cells)
}

/// The fragment stage with one directional lamp, and with or without ambient light.
fn fragment_stage(programs: &Programs, axes: &str, ambient: bool) -> Result<ReadyStage, String> {
    let ambient = if ambient { "constant" } else { "none" };
    let base = "lights=directional,max_lights=1,metallic_roughness,specular=ggx";
    let text = format!("ambient={ambient},{base},{axes}");
    let program = programs.manifest().program("forward").ok_or("no program `forward`")?;
    let mut texts = SourceSet::default();
    let id = texts.add("key", text.trim_end_matches(',').to_owned());
    let point = key::parse(&program.space, &Quoted::whole(&texts, id))
        .map_err(|problems| render(&texts, &problems, Form::Human))?;
    let stages = programs.stages(program, &program.space.settings(&point), Language::Wesl);
    let stages = stages.map_err(|problems| render(&programs.texts(), &problems, Form::Human))?;
    stages.fragment.ok_or_else(|| "no fragment stage".to_owned())
}

/// A white surface, and the angle from which it is seen.
struct Surface {
    layers: Layers,
    roughness: f64,
    angle: f64,
}

impl Surface {
    /// The direction of the viewer, in the space of the surface: its normal is z, its tangent x.
    fn view(&self) -> DVec3 {
        let (sin, cos) = self.angle.to_radians().sin_cos();
        DVec3::new(sin, 0.0, cos)
    }

    /// The reflected radiance if lamps give radiance 1 from all directions, by Monte Carlo
    /// integration.
    fn lit_by_lamps(&self, furnace: &Furnace) -> Result<f64, String> {
        let mut run = furnace.run(&|path| self.number(path, true))?;
        let ways = self.strategies();
        let mut sum = 0.0;
        for way in &ways {
            for index in 0..SAMPLES {
                let Some(l) = way.direction(self.view(), lattice_point(index)) else { continue };
                let density: f64 = ways.iter().map(|way| way.density(self.view(), l)).sum();
                // A lamp of colour 1 has the irradiance pi.
                sum += run.shade(self.view(), l)? / (PI * density * SAMPLES as f64);
            }
        }
        Ok(sum)
    }

    /// The reflected radiance under ambient light of colour 1.
    fn lit_by_ambient(&self, furnace: &Furnace) -> Result<f64, String> {
        let mut run = furnace.run(&|path| self.number(path, false))?;
        run.shade(self.view(), DVec3::Z)
    }

    fn strategies(&self) -> Vec<Way> {
        let layers = &self.layers;
        let alpha = self.roughness * self.roughness;
        let mut ways = vec![Way::Cosine(1.0), Way::Facets(alpha, 1.0)];
        if layers.clearcoat > 0.0 {
            ways.push(Way::Facets(layers.clearcoat_roughness * layers.clearcoat_roughness, 1.0));
        }
        if layers.anisotropy > 0.0 {
            ways.push(Way::Facets((alpha + 0.25 * (1.0 - alpha)).sqrt() * alpha.sqrt(), 1.0));
        }
        if layers.transmission > 0.0 || layers.diffuse_transmission > 0.0 {
            ways.extend([Way::Cosine(-1.0), Way::Facets(alpha, -1.0)]);
        }
        ways
    }

    /// Values of the uniforms: a lamp of colour 1, or ambient light of colour 1.
    fn number(&self, path: &str, has_lamp: bool) -> Vec<f64> {
        let (block, _) = path.split_once('.').unwrap_or((path, ""));
        let field = path.rsplit('.').next().unwrap_or(path);
        match (block, field) {
            ("lamps", "count") => vec![f64::from(u8::from(has_lamp))],
            ("lamps", "kind") => vec![1.0],
            ("lamps", "color") => vec![1.0; 3],
            // The lamp shines along -z of the world.
            ("lamps", "axis") => vec![0.0, 0.0, -1.0],
            ("lamps", "strength") => vec![1.0],
            ("surroundings", "color") | ("materials", "ambient") => vec![1.0; 3],
            ("materials", "roughness") => vec![self.roughness],
            ("layers", field) => self.layers.number(field).unwrap_or_else(|| vec![1.0]),
            // The rest is zero: the viewer is at the origin.
            _ => Vec::new(),
        }
    }
}

/// How many directions of the light are sampled by each strategy.
const SAMPLES: usize = 1536;

/// Points of the plane that are spread evenly (Roberts, "The Unreasonable Effectiveness of
/// Quasirandom Sequences", 2018).
fn lattice_point(index: usize) -> DVec2 {
    let at = |share: f64| (0.5 + (index as f64 + 1.0) * share).fract();
    DVec2::new(at(0.754_877_666_246_692_7), at(0.569_840_290_998_053_2))
}

/// A sampling strategy for directions of the light. The last field is 1 for the viewer's side of
/// the surface, and -1 for the other side.
enum Way {
    Cosine(f64),
    /// The view direction, reflected at GGX microfacet normals of this alpha.
    Facets(f64, f64),
}

impl Way {
    fn direction(&self, view: DVec3, at: DVec2) -> Option<DVec3> {
        let (sin, cos) = (2.0 * PI * at.y).sin_cos();
        let (l, side) = match self {
            Self::Cosine(side) => {
                let radius = at.x.sqrt();
                (DVec3::new(radius * cos, radius * sin, (1.0 - at.x).sqrt()), side)
            }
            Self::Facets(alpha, side) => {
                let slope2 = alpha * alpha * at.x / (1.0 - at.x);
                let height = 1.0 / (1.0 + slope2).sqrt();
                let radius = (1.0 - height * height).max(0.0).sqrt();
                let h = DVec3::new(radius * cos, radius * sin, height);
                (2.0 * view.dot(h) * h - view, side)
            }
        };
        (l.z > 0.0).then_some(DVec3::new(l.x, l.y, l.z * side))
    }

    /// The probability density of sampling a direction, per steradian.
    fn density(&self, view: DVec3, l: DVec3) -> f64 {
        let (Self::Cosine(side) | Self::Facets(_, side)) = self;
        if l.z * side <= 0.0 {
            return 0.0;
        }
        let l = DVec3::new(l.x, l.y, l.z.abs());
        match self {
            Self::Cosine(_) => l.z / PI,
            Self::Facets(alpha, _) => {
                let h = (l + view).normalize();
                let across = h.x * h.x + h.y * h.y;
                let k = alpha / (across + (h.z * alpha).powi(2));
                k * k / PI * h.z / (4.0 * view.dot(h))
            }
        }
    }
}

/// A fragment stage for the evaluator.
struct Furnace {
    stage: ReadyStage,
    program: Program,
    /// The index of an input's component, by its location.
    inputs: BTreeMap<(u32, usize), usize>,
}

impl Furnace {
    fn new(stage: ReadyStage) -> Result<Self, String> {
        let program = Program::new(&stage.validated.module, &stage.validated.info)
            .map_err(|error| error.to_string())?;
        let inputs = fragments::places(&stage)?;
        Ok(Self { stage, program, inputs })
    }

    /// With values for its uniforms.
    fn run(&self, number: &dyn Fn(&str) -> Vec<f64>) -> Result<Run<'_>, String> {
        let mut resources = Resources::default();
        for binding in &self.stage.reflection.bindings {
            if binding.kind == BindingKind::Uniform {
                let bytes = pack_buffer(binding, &|path| Some(number(path)));
                let place = (binding.group, binding.binding);
                resources.buffers.insert(place, bytes.map_err(|problem| problem.message)?);
            }
        }
        let mut machine = Machine::new(&self.program).map_err(|error| error.to_string())?;
        machine.bind(resources).map_err(|error| error.to_string())?;
        let mut functions = self.program.functions();
        let (id, signature) = functions
            .find(|(_, function)| function.name == self.stage.entry)
            .ok_or("no entry point")?;
        let arguments = vec![0.0; signature.arguments.len()];
        Ok(Run { furnace: self, machine, id, arguments })
    }
}

/// The evaluator with a fragment stage and its uniforms.
struct Run<'f> {
    furnace: &'f Furnace,
    machine: Machine<'f, f64>,
    id: FunctionId,
    arguments: Vec<f64>,
}

impl Run<'_> {
    /// The mean of the colour's channels, for directions in the space of the surface. The lamp stays
    /// where it is, and the surface is turned with its viewer, who is at the origin.
    fn shade(&mut self, view: DVec3, l: DVec3) -> Result<f64, String> {
        let turn = DQuat::from_rotation_arc(l, DVec3::Z);
        let given =
            [(0, -(turn * view)), (1, turn * DVec3::Z), (2, DVec3::ONE), (5, turn * DVec3::X)];
        for (location, vector) in given {
            for (component, value) in vector.extend(1.0).to_array().into_iter().enumerate() {
                if let Some(index) = self.furnace.inputs.get(&(location, component)) {
                    self.arguments[*index] = value;
                }
            }
        }
        let color =
            self.machine.call(self.id, &self.arguments).map_err(|error| error.to_string())?;
        Ok((color[0] + color[1] + color[2]) / 3.0)
    }
}
