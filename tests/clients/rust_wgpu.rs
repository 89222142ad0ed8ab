//! Draws the scene with wgpu on lavapipe, by `lamplight-wgpu`.

use lamplight::bundle::{Binding, Bundle, Language, Target}; // lamplight
use lamplight_wgpu::{Block, PipelineLayout, Stage, pipeline_layout, vertex_attributes}; // lamplight
use libtest_mimic::Failed;
use wgpu::util::DeviceExt as _;

use super::{HEIGHT, WIDTH};

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8Unorm;

const VERTICES: [[f32; 5]; 6] = [
    [-0.9, -0.7, 0.1, 0.0, 1.0],
    [0.8, -0.8, 0.0, 1.0, 1.0],
    [0.7, 0.9, 0.2, 1.0, 0.0],
    [-0.9, -0.7, 0.1, 0.0, 1.0],
    [0.7, 0.9, 0.2, 1.0, 0.0],
    [-0.5, 0.4, 0.0, 0.0, 0.0],
];

const IMAGE: [[u8; 3]; 12] = [
    [255, 40, 30],
    [40, 200, 60],
    [50, 60, 220],
    [240, 230, 40],
    [20, 180, 170],
    [200, 60, 190],
    [90, 90, 90],
    [255, 255, 255],
    [130, 70, 20],
    [250, 150, 40],
    [30, 30, 100],
    [10, 90, 20],
];

/// A device with what all pictures have in common.
pub struct Scene {
    pub device: wgpu::Device,
    queue: wgpu::Queue,
    vertices: wgpu::Buffer,
    target: wgpu::Texture,
}

/// All pictures, one after the other.
pub fn pictures(file: Vec<u8>) -> Result<Vec<u8>, Failed> {
    let scene = Scene::open()?;
    // lamplight
    let bundle = Bundle::from_bytes(file)?;
    let program = bundle.program("lit")?;
    let layout = pipeline_layout(&scene.device, program.layout(Language::Wesl))?;
    // lamplight end
    let groups = scene.bind_groups(&program, &layout)?;
    let mut all = Vec::new();
    for key in keys() {
        // lamplight
        let vertex = program.shader("vs_main")?.get(&key, Target::WGSL)?;
        let fragment = program.shader("fs_main")?.get(&key, Target::WGSL)?;
        let attributes = vertex_attributes(&vertex.reflection);
        let vertex = Stage::new(&scene.device, &vertex)?;
        let fragment = Stage::new(&scene.device, &fragment)?;
        // lamplight end
        let pipeline = scene.pipeline(&layout.layout, (&vertex, attributes), &fragment);
        all.extend(scene.draw(&pipeline, &groups)?);
    }
    Ok(all)
}

fn keys() -> impl Iterator<Item = String> {
    ["point", "spot"].into_iter().flat_map(|lamp| {
        ["none", "hard", "pcf"].into_iter().flat_map(move |shadow| {
            [8, 32, 128].map(|gloss| format!("lamp={lamp},shadow={shadow},gloss={gloss}"))
        })
    })
}

fn camera_block(binding: &Binding) -> Result<Block<'_>, Failed> {
    let mut camera = Block::new(binding); // lamplight
    camera.set(
        "clip_from_world",
        &[0.9_f32, 0.1, 0.0, 0.0, -0.15, 0.8, 0.0, 0.0, 0.0, 0.0, 0.5, 0.3, 0.05, -0.1, 0.25, 1.0],
    )?;
    camera.set("normal_from_object", &[1.0_f32, 0.3, 0.0, 0.0, 0.9, -0.4, -0.2, 0.0, 1.1])?;
    camera.set("eye", &[0.4_f32, 0.3, 2.0])?;
    camera.set("exposure", &[0.8_f32])?;
    Ok(camera)
}

