//! An executor, which runs functions and draws frames: a device of wgpu, or a copy of an executor
//! that exists.

use std::fmt::Write as _;

use super::{NewFiles, Repository, TaskKind, check_name};

pub const KIND: TaskKind = TaskKind {
    name: "executor",
    example: &["dx12"],
    rest: "[EXECUTOR THAT IT IS LIKE, or own]",
    make,
};

const FOLDER: &str = "crates/execute/src/executors";
const CARGO: &str = "Cargo.toml";

/// Graphics APIs that wgpu has on some systems only: the name, which is also that of a feature of
/// wgpu, and the systems.
const INTERFACES: [(&str, &str); 2] = [("dx12", "windows"), ("metal", "macos, ios")];

fn make(repository: &Repository<'_>, name: &str, rest: &[&str]) -> Result<NewFiles, String> {
    check_name(name, '_')?;
    let file = format!("{FOLDER}/{name}.rs");
    repository.refuse_existing(&file)?;
    let known = repository.stems(FOLDER)?;
    let interface = INTERFACES.iter().find(|(one, _)| *rest.first().unwrap_or(&name) == *one);
    let text = match rest {
        ["own"] => explained(&OWN.replace("NAME", name)),
        [] | [_] if interface.is_some() => of_wgpu(name, interface),
        [] => of_wgpu(name, None),
        [like] if known.iter().any(|known| known == like) => {
            copy_of(&repository.read(&format!("{FOLDER}/{like}.rs"))?, like, name)
        }
        _ => return Err(format!("name one executor of {}, dx12, metal", known.join(", "))),
    };
    let next = steps(&file, name, interface.is_none() && rest.is_empty(), rest == ["own"]);
    let (mut files, mut next) = (vec![(file, text)], next);
    if let Some((interface, _)) = interface {
        files.push((CARGO.to_owned(), with_feature(&repository.read(CARGO)?, interface)?));
        next.push(
            "cargo build, with a network: Cargo.lock gets what the interface needs".to_owned(),
        );
    }
    Ok(NewFiles { files, next })
}

/// What remains to be done. `is_vulkan` means that no argument chose another form than a Vulkan
/// device of wgpu, and `is_own` that the file does without wgpu.
fn steps(file: &str, name: &str, is_vulkan: bool, is_own: bool) -> Vec<String> {
    let mut next = vec![
        format!(
            "{file}: `about`, and what opens it, as its comments say, which you delete; imports that are not used any more (tests house::described, harness::executor::{name})"
        ),
        format!(
            "{file}: `needs`; for each package that xtask/src/machine.rs lacks, add to `NEEDS` there one like `Need {{ package: \"libegl1\", what: \"EGL\", found: || library(\"libEGL.so.1\") }}`, or with `installed` or `program` (test house::needs)"
        ),
        format!(
            "{file}: `samples: None` where it draws no frames, and `shipping` where it takes a target's files as they are (tests harness::executor::{name}, frames/shipped)"
        ),
        format!(
            "{file}: `Runs on:` has `every system`, `every system but WebAssembly`, or names in its place as `linux, windows, macos`; other systems are built without the executor and do not know its name"
        ),
        "tests that open all executors fail where one is not available: have its packages installed by xtask/src/machine.rs, or narrow `Runs on:`".to_owned(),
        format!("cargo run -- list executors; cargo run -- check --executor {name} brdf::diffuse"),
        "cargo xtask record diagnostics; cargo xtask record guide; read the difference".to_owned(),
    ];
    if is_own {
        next.insert(0, format!(
            "{file}: `open_device` and `draw_pixels`, which say what they get and give; then `draw_frames`, if it draws frames"
        ));
        next.push(
            "Cargo.toml, if it needs a crate: optional, in `harness`, below `[target.'cfg(not(target_family = \"wasm\"))'.dependencies]`, with a row in ARCHITECTURE.md; then cargo build, with a network, for Cargo.lock"
                .to_owned(),
        );
    }
    if is_vulkan {
        next.insert(0, format!(
            "{file}: opens a Vulkan device whose name contains `{name}`; the interfaces are `cargo xtask new executor {name} dx12` and `... metal`, and `... own` is without wgpu"
        ));
    }
    next
}

