//! Runs the emitted MSL on the CPU, compiled by clang. Kernels are run in batches; frames are drawn
//! by our own rasterizer.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use rayon::prelude::*;

use super::compiled::CompiledProgram;
use super::compiled::request::{
    FragmentInput, ImageLevel, MetalImage, MetalResources, TexelFormat,
};
use super::dispatch::{Dispatch, DispatchResult, bound_buffers};
use super::fixture::Fixture;
use super::frame::{Drawing, EntryPoint, Frame};
use super::gpu::{emitted, run_batches};
use super::kernel::{INPUT_WIDTH, Kernel, TARGET_WIDTH, kernels_to_compile};
use super::raster::CompiledStages;
use super::shipped::Shipped;
use super::written::{self, WrittenLanguage};
use super::{Session, ShippedPair, executor_failed};
use lamplight_bundle::{BindingKind, BufferSizes, Native, Target};
use lamplight_diagnostic::Diagnostic;
use lamplight_emit::Emitted;
use lamplight_eval::{Sampler, Texture, TextureDimension};
use lamplight_tools::metal::{ClangMissing, clang_version};
use lamplight_validate::on_large_stack;

/// A session. It holds programs, each of which has many kernels.
pub struct Metal {
    compiler: String,
    /// Whether the text of a kernel's source is compiled in the place of the emitted one.
    is_written: bool,
    programs: Vec<CompiledProgram>,
    /// For each text that was compiled its program, and its index there. Kernels of one function
    /// have the same text, whatever is in their textures.
    texts: HashMap<String, (usize, usize)>,
    /// For each kernel its program, its text and its bindings; or why it could not be compiled.
    kept: HashMap<u64, Result<MetalKernel, Diagnostic>>,
}

/// A kernel within a program.
struct MetalKernel {
    program: usize,
    text: usize,
    native: Native,
}

impl Metal {
    /// Looks for clang.
    ///
    /// # Errors
    /// It is missing.
    pub fn open() -> Result<Self, ClangMissing> {
        let compiler = clang_version()?;
        let (programs, texts, kept) = Default::default();
        Ok(Self { compiler, is_written: false, programs, texts, kept })
    }

    /// The same for texts that are given with kernels.
    ///
    /// # Errors
    /// It is missing.
    pub fn open_written() -> Result<Self, ClangMissing> {
        Ok(Self { is_written: true, ..Self::open()? })
    }

    /// Compiles the kernels that are new, all of them at once.
    fn compile(&mut self, kernels: &[&Kernel]) {
        let new = kernels_to_compile(kernels, |code| self.kept.contains_key(&code));
        if new.is_empty() {
            return;
        }
        let is_written = self.is_written;
        let emit = |kernel: &&Kernel| match is_written {
            true => written::fragment_text(kernel, WrittenLanguage::Msl),
            false => emitted::emit_kernel(kernel, Target::MSL).and_then(emitted_text),
        };
        let outputs: Vec<Result<(String, Native), Diagnostic>> =
            on_large_stack(|| new.par_iter().map(emit).collect());
        let failure = self.compile_texts(outputs.iter().flatten().map(|(text, _)| text)).err();
        for (kernel, output) in new.iter().zip(outputs) {
            let kept = output.and_then(|(text, native)| match (self.texts.get(&text), &failure) {
                (Some(&(program, text)), _) => Ok(MetalKernel { program, text, native }),
                (None, Some(error)) => Err(error.clone()),
                (None, None) => Err(executor_failed("a text was not compiled")),
            });
            self.kept.insert(kernel.code, kept);
        }
    }

