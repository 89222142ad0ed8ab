//! What the functions of one target share, and how texts of that target are put together.

use std::collections::BTreeSet;
use std::sync::Arc;

use rustc_hash::FxHashMap;

use super::cut::{Cut, Shared, TextFragment};
use super::names::{ChosenNames, OutputNames, Renames};
use super::ready::{ReadyTemplate, Template};
use super::reason::Reason;
use super::text::OutputKind;
use lamplight_bundle::{Native, Target};

/// Everything that is kept for one target.
#[derive(Default)]
pub struct Texts {
    names: OutputNames,
    headers: Vec<String>,
    declarations: Vec<PooledDeclaration>,
    places: FxHashMap<(TextFragment, Vec<u32>), u32>,
    /// The declarations, in the order in which a text writes them.
    order: Vec<u32>,
    /// For each declaration its rank in that order. Declarations that are written alike have the
    /// same rank.
    ranks: Vec<u32>,
    /// Declarations of the same name and head have the same number: a text can have one of them.
    twins: FxHashMap<(String, String), u32>,
}

/// A unit in one target.
pub struct TextPiece {
    /// The number of its header, the lines before all declarations.
    header: u32,
    /// Numbers of the shared declarations that it needs, sorted.
    shared: Vec<u32>,
    globals: Vec<ReadyTemplate>,
    body: ReadyTemplate,
    native: Arc<Native>,
    /// The native names as a template, where names of the author's are among them.
    template: Option<Template>,
}

/// A declaration that functions share.
struct PooledDeclaration {
    ready: ReadyTemplate,
    declares: Template,
    twin: u32,
    /// Texts sort declarations by kind, and those of one kind by height. The kind is never lower
    /// than that of a declaration that this one uses.
    kind: OutputKind,
    /// Higher than that of each declaration that this one uses. So each comes after those that it
    /// uses.
    height: u32,
}

impl PooledDeclaration {
    fn order(&self) -> (OutputKind, u32, &str) {
        (self.kind, self.height, &self.ready.template.text)
    }

    /// The text before a function's body, which distinguishes functions of one name from each
    /// other; empty for other declarations.
    fn head(&self) -> &str {
        section_heading(self.kind, &self.ready)
    }
}

fn section_heading(kind: OutputKind, ready: &ReadyTemplate) -> &str {
    match kind {
        OutputKind::Function => ready.template.text.split('{').next().unwrap_or_default(),
        _ => "",
    }
}

impl Texts {
    pub fn new(target: Target) -> Self {
        Self { names: OutputNames::new(target), ..Self::default() }
    }

    pub fn keep(&mut self, cut: Cut, native: Option<TextFragment>) -> Result<TextPiece, Reason> {
        let Cut { header, shared, globals, body } = cut;
        let mut numbers: Vec<u32> = Vec::with_capacity(shared.len());
        for shared in shared {
            let number = self.share(shared, &numbers)?;
            numbers.push(number);
        }
        numbers.sort_unstable();
        numbers.dedup();
        let globals = globals.into_iter().map(|global| ReadyTemplate::new(global, &mut self.names));
        let globals = globals.collect::<Result<Vec<ReadyTemplate>, Reason>>()?;
        let body = ReadyTemplate::new(body, &mut self.names)?;
        let (native, template) =
            native.map_or(Ok(Default::default()), |native| self.native(native))?;
        let header = self.header(header);
        Ok(TextPiece { header, shared: numbers, globals, body, native, template })
    }

    fn header(&mut self, header: String) -> u32 {
        let known = self.headers.iter().position(|known| *known == header);
        known.unwrap_or_else(|| {
            self.headers.push(header);
            self.headers.len() - 1
        }) as u32
    }

