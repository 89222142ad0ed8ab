//! The content of the library: its modules, functions and plots, and a search over them.

use std::collections::BTreeMap;

use lamplight::LIBRARY_FILES;
use lamplight::parse::words::has_word;
use lamplight::project::LIBRARY;
use lamplight::source::{self, Files as _, Package, SourceSet};
use lamplight_catalogue::plot::{self, Plot};
use lamplight_catalogue::{self as catalogue, CatalogueItem, CatalogueItemKind};
use lamplight_check::references;
use serde::Serialize;
use tsify::Tsify;
use wasm_bindgen::prelude::wasm_bindgen;

use crate::{Answer, answer};

/// The library.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct LibraryInfo {
    pub modules: Vec<ModuleInfo>,
}

/// A module.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct ModuleInfo {
    /// `lighting::spot`.
    pub path: String,
    pub doc: Vec<String>,
    pub items: Vec<ItemInfo>,
}

/// A function, a structure or a constant.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct ItemInfo {
    /// `function`, `struct` or `constant`.
    pub kind: String,
    pub name: String,
    pub path: String,
    pub summary: String,
    pub doc: Vec<String>,
    /// Declarations without bodies.
    pub wesl: String,
    pub glsl: Option<String>,
    pub members: Vec<MemberInfo>,
    pub result: Option<String>,
    /// Where the formula was published.
    pub source: Option<String>,
    pub edges: Option<String>,
    pub error_model: Option<String>,
    /// What to write to use it.
    pub import: String,
    pub include: String,
    pub plot: Option<PlotInfo>,
    /// Whether [`reference`](crate::number::reference) knows it.
    pub has_reference: bool,
}

/// A parameter or a field.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct MemberInfo {
    pub name: String,
    #[serde(rename = "type")]
    pub ty: String,
    pub doc: String,
}

/// What a plot shows.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct PlotInfo {
    pub value: String,
    pub label: String,
    pub from: f64,
    pub to: f64,
    /// `numbers`, `degrees`, or `integers`, between which there is nothing.
    pub unit: String,
    /// The bounds of the vertical axis, where they are fixed.
    pub low: Option<f64>,
    pub high: Option<f64>,
    pub parameter: Option<String>,
    pub values: Vec<f64>,
    pub note: String,
}

/// Every module of the library.
#[wasm_bindgen]
pub fn library() -> Answer<LibraryInfo> {
    let modules = catalogue::library_modules(LIBRARY_FILES).into_iter().map(|module| {
        let plots = plots(&module.path);
        let items = module.items.iter().map(|item| info(item, plots.get(&item.name)));
        ModuleInfo { items: items.collect(), path: module.path.clone(), doc: module.doc.clone() }
    });
    answer(&LibraryInfo { modules: modules.collect() })
}

/// The plots of a module. The library's own files have no errors.
fn plots(module: &str) -> plot::Plots {
    let mut sources = SourceSet::default();
    let package = Package { name: LIBRARY.to_owned(), files: Box::new(LIBRARY_FILES) };
    match source::read(&mut sources, &package, &plot::plot_path(module)) {
        Ok(Some(id)) => plot::parse_plots(&sources, id).unwrap_or_default(),
        _ => plot::Plots::new(),
    }
}

fn info(item: &CatalogueItem, plot: Option<&Plot>) -> ItemInfo {
    let member = |member: &catalogue::CatalogueMember| MemberInfo {
        name: member.name.clone(),
        ty: member.ty.clone(),
        doc: member.doc.clone(),
    };
    ItemInfo {
        kind: item.kind.name().to_owned(),
        name: item.name.clone(),
        path: item.path(),
        summary: item.summary().to_owned(),
        doc: item.paragraphs(),
        wesl: item.wesl.clone(),
        glsl: item.glsl.clone(),
        members: item.members.iter().map(member).collect(),
        result: item.result.clone(),
        source: item.section("Source"),
        edges: item.section("Edges"),
        error_model: item.section("Error model"),
        import: item.import(),
        include: item.include(),
        plot: plot.map(plotted),
        has_reference: item.kind == CatalogueItemKind::Function
            && references::find_reference(&item.module, &item.name).is_some(),
    }
}

fn plotted(plot: &Plot) -> PlotInfo {
    PlotInfo {
        value: plot.value.clone(),
        label: plot.x.label.clone(),
        from: plot.x.from,
        to: plot.x.to,
        unit: plot.x.unit.name().to_owned(),
        low: plot.y.map(|range| range.from),
        high: plot.y.map(|range| range.to),
        parameter: plot.curves.as_ref().map(|curves| curves.name.clone()),
        values: plot.curves.as_ref().map(|curves| curves.values.clone()).unwrap_or_default(),
        note: plot.note.clone().unwrap_or_default(),
    }
}

