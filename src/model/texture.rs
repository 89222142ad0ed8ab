//! Textures of all materials on one sheet, since the programs have one texture of each kind.

use std::collections::BTreeMap;
use std::io::Cursor;

use glam::{DVec2, DVec3, DVec4};
use gltf::image::Source;

use super::Reader;
use super::nodes::Placed;
use crate::limits::{MODEL_PIXELS, MODEL_TEXTURES};
use crate::scene::Shape;
use crate::scene::sets::{Map, Maps};

/// Texels along an edge of the sheet.
const SIDE: usize = 2048;

/// Images of a material, by their numbers.
type Images = (Option<usize>, Option<usize>);

/// All textures of a model, each in a cell.
#[derive(Default)]
pub struct Sheet {
    pub maps: Option<Maps>,
    pub has_colors: bool,
    pub has_normals: bool,
    cells: BTreeMap<Images, usize>,
}

/// Puts the textures of all materials that are drawn on a sheet.
pub fn texture_sheet(reader: &mut Reader<'_>, placed: &Placed) -> Result<Sheet, String> {
    let document = reader.document;
    let mut cells = BTreeMap::new();
    for part in &placed.parts {
        let mesh = document.meshes().nth(part.mesh).ok_or("a node has a mesh that is not there")?;
        for primitive in mesh.primitives() {
            let count = cells.len();
            cells.entry(material_images(&primitive.material())).or_insert(count);
        }
    }
    if cells.keys().all(|images| *images == (None, None)) {
        return Ok(Sheet { cells, ..Sheet::default() });
    }
    if cells.len() > MODEL_TEXTURES {
        return Err(format!("materials: more than {MODEL_TEXTURES} sets of textures"));
    }
    let across = cells_across(cells.len());
    let side = (SIDE / across).min(1024);
    let mut base = blank_map(across * side, DVec4::ONE);
    let mut normal = blank_map(across * side, DVec4::new(0.5, 0.5, 1.0, 1.0));
    for ((color, bumps), cell) in &cells {
        let at = [cell % across * side, cell / across * side];
        if let Some(image) = color {
            place_image(&mut base, &decode_image(reader, *image, true)?, at, side);
        }
        if let Some(image) = bumps {
            place_image(&mut normal, &decode_image(reader, *image, false)?, at, side);
        }
    }
    let has_colors = cells.keys().any(|(color, _)| color.is_some());
    let has_normals = cells.keys().any(|(_, bumps)| bumps.is_some());
    let light = blank_map(1, DVec4::ONE);
    Ok(Sheet {
        maps: Some(Maps { base, normal, occlusion: blank_map(1, DVec4::ONE), light }),
        has_colors,
        has_normals,
        cells,
    })
}

impl Sheet {
    /// A shape whose coordinates are those of its material's cell.
    pub fn placed(&self, shape: Shape, material: &gltf::Material<'_>) -> Shape {
        let across = cells_across(self.cells.len());
        let Some(cell) = self.cells.get(&material_images(material)).filter(|_| across > 1) else {
            return shape;
        };
        let corner = DVec2::new((cell % across) as f64, (cell / across) as f64);
        let share = |x: f64| if (0.0..=1.0).contains(&x) { x } else { x - x.floor() };
        // Off the rim, so that filters do not reach into the next cell.
        let within = |uv: DVec2| 0.004 + 0.992 * DVec2::new(share(uv.x), share(uv.y));
        shape.map(|vertex| vertex.uv = (corner + within(vertex.uv)) / across as f64)
    }
}

impl Reader<'_> {
    /// The mean of a texture that the programs do not have, which is noted. Each image is decoded
    /// once.
    pub fn texture_mean(
        &mut self,
        texture: &gltf::Texture<'_>,
        is_color: bool,
        what: &str,
    ) -> Result<DVec3, String> {
        self.notes.insert(format!(
            "textures of {what} count with their mean, since the programs do not have them"
        ));
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

fn material_images(material: &gltf::Material<'_>) -> Images {
    let own = material.pbr_metallic_roughness();
    let color = own.base_color_texture().map(|info| info.texture().source().index());
    (color, material.normal_texture().map(|info| info.texture().source().index()))
}

fn blank_map(side: usize, texel: DVec4) -> Map {
    Map { width: side, height: side, texels: vec![texel; side * side] }
}

/// Writes an image into a cell, the nearest pixel for each texel.
fn place_image(map: &mut Map, image: &Map, [left, top]: [usize; 2], side: usize) {
    for (y, x) in (0..side).flat_map(|y| (0..side).map(move |x| (y, x))) {
        let (column, row) = (x * image.width / side, y * image.height / side);
        map.texels[(top + y) * map.width + left + x] = image.texels[row * image.width + column];
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
    let small = decoded.thumbnail(1024.min(width), 1024.min(height)).to_rgb8();
    let linear = |byte: u8| {
        let share = f64::from(byte) / 255.0;
        if is_color { crate::scene::linear_from_srgb(share) } else { share }
    };
    let texel = |pixel: &image::Rgb<u8>| DVec3::from_array(pixel.0.map(linear)).extend(1.0);
    Ok(Map {
        width: small.width() as usize,
        height: small.height() as usize,
        texels: small.pixels().map(texel).collect(),
    })
}
