//! Every module of the shader library is valid in both languages, has the same functions in both,
//! and is documented.

mod compilers;
mod documented;
mod emits;
mod twins;

use std::collections::BTreeMap;

use lamplight::LIBRARY_FILES;
use lamplight::compose::{self, Composed, Keep, Options};
use lamplight::diagnostic::Diagnostic;
use lamplight::diagnostic::render::{Form, render};
use lamplight::permute::Settings;
use lamplight::resolve::{self, Packages};
use lamplight::source::{Files as _, SourceSet};
use libtest_mimic::{Failed, Trial};
use naga::front::{glsl, wgsl};
use naga::{Module, ShaderStage};

pub use documented::undocumented;

use compilers::{DIALECTS, Dialect, in_dialect, in_every_target, with_include_path};
use documented::functions_are_documented;
use twins::{same, twins_agree};

use crate::glslang::accepts_text;

/// A check of a module. It is given the module's path without extension, such as `lighting/spot`.
type Check = fn(&str) -> Result<(), Failed>;

const CHECKS: &[(&str, Check)] = &[
    ("wesl", wesl_is_valid),
    ("glsl", glsl_is_valid),
    ("glslang_450", |module| in_dialect(module, 0)),
    ("glslang_330", |module| in_dialect(module, 1)),
    ("glslang_300_es", |module| in_dialect(module, 2)),
    ("glslang_310_es", |module| in_dialect(module, 3)),
    ("include_path", with_include_path),
    ("targets", in_every_target),
    ("twins", twins_agree),
    ("doc", functions_are_documented),
];

/// One test for each module and check, and tests for the whole library.
pub fn tests() -> Vec<Trial> {
    let mut tests = vec![
        Trial::test("shaderlib::pairs", every_module_has_its_twin),
        Trial::test("shaderlib::names", names_are_unique),
        Trial::test("shaderlib::edges", documented::silent_parameters_are_found),
        Trial::test("shaderlib::together", modules_go_together),
        Trial::test("shaderlib::compilers", compilers::see_mistakes),
        Trial::test("shaderlib::prefixed", modules_go_beside_names),
        Trial::test("shaderlib::prefixed_include_path", modules_go_beside_names_elsewhere),
    ];
    for module in modules() {
        for (name, check) in CHECKS {
            let module = module.clone();
            let title = format!("shaderlib::{}::{name}", module.replace('/', "::"));
            tests.push(Trial::test(title, move || check(&module)));
        }
    }
    tests
}

/// The paths of the modules, without extension.
pub fn modules() -> Vec<String> {
    stems("wesl")
}

fn stems(extension: &str) -> Vec<String> {
    let files = LIBRARY_FILES.list(&[extension]);
    files
        .iter()
        .filter(|path| !path.starts_with("programs/"))
        .filter_map(|path| Some(path.rsplit_once('.')?.0.to_owned()))
        .collect()
}

fn every_module_has_its_twin() -> Result<(), Failed> {
    let mut glsl = stems("glsl");
    // Only GLSL needs these two: one for its two forms of textures, one for the prefix of names.
    glsl.retain(|path| path != "filter/sampling" && path != "prefix");
    same("modules", &modules(), &glsl)
}

/// No two modules declare a function of the same name, since GLSL has no modules to keep them
/// apart.
fn names_are_unique() -> Result<(), Failed> {
    let mut owners = BTreeMap::new();
    for module in modules() {
        for function in functions(&read(&format!("{module}.wesl"))) {
            if let Some(other) = owners.insert(function.name.clone(), module.clone()) {
                let what = format!("`{other}` and `{module}` both declare `{}`", function.name);
                return Err(what.into());
            }
        }
    }
    Ok(())
}

/// GLSL that includes every module compiles. So names of structures and constants are distinct too.
fn modules_go_together() -> Result<(), Failed> {
    let all = modules().iter().map(|module| include(module)).collect::<String>();
    for dialect in &DIALECTS {
        accepts_text(&fragment(&all, dialect)?, "frag", dialect.options())?;
    }
    Ok(())
}

