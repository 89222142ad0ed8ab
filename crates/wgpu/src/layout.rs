//! Pipeline layouts.

use std::fmt;

use lamplight_bundle::{
    Access, Binding, BindingKind, LayoutBinding, SampleType, Stage, TextureShape,
};

/// Why a program has no pipeline layout.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum LayoutError {
    /// Permutations bind different things in this group and binding. Then each needs a layout of its
    /// own, from its reflection.
    Conflict(u32, u32),
    /// A binding has something that wgpu has not: its name, and what that is.
    Unknown(String, String),
    /// A binding is in a group of a number that no device has: its name, and the number.
    Group(String, u32),
}

impl fmt::Display for LayoutError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Conflict(group, binding) => {
                write!(f, "permutations bind different things in group {group} binding {binding}")
            }
            Self::Unknown(name, what) => write!(f, "wgpu has no `{what}`, which `{name}` needs"),
            Self::Group(name, group) => {
                write!(f, "no device has a group {group}, which `{name}` is in")
            }
        }
    }
}

impl std::error::Error for LayoutError {}

/// One layout for all permutations of a program.
#[derive(Debug, Clone)]
pub struct PipelineLayout {
    /// For `layout` of a pipeline.
    pub layout: wgpu::PipelineLayout,
    /// For bind groups: one for each group, of which those without bindings are empty.
    pub groups: Vec<wgpu::BindGroupLayout>,
}

/// Makes the layout of a program from what all of its permutations bind: `Program::layout`.
///
/// # Errors
/// Those of [`layout_entries`].
pub fn pipeline_layout(
    device: &wgpu::Device,
    layout: &[LayoutBinding],
) -> Result<PipelineLayout, LayoutError> {
    let make = |entries: &Vec<wgpu::BindGroupLayoutEntry>| {
        device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries })
    };
    let groups: Vec<wgpu::BindGroupLayout> = layout_entries(layout)?.iter().map(make).collect();
    let all: Vec<Option<&wgpu::BindGroupLayout>> = groups.iter().map(Some).collect();
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &all,
        immediate_size: immediate_size(layout),
    });
    Ok(PipelineLayout { layout, groups })
}

/// Bytes of the immediates of a program, a multiple of 4.
pub fn immediate_size(layout: &[LayoutBinding]) -> u32 {
    let immediates = layout.iter().filter(|found| found.binding.kind == BindingKind::Immediate);
    let sizes = immediates.filter_map(|found| found.binding.size);
    sizes.max().unwrap_or(0).next_multiple_of(4)
}

/// More groups than any device of wgpu has, so that no bundle asks for much memory.
const MOST_GROUPS: u32 = 64;

/// The entries of each group, by the number of the group.
///
/// # Errors
/// [`LayoutError::Conflict`] where two permutations bind different kinds of things in one place;
/// [`LayoutError::Unknown`] for a format or a dimension that wgpu does not have;
/// [`LayoutError::Group`] for a group that no device has.
pub fn layout_entries(
    layout: &[LayoutBinding],
) -> Result<Vec<Vec<wgpu::BindGroupLayoutEntry>>, LayoutError> {
    let mut groups: Vec<Vec<wgpu::BindGroupLayoutEntry>> = Vec::new();
    let bound = layout.iter().filter(|found| found.binding.kind != BindingKind::Immediate);
    for found in bound {
        let binding = &found.binding;
        if binding.group >= MOST_GROUPS {
            return Err(LayoutError::Group(binding.name.clone(), binding.group));
        }
        let group = binding.group as usize;
        groups.resize(groups.len().max(group + 1), Vec::new());
        let entries = &mut groups[group];
        if entries.iter().any(|known| known.binding == binding.binding) {
            return Err(LayoutError::Conflict(binding.group, binding.binding));
        }
        let stages = found.stages.iter().map(|stage| match stage {
            Stage::Vertex => wgpu::ShaderStages::VERTEX,
            Stage::Fragment => wgpu::ShaderStages::FRAGMENT,
            Stage::Compute => wgpu::ShaderStages::COMPUTE,
        });
        entries.push(wgpu::BindGroupLayoutEntry {
            binding: binding.binding,
            visibility: stages.fold(wgpu::ShaderStages::NONE, |all, stage| all | stage),
            ty: binding_type(binding)?,
            count: binding.count.and_then(std::num::NonZeroU32::new),
        });
    }
    Ok(groups)
}

