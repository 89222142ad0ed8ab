//! Which page of the guide explains what a diagnostic is about.
//!
//! The pages are in `docs/guide/`. Messages name a page by its title, which a reader finds in the
//! book, on a forge and in a search.

use super::{Code, codes};

/// A page of the guide that explains diagnostics.
#[derive(Debug)]
pub struct Page {
    /// Its first heading.
    pub title: &'static str,
    /// Name of its file, without the folder.
    pub file: &'static str,
}

impl Page {
    /// The codes that it explains, by name: each says so in its own file.
    pub fn codes(&self) -> impl Iterator<Item = &'static Code> {
        let stem = self.file.trim_end_matches(".md");
        codes::ALL.iter().copied().filter(move |code| code.page == stem)
    }
}

/// The page that explains a code. Every code has one.
pub fn page_of(code: &Code) -> Option<&'static Page> {
    PAGES.iter().find(|page| page.file.trim_end_matches(".md") == code.page)
}

/// Pages with codes, in the order of the guide.
pub const PAGES: &[Page] = &[
    Page { title: "A package of your own", file: "package.md" },
    Page { title: "Axes, constraints and the manifest", file: "manifest.md" },
    Page { title: "Conditions and constants", file: "conditions.md" },
    Page { title: "GLSL", file: "glsl.md" },
    Page { title: "From naga_oil", file: "migrate.md" },
    Page { title: "Numeric cases", file: "cases.md" },
    Page { title: "The report of a check", file: "report.md" },
    Page { title: "Bundles", file: "bundles.md" },
    Page { title: "Conventions of each target", file: "targets.md" },
    Page { title: "Limits and what each protects", file: "limits.md" },
    Page { title: "Troubleshooting by diagnostic", file: "troubleshooting.md" },
];
