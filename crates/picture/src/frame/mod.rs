//! Whole programs, made ready to be drawn: uniforms packed by reflection, stages composed, and
//! fragment stages that also return what each fragment was given.
//!
//! `reflection + values -> buffers`, `permutation -> stages`
//!
//! [`Programs`] composes the programs of the library's manifest into the stages of one permutation,
//! and ends their loops after a number of trips, so that no loop keeps a device busy.
//!
//! The targets of a frame hold words, four for each pixel, so that results are exact to the bit on
//! every executor. [`probe`] rewrites a fragment entry point to return the bits of its colour and
//! of its inputs.

pub mod probe;

use crate::needs::NeedsTable;
use lamplight_bundle::{Binding, Language, Member, Reflection};
use lamplight_compose as compose;
use lamplight_compose::resolve::Graph;
use lamplight_compose::{Options, PartKind, SourceMap, project, resolve};
use lamplight_diagnostic::source::{Embedded, SourceSet};
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_emit::reflect;
use lamplight_permute::manifest::{ManifestFile, Program};
use lamplight_permute::{Manifest, Settings};
use lamplight_validate::{Validated, functions, inner_blocks, inner_blocks_mut, validate};
use naga::{
    AddressSpace, Arena, BinaryOperator, Block, Expression, Function, GlobalVariable, Handle,
    Literal, LocalVariable, MemoryDecorations, Module, Range, Scalar, Span, Statement, Type,
    TypeInner,
};
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The library's programs. Each graph is read once.
pub struct Programs {
    library: Embedded,
    manifest: Manifest,
    pictures: NeedsTable,
    kept: Mutex<KeptPrograms>,
}

/// The texts, and the graph of each file.
struct KeptPrograms {
    texts: SourceSet,
    graphs: BTreeMap<String, Arc<Graph>>,
    /// The permutations that were asked for last, the latest at the end. Pictures of the same one
    /// follow each other while somebody moves a lamp.
    stages: VecDeque<(StagesKey, Stages)>,
}

impl KeptPrograms {
    /// Stages that are kept. They become the most recently used ones.
    fn again(&mut self, key: &StagesKey) -> Option<Stages> {
        let at = self.stages.iter().position(|(known, _)| known == key)?;
        let found = self.stages.remove(at)?;
        let stages = found.1.clone();
        self.stages.push_back(found);
        Some(stages)
    }
}

/// The program, settings and language of stages.
type StagesKey = (String, Settings, Language);

/// How many permutations are kept: as many as the passes of a picture.
const KEPT_STAGES: usize = 8;

/// The stages of one permutation. Without a fragment stage it draws only depth.
#[derive(Debug, Clone)]
pub struct Stages {
    pub vertex: ReadyStage,
    pub fragment: Option<ReadyStage>,
}

/// An entry point, ready to run.
#[derive(Debug, Clone)]
pub struct ReadyStage {
    pub validated: Arc<Validated>,
    pub entry: &'static str,
    pub reflection: Reflection,
    /// The composed text; for WESL, that of both stages.
    pub text: Arc<str>,
    /// Leads from the text back to its authors' files. There is none for a stage that is made.
    pub map: Arc<SourceMap>,
    /// The module before its loops were bounded.
    pub written: Arc<Validated>,
    /// Paths of the library's functions that the text has, such as `lighting::spot::cone_hard`.
    pub functions: Arc<[String]>,
}

impl ReadyStage {
    /// A stage that no author wrote.
    pub fn made(
        validated: Arc<Validated>,
        entry: &'static str,
        reflection: Reflection,
        text: Arc<str>,
    ) -> Self {
        let (written, map) = (validated.clone(), Arc::default());
        Self { validated, entry, reflection, text, map, written, functions: Arc::from(Vec::new()) }
    }
}

impl Programs {
    /// Reads the manifest of the library.
    ///
    /// # Errors
    /// The manifest's, with the texts to show them in.
    pub fn load(library: Embedded) -> Result<Self, (SourceSet, Diagnostics)> {
        Self::of_manifest(library, project::library_manifest(library)?)
    }

    /// The same without the lists of the manifest, in a fraction of the time: for those who draw a
    /// permutation that they choose themselves. Whether it ships is not known.
    ///
    /// # Errors
    /// Those of [`Self::load`].
    pub fn outline(library: Embedded) -> Result<Self, (SourceSet, Diagnostics)> {
        Self::of_manifest(library, project::library_outline(library)?)
    }

    fn of_manifest(
        library: Embedded,
        (mut texts, manifest): (SourceSet, Manifest),
    ) -> Result<Self, (SourceSet, Diagnostics)> {
        match NeedsTable::load(library, &mut texts, &manifest) {
            Ok(pictures) => {
                let (graphs, stages) = Default::default();
                let kept = Mutex::new(KeptPrograms { texts, graphs, stages });
                Ok(Self { library, manifest, pictures, kept })
            }
            Err(problems) => Err((texts, problems)),
        }
    }