    /// Compiles the texts that are new as one program.
    fn compile_texts<'t>(
        &mut self,
        texts: impl Iterator<Item = &'t String>,
    ) -> Result<(), Diagnostic> {
        let new: BTreeSet<&str> =
            texts.map(String::as_str).filter(|text| !self.texts.contains_key(*text)).collect();
        if new.is_empty() {
            return Ok(());
        }
        let new: Vec<&str> = new.into_iter().collect();
        let program =
            CompiledProgram::build(&new).map_err(|missing| executor_failed(missing.reason))?;
        let places = new
            .iter()
            .enumerate()
            .map(|(index, text)| ((*text).to_owned(), (self.programs.len(), index)));
        self.texts.extend(places.collect::<Vec<_>>());
        self.programs.push(program);
        Ok(())
    }

    /// Runs a compute entry point whose text is compiled.
    fn compute(&mut self, dispatch: &Dispatch<'_>, text: &str) -> DispatchResult {
        let Shipped { native, reflection, .. } = dispatch.output(Target::MSL)?;
        let size = reflection.workgroup_size.unwrap_or([1; 3]);
        let mut bound = MetalResources::default();
        let mut written = BTreeMap::new();
        for binding in bound_buffers(dispatch.output(Target::MSL)?)? {
            let place = (binding.group, binding.binding);
            let slot = native.slots.iter().find(|slot| (slot.group, slot.binding) == place);
            let slot = slot.and_then(|slot| slot.index);
            let slot = slot.ok_or_else(|| executor_failed("a buffer has no slot"))?;
            bound.buffers.insert(slot, dispatch.buffer(place)?.to_vec());
            if binding.kind == BindingKind::Storage && binding.writable {
                written.insert(slot, place);
            }
        }
        if let Some(BufferSizes { index, buffers }) = &native.buffer_sizes {
            let size = |place: &[u32; 2]| dispatch.buffer((place[0], place[1])).map(<[u8]>::len);
            let sizes: Vec<usize> = buffers.iter().map(size).collect::<Result<_, Diagnostic>>()?;
            let bytes = sizes.iter().flat_map(|size| (*size as u32).to_ne_bytes());
            bound.buffers.insert(*index, bytes.collect());
        }
        let (program, text) = self.texts[text];
        let found = self.programs[program].dispatch(text, &bound, (size, dispatch.groups));
        let mut found = found.map_err(executor_failed)?;
        let taken =
            written.into_iter().filter_map(|(slot, place)| Some((place, found.remove(&slot)?)));
        Ok(taken.collect())
    }

    /// One draw: the words of the target.
    fn draw(&mut self, kernel: &Kernel, texels: &[u32], rows: u32) -> Result<Vec<u32>, Diagnostic> {
        let kept = match self.kept.get(&kernel.code) {
            Some(Ok(kept)) => kept,
            Some(Err(error)) => return Err(error.clone()),
            None => return Err(executor_failed("the kernel was not prepared")),
        };
        let Some(program) = self.programs.get_mut(kept.program) else {
            return Err(executor_failed("the program was lost"));
        };
        let bound = bind_kernel(kernel, &kept.native, texels);
        let quads: Vec<[FragmentInput; 4]> = (0..rows.div_ceil(2))
            .flat_map(|y| (0..TARGET_WIDTH / 2).map(move |x| quad_fragments(2 * x, 2 * y)))
            .collect();
        let shaded = program.quads(kept.text, &bound, &quads).map_err(executor_failed)?;
        let mut pixels = vec![0; (rows * TARGET_WIDTH) as usize * 4];
        for (fragment, shaded) in quads.iter().flatten().zip(shaded.iter().flatten()) {
            let [x, y, ..] = fragment.position.map(|place| place as usize);
            let first = (y * TARGET_WIDTH as usize + x) * 4;
            if let (Some(pixel), Some(words)) =
                (pixels.get_mut(first..first + 4), shaded.targets.first())
            {
                pixel.copy_from_slice(words);
            }
        }
        Ok(pixels)
    }
}

impl Session for Metal {
    fn adapter(&self) -> String {
        self.compiler.clone()
    }

    fn prepare(&mut self, kernels: &[&Kernel]) {
        self.compile(kernels);
    }

