//! Tests the reflection by using it, as an engine would. The bundle is read through the loader, and
//! layouts, vertex buffers and targets come from the reflection alone. wgpu accepts a pipeline only
//! if they fit what it reads from the shader itself.

mod described;

use std::collections::{BTreeMap, BTreeSet};
use std::time::Instant;

use lamplight::bundle::{
    Binding, Bundle, Found, Language, Program as Loaded, Reflection, Stage, Target, pack,
};
use lamplight::diagnostic::render::{Form, render};
use lamplight::generate::{Request, in_memory};
use lamplight::permute::{Manifest, cover};
use lamplight::project;
use libtest_mimic::{Failed, Trial};
use pollster::block_on;

use described::{attributes, depth, entry, fill, targets};

/// An environment variable. If it is set, every permutation that ships is tested. Otherwise a set
/// that covers all pairs of values is.
const EVERYTHING: &str = "LAMPLIGHT_EVERY_PIPELINE";

const BACKENDS: [(&str, wgpu::Backends); 2] =
    [("vulkan", wgpu::Backends::VULKAN), ("gl", wgpu::Backends::GL)];

/// The number of pairs of stages for one device. Drivers free the memory of pipelines only when the
/// device is dropped.
const A_DEVICE: usize = 128;

/// A mistake in a reflection: its description, the pair of stages, and the change.
type Change<'a> = (&'static str, &'a Pair, &'a dyn Fn(&mut Reflection));

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("pipelines::from_the_reflection_alone", pipelines),
        Trial::test("pipelines::a_wrong_reflection_is_noticed", wrong_reflections),
    ]
}

/// wgpu creates a pipeline for every pair of stages, from WGSL on both backends, and from SPIR-V on
/// Vulkan. By day, each backend takes every second pair, the other ones of the other.
fn pipelines() -> Result<(), Failed> {
    let start = Instant::now();
    let bundle = bundle(std::env::var_os(EVERYTHING).is_some())?;
    let generated = start.elapsed();
    for (turn, (name, backend)) in BACKENDS.into_iter().enumerate() {
        let pairs = every_pair(&bundle)?.into_iter().enumerate();
        let is_taken = |index: usize| crate::is_whole() || index % BACKENDS.len() == turn;
        let pairs: Vec<Pair> =
            pairs.filter(|(index, _)| is_taken(*index)).map(|(_, pair)| pair).collect();
        let mut count = 0;
        for some in pairs.chunks(A_DEVICE) {
            let device = Device::open(backend)?;
            if name == "vulkan" && !device.spirv {
                return Err("the Vulkan device does not take SPIR-V".into());
            }
            for pair in some {
                device
                    .accepts(pair, false)
                    .map_err(|error| format!("{name}, {}: {error}", pair.title))?;
                count += 1;
                if device.spirv {
                    device
                        .accepts(pair, true)
                        .map_err(|error| format!("{name}, SPIR-V, {}: {error}", pair.title))?;
                    count += 1;
                }
            }
            println!(
                "{name}: {count} pipelines after {:.1?} (bundle: {generated:.1?})",
                start.elapsed()
            );
        }
    }
    Ok(())
}

/// wgpu refuses pipelines whose reflection is wrong. The first test relies on that.
fn wrong_reflections() -> Result<(), Failed> {
    let bundle = bundle(false)?;
    let device = Device::open(wgpu::Backends::VULKAN)?;
    let pairs = every_pair(&bundle)?;
    let find = |wanted: &dyn Fn(&Pair) -> bool| {
        pairs.iter().find(|pair| wanted(pair)).cloned().ok_or("no such permutation")
    };
    let is_depth = |binding: &Binding| binding.ty.starts_with("texture_depth");
    let mut shadowed = find(&|pair| {
        pair.fragment.as_ref().is_some_and(|found| found.reflection.bindings.iter().any(is_depth))
    })?;
    let lit = find(&|pair| pair.title.starts_with("forward"))?;
    let changes: [Change<'_>; 5] = [
        ("a binding is missing", &lit, &|reflection| reflection.bindings.truncate(1)),
        ("a buffer is too small", &lit, &|reflection| {
            reflection
                .bindings
                .iter_mut()
                .for_each(|binding| binding.size = binding.size.map(|size| size - 16))
        }),
        ("an input is missing", &lit, &|reflection| reflection.inputs.truncate(1)),
        ("an input has another type", &lit, &|reflection| {
            reflection.inputs.iter_mut().for_each(|input| "u32".clone_into(&mut input.ty))
        }),
        ("a group is another", &lit, &|reflection| {
            reflection.bindings.iter_mut().for_each(|binding| binding.group += 1)
        }),
    ];
    for (what, pair, change) in changes {
        let mut pair = pair.clone();
        change(std::sync::Arc::make_mut(&mut pair.vertex.reflection));
        if device.accepts(&pair, false).is_ok() {
            return Err(format!("{}: wgpu should refuse it: {what}", pair.title).into());
        }
    }
    let fragment = shadowed.fragment.as_mut().ok_or("no fragment stage")?;
    let bindings = &mut std::sync::Arc::make_mut(&mut fragment.reflection).bindings;
    bindings
        .iter_mut()
        .filter(|binding| is_depth(binding))
        .for_each(|binding| "texture_2d<f32>".clone_into(&mut binding.ty));
    if device.accepts(&shadowed, false).is_ok() {
        Err("wgpu should refuse a depth texture that the reflection calls a colour".into())
    } else {
        Ok(())
    }
}

