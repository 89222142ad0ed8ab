//! The text in which a function is translated: the function and what it names. Functions that it
//! does not call have no influence on this text.
//!
//! A callee is a stub: its signature, and in place of its body only what its callers can notice
//! ([`FunctionSummary`]). An entry point that does nothing is added, since naga's writers need one.

use std::collections::BTreeSet;
use std::fmt::Write;

use naga::ShaderStage;

use super::outline::{ContentKey, Outline, hash_parts};
use super::reason::Reason;
use super::summary::{FunctionSummary, ResourceOrigin, TextureShape};
use lamplight_compose::PartKind;
use lamplight_syntax::words::words;

/// The name of the entry point that does nothing.
pub const IDLE: &str = "lamplight_idle";

/// The local variable in which a stub returns its result.
const RESULT: &str = "lamplight_result";

/// What a canonical text is made for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum UnitId {
    Function(usize),
    /// The entry point.
    Entry,
}

/// What a canonical text is made of: indices of declarations.
#[derive(Debug)]
pub struct Recipe<'s> {
    pub unit: UnitId,
    /// The function that keeps its body.
    pub function: usize,
    /// Structures, constants and assertions, in the order of the text.
    others: Vec<usize>,
    /// Variables, sorted by name, since Metal passes them as arguments in their order.
    variables: Vec<usize>,
    /// The callees, each with the summary that its stub must show.
    pub stubs: Vec<(usize, &'s FunctionSummary)>,
    /// The structure that the entry point which does nothing returns. HLSL writes a structure in
    /// another way where an entry point returns it.
    interface: Option<usize>,
}

/// Collects what a unit needs. `summaries` has the summary of every function that comes before it.
pub fn make_recipe<'s>(
    outline: &Outline<'_>,
    unit: UnitId,
    summaries: &dyn Fn(usize) -> Option<&'s FunctionSummary>,
) -> Result<Recipe<'s>, Reason> {
    let function = match unit {
        UnitId::Entry => outline.entry(),
        UnitId::Function(function) => function,
    };
    let stubs =
        outline.callees(function).map(|callee| summaries(callee).map(|summary| (callee, summary)));
    let stubs: Vec<(usize, &FunctionSummary)> =
        stubs.collect::<Option<_>>().ok_or(Reason::Recursion)?;
    let mut open: Vec<usize> = Vec::new();
    open.extend(&outline.declarations[function].uses);
    for (callee, summary) in &stubs {
        open.extend(&outline.declarations[*callee].head_uses);
        for name in &summary.globals {
            open.push(outline.find(name).ok_or(Reason::Stub)?);
        }
    }
    if unit == UnitId::Entry {
        let asserted = |index: &usize| outline.declarations[*index].kind == PartKind::Assertion;
        open.extend((0..outline.declarations.len()).filter(asserted));
    }
    let reached = named_closure(outline, open);
    let of = |wanted: PartKind| {
        let is_wanted = move |index: &&usize| {
            (outline.declarations[**index].kind == PartKind::Variable)
                == (wanted == PartKind::Variable)
        };
        reached.iter().filter(is_wanted).copied().collect::<Vec<usize>>()
    };
    let mut variables = of(PartKind::Variable);
    variables.sort_by_key(|index| outline.declarations[*index].name());
    let others = of(PartKind::Other);
    let interface = outline
        .interface
        .filter(|interface| matches!(unit, UnitId::Function(_)) && others.contains(interface));
    Ok(Recipe { unit, function, others, variables, stubs, interface })
}

/// The declarations in `open`, and those that they name, directly or through others. Functions are
/// left out. The order is that of the text.
fn named_closure(outline: &Outline<'_>, mut open: Vec<usize>) -> BTreeSet<usize> {
    let mut reached = BTreeSet::new();
    while let Some(index) = open.pop() {
        let declaration = &outline.declarations[index];
        if declaration.kind != PartKind::Function && reached.insert(index) {
            open.extend(&declaration.uses);
        }
    }
    reached
}

