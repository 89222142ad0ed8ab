//! A small renderer of glTF by its text: a ray through each pixel, each triangle on its way, and for the
//! nearest of them the light of all lamps, in f64. The material, the samplers and the lamps are read from
//! the document itself.

use glam::{DMat3, DMat4, DVec2, DVec3, DVec4, Vec3Swizzles as _};
use serde_json::Value;

use super::brdf::{Choices, Surface};
use super::model::{Drawn, Mesh, Model, Pixels, local};
use super::tangents::{Face, Vertex, tangents};

/// A vertex in the world.
#[derive(Debug, Clone, Copy)]
struct Corner {
    position: DVec3,
    normal: DVec3,
    tangent: DVec4,
    uv: [DVec2; 2],
    color: DVec4,
}

#[derive(Debug, Clone)]
struct Triangle {
    corners: [Corner; 3],
    material: usize,
}

struct Lamp {
    light: Value,
    world: DMat4,
}

/// What a pixel shows: the radiance, and which triangles.
#[derive(Debug, Clone, PartialEq)]
pub struct Seen {
    pub radiance: DVec3,
    pub triangles: Vec<usize>,
}

/// A model as the reference draws it.
pub struct Scene<'m> {
    document: &'m Value,
    images: &'m [Pixels],
    triangles: Vec<Triangle>,
    lamps: Vec<Lamp>,
    camera: (Value, DMat4),
    choices: Choices,
}

/// The place where a ray meets a triangle.
struct Hit {
    distance: f64,
    triangle: usize,
    /// Shares of the corners.
    shares: [f64; 3],
    is_front: bool,
}

impl<'m> Scene<'m> {
    pub fn new(model: &'m Model, choices: Choices) -> Self {
        let document = &model.document;
        let of_mesh = |drawn| triangles(drawn, document, choices);
        let triangles = model.drawn.iter().flat_map(of_mesh).collect();
        let (mut lamps, mut camera) = (Vec::new(), (Value::Null, DMat4::IDENTITY));
        for (world, node) in nodes(document) {
            if let Some(index) = index_at(node, "/extensions/KHR_lights_punctual/light") {
                let light = &document["extensions"]["KHR_lights_punctual"]["lights"][index];
                lamps.push(Lamp { light: light.clone(), world });
            }
            if let Some(index) = index_at(node, "/camera") {
                camera = (document["cameras"][index].clone(), world);
            }
        }
        Self { document, images: &model.images, triangles, lamps, camera, choices }
    }

    /// The pixels row by row from the top.
    pub fn draw(&self, size: usize) -> Vec<Seen> {
        let places = (0..size).flat_map(|y| (0..size).map(move |x| (x, y)));
        let pixel = |(x, y): (usize, usize)| {
            let at = |place: usize| 2.0 * (place as f64 + 0.5) / size as f64 - 1.0;
            let (origin, direction) = self.ray(at(x), -at(y));
            self.seen(origin, direction)
        };
        places.map(pixel).collect()
    }

    /// 3.10.3: the ray through a place of the picture, from -1 to 1.
    fn ray(&self, x: f64, y: f64) -> (DVec3, DVec3) {
        let (camera, world) = &self.camera;
        let (origin, direction) = match camera["type"].as_str() {
            Some("orthographic") => {
                let own = &camera["orthographic"];
                let place =
                    DVec3::new(x * number(own, "xmag", 1.0), y * number(own, "ymag", 1.0), 0.0);
                (place, DVec3::NEG_Z)
            }
            _ => {
                let own = &camera["perspective"];
                let up = (0.5 * number(own, "yfov", 1.0)).tan();
                let right = up * number(own, "aspectRatio", 1.0);
                (DVec3::ZERO, DVec3::new(x * right, y * up, -1.0))
            }
        };
        (world.transform_point3(origin), world.transform_vector3(direction).normalize())
    }

    /// The light along a ray: surfaces from the farthest to the nearest, each over those behind it.
    fn seen(&self, origin: DVec3, direction: DVec3) -> Seen {
        let mut hits: Vec<Hit> = self.hits(origin, direction);
        hits.sort_by(|a, b| a.distance.total_cmp(&b.distance));
        let mut layers = Vec::new();
        for hit in hits {
            let (surface, alpha) = self.surface(&hit, -direction);
            let Some(alpha) = alpha else { continue };
            let place = origin + direction * hit.distance;
            layers.push((self.radiance(&surface, place), alpha, hit.triangle));
            if alpha >= 1.0 {
                break;
            }
        }
        let over =
            |behind: DVec3, (color, alpha, _): &(DVec3, f64, usize)| behind.lerp(*color, *alpha);
        let radiance = layers.iter().rev().fold(DVec3::ZERO, over);
        Seen { radiance, triangles: layers.iter().map(|layer| layer.2).collect() }
    }

