//! `cargo xtask gen`: writes the library's bundle, as `lamplight gen` does, once validators accept it.
//! By default they see a selection of outputs that has each distinct line of each target.
//! `--validate all` takes all outputs, and `--validate none` no output.

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::time::Instant;

use lamplight::bundle::{self, BlobFile, Bundle, Contents, DirectoryWriter, blob_files};
use lamplight::cache::{Cache, CacheFolder};
use lamplight::diagnostic::Diagnostics;
use lamplight::diagnostic::render::{Form, render};
use lamplight::generate::{
    Generated, Look, Observer, Progress, Request, RunWarnings, Summary, Tools, Trace, TracedRun,
    Validation, generate,
};
use lamplight::permute::Manifest;
use lamplight::project;
use lamplight::resolve::Packages;
use lamplight::source::SourceSet;
use lamplight_validators::{BundleRecord, Extent, OutputOrigin, Refusal, Tint, Verdict, blame};

use crate::progress::show_progress;
use crate::validate::{tint, tint_folder, validate};
use xtask::process::root;
use xtask::{CommandFailure, CommandResult};

const USAGE: &str =
    "usage: cargo xtask gen [--validate lines|all|none] (for other manifests: lamplight gen)";

/// Where the library's bundle goes.
pub fn bundle() -> PathBuf {
    root().join("target/bundles/lamplight")
}

/// What a run works with.
struct Run {
    start: Instant,
    extent: Extent,
    path: PathBuf,
    out: PathBuf,
    sources: SourceSet,
    /// The texts that are read before the packages.
    declared: SourceSet,
    manifest: Manifest,
    packages: Packages,
    observer: Observer,
    request: Request,
    cache: Cache,
}

/// Generates, validates what is new, writes the bundle and prints the summary. If an output is
/// refused, the older bundle does not change.
pub fn run(arguments: &[String]) -> CommandResult {
    let mut run = Run::open(wanted_extent(arguments)?)?;
    let trace = Trace::find(&run.cache, run.traced(), Look::Cheap);
    let summary = match trace {
        Some(trace) => run.up_to_date(trace)?,
        None => run.generate()?,
    };
    print!("{summary}");
    if run.extent == Extent::Nothing {
        println!("not validated");
    }
    println!("written to target/bundles/lamplight");
    Ok(())
}

/// What the arguments say of the validators.
fn wanted_extent(arguments: &[String]) -> Result<Extent, CommandFailure> {
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let name = match arguments.as_slice() {
        [] => return Ok(Extent::Lines),
        ["--unjudged"] => {
            eprintln!("note: `--unjudged` is now called `--validate none`");
            return Ok(Extent::Nothing);
        }
        ["--validate"] => return Ok(Extent::All),
        ["--validate", name] => Some(*name),
        [option] => option.strip_prefix("--validate="),
        _ => None,
    };
    name.and_then(Extent::find).ok_or_else(|| CommandFailure::usage(USAGE))
}

impl Run {
    fn open(extent: Extent) -> Result<Self, CommandFailure> {
        let start = Instant::now();
        let path = root().join("shaderlib").join(project::MANIFEST);
        let mut sources = SourceSet::default();
        let (manifest, packages) =
            project::declared(&path, &mut sources).map_err(|errors| input(&sources, &errors))?;
        let folder = CacheFolder::new(root().join("target/lamplight-cache"))
            .map_err(|foreign| CommandFailure::input(foreign.to_string()))?;
        let observer = Observer::default();
        Ok(Self {
            start,
            extent,
            path,
            out: bundle(),
            declared: sources.clone(),
            sources,
            manifest,
            packages: observer.observe(packages),
            observer,
            request: Request::default(),
            cache: Cache::new(lamplight::BUILD, vec![Box::new(folder)]),
        })
    }

