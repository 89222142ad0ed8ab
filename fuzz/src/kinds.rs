//! The functions that hostile input is given to. Each takes any bytes and answers with text. It must
//! not panic, not take long, and give the same answer to the same bytes.
//!
//! `cargo xtask fuzz`, the tests of `tests/regressions/` and the targets of cargo-fuzz share this
//! module.

#[path = "seal.rs"]
pub mod seal;
#[path = "stores.rs"]
mod stores;

use std::sync::OnceLock;

use lamplight::LIBRARY_FILES;
use lamplight::bundle::{Bundle, Language, Target};
use lamplight::compose::{self, Keep, Options};
use lamplight::diagnostic::Diagnostics;
use lamplight::diagnostic::render::{Form, render};
use lamplight::glsl::tree::Stage;
use lamplight::link::{self, Linker};
use lamplight::permute::{Manifest, Quoted, Setting, Settings, Space, cover, key, lock, manifest};
use lamplight::project;
use lamplight::resolve::{self, Packages};
use lamplight::source::{Memory, Package, SourceSet};
use lamplight::validate::validate;

/// A part of the crate that reads input that others wrote.
pub struct Kind {
    /// The name of the kind, and of its folder in `tests/regressions/`.
    pub name: &'static str,
    /// Folders with valid inputs, and how the names of their files end.
    pub corpus: &'static [(&'static str, &'static str)],
    /// Words that have a meaning in inputs of this kind. Mutations insert them.
    pub words: &'static str,
    /// The answer to an input.
    pub run: fn(&[u8]) -> String,
}

/// Every kind.
pub const KINDS: &[Kind] = &[
    Kind {
        name: "wesl",
        corpus: &[
            ("crates/compose/tests/compose_wesl", ".wesl"),
            ("tests/emit", ".wgsl"),
            ("shaderlib", ".wesl"),
        ],
        words: WESL,
        run: wesl,
    },
    Kind {
        name: "glsl",
        corpus: &[("crates/compose/tests/compose_glsl", ".glsl"), ("shaderlib", ".glsl")],
        words: GLSL,
        run: glsl,
    },
    Kind {
        name: "translate",
        corpus: &[("crates/glsl/tests/translated", ""), ("tests/opengl_scene", "s")],
        words: TRANSLATED,
        run: translate,
    },
    Kind {
        name: "manifest",
        corpus: &[("crates/permute/tests/permute", ".toml"), ("shaderlib", "lamplight.toml")],
        words: MANIFEST,
        run: manifest,
    },
    Kind { name: "key", corpus: &[("tests/regressions/key", "")], words: KEY, run: key },
    Kind { name: "lock", corpus: &[("tests/regressions/lock", "")], words: LOCK, run: lock },
    Kind { name: "bundle", corpus: &[("tests/regressions/bundle", "")], words: "", run: bundle },
    Kind {
        name: "sealed",
        corpus: &[("tests/regressions/bundle", "")],
        words: "{ } [ ] , : 0 1 4294967295 \u{0}",
        run: stores::sealed,
    },
    Kind {
        name: "record",
        corpus: &[("tests/regressions/record", "")],
        words: RECORD,
        run: stores::record,
    },
    Kind {
        name: "compile",
        corpus: &[("tests/emit", ".wgsl"), ("examples", ".wesl")],
        words: WESL,
        run: compile,
    },
];

const WESL: &str = "@if( @elif( @else import package super self as :: { } ( ) [ ] < > ; , . = == != && || ! - -> \
    const override var<private> let fn struct alias const_assert loop continuing switch case default for while if else \
    return break discard enable requires diagnostic f16 f32 vec3<f32> array< ptr<function, _ @fragment @vertex @compute \
    @workgroup_size( @location(0) @group(0) @binding(0) @builtin(position) @id(1) lamplight::math::safe::safe_normalize \
    constants::max_lights // /* */ true false 0 1 1.0 0x1p-3 4294967296 1e999 \u{feff} \u{0} \u{1f4a1} é \r\n";