/// Paths of the library's files with one of the endings.
#[wasm_bindgen]
pub fn files(endings: Vec<String>) -> Vec<String> {
    LIBRARY_FILES.list(&endings.iter().map(String::as_str).collect::<Vec<_>>())
}

/// The text of a file of the library.
#[wasm_bindgen]
pub fn file(path: &str) -> Option<String> {
    LIBRARY_FILES.read(path).ok().flatten()
}

/// A function's text, and the files that use it.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct Written {
    pub wesl: String,
    pub glsl: String,
    /// Files of the library that name it.
    pub used_by: Vec<String>,
}

/// The text of an item in both languages.
#[wasm_bindgen]
pub fn written(path: &str) -> Answer<Written> {
    let (module, name) = path.rsplit_once("::").unwrap_or(("", path));
    let stem = module.replace("::", "/");
    let text = |ending: &str| {
        let found = file(&format!("{stem}.{ending}")).unwrap_or_default();
        declaration(&found, name).unwrap_or_default()
    };
    let last = module.rsplit("::").next().unwrap_or(module);
    let is_user = |text: &str| has_word(text, name) && has_word(text, last);
    let own = format!("{stem}.wesl");
    let others = LIBRARY_FILES.list(&["wesl"]).into_iter().filter(|path| *path != own);
    let used_by =
        others.filter(|path| file(path).is_some_and(|text| is_user(&code(&text)))).collect();
    answer(&Written { wesl: text("wesl"), glsl: text("glsl"), used_by })
}

/// A text without its comments, since comments may name things that the code does not use.
fn code(text: &str) -> String {
    text.lines().filter_map(|line| line.split("//").next()).collect::<Vec<_>>().join("\n")
}

/// The declaration that starts at the beginning of a line, with its comment.
fn declaration(text: &str, name: &str) -> Option<String> {
    let lines: Vec<&str> = text.lines().collect();
    let declares = |line: &str| {
        let head = line.split(['(', '{', '=', ':']).next().unwrap_or_default();
        !line.starts_with([' ', '/', '#', '}', '@'])
            && !line.starts_with("import")
            && head.split_whitespace().next_back() == Some(name)
    };
    let start = lines.iter().position(|line| declares(line))?;
    let commented =
        lines[..start].iter().rev().take_while(|line| line.starts_with(['/', '@'])).count();
    let length = lines[start..]
        .iter()
        .position(|line| line.starts_with('}') || (line.ends_with(';') && !line.starts_with(' ')));
    let end = start + length.unwrap_or(lines.len() - start - 1);
    Some(lines[start - commented..=end].join("\n"))
}

/// What a search found.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct SearchResult {
    pub hits: Vec<Hit>,
}

/// An item; the best come first.
#[derive(Serialize, Tsify)]
#[serde(rename_all = "camelCase")]
pub struct Hit {
    pub path: String,
    pub score: f64,
}

/// Items that have all words in their name, formula, documentation or source. Techniques and
/// authors are named there.
#[wasm_bindgen]
pub fn search(query: &str) -> Answer<SearchResult> {
    let words: Vec<String> = query.split_whitespace().map(str::to_lowercase).collect();
    let mut hits = Vec::new();
    if words.is_empty() {
        return answer(&SearchResult { hits });
    }
    let mut texts = BTreeMap::new();
    for item in catalogue::library_modules(LIBRARY_FILES).iter().flat_map(|module| &module.items) {
        let stem = item.module.replace("::", "/");
        let text = texts
            .entry(item.module.clone())
            .or_insert_with(|| file(&format!("{stem}.wesl")).unwrap_or_default());
        let formula = declaration(text, &item.name).unwrap_or_default().to_lowercase();
        let (name, path) = (item.name.to_lowercase(), item.path().to_lowercase());
        let (summary, doc) = (item.summary().to_lowercase(), item.doc.join(" ").to_lowercase());
        let places = [(&path, 8.0), (&summary, 4.0), (&doc, 2.0), (&formula, 1.0)];
        let of = |word: &String| {
            let exact = if name == *word { 16.0 } else { 0.0 };
            exact
                + places
                    .iter()
                    .filter(|(text, _)| text.contains(word.as_str()))
                    .map(|(_, score)| score)
                    .sum::<f64>()
        };
        let scores: Vec<f64> = words.iter().map(of).collect();
        if scores.iter().all(|score| *score > 0.0) {
            hits.push(Hit { path: item.path(), score: scores.iter().sum() });
        }
    }
    hits.sort_by(|one, other| other.score.total_cmp(&one.score).then(one.path.cmp(&other.path)));
    answer(&SearchResult { hits })
}
