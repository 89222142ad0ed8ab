//! The two stages that are drawn, out of the texts of an author.

use std::collections::BTreeMap;
use std::sync::Arc;

use lamplight_bundle::{Binding, BindingKind, Language, SourceClip, Varying};
use lamplight_compose::{Composed, SourceMap};
use lamplight_diagnostic::source::Span;
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_emit::{isolate, reflect, with_defaults};
use lamplight_glsl::wgsl::Clip as Conversion;
use lamplight_scene::Clip;
use lamplight_validate::{
    Validated, glsl_as_wgsl, of_translation, on_large_stack, positions_of, validate,
};
use naga::ShaderStage;

use super::refused;
use crate::frame::{ReadyStage, bound_loops};
use crate::sketch::input_label;

/// How many trips the loops of an invocation may make, so that no text keeps a device for ever.
const TRIPS: u32 = 1 << 18;

/// A text of an author's, as WGSL.
#[derive(Debug, Clone)]
pub struct OwnText {
    validated: Validated,
    text: Arc<str>,
    map: Arc<SourceMap>,
    is_glsl: bool,
    /// The clip space of the author's API.
    pub clip: Clip,
}

/// A stage that is drawn.
#[derive(Debug, Clone)]
pub struct OwnStage {
    pub ready: ReadyStage,
    /// As the author calls it.
    pub name: String,
    /// Where each binding is declared.
    pub places: BTreeMap<(u32, u32), Span>,
    pub is_glsl: bool,
    pub clip: Clip,
}

/// What is drawn. Without a vertex stage, one is made.
#[derive(Debug, Clone)]
pub struct OwnStages {
    pub vertex: Option<OwnStage>,
    pub fragment: OwnStage,
}

impl OwnStage {
    /// What is bound at a group and binding.
    fn binding_at(&self, place: (u32, u32)) -> Option<&Binding> {
        let mut all = self.ready.reflection.bindings.iter();
        all.find(|one| (one.group, one.binding) == place)
    }
}

impl OwnStages {
    /// The same stages, whose loops make at most so many trips: a page shares its device with all others
    /// of the browser.
    #[must_use]
    pub fn with_trips(mut self, trips: u32) -> Self {
        for stage in self.vertex.iter_mut().chain([&mut self.fragment]) {
            let mut validated = Validated::clone(&stage.ready.written);
            bound_loops(&mut validated.module, trips);
            stage.ready.validated = Arc::new(validated);
        }
        self
    }

    /// Whether they are GLSL for OpenGL or WebGL.
    pub fn is_for_opengl(&self) -> bool {
        self.fragment.is_glsl && self.fragment.clip == Clip::OpenGl
    }
}

impl OwnText {
    /// Validates a composed text. GLSL is translated. The second value has the warnings.
    ///
    /// # Errors
    /// What is wrong with the text, at the places of its author.
    pub fn read(
        composed: &Composed,
        source: SourceClip,
    ) -> Result<(Self, Diagnostics), Diagnostics> {
        let (wgsl, clip, warnings) = match composed.language {
            Language::Wesl => (None, Clip::Wgpu, Vec::new()),
            Language::Glsl => {
                let (clip, space) = clip_of(composed, source);
                let mut wgsl = glsl_as_wgsl(composed, clip)?;
                // Which number something got is of no interest here: this is the host.
                wgsl.warnings.retain(|warning| warning.code != codes::TRANSLATED_OTHERWISE);
                let warnings = std::mem::take(&mut wgsl.warnings);
                (Some(wgsl), space, warnings)
            }
        };
        let is_glsl = wgsl.is_some();
        let read = wgsl.as_ref().unwrap_or(composed);
        let validated = validate(read).map_err(|errors| match is_glsl {
            true => errors.into_iter().map(of_translation).collect(),
            false => errors,
        })?;
        let (text, map) = (read.text.as_str().into(), Arc::new(read.map.clone()));
        Ok((Self { validated, text, map, is_glsl, clip }, warnings))
    }

    fn place(&self, span: naga::Span) -> Option<Span> {
        self.map.lookup(span.to_range()?)
    }
}

/// The conversion of positions, and the clip space that the author has in mind. A fragment stage has
/// no positions, but its coordinates of pixels are those of the same API.
fn clip_of(composed: &Composed, source: SourceClip) -> (Conversion, Clip) {
    let as_vertex = Composed { stage: Some(lamplight_bundle::Stage::Vertex), ..composed.clone() };
    let space = match positions_of(&as_vertex, source) {
        Conversion::Kept => Clip::Wgpu,
        Conversion::OpenGl => Clip::OpenGl,
        Conversion::Vulkan => Clip::Vulkan,
    };
    (positions_of(composed, source), space)
}

