//! Draws comparisons: one thing drawn in several ways, side by side, with a part enlarged.
//!
//! `comparisons.toml -> panels -> one picture`
//!
//! `comparisons.toml` of the library explains its own format. A panel may be a picture of a program,
//! or a colour for each place, computed by functions of the library alone.

use crate::Shot;
use crate::frame::Programs;
use crate::passes::prepare_passes;
use crate::pixels::{Linear, Picture};
use crate::plan::Plan;
use crate::prepared::sample_shift;
use embedded_graphics::Pixel;
use embedded_graphics::mono_font::MonoTextStyle;
use embedded_graphics::mono_font::iso_8859_1::FONT_10X20;
use embedded_graphics::pixelcolor::Rgb888;
use embedded_graphics::prelude::{Dimensions, DrawTarget, Drawable, Point, RgbColor, Size};
use embedded_graphics::primitives::Rectangle;
use embedded_graphics::text::{Baseline, Text};
use glam::DVec3;
use lamplight_bundle::Language;
use lamplight_catalogue::preset::{PresetNumber, SAFE};
use lamplight_catalogue::reader;
use lamplight_check::library::Library;
use lamplight_diagnostic::source::{Embedded, SourceSet, Span};
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_execute::{Session, kernel};
use lamplight_scenes::sets;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::convert::Infallible;
use std::sync::Mutex;
use toml::Spanned;

/// A panel is drawn this many times larger than it is shown. Its inset is shown at the size at
/// which it was drawn.
pub const ZOOM: u32 = 3;
/// Panels in a row. More would be too narrow on a page to read their labels.
const ACROSS: u32 = 4;
/// Pixels between panels, and the height of a label.
pub(crate) const GAP: u32 = 6;
pub(crate) const LABEL: u32 = 28;
/// Pixels to the left and right of a label's words.
pub(crate) const MARGIN: u32 = 6;
/// The colour of the background.
pub(crate) const GROUND: [u8; 3] = [24, 26, 30];
/// The colour of the frame around the part that is enlarged.
const FRAME: [u8; 3] = [255, 208, 64];

/// Draws one panel at its large size.
///
/// # Errors
/// Those of compositions and of the painter.
pub fn draw_panel(
    painter: &mut dyn Session,
    programs: &Programs,
    comparison: &Comparison,
    panel: &Panel,
    shot: &Shot,
) -> Result<Picture, Diagnostics> {
    if let Some(value) = &panel.value {
        return Ok(
            paint_expression(programs.library(), painter, &comparison.code, value, shot)?.develop()
        );
    }
    let plan = panel_plan(programs, comparison, panel)?;
    let shot = Shot { cascades: panel.cascades, ..shot.clone() };
    Ok(prepare_passes(painter, programs, &plan, &shot)?.photograph(painter, &shot)?.develop())
}

/// The passes and numbers of a panel that is drawn with a permutation.
///
/// # Errors
/// A key that the program does not have.
pub fn panel_plan(
    programs: &Programs,
    comparison: &Comparison,
    panel: &Panel,
) -> Result<Plan, Diagnostics> {
    let plan = Plan::of_key(programs, &panel.program, &panel.key)?;
    Ok(Plan { scene: comparison.scene.clone(), numbers: panel.numbers.clone(), ..plan })
}

