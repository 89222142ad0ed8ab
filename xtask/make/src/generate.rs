//! `cargo xtask gen`: writes the library's bundle, as `lamplight gen` does, once the judges of all
//! targets accept it. `--unjudged` skips the judges, which take ten times as long as everything
//! else.

use std::collections::BTreeSet;
use std::io::{IsTerminal, Write, stderr};
use std::path::PathBuf;

use lamplight::bundle::{self, BlobFile, Bundle, Contents, DirectoryWriter, blob_files};
use lamplight::cache::{Cache, CacheFolder};
use lamplight::diagnostic::Diagnostics;
use lamplight::diagnostic::render::{Form, render};
use lamplight::generate::{
    Generated, Look, Observer, Progress, Request, RunWarnings, Summary, Tools, Trace, TracedRun,
    generate,
};
use lamplight::permute::Manifest;
use lamplight::project;
use lamplight::resolve::Packages;
use lamplight::source::SourceSet;
use lamplight_validators::{OutputOrigin, blame};

use crate::validate::{JudgedOutputs, judge};
use xtask::process::root;
use xtask::{CommandFailure, CommandResult};

/// Where the library's bundle goes.
pub fn bundle() -> PathBuf {
    root().join("target/bundles/lamplight")
}

/// Generates, judges what is new, writes the bundle and prints the summary. If an output is
/// refused, the older bundle does not change.
pub fn run(arguments: &[String]) -> CommandResult {
    let is_judged = is_judged(arguments)?;
    let start = std::time::Instant::now();
    let path = root().join("shaderlib").join(project::MANIFEST);
    let mut sources = SourceSet::default();
    let input = |sources: &SourceSet, diagnostics: Diagnostics| {
        CommandFailure::input(render(sources, &diagnostics, Form::Human))
    };
    let (manifest, packages) = project::declared(&path, &mut sources)
        .map_err(|diagnostics| input(&sources, diagnostics))?;
    let (declared, observer) = (sources.clone(), Observer::default());
    let (packages, out, request) = (observer.observe(packages), bundle(), Request::default());
    let folder = CacheFolder::new(root().join("target/lamplight-cache"))
        .map_err(|foreign| CommandFailure::input(foreign.to_string()))?;
    let cache = Cache::new(lamplight::BUILD, vec![Box::new(folder)]);
    let as_run = || TracedRun {
        manifest: &path,
        declared: &declared,
        request: &request,
        packages: &packages,
        out: &out,
    };
    if let Some(Trace { summary, told, .. }) = Trace::find(&cache, as_run(), Look::Cheap) {
        eprint!("{}", told.text(Form::Human));
        let judged = judged(is_judged, || blob_files(&out), &cache)?;
        let summary =
            Summary { up_to_date: true, seconds: start.elapsed().as_secs_f64(), ..summary };
        let contents = || Bundle::open(&out).and_then(|bundle| bundle.contents());
        refuse(&mut sources, &packages, &manifest, &judged, &contents)?;
        return finish(&summary, &judged);
    }
    let writer = DirectoryWriter::create(&out).map_err(environment)?;
    let tools =
        Tools { sink: &writer, cache: Some(&cache), tool: lamplight::TOOL, progress: &show };
    let generated = generate(&mut sources, &packages, &manifest, &request, &tools);
    let Generated { contents, summary, warnings } =
        generated.map_err(|diagnostics| input(&sources, diagnostics))?;
    let judged = judged(is_judged, || writer.blob_files(), &cache)?;
    refuse(&mut sources, &packages, &manifest, &judged, &|| Ok(contents.clone()))?;
    writer.finish(&contents).map_err(environment)?;
    eprint!("{}", render(&sources, &warnings, Form::Human));
    let trace =
        Trace::new(&observer, &out, summary.clone(), RunWarnings::new(&path, &sources, &warnings));
    trace.into_iter().for_each(|trace| trace.keep(&cache, as_run()));
    finish(&summary, &judged)
}

/// Whether the judges are to be asked.
fn is_judged(arguments: &[String]) -> Result<bool, CommandFailure> {
    match arguments {
        [] => Ok(true),
        [option] if option == "--unjudged" => Ok(false),
        _ => {
            let usage = "usage: cargo xtask gen [--unjudged] (for other manifests: lamplight gen)";
            Err(CommandFailure::usage(usage))
        }
    }
}

/// What the judges say about the files, if they are asked.
fn judged(
    is_judged: bool,
    files: impl FnOnce() -> Result<BTreeSet<BlobFile>, bundle::Error>,
    cache: &Cache,
) -> Result<JudgedOutputs, CommandFailure> {
    match is_judged {
        true => judge(files().map_err(environment)?, Some(cache)),
        false => Ok(JudgedOutputs::nothing()),
    }
}

/// Fails if the judges refused an output. The errors point to places in the author's sources.
fn refuse(
    sources: &mut SourceSet,
    packages: &Packages,
    manifest: &Manifest,
    judged: &JudgedOutputs,
    contents: &dyn Fn() -> Result<Contents, bundle::Error>,
) -> CommandResult {
    if judged.refusals.is_empty() {
        return Ok(());
    }
    let made = OutputOrigin { packages, manifest, contents: &contents().map_err(environment)? };
    let refused = blame(sources, &made, &judged.refusals);
    Err(CommandFailure::input(render(sources, &refused, Form::Human)))
}

fn finish(summary: &Summary, judged: &JudgedOutputs) -> CommandResult {
    print!("{summary}");
    println!("written to target/bundles/lamplight");
    judged.complete()
}

fn environment(error: bundle::Error) -> CommandFailure {
    CommandFailure::environment(error.to_string())
}

fn show(progress: Progress) {
    if stderr().is_terminal() {
        let end = if progress.done == progress.total { "\n" } else { "" };
        let _ =
            write!(stderr(), "\r{}: {} of {}{end}", progress.stage, progress.done, progress.total);
    }
}