fn binding_type(binding: &Binding) -> Result<wgpu::BindingType, LayoutError> {
    let buffer = |ty| wgpu::BindingType::Buffer {
        ty,
        has_dynamic_offset: false,
        min_binding_size: binding.size.and_then(|size| std::num::NonZeroU64::new(size.into())),
    };
    let texture = binding.texture.as_ref().ok_or_else(|| unknown(binding, "texture"));
    Ok(match binding.kind {
        // Immediates are in no group.
        BindingKind::Uniform | BindingKind::Immediate => buffer(wgpu::BufferBindingType::Uniform),
        BindingKind::Storage => {
            buffer(wgpu::BufferBindingType::Storage { read_only: !binding.writable })
        }
        BindingKind::Sampler => wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
        BindingKind::ComparisonSampler => {
            wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Comparison)
        }
        BindingKind::Texture => sampled_type(binding, texture?)?,
        BindingKind::StorageTexture => storage_type(binding, texture?)?,
    })
}

fn unknown(binding: &Binding, what: &str) -> LayoutError {
    LayoutError::Unknown(binding.name.clone(), what.to_owned())
}

fn sampled_type(
    binding: &Binding,
    texture: &TextureShape,
) -> Result<wgpu::BindingType, LayoutError> {
    let sample_type = match texture.sample_type {
        Some(SampleType::Float) => wgpu::TextureSampleType::Float { filterable: true },
        Some(SampleType::UnfilterableFloat) => wgpu::TextureSampleType::Float { filterable: false },
        Some(SampleType::Depth) => wgpu::TextureSampleType::Depth,
        Some(SampleType::Sint) => wgpu::TextureSampleType::Sint,
        Some(SampleType::Uint) => wgpu::TextureSampleType::Uint,
        None => return Err(unknown(binding, "texture without a sample type")),
    };
    Ok(wgpu::BindingType::Texture {
        sample_type,
        view_dimension: view_dimension(binding, texture)?,
        multisampled: texture.multisampled,
    })
}

fn storage_type(
    binding: &Binding,
    texture: &TextureShape,
) -> Result<wgpu::BindingType, LayoutError> {
    let access = match texture.access {
        Some(Access::Read) => wgpu::StorageTextureAccess::ReadOnly,
        Some(Access::ReadWrite) => wgpu::StorageTextureAccess::ReadWrite,
        Some(Access::Write) | None => wgpu::StorageTextureAccess::WriteOnly,
    };
    let name = texture.format.as_deref().unwrap_or_default();
    let format = FORMATS.iter().find(|(known, _)| *known == name);
    let format = format.ok_or_else(|| unknown(binding, name))?.1;
    let view_dimension = view_dimension(binding, texture)?;
    Ok(wgpu::BindingType::StorageTexture { access, format, view_dimension })
}

