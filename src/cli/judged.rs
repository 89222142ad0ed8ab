//! `gen --validate`: asks the judges of the targets about a run's outputs, before these replace the
//! bundle that is there.

use std::path::{Path, PathBuf};

use super::failure::Failure;
use super::progress::Bar;
use crate::bundle::{BlobFile, Bundle, Contents, Error, Target, blob_files, stage_blobs};
use crate::cache::Cache;
use crate::generate::{JudgedCount, Progress, Request};
use crate::judge::{MissingTool, OutputOrigin, Tint, blame, missing, outputs, verdict};
use crate::output::Scratch;
use crate::permute::Manifest;
use crate::project;
use crate::resolve::Packages;
use crate::source::SourceSet;

/// The judges of a run's targets. All of them are installed.
pub struct Judges {
    tint: Tint,
}

/// What the outputs were made of.
pub struct Inputs<'a> {
    pub sources: &'a mut SourceSet,
    pub packages: &'a Packages,
    pub manifest: &'a Manifest,
    pub cache: Option<&'a Cache>,
}

impl Judges {
    /// Checks that all judges are installed. Tint is looked for beside the cache folder.
    pub fn open(
        manifest: &Manifest,
        request: &Request,
        path: &Path,
        cache: Option<PathBuf>,
    ) -> Result<Self, Failure> {
        let cache = cache.or_else(|| project::cache_folder(path));
        let tint = Tint::beside(&cache.unwrap_or_else(|| std::env::temp_dir().join("cache")));
        let declared = manifest.programs.iter().flat_map(|program| program.targets.clone());
        let mut targets: Vec<Target> = match request.targets.is_empty() {
            true => declared.collect(),
            false => request.targets.clone(),
        };
        targets.sort();
        let lacking: Vec<String> =
            missing(&targets, &tint).iter().map(MissingTool::to_string).collect();
        match lacking.is_empty() {
            true => Ok(Self { tint }),
            false => Err(Failure::environment(format!("cannot judge: {}", lacking.join("\n")))),
        }
    }

    /// Judges files. A refusal is an error of the input.
    pub fn files(
        &self,
        files: impl IntoIterator<Item = BlobFile>,
        contents: &dyn Fn() -> Result<Contents, Error>,
        inputs: Inputs<'_>,
        bar: &Bar,
    ) -> Result<JudgedCount, Failure> {
        let broken = |error: Error| Failure::input(error.to_string());
        let progress = |done, total| {
            bar.show(Progress { stage: "judging".to_owned(), done, total });
        };
        let Inputs { sources, packages, manifest, cache } = inputs;
        let outputs = outputs(files).map_err(broken)?;
        let verdict = verdict(outputs, cache, &self.tint, &progress);
        let verdict = verdict.map_err(Failure::environment)?;
        if verdict.refusals.is_empty() {
            return Ok(JudgedCount { now: verdict.judged, before: verdict.known });
        }
        bar.clear();
        let made = OutputOrigin { packages, manifest, contents: &contents().map_err(broken)? };
        let diagnostics = blame(sources, &made, &verdict.refusals);
        Err(Failure::Input(sources.clone(), diagnostics))
    }

    /// Judges a bundle in memory.
    pub fn contents(
        &self,
        contents: &Contents,
        inputs: Inputs<'_>,
        bar: &Bar,
    ) -> Result<JudgedCount, Failure> {
        let failed = |error: Error| Failure::environment(error.to_string());
        let scratch = Scratch::new(&std::env::temp_dir())?;
        let files = stage_blobs(contents, &scratch).map_err(failed)?;
        self.files(files, &|| Ok(contents.clone()), inputs, bar)
    }

    /// Judges a bundle that is there.
    pub fn bundle(
        &self,
        out: &Path,
        inputs: Inputs<'_>,
        bar: &Bar,
    ) -> Result<JudgedCount, Failure> {
        let broken = |error: Error| Failure::input(error.to_string());
        let contents = || Bundle::open(out)?.contents();
        match out.is_dir() {
            true => self.files(blob_files(out).map_err(broken)?, &contents, inputs, bar),
            false => self.contents(&contents().map_err(broken)?, inputs, bar),
        }
    }
}