/// A device of an interface of wgpu, or else a device of Vulkan whose driver has this name.
fn of_wgpu(name: &str, interface: Option<&(&str, &str)>) -> String {
    let (systems, needs, backend, part) = match interface {
        Some((interface, systems)) => (*systems, "", interface.to_uppercase(), ""),
        None => ("every system but WebAssembly", "\"libvulkan1\"", "VULKAN".to_owned(), name),
    };
    let words = [
        ("NAME", name),
        ("SYSTEMS", systems),
        ("NEEDS", needs),
        ("BACKEND", &backend),
        ("PART", part),
    ];
    explained(&words.iter().fold(TEXT.to_owned(), |text, (word, value)| text.replace(word, value)))
}

/// What a field of an executor is for. The text is a comment above the first line that begins with
/// the field.
const FIELDS: &[(&str, &str)] = &[
    ("about: ", "One line for listings, unlike that of every other executor."),
    ("needs: ", "Names of Debian packages, such as `\"libegl1\"`."),
    (
        "before_threads: ",
        "A function that is called while the process has one thread, such as one that sets a\n\
         variable: `announce` in `swiftshader.rs`. All executors of the process see it. If it\n\
         changes what another one opens, write an executor with a process of its own instead.",
    ),
    (
        "samples: ",
        "How many places in each pixel of a picture are averaged; `None` if it draws no frames.",
    ),
    ("backend: ", "One interface of wgpu: `VULKAN`, `GL`, `DX12` or `METAL`."),
    (
        "named: ",
        "`AdapterName::With(\"part\")`: the adapter's name has the part, upper and lower case\n\
         as it is; an empty part allows every adapter. `AdapterName::Without` is for adapters\n\
         whose names do not have it. A software adapter comes before others.",
    ),
    (
        "shaders: ",
        "wgpu translates the shaders. `Shaders::Emitted(Target::SPIRV)` gives the driver the\n\
         texts of a target unchanged, which the adapter must allow (`PASSTHROUGH_SHADERS`).",
    ),
    (
        "shipping: ",
        "`Some(Shipping { target, open })` if it draws the files of a target as they are.",
    ),
    ("reads_glsl: ", "Whether it compiles the text of GLSL modules itself, as `glsl_source` does."),
    ("compute: ", "The form in which it takes compute entry points, if it implements `dispatch`."),
];

/// The text with a comment above each field of [`FIELDS`].
fn explained(text: &str) -> String {
    let mut rest: Vec<_> = FIELDS.iter().collect();
    let mut to = String::new();
    for line in text.lines() {
        let code = line.trim_start();
        if let Some(place) = rest.iter().position(|(field, _)| code.starts_with(field)) {
            let indent = &line[..line.len() - code.len()];
            for comment in rest.remove(place).1.lines() {
                let _ = writeln!(to, "{indent}// {comment}");
            }
        }
        let _ = writeln!(to, "{line}");
    }
    to
}

/// A copy of an executor, which does not describe itself yet.
fn copy_of(text: &str, like: &str, name: &str) -> String {
    let head_end = text.find("//! Runs on:").unwrap_or_default();
    let text =
        format!("//! {name}, as `{like}` is. TODO: say what it is.\n//!\n{}", &text[head_end..]);
    let renamed = text.replace(&format!("name: {like:?}"), &format!("name: {name:?}"));
    let lines = renamed.lines().map(|line| match line.trim_start().starts_with("about: ") {
        true => "    about: \"\",".to_owned(),
        false => line.to_owned(),
    });
    explained(&lines.fold(String::new(), |text, line| text + &line + "\n"))
}

/// The manifest of the crate, with a feature of wgpu.
fn with_feature(text: &str, feature: &str) -> Result<String, String> {
    let wrong = || format!("`{CARGO}` has no line `wgpu = {{ ... features = [...] }}`");
    let start = text.find("\nwgpu = {").ok_or_else(wrong)?;
    let end = start + text[start..].find("] }").ok_or_else(wrong)?;
    if text[start..end].contains(&format!("{feature:?}")) {
        return Ok(text.to_owned());
    }
    Ok(format!("{}, {feature:?}{}", &text[..end], &text[end..]))
}