impl Recipe<'_> {
    /// A hash of every byte of the text, and of every fact that is added to its module.
    pub fn key(&self, outline: &Outline<'_>) -> ContentKey {
        let declared = |index: &usize| &outline.declarations[*index].hash[..];
        let unit = match self.unit {
            UnitId::Entry => "entry",
            UnitId::Function(_) => "function",
        };
        let stage = if outline.stage == ShaderStage::Vertex { "vertex" } else { "fragment" };
        let head = [unit, stage, &outline.header];
        let mut parts: Vec<&[u8]> = head.map(str::as_bytes).to_vec();
        for list in [&self.others, &self.variables] {
            parts.extend(list.iter().map(declared).chain([&[][..]]));
        }
        for (stub, summary) in &self.stubs {
            parts.extend([outline.declarations[*stub].head.as_bytes(), &summary.key]);
        }
        parts.push(declared(&self.function));
        parts.push(self.interface.as_ref().map_or(&[], declared));
        hash_parts(parts)
    }

    /// Bytes of the declarations that the text is made of.
    pub fn bytes(&self, outline: &Outline<'_>) -> usize {
        let whole = self.others.iter().chain(&self.variables).chain([&self.function]);
        let heads = self.stubs.iter().map(|(stub, _)| outline.declarations[*stub].head.len());
        whole.map(|index| outline.declarations[*index].text.len()).chain(heads).sum()
    }

    /// Writes the canonical text.
    pub fn text(&self, outline: &Outline<'_>) -> Result<String, Reason> {
        let mut text = outline.header.clone();
        let declared = self.others.iter().chain(&self.variables);
        for index in declared {
            text.push_str(outline.declarations[*index].text);
            text.push('\n');
        }
        for (stub, summary) in &self.stubs {
            text.push_str(&write_stub(outline, *stub, summary)?);
        }
        text.push_str(outline.declarations[self.function].text);
        text.push('\n');
        if matches!(self.unit, UnitId::Function(_)) {
            self.write_idle(outline, &mut text);
        }
        Ok(text)
    }

    fn write_idle(&self, outline: &Outline<'_>, text: &mut String) {
        let is_vertex = outline.stage == ShaderStage::Vertex;
        let idle = match self.interface {
            Some(interface) => {
                let name = outline.declarations[interface].name();
                let stage = if is_vertex { "vertex" } else { "fragment" };
                format!("@{stage} fn {IDLE}()->{name}{{var {RESULT}:{name};return {RESULT};}}\n")
            }
            None if is_vertex => {
                format!("@vertex fn {IDLE}()->@builtin(position)vec4f{{return vec4f();}}\n")
            }
            None => format!("@fragment fn {IDLE}(){{}}\n"),
        };
        text.push_str(&idle);
    }
}

/// A function's signature, with a body that does what callers can notice of the function.
fn write_stub(
    outline: &Outline<'_>,
    stub: usize,
    summary: &FunctionSummary,
) -> Result<String, Reason> {
    let declaration = &outline.declarations[stub];
    let head = declaration.head;
    let mut body = String::new();
    let arguments = parameter_names(head).ok_or(Reason::Stub)?;
    for pair in &summary.pairs {
        let name = |place: &ResourceOrigin| match place {
            ResourceOrigin::Global(name) => Some(name.clone()),
            ResourceOrigin::Argument(number) => arguments.get(*number as usize).cloned(),
        };
        let texture = name(&pair.texture).ok_or(Reason::Stub)?;
        let sampler = name(&pair.sampler).ok_or(Reason::Stub)?;
        let sample = sample_statement(pair.shape, &texture, &sampler);
        body.push_str(&sample.ok_or(Reason::Sampling)?);
    }
    if let Some((_, result)) = head.split_once("->") {
        let result = result.trim();
        let _ = write!(body, "var {RESULT}:{result};return {RESULT};");
    }
    Ok(format!("{head}{{{body}}}\n"))
}

/// The names of a function's parameters.
fn parameter_names(head: &str) -> Option<Vec<String>> {
    let open = head.find('(')?;
    let mut list = head.get(open + 1..)?;
    let (mut depth, mut starts, mut end) = (0_i32, vec![0], list.len());
    for (at, byte) in list.bytes().enumerate() {
        match byte {
            b')' if depth == 0 => {
                end = at;
                break;
            }
            b'(' | b'[' | b'<' => depth += 1,
            b')' | b']' | b'>' => depth -= 1,
            b',' if depth == 0 => starts.push(at + 1),
            _ => {}
        }
    }
    list = &list[..end];
    let ends = starts.iter().skip(1).map(|start| start - 1).chain([end]);
    let each = starts.iter().zip(ends).map(|(start, end)| &list[*start..end]);
    let name = |parameter: &str| {
        let named = parameter.split_once(':')?.0;
        words(named).last().map(|word| word.text.to_owned())
    };
    each.filter(|parameter| !parameter.trim().is_empty()).map(name).collect()
}

/// A statement that samples a texture.
fn sample_statement(shape: TextureShape, texture: &str, sampler: &str) -> Option<String> {
    let TextureShape { coordinates, arrayed, depth, compares } = shape;
    let size = if coordinates > 1 { coordinates.to_string() } else { return None };
    let layer = if arrayed { ",0" } else { "" };
    let at = format!("{texture},{sampler},vec{size}f(){layer}");
    Some(match (depth, compares) {
        (true, true) => format!("_=textureSampleCompareLevel({at},0.0);"),
        (true, false) => format!("_=textureSampleLevel({at},0);"),
        (false, false) => format!("_=textureSampleLevel({at},0.0);"),
        (false, true) => return None,
    })
}
