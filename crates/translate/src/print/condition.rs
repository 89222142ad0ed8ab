//! Conditions as directives.

use super::words::macro_name;
use crate::condition::{AxisValue, Condition};
use crate::tree::{Branch, Node};

/// A condition as the text after `#if`.
pub fn condition_text(condition: &Condition) -> String {
    match condition {
        Condition::Literal(value) => u8::from(*value).to_string(),
        Condition::Flag(axis) => macro_name(axis),
        Condition::Compare { axis, operator, value } => {
            let axis = macro_name(axis);
            match value {
                AxisValue::Integer(value) => format!("{axis} {} {value}", operator.spelling()),
                AxisValue::Name(value) => {
                    format!("{axis} {} {axis}_{}", operator.spelling(), macro_name(value))
                }
            }
        }
        Condition::Not(inner) => match &**inner {
            Condition::Flag(axis) => format!("!{}", macro_name(axis)),
            other => format!("!({})", condition_text(other)),
        },
        Condition::All(parts) => {
            let part = |one: &Condition| match one {
                Condition::Any(_) => format!("({})", condition_text(one)),
                _ => condition_text(one),
            };
            parts.iter().map(part).collect::<Vec<_>>().join(" && ")
        }
        Condition::Any(parts) => parts.iter().map(condition_text).collect::<Vec<_>>().join(" || "),
    }
}

/// Siblings that share an `#if` and its `#endif`, or one without a condition.
#[derive(Debug)]
pub struct Chain<'a, T> {
    /// By condition; `None` is what always stands, or the `#else`.
    pub arms: Vec<(Option<&'a Condition>, Vec<&'a Node<T>>)>,
    pub is_conditional: bool,
}

/// Siblings as chains. Neighbours under the same condition share one.
pub fn chains_of<T>(nodes: &[Node<T>]) -> Vec<Chain<'_, T>> {
    let mut chains: Vec<Chain<'_, T>> = Vec::new();
    for (index, node) in nodes.iter().enumerate() {
        // What follows an `@if` belongs to that alone.
        let is_single = !matches!(
            nodes.get(index + 1).and_then(|next| next.branch.as_ref()),
            Some(Branch::Elif(_) | Branch::Else)
        );
        let last = chains.last_mut();
        match (&node.branch, last) {
            (Some(Branch::Elif(condition)), Some(chain)) => {
                chain.arms.push((Some(condition), vec![node]));
            }
            (Some(Branch::Else), Some(chain)) => chain.arms.push((None, vec![node])),
            (Some(Branch::If(condition)), Some(chain))
                if chain.is_conditional
                    && chain.arms.len() == 1
                    && chain.arms[0].0 == Some(condition) =>
            {
                chain.arms[0].1.push(node);
            }
            (Some(Branch::If(condition)), Some(chain))
                if is_single
                    && chain.is_conditional
                    && chain
                        .arms
                        .iter()
                        .all(|(arm, _)| arm.is_some_and(|arm| arm.is_other_value(condition))) =>
            {
                chain.arms.push((Some(condition), vec![node]));
            }
            (None, Some(chain)) if !chain.is_conditional => chain.arms[0].1.push(node),
            (branch, _) => {
                let condition = match branch {
                    Some(Branch::If(condition) | Branch::Elif(condition)) => Some(condition),
                    _ => None,
                };
                let is_conditional = condition.is_some();
                chains.push(Chain { arms: vec![(condition, vec![node])], is_conditional });
            }
        }
    }
    chains
}

/// The directive before an arm.
pub fn directive(index: usize, condition: Option<&Condition>) -> String {
    match (index, condition) {
        (0, Some(condition)) => format!("#if {}\n", condition_text(condition)),
        (_, Some(condition)) => format!("#elif {}\n", condition_text(condition)),
        (_, None) => "#else\n".to_owned(),
    }
}
