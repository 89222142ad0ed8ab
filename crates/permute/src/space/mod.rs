//! The space of a program: its axes, which points of their product are valid, and which of those
//! are wanted.

mod diagram;
mod formula;

pub use formula::ConstraintFormula;

use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};

use super::axis::{Axis, AxisKind, Mode, ValueSet};
use super::key::{Assignment, Key};
use super::{Setting, Settings};
use diagram::Diagram;
use formula::ConditionPool;
use lamplight_diagnostic::source::Span;
use lamplight_files::limits::{Exhausted, SPACE_STEPS, Steps};

/// A condition that every permutation satisfies.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Constraint {
    /// As the manifest has it.
    pub text: String,
    /// Why, in the manifest's words.
    pub doc: Option<String>,
    /// What must hold.
    pub formula: ConstraintFormula,
    /// The text in the manifest, quotes included.
    pub span: Span,
}

/// A part of the space: for each axis the values that it may have.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Slice {
    /// By axis: the values that are in the slice.
    pub values: Vec<ValueSet>,
    /// The entry in the manifest.
    pub span: Span,
}

impl Slice {
    fn formula(&self) -> ConstraintFormula {
        ConstraintFormula::All(
            self.values
                .iter()
                .enumerate()
                .map(|(axis, set)| ConstraintFormula::Is(axis, *set))
                .collect(),
        )
    }
}

/// Which valid points are wanted: those in a slice of `only` (all, if it is empty) and in no slice
/// of `exclude`, and always those of `include`.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct SliceLists {
    /// Where there are any, nothing else ships.
    pub only: Vec<Slice>,
    /// These do not ship.
    pub exclude: Vec<Slice>,
    /// These ship whatever the slices say.
    pub include: Vec<Assignment>,
}

impl SliceLists {
    fn formula(&self) -> ConstraintFormula {
        let any =
            |slices: &[Slice]| ConstraintFormula::Any(slices.iter().map(Slice::formula).collect());
        let chosen =
            if self.only.is_empty() { ConstraintFormula::All(Vec::new()) } else { any(&self.only) };
        let kept = ConstraintFormula::All(vec![
            chosen,
            ConstraintFormula::Not(Box::new(any(&self.exclude))),
        ]);
        ConstraintFormula::Any(self.include.iter().map(Assignment::formula).chain([kept]).collect())
    }
}

/// The constraints depend on each other in so many ways that counting exceeds its bound.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TooComplex;

/// Axes, by name, and the points of their product that are valid and wanted.
#[derive(Debug, Clone)]
pub struct Space {
    axes: Vec<Axis>,
    constraints: Vec<Constraint>,
    lists: SliceLists,
    /// The valid points, once somebody asks for them.
    valid: OnceLock<Diagram>,
    /// The wanted ones.
    wanted: OnceLock<Diagram>,
    /// [`Settings::enums`] at every point.
    enums: Arc<BTreeMap<String, Vec<String>>>,
    /// [`Settings::undeclared`] at every point.
    pub undeclared: Option<bool>,
    /// The values of features that are no axes, at every point.
    pub features: BTreeMap<String, Setting>,
}

impl Space {
    /// The space of these axes, at most [`super::axis::MAX`], sorted by name; axes are named by
    /// their index in constraints and lists.
    pub fn new(
        axes: Vec<Axis>,
        constraints: Vec<Constraint>,
        lists: SliceLists,
    ) -> Result<Self, TooComplex> {
        let order = axis_order(axes.len(), &constraints);
        let valid = build_diagram(&axes, &constraints, &SliceLists::default(), order.clone())?;
        let wanted = if lists == SliceLists::default() {
            valid.clone()
        } else {
            build_diagram(&axes, &constraints, &lists, order)?
        };
        let space = Self { lists, ..Self::outline(axes, constraints) };
        Ok(Self { valid: valid.into(), wanted: wanted.into(), ..space })
    }

