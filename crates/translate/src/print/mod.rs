//! Writes a tree as GLSL for Vulkan, with separate textures and samplers, or as HLSL or MSL. `#if`
//! stands in the place of conditions.

mod condition;
mod counter;
mod dialect;
mod expression;
mod facts;
mod function;
mod header;
mod hlsl;
mod item;
mod lines;
mod macros;
mod meeting;
mod method;
mod msl;
mod names;
mod operator;
mod order;
mod outputs;
mod place;
mod range;
mod rename;
mod stage;
mod statement;
mod texture;
mod uses;
mod visit;
mod words;

use std::collections::BTreeMap;

use lamplight_diagnostic::{Diagnostic, Diagnostics};

use crate::condition::Condition;
use crate::tree::{Field, Item, ItemPath, Line, Module, Node, Stage, Structure, Type};
use crate::types::Globals;
use condition::{chains_of, condition_text, directive};
pub use dialect::Dialect;
use facts::Facts;
use item::ItemWriter;
use lines::Indented;
use meeting::{AllPlaces, check_meetings};
use names::Names;
use place::{Part, Places, exports_of, is_short, place_items, samplers_of};
use stage::{Direction, Variables, declared_fields};
use uses::item_uses;

/// How files are written.
#[derive(Debug, Clone, Copy)]
pub struct Style<'a> {
    pub dialect: Dialect,
    /// The command that makes the files, for their heads. Without one they have none.
    pub command: Option<&'a str>,
    /// The beginning of the macros that guard files against a second inclusion. If it is empty,
    /// nothing includes the files.
    pub guard: &'a str,
    /// The file, without its ending, with the macros for textures and samplers as parameters.
    pub sampling: Option<&'a str>,
    /// The file, without its ending, that gives all names a prefix, and the folders whose modules
    /// are without it.
    pub prefix: Option<(&'a str, &'a [&'a str])>,
}

/// How this project's library is written.
pub const LIBRARY_STYLE: Style<'static> = Style {
    dialect: Dialect::Glsl,
    command: Some("cargo xtask docs"),
    guard: "LAMPLIGHT",
    sampling: Some("filter/sampling"),
    prefix: Some(("prefix", &["programs"])),
};

/// A file that was made.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MadeFile {
    /// Below the root of the package.
    pub path: String,
    pub text: String,
}

/// Writes modules that were checked together.
pub fn print_modules(
    modules: &[Module],
    globals: &Globals,
    style: &Style<'_>,
) -> Result<Vec<MadeFile>, Diagnostics> {
    let macros = macros::macros_of(modules);
    let facts = Facts::of(modules, globals);
    let names = Names::of(modules, macros.keys(), style.dialect);
    let exports = exports_of(modules);
    let printer = Printer { globals, facts: &facts, names: &names, style };
    let mut files = Vec::new();
    let mut errors = macros::check_names(modules, &macros);
    let mut places = AllPlaces::new();
    for module in modules {
        match place_items(module, &facts, &exports) {
            Ok(found) => drop(places.insert(module.path.clone(), found)),
            Err(error) => errors.push(error),
        }
    }
    errors.extend(check_meetings(&places, &names));
    for module in modules {
        let Some(places) = places.get(&module.path) else { continue };
        match printer.module(module, places) {
            Ok(made) => files.extend(made),
            Err(found) => errors.extend(found),
        }
    }
    if errors.is_empty() { Ok(files) } else { Err(errors) }
}

#[derive(Clone, Copy)]
struct Printer<'a> {
    globals: &'a Globals,
    facts: &'a Facts,
    names: &'a Names,
    style: &'a Style<'a>,
}

