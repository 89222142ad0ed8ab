//! Shadows from the light's matrix to the visibility: properties of whole lookups, in both
//! languages, on every executor.

use std::collections::BTreeMap;
use std::sync::{Arc, Mutex};

use glam::{DMat4, DVec3, DVec4};
use lamplight::bundle::Language;
use lamplight::diagnostic::Diagnostic;
use lamplight::execute::fixture::{Address, Compare, Fixture, Sampler, Texture, TextureKind};
use lamplight::execute::{Session, executors, kernel, on_thread};
use lamplight::proof::library::Library;
use lamplight::source::{Embedded, Memory, SourceSet};
use libtest_mimic::{Failed, Trial};

/// What a property asks of results: each call runs one function on one executor in one language.
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

/// One trial for each property.
pub fn trials() -> Vec<Trial> {
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
float lit(texture2D map, samplerShadow smp, mat4 m, vec3 p) {
    return hard(map, smp, project(shadow_coord(m, p), 0.0));
}
float clip(texture2D map, samplerShadow smp, vec4 sc, float min_w) {
    return hard(map, smp, project(sc, min_w));
}
float stored(texture2D map, samplerShadow smp, vec2 uv, float depth) {
    return compare_tap(map, smp, uv, depth);
}
float sloped(texture2D map, samplerShadow smp, vec2 uv, float depth, float n_dot_l, float b) {
    return hard(map, smp, ShadowUv(uv, constant_bias(depth, slope_bias(n_dot_l, b, 1.0)), true));
}
float raised(texture2D map, samplerShadow smp, mat4 m, vec3 p, vec3 n, vec3 l, float texel, float scale) {
    return hard(map, smp, project(shadow_coord(m, normal_offset(p, n, l, texel, scale)), 0.0));
}
float planar(texture2D map, samplerShadow smp, vec2 uv, float depth, vec2 duv_dx, vec2 duv_dy, vec2 dz, float share) {
    vec2 slope = share * receiver_plane(duv_dx, duv_dy, dz);
    float sum = 0.0;
    for (int i = 0; i < 16; i++) {
        vec2 offset = 0.2 * vogel_disk(i, 16, 0.0);
        sum += compare_tap(map, smp, uv + offset, depth + dot(slope, offset));
    }
    return sum / 16.0;
}
float cube(textureCube map, samplerShadow smp, vec3 offset, float near, float far, float reversed) {
    float depth = cube_depth(offset, near, far);
    return cube_compare(map, smp, offset, mix(depth, 1.0 - depth, reversed));
}
float[6] filters(texture2D map, samplerShadow smp, vec2 uv, float depth) {
    ShadowUv at = ShadowUv(uv, depth, true);
    return float[6](hard(map, smp, at), pcf_3x3(map, smp, at), pcf_5x5(map, smp, at), pcf_castano_3(map, smp, at), pcf_castano_5(map, smp, at), pcf_vogel(map, smp, at, 16, 2.0, 0.0));
}
vec2 random(texture2D map, samplerShadow smp, vec4 sc, vec2 pixel) {
    return vec2(pcf_random16(map, smp, project(sc, 0.0), 2.0, pixel), pcf_random16_hpg(map, smp, sc, 0.0, pixel));
}
float moments(texture2D map, sampler smp, vec2 uv, float t) {
    return vsm_visibility(textureLod(sampler2D(map, smp), uv, 0.0).xy, t, 0.000001, 0.0, 0.0);
}
float warped(texture2D map, sampler smp, vec2 uv, float t) {
    return evsm_visibility(textureLod(sampler2D(map, smp), uv, 0.0), t, vec2(5.0, 5.0), 0.000001, 0.0);
}
float clip_moments(texture2D map, sampler smp, vec4 sc, float min_w) {
    ShadowUv at = project(sc, min_w);
    return at.inside ? moments(map, smp, at.uv, at.depth) : 1.0;
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

/// The property in both languages on every executor; all that fail are named.
fn everywhere(property: Property) -> Result<(), Failed> {
    let outcome = on_thread(|| {
        let files = [("scene.wesl", WESL), ("scene.glsl", GLSL)]
            .map(|(path, text)| (path.to_owned(), text.to_owned()));
        let library = Library::new(
            "scene",
            Arc::new(Memory(files.into())),
            vec![("lamplight".to_owned(), Arc::new(Embedded))],
        );
        let mut failed = String::new();
        for entry in executors::ALL {
            let mut session = entry.start()?;
            for language in [Language::Wesl, Language::Glsl] {
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
    /// Results of a function of the scene for rows of f32 arguments.
    fn call(
        &mut self,
        function: &str,
        map: Option<(Texture, Sampler)>,
        rows: &[Vec<f32>],
    ) -> Result<Vec<f64>, String> {
        let words: Vec<u32> = rows.iter().flatten().map(|value| value.to_bits()).collect();
        self.call_words(function, map, &words)
    }

    fn call_words(
        &mut self,
        function: &str,
        map: Option<(Texture, Sampler)>,
        words: &[u32],
    ) -> Result<Vec<f64>, String> {
        let sources = Mutex::new(SourceSet::default());
        let module = self
            .library
            .module(&sources, "scene", self.language, &[function.to_owned()])
            .map_err(|errors| said(&errors))?;
        let fixtures: BTreeMap<_, _> = map
            .into_iter()
            .flat_map(|(map, smp)| [("map", Fixture::Texture(map)), ("smp", Fixture::Sampler(smp))])
            .map(|(name, fixture)| (name.to_owned(), Arc::new(fixture)))
            .collect();
        let kernel = kernel::build(&module, function, &fixtures).map_err(|error| said(&[error]))?;
        let results = self.session.run(&kernel, words).map_err(|error| said(&[error]))?;
        Ok(results.into_iter().map(|word| f64::from(f32::from_bits(word))).collect())
    }
}

fn said(errors: &[Diagnostic]) -> String {
    errors.iter().map(|error| error.message.clone()).collect::<Vec<_>>().join("; ")
}

/// Texels of a square depth map from the place of their centres.
fn depths(side: u32, depth: impl Fn(f64, f64) -> f64) -> Texture {
    let centre = |index: u32| (f64::from(index) + 0.5) / f64::from(side);
    let texels = (0..side)
        .flat_map(|y| (0..side).map(move |x| (x, y)))
        .map(|(x, y)| depth(centre(x), centre(y)) as f32)
        .collect();
    Texture { kind: TextureKind::Depth2d, width: side, height: side, texels }
}

fn comparing(compare: Compare, linear: bool) -> Sampler {
    Sampler { compare: Some(compare), linear, address: Address::Clamp }
}

fn plain(linear: bool) -> Sampler {
    Sampler { compare: None, linear, address: Address::Clamp }
}

/// From depths that rise with the distance to depths that fall.
fn flip() -> DMat4 {
    DMat4::from_cols(DVec4::X, DVec4::Y, -DVec4::Z, DVec4::new(0.0, 0.0, 1.0, 1.0))
}

/// A depth as a map of either kind holds it, and the comparison that goes with it.
fn reversal(reversed: bool) -> (fn(f64) -> f64, Compare) {
    if reversed {
        (|depth| 1.0 - depth, Compare::GreaterEqual)
    } else {
        (|depth| depth, Compare::LessEqual)
    }
}

/// The upper left quarter of the map, seen from the light, is covered by a plane across the light's
/// direction; points before it and behind it, over all quarters, for both directions of depth.
fn covered(
    run: &mut Run<'_>,
    view: DMat4,
    projection: DMat4,
    planes: [f64; 3],
) -> Result<(), String> {
    let depth_at = |z: f64| {
        let clip = projection * DVec4::new(0.0, 0.0, -z, 1.0);
        clip.z / clip.w
    };
    for reversed in [false, true] {
        let matrix = if reversed { flip() * projection * view } else { projection * view };
        let (stored, cleared) =
            if reversed { (1.0 - depth_at(planes[1]), 0.0) } else { (depth_at(planes[1]), 1.0) };
        let map = depths(16, |u, v| if u < 0.5 && v < 0.5 { stored } else { cleared });
        let sampler =
            comparing(if reversed { Compare::GreaterEqual } else { Compare::LessEqual }, true);
        let (mut rows, mut expected) = (Vec::new(), Vec::new());
        for (x, y, z) in places(planes) {
            // From a place on the map and a distance to the world: the inverse of what the shader does.
            let depth = DVec4::new(0.0, 0.0, -z, 1.0);
            let w = (projection * depth).w;
            let ndc = DVec4::new(x * w, y * w, depth_at(z) * w, w);
            let point = (projection * view).inverse() * ndc;
            let point = point.truncate() / point.w;
            rows.push(
                matrix
                    .to_cols_array()
                    .into_iter()
                    .chain(point.to_array())
                    .map(|value| value as f32)
                    .collect(),
            );
            expected.push(f64::from(u8::from(!(x < 0.0 && y > 0.0 && z > planes[1]))));
        }
        let found = run.call("lit", Some((map, sampler)), &rows)?;
        if found != expected {
            return Err(format!("reversed {reversed}: {found:?}, not {expected:?}"));
        }
    }
    Ok(())
}

/// The middles of the quarters, before and behind the occluder.
fn places(planes: [f64; 3]) -> impl Iterator<Item = (f64, f64, f64)> {
    let sides = [-0.5, 0.5];
    let corners = sides.into_iter().flat_map(move |x| sides.into_iter().map(move |y| (x, y)));
    corners.flat_map(move |(x, y)| [planes[0], planes[2]].into_iter().map(move |z| (x, y, z)))
}

/// The view of an eye that looks along -z.
fn look_at(eye: DVec3, target: DVec3, up: DVec3) -> DMat4 {
    let back = (eye - target).normalize();
    let right = up.cross(back).normalize();
    let world = DMat4::from_cols(
        right.extend(0.0),
        back.cross(right).extend(0.0),
        back.extend(0.0),
        eye.extend(1.0),
    );
    world.inverse()
}

/// A box from -half to half, depths from 0 to 1 between the planes.
fn orthographic(half: f64, near: f64, far: f64) -> DMat4 {
    let depth = 1.0 / (near - far);
    DMat4::from_cols(
        DVec4::X / half,
        DVec4::Y / half,
        DVec4::Z * depth,
        DVec4::new(0.0, 0.0, near * depth, 1.0),
    )
}

/// A square cone of the angle, depths from 0 to 1 between the planes.
fn perspective(angle: f64, near: f64, far: f64) -> DMat4 {
    let (scale, depth) = (1.0 / (angle / 2.0).tan(), far / (near - far));
    DMat4::from_cols(
        DVec4::X * scale,
        DVec4::Y * scale,
        DVec4::new(0.0, 0.0, depth, -1.0),
        DVec4::Z * near * depth,
    )
}

/// Directional light from every octant and along the axes.
fn octants(run: &mut Run<'_>) -> Result<(), String> {
    let signs = [-1.0, 1.0];
    let octants = signs.into_iter().flat_map(|x| {
        signs.into_iter().flat_map(move |y| signs.into_iter().map(move |z| DVec3::new(x, y, z)))
    });
    for octant in
        octants.chain([DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z])
    {
        let direction = (octant * DVec3::new(0.6, 0.7, 0.4)).normalize();
        let up = if direction.y.abs() > 0.9 { DVec3::Z } else { DVec3::Y };
        let view = look_at(direction * 10.0, DVec3::ZERO, up);
        let projection = orthographic(4.0, 0.1, 20.0);
        covered(run, view, projection, [6.0, 8.0, 12.0])
            .map_err(|error| format!("light from {direction}: {error}"))?;
    }
    Ok(())
}

fn spot(run: &mut Run<'_>) -> Result<(), String> {
    let view = look_at(DVec3::new(3.0, 5.0, -2.0), DVec3::new(0.5, 0.0, 0.25), DVec3::Y);
    covered(run, view, perspective(1.2, 0.5, 30.0), [2.0, 4.0, 9.0])
}

/// Over a map that covers everything: dark inside the frustum, lit on every side of it and behind
/// the light.
fn outside_is_lit(run: &mut Run<'_>) -> Result<(), String> {
    const CLIPS: &[([f32; 4], f32, f64)] = &[
        ([0.0, 0.0, 0.5, 1.0], 0.0, 0.0),
        ([0.9, -0.9, 1.0, 2.0], 0.0, 0.0),
        ([0.99, 0.99, 0.99, 1.0], 0.0, 0.0),
        ([1.01, 0.0, 0.5, 1.0], 0.0, 1.0),
        ([-1.01, 0.0, 0.5, 1.0], 0.0, 1.0),
        ([0.0, 1.01, 0.5, 1.0], 0.0, 1.0),
        ([0.0, -1.01, 0.5, 1.0], 0.0, 1.0),
        ([0.0, 0.0, 1.01, 1.0], 0.0, 1.0),
        ([0.0, 0.0, -0.01, 1.0], 0.0, 1.0),
        ([0.0, 0.0, -0.5, -1.0], 0.0, 1.0),
        ([0.0, 0.0, 0.0, 0.0], 0.0, 1.0),
        ([0.0, 0.0, 0.5, -0.0], 0.0, 1.0),
        ([0.0, 0.0, 0.5, 1.0], 1.0, 1.0),
        ([0.0, 0.0, 0.5, 1.0], 0.99, 0.0),
        ([f32::MAX, 0.0, 0.5, 1.0], 0.0, 1.0),
        ([0.0, 0.0, 0.5, 1e-39], 0.0, 1.0),
    ];
    let rows: Vec<_> =
        CLIPS.iter().map(|(clip, min_w, _)| [clip.as_slice(), &[*min_w]].concat()).collect();
    let found = run.call(
        "clip",
        Some((depths(4, |_, _| 0.0), comparing(Compare::LessEqual, true))),
        &rows,
    )?;
    let expected: Vec<_> = CLIPS.iter().map(|(_, _, lit)| *lit).collect();
    if found != expected {
        return Err(format!("{found:?}, not {expected:?}"));
    }
    // A map of moments, as `forward` reads it: the least variance leaves a millionth of the light.
    let map = Texture {
        kind: TextureKind::Color2d,
        width: 4,
        height: 4,
        texels: [0.0, 0.0, 0.0, 1.0].repeat(16),
    };
    let found = run.call("clip_moments", Some((map, plain(true))), &rows)?;
    let near = |(found, expected): (&f64, &f64)| (found - expected).abs() < 1e-4;
    if found.iter().zip(&expected).all(near) {
        Ok(())
    } else {
        Err(format!("moments: {found:?}, not {expected:?}"))
    }
}

/// The depth that is stored is lit; its neighbours in f32 fall on their sides.
fn equal_depth_is_lit(run: &mut Run<'_>) -> Result<(), String> {
    let map = depths(8, |u, v| (u * 7.31 + v * 3.77).fract() * 0.9 + 0.05);
    for (compare, nearer, farther) in
        [(Compare::LessEqual, 1.0, 0.0), (Compare::GreaterEqual, 0.0, 1.0)]
    {
        let (mut rows, mut expected) = (Vec::new(), Vec::new());
        for (index, stored) in map.texels.iter().enumerate() {
            let (u, v) = ((index % 8) as f32 / 8.0 + 0.0625, (index / 8) as f32 / 8.0 + 0.0625);
            for (depth, lit) in
                [(*stored, 1.0), (stored.next_down(), nearer), (stored.next_up(), farther)]
            {
                rows.push(vec![u, v, depth]);
                expected.push(lit);
            }
        }
        let found = run.call("stored", Some((map.clone(), comparing(compare, false))), &rows)?;
        if let Some(wrong) = (0..rows.len()).find(|index| found[*index] != expected[*index]) {
            return Err(format!(
                "{compare:?} {:?}: {}, not {}",
                rows[wrong], found[wrong], expected[wrong]
            ));
        }
    }
    Ok(())
}

/// A sloped receiver shadows itself without a bias, and not with half a texel's bias along its
/// slope; what is well behind it stays dark.
fn bias_removes_acne(run: &mut Run<'_>) -> Result<(), String> {
    for slope in [0.1, 0.4, 0.6] {
        let receiver = |u: f64| 0.3 + slope * u;
        let map = depths(16, |u, _| receiver(u));
        let cosine = (1.0 / (1.0 + slope * slope)).sqrt() as f32;
        let places: Vec<f64> = (0..128).map(|i| (f64::from(i) + 0.5) / 128.0).collect();
        let mut dark = |beyond: f64, texels: f32| -> Result<usize, String> {
            let rows: Vec<_> = places
                .iter()
                .map(|u| {
                    vec![*u as f32, 0.5, (receiver(*u) + beyond) as f32, cosine, texels / 16.0]
                })
                .collect();
            let found = run.call(
                "sloped",
                Some((map.clone(), comparing(Compare::LessEqual, false))),
                &rows,
            )?;
            Ok(found.iter().filter(|lit| **lit == 0.0).count())
        };
        let counts = [dark(0.0, 0.0)?, dark(0.0, 0.501)?, dark(0.08, 0.501)?];
        if counts != [64, 0, 128] {
            return Err(format!("slope {slope}: {counts:?} of 128 are dark, not 64, 0 and 128"));
        }
    }
    Ok(())
}

/// A floor under slanting light shadows itself; moved along its normal by three quarters of a
/// texel it does not, and what is under something else stays dark.
fn normal_offset_removes_acne(run: &mut Run<'_>) -> Result<(), String> {
    const SIDE: u32 = 16;
    let direction = DVec3::new(0.7, 0.6, 0.3).normalize();
    let plain_matrix =
        orthographic(4.0, 0.1, 20.0) * look_at(direction * 10.0, DVec3::ZERO, DVec3::Y);
    let from_map = plain_matrix.inverse();
    // Along a ray of parallel light the height falls evenly with the depth.
    let floor = |u: f64, v: f64| {
        let height =
            |depth: f64| (from_map * DVec4::new(2.0 * u - 1.0, 1.0 - 2.0 * v, depth, 1.0)).y;
        height(0.0) / (height(0.0) - height(1.0))
    };
    let texel = 8.0 / f64::from(SIDE);
    for reversed in [false, true] {
        let (held, compare) = reversal(reversed);
        let matrix = if reversed { flip() * plain_matrix } else { plain_matrix };
        let mut dark = |nearer: f64, scale: f64| -> Result<usize, String> {
            let map = depths(SIDE, |u, v| held(floor(u, v) - nearer));
            let places = (0..144).map(|i| {
                DVec3::new(f64::from(i % 12) / 3.0 - 1.9, 0.0, f64::from(i / 12) / 3.0 - 1.8)
            });
            let row = |p: DVec3| {
                let vectors =
                    [p, DVec3::Y, direction].into_iter().flat_map(|vector| vector.to_array());
                matrix
                    .to_cols_array()
                    .into_iter()
                    .chain(vectors)
                    .chain([texel, scale])
                    .map(|value| value as f32)
                    .collect()
            };
            let rows: Vec<Vec<f32>> = places.map(row).collect();
            let found = run.call("raised", Some((map, comparing(compare, false))), &rows)?;
            Ok(found.iter().filter(|lit| **lit == 0.0).count())
        };
        let counts = [dark(0.0, 0.0)?, dark(0.0, 0.75)?, dark(0.05, 0.75)?];
        if !(36..108).contains(&counts[0]) || counts[1..] != [0, 144] {
            return Err(format!(
                "reversed {reversed}: {counts:?} of 144 are dark, not about half, 0 and 144"
            ));
        }
    }
    Ok(())
}

/// A wide filter over a slope: with one depth for all taps some are dark, with depths that follow
/// the slope none; what is well behind stays dark.
fn receiver_plane_follows_slope(run: &mut Run<'_>) -> Result<(), String> {
    const SLOPE: [f64; 2] = [0.2, -0.15];
    let receiver = |u: f64, v: f64| 0.4 + SLOPE[0] * u + SLOPE[1] * v;
    // The taps read whole texels: half of one along each axis is left.
    let bias = 0.51 / 32.0 * (SLOPE[0].abs() + SLOPE[1].abs());
    for reversed in [false, true] {
        let (held, compare) = reversal(reversed);
        let sign = if reversed { -1.0 } else { 1.0 };
        let map = depths(32, |u, v| held(receiver(u, v)));
        let mut lit = |beyond: f64, share: f64| -> Result<[f64; 2], String> {
            let places =
                (0..64).map(|i| (0.3 + 0.05 * f64::from(i % 8), 0.3 + 0.05 * f64::from(i / 8)));
            let row = |(u, v): (f64, f64)| {
                let (duv_dx, duv_dy) = ([0.01, 0.002], [-0.003, 0.008]);
                let rise = |duv: [f64; 2]| sign * (SLOPE[0] * duv[0] + SLOPE[1] * duv[1]);
                let depth = held(receiver(u, v) + beyond - bias);
                [u, v, depth]
                    .into_iter()
                    .chain(duv_dx)
                    .chain(duv_dy)
                    .chain([rise(duv_dx), rise(duv_dy), share])
                    .map(|value| value as f32)
                    .collect()
            };
            let rows: Vec<Vec<f32>> = places.map(row).collect();
            let found =
                run.call("planar", Some((map.clone(), comparing(compare, false))), &rows)?;
            Ok([
                found.iter().copied().fold(1.0, f64::min),
                found.iter().copied().fold(0.0, f64::max),
            ])
        };
        let (followed, level, behind) = (lit(0.0, 1.0)?, lit(0.0, 0.0)?, lit(0.1, 1.0)?);
        if followed != [1.0, 1.0] || level[1] > 0.9 || behind != [0.0, 0.0] {
            return Err(format!(
                "reversed {reversed}: least and most {followed:?}, {level:?}, {behind:?}"
            ));
        }
    }
    Ok(())
}

/// A point light with something before one octant: what is behind it is dark, all else is lit.
fn cube_octants(run: &mut Run<'_>) -> Result<(), String> {
    const SIDE: u32 = 8;
    let (near, far) = (0.1, 20.0);
    let depth = |distance: f64| far / (far - near) * (1.0 - near / distance);
    let octant = |index: u32| {
        DVec3::from_array([0, 1, 2].map(|axis| if index & (1 << axis) == 0 { 1.0 } else { -1.0 }))
    };
    let within = |p: DVec3, index: u32| (p * octant(index)).min_element() > 0.0;
    for reversed in [false, true] {
        let (held, compare) = reversal(reversed);
        for covered in 0..8 {
            let texel = |face: u32, x: u32, y: u32| {
                let place = |index: u32| (f64::from(index) + 0.5) / f64::from(SIDE) * 2.0 - 1.0;
                let towards = face_direction(face, place(x), place(y));
                held(if within(towards, covered) { depth(2.0) } else { 1.0 }) as f32
            };
            let texels = (0..6)
                .flat_map(|face| (0..SIDE * SIDE).map(move |i| texel(face, i % SIDE, i / SIDE)))
                .collect();
            let map = Texture { kind: TextureKind::DepthCube, width: SIDE, height: SIDE, texels };
            let (mut rows, mut expected) = (Vec::new(), Vec::new());
            for (index, distance) in
                (0..8).flat_map(|index| [(index, 1.0), (index, 1.99), (index, 2.01), (index, 4.0)])
            {
                for shape in [
                    DVec3::new(1.0, 0.6, 0.5),
                    DVec3::new(0.5, 1.0, 0.6),
                    DVec3::new(0.6, 0.5, 1.0),
                ] {
                    let offset = octant(index) * shape * distance;
                    rows.push(
                        offset
                            .to_array()
                            .into_iter()
                            .chain([near, far, f64::from(u8::from(reversed))])
                            .map(|value| value as f32)
                            .collect(),
                    );
                    expected.push(f64::from(u8::from(!(index == covered && distance > 2.0))));
                }
            }
            let found = run.call("cube", Some((map, comparing(compare, true))), &rows)?;
            if found != expected {
                return Err(format!(
                    "reversed {reversed}, octant {covered}: {found:?}, not {expected:?}"
                ));
            }
        }
    }
    Ok(())
}

/// Where a place on a face of a cube map looks, both from -1 to 1, to the right and down.
fn face_direction(face: u32, x: f64, y: f64) -> DVec3 {
    match face {
        0 => DVec3::new(1.0, -y, -x),
        1 => DVec3::new(-1.0, -y, x),
        2 => DVec3::new(x, 1.0, y),
        3 => DVec3::new(x, -1.0, -y),
        4 => DVec3::new(x, -y, 1.0),
        _ => DVec3::new(-x, -y, -1.0),
    }
}

/// Dark and lit on texel centres, half lit on the border between them, in both directions.
fn texel_borders(run: &mut Run<'_>) -> Result<(), String> {
    let across = depths(8, |u, _| if u < 0.5 { 0.25 } else { 0.75 });
    let down = depths(8, |_, v| if v < 0.5 { 0.25 } else { 0.75 });
    let steps = [(0.4375f32, 0.0), (0.46875, 0.25), (0.5, 0.5), (0.53125, 0.75), (0.5625, 1.0)];
    for (map, is_down) in [(across, false), (down, true)] {
        let place = |at: f32| if is_down { vec![0.3, at, 0.5] } else { vec![at, 0.3, 0.5] };
        let rows: Vec<_> = steps.iter().map(|(at, _)| place(*at)).collect();
        let found = run.call("stored", Some((map, comparing(Compare::LessEqual, true))), &rows)?;
        if found.iter().zip(steps).any(|(found, (_, expected))| (found - expected).abs() > 1e-6) {
            return Err(format!("down {is_down}: {found:?}"));
        }
    }
    Ok(())
}

/// From the dark to the lit side of an edge every filter only rises, from 0 to 1.
fn penumbra_is_monotone(run: &mut Run<'_>) -> Result<(), String> {
    let map = depths(32, |u, _| if u < 0.5 { 0.25 } else { 0.75 });
    let rows: Vec<_> = (0..=256).map(|i| vec![0.25 + 0.5 * i as f32 / 256.0, 0.47, 0.5]).collect();
    let found = run.call("filters", Some((map, comparing(Compare::LessEqual, true))), &rows)?;
    for filter in 0..6 {
        let values: Vec<f64> = found.iter().skip(filter).step_by(6).copied().collect();
        let falls = values.windows(2).any(|pair| pair[1] < pair[0] - 1e-5);
        let (first, last) = (values[0], values[256]);
        if falls || first.abs() > 1e-5 || (last - 1.0).abs() > 1e-5 {
            return Err(format!("filter {filter}: {values:?}"));
        }
    }
    Ok(())
}

fn moments_of_two_depths(run: &mut Run<'_>) -> Result<(), String> {
    two_depths(run, "moments", 1e-4, |depth| [depth, depth * depth, 0.0, 1.0])
}

fn warped_moments_of_two_depths(run: &mut Run<'_>) -> Result<(), String> {
    two_depths(run, "warped", 1e-3, |depth| {
        let z = 5.0 * (2.0 * depth - 1.0);
        [z.exp(), (2.0 * z).exp(), -(-z).exp(), (-2.0 * z).exp()]
    })
}

/// A filtered edge between an occluder and the receiver behind it: Chebyshev's bound is the lit
/// share itself there, so the penumbra is a straight line; and it is an upper bound everywhere.
fn two_depths(
    run: &mut Run<'_>,
    function: &str,
    error: f64,
    moments: impl Fn(f64) -> [f64; 4],
) -> Result<(), String> {
    const SIDE: u32 = 32;
    let (near, far) = (0.25, 0.75);
    let share = |x: u32| (f64::from(x) / f64::from(SIDE - 1)).clamp(0.0, 1.0);
    let (before, behind) = (moments(near), moments(far));
    let texel = |x: u32| {
        (0..4).map(move |channel| {
            (before[channel] * (1.0 - share(x)) + behind[channel] * share(x)) as f32
        })
    };
    let texels = (0..SIDE).flat_map(texel).collect();
    let map = Texture { kind: TextureKind::Color2d, width: SIDE, height: 1, texels };
    let depths = [0.2f32, 0.25, 0.3, 0.5, 0.75];
    let rows: Vec<_> = depths
        .iter()
        .flat_map(|t| (0..SIDE).map(move |x| vec![(x as f32 + 0.5) / SIDE as f32, 0.5, *t]))
        .collect();
    let found = run.call(function, Some((map, plain(false))), &rows)?;
    for (values, t) in found.chunks(SIDE as usize).zip(depths) {
        let lit = |x: usize| if f64::from(t) <= near { 1.0 } else { share(x as u32) };
        let bounds = values.iter().enumerate().all(|(x, value)| *value >= lit(x) - error);
        let rises = values.windows(2).all(|pair| pair[1] >= pair[0] - error);
        let exact =
            t != 0.75 || values.iter().enumerate().all(|(x, value)| (value - lit(x)).abs() < error);
        if !(bounds && rises && exact) {
            return Err(format!("depth {t}: {values:?}"));
        }
    }
    Ok(())
}

/// The recipe's taps lie to one side: its shadows move by 0.125/w. Centred taps do not move.
fn random_taps_shift(run: &mut Run<'_>) -> Result<(), String> {
    let map = depths(64, |u, _| if u < 0.5 { 0.25 } else { 0.75 });
    let (places, pixels) = (128u32, 64u32);
    for w in [1.0f32, 2.0, 4.0] {
        let mut rows = Vec::new();
        for (place, pixel) in
            (0..places).flat_map(|place| (0..pixels).map(move |pixel| (place, pixel)))
        {
            let u = 0.1 + 0.6 * (place as f32 + 0.5) / places as f32;
            rows.push(vec![
                (2.0 * u - 1.0) * w,
                0.1,
                0.5 * w,
                w,
                (pixel * 7 + place * 13 % 256) as f32 + 0.5,
                (pixel * 31 % 97) as f32 + 0.5,
            ]);
        }
        let found =
            run.call("random", Some((map.clone(), comparing(Compare::LessEqual, true))), &rows)?;
        // Where the shadow ends on average, from its area.
        let edge = |form: usize| {
            0.7 - 0.6 * found.iter().skip(form).step_by(2).sum::<f64>() / f64::from(places * pixels)
        };
        let shift = 0.125 / f64::from(w);
        if (edge(0) - 0.5).abs() > 0.002
            || (edge(1) - (0.5 - shift)).abs() > 0.01 * f64::from(1.0 / w)
        {
            return Err(format!(
                "w {w}: the edges are at {} and {}, not 0.5 and {}",
                edge(0),
                edge(1),
                0.5 - shift
            ));
        }
    }
    Ok(())
}

/// The 21 weights add up to 1, and are the same to both sides.
fn kernel_adds_up(run: &mut Run<'_>) -> Result<(), String> {
    let words: Vec<u32> = (-10..=10i32).map(|i| i as u32).collect();
    let weights = run.call_words("weight", None, &words)?;
    let sum: f64 = weights.iter().sum();
    let mirrored = weights.iter().eq(weights.iter().rev());
    let variance: f64 =
        weights.iter().zip(-10..).map(|(weight, i)| weight * f64::from(i * i)).sum();
    if (sum - 1.0).abs() < 1e-6 && mirrored && (7.9..8.0).contains(&variance) {
        Ok(())
    } else {
        Err(format!("{sum}, {variance}: {weights:?}"))
    }
}
