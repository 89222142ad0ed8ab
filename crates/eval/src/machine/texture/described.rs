//! Which texels an access read, for a person.

use super::{
    Footprint, Gradient, asked_level, bound_texture, chosen_sampler, coordinate_of, footprint_of,
    lowest_texel, sizes_of,
};
use crate::code::{Access, TextureOp};
use crate::machine::Env;
use crate::number::Number;
use crate::resources::{Filter, Sampler, Texture};

/// A texel that was read.
#[derive(Debug, Clone, PartialEq)]
pub struct TexelRead {
    /// Its level.
    pub level: u32,
    /// Column, row, and layer, face or slice.
    pub at: [i64; 3],
    /// Its components, before any comparison. Depth is the first one.
    pub texel: [f64; 4],
}

/// What an access read of a texture.
#[derive(Debug, Clone, PartialEq)]
pub struct TextureRead {
    /// The texture's name in the text that naga parsed.
    pub name: String,
    /// As it was given: normalised, a direction, or the numbers of a texel.
    pub coordinate: Vec<f64>,
    /// The level of detail that was asked for.
    pub level: Option<f64>,
    /// What depth is compared with.
    pub reference: Option<f64>,
    /// The texels that the filter weighs. There are none for a query.
    pub texels: Vec<TexelRead>,
}

/// What an access read. `m` is the memory before or after it. `None` if nothing is bound.
pub fn describe<N: Number>(
    env: Env<'_>,
    access: &Access,
    m: &[N],
    gradient: Option<Gradient>,
) -> Option<TextureRead> {
    let global = m.get(access.image as usize)?.word();
    let texture = bound_texture(env, global).ok()?;
    let name = env.program.globals.get(global as usize)?.name.clone();
    let mut read = TextureRead {
        name,
        coordinate: Vec::new(),
        level: None,
        reference: None,
        texels: Vec::new(),
    };
    match access.ask {
        TextureOp::Sample { reference, gather, .. } => {
            let sampler = chosen_sampler(env, access, m).ok()?;
            let level = asked_level(access, texture, m, gradient);
            read.coordinate = coordinates(access, m);
            read.level = gather.is_none().then_some(level);
            read.reference = reference.map(|slot| m[slot as usize].value());
            let footprint = footprint_of(access, texture, &sampler, m);
            for (level, filter) in levels(texture, &sampler, level) {
                let filter = if gather.is_some() { Filter::Linear } else { filter };
                read.texels.extend(texels(&Footprint { level, filter, ..footprint }));
            }
        }
        TextureOp::Load { level } => {
            let word = |slot: u32| i64::from(m[slot as usize].word() as i32);
            let mut at = [0i64; 3];
            let given = (0..usize::from(access.dimensions)).map(|i| access.coordinate + i as u32);
            given.enumerate().for_each(|(i, slot)| at[i] = word(slot));
            access.layer.into_iter().for_each(|layer| at[2] = word(layer));
            read.coordinate =
                at.iter().take(usize::from(access.dimensions)).map(|i| *i as f64).collect();
            let level = level.map_or(0, word);
            read.level = Some(level as f64);
            let found = usize::try_from(level).ok().and_then(|level| texture.levels.get(level));
            let texel = found.and_then(|level| level.texel(at));
            let level = level as u32;
            read.texels.extend(texel.map(|texel| TexelRead { level, at, texel }));
        }
        TextureOp::Size { .. } | TextureOp::Levels | TextureOp::Layers | TextureOp::Samples => {}
    }
    Some(read)
}

fn coordinates<N: Number>(access: &Access, m: &[N]) -> Vec<f64> {
    let layer = access.layer.map(|slot| f64::from(m[slot as usize].word() as i32));
    let all = coordinate_of(access, m).into_iter().take(usize::from(access.dimensions));
    all.chain(layer).collect()
}

/// The levels that a sample reads, each with its filter.
fn levels(texture: &Texture, sampler: &Sampler, level: f64) -> Vec<(usize, Filter)> {
    let last = (texture.levels.len() - 1) as f64;
    let (least, most) = sampler.levels;
    let level = if level.is_nan() { 0.0 } else { level.clamp(least, most.max(least)) };
    let filter = if level <= 0.0 { sampler.mag } else { sampler.min };
    let level = level.clamp(0.0, last);
    if sampler.mipmap == Filter::Nearest || level.fract() == 0.0 {
        return vec![((level + 0.5).floor().min(last) as usize, filter)];
    }
    vec![(level.floor() as usize, filter), (level.floor() as usize + 1, filter)]
}

/// The texels of a level that the filter weighs.
fn texels<N: Number>(footprint: &Footprint<'_, N>) -> Vec<TexelRead> {
    let level = &footprint.texture.levels[footprint.level];
    let size = sizes_of(footprint, level);
    let read = |at: [i64; 3]| TexelRead {
        level: footprint.level as u32,
        at: footprint.addressed(level, at),
        texel: footprint.texel(level, at),
    };
    if footprint.filter == Filter::Nearest {
        return vec![read([0, 1, 2].map(|i| (footprint.point.at[i] * size[i]).floor() as i64))];
    }
    let base = lowest_texel(footprint, level);
    let corners = (0..8usize).map(|corner| [corner & 1, corner >> 1 & 1, corner >> 2]);
    corners
        .filter(|corner| (0..3).all(|i| corner[i] == 0 || size[i] > 0.0))
        .map(|corner| read([0, 1, 2].map(|i| base[i].saturating_add(corner[i] as i64))))
        .collect()
}