    /// The space without lists, for callers that choose a point themselves. Which points are valid
    /// is found out only if somebody asks.
    pub fn outline(axes: Vec<Axis>, constraints: Vec<Constraint>) -> Self {
        let enums = axes.iter().filter(|axis| axis.kind == AxisKind::Enum);
        let enums = enums.map(|axis| (axis.name.clone(), axis.value_names())).collect();
        Self {
            enums: Arc::new(enums),
            axes,
            constraints,
            lists: SliceLists::default(),
            valid: OnceLock::new(),
            wanted: OnceLock::new(),
            undeclared: None,
            features: BTreeMap::new(),
        }
    }

    /// The valid points. An outline whose constraints are too complex has none.
    fn valid(&self) -> &Diagram {
        self.valid.get_or_init(|| {
            let order = axis_order(self.axes.len(), &self.constraints);
            let lists = SliceLists::default();
            build_diagram(&self.axes, &self.constraints, &lists, order.clone())
                .unwrap_or_else(|TooComplex| Diagram::empty(order))
        })
    }

    /// The wanted points. An outline has no lists, so all its valid points are.
    fn wanted(&self) -> &Diagram {
        self.wanted.get_or_init(|| self.valid().clone())
    }

    /// The axes, by name.
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// The axis of that name.
    pub fn axis(&self, name: &str) -> Option<&Axis> {
        self.axes.iter().find(|axis| axis.name == name)
    }

    /// What each permutation has to fulfil.
    pub fn constraints(&self) -> &[Constraint] {
        &self.constraints
    }

    /// Slices and keys that decide what ships.
    pub fn lists(&self) -> &SliceLists {
        &self.lists
    }

    /// Points of the full product; like every count, `u128::MAX` stands for that many or more.
    pub fn full_count(&self) -> u128 {
        self.axes
            .iter()
            .fold(1, |product: u128, axis| product.saturating_mul(axis.domain().len() as u128))
    }

    /// Points that satisfy the constraints.
    pub fn valid_count(&self) -> u128 {
        self.valid().count()
    }

    /// Points that satisfy the constraints and are wanted: the permutations.
    pub fn count(&self) -> u128 {
        self.wanted().count()
    }

    /// How many permutations would be left if the axis did not exist: those that differ only in it
    /// count as one.
    pub fn count_without(&self, axis: usize) -> Result<u128, TooComplex> {
        self.wanted().count_without(axis)
    }

    /// Every permutation in canonical order: a mixed-radix count with the first axis as its most
    /// significant digit. There are [`Self::count`] of them, so ask that first.
    pub fn enumerate(&self) -> Vec<Assignment> {
        let mut points = self.wanted().points();
        points.sort();
        points
    }

    /// Whether the point is a permutation.
    pub fn contains(&self, point: &Assignment) -> bool {
        self.wanted().contains(point)
    }

    /// Whether the point satisfies the constraints.
    pub fn is_valid(&self, point: &Assignment) -> bool {
        self.valid().contains(point)
    }

    /// The constraints that the point breaks.
    pub fn broken(&self, point: &Assignment) -> impl Iterator<Item = &Constraint> {
        self.constraints.iter().filter(|constraint| !constraint.formula.holds(&point.0))
    }

    /// For each axis the values that occur in a valid point.
    pub fn valid_values(&self) -> Vec<ValueSet> {
        self.valid().used()
    }

    /// A valid point with the pinned `(axis, ordinal)` pairs; `choose` picks each ordinal among
    /// those that lead to one. `None` if there is none.
    pub fn pick_valid(
        &self,
        pins: &[(usize, usize)],
        choose: impl FnMut(usize, ValueSet) -> usize,
    ) -> Option<Assignment> {
        let mut allowed = axis_domains(&self.axes);
        pins.iter().for_each(|(axis, ordinal)| allowed[*axis] = ValueSet::single(*ordinal));
        self.valid().pick(&allowed, choose)
    }

    /// Steps that [`Self::meets`] takes.
    pub fn steps_of_meeting(&self) -> usize {
        self.valid().nodes()
    }

    /// Whether some valid point is in the slice.
    pub fn meets(&self, slice: &Slice) -> bool {
        self.valid().meets(&slice.values)
    }

