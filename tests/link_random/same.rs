//! Finds out whether the outputs of a program depend on anything else than its sources, its
//! settings and the target, and whether the crate accepts its own WGSL.

use std::collections::BTreeMap;

use lamplight::bundle::{Artifact, Language, Reflection, Target, Unit};
use lamplight::compose::{Composed, Keep, Options, compose, lean};
use lamplight::diagnostic::Diagnostics;
use lamplight::diagnostic::render::{Form, render};
use lamplight::generate::{Generated, Request, Shard, in_memory};
use lamplight::link::{Linker, Reason, TextForms, compile};
use lamplight::permute::{Manifest, Quoted, manifest};
use lamplight::resolve::{self, Packages};
use lamplight::source::{Memory, Package, SourceSet};
use lamplight::validate::validate;
use lamplight::validators::agreement::output_differences;

use super::program::Program;
use super::run::Runnable;
use crate::random::Random;

/// A mistake that was found: its kind, and the details.
#[derive(Debug, Clone)]
pub struct Finding {
    pub kind: String,
    pub about: String,
}

impl Finding {
    pub fn new(kind: impl Into<String>, about: impl Into<String>) -> Self {
        Self { kind: kind.into(), about: about.into() }
    }
}

/// One output.
#[derive(Debug, Clone)]
pub struct Output {
    pub target: Target,
    pub artifact: Artifact,
    pub reflection: Reflection,
}

/// The outputs of a program in which no mistake was found.
#[derive(Debug, Default)]
pub struct Sound {
    /// The distinct outputs.
    pub outputs: Vec<Output>,
    /// The targets that were compiled as a whole, with the reason.
    pub whole: Vec<(String, Reason)>,
    /// A stage of each kind, each of one of the permutations.
    pub runnables: Vec<Runnable>,
    /// Whether there is a vertex stage whose position is random.
    pub is_elsewhere: bool,
}

/// The verdict on a program.
pub enum Verdict {
    /// The crate refuses the program, with these errors.
    Refused(String),
    Sound(Sound),
}

/// A program as the crate reads it.
struct Case {
    sources: SourceSet,
    packages: Packages,
    manifest: Manifest,
}

/// Units by entry point and key.
type Units = BTreeMap<(String, String), Unit>;

/// Makes the outputs of a program in several ways and compares them: all permutations together,
/// then one alone, or a shard, or fewer targets, and then all in a random order.
///
/// # Errors
/// The first finding.
pub fn compare_outputs(program: &Program, random: &mut Random) -> Result<Verdict, Finding> {
    let mut case = Case::new(program)?;
    let together = match case.made(&Request::default()) {
        Ok(made) => made,
        Err(problems) => return Ok(Verdict::Refused(problems)),
    };
    let all = units(&together);
    let keys: Vec<String> = all.keys().map(|(_, key)| key.clone()).collect();
    let (how, request) = match random.below(3) {
        0 => {
            let key = keys.get(random.below(keys.len().max(1))).cloned().unwrap_or_default();
            ("alone", case.only(&key))
        }
        1 => {
            let count = 2 + random.below(2);
            let shard = Shard::new(1 + random.below(count), count);
            ("shard", Request { shard, ..Request::default() })
        }
        _ => {
            let mut targets = program.targets.clone();
            random.shuffle(&mut targets);
            targets.truncate(1 + random.below(3));
            ("targets", Request { targets, ..Request::default() })
        }
    };
    case.alike(how, &all, &request)?;
    let mut sound = case.in_random_order(program, &all, random)?;
    sound.whole = together.summary.whole.into_iter().map(|one| (one.target, one.reason)).collect();
    Ok(Verdict::Sound(sound))
}

