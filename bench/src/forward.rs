//! What whole permutations of `forward` cost, by features: the rows that peers were measured for.

use crate::shaders::{Cycles, Measured, Row};

/// The features, the key without what all of them have, the peer, and the cycles of its own shader with
/// the same features on navi21. These are derived: the cycles of `forward` in November 2026, divided by
/// the ratio of both that was measured then with another program, and that has three digits.
const ROWS: [(&str, &str, &str, i64); 18] = [
    ("a sun", "lights=directional,max_lights=1", "three.js", 193),
    ("a point", "attenuation=inverse_square_window,lights=point,max_lights=1", "three.js", 241),
    (
        "a spot",
        "attenuation=inverse_square_window,cone=smooth,lights=spot,max_lights=1",
        "three.js",
        259,
    ),
    ("a sun, coat", "clearcoat,lights=directional,max_lights=1", "three.js", 301),
    ("a sun, sheen", "lights=directional,max_lights=1,sheen", "three.js", 323),
    (
        "a sun, soft shadow (16 taps, peer 5)",
        "lights=directional,max_lights=1,shadow=pcf_vogel,shadow_light=directional",
        "three.js",
        311,
    ),
    ("four points", "attenuation=inverse_square_window,lights=point", "three.js", 590),
    ("a lamp of any kind", "LAMPS,max_lights=1", "glTF-SR", 245),
    ("the same, IBL", "LAMPS,ambient=ibl,max_lights=1", "glTF-SR", 375),
    ("the same, coat", "LAMPS,ambient=ibl,clearcoat,max_lights=1", "glTF-SR", 439),
    ("the same, sheen", "LAMPS,ambient=ibl,max_lights=1,sheen", "glTF-SR", 560),
    ("the same, anisotropy", "LAMPS,ambient=ibl,anisotropy,max_lights=1", "glTF-SR", 495),
    ("the same, film", "LAMPS,ambient=ibl,iridescence,max_lights=1", "glTF-SR", 928),
    (
        "the same, five textures",
        "LAMPS,ambient=ibl,base_map,material_maps,max_lights=1,normal_map,occlusion=map",
        "glTF-SR",
        472,
    ),
    ("four of any kind, IBL", "LAMPS,ambient=ibl", "glTF-SR", 850),
    ("the same, film", "LAMPS,ambient=ibl,iridescence", "glTF-SR", 1556),
    ("a sun, IBL", "ambient=ibl,lights=directional,max_lights=1", "Filament", 396),
    (
        "four points, IBL",
        "ambient=ibl,attenuation=inverse_square_window,lights=point",
        "LearnOpenGL",
        543,
    ),
];

/// What `LAMPS` stands for: the lamps of glTF.
const LAMPS: &str = "attenuation=range_gltf,cone=cone_scale_offset";

/// The permutation's key, in the order of the names of its axes.
fn key(row: &str) -> String {
    let row = row.replace("LAMPS", LAMPS);
    let mut settings: Vec<&str> = row.split(',').collect();
    settings.extend(["metallic_roughness", "specular=ggx"]);
    settings.sort_unstable();
    settings.join(",")
}

/// The keys of all rows, as arguments of `lamplight cost`.
pub fn keys() -> Vec<String> {
    ROWS.iter().map(|row| key(row.1)).collect()
}

/// The rows beside the recorded cycles, by their features.
pub fn rows(cycles: &Cycles) -> Measured<Vec<Row>> {
    let row = |(features, settings, peer, other): &(&str, &str, &str, i64)| {
        let own = cycles.get(&key(settings)).ok_or_else(|| format!("no figure of {features}"))?;
        Ok((format!("{features} ({peer})"), *own, *other))
    };
    ROWS.iter().map(row).collect()
}

/// What a further lamp costs: a third of what three more cost.
pub fn further_lamps(cycles: &Cycles) -> Vec<(&'static str, i64)> {
    let pairs = [
        ("a further point", "attenuation=inverse_square_window,lights=point"),
        ("a further lamp of any kind", "LAMPS,ambient=ibl"),
    ];
    let one = |(name, settings): (&'static str, &str)| {
        let four = cycles.get(&key(settings))?;
        let single = cycles.get(&key(&format!("{settings},max_lights=1")))?;
        Some((name, (four - single) / 3))
    };
    pairs.into_iter().filter_map(one).collect()
}