const GLSL: &str = "#if #ifdef #ifndef #elif #else #endif #define #undef #include #pragma #version #extension #line #error \
    defined ( ) [ ] { } < > ; , . = == != && || ! ## # \\\n \" ' // /* */ 450 330 300 es once void main float vec3 mat4 \
    uniform layout(location=0) in out struct const if else for while do switch case return discard __LINE__ __VERSION__ \
    GL_GOOGLE_include_directive <lamplight/math/safe.glsl> \"main.frag.glsl\" TWO_SIDED SHADOW SHADOW_NONE MAX_LIGHTS 0 1 \
    1.0 0x80000000 99999999999999999999 -1 << >> / % ? : \u{feff} \u{0} é \r\n";
const TRANSLATED: &str = "void main float int uint bool double vec2 vec3 vec4 ivec2 uvec4 bvec3 mat3 mat2x4 sampler2D \
    samplerCubeShadow image2D texture2D struct in out inout const uniform buffer shared varying attribute flat centroid \
    layout( location binding set = std140 row_major push_constant local_size_x constant_id offset ) precision highp precise \
    if else for while do switch case default : break continue return discard ( ) [ ] { } < > ; , . = += <<= == != && || ^^ ! \
    ~ ++ -- ? % & | ^ << >> - + * / 0 1 2u 0x80000000 99999999999999999999 1.0 .5 1e999 1.f 0.5lf gl_Position gl_FragCoord \
    gl_PerVertex texture textureLod texelFetch atomicAdd barrier mix mod inverse isnan .length() .xyzw .rgba \n #version 330 \
    #extension // /* */ \u{feff} \u{0} é \r\n";
const MANIFEST: &str = "[program.a] [program.a.axis.b] [[program.a.constraint]] wesl glsl targets axis values default mode \
    require doc only exclude include = [ ] { } , . \" ' \"\"\" true false 0 1 -1 9223372036854775807 \"spec\" \"static\" \
    \"dynamic\" \"*\" == != => && || ! ( ) in >= < none vertex fragment # \n \\u00e9 \\ \u{feff} \u{0}";
const KEY: &str = "shadow=pcf_3x3 , = two_sided max_lights=4 lights=none none true false * ; ! é \u{0} 99999999999999999999 -0";
const LOCK: &str = "forward shadow max_lights two_sided + # \n none hard true false 0 1 4 10 -1 99999999999999999999 é \u{0}";

const RECORD: &str = "{ } [ ] : , \" is_warning code message labels notes has_warnings reflection \
    targets bytes extension native true false null 0 1 -1 4294967295 \u{1b} \u{0}";

/// The files of an input. The input begins with the root file; a line `%% PATH` begins the next file.
fn files(root: &str, text: &str) -> Memory {
    let mut files = Memory::default();
    let mut path = root;
    for line in text.split_inclusive('\n') {
        match line.strip_prefix("%% ") {
            Some(next) => path = next.trim(),
            None => files.0.entry(path.to_owned()).or_default().push_str(line),
        }
    }
    files.0.entry(root.to_owned()).or_default();
    files
}

fn wesl(bytes: &[u8]) -> String {
    composed(bytes, "main.wesl", Language::Wesl)
}

fn glsl(bytes: &[u8]) -> String {
    composed(bytes, "main.frag.glsl", Language::Glsl)
}

/// Translates a preprocessed text. What it mentions says for which stage it is.
fn translate(bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(bytes);
    let stage = match &*text {
        text if text.contains("gl_Position") => Stage::Vertex,
        text if text.contains("local_size") => Stage::Compute,
        _ => Stage::Fragment,
    };
    let mut sources = SourceSet::default();
    let id = sources.add("main", &*text);
    match lamplight::glsl::translate(&text, stage, id, Default::default()) {
        Ok(written) => written.text,
        Err(problems) => render_all(&sources, &problems),
    }
}