/// With `LAMPLIGHT_PREFIX`, all modules compile in a shader that declares a function of each of
/// their names itself.
fn modules_go_beside_names() -> Result<(), Failed> {
    let includes = modules().iter().map(|module| include(module)).collect::<String>();
    let all = format!("#define LAMPLIGHT_PREFIX\n{includes}{}", of_the_host()?);
    for dialect in &DIALECTS {
        accepts_text(&fragment(&all, dialect)?, "frag", dialect.options())?;
    }
    Ok(())
}

/// The same with glslangValidator's own includes, without our composer.
fn modules_go_beside_names_elsewhere() -> Result<(), Failed> {
    let path = concat!("-I", env!("CARGO_MANIFEST_DIR"), "/shaderlib");
    let includes: String =
        modules().iter().map(|module| format!("#include \"{module}.glsl\"\n")).collect();
    for dialect in &DIALECTS {
        let (Dialect { head, output, .. }, options) = (dialect, dialect.options());
        let text = format!(
            "{head}#extension GL_GOOGLE_include_directive : require\n#define LAMPLIGHT_PREFIX\n\
             {includes}{}{output}void main() {{\n    colour = vec4(1.0);\n}}\n",
            of_the_host()?
        );
        // glslangValidator reads includes only for Vulkan or when it links.
        let with_includes: &[&str] = if options.is_empty() { &[path, "-l"] } else { &[path] };
        accepts_text(&text, "frag", &[options, with_includes].concat())?;
    }
    Ok(())
}

/// A function for each name that the library declares, and a call of one of the library's own.
fn of_the_host() -> Result<String, Failed> {
    let items = lamplight::catalogue::library_modules(LIBRARY_FILES)
        .into_iter()
        .flat_map(|module| module.items);
    let mut names: Vec<String> = items.map(|item| item.name).collect();
    names.sort();
    if names.len() < 150 || !names.iter().any(|name| name == "wrap") {
        let what = format!("expected 150 names with `wrap` among them, found {names:?}");
        return Err(format!("the library's declarations: {what}").into());
    }
    let own = names.iter().map(|name| format!("float {name}(bool on) {{ return 1.0; }}\n"));
    let call = "float both(lamplight_Material material) {\n    return wrap(true) + material.wrap\n        \
                + lamplight_wrap(vec3(0.0), vec3(0.0), 0.5);\n}\n";
    Ok(own.collect::<String>() + call)
}

fn wesl_is_valid(module: &str) -> Result<(), Failed> {
    parse_wesl(module).map(|_| ())
}

/// naga accepts the module in GLSL 4.50. It refuses versions other than 440, 450 and 460. For other
/// versions, glslangValidator reads the modules and what naga writes.
fn glsl_is_valid(module: &str) -> Result<(), Failed> {
    parse_glsl(module).map(|_| ())
}

/// A function as it is declared in the text.
struct Function {
    name: String,
    parameters: Vec<String>,
    types: Vec<String>,
    doc: Vec<String>,
}

/// The functions of a module in either language. Parameters are found in WESL only.
fn functions(text: &str) -> Vec<Function> {
    let mut found = Vec::new();
    let mut doc = Vec::new();
    for (offset, line) in lines(text) {
        if let Some(comment) = line.strip_prefix("///") {
            doc.push(comment.trim().to_owned());
            continue;
        }
        if let Some((head, _)) = line.split_once('(').filter(|_| is_declaration(line)) {
            let name = head.rsplit(' ').next().unwrap_or(head).to_owned();
            let (parameters, types) = parameters(&text[offset..]);
            found.push(Function { name, parameters, types, doc: std::mem::take(&mut doc) });
        }
        doc.clear();
    }
    found
}

fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    text.split_inclusive('\n').scan(0, |offset, line| {
        let start = *offset;
        *offset += line.len();
        Some((start, line.trim_end()))
    })
}

fn is_declaration(line: &str) -> bool {
    line.starts_with(|first: char| first.is_ascii_alphabetic()) && line.ends_with(['{', '('])
}

/// The names and types of parameters. A comma before a name and a colon separates parameters. Any
/// other comma belongs to a type.
fn parameters(declaration: &str) -> (Vec<String>, Vec<String>) {
    let list = declaration
        .split_once('(')
        .and_then(|(_, rest)| rest.split_once(')'))
        .map_or("", |(list, _)| list);
    let mut found: Vec<(String, String)> = Vec::new();
    for part in list.split(',').map(str::trim).filter(|part| !part.is_empty()) {
        match (part.split_once(": "), found.last_mut()) {
            (Some((name, ty)), _) => found.push((name.to_owned(), ty.to_owned())),
            (None, Some((_, ty))) => *ty = format!("{ty}, {part}"),
            (None, None) => {}
        }
    }
    found.into_iter().unzip()
}

