//! Conditions of nodes over the axes of a program, and what follows from them.

use std::collections::{BTreeMap, BTreeSet};

/// A condition. Names of axes are as the author wrote them.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub enum Condition {
    Literal(bool),
    /// A boolean axis.
    Flag(String),
    Compare {
        axis: String,
        operator: Comparison,
        value: AxisValue,
    },
    Not(Box<Condition>),
    All(Vec<Condition>),
    Any(Vec<Condition>),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Comparison {
    Equal,
    NotEqual,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
}

#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub enum AxisValue {
    Name(String),
    Integer(i64),
}

/// The most choices of axes that are tried to find what follows from conditions.
const CHOICES: usize = 20_000;

impl Condition {
    /// Both; a condition that always holds is left out.
    pub fn and(self, other: Self) -> Self {
        let mut all = Vec::new();
        for one in [self, other] {
            match one {
                Self::Literal(true) => {}
                Self::All(parts) => all.extend(parts),
                one => all.push(one),
            }
        }
        let mut seen = BTreeSet::new();
        all.retain(|one| seen.insert(one.clone()));
        match all.len() {
            0 => Self::Literal(true),
            1 => all.remove(0),
            _ => Self::All(all),
        }
    }

    /// One of them at least. What follows from another one is left out.
    pub fn any(conditions: Vec<Self>) -> Self {
        let mut kept: Vec<Self> = Vec::new();
        for one in conditions {
            if kept.iter().any(|other| one.implies(other)) {
                continue;
            }
            kept.retain(|other| !other.implies(&one));
            kept.push(one);
        }
        let mut all = Vec::new();
        for one in kept {
            match one {
                Self::Any(parts) => all.extend(parts),
                one => all.push(one),
            }
        }
        match all.len() {
            _ if all.contains(&Self::Literal(true)) => Self::Literal(true),
            0 => Self::Literal(false),
            1 => all.remove(0),
            _ => Self::Any(all),
        }
    }

    /// The same without the parts of a conjunction that follow from its other parts.
    pub fn simplified(self) -> Self {
        match self {
            Self::All(mut parts) => {
                let mut at = 0;
                while at < parts.len() {
                    let implied = |other: usize| other != at && parts[other].implies(&parts[at]);
                    match (0..parts.len()).any(implied) {
                        true => drop(parts.remove(at)),
                        false => at += 1,
                    }
                }
                if parts.len() == 1 { parts.remove(0) } else { Self::All(parts) }
            }
            Self::Any(parts) => {
                let any = Self::any(parts.into_iter().map(Self::simplified).collect());
                match Self::Literal(true).implies(&any) {
                    true => Self::Literal(true),
                    false => any,
                }
            }
            other => other,
        }
    }

    /// Whether both compare the same axis with other values, so that one of them holds at most.
    pub fn is_other_value(&self, other: &Self) -> bool {
        let axes = |one: &Self| match one {
            Self::Compare { axis, operator: Comparison::Equal, .. } => Some(axis.clone()),
            Self::Any(parts) => {
                let mut axes = parts.iter().map(|part| match part {
                    Self::Compare { axis, operator: Comparison::Equal, .. } => Some(axis.clone()),
                    _ => None,
                });
                let first = axes.next().flatten();
                if axes.all(|axis| axis == first) { first } else { None }
            }
            _ => None,
        };
        axes(self).is_some() && axes(self) == axes(other) && self.excludes(other)
    }

    /// The opposite, written shortly.
    pub fn negated(self) -> Self {
        match self {
            Self::Literal(value) => Self::Literal(!value),
            Self::Not(inner) => *inner,
            Self::Compare { axis, operator, value } => {
                Self::Compare { axis, operator: operator.opposite(), value }
            }
            other => Self::Not(Box::new(other)),
        }
    }

    /// Whether the other one surely holds where this one does. False where that is not known.
    pub fn implies(&self, other: &Self) -> bool {
        self == other || self.always(other, |this, other| !this || other)
    }

    /// Whether both surely never hold together. False where that is not known.
    pub fn excludes(&self, other: &Self) -> bool {
        self.always(other, |this, other| !this || !other)
    }

    /// Whether a relation holds for all choices of the axes.
    fn always(&self, other: &Self, relation: impl Fn(bool, bool) -> bool) -> bool {
        let mut axes: BTreeMap<&str, BTreeSet<Choice>> = BTreeMap::new();
        self.collect(&mut axes);
        other.collect(&mut axes);
        let axes: Vec<(&str, Vec<Choice>)> =
            axes.into_iter().map(|(axis, choices)| (axis, choices.into_iter().collect())).collect();
        let count = axes.iter().try_fold(1_usize, |count, (_, choices)| {
            count.checked_mul(choices.len()).filter(|count| *count <= CHOICES)
        });
        let Some(count) = count else { return false };
        (0..count).all(|number| {
            let mut rest = number;
            let mut chosen = BTreeMap::new();
            for (axis, choices) in &axes {
                chosen.insert(*axis, &choices[rest % choices.len()]);
                rest /= choices.len();
            }
            relation(self.holds(&chosen), other.holds(&chosen))
        })
    }

