//! A fragment that is prepared to be written into texts. Its own text has the usual names, with a
//! list of the places where a text may need other names.

use std::collections::BTreeSet;
use std::ops::Range;

use super::cut::{DeclarationReference, TextFragment};
use super::names::{ChosenNames, OutputNames, Renames};
use super::reason::Reason;
use lamplight_emit::glsl;
use lamplight_syntax::words::{word_around, words};

/// A text in which every reference has its usual name.
pub struct Template {
    pub text: String,
    spots: Vec<Spot>,
}

/// Where a reference stands, and the number of its name.
#[derive(Debug, Clone, Copy)]
struct Spot {
    start: usize,
    end: usize,
    name: u32,
}

impl Template {
    /// Makes a template. A reference in lower case always keeps its usual name.
    pub fn new(fragment: &TextFragment, names: &mut OutputNames) -> Result<Self, Reason> {
        for reference in &fragment.references {
            names.number(&reference.name)?;
        }
        let length = fragment.text.len() + 16 * fragment.references.len();
        let (mut text, mut at) = (String::with_capacity(length), 0);
        let mut spots = Vec::with_capacity(fragment.references.len());
        for reference in &fragment.references {
            text.push_str(&fragment.text[at..reference.at]);
            at = reference.at;
            let start = text.len();
            let usual = names.usual_of(reference);
            let is_block = fragment.text[at..].starts_with(glsl::BLOCK);
            text.push_str(if is_block { glsl::before_block(usual) } else { usual });
            if !reference.small {
                let name = names.number(&reference.name)?;
                spots.push(Spot { start, end: text.len(), name });
            }
        }
        text.push_str(&fragment.text[at..]);
        Ok(Self { text, spots })
    }

    /// Whether it has no references.
    pub fn is_plain(&self) -> bool {
        self.spots.is_empty()
    }

    pub fn is_renamed(&self, renames: &Renames) -> bool {
        self.spots.iter().any(|spot| renames.contains_key(&spot.name))
    }

    /// Appends the text, with the renamed names in the places of their usual ones.
    pub fn write(&self, renames: &Renames, out: &mut String) {
        self.write_part(0..self.text.len(), &self.spots, renames, out);
    }

    fn write_part(&self, part: Range<usize>, spots: &[Spot], renames: &Renames, out: &mut String) {
        let mut at = part.start;
        for spot in spots {
            if let Some(name) = renames.get(&spot.name) {
                out.push_str(&self.text[at..spot.start]);
                out.push_str(name);
                at = spot.end;
            }
        }
        out.push_str(&self.text[at..part.end]);
    }
}

/// A template, with its names and identifiers as numbers.
pub struct ReadyTemplate {
    pub template: Template,
    /// The author's names that it refers to.
    pub names: NumberSet,
    /// Names that it cannot refer to by their usual form, since it declares that identifier itself.
    pub captured: Vec<u32>,
    /// Identifiers that are neither references nor declared by the fragment itself.
    pub words: NumberSet,
    /// Identifiers that the fragment declares itself.
    pub locals: Vec<u32>,
    derived: Vec<Derived>,
}

/// A set of numbers as blocks of bits. Sets are united often, and their numbers lie close together.
pub struct NumberSet(Vec<(u32, u64)>);

impl NumberSet {
    pub fn new(sorted: &[u32]) -> Self {
        let mut blocks: Vec<(u32, u64)> = Vec::new();
        for number in sorted {
            let (block, bit) = (number / 64, 1 << (number % 64));
            match blocks.last_mut() {
                Some((last, bits)) if *last == block => *bits |= bit,
                _ => blocks.push((block, bit)),
            }
        }
        blocks.shrink_to_fit();
        Self(blocks)
    }

    /// Whether the sets share a number. `bits` must have room for all of its own.
    pub fn meets(&self, bits: &Bits) -> bool {
        self.0.iter().any(|(block, own)| bits.0[*block as usize] & own != 0)
    }

    /// Adds its numbers to `bits`, which must have room for them.
    pub fn add_to(&self, bits: &mut Bits) {
        for (block, more) in &self.0 {
            bits.0[*block as usize] |= more;
        }
    }
}

/// A set of numbers below a bound.
pub struct Bits(Vec<u64>);

impl Bits {
    pub fn new(bound: usize) -> Self {
        Self(vec![0; bound.div_ceil(64)])
    }

    pub fn has(&self, number: usize) -> bool {
        self.0[number / 64] & 1 << (number % 64) != 0
    }

    /// Adds a number, and returns whether it was there already.
    pub fn insert(&mut self, number: usize) -> bool {
        let had = self.has(number);
        self.0[number / 64] |= 1 << (number % 64);
        had
    }

    /// All numbers, in order.
    pub fn numbers(&self) -> impl Iterator<Item = usize> {
        self.0.iter().enumerate().flat_map(|(block, bits)| {
            let mut left = *bits;
            std::iter::from_fn(move || {
                let bit = left.trailing_zeros() as usize;
                left &= left.checked_sub(1)?;
                Some(64 * block + bit)
            })
        })
    }
}

/// An identifier that the writer made from a reference, such as `ConstructMaterial`.
struct Derived {
    /// Its number, with all names in their usual form.
    word: u32,
    place: Range<usize>,
    spots: Range<usize>,
}

