//! Turns emitted files into SPIR-V that a Vulkan driver gets unchanged.
//!
//! glslangValidator compiles HLSL unchanged. Direct3D matches inputs by semantics, which become
//! locations in the SPIR-V. Sampler heaps and their index buffers have registers of separate kinds
//! there. Vulkan has no such kinds, so they become bindings of one group.

use crate::gpu::heaps;
use lamplight_bundle::{Native, SamplerHeap, Stage, Target};
use lamplight_emit::spirv;
use lamplight_emit::spirv::{HEADER_WORDS, SpirvInstruction, instructions, op, string, words};
use lamplight_syntax::words::words as text_words;
use lamplight_tools::{GLSLANG, SPIRV_OPT};
use std::collections::BTreeMap;

/// One stage as SPIR-V.
#[derive(Debug, Clone)]
pub struct SpirvBinary {
    words: Vec<u32>,
    entry: String,
    /// The heaps that the stage takes its samplers from, if its target has heaps.
    pub heaps: Vec<SamplerHeap>,
}

impl SpirvBinary {
    /// The stage from the bytes of a target, if those can become SPIR-V. Sampler heaps go into the
    /// bind group `heaps`.
    ///
    /// # Errors
    /// The message of the translator.
    pub fn new(
        target: Target,
        stage: Stage,
        bytes: &[u8],
        native: &Native,
        heaps: u32,
    ) -> Result<Self, String> {
        let words = match target {
            Target::SPIRV => words(bytes),
            Target::HLSL => compile_hlsl(bytes, stage, native, heaps)?,
            _ => return Err(format!("there is no SPIR-V of target `{target}`")),
        };
        let (entry, heaps) = (native.entry_name.clone(), native.sampler_heaps.clone());
        Ok(Self { words, entry, heaps })
    }

    /// The name of its entry point.
    pub fn entry(&self) -> &str {
        &self.entry
    }

    /// The stage as a shader module of the device.
    pub fn module(&self, device: &wgpu::Device, label: &str) -> wgpu::ShaderModule {
        let entry = wgpu::PassthroughShaderEntryPoint {
            name: self.entry.as_str().into(),
            workgroup_size: (0, 0, 0),
        };
        let descriptor = wgpu::ShaderModuleDescriptorPassthrough {
            label: Some(label),
            entry_points: vec![entry].into(),
            spirv: Some(self.words.as_slice().into()),
            ..Default::default()
        };
        // SAFETY: the words were written from a validated module. Indices into arrays are not
        // clamped in it, and the harness only uses indices that are within its own arrays.
        unsafe { device.create_shader_module_passthrough(descriptor) }
    }
}

/// Opcodes of the extension in which glslangValidator keeps the semantics of HLSL.
const OP_DECORATE_STRING: u16 = 5632;
const OP_MEMBER_DECORATE_STRING: u16 = 5633;
const LOCATION: u32 = 30;
const BINDING: u32 = 33;
const DESCRIPTOR_SET: u32 = 34;
const USER_SEMANTIC: u32 = 5635;

/// What in the text has another meaning to glslangValidator than to a compiler for Direct3D, so
/// that the text cannot be run this way.
pub fn hlsl_lacks(text: &str) -> Option<&'static str> {
    if is_misplaced(text) {
        return Some(
            "glslangValidator puts what follows a matrix of three rows or an array in a constant \
             buffer 16 bytes further than Direct3D does",
        );
    }
    if text.lines().any(is_signed_atomic) {
        return Some(
            "glslangValidator takes numbers in byte buffers for unsigned in atomic functions",
        );
    }
    let named = |name: &str| {
        text_words(text)
            .any(|word| word.text == name && text[word.at + name.len()..].starts_with('('))
    };
    if named("frexp") {
        return Some("frexp of Direct3D drops the sign, and that of glslangValidator keeps it");
    }
    named("ldexp").then_some("glslangValidator takes no integer for the exponent of ldexp")
}

/// Whether a line calls an atomic function of a byte buffer for signed numbers.
fn is_signed_atomic(line: &str) -> bool {
    let line = line.trim_start_matches([' ', '{']);
    let is_signed = line.starts_with("int ") || line.contains("_result_Sint_4_ ");
    is_signed && line.contains(".Interlocked")
}

/// The text with an unsigned 0 where an atomic value is loaded: glslangValidator does not convert the
/// argument of an atomic function of a byte buffer.
fn with_unsigned_zeros(text: &[u8]) -> Vec<u8> {
    let text = String::from_utf8_lossy(text);
    let change = |line: &str| match line.contains(".InterlockedOr(") {
        true => line.replace(", 0, ", ", 0u, "),
        false => line.to_owned(),
    };
    text.split_inclusive('\n').map(change).collect::<String>().into_bytes()
}

/// The text with the lengths of byte buffers in bytes. glslangValidator gives them in words.
fn with_byte_lengths(text: &[u8]) -> Vec<u8> {
    let text = String::from_utf8_lossy(text);
    let mut is_length = false;
    let change = |line: &str| {
        is_length =
            line.starts_with("uint NagaBufferLength") || is_length && !line.starts_with('}');
        match is_length {
            true => line.replace("return ret;", "return ret * 4u;"),
            false => line.to_owned(),
        }
    };
    text.split_inclusive('\n').map(change).collect::<String>().into_bytes()
}