    fn traced(&self) -> TracedRun<'_> {
        TracedRun {
            manifest: &self.path,
            declared: &self.declared,
            request: &self.request,
            packages: &self.packages,
            out: &self.out,
            // Every program of the library has the default form.
            optimiser: None,
        }
    }

    /// The summary of an earlier run, whose bundle is validated if it was not before.
    fn up_to_date(&mut self, trace: Trace) -> Result<Summary, CommandFailure> {
        eprint!("{}", trace.warnings.text(Form::Human));
        let validated = match self.record(&trace, &tint_folder()).find(&self.cache) {
            Some(known) => Some(known),
            None if self.extent == Extent::Nothing => None,
            None => {
                let (files, out) = (blob_files(&self.out).map_err(environment)?, self.out.clone());
                let contents = || Bundle::open(&out).and_then(|bundle| bundle.contents());
                let validated = self.validate(files, &contents)?;
                self.keep(&trace, Some(&validated));
                Some(validated)
            }
        };
        let seconds = self.start.elapsed().as_secs_f64();
        Ok(Summary { up_to_date: true, validated, seconds, ..trace.summary })
    }

    /// Generates and validates, and then writes the bundle.
    fn generate(&mut self) -> Result<Summary, CommandFailure> {
        let writer = DirectoryWriter::create(&self.out).map_err(environment)?;
        let tools = Tools {
            sink: &writer,
            cache: Some(&self.cache),
            tool: lamplight::TOOL,
            optimiser: None,
            progress: &|Progress { stage, done, total }| show_progress(&stage, done, total),
        };
        let generated =
            generate(&mut self.sources, &self.packages, &self.manifest, &self.request, &tools);
        let Generated { contents, mut summary, warnings } =
            generated.map_err(|errors| input(&self.sources, &errors))?;
        let validated = match self.extent {
            Extent::Nothing => None,
            Extent::Lines | Extent::All => {
                let files = writer.blob_files().map_err(environment)?;
                Some(self.validate(files, &|| Ok(contents.clone()))?)
            }
        };
        writer.finish(&contents).map_err(environment)?;
        eprint!("{}", render(&self.sources, &warnings, Form::Human));
        let warnings = RunWarnings::new(&self.path, &self.sources, &warnings);
        if let Some(trace) = Trace::new(&self.observer, &self.out, summary.clone(), warnings) {
            trace.keep(&self.cache, self.traced());
            self.keep(&trace, validated.as_ref());
        }
        (summary.validated, summary.seconds) = (validated, self.start.elapsed().as_secs_f64());
        Ok(summary)
    }

    /// Fails if a validator refuses an output. The errors point to places in the author's sources.
    fn validate(
        &mut self,
        files: BTreeSet<BlobFile>,
        contents: &dyn Fn() -> Result<Contents, bundle::Error>,
    ) -> Result<Validation, CommandFailure> {
        let Verdict { validation, refusals } =
            validate(files, self.extent, Some(&self.cache), &tint())?;
        if refusals.is_empty() { Ok(validation) } else { Err(self.refused(contents, &refusals)) }
    }

    fn refused(
        &mut self,
        contents: &dyn Fn() -> Result<Contents, bundle::Error>,
        refusals: &[Refusal],
    ) -> CommandFailure {
        let contents = match contents() {
            Ok(contents) => contents,
            Err(error) => return environment(error),
        };
        let (packages, manifest) = (&self.packages, &self.manifest);
        let made = OutputOrigin { packages, manifest, contents: &contents };
        let errors = blame(&mut self.sources, &made, refusals);
        input(&self.sources, &errors)
    }

    fn record(&self, trace: &Trace, tint: &Tint) -> BundleRecord {
        let targets: Vec<&str> =
            trace.summary.targets.iter().map(|target| target.target.as_str()).collect();
        BundleRecord::new(trace.bundle(), &targets, self.extent, tint)
    }

    fn keep(&self, trace: &Trace, validated: Option<&Validation>) {
        if let Some(validated) = validated {
            self.record(trace, &tint_folder()).keep(&self.cache, validated);
        }
    }
}

fn input(sources: &SourceSet, errors: &Diagnostics) -> CommandFailure {
    CommandFailure::input(render(sources, errors, Form::Human))
}

fn environment(error: bundle::Error) -> CommandFailure {
    CommandFailure::environment(error.to_string())
}
