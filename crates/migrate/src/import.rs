//! `#import`: its paths, and where it may stand.

use super::condition::ShaderDefTest;
use super::names::{FolderModules, PathDestination};
use super::tree::{ByteRange, Conditional, ImportDirective, ImportLeaf, ImportedPath, Node};
use lamplight_syntax::wesl::blank::without_comments;
use lamplight_syntax::words::leading_word;

/// Why an import cannot be read, and where.
type ImportError = (&'static str, ByteRange);

/// Reads the directive in `place`.
pub fn parse_import(text: &str, place: ByteRange) -> Result<ImportLeaf, ImportError> {
    let bare = without_comments(&text[place.clone()]);
    let start = bare.find("import").unwrap_or(0) + "import".len();
    let end = bare.trim_end().trim_end_matches(';').trim_end().len();
    let mut reader =
        ImportLineReader { bare: &bare[..end.max(start)], at: start, offset: place.start };
    let mut tree = reader.leaf(0)?;
    if !reader.is_at_end() {
        // `#import path item, item`, the form before braces.
        tree = reader.listed(tree)?;
    }
    match reader.is_at_end() {
        true => Ok(tree),
        false => Err(reader.wrong("an import that cannot be understood")),
    }
}

/// The names that an import brings into scope, with their whole paths.
pub fn import_paths(tree: &ImportLeaf) -> Vec<ImportedPath> {
    let mut found = Vec::new();
    collect_paths(tree, &[], &mut found);
    found
}

fn collect_paths(leaf: &ImportLeaf, before: &[String], found: &mut Vec<ImportedPath>) {
    let path: Vec<String> =
        before.iter().chain(leaf.file.as_ref()).chain(&leaf.path).cloned().collect();
    match (&leaf.alias, path.last(), &leaf.braces) {
        (_, _, Some(_)) => {
            leaf.children.iter().for_each(|child| collect_paths(child, &path, found))
        }
        (alias, Some(last), None) => {
            let alias = alias.as_ref().unwrap_or(last).clone();
            found.push(ImportedPath { alias, at: leaf.at.clone(), path });
        }
        (_, None, None) => {}
    }
}

struct ImportLineReader<'a> {
    bare: &'a str,
    at: usize,
    offset: usize,
}

/// How deeply braces may nest.
const DEEPEST: usize = 32;

impl ImportLineReader<'_> {
    fn skip(&mut self) {
        self.at += self.bare[self.at..].len() - self.bare[self.at..].trim_start().len();
    }

    fn is_at_end(&mut self) -> bool {
        self.skip();
        self.at == self.bare.len()
    }

    fn take(&mut self, mark: &str) -> bool {
        self.skip();
        let found = self.bare[self.at..].starts_with(mark);
        self.at += if found { mark.len() } else { 0 };
        found
    }

    fn word(&mut self) -> Option<String> {
        self.skip();
        let found = leading_word(&self.bare[self.at..]);
        self.at += found.len();
        (!found.is_empty()).then(|| found.to_owned())
    }

    fn wrong(&self, message: &'static str) -> ImportError {
        let length = self.bare[self.at..].chars().next().map_or(0, char::len_utf8);
        (message, self.offset + self.at..self.offset + self.at + length)
    }

    fn leaf(&mut self, depth: usize) -> Result<ImportLeaf, ImportError> {
        let lead = self.offset + self.at;
        self.skip();
        let start = self.offset + self.at;
        let mut leaf = ImportLeaf {
            path: Vec::new(),
            file: None,
            alias: None,
            children: Vec::new(),
            braces: None,
            lead: lead..start,
            at: start..start,
        };
        if self.take("\"") {
            let rest = &self.bare[self.at..];
            let end = rest.find('"').ok_or_else(|| self.wrong("quotes that are never closed"))?;
            leaf.file = Some(format!("\"{}\"", &rest[..end]));
            self.at += end + 1;
        }
        loop {
            if leaf.file.is_some() && leaf.path.is_empty() && !self.take("::") {
                break;
            }
            if self.take("{") {
                self.braces(&mut leaf, depth)?;
                break;
            }
            let found = self.word().ok_or_else(|| self.wrong("a name is missing here"))?;
            leaf.path.push(found);
            if !self.take("::") {
                break;
            }
        }
        let before = self.at;
        match self.word().as_deref() {
            Some("as") => {
                leaf.alias = Some(self.word().ok_or_else(|| self.wrong("a name is missing here"))?);
            }
            _ => self.at = before,
        }
        leaf.at.end = self.offset + self.at;
        Ok(leaf)
    }

    /// Reads a list in braces, from behind the opening brace.
    fn braces(&mut self, leaf: &mut ImportLeaf, depth: usize) -> Result<(), ImportError> {
        let start = self.offset + self.at - 1;
        if depth == DEEPEST {
            return Err(self.wrong("braces nest too deep"));
        }
        while !self.take("}") {
            leaf.children.push(self.leaf(depth + 1)?);
            if !self.take(",") && !self.bare[self.at..].trim_start().starts_with('}') {
                return Err(self.wrong("expected `,` or `}`"));
            }
        }
        leaf.braces = Some(start..self.offset + self.at);
        Ok(())
    }

    fn listed(&mut self, mut tree: ImportLeaf) -> Result<ImportLeaf, ImportError> {
        loop {
            tree.children.push(self.leaf(1)?);
            if !self.take(",") {
                tree.braces = Some(0..0);
                return Ok(tree);
            }
        }
    }
}

