//! Laws: properties of a function's values that hold for all rows, without an oracle.
//!
//! | law | holds |
//! |---|---|
//! | `range = [low, high]` | every component lies there, bounds included, exactly |
//! | `rising = "x"`, `falling = "x"` | a larger `x` never gives a smaller (larger) value, up to the tolerance |
//! | `swap = ["l", "v"]` | exchanging the parameters, pair by pair, changes nothing: symmetry, reciprocity |
//! | `even = ["n", "l"]` | negating the parameters changes nothing |
//! | `continuous = "x", slope = 4` | `x` a little larger changes the value by no more than that slope allows: no jumps |
//! | `at = { d = 0 }, gives = 1` | the value there, whatever the other parameters are |
//! | `integral = "l", about = "n", gives = 3.14, within = 0.001` | the integral over the hemisphere of directions `l` about `n`, for the case's other values; over the sphere without `about`; `cosine = true` for the cosine as a factor; `at_most` in place of `gives` for energy; `steps = 16` |
//! | `reaches = [low, high]` | some row comes at least that low and some that high: the inputs are no trivial ones |
//! | `albedo = ["d_ggx", "v_smith_ggx"], within = 0.001` | the function's value is the directional albedo of the product of these, by quadrature (see [`Albedo`]); or `gives`, `at_most` |
//! | `inverse = "g", within = 1e-6` | `g` of the value gives the first parameter back, or that named by `of` |
//! | `equal = "g", with = { b = "a" }, within = 1e-6` | the function's value is that of `g`, or the product of several functions (see [`Equality`]) |
//! | `area = "g", along = "r", from = 0, to = "r", within = 1e-6` | the function's value is the integral of `g`, or of a product, along one parameter (see [`Area`]); or `gives`, `at_most` |
//! | `finite = 1e9` | no value is NaN or infinite for arguments up to that magnitude, whatever they are (see [`finite`]); `where` keeps some of them, `because` says why |
//!
//! `albedo`, `inverse`, `equal` and `area` are also about other functions. Those of the same module
//! are given by name, others by path.

mod albedo;
mod area;
mod factor;
pub mod finite;
mod integral;

pub use albedo::{Albedo, IntegralValue, Over};
pub use area::{Area, Equality};
pub use factor::Formulas;
pub use integral::Integral;

use std::ops::Range;

use super::cases::{FormulaText, Rows};
use super::formula::Scope;
use lamplight_diagnostic::source::Span;
use lamplight_diagnostic::{Diagnostic, codes};
use lamplight_execute::kernel::TypeShape;
use naga::ScalarKind;

pub struct LawKind {
    pub name: &'static str,
    pub takes: Takes,
}

/// What is given for the law's key.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Takes {
    Numbers,
    Names,
    /// A parameter; the largest slope is in `slope`.
    Slope,
    /// The direction's parameter; see [`Integral`].
    Integral,
    /// Values of parameters; the expected result is in `gives`.
    Point,
    /// The factors of a reflectance; see [`Albedo`].
    Albedo,
    /// A function that leads back; see [`Inverse`].
    Inverse,
    /// Functions whose product the value is; see [`Equality`].
    Equality,
    /// Functions whose integral the value is; see [`Area`].
    Area,
    /// The largest magnitude of an argument; see [`finite`].
    Finite,
}

impl Takes {
    /// The other keys that the law's table may have.
    pub fn options(self) -> &'static [&'static str] {
        match self {
            Self::Numbers | Self::Names => &[],
            Self::Slope => &["slope"],
            Self::Integral => &["about", "cosine", "steps", "gives", "at_most", "within"],
            Self::Point => &["gives"],
            Self::Albedo => &[
                "over",
                "view",
                "azimuth",
                "peak",
                "with",
                "component",
                "steps",
                "gives",
                "at_most",
                "within",
            ],
            Self::Inverse => &["of", "within"],
            Self::Equality => &["with", "within"],
            Self::Area => &[
                "along", "from", "to", "finest", "times", "with", "steps", "gives", "at_most",
                "within",
            ],
            Self::Finite => &["where", "because"],
        }
    }
}

/// The law that no value is NaN or infinite. Functions of the library have it without being asked
/// for it.
pub const FINITE: &str = "finite";

pub const KINDS: &[LawKind] = &[
    LawKind { name: "range", takes: Takes::Numbers },
    LawKind { name: "reaches", takes: Takes::Numbers },
    LawKind { name: "rising", takes: Takes::Names },
    LawKind { name: "falling", takes: Takes::Names },
    LawKind { name: "swap", takes: Takes::Names },
    LawKind { name: "even", takes: Takes::Names },
    LawKind { name: "continuous", takes: Takes::Slope },
    LawKind { name: "at", takes: Takes::Point },
    LawKind { name: "integral", takes: Takes::Integral },
    LawKind { name: "albedo", takes: Takes::Albedo },
    LawKind { name: "inverse", takes: Takes::Inverse },
    LawKind { name: "equal", takes: Takes::Equality },
    LawKind { name: "area", takes: Takes::Area },
    LawKind { name: FINITE, takes: Takes::Finite },
];

