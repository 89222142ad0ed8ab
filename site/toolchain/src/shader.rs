//! Composition and outputs.

use std::collections::BTreeMap;

use lamplight::bundle::{
    BoundsChecks, Convention, Conventions, Language, Native, Reflection, RequestedConventions,
    Target,
};
use lamplight::compose::{self, Composed, Keep, Mangle, Options};
use lamplight::diagnostic::{self, Diagnostics, Severity, codes};
use lamplight::emit::targets;
use lamplight::generate::{CompiledShader, Root, entry_points};
use lamplight::lint;
use lamplight::permute::{Manifest, Program, Settings};
use lamplight::resolve::Graph;
use lamplight::source::SourceSet;
use serde::{Deserialize, Serialize};
use tsify::{Ts, Tsify};
use wasm_bindgen::prelude::wasm_bindgen;

use crate::choose::parsed;
use crate::diagnostic::{Diagnostic, diagnostics};
use crate::linkers::LINKERS;
use crate::package::{Files, Value, graph, manifest, packages};
use crate::{Answer, answer};

/// A root file and its settings, as for `lamplight compile`.
#[derive(Clone, PartialEq, Deserialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct ShaderRequest {
    /// The package; the library where it is left out.
    #[serde(default)]
    #[tsify(optional, type = "Record<string, string>")]
    pub files: Option<Files>,
    /// Path of the root file in the package.
    pub root: String,
    /// Axes of the program that the file belongs to, or flags.
    #[serde(default)]
    #[tsify(optional, type = "Record<string, boolean | number | string>")]
    pub settings: BTreeMap<String, Value>,
    /// The targets; if there are none, only the text is composed.
    #[serde(default)]
    #[tsify(optional)]
    pub targets: Vec<String>,
    /// `wgpu` or `native`; that of the program where it is left out.
    #[serde(default)]
    #[tsify(optional)]
    pub clip: Option<String>,
    /// `unchecked` or `restrict`; those of the program where it is left out.
    #[serde(default)]
    #[tsify(optional)]
    pub bounds: Option<String>,
    /// Only this entry point.
    #[serde(default)]
    #[tsify(optional)]
    pub entry: Option<String>,
    /// Whether imported items have the underscore form of the WESL specification.
    #[serde(default)]
    #[tsify(optional)]
    pub underscore: bool,
    /// Whether items that no entry point reaches are kept.
    #[serde(default)]
    #[tsify(optional)]
    pub keep_all: bool,
}

/// The result.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct ShaderResult {
    /// Whether there is no error.
    pub ok: bool,
    /// The composed text; absent if it could not be composed.
    pub text: Option<String>,
    /// The key of the permutation, if the file belongs to a program.
    pub key: Option<String>,
    pub entries: Vec<EntryPoint>,
    pub diagnostics: Vec<Diagnostic>,
}

/// An entry point in its targets.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct EntryPoint {
    pub name: String,
    /// `vertex`, `fragment` or `compute`.
    pub stage: String,
    /// What an engine needs to know, as in a bundle.
    #[serde(serialize_with = "plain")]
    #[tsify(type = "Reflection")]
    pub reflection: Reflection,
    pub outputs: Vec<Output>,
}

/// A file of a target.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct Output {
    pub target: String,
    /// The text, unless the target is binary.
    pub text: Option<String>,
    /// As a file has it.
    #[serde(with = "bytes")]
    #[tsify(type = "Uint8Array")]
    pub bytes: Vec<u8>,
    /// Names and numbers of the target.
    #[serde(serialize_with = "plain")]
    #[tsify(type = "Native")]
    pub native: Native,
}

mod bytes {
    /// Writes all bytes as one array of the page, a `Uint8Array`.
    pub fn serialize<S: serde::Serializer>(bytes: &[u8], to: S) -> Result<S::Ok, S::Error> {
        to.serialize_bytes(bytes)
    }
}

/// As JSON has it: objects, and nothing for what is absent.
fn plain<T: serde::Serialize, S: serde::Serializer>(value: &T, to: S) -> Result<S::Ok, S::Error> {
    serde::Serialize::serialize(value, to)
}

#[wasm_bindgen(typescript_custom_section)]
const REFLECTION: &str = r#"
/** What an engine must know of an entry point: the form of `schema.json` of bundles. */
export interface Reflection {
    stage: "vertex" | "fragment" | "compute";
    workgroup_size?: [number, number, number];
    inputs: Varying[];
    outputs: Varying[];
    bindings: Binding[];
    pairs: unknown[];
    overrides: unknown[];
}
export interface Varying { name?: string; location?: number; builtin?: string; type: string; [more: string]: unknown }
export interface Binding { group: number; binding: number; name: string; kind: string; type: string; [more: string]: unknown }
/** Names and numbers of one target. */
export interface Native { entry_name: string; [more: string]: unknown }
"#;

/// The composed text of a root file.
#[wasm_bindgen]
pub fn compose(request: Ts<ShaderRequest>) -> Answer<ShaderResult> {
    answer(&made(&ShaderRequest { targets: Vec::new(), ..request.to_rust()? }))
}