impl Case {
    fn new(program: &Program) -> Result<Self, Finding> {
        let mut sources = SourceSet::default();
        let id = sources.add("lamplight.toml", program.manifest.clone());
        let manifest = manifest::parse(&sources, id).map_err(|problems| {
            Finding::new("manifest", render(&sources, &problems, Form::Human))
        })?;
        let files = Memory(BTreeMap::from([(program.file.to_owned(), program.text.clone())]));
        let root = Package { name: "package".to_owned(), files: Box::new(files) };
        let packages = Packages::new(root, Vec::new());
        Ok(Self { sources, packages, manifest })
    }

    fn made(&mut self, request: &Request) -> Result<Generated, String> {
        let made = in_memory(&mut self.sources, &self.packages, &self.manifest, request, &|_| ());
        made.map_err(|problems| self.rendered(&problems))
    }

    fn rendered(&self, problems: &Diagnostics) -> String {
        render(&self.sources, problems, Form::Short)
    }

    fn only(&mut self, key: &str) -> Request {
        let id = self.sources.add("key", key);
        let only = Some(Quoted::whole(&self.sources, id));
        Request { only, ..Request::default() }
    }

    /// Fails unless a run over a part gives the outputs that the whole run gave.
    fn alike(&mut self, how: &str, all: &Units, request: &Request) -> Result<(), Finding> {
        let made = self.made(request);
        let made = made.map_err(|problems| {
            Finding::new(format!("{how}: refused"), format!("{request:?}\n{problems}"))
        })?;
        for (place, unit) in units(&made) {
            let known = all.get(&place).ok_or_else(|| {
                Finding::new(format!("{how}: more"), format!("{place:?} is only there"))
            })?;
            same(&unit, known).map_err(|what| {
                Finding::new(format!("{how}: {}", what.0), format!("{place:?}\n{}", what.1))
            })?;
        }
        Ok(())
    }

    /// Fails unless one linker that is given all texts in a random order gives the same outputs.
    fn in_random_order(
        &mut self,
        source: &Program,
        all: &Units,
        random: &mut Random,
    ) -> Result<Sound, Finding> {
        let language = source.language;
        let program = self.manifest.programs.first();
        let program = program.ok_or_else(|| Finding::new("manifest", "no program"))?;
        let glsl = program.glsl.iter().flat_map(|glsl| [&glsl.vertex, &glsl.fragment]).flatten();
        let root = program.wesl.iter().chain(glsl).next();
        let path = root.ok_or_else(|| Finding::new("manifest", "no file"))?.path.clone();
        let graph = resolve::load(&mut self.sources, &self.packages, &path, language);
        let graph = graph.map_err(|problems| Finding::new("load", self.rendered(&problems)))?;
        let mut places: Vec<(usize, String)> = Vec::new();
        let points = program.space.enumerate();
        for (index, point) in points.iter().enumerate() {
            let key = program.space.key(point).to_string();
            let own = all.keys().filter(|(_, other)| *other == key);
            places.extend(own.map(|(entry, _)| (index, entry.clone())));
        }
        random.shuffle(&mut places);
        let linker = Linker::with(&source.targets, program.conventions);
        let (mut sound, mut seen) = (Sound::default(), BTreeMap::new());
        for (index, entry) in places {
            let point = &points[index];
            let name = if language == Language::Glsl { "main" } else { &entry };
            let settings = program.space.settings(point);
            let composed = compose(&graph, &settings, &keeping(language, name));
            let composed =
                composed.map_err(|problems| Finding::new("compose", self.rendered(&problems)))?;
            let lean = lean(&composed);
            let text = TextForms { composed: &composed, lean: &lean };
            let made = compile(&text, name, &source.targets, &linker)
                .map_err(|problems| Finding::new("order: refused", self.rendered(&problems)))?;
            let known = &all[&(entry.clone(), program.space.key(point).to_string())];
            same(&made.unit, known).map_err(|(kind, about)| {
                Finding::new(format!("order: {kind}"), format!("{entry} {index}\n{about}"))
            })?;
            sound.keep(&made.unit, &mut seen);
            let entry = name.to_owned();
            sound.keep_runnable(
                source,
                Runnable { seed: source.seed, composed, entry, unit: made.unit },
            );
        }
        sound.outputs.iter().try_for_each(read_again)?;
        Ok(sound)
    }
}

