//! What control flow may do after a statement ("Statements Behavior Analysis" in the
//! specification). The parser computes it for each statement from those within.

use super::statements::inner_blocks;
use super::syntax::{Block, Statement, StatementKind, Tree};
use super::{Problem, Rule, Severity};

/// A set of ways in which control flow leaves a statement.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Behaviour(u8);

impl Behaviour {
    pub const NONE: Self = Self(0);
    pub const NEXT: Self = Self(1);
    pub const BREAK: Self = Self(2);
    pub const CONTINUE: Self = Self(4);
    pub const RETURN: Self = Self(8);

    pub const fn or(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    pub const fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    pub const fn has(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }
}

/// The behaviour of statements after one another.
pub fn of_statements(statements: &[Statement<'_>]) -> Behaviour {
    let mut found = Behaviour::NEXT;
    for statement in statements {
        if !found.has(Behaviour::NEXT) {
            break;
        }
        found = found.without(Behaviour::NEXT).or(statement.behaviour);
    }
    found
}

pub fn of_block(block: &Block<'_>) -> Behaviour {
    of_statements(&block.statements)
}

pub fn of_switch(clauses: &[Block<'_>]) -> Behaviour {
    let all = clauses.iter().fold(Behaviour::NONE, |found, clause| found.or(of_block(clause)));
    match all.has(Behaviour::BREAK) {
        true => all.or(Behaviour::NEXT).without(Behaviour::BREAK),
        false => all,
    }
}

/// The behaviour of a loop with the given ones of its body and of its continuing block.
pub fn of_loop(body: Behaviour, continuing: Behaviour) -> Behaviour {
    let both = body.or(continuing);
    if body == Behaviour::RETURN {
        Behaviour::RETURN
    } else if both.has(Behaviour::BREAK) {
        both.or(Behaviour::NEXT).without(Behaviour::BREAK.or(Behaviour::CONTINUE))
    } else {
        both.without(Behaviour::CONTINUE.or(Behaviour::NEXT))
    }
}

/// The behaviour of `for` and `while`: a condition is an `if` with a `break`.
pub fn of_conditional_loop(has_condition: bool, body: Behaviour) -> Behaviour {
    let body = match has_condition {
        true => body.or(Behaviour::BREAK),
        false => body,
    };
    of_loop(body, Behaviour::NEXT)
}

/// Functions and loops whose behaviour is not allowed.
pub fn check(tree: &Tree<'_>) -> Vec<Problem> {
    let mut problems = Vec::new();
    for function in &tree.functions {
        check_block(&function.body, &mut problems);
        let found = of_block(&function.body);
        let is_value = function.result.is_some();
        if is_value && found.has(Behaviour::NEXT) {
            let message = format!("`{}` does not return a value on every path", function.name);
            let problem = Problem::new(Rule::Behaviour, function.place, message);
            // Its result is open in every language.
            problems.push(Problem { severity: Severity::Error, ..problem });
        }
    }
    problems
}

fn check_block(block: &Block<'_>, problems: &mut Vec<Problem>) {
    block.statements.iter().for_each(|statement| check_statement(statement, problems));
}

fn check_statement(statement: &Statement<'_>, problems: &mut Vec<Problem>) {
    inner_blocks(statement).into_iter().for_each(|inner| check_block(inner, problems));
    let is_loop = match &statement.kind {
        StatementKind::Loop { body: _, continuing } => {
            let leaves = Behaviour::CONTINUE.or(Behaviour::RETURN);
            if let Some(continuing) = continuing.as_ref().filter(|own| of_block(own).has(leaves)) {
                let message = "a `continuing` block must not return or continue".to_owned();
                problems.push(Problem::new(Rule::Behaviour, continuing.place, message));
            }
            true
        }
        StatementKind::For(_) | StatementKind::While { .. } => true,
        _ => false,
    };
    if is_loop && statement.behaviour == Behaviour::NONE {
        let message = "this loop never ends: nothing in it breaks or returns".to_owned();
        problems.push(Problem::new(Rule::Behaviour, statement.place, message));
    }
}
