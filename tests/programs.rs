//! Every program of the library, in every permutation that ships and in a set that covers all pairs
//! of values. Each is valid as a whole, has the same interface in both languages, and differs from
//! all others. Those of the set are written for every target as a whole, and external validators
//! accept these outputs; the outputs that ship are those of `library`.

mod accepted;

use std::collections::{BTreeMap, BTreeSet};

use lamplight::LIBRARY_FILES;
use lamplight::bundle::{Reflection, Target, Varying};
use lamplight::compose::{self, Composed, Keep, Options};
use lamplight::diagnostic::Diagnostics;
use lamplight::diagnostic::render::{Form, render};
use lamplight::emit::{emit, isolate, reflect};
use lamplight::permute::manifest::{self, ManifestFile, Program};
use lamplight::permute::{Assignment, ReadTree, Settings, cover};
use lamplight::resolve::{self, Packages};
use lamplight::source::{Files as _, Package, SourceSet};
use lamplight::validate::{Validated, on_large_stack, validate};
use libtest_mimic::{Failed, Trial};
use rayon::prelude::*;

use accepted::{glslc_takes_sources, validators};

/// How many failures of a test are printed.
const SHOWN: usize = 3;

/// The stages: name, entry point in WESL, and name for glslangValidator and glslc.
const STAGES: [(&str, &str, &str); 2] =
    [("vertex", "vs_main", "vert"), ("fragment", "fs_main", "frag")];

pub fn tests() -> Vec<Trial> {
    let Ok(programs) = programs() else {
        return vec![Trial::test("programs::manifest", || programs().map(|_| ()))];
    };
    let mut tests = Vec::new();
    for program in programs {
        for stage in STAGES.iter().filter(|(stage, ..)| has(&program, stage)) {
            let (name, shipped, covered) = (
                format!("programs::{}::{}", program.name, stage.0),
                program.clone(),
                program.clone(),
            );
            tests.push(Trial::test(format!("{name}::shipped"), move || {
                every(&shipped, stage, &shipped.space.enumerate(), &[])
            }));
            tests.push(Trial::test(format!("{name}::pairs"), move || {
                let points = cover::pairwise(&covered.space).points;
                every(&covered, stage, &points, &covered.targets)
            }));
            let (sampled, whole) = (program.clone(), program.clone());
            tests.push(Trial::test(format!("{name}::glslc"), move || {
                glslc_takes_sources(&whole, stage)
            }));
            tests.push(Trial::test(format!("{name}::validators"), move || {
                validators(&sampled, stage)
            }));
        }
        tests.push(Trial::test(format!("programs::{}::distinct", program.name), move || {
            distinct(&program)
        }));
    }
    tests
}

fn programs() -> Result<Vec<Program>, Failed> {
    let mut sources = SourceSet::default();
    let text = LIBRARY_FILES.read("lamplight.toml").ok().flatten().ok_or("no manifest")?;
    let id = sources.add("lamplight.toml", text);
    Ok(manifest::parse(&sources, id)
        .map_err(|problems| render(&sources, &problems, Form::Human))?
        .programs)
}

fn has(program: &Program, stage: &str) -> bool {
    glsl_file(program, stage).is_some()
}

fn glsl_file<'a>(program: &'a Program, stage: &str) -> Option<&'a ManifestFile> {
    let glsl = program.glsl.as_ref()?;
    if stage == "vertex" { glsl.vertex.as_ref() } else { glsl.fragment.as_ref() }
}

/// The loaded sources of one stage of a program, in both languages.
struct Sources {
    texts: SourceSet,
    wesl: resolve::wesl::Graph,
    glsl: resolve::glsl::Graph,
    entry: &'static str,
}