/// Composes and validates a text, with its entry points only and with everything in it.
fn composed(bytes: &[u8], root: &str, language: Language) -> String {
    let text = String::from_utf8_lossy(bytes);
    let own = Package { name: "package".to_owned(), files: Box::new(files(root, &text)) };
    let library = Package { name: project::LIBRARY.to_owned(), files: Box::new(LIBRARY_FILES) };
    let packages = Packages::new(own, vec![library]);
    let mut sources = SourceSet::default();
    let graph = match resolve::load(&mut sources, &packages, root, language) {
        Ok(graph) => graph,
        Err(problems) => return render_all(&sources, &problems),
    };
    let settings = settings(&text);
    let mut answer = String::new();
    for keep in [Keep::EntryPoints, Keep::All] {
        let options = Options { keep, ..Options::default() };
        let composed = compose::compose(&graph, &settings, &options);
        answer += &match composed.and_then(|composed| validate(&composed).map(|_| composed)) {
            Ok(composed) => composed.text + &render_all(&sources, &composed.warnings),
            Err(problems) => render_all(&sources, &problems),
        };
    }
    answer
}

/// Compiles the first two entry points to every target, as for a bundle.
fn compile(bytes: &[u8]) -> String {
    let text = String::from_utf8_lossy(bytes);
    let own = Package { name: "package".to_owned(), files: Box::new(files("main.wesl", &text)) };
    let library = Package { name: project::LIBRARY.to_owned(), files: Box::new(LIBRARY_FILES) };
    let packages = Packages::new(own, vec![library]);
    let mut sources = SourceSet::default();
    let graph = match resolve::load(&mut sources, &packages, "main.wesl", Language::Wesl) {
        Ok(graph) => graph,
        Err(problems) => return render_all(&sources, &problems),
    };
    let settings = settings(&text);
    let whole = compose::compose(&graph, &settings, &Options::default());
    let whole = match whole.and_then(|composed| validate(&composed)) {
        Ok(validated) => validated,
        Err(problems) => return render_all(&sources, &problems),
    };
    let mut answer = String::new();
    for point in whole.module.entry_points.iter().take(2) {
        let keep = Keep::Items(vec![point.name.clone()]);
        let composed = compose::compose(&graph, &settings, &Options { keep, ..Options::default() });
        let made = composed.and_then(|composed| {
            let lean = compose::lean(&composed);
            let text = link::TextForms { composed: &composed, lean: &lean };
            link::compile(&text, &point.name, Target::ALL, &Linker::new(Target::ALL))
        });
        answer += &match made {
            Ok(made) => format!("{:?}", made.unit.hash()) + &render_all(&sources, &made.warnings),
            Err(problems) => render_all(&sources, &problems),
        };
    }
    assert!(!answer.contains("[naga-internal]"), "an internal error of naga: {answer}");
    answer
}

/// Values for the axes of `forward`, and for the names in the conditions of the text. What a name is
/// set to depends on its length.
fn settings(text: &str) -> Settings {
    let mut settings =
        forward().map(|space| space.settings(&space.default_assignment())).unwrap_or_default();
    let word = |c: char| !(c.is_alphanumeric() || c == '_');
    for condition in text.split("if(").skip(1).take(1000) {
        for name in condition
            .split(')')
            .next()
            .unwrap_or_default()
            .split(word)
            .filter(|name| !name.is_empty())
        {
            settings.values.entry(name.to_owned()).or_insert(Setting::Bool(name.len() % 2 == 0));
        }
    }
    settings
}

/// Reads a manifest and describes the permutations of its programs.
fn manifest(bytes: &[u8]) -> String {
    let mut sources = SourceSet::default();
    let id = sources.add("lamplight.toml", String::from_utf8_lossy(bytes).into_owned());
    match manifest::parse(&sources, id) {
        Err(problems) => render_all(&sources, &problems),
        Ok(Manifest { programs, warnings, .. }) => {
            let spaces = programs
                .iter()
                .map(|program| format!("{}: {}\n", program.name, space(&program.space)));
            spaces.collect::<String>() + &render_all(&sources, &warnings)
        }
    }
}

