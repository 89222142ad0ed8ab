//! Runs compute entry points through wgpu: outputs in WGSL, and everything that can become SPIR-V.

use super::passthrough::{SpirvBinary, hlsl_lacks};
use super::{Shaders, WgpuDevice, executor_failed};
use crate::dispatch::{Dispatch, DispatchResult, bound_buffers};
use crate::frame::Buffers;
use crate::shipped::Shipped;
use lamplight_bundle::{Binding, BindingKind, Target};
use lamplight_diagnostic::{Diagnostic, codes};
use std::collections::{BTreeMap, BTreeSet};

/// Group and binding.
type Place = (u32, u32);

/// A buffer of a dispatch on the device.
struct DeviceBuffer {
    place: Place,
    ty: wgpu::BufferBindingType,
    buffer: wgpu::Buffer,
    /// Its bytes; the buffer on the device ends at a whole word.
    bytes: usize,
    /// A copy for reading, of a buffer that is written to.
    copy: Option<wgpu::Buffer>,
}

/// Bindings between those of an output. wgpu numbers bindings without gaps, but an output keeps its
/// own numbers.
fn fillers(shipped: &Shipped) -> Vec<Place> {
    let bindings = shipped.reflection.bindings.iter();
    let used: BTreeSet<Place> = bindings.map(|one| (one.group, one.binding)).collect();
    let below = |(group, last): Place| (0..last).map(move |binding| (group, binding));
    let all: BTreeSet<Place> = used.iter().copied().flat_map(below).collect();
    all.difference(&used).copied().collect()
}

impl WgpuDevice {
    /// Runs one entry point.
    pub fn compute(&self, dispatch: &Dispatch<'_>) -> DispatchResult {
        let target = match self.shaders {
            Shaders::Translated | Shaders::Written => Target::WGSL,
            Shaders::Emitted(target) => target,
        };
        let shipped = dispatch.output(target)?;
        if target == Target::HLSL
            && let Some(reason) = hlsl_lacks(&shipped.text())
        {
            return Err(Diagnostic::error(codes::EXECUTOR_LACKS, reason));
        }
        let most = self.device.limits().max_bind_groups;
        let mut bound = bound_buffers(shipped)?;
        if !has_immediates(target) && bound.any(|one| one.group >= most) {
            let reason = format!("the device has {most} groups");
            return Err(Diagnostic::error(codes::EXECUTOR_LACKS, reason));
        }
        let made = self.guarded(|gpu| gpu.submit_compute(dispatch, shipped))??;
        let mut written = Buffers::new();
        for DeviceBuffer { place, ty: _, buffer: _, bytes, copy } in &made {
            if let Some(copy) = copy {
                let found = self.mapped(copy, |found| found[..*bytes].to_vec())?;
                written.insert(*place, found);
            }
        }
        Ok(written)
    }

