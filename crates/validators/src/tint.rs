//! Tint, the WGSL compiler of Dawn and Chromium, used through its npm package.

use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::MissingTool;
use lamplight_tools::NODE;

/// The npm package, in the only version that is used.
const PACKAGE: &str = "webgpu";
const VERSION: &str = "0.6.2";

const SCRIPT: &str = include_str!("tint.mjs");

/// The folder that the package is installed in.
#[derive(Debug, Clone)]
pub struct Tint {
    folder: PathBuf,
}

/// A mistake that Tint finds.
#[derive(Debug, Deserialize)]
pub struct TintMistake {
    /// Index of the text, in the order given.
    pub index: usize,
    pub line: u32,
    pub column: u32,
    pub message: String,
}

/// The last line that the script prints: how many texts it validated.
#[derive(Deserialize)]
struct Done {
    validated: usize,
}

#[derive(Deserialize)]
struct PackageJson {
    version: String,
}

/// What each line of the script begins with. No line of an output does.
const MARK: &str = "tint: ";

impl Tint {
    /// Tint, installed in a folder or not yet.
    pub fn at(folder: impl Into<PathBuf>) -> Self {
        Self { folder: folder.into() }
    }

    /// Tint in a folder beside a cache folder.
    pub fn beside(cache: &Path) -> Self {
        Self::at(cache.with_file_name("lamplight-tint"))
    }

    /// Program and arguments that install it.
    pub fn install(&self) -> [String; 6] {
        let folder = self.folder.display().to_string();
        let package = format!("{PACKAGE}@{VERSION}");
        ["npm", "install", "--no-audit", "--no-fund", &format!("--prefix={folder}"), &package]
            .map(str::to_owned)
    }

    /// What is missing, and how to install it, if it is not there.
    pub(super) fn missing(&self) -> Option<MissingTool> {
        (self.version() != VERSION).then(|| MissingTool {
            what: format!("Tint (npm package `{PACKAGE}` {VERSION})"),
            install: self.install().join(" "),
        })
    }

    /// The version that is installed; empty where none is.
    pub(super) fn version(&self) -> String {
        let file = self.folder.join("node_modules").join(PACKAGE).join("package.json");
        let text = std::fs::read(file).unwrap_or_default();
        serde_json::from_slice::<PackageJson>(&text).map_or(String::new(), |found| found.version)
    }

    /// The first mistake of each text that has one.
    ///
    /// # Errors
    /// A message, if it cannot be run.
    pub(super) fn validate(&self, files: &[&Path]) -> Result<Vec<TintMistake>, String> {
        if let Some(missing) = self.missing() {
            return Err(missing.to_string());
        }
        let folder = std::path::absolute(&self.folder).map_err(|error| error.to_string())?;
        let lines: Vec<String> = files.iter().map(|file| file.display().to_string()).collect();
        let folder = folder.display().to_string();
        let arguments = ["--input-type=module", "--eval", SCRIPT, "--", &folder];
        let printed = NODE.pipe(&arguments, lines.join("\n").as_bytes())?;
        let printed = String::from_utf8_lossy(&printed);
        let mut lines: Vec<&str> =
            printed.lines().filter_map(|line| line.strip_prefix(MARK)).collect();
        let done = lines.pop().and_then(|line| serde_json::from_str::<Done>(line).ok());
        if done.is_none_or(|done| done.validated != files.len()) {
            return Err(format!("Tint validated not all of {} texts", files.len()));
        }
        let one = |line: &str| serde_json::from_str(line).map_err(|error| error.to_string());
        lines.into_iter().map(one).collect()
    }
}