impl Sources {
    fn new(
        program: &Program,
        (stage, entry, _): &(&'static str, &'static str, &'static str),
    ) -> Result<Self, Failed> {
        let root = Package { name: "lamplight".to_owned(), files: Box::new(LIBRARY_FILES) };
        let packages = Packages::new(root, Vec::new());
        let mut texts = SourceSet::default();
        let root = &program.wesl.as_ref().ok_or("no WESL")?.path;
        let wesl = resolve::wesl::load(&mut texts, &packages, root);
        let wesl = wesl.map_err(|problems| render(&texts, &problems, Form::Human))?;
        let root = &glsl_file(program, stage).ok_or("no GLSL")?.path;
        let glsl = resolve::glsl::load(&mut texts, &packages, root);
        let glsl = glsl.map_err(|problems| render(&texts, &problems, Form::Human))?;
        Ok(Self { texts, wesl, glsl, entry })
    }

    /// For each language, the name of the entry point and the composer.
    fn languages(&self) -> [(&'static str, Box<Composer<'_>>); 2] {
        let options =
            Options { keep: Keep::Items(vec![self.entry.to_owned()]), ..Options::default() };
        [
            (
                self.entry,
                Box::new(move |settings| compose::wesl::compose(&self.wesl, settings, &options)),
            ),
            (
                "main",
                Box::new(|settings| {
                    compose::glsl::compose(&self.glsl, settings, &Options::default())
                }),
            ),
        ]
    }
}

type Composer<'a> = dyn Fn(&Settings) -> Result<Composed, Diagnostics> + 'a;

/// The distinct composed texts of some points.
struct Texts {
    /// The texts, each with the first point that has it.
    composed: Vec<(Composed, Assignment)>,
    /// For each point, the index of its text.
    of: Vec<usize>,
}

fn texts(
    program: &Program,
    sources: &SourceSet,
    points: &[Assignment],
    compose: &Composer<'_>,
) -> Result<Texts, Failed> {
    let (mut known, mut tree, mut found) =
        (BTreeMap::new(), ReadTree::default(), Texts { composed: Vec::new(), of: Vec::new() });
    for point in points {
        let settings = program.space.settings(point);
        if let Some(&index) = tree.get(&settings) {
            found.of.push(index);
            continue;
        }
        let composed = compose(&settings).map_err(|problems| {
            format!("{}\n{}", program.space.key(point), render(sources, &problems, Form::Human))
        })?;
        let next = found.composed.len();
        let index = *known.entry(composed.text.clone()).or_insert(next);
        tree.insert(&composed.reads, index)
            .map_err(|_| "the composer's reads contradict each other")?;
        found.of.push(index);
        if index == next {
            found.composed.push((composed, point.clone()));
        }
    }
    Ok(found)
}

/// Composes and validates every point in both languages, writes it for the targets, and compares the
/// interfaces.
fn every(
    program: &Program,
    stage: &(&'static str, &'static str, &'static str),
    points: &[Assignment],
    targets: &[Target],
) -> Result<(), Failed> {
    let sources = Sources::new(program, stage)?;
    let mut interfaces = Vec::new();
    for (entry, compose) in sources.languages() {
        let texts = texts(program, &sources.texts, points, &*compose)?;
        let write = |(composed, _): &(Composed, Assignment)| {
            written(targets, &sources.texts, composed, entry)
        };
        let results: Vec<Result<Reflection, String>> =
            on_large_stack(|| texts.composed.par_iter().map(write).collect());
        let failures = results
            .iter()
            .zip(&texts.composed)
            .filter_map(|(result, (_, point))| Some((point, result.as_ref().err()?)));
        report(program, failures.map(|(point, error)| (point, error.clone())).collect())?;
        let interface = |index: &usize| results[*index].as_ref().ok().cloned();
        interfaces.push(texts.of.iter().map(interface).collect::<Vec<_>>());
    }
    let differences = (0..points.len()).filter_map(|index| {
        Some((&points[index], difference(&interfaces[0][index], &interfaces[1][index])?))
    });
    report(program, differences.collect())
}

fn report(program: &Program, failures: Vec<(&Assignment, String)>) -> Result<(), Failed> {
    if failures.is_empty() {
        return Ok(());
    }
    let shown = failures
        .iter()
        .take(SHOWN)
        .map(|(point, what)| format!("[{}]\n{what}\n", program.space.key(point)));
    let shown = shown.collect::<String>();
    Err(format!("{}: {} failures, the first are\n{shown}", program.name, failures.len()).into())
}

fn written(
    targets: &[Target],
    sources: &SourceSet,
    composed: &Composed,
    entry: &str,
) -> Result<Reflection, String> {
    let explain = |problems: Diagnostics| render(sources, &problems, Form::Human);
    let alone = alone(composed, entry).map_err(explain)?;
    for target in targets {
        emit(&alone, entry, *target).map_err(|problem| explain(vec![problem]))?;
    }
    reflect(&alone, entry).map_err(|problem| explain(vec![problem]))
}

fn alone(composed: &Composed, entry: &str) -> Result<Validated, Diagnostics> {
    isolate(&validate(composed)?, entry)
}

/// The first difference between the interfaces of the two languages, which would keep an engine from
/// using either. In GLSL the inputs may be fewer, since it declares only those that are used.
fn difference(wesl: &Option<Reflection>, glsl: &Option<Reflection>) -> Option<String> {
    let (wesl, glsl) = (wesl.as_ref()?, glsl.as_ref()?);
    let lacks = |whole: &[Varying], part: &[Varying]| {
        places(part).difference(&places(whole)).next().cloned()
    };
    if wesl.bindings != glsl.bindings {
        return Some(format!("bindings\n{:#?}\n{:#?}", wesl.bindings, glsl.bindings));
    }
    if wesl.pairs != glsl.pairs {
        return Some(format!("pairs\n{:?}\n{:?}", wesl.pairs, glsl.pairs));
    }
    let outputs =
        lacks(&wesl.outputs, &glsl.outputs).or_else(|| lacks(&glsl.outputs, &wesl.outputs));
    outputs
        .or_else(|| lacks(&wesl.inputs, &glsl.inputs))
        .map(|place| format!("only one language has {place}"))
}

fn places(varyings: &[Varying]) -> BTreeSet<String> {
    varyings
        .iter()
        .map(|found| {
            format!(
                "{:?} {:?} {} {:?}",
                found.location, found.builtin, found.ty, found.interpolation
            )
        })
        .collect()
}

/// No two permutations of a program have the same texts in all stages. Otherwise an axis or a value
/// would have no effect there, and the permutation should not ship.
fn distinct(program: &Program) -> Result<(), Failed> {
    let points = program.space.enumerate();
    let mut alike: [BTreeMap<Vec<usize>, Vec<&Assignment>>; 2] = Default::default();
    let mut stages: [Vec<Vec<usize>>; 2] =
        [vec![Vec::new(); points.len()], vec![Vec::new(); points.len()]];
    for stage in STAGES.iter().filter(|(stage, ..)| has(program, stage)) {
        let sources = Sources::new(program, stage)?;
        for (language, (_, compose)) in sources.languages().into_iter().enumerate() {
            let texts = texts(program, &sources.texts, &points, &*compose)?;
            stages[language]
                .iter_mut()
                .zip(texts.of)
                .for_each(|(stages, index)| stages.push(index));
        }
    }
    for (language, stages) in stages.into_iter().enumerate() {
        stages
            .into_iter()
            .zip(&points)
            .for_each(|(stages, point)| alike[language].entry(stages).or_default().push(point));
    }
    let twins = alike.iter().flat_map(|alike| alike.values()).filter(|points| points.len() > 1);
    report(
        program,
        twins
            .map(|points| (points[0], format!("is the same as [{}]", program.space.key(points[1]))))
            .collect(),
    )
}
