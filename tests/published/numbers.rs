//! What a listing is given: the numbers of its uniforms by their paths, and its textures by their
//! names, as they were bound for a picture.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DMat3, DMat4, DVec3};
use lamplight::bundle::{Binding, BindingKind, Member};
use lamplight::execute::fixture::{Fixture, FixtureTexture};
use lamplight::execute::frame::Buffers;
use lamplight::picture::PreparedPass;

/// The uniforms and textures of one object of a picture.
pub struct Given {
    numbers: BTreeMap<String, Vec<f64>>,
    textures: BTreeMap<String, Arc<Fixture>>,
}

impl Given {
    /// What an object is drawn with: `own` has its buffers, and `view` those of the viewer.
    pub fn of(prepared: &PreparedPass, own: &Buffers, view: &Buffers) -> Self {
        let stages = [Some(&prepared.stages.vertex), prepared.stages.fragment.as_ref()];
        let mut given = Self { numbers: BTreeMap::new(), textures: BTreeMap::new() };
        for binding in stages.into_iter().flatten().flat_map(|stage| &stage.reflection.bindings) {
            let place = (binding.group, binding.binding);
            let bytes = [own, view, &prepared.buffers].into_iter().find_map(|one| one.get(&place));
            match (binding.kind, bytes) {
                (BindingKind::Uniform, Some(bytes)) => given.add_block(binding, bytes),
                _ => {
                    let fixture = prepared.fixtures.get(&place).cloned();
                    given.textures.extend(fixture.map(|one| (binding.name.clone(), one)));
                }
            }
        }
        given
    }

    fn add_block(&mut self, binding: &Binding, bytes: &[u8]) {
        for member in &binding.members {
            self.add_member(&format!("{}.{}", binding.name, member.name), member, 0, bytes);
        }
    }

    fn add_member(&mut self, path: &str, member: &Member, base: u32, bytes: &[u8]) {
        let at = base + member.offset;
        match member.stride.filter(|stride| *stride > 0 && member.ty.starts_with("array")) {
            Some(stride) => {
                for index in 0..member.size / stride {
                    let path = format!("{path}[{index}]");
                    let one = Member { offset: 0, size: stride, stride: None, ..member.clone() };
                    self.add_one(&path, &one, at + index * stride, bytes);
                }
            }
            None => self.add_one(path, member, at, bytes),
        }
    }

    fn add_one(&mut self, path: &str, member: &Member, at: u32, bytes: &[u8]) {
        for part in &member.members {
            self.add_member(&format!("{path}.{}", part.name), part, at, bytes);
        }
        if member.members.is_empty() {
            let is_integer = matches!(member.ty.as_str(), "u32" | "i32");
            let words = bytes.get(at as usize..(at + member.size) as usize).unwrap_or_default();
            let number = |word: &[u8]| {
                let word = u32::from_le_bytes(word.try_into().unwrap_or_default());
                if is_integer { f64::from(word) } else { f64::from(f32::from_bits(word)) }
            };
            self.numbers.insert(path.to_owned(), words.chunks_exact(4).map(number).collect());
        }
    }

    fn found(&self, path: &str) -> &[f64] {
        self.numbers.get(path).map_or(&[], Vec::as_slice)
    }

    /// A scalar.
    pub fn number(&self, path: &str) -> f64 {
        self.found(path).first().copied().unwrap_or(f64::NAN)
    }

    /// A vector of three.
    pub fn vector(&self, path: &str) -> DVec3 {
        self.found(path).first_chunk().map_or(DVec3::NAN, |three| DVec3::from_array(*three))
    }

    /// A matrix of four columns.
    pub fn matrix(&self, path: &str) -> DMat4 {
        self.found(path).first_chunk().map_or(DMat4::NAN, DMat4::from_cols_array)
    }

    /// From the object to the world.
    pub fn model(&self) -> DMat4 {
        self.matrix("object.world_from_object")
    }

    /// From the world to the viewer.
    pub fn view(&self) -> DMat4 {
        self.matrix("camera.world_from_view").inverse()
    }

    /// The inverse transpose of the upper part of a matrix.
    pub fn normal_matrix(matrix: DMat4) -> DMat3 {
        DMat3::from_mat4(matrix).inverse().transpose()
    }

    /// A number of a lamp.
    pub fn lamp(&self, index: usize, field: &str) -> f64 {
        self.number(&format!("lamps.lights[{index}].light.{field}"))
    }

    /// A vector of a lamp.
    pub fn lamp_vector(&self, index: usize, field: &str) -> DVec3 {
        self.vector(&format!("lamps.lights[{index}].light.{field}"))
    }

    /// How many lamps shine.
    pub fn lamps(&self) -> usize {
        self.number("lamps.count") as usize
    }

    pub fn texture(&self, name: &str) -> Option<&FixtureTexture> {
        match self.textures.get(name).map(Arc::as_ref) {
            Some(Fixture::Texture(texture)) => Some(texture),
            _ => None,
        }
    }
}
