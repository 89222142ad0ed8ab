//! The sampler heaps of HLSL, bound on a Vulkan device.
//!
//! | binding | holds |
//! |---|---|
//! | 0 | the heap of samplers |
//! | 1 | the heap of comparison samplers |
//! | 2 + N | for group N, the place of each sampler in its heap
//!
//! All other elements of a heap are samplers that give other results. So an index that was read
//! from the wrong place changes the picture.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::num::NonZeroU32;
use std::sync::Mutex;

use wgpu::util::DeviceExt as _;

use super::{fixtures, lock_mutex};
use crate::fixture::{Address, Compare, FixtureSampler};
use lamplight_bundle::{HeapSampler, SamplerHeap};

/// Bindings before those of the index buffers.
const HEAPS: u32 = 2;
/// The place of the first sampler in a heap, and the distance to the next one.
const FIRST: u32 = 5;
const STEP: u32 = 7;

/// The name of each heap and of each index buffer in the output, with its binding.
pub fn heap_bindings(heaps: &[SamplerHeap]) -> impl Iterator<Item = (String, u32)> {
    let samplers = heaps.iter().flat_map(|heap| &heap.samplers);
    let buffers = samplers.map(|sampler| {
        (format!("nagaGroup{}SamplerIndexArray", sampler.group), HEAPS + sampler.group)
    });
    heaps.iter().map(|heap| (heap.name.clone(), u32::from(heap.comparison))).chain(buffers)
}

/// A bind group with the heaps of all stages, and its layout.
#[derive(Clone)]
pub struct HeapGroup {
    pub layout: wgpu::BindGroupLayout,
    pub group: wgpu::BindGroup,
}

/// The heaps of all stages, and the settings of the sampler at each group and binding.
type HeapContents = (Vec<SamplerHeap>, BTreeMap<[u32; 2], FixtureSampler>);

/// The bind groups with heaps of a device. They are kept, since a driver on the CPU clears the memory
/// of many heaps for each new one.
#[derive(Default)]
pub struct HeapGroups {
    known: Mutex<HashMap<HeapContents, HeapGroup>>,
}

impl HeapGroups {
    /// The bind group with heaps. `sampler` gives the sampler at a group and a binding.
    pub fn bind(
        &self,
        device: &wgpu::Device,
        heaps: &[SamplerHeap],
        sampler: &dyn Fn([u32; 2]) -> Option<FixtureSampler>,
    ) -> Result<HeapGroup, String> {
        let settings = all_samplers(heaps).map(|HeapSampler { group, binding, .. }| {
            let lacks = || format!("no sampler for group {group}, binding {binding}");
            Ok(([*group, *binding], sampler([*group, *binding]).ok_or_else(lacks)?))
        });
        let contents = (heaps.to_vec(), settings.collect::<Result<_, String>>()?);
        let mut known = lock_mutex(&self.known);
        let bound = known
            .entry(contents)
            .or_insert_with_key(|(heaps, settings)| bind_heaps(device, heaps, settings));
        Ok(bound.clone())
    }
}

fn bind_heaps(
    device: &wgpu::Device,
    heaps: &[SamplerHeap],
    settings: &BTreeMap<[u32; 2], FixtureSampler>,
) -> HeapGroup {
    let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &layout_entries(heaps),
    });
    let places = sampler_places(heaps);
    let arrays =
        [false, true].map(|comparison| heap_samplers(device, heaps, comparison, &places, settings));
    let arrays = arrays.each_ref().map(|array| array.iter().collect::<Vec<_>>());
    let buffers: Vec<_> =
        index_numbers(heaps, &places).iter().map(|numbers| index_buffer(device, numbers)).collect();
    let of_arrays = arrays.iter().map(|array| wgpu::BindingResource::SamplerArray(array));
    let of_buffers = buffers.iter().map(wgpu::Buffer::as_entire_binding);
    let entries: Vec<_> = (0..)
        .zip(of_arrays.chain(of_buffers))
        .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
        .collect();
    let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &layout,
        entries: &entries,
    });
    HeapGroup { layout, group }
}

