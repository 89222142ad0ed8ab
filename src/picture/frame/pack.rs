//! Fills uniform buffers by reflection.

use crate::bundle::{Binding, Member};
use crate::diagnostic::{Diagnostic, codes};

/// Gives the numbers of a field by its path, such as `lamps.lights[2].color`. A matrix is given
/// column by column; an empty list stands for zeros. `None` if nothing knows the field.
pub type Numbers<'n> = dyn Fn(&str) -> Option<Vec<f64>> + 'n;

/// The bytes of a buffer.
///
/// # Errors
/// A field that nothing knows, or for which there are too few numbers.
pub fn pack_buffer(binding: &Binding, numbers: &Numbers<'_>) -> Result<Vec<u8>, Diagnostic> {
    let size = binding.size.unwrap_or(0);
    let mut packer = Packer { bytes: vec![0; size as usize], numbers };
    if binding.members.is_empty() {
        packer.leaf(0, &binding.ty, size, &binding.name)?;
    }
    packer.members(0, &binding.name, &binding.members)?;
    Ok(packer.bytes)
}

struct Packer<'n> {
    bytes: Vec<u8>,
    numbers: &'n Numbers<'n>,
}

impl Packer<'_> {
    fn members(&mut self, base: u32, path: &str, members: &[Member]) -> Result<(), Diagnostic> {
        members.iter().try_for_each(|member| {
            self.member(base + member.offset, &format!("{path}.{}", member.name), member)
        })
    }

    fn member(&mut self, at: u32, path: &str, member: &Member) -> Result<(), Diagnostic> {
        let is_array = |stride: &u32| *stride > 0 && member.ty.starts_with("array");
        let Some(stride) = member.stride.filter(is_array) else {
            if member.members.is_empty() {
                return self.leaf(at, &member.ty, member.size, path);
            }
            return self.members(at, path, &member.members);
        };
        for index in 0..member.size / stride {
            let (at, path) = (at + index * stride, format!("{path}[{index}]"));
            if member.members.is_empty() {
                self.leaf(at, member.ty.trim_start_matches("array<"), stride, &path)?;
            } else {
                self.members(at, &path, &member.members)?;
            }
        }
        Ok(())
    }

    fn leaf(&mut self, at: u32, ty: &str, size: u32, path: &str) -> Result<(), Diagnostic> {
        let values = (self.numbers)(path).ok_or_else(|| without_number(path, ty))?;
        let offsets: Vec<u32> = scalar_offsets(ty, size).collect();
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
            if let Some(place) = self.bytes.get_mut(from..from + 4) {
                place.copy_from_slice(&word_bytes(ty, value));
            }
        }
        Ok(())
    }
}

fn without_number(path: &str, ty: &str) -> Diagnostic {
    let message = format!("nothing has a number for the uniform `{path}: {ty}`");
    Diagnostic::error(codes::PICTURE_INVALID, message).note(
        "help: give it one under `[uniforms]` of `shaderlib/pictures.toml`, or compute it from the \
         scene in `src/picture/values.rs`",
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