/// The outputs of a root file: the bytes are those of `lamplight compile` and `lamplight gen`.
#[wasm_bindgen]
pub fn compile(request: Ts<ShaderRequest>) -> Answer<ShaderResult> {
    answer(&made(&request.to_rust()?))
}

fn made(request: &ShaderRequest) -> ShaderResult {
    let mut sources = SourceSet::default();
    let mut made = ShaderResult {
        ok: false,
        text: None,
        key: None,
        entries: Vec::new(),
        diagnostics: Vec::new(),
    };
    let found = run(request, &mut sources, &mut made).unwrap_or_else(|errors| errors);
    made.ok = found.iter().all(|one| one.severity != Severity::Error);
    made.diagnostics = diagnostics(&sources, &found);
    made
}

/// The composed text of a root file, with the problems in the author's places.
pub fn composed_text(
    request: &ShaderRequest,
    sources: &mut SourceSet,
) -> Result<Composed, Diagnostics> {
    let manifest = manifest(request.files.as_ref(), sources)?;
    let loaded = graph(request.files.as_ref(), &request.root, language(&request.root), sources)?;
    let Chosen { settings, .. } = chosen(request, manifest.get(), sources)?;
    compose::compose(&loaded.1, &settings, &options(request))
        .map_err(|errors| loaded.1.traced(errors))
}

/// What is chosen of a root file.
struct Chosen {
    settings: Settings,
    conventions: Conventions,
    key: Option<String>,
    warnings: Diagnostics,
}

fn run(
    request: &ShaderRequest,
    sources: &mut SourceSet,
    made: &mut ShaderResult,
) -> Result<Diagnostics, Diagnostics> {
    let wanted = wanted(&request.targets).map_err(|problem| vec![problem])?;
    let manifest = manifest(request.files.as_ref(), sources)?;
    let language = language(&request.root);
    let loaded = graph(request.files.as_ref(), &request.root, language, sources)?;
    let graph = &loaded.1;
    let Chosen { settings, conventions, key, mut warnings } =
        chosen(request, manifest.get(), sources)?;
    made.key = key;
    let conventions = requested_conventions(request)?.or(conventions);
    let options = options(request);
    let explain = |errors: Diagnostics| graph.traced(errors);
    let mut composed = compose::compose(graph, &settings, &options).map_err(explain)?;
    warnings.append(&mut composed.warnings);
    made.text = Some(composed.text.clone());
    if wanted.is_empty() {
        return Ok(warnings);
    }
    let shaders = shaders(request, graph, &settings, &options, conventions, &composed, &wanted);
    let shaders = shaders.map_err(explain)?;
    for warning in shaders.iter().flat_map(|shader| &shader.made.warnings) {
        if !warnings.contains(warning) {
            warnings.push(warning.clone());
        }
    }
    made.entries = shaders.iter().map(|shader| entry(shader, &wanted)).collect();
    Ok(graph.own(warnings))
}

fn shaders(
    request: &ShaderRequest,
    graph: &Graph,
    settings: &Settings,
    options: &Options,
    conventions: Conventions,
    composed: &Composed,
    wanted: &[Target],
) -> Result<Vec<CompiledShader>, Diagnostics> {
    let root = Root { graph, settings, options, conventions, optimiser: None, numbers: "" };
    let mut entries = entry_points(composed)?;
    if let Some(wanted) = &request.entry {
        entries.retain(|(name, _)| name == wanted);
    }
    if entries.is_empty() {
        let message = format!("`{}` has no such entry point", request.root);
        return Err(vec![diagnostic::Diagnostic::error(codes::NO_ENTRY_POINT, message)]);
    }
    LINKERS.with_borrow_mut(|linkers| {
        let linker = linkers.of(wanted, conventions);
        let made = root.compile_with(&entries, linker);
        linker.forget();
        made
    })
}

fn options(request: &ShaderRequest) -> Options {
    let mangle = if request.underscore { Mangle::Underscore } else { Mangle::Collisions };
    let keep = if request.keep_all { Keep::All } else { Keep::EntryPoints };
    Options { mangle, keep, stage: None }
}

/// The settings of a request, over the defaults of the program that the file belongs to.
fn chosen(
    request: &ShaderRequest,
    manifest: Option<&Manifest>,
    sources: &mut SourceSet,
) -> Result<Chosen, Diagnostics> {
    let program = manifest.and_then(|manifest| {
        manifest
            .programs
            .iter()
            .find(|program| program.files().any(|file| file.path == request.root))
    });
    if let Some(program) = program {
        return of_program(request, program, sources);
    }
    let values = request.settings.iter().map(|(name, value)| (name.clone(), value.setting()));
    let mut settings = Settings { values: values.collect(), ..Settings::default() };
    let mut warnings = Diagnostics::new();
    if let Some(manifest) = manifest {
        manifest.features.complete(&mut settings);
        warnings = manifest.features.broken(&settings);
    }
    Ok(Chosen { settings, conventions: Conventions::default(), key: None, warnings })
}

