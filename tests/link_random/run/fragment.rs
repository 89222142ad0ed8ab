//! What a fragment stage is drawn with.

use std::fmt::Write as _;

use lamplight::bundle::{Language, Reflection};
use lamplight::compose::Composed;
use lamplight::diagnostic::Diagnostics;
use lamplight::picture::frame::probe;
use lamplight::validate::{Validated, validate};

use super::{Partner, interpolated, number};
use crate::random::Random;

/// A vertex stage for a fragment stage.
pub fn partner(
    validated: &Validated,
    entry: &str,
    reflection: &Reflection,
    random: &mut Random,
) -> Result<Partner, Diagnostics> {
    let text = feeder(reflection, random);
    let feeder = validate(&Composed::of_text(Language::Wesl, None, text))?;
    let input_stage = probe::inputs_module(&validated.module, entry);
    Ok(Partner { validated: feeder, entry: "feed", input_stage })
}

/// A vertex stage that draws one triangle over the whole frame. Its outputs fit the inputs of a
/// fragment stage, and differ from pixel to pixel.
fn feeder(reflection: &Reflection, random: &mut Random) -> String {
    let (mut members, mut values) = (String::new(), String::new());
    for (index, input) in reflection.inputs.iter().enumerate() {
        let Some(location) = input.location else { continue };
        let attribute = interpolated(input);
        let _ = writeln!(members, "@location({location}) {attribute} fed_{index}: {},", input.ty);
        let count = match input.ty.as_bytes() {
            [b'v', b'e', b'c', size, ..] => usize::from(size - b'0'),
            _ => 1,
        };
        let mut one = || match input.ty.contains("f32") {
            true => format!("{:?} + corner.x * {:?}", number(random), number(random)),
            false => format!("{}", random.below(9)),
        };
        let parts: Vec<String> = (0..count).map(|_| one()).collect();
        let _ = write!(values, ", {}({})", input.ty, parts.join(", "));
    }
    format!(
        "struct Fed {{ @builtin(position) position: vec4f,\n{members}}}\n\
         @vertex fn feed(@builtin(vertex_index) index: u32) -> Fed {{\n\
         let corner = vec2f(vec2u((index << 1u) & 2u, index & 2u));\n\
         return Fed(vec4f(corner * 2.0 - 1.0, 0.0, 1.0){values});\n}}\n"
    )
}
