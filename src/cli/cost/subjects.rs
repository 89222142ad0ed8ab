//! Finds what is measured: functions of the library, permutations, shaders in files.

use std::path::Path;
use std::sync::Mutex;

use super::super::failure::{DiagnosticForm, Failure};
use super::super::input::{ComposedInput, ErrorContext};
use super::super::progress::Bar;
use super::super::stream::{self, STANDARD_INPUT};
use super::super::variants;
use super::{Arguments, MOST_BYTES};
use crate::LIBRARY_FILES;
use crate::bundle::key::DEFAULT;
use crate::bundle::{Axis, Conventions, Language, Stage, Target};
use crate::cache::Cache;
use crate::catalogue::{self, CatalogueItem, CatalogueItemKind};
use crate::check::library::Library;
use crate::compose::{Composed, PartKind};
use crate::cost::foreign::{ForeignError, foreign_stages};
use crate::cost::pipeline::ReflectedStage;
use crate::cost::{self, CostSubject, permutations};
use crate::diagnostic::{Diagnostics, nearest_name};
use crate::generate::{MemorySink, Optimiser, Request, Root, Tools, entry_points, generate};
use crate::input::read_file;
use crate::lint;
use crate::permute::{Manifest, Quoted, cover};
use crate::project;
use crate::resolve::{Graph, Packages};
use crate::source::SourceSet;
use crate::spirv_opt::SpirvOpt;
use crate::tools::SPIRV_VAL;
use crate::validate::validate_every;

/// What was asked for, in order.
pub fn requested_subjects(
    arguments: &Arguments,
    form: DiagnosticForm,
) -> Result<Vec<CostSubject>, Failure> {
    if arguments.cover {
        return covering_subjects(arguments);
    }
    let mut subjects = Vec::new();
    let (files, named): (Vec<&String>, Vec<&String>) =
        arguments.subjects.iter().partition(|name| is_file(name));
    let modules = catalogue::library_modules(LIBRARY_FILES);
    let items: Vec<&CatalogueItem> = modules.iter().flat_map(|module| &module.items).collect();
    let (paths, keys) = separate_paths(arguments, &items, named)?;
    if arguments.subjects.is_empty() || !paths.is_empty() {
        let conventions = arguments.conventions.chosen().or(Conventions::default());
        let language = requested_language(arguments);
        subjects = function_subjects(&items, &paths, language, conventions)?;
    }
    for key in keys {
        subjects.push(permutation_subject(arguments, key)?);
    }
    for file in files {
        let is_stream = file == STANDARD_INPUT;
        subjects.extend(match is_module(file) || is_stream && !arguments.input.names_language() {
            true => foreign_subjects(Path::new(file))?,
            false => file_subjects(arguments, Path::new(file), form)?,
        });
    }
    Ok(subjects)
}

/// Separates paths of the library from keys. An argument is a key if it contains `=` or `,`, or if
/// it is `default` or names an axis of the program and is no path of the library.
fn separate_paths<'a>(
    arguments: &Arguments,
    items: &[&CatalogueItem],
    named: Vec<&'a String>,
) -> Result<(Vec<&'a String>, Vec<&'a String>), Failure> {
    let is_path = |name: &str| items.iter().any(|item| is_below(&item.path(), name));
    let is_plain = |name: &str| !name.contains(['=', ',', ':']) && !is_path(name);
    let axes = match named.iter().any(|name| is_plain(name)) {
        true => axis_names(arguments)?,
        false => Vec::new(),
    };
    let is_axis = |name: &str| name == DEFAULT || axes.iter().any(|axis| axis == name);
    let is_key = |name: &str| name.contains(['=', ',']) || is_plain(name) && is_axis(name);
    Ok(named.into_iter().partition(|name| !is_key(name)))
}