/// One law of a case.
#[derive(Debug)]
pub struct Law {
    pub kind: &'static LawKind,
    pub span: Span,
    pub names: Vec<String>,
    pub numbers: Vec<f64>,
    pub at: Vec<(String, Vec<f64>)>,
    pub integral: Option<Integral>,
    pub albedo: Option<Albedo>,
    pub inverse: Option<Inverse>,
    pub equality: Option<Equality>,
    pub area: Option<Area>,
    /// The other functions that the law is about, by their names in the file.
    pub partners: Vec<String>,
    /// The arguments that the law `finite` tries; without it, all of them.
    pub filter: Option<FormulaText>,
}

/// An inverse: called with a row's value, and with the row's other parameters by name, the function
/// gives a parameter of the row back.
#[derive(Debug, Clone)]
pub struct Inverse {
    /// The parameter that must come back; the first one without it.
    pub of: Option<String>,
    /// The allowed error: relative for values above 1, absolute below.
    pub within: f64,
}

impl std::fmt::Debug for LawKind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name)
    }
}

/// The law as text for a case file, to reproduce a row that breaks it. Only laws that a single row
/// can break are reproduced, so the other laws are written without their options.
pub fn law_toml(law: &Law) -> String {
    let names = law.names.iter().map(|name| format!("{name:?}")).collect::<Vec<_>>().join(", ");
    let point = || {
        law.at
            .iter()
            .map(|(name, values)| format!("{name:?} = {values:?}"))
            .collect::<Vec<_>>()
            .join(", ")
    };
    let value = match law.kind.takes {
        Takes::Numbers => format!("{:?}", law.numbers),
        Takes::Finite => format!("{:?}", law.number(0)),
        Takes::Names => format!("[{names}]"),
        Takes::Integral | Takes::Albedo | Takes::Inverse | Takes::Equality | Takes::Area => names,
        Takes::Slope => format!("{names}, slope = {:?}", law.number(0)),
        Takes::Point => format!("{{ {} }}, gives = {:?}", point(), law.numbers),
    };
    format!("{{ {} = {value} }}", law.kind.name)
}

impl Law {
    /// The law that values are finite for arguments up to a magnitude.
    pub fn finite(kind: &'static LawKind, up_to: f64, span: Span) -> Self {
        Self { numbers: vec![up_to], ..Self::new(kind, span) }
    }

    /// A law of a kind, without any of its values yet.
    pub fn new(kind: &'static LawKind, span: Span) -> Self {
        Self {
            kind,
            span,
            names: Vec::new(),
            numbers: Vec::new(),
            at: Vec::new(),
            integral: None,
            albedo: None,
            inverse: None,
            equality: None,
            area: None,
            partners: Vec::new(),
            filter: None,
        }
    }

    /// The number for a component. A single number is for all components.
    pub fn number(&self, word: usize) -> f64 {
        self.numbers
            .get(if self.numbers.len() == 1 { 0 } else { word })
            .copied()
            .unwrap_or(f64::NAN)
    }
}

pub fn find_kind(name: &str) -> Option<&'static LawKind> {
    KINDS.iter().find(|kind| kind.name == name)
}

/// The rows that the law compares the case's rows with; `None` for laws about single values, and
/// for those with partners.
pub fn transform_rows(
    law: &Law,
    rows: &Rows,
    scope: &Scope<'_>,
) -> Result<Option<Rows>, Diagnostic> {
    if !law.partners.is_empty() {
        return Ok(None);
    }
    if law.kind.takes == Takes::Finite {
        return finite_rows(law, scope);
    }
    if let Some(integral) = &law.integral {
        let direction = |name: &String| direction_words(law, name, scope);
        let over = law.names.first().map(direction).transpose()?.unwrap_or_default();
        return Ok(Some(integral.rows(
            rows,
            over,
            integral.about.as_ref().map(direction).transpose()?,
        )));
    }
    let mut words = rows.words.clone();
    let places: Vec<_> =
        law.names.iter().map(|name| argument_place(law, name, scope)).collect::<Result<_, _>>()?;
    for row in words.chunks_mut(rows.stride) {
        match law.kind.name {
            "rising" | "falling" => {
                words_of(&places).for_each(|word| raise_word(&mut row[word], rows.kinds[word]))
            }
            "continuous" => {
                words_of(&places).for_each(|word| nudge_word(&mut row[word], rows.kinds[word]))
            }
            "even" => words_of(&places).for_each(|word| row[word] ^= 0x8000_0000),
            "swap" => swap_arguments(row, &places),
            "at" => set_arguments(law, row, scope)?,
            _ => return Ok(None),
        }
    }
    Ok(Some(rows.with_words(words)))
}

