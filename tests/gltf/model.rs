//! Models that the tests make: a document and a buffer, and beside it what is drawn, for the reference.

use glam::{DMat4, DQuat, DVec3};
use serde_json::{Value, json};

/// Triangles of a material. Everything is given for each vertex.
#[derive(Debug, Clone, Default)]
pub struct Mesh {
    pub positions: Vec<[f32; 3]>,
    pub indices: Option<Vec<u32>>,
    pub normals: Option<Vec<[f32; 3]>>,
    pub tangents: Option<Vec<[f32; 4]>>,
    pub uvs: [Option<Vec<[f32; 2]>>; 2],
    pub colors: Option<Vec<[f32; 4]>>,
    pub material: usize,
}

/// A mesh in its place.
#[derive(Debug, Clone)]
pub struct Drawn {
    pub mesh: Mesh,
    pub world: DMat4,
}

/// Pixels of an image, each of 8 bits, from the upper left.
#[derive(Debug, Clone)]
pub struct Pixels {
    pub width: usize,
    pub height: usize,
    pub texels: Vec<[u8; 4]>,
}

/// A model that is being made.
pub struct Model {
    pub document: Value,
    pub buffer: Vec<u8>,
    pub drawn: Vec<Drawn>,
    pub images: Vec<Pixels>,
}

/// The triangle that fills the picture, seen from the front by the camera of [`Model::new`].
const CORNERS: [[f32; 3]; 3] =
    [[-HALF, -HALF, 0.0], [3.0 * HALF, -HALF, 0.0], [-HALF, 3.0 * HALF, 0.0]];

impl Mesh {
    /// The triangle with normals that lean outwards by `bulge` for each unit, so that the picture has many
    /// angles, and coordinates from 0 to 1 from left to right and from top to bottom of the picture.
    pub fn bulging(bulge: f32) -> Self {
        let normal = |[x, y, _]: [f32; 3]| {
            let n = glam::Vec3::new(bulge * x, bulge * y, 1.0).normalize();
            n.to_array()
        };
        let uv = |[x, y, _]: [f32; 3]| [0.5 + 0.5 * x / HALF, 0.5 - 0.5 * y / HALF];
        Self {
            positions: CORNERS.to_vec(),
            normals: Some(CORNERS.map(normal).to_vec()),
            uvs: [Some(CORNERS.map(uv).to_vec()), None],
            ..Self::default()
        }
    }

    /// With its back to the viewer.
    pub fn turned(mut self) -> Self {
        self.indices = Some(vec![0, 2, 1]);
        for normal in self.normals.iter_mut().flatten() {
            *normal = normal.map(|part| -part);
        }
        self
    }

    /// With the tangent of the coordinates at each vertex.
    pub fn with_tangents(mut self) -> Self {
        let normals = self.normals.clone().unwrap_or_default();
        let tangent = |n: &[f32; 3]| {
            let n = glam::Vec3::from_array(*n);
            (glam::Vec3::X - n * n.x).normalize().extend(n.z.signum()).to_array()
        };
        self.tangents = Some(normals.iter().map(tangent).collect());
        self
    }
}

/// Half of the height that the camera sees at the origin.
pub const HALF: f32 = 0.928_008_8;
/// Its whole angle.
pub const ANGLE: f64 = 0.6;
/// Its distance.
pub const DISTANCE: f64 = 3.0;

impl Model {
    /// A camera before the origin.
    pub fn new() -> Self {
        let document = json!({
            "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [0] }],
            "nodes": [{ "camera": 0, "translation": [0.0, 0.0, DISTANCE] }],
            "cameras": [{ "type": "perspective",
                "perspective": { "yfov": ANGLE, "aspectRatio": 1.0, "znear": 0.1, "zfar": 100.0 } }],
            "materials": [], "meshes": [], "accessors": [], "bufferViews": [],
        });
        Self { document, buffer: Vec::new(), drawn: Vec::new(), images: Vec::new() }
    }

