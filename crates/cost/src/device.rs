//! Uses Mesa's RADV for GPUs that are not installed: compiles pipelines and reads their figures.
//!
//! With `RADV_FORCE_FAMILY` the driver makes a device of that family on top of no hardware. Nothing
//! is ever submitted to it. The loader is pointed at RADV alone, so that no other driver, and no
//! real device, is touched; the environment is put back before anything else reads it.

use crate::gpu::Gpu;
use crate::machine::{Counting, count_machine};
use crate::pipeline::{LocationAttribute, Pipeline, ResourceSlot, SlotKind, SpirvStage};
use crate::statistics::Statistics;
use ash::{khr, vk};
use lamplight_bundle::{BindingKind, Stage};
use std::ffi::CStr;
use std::path::Path;

/// The environment variable that names another manifest of the driver.
const MANIFEST: &str = "LAMPLIGHT_RADV_MANIFEST";

/// Where packages put the driver's manifest.
const MANIFESTS: &[&str] = &[
    "/usr/share/vulkan/icd.d/radeon_icd.x86_64.json",
    "/usr/share/vulkan/icd.d/radeon_icd.json",
    "/etc/vulkan/icd.d/radeon_icd.x86_64.json",
];

/// What pipelines keep of their compilation: the statistics, and the machine code as text.
const CAPTURED: vk::PipelineCreateFlags = vk::PipelineCreateFlags::from_raw(
    vk::PipelineCreateFlags::CAPTURE_STATISTICS_KHR.as_raw()
        | vk::PipelineCreateFlags::CAPTURE_INTERNAL_REPRESENTATIONS_KHR.as_raw(),
);

/// Bytes of push constants: all that RADV has.
const PUSH_BYTES: u32 = 256;

/// The driver's name for the machine code.
const ASSEMBLY: &CStr = c"Assembly";

/// A part of the device's name if it has no hardware.
const NULL_HARDWARE: &str = "Null hardware";

/// How to get the driver.
pub const INSTALL: &str = "apt-get install mesa-vulkan-drivers libvulkan1";

/// A GPU to compile for.
pub struct Device {
    pub gpu: &'static Gpu,
    /// The driver's version. Figures of different versions differ.
    pub driver: String,
    _entry: ash::Entry,
    instance: ash::Instance,
    device: ash::Device,
    executables: khr::pipeline_executable_properties::Device,
}

impl Device {
    /// Opens the GPU. Call this while the process has only one thread: it changes the environment
    /// for a moment, since the loader and the driver read it.
    ///
    /// # Errors
    /// Why the device cannot be opened. If the driver is missing, the command that installs it.
    pub fn open(gpu: &'static Gpu) -> Result<Self, String> {
        let manifest =
            driver_manifest().ok_or_else(|| missing_feature("there is no RADV driver"))?;
        let settings = [
            ("RADV_FORCE_FAMILY", gpu.name),
            ("VK_DRIVER_FILES", &manifest),
            ("VK_ICD_FILENAMES", &manifest),
            ("VK_LOADER_LAYERS_DISABLE", "~all~"),
            ("NODEVICE_SELECT", "1"),
            ("MESA_SHADER_CACHE_DISABLE", "true"),
        ];
        let before = settings.map(|(name, _)| (name, std::env::var_os(name)));
        for (name, value) in settings {
            // SAFETY: the process has one thread, as the caller promises.
            unsafe { std::env::set_var(name, value) };
        }
        let opened = Self::create(gpu);
        for (name, value) in before {
            match value {
                // SAFETY: as above.
                Some(value) => unsafe { std::env::set_var(name, value) },
                // SAFETY: as above.
                None => unsafe { std::env::remove_var(name) },
            }
        }
        opened
    }

    fn create(gpu: &'static Gpu) -> Result<Self, String> {
        // SAFETY: the loader is the system's, and outlives what is made with it in `Device`.
        let entry = unsafe { ash::Entry::load() }
            .map_err(|_| missing_feature("there is no Vulkan loader"))?;
        let application = vk::ApplicationInfo::default().api_version(vk::API_VERSION_1_3);
        let info = vk::InstanceCreateInfo::default().application_info(&application);
        // SAFETY: the structures live during the call.
        let instance = unsafe { entry.create_instance(&info, None) }.map_err(refusal_text)?;
        // SAFETY: `instance` is valid until it is destroyed in `drop`, and here on failure.
        let found = unsafe { instance.enumerate_physical_devices() }.map_err(refusal_text);
        let opened = found.and_then(|found| {
            let physical =
                found.first().copied().ok_or_else(|| missing_feature("RADV has no device"))?;
            open_device(&instance, physical, gpu)
        });
        match opened {
            Ok((device, driver)) => {
                let executables =
                    khr::pipeline_executable_properties::Device::new(&instance, &device);
                Ok(Self { gpu, driver, _entry: entry, instance, device, executables })
            }
            Err(error) => {
                // SAFETY: nothing was made of it.
                unsafe { instance.destroy_instance(None) };
                Err(error)
            }
        }
    }

