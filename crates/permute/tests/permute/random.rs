//! Small random spaces, which are the same in every run.

use lamplight_diagnostic::source::{SourceId, Span};
use lamplight_permute::axis::{Axis, AxisKind, Mode, ValueSet};
use lamplight_permute::space::{Constraint, ConstraintFormula, Slice, SliceLists};
use lamplight_permute::{Assignment, Setting, Space};

use lamplight_testing::random::Random;

pub const NOWHERE: Span = Span { source: SourceId(0), start: 0, end: 0 };

pub fn axis(name: String, count: usize) -> Axis {
    let values = (0..count).map(|value| Setting::Name(format!("v{value}"))).collect();
    Axis {
        name,
        kind: AxisKind::Enum,
        values,
        default: 0,
        mode: Mode::Static,
        doc: None,
        span: NOWHERE,
    }
}

pub fn constraint(formula: ConstraintFormula) -> Constraint {
    Constraint { text: String::new(), doc: None, formula, span: NOWHERE }
}

/// A space of up to six axes with up to four values each, up to five constraints, and possibly lists.
pub fn space(random: &mut Random) -> Space {
    let axes: Vec<Axis> = (0..1 + random.below(6))
        .map(|index| axis(format!("a{index}"), 1 + random.below(4)))
        .collect();
    let constraints = (0..random.below(6)).map(|_| constraint(formula(random, &axes, 3))).collect();
    let lists = SliceLists {
        only: slices(random, &axes),
        exclude: slices(random, &axes),
        include: Vec::new(),
    };
    Space::new(axes, constraints, lists).expect("small spaces are simple")
}

fn slices(random: &mut Random, axes: &[Axis]) -> Vec<Slice> {
    let slice = |random: &mut Random| Slice {
        values: axes.iter().map(|axis| values(random, axis)).collect(),
        span: NOWHERE,
    };
    (0..random.below(4)).map(|_| slice(random)).collect()
}

fn values(random: &mut Random, axis: &Axis) -> ValueSet {
    (0..axis.values.len()).filter(|_| random.below(2) == 0).collect()
}

fn formula(random: &mut Random, axes: &[Axis], depth: usize) -> ConstraintFormula {
    let parts = |random: &mut Random| {
        (0..1 + random.below(3)).map(|_| formula(random, axes, depth - 1)).collect()
    };
    match if depth == 0 { 0 } else { random.below(5) } {
        0 | 1 => {
            let axis = random.below(axes.len());
            ConstraintFormula::Is(axis, values(random, &axes[axis]))
        }
        2 => ConstraintFormula::Not(Box::new(formula(random, axes, depth - 1))),
        3 => ConstraintFormula::All(parts(random)),
        _ => ConstraintFormula::Any(parts(random)),
    }
}

/// Every point of the full product, in canonical order.
pub fn product(space: &Space) -> Vec<Vec<u8>> {
    space.axes().iter().fold(vec![Vec::new()], |points, axis| {
        points
            .iter()
            .flat_map(|point: &Vec<u8>| {
                (0..axis.values.len() as u8).map(move |value| [point.as_slice(), &[value]].concat())
            })
            .collect()
    })
}

pub fn is_valid(space: &Space, point: &[u8]) -> bool {
    space.constraints().iter().all(|constraint| constraint.formula.holds(point))
}

pub fn is_wanted(space: &Space, point: &[u8]) -> bool {
    let inside = |slice: &Slice| {
        slice.values.iter().zip(point).all(|(set, value)| set.contains((*value).into()))
    };
    let lists = space.lists();
    is_valid(space, point)
        && (lists.only.is_empty() || lists.only.iter().any(inside))
        && !lists.exclude.iter().any(inside)
}

pub fn ordinals(points: &[Assignment]) -> Vec<Vec<u8>> {
    points.iter().map(|point| point.ordinals().to_vec()).collect()
}