    /// A model of one mesh with one material, and the usual lamps.
    pub fn of(mesh: Mesh, material: Value) -> Self {
        let mut model = Self::new();
        model.add_material(material);
        model.add(mesh, json!({}));
        model.add_usual_lamps();
        model
    }

    fn list(&mut self, name: &str) -> &mut Vec<Value> {
        let list = &mut self.document[name];
        if list.is_null() {
            *list = json!([]);
        }
        list.as_array_mut().expect("a list")
    }

    /// Adds to a list of the document. The result is its number.
    pub fn push(&mut self, name: &str, value: Value) -> usize {
        let list = self.list(name);
        list.push(value);
        list.len() - 1
    }

    pub fn add_material(&mut self, material: Value) -> usize {
        self.push("materials", material)
    }

    /// Adds a node to the scene.
    pub fn add_node(&mut self, node: Value) -> usize {
        let index = self.push("nodes", node);
        self.document["scenes"][0]["nodes"].as_array_mut().expect("nodes").push(json!(index));
        index
    }

    /// Adds bytes to the buffer.
    pub fn add_view(&mut self, bytes: &[u8]) -> usize {
        let start = self.buffer.len();
        self.buffer.extend(bytes);
        self.buffer.resize(self.buffer.len().next_multiple_of(4), 0);
        let view = json!({ "buffer": 0, "byteOffset": start, "byteLength": bytes.len() });
        self.push("bufferViews", view)
    }

    /// Adds an accessor of floats.
    pub fn add_floats<const N: usize>(&mut self, rows: &[[f32; N]]) -> usize {
        let bytes: Vec<u8> = rows.iter().flatten().flat_map(|part| part.to_le_bytes()).collect();
        let view = self.add_view(&bytes);
        let kind = ["SCALAR", "VEC2", "VEC3", "VEC4"].get(N - 1).copied().unwrap_or("MAT4");
        self.push(
            "accessors",
            json!({ "bufferView": view, "componentType": 5126, "count": rows.len(), "type": kind }),
        )
    }

    /// Adds the attributes of a mesh to the document. The result is its number.
    pub fn add_mesh(&mut self, mesh: &Mesh) -> usize {
        let mut attributes = json!({ "POSITION": self.add_floats(&mesh.positions) });
        if let Some(rows) = &mesh.normals {
            attributes["NORMAL"] = json!(self.add_floats(rows));
        }
        if let Some(rows) = &mesh.tangents {
            attributes["TANGENT"] = json!(self.add_floats(rows));
        }
        for (set, rows) in mesh.uvs.iter().enumerate() {
            if let Some(rows) = rows {
                attributes[format!("TEXCOORD_{set}")] = json!(self.add_floats(rows));
            }
        }
        if let Some(rows) = &mesh.colors {
            attributes["COLOR_0"] = json!(self.add_floats(rows));
        }
        let mut primitive = json!({ "attributes": attributes, "material": mesh.material });
        if let Some(indices) = &mesh.indices {
            let bytes: Vec<u8> = indices.iter().flat_map(|index| index.to_le_bytes()).collect();
            let view = self.add_view(&bytes);
            let accessor = json!({ "bufferView": view, "componentType": 5125,
                "count": indices.len(), "type": "SCALAR" });
            primitive["indices"] = json!(self.push("accessors", accessor));
        }
        self.push("meshes", json!({ "primitives": [primitive] }))
    }

    /// Adds a mesh at a node, whose place is in `node`.
    pub fn add(&mut self, mesh: Mesh, mut node: Value) {
        node["mesh"] = json!(self.add_mesh(&mesh));
        self.drawn.push(Drawn { mesh, world: local(&node) });
        self.add_node(node);
    }

    /// Adds a lamp at a node.
    pub fn add_lamp(&mut self, light: Value, mut node: Value) {
        let lights = &mut self.document["extensions"]["KHR_lights_punctual"]["lights"];
        if lights.is_null() {
            *lights = json!([]);
        }
        let lights = lights.as_array_mut().expect("lights");
        lights.push(light);
        node["extensions"] = json!({ "KHR_lights_punctual": { "light": lights.len() - 1 } });
        self.add_node(node);
    }

