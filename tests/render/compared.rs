//! Comparisons show visible differences: neighbouring panels differ in at least the share of pixels
//! that the comparison's table demands.

use lamplight::bundle::Language;
use lamplight::picture::strip::{self, Comparison};
use libtest_mimic::Trial;

use super::difference::Difference;
use super::{library, on_device, rendered, shot};

/// The size of a panel.
const SIZE: [u32; 2] = [320, 240];
/// A distance in CIELAB that is visible: twice the one that is just noticeable.
const VISIBLE: f64 = 4.0;

pub fn tests() -> Vec<Trial> {
    let comparisons = library()
        .programs
        .with_texts(|texts| strip::library_comparisons(lamplight::LIBRARY_FILES, texts))
        .unwrap();
    let test = |comparison: Comparison| {
        Trial::test(format!("render/compared/{}", comparison.name), move || {
            on_device("vulkan", |_| neighbours_differ(&comparison))
        })
    };
    comparisons.into_iter().map(test).collect()
}

fn neighbours_differ(comparison: &Comparison) -> Result<(), String> {
    let mut painter = super::start("vulkan")?;
    let shot = shot(SIZE, 1, Language::Wesl);
    let draw = |panel| {
        strip::draw_panel(painter.as_mut(), &library().programs, comparison, panel, &shot)
            .map_err(rendered)
    };
    let pictures = comparison.panels.iter().map(draw).collect::<Result<Vec<_>, _>>()?;
    let mut alike = Vec::new();
    for (pair, panels) in pictures.windows(2).zip(comparison.panels.windows(2)) {
        let share = Difference::new(&pair[0], &pair[1])?.share(VISIBLE);
        println!("{} and {}: {:.3}", panels[0].label, panels[1].label, share);
        if share < comparison.differs {
            alike.push(format!("{} and {}: {share:.4}", panels[0].label, panels[1].label));
        }
    }
    if alike.is_empty() {
        return Ok(());
    }
    let what = format!("differ in less than the share {} of the pixels", comparison.differs);
    Err(format!("these neighbours {what}: {}", alike.join(", ")))
}
