//! Laws that hold for every key.

use std::collections::BTreeSet;

use lamplight_bundle as bundle;
use lamplight_diagnostic::source::SourceSet;
use lamplight_permute::{Key, Space, manifest};
use libtest_mimic::Failed;

use super::laws::{ensure, random_spaces, read};
use lamplight_testing::random::Random;

/// Every point has a key of its own, and the key is read as that point.
pub fn keys_round_trip() -> Result<(), Failed> {
    for space in random_spaces(50) {
        let points = space.enumerate();
        let keys: BTreeSet<Key> = points.iter().map(|point| space.key(point)).collect();
        ensure(keys.len() == points.len(), "two points have the same key")?;
        for point in &points {
            ensure(
                read(&space, space.key(point).as_str()).as_ref() == Some(point),
                format!("the key `{}` is not read as its own point", space.key(point)),
            )?;
        }
    }
    Ok(())
}

/// The loader and the tools, which each read keys, give the same canonical key for a text, or both
/// refuse it. If they differed, an engine could not find what `gen` wrote.
pub fn loader_and_tools_read_alike() -> Result<(), Failed> {
    let mut sources = SourceSet::default();
    let id = sources.add("lamplight.toml", MIXED_AXES);
    let manifest = manifest::parse(&sources, id).map_err(|problems| format!("{problems:?}"))?;
    let space = &manifest.programs[0].space;
    let axes: Vec<bundle::Axis> = space.axes().iter().map(bundle_axis).collect();
    let (mut random, mut fine, mut wrong) = (Random(7), 0, 0);
    for _ in 0..20_000 {
        let text = random_key(&mut random, &axes);
        let loader = bundle::canonical(&axes, &text).ok();
        let tools = read(space, &text).map(|point| space.key(&point).to_string());
        ensure(loader == tools, format!("`{text}`: loader {loader:?}, tools {tools:?}"))?;
        *(if loader.is_some() { &mut fine } else { &mut wrong }) += 1;
    }
    let counts = format!("{fine} keys are accepted, {wrong} refused");
    ensure(fine > 1000 && wrong > 1000, format!("{counts}, expected more than 1000 of each"))
}

/// Axes of every kind and mode.
const MIXED_AXES: &str = "[program.p]
wesl = \"p.wesl\"
[program.p.axis]
count = { values = [-1, 0, 1, 12], default = 1 }
exposure = { values = [1, 2], mode = \"dynamic\" }
lit = { values = [false, true], default = true }
shadow = { values = [\"none\", \"hard\", \"pcf_3x3\"] }
taps = { values = [5, 9], mode = \"spec\" }
two_sided = { values = [false, true] }
";

fn bundle_axis(axis: &lamplight_permute::Axis) -> bundle::Axis {
    bundle::Axis {
        name: axis.name.clone(),
        values: axis.value_names(),
        default: axis.values[axis.default].to_string(),
        mode: axis.mode.name().to_owned(),
    }
}

/// A key with few parts. A part may have blanks, no value, or a mistake.
fn random_key(random: &mut Random, axes: &[bundle::Axis]) -> String {
    const SPOILT: [&str; 12] = [
        "",
        "=",
        "lit=",
        "=hard",
        "shadow==hard",
        "default",
        "taps=05",
        "count=+1",
        "shdow=hard",
        "lit=True",
        "count=\"1\"",
        "two_sided=1",
    ];
    const BLANKS: [&str; 6] = ["", "", "", "", " ", "\t "];
    let parts = (0..random.below(4)).map(|_| {
        let axis = &axes[random.below(axes.len())];
        let mut blank = || BLANKS[random.below(BLANKS.len())];
        let [a, b, c, d] = [blank(), blank(), blank(), blank()];
        let value = &axis.values[random.below(axis.values.len())];
        match random.below(8) {
            0 => SPOILT[random.below(SPOILT.len())].to_owned(),
            1 => format!("{a}{}{b}", axis.name),
            _ => format!("{a}{}{b}={c}{value}{d}", axis.name),
        }
    });
    parts.collect::<Vec<_>>().join(",")
}

/// A space, and the same space with more axes and values.
pub fn grown() -> Result<[Space; 2], Failed> {
    let parsed = |axes: &str| -> Result<Space, Failed> {
        let mut sources = SourceSet::default();
        let id = sources.add(
            "lamplight.toml",
            format!("[program.p]\nwesl = \"p.wesl\"\n[program.p.axis]\n{axes}"),
        );
        let manifest = manifest::parse(&sources, id).map_err(|problems| format!("{problems:?}"))?;
        Ok(manifest.programs[0].space.clone())
    };
    let small = parsed(
        "max_lights = { values = [1, 4, 10], default = 4 }\nshadow = { values = [\"none\", \"hard\"] }",
    )?;
    let large = parsed(
        "fog = { values = [\"none\", \"linear\"] }\nmax_lights = { values = [1, 2, 4, 10], default = 4 }\n\
         shadow = { values = [\"vsm\", \"none\", \"hard\", \"evsm\"], default = \"none\" }\ntwo_sided = { values = [false, true] }",
    )?;
    Ok([small, large])
}

/// A key keeps its text and its settings when the space gets more axes and values.
pub fn keys_survive_growth() -> Result<(), Failed> {
    let [small, large] = grown()?;
    for point in small.enumerate() {
        let key = small.key(&point);
        let later = read(&large, key.as_str());
        let later = later.ok_or_else(|| format!("the larger space refuses the key `{key}`"))?;
        ensure(large.key(&later) == key, format!("`{key}` became `{}`", large.key(&later)))?;
        let (before, after) = (small.settings(&point).values, large.settings(&later).values);
        ensure(
            before.iter().all(|(name, value)| after.get(name) == Some(value)),
            format!("`{key}` has other settings in the larger space"),
        )?;
    }
    Ok(())
}
