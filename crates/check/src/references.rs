//! References: what functions should return, in f64, with one file of `references/` for each
//! module. A reference is written from the published formula and never from the shader's text.

use std::sync::Arc;

use glam::{DMat3, DMat4, DVec2, DVec3, DVec4};

use lamplight_execute::fixture::{Fixture, FixtureSampler, FixtureTexture};

pub struct ReferenceEntry {
    /// Module path below the package, `lighting::spot`.
    pub module: &'static str,
    /// Function name, what its reference is written from, and the reference.
    pub functions: &'static [(&'static str, Source, Reference)],
}

/// What a reference is written from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Source {
    /// What the quantity is: an integral by quadrature, or a sum over all parts.
    Integral,
    /// A formula of a publication, in another form or order than the shader's.
    Published,
    /// The code or formula of a standard or of an extension.
    Specification,
    /// Terms of a sum without end, as many as count in f64.
    Series,
}

impl Source {
    pub fn name(self) -> &'static str {
        match self {
            Self::Integral => "integral",
            Self::Published => "published form",
            Self::Specification => "specification",
            Self::Series => "series",
        }
    }
}

/// A reference reads its arguments in the order of the parameters.
pub type Reference = fn(&mut CallArguments<'_>) -> Expected;

/// The arguments of one call, taken from the front.
pub struct CallArguments<'a> {
    words: &'a [f64],
    fixtures: &'a [Arc<Fixture>],
}

impl<'a> CallArguments<'a> {
    /// The words of the plain parameters, and the fixtures of the others in order.
    pub fn new(words: &'a [f64], fixtures: &'a [Arc<Fixture>]) -> Self {
        Self { words, fixtures }
    }

    /// A number. A missing word is 0; the comparison with the shader then fails.
    pub fn f64(&mut self) -> f64 {
        let (first, rest) = self.words.split_first().unwrap_or((&0.0, &[]));
        self.words = rest;
        *first
    }

    /// A truth value.
    pub fn bool(&mut self) -> bool {
        self.f64() != 0.0
    }

    pub fn vec2(&mut self) -> DVec2 {
        DVec2::new(self.f64(), self.f64())
    }

    pub fn vec3(&mut self) -> DVec3 {
        DVec3::new(self.f64(), self.f64(), self.f64())
    }

    pub fn vec4(&mut self) -> DVec4 {
        DVec4::new(self.f64(), self.f64(), self.f64(), self.f64())
    }

    /// Column by column.
    pub fn mat3(&mut self) -> DMat3 {
        DMat3::from_cols(self.vec3(), self.vec3(), self.vec3())
    }

    /// Column by column.
    pub fn mat4(&mut self) -> DMat4 {
        DMat4::from_cols(self.vec4(), self.vec4(), self.vec4(), self.vec4())
    }

    /// The next texture.
    pub fn texture(&mut self) -> Option<&'a FixtureTexture> {
        self.fixture(|fixture| match fixture {
            Fixture::Texture(texture) => Some(texture),
            Fixture::Sampler(_) => None,
        })
    }

    /// The next sampler.
    pub fn sampler(&mut self) -> Option<FixtureSampler> {
        self.fixture(|fixture| match fixture {
            Fixture::Sampler(sampler) => Some(*sampler),
            Fixture::Texture(_) => None,
        })
    }

    fn fixture<T>(&mut self, pick: impl Fn(&'a Fixture) -> Option<T>) -> Option<T> {
        let index = self.fixtures.iter().position(|fixture| pick(fixture).is_some())?;
        let found = pick(&self.fixtures[index]);
        self.fixtures = &self.fixtures[index + 1..];
        found
    }
}

/// What a call should return, as words.
#[derive(Debug, Clone, PartialEq)]
pub struct Expected {
    pub value: Vec<f64>,
    /// Other values that are accepted: those of the other branch, where rounding may decide a
    /// comparison.
    pub alternatives: Vec<Vec<f64>>,
}

impl Expected {
    /// Words one after another.
    pub fn words(value: impl IntoIterator<Item = f64>) -> Self {
        Self { value: value.into_iter().collect(), alternatives: Vec::new() }
    }

    /// Adds a value that is accepted too.
    pub fn or(mut self, other: impl Into<Self>) -> Self {
        let other = other.into();
        self.alternatives.push(other.value);
        self.alternatives.extend(other.alternatives);
        self
    }
}

impl From<f64> for Expected {
    fn from(value: f64) -> Self {
        Self::words([value])
    }
}

impl From<bool> for Expected {
    fn from(value: bool) -> Self {
        Self::words([f64::from(u8::from(value))])
    }
}

impl From<DVec2> for Expected {
    fn from(value: DVec2) -> Self {
        Self::words(value.to_array())
    }
}

impl From<DVec3> for Expected {
    fn from(value: DVec3) -> Self {
        Self::words(value.to_array())
    }
}

impl From<DVec4> for Expected {
    fn from(value: DVec4) -> Self {
        Self::words(value.to_array())
    }
}

impl From<DMat3> for Expected {
    fn from(value: DMat3) -> Self {
        Self::words(value.to_cols_array())
    }
}

include!(concat!(env!("OUT_DIR"), "/references.rs"));

/// The reference of a function by its path below the package.
pub fn find_reference(module: &str, function: &str) -> Option<Reference> {
    find(module, function).map(|(_, reference)| reference)
}

/// What the reference of a function is written from.
pub fn find_source(module: &str, function: &str) -> Option<Source> {
    find(module, function).map(|(source, _)| source)
}

fn find(module: &str, function: &str) -> Option<(Source, Reference)> {
    let entry = ALL.iter().find(|entry| entry.module == module)?;
    let mut named = entry.functions.iter().filter(|(name, ..)| *name == function);
    named.next().map(|(_, source, reference)| (*source, *reference))
}
