//! Puts the textures of all materials on one sheet (an atlas), since the programs have one texture
//! of each kind.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use std::io::Cursor;

use glam::{DVec2, DVec3, DVec4};
use gltf::image::Source;
use image::{DynamicImage, ImageDecoder as _, ImageError};

use super::GltfReader;
use super::bake::{Budget, triangles_of, unwrapped};
use super::files::uri_bytes;
use super::mesh::{has_triangles, mesh_coordinates};
use super::nodes::PlacedNodes;
use crate::maps::blank_texel;
use crate::model::channels::{Coordinates, ImageChannels, Window, Wrap, image_of, material_parts};
use crate::sets::{Maps, TextureMap};
use crate::shape::Shape;
use lamplight_files::limits::{MODEL_ALL_PIXELS, MODEL_CORNERS, MODEL_PIXELS, MODEL_TEXTURES};

/// All textures of a model: each set of them, as a material has it, is in a cell.
#[derive(Default)]
pub struct Sheet {
    pub maps: Option<Maps>,
    /// The textures that at least one material has, by the names of their bindings.
    pub names: BTreeSet<&'static str>,
    cells: BTreeMap<Vec<ImageChannels>, Cell>,
}

/// The part of a cell on each side that is beyond its window: a texel of the smallest cells.
const FRAME: f64 = 1.0 / 64.0;

/// The place of a set of textures on the sheet.
#[derive(Debug, Clone, Copy)]
struct Cell {
    index: usize,
    /// The coordinates of the surfaces with this set: those of the textures if all of them have the
    /// same, else a set of coordinates without a transform.
    own: Coordinates,
    is_shared: bool,
    window: Window,
    /// Whether it shows a little more than the window on each side, so that filters do not reach into the
    /// next cell. A single set that repeats is repeated by the sampler.
    is_framed: bool,
}

impl Cell {
    /// The cell for the textures of a material. If their transforms differ, these are applied to
    /// the images as they are drawn into the cell. A texture with another set of coordinates than
    /// the first cannot be drawn into the cell.
    fn new(index: usize, parts: &[ImageChannels]) -> Self {
        let first = parts.first().map_or_else(Coordinates::default, |part| part.coordinates);
        let is_shared = parts.iter().all(|part| part.coordinates == first);
        let own = if is_shared { first } else { Coordinates::of_set(first.set) };
        Self { index, own, is_shared, window: Window::UNIT, is_framed: true }
    }

    /// The coordinates in a texture of a position in the cell, in [0, 1]. Those in [0, 1] are in the
    /// image.
    fn in_texture(&self, part: &ImageChannels, share: DVec2) -> DVec2 {
        let share = if self.is_framed { (share - FRAME) / (1.0 - 2.0 * FRAME) } else { share };
        let at = self.window.at(share);
        if self.is_shared { at } else { part.coordinates.texture_from_set().transform_point2(at) }
    }

    /// Where in the cell coordinates of its own set are, in [0, 1].
    fn place(&self, uv: DVec2) -> DVec2 {
        if !self.is_framed {
            return (uv - self.window.low) / self.window.size;
        }
        FRAME + (1.0 - 2.0 * FRAME) * self.window.share(uv)
    }

    /// Whether the sampler can repeat the cell as its only texture.
    fn is_repeated(parts: &[ImageChannels]) -> bool {
        parts.iter().all(|part| part.wraps == [Wrap::Repeat; 2])
    }
}

