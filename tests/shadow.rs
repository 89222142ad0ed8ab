//! Properties of whole shadow lookups, from the light's matrix to the visibility. They are tested in
//! both languages, on every executor.

mod bias;
mod cube;
mod filters;
mod lights;

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

use glam::{DMat4, DVec4};
use lamplight::LIBRARY_FILES;
use lamplight::bundle::Language;
use lamplight::check::library::Library;
use lamplight::execute::fixture::{
    Address, Compare, Fixture, FixtureSampler, FixtureTexture, TextureKind,
};
use lamplight::execute::{Session, executors, on_thread};
use lamplight::source::{Memory, SourceSet};
use lamplight_testing::joined_messages;
use libtest_mimic::{Failed, Trial};

use bias::{
    bias_removes_acne, equal_depth_is_lit, normal_offset_removes_acne, receiver_plane_follows_slope,
};
use cube::cube_octants;
use filters::{
    kernel_adds_up, moments_of_two_depths, penumbra_is_monotone, random_taps_shift, texel_borders,
    warped_moments_of_two_depths,
};
use lights::{octants, outside_is_lit, spot};

/// A property of the results of functions. Each call of a function runs on one executor in one
/// language.
type Property = fn(&mut Run<'_>) -> Result<(), String>;

const PROPERTIES: &[(&str, Property)] = &[
    ("octants", octants),
    ("spot", spot),
    ("outside_is_lit", outside_is_lit),
    ("equal_depth_is_lit", equal_depth_is_lit),
    ("bias_removes_acne", bias_removes_acne),
    ("normal_offset_removes_acne", normal_offset_removes_acne),
    ("receiver_plane_follows_slope", receiver_plane_follows_slope),
    ("cube_octants", cube_octants),
    ("texel_borders", texel_borders),
    ("penumbra_is_monotone", penumbra_is_monotone),
    ("moments_of_two_depths", moments_of_two_depths),
    ("warped_moments_of_two_depths", warped_moments_of_two_depths),
    ("random_taps_shift", random_taps_shift),
    ("kernel_adds_up", kernel_adds_up),
];

/// One test for each property.
pub fn tests() -> Vec<Trial> {
    PROPERTIES
        .iter()
        .map(|(name, property)| {
            Trial::test(format!("shadow::{name}"), move || everywhere(*property))
        })
        .collect()
}

const WESL: &str = "
import lamplight::math::noise::vogel_disk;
import lamplight::shadow::bias::{constant_bias, normal_offset, receiver_plane, slope_bias};
import lamplight::shadow::compare::{
    compare_tap, cube_compare, hard, pcf_3x3, pcf_5x5, pcf_castano_3, pcf_castano_5, pcf_random16, pcf_random16_hpg, pcf_vogel,
};
import lamplight::shadow::coord::{ShadowUv, cube_depth, project, shadow_coord};
import lamplight::shadow::moments::{evsm_visibility, vsm_visibility};
import lamplight::filter::gaussian::gaussian21;
fn lit(map: texture_depth_2d, smp: sampler_comparison, m: mat4x4f, p: vec3f) -> f32 {
    return hard(map, smp, project(shadow_coord(m, p), 0.0));
}
fn clip(map: texture_depth_2d, smp: sampler_comparison, sc: vec4f, min_w: f32) -> f32 {
    return hard(map, smp, project(sc, min_w));
}
fn stored(map: texture_depth_2d, smp: sampler_comparison, uv: vec2f, depth: f32) -> f32 {
    return compare_tap(map, smp, uv, depth);
}
fn sloped(map: texture_depth_2d, smp: sampler_comparison, uv: vec2f, depth: f32, n_dot_l: f32, b: f32) -> f32 {
    return hard(map, smp, ShadowUv(uv, constant_bias(depth, slope_bias(n_dot_l, b, 1.0)), true));
}
fn raised(map: texture_depth_2d, smp: sampler_comparison, m: mat4x4f, p: vec3f, n: vec3f, l: vec3f, texel: f32, scale: f32) -> f32 {
    return hard(map, smp, project(shadow_coord(m, normal_offset(p, n, l, texel, scale)), 0.0));
}
fn planar(map: texture_depth_2d, smp: sampler_comparison, uv: vec2f, depth: f32, duv_dx: vec2f, duv_dy: vec2f, dz: vec2f, share: f32) -> f32 {
    let slope = share * receiver_plane(duv_dx, duv_dy, dz);
    var sum = 0.0;
    for (var i = 0; i < 16; i++) {
        let offset = 0.2 * vogel_disk(i, 16, 0.0);
        sum += compare_tap(map, smp, uv + offset, depth + dot(slope, offset));
    }
    return sum / 16.0;
}
fn cube(map: texture_depth_cube, smp: sampler_comparison, offset: vec3f, near: f32, far: f32, reversed: f32) -> f32 {
    let depth = cube_depth(offset, near, far);
    return cube_compare(map, smp, offset, mix(depth, 1.0 - depth, reversed));
}
fn filters(map: texture_depth_2d, smp: sampler_comparison, uv: vec2f, depth: f32) -> array<f32, 6> {
    let at = ShadowUv(uv, depth, true);
    return array<f32, 6>(hard(map, smp, at), pcf_3x3(map, smp, at), pcf_5x5(map, smp, at), pcf_castano_3(map, smp, at), pcf_castano_5(map, smp, at), pcf_vogel(map, smp, at, 16, 2.0, 0.0));
}
fn random(map: texture_depth_2d, smp: sampler_comparison, sc: vec4f, pixel: vec2f) -> vec2f {
    return vec2f(pcf_random16(map, smp, project(sc, 0.0), 2.0, pixel), pcf_random16_hpg(map, smp, sc, 0.0, pixel));
}
fn moments(map: texture_2d<f32>, smp: sampler, uv: vec2f, t: f32) -> f32 {
    return vsm_visibility(textureSampleLevel(map, smp, uv, 0.0).xy, t, 0.000001, 0.0, 0.0);
}
fn warped(map: texture_2d<f32>, smp: sampler, uv: vec2f, t: f32) -> f32 {
    return evsm_visibility(textureSampleLevel(map, smp, uv, 0.0), t, vec2f(5.0, 5.0), 0.000001, 0.0);
}
fn clip_moments(map: texture_2d<f32>, smp: sampler, sc: vec4f, min_w: f32) -> f32 {
    let at = project(sc, min_w);
    return select(1.0, moments(map, smp, at.uv, at.depth), at.inside);
}
fn weight(i: i32) -> f32 {
    return gaussian21(i);
}
";

const GLSL: &str = "
#include <lamplight/shadow/bias.glsl>
#include <lamplight/shadow/compare.glsl>
#include <lamplight/shadow/moments.glsl>
#include <lamplight/filter/gaussian.glsl>
float lit(LAMPLIGHT_DEPTH_MAP(map, smp), mat4 m, vec3 p) {
    return hard(LAMPLIGHT_DEPTH_ARG(map, smp), project(shadow_coord(m, p), 0.0));
}
float clip(LAMPLIGHT_DEPTH_MAP(map, smp), vec4 sc, float min_w) {
    return hard(LAMPLIGHT_DEPTH_ARG(map, smp), project(sc, min_w));
}
float stored(LAMPLIGHT_DEPTH_MAP(map, smp), vec2 uv, float depth) {
    return compare_tap(LAMPLIGHT_DEPTH_ARG(map, smp), uv, depth);
}
float sloped(LAMPLIGHT_DEPTH_MAP(map, smp), vec2 uv, float depth, float n_dot_l, float b) {
    return hard(LAMPLIGHT_DEPTH_ARG(map, smp), ShadowUv(uv, constant_bias(depth, slope_bias(n_dot_l, b, 1.0)), true));
}
float raised(LAMPLIGHT_DEPTH_MAP(map, smp), mat4 m, vec3 p, vec3 n, vec3 l, float texel, float scale) {
    return hard(LAMPLIGHT_DEPTH_ARG(map, smp), project(shadow_coord(m, normal_offset(p, n, l, texel, scale)), 0.0));
}
float planar(LAMPLIGHT_DEPTH_MAP(map, smp), vec2 uv, float depth, vec2 duv_dx, vec2 duv_dy, vec2 dz, float share) {
    vec2 slope = share * receiver_plane(duv_dx, duv_dy, dz);
    float sum = 0.0;
    for (int i = 0; i < 16; i++) {
        vec2 offset = 0.2 * vogel_disk(i, 16, 0.0);
        sum += compare_tap(LAMPLIGHT_DEPTH_ARG(map, smp), uv + offset, depth + dot(slope, offset));
    }
    return sum / 16.0;
}
float cube(LAMPLIGHT_DEPTH_CUBE(map, smp), vec3 offset, float near, float far, float reversed) {
    float depth = cube_depth(offset, near, far);
    return cube_compare(LAMPLIGHT_DEPTH_ARG(map, smp), offset, mix(depth, 1.0 - depth, reversed));
}
float[6] filters(LAMPLIGHT_DEPTH_MAP(map, smp), vec2 uv, float depth) {
    ShadowUv at = ShadowUv(uv, depth, true);
    return float[6](hard(LAMPLIGHT_DEPTH_ARG(map, smp), at), pcf_3x3(LAMPLIGHT_DEPTH_ARG(map, smp), at), pcf_5x5(LAMPLIGHT_DEPTH_ARG(map, smp), at), pcf_castano_3(LAMPLIGHT_DEPTH_ARG(map, smp), at), pcf_castano_5(LAMPLIGHT_DEPTH_ARG(map, smp), at), pcf_vogel(LAMPLIGHT_DEPTH_ARG(map, smp), at, 16, 2.0, 0.0));
}
vec2 random(LAMPLIGHT_DEPTH_MAP(map, smp), vec4 sc, vec2 pixel) {
    return vec2(pcf_random16(LAMPLIGHT_DEPTH_ARG(map, smp), project(sc, 0.0), 2.0, pixel), pcf_random16_hpg(LAMPLIGHT_DEPTH_ARG(map, smp), sc, 0.0, pixel));
}
float moments(LAMPLIGHT_COLOR_MAP(map, smp), vec2 uv, float t) {
    return vsm_visibility(textureLod(LAMPLIGHT_COLOR_SAMPLER(map, smp), uv, 0.0).xy, t, 0.000001, 0.0, 0.0);
}
float warped(LAMPLIGHT_COLOR_MAP(map, smp), vec2 uv, float t) {
    return evsm_visibility(textureLod(LAMPLIGHT_COLOR_SAMPLER(map, smp), uv, 0.0), t, vec2(5.0, 5.0), 0.000001, 0.0);
}
float clip_moments(LAMPLIGHT_COLOR_MAP(map, smp), vec4 sc, float min_w) {
    ShadowUv at = project(sc, min_w);
    return at.inside ? moments(LAMPLIGHT_COLOR_ARG(map, smp), at.uv, at.depth) : 1.0;
}
float weight(int i) {
    return gaussian21(i);
}
";

/// One executor and one language.
struct Run<'a> {
    session: &'a mut dyn Session,
    library: &'a Library,
    language: Language,
}