fn of_program(
    request: &ShaderRequest,
    program: &Program,
    sources: &mut SourceSet,
) -> Result<Chosen, Diagnostics> {
    let is_axis = |name: &str| program.space.axis(name).is_some();
    let (axes, flags): (Vec<_>, Vec<_>) =
        request.settings.iter().partition(|(name, _)| is_axis(name));
    let parts: Vec<String> =
        axes.iter().map(|(axis, value)| format!("{axis}={}", value.setting())).collect();
    let point = parsed(&program.space, &parts.join(","), sources)?;
    let mut settings = program.space.settings(&point);
    settings.values.extend(flags.iter().map(|(name, value)| ((*name).clone(), value.setting())));
    let broken = |constraint: &lamplight::permute::space::Constraint| {
        let message = format!("program `{}` has no such permutation", program.name);
        diagnostic::Diagnostic::warning(codes::INVALID_PERMUTATION, message)
            .at(constraint.span, "this constraint is broken")
    };
    let warnings = program.space.broken(&point).map(broken).collect();
    let key = Some(program.space.key(&point).to_string());
    Ok(Chosen { settings, conventions: program.conventions, key, warnings })
}

/// The language from the file's extension, as on the command line.
pub fn language(path: &str) -> Language {
    lint::language(path).unwrap_or(Language::Wesl)
}

fn wanted(names: &[String]) -> Result<Vec<Target>, diagnostic::Diagnostic> {
    let one = |name: &String| {
        Target::ALL.iter().copied().find(|target| target.name() == name).ok_or_else(|| {
            let known = Target::ALL.iter().map(|target| target.name());
            let message = format!("there is no target `{name}`");
            diagnostic::Diagnostic::error(codes::UNKNOWN_TARGET, message).suggest(name, known)
        })
    };
    names.iter().map(one).collect()
}

fn requested_conventions(request: &ShaderRequest) -> Result<RequestedConventions, Diagnostics> {
    let clip = named(&request.clip, codes::UNKNOWN_CLIP, "there is no clip space");
    let bounds =
        named::<BoundsChecks>(&request.bounds, codes::UNKNOWN_BOUNDS, "there are no checks");
    Ok(RequestedConventions { clip: clip?, source_clip: None, bounds: bounds?, spirv: None })
}

fn named<C: Convention>(
    name: &Option<String>,
    code: &'static diagnostic::Code,
    unknown: &str,
) -> Result<Option<C>, Diagnostics> {
    let Some(name) = name else { return Ok(None) };
    let found = C::find(name).ok_or_else(|| {
        let error = diagnostic::Diagnostic::error(code, format!("{unknown} `{name}`"));
        vec![error.suggest(name, C::names())]
    });
    found.map(Some)
}

fn entry(shader: &CompiledShader, wanted: &[Target]) -> EntryPoint {
    let unit = &shader.made.unit;
    let output = |target: &Target| {
        let (known, artifact) = (targets::find(*target)?, unit.targets.get(target.name())?);
        let text = || String::from_utf8_lossy(&artifact.bytes).into_owned();
        Some(Output {
            target: target.name().to_owned(),
            text: (!known.binary).then(text),
            bytes: artifact.bytes.to_vec(),
            native: Native::clone(&artifact.native),
        })
    };
    EntryPoint {
        name: shader.entry.clone(),
        stage: unit.reflection.stage.name().to_owned(),
        reflection: Reflection::clone(&unit.reflection),
        outputs: wanted.iter().filter_map(output).collect(),
    }
}

/// A whole package, as for `lamplight lint`.
#[derive(Deserialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct LintRequest {
    #[tsify(type = "Record<string, string>")]
    pub files: Files,
}

/// What is wrong with a package.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct LintResult {
    pub diagnostics: Vec<Diagnostic>,
}

/// Everything that is wrong with a package, reached or not.
#[wasm_bindgen(js_name = lint)]
pub fn lint_package(request: Ts<LintRequest>) -> Answer<LintResult> {
    let files = request.to_rust()?.files;
    let mut sources = SourceSet::default();
    let found = linted(&files, &mut sources).unwrap_or_else(|problems| problems);
    answer(&LintResult { diagnostics: diagnostics(&sources, &found) })
}

fn linted(files: &Files, sources: &mut SourceSet) -> Result<Diagnostics, Diagnostics> {
    let manifest = manifest(Some(files), sources)?;
    let packages = packages(Some(files));
    let mut settings = Settings::default();
    manifest.get().iter().for_each(|manifest| manifest.features.complete(&mut settings));
    let paths: Vec<String> =
        files.keys().filter(|path| lint::language(path).is_some()).cloned().collect();
    let request = lint::Request {
        packages: &packages,
        manifest: manifest.get(),
        settings: &settings,
        paths: &paths,
    };
    Ok(lint::lint(sources, &request).diagnostics)
}