    /// The number of a shared declaration, which is kept once.
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
        let ready = ReadyTemplate::new(key.0.clone(), &mut self.names)?;
        let declares = Template::new(&shared.declares, &mut self.names)?;
        let twin = (declares.text.clone(), section_heading(kind, &ready).to_owned());
        let next = self.twins.len() as u32;
        let twin = *self.twins.entry(twin).or_insert(next);
        let number = self.declarations.len() as u32;
        self.declarations.push(PooledDeclaration { ready, declares, twin, kind, height });
        self.rank(number);
        self.places.insert(key, number);
        Ok(number)
    }

    /// Inserts the newest declaration into the order, and gives it its rank.
    fn rank(&mut self, number: u32) {
        let of = |number: &u32| self.declarations[*number as usize].order();
        let place = self.order.partition_point(|other| of(other) < of(&number));
        let at_place = self.order.get(place);
        let is_alike = at_place.is_some_and(|other| of(other) == of(&number));
        let rank = match at_place {
            Some(other) => self.ranks[*other as usize],
            None => self.order.last().map_or(0, |last| self.ranks[*last as usize] + 1),
        };
        if !is_alike {
            self.ranks.iter_mut().for_each(|other| *other += u32::from(*other >= rank));
        }
        self.ranks.push(rank);
        self.order.insert(place, number);
    }

    /// The native names of an entry point, with their template where names of the author's are
    /// among them.
    fn native(&mut self, native: TextFragment) -> Result<(Arc<Native>, Option<Template>), Reason> {
        let template = Template::new(&native, &mut self.names)?;
        let native = serde_json::from_str(&template.text).map_err(|_| Reason::Shape)?;
        Ok((Arc::new(native), (!template.is_plain()).then_some(template)))
    }

    /// Writes a text: header, shared declarations, bound variables, functions, and at last the
    /// entry point, which is the last of the pieces. `text` is a buffer whose content is replaced.
    pub fn link(&self, pieces: &[&TextPiece], text: &mut String) -> Result<Arc<Native>, Reason> {
        let entry = pieces.last().ok_or(Reason::Header)?;
        let shared = self.shared(pieces);
        let declared = shared.iter().map(|declared| &declared.ready);
        let globals = entry.globals.iter();
        let bodies = pieces.iter().map(|piece| &piece.body);
        let all: Vec<&ReadyTemplate> = declared.chain(globals).chain(bodies).collect();
        let chosen = self.names.choose(&all)?;
        let renames = &chosen.renames;
        self.refuse_twins(&shared, renames)?;
        self.refuse_derived(&all, &chosen)?;
        text.clear();
        self.write_header(pieces, text)?;
        let (declared, rest) = all.split_at(shared.len());
        let (globals, bodies) = rest.split_at(entry.globals.len());
        for (fragments, gap) in [(declared, "\n"), (globals, "\n"), (bodies, "\n\n")] {
            for (index, ready) in fragments.iter().enumerate() {
                let before = if index > 0 { gap } else { "\n\n" };
                text.push_str(if text.is_empty() { "" } else { before });
                ready.write(&chosen, text);
            }
        }
        text.push('\n');
        native_names(entry, renames)
    }

    /// The shared declarations that the pieces need, in the order in which a text writes them.
    fn shared(&self, pieces: &[&TextPiece]) -> Vec<&PooledDeclaration> {
        let mut seen = vec![false; self.declarations.len()];
        let mut found: Vec<(u32, &PooledDeclaration)> = Vec::new();
        for number in pieces.iter().flat_map(|piece| &piece.shared) {
            let number = *number as usize;
            if !std::mem::replace(&mut seen[number], true) {
                found.push((self.ranks[number], &self.declarations[number]));
            }
        }
        found.sort_by_key(|(rank, _)| *rank);
        found.into_iter().map(|(_, declared)| declared).collect()
    }

    /// Refuses two declarations of one name, unless their heads distinguish them.
    fn refuse_twins(&self, shared: &[&PooledDeclaration], renames: &Renames) -> Result<(), Reason> {
        let mut seen = vec![false; self.twins.len()];
        let mut others = BTreeSet::new();
        for declared in shared {
            let twin = if declared.declares.is_renamed(renames) {
                let mut name = String::new();
                declared.declares.write(renames, &mut name);
                let key = (name, declared.head().to_owned());
                self.twins.get(&key).copied().ok_or(key)
            } else {
                Ok(declared.twin)
            };
            let is_new = match twin {
                Ok(twin) => !std::mem::replace(&mut seen[twin as usize], true),
                Err(unusual) => others.insert(unusual),
            };
            if !is_new {
                return Err(Reason::Clash);
            }
        }
        Ok(())
    }

    /// Refuses a text where a numbered name, within a longer identifier, gives the name of another
    /// declaration.
    fn refuse_derived(&self, all: &[&ReadyTemplate], chosen: &ChosenNames) -> Result<(), Reason> {
        if chosen.renames.is_empty() {
            return Ok(());
        }
        let mut derived = all.iter().flat_map(|ready| ready.derived(&chosen.renames));
        match derived.any(|identifier| self.names.is_name(&identifier, chosen)) {
            true => Err(Reason::Clash),
            false => Ok(()),
        }
    }

    /// Writes the header: the lines that all pieces have, and the extensions that some need.
    fn write_header(&self, pieces: &[&TextPiece], text: &mut String) -> Result<(), Reason> {
        let headers: BTreeSet<u32> = pieces.iter().map(|piece| piece.header).collect();
        let headers: Vec<&str> =
            headers.iter().map(|number| &*self.headers[*number as usize]).collect();
        if let [header] = *headers {
            text.push_str(header);
            return Ok(());
        }
        let is_extra = |line: &&str| {
            ["#extension ", "enable ", "requires "].iter().any(|start| line.starts_with(start))
        };
        let plain = |header: &str| -> Vec<String> {
            header.lines().filter(|line| !is_extra(line)).map(str::to_owned).collect()
        };
        let common = headers.first().map(|header| plain(header)).ok_or(Reason::Header)?;
        if headers.iter().any(|header| plain(header) != common) {
            return Err(Reason::Header);
        }
        let extra: BTreeSet<&str> =
            headers.iter().flat_map(|header| header.lines()).filter(is_extra).collect();
        // GLSL's `#version` must come first. WGSL's headers have no other lines.
        let first = common.iter().take(1).map(String::as_str);
        let rest = common.iter().skip(1).map(String::as_str);
        let lines: Vec<&str> = first.chain(extra).chain(rest).collect();
        text.push_str(&lines.join("\n"));
        Ok(())
    }
}

/// The native names of an entry point, where some of the author's names were renamed.
fn native_names(entry: &TextPiece, renames: &Renames) -> Result<Arc<Native>, Reason> {
    let Some(template) = entry.template.as_ref().filter(|text| text.is_renamed(renames)) else {
        return Ok(entry.native.clone());
    };
    let mut text = String::with_capacity(template.text.len() + 64);
    template.write(renames, &mut text);
    serde_json::from_str(&text).map(Arc::new).map_err(|_| Reason::Shape)
}