    /// The triangles on a ray (Möller, Trumbore 1997), without the backs of single-sided materials.
    fn hits(&self, origin: DVec3, direction: DVec3) -> Vec<Hit> {
        let hit = |(index, triangle): (usize, &Triangle)| {
            let [a, b, c] = triangle.corners.map(|corner| corner.position);
            let (ab, ac) = (b - a, c - a);
            let across = direction.cross(ac);
            let determinant = ab.dot(across);
            let offset = origin - a;
            let u = offset.dot(across) / determinant;
            let along = offset.cross(ab);
            let v = direction.dot(along) / determinant;
            let distance = ac.dot(along) / determinant;
            let is_inside = u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > 0.0;
            let is_front = ab.cross(ac).dot(direction) < 0.0;
            let material = &self.document["materials"][triangle.material];
            let is_drawn = is_front || material["doubleSided"] == true;
            (is_inside && is_drawn).then_some(Hit {
                distance,
                triangle: index,
                shares: [1.0 - u - v, u, v],
                is_front,
            })
        };
        self.triangles.iter().enumerate().filter_map(hit).collect()
    }

    /// 3.9.3, appendix B and KHR_lights_punctual: what the surface gives off, and what it reflects of each lamp.
    fn radiance(&self, surface: &Surface, place: DVec3) -> DVec3 {
        if surface.is_unlit {
            return surface.base;
        }
        const STEPS: usize = 20;
        let albedo = match self.choices.multiple {
            true => surface.lobe().albedo(surface.view, STEPS),
            false => 1.0,
        };
        let lit = self.lamps.iter().map(|lamp| {
            let (l, arriving) = lamp.arriving(place);
            if arriving == DVec3::ZERO {
                return DVec3::ZERO;
            }
            arriving * surface.reflected(l, self.choices, albedo)
        });
        surface.emitted() + lit.sum::<DVec3>()
    }

    /// The surface at a place, and its alpha; `None` if that is below the cutoff (3.9.4).
    fn surface(&self, hit: &Hit, view: DVec3) -> (Surface, Option<f64>) {
        let triangle = &self.triangles[hit.triangle];
        let material = &self.document["materials"][triangle.material];
        let at = Place { scene: self, hit, corners: &triangle.corners };
        let base = self.base(&at, material);
        let mut surface = at.bare_surface(material, view);
        surface.base = base.truncate();
        surface.is_unlit = !material["extensions"]["KHR_materials_unlit"].is_null();
        at.set_factors(material, &mut surface);
        at.set_extensions(&material["extensions"], &mut surface);
        let alpha = match material["alphaMode"].as_str() {
            Some("MASK") => (base.w >= number(material, "alphaCutoff", 0.5)).then_some(1.0),
            Some("BLEND") => Some(base.w),
            _ => Some(1.0),
        };
        (surface, alpha)
    }

    /// 3.9.2: the base colour is the product of the factor, the texture and the vertex colour.
    fn base(&self, at: &Place<'_, '_>, material: &Value) -> DVec4 {
        let gloss = &material["extensions"]["KHR_materials_pbrSpecularGlossiness"];
        let (own, names) = match gloss.is_null() {
            true => (&material["pbrMetallicRoughness"], ["baseColorFactor", "baseColorTexture"]),
            false => (gloss, ["diffuseFactor", "diffuseTexture"]),
        };
        let factor = vector4(own, names[0]);
        let color = at.mean(|corner| corner.color);
        factor * at.texel(&own[names[1]], true) * color
    }
}

/// A place on a triangle.
struct Place<'s, 'm> {
    scene: &'s Scene<'m>,
    hit: &'s Hit,
    corners: &'s [Corner; 3],
}

impl Place<'_, '_> {
    fn mean<T: std::ops::Mul<f64, Output = T> + std::iter::Sum>(
        &self,
        of: impl Fn(&Corner) -> T,
    ) -> T {
        self.corners.iter().zip(self.hit.shares).map(|(corner, share)| of(corner) * share).sum()
    }

