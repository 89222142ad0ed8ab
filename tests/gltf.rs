//! `forward` draws models as glTF says. Each row is a property of the specification or of an extension: a
//! model that the test makes is drawn by the library and by a renderer in f64 that is written from the texts
//! (`tests/gltf/`, each formula with its place in them) and shares no code with it. Linear radiances are
//! compared, and what is measured with what `docs/guide/gltf.md` says of the row.

mod brdf;
mod model;
mod page;
mod reference;
mod rows;
mod tangents;

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use lamplight::bundle::Language;
use lamplight::bundle::key::{IMPLIED, has_value};
use lamplight::execute::Session;
use lamplight::model::{Lacks, View, read_model};
use lamplight::picture::{Linear, Plan, prepare_passes};
use libtest_mimic::{Failed, Trial};

use crate::render::{library, on_device, rendered, shot};
use model::Model;
use reference::{Scene, Seen};
use rows::{Expected, Row};

/// The executors, and the language in which each is given the shaders.
const EXECUTORS: [(&str, Language); 3] =
    [("eval", Language::Wesl), ("vulkan", Language::Wesl), ("gl", Language::Glsl)];
/// Pixels along an edge.
const SIZE: usize = 48;
/// A pixel agrees if each channel is this close, as a share of the channel or of white.
const CLOSE: f64 = 0.01;
/// The least share of pixels that agree.
const LEAST: f64 = 0.995;
/// The largest share of pixels that are excluded, since another triangle is beside them.
const EXCLUDED: f64 = 0.05;
/// How far devices may be from the page's share of a row that differs, which is the evaluator's.
const NEAR: f64 = 0.02;
/// The same for the page's median difference, as a share of it or of [`CLOSE`].
const NEAR_MEDIAN: f64 = 0.02;
/// Half of the last digit that the page has of a median difference.
const ROUNDED: f64 = 0.0005;

pub fn tests() -> Vec<Trial> {
    let each = rows::all().into_iter().flat_map(|row| {
        EXECUTORS.map(move |(executor, language)| {
            let row = row.clone();
            Trial::test(format!("gltf/{}/{executor}", row.name), move || {
                on_device(executor, |painter| compared(&row, executor, painter, language))
            })
        })
    });
    each.chain([Trial::test("gltf/page", page::is_current)]).collect()
}

/// How well a picture agrees with the reference.
#[derive(Debug, Clone, Copy)]
struct Agreement {
    /// The share of the pixels that are compared and agree.
    agree: f64,
    /// The share of the pixels that are excluded.
    excluded: f64,
    /// The largest difference, as a share of the channel or of white.
    worst: f64,
    /// The difference that half of the pixels do not have.
    median: f64,
}

impl Agreement {
    fn percent(self) -> String {
        format!("{:.1}", (1000.0 * self.agree).floor() / 10.0)
    }

    /// What the page says of a row.
    fn figure(self, expected: Expected) -> String {
        match expected {
            Expected::Agrees => self.percent(),
            Expected::Differs { .. } => {
                format!("{}{}{:.1}", self.percent(), page::MEDIAN, 100.0 * self.median)
            }
        }
    }
}

/// Draws a row with an executor and compares it with the reference.
fn measured(row: &Row, painter: &dyn Session, language: Language) -> Result<Agreement, String> {
    let model = (row.make)();
    let found = picture(&model, painter, language)?;
    let wanted = reference(row, &model);
    Ok(agreement(&found, &wanted))
}

/// The picture of a row, once it is drawn.
type Drawn = Arc<OnceLock<Arc<Vec<Seen>>>>;

/// What the reference draws of a row, once for all executors.
fn reference(row: &Row, model: &Model) -> Arc<Vec<Seen>> {
    static DRAWN: Mutex<BTreeMap<&str, Drawn>> = Mutex::new(BTreeMap::new());
    let mut drawn = DRAWN.lock().unwrap_or_else(PoisonError::into_inner);
    let own = drawn.entry(row.name).or_default().clone();
    drop(drawn);
    own.get_or_init(|| Arc::new(Scene::new(model, row.choices).draw(SIZE))).clone()
}

fn compared(
    row: &Row,
    executor: &str,
    painter: &dyn Session,
    language: Language,
) -> Result<(), String> {
    let found = measured(row, painter, language)?;
    println!("{}: {found:?}", row.name);
    if found.excluded > EXCLUDED {
        return Err(format!("{} of the pixels are excluded", found.excluded));
    }
    let agrees = found.agree >= LEAST;
    match row.expected {
        Expected::Agrees if !agrees => Err(format!(
            "{} % of the pixels agree, the largest difference is {:.4}",
            found.percent(),
            found.worst
        )),
        Expected::Differs { .. } if agrees => {
            Err(format!("{} % of the pixels agree, so the row does not differ", found.percent()))
        }
        _ if page::is_updated() => Ok(()),
        _ if executor == "eval" => as_printed(row, found),
        Expected::Agrees => Ok(()),
        Expected::Differs { .. } => near_printed(row, found),
    }
}

