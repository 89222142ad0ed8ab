//! Replaces tokens that WESL writes differently: paths, and values of shader defs.

use std::collections::{BTreeMap, BTreeSet};

use super::names::{FolderModules, PathDestination};
use super::tree::{ByteRange, Node, Scanned, Token, TokenKind};

/// Why a use has no form in WESL, and where.
type UseError = (String, ByteRange);

/// New texts of tokens, by their first byte.
pub fn replaced_tokens(
    text: &str,
    found: &Scanned,
    modules: &FolderModules,
) -> Result<BTreeMap<usize, String>, UseError> {
    let mut aliases: BTreeMap<&str, BTreeSet<&[String]>> = BTreeMap::new();
    for import in &found.imports {
        aliases.entry(&import.alias).or_default().insert(&import.path);
    }
    let mut uses = Uses { text, modules, aliases, replaced: BTreeMap::new() };
    uses.nodes(&found.nodes)?;
    Ok(uses.replaced)
}

struct Uses<'a> {
    text: &'a str,
    modules: &'a FolderModules,
    aliases: BTreeMap<&'a str, BTreeSet<&'a [String]>>,
    replaced: BTreeMap<usize, String>,
}

impl Uses<'_> {
    fn nodes(&mut self, nodes: &[Node]) -> Result<(), UseError> {
        let mut at = 0;
        while at < nodes.len() {
            match &nodes[at] {
                Node::Choice(choice) => {
                    choice.branches.iter().try_for_each(|branch| self.nodes(&branch.nodes))?;
                    at += 1;
                }
                Node::Token(token) if token.kind == TokenKind::Word => at = self.word(nodes, at)?,
                Node::Token(token) if token.kind == TokenKind::Def => {
                    self.value(token, token_at(nodes, at + 1))?;
                    at += 1;
                }
                _ => at += 1,
            }
        }
        Ok(())
    }

    fn text_of(&self, token: &Token) -> &str {
        &self.text[token.range.clone()]
    }

    /// A path, or a word of the language; returns the index behind.
    fn word(&mut self, nodes: &[Node], at: usize) -> Result<usize, UseError> {
        let mut tokens: Vec<&Token> = Vec::new();
        let mut end = at;
        while let Some(token) = token_at(nodes, end) {
            let expected =
                if tokens.len().is_multiple_of(2) { TokenKind::Word } else { TokenKind::Path };
            if token.kind != expected {
                break;
            }
            tokens.push(token);
            end += 1;
        }
        let first = tokens[0];
        self.check_word(first, tokens.get(1).copied().or_else(|| token_at(nodes, end)))?;
        if tokens.len().is_multiple_of(2) || tokens.len() < 3 {
            return Ok(end.max(at + 1));
        }
        let path: Vec<String> =
            tokens.iter().step_by(2).map(|token| self.text_of(token).to_owned()).collect();
        let place = first.range.start..tokens[tokens.len() - 1].range.end;
        if let Some(new) = self.path(&path).map_err(|message| (message, place))? {
            for token in &tokens {
                self.replaced.insert(token.range.start, String::new());
            }
            self.replaced.insert(first.range.start, new);
        }
        Ok(end)
    }

    fn check_word(&self, word: &Token, next: Option<&Token>) -> Result<(), UseError> {
        let followed = next.is_some_and(|next| self.text_of(next) == "fn");
        let text = self.text_of(word);
        match followed && (text == "virtual" || text == "override") {
            true => Err((format!("WESL has no `{text}` functions"), word.range.clone())),
            false => Ok(()),
        }
    }

    /// The path as WESL has it, where that is another.
    fn path(&self, path: &[String]) -> Result<Option<String>, String> {
        let known = |place: PathDestination| match place {
            PathDestination::Known(path) => Some(path),
            PathDestination::Foreign | PathDestination::Prefix => None,
        };
        let Some(targets) = self.aliases.get(path[0].as_str()) else {
            return Ok(known(self.modules.place(path)?));
        };
        let mut targets = targets.iter();
        let (Some(target), None) = (targets.next(), targets.next()) else { return Ok(None) };
        match self.modules.place(target)? {
            // WESL has no such import, so the whole path is written here.
            PathDestination::Prefix => {
                let whole: Vec<String> = target.iter().chain(&path[1..]).cloned().collect();
                Ok(known(self.modules.place(&whole)?))
            }
            PathDestination::Known(_) | PathDestination::Foreign => Ok(None),
        }
    }

    /// Replaces `#{NAME}`, and a suffix that directly follows it.
    fn value(&mut self, def: &Token, next: Option<&Token>) -> Result<(), UseError> {
        let name = self.text_of(def).trim_matches(|mark| "#{} \t".contains(mark)).to_owned();
        let value = format!("constants::{name}");
        let pasted = next.filter(|next| next.lead.is_empty());
        let pasted = pasted.filter(|next| matches!(next.kind, TokenKind::Word | TokenKind::Number));
        let text = match pasted.map(|next| self.text_of(next)) {
            None => value,
            Some("u") => format!("u32({value})"),
            Some("i") => format!("i32({value})"),
            Some("f" | ".0" | ".0f") => format!("f32({value})"),
            Some("h" | ".0h") => format!("f16({value})"),
            Some(_) => {
                let place = def.range.start..pasted.map_or(def.range.end, |next| next.range.end);
                return Err(("a word that is put together from a shader def".to_owned(), place));
            }
        };
        if let Some(next) = pasted {
            self.replaced.insert(next.range.start, String::new());
        }
        self.replaced.insert(def.range.start, text);
        Ok(())
    }
}

fn token_at(nodes: &[Node], at: usize) -> Option<&Token> {
    match nodes.get(at) {
        Some(Node::Token(token)) => Some(token),
        _ => None,
    }
}
