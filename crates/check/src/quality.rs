//! Measures the errors of different functions for the same task, for the catalogue's pictures of
//! cost against quality.

use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::sync::{Arc, Mutex};

use super::library::Library;
use lamplight_bundle::Language;
use lamplight_catalogue::quality::{Measured, QualityEntry, QualityGroup, QualityReference};
use lamplight_diagnostic::source::SourceSet;
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_execute::fixture::{
    Address, Compare, Fixture, FixtureSampler, FixtureTexture, TextureKind,
};
use lamplight_execute::{Session, kernel};

/// Name of the function around an entry's expression.
pub const FUNCTION: &str = "lamplight_quality";

/// Texels of the depth map along each side, and the depths on the two sides of its edge.
const SIZE: u32 = 64;
const DEPTHS: [f32; 2] = [0.25, 0.75];
/// The radius of the wanted penumbra in texels, and how many comparisons its reference averages.
const RADIUS: f64 = 4.0;
const TAPS: u32 = 1024;

/// The module of one expression of a group, as a function of `x` and `y`.
pub fn quality_module(
    library: &Library,
    sources: &Mutex<SourceSet>,
    group: &QualityGroup,
    value: &str,
) -> Result<naga::Module, Diagnostics> {
    let imports = group.imports.iter().map(|path| format!("import {}::{path};\n", library.name()));
    let map = if group.edge { "map: texture_depth_2d, smp: sampler_comparison, " } else { "" };
    let text = format!(
        "{}\nfn {FUNCTION}({map}x: f32, y: f32) -> f32 {{\n    {}\n    return {value};\n}}\n",
        imports.collect::<String>(),
        group.setup
    );
    let root = ("quality.wesl", text.as_str());
    Ok(library.importing(sources, root, Language::Wesl, FUNCTION)?.module)
}

/// The errors of all entries of a group.
pub fn measure_group(
    library: &Library,
    sources: &Mutex<SourceSet>,
    group: QualityGroup,
    session: &mut dyn Session,
) -> Result<Measured, Diagnostics> {
    let map = edge_map();
    let mut errors = Vec::new();
    for entry in &group.entries {
        let found = run_expression(library, sources, &group, &entry.value, &map, session)?;
        let exact = match (&entry.exact, entry.reference.or(group.reference)) {
            (Some(exact), _) => run_expression(library, sources, &group, exact, &map, session)?,
            (None, Some(reference)) => reference_values(&group, reference, &map),
            (None, None) => return Err(vec![nothing_exact(&group, entry)]),
        };
        let differences: Vec<f64> =
            found.iter().zip(&exact).map(|(found, exact)| found - exact).collect();
        let scale = if group.relative { 100.0 / root_mean_square(&exact) } else { 1.0 };
        errors.push(root_mean_square(&differences) * scale);
    }
    Ok(Measured { group, errors })
}

fn nothing_exact(group: &QualityGroup, entry: &QualityEntry) -> Diagnostic {
    Diagnostic::error(
        codes::DATA_SYNTAX,
        format!("`{}` has neither `exact` nor `reference`", group.key(entry)),
    )
}

fn root_mean_square(values: &[f64]) -> f64 {
    let sum: f64 = values.iter().map(|value| value * value).sum();
    (sum / values.len().max(1) as f64).sqrt()
}

/// The inputs `x` and `y` of a group. `x` changes fastest.
fn grid_places(group: &QualityGroup) -> impl Iterator<Item = (f64, f64)> {
    let x = group.x;
    group.y.values().flat_map(move |y| x.values().map(move |x| (x, y)))
}

fn run_expression(
    library: &Library,
    sources: &Mutex<SourceSet>,
    group: &QualityGroup,
    value: &str,
    map: &FixtureTexture,
    session: &mut dyn Session,
) -> Result<Vec<f64>, Diagnostics> {
    let module = quality_module(library, sources, group, value)?;
    let sampler =
        FixtureSampler { compare: Some(Compare::LessEqual), linear: true, address: Address::Clamp };
    let fixtures = BTreeMap::from([
        ("map".to_owned(), Arc::new(Fixture::Texture(map.clone()))),
        ("smp".to_owned(), Arc::new(Fixture::Sampler(sampler))),
    ]);
    let fixtures = if group.edge { fixtures } else { BTreeMap::new() };
    let built = kernel::build_kernel(&module, FUNCTION, &fixtures);
    let kernel = built.map_err(|error| vec![error])?;
    let words = grid_places(group).flat_map(|(x, y)| [x, y]).map(|value| (value as f32).to_bits());
    let found = session.run(&kernel, &words.collect::<Vec<u32>>()).map_err(|error| vec![error])?;
    Ok(found.into_iter().map(|word| f64::from(f32::from_bits(word))).collect())
}