    /// Compiles a pipeline and gives the figures of each of its stages. `iterations` says how often
    /// loops run whose code does not say it, in the order of the code; the last number holds for
    /// all further ones, and without any each counts once.
    ///
    /// # Errors
    /// What the driver says where it refuses the pipeline, or what about the machine code is not
    /// understood.
    pub fn measure(
        &self,
        pipeline: &Pipeline,
        iterations: &[u32],
    ) -> Result<Vec<(Stage, Statistics)>, String> {
        let mut made = PipelineObjects::new(&self.device);
        let compiled = made.pipeline(pipeline).map_err(refusal_text)?;
        self.figures(compiled, iterations)
    }

    fn figures(
        &self,
        pipeline: vk::Pipeline,
        iterations: &[u32],
    ) -> Result<Vec<(Stage, Statistics)>, String> {
        let info = vk::PipelineInfoKHR::default().pipeline(pipeline);
        // SAFETY: the pipeline was made by this device with its statistics captured.
        let found = unsafe { self.executables.get_pipeline_executable_properties(&info) };
        let mut stages = Vec::new();
        for (index, executable) in found.map_err(refusal_text)?.iter().enumerate() {
            let Some(stage) = stage_of(executable.stages) else { continue };
            let info = vk::PipelineExecutableInfoKHR::default()
                .pipeline(pipeline)
                .executable_index(index as u32);
            // SAFETY: as above; the index is one of those that the driver listed.
            let named = unsafe { self.executables.get_pipeline_executable_statistics(&info) };
            let named = named.map_err(refusal_text)?;
            let named = named.iter().filter_map(|named| {
                Some((named.name_as_c_str().ok()?.to_str().ok()?, statistic_value(named)))
            });
            let text = self.assembly(&info).map_err(refusal_text)?;
            let wave = executable.subgroup_size;
            let counting = Counting { rates: self.gpu.rates, wave, iterations };
            let counted = count_machine(&text, counting).map_err(|error| error.to_string())?;
            stages.push((stage, Statistics::of_stage(named, &counted, wave)));
        }
        Ok(stages)
    }
}

impl Device {
    /// The machine code of an executable as text: empty where the driver has no disassembler.
    fn assembly(&self, info: &vk::PipelineExecutableInfoKHR<'_>) -> Result<String, vk::Result> {
        // SAFETY: the executable is one that the driver listed for a pipeline of this device.
        let mut found =
            unsafe { self.executables.get_pipeline_executable_internal_representations(info) }?;
        let mut texts: Vec<Vec<u8>> = found.iter().map(|one| vec![0; one.data_size]).collect();
        for (one, text) in found.iter_mut().zip(&mut texts) {
            one.p_data = text.as_mut_ptr().cast();
        }
        let ask = self.executables.fp().get_pipeline_executable_internal_representations_khr;
        let mut count = found.len() as u32;
        // SAFETY: as above; each `p_data` has the size that the driver named, and `texts` lives on.
        let answer =
            unsafe { ask(self.executables.device(), info, &mut count, found.as_mut_ptr()) };
        answer.result()?;
        let place =
            found.iter().position(|one| one.name_as_c_str().is_ok_and(|name| name == ASSEMBLY));
        let text = place.and_then(|place| texts.get(place)).map_or(&[][..], Vec::as_slice);
        let end = text.iter().position(|byte| *byte == 0).unwrap_or(text.len());
        Ok(String::from_utf8_lossy(&text[..end]).into_owned())
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        // SAFETY: both were made by `create` and nothing of theirs is left.
        unsafe {
            self.device.destroy_device(None);
            self.instance.destroy_instance(None);
        }
    }
}

/// The driver's manifest: that of `LAMPLIGHT_RADV_MANIFEST`, or where packages put it.
fn driver_manifest() -> Option<String> {
    let named = std::env::var(MANIFEST).ok();
    let known = || MANIFESTS.iter().map(|path| (*path).to_owned());
    let mut paths: Box<dyn Iterator<Item = String>> = match named {
        Some(named) => Box::new(std::iter::once(named)),
        None => Box::new(known()),
    };
    paths.find(|path| Path::new(path).is_file())
}

