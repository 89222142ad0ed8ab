//! What a text was compiled to, by functions.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::{Arc, PoisonError, RwLock};

use naga::valid::{ValidationFlags, Validator};
use naga::{Constant, Expression, Literal, Module, Scalar, ShaderStage, Span, Type, TypeInner};

use super::local::{FirstNames, Locals};
use super::outline::{Key, Kind, Outline};
use super::text::{self, Declared};
use super::words::words;
use crate::bundle::{Native, Reflection, Target};
use crate::compose::Language;
use crate::emit::{Emitted, emit};
use crate::validate::{CAPABILITIES, Validated};

/// A text in every target: SPIR-V as naga writes it, texts of the module with marked names.
pub struct Whole {
    pub reflection: Arc<Reflection>,
    pub emitted: Vec<Emitted>,
}

/// Functions of one text in every target, and what they need.
pub struct Taken {
    /// In the order of the targets.
    pub targets: Vec<TakenTarget>,
    pub functions: BTreeSet<Key>,
    /// The entry point, if it is among the functions.
    pub point: Option<TakenPoint>,
}

pub struct TakenPoint {
    pub key: Key,
    pub reflection: Arc<Reflection>,
    pub natives: Vec<Arc<Native>>,
}

/// What a text was compiled to in one target.
pub enum TakenTarget {
    Text(TakenText),
    Words(TakenWords),
}

impl TakenTarget {
    /// Bytes, roughly.
    pub fn size(&self) -> usize {
        match self {
            Self::Text(text) => text.functions.values().chain(&text.globals).map(|piece| piece.text.len()).sum(),
            Self::Words(words) => size_of_val(words.words.as_slice()) / words.names.len().max(1),
        }
    }
}

pub struct TakenText {
    /// What functions share, each after what it uses; uses are indices into this list.
    pub shared: Vec<Shared>,
    /// In the order of the text.
    pub globals: Vec<Piece>,
    pub functions: BTreeMap<Key, Piece>,
}

pub struct TakenWords {
    pub words: Vec<u32>,
    /// The author's functions, without the entry point.
    pub names: BTreeMap<String, Key>,
    pub entry: Key,
    pub entry_name: String,
}

/// What every text of a target begins with, if it needs nothing special, by stage.
pub type Headers = [String; 2];

/// A text, and what it uses of what is shared.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct Piece {
    pub text: String,
    pub uses: Vec<u32>,
}

/// A type, a constant, or a function of the writer's own.
#[derive(Debug)]
pub struct Shared {
    pub name: String,
    pub piece: Piece,
    /// No less than that of anything it uses: declarations are written in this order,
    pub kind: text::Kind,
    /// and then in this one, more than that of anything it uses.
    pub height: u32,
}

/// Declarations within each other after which a function is taken to call anything.
const DEPTH: usize = 32;

/// Whether to take functions that call one of several functions of one name, all that the module
/// has: for other modules that would be too many.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Overloads {
    Take,
    Leave,
}

/// What is known of the way that naga writes each target.
pub struct Names {
    /// In the order of the targets.
    pub headers: Vec<Headers>,
    /// What naga calls the first declaration of a name, in the order of the targets.
    first: RwLock<Vec<FirstNames>>,
}

/// Takes the wanted functions out of a text's outputs.
pub fn take(
    outline: &Outline<'_>,
    whole: Whole,
    targets: &[Target],
    names: &Names,
    wanted: &dyn Fn(&Key) -> bool,
    overloads: Overloads,
) -> Result<Taken, String> {
    let authors: BTreeMap<&str, Key> = outline.functions().map(|function| (function.name, function.key)).collect();
    let entry = outline.functions().find(|function| function.kind == Kind::Entry).map(|entry| entry.key).ok_or("no entry point")?;
    let mut functions: BTreeSet<Key> = authors.values().copied().filter(|key| wanted(key)).collect();
    let stage = usize::from(whole.reflection.stage == crate::bundle::Stage::Fragment);
    let (mut taken, mut natives, mut left) = (Vec::new(), Vec::new(), BTreeSet::new());
    for (index, (target, emitted)) in targets.iter().zip(whole.emitted).enumerate() {
        taken.push(if *target == Target::SPIRV {
            words_of(&emitted.bytes, &authors, entry, &emitted.native.entry_name)
        } else {
            let text = std::str::from_utf8(&emitted.bytes).map_err(|error| error.to_string())?;
            let (header, declared) = text::split(text)?;
            if header != names.headers[index][stage] {
                return Err(format!("an unusual header: {header}"));
            }
            let output = Output::new(&declared, &authors, entry, &emitted.native.entry_name);
            output.take(&functions, &mut left, functions.contains(&entry), &|text| names.plain(index, *target, text, &output.names))?
        });
        natives.push(Arc::new(emitted.native));
    }
    if overloads == Overloads::Leave {
        functions.retain(|key| !left.contains(key));
    }
    let point = functions.contains(&entry).then_some(TakenPoint { key: entry, reflection: whole.reflection, natives });
    Ok(Taken { targets: taken, functions, point })
}

