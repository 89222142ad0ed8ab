//! Pictures of the program `published` have the colours that models of the printed listings give.
//! The models are written in f64 from the texts alone, and share no code with the library.

use std::collections::{BTreeMap, BTreeSet};

use glam::{DVec3, DVec4};
use lamplight::bundle::Language;
use lamplight::catalogue::preset::Preset;
use lamplight::execute::Session;
use lamplight::picture::{Linear, Plan, PreparedPass, prepare_passes};
use libtest_mimic::Trial;

use super::geometry::{Corner, Hit, Pixels};
use super::listing::{Fragment, Listing};
use super::numbers::Given;
use super::{hpg, oglpg, tutorials};
use crate::is_whole;
use crate::render::{library, on_device, plan, rendered, shot};

/// The size of the pictures, and the least number of pixels that are compared.
pub const SIZE: [u32; 2] = [96, 72];
pub const LEAST: usize = 500;
/// The largest error, as a share of the listing's value or of white, whichever is larger.
const ERROR: f64 = 0.01;
const WHITE: f64 = 0.01;
/// The least share of the defined pixels that agree.
pub const AGREEING: f64 = 0.995;
/// The largest share of the pixels that the source leaves undefined.
const UNDEFINED: f64 = 0.2;
/// By day, a driver draws every ninth listing.
const STEP: usize = 9;

/// How many pixels were compared, how many agree, and how many the source leaves undefined.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Agreement {
    pub compared: usize,
    pub agreeing: usize,
    pub undefined: usize,
    /// The largest error as a share of what is allowed, of pixels that agree.
    pub share: f64,
}

pub fn tests() -> Vec<Trial> {
    let all = || library().presets.iter().filter(|preset| is_published(preset)).enumerate();
    let on_eval = all().flat_map(|(index, preset)| {
        let other = if index % 2 == 0 { Language::Wesl } else { Language::Glsl };
        let languages = if is_whole() { vec![Language::Wesl, Language::Glsl] } else { vec![other] };
        languages.into_iter().map(move |language| trial(preset, language, "eval"))
    });
    let backends = [("vulkan", Language::Wesl), ("gl", Language::Glsl)];
    let on_drivers = all().flat_map(move |(index, preset)| {
        let turns = backends.into_iter().enumerate();
        let chosen = turns.filter(move |(turn, _)| is_whole() || index % STEP == 4 * turn);
        chosen.map(move |(_, (backend, language))| trial(preset, language, backend))
    });
    on_eval.chain(on_drivers).collect()
}

/// Whether a preset draws a listing as it is printed.
pub fn is_published(preset: &Preset) -> bool {
    preset.program == "published" || preset.key == "curve=igl"
}

fn trial(preset: &'static Preset, language: Language, executor: &'static str) -> Trial {
    let name = format!("published::{}/{}/{executor}", preset.name, language.name());
    Trial::test(name, move || {
        on_device(executor, |painter| {
            let found = agreement(painter, preset, language)?;
            println!("{}, {language:?} on {executor}: {found:?}", preset.name);
            found.checked()
        })
    })
}

impl Agreement {
    fn add(&mut self, found: Option<DVec3>, wanted: Option<DVec3>) {
        self.compared += 1;
        let Some(wanted) = wanted else {
            self.undefined += 1;
            return;
        };
        let allowed = wanted.abs().max(DVec3::splat(WHITE)) * ERROR;
        let share = found.map_or(f64::INFINITY, |found| {
            let share = (found - wanted).abs() / allowed;
            if share.is_nan() { f64::INFINITY } else { share.max_element() }
        });
        if share <= 1.0 {
            self.agreeing += 1;
            self.share = self.share.max(share);
        }
    }

    fn checked(&self) -> Result<(), String> {
        self.checked_for(AGREEING)
    }

    /// Whether enough pixels have a defined colour, and of those the least share agrees.
    pub fn checked_for(&self, least: f64) -> Result<(), String> {
        let defined = self.compared - self.undefined;
        if defined < LEAST || self.undefined as f64 > UNDEFINED * self.compared as f64 {
            return Err(format!("too few pixels have a defined colour: {self:?}"));
        }
        if (self.agreeing as f64) < least * defined as f64 {
            return Err(format!("too few pixels agree with the listing: {self:?}"));
        }
        Ok(())
    }
}

/// Compares a picture of a preset with the model of its listing.
pub fn agreement(
    painter: &dyn Session,
    preset: &Preset,
    language: Language,
) -> Result<Agreement, String> {
    agreement_of([painter, painter], preset, language)
}

/// The same with two executors: the first draws what the last pass reads, such as shadow maps.
pub fn agreement_of(
    [maker, painter]: [&dyn Session; 2],
    preset: &Preset,
    language: Language,
) -> Result<Agreement, String> {
    let plan = plan(preset)?;
    let shot = shot(SIZE, 1, language);
    let mut prepared =
        prepare_passes(maker, &library().programs, &plan, &shot).map_err(rendered)?;
    // Drivers may choose how they blend two mip levels, so textures have only one here.
    prepared.levels.clear();
    let picture = prepared.photograph(painter, &shot).map_err(rendered)?;
    let pixels = sampled_pixels(&picture);
    let on = Device::of(painter);
    let (wanted, open) = match preset.program.as_str() {
        "published" => modelled(&plan, &prepared, &pixels, on)?,
        _ => (shown_depths(&prepared, &pixels)?, BTreeSet::new()),
    };
    let mut agreement = Agreement::default();
    for pixel in pixels.iter().filter(|pixel| !open.contains(*pixel)) {
        let found = picture.drawn(pixel[0], pixel[1]);
        let Some(wanted) = wanted.get(pixel) else {
            agreement.add(None, Some(DVec3::ZERO));
            continue;
        };
        let before = agreement.agreeing + agreement.undefined;
        agreement.add(found, *wanted);
        if agreement.agreeing + agreement.undefined == before {
            println!("{}: at {pixel:?} found {found:?}, wanted {wanted:?}", preset.name);
        }
    }
    Ok(agreement)
}

