//! Keeps each unit once in every target, and links texts from units.

use rustc_hash::FxHashMap;
use std::collections::BTreeSet;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, PoisonError, RwLock, RwLockReadGuard, RwLockWriteGuard};

use super::cut::Cut;
use super::outline::ContentKey;
use super::reason::Reason;
use super::spirv;
use super::summary::FunctionSummary;
use super::texts::{TextPiece, Texts};
use super::translate::{Translated, WrittenUnit};
use lamplight_bundle::{Artifact, Native, Reflection, Target};
use lamplight_emit::targets;

/// The units that are kept. Each target has a lock of its own, so that a thread which keeps a unit
/// seldom waits for one that links a text.
pub struct Pool {
    units: RwLock<FxHashMap<ContentKey, Result<Arc<Unit>, Reason>>>,
    /// What the functions of each target share, in the order of the targets.
    texts: Vec<RwLock<Texts>>,
    words: RwLock<spirv::DeclarationPool>,
    /// Bytes of all units, roughly.
    size: AtomicUsize,
}

/// A translated unit.
pub struct Unit {
    pub summary: FunctionSummary,
    pub reflection: Option<Arc<Reflection>>,
    targets: Vec<Result<TargetPiece, Reason>>,
}

/// A unit in one target.
enum TargetPiece {
    Text(TextPiece),
    Words { piece: spirv::Piece, native: Arc<Native> },
}

/// What one text is linked from: the units of its functions, callees first, and that of its entry
/// point.
pub struct LinkParts<'p> {
    /// The author's names of the functions.
    pub functions: Vec<(&'p str, Arc<Unit>)>,
    pub entry: Arc<Unit>,
}

impl Pool {
    pub fn new(targets: &[Target]) -> Self {
        Self {
            units: RwLock::default(),
            texts: targets.iter().map(|target| RwLock::new(Texts::new(*target))).collect(),
            words: RwLock::default(),
            size: AtomicUsize::new(0),
        }
    }

    pub fn find(&self, key: &ContentKey) -> Option<Result<Arc<Unit>, Reason>> {
        read(&self.units).get(key).cloned()
    }

    /// Bytes of all units, roughly.
    pub fn size(&self) -> usize {
        self.size.load(Ordering::Relaxed)
    }

    /// Forgets all units. No text may be linked meanwhile, since its units belong to this pool.
    pub fn clear(&self, targets: &[Target]) {
        write(&self.units).clear();
        for (texts, target) in self.texts.iter().zip(targets) {
            *write(texts) = Texts::new(*target);
        }
        *write(&self.words) = spirv::DeclarationPool::default();
        self.size.store(0, Ordering::Relaxed);
    }

    /// Keeps a unit. `function` is the author's name of its function, `None` for an entry point.
    /// `callees` are the names of the functions that it may call. If two threads translate the same
    /// unit, one result is kept.
    pub fn keep(
        &self,
        key: ContentKey,
        translated: Result<Translated, Reason>,
        function: Option<&str>,
        callees: &BTreeSet<&str>,
    ) -> Result<Arc<Unit>, Reason> {
        if let Some(known) = self.find(&key) {
            return known;
        }
        let unit = translated.map(|translated| {
            let pieces = translated.targets.into_iter().zip(&self.texts);
            let pieces = pieces.map(|(written, texts)| match written? {
                WrittenUnit::Text { cut, native } => {
                    self.size.fetch_add(2 * cut.size(), Ordering::Relaxed);
                    Ok(TargetPiece::Text(write(texts).keep(cut, native)?))
                }
                WrittenUnit::Words { words, native } => {
                    self.size.fetch_add(size_of_val(words.as_slice()) / 2, Ordering::Relaxed);
                    words_piece(&mut write(&self.words), &words, native, function, callees)
                }
            });
            let targets = pieces.collect();
            let (summary, reflection) = (translated.summary, translated.reflection);
            Arc::new(Unit { summary, reflection, targets })
        });
        write(&self.units).entry(key).or_insert(unit).clone()
    }