fn words_of(bytes: &[u8], authors: &BTreeMap<&str, Key>, entry: Key, entry_name: &str) -> TakenTarget {
    let words = bytes.as_chunks::<4>().0.iter().map(|word| u32::from_le_bytes(*word)).collect();
    let names = authors.iter().filter(|(_, key)| **key != entry).map(|(name, key)| ((*name).to_owned(), *key)).collect();
    TakenTarget::Words(TakenWords { words, names, entry, entry_name: entry_name.to_owned() })
}

/// One output text, its declarations told apart.
struct Output<'a> {
    declared: &'a [Declared<'a>],
    /// Of all declarations.
    names: BTreeSet<&'a str>,
    /// The author's functions by their place in the text.
    authors: BTreeMap<usize, Key>,
    /// Indices of what is shared, by name.
    shared: BTreeMap<&'a str, Vec<usize>>,
}

/// What of the shared declarations is needed so far.
#[derive(Default)]
struct Needed {
    shared: Vec<Shared>,
    /// By their place in the text.
    places: BTreeMap<usize, u32>,
}

impl<'a> Output<'a> {
    fn new(declared: &'a [Declared<'a>], authors: &BTreeMap<&str, Key>, entry: Key, entry_name: &str) -> Self {
        // A name that a language has taken, or that ends with a digit, has an underscore after it.
        let author = |name: &str| match name == entry_name {
            true => Some(entry),
            false => authors.get(name).or_else(|| authors.get(name.strip_suffix('_')?)).copied(),
        };
        let is_function = |declared: &&Declared<'_>| declared.kind == text::Kind::Function;
        let functions = declared.iter().enumerate().filter(|(_, declared)| is_function(declared));
        let authors: BTreeMap<usize, Key> = functions.filter_map(|(index, declared)| Some((index, author(declared.name)?))).collect();
        let mut shared: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
        for (index, declared) in declared.iter().enumerate() {
            if declared.kind != text::Kind::Global && !authors.contains_key(&index) {
                shared.entry(declared.name).or_default().push(index);
            }
        }
        Self { declared, names: declared.iter().map(|declared| declared.name).collect(), authors, shared }
    }

    /// Takes the wanted functions, with what they need; what is bound comes with the entry point.
    fn take(
        &self,
        wanted: &BTreeSet<Key>,
        left: &mut BTreeSet<Key>,
        entry: bool,
        plain: &dyn Fn(&str) -> Result<String, String>,
    ) -> Result<TakenTarget, String> {
        let mut needed = Needed::default();
        let globals = self.declared.iter().filter(|declared| entry && declared.kind == text::Kind::Global);
        let globals = globals.map(|declared| self.piece(declared.text, declared.text.to_owned(), &mut needed)).collect::<Result<_, _>>()?;
        let mut functions = BTreeMap::new();
        for (index, key) in self.authors.iter().filter(|(_, key)| wanted.contains(*key)) {
            let written = self.declared[*index].text;
            let piece = self.piece(written, plain(written)?, &mut needed)?;
            if self.calls_overloads(written, 0) {
                left.insert(*key);
            }
            if functions.insert(*key, piece).is_some() {
                return Err("two functions of one name".to_owned());
            }
        }
        match functions.len() == wanted.len() {
            true => Ok(TakenTarget::Text(TakenText { shared: needed.shared, globals, functions })),
            false => Err("a function was not written".to_owned()),
        }
    }

    /// A text with what it uses: as it was written, for a local may be called as something shared.
    fn piece(&self, written: &str, text: String, needed: &mut Needed) -> Result<Piece, String> {
        let uses = self.uses(written).into_iter().map(|used| self.share(used, needed, 0)).collect::<Result<_, _>>()?;
        Ok(Piece { text, uses })
    }

    /// The place of a shared declaration, after those that it uses.
    fn share(&self, index: usize, needed: &mut Needed, depth: usize) -> Result<u32, String> {
        if let Some(place) = needed.places.get(&index) {
            return Ok(*place);
        }
        let Declared { kind, name, text } = self.declared[index];
        if depth > self.declared.len() {
            return Err(format!("`{name}` uses itself"));
        }
        // Functions of one name do not use each other.
        let used = self.uses(text).into_iter().filter(|used| self.declared[*used].name != name);
        let uses = used.map(|used| self.share(used, needed, depth + 1)).collect::<Result<Vec<u32>, _>>()?;
        let below = || uses.iter().map(|place| &needed.shared[*place as usize]);
        let kind = below().map(|shared| shared.kind).max().map_or(kind, |most| most.max(kind));
        let height = below().map(|shared| shared.height + 1).max().unwrap_or(0);
        let place = needed.shared.len() as u32;
        needed.places.insert(index, place);
        needed.shared.push(Shared { name: name.to_owned(), piece: Piece { text: text.to_owned(), uses }, kind, height });
        Ok(place)
    }

    /// Shared declarations that a text names, each once.
    fn uses(&self, text: &str) -> BTreeSet<usize> {
        let named = words(text).filter(|word| word.before != b'.').filter_map(|word| self.shared.get(word.text));
        named.flatten().copied().collect()
    }

    /// Whether a text calls, itself or through others, one of several functions of a name.
    fn calls_overloads(&self, text: &str, depth: usize) -> bool {
        let named: BTreeSet<&Vec<usize>> =
            words(text).filter(|word| word.before != b'.').filter_map(|word| self.shared.get(word.text)).collect();
        named.into_iter().any(|found| match found.as_slice() {
            [used] => self.declared[*used].text != text && (depth > DEPTH || self.calls_overloads(self.declared[*used].text, depth + 1)),
            _ => true,
        })
    }
}

