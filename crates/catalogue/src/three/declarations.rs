//! The declarations of the composed text, with the names that they have in shaders.

use std::collections::{BTreeMap, BTreeSet};

use lamplight_compose::{Composed, Part, PartKind};
use lamplight_diagnostic::source::SourceSet;
use lamplight_syntax::wesl::blank::without_comments;
use lamplight_syntax::words::{LexemeKind, pieces};
use lamplight_translate::tree::{Item, Type};
use lamplight_translate::wesl::read_module;

use super::MADE;
use super::signature::{Signature, signature_of};

/// A declaration in WGSL.
pub(super) struct Declaration {
    pub name: String,
    pub kind: PartKind,
    /// Without comments.
    pub text: String,
    /// The declarations that it names.
    pub uses: Vec<usize>,
    /// The module that it is of, below the root of its package, without ending.
    pub module: String,
}

pub(super) struct Declarations {
    pub all: Vec<Declaration>,
    by_composed_name: BTreeMap<String, usize>,
    /// The types that have another name.
    aliases: BTreeMap<String, Type>,
}

impl Declarations {
    /// The declarations of a text in which names are those of `Mangle::Underscore`, so that no local
    /// variable and no member has one of them. `homes` has the module of each file of the package, by
    /// its shown path. Names begin with `prefix`.
    pub(super) fn of(
        composed: &Composed,
        sources: &SourceSet,
        homes: &BTreeMap<String, String>,
        prefix: &str,
    ) -> Self {
        let origin = |part| origin_of(composed, part, sources, homes);
        let origins: Vec<Origin> = composed.parts.iter().map(origin).collect();
        let names = names_of(&composed.parts, &origins, prefix);
        let renamed = |part: &Part| {
            let text = composed.text.get(part.range.clone()).unwrap_or_default();
            renamed_text(&code_of(text), &names)
        };
        let by_composed_name = (composed.parts.iter().enumerate())
            .flat_map(|(index, part)| part.names.iter().map(move |name| (name.clone(), index)))
            .collect();
        let all: Vec<Declaration> = (composed.parts.iter().zip(origins))
            .map(|(part, origin)| Declaration {
                name: part.names.first().map_or_else(String::new, |name| names[name].clone()),
                kind: part.kind,
                text: renamed(part),
                uses: part.uses.iter().map(|index| *index as usize).collect(),
                module: origin.module,
            })
            .collect();
        let aliases = all
            .iter()
            .filter(|declaration| declaration.kind == PartKind::Alias)
            .filter_map(|declaration| match read_item(&declaration.text) {
                Ok(Item::Alias(name, ty)) => Some((name, ty)),
                _ => None,
            })
            .collect();
        Self { all, by_composed_name, aliases }
    }

    pub(super) fn find(&self, composed_name: &str) -> Option<usize> {
        self.by_composed_name.get(composed_name).copied()
    }

    /// What a function takes and gives, or why no node can be made of it.
    pub(super) fn signature(&self, index: usize) -> Result<Signature, String> {
        let Item::Function(function) = read_item(&self.all[index].text)? else {
            return Err("it is not a function".to_owned());
        };
        let signature = signature_of(&function, &self.aliases)?;
        for used in self.reached(index) {
            let Declaration { name, kind, .. } = &self.all[used];
            let what = match kind {
                PartKind::Variable => "a variable of the module",
                PartKind::Override => "a constant that pipelines choose",
                PartKind::Directive => "a directive",
                PartKind::Function
                | PartKind::Prototype
                | PartKind::Struct
                | PartKind::Alias
                | PartKind::Constant
                | PartKind::Assertion
                | PartKind::Other => continue,
            };
            return Err(format!("it uses `{name}`, {what}"));
        }
        Ok(signature)
    }

    /// A declaration and all that it needs, directly or not, in the order of the text.
    pub(super) fn reached(&self, index: usize) -> BTreeSet<usize> {
        let mut found = BTreeSet::new();
        let mut open = vec![index];
        while let Some(next) = open.pop() {
            if found.insert(next) {
                open.extend(&self.all[next].uses);
            }
        }
        found
    }
}

