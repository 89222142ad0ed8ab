//! WGSL, for WebGPU: one self-contained entry point, as naga writes it.
//!
//! Group and binding are the author's; overrides stay overrides.

use naga::back::wgsl::{Writer, WriterFlags};

use lamplight_bundle::{OverrideChoice, Target};
use crate::slots::{Numbering, native_reflection};
use crate::text::BoundedText;
use crate::{EmitSource, Emitted, JudgeRules, Overrides, TargetEntry, clip};

/// The target, for the table of all.
pub const TARGET: TargetEntry = TargetEntry {
    target: Target::WGSL,
    extension: "wgsl",
    binary: false,
    about: "WGSL (WebGPU)",
    glsl: None,
    header: &["enable ", "requires "],
    overrides: Overrides::Kept,
    judged: JudgeRules { judge: "naga_tint", rules: &[] },
    clip: &clip::SHARED,
    write,
};

fn write(source: &EmitSource<'_>) -> Result<Emitted, String> {
    let mut text = BoundedText::default();
    let written = Writer::new(&mut text, WriterFlags::empty()).write(source.module, source.info);
    written.map_err(|error| text.explain(error))?;
    let text = text.0;
    // naga does not tell the names that it wrote, and it appends an underscore to names that end
    // with a digit.
    let entry =
        declared_names(&text, "fn", Some("@")).next().ok_or("no entry point was written")?;
    let mut native = native_reflection(source, entry, Numbering::Author);
    let overrides = source.module.overrides.iter().map(|(_, constant)| constant);
    native.choices = overrides
        .zip(declared_names(&text, "override", None))
        .filter_map(override_choice)
        .collect();
    Ok(Emitted { bytes: text.into_bytes(), native })
}

fn override_choice((constant, written): (&naga::Override, &str)) -> Option<OverrideChoice> {
    let name = constant.name.clone()?;
    let symbol = (name != written).then(|| written.to_owned());
    Some(OverrideChoice { name, id: constant.id.map(u32::from), symbol })
}

/// The names of declarations that begin with `word`, in the order of the text. With `after`, only
/// those that follow a line which begins with `after`.
fn declared_names<'t>(
    text: &'t str,
    word: &'static str,
    after: Option<&'static str>,
) -> impl Iterator<Item = &'t str> {
    let before = std::iter::once("").chain(text.lines());
    let lines = before
        .zip(text.lines())
        .filter(move |(before, _)| after.is_none_or(|after| before.starts_with(after)));
    lines.filter_map(move |(_, line)| {
        // `@id(...)` may stand before an override.
        let line = line
            .strip_prefix("@id(")
            .and_then(|line| line.split_once(") "))
            .map_or(line, |(_, line)| line);
        let rest = line.strip_prefix(word)?.strip_prefix(' ')?;
        rest.split(['(', ':', ' ']).next()
    })
}
