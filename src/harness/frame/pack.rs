//! Uniform buffers, laid out as reflection says.

use crate::bundle::{Binding, Member};

/// The bytes of a buffer. `value` gives the numbers of a leaf by its path, such as
/// `lamps.lights[2].color`; matrices column by column. Missing numbers are 0.
pub fn pack(binding: &Binding, value: &dyn Fn(&str) -> Vec<f64>) -> Vec<u8> {
    let size = binding.size.unwrap_or(0);
    let mut bytes = vec![0; size as usize];
    if binding.members.is_empty() {
        leaf(&mut bytes, 0, &binding.ty, size, &value(&binding.name));
    }
    members(&mut bytes, 0, &binding.name, &binding.members, value);
    bytes
}

fn members(bytes: &mut [u8], base: u32, path: &str, members: &[Member], value: &dyn Fn(&str) -> Vec<f64>) {
    members.iter().for_each(|member| self::member(bytes, base + member.offset, &format!("{path}.{}", member.name), member, value));
}

fn member(bytes: &mut [u8], at: u32, path: &str, member: &Member, value: &dyn Fn(&str) -> Vec<f64>) {
    let Some(stride) = member.stride.filter(|stride| *stride > 0 && member.ty.starts_with("array")) else {
        if member.members.is_empty() {
            return leaf(bytes, at, &member.ty, member.size, &value(path));
        }
        return members(bytes, at, path, &member.members, value);
    };
    for index in 0..member.size / stride {
        let (at, path) = (at + index * stride, format!("{path}[{index}]"));
        if member.members.is_empty() {
            leaf(bytes, at, member.ty.trim_start_matches("array<"), stride, &value(&path));
        } else {
            members(bytes, at, &path, &member.members, value);
        }
    }
}

/// Scalars of one value: `rows` of them, then the next column.
fn leaf(bytes: &mut [u8], at: u32, ty: &str, size: u32, values: &[f64]) {
    let digit = |index: usize| ty.as_bytes().get(index).map_or(1, |digit| u32::from(digit.saturating_sub(b'0')));
    let (rows, step) = match ty {
        _ if ty.starts_with("mat") => (digit(5), if digit(5) == 2 { 8 } else { 16 }),
        _ if ty.starts_with("vec") => (digit(3), 16),
        _ => (1, 4),
    };
    let offsets = (0..size / 4).map(|index| index * 4).filter(|offset| offset % step < 4 * rows);
    for (offset, value) in offsets.zip(values) {
        let from = (at + offset) as usize;
        if let Some(place) = bytes.get_mut(from..from + 4) {
            place.copy_from_slice(&word(ty, *value));
        }
    }
}

fn word(ty: &str, value: f64) -> [u8; 4] {
    match ty {
        _ if ty.contains("i32") || ty.ends_with('i') => (value as i32).to_le_bytes(),
        _ if ty.contains("u32") || ty.ends_with('u') => (value as u32).to_le_bytes(),
        _ => (value as f32).to_le_bytes(),
    }
}