/// Tests a property in both languages on every executor. The error names all that fail.
fn everywhere(property: Property) -> Result<(), Failed> {
    let outcome = on_thread(|| {
        let files = [("scene.wesl", WESL), ("scene.glsl", GLSL)]
            .map(|(path, text)| (path.to_owned(), text.to_owned()));
        let library = Library::new(
            "scene",
            Arc::new(Memory(files.into())),
            vec![("lamplight".to_owned(), Arc::new(LIBRARY_FILES))],
        );
        let mut failed = String::new();
        for entry in executors::ALL {
            let mut session = entry.start()?;
            let languages = [Language::Wesl, Language::Glsl];
            let runs = |language: &Language| *language == Language::Glsl || !entry.reads_glsl;
            for language in languages.into_iter().filter(runs) {
                let mut run = Run { session: session.as_mut(), library: &library, language };
                if let Err(error) = property(&mut run) {
                    failed += &format!("{language:?} on {}: {error}\n", entry.name);
                }
            }
        }
        if failed.is_empty() { Ok(()) } else { Err(failed) }
    });
    outcome.ok_or("panicked")?.map_err(Failed::from)
}

impl Run<'_> {
    /// Runs a function of the text above on rows of f32 arguments.
    fn call(
        &mut self,
        function: &str,
        map: Option<(FixtureTexture, FixtureSampler)>,
        rows: &[Vec<f32>],
    ) -> Result<Vec<f64>, String> {
        let words: Vec<u32> = rows.iter().flatten().map(|value| value.to_bits()).collect();
        self.call_words(function, map, &words)
    }

    fn call_words(
        &mut self,
        function: &str,
        map: Option<(FixtureTexture, FixtureSampler)>,
        words: &[u32],
    ) -> Result<Vec<f64>, String> {
        let sources = Mutex::new(SourceSet::default());
        let module = self
            .library
            .checked_module(&sources, "scene", self.language, &[function.to_owned()])
            .map_err(|errors| joined_messages(&errors))?;
        let fixtures: BTreeMap<_, _> = map
            .into_iter()
            .flat_map(|(map, smp)| [("map", Fixture::Texture(map)), ("smp", Fixture::Sampler(smp))])
            .map(|(name, fixture)| (name.to_owned(), Arc::new(fixture)))
            .collect();
        let kernel =
            module.kernel(function, &fixtures).map_err(|error| joined_messages(&[error]))?;
        let results =
            self.session.run(&kernel, words).map_err(|error| joined_messages(&[error]))?;
        Ok(results.into_iter().map(|word| f64::from(f32::from_bits(word))).collect())
    }
}

