//! What `gen` and `watch` share: they open a package with its manifest and its cache, and generate
//! its bundle.

use std::io::Write;
use std::path::{Path, PathBuf};

use clap::Args;

use super::cached::Cached;
use super::compile::write_depfile;
use super::failure::{DiagnosticForm, Failure, print_warnings};
use super::overwrite::{Overwrite, Patience, write_failure};
use super::partial;
use super::progress::Bar;
use super::terminal::stderr;
use super::validated::{Inputs, Validators};
use crate::bundle::{self, Bundle, Contents, DirectoryWriter};
use crate::cache::Cache;
use crate::generate::{
    Generated, Look, MemorySink, Observer, Request, RunWarnings, Sink, Summary, Tools, Trace,
    TracedRun, generate,
};
use crate::output::Replace;
use crate::permute::Manifest;
use crate::project;
use crate::resolve::Packages;
use crate::source::SourceSet;
use crate::spirv_opt::SpirvOpt;
use crate::store;
use crate::validators::Extent;

/// Where things are.
#[derive(Args)]
pub struct PathArguments {
    /// The manifest [default: `lamplight.toml` here or in the nearest folder above].
    #[arg(long, value_name = "FILE")]
    manifest: Option<PathBuf>,
    /// The folder of the bundle, or a single file whose name ends in `.lamplight`.
    #[arg(short, long, value_name = "DIR", default_value = "bundle")]
    pub out: PathBuf,
    #[command(flatten)]
    cached: Cached,
    #[arg(long, value_name = "ADDRESS", help = store::HELP, conflicts_with = "no_cache")]
    store: Option<String>,
    #[command(flatten)]
    overwrite: Overwrite,
    #[command(flatten)]
    patience: Patience,
}

impl PathArguments {
    /// The manifest that was named, or else the nearest.
    pub fn manifest(&self) -> PathBuf {
        let named = self.manifest.clone().or_else(|| project::manifest_above(Path::new("")));
        named.unwrap_or_else(|| PathBuf::from(project::MANIFEST))
    }
}

/// Everything that a run needs, read and ready.
pub struct Work {
    pub sources: SourceSet,
    pub out: PathBuf,
    /// The path of the manifest.
    path: PathBuf,
    packages: Packages,
    manifest: Manifest,
    observer: Observer,
    cache: Option<Cache>,
    /// The cache folder, as it was asked for.
    cache_folder: Option<PathBuf>,
    validators: Option<Validators>,
    replace: Replace,
    patience: Patience,
    /// The texts that are read before the packages: the manifest, and the files that declare
    /// packages.
    declared: SourceSet,
}

impl Work {
    pub fn open(places: &PathArguments) -> Result<Self, Failure> {
        let mut sources = SourceSet::default();
        let path = places.manifest();
        let opened = project::declared(&path, &mut sources);
        let (manifest, packages) =
            opened.map_err(|diagnostics| Failure::Input(sources.clone(), diagnostics))?;
        let observer = Observer::default();
        Ok(Self {
            declared: sources.clone(),
            sources,
            out: places.out.clone(),
            packages: observer.observe(packages),
            manifest,
            observer,
            cache: open_cache(places, &path)?,
            cache_folder: places.cached.cache.clone(),
            validators: None,
            path,
            replace: places.overwrite.replace(),
            patience: places.patience,
        })
    }

    /// Lets the validators check the outputs of later runs, before these replace a bundle.
    pub fn validate(&mut self, extent: Extent) {
        let cache = self.cache_folder.clone();
        let is_requested = extent != Extent::Nothing;
        self.validators = is_requested.then(|| Validators::new(extent, &self.path, cache));
    }

    /// The summary of an earlier run, whose bundle is on disk. If validators are asked for, they
    /// check it, unless they did so before.
    pub fn validate_bundle(&mut self, trace: Trace) -> Result<Summary, Failure> {
        let (out, bar) = (self.out.clone(), Bar::new());
        let (validators, inputs) = self.validators();
        let Some(validators) = validators else { return Ok(trace.summary) };
        let record = validators.record(trace.bundle(), &trace.summary);
        let known = inputs.cache.and_then(|cache| record.find(cache));
        let validated = match known {
            Some(known) => known,
            None => {
                let validated = validators.bundle(&out, inputs, &bar)?;
                bar.clear();
                self.cache.iter().for_each(|cache| record.keep(cache, &validated));
                validated
            }
        };
        Ok(Summary { validated: Some(validated), ..trace.summary })
    }