/// The evaluator's figure is that of the page.
fn as_printed(row: &Row, found: Agreement) -> Result<(), String> {
    let (figure, printed) = (found.figure(row.expected), page::printed(row)?);
    match figure == printed {
        true => Ok(()),
        false => Err(format!("measured `{figure}`, but the page has `{printed}`")),
    }
}

/// A device's figures are those of the page, but for its rounding.
fn near_printed(row: &Row, found: Agreement) -> Result<(), String> {
    let (agree, median) = page::listed(row)?;
    let is_near = (found.agree - agree).abs() <= NEAR
        && (found.median - median).abs() <= NEAR_MEDIAN * median.max(CLOSE) + ROUNDED;
    match is_near {
        true => Ok(()),
        false => Err(format!("measured {found:?}, but the page has {agree} and {median}")),
    }
}

/// The picture of a model by the program and the axes that it asks for, without surroundings and shadows.
fn picture(model: &Model, painter: &dyn Session, language: Language) -> Result<Linear, String> {
    let mut read = read_model(&model.glb(), View::Own)?;
    read.fit(1.0);
    let is_lit = |value: &&String| {
        let axis = value.split('=').next().unwrap_or_default();
        !axis.starts_with("shadow") && axis != "ambient" && axis != "occlusion"
    };
    let own = read.axes.iter().chain(&read.layers).filter(is_lit).map(String::as_str);
    let key = own.chain(["shadow=none", "ambient=none"]).collect::<Vec<&str>>().join(",");
    let mut plan = Plan::of_key(&library().programs, "forward", &key).map_err(rendered)?;
    let key = plan.last().map_or("", |pass| pass.key.as_str());
    let lacks = Lacks { maps: !has_value(key, "material_maps", IMPLIED), occlusion: true };
    let (scene, _) = read.scene_of(lacks);
    plan.model = Some(Arc::new(scene));
    let shot = shot([SIZE as u32; 2], 1, language);
    let prepared = prepare_passes(painter, &library().programs, &plan, &shot).map_err(rendered)?;
    prepared.photograph(painter, &shot).map_err(rendered)
}

/// Compares all pixels, apart from those with another triangle beside them.
fn agreement(found: &Linear, wanted: &[Seen]) -> Agreement {
    let at = |x: usize, y: usize| &wanted[y * SIZE + x];
    let is_excluded = |x: usize, y: usize| {
        let near = |place: usize| place.saturating_sub(1)..(place + 2).min(SIZE);
        let mut others = near(y).flat_map(|y| near(x).map(move |x| (x, y)));
        others.any(|(i, j)| at(i, j).triangles != at(x, y).triangles)
    };
    let (mut differences, mut excluded) = (Vec::new(), 0);
    for (x, y) in (0..SIZE).flat_map(|y| (0..SIZE).map(move |x| (x, y))) {
        if is_excluded(x, y) {
            excluded += 1;
            continue;
        }
        let drawn = found.drawn(x as u32, y as u32);
        let is_empty = at(x, y).triangles.is_empty();
        let difference = match drawn {
            None if is_empty => 0.0,
            Some(drawn) if !is_empty => {
                let wanted = at(x, y).radiance;
                // |a-b| as a share of max(|b|, 0.01 white).
                let scale = wanted.abs().max(glam::DVec3::splat(CLOSE));
                ((drawn - wanted).abs() / scale).max_element()
            }
            _ => f64::INFINITY,
        };
        differences.push(difference);
    }
    differences.sort_by(f64::total_cmp);
    let agree = differences.iter().filter(|difference| **difference <= CLOSE).count();
    let worst = differences.last().copied().unwrap_or_default();
    let median = differences.get(differences.len() / 2).copied().unwrap_or_default();
    let all = SIZE * SIZE;
    let share = |count: usize, of: usize| count as f64 / of.max(1) as f64;
    let agree = share(agree, all - excluded);
    Agreement { agree, excluded: share(excluded, all), worst, median }
}

/// The rows with what the evaluator's pictures agree in, each measured once.
fn all_measured() -> &'static [(Row, Result<Agreement, String>)] {
    static MEASURED: OnceLock<Vec<(Row, Result<Agreement, String>)>> = OnceLock::new();
    MEASURED.get_or_init(|| {
        let measure = |row: Row| {
            let mut found = Err("no result".to_owned());
            let outcome = on_device("eval", |painter| {
                found = measured(&row, painter, Language::Wesl);
                Ok(())
            });
            (row, outcome.map_err(|_| "the evaluator stopped".to_owned()).and(found))
        };
        rows::all().into_iter().map(measure).collect()
    })
}

fn failed(reason: impl Into<String>) -> Failed {
    reason.into().into()
}
