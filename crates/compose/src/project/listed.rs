//! Which files of a folder are modules of its package: not those that `wesl.toml` leaves out, not those
//! of packages within it, and no `.wgsl` file where there is a `.wesl` file of the same name.

use std::collections::BTreeSet;
use std::path::Path;

use glob::{MatchOptions, Pattern};

use super::wesl_toml::{self, FilePatterns};
use lamplight_diagnostic::source::{Embedded, Files, ReadError};

/// The files of a package. All can be read; only those that are its modules are listed.
pub struct ListedFiles {
    below: Box<dyn Files>,
    /// `None` where all files are included.
    include: Option<Vec<Pattern>>,
    exclude: Vec<Pattern>,
    root: String,
}

impl ListedFiles {
    /// The files of the package whose root is a folder.
    pub fn new(root: &Path, below: Box<dyn Files>) -> Self {
        let FilePatterns { include, exclude, root } = wesl_toml::patterns(root);
        let all = |patterns: Vec<String>| -> Vec<Pattern> {
            patterns.iter().filter_map(|pattern| file_pattern(pattern)).collect()
        };
        Self { below, include: include.map(all), exclude: all(exclude), root }
    }

    fn is_listed(&self, file: &str, is_module: bool) -> bool {
        let path = format!("{}{file}", self.root);
        let options = MatchOptions { require_literal_separator: true, ..MatchOptions::default() };
        let matches = |pattern: &Pattern| pattern.matches_with(&path, options);
        // The patterns say where files of WESL are; what is left out is so in any language.
        let is_included = |include: &Vec<Pattern>| !is_module || include.iter().any(matches);
        self.include.as_ref().is_none_or(is_included) && !self.exclude.iter().any(matches)
    }
}

/// The pattern that a line of `include` or `exclude` means: a last part with neither a wildcard nor
/// an ending is a folder with all that is in it. `None` where it is no pattern, which the manifest's
/// reader reports.
fn file_pattern(pattern: &str) -> Option<Pattern> {
    let pattern = pattern.trim_start_matches("./").trim_end_matches('/');
    let last = pattern.rsplit('/').next().unwrap_or(pattern);
    let whole = match last.contains(['*', '?', '.']) && !matches!(last, "." | "..") {
        true => pattern.to_owned(),
        false if matches!(pattern, "" | ".") => "**/*".to_owned(),
        false => format!("{pattern}/**/*"),
    };
    Pattern::new(&whole).ok()
}

impl Files for ListedFiles {
    fn read(&self, path: &str) -> Result<Option<String>, ReadError> {
        self.below.read(path)
    }

    fn list(&self, extensions: &[&str]) -> Vec<String> {
        let asked = extensions.iter().chain(&["wesl", "toml"]).copied().collect::<Vec<_>>();
        let found = self.below.list(&asked);
        let nested: BTreeSet<&str> =
            found.iter().filter_map(|file| file.strip_suffix("/wesl.toml")).collect();
        let twins: BTreeSet<&str> =
            found.iter().filter_map(|file| file.strip_suffix(".wesl")).collect();
        let is_own = |file: &&String| {
            let mut folders = file.match_indices('/').map(|(at, _)| &file[..at]);
            !folders.any(|folder| nested.contains(folder))
        };
        let ending = |file: &str| file.rsplit_once('.').map(|(_, ending)| ending.to_owned());
        let is_asked = |file: &&String| {
            ending(file).is_some_and(|ending| extensions.contains(&ending.as_str()))
        };
        let is_twin =
            |file: &&String| file.strip_suffix(".wgsl").is_some_and(|stem| twins.contains(stem));
        let is_module = |file: &str| file.ends_with(".wesl") || file.ends_with(".wgsl");
        let listed = found.iter().filter(is_asked).filter(is_own).filter(|file| !is_twin(file));
        listed.filter(|file| self.is_listed(file, is_module(file))).cloned().collect()
    }

    fn display(&self, path: &str) -> String {
        self.below.display(path)
    }

    fn on_disk(&self, path: &str) -> bool {
        self.below.on_disk(path)
    }

    fn embedded(&self) -> Option<Embedded> {
        self.below.embedded()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lamplight_diagnostic::source::Memory;

    fn listed(include: Option<&[&str]>, exclude: &[&str], root: &str) -> Vec<String> {
        let files = [
            "main.wesl",
            "main.wgsl",
            "other.wgsl",
            "shade.frag",
            "test/a.wesl",
            "test/b.frag",
            "vendor/wesl.toml",
            "vendor/x.wesl",
            "deep/test/c.wesl",
            "deep/d.wesl",
        ];
        let files = files.map(|file| (file.to_owned(), String::new()));
        let all = |patterns: &[&str]| -> Vec<Pattern> {
            patterns.iter().filter_map(|pattern| file_pattern(pattern)).collect()
        };
        let listed = ListedFiles {
            below: Box::new(Memory(files.into())),
            include: include.map(all),
            exclude: all(exclude),
            root: root.to_owned(),
        };
        listed.list(&["wesl", "wgsl", "frag"])
    }

    #[test]
    fn twins_and_nested_packages_are_left_out() {
        let all = ["deep/d.wesl", "deep/test/c.wesl", "main.wesl", "other.wgsl", "shade.frag"];
        let all: Vec<&str> = all.into_iter().chain(["test/a.wesl", "test/b.frag"]).collect();
        assert_eq!(listed(None, &[], ""), all);
    }

    #[test]
    fn patterns_are_relative_to_the_manifest() {
        let wesl = ["deep/d.wesl", "deep/test/c.wesl", "main.wesl", "shade.frag", "test/a.wesl"];
        let wesl: Vec<&str> = wesl.into_iter().chain(["test/b.frag"]).collect();
        assert_eq!(listed(Some(&["shaders/**/*.wesl"]), &[], "shaders/"), wesl);
        let some = ["deep/d.wesl", "main.wesl", "shade.frag"];
        assert_eq!(listed(Some(&["./**/*.wesl"]), &["**/test"], ""), some);
        assert_eq!(
            listed(Some(&["deep"]), &["*.frag", "test"], ""),
            ["deep/d.wesl", "deep/test/c.wesl"]
        );
        assert_eq!(listed(Some(&["?ther.wgsl"]), &["**/*.frag"], ""), ["other.wgsl"]);
    }
}
