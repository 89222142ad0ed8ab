//! The values that a parameter takes in a case.

use super::reader::{CaseNode, CaseValue};
use super::values::{
    even_steps, neighbours_of, related_directions, special_values, specials, unit_vectors,
    value_grid,
};
use crate::cases::values::Random;
use lamplight_diagnostic::{Diagnostic, Diagnostics};
use lamplight_execute::kernel::TypeShape;
use lamplight_files::limits::CASE_ROWS;
use naga::ScalarKind;

/// The most values of one domain.
const MOST: u32 = CASE_ROWS as u32;

/// A kind of domain in a case file: its key, the keys that may accompany it, and how it is
/// read.
struct DomainKind {
    key: &'static str,
    others: &'static [&'static str],
    read: fn(&CaseNode, &CaseNode) -> Result<Domain, Diagnostic>,
}

const KINDS: &[DomainKind] = &[
    DomainKind {
        key: "values",
        others: &[],
        read: |value, _| {
            Ok(Domain::Values(
                value.elements()?.iter().map(CaseNode::numbers).collect::<Result<_, _>>()?,
            ))
        },
    },
    DomainKind {
        key: "grid",
        others: &["count"],
        read: |value, all| Ok(Domain::Grid { range: value.pair()?, count: read_count(all)? }),
    },
    DomainKind { key: "log", others: &["count"], read: read_log },
    DomainKind {
        key: "random",
        others: &["count", "seed"],
        read: |value, all| {
            Ok(Domain::Random {
                range: value.pair()?,
                count: read_count(all)?,
                seed: read_seed(all)?,
            })
        },
    },
    DomainKind {
        key: "unit",
        others: &["seed"],
        read: |value, all| Ok(Domain::Unit { count: value.count(1, MOST)?, seed: read_seed(all)? }),
    },
    DomainKind {
        key: "hemisphere",
        others: &["count", "seed"],
        read: |value, all| read_about(value, all, About::Hemisphere),
    },
    DomainKind {
        key: "grazing",
        others: &["count", "seed"],
        read: |value, all| read_about(value, all, About::Grazing),
    },
    DomainKind {
        key: "same",
        others: &[],
        read: |value, _| {
            Ok(Domain::About { of: read_path(value)?, kind: About::Same, count: 1, seed: 0 })
        },
    },
    DomainKind {
        key: "around",
        others: &["ulps"],
        read: |value, all| {
            Ok(Domain::Around {
                value: value.numbers()?,
                ulps: all.required("ulps")?.count(1, 1000)?,
            })
        },
    },
    DomainKind {
        key: "special",
        others: &[],
        read: |value, _| Ok(Domain::Special(value.choice(SPECIALS)?)),
    },
];

/// Values at which functions fail most often.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Special {
    /// Zeros and ones of both signs, the f32 neighbours of 1, 0.5 and 2.
    Plain,
    /// Those of `Plain`, and subnormals, the smallest normal number, and 1e-18 of both signs.
    Small,
    /// Those of `Small`, and 1e18 of both signs, whose squares are still finite.
    All,
}

const SPECIALS: &[(&str, Special)] =
    &[("plain", Special::Plain), ("small", Special::Small), ("all", Special::All)];

/// How a vector is chosen relative to another parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum About {
    /// A unit vector whose dot product with the other one is not negative.
    Hemisphere,
    /// A unit vector nearly perpendicular to the other one, on either side.
    Grazing,
    /// Equal to the other one.
    Same,
}

/// A list of values for a parameter, as a case file describes it.
#[derive(Debug, Clone)]
pub enum Domain {
    Values(Vec<Vec<f64>>),
    Grid { range: (f64, f64), count: u32 },
    Log { range: (f64, f64), count: u32 },
    Random { range: (f64, f64), count: u32, seed: u64 },
    Unit { count: u32, seed: u64 },
    About { of: String, kind: About, count: u32, seed: u64 },
    Around { value: Vec<f64>, ulps: u32 },
    Special(Special),
    Union(Vec<Domain>),
}

/// Reads the domains below a path: one for a plain parameter, one for each field of a struct.
pub fn read_domains(
    path: &str,
    node: &CaseNode,
    found: &mut Vec<(String, Domain, CaseNode)>,
) -> Result<(), Diagnostics> {
    match &node.value {
        CaseValue::Table(entries) if !is_domain(node) => {
            for (key, inner) in entries {
                read_domains(&format!("{path}.{}", key.name), inner, found)?;
            }
        }
        _ => found.push((
            path.to_owned(),
            read_domain(node).map_err(|error| vec![error])?,
            node.clone(),
        )),
    }
    Ok(())
}