/// One declaration; the error says why it cannot be read.
fn read_item(text: &str) -> Result<Item, String> {
    let module = read_module(&["three".to_owned()], MADE, text, &[]).map_err(|problems| {
        let message = problems.first().map_or("", |problem| problem.message.as_str());
        format!("it cannot be translated: {message}")
    })?;
    let item = module.items.into_iter().next().map(|node| node.body);
    item.ok_or_else(|| "it has no declaration".to_owned())
}

/// Where a declaration is from.
struct Origin {
    module: String,
    name: String,
}

fn origin_of(
    composed: &Composed,
    part: &Part,
    sources: &SourceSet,
    homes: &BTreeMap<String, String>,
) -> Origin {
    let composed_name = part.names.first().cloned().unwrap_or_default();
    let Some(span) = composed.place_of(part) else {
        return Origin { module: String::new(), name: composed_name };
    };
    let source = sources.get(span.source);
    let line = source.text.get(span.start as usize..).unwrap_or_default();
    const KEYWORDS: [&str; 6] = ["fn", "const", "struct", "alias", "var", "override"];
    let mut words = pieces(line).filter(|piece| piece.kind == LexemeKind::Word);
    let name = words
        .find(|piece| KEYWORDS.contains(&piece.text))
        .and_then(|_| words.next())
        .map_or(composed_name, |piece| piece.text.to_owned());
    let module = homes.get(&source.path).cloned().unwrap_or_else(|| foreign_home(&source.path));
    Origin { module, name }
}

/// The module for what is of another package: the last two parts of the path of its file.
fn foreign_home(path: &str) -> String {
    let stem = path.rsplit_once('.').map_or(path, |(stem, _)| stem);
    let mut parts: Vec<&str> = stem.rsplit(['/', '\\']).take(2).collect();
    parts.reverse();
    let plain = |letter: char| letter.is_ascii_alphanumeric() || letter == '/';
    let word = |letter| if plain(letter) { letter } else { '_' };
    format!("others/{}", parts.join("/").chars().map(word).collect::<String>())
}

/// The new name of each declaration: the author's behind the prefix. Where two modules have the same,
/// the last part of the module's path is between them, and else a number behind.
fn names_of(parts: &[Part], origins: &[Origin], prefix: &str) -> BTreeMap<String, String> {
    let plain = |name: &str| name.trim_matches('_').replace("__", "_");
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    for origin in origins {
        *counts.entry(plain(&origin.name)).or_default() += 1;
    }
    let mut taken = BTreeSet::new();
    let mut names = BTreeMap::new();
    for (part, origin) in parts.iter().zip(origins) {
        let Some(composed_name) = part.names.first() else { continue };
        let own = plain(&origin.name);
        let stem = plain(origin.module.rsplit('/').next().unwrap_or_default());
        let first = match counts[&own] {
            1 => format!("{prefix}_{own}"),
            _ => format!("{prefix}_{stem}_{own}"),
        };
        let mut name = first.clone();
        for number in 2.. {
            if taken.insert(name.clone()) {
                break;
            }
            name = format!("{first}_{number}");
        }
        names.insert(composed_name.clone(), name);
    }
    names
}

/// A text without comments and empty lines. A function begins with its keyword: attributes before it
/// are for compilers, and three.js reads none.
pub(super) fn code_of(text: &str) -> String {
    let bare = without_comments(text);
    let lines: Vec<&str> =
        bare.lines().map(str::trim_end).filter(|line| !line.trim().is_empty()).collect();
    let code = lines.join("\n");
    match code.split_once("@must_use") {
        Some((before, after)) if before.trim().is_empty() => after.trim_start().to_owned(),
        _ => code,
    }
}

/// The text with other names.
fn renamed_text(text: &str, names: &BTreeMap<String, String>) -> String {
    let word = |text| names.get(text).map_or(text, String::as_str);
    pieces(text)
        .map(|piece| if piece.kind == LexemeKind::Word { word(piece.text) } else { piece.text })
        .collect()
}
