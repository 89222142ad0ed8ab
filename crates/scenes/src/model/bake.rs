//! Textures that name another set of coordinates than the first one of their material: they are drawn into
//! its cell triangle by triangle, from where these are in their own set to where they are in the cell.

use glam::DVec2;

use super::GltfReader;
use super::channels::{Coordinates, ImageChannels};
use super::mesh::{mesh_coordinates, triangle_indices};
use super::nodes::PlacedNodes;
use crate::model::channels::material_parts;
use lamplight_files::limits::MODEL_CORNERS;
use std::collections::BTreeSet;

/// The corners of a triangle, each in the first set of its material and in another one.
pub type TwoSets = [[DVec2; 2]; 3];

/// What all textures of a model may take together: corners of triangles with those of primitives that
/// are looked at, and pixels.
pub struct Budget {
    corners: usize,
    pixels: usize,
}

impl Default for Budget {
    fn default() -> Self {
        Self { corners: 4 * MODEL_CORNERS, pixels: 1 << 28 }
    }
}

/// Why a texture cannot be drawn into the first set.
type Reason = &'static str;

/// The triangles of all meshes whose material has these textures, in two sets of coordinates, or why
/// there are none.
///
/// # Errors
/// Numbers that are not there.
pub fn triangles_of(
    reader: &mut GltfReader<'_>,
    placed: &PlacedNodes,
    parts: &[ImageChannels],
    sets: [Coordinates; 2],
    budget: &mut Budget,
) -> Result<Result<Vec<TwoSets>, Reason>, String> {
    const MANY: Reason = "there are too many triangles";
    let mut found = Vec::new();
    let meshes: BTreeSet<usize> = placed.parts.iter().map(|part| part.mesh).collect();
    let document = reader.document;
    for mesh in document.meshes().filter(|mesh| meshes.contains(&mesh.index())) {
        for primitive in mesh.primitives() {
            let Some(left) = budget.corners.checked_sub(1) else { return Ok(Err(MANY)) };
            budget.corners = left;
            if material_parts(reader, &primitive.material())? != parts {
                continue;
            }
            let place = format!("meshes[{}].primitives[{}]", mesh.index(), primitive.index());
            let name = gltf::Semantic::TexCoords(sets[1].set);
            if primitive.get(&name).is_none() {
                let set = sets[1].set;
                let note = format!("{place}: no `TEXCOORD_{set}`, which its textures name");
                reader.notes.insert(note);
            }
            let Some(indices) = triangle_indices(reader, &primitive, &place)? else { continue };
            let left = budget.corners.checked_sub(indices.len());
            let Some(left) = left.filter(|_| 3 * found.len() + indices.len() <= MODEL_CORNERS)
            else {
                return Ok(Err(MANY));
            };
            budget.corners = left;
            let first = mesh_coordinates(reader, &primitive, sets[0], &place)?;
            let other = mesh_coordinates(reader, &primitive, sets[1], &place)?;
            let at =
                |rows: &[DVec2], index: u32| rows.get(index as usize).copied().unwrap_or_default();
            let corner = |index: u32| [at(&first, index), at(&other, index)];
            let triangles = indices.as_chunks::<3>().0.iter();
            found.extend(triangles.map(|three| three.map(corner)));
        }
    }
    Ok(Ok(found))
}

