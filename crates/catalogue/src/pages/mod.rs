//! Writes the catalogue as Markdown: an index, a page for each module, one for programs, one for
//! presets. The page of costs is in [`cost`].

pub mod cost;

use crate::cost::Costs;
use crate::figure::{Figures, Kinds};
use crate::preset::Preset;
use crate::probe::{ORDER, Probe};
use crate::quality::Measured;
use crate::{CatalogueItem, CatalogueItemKind, CatalogueModule, SECTIONS};
use lamplight_permute::{Axis, Manifest, Program};
use lamplight_scenes::sets;
use std::collections::BTreeMap;
use std::fmt::Write as _;

pub struct DrawnPlot {
    pub svg: String,
    /// What is drawn, as Markdown.
    pub caption: String,
}

/// What the catalogue shows.
pub struct CatalogueContents<'c> {
    pub modules: &'c [CatalogueModule],
    /// By the path of the function: `lighting::spot::cone_hard`.
    pub plots: &'c BTreeMap<String, DrawnPlot>,
    pub kinds: &'c Kinds,
    /// By the path of the function; the pictures are drawn apart.
    pub figures: &'c Figures,
    pub manifest: &'c Manifest,
    pub presets: &'c [Preset],
    pub probes: &'c [Probe],
    pub costs: &'c Costs,
    pub quality: &'c [Measured],
}

/// The files of the catalogue: path below its folder and text.
pub fn catalogue_pages(contents: &CatalogueContents) -> BTreeMap<String, String> {
    let mut files = BTreeMap::from([
        ("README.md".to_owned(), index_page(contents)),
        ("programs.md".to_owned(), program_page(contents.manifest, contents.costs)),
        (
            "costs.md".to_owned(),
            cost::cost_page(contents.modules, contents.costs, contents.quality),
        ),
        ("presets.md".to_owned(), preset_page(contents.presets, contents.probes)),
    ]);
    for module in contents.modules {
        files.insert(page_of(&module.path), module_page(module, contents));
    }
    for (path, plot) in contents.plots {
        files.insert(format!("{}.svg", path.replace("::", "/")), plot.svg.clone());
    }
    for measured in contents.quality {
        if let Some(svg) = cost::quality_picture(measured, contents.costs) {
            files.insert(cost::picture_path(measured), svg);
        }
    }
    files
}

/// Page of a module below the catalogue's folder.
fn page_of(module: &str) -> String {
    format!("{}.md", module.replace("::", "/"))
}

const INDEX: &str = "\
# Catalogue

Every module exists in WESL and in GLSL with the same functions, parameters and results. Import a
function in WESL, include its module in GLSL:

```wgsl
import lamplight::brdf::specular::blinn_phong;
```

```glsl
#include <lamplight/brdf/specular.glsl>
```

Vectors named `n`, `l`, `v` and `h` are unit vectors. `l` and `v` point away from the surface.
Colours are linear.
Visibility is a factor from 0 to 1, where 1 is fully lit. Attenuation is a factor of at least 0.
Depth is from 0 to 1, from near to far.

There are also pages of the [programs](programs.md) with their axes, of the [presets](presets.md),
one for each published example, and of the [costs](costs.md) of functions on GPUs, with pictures of
cost against quality. [The published listings](../published.md) says of each listing that it is drawn
as printed, and how far its safe form is away.

`cargo xtask docs` generates this catalogue from the library.
";

fn index_page(contents: &CatalogueContents) -> String {
    let mut text = INDEX.to_owned();
    let mut folder = "";
    for module in contents.modules {
        let (here, _) = module.path.split_once("::").unwrap_or((&module.path, ""));
        if here != folder {
            let _ = writeln!(text, "\n## {here}\n\n| module | functions | |\n|---|---|---|");
            folder = here;
        }
        let link = format!("[`{}`]({})", module.path, page_of(&module.path));
        let functions = module.items.iter().filter(|item| item.kind == CatalogueItemKind::Function);
        let names: Vec<String> = functions
            .map(|item| {
                format!("[{}]({}#{})", escaped_prose(&item.name), page_of(&module.path), item.name)
            })
            .collect();
        let _ =
            writeln!(text, "| {link} | {} | {} |", names.join(", "), table_cell(module.summary()));
    }
    text
}

/// The sections that are printed as paragraphs. The parameters are a table.
const PARAGRAPHS: std::ops::RangeFrom<usize> = 1..;

/// The page: the module's comment, a table of contents, every item.
fn module_page(module: &CatalogueModule, contents: &CatalogueContents) -> String {
    let mut text = format!("# {}\n", module.path);
    for paragraph in &module.doc {
        let _ = write!(text, "\n{}\n", escaped_prose(paragraph));
    }
    if let Some(item) = module.items.first() {
        let import = format!("import lamplight::{}::{{..}};", module.path);
        let _ =
            write!(text, "\n| WESL | GLSL |\n|---|---|\n| `{import}` | `{}` |\n", item.include());
    }
    write_contents(&mut text, module);
    for item in &module.items {
        write_item(&mut text, item, contents);
        cost::of_function(&mut text, item, contents.costs);
    }
    let up = "../".repeat(module.path.matches("::").count());
    let _ = write!(text, "\n---\n[Catalogue]({up}README.md)\n");
    text
}

