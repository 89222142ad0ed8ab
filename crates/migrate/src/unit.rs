//! Tokens as lists: declarations, statements, members, parameters, cases of a `switch`.
//!
//! A condition of WESL stands around whole units of such lists. A unit that one of `naga_oil` cuts
//! is written once for each way that the condition can go, with the units up to where all meet.

use std::cell::Cell;
use std::collections::HashMap;

use super::condition::{Facts, ShaderDefTest};
use super::level::{OpenUnit, UnitKind};
use super::tree::{Conditional, DirectiveLine, ImportDirective, Node, Token, TokenKind};

#[derive(Debug)]
pub enum Element<'a> {
    Unit(Vec<UnitPart<'a>>),
    Import(&'a ImportDirective),
    Comment(&'a DirectiveLine),
    Gone(&'a DirectiveLine),
    Choice(Choice<'a>),
}

#[derive(Debug)]
pub enum UnitPart<'a> {
    Token(&'a Token),
    List(UnitKind, Vec<Element<'a>>),
}

/// A choice: a list of elements for each branch.
#[derive(Debug)]
pub struct Choice<'a> {
    /// What the author wrote, if the condition stands around whole units there.
    pub written: Option<&'a Conditional>,
    pub branches: Vec<(Option<ShaderDefTest>, Vec<Element<'a>>)>,
}

/// Why a list or a unit could not be read.
#[derive(Debug)]
enum ReadStop {
    /// The choice at this index of the row cuts through a unit.
    Cut(usize),
    Broken(usize),
    TooMuch,
}

/// Nodes in a row. In place of a choice whose outcome is known, it has the nodes of the branch.
type NodeRow<'a> = Vec<&'a Node>;
type Read<T> = Result<T, ReadStop>;

/// How many steps reading a file may take for each of its nodes, in addition to `STEPS_AT_LEAST`.
const STEPS: usize = 400;
const STEPS_AT_LEAST: usize = 200_000;

/// Reads a file. The error is where it cannot be understood, and whether that took too many steps.
pub fn read_elements<'a>(
    text: &'a str,
    nodes: &'a [Node],
) -> Result<Vec<Element<'a>>, (usize, bool)> {
    let steps = STEPS_AT_LEAST + STEPS * count_nodes(nodes);
    let reader = UnitReader { text, steps: Cell::new(steps) };
    let facts = Facts::default();
    let row = reader.row(nodes, &facts);
    let place = |at: usize| row.get(at).or(row.last()).map_or(0, |node| node_start(node));
    let mut at = 0;
    match reader.list(&row, &mut at, UnitKind::Declarations, &facts) {
        Ok(found) if at == row.len() => Ok(found),
        Ok(_) => Err((place(at), false)),
        Err(ReadStop::Cut(at) | ReadStop::Broken(at)) => Err((place(at), false)),
        Err(ReadStop::TooMuch) => Err((place(0), true)),
    }
}

fn count_nodes(nodes: &[Node]) -> usize {
    let of = |node: &Node| match node {
        Node::Choice(one) => one.branches.iter().map(|branch| count_nodes(&branch.nodes)).sum(),
        _ => 1,
    };
    nodes.iter().map(of).sum()
}

fn node_start(node: &Node) -> usize {
    match node {
        Node::Token(token) => token.range.start,
        Node::Import(import) => import.line.words.start,
        Node::Choice(choice) => choice.branches[0].line.words.start,
        Node::Comment(line) | Node::Gone(line) => line.words.start,
    }
}

struct UnitReader<'a> {
    text: &'a str,
    steps: Cell<usize>,
}

/// The ways a choice can go: the last one is `#else`, whether it was written or not.
fn choice_ways(choice: &Conditional) -> Vec<(Option<ShaderDefTest>, &[Node])> {
    let mut found: Vec<(Option<ShaderDefTest>, &[Node])> = Vec::new();
    for branch in &choice.branches {
        found.push((branch.condition.clone(), &branch.nodes));
    }
    if found.last().is_some_and(|(condition, _)| condition.is_some()) {
        found.push((None, &[]));
    }
    found
}

/// What holds in each branch: its own condition, and none before it.
pub fn explicit_conditions(conditions: &[Option<ShaderDefTest>]) -> Vec<Vec<ShaderDefTest>> {
    let mut before = Vec::new();
    let one = |condition: &Option<ShaderDefTest>| {
        let here: Vec<ShaderDefTest> = before.iter().chain(condition).cloned().collect();
        before.extend(condition.clone().map(ShaderDefTest::not));
        here
    };
    conditions.iter().map(one).collect()
}

/// One way through a choice, with the elements that were read so far.
struct ChoicePath<'a> {
    row: NodeRow<'a>,
    at: usize,
    facts: Facts,
    elements: Vec<Element<'a>>,
}

impl<'a> UnitReader<'a> {
    fn step(&self, steps: usize) -> Read<()> {
        let left = self.steps.get().saturating_sub(steps);
        self.steps.set(left);
        if left == 0 { Err(ReadStop::TooMuch) } else { Ok(()) }
    }

    fn row(&self, nodes: impl IntoIterator<Item = &'a Node>, facts: &Facts) -> NodeRow<'a> {
        let mut row = NodeRow::new();
        for node in nodes {
            match node {
                Node::Choice(choice) => match decided_branch(choice, facts) {
                    Some(branch) => row.extend(self.row(branch, facts)),
                    None => row.push(node),
                },
                node => row.push(node),
            }
        }
        row
    }

    fn mark(&self, node: Option<&&'a Node>) -> Option<u8> {
        match node {
            Some(Node::Token(Token { kind: TokenKind::Mark(mark), .. })) => Some(*mark),
            _ => None,
        }
    }

    fn is_word(&self, node: &Node, word: &str) -> bool {
        matches!(node, Node::Token(token) if &self.text[token.range.clone()] == word)
    }

    fn is_closer(&self, node: Option<&&'a Node>) -> bool {
        matches!(self.mark(node), Some(b'}' | b')' | b']'))
    }

    /// Elements up to a closing bracket or the end of the row.
    fn list(
        &self,
        row: &NodeRow<'a>,
        at: &mut usize,
        level: UnitKind,
        facts: &Facts,
    ) -> Read<Vec<Element<'a>>> {
        let mut elements = Vec::new();
        while *at < row.len() && !self.is_closer(row.get(*at)) {
            elements.push(self.element(row, at, level, facts)?);
        }
        Ok(elements)
    }

    fn element(
        &self,
        row: &NodeRow<'a>,
        at: &mut usize,
        level: UnitKind,
        facts: &Facts,
    ) -> Read<Element<'a>> {
        let start = *at;
        self.step(1)?;
        let cut = match row[start] {
            Node::Import(import) => {
                *at += 1;
                return Ok(Element::Import(import));
            }
            Node::Comment(line) => {
                *at += 1;
                return Ok(Element::Comment(line));
            }
            Node::Gone(line) => {
                *at += 1;
                return Ok(Element::Gone(line));
            }
            Node::Choice(choice) => match self.whole(choice, level, facts) {
                Ok(found) => {
                    *at += 1;
                    return Ok(Element::Choice(found));
                }
                Err(ReadStop::TooMuch) => return Err(ReadStop::TooMuch),
                Err(_) => start,
            },
            Node::Token(_) => match self.unit(row, at, level, facts) {
                Err(ReadStop::Cut(cut)) => cut,
                found => return found.map(Element::Unit),
            },
        };
        let (found, end) = self.variants(row, start, cut, level, facts)?;
        *at = end;
        Ok(Element::Choice(found))
    }

    /// A choice between whole units.
    fn whole(&self, choice: &'a Conditional, level: UnitKind, facts: &Facts) -> Read<Choice<'a>> {
        let conditions: Vec<_> =
            choice.branches.iter().map(|branch| branch.condition.clone()).collect();
        let mut branches = Vec::new();
        for (branch, known) in choice.branches.iter().zip(explicit_conditions(&conditions)) {
            let facts = facts.with(&known);
            let row = self.row(&branch.nodes, &facts);
            let mut at = 0;
            let elements = self.list(&row, &mut at, level, &facts)?;
            if at < row.len() {
                return Err(ReadStop::Broken(0));
            }
            branches.push((branch.condition.clone(), elements));
        }
        Ok(Choice { written: Some(choice), branches })
    }

    /// Whole units from `start` on, once for each way through the choice at `cut`.
    fn variants(
        &self,
        row: &NodeRow<'a>,
        start: usize,
        cut: usize,
        level: UnitKind,
        facts: &Facts,
    ) -> Read<(Choice<'a>, usize)> {
        let Node::Choice(choice) = row[cut] else { return Err(ReadStop::Broken(cut)) };
        let ways = choice_ways(choice);
        let conditions: Vec<_> = ways.iter().map(|(condition, _)| condition.clone()).collect();
        let behind: HashMap<*const Node, usize> =
            (cut + 1..row.len()).map(|index| (std::ptr::from_ref(row[index]), index)).collect();
        let mut variants = Vec::new();
        for ((_, nodes), known) in ways.iter().zip(explicit_conditions(&conditions)) {
            self.step(row.len() - start)?;
            let facts = facts.with(&known);
            let mut variant = row[start..cut].to_vec();
            variant.extend(self.row(nodes.iter().chain(row[cut + 1..].iter().copied()), &facts));
            variants.push(ChoicePath { row: variant, at: 0, facts, elements: Vec::new() });
        }
        let end = |variant: &ChoicePath<'a>| match variant.row.get(variant.at) {
            Some(node) => behind.get(&std::ptr::from_ref(*node)).copied(),
            None => Some(row.len()),
        };
        loop {
            let ends: Vec<Option<usize>> = variants.iter().map(end).collect();
            if ends.iter().all(|end| end.is_some() && *end == ends[0]) {
                let elements = variants.into_iter().map(|variant| variant.elements);
                let branches = conditions.into_iter().zip(elements).collect();
                return Ok((Choice { written: None, branches }, ends[0].unwrap_or(row.len())));
            }
            let least = ends.iter().copied().min().flatten();
            for variant in variants.iter_mut().filter(|variant| end(variant) == least) {
                let ChoicePath { row, at, facts, elements } = variant;
                if *at >= row.len() || self.is_closer(row.get(*at)) {
                    return Err(ReadStop::Cut(cut));
                }
                match self.element(row, at, level, facts) {
                    Ok(found) => elements.push(found),
                    Err(ReadStop::TooMuch) => return Err(ReadStop::TooMuch),
                    Err(_) => return Err(ReadStop::Cut(cut)),
                }
            }
        }
    }

    /// One declaration, statement, member, parameter or case.
    fn unit(
        &self,
        row: &NodeRow<'a>,
        at: &mut usize,
        level: UnitKind,
        facts: &Facts,
    ) -> Read<Vec<UnitPart<'a>>> {
        let mut unit = OpenUnit::new(level);
        loop {
            self.step(1)?;
            let token = match row.get(*at) {
                Some(Node::Token(token)) => token,
                Some(Node::Choice(_)) => return Err(ReadStop::Cut(*at)),
                None if level.has_commas() && !unit.parts.is_empty() => return Ok(unit.parts),
                _ => return Err(ReadStop::Broken((*at).min(row.len().saturating_sub(1)))),
            };
            let mark = self.mark(row.get(*at));
            if self.is_closer(row.get(*at)) {
                let ends = level.has_commas() && !unit.parts.is_empty();
                return if ends { Ok(unit.parts) } else { Err(ReadStop::Broken(*at)) };
            }
            if mark == Some(b',') && unit.parts.is_empty() {
                return Err(ReadStop::Broken(*at));
            }
            unit.note(&self.text[token.range.clone()]);
            unit.parts.push(UnitPart::Token(token));
            *at += 1;
            match mark {
                Some(b';') => return Ok(unit.parts),
                Some(b',') if level.has_commas() && unit.angles == 0 => return Ok(unit.parts),
                Some(b'(') if unit.parameters_follow() => {
                    self.nested(row, at, UnitKind::Parameters, facts, &mut unit.parts)?;
                }
                Some(b'(' | b'[') => self.group(row, at, &mut unit.parts)?,
                Some(b'{') => {
                    let inner = unit.inner().ok_or(ReadStop::Broken(*at - 1))?;
                    self.nested(row, at, inner, facts, &mut unit.parts)?;
                    if !(unit.first == "if" && self.goes_on(row, *at, facts)?) {
                        return Ok(unit.parts);
                    }
                }
                _ => {}
            }
        }
    }

    /// Whether an `else` follows. A choice with a branch that starts with `else` cuts the `if`.
    fn goes_on(&self, row: &NodeRow<'a>, at: usize, facts: &Facts) -> Read<bool> {
        match row.get(at) {
            Some(Node::Choice(choice)) => {
                let starts = |(condition, nodes): &(Option<ShaderDefTest>, &'a [Node])| {
                    let facts = facts.with(condition.as_slice());
                    let rest = nodes.iter().chain(row[at + 1..].iter().take(1).copied());
                    let row = self.row(rest, &facts);
                    matches!(self.goes_on(&row, 0, &facts), Ok(true) | Err(_))
                };
                let cut = choice_ways(choice).iter().any(starts);
                if cut { Err(ReadStop::Cut(at)) } else { Ok(false) }
            }
            Some(node) => Ok(self.is_word(node, "else")),
            None => Ok(false),
        }
    }

    /// A list and the bracket that closes it.
    fn nested(
        &self,
        row: &NodeRow<'a>,
        at: &mut usize,
        level: UnitKind,
        facts: &Facts,
        parts: &mut Vec<UnitPart<'a>>,
    ) -> Read<()> {
        let elements = self.list(row, at, level, facts)?;
        let Some(Node::Token(close)) = row.get(*at) else {
            return Err(ReadStop::Broken(row.len().saturating_sub(1)));
        };
        parts.push(UnitPart::List(level, elements));
        parts.push(UnitPart::Token(close));
        *at += 1;
        Ok(())
    }

    /// Tokens up to the bracket that closes what was opened, and that bracket.
    fn group(&self, row: &NodeRow<'a>, at: &mut usize, parts: &mut Vec<UnitPart<'a>>) -> Read<()> {
        let mut depth = 1;
        while depth > 0 {
            self.step(1)?;
            match row.get(*at) {
                Some(Node::Token(token)) => {
                    match token.kind {
                        TokenKind::Mark(b'(' | b'[' | b'{') => depth += 1,
                        TokenKind::Mark(b')' | b']' | b'}') => depth -= 1,
                        _ => {}
                    }
                    parts.push(UnitPart::Token(token));
                    *at += 1;
                }
                Some(Node::Choice(_)) => return Err(ReadStop::Cut(*at)),
                _ => return Err(ReadStop::Broken((*at).min(row.len().saturating_sub(1)))),
            }
        }
        Ok(())
    }
}

/// The branch that the facts decide for, which is empty if all conditions are known to be false;
/// `None` if the facts do not decide.
fn decided_branch<'a>(choice: &'a Conditional, facts: &Facts) -> Option<&'a [Node]> {
    for branch in &choice.branches {
        match branch.condition.as_ref().map_or(Some(true), |condition| facts.holds(condition)) {
            Some(true) => return Some(&branch.nodes),
            Some(false) => {}
            None => return None,
        }
    }
    Some(&[])
}
