//! The modules of JavaScript, and the page about them.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

use super::glsl::{Part, Parts};
use super::{Exported, LeftOut};
use crate::CatalogueModule;

const START: &str = "// Written by `lamplight export --form three`; do not edit.\n";

/// What is the same for every package.
const RUNTIME: [(&str, &str); 4] = [
    ("node.js", include_str!("node.js")),
    ("node.d.ts", include_str!("node.d.ts")),
    ("chunk.js", include_str!("chunk.js")),
    ("chunk.d.ts", include_str!("chunk.d.ts")),
];

/// Parts that only translations have.
const TRANSLATED: &str = "translated";

pub(super) fn package_files(
    made: &Parts<'_>,
    modules: &[CatalogueModule],
    name: &str,
    left_out: &[LeftOut],
) -> BTreeMap<String, String> {
    let mut files: BTreeMap<String, String> =
        RUNTIME.iter().map(|(path, text)| ((*path).to_owned(), (*text).to_owned())).collect();
    let table = PartTable::of(made, name);
    let homes: BTreeSet<&str> = made.parts.iter().map(home_of).collect();
    for module in homes {
        let own = made.parts.iter().filter(|part| home_of(part) == module);
        files.insert(format!("parts/{module}.js"), table.parts_text(module, own));
        files.insert(format!("parts/{module}.d.ts"), table.parts_types(module));
    }
    for module in modules {
        let own: Vec<&Exported<'_>> = (made.exported.iter())
            .filter(|one| module.items.iter().any(|item| std::ptr::eq(item, one.item)))
            .collect();
        let Some(first) = own.first() else { continue };
        let path = first.item.module.replace("::", "/");
        files.insert(format!("tsl/{path}.js"), table.nodes_text(&path, &own, made));
        files.insert(format!("tsl/{path}.d.ts"), types_text(&path, module, &own));
    }
    files.insert("left_out.md".to_owned(), page_text(left_out));
    files
}

/// The module that a part is in.
fn home_of(part: &Part) -> &str {
    if part.module.is_empty() { TRANSLATED } else { &part.module }
}

/// Words that cannot name a variable of a module.
const RESERVED: &[&str] = &[
    "arguments",
    "await",
    "break",
    "case",
    "catch",
    "class",
    "const",
    "continue",
    "debugger",
    "default",
    "delete",
    "do",
    "else",
    "enum",
    "eval",
    "export",
    "extends",
    "false",
    "finally",
    "for",
    "function",
    "if",
    "implements",
    "import",
    "in",
    "instanceof",
    "interface",
    "let",
    "new",
    "null",
    "package",
    "private",
    "protected",
    "public",
    "return",
    "static",
    "super",
    "switch",
    "this",
    "throw",
    "true",
    "try",
    "typeof",
    "var",
    "void",
    "while",
    "with",
    "yield",
];

fn script_name(name: &str) -> String {
    if RESERVED.contains(&name) { format!("{name}_") } else { name.to_owned() }
}

/// The way from the folder of one module to another one.
fn relative_path(from: &str, to: &str) -> String {
    let up = from.matches('/').count();
    format!("{}{to}.js", if up == 0 { "./".to_owned() } else { "../".repeat(up) })
}

/// A text as a template of JavaScript.
fn template_literal(text: &str) -> String {
    format!("`{}`", text.replace('\\', "\\\\").replace('`', "\\`").replace("${", "\\${"))
}

/// Where each part is.
struct PartTable<'a> {
    prefix: String,
    parts: BTreeMap<&'a str, &'a Part>,
}

impl<'a> PartTable<'a> {
    fn of(made: &'a Parts<'_>, name: &str) -> Self {
        let parts = made.parts.iter().map(|part| (part.name.as_str(), part)).collect();
        Self { prefix: format!("{name}_"), parts }
    }

    /// The name of a part in its module.
    fn own_name(&self, part: &Part) -> String {
        script_name(part.name.strip_prefix(&self.prefix).unwrap_or(&part.name))
    }