/// Whether every key belongs to one kind of domain. If not, the table lists fields of a struct.
fn is_domain(node: &CaseNode) -> bool {
    KINDS.iter().any(|kind| node.get(kind.key).is_some() && node.only(&domain_keys(kind)).is_ok())
}

fn domain_keys(kind: &DomainKind) -> Vec<&'static str> {
    std::iter::once(kind.key).chain(kind.others.iter().copied()).collect()
}

fn read_domain(node: &CaseNode) -> Result<Domain, Diagnostic> {
    match &node.value {
        CaseValue::Array(elements) => {
            elements.iter().map(read_part).collect::<Result<_, _>>().map(Domain::Union)
        }
        CaseValue::Table(_) => match KINDS.iter().find(|kind| node.get(kind.key).is_some()) {
            Some(kind) => (kind.read)(node.required(kind.key)?, node),
            None => Err(node.error("this table is not a domain").note(format!(
                "domains are {}",
                KINDS.iter().map(|kind| kind.key).collect::<Vec<_>>().join(", ")
            ))),
        },
        _ => node.number().map(|number| Domain::Values(vec![vec![number]])),
    }
}

/// Reads an element of a union. An array there lists values; the value of a vector is an array
/// itself.
fn read_part(node: &CaseNode) -> Result<Domain, Diagnostic> {
    match &node.value {
        CaseValue::Array(values) => {
            values.iter().map(CaseNode::numbers).collect::<Result<_, _>>().map(Domain::Values)
        }
        _ => read_domain(node),
    }
}

fn read_count(all: &CaseNode) -> Result<u32, Diagnostic> {
    all.required("count")?.count(1, MOST)
}

fn read_seed(all: &CaseNode) -> Result<u64, Diagnostic> {
    all.get("seed").map_or(Ok(1), |node| node.count(0, u32::MAX).map(u64::from))
}

fn read_log(value: &CaseNode, all: &CaseNode) -> Result<Domain, Diagnostic> {
    let range = value.pair()?;
    if range.0 * range.1 <= 0.0 {
        return Err(value.error("a logarithmic range may not hold zero"));
    }
    Ok(Domain::Log { range, count: read_count(all)? })
}

fn read_about(value: &CaseNode, all: &CaseNode, kind: About) -> Result<Domain, Diagnostic> {
    Ok(Domain::About {
        of: read_path(value)?,
        kind,
        count: read_count(all)?,
        seed: read_seed(all)?,
    })
}

fn read_path(value: &CaseNode) -> Result<String, Diagnostic> {
    value.text().map(str::to_owned)
}

impl Domain {
    /// The parameters whose values must be chosen before this one's.
    pub fn needs(&self) -> Vec<&str> {
        match self {
            Self::About { of, .. } => vec![of],
            Self::Union(parts) => parts.iter().flat_map(Self::needs).collect(),
            _ => Vec::new(),
        }
    }

    /// How many values are computed again for each row: those of the parts that depend on another
    /// parameter.
    pub fn fresh(&self) -> usize {
        match self {
            Self::About { count, .. } => *count as usize,
            Self::Union(parts) => parts.iter().map(Self::fresh).fold(0, usize::saturating_add),
            _ => 0,
        }
    }

    /// Whether the domain, or a part of it, gives directions. Shrinking then changes the vector as
    /// a whole, not word by word.
    pub fn is_unit(&self) -> bool {
        match self {
            Self::Unit { .. } | Self::About { .. } => true,
            Self::Union(parts) => parts.iter().any(Self::is_unit),
            _ => false,
        }
    }

    /// How many values the domain has for a parameter of this shape, without making them.
    ///
    /// # Errors
    /// Why it has none: it is empty, or its values have another number of components.
    /// `other` gives the shape of a needed parameter.
    pub fn count(
        &self,
        shape: &TypeShape,
        other: &dyn Fn(&str) -> Option<TypeShape>,
    ) -> Result<usize, String> {
        let size = shape.words() as usize;
        let fits = |given: usize| match given == 1 || given == size {
            true => Ok(()),
            false => Err(format!("expected {size} values, found {given}")),
        };
        let count = match self {
            Self::Values(values) => {
                values.iter().try_for_each(|value| fits(value.len()))?;
                values.len()
            }
            Self::Grid { count, .. } | Self::Log { count, .. } => {
                (0..size).fold(1, |all: usize, _| all.saturating_mul(*count as usize))
            }
            Self::Random { count, .. } => *count as usize,
            Self::Unit { count, .. } => check_direction(size).map(|()| *count as usize)?,
            Self::About { of, count, .. } => {
                check_direction(size)?;
                let given = other(of).map_or(0, |shape| shape.words() as usize);
                if given != size {
                    return Err(format!("has {size} values, and `{of}` has {given}"));
                }
                *count as usize
            }
            Self::Around { value, ulps } => {
                fits(value.len())?;
                2 * *ulps as usize + 1
            }
            Self::Special(special) => {
                special_values(*special).len() * (1 + size * usize::from(size > 1))
            }
            Self::Union(parts) => {
                check_unmistakable(parts, size)?;
                let counts = parts.iter().map(|part| part.count(shape, other));
                counts.sum::<Result<usize, String>>()?
            }
        };
        if count == 0 { Err("the domain has no values".to_owned()) } else { Ok(count) }
    }