fn write_contents(text: &mut String, module: &CatalogueModule) {
    text.push_str("\n| | |\n|---|---|\n");
    for item in &module.items {
        let kind = if item.kind == CatalogueItemKind::Function {
            String::new()
        } else {
            format!("{} ", item.kind.name())
        };
        let _ = writeln!(
            text,
            "| {kind}[`{}`](#{}) | {} |",
            item.name,
            item.name.to_lowercase(),
            table_cell(item.summary())
        );
    }
}

fn write_item(text: &mut String, item: &CatalogueItem, contents: &CatalogueContents) {
    let _ = write!(text, "\n## {}\n", escaped_prose(&item.name));
    for paragraph in item.paragraphs() {
        let _ = write!(text, "\n{}\n", escaped_prose(&paragraph));
    }
    let _ = write!(text, "\n{}", code_block("wgsl", &item.wesl));
    if let Some(glsl) = &item.glsl {
        let _ = write!(text, "\n{}", code_block("glsl", glsl));
    }
    write_pictures(text, item, contents);
    write_members(text, item);
    for section in &SECTIONS[PARAGRAPHS] {
        if let Some(words) = item.section(section) {
            let _ = write!(text, "\n**{section}.** {}\n", escaped_prose(&words));
        }
    }
}

/// The plot and the figure, each with what it shows.
fn write_pictures(text: &mut String, item: &CatalogueItem, contents: &CatalogueContents) {
    let (name, path) = (&item.name, item.path());
    let (_, module) = item.module.rsplit_once("::").unwrap_or(("", &item.module));
    if let Some(plot) = contents.plots.get(&path) {
        let caption = &plot.caption;
        let _ = write!(text, "\n![{name} plotted]({module}/{name}.svg)\n\nPlotted: {caption}\n");
    }
    let Some(figure) = contents.figures.get(&path) else { return };
    if let Some(reason) = &figure.none {
        let _ = write!(text, "\nNo picture: {}.\n", escaped_prose(reason));
    } else {
        let caption = figure.caption(contents.kinds);
        let _ = write!(text, "\n![{name} drawn]({module}/{name}.png)\n\n{caption}\n");
    }
}

fn write_members(text: &mut String, item: &CatalogueItem) {
    if item.members.is_empty() {
        return;
    }
    let heading = if item.kind == CatalogueItemKind::Struct { "field" } else { "parameter" };
    let _ = write!(text, "\n| {heading} | type | |\n|---|---|---|\n");
    for member in &item.members {
        let _ =
            writeln!(text, "| `{}` | `{}` | {} |", member.name, member.ty, table_cell(&member.doc));
    }
}

fn program_page(manifest: &Manifest, costs: &Costs) -> String {
    let mut text = "# Programs\n\nThe programs of the library have entry points in both languages. Axes multiply the permutations of a\n\
                    program, and constraints exclude some. `shaderlib/lamplight.toml` lists those that ship.\n"
        .to_owned();
    for program in &manifest.programs {
        write_program(&mut text, program, costs);
    }
    text.push_str("\n---\n[Catalogue](README.md)\n");
    text
}

fn write_program(text: &mut String, program: &Program, costs: &Costs) {
    let _ = write!(text, "\n## {}\n", escaped_prose(&program.name));
    if let Some(doc) = &program.doc {
        let _ = write!(text, "\n{}\n", escaped_prose(doc));
    }
    let files: Vec<String> = program.files().map(|file| format!("`{}`", file.path)).collect();
    let targets: Vec<&str> = program.targets.iter().map(|target| target.name()).collect();
    let space = &program.space;
    let _ = write!(
        text,
        "\n| | |\n|---|---|\n| files | {} |\n| targets | {} |\n",
        files.join(", "),
        targets.join(", ")
    );
    let _ = write!(
        text,
        "| full product | {} |\n| valid | {} |\n| shipped | {} |\n",
        space.full_count(),
        space.valid_count(),
        space.count()
    );
    write_axes(text, space.axes());
    cost::of_program(text, &program.name, costs);
    for (index, constraint) in space.constraints().iter().enumerate() {
        let start = if index == 0 { "\nConstraints:\n\n" } else { "" };
        let doc = constraint
            .doc
            .as_ref()
            .map_or(String::new(), |doc| format!("  \n  {}", escaped_prose(doc)));
        let _ = writeln!(text, "{start}- `{}`{doc}", constraint.text);
    }
}