/// Bindings without gaps, as wgpu numbers them: both heaps, and an index buffer for each group up
/// to the last.
fn layout_entries(heaps: &[SamplerHeap]) -> Vec<wgpu::BindGroupLayoutEntry> {
    let array = |kind| (wgpu::BindingType::Sampler(kind), NonZeroU32::new(heap_size(heaps)));
    let numbers = wgpu::BindingType::Buffer {
        ty: wgpu::BufferBindingType::Storage { read_only: true },
        has_dynamic_offset: false,
        min_binding_size: None,
    };
    let kinds = [wgpu::SamplerBindingType::Filtering, wgpu::SamplerBindingType::Comparison];
    let types =
        kinds.map(array).into_iter().chain((0..group_count(heaps)).map(|_| (numbers, None)));
    let entry = |(binding, (ty, count))| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
        ty,
        count,
    };
    (0..).zip(types).map(entry).collect()
}

fn heap_samplers(
    device: &wgpu::Device,
    heaps: &[SamplerHeap],
    comparison: bool,
    places: &BTreeMap<[u32; 2], u32>,
    settings: &BTreeMap<[u32; 2], FixtureSampler>,
) -> Vec<wgpu::Sampler> {
    let mut array = vec![
        fixtures::create_sampler(device, decoy_sampler(comparison));
        heap_size(heaps) as usize
    ];
    let own = heaps.iter().filter(|heap| heap.comparison == comparison);
    for HeapSampler { group, binding, .. } in own.flat_map(|heap| &heap.samplers) {
        let place = [*group, *binding];
        array[places[&place] as usize] = fixtures::create_sampler(device, settings[&place]);
    }
    array
}

/// How many elements each heap has.
fn heap_size(heaps: &[SamplerHeap]) -> u32 {
    heaps.iter().map(|heap| heap.size).max().unwrap_or(1)
}

fn all_samplers(heaps: &[SamplerHeap]) -> impl Iterator<Item = &HeapSampler> {
    heaps.iter().flat_map(|heap| &heap.samplers)
}

/// How many groups there are, up to the last one that has samplers.
fn group_count(heaps: &[SamplerHeap]) -> u32 {
    all_samplers(heaps).map(|sampler| sampler.group + 1).max().unwrap_or(0)
}

/// The place of each sampler in its heap.
fn sampler_places(heaps: &[SamplerHeap]) -> BTreeMap<[u32; 2], u32> {
    let all: BTreeSet<[u32; 2]> =
        all_samplers(heaps).map(|sampler| [sampler.group, sampler.binding]).collect();
    all.into_iter().zip((FIRST..).step_by(STEP as usize)).collect()
}

/// The content of each group's index buffer, which has at least one number.
fn index_numbers(heaps: &[SamplerHeap], places: &BTreeMap<[u32; 2], u32>) -> Vec<Vec<u32>> {
    let mut numbers = vec![vec![0]; group_count(heaps) as usize];
    for sampler in all_samplers(heaps) {
        let own = &mut numbers[sampler.group as usize];
        own.resize(own.len().max(sampler.element as usize + 1), 0);
        own[sampler.element as usize] = places[&[sampler.group, sampler.binding]];
    }
    numbers
}

fn index_buffer(device: &wgpu::Device, numbers: &[u32]) -> wgpu::Buffer {
    device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: None,
        contents: &numbers.iter().flat_map(|number| number.to_le_bytes()).collect::<Vec<u8>>(),
        usage: wgpu::BufferUsages::STORAGE,
    })
}

/// A sampler with settings that no case uses.
fn decoy_sampler(comparison: bool) -> FixtureSampler {
    let compare = comparison.then_some(Compare::Greater);
    FixtureSampler { compare, linear: false, address: Address::Mirror }
}
