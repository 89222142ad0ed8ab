//! Texts in MSL, compiled for the CPU into one program, which runs them on request.

use std::io::{Read as _, Write as _};
use std::process::{Child, Command, Stdio};

use super::build::{self, Built};
use super::interface::{Interface, InterfaceRole};
use super::request::{
    FragmentInput, MetalResources, RequestWords, ShadedFragment, Transformed, VertexInput, words,
};
use lamplight_tools::metal::ClangMissing;

/// Entry points, ready to run.
#[derive(Debug)]
pub struct CompiledProgram {
    built: Built,
    /// The process that runs them, once it was needed.
    child: Option<Child>,
}

impl CompiledProgram {
    /// Compiles one entry point of each text. A text that clang refuses, or whose entry point needs
    /// something that the CPU lacks, fails when it is run.
    ///
    /// # Errors
    /// clang is missing or cannot be run.
    pub fn build(texts: &[&str]) -> Result<Self, ClangMissing> {
        Ok(Self { built: build::build_program(texts)?, child: None })
    }

    /// What the entry point of a text takes and returns.
    ///
    /// # Errors
    /// Why the text cannot be run.
    pub fn interface(&self, text: usize) -> Result<&Interface, String> {
        match self.built.entries.get(text) {
            Some(entry) => entry.as_ref().map_err(Clone::clone),
            None => Err("there is no such text".to_owned()),
        }
    }

    /// Runs a vertex entry point for each vertex.
    ///
    /// # Errors
    /// Why the text cannot be run, or how it failed.
    pub fn vertices(
        &mut self,
        text: usize,
        bound: &MetalResources,
        vertices: &[VertexInput],
    ) -> Result<Vec<Transformed>, String> {
        let mut request = self.head(text, 0, bound)?;
        let (taken, given) = self.interface(text)?.locations();
        request.push(vertices.len() as u32);
        for vertex in vertices {
            request.extend([vertex.index, vertex.instance]);
            words::locations(&mut request, &vertex.locations, taken);
        }
        let answer = self.ask(&request, vertices.len(), given)?;
        Ok(answer.iter().map(|words| Transformed::from_words(words)).collect())
    }

    /// Runs a fragment entry point for the fragments of each quad: (0, 0), (1, 0), (0, 1), (1, 1).
    ///
    /// # Errors
    /// Why the text cannot be run, or how it failed.
    pub fn quads(
        &mut self,
        text: usize,
        bound: &MetalResources,
        quads: &[[FragmentInput; 4]],
    ) -> Result<Vec<[ShadedFragment; 4]>, String> {
        let mut request = self.head(text, 1, bound)?;
        let (taken, given) = self.interface(text)?.locations();
        request.push(quads.len() as u32);
        for fragment in quads.iter().flatten() {
            request.extend(fragment.position.map(f32::to_bits));
            request.push(u32::from(fragment.front));
            words::locations(&mut request, &fragment.locations, taken);
        }
        let answer = self.ask(&request, quads.len() * 4, given)?;
        let shaded: Vec<ShadedFragment> =
            answer.iter().map(|words| ShadedFragment::from_words(words)).collect();
        Ok(shaded.as_chunks::<4>().0.to_vec())
    }

    /// The start of every request.
    fn head(
        &self,
        text: usize,
        stage: u32,
        bound: &MetalResources,
    ) -> Result<RequestWords, String> {
        let interface = self.interface(text)?;
        for parameter in &interface.parameters {
            let is_bound = match parameter.role {
                InterfaceRole::Buffer(slot) => bound.buffers.contains_key(&slot),
                InterfaceRole::Texture(slot) => bound.textures.contains_key(&slot),
                InterfaceRole::Sampler(slot) => bound.samplers.contains_key(&slot),
                _ => true,
            };
            if !is_bound {
                return Err(format!("nothing is bound for `{}`", parameter.name));
            }
        }
        let (taken, given) = interface.locations();
        let mut request = vec![text as u32, stage, taken, given];
        words::bound(&mut request, bound);
        Ok(request)
    }

    /// Sends a request, and waits for the words of each invocation: four words, then those of its
    /// locations.
    fn ask(
        &mut self,
        request: &[u32],
        count: usize,
        given: u32,
    ) -> Result<Vec<RequestWords>, String> {
        let size = 4 * (1 + given as usize);
        match self.exchange(request, count * size) {
            Ok(answer) => Ok(answer.chunks(size).map(<[u32]>::to_vec).collect()),
            Err(error) => Err(self.ended(&error.to_string())),
        }
    }

    fn exchange(&mut self, request: &[u32], count: usize) -> std::io::Result<RequestWords> {
        let child = match &mut self.child {
            Some(child) => child,
            none => none.insert(start_program(&self.built)?),
        };
        let (Some(stdin), Some(stdout)) = (&mut child.stdin, &mut child.stdout) else {
            return Err(std::io::ErrorKind::BrokenPipe.into());
        };
        let mut bytes = (request.len() as u32).to_ne_bytes().to_vec();
        bytes.extend(request.iter().flat_map(|word| word.to_ne_bytes()));
        stdin.write_all(&bytes)?;
        stdin.flush()?;
        let mut answer = vec![0; count * 4];
        stdout.read_exact(&mut answer)?;
        Ok(answer.as_chunks::<4>().0.iter().map(|bytes| u32::from_ne_bytes(*bytes)).collect())
    }

    /// Ends the process; returns a message with its status and what it wrote to stderr. The next
    /// request starts another process.
    fn ended(&mut self, error: &str) -> String {
        let Some(mut child) = self.child.take() else { return error.to_owned() };
        drop(child.stdin.take());
        let _ = child.kill();
        let told = child.wait_with_output();
        told.map_or(error.to_owned(), |output| {
            let words = String::from_utf8_lossy(&output.stderr).trim().to_owned();
            format!("the program ended ({}): {words}", output.status)
        })
    }
}

impl Drop for CompiledProgram {
    fn drop(&mut self) {
        if let Some(mut child) = self.child.take() {
            // The process ends when its input does, but a shader may still be running.
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}

fn start_program(built: &Built) -> std::io::Result<Child> {
    Command::new(built.program())
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
}
