//! Translates a reflection to wgpu's descriptors.

use std::collections::BTreeMap;
use std::num::NonZeroU64;

use lamplight::bundle::{Binding, BindingKind, Reflection, Stage, Varying};

/// Fills the gaps between the bindings of a group with bindings that no stage can see.
pub fn fill(group: &mut BTreeMap<u32, wgpu::BindGroupLayoutEntry>) {
    let last = group.last_key_value().map_or(0, |(binding, _)| *binding);
    for binding in 0..last {
        let ty = wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering);
        let unseen = wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::NONE,
            ty,
            count: None,
        };
        group.entry(binding).or_insert(unseen);
    }
}

pub fn entry(
    binding: &Binding,
    reflection: &Reflection,
) -> Result<wgpu::BindGroupLayoutEntry, String> {
    let place = [binding.group, binding.binding];
    let ty = match binding.kind {
        BindingKind::Uniform => wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: binding.size.and_then(|size| NonZeroU64::new(size.into())),
        },
        BindingKind::Sampler if filters_depth(place, reflection) => {
            wgpu::BindingType::Sampler(wgpu::SamplerBindingType::NonFiltering)
        }
        BindingKind::Sampler => wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
        BindingKind::ComparisonSampler => {
            wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Comparison)
        }
        BindingKind::Texture => texture(binding)?,
        BindingKind::Storage | BindingKind::StorageTexture | BindingKind::Immediate => {
            let what = "which this test does not expect in the library";
            return Err(format!("`{}` is a {:?}, {what}", binding.name, binding.kind));
        }
    };
    let visibility = match reflection.stage {
        Stage::Vertex => wgpu::ShaderStages::VERTEX,
        Stage::Fragment => wgpu::ShaderStages::FRAGMENT,
        Stage::Compute => wgpu::ShaderStages::COMPUTE,
    };
    Ok(wgpu::BindGroupLayoutEntry { binding: binding.binding, visibility, ty, count: None })
}

/// Whether the sampler reads a depth texture without comparing. wgpu does not allow filtering then.
fn filters_depth(sampler: [u32; 2], reflection: &Reflection) -> bool {
    let is_depth = |place: [u32; 2]| {
        reflection.bindings.iter().any(|binding| {
            [binding.group, binding.binding] == place && binding.ty.starts_with("texture_depth")
        })
    };
    reflection.pairs.iter().any(|pair| pair.sampler == sampler && is_depth(pair.texture))
}

fn texture(binding: &Binding) -> Result<wgpu::BindingType, String> {
    use wgpu::TextureViewDimension::{Cube, CubeArray, D2, D2Array, D3};
    let float = wgpu::TextureSampleType::Float { filterable: true };
    let (sample_type, view_dimension) = match binding.ty.as_str() {
        "texture_2d<f32>" => (float, D2),
        "texture_2d_array<f32>" => (float, D2Array),
        "texture_cube<f32>" => (float, Cube),
        "texture_3d<f32>" => (float, D3),
        "texture_depth_2d" => (wgpu::TextureSampleType::Depth, D2),
        "texture_depth_2d_array" => (wgpu::TextureSampleType::Depth, D2Array),
        "texture_depth_cube" => (wgpu::TextureSampleType::Depth, Cube),
        "texture_depth_cube_array" => (wgpu::TextureSampleType::Depth, CubeArray),
        other => return Err(format!("`{}` has the unknown type `{other}`", binding.name)),
    };
    Ok(wgpu::BindingType::Texture { sample_type, view_dimension, multisampled: false })
}

/// One interleaved buffer with an attribute for each location.
pub fn attributes(inputs: &[Varying]) -> Result<Vec<wgpu::VertexAttribute>, String> {
    let mut offset = 0;
    let mut attributes = Vec::new();
    for input in inputs {
        let Some(shader_location) = input.location else { continue };
        let format = match input.ty.as_str() {
            "f32" => wgpu::VertexFormat::Float32,
            "vec2<f32>" => wgpu::VertexFormat::Float32x2,
            "vec3<f32>" => wgpu::VertexFormat::Float32x3,
            "vec4<f32>" => wgpu::VertexFormat::Float32x4,
            "u32" => wgpu::VertexFormat::Uint32,
            "i32" => wgpu::VertexFormat::Sint32,
            other => return Err(format!("a vertex input has the unknown type `{other}`")),
        };
        attributes.push(wgpu::VertexAttribute { format, offset, shader_location });
        offset += format.size();
    }
    Ok(attributes)
}

pub fn targets(outputs: &[Varying]) -> Result<Vec<Option<wgpu::ColorTargetState>>, String> {
    let mut targets = Vec::new();
    for output in outputs {
        let Some(location) = output.location else { continue };
        let format = match output.ty.as_str() {
            "f32" => wgpu::TextureFormat::R8Unorm,
            "vec2<f32>" => wgpu::TextureFormat::Rg8Unorm,
            "vec4<f32>" => wgpu::TextureFormat::Rgba8Unorm,
            other => return Err(format!("a fragment output has the unknown type `{other}`")),
        };
        targets.resize(location as usize, None);
        targets.push(Some(format.into()));
    }
    Ok(targets)
}

/// A depth buffer, as in most engines.
pub fn depth() -> wgpu::DepthStencilState {
    wgpu::DepthStencilState {
        format: wgpu::TextureFormat::Depth32Float,
        depth_write_enabled: Some(true),
        depth_compare: Some(wgpu::CompareFunction::LessEqual),
        stencil: Default::default(),
        bias: Default::default(),
    }
}