    /// The texel of a texture of the document; white where there is none (3.9.2).
    fn texel(&self, info: &Value, is_color: bool) -> DVec4 {
        let Some(index) = index_at(info, "/index") else { return DVec4::ONE };
        let uv = placed(info, [0, 1].map(|set| self.mean(|corner| corner.uv[set])), true);
        let texture = &self.scene.document["textures"][index];
        // EXT_texture_webp: its image is taken where it can be read, `source` otherwise.
        let source = index_at(texture, "/extensions/EXT_texture_webp/source");
        let source = source.or(index_at(texture, "/source")).expect("an image");
        let image = &self.scene.images[source];
        let sampler = index_at(texture, "/sampler").map(|at| &self.scene.document["samplers"][at]);
        image.sample(uv, sampler.unwrap_or(&Value::Null), is_color)
    }

    /// The normals and tangents. A back has them turned round (3.9.5), the tangent with its bitangent, as
    /// in the glTF Sample Renderer (`getNormalInfo`).
    fn bare_surface(&self, material: &Value, view: DVec3) -> Surface {
        let side = if self.hit.is_front { 1.0 } else { -1.0 };
        let normal = self.mean(|corner| corner.normal).normalize();
        let tangent = self.mean(|corner| corner.tangent.truncate()).normalize_or_zero();
        let bitangent =
            self.mean(|corner| corner.normal.cross(corner.tangent.truncate()) * corner.tangent.w);
        let [normal, tangent, bitangent] =
            [normal, tangent, bitangent.normalize_or_zero()].map(|vector| vector * side);
        let mut bent = normal;
        let map = &material["normalTexture"];
        if !map.is_null() {
            // 3.9.3: the texel scaled, then normalised.
            let scale = number(map, "scale", 1.0);
            let texel = self.texel(map, false).truncate() * 2.0 - 1.0;
            let texel = (texel * DVec3::new(scale, scale, 1.0)).normalize();
            bent = (tangent * texel.x + bitangent * texel.y + normal * texel.z).normalize();
        }
        Surface { normal: bent, plain_normal: normal, tangent, bitangent, view, ..plain() }
    }

    /// 3.9.2 and 3.9.3, with KHR_materials_emissive_strength.
    fn set_factors(&self, material: &Value, surface: &mut Surface) {
        let own = &material["pbrMetallicRoughness"];
        let map = self.texel(&own["metallicRoughnessTexture"], false);
        surface.metallic = number(own, "metallicFactor", 1.0) * map.z;
        surface.roughness = number(own, "roughnessFactor", 1.0) * map.y;
        let strength = number(
            &material["extensions"]["KHR_materials_emissive_strength"],
            "emissiveStrength",
            1.0,
        );
        let texel = self.texel(&material["emissiveTexture"], true).truncate();
        surface.emission = vector3(material, "emissiveFactor", 0.0) * texel * strength;
    }

