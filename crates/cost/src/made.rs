//! Creates pipelines of Vulkan.

use ash::vk;

use super::pipeline::{LocationAttribute, Pipeline, ResourceSlot, SpirvStage};
use lamplight_bundle::{BindingKind, Stage};

/// The objects of one pipeline, which are destroyed with it.
pub(super) struct PipelineObjects<'d> {
    device: &'d ash::Device,
    modules: Vec<vk::ShaderModule>,
    sets: Vec<vk::DescriptorSetLayout>,
    layout: vk::PipelineLayout,
    pipeline: vk::Pipeline,
}

impl<'d> PipelineObjects<'d> {
    pub(super) fn new(device: &'d ash::Device) -> Self {
        let (modules, sets) = (Vec::new(), Vec::new());
        let (layout, pipeline) = (vk::PipelineLayout::null(), vk::Pipeline::null());
        Self { device, modules, sets, layout, pipeline }
    }

    pub(super) fn pipeline(&mut self, wanted: &Pipeline) -> Result<vk::Pipeline, vk::Result> {
        for stage in &wanted.stages {
            let info = vk::ShaderModuleCreateInfo::default().code(&stage.words);
            // SAFETY: the words are a module that naga wrote and its validator accepted.
            self.modules.push(unsafe { self.device.create_shader_module(&info, None) }?);
        }
        self.layout(&wanted.slots)?;
        let constants: Vec<SpecialisationEntries> =
            wanted.stages.iter().map(SpecialisationEntries::of).collect();
        let infos: Vec<_> = constants.iter().map(SpecialisationEntries::info).collect();
        let stages = self.stages(wanted, &infos);
        self.pipeline = match wanted.stages.iter().any(|stage| stage.stage == Stage::Compute) {
            true => self.compute(stages)?,
            false => self.graphics(wanted, &stages)?,
        };
        Ok(self.pipeline)
    }

    fn layout(&mut self, slots: &[ResourceSlot]) -> Result<(), vk::Result> {
        let groups = slots.iter().map(|slot| slot.group + 1).max().unwrap_or(0);
        for group in 0..groups {
            let bindings: Vec<_> = slots
                .iter()
                .filter(|slot| slot.group == group)
                .map(|slot| {
                    vk::DescriptorSetLayoutBinding::default()
                        .binding(slot.binding)
                        .descriptor_type(descriptor_type(slot.kind))
                        .descriptor_count(1)
                        .stage_flags(vk::ShaderStageFlags::ALL)
                })
                .collect();
            let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
            // SAFETY: the structures live during the call.
            self.sets.push(unsafe { self.device.create_descriptor_set_layout(&info, None) }?);
        }
        let info = vk::PipelineLayoutCreateInfo::default().set_layouts(&self.sets);
        // SAFETY: as above.
        self.layout = unsafe { self.device.create_pipeline_layout(&info, None) }?;
        Ok(())
    }

    fn stages<'s>(
        &self,
        wanted: &'s Pipeline,
        constants: &'s [vk::SpecializationInfo<'s>],
    ) -> Vec<vk::PipelineShaderStageCreateInfo<'s>> {
        let stages = wanted.stages.iter().zip(constants).zip(&self.modules);
        let info = stages.map(|((stage, constants), module)| {
            vk::PipelineShaderStageCreateInfo::default()
                .stage(stage_flags(stage.stage))
                .module(*module)
                .name(&stage.entry)
                .specialization_info(constants)
        });
        info.collect()
    }

    fn compute(
        &self,
        stages: Vec<vk::PipelineShaderStageCreateInfo<'_>>,
    ) -> Result<vk::Pipeline, vk::Result> {
        let infos: Vec<_> = stages
            .into_iter()
            .take(1)
            .map(|stage| {
                vk::ComputePipelineCreateInfo::default()
                    .flags(vk::PipelineCreateFlags::CAPTURE_STATISTICS_KHR)
                    .stage(stage)
                    .layout(self.layout)
            })
            .collect();
        let none = vk::PipelineCache::null();
        // SAFETY: the structures live during the call.
        let made = unsafe { self.device.create_compute_pipelines(none, &infos, None) };
        first_pipeline(made)
    }

    fn graphics(
        &self,
        wanted: &Pipeline,
        stages: &[vk::PipelineShaderStageCreateInfo<'_>],
    ) -> Result<vk::Pipeline, vk::Result> {
        let attributes: Vec<_> = wanted.attributes.iter().map(attribute_description).collect();
        let strides: Vec<_> = wanted.attributes.iter().map(binding_description).collect();
        let vertices = vk::PipelineVertexInputStateCreateInfo::default()
            .vertex_binding_descriptions(&strides)
            .vertex_attribute_descriptions(&attributes);
        let assembly = vk::PipelineInputAssemblyStateCreateInfo::default()
            .topology(vk::PrimitiveTopology::TRIANGLE_LIST);
        let viewport =
            vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
        let raster = vk::PipelineRasterizationStateCreateInfo::default().line_width(1.0);
        let samples = vk::PipelineMultisampleStateCreateInfo::default()
            .rasterization_samples(vk::SampleCountFlags::TYPE_1);
        let depth = vk::PipelineDepthStencilStateCreateInfo::default();
        let formats: Vec<_> = wanted.colors.iter().map(color_format).collect();
        let written = vk::PipelineColorBlendAttachmentState::default()
            .color_write_mask(vk::ColorComponentFlags::RGBA);
        let blends = vec![written; formats.len()];
        let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blends);
        let states = [vk::DynamicState::VIEWPORT, vk::DynamicState::SCISSOR];
        let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&states);
        let mut rendering = vk::PipelineRenderingCreateInfo::default()
            .color_attachment_formats(&formats)
            .depth_attachment_format(vk::Format::D32_SFLOAT);
        let info = vk::GraphicsPipelineCreateInfo::default()
            .flags(vk::PipelineCreateFlags::CAPTURE_STATISTICS_KHR)
            .stages(stages)
            .vertex_input_state(&vertices)
            .input_assembly_state(&assembly)
            .viewport_state(&viewport)
            .rasterization_state(&raster)
            .multisample_state(&samples)
            .depth_stencil_state(&depth)
            .color_blend_state(&blend)
            .dynamic_state(&dynamic)
            .layout(self.layout)
            .push_next(&mut rendering);
        let none = vk::PipelineCache::null();
        // SAFETY: the structures live during the call.
        let made = unsafe { self.device.create_graphics_pipelines(none, &[info], None) };
        first_pipeline(made)
    }
}

