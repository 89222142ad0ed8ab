//! What the shader library offers, read from its modules: names, signatures, documentation.

mod outline;

use crate::source::{Embedded, Files};

/// Folders of the library that hold programs, not modules.
const PROGRAMS: &str = "programs/";

/// What an item is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Function,
    Struct,
}

/// A public function or struct of a module.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Item {
    pub kind: Kind,
    /// Module path below the package, `::` between its parts.
    pub module: String,
    pub name: String,
    /// Lines of the doc comment, without their marks.
    pub doc: Vec<String>,
    /// Declaration in WESL, without its body.
    pub wesl: String,
    /// Declaration in GLSL, without its body; `None` where the twin lacks it.
    pub glsl: Option<String>,
}

impl Item {
    /// Path below the package: `lighting::spot::cone_hard`.
    pub fn path(&self) -> String {
        format!("{}::{}", self.module, self.name)
    }

    /// The first line of the documentation.
    pub fn summary(&self) -> &str {
        self.doc.iter().map(String::as_str).find(|line| !line.is_empty()).unwrap_or_default()
    }

    /// The paragraph that begins with `NAME:`, without that word.
    pub fn section(&self, name: &str) -> Option<String> {
        let start = self.doc.iter().position(|line| line.strip_prefix(name).is_some_and(|rest| rest.starts_with(':')))?;
        let rest = self.doc[start + 1..].iter().take_while(|line| !line.is_empty() && !is_heading(line));
        let first = self.doc[start][name.len() + 1..].trim();
        Some(std::iter::once(first).chain(rest.map(|line| line.trim())).collect::<Vec<_>>().join(" ").trim().to_owned())
    }
}

/// The headings of a doc comment, in their order.
pub const SECTIONS: &[&str] = &["Parameters", "Returns", "Source", "Edges", "Error model"];

fn is_heading(line: &str) -> bool {
    SECTIONS.iter().any(|section| line.strip_prefix(section).is_some_and(|rest| rest.starts_with(':')))
}

/// A module of the library.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Module {
    /// Path below the package, `::` between its parts.
    pub path: String,
    /// First line of the module's own comment.
    pub summary: String,
    pub items: Vec<Item>,
}

/// Every module of the embedded library, by path.
pub fn library() -> Vec<Module> {
    modules(&Embedded)
}

/// Every module of a package that has the library's layout.
pub fn modules(files: &dyn Files) -> Vec<Module> {
    let paths = files.list(&["wesl"]).into_iter().filter(|path| !path.starts_with(PROGRAMS));
    paths.filter_map(|path| module(files, path.strip_suffix(".wesl")?)).collect()
}

fn module(files: &dyn Files, stem: &str) -> Option<Module> {
    let text = files.read(&format!("{stem}.wesl")).ok()??;
    let twin = files.read(&format!("{stem}.glsl")).ok().flatten().unwrap_or_default();
    let path = stem.replace('/', "::");
    let glsl = outline::glsl(&twin);
    let items = outline::wesl(&text).into_iter().map(|found| Item {
        kind: found.kind,
        module: path.clone(),
        glsl: glsl.iter().find(|twin| twin.name == found.name).map(|twin| twin.declaration.clone()),
        name: found.name,
        doc: found.doc,
        wesl: found.declaration,
    });
    Some(Module { summary: outline::module_summary(&text), items: items.collect(), path })
}