/// The coordinates in the other set at each pixel of a cell; `None` where no triangle is. The corners are in
/// pixels of the cell.
///
/// # Errors
/// Why there is no result: triangles lie on one another, or there are too many.
pub fn unwrapped(
    triangles: &[TwoSets],
    size: [usize; 2],
    budget: &mut Budget,
) -> Result<Vec<Option<DVec2>>, Reason> {
    /// How far a triangle reaches beyond its edges, in pixels, so that filters find no gaps.
    const RIM: f64 = 2.0;
    let [width, height] = size;
    let mut found: Vec<Option<(DVec2, bool)>> = vec![None; width * height];
    let (mut overlaps, mut inner) = (0, 0);
    for triangle in triangles {
        let [a, b, c] = triangle.map(|corner| corner[0]);
        let twice = (b - a).perp_dot(c - a);
        if twice == 0.0 || !twice.is_finite() {
            continue;
        }
        // A share of a corner falls by this much in a pixel.
        let slopes = [(c - b), (a - c), (b - a)].map(|edge| edge.length() / twice.abs());
        for (y, x) in pixels_around([a, b, c], RIM, size) {
            let left = budget.pixels.checked_sub(1);
            budget.pixels = left.ok_or("its triangles have too many pixels in the image")?;
            let shares = shares_at([a, b, c], twice, DVec2::new(x as f64, y as f64));
            let is_near = shares.iter().zip(slopes).all(|(share, slope)| *share >= -RIM * slope);
            if !is_near {
                continue;
            }
            let is_inner = shares.iter().zip(slopes).all(|(share, slope)| *share >= 0.5 * slope);
            let own: DVec2 = triangle.iter().zip(shares).map(|(corner, s)| corner[1] * s).sum();
            let pixel = &mut found[y * width + x];
            inner += usize::from(is_inner);
            match pixel {
                Some((other, true)) if is_inner && other.distance(own) > 1e-3 => overlaps += 1,
                Some((_, true)) => {}
                Some(_) if !is_inner => {}
                _ => *pixel = Some((own, is_inner)),
            }
        }
    }
    if 100 * overlaps > inner {
        return Err("its triangles share places of the first set");
    }
    Ok(found.into_iter().map(|own| own.map(|(own, _)| own)).collect())
}

/// The pixels in and around a triangle, row and column.
fn pixels_around(
    [a, b, c]: [DVec2; 3],
    rim: f64,
    [width, height]: [usize; 2],
) -> impl Iterator<Item = (usize, usize)> {
    let most = DVec2::new(width as f64, height as f64) - 1.0;
    let low = (a.min(b).min(c) - rim).clamp(DVec2::ZERO, most).as_uvec2();
    let high = (a.max(b).max(c) + rim).clamp(DVec2::ZERO, most).as_uvec2();
    let columns = move |y: u32| (low.x..=high.x).map(move |x| (y as usize, x as usize));
    (low.y..=high.y).flat_map(columns)
}

/// The shares of a triangle's corners at a place. `twice` is twice its area.
fn shares_at([a, b, c]: [DVec2; 3], twice: f64, at: DVec2) -> [f64; 3] {
    let first = (b - at).perp_dot(c - at) / twice;
    let second = (c - at).perp_dot(a - at) / twice;
    [first, second, 1.0 - first - second]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of 8 pixels as two triangles, whose other coordinates are turned by a quarter.
    fn square() -> Vec<TwoSets> {
        let corner = |x: f64, y: f64| [DVec2::new(8.0 * x, 8.0 * y), DVec2::new(1.0 - y, x)];
        let [a, b, c, d] = [corner(0.0, 0.0), corner(1.0, 0.0), corner(1.0, 1.0), corner(0.0, 1.0)];
        vec![[a, b, c], [a, c, d]]
    }

    #[test]
    fn pixels_have_the_other_coordinates() {
        let found = unwrapped(&square(), [16, 16], &mut Budget::default()).unwrap();
        let at = |x: usize, y: usize| found[16 * y + x].unwrap();
        assert!(at(2, 6).abs_diff_eq(DVec2::new(0.25, 0.25), 1e-12));
        assert!(at(7, 1).abs_diff_eq(DVec2::new(0.875, 0.875), 1e-12));
        assert_eq!(found[16 * 14 + 14], None);
    }

    #[test]
    fn triangles_on_one_another_are_refused() {
        let mut twice = square();
        twice.push(twice[0].map(|[at, other]| [at, other + 0.5]));
        assert!(unwrapped(&twice, [16, 16], &mut Budget::default()).is_err());
        twice.pop();
        twice.push(twice[0]);
        let same = unwrapped(&twice, [16, 16], &mut Budget::default());
        assert!(same.is_ok(), "the same place twice");
    }

    #[test]
    fn pixels_are_counted_for_all_textures() {
        let mut budget = Budget { pixels: 1000, ..Budget::default() };
        let found: Vec<bool> =
            (0..8).map(|_| unwrapped(&square(), [16, 16], &mut budget).is_ok()).collect();
        assert_eq!((found.first(), found.last()), (Some(&true), Some(&false)), "{found:?}");
    }
}