/// The logical device, and the driver's version.
fn open_device(
    instance: &ash::Instance,
    physical: vk::PhysicalDevice,
    gpu: &Gpu,
) -> Result<(ash::Device, String), String> {
    let mut driver = vk::PhysicalDeviceDriverProperties::default();
    let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut driver);
    // SAFETY: `physical` is one of the instance's.
    unsafe { instance.get_physical_device_properties2(physical, &mut properties) };
    let name = text_of(properties.properties.device_name_as_c_str());
    if !name.contains(NULL_HARDWARE) {
        return Err(format!(
            "RADV gave the device `{name}` instead of {} without hardware",
            gpu.name
        ));
    }
    let version = text_of(driver.driver_info_as_c_str());
    let priorities = [1.0];
    let queues = [vk::DeviceQueueCreateInfo::default().queue_priorities(&priorities)];
    let extensions = [khr::pipeline_executable_properties::NAME.as_ptr()];
    let mut executables = vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR::default()
        .pipeline_executable_info(true);
    let mut rendering =
        vk::PhysicalDeviceDynamicRenderingFeatures::default().dynamic_rendering(true);
    // SAFETY: as above.
    let features = unsafe { instance.get_physical_device_features(physical) };
    let info = vk::DeviceCreateInfo::default()
        .queue_create_infos(&queues)
        .enabled_extension_names(&extensions)
        .enabled_features(&features)
        .push_next(&mut executables)
        .push_next(&mut rendering);
    // SAFETY: the structures live during the call.
    let device = unsafe { instance.create_device(physical, &info, None) }.map_err(refusal_text)?;
    Ok((device, version))
}

fn missing_feature(what: &str) -> String {
    format!("{what}\ninstall it with: {INSTALL}")
}

fn refusal_text(error: vk::Result) -> String {
    format!("the driver answered {error}")
}

fn text_of(name: Result<&CStr, std::ffi::FromBytesUntilNulError>) -> String {
    name.map_or(String::new(), |name| name.to_string_lossy().into_owned())
}

fn stage_of(flags: vk::ShaderStageFlags) -> Option<Stage> {
    if flags.contains(vk::ShaderStageFlags::FRAGMENT) {
        Some(Stage::Fragment)
    } else if flags.contains(vk::ShaderStageFlags::VERTEX) {
        Some(Stage::Vertex)
    } else if flags.contains(vk::ShaderStageFlags::COMPUTE) {
        Some(Stage::Compute)
    } else {
        None
    }
}

fn statistic_value(named: &vk::PipelineExecutableStatisticKHR) -> i64 {
    // SAFETY: the format tells which field was written.
    unsafe {
        match named.format {
            vk::PipelineExecutableStatisticFormatKHR::BOOL32 => i64::from(named.value.b32),
            vk::PipelineExecutableStatisticFormatKHR::INT64 => named.value.i64,
            vk::PipelineExecutableStatisticFormatKHR::UINT64 => named.value.u64 as i64,
            _ => named.value.f64 as i64,
        }
    }
}

/// The objects of one pipeline, which are destroyed with it.
struct PipelineObjects<'d> {
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
            // SAFETY: naga wrote the module and its validator accepted it, or `spirv-val` did.
            self.modules.push(unsafe { self.device.create_shader_module(&info, None) }?);
        }
        self.layout(&wanted.slots, wanted.has_push)?;
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

    fn layout(&mut self, slots: &[ResourceSlot], has_push: bool) -> Result<(), vk::Result> {
        let groups = slots.iter().map(|slot| slot.group + 1).max().unwrap_or(0);
        for group in 0..groups {
            let bindings: Vec<_> = slots
                .iter()
                .filter(|slot| slot.group == group)
                .map(|slot| {
                    vk::DescriptorSetLayoutBinding::default()
                        .binding(slot.binding)
                        .descriptor_type(descriptor_type(slot.kind))
                        .descriptor_count(slot.count)
                        .stage_flags(vk::ShaderStageFlags::ALL)
                })
                .collect();
            let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
            // SAFETY: the structures live during the call.
            self.sets.push(unsafe { self.device.create_descriptor_set_layout(&info, None) }?);
        }
        let push = vk::PushConstantRange::default()
            .stage_flags(vk::ShaderStageFlags::ALL)
            .size(PUSH_BYTES);
        let push = if has_push { &[push][..] } else { &[] };
        let info = vk::PipelineLayoutCreateInfo::default()
            .set_layouts(&self.sets)
            .push_constant_ranges(push);
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
                    .flags(CAPTURED)
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
            .flags(CAPTURED)
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

fn descriptor_type(kind: SlotKind) -> vk::DescriptorType {
    let kind = match kind {
        SlotKind::Plain(kind) => kind,
        SlotKind::Combined => return vk::DescriptorType::COMBINED_IMAGE_SAMPLER,
        SlotKind::TexelBuffer => return vk::DescriptorType::UNIFORM_TEXEL_BUFFER,
        SlotKind::StorageTexelBuffer => return vk::DescriptorType::STORAGE_TEXEL_BUFFER,
        SlotKind::InputAttachment => return vk::DescriptorType::INPUT_ATTACHMENT,
    };
    match kind {
        // Immediates get no slot.
        BindingKind::Uniform | BindingKind::Immediate => vk::DescriptorType::UNIFORM_BUFFER,
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
