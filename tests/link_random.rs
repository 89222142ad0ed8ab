//! Random programs. Their outputs depend on the sources, the settings and the target only, every
//! validator accepts them, and they compute what the evaluator computes.
//!
//! `seed -> program -> outputs, made in several ways and compared -> validators -> executors`
//!
//! `cargo xtask fuzz link` runs the test `link::random` with another seed and more programs.

mod body;
mod draft;
mod flow;
mod names;
mod numbers;
mod outside;
mod program;
mod run;
mod same;
pub mod shrink;
mod stages;
mod statements;
mod types;

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use crate::is_whole;
use crate::random::Random;
use lamplight::bundle::Target;
use lamplight::execute::on_thread;
use libtest_mimic::{Failed, Trial};
use program::Program;
use run::{Ran, Runnable, Runner};
use same::{Finding, Output, Verdict};

/// How many programs the tests make, and those of the night.
const PROGRAMS: [u64; 2] = [200, 400];
/// The seed of the first program.
const SEED: u64 = 1;
/// The external validators are given every 20th program.
const VALIDATED: u64 = 20;
/// The outputs of every second program are run.
const RUN: u64 = 2;
/// The number of programs whose outputs are validated together.
const BATCH: u64 = 64;
/// How many percent of the programs the crate may refuse. The generator does not know every rule.
const REFUSED: usize = 10;
/// How many programs have an unused function that naga refuses at most, in percent.
const EXCUSED: usize = 1;

pub fn tests() -> Vec<Trial> {
    vec![Trial::test("link::random", || {
        on_thread(|| random_programs().map_err(|failed| failed.message().unwrap_or("").to_owned()))
            .ok_or("panicked")?
            .map_err(Failed::from)
    })]
}

/// A number from the environment, or the usual one.
fn number(name: &str, usual: u64) -> Result<u64, Failed> {
    match std::env::var(name) {
        Ok(text) => Ok(text.parse().map_err(|_| format!("{name} is not a number"))?),
        Err(_) => Ok(usual),
    }
}

fn random_programs() -> Result<(), Failed> {
    let programs = number("LAMPLIGHT_LINK_PROGRAMS", PROGRAMS[usize::from(is_whole())])?;
    let seed = number("LAMPLIGHT_LINK_SEED", SEED)?;
    if std::env::var_os("LAMPLIGHT_LINK_PRINT").is_some() {
        let program = program(seed);
        println!("{}\n{}", program.manifest, program.text);
    }
    let every = number("LAMPLIGHT_LINK_VALIDATED", VALIDATED)?.max(1);
    let often = number("LAMPLIGHT_LINK_RUN", RUN)?;
    let mut tally = Tally::default();
    let runner = if often > 0 { Some(Runner::open()?) } else { None };
    let most = number("LAMPLIGHT_LINK_MOST", u64::MAX)?.try_into().unwrap_or(usize::MAX);
    let how = How { every, most, often, runner };
    let (mut next, started) = (seed, Instant::now());
    let mut reported = BTreeSet::new();
    while next < seed + programs {
        let end = (next + BATCH).min(seed + programs);
        batch(next..end, &how, &mut tally)?;
        next = end;
        for (kind, found) in &tally.findings {
            // A finding is written at once, so that it is kept if the run is ended.
            if reported.insert(kind.clone()) {
                report_finding(kind, found, how.runner.as_ref())?;
            }
        }
        if programs > PROGRAMS[1] {
            tally.progress(programs, started.elapsed());
        }
    }
    println!("{tally}");
    let refused: usize = tally.refused.values().sum();
    if refused * 100 > REFUSED * tally.programs {
        let what = format!("the crate refuses {refused} of {} programs", tally.programs);
        return Err(format!("{what}, at most {REFUSED} %: {:?}", tally.refused).into());
    }
    if tally.refused_whole * 100 > EXCUSED * tally.programs {
        let what = format!("{} stages of {}", tally.refused_whole, tally.programs);
        return Err(
            format!("{what} programs were not compared, at most {EXCUSED} %: {tally}").into()
        );
    }
    match tally.findings.is_empty() {
        true => Ok(()),
        false => Err(format!("{tally}").into()),
    }
}

/// How many of the programs are validated and run.
struct How {
    /// The external validators are given every `every`-th program.
    every: u64,
    /// They are given at most this many outputs of a program in each target.
    most: usize,
    /// The outputs of every `often`-th program are run; none if it is 0.
    often: u64,
    runner: Option<Runner>,
}