fn write_axes(text: &mut String, axes: &[Axis]) {
    if axes.is_empty() {
        return;
    }
    text.push_str("\n| axis | values | mode | |\n|---|---|---|---|\n");
    for axis in axes {
        let value = |(ordinal, name): (usize, String)| {
            if ordinal == axis.default { format!("**`{name}`**") } else { format!("`{name}`") }
        };
        let values: Vec<String> = axis.value_names().into_iter().enumerate().map(value).collect();
        let doc = axis.doc.as_deref().unwrap_or_default();
        let _ = writeln!(
            text,
            "| `{}` | {} | {} | {} |",
            axis.name,
            values.join(", "),
            axis.mode.name(),
            table_cell(doc)
        );
    }
    text.push_str("\nThe default of each axis is bold.\n");
}

/// The page: presets, scenes, light probes.
fn preset_page(presets: &[Preset], probes: &[Probe]) -> String {
    let mut text = "# Presets\n\nEach published example is a preset. Its numbers are those that the source gives, under the names of the\n\
                    uniforms' fields. The scene chooses the values that the source leaves open: `lamplight show PRESET` lists these.\n"
        .to_owned();
    let mut work = "";
    for preset in presets {
        let (here, place) = work_and_place(preset);
        if here != work {
            let _ = write!(
                text,
                "\n## {}\n\n| preset | place | permutation | scene | numbers | |\n|---|---|---|---|---|---|\n",
                escaped_prose(here)
            );
            work = here;
        }
        write_row(&mut text, preset, place);
    }
    text.push_str("\n## Scenes\n\n| scene | what it is |\n|---|---|\n");
    for set in sets::ALL {
        let _ = writeln!(text, "| `{}` | {} |", set.name, set.about);
    }
    light_probes(&mut text, probes);
    text.push_str("\n---\n[Catalogue](README.md)\n");
    text
}

/// The work, and the place in it.
fn work_and_place(preset: &Preset) -> (&str, &str) {
    let source = preset.source.as_str();
    if !source.starts_with(preset.work()) {
        return (preset.work(), source);
    }
    let (here, place) = source
        .split_once(", example")
        .map_or((source, ""), |(here, _)| (here, &source[here.len() + 2..]));
    here.split_once(", chapter 4, ").unwrap_or((here, place))
}

fn write_row(text: &mut String, preset: &Preset, place: &str) {
    let passes = preset
        .passes
        .iter()
        .map(|pass| format!("`{}:{}`, then ", pass.program, pass.key))
        .collect::<String>();
    let numbers = preset.numbers.iter().flat_map(|(group, fields)| {
        fields.iter().map(move |(name, value)| format!("`{group}.{name}` = {value}"))
    });
    let probe = preset.probe.iter().map(|probe| format!("probe `{probe}`"));
    let numbers: Vec<String> = numbers.chain(probe).collect();
    let _ = writeln!(
        text,
        "| `{}` | {} | {passes}`{}:{}` | `{}` | {} | {} |",
        preset.name,
        table_cell(place),
        preset.program,
        preset.key,
        preset.scene,
        numbers.join("<br>"),
        table_cell(&preset_description(preset)),
    );
}

/// What a preset shows, and how that differs from the example.
fn preset_description(preset: &Preset) -> String {
    let deviations = preset.deviations.iter().map(String::as_str);
    let sentences: Vec<&str> = std::iter::once(preset.doc.as_str()).chain(deviations).collect();
    sentences.join(" ")
}

fn light_probes(text: &mut String, probes: &[Probe]) {
    let _ = write!(
        text,
        "\n## Light probes\n\nEach probe has nine coefficients in the order {}. In shaders, [`ambient::probes`](ambient/probes.md) has a function\n\
         for each probe. In Rust, `lamplight::catalogue::probe::library_probes(..)` returns them.\n\n| probe | place | L00 |\n|---|---|---|\n",
        ORDER.join(", ")
    );
    for probe in probes {
        let [r, g, b] = probe.coefficients[0];
        let _ =
            writeln!(text, "| `{}` | {} | {r}, {g}, {b} |", probe.name, table_cell(&probe.title));
    }
}

/// The text, with everything outside of backticks escaped.
fn escaped_prose(text: &str) -> String {
    let parts = text
        .split('`')
        .enumerate()
        .map(|(index, part)| if index % 2 == 0 { escape_markdown(part) } else { part.to_owned() });
    parts.collect::<Vec<_>>().join("`")
}

/// The same for a cell of a table, where a bar ends the cell even within backticks.
pub fn table_cell(text: &str) -> String {
    escaped_prose(text).replace('|', "\\|")
}

fn code_block(language: &str, code: &str) -> String {
    format!("```{language}\n{code}\n```\n")
}

fn escape_markdown(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in text.chars() {
        if "*_<[".contains(letter) {
            out.push('\\');
        }
        out.push(letter);
    }
    out
}