/// Puts the textures of all materials that are drawn on a sheet.
pub fn texture_sheet(reader: &mut GltfReader<'_>, placed: &PlacedNodes) -> Result<Sheet, String> {
    let cells = texture_cells(reader, placed)?;
    let names: BTreeSet<&str> = cells.keys().flatten().map(|part| part.map).collect();
    if names.is_empty() {
        return Ok(Sheet { cells, ..Sheet::default() });
    }
    if cells.len() > MODEL_TEXTURES {
        return Err(format!("materials: more than {MODEL_TEXTURES} sets of textures"));
    }
    let across = cells_across(cells.len());
    if across > COARSE {
        let (count, side) = (cells.len(), 2048 / across);
        let note = format!("{count} sets of textures share one sheet: {side} x {side} pixels each");
        reader.notes.insert(note);
    }
    let sizes = map_sizes(reader, &cells)?;
    let (mut maps, mut budget) = (BTreeMap::new(), Budget::default());
    for (parts, cell) in &cells {
        for part in parts {
            let [width, height] = sizes.get(part.map).map_or([1; 2], |cell| cell.size);
            let map = maps.entry(part.map).or_insert_with(|| {
                blank_map([across * width, across * height], blank_of(part.map))
            });
            let Some(image) = reader.image(part.image, part.is_color)? else { continue };
            let at = [cell.index % across * width, cell.index / across * height];
            let place = (at, [width, height]);
            if part.coordinates.set == cell.own.set {
                place_image(map, part, &image, place, |share| cell.in_texture(part, share));
            } else {
                let size = [width, height];
                let found = other_set(reader, placed, (parts, cell), (part, size), &mut budget)?;
                place_other(map, part, &image, place, found);
            }
        }
    }
    let mut taken =
        |name: &str| maps.remove(name).unwrap_or_else(|| blank_map([1; 2], blank_of(name)));
    let (base, normal) = (taken("base_map"), taken("normal_map"));
    let (occlusion, light) = (taken("occlusion_map"), taken("light_map"));
    // A picture that has fewer pixels than an enlarged image reads between its pixels, and not their mean.
    let single = sizes.iter().filter(|(_, cell)| !cell.is_fine).map(|(name, _)| *name).collect();
    let maps = Some(Maps { base, normal, occlusion, light, material: maps, single });
    Ok(Sheet { maps, names, cells })
}

/// Where each pixel of a cell is in the set of coordinates of one of its textures, which is not the first
/// set of the material. If that is nowhere, a note says so: the texture counts with its mean.
fn other_set(
    reader: &mut GltfReader<'_>,
    placed: &PlacedNodes,
    (parts, cell): (&[ImageChannels], &Cell),
    (part, size): (&ImageChannels, [usize; 2]),
    budget: &mut Budget,
) -> Result<Option<Vec<Option<DVec2>>>, String> {
    let found = if part.map == "normal_map" {
        Err("its normals have their directions from the first set")
    } else {
        let pixels = DVec2::new(size[0] as f64, size[1] as f64);
        let sets = [cell.own, part.coordinates];
        triangles_of(reader, placed, parts, sets, budget)?.and_then(|mut triangles| {
            for [first, _] in triangles.iter_mut().flatten() {
                *first = cell.place(*first) * pixels - 0.5;
            }
            unwrapped(&triangles, size, budget)
        })
    };
    if let Err(reason) = found {
        let what = "a texture with another set of coordinates than the first of its material";
        reader.notes.insert(format!("{what} counts with its mean: {reason}"));
    }
    Ok(found.ok())
}

/// Writes the channels of an image into a cell by the coordinates of each pixel, and the image's mean
/// where there are none.
fn place_other(
    map: &mut TextureMap,
    part: &ImageChannels,
    image: &TextureMap,
    (at, size): ([usize; 2], [usize; 2]),
    found: Option<Vec<Option<DVec2>>>,
) {
    place_image(map, part, &blank_map([1; 2], image.mean()), (at, size), |_| DVec2::ZERO);
    let pixels = DVec2::new(image.width as f64, image.height as f64);
    for (index, uv) in found.into_iter().flatten().enumerate() {
        let Some(uv) = uv else { continue };
        let place = uv * pixels;
        let own =
            if part.is_blocky { pixel_at(image, part, place) } else { between(image, part, place) };
        let own = part.scaled(own);
        let (x, y) = (at[0] + index % size[0], at[1] + index / size[0]);
        for channel in part.channels {
            map.texels[y * map.width + x][*channel] = own[*channel];
        }
    }
}

/// The pixels of a cell of a texture.
#[derive(Clone, Copy, Default)]
struct CellSize {
    size: [usize; 2],
    /// Whether some image has not many more pixels there than in its file.
    is_fine: bool,
}