/// The template of an executor on wgpu.
const TEXT: &str = r#"//! wgpu on NAME.
//!
//! Runs on: SYSTEMS

use super::{DEVICE_SAMPLES, ExecutorEntry};
use crate::execute::gpu::{AdapterName, DeviceRequest, Shaders};

pub const EXECUTOR: ExecutorEntry = ExecutorEntry {
    name: "NAME",
    about: "",
    needs: &[NEEDS],
    before_threads: None,
    samples: Some(DEVICE_SAMPLES),
    open: || {
        super::open_gpu(DeviceRequest {
            backend: wgpu::Backends::BACKEND,
            named: AdapterName::With("PART"),
            shaders: Shaders::Translated,
        })
    },
    shipping: None,
    reads_glsl: false,
    compute: None,
};
"#;

const OWN: &str = r#"//! NAME.
//!
//! Runs on: every system but WebAssembly

use super::{ExecutorEntry, Unavailable};
use crate::bundle::Target;
use crate::diagnostic::{Diagnostic, codes};
use crate::execute::Session;
use crate::execute::emitted::emit_kernel;
use crate::execute::gpu::run_batches;
use crate::execute::kernel::{ENTRY, INPUT_WIDTH, Kernel, TARGET_WIDTH};

/// The executor, for the table of all.
pub const EXECUTOR: ExecutorEntry = ExecutorEntry {
    name: "NAME",
    about: "",
    needs: &[],
    before_threads: None,
    samples: None,
    open: || Ok(Box::new(Own { adapter: open_device()? })),
    shipping: None,
    reads_glsl: false,
    compute: None,
};

/// An open device.
struct Own {
    /// Its name, driver and version.
    adapter: String,
}

/// Opens the device, or says why it is not available on this machine.
fn open_device() -> Result<String, Unavailable> {
    Err("`NAME` opens no device yet".to_owned().into())
}

impl Session for Own {
    fn adapter(&self) -> String {
        self.adapter.clone()
    }

    // `prepare` is called before the first `run`, with all kernels, for executors that compile many at
    // once. `draw_frames` and `draw_shipped` draw pictures; without them, both refuse.

    fn run(&mut self, kernel: &Kernel, inputs: &[u32]) -> Result<Vec<u32>, Diagnostic> {
        run_batches(kernel, inputs, |texels, rows| {
            let text = emit_kernel(kernel, Target::WGSL)?.bytes;
            draw_pixels(kernel, &text, texels, rows)
        })
    }
}

/// Draws a triangle over a whole target, and gives the words of its pixels, row by row.
///
/// - `text` is a fragment shader in the language of the target that `run` names. Its entry point is
///   called [`ENTRY`].
/// - The target has the format `Rgba32Uint`, `TARGET_WIDTH` pixels a row, and `rows` rows.
/// - Binding 0 of group 0 is a texture of `Rgba32Uint`, `INPUT_WIDTH` texels a row, that has the words
///   of `texels`, four a texel.
/// - `kernel.resources()` are further textures and samplers of group 0: each has its `binding` and, in
///   `fixture`, what it holds: a texture with `kind`, `width`, `height` and `texels` (f32, row by row,
///   four for a colour and one for a depth, six layers for a cube), or a sampler. Refuse what the
///   device lacks with `EXECUTOR_FAILED`.
fn draw_pixels(
    kernel: &Kernel,
    text: &[u8],
    texels: &[u32],
    rows: u32,
) -> Result<Vec<u32>, Diagnostic> {
    let kernel_entry = ENTRY;
    let (inputs, resources) = (texels.len() as u32 / 4 / INPUT_WIDTH, kernel.resources().count());
    let message = format!(
        "`NAME` does not draw `{kernel_entry}` yet: {} bytes, {inputs} rows of inputs, \
         {resources} resources, {TARGET_WIDTH} x {rows} pixels",
        text.len()
    );
    Err(Diagnostic::error(codes::EXECUTOR_FAILED, message))
}
"#;