fn read(path: &str) -> String {
    LIBRARY_FILES
        .read(path)
        .expect("the embedded library is readable")
        .unwrap_or_else(|| panic!("no `{path}` in the library"))
}

/// A WESL text, composed with the library as the dependency `lamplight`, as for a user.
fn composed_wesl(text: String) -> Result<String, Failed> {
    let (mut sources, packages) = with_library("main.wesl", text);
    let composed = resolve::wesl::load(&mut sources, &packages, "main.wesl").and_then(|graph| {
        compose::wesl::compose(&graph, &Settings::default(), &Options::default())
    });
    written(&sources, composed)
}

/// A GLSL text, composed with all that it includes.
fn composed_glsl(text: String) -> Result<String, Failed> {
    let (mut sources, packages) = with_library("main.frag.glsl", text);
    let options = Options { keep: Keep::All, ..Options::default() };
    let composed = resolve::glsl::load(&mut sources, &packages, "main.frag.glsl")
        .and_then(|graph| compose::glsl::compose(&graph, &Settings::default(), &options));
    written(&sources, composed)
}

fn with_library(root: &str, text: String) -> (SourceSet, Packages) {
    let mut packages = Packages::of_text(root, text);
    packages.add(lamplight::project::library_package());
    (SourceSet::default(), packages)
}

fn written(
    sources: &SourceSet,
    composed: Result<Composed, Vec<Diagnostic>>,
) -> Result<String, Failed> {
    let shown =
        |diagnostics: &[Diagnostic]| Failed::from(render(sources, diagnostics, Form::Human));
    let composed = composed.map_err(|diagnostics| shown(&diagnostics))?;
    if composed.warnings.is_empty() { Ok(composed.text) } else { Err(shown(&composed.warnings)) }
}

/// A module, composed for an entry point that calls each of its functions.
fn called_wesl(module: &str) -> Result<String, Failed> {
    composed_wesl(entry_wesl(module))
}

/// An entry point that calls each function of a module by its path in the package `lamplight`.
pub fn entry_wesl(module: &str) -> String {
    let path = format!("lamplight::{}", module.replace('/', "::"));
    let called = |f: Function| {
        (format!("{path}::{}", f.name), f.types.iter().map(|ty| qualified(ty)).collect())
    };
    let functions: Vec<_> =
        functions(&read(&format!("{module}.wesl"))).into_iter().map(called).collect();
    emits::entry(&functions)
}

/// A type. If it is a structure of the library, its name has its module in front.
fn qualified(ty: &str) -> String {
    let declares =
        |module: &String| read(&format!("{module}.wesl")).contains(&format!("\nstruct {ty} {{"));
    match modules().into_iter().find(declares) {
        Some(module) => format!("lamplight::{}::{ty}", module.replace('/', "::")),
        None => ty.to_owned(),
    }
}

fn include(module: &str) -> String {
    format!("#include <lamplight/{module}.glsl>\n")
}

fn fragment(includes: &str, dialect: &Dialect) -> Result<String, Failed> {
    composed_glsl(format!(
        "{}{includes}{}void main() {{\n    colour = vec4(1.0);\n}}\n",
        dialect.head, dialect.output
    ))
}

fn parse_wesl(module: &str) -> Result<Module, Failed> {
    let text = called_wesl(module)?;
    validated(wgsl::parse_str(&text).map_err(|error| error.emit_to_string(&text))?)
}

fn parse_glsl(module: &str) -> Result<Module, Failed> {
    let text = fragment(&include(module), &DIALECTS[0])?;
    let parsed =
        glsl::Frontend::default().parse(&glsl::Options::from(ShaderStage::Fragment), &text);
    validated(parsed.map_err(|errors| errors.emit_to_string(&text))?)
}

fn validated(module: Module) -> Result<Module, Failed> {
    use naga::valid::{Capabilities, ValidationFlags, Validator};
    Validator::new(ValidationFlags::all(), Capabilities::empty())
        .validate(&module)
        .map_err(|error| format!("{error:?}"))?;
    Ok(module)
}