/// The pixels of a cell of each texture. Images that the sampler can show as they are keep their size. Others
/// are drawn much larger into their cells, so that what is between their pixels is there too.
fn map_sizes(
    reader: &GltfReader<'_>,
    cells: &BTreeMap<Vec<ImageChannels>, Cell>,
) -> Result<BTreeMap<&'static str, CellSize>, String> {
    const LARGER: f64 = 64.0;
    const LEAST: usize = 64;
    let across = cells_across(cells.len());
    let mut sizes = BTreeMap::new();
    for (parts, cell) in cells {
        let is_smooth = parts.iter().all(|part| !part.is_blocky);
        let is_shown = is_smooth && cell.is_shared && !cell.is_framed;
        for part in parts {
            let most = (sheet_side(part.map) / across).clamp(1, LARGEST);
            let [width, height] = image_size(reader, part.image)?;
            let pixels = DVec2::new(width as f64, height as f64) * cell.window.size;
            // What is drawn triangle by triangle has another size on each.
            let is_other = part.coordinates.set != cell.own.set;
            let wanted = (LARGER * pixels.max_element()) as usize;
            let least = if is_other { most } else { LEAST };
            let side = wanted.next_power_of_two().max(least).min(most);
            let own = if is_shown { [width.min(most), height.min(most)] } else { [side; 2] };
            let found: &mut CellSize = sizes.entry(part.map).or_default();
            found.size = [found.size[0].max(own[0]), found.size[1].max(own[1])];
            found.is_fine |= is_shown || 8 * side < wanted;
        }
    }
    Ok(sizes)
}

/// A cell for each set of textures. A single set that repeats is repeated by the sampler. Otherwise
/// what is beyond the images is drawn into the cells.
fn texture_cells(
    reader: &GltfReader<'_>,
    placed: &PlacedNodes,
) -> Result<BTreeMap<Vec<ImageChannels>, Cell>, String> {
    let document = reader.document;
    let mut cells = BTreeMap::new();
    let mut bounds: BTreeMap<usize, (DVec2, DVec2)> = BTreeMap::new();
    let mut corners = 0;
    let meshes: BTreeSet<usize> = placed.parts.iter().map(|part| part.mesh).collect();
    for index in meshes {
        let mesh = document.meshes().nth(index).ok_or("a node has a mesh that is not there")?;
        for primitive in mesh.primitives().filter(has_triangles) {
            let parts = material_parts(reader, &primitive.material())?;
            let count = cells.len();
            let cell = *cells.entry(parts).or_insert_with_key(|parts| Cell::new(count, parts));
            let place = format!("meshes[{index}].primitives[{}]", primitive.index());
            let rows = mesh_coordinates(reader, &primitive, cell.own, &place)?;
            corners += rows.len();
            if corners > MODEL_CORNERS {
                return Err(format!("{place}: more than {MODEL_CORNERS} vertices of triangles"));
            }
            let (low, high) =
                bounds.entry(cell.index).or_insert((DVec2::INFINITY, DVec2::NEG_INFINITY));
            for uv in rows {
                (*low, *high) = (low.min(uv), high.max(uv));
            }
        }
    }
    let is_alone = cells.len() == 1;
    for (parts, cell) in &mut cells {
        cell.is_framed = !is_alone || !Cell::is_repeated(parts);
        if !cell.is_framed && cell.is_shared {
            continue;
        }
        if let Some((low, high)) = bounds.get(&cell.index) {
            cell.window = Window::around(*low, *high);
        }
    }
    Ok(cells)
}

/// The most pixels along an edge that are read of an image.
const LARGEST: usize = 1024;

/// With more cells in a row, images are drawn much smaller than they are.
const COARSE: usize = 8;

/// Texels along an edge of a sheet. A model may need ten sheets.
fn sheet_side(map: &str) -> usize {
    if matches!(map, "base_map" | "normal_map") { 2048 } else { 1024 }
}

/// The texel where a material has no texture.
fn blank_of(map: &str) -> DVec4 {
    let other = if map == "normal_map" { DVec4::new(0.5, 0.5, 1.0, 1.0) } else { DVec4::ONE };
    blank_texel(map).unwrap_or(other)
}

impl Sheet {
    /// The coordinates that the corners of a material's surfaces have.
    pub fn coordinates(
        &self,
        reader: &GltfReader<'_>,
        material: &gltf::Material<'_>,
    ) -> Result<Coordinates, String> {
        let cell = self.cells.get(&material_parts(reader, material)?);
        Ok(cell.map_or_else(Coordinates::default, |cell| cell.own))
    }