/// The arguments for one of the law's other functions; `None` where they are results. `own` has the
/// parameters of that function.
pub fn partner_rows(
    law: &Law,
    index: usize,
    rows: &Rows,
    (case, own): (&Scope<'_>, &Scope<'_>),
) -> Result<Option<Rows>, Diagnostic> {
    if let Some(albedo) = &law.albedo {
        return albedo.rows(rows, case, own, law.span).map(Some);
    }
    if let Some(equality) = &law.equality {
        return equality.rows(index, rows, (case, own), law.span).map(Some);
    }
    law.area.as_ref().map(|area| area.rows(rows, (case, own), law.span)).transpose()
}

/// The rows that the law `finite` adds; `None` for a function without parameters.
fn finite_rows(law: &Law, scope: &Scope<'_>) -> Result<Option<Rows>, Diagnostic> {
    let filter = law.filter.as_ref().map(|text| text.bind(scope)).transpose()?;
    let rows = finite::edge_rows(scope, law.number(0), filter.as_ref());
    if rows.is_empty() && !scope.0.is_empty() {
        let error =
            Diagnostic::error(codes::CASE_INVALID, "`where` leaves no arguments to the law");
        return Err(error.at(law.span, "here"));
    }
    Ok(Some(rows).filter(|rows| !rows.is_empty()))
}

fn argument_place<'a>(
    law: &Law,
    name: &str,
    scope: &'a Scope<'_>,
) -> Result<(usize, &'a TypeShape), Diagnostic> {
    let parts: Vec<String> = name.split('.').map(str::to_owned).collect();
    scope.find(&parts).ok_or_else(|| scope.unknown(name).at(law.span, "in this law"))
}

/// The words of a parameter that is a direction. Fails unless it has three floats.
fn direction_words(law: &Law, name: &str, scope: &Scope<'_>) -> Result<Range<usize>, Diagnostic> {
    let (first, shape) = argument_place(law, name, scope)?;
    if shape.kinds() == [ScalarKind::Float; 3] {
        return Ok(first..first + 3);
    }
    Err(Diagnostic::error(
        codes::CASE_INVALID,
        format!("`{name}` is not a direction: it does not have three floats"),
    )
    .at(law.span, "in this law"))
}

fn words_of<'a>(places: &'a [(usize, &TypeShape)]) -> impl Iterator<Item = usize> + 'a {
    places.iter().flat_map(|(first, shape)| *first..first + shape.words() as usize)
}

/// A slightly larger value. The step is large enough to pass an edge that the case approaches.
fn nudge_word(word: &mut u32, kind: ScalarKind) {
    if kind == ScalarKind::Float {
        let value = f32::from_bits(*word);
        *word = (value + value.abs() / 256.0 + 1.0 / 4096.0).to_bits();
    }
}

/// A value that is larger by one part in sixteen, at least by the smallest normal number.
fn raise_word(word: &mut u32, kind: ScalarKind) {
    *word = match kind {
        ScalarKind::Float => {
            let value = f32::from_bits(*word);
            (value + value.abs() / 16.0 + f32::MIN_POSITIVE).to_bits()
        }
        _ => word.saturating_add(1),
    };
}

fn swap_arguments(row: &mut [u32], places: &[(usize, &TypeShape)]) {
    let (pairs, _) = places.as_chunks::<2>();
    for [(first, shape), (second, other)] in pairs {
        for word in 0..shape.words().min(other.words()) as usize {
            row.swap(first + word, second + word);
        }
    }
}

fn set_arguments(law: &Law, row: &mut [u32], scope: &Scope<'_>) -> Result<(), Diagnostic> {
    for (name, values) in &law.at {
        let (first, shape) = argument_place(law, name, scope)?;
        for (index, kind) in shape.kinds().into_iter().enumerate() {
            let value =
                values.get(if values.len() == 1 { 0 } else { index }).copied().unwrap_or(0.0);
            row[first + index] = super::cases::word_of(value, kind);
        }
    }
    Ok(())
}

/// By how much a value breaks a law; 0 if it does not. `value` is the row's, `other` that of the
/// transformed row at the distance `moved`, and `word` is the component.
pub fn broken_by(law: &Law, value: f64, other: Option<f64>, moved: f64, word: usize) -> f64 {
    let number = |index: usize| law.number(index);
    match (law.kind.name, other) {
        ("continuous", Some(other)) => ((other - value).abs() - number(0) * moved).max(0.0),
        ("range", _) => (number(0) - value).max(value - number(1)).max(0.0),
        ("rising", Some(other)) => (value - other).max(0.0),
        ("falling", Some(other)) => (other - value).max(0.0),
        ("swap" | "even", Some(other)) => (other - value).abs(),
        ("at", Some(other)) => (other - number(word)).abs(),
        _ => 0.0,
    }
}
