//! Fills uniform buffers by reflection.

use lamplight_bundle::{Binding, Member};
use lamplight_diagnostic::{Diagnostic, codes};

/// Gives the numbers of a field by its path, such as `lamps.lights[2].color`. A matrix is given
/// column by column; an empty list stands for zeros. `None` if nothing knows the field.
pub type FieldNumbers<'n> = dyn Fn(&str) -> Option<Vec<f64>> + 'n;

/// A scalar, a vector or a matrix in a buffer.
pub struct BufferLeaf<'b> {
    /// As in [`FieldNumbers`].
    pub path: String,
    /// Type in WGSL.
    pub ty: &'b str,
    at: u32,
    size: u32,
}

/// The bytes of a buffer.
///
/// # Errors
/// A field that nothing knows, or for which there are too few numbers.
pub fn pack_buffer(binding: &Binding, numbers: &FieldNumbers<'_>) -> Result<Vec<u8>, Diagnostic> {
    let mut bytes = vec![0; binding.size.unwrap_or(0) as usize];
    buffer_leaves(binding).iter().try_for_each(|leaf| pack_leaf(&mut bytes, leaf, numbers))?;
    Ok(bytes)
}

/// Everything in a buffer that has numbers, in the order of the buffer.
pub fn buffer_leaves(binding: &Binding) -> Vec<BufferLeaf<'_>> {
    let mut leaves = Vec::new();
    if binding.members.is_empty() {
        let size = binding.size.unwrap_or(0);
        leaves.push(BufferLeaf { path: binding.name.clone(), ty: &binding.ty, at: 0, size });
    }
    members(&mut leaves, 0, &binding.name, &binding.members);
    leaves
}

fn members<'b>(leaves: &mut Vec<BufferLeaf<'b>>, base: u32, path: &str, members: &'b [Member]) {
    for one in members {
        member(leaves, base + one.offset, format!("{path}.{}", one.name), one);
    }
}

fn member<'b>(leaves: &mut Vec<BufferLeaf<'b>>, at: u32, path: String, member: &'b Member) {
    let is_array = |stride: &u32| *stride > 0 && member.ty.starts_with("array");
    let Some(stride) = member.stride.filter(is_array) else {
        if member.members.is_empty() {
            return leaves.push(BufferLeaf { path, ty: &member.ty, at, size: member.size });
        }
        return members(leaves, at, &path, &member.members);
    };
    for index in 0..member.size / stride {
        let (at, path) = (at + index * stride, format!("{path}[{index}]"));
        if member.members.is_empty() {
            let ty = member.ty.trim_start_matches("array<").split(',').next().unwrap_or_default();
            leaves.push(BufferLeaf { path, ty, at, size: stride });
        } else {
            members(leaves, at, &path, &member.members);
        }
    }
}

fn pack_leaf(
    bytes: &mut [u8],
    leaf: &BufferLeaf<'_>,
    numbers: &FieldNumbers<'_>,
) -> Result<(), Diagnostic> {
    let BufferLeaf { path, ty, at, size } = leaf;
    let values = numbers(path).ok_or_else(|| without_number(path, ty))?;
    let offsets: Vec<u32> = scalar_offsets(ty, *size).collect();
    if !values.is_empty() && values.len() < offsets.len() {
        let message = format!(
            "the uniform `{path}: {ty}` was given {} of {} numbers",
            values.len(),
            offsets.len()
        );
        return Err(Diagnostic::error(codes::PICTURE_INVALID, message));
    }
    for (offset, value) in offsets.into_iter().zip(values) {
        let from = (at + offset) as usize;
        if let Some(place) = bytes.get_mut(from..from + 4) {
            place.copy_from_slice(&word_bytes(ty, value));
        }
    }
    Ok(())
}

fn without_number(path: &str, ty: &str) -> Diagnostic {
    let message = format!("nothing has a number for the uniform `{path}: {ty}`");
    Diagnostic::error(codes::PICTURE_INVALID, message).note(
        "help: give it one under `[uniforms]` of `shaderlib/pictures.toml`, or compute it from the \
         scene in `crates/picture/src/values.rs`",
    )
}

/// The offsets of a value's scalars, column by column, each of `rows` scalars.
fn scalar_offsets(ty: &str, size: u32) -> impl Iterator<Item = u32> {
    let digit = |index: usize| {
        ty.as_bytes().get(index).map_or(1, |digit| u32::from(digit.saturating_sub(b'0')))
    };
    let (rows, step) = match ty {
        _ if ty.starts_with("mat") => (digit(5), if digit(5) == 2 { 8 } else { 16 }),
        _ if ty.starts_with("vec") => (digit(3), 16),
        _ => (1, size.max(4)),
    };
    (0..size / 4).map(|index| index * 4).filter(move |offset| offset % step < 4 * rows)
}

fn word_bytes(ty: &str, value: f64) -> [u8; 4] {
    match ty {
        _ if ty.contains("i32") || ty.ends_with('i') => (value as i32).to_le_bytes(),
        _ if ty.contains("u32") || ty.ends_with('u') => (value as u32).to_le_bytes(),
        _ => (value as f32).to_le_bytes(),
    }
}