    fn set_extensions(&self, all: &Value, surface: &mut Surface) {
        let texel = |own: &Value, name: &str, is_color| self.texel(&own[name], is_color);
        let gloss = &all["KHR_materials_pbrSpecularGlossiness"];
        if !gloss.is_null() {
            self.set_gloss(gloss, surface);
        }
        surface.ior = number(&all["KHR_materials_ior"], "ior", surface.ior);
        let own = &all["KHR_materials_specular"];
        if !own.is_null() {
            surface.specular =
                number(own, "specularFactor", 1.0) * texel(own, "specularTexture", false).w;
            let map = texel(own, "specularColorTexture", true).truncate();
            surface.specular_color = vector3(own, "specularColorFactor", 1.0) * map;
        }
        let own = &all["KHR_materials_clearcoat"];
        surface.clearcoat =
            number(own, "clearcoatFactor", 0.0) * texel(own, "clearcoatTexture", false).x;
        surface.clearcoat_roughness = number(own, "clearcoatRoughnessFactor", 0.0)
            * texel(own, "clearcoatRoughnessTexture", false).y;
        let own = &all["KHR_materials_sheen"];
        surface.sheen_color = vector3(own, "sheenColorFactor", 0.0)
            * texel(own, "sheenColorTexture", true).truncate();
        surface.sheen_roughness =
            number(own, "sheenRoughnessFactor", 0.0) * texel(own, "sheenRoughnessTexture", false).w;
        self.set_anisotropy(&all["KHR_materials_anisotropy"], surface);
        let own = &all["KHR_materials_iridescence"];
        surface.iridescence =
            number(own, "iridescenceFactor", 0.0) * texel(own, "iridescenceTexture", false).x;
        surface.film_ior = number(own, "iridescenceIor", 1.3);
        let (low, high) = (
            number(own, "iridescenceThicknessMinimum", 100.0),
            number(own, "iridescenceThicknessMaximum", 400.0),
        );
        surface.film_thickness =
            low + (high - low) * texel(own, "iridescenceThicknessTexture", false).y;
        let own = &all["KHR_materials_transmission"];
        surface.transmission =
            number(own, "transmissionFactor", 0.0) * texel(own, "transmissionTexture", false).x;
        let own = &all["KHR_materials_diffuse_transmission"];
        surface.diffuse_transmission = number(own, "diffuseTransmissionFactor", 0.0)
            * texel(own, "diffuseTransmissionTexture", false).w;
        surface.diffuse_transmission_color = vector3(own, "diffuseTransmissionColorFactor", 1.0)
            * texel(own, "diffuseTransmissionColorTexture", true).truncate();
        let own = &all["KHR_materials_volume"];
        surface.thickness =
            number(own, "thicknessFactor", 0.0) * texel(own, "thicknessTexture", false).y;
        surface.attenuation_color = vector3(own, "attenuationColor", 1.0);
        surface.attenuation_distance = number(own, "attenuationDistance", f64::INFINITY);
    }

    /// KHR_materials_pbrSpecularGlossiness by the conversion of KHR_materials_specular.
    fn set_gloss(&self, own: &Value, surface: &mut Surface) {
        let map = self.texel(&own["specularGlossinessTexture"], true);
        surface.metallic = 0.0;
        surface.ior = 0.0;
        surface.specular_color = vector3(own, "specularFactor", 1.0) * map.truncate();
        surface.roughness = 1.0 - number(own, "glossinessFactor", 1.0) * map.w;
    }

    /// KHR_materials_anisotropy: the texture has the direction and a factor of the strength.
    fn set_anisotropy(&self, own: &Value, surface: &mut Surface) {
        surface.anisotropy = number(own, "anisotropyStrength", 0.0);
        let (sine, cosine) = number(own, "anisotropyRotation", 0.0).sin_cos();
        let mut way = DVec2::X;
        if !own["anisotropyTexture"].is_null() {
            let map = self.texel(&own["anisotropyTexture"], false);
            surface.anisotropy *= map.z;
            way = (map.truncate().xy() * 2.0 - 1.0).normalize();
        }
        surface.brush = [cosine * way.x - sine * way.y, sine * way.x + cosine * way.y];
    }
}

fn plain() -> Surface {
    Surface {
        normal: DVec3::Z,
        plain_normal: DVec3::Z,
        tangent: DVec3::X,
        bitangent: DVec3::Y,
        view: DVec3::Z,
        base: DVec3::ONE,
        metallic: 1.0,
        roughness: 1.0,
        ior: 1.5,
        specular: 1.0,
        specular_color: DVec3::ONE,
        emission: DVec3::ZERO,
        clearcoat: 0.0,
        clearcoat_roughness: 0.0,
        sheen_color: DVec3::ZERO,
        sheen_roughness: 0.0,
        anisotropy: 0.0,
        brush: [1.0, 0.0],
        iridescence: 0.0,
        film_ior: 1.3,
        film_thickness: 0.0,
        transmission: 0.0,
        diffuse_transmission: 0.0,
        diffuse_transmission_color: DVec3::ONE,
        thickness: 0.0,
        attenuation_color: DVec3::ONE,
        attenuation_distance: f64::INFINITY,
        is_unlit: false,
    }
}

