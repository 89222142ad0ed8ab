//! Primitives of meshes as objects in world space.

use crate::model::GltfReader;
use crate::model::channels::{Coordinates, material_parts};
use crate::model::deform::{Skinning, Skins, morph};
use crate::model::nodes::PlacedMesh;
use crate::model::surface::{self, Means, drawn_alpha, has_alpha, read_surface};
use crate::model::tangents::{is_crowded, set_tangents, with_any_tangents};
use crate::model::texture::Sheet;
use crate::sets::Object;
use crate::shape::{Shape, Vertex};
use glam::{DMat4, DVec2, DVec3, DVec4};
use gltf::accessor::Dimensions;
use gltf::mesh::Mode;
use lamplight_files::limits::MODEL_CORNERS;

/// The objects of a mesh in its place: one for each primitive of triangles.
pub fn mesh_objects(
    reader: &mut GltfReader<'_>,
    (part, skins): (&PlacedMesh, &Skins),
    sheet: &Sheet,
    corners: &mut usize,
) -> Result<Vec<(Object, Means)>, String> {
    let document = reader.document;
    let mesh = document.meshes().nth(part.mesh).ok_or("a node has a mesh that is not there")?;
    let mut objects = Vec::new();
    let skinning = part.skin.and_then(|skin| skins.get(&skin));
    for primitive in mesh.primitives() {
        let place = format!("meshes[{}].primitives[{}]", part.mesh, primitive.index());
        let Some(indices) = triangle_indices(reader, &primitive, &place)? else { continue };
        // Vertices that no triangle uses take memory too, again for each node that has the mesh.
        let count = primitive.get(&gltf::Semantic::Positions).map_or(0, |rows| rows.count());
        *corners += indices.len().max(count);
        if *corners > MODEL_CORNERS {
            return Err(format!("{place}: more than {MODEL_CORNERS} vertices of triangles"));
        }
        let own = sheet.coordinates(reader, &primitive.material())?;
        if own.set > 0 && primitive.get(&gltf::Semantic::TexCoords(own.set)).is_none() {
            let note = format!("{place}: no `TEXCOORD_{}`, which its textures name", own.set);
            reader.notes.insert(note);
        }
        let shape = mesh_shape(reader, &primitive, (indices, own), (part, skinning), &place)?;
        let shape = sheet.placed(reader, shape, &primitive.material())?;
        let shape = match skinning {
            Some(_) => shape,
            None => placed_shape(shape, part.world_from_mesh),
        };
        let (color, mut material, means) = read_surface(reader, &primitive.material())?;
        // The thickness of a volume scales with the mesh.
        let scale = part.world_from_mesh.determinant().abs().cbrt();
        if let Some(layers) = &mut material.layers {
            layers.thickness *= scale;
        }
        let object = Object::made(shape, DMat4::IDENTITY, color, material);
        let single_sided = !primitive.material().double_sided();
        let alpha = drawn_alpha(&primitive.material());
        let is_blended = surface::is_blended(&primitive.material());
        // What can be seen through has no shadow, since that would be one of the whole face.
        let casts = !is_blended;
        objects.push((Object { alpha, single_sided, is_blended, casts, ..object }, means));
    }
    Ok(objects)
}

/// Whether a primitive is made of triangles. Others are left out.
pub fn has_triangles(primitive: &gltf::Primitive<'_>) -> bool {
    matches!(primitive.mode(), Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan)
}

fn placed_shape(shape: Shape, world_from_mesh: DMat4) -> Shape {
    let shape = shape.transformed(world_from_mesh);
    if world_from_mesh.determinant() < 0.0 { mirror_winding(shape) } else { shape }
}

/// Mirrored triangles wind the other way round.
fn mirror_winding(mut shape: Shape) -> Shape {
    shape.indices.chunks_exact_mut(3).for_each(|triangle| triangle.swap(1, 2));
    shape
}

/// The indices of triangles, three for each; `None` for points and lines.
pub fn triangle_indices(
    reader: &mut GltfReader<'_>,
    primitive: &gltf::Primitive<'_>,
    place: &str,
) -> Result<Option<Vec<u32>>, String> {
    let Some(positions) = primitive.get(&gltf::Semantic::Positions) else {
        return Err(format!("{place}: no `POSITION`"));
    };
    let count = positions.count();
    if count > MODEL_CORNERS {
        return Err(format!("{place}: more than {MODEL_CORNERS} vertices"));
    }
    let listed = match primitive.indices() {
        Some(accessor) => reader.indices(&accessor, &format!("{place}.indices"))?,
        None => (0..count as u32).collect(),
    };
    if let Some(index) = listed.iter().find(|index| **index as usize >= count) {
        return Err(format!("{place}.indices: {index} is beyond the last of {count} vertices"));
    }
    let step = |at: usize| match primitive.mode() {
        Mode::TriangleStrip if at % 2 == 1 => [at + 1, at, at + 2],
        Mode::TriangleFan => [0, at + 1, at + 2],
        _ => [at, at + 1, at + 2],
    };
    Ok(Some(match primitive.mode() {
        Mode::Triangles => {
            let whole = listed.len() / 3 * 3;
            listed[..whole].to_vec()
        }
        Mode::TriangleStrip | Mode::TriangleFan => {
            let starts = 0..listed.len().saturating_sub(2);
            starts.flat_map(step).map(|at| listed[at]).collect()
        }
        _ => {
            reader.notes.insert("points and lines are ignored".to_owned());
            return Ok(None);
        }
    }))
}

