//! Units in every target, each once, and texts put together from them.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::sync::Arc;

use super::cut::{Cut, Fragment, Shared};
use super::names::Names;
use super::outline::Key;
use super::reason::Reason;
use super::spirv;
use super::summary::Summary;
use super::text::Kind;
use super::translate::{Translated, Written};
use crate::bundle::{Artifact, Native, Reflection, Target};
use crate::emit::targets;

/// What is kept.
pub struct Pool {
    units: HashMap<Key, Result<Arc<Unit>, Reason>>,
    /// In the order of the targets.
    texts: Vec<Texts>,
    words: spirv::Pool,
    /// Bytes of all units, roughly.
    size: usize,
}

/// A unit that was translated.
pub struct Unit {
    pub summary: Summary,
    pub reflection: Option<Arc<Reflection>>,
    targets: Vec<Result<Piece, Reason>>,
}

/// A unit in one target.
enum Piece {
    Text(TextPiece),
    Words { piece: spirv::Piece, native: Arc<Native> },
}

struct TextPiece {
    header: String,
    /// Numbers of what it needs of what is shared, sorted.
    shared: Vec<u32>,
    globals: Vec<Ready>,
    body: Ready,
    native: Arc<Native>,
    /// The native names as text, where they have names of the author's in them.
    template: Option<Fragment>,
}

/// A fragment with numbers for names and words, and with the text it nearly always has.
struct Ready {
    fragment: Fragment,
    /// With the names that naga would choose.
    text: String,
    /// The author's names it has, each once.
    names: Vec<u32>,
    /// Names that it cannot have as they are: it declares the same itself.
    captured: Vec<u32>,
    /// Identifiers that are neither references nor its own.
    words: Vec<u32>,
}

/// What the functions of one target share.
#[derive(Default)]
struct Texts {
    names: Names,
    declarations: Vec<Declared>,
    places: HashMap<(Fragment, Vec<u32>), u32>,
}

/// A declaration that functions share.
struct Declared {
    ready: Ready,
    declares: Fragment,
    /// No less than that of anything it uses: declarations are written in this order,
    kind: Kind,
    /// and then in this one, more than that of anything it uses.
    height: u32,
}

/// One text to put together: the units of its functions, callees first, then of its entry point.
pub struct Parts<'p> {
    /// The author's names of the functions.
    pub functions: Vec<(&'p str, Arc<Unit>)>,
    pub entry: Arc<Unit>,
}

impl Pool {
    pub fn new(targets: &[Target]) -> Self {
        Self {
            units: HashMap::new(),
            texts: targets.iter().map(|target| Texts::new(*target)).collect(),
            words: spirv::Pool::default(),
            size: 0,
        }
    }

    pub fn find(&self, key: &Key) -> Option<Result<Arc<Unit>, Reason>> {
        self.units.get(key).cloned()
    }

    /// Bytes of all units, roughly.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Keeps a unit; `function` is its author's name, if it is no entry point. `callees` are the
    /// names of the functions that it may call.
    pub fn keep(
        &mut self,
        key: Key,
        translated: Result<Translated, Reason>,
        function: Option<&str>,
        callees: &BTreeSet<&str>,
    ) -> Result<Arc<Unit>, Reason> {
        if let Some(known) = self.units.get(&key) {
            return known.clone();
        }
        let unit = translated.map(|translated| {
            let mut pieces = Vec::new();
            for (written, texts) in translated.targets.into_iter().zip(&mut self.texts) {
                let piece = written.and_then(|written| match written {
                    Written::Text { cut, native } => {
                        self.size += 2 * cut.size();
                        Ok(Piece::Text(texts.keep(cut, native)?))
                    }
                    Written::Words { words, native } => {
                        self.size += size_of_val(words.as_slice()) / 2;
                        words_piece(&mut self.words, &words, native, function, callees)
                    }
                });
                pieces.push(piece);
            }
            let (summary, reflection) = (translated.summary, translated.reflection);
            Arc::new(Unit { summary, reflection, targets: pieces })
        });
        self.units.insert(key, unit.clone());
        unit
    }