/// The results of all programs so far.
#[derive(Default)]
struct Tally {
    programs: usize,
    outputs: usize,
    validated: usize,
    /// How many programs were refused, for each first error.
    refused: BTreeMap<String, usize>,
    /// How many entry points have texts that were compiled as a whole, for each reason and target,
    /// with the seed of the first.
    whole: BTreeMap<String, (usize, u64)>,
    /// The stages that were run, by executor.
    ran: BTreeMap<&'static str, Ran>,
    /// How many vertex stages were not run because their positions are random.
    elsewhere: usize,
    /// How many programs were not run because naga refuses a function that nothing calls. The
    /// outputs lack this function, but the evaluator reads the whole text.
    refused_whole: usize,
    /// The findings, by kind.
    findings: BTreeMap<String, Found>,
}

/// A kind of finding.
struct Found {
    /// The seeds of all programs with a finding of this kind.
    seeds: BTreeSet<u64>,
    /// The seed of the first program with it.
    seed: u64,
    /// The finding of the first program.
    finding: Finding,
}

/// How many seeds of a kind of finding are printed.
const SEEDS: usize = 8;

impl Tally {
    fn find(&mut self, seed: u64, finding: Finding) {
        let first = || Found { seeds: BTreeSet::new(), seed, finding: finding.clone() };
        self.findings.entry(finding.kind.clone()).or_insert_with(first).seeds.insert(seed);
    }

    fn progress(&self, all: u64, since: Duration) {
        let Self { programs, findings, .. } = self;
        let found: usize = findings.values().map(|found| found.seeds.len()).sum();
        let pace = *programs as f64 / since.as_secs_f64().max(0.001);
        let kinds = findings.len();
        println!(
            "{programs} of {all} programs, {pace:.1} a second, {found} findings of {kinds} kinds"
        );
    }
}

impl std::fmt::Display for Tally {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { programs, outputs, validated, .. } = self;
        write!(f, "{programs} programs, {outputs} outputs, {validated} validated by others")?;
        let refused: usize = self.refused.values().sum();
        write!(f, "; {refused} refused; as a whole: {:?}", self.whole)?;
        self.ran.iter().try_for_each(|(name, ran)| write!(f, "\n  {name}: {ran}"))?;
        if self.elsewhere > 0 {
            write!(f, "\n  {} not run: vertex stages with random positions", self.elsewhere)?;
        }
        if self.refused_whole > 0 {
            write!(f, "\n  {} not run: naga refuses an unused function", self.refused_whole)?;
        }
        f.write_str("\n  findings:")?;
        for (kind, Found { seeds, .. }) in &self.findings {
            let first: Vec<String> = seeds.iter().take(SEEDS).map(u64::to_string).collect();
            write!(f, "\n  {} x {kind} (seeds {})", seeds.len(), first.join(", "))?;
        }
        if self.findings.is_empty() { f.write_str(" none") } else { Ok(()) }
    }
}

fn batch(seeds: std::ops::Range<u64>, how: &How, tally: &mut Tally) -> Result<(), Failed> {
    let (mut outputs, mut owners): (Vec<Output>, Vec<u64>) = Default::default();
    let mut runnables: Vec<Runnable> = Vec::new();
    for seed in seeds {
        tally.programs += 1;
        match verdict_on(seed) {
            Err(finding) => tally.find(seed, finding),
            Ok(Verdict::Refused(words)) => {
                if std::env::var_os("LAMPLIGHT_LINK_REFUSED").is_some() {
                    std::fs::create_dir_all(findings())?;
                    let file = findings().join(format!("refused_{seed}.txt"));
                    std::fs::write(file, format!("{words}\n{}", program(seed).text))?;
                }
                *tally.refused.entry(first_words(&words)).or_default() += 1;
            }
            Ok(Verdict::Sound(sound)) => {
                tally.outputs += sound.outputs.len();
                for (target, reason) in &sound.whole {
                    let place = format!("{reason:?} in {target}");
                    tally.whole.entry(place).or_insert((0, seed)).0 += 1;
                }
                if how.often > 0 && seed % how.often == 0 {
                    tally.elsewhere += usize::from(sound.is_elsewhere);
                    for runnable in sound.runnables {
                        match runnable.as_a_whole() {
                            Some(whole) => runnables.push(whole),
                            None => tally.refused_whole += 1,
                        }
                    }
                }
                if seed % how.every == 0 {
                    let some = few(sound.outputs, how.most);
                    owners.extend(some.iter().map(|_| seed));
                    outputs.extend(some);
                }
            }
        }
    }
    tally.validated += outputs.len();
    let views: Vec<&Output> = outputs.iter().collect();
    for (index, words) in outside::refused(&views)? {
        tally.find(owners[index], refusal(&outputs[index], &words));
    }
    if let Some(runner) = &how.runner {
        for (index, finding) in runner.run(&runnables, &mut tally.ran)? {
            tally.find(runnables[index].seed, finding);
        }
    }
    Ok(())
}