    /// The library that has the programs.
    pub fn library(&self) -> Embedded {
        self.library
    }

    /// What pictures need from the programs.
    pub fn pictures(&self) -> &NeedsTable {
        &self.pictures
    }

    pub fn manifest(&self) -> &Manifest {
        &self.manifest
    }

    /// The texts that were read so far.
    pub fn texts(&self) -> SourceSet {
        self.kept().texts.clone()
    }

    /// Calls a function with the texts that were read so far.
    pub fn with_texts<T>(&self, run: impl FnOnce(&mut SourceSet) -> T) -> T {
        run(&mut self.kept().texts)
    }

    /// Composes both stages of a program.
    ///
    /// # Errors
    /// Those of the composition, and a program that does not exist in the language.
    pub fn stages(
        &self,
        program: &Program,
        settings: &Settings,
        language: Language,
    ) -> Result<Stages, Diagnostics> {
        let key = (program.name.clone(), settings.clone(), language);
        if let Some(stages) = self.kept().again(&key) {
            return Ok(stages);
        }
        let stages = self.composed_stages(program, settings, language)?;
        let mut kept = self.kept();
        kept.stages.push_back((key, stages.clone()));
        if kept.stages.len() > KEPT_STAGES {
            kept.stages.pop_front();
        }
        Ok(stages)
    }

    fn composed_stages(
        &self,
        program: &Program,
        settings: &Settings,
        language: Language,
    ) -> Result<Stages, Diagnostics> {
        match (language, &program.wesl, &program.glsl) {
            (Language::Wesl, Some(file), _) => self.of_wesl(file, settings),
            (Language::Glsl, _, Some(glsl)) => {
                let vertex =
                    glsl.vertex.as_ref().ok_or_else(|| absent_language(program, language))?;
                let stage = |file: &ManifestFile| {
                    self.composed(file, settings, language)
                        .and_then(|text| ready_text(&text, "main"))
                };
                Ok(Stages {
                    vertex: stage(vertex)?,
                    fragment: glsl.fragment.as_ref().map(stage).transpose()?,
                })
            }
            _ => Err(absent_language(program, language)),
        }
    }

    fn of_wesl(&self, file: &ManifestFile, settings: &Settings) -> Result<Stages, Diagnostics> {
        let text = self.composed(file, settings, Language::Wesl)?;
        let mut points = text.validated.module.entry_points.iter();
        let has_fragment = points.any(|point| point.name == "fs_main");
        let fragment = if has_fragment { Some(ready_text(&text, "fs_main")?) } else { None };
        Ok(Stages { vertex: ready_text(&text, "vs_main")?, fragment })
    }

    fn composed(
        &self,
        file: &ManifestFile,
        settings: &Settings,
        language: Language,
    ) -> Result<CompiledText, Diagnostics> {
        let composed =
            compose::compose(&*self.graph(file, language)?, settings, &Options::default())?;
        let validated = Arc::new(validate(&composed)?);
        let functions = library_functions(&composed, &self.kept().texts);
        let map = Arc::new(composed.map);
        Ok(CompiledText { text: composed.text.into(), map, functions, validated })
    }

    fn graph(&self, file: &ManifestFile, language: Language) -> Result<Arc<Graph>, Diagnostics> {
        let mut kept = self.kept();
        if let Some(graph) = kept.graphs.get(&file.path) {
            return Ok(graph.clone());
        }
        let graph = Arc::new(resolve::load(
            &mut kept.texts,
            &project::library_packages(self.library),
            &file.path,
            language,
        )?);
        kept.graphs.insert(file.path.clone(), graph.clone());
        Ok(graph)
    }