/// Formats of storage textures by their names in WGSL.
const FORMATS: &[(&str, wgpu::TextureFormat)] = &[
    ("rgba8unorm", wgpu::TextureFormat::Rgba8Unorm),
    ("rgba8snorm", wgpu::TextureFormat::Rgba8Snorm),
    ("rgba8uint", wgpu::TextureFormat::Rgba8Uint),
    ("rgba8sint", wgpu::TextureFormat::Rgba8Sint),
    ("rgba16uint", wgpu::TextureFormat::Rgba16Uint),
    ("rgba16sint", wgpu::TextureFormat::Rgba16Sint),
    ("rgba16float", wgpu::TextureFormat::Rgba16Float),
    ("r32uint", wgpu::TextureFormat::R32Uint),
    ("r32sint", wgpu::TextureFormat::R32Sint),
    ("r32float", wgpu::TextureFormat::R32Float),
    ("rg32uint", wgpu::TextureFormat::Rg32Uint),
    ("rg32sint", wgpu::TextureFormat::Rg32Sint),
    ("rg32float", wgpu::TextureFormat::Rg32Float),
    ("rgba32uint", wgpu::TextureFormat::Rgba32Uint),
    ("rgba32sint", wgpu::TextureFormat::Rgba32Sint),
    ("rgba32float", wgpu::TextureFormat::Rgba32Float),
    ("bgra8unorm", wgpu::TextureFormat::Bgra8Unorm),
    ("rgba16unorm", wgpu::TextureFormat::Rgba16Unorm),
    ("rgba16snorm", wgpu::TextureFormat::Rgba16Snorm),
];

fn view_dimension(
    binding: &Binding,
    texture: &TextureShape,
) -> Result<wgpu::TextureViewDimension, LayoutError> {
    Ok(match texture.dimension.as_str() {
        "1d" => wgpu::TextureViewDimension::D1,
        "2d" => wgpu::TextureViewDimension::D2,
        "2d_array" => wgpu::TextureViewDimension::D2Array,
        "3d" => wgpu::TextureViewDimension::D3,
        "cube" => wgpu::TextureViewDimension::Cube,
        "cube_array" => wgpu::TextureViewDimension::CubeArray,
        other => return Err(unknown(binding, other)),
    })
}

#[cfg(test)]
mod tests {
    use std::collections::{BTreeMap, BTreeSet};

    use super::*;

    fn entry(kind: BindingKind, texture: Option<TextureShape>) -> LayoutBinding {
        let binding = Binding {
            group: 1,
            binding: 3,
            name: "picture".to_owned(),
            kind,
            ty: String::new(),
            count: None,
            size: None,
            writable: false,
            shape: None,
            texture,
            members: Vec::new(),
        };
        let stages = BTreeSet::from([Stage::Vertex, Stage::Fragment]);
        LayoutBinding { binding, stages, when: BTreeMap::new() }
    }

    fn shape(format: &str) -> TextureShape {
        TextureShape {
            dimension: "cube".to_owned(),
            multisampled: false,
            sample_type: Some(SampleType::Depth),
            format: Some(format.to_owned()),
            access: Some(Access::ReadWrite),
        }
    }

    #[test]
    fn groups_before_the_first_are_empty() {
        let groups = layout_entries(&[entry(BindingKind::Texture, Some(shape("")))]).unwrap();
        assert_eq!((groups.len(), groups[0].len()), (2, 0));
        assert_eq!(groups[1][0].visibility, wgpu::ShaderStages::VERTEX_FRAGMENT);
        let ty = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Depth,
            view_dimension: wgpu::TextureViewDimension::Cube,
            multisampled: false,
        };
        assert_eq!(groups[1][0].ty, ty);
    }

    #[test]
    fn what_wgpu_lacks_is_named() {
        let wrong = entry(BindingKind::StorageTexture, Some(shape("rgba9")));
        let error = layout_entries(&[wrong]).unwrap_err();
        assert_eq!(error.to_string(), "wgpu has no `rgba9`, which `picture` needs");
        let twice = [entry(BindingKind::Sampler, None), entry(BindingKind::Uniform, None)];
        assert_eq!(layout_entries(&twice).unwrap_err(), LayoutError::Conflict(1, 3));
        let mut far = entry(BindingKind::Sampler, None);
        far.binding.group = u32::MAX;
        let error = layout_entries(&[far]).unwrap_err();
        assert_eq!(error.to_string(), "no device has a group 4294967295, which `picture` is in");
    }
}
