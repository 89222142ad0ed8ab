//! Structures that `@align` within them gives an alignment, as members of others.

use super::constants::Constants;
use super::names::Module;
use super::syntax::{ExprId, Member, Tree};
use super::{Place, Problem, Rule, parse};

/// A member of a structure whose type has an alignment from an `@align` within it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NestedAlignment {
    /// The name of the structure that has the member.
    pub structure: String,
    /// The index of the member, and its name.
    pub member: usize,
    pub name: String,
    pub place: Place,
    /// The largest `@align` within its type.
    pub alignment: u32,
}

/// How often alignments are passed on from structures to those that have them. It bounds circles,
/// which are refused elsewhere.
const MOST_LEVELS: usize = 64;

/// The members of a text whose types have an alignment of their own. Empty where it is no WGSL. It
/// needs a large stack.
pub fn nested_alignments(text: &str) -> Vec<NestedAlignment> {
    if !text.contains("align") {
        return Vec::new();
    }
    let Some(Ok((tree, _))) = parse::parse(text) else { return Vec::new() };
    nested(&tree, &Module::read(&tree))
}

fn nested(tree: &Tree<'_>, module: &Module<'_, '_>) -> Vec<NestedAlignment> {
    let alignments = alignments(tree, module);
    let mut found = Vec::new();
    for structure in &tree.structs {
        for (member, Member { name, place, of_type, attributes: _ }) in
            structure.members.iter().enumerate()
        {
            let alignment = element(module, *of_type).map_or(0, |inner| alignments[inner]);
            if alignment > 0 {
                let (structure, name, place) =
                    (structure.name.to_owned(), (*name).to_owned(), *place);
                found.push(NestedAlignment { structure, member, name, place, alignment });
            }
        }
    }
    found
}

/// The members with an `@align` below that of their type. naga finds those that have no `@align`
/// within the type.
pub fn check(tree: &Tree<'_>, module: &Module<'_, '_>) -> Vec<Problem> {
    let has_align = |member: &Member<'_>| member.attributes.iter().any(|one| one.name == "align");
    if !tree.structs.iter().flat_map(|structure| &structure.members).any(has_align) {
        return Vec::new();
    }
    let constants = Constants::of(module);
    let mut problems = Vec::new();
    for NestedAlignment { structure, member, name, place: _, alignment } in nested(tree, module) {
        let Some(of) = tree.structs.iter().find(|found| found.name == structure) else { continue };
        for attribute in of.members[member].attributes.iter().filter(|one| one.name == "align") {
            let own = attribute.arguments.first().and_then(|id| constants.value(*id)?.number());
            if own.is_some_and(|own| own < f64::from(alignment)) {
                let message =
                    format!("an `@align` within the type of `{name}` asks for {alignment} here");
                problems.push(Problem::new(Rule::Attribute, attribute.place, message));
            }
        }
    }
    problems
}

/// The largest `@align` in each structure and in those within it, or 0.
fn alignments(tree: &Tree<'_>, module: &Module<'_, '_>) -> Vec<u32> {
    let constants = Constants::of(module);
    let own = |member: &Member<'_>| {
        let attributes = member.attributes.iter().filter(|attribute| attribute.name == "align");
        let arguments = attributes.flat_map(|attribute| &attribute.arguments);
        let numbers = arguments.filter_map(|id| constants.value(*id)?.number());
        numbers.map(|number| number as u32).max().unwrap_or(0)
    };
    let mut found: Vec<u32> = tree
        .structs
        .iter()
        .map(|structure| structure.members.iter().map(own).max().unwrap_or(0))
        .collect();
    for _ in 0..MOST_LEVELS {
        let before = found.clone();
        for (at, structure) in tree.structs.iter().enumerate() {
            let inner = structure.members.iter().filter_map(|one| element(module, one.of_type));
            found[at] = inner.map(|inner| before[inner]).fold(found[at], u32::max);
        }
        if found == before {
            break;
        }
    }
    found
}

/// The structure that a type is, or that it is an array of.
fn element(module: &Module<'_, '_>, mut of_type: ExprId) -> Option<usize> {
    for _ in 0..MOST_LEVELS {
        match module.type_of(of_type)? {
            ("array", [first, ..]) => of_type = *first,
            _ => return module.structure(of_type),
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn alignments_reach_what_has_the_structure() {
        let text = "const size = 16u;\nalias Many = array<A, 3>;\nstruct C { b: B }\n\
            struct A { @align(size * 2u) x: f32 }\nstruct B { y: f32, all: Many }\n\
            struct Plain { a: vec4f }\nstruct D { plain: Plain }";
        let found: Vec<_> = nested_alignments(text)
            .into_iter()
            .map(|one| (one.structure, one.member, one.name, one.alignment))
            .collect();
        let expected = [("C", 0, "b", 32), ("B", 1, "all", 32)];
        let expected = expected.map(|(of, at, name, by)| (of.to_owned(), at, name.to_owned(), by));
        assert_eq!(found, expected);
    }

    #[test]
    fn a_structure_in_itself_ends() {
        assert_eq!(nested_alignments("struct A { @align(16) a: A }").len(), 1);
        assert_eq!(nested_alignments("struct A { @align(16) a: "), []);
    }
}