impl ReadyTemplate {
    pub fn new(fragment: TextFragment, names: &mut OutputNames) -> Result<Self, Reason> {
        let fragment = name_small(fragment, names)?;
        let template = Template::new(&fragment, names)?;
        let numbers = template.spots.iter().map(|spot| spot.name).collect();
        let named: Vec<u32> = sorted_numbers(numbers);
        let locals = fragment.locals.iter().map(|local| names.word(local)).collect();
        let locals: Vec<u32> = sorted_numbers(locals);
        let is_local = |word: &u32| locals.binary_search(word).is_ok();
        let usual = named.iter().map(|name| names.usual_word(*name)).collect();
        let usual: Vec<u32> = sorted_numbers(usual);
        let is_captured = |name: &u32| is_local(&names.usual_word(*name));
        let captured = named.iter().copied().filter(is_captured).collect();
        let derived = find_derived(&template, names);
        // Identifiers with references in them count as words too, in their usual form.
        let all = words(&template.text).map(|word| names.word(word.text)).collect();
        let mut known: Vec<u32> = sorted_numbers(all);
        known.retain(|word| !is_local(word) && usual.binary_search(word).is_err());
        let plain = fragment.words().map(|word| names.word(word));
        known.extend(plain.filter(|word| !is_local(word)));
        let (names, words) = (NumberSet::new(&named), NumberSet::new(&sorted_numbers(known)));
        Ok(Self { template, names, captured, words, locals, derived })
    }

    /// Appends the text, with the names that were chosen for it.
    pub fn write(&self, chosen: &ChosenNames, out: &mut String) {
        if self.names.meets(&chosen.renamed) {
            self.template.write(&chosen.renames, out);
        } else {
            out.push_str(&self.template.text);
        }
    }

    /// The identifiers that the writer made from references, with the names that were chosen.
    pub fn derived(&self, renames: &Renames) -> impl Iterator<Item = Identifier> {
        self.derived.iter().map(|derived| {
            let spots = &self.template.spots[derived.spots.clone()];
            if spots.iter().any(|spot| renames.contains_key(&spot.name)) {
                let mut text = String::new();
                self.template.write_part(derived.place.clone(), spots, renames, &mut text);
                Identifier::Text(text)
            } else {
                Identifier::Usual(derived.word)
            }
        })
    }
}

/// An identifier of a text that may be new to the target.
pub enum Identifier {
    /// Known, by its number.
    Usual(u32),
    Text(String),
}

/// The numbers, sorted and each once.
fn sorted_numbers(mut numbers: Vec<u32>) -> Vec<u32> {
    numbers.sort_unstable();
    numbers.dedup();
    numbers
}

/// Finds the identifiers that are longer than the references in them.
fn find_derived(template: &Template, names: &mut OutputNames) -> Vec<Derived> {
    let mut derived: Vec<Derived> = Vec::new();
    for (index, spot) in template.spots.iter().enumerate() {
        if let Some(last) = derived.last_mut()
            && spot.start < last.place.end
        {
            last.spots.end = index + 1;
            continue;
        }
        let place = word_around(&template.text, spot.start..spot.end);
        if place != (spot.start..spot.end) {
            let word = names.word(&template.text[place.clone()]);
            derived.push(Derived { word, place, spots: index..index + 1 });
        }
    }
    derived
}

/// Gives their final names to the variables that the writer named after a declaration: they are
/// locals of the function.
fn name_small(mut fragment: TextFragment, names: &mut OutputNames) -> Result<TextFragment, Reason> {
    let small = fragment.references.iter().filter(|reference| reference.small);
    let small: BTreeSet<String> = small.map(|reference| reference.name.clone()).collect();
    for name in small {
        let mut taken: BTreeSet<String> = fragment.locals.iter().cloned().collect();
        taken.extend(fragment.words().map(str::to_owned));
        for reference in fragment.references.iter().filter(|reference| !reference.small) {
            let number = names.number(&reference.name)?;
            taken.insert(names.usual(number).to_owned());
        }
        let number = names.number(&name.to_lowercase())?;
        let usual = names.usual(number).to_owned();
        let base = usual.trim_end_matches('_').to_owned();
        let around = around_small(&fragment, &name);
        // naga appends numbers to such a name, which may give the name of another local.
        let is_free = |name: &String| {
            around.iter().all(|(start, end)| !taken.contains(&format!("{start}{name}{end}")))
        };
        let numbered = (1..u32::MAX).map(|number| format!("{base}_{number}"));
        let mut candidates = std::iter::once(usual).chain(numbered);
        let free = candidates.find(is_free).ok_or(Reason::Clash)?;
        fragment.settle(&name, &free);
    }
    Ok(fragment)
}

/// For each identifier with a reference in lower case to `name`: its parts before and after the
/// reference.
fn around_small(fragment: &TextFragment, name: &str) -> BTreeSet<(String, String)> {
    let is_it = |reference: &&DeclarationReference| reference.small && reference.name == name;
    let around = |reference: &DeclarationReference| {
        let place = word_around(&fragment.text, reference.at..reference.at);
        let start = fragment.text[place.start..reference.at].to_owned();
        (start, fragment.text[reference.at..place.end].to_owned())
    };
    fragment.references.iter().filter(is_it).map(around).collect()
}