/// The stages of texts: those that `entries` names, or the only ones.
///
/// # Errors
/// There is no fragment stage; or several stages, of which none is named; or a name that no entry
/// point has.
pub fn choose_stages(texts: &[OwnText], entries: &[String]) -> Result<OwnStages, Diagnostics> {
    check_names(texts, entries)?;
    let fragment = one_of(texts, entries, ShaderStage::Fragment).map_err(|error| vec![error])?;
    let Some((text, name)) = fragment else { return Err(vec![no_fragment(texts)]) };
    let mut fragment = ready_stage(text, &name, "fs_main")?;
    check_outputs(&fragment).map_err(|error| vec![error])?;
    let vertex = one_of(texts, entries, ShaderStage::Vertex).map_err(|error| vec![error])?;
    let vertex = vertex.map(|(text, name)| ready_stage(text, &name, "vs_main")).transpose()?;
    if let Some(vertex) = &vertex {
        check_between(vertex, &fragment).map_err(|error| vec![error])?;
        separate_numbered(vertex, &mut fragment);
        check_shared(vertex, &fragment).map_err(|error| vec![error])?;
    }
    Ok(OwnStages { vertex, fragment })
}

fn points(texts: &[OwnText]) -> impl Iterator<Item = (&OwnText, &naga::EntryPoint)> {
    texts
        .iter()
        .flat_map(|text| text.validated.module.entry_points.iter().map(move |one| (text, one)))
}

fn names_of(texts: &[OwnText], stage: Option<ShaderStage>) -> Vec<&str> {
    let found = points(texts).filter(|(_, point)| stage.is_none_or(|stage| point.stage == stage));
    found.map(|(_, point)| point.name.as_str()).collect()
}

fn check_names(texts: &[OwnText], entries: &[String]) -> Result<(), Diagnostics> {
    let known = names_of(texts, None);
    let wrong = entries.iter().filter(|name| !known.contains(&name.as_str()));
    let errors: Diagnostics = wrong
        .map(|name| {
            let message = format!("there is no entry point `{name}`");
            Diagnostic::error(codes::UNKNOWN_ENTRY_POINT, message)
                .suggest(name, known.iter().copied())
                .note(format!("entry points: {}", known.join(", ")))
        })
        .collect();
    if errors.is_empty() { Ok(()) } else { Err(errors) }
}

/// The entry point of a stage: the one that is named, or the only one.
fn one_of<'t>(
    texts: &'t [OwnText],
    entries: &[String],
    stage: ShaderStage,
) -> Result<Option<(&'t OwnText, String)>, Diagnostic> {
    let all: Vec<_> = points(texts).filter(|(_, point)| point.stage == stage).collect();
    let named: Vec<_> =
        all.iter().filter(|(_, point)| entries.contains(&point.name)).copied().collect();
    let chosen = if named.is_empty() { all } else { named };
    match chosen.as_slice() {
        [] => Ok(None),
        [(text, point)] => Ok(Some((text, point.name.clone()))),
        several => {
            let kind = if stage == ShaderStage::Vertex { "vertex" } else { "fragment" };
            let names: Vec<&str> = several.iter().map(|(_, point)| point.name.as_str()).collect();
            let message = format!("there are several {kind} stages: {}", names.join(", "));
            let error = refused(&message);
            Err(error.note("help: `--entry NAME` chooses one"))
        }
    }
}

fn no_fragment(texts: &[OwnText]) -> Diagnostic {
    let stage_of = |(_, point): (&OwnText, &naga::EntryPoint)| {
        format!("`{}` is a {} stage", point.name, format!("{:?}", point.stage).to_lowercase())
    };
    let stages: Vec<String> = points(texts).map(stage_of).collect();
    let message = match stages.is_empty() {
        true => "there is no entry point to draw".to_owned(),
        false => format!("there is no fragment stage to draw: {}", stages.join(", ")),
    };
    let compute = names_of(texts, Some(ShaderStage::Compute));
    let help = match (compute.is_empty(), names_of(texts, Some(ShaderStage::Vertex)).is_empty()) {
        (false, true) => {
            "help: a compute shader makes no picture; `lamplight eval` calls functions"
        }
        (_, false) => "help: `--with FILE` names the file that has the fragment stage",
        _ => "help: `@fragment` makes a function one, which returns a colour at `@location(0)`",
    };
    Diagnostic::error(codes::NO_ENTRY_POINT, message).note(help)
}

fn ready_stage(text: &OwnText, name: &str, entry: &'static str) -> Result<OwnStage, Diagnostics> {
    let mut validated = isolate(&text.validated, name)?;
    fix_overrides(&mut validated, name)?;
    let places = validated.module.global_variables.iter().filter_map(|(handle, variable)| {
        let binding = variable.binding?;
        let span = text.place(validated.module.global_variables.get_span(handle))?;
        Some(((binding.group, binding.binding), span))
    });
    let places = places.collect();
    for point in &mut validated.module.entry_points {
        entry.clone_into(&mut point.name);
    }
    let reflection = reflect(&validated, entry).map_err(|problem| vec![problem])?;
    let written = Arc::new(validated.clone());
    bound_loops(&mut validated.module, TRIPS);
    let validated = Arc::new(validated);
    let ready = ReadyStage {
        validated,
        entry,
        reflection,
        text: text.text.clone(),
        map: text.map.clone(),
        written,
        functions: Arc::from(Vec::new()),
    };
    let name = name.to_owned();
    Ok(OwnStage { ready, name, places, is_glsl: text.is_glsl, clip: text.clip })
}