    /// One target of a text.
    ///
    /// # Errors
    /// The reason why this target of the text is compiled as a whole.
    pub fn link(
        &self,
        parts: &Parts<'_>,
        index: usize,
        target: Target,
    ) -> Result<Artifact, Reason> {
        let texts = self.texts.get(index).ok_or(Reason::Shape)?;
        let (bytes, native) = match piece(&parts.entry, index)? {
            Piece::Text(entry) => texts.link(parts, entry, index)?,
            Piece::Words { piece, native } => {
                let bytes = self.link_words(parts, piece, index)?;
                (bytes, native.clone())
            }
        };
        let extension = targets::find(target).map_or("", |entry| entry.extension).to_owned();
        Ok(Artifact { bytes: bytes.into(), extension, native })
    }

    fn link_words(
        &self,
        parts: &Parts<'_>,
        entry: &spirv::Piece,
        index: usize,
    ) -> Result<Vec<u8>, Reason> {
        let mut named: HashMap<&str, &spirv::Piece> = HashMap::new();
        for (name, unit) in &parts.functions {
            if let Piece::Words { piece, .. } = piece(unit, index)? {
                named.insert(name, piece);
            }
        }
        let words = spirv::assemble(&self.words, entry, &|name| named.get(name).copied());
        let words = words.map_err(|_| Reason::Spirv)?;
        let mut bytes = Vec::with_capacity(4 * words.len());
        words.iter().for_each(|word| bytes.extend_from_slice(&word.to_le_bytes()));
        Ok(bytes)
    }
}

impl Unit {
    /// Whether a target has no words for it.
    pub fn is_refused(&self, index: usize) -> bool {
        matches!(self.targets.get(index), Some(Err(Reason::Refused)))
    }
}

fn piece(unit: &Unit, index: usize) -> Result<&Piece, Reason> {
    match unit.targets.get(index) {
        Some(piece) => piece.as_ref().map_err(|reason| *reason),
        None => Err(Reason::Shape),
    }
}

fn words_piece(
    pool: &mut spirv::Pool,
    words: &[u32],
    native: Native,
    function: Option<&str>,
    callees: &BTreeSet<&str>,
) -> Result<Piece, Reason> {
    let is_author = |name: &str| function == Some(name) || callees.contains(name);
    let is_wanted = |name: &str| function.unwrap_or(&native.entry_name) == name;
    let parts = spirv::split(words, pool, &is_author, &is_wanted).map_err(|_| Reason::Spirv)?;
    let mut functions = parts.functions.into_iter();
    let piece = match function {
        Some(name) => functions.find(|(found, _)| found == name).map(|(_, piece)| piece),
        None => parts.entry,
    };
    Ok(Piece::Words { piece: piece.ok_or(Reason::Spirv)?, native: Arc::new(native) })
}

impl Cut {
    fn size(&self) -> usize {
        self.body.text.len() + self.globals.iter().map(|global| global.text.len()).sum::<usize>()
    }
}

impl Texts {
    fn new(target: Target) -> Self {
        Self { names: Names::new(target), ..Self::default() }
    }

    fn keep(&mut self, cut: Cut, native: Option<Fragment>) -> Result<TextPiece, Reason> {
        let Cut { header, shared, globals, body } = cut;
        let mut numbers: Vec<u32> = Vec::with_capacity(shared.len());
        for shared in shared {
            let number = self.share(shared, &numbers)?;
            numbers.push(number);
        }
        numbers.sort_unstable();
        numbers.dedup();
        let globals = globals.into_iter().map(|global| self.ready(global));
        let globals = globals.collect::<Result<Vec<Ready>, Reason>>()?;
        let body = self.ready(body)?;
        let (native, template) =
            native.map_or(Ok(Default::default()), |native| self.native(native))?;
        Ok(TextPiece { header, shared: numbers, globals, body, native, template })
    }

    /// The number of what is shared; it is kept once.
    fn share(&mut self, shared: Shared, numbers: &[u32]) -> Result<u32, Reason> {
        let uses: Vec<u32> = shared.uses.iter().map(|place| numbers[*place]).collect();
        let key = (shared.fragment, uses);
        if let Some(number) = self.places.get(&key) {
            return Ok(*number);
        }
        let below = || key.1.iter().map(|number| &self.declarations[*number as usize]);
        let kind =
            below().map(|below| below.kind).max().map_or(shared.kind, |most| most.max(shared.kind));
        let height = below().map(|below| below.height + 1).max().unwrap_or(0);
        let ready = self.ready(key.0.clone())?;
        let number = self.declarations.len() as u32;
        self.declarations.push(Declared { ready, declares: shared.declares, kind, height });
        self.places.insert(key, number);
        Ok(number)
    }

