//! Axes: what a program varies in, and the values of each.

use super::Setting;
use lamplight_diagnostic::source::Span;

/// The most axes of a program, and the most values of an axis. Sets of either then fit into one
/// machine word, which makes counting large spaces fast.
pub const MAX: usize = lamplight_files::limits::AXES;

/// What the values of an axis are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum AxisKind {
    /// False or true.
    Bool,
    /// Integers.
    Int,
    /// Names.
    Enum,
}

impl AxisKind {
    /// The name in messages and reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Bool => "boolean",
            Self::Int => "integer",
            Self::Enum => "enum",
        }
    }

    /// The kind a value belongs to.
    pub fn of(value: &Setting) -> Self {
        match value {
            Setting::Bool(_) => Self::Bool,
            Setting::Int(_) => Self::Int,
            Setting::Name(_) => Self::Enum,
        }
    }
}

/// When the value of an axis is chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default)]
pub enum Mode {
    /// While composing.
    #[default]
    Static,
    /// When a pipeline is made, by an override or a specialisation constant, where the target
    /// has one; while composing elsewhere.
    Spec,
    /// By a uniform: never multiplies permutations.
    Dynamic,
}

impl Mode {
    /// Every mode, by its name in manifests.
    pub const ALL: &[(&str, Self)] =
        &[("static", Self::Static), ("spec", Self::Spec), ("dynamic", Self::Dynamic)];

    /// The name in manifests.
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(_, mode)| *mode == self).map_or("", |(name, _)| name)
    }
}

/// One thing a program varies in.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Axis {
    /// As keys name it.
    pub name: String,
    /// What its values are.
    pub kind: AxisKind,
    /// All of one kind, distinct, in the order declared, at least one, at most [`MAX`].
    pub values: Vec<Setting>,
    /// The ordinal of the default, which keys leave out.
    pub default: usize,
    /// How its values reach the shader.
    pub mode: Mode,
    /// What the manifest says about it.
    pub doc: Option<String>,
    /// The axis's name in the manifest.
    pub span: Span,
}

impl Axis {
    /// The place of a value among `values`.
    pub fn ordinal(&self, value: &Setting) -> Option<usize> {
        self.values.iter().position(|known| known == value)
    }

    /// The values as text, in order: for suggestions and listings.
    pub fn value_names(&self) -> Vec<String> {
        self.values.iter().map(ToString::to_string).collect()
    }

    /// The ordinals that permutations choose from: all, or the default of a dynamic axis.
    pub fn domain(&self) -> ValueSet {
        match self.mode {
            Mode::Dynamic => ValueSet::single(self.default),
            Mode::Static | Mode::Spec => ValueSet::full(self.values.len()),
        }
    }

    /// The GLSL macros for this axis: its own, then one for each value of an enum.
    pub fn macros(&self) -> Vec<String> {
        let own = self.name.to_ascii_uppercase();
        let values = match self.kind {
            AxisKind::Enum => self
                .values
                .iter()
                .map(|value| format!("{own}_{}", value.to_string().to_ascii_uppercase()))
                .collect(),
            AxisKind::Bool | AxisKind::Int => Vec::new(),
        };
        std::iter::once(own).chain(values).collect()
    }
}

/// A set of ordinals of one axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ValueSet(u128);

impl ValueSet {
    /// No ordinal.
    pub const EMPTY: Self = Self(0);

    /// One ordinal, below [`MAX`].
    pub fn single(ordinal: usize) -> Self {
        Self(1 << ordinal)
    }

    /// The ordinals below `count`, which is at most [`MAX`].
    pub fn full(count: usize) -> Self {
        Self(u128::MAX.checked_shr((MAX - count) as u32).unwrap_or(0))
    }

    /// Whether the value is in the set.
    pub fn contains(self, ordinal: usize) -> bool {
        self.0 >> ordinal & 1 == 1
    }

    /// Whether no value is in the set.
    pub fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// Values that are in both sets.
    pub fn and(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }

    /// Values that are in one of the sets.
    pub fn or(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// The ordinals of `self` that `other` lacks.
    pub fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// How many ordinals it has.
    pub fn len(self) -> usize {
        self.0.count_ones() as usize
    }

    /// The ordinals, ascending.
    pub fn iter(self) -> impl Iterator<Item = usize> {
        (0..MAX - self.0.leading_zeros() as usize).filter(move |ordinal| self.contains(*ordinal))
    }
}

impl FromIterator<usize> for ValueSet {
    fn from_iter<T: IntoIterator<Item = usize>>(ordinals: T) -> Self {
        ordinals.into_iter().fold(Self::EMPTY, |set, ordinal| set.or(Self::single(ordinal)))
    }
}