/// Names of the axes of the program that keys are of.
fn axis_names(arguments: &Arguments) -> Result<Vec<String>, Failure> {
    let mut sources = SourceSet::default();
    let (manifest, _) = chosen_manifest(arguments, &mut sources)?;
    let name = program_of_key(arguments, &manifest)?;
    let program = manifest.programs.iter().find(|program| program.name == name);
    let axes = program.into_iter().flat_map(|program| program.space.axes());
    Ok(axes.map(|axis| axis.name.clone()).collect())
}

/// Whether a path is the one that is named, or is below it.
fn is_below(path: &str, named: &str) -> bool {
    let named = named.strip_prefix("lamplight::").unwrap_or(named);
    path == named || path.strip_prefix(named).is_some_and(|rest| rest.starts_with("::"))
}

/// Whether a name is that of a shader's file: it ends as one does, or is standard input.
fn is_file(name: &str) -> bool {
    name == STANDARD_INPUT || is_module(name) || has_text(name)
}

/// Whether a name is that of a file of SPIR-V.
fn is_module(name: &str) -> bool {
    Path::new(name).extension().is_some_and(|extension| extension == "spv")
}

fn has_text(name: &str) -> bool {
    let extension = Path::new(name).extension().and_then(|extension| extension.to_str());
    extension.is_some_and(|extension| lint::EXTENSIONS.contains(&extension))
}

fn requested_language(arguments: &Arguments) -> Language {
    arguments.input.chosen_language().unwrap_or(Language::Wesl)
}

/// The subjects of a file. If the file has exactly one vertex stage, exactly one fragment stage and
/// no other entry point, they are one subject. Otherwise each entry point is a subject. A file
/// without entry points is a module, whose functions are the subjects.
fn file_subjects(
    arguments: &Arguments,
    file: &Path,
    form: DiagnosticForm,
) -> Result<Vec<CostSubject>, Failure> {
    let ComposedInput { sources, composed, context } =
        arguments.input.compose(file, SourceSet::default(), form)?;
    let ErrorContext { graph, settings, options, .. } = &context;
    let conventions = arguments.conventions.chosen().or(context.conventions);
    let (optimiser, numbers): (Option<&dyn Optimiser>, _) = (Some(&SpirvOpt), &*context.numbers);
    let root = Root { graph, settings, options, conventions, optimiser, numbers };
    let of_sources = |errors| Failure::Input(sources.clone(), context.explain(errors));
    let entries = entry_points(&composed).map_err(of_sources)?;
    if entries.is_empty() {
        return module_subjects(file, graph, &composed, conventions).map_err(of_sources);
    }
    let shaders = root.compile(&entries, &[Target::SPIRV]).map_err(of_sources)?;
    let known = shaders.iter().map(|shader| {
        let artifact = shader.made.unit.targets.get(Target::SPIRV.name());
        let artifact = artifact.ok_or("there is no SPIR-V")?;
        let reflection = shader.made.unit.reflection.as_ref().clone();
        let known = ReflectedStage::new(&artifact.native.entry_name, &artifact.bytes, reflection)?;
        Ok((shader.entry.as_str(), known))
    });
    let with_name = |reason: String| Failure::input(format!("{}: {reason}", file.display()));
    let known =
        known.collect::<Result<Vec<(&str, ReflectedStage)>, String>>().map_err(with_name)?;
    stage_subjects(&file.display().to_string(), known)
}

/// The subjects of the stages of a file, by the names of their entry points.
fn stage_subjects(
    name: &str,
    known: Vec<(&str, ReflectedStage)>,
) -> Result<Vec<CostSubject>, Failure> {
    let with_name = |reason: String| Failure::input(format!("{name}: {reason}"));
    let of = |stage| known.iter().filter(move |(_, known)| known.words.stage == stage).count();
    let is_pair = (of(Stage::Vertex), of(Stage::Fragment), known.len()) == (1, 1, 2);
    if is_pair {
        let pair = known.into_iter().map(|(_, known)| known).collect();
        return Ok(vec![cost::stages_subject(name, pair).map_err(with_name)?]);
    }
    let each = known
        .into_iter()
        .map(|(entry, known)| cost::stages_subject(&format!("{name} {entry}"), vec![known]));
    each.collect::<Result<_, _>>().map_err(with_name)
}