impl Names {
    pub fn new(targets: &[Target]) -> Self {
        let header = |target: Target, stage| {
            let emitted = trivial(&BTreeSet::new(), stage).and_then(|module| written(&module, target));
            emitted.ok().and_then(|text| Some(text::split(&text).ok()?.0.to_owned())).unwrap_or_default()
        };
        let headers = targets.iter().map(|target| match *target {
            Target::SPIRV => Default::default(),
            target => [header(target, ShaderStage::Vertex), header(target, ShaderStage::Fragment)],
        });
        Self { headers: headers.collect(), first: RwLock::new(vec![FirstNames::new(); targets.len()]) }
    }

    /// The text of a function with the names it has in a module by itself.
    fn plain(&self, index: usize, target: Target, text: &str, modules: &BTreeSet<&str>) -> Result<String, String> {
        let locals = Locals::read(text, modules);
        let missing = |first: &FirstNames| locals.bases().filter(|base| !first.contains_key(*base)).collect::<BTreeSet<&str>>();
        let new = missing(&self.first.read().unwrap_or_else(PoisonError::into_inner)[index]);
        if !new.is_empty() {
            let names = first_names(&new, target)?;
            self.first.write().unwrap_or_else(PoisonError::into_inner)[index].extend(names);
        }
        locals.plain(&self.first.read().unwrap_or_else(PoisonError::into_inner)[index])
    }
}

/// What naga calls the first declaration of each name: those of constants, which it writes in
/// their order.
fn first_names(bases: &BTreeSet<&str>, target: Target) -> Result<FirstNames, String> {
    let text = written(&trivial(bases, ShaderStage::Fragment)?, target)?;
    let (_, declared) = text::split(&text)?;
    let constants: Vec<&str> = declared.iter().filter(|declared| declared.kind == text::Kind::Constant).map(|found| found.name).collect();
    match constants.len() == bases.len() {
        true => Ok(bases.iter().zip(constants).map(|(base, name)| ((*base).to_owned(), name.to_owned())).collect()),
        false => Err("a constant was not written".to_owned()),
    }
}

fn written(module: &Validated, target: Target) -> Result<String, String> {
    let emitted = emit(module, ENTRY, target).map_err(|error| error.message)?;
    String::from_utf8(emitted.bytes).map_err(|error| error.to_string())
}

const ENTRY: &str = "lamplight_entry";

/// A stage that does nothing, beside constants of the given names.
fn trivial(names: &BTreeSet<&str>, stage: ShaderStage) -> Result<Validated, String> {
    let text = match stage {
        ShaderStage::Vertex => format!("@vertex fn {ENTRY}() -> @builtin(position) vec4f {{ return vec4f(); }}"),
        _ => format!("@fragment fn {ENTRY}() {{}}"),
    };
    let mut module: Module = naga::front::wgsl::parse_str(&text).map_err(|error| error.to_string())?;
    let ty = module.types.insert(Type { name: None, inner: TypeInner::Scalar(Scalar::U32) }, Span::UNDEFINED);
    let init = module.global_expressions.append(Expression::Literal(Literal::U32(0)), Span::UNDEFINED);
    for name in names {
        module.constants.append(Constant { name: Some((*name).to_owned()), ty, init }, Span::UNDEFINED);
    }
    let info = Validator::new(ValidationFlags::empty(), CAPABILITIES).validate(&module).map_err(|error| error.to_string())?;
    Ok(Validated { language: Language::Wesl, module, info })
}