    /// Links one target of a text. `text` is a buffer that is used again.
    ///
    /// # Errors
    /// The reason why this target of the text is compiled as a whole.
    pub fn link(
        &self,
        parts: &LinkParts<'_>,
        index: usize,
        target: Target,
        text: &mut String,
    ) -> Result<Artifact, Reason> {
        let texts = self.texts.get(index).ok_or(Reason::Shape)?;
        let (bytes, native) = match spirv_piece(&parts.entry, index)? {
            TargetPiece::Text(_) => {
                let native = read(texts).link(&text_pieces(parts, index)?, text)?;
                (text.as_bytes().into(), native)
            }
            TargetPiece::Words { piece, native } => {
                (self.link_words(parts, piece, index)?.into(), native.clone())
            }
        };
        let extension = targets::find(target).map_or("", |entry| entry.extension).to_owned();
        Ok(Artifact { bytes, extension, native })
    }

    fn link_words(
        &self,
        parts: &LinkParts<'_>,
        entry: &spirv::Piece,
        index: usize,
    ) -> Result<Vec<u8>, Reason> {
        let mut named: FxHashMap<&str, &spirv::Piece> = FxHashMap::default();
        for (name, unit) in &parts.functions {
            if let TargetPiece::Words { piece, .. } = spirv_piece(unit, index)? {
                named.insert(name, piece);
            }
        }
        let pool = read(&self.words);
        let words = spirv::assemble_module(&pool, entry, &|name| named.get(name).copied());
        let words = words.map_err(|_| Reason::Spirv)?;
        let mut bytes = Vec::with_capacity(4 * words.len());
        words.iter().for_each(|word| bytes.extend_from_slice(&word.to_le_bytes()));
        Ok(bytes)
    }
}

impl Unit {
    /// Whether the target cannot express the unit.
    pub fn is_refused(&self, index: usize) -> bool {
        matches!(self.targets.get(index), Some(Err(Reason::Refused)))
    }
}

fn read<T>(lock: &RwLock<T>) -> RwLockReadGuard<'_, T> {
    lock.read().unwrap_or_else(PoisonError::into_inner)
}

fn write<T>(lock: &RwLock<T>) -> RwLockWriteGuard<'_, T> {
    lock.write().unwrap_or_else(PoisonError::into_inner)
}

fn spirv_piece(unit: &Unit, index: usize) -> Result<&TargetPiece, Reason> {
    match unit.targets.get(index) {
        Some(piece) => piece.as_ref().map_err(|reason| *reason),
        None => Err(Reason::Shape),
    }
}

/// The pieces of a text: callees first, the entry point last.
fn text_pieces<'p>(parts: &'p LinkParts<'_>, index: usize) -> Result<Vec<&'p TextPiece>, Reason> {
    let units = parts.functions.iter().map(|(_, unit)| unit).chain([&parts.entry]);
    let text = |unit: &'p Arc<Unit>| match spirv_piece(unit, index)? {
        TargetPiece::Text(piece) => Ok(piece),
        TargetPiece::Words { .. } => Err(Reason::Shape),
    };
    units.map(text).collect()
}

fn words_piece(
    pool: &mut spirv::DeclarationPool,
    words: &[u32],
    native: Native,
    function: Option<&str>,
    callees: &BTreeSet<&str>,
) -> Result<TargetPiece, Reason> {
    let is_author = |name: &str| function == Some(name) || callees.contains(name);
    let is_wanted = |name: &str| function.unwrap_or(&native.entry_name) == name;
    let parts =
        spirv::split_module(words, pool, &is_author, &is_wanted).map_err(|_| Reason::Spirv)?;
    let mut functions = parts.functions.into_iter();
    let piece = match function {
        Some(name) => functions.find(|(found, _)| found == name).map(|(_, piece)| piece),
        None => parts.entry,
    };
    Ok(TargetPiece::Words { piece: piece.ok_or(Reason::Spirv)?, native: Arc::new(native) })
}

impl Cut {
    fn size(&self) -> usize {
        self.body.text.len() + self.globals.iter().map(|global| global.text.len()).sum::<usize>()
    }
}