/// The subjects of a file of SPIR-V, after `spirv-val` accepted it: a driver may do anything with
/// a module that is not valid.
fn foreign_subjects(file: &Path) -> Result<Vec<CostSubject>, Failure> {
    let name = match file.as_os_str() == STANDARD_INPUT {
        true => "<standard input>".to_owned(),
        false => file.display().to_string(),
    };
    let with_name = |reason: String| Failure::input(format!("{name}: {reason}"));
    let bytes = match file.as_os_str() == STANDARD_INPUT {
        true => stream::read_stream_bytes(file)?,
        false => read_file(file, MOST_BYTES).map_err(|error| with_name(error.to_string()))?,
    };
    let stages = foreign_stages(&bytes).map_err(|error| {
        let hint = match (&error, file.as_os_str() == STANDARD_INPUT) {
            (ForeignError::NoModule, true) => "; for a text, add `--lang`",
            _ => "",
        };
        with_name(format!("{error}{hint}"))
    })?;
    if SPIRV_VAL.path().is_none() {
        return Err(Failure::environment(SPIRV_VAL.missing()));
    }
    SPIRV_VAL.pipe(&["--target-env", "vulkan1.3", "-"], &bytes).map_err(with_name)?;
    let names: Vec<String> =
        stages.iter().map(|stage| stage.words.entry.to_string_lossy().into_owned()).collect();
    stage_subjects(&name, names.iter().map(String::as_str).zip(stages).collect())
}

/// The functions that a module declares itself.
fn module_subjects(
    file: &Path,
    graph: &Graph,
    composed: &Composed,
    conventions: Conventions,
) -> Result<Vec<CostSubject>, Diagnostics> {
    let module = validate_every(composed)?.module;
    let own = graph.root_items();
    let functions = composed.parts.iter().filter(|part| part.kind == PartKind::Function);
    let functions = functions.flat_map(|part| &part.names).filter(|name| own.contains(*name));
    let subject = |function: &String| {
        let name = format!("{} {function}", file.display());
        cost::function_subject(&name, &module, function, conventions)
    };
    functions.map(|function| subject(function).map_err(|error| vec![error])).collect()
}

/// The subjects of functions, modules and folders; of all functions where none is named.
pub fn function_subjects(
    items: &[&CatalogueItem],
    paths: &[&String],
    language: Language,
    conventions: Conventions,
) -> Result<Vec<CostSubject>, Failure> {
    let library = Library::shipped(LIBRARY_FILES);
    let functions: Vec<&CatalogueItem> =
        items.iter().copied().filter(|item| item.kind == CatalogueItemKind::Function).collect();
    for named in paths {
        if !functions.iter().any(|item| is_below(&item.path(), named)) {
            let known: Vec<String> = functions.iter().map(|item| item.path()).collect();
            let hint = nearest_name(named, known.iter().map(String::as_str))
                .map_or(String::new(), |near| format!("; did you mean `{near}`?"));
            return Err(Failure::input(format!("the library has no `{named}`{hint}")));
        }
    }
    let is_wanted = |path: &str| {
        let named = |named: &&String| is_below(path, named);
        paths.is_empty() || paths.iter().any(named)
    };
    let (sources, mut subjects) = (Mutex::new(SourceSet::default()), Vec::new());
    for item in functions.iter().filter(|item| is_wanted(&item.path())) {
        let path = item.path();
        let Some((module, name)) = path.rsplit_once("::") else { continue };
        let of_sources = |diagnostics| {
            Failure::Input(
                sources.lock().map(|sources| sources.clone()).unwrap_or_default(),
                diagnostics,
            )
        };
        let composed =
            library.module(&sources, module, language, &[name.to_owned()]).map_err(of_sources)?;
        let subject = cost::function_subject(&path, &composed, name, conventions);
        subjects.push(subject.map_err(|diagnostic| of_sources(vec![diagnostic]))?);
    }
    Ok(subjects)
}