    /// A point lamp near the surface and a dimmer lamp of one direction.
    pub fn add_usual_lamps(&mut self) {
        let near = json!({ "type": "point", "color": [1.0, 0.9, 0.8], "intensity": 6.0 });
        self.add_lamp(near, json!({ "translation": [0.7, 0.8, 1.3] }));
        let far = json!({ "type": "directional", "color": [0.6, 0.8, 1.0], "intensity": 1.2 });
        self.add_lamp(far, json!({ "rotation": [-0.2, -0.5, 0.0, 0.842_614_977] }));
    }

    /// Adds an image. The result is its number.
    fn add_image(&mut self, pixels: Pixels, format: image::ImageFormat) -> usize {
        let texels = pixels.texels.concat();
        let image = image::RgbaImage::from_raw(pixels.width as u32, pixels.height as u32, texels);
        let mut file = std::io::Cursor::new(Vec::new());
        image.expect("whole rows").write_to(&mut file, format).expect("an image");
        let view = self.add_view(&file.into_inner());
        self.images.push(pixels);
        self.push("images", json!({ "bufferView": view, "mimeType": format.to_mime_type() }))
    }

    /// Adds an image with a sampler. The result is the number of the texture.
    pub fn add_texture(&mut self, pixels: Pixels, sampler: Value) -> usize {
        let image = self.add_image(pixels, image::ImageFormat::Png);
        let sampler = self.push("samplers", sampler);
        self.push("textures", json!({ "source": image, "sampler": sampler }))
    }

    /// Adds a texture with two images: a lossless WebP, and another for readers without EXT_texture_webp.
    pub fn add_webp_texture(&mut self, pixels: Pixels, other: Pixels) -> usize {
        let [other, own] = [(other, image::ImageFormat::Png), (pixels, image::ImageFormat::WebP)]
            .map(|(pixels, format)| self.add_image(pixels, format));
        self.document["extensionsUsed"] = json!(["EXT_texture_webp"]);
        let extensions = json!({ "EXT_texture_webp": { "source": own } });
        self.push("textures", json!({ "source": other, "extensions": extensions }))
    }

    /// The binary file.
    pub fn glb(&self) -> Vec<u8> {
        let mut document = self.document.clone();
        for name in ["materials", "meshes", "accessors", "bufferViews"] {
            if document[name].as_array().is_some_and(Vec::is_empty) {
                document.as_object_mut().expect("an object").remove(name);
            }
        }
        document["buffers"] = json!([{ "byteLength": self.buffer.len() }]);
        let mut text = document.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let chunk =
            |kind: &[u8], bytes: &[u8]| [&(bytes.len() as u32).to_le_bytes(), kind, bytes].concat();
        let body = [chunk(b"JSON", &text), chunk(b"BIN\0", &self.buffer)].concat();
        let length = (body.len() as u32 + 12).to_le_bytes();
        [b"glTF".as_slice(), &2_u32.to_le_bytes(), &length, &body].concat()
    }
}

/// From the space of a node to that of its parent (glTF 2.0, 3.5.3).
pub fn local(node: &Value) -> DMat4 {
    let numbers = |name: &str| -> Option<Vec<f64>> {
        node.get(name)?.as_array()?.iter().map(Value::as_f64).collect()
    };
    if let Some(matrix) = numbers("matrix") {
        return DMat4::from_cols_array(&matrix.try_into().expect("16 numbers"));
    }
    let vector = |name: &str, usual: f64| {
        numbers(name).map_or(DVec3::splat(usual), |n| DVec3::new(n[0], n[1], n[2]))
    };
    let turn = numbers("rotation")
        .map_or(DQuat::IDENTITY, |n| DQuat::from_xyzw(n[0], n[1], n[2], n[3]).normalize());
    DMat4::from_translation(vector("translation", 0.0))
        * DMat4::from_quat(turn)
        * DMat4::from_scale(vector("scale", 1.0))
}