    fn kept(&self) -> MutexGuard<'_, KeptPrograms> {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A composed text, compiled.
struct CompiledText {
    text: Arc<str>,
    map: Arc<SourceMap>,
    functions: Arc<[String]>,
    validated: Arc<Validated>,
}

/// The functions of a text that are in modules of the library, in the order of their paths.
fn library_functions(composed: &compose::Composed, texts: &SourceSet) -> Arc<[String]> {
    let functions = composed.parts.iter().filter(|part| part.kind == PartKind::Function);
    let path = |part: &compose::Part| {
        let file = &texts.get(composed.place_of(part)?.source).path;
        let (module, _) = file.rsplit_once('.')?;
        let is_module = !module.contains("programs/");
        let name = part.names.first().filter(|_| is_module)?;
        Some(format!("{}::{name}", module.trim_start_matches("lamplight/").replace('/', "::")))
    };
    functions.filter_map(path).collect::<BTreeSet<_>>().into_iter().collect()
}

fn ready_text(text: &CompiledText, entry: &'static str) -> Result<ReadyStage, Diagnostics> {
    let reflection = reflect(&text.validated, entry).map_err(|problem| vec![problem])?;
    Ok(ReadyStage {
        validated: text.validated.clone(),
        entry,
        reflection,
        text: text.text.clone(),
        map: text.map.clone(),
        written: text.validated.clone(),
        functions: text.functions.clone(),
    })
}

fn absent_language(program: &Program, language: Language) -> Diagnostics {
    let name = match language {
        Language::Wesl => "WESL",
        Language::Glsl => "GLSL",
    };
    vec![Diagnostic::error(
        codes::UNKNOWN_PROGRAM,
        format!("there is no program `{}` in {name}", program.name),
    )]
}

/// Gives the numbers of a field by its path, such as `lamps.lights[2].color`. A matrix is given
/// column by column; an empty list stands for zeros. `None` if nothing knows the field.
type FieldNumbers<'n> = dyn Fn(&str) -> Option<Vec<f64>> + 'n;

/// A scalar, a vector or a matrix in a buffer.
pub struct BufferLeaf<'b> {
    /// As in [`FieldNumbers`].
    pub path: String,
    /// Type in WGSL.
    pub ty: &'b str,
    at: u32,
    size: u32,
}

/// The bytes of a buffer.
///
/// # Errors
/// A field that nothing knows, or for which there are too few numbers.
pub fn pack_buffer(binding: &Binding, numbers: &FieldNumbers<'_>) -> Result<Vec<u8>, Diagnostic> {
    let mut bytes = vec![0; binding.size.unwrap_or(0) as usize];
    buffer_leaves(binding).iter().try_for_each(|leaf| pack_leaf(&mut bytes, leaf, numbers))?;
    Ok(bytes)
}

/// Everything in a buffer that has numbers, in the order of the buffer.
pub fn buffer_leaves(binding: &Binding) -> Vec<BufferLeaf<'_>> {
    let mut leaves = Vec::new();
    if binding.members.is_empty() {
        let size = binding.size.unwrap_or(0);
        leaves.push(BufferLeaf { path: binding.name.clone(), ty: &binding.ty, at: 0, size });
    }
    members(&mut leaves, 0, &binding.name, &binding.members);
    leaves
}

fn members<'b>(leaves: &mut Vec<BufferLeaf<'b>>, base: u32, path: &str, members: &'b [Member]) {
    for one in members {
        member(leaves, base + one.offset, format!("{path}.{}", one.name), one);
    }
}

fn member<'b>(leaves: &mut Vec<BufferLeaf<'b>>, at: u32, path: String, member: &'b Member) {
    let is_array = |stride: &u32| *stride > 0 && member.ty.starts_with("array");
    let Some(stride) = member.stride.filter(is_array) else {
        if member.members.is_empty() {
            return leaves.push(BufferLeaf { path, ty: &member.ty, at, size: member.size });
        }
        return members(leaves, at, &path, &member.members);
    };
    for index in 0..member.size / stride {
        let (at, path) = (at + index * stride, format!("{path}[{index}]"));
        if member.members.is_empty() {
            let ty = member.ty.trim_start_matches("array<").split(',').next().unwrap_or_default();
            leaves.push(BufferLeaf { path, ty, at, size: stride });
        } else {
            members(leaves, at, &path, &member.members);
        }
    }
}

fn pack_leaf(
    bytes: &mut [u8],
    leaf: &BufferLeaf<'_>,
    numbers: &FieldNumbers<'_>,
) -> Result<(), Diagnostic> {
    let BufferLeaf { path, ty, at, size } = leaf;
    let values = numbers(path).ok_or_else(|| without_number(path, ty))?;
    let offsets: Vec<u32> = scalar_offsets(ty, *size).collect();
    if !values.is_empty() && values.len() < offsets.len() {
        let message = format!(
            "the uniform `{path}: {ty}` was given {} of {} numbers",
            values.len(),
            offsets.len()
        );
        return Err(Diagnostic::error(codes::PICTURE_INVALID, message));
    }
    for (offset, value) in offsets.into_iter().zip(values) {
        let from = (at + offset) as usize;
        if let Some(place) = bytes.get_mut(from..from + 4) {
            place.copy_from_slice(&word_bytes(ty, value));
        }
    }
    Ok(())
}

fn without_number(path: &str, ty: &str) -> Diagnostic {
    let message = format!("nothing has a number for the uniform `{path}: {ty}`");
    Diagnostic::error(codes::PICTURE_INVALID, message).note(
        "help: give it one under `[uniforms]` of `shaderlib/pictures.toml`, or compute it from the \
         scene in `crates/picture/src/values.rs`",
    )
}