impl Drop for PipelineObjects<'_> {
    fn drop(&mut self) {
        // SAFETY: all were made by this device, and null handles may be destroyed.
        unsafe {
            self.device.destroy_pipeline(self.pipeline, None);
            self.device.destroy_pipeline_layout(self.layout, None);
            for set in &self.sets {
                self.device.destroy_descriptor_set_layout(*set, None);
            }
            for module in &self.modules {
                self.device.destroy_shader_module(*module, None);
            }
        }
    }
}

/// The specialisation constants of a stage, as the driver takes them.
struct SpecialisationEntries {
    places: Vec<vk::SpecializationMapEntry>,
    bytes: Vec<u8>,
}

impl SpecialisationEntries {
    fn of(stage: &SpirvStage) -> Self {
        let place = |(index, (id, _)): (usize, &(u32, u32))| vk::SpecializationMapEntry {
            constant_id: *id,
            offset: index as u32 * 4,
            size: 4,
        };
        let places = stage.constants.iter().enumerate().map(place).collect();
        let bytes = stage.constants.iter().flat_map(|(_, bits)| bits.to_ne_bytes()).collect();
        Self { places, bytes }
    }

    fn info(&self) -> vk::SpecializationInfo<'_> {
        vk::SpecializationInfo::default().map_entries(&self.places).data(&self.bytes)
    }
}

fn first_pipeline(
    made: Result<Vec<vk::Pipeline>, (Vec<vk::Pipeline>, vk::Result)>,
) -> Result<vk::Pipeline, vk::Result> {
    match made {
        Ok(made) => made.first().copied().ok_or(vk::Result::ERROR_UNKNOWN),
        Err((_, error)) => Err(error),
    }
}

fn stage_flags(stage: Stage) -> vk::ShaderStageFlags {
    match stage {
        Stage::Vertex => vk::ShaderStageFlags::VERTEX,
        Stage::Fragment => vk::ShaderStageFlags::FRAGMENT,
        Stage::Compute => vk::ShaderStageFlags::COMPUTE,
    }
}

fn descriptor_type(kind: BindingKind) -> vk::DescriptorType {
    match kind {
        BindingKind::Uniform => vk::DescriptorType::UNIFORM_BUFFER,
        BindingKind::Storage => vk::DescriptorType::STORAGE_BUFFER,
        BindingKind::Texture => vk::DescriptorType::SAMPLED_IMAGE,
        BindingKind::StorageTexture => vk::DescriptorType::STORAGE_IMAGE,
        BindingKind::Sampler | BindingKind::ComparisonSampler => vk::DescriptorType::SAMPLER,
    }
}

fn attribute_description(attribute: &LocationAttribute) -> vk::VertexInputAttributeDescription {
    vk::VertexInputAttributeDescription::default()
        .location(attribute.location)
        .binding(attribute.location)
        .format(vertex_format(attribute.scalar, attribute.components))
}

/// The layout of a vertex buffer. Each attribute has its own.
fn binding_description(attribute: &LocationAttribute) -> vk::VertexInputBindingDescription {
    vk::VertexInputBindingDescription::default().binding(attribute.location).stride(16)
}

fn color_format(attribute: &Option<LocationAttribute>) -> vk::Format {
    attribute.as_ref().map_or(vk::Format::UNDEFINED, |attribute| vertex_format(attribute.scalar, 4))
}

/// The format that holds a value of 32-bit components unchanged.
fn vertex_format(scalar: naga::ScalarKind, components: u8) -> vk::Format {
    use vk::Format;
    let formats = match scalar {
        naga::ScalarKind::Sint => [
            Format::R32_SINT,
            Format::R32G32_SINT,
            Format::R32G32B32_SINT,
            Format::R32G32B32A32_SINT,
        ],
        naga::ScalarKind::Uint => [
            Format::R32_UINT,
            Format::R32G32_UINT,
            Format::R32G32B32_UINT,
            Format::R32G32B32A32_UINT,
        ],
        _ => [
            Format::R32_SFLOAT,
            Format::R32G32_SFLOAT,
            Format::R32G32B32_SFLOAT,
            Format::R32G32B32A32_SFLOAT,
        ],
    };
    formats[usize::from(components.clamp(1, 4)) - 1]
}