/// The manifest that the arguments name, or that of the folder, or the library's.
fn chosen_manifest(
    arguments: &Arguments,
    sources: &mut SourceSet,
) -> Result<(Manifest, Packages), Failure> {
    let manifest = arguments.manifest.clone();
    let manifest = manifest.or_else(|| project::manifest_above(Path::new("")));
    variants::open_manifest(manifest.as_deref(), sources)
        .map_err(|diagnostics| Failure::Input(sources.clone(), diagnostics))
}

/// The subjects of covering sets. Their names begin with the program.
fn covering_subjects(arguments: &Arguments) -> Result<Vec<CostSubject>, Failure> {
    let mut sources = SourceSet::default();
    let (mut manifest, packages) = chosen_manifest(arguments, &mut sources)?;
    for program in &mut manifest.programs {
        program.space = cover::covering_space(program);
    }
    let names = match &arguments.program {
        Some(program) => vec![program.clone()],
        None => manifest.programs.iter().map(|program| program.name.clone()).collect(),
    };
    let mut subjects = Vec::new();
    for name in names {
        let request = Request {
            program: Some(name.clone()),
            targets: vec![Target::SPIRV],
            conventions: arguments.conventions.chosen(),
            ..Request::default()
        };
        let language = requested_language(arguments);
        let (_, found) =
            permutations_of(&mut sources, &packages, &manifest, &request, language, None)?;
        subjects.extend(found.into_iter().map(|mut subject| {
            subject.name = format!("{name} {}", subject.name);
            subject
        }));
    }
    Ok(subjects)
}

/// The subject of one permutation: its stages in SPIR-V, as a bundle has them.
fn permutation_subject(arguments: &Arguments, key: &str) -> Result<CostSubject, Failure> {
    let mut sources = SourceSet::default();
    let (manifest, packages) = chosen_manifest(arguments, &mut sources)?;
    let program = program_of_key(arguments, &manifest)?;
    let id = sources.add("KEY", key);
    let request = Request {
        program: Some(program),
        only: Some(Quoted::whole(&sources, id)),
        targets: vec![Target::SPIRV],
        conventions: arguments.conventions.chosen(),
        ..Request::default()
    };
    let language = requested_language(arguments);
    let subjects = permutations_of(&mut sources, &packages, &manifest, &request, language, None);
    subjects?.1.pop().ok_or_else(|| {
        Failure::input(format!("the permutation `{key}` has no stages in this language"))
    })
}

/// The permutations that a request chooses of a program, with the program's axes.
pub fn permutations_of(
    sources: &mut SourceSet,
    packages: &Packages,
    manifest: &Manifest,
    request: &Request,
    language: Language,
    cache: Option<&Cache>,
) -> Result<(Vec<Axis>, Vec<CostSubject>), Failure> {
    let (memory, bar) = (MemorySink::default(), Bar::new());
    let progress = |progress| bar.show(progress);
    let tools = Tools {
        sink: &memory,
        cache,
        tool: crate::TOOL,
        optimiser: Some(&SpirvOpt),
        progress: &progress,
    };
    let generated = generate(sources, packages, manifest, request, &tools);
    bar.clear();
    let generated =
        generated.map_err(|diagnostics| Failure::Input(sources.clone(), diagnostics))?;
    let mut contents = generated.contents;
    memory.fill(&mut contents);
    let program = contents.programs.into_values().next();
    let Some(program) = program else { return Ok(Default::default()) };
    let subjects =
        permutations::permutation_subjects(&program, language).map_err(Failure::input)?;
    Ok((program.axes, subjects))
}

/// The program that a key is of.
fn program_of_key(arguments: &Arguments, manifest: &Manifest) -> Result<String, Failure> {
    if let Some(program) = &arguments.program {
        return Ok(program.clone());
    }
    match manifest.programs.as_slice() {
        [only] => Ok(only.name.clone()),
        programs if programs.iter().any(|program| program.name == "forward") => {
            Ok("forward".to_owned())
        }
        _ => Err(Failure::usage("the manifest has several programs: choose one with `--program`")),
    }
}
