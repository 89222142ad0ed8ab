//! Functions in every target, each once, and texts put together from them.

use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

use super::outline::{Key, Outline};
use super::spirv;
use super::take::{Headers, Names, Piece, Shared, Taken, TakenTarget, TakenText, TakenWords};
use crate::bundle::{Artifact, Native, Reflection, Stage, Target, Unit};
use crate::emit::targets;

/// What is kept.
pub struct Pool {
    /// The number of each function; by it, pieces are found in every target.
    numbers: HashMap<Key, usize>,
    /// In the order of the targets; SPIR-V has no text.
    texts: Vec<Texts>,
    words: Words,
    points: BTreeMap<Key, Point>,
    /// Bytes of all pieces, roughly.
    size: usize,
}

/// What an entry point says of itself.
struct Point {
    reflection: Arc<Reflection>,
    natives: Vec<Arc<Native>>,
}

/// One target that is a text.
struct Texts {
    headers: Headers,
    /// What functions share, each once, after all that it uses.
    shared: Vec<Shared>,
    places: HashMap<Piece, u32>,
    /// The place of each in the order in which they are declared.
    ranks: Vec<u32>,
    /// What is shared, in that order.
    ranked: Vec<u32>,
    functions: Vec<Option<Piece>>,
    /// By entry point, in the order of the text.
    globals: BTreeMap<Key, Vec<Piece>>,
}

#[derive(Default)]
struct Words {
    pool: spirv::Pool,
    functions: Vec<Option<spirv::Piece>>,
}

impl Pool {
    pub fn new(names: &Names) -> Self {
        let texts = names.headers.iter().map(|headers| Texts {
            headers: headers.clone(),
            shared: Vec::new(),
            places: HashMap::new(),
            ranks: Vec::new(),
            ranked: Vec::new(),
            functions: Vec::new(),
            globals: BTreeMap::new(),
        });
        Self { numbers: HashMap::new(), texts: texts.collect(), words: Words::default(), points: BTreeMap::new(), size: 0 }
    }

    /// Keeps functions, and the entry point that came with them.
    pub fn keep(&mut self, taken: Taken) -> Result<(), String> {
        let Taken { targets, functions, point } = taken;
        self.size += targets.iter().map(TakenTarget::size).sum::<usize>();
        for key in &functions {
            let next = self.numbers.len();
            self.numbers.entry(*key).or_insert(next);
        }
        let number = |key: &Key| functions.contains(key).then(|| self.numbers.get(key).copied()).flatten();
        for (texts, taken) in self.texts.iter_mut().zip(targets) {
            match taken {
                TakenTarget::Text(text) => texts.keep(text, &number, point.as_ref().map(|point| point.key)),
                TakenTarget::Words(words) => self.words.keep(&words, &number)?,
            }
        }
        self.points.extend(point.map(|point| (point.key, Point { reflection: point.reflection, natives: point.natives })));
        Ok(())
    }

    /// Bytes of all pieces, roughly.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Puts what is shared in its order. To be called before anything is linked.
    pub fn settle(&mut self) {
        self.texts.iter_mut().for_each(Texts::settle);
    }

    /// The text from what is kept; `None` where something is missing.
    pub fn link(&self, outline: &Outline<'_>, targets: &[Target]) -> Option<Unit> {
        let entry = outline.functions().last()?.key;
        let functions: Vec<(&str, usize)> =
            outline.functions().map(|function| Some((function.name, *self.numbers.get(&function.key)?))).collect::<Option<_>>()?;
        let point = self.points.get(&entry)?;
        let mut artifacts = BTreeMap::new();
        for ((target, texts), native) in targets.iter().zip(&self.texts).zip(&point.natives) {
            let bytes = match *target {
                Target::SPIRV => self.words.link(&functions)?,
                _ => texts.link(&functions, entry, point.reflection.stage)?.into_bytes(),
            };
            let extension = targets::find(*target).map_or("", |entry| entry.extension).to_owned();
            artifacts.insert(target.name().to_owned(), Artifact { bytes: bytes.into(), extension, native: native.clone() });
        }
        Some(Unit { reflection: point.reflection.clone(), targets: artifacts })
    }
}

impl Texts {
    fn keep(&mut self, taken: TakenText, number: &dyn Fn(&Key) -> Option<usize>, entry: Option<Key>) {
        let mut places: Vec<u32> = Vec::with_capacity(taken.shared.len());
        for shared in taken.shared {
            places.push(self.share(shared, &places));
        }
        for (key, piece) in taken.functions {
            put(&mut self.functions, number(&key), || moved(piece, &places));
        }
        let globals = taken.globals.into_iter().map(|piece| moved(piece, &places));
        self.globals.extend(entry.map(|entry| (entry, globals.collect())));
    }