impl Printer<'_> {
    fn module(&self, module: &Module, places: &Places) -> Result<Vec<MadeFile>, Diagnostics> {
        let samplers = samplers_of(module, self.globals);
        let structures = structures_of(module);
        let writer = ItemWriter {
            globals: self.globals,
            facts: self.facts,
            names: self.names,
            stage: None,
            variables: &[],
            module: &module.path,
            has_macros: self.style.sampling.is_some(),
            samplers: &samplers,
            structures: &structures,
        };
        let has_shared = places.parts.contains_key(&Part::Shared);
        let has_stages = places.parts.keys().any(|part| *part != Part::Shared);
        let mut files = Vec::new();
        let mut errors = Vec::new();
        for (part, items) in &places.parts {
            let dialect = self.style.dialect;
            let file = FilePart { dialect, module, part: *part, items, has_shared, has_stages };
            let text = match part {
                Part::Shared => self.shared(&file, &writer),
                Part::Stage(stage) => self.stage(&file, *stage, &writer),
            };
            match text {
                Ok(text) => files.push(MadeFile { path: file.path(), text }),
                Err(found) => errors.extend(found),
            }
        }
        if errors.is_empty() { Ok(files) } else { Err(errors) }
    }

    /// A file that others include.
    fn shared(&self, file: &FilePart<'_>, writer: &ItemWriter<'_>) -> Result<String, Diagnostics> {
        let guard = self.guard(&file.module.path);
        let mut out = Indented::default();
        self.head(file, &mut out);
        let is_guarded = !self.style.guard.is_empty();
        if is_guarded {
            out.blank();
            out.line(&format!("#ifndef {guard}"));
            out.line(&format!("#define {guard}"));
        }
        self.includes(file, &mut out);
        self.declarations(file, &mut out).map_err(|error| vec![error])?;
        let prefix = self.prefix(&file.module.path);
        if let Some(path) = &prefix {
            out.blank();
            out.raw(&format!("#ifdef LAMPLIGHT_PREFIX\n#include \"{path}\"\n#endif\n"));
        }
        out.blank();
        write_items(file.items, writer, &mut out)?;
        if !file.module.end.is_empty() {
            out.blank();
            file.module.end.iter().for_each(|line| item::write_line(line, &mut out));
        }
        if let Some(path) = &prefix {
            out.blank();
            out.raw(&format!("#ifdef LAMPLIGHT_PREFIX\n#include \"{path}\"\n#endif\n"));
        }
        if is_guarded {
            out.blank();
            out.line("#endif");
        }
        Ok(out.text.trim_start_matches('\n').to_owned())
    }

    /// What a file in HLSL or MSL has before its items.
    fn declarations(&self, file: &FilePart<'_>, out: &mut Indented) -> Result<(), Diagnostic> {
        match self.style.dialect {
            Dialect::Glsl => {}
            Dialect::Msl => {
                out.blank();
                out.line("using namespace metal;");
            }
            Dialect::Hlsl => {
                let mut texts = hlsl::array_types(file.items, self.names)?
                    .into_iter()
                    .map(|(name, text)| (name.to_uppercase(), text + "\n"))
                    .collect::<BTreeMap<String, String>>();
                texts.extend(texture::size_functions(file.items)?);
                for (guard, text) in texts {
                    out.blank();
                    out.raw(&format!("#ifndef {guard}\n#define {guard}\n{text}#endif\n"));
                }
            }
        }
        Ok(())
    }

    /// A stage of a program.
    fn stage(
        &self,
        file: &FilePart<'_>,
        stage: Stage,
        writer: &ItemWriter<'_>,
    ) -> Result<String, Diagnostics> {
        let mut out = Indented::default();
        out.line("#version 450");
        self.head(file, &mut out);
        self.includes(file, &mut out);
        let entries: Vec<&Node<Item>> = file
            .items
            .iter()
            .filter(|node| matches!(&node.body, Item::Function(one) if one.stage.is_some()))
            .collect();
        let [entry] = entries.as_slice() else {
            let span = entries.last().map_or(file.items[0].span, |node| node.span);
            let what = "a second entry point of a stage";
            return Err(vec![crate::wesl::untranslated(span, what)]);
        };
        let mut variables = Vec::new();
        if let Item::Function(function) = &entry.body {
            variables = self.interface(function, stage, &mut out).map_err(|error| vec![error])?;
        }
        let writer = &ItemWriter { stage: Some(stage), variables: &variables, ..*writer };
        let others: Vec<Node<Item>> =
            file.items.iter().filter(|node| !std::ptr::eq(*node, *entry)).cloned().collect();
        if !others.is_empty() {
            out.blank();
            write_items(&others, writer, &mut out)?;
        }
        out.blank();
        write_items(std::slice::from_ref(*entry), writer, &mut out)?;
        if !file.has_shared && !file.module.end.is_empty() {
            out.blank();
            file.module.end.iter().for_each(|line| item::write_line(line, &mut out));
        }
        Ok(out.text)
    }

    fn interface(
        &self,
        function: &crate::tree::Function,
        stage: Stage,
        out: &mut Indented,
    ) -> Result<Vec<String>, Diagnostic> {
        if stage == Stage::Compute {
            let writer = function.workgroup.iter().map(expression::Writer::literal);
            let sizes: Option<Vec<i64>> = writer.collect();
            let sizes = sizes.ok_or_else(|| {
                crate::wesl::untranslated(function.span, "a size of a workgroup that is computed")
            })?;
            let names = ["x", "y", "z"].iter().zip(sizes);
            let words: Vec<String> =
                names.map(|(name, size)| format!("local_size_{name} = {size}")).collect();
            out.blank();
            out.line(&format!("layout({}) in;", words.join(", ")));
        }
        let mut found: Vec<(String, Condition)> = Vec::new();
        for direction in [Direction::In, Direction::Out] {
            let variables = Variables { stage, direction, names: self.names };
            let fields = declared_fields(function, self.facts, direction);
            if fields.is_empty() {
                continue;
            }
            for (node, condition) in fields.iter().zip(crate::tree::whole_conditions(&fields)) {
                let Field { name, binding, span, ty: _ } = &node.body;
                let Some(binding) = binding else { continue };
                let variable = variables.one(name, &binding.place, *span)?;
                if found.iter().any(|(other, at)| *other == variable && !at.excludes(&condition)) {
                    let what = format!("a second `{name}` of what a stage takes or returns");
                    return Err(crate::wesl::untranslated(*span, what));
                }
                found.push((variable, condition));
            }
            out.blank();
            for chain in chains_of(&fields) {
                item::write_chain(&chain, out, |node, out| {
                    out.line(&variables.declaration(&node.body)?);
                    Ok(())
                })?;
            }
        }
        Ok(found.into_iter().map(|(name, _)| name).collect())
    }

    /// The documentation, and what the file is made from.
    fn head(&self, file: &FilePart<'_>, out: &mut Indented) {
        let name = format!("{}.wesl", file.module.path.last().map_or("", String::as_str));
        match (file.part, file.has_stages) {
            (Part::Shared, false) => {
                // What made the module that this one is made from does not matter here.
                let is_made = |line: &&String| line.starts_with("Made from");
                let doc: Vec<&String> =
                    file.module.doc.iter().filter(|one| !is_made(one)).collect();
                let blank = doc.iter().rev().take_while(|line| line.is_empty()).count();
                for line in &doc[..doc.len() - blank] {
                    out.line(format!("//! {line}").trim_end());
                }
            }
            // The name of a text alone says nothing.
            _ if self.style.guard.is_empty() => {}
            (part, _) => {
                let what = match part {
                    Part::Shared => "What the stages",
                    Part::Stage(Stage::Vertex) => "The vertex stage",
                    Part::Stage(Stage::Fragment) => "The fragment stage",
                    Part::Stage(Stage::Compute) => "The compute stage",
                };
                let program = file.module.path.last().map_or("", String::as_str);
                let text = match part {
                    Part::Shared => format!("{what} of `{program}` share"),
                    Part::Stage(_) => format!("{what} of `{program}`"),
                };
                out.line(&format!("//! {text}, which `{name}` describes."));
            }
        }
        if let Some(command) = self.style.command {
            if !out.text.is_empty() {
                out.line("//!");
            }
            out.line(&format!("//! Made from `{name}` by `{command}`: edit that, not this file."));
        }
    }

    fn guard(&self, path: &[String]) -> String {
        let mut guard = self.style.guard.to_owned();
        for segment in path {
            guard += "_";
            guard += &segment.to_uppercase();
        }
        guard + "_" + &self.style.dialect.ending().to_uppercase()
    }

    /// The path of the file that gives names a prefix, as a module includes it.
    fn prefix(&self, path: &[String]) -> Option<String> {
        let (prefix, without) = self.style.prefix?;
        let is_without = path.first().is_some_and(|folder| without.contains(&folder.as_str()));
        (!is_without).then(|| relative_path(path, prefix, self.style.dialect))
    }

    /// The includes of what items use.
    fn includes(&self, file: &FilePart<'_>, out: &mut Indented) {
        let mut wanted: BTreeMap<String, Vec<(Condition, Condition)>> = BTreeMap::new();
        let whole = crate::tree::whole_conditions(file.items);
        let own = file.module.path.join("/");
        let local: Vec<&str> = file.items.iter().map(|node| node.body.name()).collect();
        for (node, condition) in file.items.iter().zip(whole) {
            self.item_includes(&node.body, file.module, &mut |path, inner| {
                let target = path.module.join("/");
                let is_shared = file.has_shared && file.part != Part::Shared;
                if target == own && (!is_shared || local.contains(&path.name.as_str())) {
                    return;
                }
                wanted.entry(target).or_default().push((condition.clone(), inner.clone()));
            });
            if let (true, Some(sampling)) = (takes_textures(&node.body), self.style.sampling) {
                let always = Condition::Literal(true);
                wanted.entry(sampling.to_owned()).or_default().push((condition.clone(), always));
            }
        }
        let is_metal = self.style.dialect == Dialect::Msl;
        if wanted.is_empty() && !is_metal {
            return;
        }
        out.blank();
        if is_metal {
            out.line("#include <metal_stdlib>");
        }
        let mut lines: Vec<(String, Condition)> = wanted
            .into_iter()
            .map(|(target, conditions)| {
                let path = relative_path(&file.module.path, &target, self.style.dialect);
                (path, include_condition(conditions))
            })
            .collect();
        lines.sort_by(|left, right| left.0.cmp(&right.0));
        write_includes(lines, out);
    }

    /// What an item and the structure of its block use of other modules and of the shared file.
    fn item_includes(
        &self,
        item: &Item,
        module: &Module,
        visit: &mut dyn FnMut(&ItemPath, &Condition),
    ) {
        item_uses(item, &mut |path, condition| {
            if self.facts.is_stage_structure(path) {
                return;
            }
            match self.facts.is_block(path) && path.module == module.path {
                true => {
                    let structure = module.items.iter().find(|node| node.body.name() == path.name);
                    if let Some(node) = structure {
                        item_uses(&node.body, visit);
                    }
                }
                false => visit(path, condition),
            }
        });
    }
}