/// The library's bundle: every permutation that ships, or a set that covers all pairs of values.
fn bundle(everything: bool) -> Result<Bundle, Failed> {
    let (mut sources, mut manifest) = project::library_manifest()
        .map_err(|(sources, problems)| render(&sources, &problems, Form::Human))?;
    for program in &mut manifest.programs {
        program.targets = vec![Target::WGSL, Target::SPIRV];
        if !everything {
            program.space = cover::covering_space(program);
        }
    }
    let generated = generated(&mut sources, &manifest);
    let contents = generated.map_err(|problems| render(&sources, &problems, Form::Human))?;
    Ok(Bundle::from_bytes(pack(&contents)?)?)
}

fn generated(
    sources: &mut lamplight::source::SourceSet,
    manifest: &Manifest,
) -> Result<lamplight::bundle::Contents, lamplight::diagnostic::Diagnostics> {
    Ok(in_memory(sources, &project::library_packages(), manifest, &Request::default(), &|_| ())?
        .contents)
}

/// The stages of one permutation in one language, in both targets.
#[derive(Clone)]
struct Pair {
    title: String,
    vertex: Found,
    fragment: Option<Found>,
    spirv: [Option<Found>; 2],
}

/// The stages of every permutation. Permutations with the same shaders are taken once.
fn every_pair(bundle: &Bundle) -> Result<Vec<Pair>, Failed> {
    let mut pairs = Vec::new();
    for name in bundle.programs() {
        let program = bundle.program(name)?;
        for language in [Language::Wesl, Language::Glsl] {
            pairs_of(&program, language, &mut pairs)?;
        }
    }
    Ok(pairs)
}

fn pairs_of(program: &Loaded<'_>, language: Language, pairs: &mut Vec<Pair>) -> Result<(), Failed> {
    let names: Vec<&str> =
        program.entries().filter(|(found, _)| *found == language).map(|(_, name)| name).collect();
    let shaders =
        names.iter().map(|name| program.entry(language, name)).collect::<Result<Vec<_>, _>>()?;
    let mut seen = BTreeSet::new();
    for key in shaders[0].keys()? {
        let units =
            shaders.iter().map(|shader| shader.find(&key)).collect::<Result<Vec<_>, _>>()?;
        if !seen.insert(units) {
            continue;
        }
        let stages = |target| -> Result<[Option<Found>; 2], Failed> {
            let mut stages = [None, None];
            for shader in &shaders {
                let found = shader.get(&key, target)?;
                let stage = usize::from(found.reflection.stage == Stage::Fragment);
                stages[stage] = Some(found);
            }
            Ok(stages)
        };
        let [vertex, fragment] = stages(Target::WGSL)?;
        let title = format!("{} {language:?} {key}", program.name());
        pairs.push(Pair {
            vertex: vertex.ok_or_else(|| format!("{title} has no vertex stage"))?,
            title,
            fragment,
            spirv: stages(Target::SPIRV)?,
        });
    }
    Ok(())
}

struct Device {
    device: wgpu::Device,
    /// Whether the device accepts SPIR-V without translating it.
    spirv: bool,
}