    fn validators(&mut self) -> (Option<&Validators>, Inputs<'_>) {
        let Self { sources, packages, manifest, cache, validators, .. } = self;
        (validators.as_ref(), Inputs { sources, packages, manifest, cache: cache.as_ref() })
    }

    /// Writes a rule for make: the bundle, and the files that the last run read.
    pub fn write_rule(&self, path: &Path) -> Result<(), Failure> {
        let is_single = is_file(&self.out);
        let output = if is_single { self.out.clone() } else { self.out.join("manifest.json") };
        write_depfile(path, std::iter::once(output), &self.sources, self.replace)
    }

    /// Whether files are still as they were when they were read.
    pub fn is_current(&self) -> bool {
        let mut sources = SourceSet::default();
        let declared = project::declared(&self.path, &mut sources).is_ok()
            && sources
                .iter()
                .map(|(_, source)| &source.text)
                .eq(self.declared.iter().map(|(_, source)| &source.text));
        declared && self.observer.is_current(&self.packages)
    }

    /// An earlier run, if nothing changed since. Its warnings are printed again.
    pub fn up_to_date(&self, request: &Request, look: Look, form: DiagnosticForm) -> Option<Trace> {
        // A run without the optimiser that it needs tells what is missing.
        let optimiser = request.optimiser_version(&self.manifest, Some(&SpirvOpt)).ok()?;
        let run = self.as_run(request, optimiser.as_deref());
        let mut found = Trace::find(self.cache.as_ref()?, run, look)?;
        let _ = stderr().write_all(found.warnings.text(form.into()).as_bytes());
        (found.summary.up_to_date, found.summary.validated) = (true, None);
        Some(found)
    }

    /// Generates, and writes the bundle or compares with it.
    pub fn run(
        &mut self,
        request: &Request,
        check: bool,
        form: DiagnosticForm,
    ) -> Result<Summary, Failure> {
        if !check && self.replace == Replace::Ours {
            partial::refuse_partial(&self.manifest, request, &self.out)?;
        }
        let bar = Bar::new();
        let outcome = if check || is_file(&self.out) {
            self.in_memory(request, check, &bar)
        } else {
            self.streamed(request, &bar)
        };
        bar.clear();
        let Generated { summary, warnings, .. } = outcome?;
        print_warnings(&self.sources, &warnings, form);
        if let Some(cache) = &self.cache {
            warn_of_failures(cache);
            let warnings = RunWarnings::new(&self.path, &self.sources, &warnings);
            let trace = Trace::new(&self.observer, &self.out, summary.clone(), warnings);
            if let Some(trace) = trace {
                let optimiser = request.optimiser_version(&self.manifest, Some(&SpirvOpt));
                if let Ok(optimiser) = optimiser {
                    trace.keep(cache, self.as_run(request, optimiser.as_deref()));
                }
                if let (Some(validators), Some(validated)) = (&self.validators, &summary.validated)
                {
                    validators.record(trace.bundle(), &summary).keep(cache, validated);
                }
            }
        }
        Ok(summary)
    }