    /// The place of what is shared; it is kept once.
    fn share(&mut self, shared: Shared, places: &[u32]) -> u32 {
        let piece = moved(shared.piece, places);
        let next = self.shared.len() as u32;
        let place = *self.places.entry(piece.clone()).or_insert(next);
        if place == next {
            self.shared.push(Shared { piece, ..shared });
        }
        place
    }

    /// Header, what is shared, what is bound, the functions, the entry point.
    fn link(&self, functions: &[(&str, usize)], entry: Key, stage: Stage) -> Option<String> {
        let functions = functions.iter().map(|(_, number)| self.functions.get(*number)?.as_ref()).collect::<Option<Vec<&Piece>>>()?;
        let globals = self.globals.get(&entry)?;
        let shared = self.reached(functions.iter().copied().chain(globals));
        let header = &self.headers[usize::from(stage == Stage::Fragment)];
        let globals: Vec<&Piece> = globals.iter().collect();
        let sections = [(shared, "\n"), (globals, "\n"), (functions, "\n\n")];
        let length = sections.iter().flat_map(|(pieces, _)| pieces).map(|piece| piece.text.len() + 2).sum::<usize>();
        let mut text = String::with_capacity(header.len() + length + 8);
        text.push_str(header);
        for (pieces, gap) in sections {
            for (index, piece) in pieces.iter().enumerate() {
                let before = if index > 0 { gap } else { "\n\n" };
                text.push_str(if text.is_empty() { "" } else { before });
                text.push_str(&piece.text);
            }
        }
        text.push('\n');
        Some(text)
    }

    /// What is shared and used, in the order to declare it in.
    fn reached<'p>(&self, from: impl Iterator<Item = &'p Piece>) -> Vec<&Piece> {
        let mut seen = vec![false; self.shared.len()];
        let mut open: Vec<u32> = from.flat_map(|piece| piece.uses.iter().copied()).collect();
        let mut found = Vec::new();
        while let Some(place) = open.pop() {
            if !std::mem::replace(&mut seen[place as usize], true) {
                open.extend(&self.shared[place as usize].piece.uses);
                found.push(self.ranks[place as usize]);
            }
        }
        found.sort_unstable();
        found.into_iter().map(|rank| &self.shared[self.ranked[rank as usize] as usize].piece).collect()
    }

    fn settle(&mut self) {
        self.ranked = (0..self.shared.len() as u32).collect();
        self.ranked.sort_by_key(|place| {
            let shared = &self.shared[*place as usize];
            (shared.kind, shared.height, &shared.name, &shared.piece.text)
        });
        self.ranks = vec![0; self.shared.len()];
        for (rank, place) in self.ranked.iter().enumerate() {
            self.ranks[*place as usize] = rank as u32;
        }
    }
}

impl Words {
    fn keep(&mut self, taken: &TakenWords, number: &dyn Fn(&Key) -> Option<usize>) -> Result<(), String> {
        let key = |name: &str| if name == taken.entry_name { Some(&taken.entry) } else { taken.names.get(name) };
        let wanted = |name: &str| key(name).is_some_and(|key| number(key).is_some());
        let parts = spirv::split(&taken.words, &mut self.pool, &|name| taken.names.contains_key(name), &wanted)?;
        for (name, piece) in parts.functions {
            put(&mut self.functions, taken.names.get(&name).and_then(number), || piece);
        }
        if let Some(entry) = parts.entry {
            put(&mut self.functions, number(&taken.entry), || entry);
        }
        Ok(())
    }

    fn link(&self, functions: &[(&str, usize)]) -> Option<Vec<u8>> {
        let piece = |number: usize| self.functions.get(number)?.as_ref();
        let named: HashMap<&str, usize> = functions.iter().copied().collect();
        let (_, entry) = functions.last()?;
        let words = spirv::assemble(&self.pool, piece(*entry)?, &|name| piece(*named.get(name)?)).ok()?;
        let mut bytes = Vec::with_capacity(4 * words.len());
        words.iter().for_each(|word| bytes.extend_from_slice(&word.to_le_bytes()));
        Some(bytes)
    }
}

/// Puts something in its numbered place; without a number, nowhere.
fn put<T>(places: &mut Vec<Option<T>>, number: Option<usize>, value: impl FnOnce() -> T) {
    if let Some(number) = number {
        places.resize_with(places.len().max(number + 1), || None);
        places[number] = Some(value());
    }
}

/// A piece whose uses are places of the pool.
fn moved(piece: Piece, places: &[u32]) -> Piece {
    Piece { uses: piece.uses.iter().map(|place| places[*place as usize]).collect(), ..piece }
}