impl Lamp {
    /// KHR_lights_punctual: the unit direction towards the lamp, and what it gives a surface that faces it,
    /// in lux.
    fn arriving(&self, place: DVec3) -> (DVec3, DVec3) {
        let light = &self.light;
        let strength = vector3(light, "color", 1.0) * number(light, "intensity", 1.0);
        let axis = self.world.transform_vector3(DVec3::NEG_Z).normalize();
        if light["type"] == "directional" {
            return (-axis, strength);
        }
        let offset = self.world.transform_point3(DVec3::ZERO) - place;
        let (d, l) = (offset.length(), offset.normalize());
        let window = match light["range"].as_f64() {
            Some(range) => (1.0 - (d / range).powi(4)).clamp(0.0, 1.0),
            None => 1.0,
        };
        let mut share = window / (d * d);
        if light["type"] == "spot" {
            let spot = &light["spot"];
            let inner = number(spot, "innerConeAngle", 0.0).cos();
            let outer = number(spot, "outerConeAngle", std::f64::consts::FRAC_PI_4).cos();
            let scale = 1.0 / (inner - outer).max(0.001);
            let ramp = (axis.dot(-l) * scale - outer * scale).clamp(0.0, 1.0);
            share *= ramp * ramp;
        }
        (l, strength * share)
    }
}

impl Pixels {
    /// 3.8.4 and OpenGL ES 3.2, 8.14: the texel nearest to a place, or what is between four of them. Colours are
    /// linear before that.
    fn sample(&self, uv: DVec2, sampler: &Value, is_color: bool) -> DVec4 {
        let at = uv * DVec2::new(self.width as f64, self.height as f64);
        let wrap = |name: &str, place: f64, size: usize| {
            let (place, size) = (place as i64, size as i64);
            let found = match sampler[name].as_u64() {
                Some(33071) => place.clamp(0, size - 1),
                Some(33648) => {
                    let turned = place.rem_euclid(2 * size);
                    if turned < size { turned } else { 2 * size - 1 - turned }
                }
                _ => place.rem_euclid(size),
            };
            found as usize
        };
        let texel = |x: f64, y: f64| {
            let (x, y) = (wrap("wrapS", x, self.width), wrap("wrapT", y, self.height));
            let [r, g, b, a] = self.texels[y * self.width + x].map(|byte| f64::from(byte) / 255.0);
            let linear = |c: f64| match is_color {
                true if c <= 0.04045 => c / 12.92,
                true => ((c + 0.055) / 1.055).powf(2.4),
                false => c,
            };
            DVec4::new(linear(r), linear(g), linear(b), a)
        };
        if sampler["magFilter"] == 9728 {
            return texel(at.x.floor(), at.y.floor());
        }
        let low = (at - 0.5).floor();
        let share = at - 0.5 - low;
        let upper = texel(low.x, low.y).lerp(texel(low.x + 1.0, low.y), share.x);
        let lower = texel(low.x, low.y + 1.0).lerp(texel(low.x + 1.0, low.y + 1.0), share.x);
        upper.lerp(lower, share.y)
    }
}

/// The coordinates of a texture, of the two sets of a mesh. KHR_texture_transform: translation * rotation *
/// scale.
fn placed(info: &Value, sets: [DVec2; 2], is_transformed: bool) -> DVec2 {
    let transform = &info["extensions"]["KHR_texture_transform"];
    let set = index_at(transform, "/texCoord").or(index_at(info, "/texCoord")).unwrap_or(0);
    if !is_transformed {
        return sets[set];
    }
    let pair = |name: &str, usual: f64| {
        let list = transform[name].as_array();
        list.map_or(DVec2::splat(usual), |list| {
            DVec2::new(list[0].as_f64().unwrap_or(0.0), list[1].as_f64().unwrap_or(0.0))
        })
    };
    let uv = sets[set] * pair("scale", 1.0);
    let (sine, cosine) = number(transform, "rotation", 0.0).sin_cos();
    let turned = DVec2::new(cosine * uv.x + sine * uv.y, cosine * uv.y - sine * uv.x);
    turned + pair("offset", 0.0)
}

