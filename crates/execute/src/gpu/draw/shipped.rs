//! Draws frames from the bytes of a bundle: from WGSL, and from everything that can become SPIR-V.

use std::collections::BTreeSet;

use super::super::passthrough::{SpirvBinary, hlsl_lacks};
use super::super::{Shaders, WgpuDevice, executor_failed, lock_mutex};
use super::{LAVAPIPE_BLOCKS, Meshes, StageModules};
use crate::ShippedPair;
use crate::frame::{BindingPlace, Drawing, Frame};
use crate::gpu::draw::Bindings;
use crate::gpu::draw::Targets;
use crate::shipped::{ColorFormat, Shipped};
use lamplight_bundle::{BindingKind, SamplerHeap, Stage, Target};
use lamplight_diagnostic::{Diagnostic, codes};

/// A stage as a shader module of the device.
struct Loaded {
    module: wgpu::ShaderModule,
    entry: String,
    heaps: Vec<SamplerHeap>,
}

impl WgpuDevice {
    /// Draws the frame of each view with shipped stages, and reads it back.
    pub fn shipped_frames(
        &self,
        pair: ShippedPair<'_>,
        drawing: &Drawing<'_>,
    ) -> Result<Vec<Frame>, Diagnostic> {
        self.can_draw(pair)?;
        let formats = pair.fragment.targets().map_err(executor_failed)?;
        let frames = self.guarded(|gpu| gpu.submit_shipped(pair, drawing, &formats))??;
        frames.into_iter().map(|frame| frame.read(self, None)).collect()
    }

    fn can_draw(&self, pair: ShippedPair<'_>) -> Result<(), Diagnostic> {
        let own = match self.shaders {
            Shaders::Translated | Shaders::Written => Target::WGSL,
            Shaders::Emitted(target) => target,
        };
        let stages = [pair.vertex, pair.fragment];
        if let Some(stage) = stages.iter().find(|stage| stage.target != own) {
            return Err(executor_failed(format!("this executor draws no {}", stage.target)));
        }
        if let Some(reason) = stages.into_iter().find_map(stage_lacks) {
            return Err(Diagnostic::error(codes::EXECUTOR_LACKS, reason));
        }
        if self.is_lavapipe() && stages.iter().any(|one| one.blocks().count() > LAVAPIPE_BLOCKS) {
            let message = "lavapipe crashes where a branch reads a stage's fourth uniform block";
            return Err(Diagnostic::error(codes::EXECUTOR_LACKS, message));
        }
        Ok(())
    }

    fn submit_shipped(
        &self,
        pair: ShippedPair<'_>,
        drawing: &Drawing<'_>,
        formats: &[ColorFormat],
    ) -> Result<Vec<super::Pending>, Diagnostic> {
        let used = read_places(pair);
        let group = used.iter().map(|(group, _)| group + 1).max().unwrap_or(0);
        let vertex = self.loaded(pair.vertex, group)?;
        let fragment = self.loaded(pair.fragment, group)?;
        let bindings = Bindings::new(self, drawing, used)?.without_gaps(self);
        let layouts = bindings.layouts(self, drawing);
        let all = [vertex.heaps, fragment.heaps].concat();
        let heaps = if all.is_empty() {
            None
        } else {
            let sampler = |place: [u32; 2]| drawing.sampler_at(place);
            Some(self.heaps.bind(&self.device, &all, &sampler).map_err(executor_failed)?)
        };
        let mut in_order: Vec<Option<&wgpu::BindGroupLayout>> =
            (0..group).map(|index| layouts.get(&index)).collect();
        in_order.extend(heaps.as_ref().map(|bound| Some(&bound.layout)));
        let layout = self.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &in_order,
            immediate_size: 0,
        });
        let stages = StageModules {
            vertex: (&vertex.module, &vertex.entry),
            fragment: Some((&fragment.module, &fragment.entry)),
        };
        let pipeline = self.mesh_pipeline(drawing, stages, Some(&layout), formats);
        let meshes = Meshes::new(self, drawing);
        let targets = Targets::new(&self.device, drawing, formats);
        let mut frames = Vec::new();
        for view in drawing.views {
            let groups: Vec<_> = drawing
                .items
                .iter()
                .map(|item| {
                    let layout = |index| layouts.get(&index).cloned();
                    let mut groups = bindings.groups(self, drawing, view, item, &layout)?;
                    groups.extend(heaps.as_ref().map(|bound| (group, bound.group.clone())));
                    Ok(groups)
                })
                .collect::<Result<_, Diagnostic>>()?;
            frames.push(meshes.pass(self, &targets, &pipeline, &groups));
        }
        Ok(frames)
    }

    /// Loads the stage in the form that the driver accepts. Sampler heaps go into the bind group
    /// `heaps`.
    fn loaded(&self, shipped: &Shipped, heaps: u32) -> Result<Loaded, Diagnostic> {
        let Shipped { target, native, reflection, .. } = shipped;
        if *target == Target::WGSL {
            let source = wgpu::ShaderSource::Wgsl(shipped.text());
            let descriptor = wgpu::ShaderModuleDescriptor { label: None, source };
            let module = self.device.create_shader_module(descriptor);
            return Ok(Loaded { module, entry: native.entry_name.clone(), heaps: Vec::new() });
        }
        let binary = self.binary(shipped, heaps)?;
        let label = if reflection.stage == Stage::Vertex { "vertex" } else { "fragment" };
        let module = binary.module(&self.device, label);
        Ok(Loaded { module, entry: binary.entry().to_owned(), heaps: binary.heaps })
    }
}

impl WgpuDevice {
    /// The stage as SPIR-V. Results are kept, since many drawings share a vertex stage and
    /// translating HLSL runs two programs.
    fn binary(&self, shipped: &Shipped, heaps: u32) -> Result<SpirvBinary, Diagnostic> {
        let key = (shipped.bytes.clone(), heaps);
        if let Some(known) = lock_mutex(&self.binaries).get(&key) {
            return Ok(known.clone());
        }
        let Shipped { target, bytes, native, reflection } = shipped;
        let binary = SpirvBinary::new(*target, reflection.stage, bytes, native, heaps);
        let binary = binary.map_err(executor_failed)?;
        lock_mutex(&self.binaries).insert(key, binary.clone());
        Ok(binary)
    }
}

/// Why the stage cannot be drawn here, if something in it is not supported.
fn stage_lacks(stage: &Shipped) -> Option<&'static str> {
    match stage.target {
        Target::WGSL | Target::SPIRV
            if stage.reflection.bindings.iter().any(|one| one.kind == BindingKind::Immediate) =>
        {
            Some("immediates are set for compute stages only")
        }
        Target::WGSL if stage.reflection.stage == Stage::Fragment => stage.lacks_of_webgpu(),
        Target::HLSL => hlsl_lacks(&stage.text()),
        _ => None,
    }
}

/// The bindings of both stages.
fn read_places(pair: ShippedPair<'_>) -> BTreeSet<BindingPlace> {
    let stages = [pair.vertex, pair.fragment].into_iter();
    stages
        .flat_map(|stage| &stage.reflection.bindings)
        .map(|binding| (binding.group, binding.binding))
        .collect()
}