/// The texture coordinates of a primitive's vertices, with the textures' transform applied. Empty
/// if it has none.
pub fn mesh_coordinates(
    reader: &GltfReader<'_>,
    primitive: &gltf::Primitive<'_>,
    own: Coordinates,
    place: &str,
) -> Result<Vec<DVec2>, String> {
    let name = format!("TEXCOORD_{}", own.set);
    let Some(accessor) = primitive.get(&gltf::Semantic::TexCoords(own.set)) else {
        return Ok(Vec::new());
    };
    let moved = own.texture_from_set();
    let rows = reader.rows(&accessor, &format!("{place}.attributes.{name}"))?;
    let at = |row: &[f64; 4]| moved.transform_point2(DVec2::new(row[0], row[1]));
    Ok(rows.iter().map(at).map(|at| if at.is_finite() { at } else { DVec2::ZERO }).collect())
}

/// The colours of a primitive's vertices, with an alpha of 1 where they have none.
fn vertex_colors(
    reader: &GltfReader<'_>,
    primitive: &gltf::Primitive<'_>,
    place: &str,
) -> Result<Option<Vec<[f64; 4]>>, String> {
    let Some(accessor) = primitive.get(&gltf::Semantic::Colors(0)) else { return Ok(None) };
    let mut rows = reader.rows(&accessor, &format!("{place}.attributes.COLOR_0"))?;
    if accessor.dimensions() != Dimensions::Vec4 {
        rows.iter_mut().for_each(|row| row[3] = 1.0);
    }
    Ok(Some(rows))
}

/// The vertices and triangles of a primitive. Without normals each triangle has that of its face, and
/// tangents are then ignored (glTF 2.0, 3.7.2.1).
fn mesh_shape(
    reader: &mut GltfReader<'_>,
    primitive: &gltf::Primitive<'_>,
    (indices, own): (Vec<u32>, Coordinates),
    (part, skinning): (&PlacedMesh, Option<&Skinning>),
    place: &str,
) -> Result<Shape, String> {
    let material = primitive.material();
    let parts = material_parts(reader, &material)?;
    let of_normals = match parts.iter().find(|part| part.map == "normal_map") {
        Some(part) => Some(mesh_coordinates(reader, primitive, part.coordinates, place)?),
        None => None,
    };
    // Nothing else reads tangents.
    let is_read = of_normals.is_some() || surface::is_anisotropic(&material);
    let mut vertices = mesh_vertices(reader, primitive, own, of_normals.as_deref(), place)?;
    morph(reader, primitive, part, &mut vertices, place)?;
    let is_mirrored = match skinning {
        Some(skinning) => skinning.apply(reader, primitive, &mut vertices, place)?,
        None => false,
    };
    let shape = Shape { vertices, indices };
    let shape = if is_mirrored { mirror_winding(shape) } else { shape };
    let has = |semantic: gltf::Semantic| primitive.get(&semantic).is_some();
    let has_normals = has(gltf::Semantic::Normals);
    let shape = if has_normals { shape } else { shape.faceted() };
    if has_normals && has(gltf::Semantic::Tangents) {
        return Ok(shape);
    }
    Ok(if is_read { made_tangents(reader, shape, place) } else { with_any_tangents(shape) })
}

/// The vertices of a primitive as the file gives them.
fn mesh_vertices(
    reader: &GltfReader<'_>,
    primitive: &gltf::Primitive<'_>,
    own: Coordinates,
    of_normals: Option<&[DVec2]>,
    place: &str,
) -> Result<Vec<Vertex>, String> {
    let rows = |semantic: gltf::Semantic, name: &str| match primitive.get(&semantic) {
        Some(accessor) => reader.rows(&accessor, &format!("{place}.attributes.{name}")).map(Some),
        None => Ok(None),
    };
    let positions = rows(gltf::Semantic::Positions, "POSITION")?.unwrap_or_default();
    let normals = rows(gltf::Semantic::Normals, "NORMAL")?;
    let tangents = rows(gltf::Semantic::Tangents, "TANGENT")?;
    let coordinates = mesh_coordinates(reader, primitive, own, place)?;
    let colors = vertex_colors(reader, primitive, place)?;
    let has_alpha = has_alpha(&primitive.material());
    let vector = |row: &[f64; 4]| DVec3::new(row[0], row[1], row[2]);
    let row = |rows: &Option<Vec<[f64; 4]>>, index: usize| {
        rows.as_ref().and_then(|rows| rows.get(index).copied())
    };
    let vertex = |(index, position): (usize, &[f64; 4])| {
        let uv = coordinates.get(index).copied().unwrap_or_default();
        let normal = row(&normals, index).map(|normal| vector(&normal).normalize_or_zero());
        Vertex {
            position: vector(position),
            normal: normal.unwrap_or(DVec3::Y),
            color: row(&colors, index).map_or(DVec3::ONE, |color| vector(&color)),
            alpha: row(&colors, index).filter(|_| has_alpha).map_or(1.0, |color| color[3]),
            uv,
            // A model has no light map. Its tangents follow these coordinates.
            light_uv: of_normals.and_then(|all| all.get(index)).copied().unwrap_or(uv),
            tangent: row(&tangents, index).map_or(DVec4::ZERO, DVec4::from_array),
        }
    };
    Ok(positions.iter().enumerate().map(vertex).collect())
}

/// A shape with the tangents that its texture coordinates give.
fn made_tangents(reader: &mut GltfReader<'_>, shape: Shape, place: &str) -> Shape {
    if is_crowded(&shape) {
        let note = format!("{place}: so many triangles meet in a point that it has any tangents");
        reader.notes.insert(note);
        return with_any_tangents(shape);
    }
    set_tangents(shape)
}