    fn submit_compute(
        &self,
        dispatch: &Dispatch<'_>,
        shipped: &Shipped,
    ) -> Result<Vec<DeviceBuffer>, Diagnostic> {
        let (module, entry) = self.compute_module(shipped)?;
        let immediates = self.immediates(dispatch, shipped)?;
        let mut buffers: Vec<DeviceBuffer> = bound_buffers(shipped)?
            .filter(|binding| immediates.is_empty() || binding.kind != BindingKind::Immediate)
            .map(|binding| {
                let place = (binding.group, binding.binding);
                Ok(self.device_buffer(place, binding_type(binding), dispatch.buffer(place)?))
            })
            .collect::<Result<_, Diagnostic>>()?;
        let unused = wgpu::BufferBindingType::Storage { read_only: true };
        let fillers = fillers(shipped).into_iter();
        buffers.extend(fillers.map(|place| self.device_buffer(place, unused, &[0; 4])));
        let layouts = self.compute_layouts(&buffers);
        let count = layouts.keys().max().map_or(0, |last| last + 1);
        let in_order: Vec<Option<&wgpu::BindGroupLayout>> =
            (0..count).map(|group| layouts.get(&group)).collect();
        let layout = self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &in_order,
            immediate_size: immediates.len() as u32,
        });
        let pipeline = self.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: None,
            layout: Some(&layout),
            module: &module,
            entry_point: Some(&entry),
            compilation_options: Default::default(),
            cache: None,
        });
        let groups = self.compute_groups(&buffers, &layouts);
        let mut encoder = self.device.create_command_encoder(&Default::default());
        record_pass(&mut encoder, &pipeline, &groups, (dispatch.groups, &immediates));
        for DeviceBuffer { place: _, ty: _, buffer, bytes: _, copy } in &buffers {
            if let Some(copy) = copy {
                encoder.copy_buffer_to_buffer(buffer, 0, copy, 0, buffer.size());
            }
        }
        self.queue.submit([encoder.finish()]);
        Ok(buffers)
    }

    /// The immediates of an output that has them, and not a buffer in their place.
    fn immediates(
        &self,
        dispatch: &Dispatch<'_>,
        shipped: &Shipped,
    ) -> Result<Vec<u8>, Diagnostic> {
        let mut bound = bound_buffers(shipped)?;
        let is_own = has_immediates(shipped.target);
        match bound.find(|one| is_own && one.kind == BindingKind::Immediate) {
            Some(binding) => Ok(dispatch.buffer((binding.group, binding.binding))?.to_vec()),
            None => Ok(Vec::new()),
        }
    }

    fn compute_module(
        &self,
        shipped: &Shipped,
    ) -> Result<(wgpu::ShaderModule, String), Diagnostic> {
        let Shipped { target, bytes, native, reflection } = shipped;
        if *target == Target::WGSL {
            let source = wgpu::ShaderSource::Wgsl(shipped.text());
            let descriptor = wgpu::ShaderModuleDescriptor { label: None, source };
            let module = self.device.create_shader_module(descriptor);
            return Ok((module, native.entry_name.clone()));
        }
        let binary = SpirvBinary::new(*target, reflection.stage, bytes, native, 0);
        let binary = binary.map_err(executor_failed)?;
        Ok((binary.module(&self.device, "compute"), binary.entry().to_owned()))
    }

    fn device_buffer(
        &self,
        place: Place,
        ty: wgpu::BufferBindingType,
        bytes: &[u8],
    ) -> DeviceBuffer {
        let mut whole = bytes.to_vec();
        whole.resize(bytes.len().next_multiple_of(4).max(4), 0);
        let make = |usage: wgpu::BufferUsages| {
            self.device.create_buffer(&wgpu::BufferDescriptor {
                label: None,
                size: whole.len() as u64,
                usage,
                mapped_at_creation: false,
            })
        };
        let usage = match ty {
            wgpu::BufferBindingType::Uniform => wgpu::BufferUsages::UNIFORM,
            _ => wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
        };
        let buffer = make(usage | wgpu::BufferUsages::COPY_DST);
        self.queue.write_buffer(&buffer, 0, &whole);
        let is_written = ty == wgpu::BufferBindingType::Storage { read_only: false };
        let copy = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
        let copy = is_written.then(|| make(copy));
        DeviceBuffer { place, ty, buffer, bytes: bytes.len(), copy }
    }

    fn compute_layouts(&self, buffers: &[DeviceBuffer]) -> BTreeMap<u32, wgpu::BindGroupLayout> {
        let mut entries: BTreeMap<u32, Vec<wgpu::BindGroupLayoutEntry>> = BTreeMap::new();
        for DeviceBuffer { place: (group, binding), ty, .. } in buffers {
            entries.entry(*group).or_default().push(wgpu::BindGroupLayoutEntry {
                binding: *binding,
                visibility: wgpu::ShaderStages::COMPUTE,
                ty: wgpu::BindingType::Buffer {
                    ty: *ty,
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                count: None,
            });
        }
        let layout = |(group, entries)| (group, self.layouts.of(&self.device, entries));
        entries.into_iter().map(layout).collect()
    }

    fn compute_groups(
        &self,
        buffers: &[DeviceBuffer],
        layouts: &BTreeMap<u32, wgpu::BindGroupLayout>,
    ) -> Vec<(u32, wgpu::BindGroup)> {
        let group = |(index, layout): (&u32, &wgpu::BindGroupLayout)| {
            let own = buffers.iter().filter(|one| one.place.0 == *index);
            let entries: Vec<_> = own
                .map(|one| wgpu::BindGroupEntry {
                    binding: one.place.1,
                    resource: one.buffer.as_entire_binding(),
                })
                .collect();
            let descriptor = wgpu::BindGroupDescriptor { label: None, layout, entries: &entries };
            (*index, self.device.create_bind_group(&descriptor))
        };
        layouts.iter().map(group).collect()
    }
}

fn record_pass(
    encoder: &mut wgpu::CommandEncoder,
    pipeline: &wgpu::ComputePipeline,
    groups: &[(u32, wgpu::BindGroup)],
    ([x, y, z], immediates): ([u32; 3], &[u8]),
) {
    let mut pass = encoder.begin_compute_pass(&Default::default());
    pass.set_pipeline(pipeline);
    for (index, group) in groups {
        pass.set_bind_group(*index, group, &[]);
    }
    if !immediates.is_empty() {
        pass.set_immediates(0, immediates);
    }
    pass.dispatch_workgroups(x, y, z);
}

/// Whether outputs have immediates, and not a buffer in their place.
fn has_immediates(target: Target) -> bool {
    matches!(target, Target::WGSL | Target::SPIRV)
}

fn binding_type(binding: &Binding) -> wgpu::BufferBindingType {
    match binding.kind {
        BindingKind::Uniform | BindingKind::Immediate => wgpu::BufferBindingType::Uniform,
        _ => wgpu::BufferBindingType::Storage { read_only: !binding.writable },
    }
}