    fn ready(&mut self, fragment: Fragment) -> Result<Ready, Reason> {
        let fragment = self.name_small(fragment)?;
        let mut names = Vec::new();
        for reference in &fragment.references {
            names.push(self.names.number(&reference.name)?);
        }
        names.sort_unstable();
        names.dedup();
        let known = &self.names;
        let text = fragment.render(&|reference| known.usual_of(reference).to_owned());
        let is_captured =
            |number: &u32| fragment.locals.iter().any(|local| local == known.usual(*number));
        let captured = names.iter().copied().filter(is_captured).collect();
        // Names with a mark in them are words too, as they nearly always are.
        let derived = super::words::words(&text).map(|word| word.text.to_owned());
        let all: BTreeSet<String> = derived.collect();
        let plain = |word: &String| {
            !fragment.locals.contains(word)
                && !names.iter().any(|name| self.names.usual(*name) == word)
        };
        let mut words: BTreeSet<String> = all.into_iter().filter(plain).collect();
        words.extend(fragment.words.iter().cloned());
        let words = words.into_iter().map(|word| self.names.word(word)).collect();
        Ok(Ready { fragment, text, names, captured, words })
    }

    /// Names the variables that a writer calls after a declaration: they belong to the function.
    fn name_small(&mut self, mut fragment: Fragment) -> Result<Fragment, Reason> {
        let small = fragment.references.iter().filter(|reference| reference.small);
        let small: BTreeSet<String> = small.map(|reference| reference.name.clone()).collect();
        for name in small {
            let mut taken: BTreeSet<String> =
                fragment.locals.iter().chain(&fragment.words).cloned().collect();
            for reference in fragment.references.iter().filter(|reference| !reference.small) {
                let number = self.names.number(&reference.name)?;
                taken.insert(self.names.usual(number).to_owned());
            }
            let number = self.names.number(&name.to_lowercase())?;
            let usual = self.names.usual(number).to_owned();
            let base = usual.trim_end_matches('_').to_owned();
            let mut numbered = (1..u32::MAX).map(|number| format!("{base}_{number}"));
            let free = match taken.contains(&usual) {
                false => usual,
                true => numbered.find(|name| !taken.contains(name)).ok_or(Reason::Clash)?,
            };
            fragment.settle(&name, &free);
        }
        Ok(fragment)
    }

    /// What the output calls things; with the text of it, where that has names of the author's.
    fn native(&mut self, template: Fragment) -> Result<(Arc<Native>, Option<Fragment>), Reason> {
        for reference in &template.references {
            self.names.number(&reference.name)?;
        }
        let text = template.render(&|reference| self.names.usual_of(reference).to_owned());
        let native = serde_json::from_str(&text).map_err(|_| Reason::Shape)?;
        Ok((Arc::new(native), (!template.references.is_empty()).then_some(template)))
    }

    /// Header, what is shared, what is bound, the functions, the entry point.
    fn link(
        &self,
        parts: &Parts<'_>,
        entry: &TextPiece,
        index: usize,
    ) -> Result<(Vec<u8>, Arc<Native>), Reason> {
        let mut pieces: Vec<&TextPiece> = Vec::with_capacity(parts.functions.len() + 1);
        for (_, unit) in &parts.functions {
            match piece(unit, index)? {
                Piece::Text(piece) => pieces.push(piece),
                Piece::Words { .. } => return Err(Reason::Shape),
            }
        }
        pieces.push(entry);
        let header = header(&pieces)?;
        let shared = self.shared(&pieces);
        let declared = shared.iter().map(|declared| &declared.ready);
        let globals = entry.globals.iter();
        let bodies = pieces.iter().map(|piece| &piece.body);
        let all: Vec<&Ready> = declared.chain(globals).chain(bodies).collect();
        let renames = self.names.choose(&all_of(&all))?;
        self.refuse_twins(&shared, &renames)?;
        self.refuse_derived(&all, &renames)?;
        let sections: [(Vec<&Ready>, &str); 3] = [
            (shared.iter().map(|declared| &declared.ready).collect(), "\n"),
            (entry.globals.iter().collect(), "\n"),
            (pieces.iter().map(|piece| &piece.body).collect(), "\n\n"),
        ];
        let mut text = header;
        for (fragments, gap) in sections {
            for (index, ready) in fragments.into_iter().enumerate() {
                let before = if index > 0 { gap } else { "\n\n" };
                text.push_str(if text.is_empty() { "" } else { before });
                if renames.is_empty() {
                    text.push_str(&ready.text);
                } else {
                    let name = |reference: &_| self.names.renamed(reference, &renames);
                    text.push_str(&ready.fragment.render(&name));
                }
            }
        }
        text.push('\n');
        let native = self.named(entry, &renames)?;
        Ok((text.into_bytes(), native))
    }

