//! `gen --validate`: asks the validators of the targets about a run's outputs, before these replace
//! the bundle that is there.

use std::path::{Path, PathBuf};

use clap::ValueEnum;

use super::failure::Failure;
use super::progress::Bar;
use crate::bundle::{BlobFile, Bundle, Contents, Error, blob_files, stage_blobs};
use crate::cache::Cache;
use crate::generate::{Progress, Summary, Validation};
use crate::output::Scratch;
use crate::permute::Manifest;
use crate::project;
use crate::resolve::Packages;
use crate::source::SourceSet;
use crate::validators::{BundleRecord, Extent, OutputOrigin, Tint, blame, outputs, verdict};

/// [`Extent`] as an option's value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ValidatedOutputs {
    /// A selection of outputs that has each distinct line of each target.
    Lines,
    /// Every output.
    All,
    /// No output.
    None,
}

impl From<ValidatedOutputs> for Extent {
    fn from(extent: ValidatedOutputs) -> Self {
        match extent {
            ValidatedOutputs::Lines => Self::Lines,
            ValidatedOutputs::All => Self::All,
            ValidatedOutputs::None => Self::Nothing,
        }
    }
}

/// The validators, and how many outputs they check.
pub struct Validators {
    tint: Tint,
    extent: Extent,
}

/// What the outputs were made of.
pub struct Inputs<'a> {
    pub sources: &'a mut SourceSet,
    pub packages: &'a Packages,
    pub manifest: &'a Manifest,
    pub cache: Option<&'a Cache>,
}

impl Validators {
    /// The validators for a manifest. Tint is looked for beside the cache folder.
    pub fn new(extent: Extent, path: &Path, cache: Option<PathBuf>) -> Self {
        let cache = cache.or_else(|| project::cache_folder(path));
        let tint = Tint::beside(&cache.unwrap_or_else(|| std::env::temp_dir().join("cache")));
        Self { tint, extent }
    }

    /// The record of a bundle that was validated.
    pub fn record(&self, bundle: &str, summary: &Summary) -> BundleRecord {
        let targets: Vec<&str> =
            summary.targets.iter().map(|target| target.target.as_str()).collect();
        BundleRecord::new(bundle, &targets, self.extent, &self.tint)
    }

    /// Validates files. A refusal is an error of the input.
    pub fn files(
        &self,
        files: impl IntoIterator<Item = BlobFile>,
        contents: &dyn Fn() -> Result<Contents, Error>,
        inputs: Inputs<'_>,
        bar: &Bar,
    ) -> Result<Validation, Failure> {
        let broken = |error: Error| Failure::input(error.to_string());
        let progress = |done, total| {
            bar.show(Progress { stage: "validating".to_owned(), done, total });
        };
        let Inputs { sources, packages, manifest, cache } = inputs;
        let outputs = outputs(files).map_err(broken)?;
        let verdict = verdict(outputs, self.extent, cache, &self.tint, &progress);
        let verdict = verdict.map_err(Failure::environment)?;
        if verdict.refusals.is_empty() {
            return Ok(verdict.validation);
        }
        bar.clear();
        let made = OutputOrigin { packages, manifest, contents: &contents().map_err(broken)? };
        let diagnostics = blame(sources, &made, &verdict.refusals);
        Err(Failure::Input(sources.clone(), diagnostics))
    }

    /// Validates a bundle in memory.
    pub fn contents(
        &self,
        contents: &Contents,
        inputs: Inputs<'_>,
        bar: &Bar,
    ) -> Result<Validation, Failure> {
        let failed = |error: Error| Failure::environment(error.to_string());
        let scratch = Scratch::new(&std::env::temp_dir())?;
        let files = stage_blobs(contents, &scratch).map_err(failed)?;
        self.files(files, &|| Ok(contents.clone()), inputs, bar)
    }

    /// Validates a bundle that is there.
    pub fn bundle(&self, out: &Path, inputs: Inputs<'_>, bar: &Bar) -> Result<Validation, Failure> {
        let broken = |error: Error| Failure::input(error.to_string());
        let contents = || Bundle::open(out)?.contents();
        match out.is_dir() {
            true => self.files(blob_files(out).map_err(broken)?, &contents, inputs, bar),
            false => self.contents(&contents().map_err(broken)?, inputs, bar),
        }
    }
}

/// Fails if a validator that was asked for is not installed. The run is over by then: what the
/// others accepted is written.
pub fn refuse_missing(validation: Option<&Validation>) -> Result<(), Failure> {
    let missing = validation.map(Validation::missing).unwrap_or_default();
    match missing.is_empty() {
        true => Ok(()),
        false => {
            let missing = missing.join("\n");
            Err(Failure::environment(format!("not all outputs are validated:\n{missing}")))
        }
    }
}