fn lamps_block(binding: &Binding) -> Result<Block<'_>, Failed> {
    const LAMPS: [([f32; 3], f32, [f32; 3]); 3] = [
        ([0.6, 0.5, 1.2], 1.0, [1.0, 0.8, 0.5]),
        ([-0.7, 0.2, 0.9], 1.7, [0.4, 0.6, 1.0]),
        ([0.0, 0.0, 0.3], 2.4, [9.0, 0.0, 9.0]),
    ];
    let mut lamps = Block::new(binding); // lamplight
    for (index, (position, strength, color)) in LAMPS.iter().enumerate() {
        lamps.set(&format!("all[{index}].position"), position)?;
        lamps.set(&format!("all[{index}].strength"), &[*strength])?;
        lamps.set(&format!("all[{index}].color"), color)?;
    }
    lamps.set("axis", &[0.3_f32, 0.2, 0.93])?;
    lamps.set("count", &[2_u32])?;
    Ok(lamps)
}

impl Scene {
    pub fn open() -> Result<Self, Failed> {
        let descriptor = wgpu::InstanceDescriptor {
            backends: wgpu::Backends::VULKAN,
            ..wgpu::InstanceDescriptor::new_without_display_handle()
        };
        let instance = wgpu::Instance::new(descriptor);
        let adapters = pollster::block_on(instance.enumerate_adapters(wgpu::Backends::VULKAN));
        let is_lavapipe = |found: &wgpu::Adapter| found.get_info().name.contains("llvmpipe");
        let adapter = adapters.into_iter().find(is_lavapipe).ok_or("there is no lavapipe")?;
        let (device, queue) = pollster::block_on(adapter.request_device(&Default::default()))?;
        let bytes: Vec<u8> = VERTICES.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
        let vertices = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: None,
            contents: &bytes,
            usage: wgpu::BufferUsages::VERTEX,
        });
        let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC;
        let size = (WIDTH as u32, HEIGHT as u32);
        let target = device.create_texture(&texture(size, FORMAT, usage));
        Ok(Self { device, queue, vertices, target })
    }

    fn sampled(
        &self,
        size: (u32, u32),
        format: wgpu::TextureFormat,
        bytes: &[u8],
    ) -> wgpu::TextureView {
        let made = self.device.create_texture_with_data(
            &self.queue,
            &texture(size, format, wgpu::TextureUsages::TEXTURE_BINDING),
            wgpu::util::TextureDataOrder::default(),
            bytes,
        );
        made.create_view(&Default::default())
    }

    /// The resources of all permutations, by the author's names.
    fn bind_groups(
        &self,
        program: &lamplight::bundle::Program<'_>,
        layout: &PipelineLayout,
    ) -> Result<Vec<wgpu::BindGroup>, Failed> {
        let image: Vec<u8> = IMAGE.iter().flat_map(|[r, g, b]| [*r, *g, *b, 255]).collect();
        let image = self.sampled((4, 3), FORMAT, &image);
        let is_near = |i: u32| 2 * (i / 8) > i % 8 + 5;
        let depths: Vec<u8> =
            (0..64).flat_map(|i| if is_near(i) { [0; 2] } else { [255; 2] }).collect();
        let shadow = self.sampled((8, 8), wgpu::TextureFormat::Depth16Unorm, &depths);
        let plain = self.device.create_sampler(&Default::default());
        let compare = self.device.create_sampler(&wgpu::SamplerDescriptor {
            compare: Some(wgpu::CompareFunction::LessEqual),
            ..Default::default()
        });
        let bindings = program.layout(Language::Wesl);
        let (camera, lamps) =
            (camera_block(&bindings[0].binding)?, lamps_block(&bindings[1].binding)?);
        let buffers = [&camera, &lamps].map(|block| {
            self.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: None,
                contents: block.bytes(), // lamplight
                usage: wgpu::BufferUsages::UNIFORM,
            })
        });
        let resource = |name: &str| match name {
            "camera" => buffers[0].as_entire_binding(),
            "lamps" => buffers[1].as_entire_binding(),
            "image" => wgpu::BindingResource::TextureView(&image),
            "shadow_map" => wgpu::BindingResource::TextureView(&shadow),
            "image_sampler" => wgpu::BindingResource::Sampler(&plain),
            _ => wgpu::BindingResource::Sampler(&compare),
        };
        let group = |(index, layout)| {
            let own = bindings.iter().map(|found| &found.binding);
            let own = own.filter(|binding| binding.group as usize == index);
            let entry = |found: &Binding| {
                let (binding, resource) = (found.binding, resource(&found.name));
                wgpu::BindGroupEntry { binding, resource }
            };
            let entries: Vec<_> = own.map(entry).collect();
            let descriptor = wgpu::BindGroupDescriptor { label: None, layout, entries: &entries };
            self.device.create_bind_group(&descriptor)
        };
        Ok(layout.groups.iter().enumerate().map(group).collect())
    }

    fn pipeline(
        &self,
        layout: &wgpu::PipelineLayout,
        (vertex, (stride, attributes)): (&Stage, (u64, Vec<wgpu::VertexAttribute>)),
        fragment: &Stage,
    ) -> wgpu::RenderPipeline {
        let constants = [vertex.constants(), fragment.constants()]; // lamplight
        let options = |index: usize| wgpu::PipelineCompilationOptions {
            constants: &constants[index],
            ..Default::default()
        };
        let buffer = wgpu::VertexBufferLayout {
            array_stride: stride,
            step_mode: wgpu::VertexStepMode::Vertex,
            attributes: &attributes,
        };
        self.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: None,
            layout: Some(layout),
            vertex: wgpu::VertexState {
                module: &vertex.module,
                entry_point: Some(&vertex.entry),
                compilation_options: options(0),
                buffers: &[Some(buffer)],
            },
            primitive: wgpu::PrimitiveState {
                cull_mode: Some(wgpu::Face::Back),
                ..Default::default()
            },
            depth_stencil: None,
            multisample: Default::default(),
            fragment: Some(wgpu::FragmentState {
                module: &fragment.module,
                entry_point: Some(&fragment.entry),
                compilation_options: options(1),
                targets: &[Some(FORMAT.into())],
            }),
            multiview_mask: None,
            cache: None,
        })
    }

    fn draw(
        &self,
        pipeline: &wgpu::RenderPipeline,
        groups: &[wgpu::BindGroup],
    ) -> Result<Vec<u8>, Failed> {
        let view = self.target.create_view(&Default::default());
        let mut encoder = self.device.create_command_encoder(&Default::default());
        let clear = wgpu::Color { r: 0.2, g: 0.1, b: 0.3, a: 1.0 };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                view: &view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(clear),
                    store: wgpu::StoreOp::Store,
                },
            })],
            ..Default::default()
        });
        pass.set_pipeline(pipeline);
        for (index, group) in groups.iter().enumerate() {
            pass.set_bind_group(index as u32, group, &[]);
        }
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.draw(0..6, 0..1);
        drop(pass);
        self.read(encoder)
    }

    fn read(&self, mut encoder: wgpu::CommandEncoder) -> Result<Vec<u8>, Failed> {
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: 256 * HEIGHT as u64,
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(256),
            rows_per_image: None,
        };
        encoder.copy_texture_to_buffer(
            self.target.as_image_copy(),
            wgpu::TexelCopyBufferInfo { buffer: &buffer, layout },
            self.target.size(),
        );
        self.queue.submit([encoder.finish()]);
        buffer.slice(..).map_async(wgpu::MapMode::Read, |_| ());
        self.device.poll(wgpu::PollType::wait_indefinitely())?;
        let bytes = buffer.slice(..).get_mapped_range()?;
        Ok(bytes.chunks(256).flat_map(|row| row[..4 * WIDTH].to_vec()).collect())
    }
}

fn texture(
    (width, height): (u32, u32),
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> wgpu::TextureDescriptor<'static> {
    wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    }
}