    /// The values as words of the shape. `other` gives the value of a needed parameter. `salt`
    /// makes random values of different rows differ.
    pub fn words(
        &self,
        shape: &TypeShape,
        other: &dyn Fn(&str) -> Vec<f64>,
        salt: u64,
    ) -> Vec<Vec<u32>> {
        let kinds = shape.kinds();
        let to_words = |value: Vec<f64>| {
            let splat = value.len() == 1;
            kinds
                .iter()
                .enumerate()
                .map(|(index, kind)| {
                    word_of(value.get(if splat { 0 } else { index }).copied().unwrap_or(0.0), *kind)
                })
                .collect()
        };
        self.values(kinds.len(), other, salt).into_iter().map(to_words).collect()
    }

    fn values(&self, size: usize, other: &dyn Fn(&str) -> Vec<f64>, salt: u64) -> Vec<Vec<f64>> {
        match self {
            Self::Values(values) => values.clone(),
            Self::Grid { range, count } => {
                value_grid(size, &even_steps(*count, |t| range.0 + (range.1 - range.0) * t))
            }
            Self::Log { range, count } => {
                value_grid(size, &even_steps(*count, |t| range.0 * (range.1 / range.0).powf(t)))
            }
            Self::Random { range, count, seed } => {
                let mut random = Random::new(seed ^ salt << 20);
                (0..*count)
                    .map(|_| (0..size).map(|_| random.range(range.0, range.1)).collect())
                    .collect()
            }
            Self::Unit { count, seed } => unit_vectors(size, *count, *seed),
            Self::About { of, kind, count, seed } => {
                related_directions(&other(of), *kind, *count, seed ^ salt << 20)
            }
            Self::Around { value, ulps } => neighbours_of(value, *ulps),
            Self::Special(special) => specials(*special, size),
            Self::Union(parts) => {
                parts.iter().flat_map(|part| part.values(size, other, salt)).collect()
            }
        }
    }
}

/// Random directions are drawn from a cube until one lies in the unit sphere. In many dimensions
/// hardly any does, so a direction has at most 4 values.
fn check_direction(size: usize) -> Result<(), String> {
    match size {
        1..=4 => Ok(()),
        _ => Err(format!("a direction has 1 to 4 values, and this has {size}")),
    }
}

/// Refuses a list of plain numbers that has as many numbers as the vector has components. Each
/// number would be a vector with equal components, but whoever writes such a list means one vector.
fn check_unmistakable(parts: &[Domain], size: usize) -> Result<(), String> {
    let one = |part: &Domain| match part {
        Domain::Values(values) => values.iter().map(|value| plain_number(value)).collect(),
        _ => None,
    };
    let numbers: Option<Vec<Vec<f64>>> = parts.iter().map(one).collect();
    let Some(numbers) = numbers.map(|numbers| numbers.concat()) else { return Ok(()) };
    if size < 2 || numbers.len() != size || (parts.len() != 1 && parts.len() != size) {
        return Ok(());
    }
    let list = format!("{numbers:?}");
    Err(format!(
        "these are {size} vectors of equal components: for one vector write `{{ values = [{list}] }}`, for {size} of them `{{ values = {list} }}`"
    ))
}

/// The number of a value that has one component.
fn plain_number(value: &[f64]) -> Option<f64> {
    match value {
        [number] => Some(*number),
        _ => None,
    }
}

/// The 32-bit word of a value of the scalar kind.
pub fn word_of(value: f64, kind: ScalarKind) -> u32 {
    match kind {
        ScalarKind::Sint => value as i32 as u32,
        ScalarKind::Uint => value as u32,
        ScalarKind::Bool => u32::from(value != 0.0),
        _ => (value as f32).to_bits(),
    }
}
