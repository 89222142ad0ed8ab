//! The resources that a drawing's stages are bound to.

use std::collections::{BTreeMap, BTreeSet};

use super::super::{WgpuDevice, executor_failed, fixtures, pipeline};
use super::Groups;
use crate::fixture::{Address, Fixture, FixtureSampler};
use crate::frame::{BindingPlace, Buffers, DrawItem, Drawing};
use lamplight_diagnostic::Diagnostic;

/// The bindings that the stages use, with their textures and samplers uploaded.
pub struct Bindings {
    used: BTreeSet<BindingPlace>,
    kept: BTreeMap<BindingPlace, KeptResource>,
}

/// What keeps a binding's resource alive.
enum KeptResource {
    Buffer(wgpu::Buffer),
    View(wgpu::TextureView),
    Sampler(wgpu::Sampler),
}

impl Bindings {
    pub fn new(
        gpu: &WgpuDevice,
        drawing: &Drawing<'_>,
        used: BTreeSet<BindingPlace>,
    ) -> Result<Self, Diagnostic> {
        let mut kept = BTreeMap::new();
        for place in used.iter().filter(|place| !drawing.is_buffer(**place)) {
            kept.insert(*place, bound_fixture(gpu, drawing, *place)?);
        }
        Ok(Self { used, kept })
    }

    /// The bind groups of one item in one view.
    pub fn groups(
        &self,
        gpu: &WgpuDevice,
        drawing: &Drawing<'_>,
        view: &Buffers,
        item: &DrawItem<'_>,
        layout: &dyn Fn(u32) -> Option<wgpu::BindGroupLayout>,
    ) -> Result<Groups, Diagnostic> {
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
            let layout = layout(index)?;
            let descriptor =
                wgpu::BindGroupDescriptor { label: None, layout: &layout, entries: &entries };
            Some((index, gpu.device.create_bind_group(&descriptor)))
        };
        Ok(indices.into_iter().filter_map(group).collect())
    }

    /// Adds samplers that nothing reads at the unused bindings of its groups. wgpu numbers bindings
    /// without gaps, but a shipped stage has the author's numbers.
    pub fn without_gaps(mut self, gpu: &WgpuDevice) -> Self {
        let last: BTreeMap<u32, u32> = self.used.iter().copied().collect();
        for place in last.iter().flat_map(|(group, last)| (0..*last).map(|one| (*group, one))) {
            if !self.used.contains(&place) {
                let settings =
                    FixtureSampler { compare: None, linear: false, address: Address::Clamp };
                let sampler = fixtures::create_sampler(&gpu.device, settings);
                self.kept.insert(place, KeptResource::Sampler(sampler));
            }
        }
        self
    }

    /// The layouts of all groups.
    pub fn layouts(
        &self,
        gpu: &WgpuDevice,
        drawing: &Drawing<'_>,
    ) -> BTreeMap<u32, wgpu::BindGroupLayout> {
        let places: BTreeSet<BindingPlace> =
            self.used.iter().chain(self.kept.keys()).copied().collect();
        let fixture = |place: &BindingPlace| drawing.fixtures.get(place).map(|fixture| &**fixture);
        // Not every device can filter f32 textures, so filtering is asked for only where a stage
        // filters.
        let is_filter = |fixture: &Fixture| matches!(fixture, Fixture::Sampler(one) if one.linear && one.compare.is_none());
        let filters = self.used.iter().filter_map(fixture).any(is_filter);
        let entry = |place: &BindingPlace| wgpu::BindGroupLayoutEntry {
            binding: place.1,
            visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
            ty: match (self.used.contains(place), fixture(place)) {
                (true, Some(fixture)) => binding_type(fixture, filters),
                (true, None) => UNIFORM,
                (false, _) => wgpu::BindingType::Sampler(wgpu::SamplerBindingType::NonFiltering),
            },
            count: None,
        };
        let groups: BTreeSet<u32> = places.iter().map(|(group, _)| *group).collect();
        let layout = |group: u32| {
            let own = places.iter().filter(|(other, _)| *other == group);
            (group, gpu.layouts.of(&gpu.device, own.map(entry).collect()))
        };
        groups.into_iter().map(layout).collect()
    }

    fn buffers(
        &self,
        gpu: &WgpuDevice,
        drawing: &Drawing<'_>,
        view: &Buffers,
        item: &DrawItem<'_>,
    ) -> Result<BTreeMap<BindingPlace, KeptResource>, Diagnostic> {
        let places = self.used.iter().filter(|place| !self.kept.contains_key(place));
        let buffer = |place: &BindingPlace| {
            let bytes =
                drawing.buffer(view, item, *place).ok_or_else(|| missing_binding(*place))?;
            Ok((
                *place,
                KeptResource::Buffer(
                    gpu.buffer(bytes, wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::STORAGE),
                ),
            ))
        };
        places.map(buffer).collect()
    }
}

impl KeptResource {
    fn resource(&self) -> wgpu::BindingResource<'_> {
        match self {
            Self::Buffer(buffer) => buffer.as_entire_binding(),
            Self::View(view) => wgpu::BindingResource::TextureView(view),
            Self::Sampler(sampler) => wgpu::BindingResource::Sampler(sampler),
        }
    }
}

const UNIFORM: wgpu::BindingType = wgpu::BindingType::Buffer {
    ty: wgpu::BufferBindingType::Uniform,
    has_dynamic_offset: false,
    min_binding_size: None,
};

fn binding_type(fixture: &Fixture, filterable: bool) -> wgpu::BindingType {
    match fixture {
        Fixture::Texture(texture) => {
            let is_cube = texture.kind.layers() == 6;
            let dimension = if is_cube {
                wgpu::TextureViewDimension::Cube
            } else {
                wgpu::TextureViewDimension::D2
            };
            let sample = match texture.kind.is_depth() {
                true => wgpu::TextureSampleType::Depth,
                false => wgpu::TextureSampleType::Float { filterable },
            };
            pipeline::texture_type(sample, dimension)
        }
        Fixture::Sampler(settings) => pipeline::sampler_type(*settings),
    }
}

fn bound_fixture(
    gpu: &WgpuDevice,
    drawing: &Drawing<'_>,
    place: BindingPlace,
) -> Result<KeptResource, Diagnostic> {
    match drawing.fixtures.get(&place).map(|fixture| &**fixture) {
        Some(Fixture::Texture(texture)) => {
            let levels = drawing.levels.get(&place).map_or(&[][..], Vec::as_slice);
            Ok(KeptResource::View(fixtures::upload_levels(
                &gpu.device,
                &gpu.queue,
                texture,
                levels,
            )))
        }
        Some(Fixture::Sampler(sampler)) => {
            Ok(KeptResource::Sampler(fixtures::create_sampler(&gpu.device, *sampler)))
        }
        None => Err(missing_binding(place)),
    }
}

fn missing_binding(place: BindingPlace) -> Diagnostic {
    executor_failed(format!("nothing is given for group {}, binding {}", place.0, place.1))
}