/// A depth map whose near part ends at a slanted edge through the middle.
fn edge_map() -> FixtureTexture {
    let is_near = |x: u32, y: u32| {
        let [across, down] = [x, y].map(|at| f64::from(at) - f64::from(SIZE) / 2.0);
        across + 0.4 * down < 0.0
    };
    let texels = (0..SIZE * SIZE).map(|index| {
        let [near, far] = DEPTHS;
        if is_near(index % SIZE, index / SIZE) { near } else { far }
    });
    let texels = texels.collect();
    FixtureTexture { kind: TextureKind::Depth2d, width: SIZE, height: SIZE, texels }
}

fn reference_values(
    group: &QualityGroup,
    reference: QualityReference,
    map: &FixtureTexture,
) -> Vec<f64> {
    // The shader has its coordinates in f32.
    let places = grid_places(group).map(|(x, y)| (f64::from(x as f32), f64::from(y as f32)));
    match reference {
        QualityReference::Disk => places.map(|(x, y)| disk_visibility(map, x, y)).collect(),
        QualityReference::GgxAlbedo => places.map(|(x, y)| ggx_albedo(x, y)).collect(),
    }
}

/// The mean over a disk of comparisons at depth 0.5, on Vogel's spiral.
fn disk_visibility(map: &FixtureTexture, x: f64, y: f64) -> f64 {
    let golden = TAU * 0.381_966_011_250_105;
    let tap = |index: u32| {
        let radius = RADIUS * ((f64::from(index) + 0.5) / f64::from(TAPS)).sqrt();
        let (sin, cos) = (golden * f64::from(index)).sin_cos();
        let size = f64::from(SIZE);
        filtered_comparison(map, x * size + radius * cos, y * size + radius * sin)
    };
    (0..TAPS).map(tap).sum::<f64>() / f64::from(TAPS)
}

/// A comparison at depth 0.5, filtered linearly over four texels. The place is in texels.
fn filtered_comparison(map: &FixtureTexture, x: f64, y: f64) -> f64 {
    let (left, top) = ((x - 0.5).floor(), (y - 0.5).floor());
    let (across, down) = (x - 0.5 - left, y - 0.5 - top);
    let lit = |dx: i64, dy: i64| {
        let column = Address::Clamp.wrap(left as i64 + dx, SIZE);
        let row = Address::Clamp.wrap(top as i64 + dy, SIZE);
        f64::from(u8::from(map.texel(column, row, 0, 0) >= 0.5))
    };
    let above = lit(0, 0) * (1.0 - across) + lit(1, 0) * across;
    let below = lit(0, 1) * (1.0 - across) + lit(1, 1) * across;
    above * (1.0 - down) + below * down
}

/// The albedo of a white lobe of GGX with the height-correlated visibility: a mean over half
/// vectors in proportion to their density (Walter et al., "Microfacet Models for Refraction", 2007,
/// equations 35 and 36; Heitz, "Understanding the Masking-Shadowing Function", 2014).
fn ggx_albedo(nv: f64, roughness: f64) -> f64 {
    const STEPS: u32 = 64;
    let alpha = roughness * roughness;
    let a2 = alpha * alpha;
    let view = [(1.0 - nv * nv).max(0.0).sqrt(), nv];
    let middle = |index: u32| (f64::from(index) + 0.5) / f64::from(STEPS);
    let mut sum = 0.0;
    for (row, column) in (0..STEPS).flat_map(|row| (0..STEPS).map(move |column| (row, column))) {
        let u = middle(row);
        let nh = ((1.0 - u) / (1.0 + (a2 - 1.0) * u)).sqrt();
        let across = (1.0 - nh * nh).max(0.0).sqrt() * (TAU * middle(column)).cos();
        let vh = view[0] * across + view[1] * nh;
        let nl = 2.0 * vh * nh - nv;
        if nl > 0.0 && vh > 0.0 {
            let masked = |one: f64, other: f64| one * (a2 + (1.0 - a2) * other * other).sqrt();
            let visibility = 0.5 / (masked(nl, nv) + masked(nv, nl));
            sum += 4.0 * visibility * nl * vh / nh;
        }
    }
    sum / f64::from(STEPS * STEPS)
}
