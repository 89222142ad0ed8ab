//! Stages as a bundle holds them.

use super::emitted;
use super::frame::EntryPoint;
#[cfg(not(target_family = "wasm"))]
use lamplight_bundle::{BindingKind, Stage};
use lamplight_bundle::{Native, Reflection, Target, Varying};
use lamplight_diagnostic::Diagnostic;
use lamplight_emit::{self as emit, Emitted};
use lamplight_link::Linker;

/// A stage as it is shipped: its bytes in a target, and its reflection.
#[derive(Debug, Clone)]
pub struct Shipped {
    pub target: Target,
    pub bytes: Vec<u8>,
    pub native: Native,
    pub reflection: Reflection,
}

/// What the colour target of a shipped stage holds.
#[cfg(not(target_family = "wasm"))]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ColorFormat {
    /// Bits of floats.
    Float,
    Uint,
}

impl Shipped {
    /// Compiles an entry point as a bundle would hold it.
    ///
    /// # Errors
    /// `executor-lacks` where the target's language cannot express something in it.
    pub fn of(stage: EntryPoint<'_>, target: Target) -> Result<Self, Diagnostic> {
        Self::linked(stage, target, &Linker::new(&[target]))
    }

    /// As [`Self::of`], with a linker of that target which is kept from stage to stage.
    ///
    /// # Errors
    /// Those of [`Self::of`].
    pub fn linked(
        stage: EntryPoint<'_>,
        target: Target,
        linker: &Linker<'_>,
    ) -> Result<Self, Diagnostic> {
        let (emitted, validated) = emitted::of_module(stage.module, stage.entry, target, linker)?;
        let Emitted { bytes, native } = emitted;
        let reflection = emit::reflect(&validated, stage.entry)?;
        Ok(Self { target, bytes, native, reflection })
    }

    /// Its bytes as text. Not meant for binary targets.
    pub fn text(&self) -> std::borrow::Cow<'_, str> {
        String::from_utf8_lossy(&self.bytes)
    }

    /// The colour targets that it needs, by location.
    ///
    /// # Errors
    /// A message about a type that no target exists for.
    #[cfg(not(target_family = "wasm"))]
    pub(super) fn targets(&self) -> Result<Vec<ColorFormat>, String> {
        if self.reflection.stage != Stage::Fragment {
            return Ok(Vec::new());
        }
        let located = self.reflection.outputs.iter().filter_map(|output| {
            let format = match output.ty.as_str() {
                ty if ty.contains("f32") => Ok(ColorFormat::Float),
                ty if ty.contains("u32") => Ok(ColorFormat::Uint),
                ty => Err(format!("no target is made for outputs of type {ty}")),
            };
            output.location.map(|location| format.map(|format| (location, format)))
        });
        let located: Vec<(u32, ColorFormat)> = located.collect::<Result<_, _>>()?;
        let count = located.iter().map(|(location, _)| location + 1).max().unwrap_or(0);
        let format = |location: u32| located.iter().find(|(other, _)| *other == location);
        Ok((0..count)
            .map(|location| format(location).map_or(ColorFormat::Float, |one| one.1))
            .collect())
    }

    /// What of a fragment stage WebGPU does not support with the targets that are used here.
    pub fn lacks_of_webgpu(&self) -> Option<&'static str> {
        let outputs = &self.reflection.outputs;
        let is_small = |one: &Varying| one.location.is_some() && !one.ty.starts_with("vec4");
        if outputs.iter().any(|one| one.builtin.as_deref() == Some("frag_depth")) {
            return Some("WebGPU asks for a depth target where a stage writes depth");
        }
        outputs.iter().any(is_small).then_some(
            "WebGPU asks for targets of as many numbers as a stage writes, and there are none of \
             three",
        )
    }

    /// Groups and bindings of its uniform buffers.
    #[cfg(not(target_family = "wasm"))]
    pub(super) fn blocks(&self) -> impl Iterator<Item = (u32, u32)> {
        let blocks = self.reflection.bindings.iter().filter(|one| one.kind == BindingKind::Uniform);
        blocks.map(|one| (one.group, one.binding))
    }
}
