//! Draws figures: pictures of single functions. The evaluator computes them.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use glam::DVec3;

use super::pixels::{Linear, Picture};
use super::prepared::sample_shift;
use crate::strip::place_words;
use crate::textures::{columns, fence, image};
use lamplight_bundle::Language;
use lamplight_catalogue::figure::{Figure, FigureKind, Figures, Kinds, Textures};
use lamplight_check::library::Library;
use lamplight_compose::project::LIBRARY;
use lamplight_diagnostic::source::{Embedded, SourceSet};
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_execute::executors::eval::EXECUTOR;
use lamplight_execute::fixture::{Address, Compare, Fixture, FixtureSampler, TextureKind};
use lamplight_execute::kernel::{self, Kernel};
use lamplight_execute::{Session, on_thread};

/// The side of a panel and the gap between panels, in pixels, and the colour of the gap.
pub const SIDE: u32 = 144;
const GAP: u32 = 4;
const GROUND: [u8; 3] = [24, 26, 30];
/// Samples per pixel.
const SAMPLES: u32 = 4;
/// A check computes only the middle pixel of each square with this side, in pixels.
const SPARSE: u32 = 9;
/// Part of the pixels that must be as they were, within `CLOSE` of 255. Sines and powers differ
/// between systems in their last digit, and an edge may then fall on another pixel.
const ALIKE: f64 = 0.97;
const CLOSE: u8 = 4;

const FUNCTION: &str = "lamplight_figure";

/// PNG files by path below the catalogue's folder.
pub type Pictures = BTreeMap<String, Vec<u8>>;

/// All figures. A picture that exists is kept if a part of its pixels, computed again, is as it
/// was.
///
/// # Errors
/// Those of the functions and expressions, with the figure's name.
pub fn draw_figures(
    library: Embedded,
    kinds: &Kinds,
    figures: &Figures,
    existing: &(dyn Fn(&str) -> Option<Vec<u8>> + Sync),
) -> Result<Pictures, Diagnostics> {
    let drawn = each_figure(figures, &|path, figure| {
        let panels = Panels::new(library, kinds, path, figure)?;
        let old = existing(path).filter(|png| panels.shows(png));
        let png = old.map_or_else(|| panels.draw()?.png().map_err(not_written), Ok)?;
        Ok((lamplight_catalogue::figure::picture_path(path), png))
    })?;
    Ok(drawn.into_iter().collect())
}

/// Names of figures whose pictures do not show what their functions compute, or are missing.
///
/// # Errors
/// As of [`draw_figures`].
pub fn stale_figures(
    library: Embedded,
    kinds: &Kinds,
    figures: &Figures,
    existing: &(dyn Fn(&str) -> Option<Vec<u8>> + Sync),
) -> Result<Vec<String>, Diagnostics> {
    let stale = each_figure(figures, &|path, figure| {
        let panels = Panels::new(library, kinds, path, figure)?;
        let is_shown = existing(path).is_some_and(|png| panels.shows(&png));
        Ok((!is_shown).then(|| path.to_owned()))
    })?;
    Ok(stale.into_iter().flatten().collect())
}

