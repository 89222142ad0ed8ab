//! On which executors each listing was compared with its model: `docs/published.md` has a table that is
//! made of the files in `tests/published/compared/`, one for each executor.
//!
//! An executor with frames of its own draws from the composed text. The others draw exactly the bytes
//! of a target. Shadow maps are drawn by the evaluator, so that only the listing's own stages differ.
//! By day each executor draws one listing in both languages; with `UPDATE_EXPECT=1` it draws all, and
//! writes its file.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::PathBuf;

use lamplight::bundle::{Language, Target};
use lamplight::catalogue::preset::Preset;
use lamplight::diagnostic::Diagnostic;
use lamplight::execute::executors::{self, OpenSession};
use lamplight::execute::frame::{Drawing, Frame};
use lamplight::execute::kernel::Kernel;
use lamplight::execute::shipped::Shipped;
use lamplight::execute::{Session, ShippedPair};
use libtest_mimic::Trial;

use super::listings::{AGREEING, Agreement, agreement_of, is_published};
use crate::render::{library, start};
use crate::{is_whole, snapshot};

/// The least share for the listing with random taps on SwiftShader, of those pixels whose taps all
/// sines agree about. It interpolates between corners in sixteenths of a pixel and rounds the weights
/// of its comparisons, and a pixel in the penumbra has sixteen of these.
const RANDOM_ON_SWIFTSHADER: f64 = 0.99;

const LANGUAGES: [Language; 2] = [Language::Wesl, Language::Glsl];

/// An executor that draws all listings, and what it draws of them.
pub struct Column {
    pub executor: &'static str,
    /// The target whose bytes are drawn; none where the composed text is.
    pub target: Option<Target>,
    open: OpenSession,
}

/// The evaluator and the drivers, then whatever draws a target, target by target.
pub fn columns() -> Vec<Column> {
    let own = ["eval", "vulkan", "gl"].into_iter().filter_map(executors::find_executor);
    let own = own.map(|entry| Column { executor: entry.name, target: None, open: entry.open });
    let shipping = Target::ALL.iter().flat_map(|target| {
        executors::shipping(*target).map(|(entry, shipping)| Column {
            executor: entry.name,
            target: Some(*target),
            open: shipping.open,
        })
    });
    own.chain(shipping).collect()
}

impl Column {
    /// The name of its file and of its column.
    pub fn name(&self) -> String {
        match self.target {
            Some(target) if target.name() != self.executor => {
                format!("{}_{}", target.name(), self.executor)
            }
            _ => self.executor.to_owned(),
        }
    }

    fn file(&self) -> PathBuf {
        snapshot::root().join("tests/published/compared").join(format!("{}.txt", self.name()))
    }

    /// The lines of its file, by listing and language: how many pixels agree, and of how many.
    pub fn recorded(&self) -> BTreeMap<(String, String), [usize; 2]> {
        let text = std::fs::read_to_string(self.file()).unwrap_or_default();
        let lines = text.lines().filter_map(|line| {
            let words: Vec<&str> = line.split(' ').collect();
            let [name, language, agreeing, "of", defined] = words[..] else { return None };
            let counts = [agreeing.parse().ok()?, defined.parse().ok()?];
            Some(((name.to_owned(), language.to_owned()), counts))
        });
        lines.collect()
    }
}

pub fn tests() -> Vec<Trial> {
    let trial = |(index, column): (usize, Column)| {
        Trial::test(format!("published::compared/{}", column.name()), move || {
            crate::render::on_device("eval", |maker| compared(maker, index, &column))
        })
    };
    columns().into_iter().enumerate().map(trial).collect()
}

