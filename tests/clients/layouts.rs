//! Layouts of buffers and storage textures, which the scene does not have: wgpu takes a pipeline of
//! the layout and the shader.

use lamplight::bundle::{Bundle, Language, Target};
use lamplight_wgpu::{Stage, pipeline_layout};

use super::rust_wgpu::Scene;
use super::{LAMPLIGHT, Outcome, run};

const MANIFEST: &str = "[program.work]
wesl = \"work.wesl\"
targets = [\"wgsl\"]
";

/// `places` and `counter` are declared as `read_write`, but only read.
const SHADER: &str = "
struct Output { count: u32, values: array<vec4f> }

@group(0) @binding(0) var<storage, read_write> places: array<u32>;
@group(0) @binding(1) var<storage, read> values: array<vec4f>;
@group(0) @binding(2) var<storage, read_write> output: Output;
@group(0) @binding(3) var<storage, read_write> counter: atomic<u32>;
@group(1) @binding(0) var picture: texture_storage_2d<rgba8unorm, write>;
@group(1) @binding(1) var numbers: texture_storage_2d<r32uint, read_write>;
@group(1) @binding(2) var layers: texture_2d_array<u32>;

@compute @workgroup_size(8)
fn main(@builtin(global_invocation_id) id: vec3u) {
    let value = values[places[id.x]] * f32(atomicLoad(&counter));
    output.values[id.x] = value;
    textureStore(picture, id.xy, value);
    let old = textureLoad(numbers, id.xy) + textureLoad(layers, id.xy, 0, 0);
    textureStore(numbers, id.xy, old);
}
";

pub fn fit() -> Outcome {
    let folder = tempfile::tempdir()?;
    for (name, text) in [("lamplight.toml", MANIFEST), ("work.wesl", SHADER)] {
        std::fs::write(folder.path().join(name), text)?;
    }
    let mut command = std::process::Command::new(LAMPLIGHT);
    run(command.current_dir(folder.path()).args(["gen", "--no-cache", "-o", "bundle"]))?;
    let bundle = Bundle::open(folder.path().join("bundle"))?;
    let program = bundle.program("work")?;
    let device = Scene::open()?.device;
    let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let layout = pipeline_layout(&device, program.layout(Language::Wesl))?;
    let stage = Stage::new(&device, &program.shader("main")?.get("default", Target::WGSL)?)?;
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: Some(&layout.layout),
        module: &stage.module,
        entry_point: Some(&stage.entry),
        compilation_options: Default::default(),
        cache: None,
    });
    let error = pollster::block_on(scope.pop());
    drop(pipeline);
    match error {
        None => Ok(()),
        Some(error) => Err(error.to_string().into()),
    }
}