/// The counts of a program's permutations. A program of at most 2,000 is also enumerated.
fn space(space: &Space) -> String {
    let counts = format!("{} {} {}", space.full_count(), space.valid_count(), space.count());
    if space.count() > 2_000 {
        return counts;
    }
    let points = space.enumerate();
    let keys: Vec<String> = points.iter().map(|point| space.key(point).to_string()).collect();
    format!("{counts} {} {}", keys.join(";"), cover::pairwise(space).points.len())
}

/// The permutations of `forward`, the largest program of the library. They are read once.
fn forward() -> Option<&'static Space> {
    static SPACE: OnceLock<Option<Space>> = OnceLock::new();
    let read = || {
        let (_, manifest) = project::library_manifest().ok()?;
        Some(manifest.programs.into_iter().find(|program| program.name == "forward")?.space)
    };
    SPACE.get_or_init(read).as_ref()
}

/// Reads a key of `forward` as the compiler does, and as the loader of bundles does.
fn key(bytes: &[u8]) -> String {
    let Some(space) = forward() else { return String::new() };
    let mut sources = SourceSet::default();
    let id = sources.add("key", String::from_utf8_lossy(bytes).into_owned());
    let text = match key::parse(space, &Quoted::whole(&sources, id)) {
        Ok(point) => space.key(&point).to_string(),
        Err(problems) => render_all(&sources, &problems),
    };
    let axes: Vec<lamplight::bundle::Axis> = space.axes().iter().map(shipped).collect();
    format!("{text}\n{:?}", lamplight::bundle::canonical(&axes, &sources.get(id).text))
}

/// An axis as a bundle describes it.
fn shipped(axis: &lamplight::permute::Axis) -> lamplight::bundle::Axis {
    let values = axis.value_names();
    let default = values.get(axis.default).cloned().unwrap_or_default();
    lamplight::bundle::Axis {
        name: axis.name.clone(),
        values,
        default,
        mode: axis.mode.name().to_owned(),
    }
}

/// Reads a lock file, extends it for `forward`, and turns some numbers into permutations.
fn lock(bytes: &[u8]) -> String {
    let Some(space) = forward() else { return String::new() };
    let mut sources = SourceSet::default();
    let id = sources.add("lock", String::from_utf8_lossy(bytes).into_owned());
    let lock = match lock::parse(&sources, id) {
        Ok(lock) => lock.extended("forward", space),
        Err(problems) => return render_all(&sources, &problems),
    };
    let dense = lock.dense("forward", space, &space.default_assignment());
    let points: Vec<_> = [0, 1, 7, u128::MAX]
        .into_iter()
        .chain(dense)
        .map(|dense| lock.point("forward", space, dense))
        .collect();
    format!("{lock}{dense:?} {points:?}")
}

/// Opens a single-file bundle, verifies it, and reads shaders from it.
fn bundle(bytes: &[u8]) -> String {
    let bundle = match Bundle::from_bytes(bytes.to_vec()) {
        Ok(bundle) => bundle,
        Err(error) => return error.to_string(),
    };
    let mut answer = format!("{:?}\n", bundle.verify());
    for name in bundle.programs() {
        let Ok(program) = bundle.program(name) else { continue };
        for (language, entry) in program.entries() {
            let Ok(shader) = program.entry(language, entry) else { continue };
            for key in shader
                .keys()
                .unwrap_or_default()
                .iter()
                .take(20)
                .map(String::as_str)
                .chain(["no=such", ""])
            {
                let bytes = shader.get(key, Target::SPIRV).map(|found| found.bytes.len());
                answer += &format!("{name} {entry} {key} {bytes:?} {:?}\n", shader.targets(key));
            }
        }
    }
    answer + &format!("{:?}", bundle.contents().map(|contents| contents.programs.len()))
}

/// The diagnostics in every form, since each form reads the spans in its own way.
fn render_all(sources: &SourceSet, problems: &Diagnostics) -> String {
    [Form::Human, Form::Short, Form::Json].map(|form| render(sources, problems, form)).concat()
}