    /// Every axis, with the values that make a difference.
    fn collect<'a>(&'a self, axes: &mut BTreeMap<&'a str, BTreeSet<Choice>>) {
        match self {
            Self::Literal(_) => {}
            Self::Flag(axis) => {
                axes.entry(axis).or_default().extend([Choice::Bool(false), Choice::Bool(true)]);
            }
            Self::Compare { axis, value: AxisValue::Name(name), .. } => {
                let choices = axes.entry(axis).or_default();
                choices.extend([Choice::Other, Choice::Name(name.clone())]);
            }
            Self::Compare { axis, value: AxisValue::Integer(value), .. } => {
                let near = [value.saturating_sub(1), *value, value.saturating_add(1)];
                axes.entry(axis).or_default().extend(near.map(Choice::Integer));
            }
            Self::Not(inner) => inner.collect(axes),
            Self::All(parts) | Self::Any(parts) => parts.iter().for_each(|one| one.collect(axes)),
        }
    }

    fn holds(&self, chosen: &BTreeMap<&str, &Choice>) -> bool {
        match self {
            Self::Literal(value) => *value,
            Self::Flag(axis) => chosen.get(axis.as_str()) == Some(&&Choice::Bool(true)),
            Self::Compare { axis, operator, value } => match (chosen.get(axis.as_str()), value) {
                (Some(Choice::Integer(chosen)), AxisValue::Integer(value)) => {
                    operator.holds(*chosen, *value)
                }
                (Some(Choice::Name(chosen)), AxisValue::Name(value)) => {
                    (chosen == value) == (*operator == Comparison::Equal)
                }
                _ => *operator == Comparison::NotEqual,
            },
            Self::Not(inner) => !inner.holds(chosen),
            Self::All(parts) => parts.iter().all(|one| one.holds(chosen)),
            Self::Any(parts) => parts.iter().any(|one| one.holds(chosen)),
        }
    }
}

#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
enum Choice {
    Bool(bool),
    Integer(i64),
    Name(String),
    /// A value that no condition names.
    Other,
}

impl Comparison {
    /// Every comparison, its spelling, and its opposite.
    const TABLE: [(Self, &'static str, Self); 6] = [
        (Self::Equal, "==", Self::NotEqual),
        (Self::NotEqual, "!=", Self::Equal),
        (Self::Less, "<", Self::GreaterEqual),
        (Self::LessEqual, "<=", Self::Greater),
        (Self::Greater, ">", Self::LessEqual),
        (Self::GreaterEqual, ">=", Self::Less),
    ];

    fn row(self) -> (Self, &'static str, Self) {
        Self::TABLE.into_iter().find(|(known, ..)| *known == self).unwrap_or(Self::TABLE[0])
    }

    /// As WGSL, GLSL and C write it.
    pub fn spelling(self) -> &'static str {
        self.row().1
    }

    fn opposite(self) -> Self {
        self.row().2
    }

    /// The same with its sides exchanged.
    pub fn swapped(self) -> Self {
        match self {
            Self::Less => Self::Greater,
            Self::LessEqual => Self::GreaterEqual,
            Self::Greater => Self::Less,
            Self::GreaterEqual => Self::LessEqual,
            same => same,
        }
    }

    /// Whether it holds for two numbers.
    pub fn holds(self, left: i64, right: i64) -> bool {
        match self {
            Self::Equal => left == right,
            Self::NotEqual => left != right,
            Self::Less => left < right,
            Self::LessEqual => left <= right,
            Self::Greater => left > right,
            Self::GreaterEqual => left >= right,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn is(axis: &str, value: &str) -> Condition {
        Condition::Compare {
            axis: axis.to_owned(),
            operator: Comparison::Equal,
            value: AxisValue::Name(value.to_owned()),
        }
    }

    #[test]
    fn values_of_an_axis_exclude_each_other() {
        assert!(is("fog", "linear").excludes(&is("fog", "exp2")));
        assert!(!is("fog", "linear").excludes(&is("lights", "none")));
        assert!(is("fog", "linear").implies(&is("fog", "none").negated()));
        assert!(!is("fog", "none").negated().implies(&is("fog", "linear")));
    }

    #[test]
    fn a_part_implies_the_whole() {
        let flag = Condition::Flag("sheen".to_owned());
        let both = is("fog", "linear").and(flag.clone());
        assert!(both.implies(&flag));
        assert!(!flag.implies(&both));
        assert_eq!(Condition::any(vec![both, flag.clone()]), flag);
    }

    #[test]
    fn integers_are_ordered() {
        let compare = |operator, value| Condition::Compare {
            axis: "count".to_owned(),
            operator,
            value: AxisValue::Integer(value),
        };
        assert!(compare(Comparison::Greater, 4).implies(&compare(Comparison::Greater, 2)));
        assert!(!compare(Comparison::Greater, 2).implies(&compare(Comparison::Greater, 4)));
        assert!(compare(Comparison::Equal, 1).excludes(&compare(Comparison::GreaterEqual, 2)));
    }
}