/// The offsets of a value's scalars, column by column, each of `rows` scalars.
fn scalar_offsets(ty: &str, size: u32) -> impl Iterator<Item = u32> {
    let digit = |index: usize| {
        ty.as_bytes().get(index).map_or(1, |digit| u32::from(digit.saturating_sub(b'0')))
    };
    let (rows, step) = match ty {
        _ if ty.starts_with("mat") => (digit(5), if digit(5) == 2 { 8 } else { 16 }),
        _ if ty.starts_with("vec") => (digit(3), 16),
        _ => (1, size.max(4)),
    };
    (0..size / 4).map(|index| index * 4).filter(move |offset| offset % step < 4 * rows)
}

fn word_bytes(ty: &str, value: f64) -> [u8; 4] {
    match ty {
        _ if ty.contains("i32") || ty.ends_with('i') => (value as i32).to_le_bytes(),
        _ if ty.contains("u32") || ty.ends_with('u') => (value as u32).to_le_bytes(),
        _ => (value as f32).to_le_bytes(),
    }
}

/// Ends each loop once `most` trips were made, in all functions of an invocation together.
///
/// Browsers refuse derivatives in a loop whose end depends on a module-scope variable, since that
/// could differ between invocations. So in a module with derivatives, each call of a function
/// counts its own trips. If functions call one another in loops, their numbers of trips multiply.
pub fn bound_loops(module: &mut Module, most: u32) {
    let ty = Type { name: None, inner: TypeInner::Scalar(Scalar::U32) };
    let ty = module.types.insert(ty, Span::UNDEFINED);
    let shared = match has_derivatives(module) {
        true => None,
        false => Some(module.global_variables.append(trip_counter(ty), Span::UNDEFINED)),
    };
    let functions = module.functions.iter_mut().map(|(_, function)| function);
    for function in functions.chain(module.entry_points.iter_mut().map(|point| &mut point.function))
    {
        if has_loop(&function.body) {
            bound_function(function, shared, ty, most);
        }
    }
}

fn trip_counter(ty: Handle<Type>) -> GlobalVariable {
    GlobalVariable {
        name: Some("lamplight_trips".to_owned()),
        space: AddressSpace::Private,
        binding: None,
        ty,
        init: None,
        memory_decorations: MemoryDecorations::empty(),
    }
}

fn has_derivatives(module: &Module) -> bool {
    functions(module).any(|function| {
        function.expressions.iter().any(|(_, expression)| {
            matches!(expression, Expression::Derivative { .. } | Expression::ImageSample { .. })
        })
    })
}

fn has_loop(block: &Block) -> bool {
    block.iter().any(|statement| {
        matches!(statement, Statement::Loop { .. })
            || inner_blocks(statement).into_iter().any(has_loop)
    })
}

fn bound_function(
    function: &mut Function,
    shared: Option<Handle<GlobalVariable>>,
    ty: Handle<Type>,
    most: u32,
) {
    let mut add = |expression| function.expressions.append(expression, Span::UNDEFINED);
    let counter = match shared {
        Some(global) => add(Expression::GlobalVariable(global)),
        None => {
            let zero = add(Expression::Literal(Literal::U32(0)));
            let name = Some("lamplight_trips".to_owned());
            let local = LocalVariable { name, ty, init: Some(zero) };
            let local = function.local_variables.append(local, Span::UNDEFINED);
            add(Expression::LocalVariable(local))
        }
    };
    let (one, most) =
        (add(Expression::Literal(Literal::U32(1))), add(Expression::Literal(Literal::U32(most))));
    bound_block(&mut function.body, &mut function.expressions, [counter, one, most]);
}

type BudgetValue = Handle<Expression>;

/// Begins the body of every loop with `trips += 1; if trips > most { break; }`.
fn bound_block(block: &mut Block, arena: &mut Arena<Expression>, given: [BudgetValue; 3]) {
    for statement in block.iter_mut() {
        for inner in inner_blocks_mut(statement) {
            bound_block(inner, arena, given);
        }
        if let Statement::Loop { body, .. } = statement {
            body.splice(0..0, counted_trip(arena, given));
        }
    }
}

fn counted_trip(arena: &mut Arena<Expression>, [counter, one, most]: [BudgetValue; 3]) -> Block {
    let mut add = |expression| arena.append(expression, Span::UNDEFINED);
    let before = add(Expression::Load { pointer: counter });
    let binary = |op, left, right| Expression::Binary { op, left, right };
    let after = add(binary(BinaryOperator::Add, before, one));
    let done = add(binary(BinaryOperator::Greater, after, most));
    let accept = Block::from_vec(vec![Statement::Break]);
    Block::from_vec(vec![
        Statement::Emit(Range::new_from_bounds(before, done)),
        Statement::Store { pointer: counter, value: after },
        Statement::If { condition: done, accept, reject: Block::new() },
    ])
}