/// Draws listings on an executor, and compares them with their models.
fn compared(maker: &dyn Session, index: usize, column: &Column) -> Result<(), String> {
    let all: Vec<&Preset> = library().presets.iter().filter(|one| is_published(one)).collect();
    let writes = std::env::var_os("UPDATE_EXPECT").is_some();
    let chosen = match writes || is_whole() {
        true => all,
        false => vec![all[7 * index % all.len()]],
    };
    let painter: Box<dyn Session> = match column.target {
        Some(target) => {
            let session = (column.open)().map_err(|missing| missing.reason)?;
            Box::new(Outputs { session, target })
        }
        None => start(column.executor)?,
    };
    let (recorded, mut failures) = (column.recorded(), Vec::new());
    let mut text = String::new();
    for preset in chosen {
        for language in LANGUAGES {
            let name = (preset.name.clone(), language.name().to_owned());
            let found = agreement_of([maker, painter.as_ref()], preset, language);
            let least = least_share(preset, painter.as_ref());
            let checked = found.and_then(|found| found.checked_for(least).map(|()| found));
            match checked {
                Ok(Agreement { compared, agreeing, undefined, share: _ }) => {
                    let defined = compared - undefined;
                    writeln!(text, "{} {} {agreeing} of {defined}", name.0, name.1)
                        .map_err(|error| error.to_string())?;
                    if !writes && !recorded.contains_key(&name) {
                        failures.push(format!("{name:?} is not recorded"));
                    }
                }
                Err(error) => failures.push(format!("{name:?}: {error}")),
            }
        }
    }
    println!("{} on {}:\n{text}", column.name(), painter.adapter());
    if writes {
        let head = format!("# {}\n", painter.adapter());
        std::fs::write(column.file(), head + &text).map_err(|error| error.to_string())?;
    }
    if failures.is_empty() { Ok(()) } else { Err(failures.join("\n")) }
}

fn least_share(preset: &Preset, painter: &dyn Session) -> f64 {
    let is_random = preset.key == "example=hpg_6_random";
    let is_coarse = painter.adapter().to_lowercase().contains("swiftshader");
    if is_random && is_coarse { RANDOM_ON_SWIFTSHADER } else { AGREEING }
}

/// Draws the bytes that a target has for each stage.
struct Outputs {
    session: Box<dyn Session>,
    target: Target,
}

impl Session for Outputs {
    fn adapter(&self) -> String {
        self.session.adapter()
    }

    fn run(&mut self, kernel: &Kernel, inputs: &[u32]) -> Result<Vec<u32>, Diagnostic> {
        self.session.run(kernel, inputs)
    }

    fn draw_frames(&self, drawing: &Drawing<'_>) -> Result<Vec<Frame>, Diagnostic> {
        let fragment = drawing.fragment.ok_or_else(|| {
            let message = "a pass of depths alone is drawn by the evaluator";
            Diagnostic::error(lamplight::diagnostic::codes::EXECUTOR_LACKS, message)
        })?;
        let vertex = Shipped::of(drawing.vertex, self.target)?;
        let fragment = Shipped::of(fragment, self.target)?;
        self.session.draw_shipped(ShippedPair { vertex: &vertex, fragment: &fragment }, drawing)
    }
}

/// The table: for each listing and executor the smaller share of the pixels that agree, of both
/// languages. What was not compared in both is red.
///
/// # Errors
/// What is red.
pub fn table() -> Result<String, String> {
    let columns = columns();
    let names: Vec<String> = columns.iter().map(Column::name).collect();
    let recorded: Vec<_> = columns.iter().map(Column::recorded).collect();
    let mut text = format!("| listing | {} |\n|---|", names.join(" | "));
    text += &"---|".repeat(names.len());
    text.push('\n');
    let mut missing = Vec::new();
    for preset in library().presets.iter().filter(|preset| is_published(preset)) {
        let cells = recorded.iter().zip(&names).map(|(recorded, column)| {
            let of = |language: Language| {
                let key = (preset.name.clone(), language.name().to_owned());
                let [agreeing, defined] = *recorded.get(&key)?;
                Some(100.0 * agreeing as f64 / defined as f64)
            };
            let both = of(Language::Wesl).zip(of(Language::Glsl));
            let share = both.map(|(wesl, glsl)| wesl.min(glsl));
            if share.is_none() {
                missing.push(format!("{} on {column}", preset.name));
            }
            share.map_or("🔴".to_owned(), |share| format!("{share:.1}"))
        });
        let cells: Vec<String> = cells.collect();
        text += &format!("| {} | {} |\n", preset.name, cells.join(" | "));
    }
    if missing.is_empty() || std::env::var_os("UPDATE_EXPECT").is_some() {
        return Ok(text);
    }
    Err(format!(
        "not compared in both languages: {}\ncargo xtask record published::compared published::page",
        missing.join(", ")
    ))
}
