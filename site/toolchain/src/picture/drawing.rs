//! A drawing in the form in which the page gets it.

use lamplight::bundle::{Conventions, Target};
use lamplight::diagnostic;
use lamplight_execute::fixture::{Fixture, FixtureSampler, FixtureTexture, TextureKind};
use lamplight_execute::frame::{self, Buffers, EntryPoint, Face, VertexFormat};
use lamplight_execute::shipped::Shipped;

use crate::linkers::LINKERS;

use super::exchange::{Attribute, Buffer, Drawing, Level, Mesh, SamplerInfo, Stage, TextureInfo};

/// A drawing with its shaders in a target.
pub fn described(
    drawing: &frame::Drawing<'_>,
    target: Target,
) -> Result<Drawing, diagnostic::Diagnostic> {
    let state = drawing.state;
    let (textures, samplers) = fixtures(drawing);
    Ok(Drawing {
        vertex: stage(drawing.vertex, target)?,
        fragment: drawing.fragment.map(|entry| stage(entry, target)).transpose()?,
        targets: drawing.targets,
        meshes: drawing.items.iter().map(mesh).collect(),
        views: drawing.views.iter().map(buffers).collect(),
        buffers: buffers(drawing.buffers),
        textures,
        samplers,
        width: drawing.size[0],
        height: drawing.size[1],
        depth_test: state.depth_test,
        keep_depth: state.keep_depth,
        cull: match state.cull {
            None => "none",
            Some(Face::Front) => "front",
            Some(Face::Back) => "back",
        }
        .to_owned(),
        mirrored: state.mirrored,
        offset: state.offset,
    })
}

fn stage(entry: EntryPoint<'_>, target: Target) -> Result<Stage, diagnostic::Diagnostic> {
    let Shipped { bytes, native, reflection, .. } = LINKERS.with_borrow_mut(|linkers| {
        let linker = linkers.of(&[target], Conventions::default());
        let made = Shipped::linked(entry, target, linker);
        linker.forget();
        made
    })?;
    Ok(Stage { text: String::from_utf8_lossy(&bytes).into_owned(), native, reflection })
}

fn mesh(item: &frame::DrawItem<'_>) -> Mesh {
    let bytes = |words: &[u32]| words.iter().flat_map(|word| word.to_le_bytes()).collect();
    let attribute = |(attribute, offset): (frame::VertexAttribute, u64)| Attribute {
        location: attribute.location,
        format: match attribute.format {
            VertexFormat::Uint32 => "uint32",
            VertexFormat::Uint32x2 => "uint32x2",
            VertexFormat::Uint32x3 => "uint32x3",
            VertexFormat::Uint32x4 => "uint32x4",
            VertexFormat::Sint32 => "sint32",
            VertexFormat::Sint32x2 => "sint32x2",
            VertexFormat::Sint32x3 => "sint32x3",
            VertexFormat::Sint32x4 => "sint32x4",
            VertexFormat::Float32 => "float32",
            VertexFormat::Float32x2 => "float32x2",
            VertexFormat::Float32x3 => "float32x3",
            VertexFormat::Float32x4 => "float32x4",
        }
        .to_owned(),
        offset: offset as u32,
    };
    Mesh {
        attributes: item.mesh.layout().into_iter().map(attribute).collect(),
        stride: item.mesh.stride() as u32,
        vertices: item.mesh.vertices(),
        words: bytes(&item.mesh.words),
        indices: bytes(&item.mesh.indices),
        buffers: buffers(item.buffers),
    }
}

fn buffers(buffers: &Buffers) -> Vec<Buffer> {
    let one = |((group, binding), bytes): (&(u32, u32), &Vec<u8>)| Buffer {
        group: *group,
        binding: *binding,
        bytes: bytes.clone(),
    };
    buffers.iter().map(one).collect()
}

fn fixtures(drawing: &frame::Drawing<'_>) -> (Vec<TextureInfo>, Vec<SamplerInfo>) {
    let (mut textures, mut samplers) = (Vec::new(), Vec::new());
    for (place, fixture) in drawing.fixtures {
        match &**fixture {
            Fixture::Texture(texture) => {
                let smaller = drawing.levels.get(place).map_or(&[][..], Vec::as_slice);
                let levels = std::iter::once(texture).chain(smaller).map(level);
                textures.push(TextureInfo {
                    group: place.0,
                    binding: place.1,
                    depth: texture.kind.is_depth(),
                    cube: matches!(texture.kind, TextureKind::DepthCube | TextureKind::ColorCube),
                    levels: levels.collect(),
                });
            }
            Fixture::Sampler(sampler) => samplers.push(sampling(*place, *sampler)),
        }
    }
    (textures, samplers)
}

fn level(texture: &FixtureTexture) -> Level {
    Level {
        width: texture.width,
        height: texture.height,
        bytes: texture.texels.iter().flat_map(|texel| texel.to_le_bytes()).collect(),
    }
}

fn sampling((group, binding): (u32, u32), sampler: FixtureSampler) -> SamplerInfo {
    let (address, compare) = sampler.web_words();
    SamplerInfo { group, binding, compare, linear: sampler.linear, address: address.to_owned() }
}
