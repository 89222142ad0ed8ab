//! One value for each axis or feature that a composition may ask for.

use std::collections::BTreeMap;
use std::fmt;
use std::sync::Arc;

/// The value of an axis or a feature.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Setting {
    /// False or true.
    Bool(bool),
    /// An integer.
    Int(i64),
    /// A value of an enum axis, by name.
    Name(String),
}

impl Setting {
    /// `true` and `false`, a decimal integer as it is printed, or else a name.
    pub fn parse(text: &str) -> Self {
        match (text, text.parse::<i64>()) {
            ("true", _) => Self::Bool(true),
            ("false", _) => Self::Bool(false),
            (_, Ok(number)) if number.to_string() == text => Self::Int(number),
            _ => Self::Name(text.to_owned()),
        }
    }
}

impl fmt::Display for Setting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Bool(value) => value.fmt(f),
            Self::Int(value) => value.fmt(f),
            Self::Name(value) => value.fmt(f),
        }
    }
}

/// The settings that a composition is asked for: a value for every axis and feature.
#[derive(Debug, Clone, Default, PartialEq, Eq, Hash)]
pub struct Settings {
    /// By name of the axis or feature, with its chosen value.
    pub values: BTreeMap<String, Setting>,
    /// Enum axes with all their values, so that `@if(axis == value)` and the GLSL macros
    /// `AXIS_VALUE` know them. Names that are not here are plain WESL features.
    pub enums: Arc<BTreeMap<String, Vec<String>>>,
    /// Declared integer axes: those that conditions may compare.
    pub integers: std::collections::BTreeSet<String>,
    /// Axes whose numbers are left open for the pipeline to choose, with their defaults:
    /// `constants::NAME` is an override then. Conditions see the value all the same.
    pub open: BTreeMap<String, Setting>,
    /// The value of every feature that has none here. If this is `None`, asking for such a feature
    /// is an error.
    pub undeclared: Option<bool>,
    /// Values for `constants::NAME` where no axis has the name: literals of WGSL, as
    /// [`super::constant::parse`] reads them.
    pub constants: BTreeMap<String, String>,
}

impl Settings {
    /// The value of an axis or a feature.
    pub fn value(&self, name: &str) -> Option<&Setting> {
        const ON: &Setting = &Setting::Bool(true);
        const OFF: &Setting = &Setting::Bool(false);
        let undeclared = || self.undeclared.map(|on| if on { ON } else { OFF });
        self.values.get(name).or_else(undeclared)
    }
}