/// Calls a function for all figures that are drawn, on several threads.
fn each_figure<T: Send>(
    figures: &Figures,
    run: &(dyn Fn(&str, &Figure) -> Result<T, Diagnostics> + Sync),
) -> Result<Vec<T>, Diagnostics> {
    let all: Vec<_> = figures.iter().filter(|(_, figure)| figure.none.is_none()).collect();
    let next = AtomicUsize::new(0);
    let found = Mutex::new(Vec::new());
    let work = || {
        while let Some((path, figure)) = all.get(next.fetch_add(1, Ordering::Relaxed)) {
            let made = run(path, figure).map_err(|problems| {
                let named =
                    |problem: Diagnostic| problem.note(format!("in the figure of `{path}`"));
                problems.into_iter().map(named).collect::<Vec<_>>()
            });
            found.lock().unwrap_or_else(PoisonError::into_inner).push((*path, made));
        }
    };
    let threads = std::thread::available_parallelism().map_or(1, |count| count.get().min(8));
    let ended = std::thread::scope(|scope| {
        let running: Vec<_> = (0..threads).map(|_| scope.spawn(|| on_thread(work))).collect();
        running.into_iter().all(|one| matches!(one.join(), Ok(Some(()))))
    });
    let mut found = found.into_inner().unwrap_or_else(PoisonError::into_inner);
    if !ended {
        return Err(vec![Diagnostic::error(codes::EVAL_INTERNAL, "the figures stopped")]);
    }
    found.sort_by_key(|(path, _)| *path);
    let (mut all, mut problems) = (Vec::new(), Vec::new());
    for (_, made) in found {
        match made {
            Ok(one) => all.push(one),
            Err(some) => problems.extend(some),
        }
    }
    if problems.is_empty() { Ok(all) } else { Err(problems) }
}

fn not_written(reason: String) -> Diagnostics {
    vec![Diagnostic::error(codes::EVAL_INTERNAL, reason)]
}

/// The panels of a figure, ready to be computed.
struct Panels {
    kernel: Kernel,
    values: Vec<f64>,
}

impl Panels {
    fn new(
        files: Embedded,
        kinds: &Kinds,
        path: &str,
        figure: &Figure,
    ) -> Result<Self, Diagnostics> {
        let kind = kinds.get(&figure.kind);
        let kind = kind.ok_or_else(|| not_written(format!("no kind `{}`", figure.kind)))?;
        let sources = Mutex::new(SourceSet::default());
        let text = figure_text(kind, path, figure);
        let library = Library::shipped(files);
        let root = ("figure.wesl", text.as_str());
        let module = library.importing(&sources, root, Language::Wesl, FUNCTION)?.module;
        let kernel = kernel::build_kernel(&module, FUNCTION, &fixtures(kind.textures));
        Ok(Self { kernel: kernel.map_err(|error| vec![error])?, values: figure.panel_values() })
    }

    /// The linear colour at samples of a panel's pixels.
    fn colors(
        &self,
        session: &mut dyn Session,
        value: f64,
        places: impl Iterator<Item = [f64; 2]>,
    ) -> Result<Vec<DVec3>, Diagnostics> {
        let value = (value as f32).to_bits();
        let words = places.flat_map(|place| {
            let [across, up] = place_words(place, [SIDE; 2]);
            [across, up, value]
        });
        let words: Vec<u32> = words.collect();
        let found = session.run(&self.kernel, &words).map_err(|error| vec![error])?;
        let number = |word: &u32| f64::from(f32::from_bits(*word));
        let color = |words: &[u32; 3]| DVec3::from_array(words.each_ref().map(number));
        Ok(found.as_chunks::<3>().0.iter().map(color).collect())
    }

    /// Some pixels of a panel, in sRGB.
    fn develop(
        &self,
        session: &mut dyn Session,
        value: f64,
        pixels: &[[u32; 2]],
    ) -> Result<Picture, Diagnostics> {
        let mut linear = Linear::new([pixels.len() as u32, 1]);
        for index in 0..SAMPLES {
            let shift = sample_shift(index, SAMPLES);
            let place = |pixel: &[u32; 2]| [0, 1].map(|at| f64::from(pixel[at]) + 0.5 + shift[at]);
            let colors = self.colors(session, value, pixels.iter().map(place))?;
            linear.add_all(colors.into_iter(), 0.0);
        }
        Ok(linear.develop())
    }