/// Lines that include files, those of one condition together.
fn write_includes(lines: Vec<(String, Condition)>, out: &mut Indented) {
    let mut last = Condition::Literal(true);
    for (path, condition) in lines {
        if condition != last {
            if last != Condition::Literal(true) {
                out.line("#endif");
            }
            if condition != Condition::Literal(true) {
                out.line(&format!("#if {}", condition_text(&condition)));
            }
        }
        out.line(&format!("#include \"{path}\""));
        last = condition;
    }
    if last != Condition::Literal(true) {
        out.line("#endif");
    }
}

/// A file in the making.
struct FilePart<'a> {
    dialect: Dialect,
    module: &'a Module,
    part: Part,
    items: &'a [Node<Item>],
    has_shared: bool,
    has_stages: bool,
}

impl FilePart<'_> {
    fn path(&self) -> String {
        let path = self.module.path.join("/");
        match self.part {
            Part::Shared => format!("{path}.{}", self.dialect.ending()),
            Part::Stage(Stage::Vertex) => format!("{path}.vert.glsl"),
            Part::Stage(Stage::Fragment) => format!("{path}.frag.glsl"),
            Part::Stage(Stage::Compute) => format!("{path}.comp.glsl"),
        }
    }
}

/// The longest condition of an include. What would be longer is included always.
const LONGEST: usize = 120;