    fn as_run<'a>(&'a self, request: &'a Request, optimiser: Option<&'a str>) -> TracedRun<'a> {
        TracedRun {
            manifest: &self.path,
            declared: &self.declared,
            request,
            packages: &self.packages,
            out: &self.out,
            optimiser,
        }
    }

    /// Writes one permutation into the present bundle directory, before all others.
    pub fn patch(&mut self, request: &Request) -> Result<(), Failure> {
        let memory = MemorySink::default();
        let mut generated = self.generate(request, &memory, &Bar::new())?;
        memory.fill(&mut generated.contents);
        bundle::patch_directory(&generated.contents, &self.out)
            .map_err(|error| write_failure(&self.out, error))
    }

    /// Generates into a bundle directory. Each unit is written as soon as it is made.
    fn streamed(&mut self, request: &Request, bar: &Bar) -> Result<Generated, Failure> {
        let writer = self.patience.with_turns(&self.out, |turns| {
            DirectoryWriter::take_over(&self.out, self.replace, turns)
        });
        let writer = writer.map_err(|error| write_failure(&self.out, error))?;
        let mut generated = self.generate(request, &writer, bar)?;
        let (validators, inputs) = self.validators();
        if let Some(validators) = validators {
            let files = writer
                .blob_files()
                .map_err(|error: bundle::Error| Failure::environment(error.to_string()))?;
            let contents = || Ok(generated.contents.clone());
            generated.summary.validated = Some(validators.files(files, &contents, inputs, bar)?);
        }
        writer.finish(&generated.contents).map_err(|error| write_failure(&self.out, error))?;
        Ok(generated)
    }

    /// Generates in memory, then compares with the bundle on disk, or writes a single file. The
    /// order of its parts is known only at the end.
    fn in_memory(
        &mut self,
        request: &Request,
        check: bool,
        bar: &Bar,
    ) -> Result<Generated, Failure> {
        let memory = MemorySink::default();
        let mut generated = self.generate(request, &memory, bar)?;
        memory.fill(&mut generated.contents);
        let (validators, inputs) = self.validators();
        if let Some(validators) = validators {
            generated.summary.validated =
                Some(validators.contents(&generated.contents, inputs, bar)?);
        }
        match check {
            true => compare_with_last(&generated.contents, &self.out)?,
            false => bundle::replace_file(&generated.contents, &self.out, self.replace)
                .map_err(|error| write_failure(&self.out, error))?,
        }
        Ok(generated)
    }

    fn generate(
        &mut self,
        request: &Request,
        sink: &dyn Sink,
        bar: &Bar,
    ) -> Result<Generated, Failure> {
        let tools = Tools {
            sink,
            cache: self.cache.as_ref(),
            tool: crate::TOOL,
            optimiser: Some(&SpirvOpt),
            progress: &|progress| bar.show(progress),
        };
        let generated =
            generate(&mut self.sources, &self.packages, &self.manifest, request, &tools);
        generated.map_err(|diagnostics| {
            bar.clear();
            Failure::Input(self.sources.clone(), diagnostics)
        })
    }
}

fn open_cache(places: &PathArguments, manifest: &Path) -> Result<Option<Cache>, Failure> {
    let mut storages = places.cached.storages(Some(manifest))?;
    if let Some(address) = &places.store {
        storages.push(store::open(address).map_err(Failure::environment)?);
    }
    Ok((!storages.is_empty()).then(|| Cache::new(crate::BUILD, storages)))
}

/// Warns if the cache failed. The run does not fail because of that.
fn warn_of_failures(cache: &Cache) {
    if cache.failures() > 0 {
        let _ = writeln!(
            stderr(),
            "warning: the cache or the store refused {} times; everything was computed all the same",
            cache.failures()
        );
    }
}

pub fn is_file(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension == "lamplight")
}

fn compare_with_last(contents: &Contents, out: &Path) -> Result<(), Failure> {
    let there = Bundle::open(out).and_then(|bundle| bundle.verify().map(|()| bundle));
    let there = there.and_then(|bundle| bundle.contents());
    let there = there.map_err(|error| Failure::check(format!("`{}`: {error}", out.display())))?;
    let difference = bundle::diff(&there, contents);
    if difference.is_empty() {
        return Ok(());
    }
    let changes = difference.permutations.iter().take(20);
    let lines: Vec<String> = changes
        .map(|change| {
            format!("  {} {} {} {}", change.kind, change.program, change.entry, change.key)
        })
        .collect();
    let count = difference.permutations.len();
    let differ = if count == 1 {
        "1 permutation differs".to_owned()
    } else {
        format!("{count} permutations differ")
    };
    Err(Failure::check(format!(
        "`{}` is not up to date: {differ}\n{}",
        out.display(),
        lines.join("\n")
    )))
}