/// Gives overrides their own values, since nothing else chooses them here.
fn fix_overrides(validated: &mut Validated, name: &str) -> Result<(), Diagnostics> {
    if validated.module.overrides.is_empty() {
        return Ok(());
    }
    let fixed = on_large_stack(|| with_defaults(&validated.module, name));
    let (module, info) = fixed.map_err(|problem| vec![problem])?;
    (validated.module, validated.info) = (module, info);
    Ok(())
}

/// What is drawn are the floating-point numbers at location 0.
fn check_outputs(fragment: &OwnStage) -> Result<(), Diagnostic> {
    let outputs = &fragment.ready.reflection.outputs;
    let found = outputs.iter().find(|output| output.location == Some(0));
    let name = &fragment.name;
    let message = match found {
        Some(Varying { ty, .. }) if ty.ends_with("f32>") || ty == "f32" => return Ok(()),
        Some(Varying { ty, .. }) => {
            let ty = super::shape::short_type(ty);
            format!("`{name}` returns {ty} at location 0, which is no colour")
        }
        None if outputs.iter().all(|output| output.location.is_none()) => {
            format!("`{name}` returns no colour")
        }
        None => format!("`{name}` returns no colour at location 0"),
    };
    Err(refused(&message).note("help: a picture shows one to four numbers of f32 at location 0"))
}

/// Both stages must agree on what goes from one to the other.
fn check_between(vertex: &OwnStage, fragment: &OwnStage) -> Result<(), Diagnostic> {
    let outputs = &vertex.ready.reflection.outputs;
    let located = fragment.ready.reflection.inputs.iter().filter(|one| one.location.is_some());
    for input in located {
        let given = outputs.iter().find(|output| output.location == input.location);
        let name = input_label(input);
        let place = input.location.unwrap_or_default();
        let message = match given {
            Some(output) if output.ty == input.ty => continue,
            Some(Varying { ty, .. }) => format!(
                "the fragment stage `{}` takes `{name}` as {} at location {place}, where the vertex \
                 stage `{}` returns {}",
                fragment.name,
                super::shape::short_type(&input.ty),
                vertex.name,
                super::shape::short_type(ty)
            ),
            None => format!(
                "the fragment stage `{}` takes `{name}` at location {place}, where the vertex stage \
                 `{}` returns nothing",
                fragment.name, vertex.name
            ),
        };
        return Err(refused(&message));
    }
    Ok(())
}

/// The bindings at one place that differ in both stages.
fn clashes(vertex: &OwnStage, fragment: &OwnStage) -> Vec<(u32, u32)> {
    let differs = |one: &Binding, other: &Binding| match one.kind {
        kind if kind != other.kind => true,
        BindingKind::Uniform | BindingKind::Storage => one.size != other.size,
        _ => one.ty != other.ty,
    };
    let places = vertex.ready.reflection.bindings.iter().filter_map(|one| {
        let place = (one.group, one.binding);
        fragment.binding_at(place).is_some_and(|other| differs(one, other)).then_some(place)
    });
    places.collect()
}

/// Moves what GLSL has in two files under numbers that it did not choose, such as push constants.
fn separate_numbered(vertex: &OwnStage, fragment: &mut OwnStage) {
    if !fragment.is_glsl {
        return;
    }
    for place in clashes(vertex, fragment) {
        let taken = vertex.ready.reflection.bindings.iter();
        let taken = taken.chain(&fragment.ready.reflection.bindings);
        let free = taken.map(|one| one.binding + 1).max().unwrap_or(0);
        for validated in [&mut fragment.ready.validated, &mut fragment.ready.written] {
            for (_, variable) in Arc::make_mut(validated).module.global_variables.iter_mut() {
                if let Some(binding) = &mut variable.binding
                    && (binding.group, binding.binding) == place
                {
                    binding.binding = free;
                }
            }
        }
        for binding in &mut fragment.ready.reflection.bindings {
            if (binding.group, binding.binding) == place {
                binding.binding = free;
            }
        }
        if let Some(span) = fragment.places.remove(&place) {
            fragment.places.insert((place.0, free), span);
        }
    }
}

/// Two stages of separate files must not bind different things to one place.
fn check_shared(vertex: &OwnStage, fragment: &OwnStage) -> Result<(), Diagnostic> {
    let Some(place) = clashes(vertex, fragment).into_iter().next() else { return Ok(()) };
    let name =
        |stage: &OwnStage| stage.binding_at(place).map(|one| one.name.clone()).unwrap_or_default();
    let (group, binding) = place;
    let (one, other) = (name(vertex), name(fragment));
    let message = format!("`{one}` and `{other}` are both at group {group}, binding {binding}");
    let mut error = refused(&message);
    let labels =
        [(vertex, "the vertex stage has this there"), (fragment, "the fragment stage has this")];
    for (stage, label) in labels {
        if let Some(span) = stage.places.get(&place) {
            error = error.at(*span, label);
        }
    }
    Err(error)
}