    fn parts_text<'p>(&self, module: &str, own: impl Iterator<Item = &'p Part>) -> String {
        let (mut body, mut others) = (String::new(), BTreeSet::new());
        for part in own {
            let mut needs = Vec::new();
            for needed in part.needs.iter().filter_map(|name| self.parts.get(name.as_str())) {
                let name = self.own_name(needed);
                if home_of(needed) == module {
                    needs.push(name);
                } else {
                    others.insert(home_of(needed));
                    needs.push(format!("{}.{name}", space_of(home_of(needed))));
                }
            }
            let _ = write!(
                body,
                "\nexport const {} = {{\n  name: \"{}\",\n  isFunction: {},\n  wgsl: {},\n  \
                 glsl: {},\n  needs: () => [{}],\n}};\n",
                self.own_name(part),
                part.name,
                part.is_function,
                template_literal(&part.wgsl),
                template_literal(&part.glsl),
                needs.join(", ")
            );
        }
        let imports: String = others
            .iter()
            .map(|other| {
                format!(
                    "import * as {} from \"{}\";\n",
                    space_of(other),
                    relative_path(module, other)
                )
            })
            .collect();
        format!("{START}{imports}{body}")
    }

    fn parts_types(&self, module: &str) -> String {
        let root = "../".repeat(module.matches('/').count() + 1);
        let own = self.parts.values().filter(|part| home_of(part) == module);
        let names: String =
            own.map(|part| format!("export const {}: Part;\n", self.own_name(part))).collect();
        format!("{START}import type {{ Part }} from \"{root}chunk.js\";\n\n{names}")
    }

    fn nodes_text(&self, module: &str, own: &[&Exported<'_>], made: &Parts<'_>) -> String {
        let root = "../".repeat(module.matches('/').count() + 1);
        let mut text = format!(
            "{START}import {{ node }} from \"{root}node.js\";\nimport * as parts from \
             \"{root}parts/{module}.js\";\n\n"
        );
        for one in own {
            let Some(part) = made.part_of(one) else { continue };
            let name = script_name(&one.item.name);
            let _ = writeln!(
                text,
                "export const {name} = /*@__PURE__*/ node(parts.{});",
                self.own_name(part)
            );
        }
        text
    }
}

/// The name of another module in a module.
fn space_of(module: &str) -> String {
    let word = |letter: char| if letter.is_ascii_alphanumeric() { letter } else { '_' };
    format!("in_{}", module.chars().map(word).collect::<String>())
}

fn types_text(path: &str, module: &CatalogueModule, own: &[&Exported<'_>]) -> String {
    let root = "../".repeat(path.matches('/').count() + 1);
    let mut text = format!("{START}import type {{ NodeFunction }} from \"{root}node.js\";\n");
    if !module.doc.is_empty() {
        let _ = writeln!(text, "\n{}", comment_lines(&module.doc, "// ", ""));
    }
    for one in own {
        let parameters: Vec<String> = (one.signature.parameters.iter())
            .map(|(name, ty)| format!("{}: \"{ty}\"", script_name(name)))
            .collect();
        let _ = write!(
            text,
            "\n/**\n{} */\nexport const {}: NodeFunction<[{}], \"{}\">;\n",
            comment_lines(&one.item.doc, " * ", "\n"),
            script_name(&one.item.name),
            parameters.join(", "),
            one.signature.result
        );
    }
    text
}

fn comment_lines(lines: &[String], mark: &str, end: &str) -> String {
    let lines: Vec<String> = lines
        .iter()
        .map(|line| format!("{mark}{}", line.replace("*/", "* /")).trim_end().to_owned())
        .collect();
    let text = lines.join("\n");
    if text.is_empty() { text } else { text + end }
}

/// What is left out, with its reasons.
fn page_text(left_out: &[LeftOut]) -> String {
    let mut text = "# What is left out\n\nA node takes and gives numbers, vectors and square \
                    matrices. These functions have something else, or are not in GLSL ES 3.00.\n\n\
                    | function | reason |\n|---|---|\n"
        .to_owned();
    for LeftOut { path, reason } in left_out {
        let _ = writeln!(text, "| `{path}` | {} |", reason.replace('|', "\\|"));
    }
    text
}