/// Options with which a composed text has one entry point.
fn keeping(language: Language, entry: &str) -> Options {
    let keep = match language {
        Language::Glsl => Keep::EntryPoints,
        Language::Wesl => Keep::Items(vec![entry.to_owned()]),
    };
    Options { keep, ..Options::default() }
}

impl Sound {
    /// Keeps the first stage of each kind that can be run.
    fn keep_runnable(&mut self, source: &Program, runnable: Runnable) {
        let is_fragment = runnable.is_fragment();
        if !is_fragment && !source.places_corners {
            self.is_elsewhere = true;
        } else if self.runnables.iter().all(|known| known.is_fragment() != is_fragment) {
            self.runnables.push(runnable);
        }
    }

    fn keep(&mut self, unit: &Unit, seen: &mut BTreeMap<(String, Vec<u8>), ()>) {
        for (name, artifact) in &unit.targets {
            let place = (name.clone(), artifact.bytes.to_vec());
            let target = Target::ALL.iter().copied().find(|target| target.name() == name);
            if let (Some(target), None) = (target, seen.insert(place, ())) {
                let (artifact, reflection) = (artifact.clone(), (*unit.reflection).clone());
                self.outputs.push(Output { target, artifact, reflection });
            }
        }
    }
}

/// Fails unless the crate accepts its own WGSL, and each output has what its reflection says.
fn read_again(output: &Output) -> Result<(), Finding> {
    let Output { target, artifact, reflection } = output;
    if *target == Target::WGSL {
        let text = String::from_utf8_lossy(&artifact.bytes).into_owned();
        let composed = Composed::of_text(Language::Wesl, None, text.clone());
        validate(&composed).map_err(|problems| {
            let words: Vec<&str> = problems.iter().map(|one| one.message.as_str()).collect();
            Finding::new("wgsl: refused", format!("{}\n{text}", words.join("\n")))
        })?;
    }
    let differences = output_differences(*target, &artifact.bytes, reflection, &artifact.native);
    match differences.first() {
        None => Ok(()),
        Some(first) => {
            let plain = first.split(['`', '"']).step_by(2).flat_map(str::chars);
            let kind: String = plain.filter(|one| !one.is_ascii_digit()).take(80).collect();
            let text = String::from_utf8_lossy(&artifact.bytes);
            let about = format!("{}\n{reflection:#?}\n{text}", differences.join("\n"));
            Err(Finding::new(format!("{target} differs from its reflection: {kind}"), about))
        }
    }
}

/// Fails if two units differ, with what differs and both forms of it.
fn same(one: &Unit, other: &Unit) -> Result<(), (String, String)> {
    if one.reflection != other.reflection {
        return Err((
            "reflection".to_owned(),
            format!("{:?}\n{:?}", one.reflection, other.reflection),
        ));
    }
    for (target, artifact) in &one.targets {
        let known = &other.targets[target];
        if known.bytes != artifact.bytes {
            let text = |artifact: &Artifact| String::from_utf8_lossy(&artifact.bytes).into_owned();
            let both = format!("one:\n{}\nother:\n{}", text(artifact), text(known));
            return Err((format!("{target} differs"), both));
        }
        if known != artifact {
            let both = format!("{:?}\n{:?}", artifact.native, known.native);
            return Err((format!("names of {target} differ"), both));
        }
    }
    Ok(())
}

fn units(generated: &Generated) -> Units {
    let languages = generated.contents.programs.values().flat_map(|one| one.languages.values());
    let units = languages.flatten().flat_map(|(name, entry)| {
        let unit = |hash| entry.units[hash].clone();
        entry.keys.iter().map(move |(key, hash)| ((name.clone(), key.clone()), unit(hash)))
    });
    units.collect()
}