/// All panels in rows, each with its label above and a part of it enlarged below.
///
/// # Errors
/// Those of its panels.
pub fn draw_strip(
    painter: &mut dyn Session,
    programs: &Programs,
    comparison: &Comparison,
    shot: &Shot,
) -> Result<Picture, Diagnostics> {
    let panels = comparison.panels.iter();
    let large: Vec<Picture> = panels
        .map(|one| draw_panel(painter, programs, comparison, one, shot))
        .collect::<Result<_, _>>()?;
    let [width, height] = shot.size.map(|side| side / ZOOM);
    let count = large.len() as u32;
    // As many rows as are needed, and the panels spread evenly over them.
    let rows = count.div_ceil(ACROSS).max(1);
    let across = count.div_ceil(rows);
    let tall = LABEL + 2 * height + GAP;
    let extent = |count: u32, side: u32| count * side + count.saturating_sub(1) * GAP;
    let mut strip = Picture::filled(extent(across, width), extent(rows, tall), GROUND);
    let inset = [0, 1].map(|axis| {
        let free = shot.size[axis] - shot.size[axis] / ZOOM;
        ((comparison.inset[axis] * f64::from(shot.size[axis])) as u32).min(free)
    });
    for (index, (picture, panel)) in (0..).zip(large.iter().zip(&comparison.panels)) {
        let (left, top) = (index % across * (width + GAP), index / across * (tall + GAP));
        let mut small = picture.shrunk(ZOOM);
        small.outline(inset.map(|at| at / ZOOM), [width / ZOOM, height / ZOOM], FRAME);
        write_label(
            &mut strip,
            &panel.label,
            [left + MARGIN, top + 4],
            width.saturating_sub(2 * MARGIN),
        );
        strip.place(&small, [left, top + LABEL]);
        strip.place(&picture.part(inset, [width, height]), [left, top + LABEL + height + GAP]);
    }
    Ok(strip)
}

/// Path below the library.
const PATH: &str = "comparisons.toml";

/// One thing, drawn in several ways.
#[derive(Debug, Clone, Serialize)]
pub struct Comparison {
    pub name: String,
    pub doc: String,
    /// What to look for in the picture.
    pub look: String,
    /// The scene that panels with a key draw.
    pub scene: String,
    /// WGSL that stands before the values of panels without a key.
    pub code: String,
    /// The upper left corner of the part that is enlarged, as shares of a panel.
    pub inset: [f64; 2],
    /// The smallest share of pixels that must differ visibly between neighbouring panels.
    pub differs: f64,
    pub panels: Vec<Panel>,
}

/// One way to draw it: a panel of the picture.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Panel {
    pub label: String,
    /// The program of the key.
    #[serde(default = "default_program", skip_serializing_if = "is_default_program")]
    pub program: String,
    /// Its permutation.
    #[serde(default)]
    pub key: String,
    #[serde(default = "default_one")]
    pub cascades: u32,
    /// Numbers that replace those of the scene, by group and field, as in a preset.
    #[serde(default)]
    pub numbers: BTreeMap<String, BTreeMap<String, PresetNumber>>,
    /// Instead of a key, a WGSL expression for the colour at `at`, which goes from (-4/3, -1) to
    /// (4/3, 1).
    pub value: Option<String>,
}

fn default_program() -> String {
    SAFE.to_owned()
}

fn is_default_program(program: &str) -> bool {
    program == SAFE
}

fn default_one() -> u32 {
    1
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename = "Entry")]
struct ComparisonEntry {
    doc: String,
    look: String,
    #[serde(default)]
    scene: Option<Spanned<String>>,
    #[serde(default)]
    code: String,
    inset: [f64; 2],
    differs: f64,
    panels: Vec<Panel>,
}

/// The library's comparisons, by name.
///
/// # Errors
/// Those of the file.
pub fn library_comparisons(
    library: Embedded,
    sources: &mut SourceSet,
) -> Result<Vec<Comparison>, Diagnostics> {
    let id = reader::add_own(library, sources, PATH)?;
    let entries: BTreeMap<String, ComparisonEntry> = reader::read_data(sources, id)?;
    let mut problems = Vec::new();
    let comparison = |(name, entry): (String, ComparisonEntry)| {
        if let Some(scene) = &entry.scene
            && !sets::ALL.iter().any(|set| set.name == scene.get_ref())
        {
            let message = format!("there is no scene `{}`", scene.get_ref());
            problems.push(reader::invalid_data(Span::new(id, scene.span()), message));
        }
        let ComparisonEntry { doc, look, scene, code, inset, differs, panels } = entry;
        let scene = scene.map_or_else(String::new, Spanned::into_inner);
        Comparison { name, doc, look, scene, code, inset, differs, panels }
    };
    let comparisons = entries.into_iter().map(comparison).collect();
    if problems.is_empty() { Ok(comparisons) } else { Err(problems) }
}

/// Name of the function around an expression.
const FUNCTION: &str = "lamplight_picture";
/// How many places are computed at once.
const AT_ONCE: usize = 1 << 16;