    /// A numbered name makes names that hold it others too: none may be a name of the author's.
    fn refuse_derived(
        &self,
        all: &[&Ready],
        renames: &BTreeMap<u32, String>,
    ) -> Result<(), Reason> {
        if renames.is_empty() {
            return Ok(());
        }
        let named = all.iter().flat_map(|ready| &ready.names);
        let finals: BTreeSet<&str> = named
            .map(|name| renames.get(name).map_or_else(|| self.names.usual(*name), String::as_str))
            .collect();
        for ready in all {
            let name = |reference: &_| self.names.renamed(reference, renames);
            let derived = ready.fragment.derived(&name);
            if derived.iter().any(|derived| finals.contains(&**derived)) {
                return Err(Reason::Clash);
            }
        }
        Ok(())
    }

    fn named(
        &self,
        entry: &TextPiece,
        renames: &BTreeMap<u32, String>,
    ) -> Result<Arc<Native>, Reason> {
        let Some(template) = entry.template.as_ref().filter(|_| !renames.is_empty()) else {
            return Ok(entry.native.clone());
        };
        let text = template.render(&|reference| self.names.renamed(reference, renames));
        serde_json::from_str(&text).map(Arc::new).map_err(|_| Reason::Shape)
    }

    /// What the pieces share, in the order to declare it in.
    fn shared(&self, pieces: &[&TextPiece]) -> Vec<&Declared> {
        let mut seen = vec![false; self.declarations.len()];
        let mut found: Vec<&Declared> = Vec::new();
        for number in pieces.iter().flat_map(|piece| &piece.shared) {
            if !std::mem::replace(&mut seen[*number as usize], true) {
                found.push(&self.declarations[*number as usize]);
            }
        }
        let order = |declared: &&Declared| (declared.kind, declared.height);
        found.sort_by(|one, other| {
            order(one).cmp(&order(other)).then_with(|| one.ready.text.cmp(&other.ready.text))
        });
        found
    }

    /// Two declarations of one name are one too many, unless their heads tell them apart.
    fn refuse_twins(
        &self,
        shared: &[&Declared],
        renames: &BTreeMap<u32, String>,
    ) -> Result<(), Reason> {
        let mut seen = BTreeSet::new();
        for declared in shared {
            let name =
                declared.declares.render(&|reference| self.names.renamed(reference, renames));
            let head = match declared.kind {
                Kind::Function => declared.ready.text.split('{').next().unwrap_or_default(),
                _ => "",
            };
            if !seen.insert((name, head)) {
                return Err(Reason::Clash);
            }
        }
        Ok(())
    }
}

fn all_of<'r>(ready: &[&'r Ready]) -> Vec<super::names::Used<'r>> {
    let used = |ready: &&'r Ready| super::names::Used {
        names: &ready.names,
        captured: &ready.captured,
        words: &ready.words,
        locals: &ready.fragment.locals,
    };
    ready.iter().map(used).collect()
}

/// The lines before all declarations: those that every piece has, and extensions of some.
fn header(pieces: &[&TextPiece]) -> Result<String, Reason> {
    let Some(last) = pieces.last() else { return Err(Reason::Header) };
    if pieces.iter().all(|piece| piece.header == last.header) {
        return Ok(last.header.clone());
    }
    let is_extra = |line: &&str| {
        ["#extension ", "enable ", "requires "].iter().any(|start| line.starts_with(start))
    };
    let plain = |header: &str| -> Vec<String> {
        header.lines().filter(|line| !is_extra(line)).map(str::to_owned).collect()
    };
    let common = plain(&last.header);
    if pieces.iter().any(|piece| plain(&piece.header) != common) {
        return Err(Reason::Header);
    }
    let extra: BTreeSet<&str> =
        pieces.iter().flat_map(|piece| piece.header.lines()).filter(is_extra).collect();
    // `#version` comes first in GLSL, and WGSL has no other lines.
    let first = common.iter().take(1).map(String::as_str);
    let rest = common.iter().skip(1).map(String::as_str);
    let lines: Vec<&str> = first.chain(extra).chain(rest).collect();
    Ok(lines.join("\n"))
}
