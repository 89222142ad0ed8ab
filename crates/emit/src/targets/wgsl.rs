//! WGSL, for WebGPU: one self-contained entry point, as naga writes it.
//!
//! Group and binding are the author's; overrides stay overrides.

use naga::valid::Capabilities;
use naga::back::wgsl::{Writer, WriterFlags};

use crate::nesting::nesting_lack;
use crate::slots::{Numbering, native_reflection};
use crate::text::BoundedText;
use crate::plain::{self, Needs};
use crate::results;
use crate::{
    EmitSource, Emitted, Overrides, TargetEntry, ValidatorRules, clip, extensions, filters, lets, sized,
    specialise, unused,
};
use lamplight_bundle::{OverrideChoice, Target};

/// The target, for the table of all.
pub const TARGET: TargetEntry = TargetEntry {
    target: Target::WGSL,
    extension: "wgsl",
    binary: false,
    about: "WGSL (WebGPU)",
    glsl: None,
    capabilities: Capabilities::SHADER_FLOAT16
        .union(Capabilities::CLIP_DISTANCES)
        .union(Capabilities::DUAL_SOURCE_BLENDING)
        .union(Capabilities::PRIMITIVE_INDEX)
        .union(Capabilities::SUBGROUP)
        .union(Capabilities::TEXTURE_EXTERNAL)
        .union(Capabilities::STORAGE_TEXTURE_16BIT_NORM_FORMATS),
    header: &["enable ", "requires ", "diagnostic("],
    overrides: Overrides::Kept,
    immediates: true,
    validation: ValidatorRules { validator: "naga_tint", rules: &[] },
    clip: &clip::SHARED,
    write,
};

fn write(source: &EmitSource<'_>) -> Result<Emitted, String> {
    if let Some(reason) = nesting_lack(source.module) {
        return Err(reason);
    }
    let with_variables = lets::with_variables(source.module, source.info)?;
    let source = &source.with_analysed(with_variables.as_ref());
    let named = results::with_named_results(source.module, source.info)?;
    let source = &source.with_analysed(named.as_ref());
    // WGSL counts these modulo the bits. wgpu, which may read the text, does not.
    let needs = Needs { masked_shifts: true, ..Needs::default() };
    let plain = plain::with_plain_forms(source.module, source.info, needs)?;
    let source = &source.with_analysed(plain.as_ref());
    let written = specialise::written_module(source.module)?;
    let module = written.as_ref().unwrap_or(source.module);
    let mut text = BoundedText::default();
    let done = Writer::new(&mut text, WriterFlags::empty()).write(module, source.info);
    done.map_err(|error| text.explain(error))?;
    let text = with_largest_numbers(text.0);
    let names: Vec<String> = declared_names(&text, "override", None).map(str::to_owned).collect();
    let text = match written {
        Some(_) => specialise::with_expressions(&text, source.module, &names)?,
        None => text,
    };
    let text = sized::with_sizes(text, module)?;
    let text = filters::with_filters(&text, source.module)?;
    let text = unused::without_unused_bindings(text, source);
    let text = extensions::with_extensions(text, source.module);
    // naga does not return the names that it wrote, and it appends an underscore to names that end
    // with a digit.
    let entry =
        declared_names(&text, "fn", Some("@")).next().ok_or("no entry point was written")?;
    let mut native = native_reflection(source, entry, Numbering::Author);
    let overrides = source.module.overrides.iter().map(|(_, constant)| constant);
    native.choices =
        overrides.zip(names.iter().map(String::as_str)).filter_map(override_choice).collect();
    Ok(Emitted { bytes: text.into_bytes(), native })
}

/// The text with the largest number in hexadecimal. naga writes it with all its digits, which are
/// those of a number that is a little larger, and browsers refuse that.
fn with_largest_numbers(text: String) -> String {
    const DECIMAL: &str = "340282350000000000000000000000000000000f";
    let mut parts = text.split(DECIMAL);
    let mut changed = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        // A name can end with these digits.
        let is_name = changed.ends_with(|last: char| last == '_' || last.is_alphanumeric());
        changed += if is_name { DECIMAL } else { "0x1.fffffep+127f" };
        changed += part;
    }
    changed
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
