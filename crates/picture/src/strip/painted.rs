//! Draws pictures with functions of the library alone: a colour for each place.

use std::collections::BTreeMap;
use std::sync::Mutex;

use glam::DVec3;

use crate::Shot;
use crate::pixels::Linear;
use crate::prepared::sample_shift;
use lamplight_bundle::Language;
use lamplight_check::library::Library;
use lamplight_diagnostic::source::{Embedded, SourceSet};
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_execute::{Session, kernel};

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