/// What the models know of a device.
#[derive(Clone, Copy)]
struct Device {
    /// Whether it computes in 32 bits as IEEE 754 says.
    exact: bool,
    /// The steps of a pixel to which its rasterizer moves corners, where they are coarse enough to be
    /// seen, or where it interpolates between the corners there: 8 bits in the rasterizer of the
    /// evaluator and of compiled MSL, and 4 in SwiftShader, also where Chromium draws with it.
    steps: Option<f64>,
}

/// With steps as coarse as these, many edges go through the middle of a pixel, which is then not
/// compared.
const COARSE: f64 = 16.0;

impl Device {
    fn of(painter: &dyn Session) -> Self {
        let adapter = painter.adapter().to_lowercase();
        let exact = adapter.starts_with("lamplight eval");
        let steps = match adapter {
            own if exact || own.contains("clang") => Some(256.0),
            swiftshader if swiftshader.contains("swiftshader") => Some(COARSE),
            _ => None,
        };
        Self { exact, steps }
    }
}

/// Pixels that show a surface, spread over the picture.
fn sampled_pixels(picture: &Linear) -> Vec<[u32; 2]> {
    let [width, height] = SIZE;
    let places = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
    let drawn: Vec<[u32; 2]> = places.filter(|[x, y]| picture.drawn(*x, *y).is_some()).collect();
    let step = (drawn.len() / (LEAST + LEAST / 4)).max(1);
    drawn.into_iter().step_by(step).collect()
}

/// The colours that a model gives to pixels; `None` where they are undefined.
type Colors = BTreeMap<[u32; 2], Option<DVec3>>;

/// The colours that the model gives to pixels, and those whose place is open. A pixel without an entry
/// shows nothing.
fn modelled(
    plan: &Plan,
    prepared: &PreparedPass,
    pixels: &[[u32; 2]],
    Device { exact, steps }: Device,
) -> Result<(Colors, BTreeSet<[u32; 2]>), String> {
    let last = plan.last().ok_or("no pass")?;
    let example = last.settings.values.get("example").ok_or("no example")?.to_string();
    let found = [oglpg::listing, hpg::listing, tutorials::listing];
    let listing = found.iter().find_map(|listing| listing(&example)).ok_or("no model")?;
    let view = prepared.eye_view([0.0; 2], SIZE).map_err(|problem| problem.message)?;
    let given: Vec<Given> =
        prepared.items.iter().map(|(_, own)| Given::of(prepared, own, &view)).collect();
    let mut seen = Pixels::new(SIZE, steps, pixels);
    for (item, (mesh, _)) in prepared.items.iter().enumerate() {
        let clip_from_world = given[item].matrix("camera.clip_from_world");
        seen.add(item, mesh, clip_from_world * given[item].model());
    }
    let color = |(pixel, hit): (&[u32; 2], &Hit)| {
        let fragment = Fragment { pixel: *pixel, front: hit.front, exact };
        (*pixel, shaded(&listing, &given[hit.item], hit, &fragment))
    };
    let is_open = |pixel: &[u32; 2]| steps == Some(COARSE) && seen.on_edges.contains(pixel);
    let colors = seen.hits.iter().map(color).collect();
    Ok((colors, pixels.iter().filter(|pixel| is_open(pixel)).copied().collect()))
}

/// Runs both shaders of a listing.
fn shaded(listing: &Listing, given: &Given, hit: &Hit, at: &Fragment) -> Option<DVec3> {
    let passed = hit.corners.map(|corner: Corner| (listing.vertex)(given, &corner));
    let shares = hit.shares.to_array();
    let mix = |index: usize| (0..3).map(|k| passed[k][index] * shares[k]).sum::<DVec4>();
    let interpolated: Vec<DVec4> = (0..passed[0].len()).map(mix).collect();
    (listing.fragment)(given, &interpolated, at)
}

/// Igalia's picture of a shadow map: `1 - (1 - depth)*100` of the texel.
fn shown_depths(prepared: &PreparedPass, pixels: &[[u32; 2]]) -> Result<Colors, String> {
    let given = Given::of(prepared, &BTreeMap::new(), &BTreeMap::new());
    let map = given.texture("depths").ok_or("no depths")?;
    let color = |pixel: &[u32; 2]| {
        let at = |axis: usize, side: u32| {
            let place = (f64::from(pixel[axis]) + 0.5) / f64::from(SIZE[axis]);
            (place * f64::from(side)) as usize
        };
        let texel = at(1, map.height) * map.width as usize + at(0, map.width);
        let depth = map.texels.get(texel * map.kind.channels()).copied().map(f64::from);
        (*pixel, depth.map(|depth| DVec3::splat(1.0 - (1.0 - depth) * 100.0)))
    };
    Ok(pixels.iter().map(color).collect())
}