    fn draw(&self) -> Result<Picture, Diagnostics> {
        let mut session = evaluator()?;
        let count = self.values.len() as u32;
        let mut picture = Picture::filled(count * (SIDE + GAP) - GAP, SIDE, GROUND);
        let pixels: Vec<_> = (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| [x, y])).collect();
        for (index, value) in self.values.iter().enumerate() {
            let row = self.develop(session.as_mut(), *value, &pixels)?;
            let panel = Picture { width: SIDE, height: SIDE, ..row };
            picture.place(&panel, [index as u32 * (SIDE + GAP), 0]);
        }
        Ok(picture)
    }

    /// Whether a picture shows the figure, by some of its pixels.
    fn shows(&self, png: &[u8]) -> bool {
        let Ok(picture) = Picture::from_png(png) else { return false };
        let count = self.values.len() as u32;
        if [picture.width, picture.height] != [count * (SIDE + GAP) - GAP, SIDE] {
            return false;
        }
        let along = || (0..SIDE / SPARSE).map(|at| at * SPARSE + SPARSE / 2);
        let pixels: Vec<_> = along().flat_map(|y| along().map(move |x| [x, y])).collect();
        let Ok(mut session) = evaluator() else { return false };
        let (mut alike, mut all) = (0, 0);
        for (index, value) in self.values.iter().enumerate() {
            let Ok(row) = self.develop(session.as_mut(), *value, &pixels) else { return false };
            let left = index as u32 * (SIDE + GAP);
            for ([x, y], color) in pixels.iter().zip(row.pixels.as_chunks::<3>().0) {
                let old = picture.pixel([left + x, *y]);
                let is_close = |(one, other): (&u8, &u8)| one.abs_diff(*other) <= CLOSE;
                alike += u32::from(old.iter().zip(color).all(is_close));
                all += 1;
            }
        }
        f64::from(alike) >= ALIKE * f64::from(all)
    }
}

fn evaluator() -> Result<Box<dyn Session>, Diagnostics> {
    EXECUTOR.start().map_err(|_| not_written("the evaluator could not be started".to_owned()))
}

/// A module whose function takes a place in a panel and the value of the panel, and returns a
/// colour.
fn figure_text(kind: &FigureKind, path: &str, figure: &Figure) -> String {
    let name = figure.panels.as_ref().map_or("unused", |panels| &panels.name);
    let code = kind.code.replace("VALUE", &figure.value);
    let (taken, given) = match kind.textures {
        Textures::None => ("", ""),
        Textures::Depth => (
            "map: texture_depth_2d, smp: sampler_comparison, depths: texture_2d<f32>, depths_smp: sampler, ",
            "map, smp, depths, depths_smp, ",
        ),
        Textures::Cube => ("cube: texture_depth_cube, smp: sampler_comparison, ", "cube, smp, "),
        Textures::Image => ("map: texture_2d<f32>, smp: sampler, ", "map, smp, "),
    };
    format!(
        "import {LIBRARY}::{path};\n{code}\n\nvar<private> {name}: f32;\n\n\
         fn {FUNCTION}({taken}across: f32, up: f32, second: f32) -> vec3f {{\n    \
         {name} = second;\n    return shown({given}vec2f(across, up));\n}}\n"
    )
}

fn fixtures(textures: Textures) -> BTreeMap<String, Arc<Fixture>> {
    let sampler = |compare| {
        Fixture::Sampler(FixtureSampler { compare, linear: true, address: Address::Clamp })
    };
    let lit = || sampler(Some(Compare::LessEqual));
    let nearest = || {
        Fixture::Sampler(FixtureSampler { compare: None, linear: false, address: Address::Clamp })
    };
    let texture = Fixture::Texture;
    let named = |all: Vec<(&str, Fixture)>| {
        all.into_iter().map(|(name, one)| (name.to_owned(), Arc::new(one))).collect()
    };
    match textures {
        Textures::None => BTreeMap::new(),
        Textures::Depth => named(vec![
            ("map", texture(fence(TextureKind::Depth2d))),
            ("smp", lit()),
            ("depths", texture(fence(TextureKind::Color2d))),
            ("depths_smp", nearest()),
        ]),
        Textures::Cube => named(vec![("cube", texture(columns())), ("smp", lit())]),
        Textures::Image => named(vec![("map", texture(image())), ("smp", sampler(None))]),
    }
}