/// The nodes without imports that would stand in a block: those go to `late`.
pub fn without_late_imports(
    nodes: Vec<Node>,
    late: &mut Vec<(Vec<ShaderDefTest>, ImportDirective)>,
) -> Vec<Node> {
    let taken = std::mem::take(late);
    let one = |node| match node {
        Node::Choice(choice) if !choice.is_of_imports() => {
            Node::Choice(without_imports(choice, &[], late))
        }
        node => node,
    };
    let nodes = nodes.into_iter().map(one).collect();
    late.extend(taken);
    nodes
}

fn without_imports(
    mut choice: Conditional,
    around: &[ShaderDefTest],
    late: &mut Vec<(Vec<ShaderDefTest>, ImportDirective)>,
) -> Conditional {
    let mut before = around.to_vec();
    for branch in &mut choice.branches {
        let mut here = before.clone();
        here.extend(branch.condition.clone());
        before.extend(branch.condition.clone().map(ShaderDefTest::not));
        let mut nodes = Vec::new();
        for node in std::mem::take(&mut branch.nodes) {
            match node {
                Node::Import(import) => late.push((here.clone(), import)),
                Node::Choice(inner) => {
                    nodes.push(Node::Choice(without_imports(inner, &here, late)));
                }
                node => nodes.push(node),
            }
        }
        branch.nodes = nodes;
    }
    choice
}

/// The paths of the WESL imports that replace a directive, without the keyword `import`. Names that
/// need no import, or that their module lacks, are left out.
pub fn import_statements(
    text: &str,
    tree: &ImportLeaf,
    modules: &FolderModules,
) -> Result<Vec<String>, String> {
    let mut found = Vec::new();
    write_import(text, tree, &[], modules, &mut found)?;
    Ok(found)
}

fn write_import(
    text: &str,
    leaf: &ImportLeaf,
    before: &[String],
    modules: &FolderModules,
    found: &mut Vec<String>,
) -> Result<(), String> {
    let path: Vec<String> =
        before.iter().chain(leaf.file.as_ref()).chain(&leaf.path).cloned().collect();
    let Some(braces) = &leaf.braces else {
        found.extend(import_one(&path, leaf, modules)?);
        return Ok(());
    };
    let module = modules.module(&path)?;
    let is_foreign = |name: &String| modules.packages().contains(name.as_str());
    let listed = match (braces.is_empty(), path.first()) {
        // The form without braces.
        (true, _) => None,
        _ if leaf.children.is_empty() => return Ok(()),
        (false, Some(first)) if is_foreign(first) && module.is_none() => Some(path.join("::")),
        _ => module.filter(|_| !modules.has_modules(&path, leaf)),
    };
    match listed {
        Some(module) => found.extend(
            listed_in(text, leaf, braces, |name| modules.lacks(&path, name))
                .map(|braces| format!("{module}::{braces}")),
        ),
        None => {
            for child in &leaf.children {
                let comment = bare_of_blanks(&text[child.lead.clone()]);
                let first = found.len();
                write_import(text, child, &path, modules, found)?;
                if let Some(statement) = found.get_mut(first).filter(|_| !comment.is_empty()) {
                    *statement = format!("{comment} {statement}");
                }
            }
        }
    }
    Ok(())
}

/// Braces as they were written, with a comment in place of each name that is absent. `None` if all
/// are.
fn listed_in(
    text: &str,
    leaf: &ImportLeaf,
    braces: &ByteRange,
    is_absent: impl Fn(&str) -> bool,
) -> Option<String> {
    let (mut listed, mut at, mut count) = (String::new(), braces.start, 0);
    for child in &leaf.children {
        if !child.path.last().is_some_and(|name| is_absent(name)) {
            count += 1;
            continue;
        }
        listed.push_str(&text[at..child.at.start]);
        listed.push_str(&format!("/* {} */", &text[child.at.clone()]));
        let rest = &text[child.at.end..braces.end];
        let comma = rest.len() - rest.trim_start().len() + 1;
        let is_comma = rest.trim_start().starts_with(',');
        at = child.at.end + if is_comma { comma } else { 0 };
    }
    listed.push_str(&text[at..braces.end]);
    (count > 0).then_some(listed)
}

/// Comments among braces as one comment that needs no line of its own.
fn bare_of_blanks(lead: &str) -> String {
    let words: Vec<&str> = lead.lines().map(|line| line.trim().trim_start_matches('/')).collect();
    let words = words.join(" ");
    let words = words.trim().trim_start_matches('*').trim_end_matches(['*', '/']).trim();
    if words.is_empty() { String::new() } else { format!("/* {} */", words.replace("*/", "")) }
}

/// The path of the WESL import of one name; `None` if there is none.
fn import_one(
    path: &[String],
    leaf: &ImportLeaf,
    modules: &FolderModules,
) -> Result<Option<String>, String> {
    let Some(last) = path.last() else { return Ok(None) };
    if modules.lacks(&path[..path.len() - 1], last) {
        return Ok(None);
    }
    let place = match modules.place(path)? {
        PathDestination::Known(place) => place,
        PathDestination::Foreign => path.join("::"),
        PathDestination::Prefix => return Ok(None),
    };
    let alias = leaf.alias.as_ref().unwrap_or(last);
    let own = place.rsplit("::").next().unwrap_or_default();
    Ok(Some(if own == alias { place } else { format!("{place} as {alias}") }))
}