/// Whether glslangValidator gives members of a constant buffer other offsets than Direct3D does. In
/// Direct3D the last row of a matrix, or the last element of an array, ends with its last number,
/// and naga adds a member to fill the rest.
fn is_misplaced(text: &str) -> bool {
    let is_short = |line: &str| {
        let is_matrix = line.contains("row_major float") && line.contains("x3 ");
        is_matrix || line.trim_end().ends_with("];")
    };
    let is_filler = |line: &str| line.trim_start().starts_with("int _pad");
    let mut open: Vec<&str> = text.lines().filter(|line| line.starts_with("cbuffer ")).collect();
    let mut seen: Vec<&str> = Vec::new();
    while let Some(member) = open.pop() {
        // The type of a member is the first word with a structure of that name.
        let named = text_words(member).map(|word| word.text).filter(|name| !seen.contains(name));
        let names: Vec<&str> = named.collect();
        for name in names {
            let Some((_, body)) = text.split_once(&format!("struct {name} {{")) else { continue };
            seen.push(name);
            let members: Vec<&str> = body.lines().take_while(|line| *line != "};").collect();
            let mut pairs = members.iter().zip(members.iter().skip(1));
            if pairs.any(|(line, next)| is_short(line) && is_filler(next)) {
                return true;
            }
            open.extend(members);
        }
    }
    false
}

/// Compiles the text to SPIR-V. Its sampler heaps go into bind group `group`.
///
/// # Errors
/// The message of glslangValidator or spirv-opt, or which of them is not installed.
fn compile_hlsl(
    text: &[u8],
    stage: Stage,
    native: &Native,
    group: u32,
) -> Result<Vec<u32>, String> {
    let compiled = GLSLANG.pipe(
        &[
            "--stdin",
            "--quiet",
            "-D",
            "-V",
            "--target-env",
            "vulkan1.1",
            "-fhlsl_functionality1",
            "-S",
            stage.suffix(),
            "-e",
            &native.entry_name,
            "-o",
            "/dev/stdout",
        ],
        &with_byte_lengths(&with_unsigned_zeros(text)),
    )?;
    // The static samplers are still variables here, which Vulkan does not allow.
    let legal = SPIRV_OPT
        .pipe(&["--target-env=vulkan1.1", "--legalize-hlsl", "-o", "-", "-"], &compiled)?;
    bind_words(&spirv::words(&legal), native, group)
}

/// Takes the locations from the semantics, sets the bindings of heaps, and removes the semantics.
fn bind_words(words: &[u32], native: &Native, group: u32) -> Result<Vec<u32>, String> {
    let places = heap_places(words, native);
    let locations = semantic_locations(words)?;
    let header = words.get(..HEADER_WORDS).ok_or("glslangValidator wrote no module")?;
    let mut out = header.to_vec();
    for SpirvInstruction { op, words } in instructions(words) {
        match (op, words) {
            (OP_DECORATE_STRING | OP_MEMBER_DECORATE_STRING, _) => {}
            (op::EXTENSION, [_, name @ ..]) if string(name).starts_with("SPV_GOOGLE") => {}
            (op::DECORATE, [head, id, decoration, value]) => {
                let value = match (*decoration, places.get(id), locations.get(id)) {
                    (LOCATION, _, Some(location)) => *location,
                    (BINDING, Some(binding), _) => *binding,
                    (DESCRIPTOR_SET, Some(_), _) => group,
                    _ => *value,
                };
                out.extend([*head, *id, *decoration, value]);
            }
            _ => out.extend_from_slice(words),
        }
    }
    Ok(out)
}

/// The binding of each variable that is a heap or an index buffer, found by its name.
fn heap_places(words: &[u32], native: &Native) -> BTreeMap<u32, u32> {
    let by_name: BTreeMap<String, u32> = heaps::heap_bindings(&native.sampler_heaps).collect();
    let mut places = BTreeMap::new();
    let mut variables = Vec::new();
    for SpirvInstruction { op, words } in instructions(words) {
        match (op, words) {
            (op::NAME, [_, id, name @ ..]) => {
                places.extend(by_name.get(&string(name)).map(|binding| (*id, *binding)));
            }
            (op::DECORATE, [_, id, DESCRIPTOR_SET, _]) => variables.push(*id),
            _ => {}
        }
    }
    // A struct may have the same name as its variable, but it has no descriptor set.
    places.retain(|id, _| variables.contains(id));
    places
}

/// The location of each variable, from the number in its semantic `LOCn`.
fn semantic_locations(words: &[u32]) -> Result<BTreeMap<u32, u32>, String> {
    let mut locations = BTreeMap::new();
    for SpirvInstruction { op, words } in instructions(words) {
        if let (OP_DECORATE_STRING, [_, id, USER_SEMANTIC, name @ ..]) = (op, words)
            && let Some(number) = string(name).strip_prefix("LOC")
        {
            let number = number.parse().map_err(|_| format!("the semantic LOC{number}"))?;
            locations.insert(*id, number);
        }
    }
    Ok(locations)
}