    fn run(&mut self, kernel: &Kernel, inputs: &[u32]) -> Result<Vec<u32>, Diagnostic> {
        self.compile(&[kernel]);
        run_batches(kernel, inputs, |texels, rows| self.draw(kernel, texels, rows))
    }

    fn dispatch(&mut self, dispatches: &[Dispatch<'_>]) -> Vec<DispatchResult> {
        let texts = dispatches.iter().map(|dispatch| {
            dispatch.output(Target::MSL).map(|shipped| shipped.text().into_owned())
        });
        let texts: Vec<Result<String, Diagnostic>> = texts.collect();
        let failure = self.compile_texts(texts.iter().flatten()).err();
        let runs = dispatches.iter().zip(texts);
        runs.map(|(dispatch, text)| match (text, &failure) {
            (Err(error), _) => Err(error),
            (_, Some(error)) => Err(error.clone()),
            (Ok(text), None) => self.compute(dispatch, &text),
        })
        .collect()
    }

    fn draw_frames(&self, drawing: &Drawing<'_>) -> Result<Vec<Frame>, Diagnostic> {
        let shipped = |stage: EntryPoint<'_>| Shipped::of(stage, Target::MSL);
        let mut stages = vec![shipped(drawing.vertex)?];
        stages.extend(drawing.fragment.map(shipped).transpose()?);
        let fragment = stages.len().checked_sub(2).map(|_| 1);
        let compiled =
            CompiledStages::new(stages).map_err(|missing| executor_failed(missing.reason))?;
        compiled.draw(0, fragment, drawing)
    }

    fn draw_shipped(
        &self,
        pair: ShippedPair<'_>,
        drawing: &Drawing<'_>,
    ) -> Result<Vec<Frame>, Diagnostic> {
        let targets = pair.fragment.targets().map_err(executor_failed)?.len() as u32;
        let stages = vec![pair.vertex.clone(), pair.fragment.clone()];
        let compiled =
            CompiledStages::new(stages).map_err(|missing| executor_failed(missing.reason))?;
        compiled.draw(0, Some(1), &Drawing { targets, ..*drawing })
    }
}

fn emitted_text(emitted: Emitted) -> Result<(String, Native), Diagnostic> {
    let text =
        String::from_utf8(emitted.bytes).map_err(|error| executor_failed(error.to_string()))?;
    Ok((text, emitted.native))
}

/// The fragments of the quad whose first pixel is (x, y).
fn quad_fragments(x: u32, y: u32) -> [FragmentInput; 4] {
    [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)].map(|(x, y)| FragmentInput {
        position: [x as f32 + 0.5, y as f32 + 0.5, 0.0, 1.0],
        front: true,
        locations: Vec::new(),
    })
}

/// Binds the inputs and the fixtures of a kernel to the slots that its text declares.
fn bind_kernel(kernel: &Kernel, native: &Native, texels: &[u32]) -> MetalResources {
    let mut bound = MetalResources::default();
    for slot in &native.slots {
        let Some(index) = slot.index else { continue };
        match kernel.fixture_at(slot.binding) {
            Some(Fixture::Texture(texture)) => {
                let image = MetalImage::new(&Texture::from(texture), TexelFormat::Float);
                bound.textures.insert(index, image);
            }
            Some(Fixture::Sampler(sampler)) => {
                bound.samplers.insert(index, Sampler::from(*sampler));
            }
            None => drop(bound.textures.insert(index, input_image(texels))),
        }
    }
    bound
}

/// The input texture, binding 0.
fn input_image(texels: &[u32]) -> MetalImage {
    let height = texels.len() as u32 / 4 / INPUT_WIDTH;
    let level = ImageLevel { width: INPUT_WIDTH, height, layers: 1, words: texels.to_vec() };
    MetalImage { shape: TextureDimension::D2, format: TexelFormat::Unsigned, levels: vec![level] }
}
