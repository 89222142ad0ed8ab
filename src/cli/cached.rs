//! The options for the cache.

use std::path::{Path, PathBuf};

use clap::Args;

use super::failure::Failure;
use crate::cache::{Cache, CacheFolder, Storage};
use crate::project;

#[derive(Debug, Args)]
pub struct Cached {
    /// Folder for results that later runs need not compute again [default: `lamplight-cache` in
    /// the package's cargo target folder, or else in the user's cache folder].
    #[arg(long, value_name = "DIR")]
    pub cache: Option<PathBuf>,
    /// Do not read or write the cache.
    #[arg(long, conflicts_with = "cache")]
    pub no_cache: bool,
}

impl Cached {
    /// The cache of a package, or of the current folder where there is no manifest.
    pub fn open(&self, manifest: Option<&Path>) -> Result<Option<Cache>, Failure> {
        let storages = self.storages(manifest)?;
        Ok((!storages.is_empty()).then(|| Cache::new(crate::BUILD, storages)))
    }

    /// The cache folder as a storage. The list is empty with `--no-cache`, and where no folder is
    /// named and no default folder exists.
    pub fn storages(&self, manifest: Option<&Path>) -> Result<Vec<Box<dyn Storage>>, Failure> {
        if self.no_cache {
            return Ok(Vec::new());
        }
        let usual = || project::cache_folder(manifest.unwrap_or(Path::new(".")));
        let folder = self.cache.clone().or_else(usual);
        let storage = |folder| Ok::<Box<dyn Storage>, Failure>(Box::new(CacheFolder::new(folder)?));
        folder.map(storage).transpose().map(|storage| storage.into_iter().collect())
    }
}
