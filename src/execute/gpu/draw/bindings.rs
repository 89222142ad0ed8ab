//! What a drawing's stages are bound to.

use std::collections::{BTreeMap, BTreeSet};

use super::super::{Gpu, failed, fixtures};
use crate::diagnostic::Diagnostic;
use crate::execute::fixture::Fixture;
use crate::execute::frame::{Buffers, Drawing, Item, Place};

/// The places that the stages use, their textures and samplers uploaded.
pub struct Bindings {
    used: BTreeSet<Place>,
    kept: BTreeMap<Place, Kept>,
}

/// What a binding keeps alive.
enum Kept {
    Buffer(wgpu::Buffer),
    View(wgpu::TextureView),
    Sampler(wgpu::Sampler),
}

impl Bindings {
    pub fn new(
        gpu: &Gpu,
        drawing: &Drawing<'_>,
        used: BTreeSet<Place>,
    ) -> Result<Self, Diagnostic> {
        let mut kept = BTreeMap::new();
        for place in used.iter().filter(|place| !drawing.is_buffer(**place)) {
            kept.insert(*place, fixture(gpu, drawing, *place)?);
        }
        Ok(Self { used, kept })
    }

    /// The bind groups of one item in one view.
    pub fn groups(
        &self,
        gpu: &Gpu,
        drawing: &Drawing<'_>,
        view: &Buffers,
        item: &Item<'_>,
        pipeline: &wgpu::RenderPipeline,
    ) -> Result<Vec<(u32, wgpu::BindGroup)>, Diagnostic> {
        let buffers = self.buffers(gpu, drawing, view, item)?;
        let indices: BTreeSet<u32> = self.used.iter().map(|(group, _)| *group).collect();
        let group = |index: u32| {
            let own = buffers.iter().chain(&self.kept).filter(|((group, _), _)| *group == index);
            let entries: Vec<_> = own
                .map(|((_, binding), kept)| wgpu::BindGroupEntry {
                    binding: *binding,
                    resource: kept.resource(),
                })
                .collect();
            let layout = &pipeline.get_bind_group_layout(index);
            (
                index,
                gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                    label: None,
                    layout,
                    entries: &entries,
                }),
            )
        };
        Ok(indices.into_iter().map(group).collect())
    }

    fn buffers(
        &self,
        gpu: &Gpu,
        drawing: &Drawing<'_>,
        view: &Buffers,
        item: &Item<'_>,
    ) -> Result<BTreeMap<Place, Kept>, Diagnostic> {
        let places = self.used.iter().filter(|place| !self.kept.contains_key(place));
        let buffer = |place: &Place| {
            let bytes = drawing.buffer(view, item, *place).ok_or_else(|| missing(*place))?;
            Ok((
                *place,
                Kept::Buffer(
                    gpu.buffer(bytes, wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::STORAGE),
                ),
            ))
        };
        places.map(buffer).collect()
    }
}

impl Kept {
    fn resource(&self) -> wgpu::BindingResource<'_> {
        match self {
            Self::Buffer(buffer) => buffer.as_entire_binding(),
            Self::View(view) => wgpu::BindingResource::TextureView(view),
            Self::Sampler(sampler) => wgpu::BindingResource::Sampler(sampler),
        }
    }
}

fn fixture(gpu: &Gpu, drawing: &Drawing<'_>, place: Place) -> Result<Kept, Diagnostic> {
    match drawing.fixtures.get(&place).map(|fixture| &**fixture) {
        Some(Fixture::Texture(texture)) => {
            let levels = drawing.levels.get(&place).map_or(&[][..], Vec::as_slice);
            Ok(Kept::View(fixtures::upload_levels(&gpu.device, &gpu.queue, texture, levels)))
        }
        Some(Fixture::Sampler(sampler)) => {
            Ok(Kept::Sampler(fixtures::sampler(&gpu.device, *sampler)))
        }
        None => Err(missing(place)),
    }
}

fn missing(place: Place) -> Diagnostic {
    failed(format!("nothing is given for group {}, binding {}", place.0, place.1))
}