impl Device {
    fn open(backend: wgpu::Backends) -> Result<Self, Failed> {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor {
            backends: backend,
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        });
        let mut adapters = block_on(instance.enumerate_adapters(backend));
        // Other tests of this process add SwiftShader to the Vulkan loader's drivers.
        adapters.retain(|adapter| !adapter.get_info().name.contains("SwiftShader"));
        adapters.sort_by_key(|adapter| adapter.get_info().device_type != wgpu::DeviceType::Cpu);
        let adapter = adapters
            .into_iter()
            .next()
            .ok_or_else(|| format!("no adapter for {backend:?}: cargo xtask test installs one"))?;
        let descriptor = wgpu::DeviceDescriptor {
            required_features: adapter.features() & wgpu::Features::PASSTHROUGH_SHADERS,
            required_limits: adapter.limits(),
            // SAFETY: the shaders that pass through were written by naga and validated.
            experimental_features: unsafe { wgpu::ExperimentalFeatures::enabled() },
            ..Default::default()
        };
        let (device, _) = block_on(adapter.request_device(&descriptor))?;
        let spirv = backend == wgpu::Backends::VULKAN
            && device.features().contains(wgpu::Features::PASSTHROUGH_SHADERS);
        Ok(Self { device, spirv })
    }

    /// Creates the pipeline, or gives the reason why wgpu refuses it.
    fn accepts(&self, pair: &Pair, spirv: bool) -> Result<(), String> {
        let scope = self.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let internal = self.device.push_error_scope(wgpu::ErrorFilter::Internal);
        let created = self.create(pair, spirv);
        let errors = [block_on(internal.pop()), block_on(scope.pop())];
        created?;
        errors.into_iter().flatten().next().map_or(Ok(()), |error| Err(error.to_string()))
    }

    fn create(&self, pair: &Pair, spirv: bool) -> Result<(), String> {
        let stages = || std::iter::once(&pair.vertex).chain(&pair.fragment);
        let layout = self.layout(stages().map(|found| &*found.reflection), spirv)?;
        let modules: Vec<_> = if spirv {
            let words = pair.spirv.iter().flatten();
            words.map(|found| self.passed(found)).collect::<Result<_, _>>()?
        } else {
            stages().map(|found| self.module(found)).collect::<Result<_, _>>()?
        };
        let attributes = attributes(&pair.vertex.reflection.inputs)?;
        let ends = attributes.iter().map(|found| found.offset + found.format.size());
        let buffer = wgpu::VertexBufferLayout {
            array_stride: ends.max().unwrap_or(0),
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &attributes,
        };
        let fragment = pair.fragment.as_ref();
        let targets =
            fragment.map_or(Ok(Vec::new()), |found| targets(&found.reflection.outputs))?;
        let _pipeline = self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &modules[0],
                entry_point: Some(&pair.vertex.native.entry_name),
                compilation_options: Default::default(),
                buffers: &[(!attributes.is_empty()).then_some(buffer)],
            },
            primitive: Default::default(),
            depth_stencil: Some(depth()),
            multisample: Default::default(),
            fragment: fragment.map(|found| wgpu::FragmentState {
                module: &modules[1],
                entry_point: Some(&found.native.entry_name),
                compilation_options: Default::default(),
                targets: &targets,
            }),
            multiview_mask: None,
            cache: None,
        });
        Ok(())
    }

    fn module(&self, found: &Found) -> Result<wgpu::ShaderModule, String> {
        let text = std::str::from_utf8(&found.bytes).map_err(|error| error.to_string())?;
        let source = wgpu::ShaderSource::Wgsl(text.into());
        Ok(self.device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source }))
    }

    fn passed(&self, found: &Found) -> Result<wgpu::ShaderModule, String> {
        let words: Vec<u32> =
            found.bytes.as_chunks::<4>().0.iter().map(|bytes| u32::from_le_bytes(*bytes)).collect();
        let entry = wgpu::PassthroughShaderEntryPoint {
            name: found.native.entry_name.as_str().into(),
            workgroup_size: (0, 0, 0),
        };
        let descriptor = wgpu::ShaderModuleDescriptorPassthrough {
            entry_points: std::slice::from_ref(&entry).into(),
            spirv: Some(words.into()),
            ..Default::default()
        };
        // SAFETY: naga wrote the words from a valid module.
        Ok(unsafe { self.device.create_shader_module_passthrough(descriptor) })
    }

    /// One layout for both stages, since they share their groups. wgpu numbers the bindings of a
    /// Vulkan layout without gaps, and renumbers those of shaders that it translates itself. For
    /// SPIR-V, which it does not translate, bindings that no stage can see fill the gaps.
    fn layout<'a>(
        &self,
        stages: impl Iterator<Item = &'a Reflection>,
        without_gaps: bool,
    ) -> Result<wgpu::PipelineLayout, String> {
        let mut groups: BTreeMap<u32, BTreeMap<u32, wgpu::BindGroupLayoutEntry>> = BTreeMap::new();
        for reflection in stages {
            for binding in &reflection.bindings {
                let entry = entry(binding, reflection)?;
                let known = groups
                    .entry(binding.group)
                    .or_default()
                    .entry(binding.binding)
                    .or_insert(entry);
                known.visibility |= entry.visibility;
                if known.ty != entry.ty {
                    return Err(format!("the stages disagree about `{}`", binding.name));
                }
            }
        }
        if without_gaps {
            groups.values_mut().for_each(fill);
        }
        let last = groups.last_key_value().map_or(0, |(group, _)| group + 1);
        let layouts: Vec<Option<wgpu::BindGroupLayout>> =
            (0..last).map(|group| Some(self.group(groups.get(&group)?))).collect();
        let layouts: Vec<Option<&wgpu::BindGroupLayout>> =
            layouts.iter().map(Option::as_ref).collect();
        let descriptor = wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &layouts,
            immediate_size: 0,
        };
        Ok(self.device.create_pipeline_layout(&descriptor))
    }

    fn group(&self, entries: &BTreeMap<u32, wgpu::BindGroupLayoutEntry>) -> wgpu::BindGroupLayout {
        let entries: Vec<_> = entries.values().copied().collect();
        self.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: None,
            entries: &entries,
        })
    }
}
