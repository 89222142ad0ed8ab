//! Opening a bundle and looking keys up is fast even with 100,000 keys.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use lamplight_bundle::{
    Axis, Bundle, Contents, EntryContents, Language, ProgramContents, Target, canonical, write_file,
};

use super::{Outcome, check, unit};

/// A bundle with 100,000 keys over 2,000 units, and the list of keys.
fn many() -> (Contents, Vec<String>) {
    let axis = |name: &str, count: usize| Axis {
        name: name.into(),
        values: (0..count).map(|value| format!("value_{value}")).collect(),
        default: "value_0".into(),
        mode: "static".into(),
    };
    let axes: Vec<Axis> = ["ambient", "attenuation", "specular", "shadow", "lights"]
        .map(|name| axis(name, 10))
        .into();
    let mut entry = EntryContents::default();
    let hashes: Vec<_> = (0..2_000)
        .map(|index| {
            entry.add(unit(&format!("unit {index}"), &[Target::SPIRV, Target::WGSL])).unwrap()
        })
        .collect();
    for index in 0..100_000usize {
        let value = |axis: u32| index / 10usize.pow(axis) % 10;
        let key: Vec<String> = (0..5)
            .map(|axis| format!("{}=value_{}", axes[axis as usize].name, value(axis)))
            .collect();
        entry.keys.insert(canonical(&axes, &key.join(",")).unwrap(), hashes[index % hashes.len()]);
    }
    let keys: Vec<String> = entry.keys.keys().cloned().collect();
    let entries = BTreeMap::from([("fs_main".to_owned(), entry)]);
    let program = ProgramContents { axes, languages: BTreeMap::from([(Language::Wesl, entries)]) };
    (Contents { programs: BTreeMap::from([("forward".to_owned(), program)]), shard: None }, keys)
}

/// Opening, looking up and fetching stay below a bound. `--nocapture` prints the times.
pub fn large() -> Outcome {
    let (contents, keys) = many();
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("large.lamplight");
    let (_, packing) = timed(|| write_file(&contents, &path));
    let (bundle, opening) = timed(|| Bundle::open(&path));
    let bundle = bundle?;
    let shader = bundle.program("forward")?.shader("fs_main")?;
    let (_, first) = timed(|| shader.find(&keys[0]));
    // The keys are copied in the order in which they are asked for. Otherwise the time would
    // include cache misses on the test's own list.
    let requested: Vec<String> =
        (0..keys.len()).map(|index| keys[index * 7919 % keys.len()].clone()).collect();
    let (found, looking) =
        timed(|| requested.iter().filter(|key| shader.find(key).is_ok()).count());
    check(found == 100_000, &format!("only {found} of 100,000 keys were found"))?;
    let (_, fetching) = timed(|| {
        requested.iter().take(1_000).filter(|key| shader.get(key, Target::SPIRV).is_ok()).count()
    });
    let (_, verifying) = timed(|| bundle.verify());
    let size = std::fs::metadata(&path)?.len();
    println!(
        "100,000 keys, {size} bytes: pack {packing:?}, open {opening:?}, first lookup {first:?}, lookup {:?}, fetch {:?}, verify {verifying:?}",
        looking / 100_000,
        fetching / 1_000
    );
    // Bounds for an unoptimised build on a busy machine; optimised builds are far below.
    let (lookup, fetch) = (looking / 100_000, fetching / 1_000);
    let slow = |what: &str, took: Duration, bound: Duration| {
        check(took < bound, &format!("{what} took {took:?}, the bound is {bound:?}"))
    };
    slow("opening", opening, Duration::from_millis(50))?;
    slow("looking up a key", lookup, Duration::from_micros(20))?;
    slow("fetching an output", fetch, Duration::from_millis(2))
}

fn timed<T>(work: impl FnOnce() -> T) -> (T, Duration) {
    let start = Instant::now();
    let value = work();
    (value, start.elapsed())
}