    /// How many points of the full product satisfy one condition, within the steps that are left.
    pub fn satisfying(
        &self,
        formula: &ConstraintFormula,
        steps: &mut Steps,
    ) -> Result<u128, TooComplex> {
        let domains = axis_domains(&self.axes);
        // Every level of the diagram is made, whatever the condition is.
        steps.spend(domains.len() as u64).map_err(|Exhausted| TooComplex)?;
        let mut conditions = ConditionPool::new(domains.clone(), *steps);
        let order = (0..self.axes.len()).collect();
        let diagram = conditions
            .add(formula)
            .and_then(|condition| Diagram::new(&mut conditions, condition, &domains, order));
        *steps = conditions.steps();
        Ok(diagram?.count())
    }

    /// Every axis at its default.
    pub fn default_assignment(&self) -> Assignment {
        Assignment(self.axes.iter().map(|axis| axis.default as u8).collect())
    }

    /// The text that names a point.
    pub fn key(&self, point: &Assignment) -> Key {
        Key::of(&self.axes, point)
    }

    /// The settings for a composition at a point: every axis with its value, dynamic ones too.
    pub fn settings(&self, point: &Assignment) -> Settings {
        let integers = self.axes.iter().filter(|axis| axis.kind == AxisKind::Int);
        let open = self.axes.iter().filter(|axis| axis.mode == Mode::Spec);
        let axes = self.axes.iter().enumerate();
        let axes = axes.map(|(index, axis)| (axis.name.clone(), self.value(index, point).clone()));
        Settings {
            values: self.features.clone().into_iter().chain(axes).collect(),
            enums: self.enums.clone(),
            integers: integers.map(|axis| axis.name.clone()).collect(),
            open: open.map(|axis| (axis.name.clone(), axis.values[axis.default].clone())).collect(),
            undeclared: self.undeclared,
            constants: BTreeMap::new(),
        }
    }

    /// The value of an axis at a point.
    pub fn value(&self, axis: usize, point: &Assignment) -> &Setting {
        &self.axes[axis].values[point.ordinal(axis)]
    }
}

fn build_diagram(
    axes: &[Axis],
    constraints: &[Constraint],
    lists: &SliceLists,
    order: Vec<usize>,
) -> Result<Diagram, TooComplex> {
    let domains = axis_domains(axes);
    let mut conditions = ConditionPool::new(domains.clone(), Steps::new(SPACE_STEPS));
    let lists = lists.formula();
    let formulas = constraints.iter().map(|constraint| &constraint.formula).chain([&lists]);
    let parts = formulas.map(|formula| conditions.add(formula)).collect::<Result<_, _>>()?;
    let condition = conditions.all(parts)?;
    Diagram::new(&mut conditions, condition, &domains, order)
}

fn axis_domains(axes: &[Axis]) -> Vec<ValueSet> {
    axes.iter().map(Axis::domain).collect()
}

/// The order in which a diagram asks the axes: always next the one that shares the most
/// constraints with those already asked, then the one in most constraints, then by name. Axes
/// that constrain each other are neighbours, which keeps the diagram narrow.
fn axis_order(count: usize, constraints: &[Constraint]) -> Vec<usize> {
    let mentions: Vec<Vec<bool>> =
        constraints.iter().map(|constraint| mentioned_axes(count, &constraint.formula)).collect();
    let mut order: Vec<usize> = Vec::new();
    let mut near = vec![0usize; count];
    let involved: Vec<usize> =
        (0..count).map(|axis| mentions.iter().filter(|axes| axes[axis]).count()).collect();
    while order.len() < count {
        let involved = |axis: usize| involved[axis];
        let rest = (0..count).filter(|axis| !order.contains(axis));
        let Some(next) =
            rest.max_by_key(|axis| (near[*axis], involved(*axis), std::cmp::Reverse(*axis)))
        else {
            break;
        };
        order.push(next);
        for axes in mentions.iter().filter(|axes| axes[next]) {
            axes.iter()
                .zip(&mut near)
                .for_each(|(mentioned, near)| *near += usize::from(*mentioned));
        }
    }
    order
}

fn mentioned_axes(count: usize, formula: &ConstraintFormula) -> Vec<bool> {
    let mut axes = vec![false; count];
    formula.mark(&mut axes);
    axes
}