/// The triangles of a mesh in the world. Normals that are absent are those of the faces, and then tangents
/// that are given count for nothing (3.7.2.1). Tangents that are absent are those of MikkTSpace, with the
/// coordinates of the normal map.
fn triangles(drawn: &Drawn, document: &Value, choices: Choices) -> Vec<Triangle> {
    let (mesh, linear) = (&drawn.mesh, DMat3::from_mat4(drawn.world));
    let of_normals = linear.inverse().transpose();
    let is_mirrored = linear.determinant() < 0.0;
    // The bitangent is transformed with the mesh, so a mirror turns its sign.
    let sign = if is_mirrored { -1.0 } else { 1.0 };
    let list = mesh.indices.clone().unwrap_or_else(|| (0..mesh.positions.len() as u32).collect());
    let threes: Vec<[usize; 3]> =
        list.chunks_exact(3).map(|three| [0, 1, 2].map(|at| three[at] as usize)).collect();
    let map = &document["materials"][mesh.material]["normalTexture"];
    let of_map = |at: usize| placed(map, sets(mesh, at), choices.transformed_tangents);
    let faces: Vec<Face> = threes.iter().map(|three| face(mesh, *three, of_map)).collect();
    let tangents = match mesh.tangents.as_ref().filter(|_| mesh.normals.is_some()) {
        Some(rows) => threes.iter().map(|three| three.map(|at| wide4(rows[at]))).collect(),
        None => tangents(&faces),
    };
    let triangle = |((face, tangents), three): ((&Face, [DVec4; 3]), &[usize; 3])| {
        let mut corners = [0, 1, 2].map(|corner| Corner {
            position: drawn.world.transform_point3(face[corner].position),
            normal: (of_normals * face[corner].normal).normalize_or_zero(),
            tangent: (linear * tangents[corner].truncate())
                .normalize_or_zero()
                .extend(sign * tangents[corner].w),
            uv: sets(mesh, three[corner]),
            color: mesh.colors.as_ref().map_or(DVec4::ONE, |rows| wide4(rows[three[corner]])),
        });
        // 3.7.4: a mirror turns the winding.
        if is_mirrored {
            corners.swap(1, 2);
        }
        Triangle { corners, material: mesh.material }
    };
    faces.iter().zip(tangents).zip(&threes).map(triangle).collect()
}

fn wide4(row: [f32; 4]) -> DVec4 {
    DVec4::from_array(row.map(f64::from))
}

/// Both sets of coordinates of a vertex.
fn sets(mesh: &Mesh, at: usize) -> [DVec2; 2] {
    let set = |rows: &Option<Vec<[f32; 2]>>| {
        rows.as_ref().map_or(DVec2::ZERO, |rows| DVec2::from_array(rows[at].map(f64::from)))
    };
    [set(&mesh.uvs[0]), set(&mesh.uvs[1])]
}

/// A face in the space of its mesh, with the coordinates of its normal map.
fn face(mesh: &Mesh, three: [usize; 3], uv: impl Fn(usize) -> DVec2) -> Face {
    let vector = |v: [f32; 3]| DVec3::from_array(v.map(f64::from));
    let mut face = three.map(|at| {
        let normal = mesh.normals.as_ref().map_or(DVec3::ZERO, |rows| vector(rows[at]).normalize());
        Vertex { position: vector(mesh.positions[at]), normal, uv: uv(at) }
    });
    if mesh.normals.is_none() {
        let [a, b, c] = face.map(|vertex| vertex.position);
        face.iter_mut().for_each(|vertex| vertex.normal = (b - a).cross(c - a).normalize());
    }
    face
}

/// All nodes of the scene with their places in the world.
fn nodes(document: &Value) -> Vec<(DMat4, &Value)> {
    let mut found = Vec::new();
    let list = |value: &Value| -> Vec<usize> {
        let all = value.as_array().into_iter().flatten();
        all.filter_map(Value::as_u64).map(|index| index as usize).collect()
    };
    let mut open: Vec<(DMat4, usize)> =
        list(&document["scenes"][0]["nodes"]).into_iter().map(|at| (DMat4::IDENTITY, at)).collect();
    while let Some((parent, index)) = open.pop() {
        let node = &document["nodes"][index];
        let world = parent * local(node);
        open.extend(list(&node["children"]).into_iter().map(|child| (world, child)));
        found.push((world, node));
    }
    found
}

fn index_at(value: &Value, pointer: &str) -> Option<usize> {
    value.pointer(pointer).and_then(Value::as_u64).map(|index| index as usize)
}

fn number(value: &Value, name: &str, usual: f64) -> f64 {
    value[name].as_f64().unwrap_or(usual)
}

fn vector3(value: &Value, name: &str, usual: f64) -> DVec3 {
    let list = value[name].as_array();
    list.map_or(DVec3::splat(usual), |list| {
        DVec3::from_array([0, 1, 2].map(|at| list[at].as_f64().unwrap_or(usual)))
    })
}

fn vector4(value: &Value, name: &str) -> DVec4 {
    let list = value[name].as_array();
    list.map_or(DVec4::ONE, |list| {
        DVec4::from_array([0, 1, 2, 3].map(|at| list[at].as_f64().unwrap_or(1.0)))
    })
}