/// The first `most` outputs of each target. Their order is random.
fn few(mut outputs: Vec<Output>, most: usize) -> Vec<Output> {
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    outputs.retain(|output| {
        let count = counts.entry(output.target.name()).or_default();
        *count += 1;
        *count <= most
    });
    outputs
}

fn refusal(output: &Output, words: &str) -> Finding {
    let text = match output.target == Target::SPIRV {
        false => String::from_utf8_lossy(&output.artifact.bytes).into_owned(),
        true => String::new(),
    };
    let line = words.lines().find(|line| line.to_lowercase().contains("error"));
    // The author's names are between quotes. They and the places are left out, so that the same
    // mistake has the same kind in all programs.
    let unnamed = line.unwrap_or_default().split('\'').step_by(2);
    let message: String =
        unnamed.flat_map(str::chars).filter(|one| !one.is_ascii_digit()).collect();
    let kind = format!("{} is refused: {message}", output.target);
    Finding::new(kind, format!("{words}\n{text}"))
}

/// The start of an error, without its place and without digits, which differ between programs.
fn first_words(words: &str) -> String {
    let line = words.lines().next().unwrap_or_default();
    let message = line.split_once("error").map_or(line, |(_, message)| message);
    message.chars().filter(|c| !c.is_ascii_digit()).take(60).collect()
}

/// The verdict on the program of a seed. A panic is a finding too.
fn verdict_on(seed: u64) -> Result<Verdict, Finding> {
    guarded(&program(seed), seed)
}

/// The program of a seed. The environment may name a file with another text for it, such as one
/// that somebody made smaller.
fn program(seed: u64) -> Program {
    let program = Program::new(seed);
    let Some(file) = std::env::var_os("LAMPLIGHT_LINK_TEXT") else { return program };
    match std::fs::read_to_string(&file) {
        Ok(text) => Program { text, ..program },
        Err(error) => panic!("LAMPLIGHT_LINK_TEXT, {}: {error}", file.display()),
    }
}

fn guarded(program: &Program, seed: u64) -> Result<Verdict, Finding> {
    let compared = || same::compare_outputs(program, &mut Random(seed ^ 0x5eed));
    catch_unwind(AssertUnwindSafe(compared))
        .unwrap_or_else(|_| Err(Finding::new("panic", program.text.clone())))
}

/// Writes the first program of a kind of finding to a file. It is made smaller if that is asked
/// for.
fn report_finding(kind: &str, found: &Found, runner: Option<&Runner>) -> Result<(), Failed> {
    let folder = findings();
    std::fs::create_dir_all(&folder)?;
    let program = program(found.seed);
    let (mut small, mut about) = (program.clone(), found.finding.about.clone());
    if std::env::var_os("LAMPLIGHT_LINK_SHRINK").is_some() {
        let with = |text: &str| Program { text: text.to_owned(), ..program.clone() };
        let has = |text: &str| again(&with(text), found.seed, kind, runner).is_some();
        small = with(&shrink::shrunk(&program.text, &has));
        about = again(&small, found.seed, kind, runner).map_or(about, |finding| finding.about);
    }
    let mut text = format!("seed {}: {kind}\n\n{}\n{}\n", found.seed, small.manifest, small.text);
    let _ = write!(text, "\n{about}\n");
    let plain = |letter: char| if letter.is_ascii_alphanumeric() { letter } else { '_' };
    let name: String = kind.chars().map(plain).take(60).collect();
    let file = folder.join(format!("{name}_{}.txt", found.seed));
    println!("{}", file.display());
    Ok(std::fs::write(file, text)?)
}

/// The folder to which findings are written.
fn findings() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("target/fuzz/link")
}

/// The finding of a kind in a program, if the program has one.
fn again(program: &Program, seed: u64, kind: &str, runner: Option<&Runner>) -> Option<Finding> {
    match guarded(program, seed) {
        Err(finding) => (finding.kind == kind).then_some(finding),
        Ok(Verdict::Refused(_)) => None,
        Ok(Verdict::Sound(sound)) => {
            let is_wanted = |output: &&Output| kind.starts_with(output.target.name());
            let views: Vec<&Output> = sound.outputs.iter().filter(is_wanted).collect();
            let refused = outside::refused(&views).ok()?;
            let refused = refused.iter().map(|(index, words)| refusal(views[*index], words));
            let ran = match runner {
                Some(runner) => runner.run(&sound.runnables, &mut BTreeMap::new()).ok()?,
                None => Vec::new(),
            };
            let mut all = refused.chain(ran.into_iter().map(|(_, finding)| finding));
            all.find(|finding| finding.kind == kind)
        }
    }
}
