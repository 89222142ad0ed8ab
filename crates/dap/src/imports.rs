//! How a text came to be read: the imports and includes that lead from one text to another.

use std::collections::{BTreeMap, VecDeque};

use lamplight_diagnostic::source::{SourceId, SourceSet};

/// Which text names which other one, and where.
#[derive(Debug, Default)]
pub struct Imports {
    /// For each text, the texts that it names and the lines.
    edges: BTreeMap<SourceId, Vec<(SourceId, u32)>>,
}

impl Imports {
    /// Reads the imports of all texts.
    pub fn of(sources: &SourceSet) -> Self {
        let modules: Vec<(SourceId, String)> = sources
            .iter()
            .filter_map(|(id, one)| Some((id, stem(&one.path)?.to_owned())))
            .collect();
        let mut edges = BTreeMap::new();
        for (id, source) in sources.iter() {
            let mut own = Vec::new();
            for (line, text) in statements(&source.text) {
                let is_word = |c: char| c.is_alphanumeric() || c == '_';
                let words: Vec<&str> = text.split(|c| !is_word(c)).collect();
                let named = modules
                    .iter()
                    .filter(|(other, name)| *other != id && words.iter().any(|word| word == name));
                own.extend(named.map(|(other, _)| (*other, line)));
            }
            edges.insert(id, own);
        }
        Self { edges }
    }

    /// The shortest way from a text to another: each text on it that names the next one, and the line
    /// where it does, the nearest to `to` first. Empty if there is none.
    pub fn way(&self, from: SourceId, to: SourceId) -> Vec<(SourceId, u32)> {
        let mut came: BTreeMap<SourceId, (SourceId, u32)> = BTreeMap::new();
        let mut open = VecDeque::from([from]);
        while let Some(next) = open.pop_front() {
            for (other, line) in self.edges.get(&next).into_iter().flatten() {
                if *other != from && !came.contains_key(other) {
                    came.insert(*other, (next, *line));
                    open.push_back(*other);
                }
            }
        }
        let (mut way, mut at) = (Vec::new(), to);
        while let Some((before, line)) = came.get(&at) {
            way.push((*before, *line));
            at = *before;
        }
        way
    }
}

/// The name of a file without folders and ending.
fn stem(path: &str) -> Option<&str> {
    let file = path.rsplit(['/', '\\']).next()?;
    let stem = file.split('.').next()?;
    (!stem.is_empty() && file.len() > stem.len()).then_some(stem)
}

/// The imports and includes of a text, each with its line.
fn statements(text: &str) -> Vec<(u32, String)> {
    let mut found = Vec::new();
    let mut open: Option<(u32, String)> = None;
    for (row, line) in text.lines().zip(1_u32..) {
        let row = row.split("//").next().unwrap_or_default().trim();
        if let Some((_, text)) = &mut open {
            text.push_str(row);
        } else if row.starts_with("#include") {
            found.push((line, row.to_owned()));
        } else if row.starts_with("import ") || row.contains(" import ") {
            open = Some((line, row.to_owned()));
        }
        if open.as_ref().is_some_and(|(_, text)| text.contains(';')) {
            found.extend(open.take());
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ways() {
        let mut sources = SourceSet::default();
        let main = sources.add("main.wesl", "import package::a::{\n  f,\n};\nfn g() {}");
        let a = sources.add("a.wesl", "// import package::c::k;\n\nimport package::b::h;\n");
        let b = sources.add("lib/b.wesl", "fn h() {}");
        let c = sources.add("c.wesl", "");
        let imports = Imports::of(&sources);
        assert_eq!(imports.way(main, a), [(main, 1)]);
        assert_eq!(imports.way(main, b), [(a, 3), (main, 1)]);
        assert_eq!(imports.way(main, c), []);
        assert_eq!(imports.way(b, main), []);
    }
}
