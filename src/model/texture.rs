//! Textures of all materials on one sheet, since the programs have one texture of each kind.

use std::collections::{BTreeMap, BTreeSet};
use std::io::Cursor;

use glam::{DVec2, DVec3, DVec4};
use gltf::image::Source;

use super::Reader;
use super::nodes::Placed;
use super::part::{Part, material_parts};
use crate::limits::{MODEL_PIXELS, MODEL_TEXTURES};
use crate::scene::sets::{Map, Maps};
use crate::scene::{Shape, blank_texel};

/// All textures of a model, each in a cell.
#[derive(Default)]
pub struct Sheet {
    pub maps: Option<Maps>,
    /// The textures that at least one material has, by the names of their bindings.
    pub names: BTreeSet<&'static str>,
    cells: BTreeMap<Vec<Part>, usize>,
}

/// Puts the textures of all materials that are drawn on a sheet.
pub fn texture_sheet(reader: &mut Reader<'_>, placed: &Placed) -> Result<Sheet, String> {
    let document = reader.document;
    let mut cells = BTreeMap::new();
    for part in &placed.parts {
        let mesh = document.meshes().nth(part.mesh).ok_or("a node has a mesh that is not there")?;
        for primitive in mesh.primitives() {
            let count = cells.len();
            cells.entry(material_parts(reader, &primitive.material())?).or_insert(count);
        }
    }
    let names: BTreeSet<&str> = cells.keys().flatten().map(|part| part.map).collect();
    if names.is_empty() {
        return Ok(Sheet { cells, ..Sheet::default() });
    }
    if cells.len() > MODEL_TEXTURES {
        return Err(format!("materials: more than {MODEL_TEXTURES} sets of textures"));
    }
    let across = cells_across(cells.len());
    let mut maps = BTreeMap::new();
    for (parts, cell) in &cells {
        for part in parts {
            let side = (sheet_side(part.map) / across).min(1024);
            let map = maps.entry(part.map);
            let map = map.or_insert_with(|| blank_map(across * side, blank_of(part.map)));
            let at = [cell % across * side, cell / across * side];
            place_image(map, part, &decode_image(reader, part.image, part.is_color)?, at, side);
        }
    }
    let mut taken = |name: &str| maps.remove(name).unwrap_or_else(|| blank_map(1, blank_of(name)));
    let (base, normal) = (taken("base_map"), taken("normal_map"));
    let (occlusion, light) = (taken("occlusion_map"), taken("light_map"));
    let maps = Some(Maps { base, normal, occlusion, light, material: maps });
    Ok(Sheet { maps, names, cells })
}

/// Texels along an edge of a sheet. There may be ten of them.
fn sheet_side(map: &str) -> usize {
    if matches!(map, "base_map" | "normal_map") { 2048 } else { 1024 }
}

/// The texel where a material has no texture.
fn blank_of(map: &str) -> DVec4 {
    let other = if map == "normal_map" { DVec4::new(0.5, 0.5, 1.0, 1.0) } else { DVec4::ONE };
    blank_texel(map).unwrap_or(other)
}

impl Sheet {
    /// A shape whose coordinates are those of its material's cell.
    pub fn placed(
        &self,
        reader: &mut Reader<'_>,
        shape: Shape,
        material: &gltf::Material<'_>,
    ) -> Result<Shape, String> {
        let across = cells_across(self.cells.len());
        let parts = material_parts(reader, material)?;
        let Some(cell) = self.cells.get(&parts).filter(|_| across > 1) else { return Ok(shape) };
        let corner = DVec2::new((cell % across) as f64, (cell / across) as f64);
        let share = |x: f64| if (0.0..=1.0).contains(&x) { x } else { x - x.floor() };
        // Off the rim, so that filters do not reach into the next cell.
        let within = |uv: DVec2| 0.004 + 0.992 * DVec2::new(share(uv.x), share(uv.y));
        Ok(shape.map(|vertex| vertex.uv = (corner + within(vertex.uv)) / across as f64))
    }
}

impl Reader<'_> {
    /// The mean of a texture, for permutations that do not have it. Each image is decoded once.
    pub fn texture_mean(
        &mut self,
        texture: &gltf::Texture<'_>,
        is_color: bool,
    ) -> Result<DVec3, String> {
        let key = (texture.source().index(), is_color);
        if let Some(mean) = self.means.get(&key) {
            return Ok(*mean);
        }
        if self.means.len() >= MODEL_TEXTURES {
            return Err(format!("materials: more than {MODEL_TEXTURES} sets of textures"));
        }
        let map = decode_image(self, key.0, is_color)?;
        let sum: DVec3 = map.texels.iter().map(|texel| texel.truncate()).sum();
        let mean = sum / map.texels.len().max(1) as f64;
        self.means.insert(key, mean);
        Ok(mean)
    }
}

/// Cells in a row of the sheet.
fn cells_across(cells: usize) -> usize {
    (1..).find(|side| side * side >= cells).unwrap_or(1)
}

fn blank_map(side: usize, texel: DVec4) -> Map {
    Map { width: side, height: side, texels: vec![texel; side * side] }
}

/// Writes the channels of an image that count into a cell, the nearest pixel for each texel.
fn place_image(map: &mut Map, part: &Part, image: &Map, [left, top]: [usize; 2], side: usize) {
    for (y, x) in (0..side).flat_map(|y| (0..side).map(move |x| (y, x))) {
        let (column, row) = (x * image.width / side, y * image.height / side);
        let own = part.weakened(image.texels[row * image.width + column]);
        let texel = &mut map.texels[(top + y) * map.width + left + x];
        for channel in part.channels {
            texel[*channel] = own[*channel];
        }
    }
}

/// An image of the document, linear.
fn decode_image(reader: &Reader<'_>, index: usize, is_color: bool) -> Result<Map, String> {
    let place = format!("images[{index}]");
    let image = reader.document.images().nth(index).ok_or(format!("{place}: is not there"))?;
    let bytes = match image.source() {
        Source::View { view, .. } => reader.view(&view, &place)?,
        Source::Uri { .. } => {
            return Err(format!("{place}: is in another file; export one `.glb`"));
        }
    };
    let mut limits = image::Limits::default();
    limits.max_alloc = Some(16 * MODEL_PIXELS);
    let mut decoder = image::ImageReader::new(Cursor::new(bytes))
        .with_guessed_format()
        .map_err(|error| format!("{place}: {error}"))?;
    decoder.limits(limits);
    let decoded = decoder.decode().map_err(|error| format!("{place}: {error}"))?;
    let (width, height) = (decoded.width(), decoded.height());
    if u64::from(width) * u64::from(height) > MODEL_PIXELS || width == 0 || height == 0 {
        return Err(format!("{place}: {width} x {height} pixels are more than {MODEL_PIXELS}"));
    }
    // No finer than a cell can be.
    let small = decoded.thumbnail(1024.min(width), 1024.min(height)).to_rgba8();
    let linear = |byte: u8| {
        let share = f64::from(byte) / 255.0;
        if is_color { crate::scene::linear_from_srgb(share) } else { share }
    };
    let texel = |pixel: &image::Rgba<u8>| {
        let [red, green, blue, alpha] = pixel.0;
        DVec3::from_array([red, green, blue].map(linear)).extend(f64::from(alpha) / 255.0)
    };
    Ok(Map {
        width: small.width() as usize,
        height: small.height() as usize,
        texels: small.pixels().map(texel).collect(),
    })
}