    /// A shape whose coordinates are those of its material's cell.
    pub fn placed(
        &self,
        reader: &GltfReader<'_>,
        shape: Shape,
        material: &gltf::Material<'_>,
    ) -> Result<Shape, String> {
        let across = cells_across(self.cells.len());
        let parts = material_parts(reader, material)?;
        let Some(cell) = self.cells.get(&parts) else { return Ok(shape) };
        // The window of a single cell is repeated by the sampler.
        if !cell.is_framed {
            return Ok(shape.map(|vertex| vertex.uv = cell.place(vertex.uv)));
        }
        let corner = DVec2::new((cell.index % across) as f64, (cell.index / across) as f64);
        Ok(shape.map(|vertex| vertex.uv = (corner + cell.place(vertex.uv)) / across as f64))
    }
}

impl GltfReader<'_> {
    /// The mean of a texture, for permutations that do not have it. Each image is decoded once.
    pub fn texture_mean(
        &mut self,
        texture: &gltf::Texture<'_>,
        is_color: bool,
    ) -> Result<DVec4, String> {
        // A texture that cannot be read counts as 1, which changes no factor.
        let Some(image) = image_of(texture) else { return Ok(DVec4::ONE) };
        let key = (image, is_color);
        if let Some(mean) = self.means.get(&key) {
            return Ok(*mean);
        }
        if self.means.len() >= MODEL_TEXTURES {
            return Err(format!("materials: more than {MODEL_TEXTURES} sets of textures"));
        }
        let mean = self.image(key.0, is_color)?.map_or(DVec4::ONE, |map| map.mean());
        self.means.insert(key, mean);
        Ok(mean)
    }

    /// An image of the document, linear. One that cannot be decoded is left out with a note.
    fn image(&mut self, index: usize, is_color: bool) -> Result<Option<TextureMap>, String> {
        match decode_image(self, index, is_color)? {
            Ok(map) => Ok(Some(map)),
            Err(reason) => {
                let note = format!("images[{index}] is ignored: {reason}");
                self.notes.insert(note);
                Ok(None)
            }
        }
    }
}

/// Cells in a row of the sheet.
fn cells_across(cells: usize) -> usize {
    (1..).find(|side| side * side >= cells).unwrap_or(1)
}

fn blank_map([width, height]: [usize; 2], texel: DVec4) -> TextureMap {
    TextureMap { width, height, texels: vec![texel; width * height] }
}

/// Writes the channels of an image that count into a cell: between the pixels of the image, unless its
/// sampler shows them as squares.
fn place_image(
    map: &mut TextureMap,
    part: &ImageChannels,
    image: &TextureMap,
    ([left, top], [width, height]): ([usize; 2], [usize; 2]),
    in_texture: impl Fn(DVec2) -> DVec2,
) {
    let size = DVec2::new(image.width as f64, image.height as f64);
    let cell = DVec2::new(width as f64, height as f64);
    for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
        let at = in_texture((DVec2::new(x as f64, y as f64) + 0.5) / cell) * size;
        let own = if part.is_blocky { pixel_at(image, part, at) } else { between(image, part, at) };
        let own = part.scaled(own);
        let texel = &mut map.texels[(top + y) * map.width + left + x];
        for channel in part.channels {
            texel[*channel] = own[*channel];
        }
    }
}

/// The pixel at a place in an image, in pixels.
fn pixel_at(image: &TextureMap, part: &ImageChannels, at: DVec2) -> DVec4 {
    let [across, down] = part.wraps;
    let column = across.pixel(at.x.floor() as i64, image.width);
    let row = down.pixel(at.y.floor() as i64, image.height);
    image.texels[row * image.width + column]
}

/// What is between the middles of the four pixels around a place in an image, in pixels.
fn between(image: &TextureMap, part: &ImageChannels, at: DVec2) -> DVec4 {
    let low = (at - 0.5).floor();
    let share = at - 0.5 - low;
    let pixel = |x: f64, y: f64| pixel_at(image, part, low + DVec2::new(x, y));
    let [upper, lower] = [0.0, 1.0].map(|y| pixel(0.0, y).lerp(pixel(1.0, y), share.x));
    upper.lerp(lower, share.y)
}