/// A square depth map. The depth of a texel is a function of its centre.
fn depths(side: u32, depth: impl Fn(f64, f64) -> f64) -> FixtureTexture {
    let centre = |index: u32| (f64::from(index) + 0.5) / f64::from(side);
    let texels = (0..side)
        .flat_map(|y| (0..side).map(move |x| (x, y)))
        .map(|(x, y)| depth(centre(x), centre(y)) as f32)
        .collect();
    FixtureTexture { kind: TextureKind::Depth2d, width: side, height: side, texels }
}

fn comparing(compare: Compare, linear: bool) -> FixtureSampler {
    FixtureSampler { compare: Some(compare), linear, address: Address::Clamp }
}

fn plain(linear: bool) -> FixtureSampler {
    FixtureSampler { compare: None, linear, address: Address::Clamp }
}

/// The matrix that turns depths that rise with the distance into depths that fall.
fn flip() -> DMat4 {
    DMat4::from_cols(DVec4::X, DVec4::Y, -DVec4::Z, DVec4::new(0.0, 0.0, 1.0, 1.0))
}

/// For a map with reversed or plain depth: the stored form of a depth, and the comparison.
fn reversal(reversed: bool) -> (fn(f64) -> f64, Compare) {
    if reversed {
        (|depth| 1.0 - depth, Compare::GreaterEqual)
    } else {
        (|depth| depth, Compare::LessEqual)
    }
}
