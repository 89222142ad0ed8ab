//! Which page of the guide explains what a diagnostic is about.
//!
//! The pages are in `docs/guide/`. Messages name a page by its title, which a reader finds in the
//! book, on a forge and in a search.

use super::{Code, codes};

/// A page of the guide that explains diagnostics.
#[derive(Debug)]
pub struct GuidePage {
    /// Its first heading.
    pub title: &'static str,
    /// Name of its file, without the folder.
    pub file: &'static str,
}

impl GuidePage {
    /// The codes that it explains, by name: each says so in its own file.
    pub fn codes(&self) -> impl Iterator<Item = &'static Code> {
        let stem = self.file.trim_end_matches(".md");
        codes::ALL.iter().copied().filter(move |code| code.page == stem)
    }
}

/// The page that explains a code. Every code has one.
pub fn page_of(code: &Code) -> Option<&'static GuidePage> {
    PAGES.iter().find(|page| page.file.trim_end_matches(".md") == code.page)
}

/// Pages with codes, in the order of the guide.
pub const PAGES: &[GuidePage] = &[
    GuidePage { title: "A picture of your shader", file: "render.md" },
    GuidePage { title: "A package of your own", file: "package.md" },
    GuidePage { title: "Formatting shaders", file: "formatting.md" },
    GuidePage { title: "Axes, constraints and the manifest", file: "manifest.md" },
    GuidePage { title: "Conditions and constants", file: "conditions.md" },
    GuidePage { title: "GLSL", file: "glsl.md" },
    GuidePage { title: "From naga_oil", file: "migrate.md" },
    GuidePage { title: "Numeric cases", file: "cases.md" },
    GuidePage { title: "The report of a check", file: "report.md" },
    GuidePage { title: "Values of older versions", file: "values.md" },
    GuidePage { title: "Bundles", file: "bundles.md" },
    GuidePage { title: "Conventions of each target", file: "targets.md" },
    GuidePage { title: "Limits and what each protects", file: "limits.md" },
    GuidePage { title: "Troubleshooting by diagnostic", file: "troubleshooting.md" },
];