/// The bytes of an image as they are in the file.
fn image_bytes<'b>(
    reader: &GltfReader<'b>,
    index: usize,
    place: &str,
) -> Result<Cow<'b, [u8]>, String> {
    let image = reader.document.images().nth(index).ok_or(format!("{place}: is not there"))?;
    match image.source() {
        Source::View { view, .. } => reader.view(&view, place).map(Cow::Borrowed),
        Source::Uri { uri, .. } => {
            let bytes = uri_bytes(uri, reader.files).map(Cow::Owned);
            bytes.map_err(|reason| format!("{place}: {reason}"))
        }
    }
}

/// The format of an image that extensions allow, by its first bytes.
fn unread_format(bytes: &[u8]) -> Option<&'static str> {
    if bytes.starts_with(b"\xabKTX 20\xbb") {
        return Some("KTX 2, as of KHR_texture_basisu");
    }
    bytes.starts_with(b"DDS ").then_some("DDS")
}

/// Width and height of an image, by its header; 1 if it cannot be read.
fn image_size(reader: &GltfReader<'_>, index: usize) -> Result<[usize; 2], String> {
    let bytes = image_bytes(reader, index, &format!("images[{index}]"))?;
    let file = image::ImageReader::new(Cursor::new(bytes.as_ref())).with_guessed_format();
    let size = file.ok().and_then(|file| file.into_dimensions().ok()).unwrap_or((1, 1));
    Ok([size.0 as usize, size.1 as usize])
}

/// An image of the document, linear, or why it cannot be decoded.
///
/// # Errors
/// Bytes that are not in the file, and an image that is too large.
fn decode_image(
    reader: &mut GltfReader<'_>,
    index: usize,
    is_color: bool,
) -> Result<Result<TextureMap, String>, String> {
    let place = format!("images[{index}]");
    let bytes = image_bytes(reader, index, &place)?;
    let bytes = bytes.as_ref();
    if let Some(format) = unread_format(bytes) {
        return Ok(Err(format!("it is {format}, which is not read; export it as PNG or JPEG")));
    }
    let mut limits = image::Limits::default();
    limits.max_alloc = Some(16 * MODEL_PIXELS);
    let mut file = image::ImageReader::new(Cursor::new(bytes))
        .with_guessed_format()
        .map_err(|error| format!("{place}: {error}"))?;
    file.limits(limits);
    // What is too large is an error, and anything else is a kind of image that is not known.
    let undecoded = |error: ImageError| match error {
        ImageError::Limits(error) => Err(format!("{place}: {error}")),
        error => Ok(Err(error.to_string())),
    };
    let decoder = match file.into_decoder() {
        Ok(decoder) => decoder,
        Err(error) => return undecoded(error),
    };
    let (width, height) = decoder.dimensions();
    if u64::from(width) * u64::from(height) > MODEL_PIXELS || width == 0 || height == 0 {
        return Err(format!("{place}: {width} x {height} pixels are more than {MODEL_PIXELS}"));
    }
    reader.decoded += u64::from(width) * u64::from(height);
    if reader.decoded > MODEL_ALL_PIXELS {
        return Err(format!("{place}: all images have more than {MODEL_ALL_PIXELS} pixels"));
    }
    let decoded = match DynamicImage::from_decoder(decoder) {
        Ok(decoded) => decoded,
        Err(error) => return undecoded(error),
    };
    Ok(Ok(linear_map(&decoded, is_color)))
}

/// The texels of an image, linear, and no finer than a cell can be.
fn linear_map(decoded: &DynamicImage, is_color: bool) -> TextureMap {
    let small = match decoded.width().max(decoded.height()) > LARGEST as u32 {
        true => decoded.thumbnail(LARGEST as u32, LARGEST as u32).to_rgba8(),
        false => decoded.to_rgba8(),
    };
    let linear = |byte: u8| {
        let share = f64::from(byte) / 255.0;
        if is_color { crate::linear_from_srgb(share) } else { share }
    };
    let texel = |pixel: &image::Rgba<u8>| {
        let [red, green, blue, alpha] = pixel.0;
        DVec3::from_array([red, green, blue].map(linear)).extend(f64::from(alpha) / 255.0)
    };
    TextureMap {
        width: small.width() as usize,
        height: small.height() as usize,
        texels: small.pixels().map(texel).collect(),
    }
}