/// The condition of an include: that of each use within its item, or that of the items, or none.
fn include_condition(uses: Vec<(Condition, Condition)>) -> Condition {
    let whole = |(item, inner): &(Condition, Condition)| item.clone().and(inner.clone());
    let item = |(item, _): &(Condition, Condition)| item.clone();
    let parts: Vec<Condition> = uses.iter().map(whole).map(Condition::simplified).collect();
    let within = Condition::any(parts).simplified();
    let of_items = Condition::any(uses.iter().map(item).collect()).simplified();
    let is_short = |one: &Condition| condition_text(one).len() <= LONGEST;
    match is_short(&within) && !of_items.implies(&within) {
        true => within,
        false if is_short(&of_items) => of_items,
        false => Condition::Literal(true),
    }
}

/// Whether an item takes a texture and a sampler as parameters.
fn takes_textures(item: &Item) -> bool {
    match item {
        Item::Function(function) => {
            function.parameters.iter().any(|node| matches!(node.body.ty, Type::Texture(_)))
        }
        _ => false,
    }
}

/// The path of a file as a module includes it: `a/b` of the module `c/d` is `../a/b.glsl`.
fn relative_path(module: &[String], target: &str, dialect: Dialect) -> String {
    let target: Vec<&str> = target.split('/').collect();
    let folder = &module[..module.len().saturating_sub(1)];
    let common = folder.iter().zip(&target).take_while(|(left, right)| left == right).count();
    let ups = "../".repeat(folder.len() - common);
    format!("{ups}{}.{}", target[common..].join("/"), dialect.ending())
}

fn structures_of(module: &Module) -> BTreeMap<String, (Vec<Line>, Structure)> {
    let mut structures = BTreeMap::new();
    for node in &module.items {
        if let Item::Structure(structure) = &node.body {
            let lead = node.lead.clone();
            structures.insert(structure.name.clone(), (lead, structure.clone()));
        }
    }
    structures
}

/// Items with blank lines between, and directives around those with conditions.
fn write_items(
    items: &[Node<Item>],
    writer: &ItemWriter<'_>,
    out: &mut Indented,
) -> Result<(), Diagnostics> {
    let mut errors = Vec::new();
    let mut was_short = false;
    for chain in chains_of(items) {
        for (number, (condition, nodes)) in chain.arms.iter().enumerate() {
            for (place, node) in nodes.iter().enumerate() {
                let is_apart = node.lead.first() == Some(&Line::Blank);
                let is_dense = was_short && is_short(&node.body) && !is_apart;
                let is_inner = chain.is_conditional && place == 0 && number > 0;
                if !is_dense && !is_inner {
                    out.blank();
                }
                if chain.is_conditional && place == 0 {
                    out.raw(&directive(number, *condition));
                }
                errors.extend(writer.item(node, out).err());
                was_short = is_short(&node.body);
            }
        }
        if chain.is_conditional {
            out.raw("#endif\n");
        }
    }
    if errors.is_empty() { Ok(()) } else { Err(errors) }
}