/// Draws an expression over `at: vec2f`. Its y goes upwards from -1 to 1, and its x from minus to
/// plus the aspect ratio. `code` has the imports and functions that it needs.
///
/// # Errors
/// Those of the expression and of the executor.
pub fn paint_expression(
    files: Embedded,
    painter: &mut dyn Session,
    code: &str,
    value: &str,
    shot: &Shot,
) -> Result<Linear, Diagnostics> {
    let text = format!(
        "{code}\n\nfn {FUNCTION}(x: f32, y: f32) -> vec3f {{\n    let at = vec2f(x, y);\n    return {value};\n}}\n"
    );
    let sources = Mutex::new(SourceSet::default());
    let library = Library::shipped(files);
    let module =
        library.importing(&sources, ("picture.wesl", &text), Language::Wesl, FUNCTION)?.module;
    let kernel =
        kernel::build_kernel(&module, FUNCTION, &BTreeMap::new()).map_err(|error| vec![error])?;
    if kernel.input_words() != 2 || kernel.result_words() != 3 {
        let message = format!("`{value}` is not a colour at a place");
        return Err(vec![Diagnostic::error(codes::UNTESTABLE_FUNCTION, message)]);
    }
    let mut picture = Linear::new(shot.size);
    for index in 0..shot.samples.max(1) {
        let places = pixel_centres(shot.size, sample_shift(index, shot.samples));
        let mut colors = Vec::with_capacity(places.len() / 2);
        for some in places.chunks(2 * AT_ONCE) {
            let words = painter.run(&kernel, some).map_err(|error| vec![error])?;
            colors.extend(words.chunks_exact(3).map(color_of_words));
        }
        picture.add_all(colors.into_iter(), shot.exposure);
    }
    Ok(picture)
}

fn color_of_words(words: &[u32]) -> DVec3 {
    let number = |index: usize| f64::from(f32::from_bits(words[index]));
    DVec3::new(number(0), number(1), number(2))
}

/// The centre of every pixel, moved by a part of a pixel, as words.
fn pixel_centres([width, height]: [u32; 2], shift: [f64; 2]) -> Vec<u32> {
    let place = |x: u32, y: u32| {
        place_words([f64::from(x) + 0.5 + shift[0], f64::from(y) + 0.5 + shift[1]], [width, height])
    };
    (0..height).flat_map(|y| (0..width).flat_map(move |x| place(x, y))).collect()
}

/// A place in pixels as words of the two coordinates that an expression has.
pub fn place_words([x, y]: [f64; 2], size: [u32; 2]) -> [u32; 2] {
    let [width, height] = size.map(f64::from);
    let (across, up) = ((2.0 * x - width) / height, 1.0 - 2.0 * y / height);
    [(across as f32).to_bits(), (up as f32).to_bits()]
}

const INK: Rgb888 = Rgb888::new(232, 234, 238);

/// Writes one line from a place to the right, as far as the width allows.
pub(crate) fn write_label(picture: &mut Picture, text: &str, [left, top]: [u32; 2], width: u32) {
    let mut page = LabelCanvas { picture, right: left + width };
    let style = MonoTextStyle::new(&FONT_10X20, INK);
    let place = Point::new(left as i32, top as i32);
    // Writing pixels in memory cannot fail.
    let Ok(_) = Text::with_baseline(text, place, style, Baseline::Top).draw(&mut page);
}

/// A picture to write on.
struct LabelCanvas<'p> {
    picture: &'p mut Picture,
    right: u32,
}

impl Dimensions for LabelCanvas<'_> {
    fn bounding_box(&self) -> Rectangle {
        Rectangle::new(Point::zero(), Size::new(self.right, self.picture.height))
    }
}

impl DrawTarget for LabelCanvas<'_> {
    type Color = Rgb888;
    type Error = Infallible;

    fn draw_iter<I>(&mut self, pixels: I) -> Result<(), Infallible>
    where
        I: IntoIterator<Item = Pixel<Rgb888>>,
    {
        for Pixel(Point { x, y }, color) in pixels {
            if let (Ok(x), Ok(y)) = (u32::try_from(x), u32::try_from(y))
                && x < self.right
            {
                self.picture.set([x, y], [color.r(), color.g(), color.b()]);
            }
        }
        Ok(())
    }
}
