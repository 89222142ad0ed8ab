//! Reads GLSL by what glslang makes of its declarations: SPIR-V, in which each block has offsets and
//! strides, and each constant of the host its binding.
//!
//! Only declarations are compiled. A version that Vulkan does not know is replaced by the next one.

use lamplight_bundle::{Binding, BindingSlot, Combined, Reflection, Stage};

use super::compare::{Differences, SlotRules, compare_binding, compare_reading};
use super::described::Described;
use super::reading::{ReadBinding, Reading};
use super::spirv::read_spirv;
use super::text::{has_function, read_statements, with_statements};

/// What differs between a text and what a bundle says of it, as far as the text alone shows it.
pub fn text_differences(text: &str, described: Described<'_>) -> Vec<String> {
    let mut found = Differences::default();
    let statements = read_statements(text);
    let entry = &described.native.entry_name;
    if !has_function(&statements, entry) {
        found.note(format!(
            "the entry point is {entry:?} in the reflection, which the output lacks"
        ));
    }
    let first_instance = described.native.first_instance.as_deref();
    let declared = statements.iter().find_map(|one| match one.head.as_slice() {
        ["uniform", "uint", name] => Some(*name),
        _ => None,
    });
    found.same("the uniform with the first instance is", &declared, &first_instance);
    found.0
}

/// What decides the layouts and the bindings of a text, so that glslc reads it for Vulkan.
pub fn declarations(text: &str, described: Described<'_>) -> String {
    let first_instance = described.native.first_instance.as_deref();
    let mut text = with_statements(text, |statement| {
        let is_block = statement.block_name(&["struct", "uniform", "buffer"]).is_some();
        let is_sampler = statement.head.contains(&"uniform");
        // Vulkan has no uniforms outside of blocks.
        let is_number = statement.head.last().copied() == first_instance;
        // `layout(local_size_x = 8) in;`
        let is_size = statement.head.last() == Some(&"in");
        let is_precision = statement.head.first() == Some(&"precision");
        is_block || is_sampler && !is_number || is_size || is_precision
    });
    text = text.replacen("#version 300 es", "#version 310 es", 1);
    text + "\nvoid main() {}\n"
}

/// What differs between the SPIR-V of a text's declarations and what a bundle says of the text.
pub fn compiled_differences(bytes: &[u8], described: Described<'_>) -> Result<Vec<String>, String> {
    let mut reading = read_spirv(bytes)?;
    let combined = take_textures(&mut reading);
    let mut found = Differences::default();
    compare_combined(&mut found, &combined, described);
    // The text shows it.
    reading.entry = None;
    // Only the size of a workgroup shows the stage: a text is of the one that it is compiled for.
    reading.stage = reading.workgroup_size.map(|_| Stage::Compute);
    let is_at = |_: &Binding, slot: &BindingSlot, found: &ReadBinding| slot.name == found.name;
    let reflection = &Reflection {
        bindings: described
            .reflection
            .bindings
            .iter()
            .filter(|one| is_block(one))
            .cloned()
            .collect(),
        ..described.reflection.clone()
    };
    compare_numbers(&mut found, &reading, described);
    let described = Described { reflection, native: described.native };
    found.0.extend(compare_reading(&reading, described, &SlotRules { is_at, leaves_out: false }));
    Ok(found.0)
}

fn is_block(binding: &Binding) -> bool {
    binding.kind.is_buffer()
}

/// Takes the textures out of a reading.
fn take_textures(reading: &mut Reading) -> Vec<ReadBinding> {
    let bindings = std::mem::take(&mut reading.bindings);
    let (blocks, textures) = bindings.into_iter().partition(|one| one.ty.is_some());
    reading.bindings = blocks;
    textures
}

/// Compares the names of combined samplers, and their units where the language has them.
fn compare_combined(found: &mut Differences, read: &[ReadBinding], described: Described<'_>) {
    let mut names: Vec<&str> = read.iter().filter_map(|one| one.name.as_deref()).collect();
    names.sort_unstable();
    let mut reflected: Vec<&str> =
        described.native.combined.iter().map(|one| one.name.as_str()).collect();
    reflected.sort_unstable();
    found.same("the textures are", &names, &reflected);
    for Combined { texture, sampler: _, name } in &described.native.combined {
        let Some(read) = read.iter().find(|one| one.name.as_deref() == Some(name)) else {
            continue;
        };
        let is_it = |one: &&Binding| [one.group, one.binding] == *texture;
        let Some(binding) = described.reflection.bindings.iter().find(is_it) else {
            found.note(format!("the texture `{name}` is no binding of the reflection"));
            continue;
        };
        compare_binding(found, read, binding);
        let unit = described.slot(binding).and_then(|slot| slot.index);
        if unit.is_some() {
            found.same(&format!("the unit of `{name}` is"), &read.index, &unit);
        }
    }
}

/// Compares the numbers of blocks. glslc gives others where the language has none.
fn compare_numbers(found: &mut Differences, reading: &Reading, described: Described<'_>) {
    for read in &reading.bindings {
        let slot = described.native.slots.iter().find(|slot| slot.name == read.name);
        let number = slot.and_then(|slot| slot.index);
        if number.is_some() {
            let what = format!("the number of `{}` is", read.name.as_deref().unwrap_or_default());
            found.same(&what, &read.index, &number);
        }
    }
}
