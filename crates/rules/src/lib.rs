//! The rules of WGSL that naga does not check, and browsers do: uniformity ("Uniformity" in the
//! specification), behaviours of statements, and smaller ones. The analysis runs on a text of its
//! own tree: naga's module no longer has all that the rules speak of.

mod atomics;
mod attributes;
mod behaviour;
mod constants;
mod layout;
mod lets;
mod lookup;
mod memory;
mod names;
mod parse;
mod statements;
mod syntax;
mod token;
mod uniformity;

use std::ops::Range;

pub use constants::fold;
pub use layout::{NestedAlignment, nested_alignments};
pub use lets::with_variables;
pub use lookup::{Declared, Head, Lookup, Piece, Step};
use syntax::Directive;
pub use syntax::Severity;
pub use uniformity::Summary;

/// Bytes of a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Place {
    pub start: u32,
    pub end: u32,
}

impl Place {
    /// The same as a range.
    pub fn range(self) -> Range<usize> {
        self.start as usize..self.end as usize
    }
}

/// Which rule a text breaks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Rule {
    /// The grammar.
    Grammar,
    /// The text nests deeper than browsers or this analysis go, or is too large for it.
    Depth,
    /// Operators beside each other that need brackets.
    Precedence,
    /// Statements that never end, or never return a value.
    Behaviour,
    /// Atomics where they cannot be, memory that a stage cannot use.
    Memory,
    /// Attributes where they do not belong.
    Attribute,
    /// Constant arguments that give no value.
    Constant,
    /// `derivative_uniformity`.
    Derivative,
    /// `subgroup_uniformity`.
    Subgroup,
    /// Barriers and `workgroupUniformLoad`.
    Barrier,
}

/// A place where a text breaks a rule.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    pub rule: Rule,
    pub severity: Severity,
    pub place: Place,
    pub message: String,
    /// Other places that explain it.
    pub notes: Vec<(Place, String)>,
}

impl Problem {
    fn new(rule: Rule, place: Place, message: String) -> Self {
        Self { rule, severity: Severity::Default, place, message, notes: Vec::new() }
    }
}

/// What breaks a rule in a text that naga accepts, in the order of the text. It recurses as deep as
/// the text nests, so it needs a large stack.
pub fn check(text: &str) -> Vec<Problem> {
    check_with(text, &|_| None).0
}

/// What callers notice of a function, and whether anything in it breaks a rule. `known` has this of
/// the functions whose bodies are not in the text. It needs a large stack, as [`check`] does.
pub fn summarise<'s>(
    text: &str,
    function: &str,
    known: &dyn Fn(&str) -> Option<&'s Summary>,
) -> (Summary, bool) {
    let (problems, mut summaries) = check_with(text, known);
    let own = summaries.iter().position(|(name, _)| name == function);
    let own = own.map_or_else(Summary::default, |at| summaries.swap_remove(at).1);
    (own.without_places(), problems.is_empty())
}

/// Directives with an extension that naga does not know, although what it allows is there: pointers
/// are placed before naga sees them, and naga has subgroups and immediates at all times.
const UNREAD: [(&str, &str); 3] = [
    ("requires", "unrestricted_pointer_parameters"),
    ("requires", "immediate_address_space"),
    ("enable", "subgroups"),
];

/// The text with blanks for what naga cannot read, the filters at statements and some directives;
/// `None` where it has neither. It needs a large stack.
pub fn without_unread(text: &str) -> Option<String> {
    // Blanks and comments may stand between the two.
    let has_filters = text.contains('@') && text.contains("diagnostic");
    if !has_filters && !UNREAD.iter().any(|(_, name)| text.contains(name)) {
        return None;
    }
    let (tree, _) = parse::parse(text)?.ok()?;
    let mut blank = text.to_owned();
    for place in &tree.statement_filters {
        blank.replace_range(place.range(), &" ".repeat(place.range().len()));
    }
    for Directive { word, place, names } in &tree.extensions {
        let is_read = |name: &&str| !UNREAD.contains(&(*word, *name));
        let kept: Vec<&str> = names.iter().copied().filter(is_read).collect();
        let directive = match kept.as_slice() {
            [] => String::new(),
            names => format!("{word} {};", names.join(", ")),
        };
        let width = place.range().len();
        if kept.len() < names.len() && directive.len() <= width {
            blank.replace_range(place.range(), &format!("{directive:width$}"));
        }
    }
    (blank != text).then_some(blank)
}

/// The places of what a text is made of.
#[derive(Debug, Default)]
pub struct Parts {
    /// The statements of each function, without those within them.
    pub statements: Vec<Vec<Place>>,
    /// The values of the constants and variables of the module.
    pub values: Vec<Place>,
    /// The types that aliases, variables and members of structures are declared with.
    pub types: Vec<Place>,
}

/// The places of what a text is made of; `None` where it is no WGSL. It needs a large stack.
pub fn parts(text: &str) -> Option<Parts> {
    let (tree, _) = parse::parse(text)?.ok()?;
    let statements = |function: &syntax::Function<'_>| {
        function.body.statements.iter().map(|statement| statement.place).collect()
    };
    let values = tree.declarations.iter().filter_map(|one| one.value);
    let aliases = tree.aliases.iter().map(|one| one.of_type);
    let declared = tree.declarations.iter().filter_map(|one| one.of_type);
    let members = tree.structs.iter().flat_map(|one| &one.members).map(|one| one.of_type);
    let types = aliases.chain(members).chain(declared);
    Some(Parts {
        statements: tree.functions.iter().map(statements).collect(),
        values: values.map(|id| tree.place(id)).collect(),
        types: types.map(|id| tree.place(id)).collect(),
    })
}

/// The problems of a text, and what is known of its functions.
fn check_with<'s>(
    text: &str,
    known: &dyn Fn(&str) -> Option<&'s Summary>,
) -> (Vec<Problem>, Vec<(String, Summary)>) {
    if let Some(at) = text.find('\0') {
        let place = Place { start: at as u32, end: at as u32 + 1 };
        let message = "a text must not have the character U+0000".to_owned();
        return (vec![Problem::new(Rule::Grammar, place, message)], Vec::new());
    }
    let (tree, mut problems) = match parse::parse(text) {
        None => return (Vec::new(), Vec::new()),
        Some(Err(problem)) => return (vec![problem], Vec::new()),
        Some(Ok(parsed)) => parsed,
    };
    let module = names::Module::read(&tree);
    problems.extend(behaviour::check(&tree));
    problems.extend(statements::check(&module));
    problems.extend(attributes::check(&tree, &module));
    problems.extend(layout::check(&tree, &module));
    problems.extend(memory::check(&tree, &module));
    problems.extend(atomics::check(&tree, &module));
    problems.extend(constants::check(&tree, &module));
    let (found, summaries) = uniformity::check(&tree, &module, known);
    problems.extend(found);
    problems.sort_by(|one, other| {
        (one.place, one.rule, &one.notes).cmp(&(other.place, other.rule, &other.notes))
    });
    problems.dedup_by_key(|problem| (problem.place, problem.rule));
    (problems, summaries)
}
