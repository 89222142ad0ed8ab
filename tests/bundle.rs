//! Bundles written, loaded, damaged, merged and timed.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::{Duration, Instant};

use lamplight::bundle::{
    Artifact, Axis, Bundle, Contents, EntryContents, Error, Language, Native, ProgramContents,
    Reflection, SCHEMA, Stage, Target, Unit, Usage, canonical, diff, pack, write_directory,
    write_file,
};
use libtest_mimic::{Failed, Trial};
use serde_json::Value;

type Outcome = Result<(), Failed>;
type Case = (&'static str, fn() -> Outcome);

pub fn trials() -> Vec<Trial> {
    let cases: [Case; 13] = [
        ("recorded_keys_are_listed", recording),
        ("both_forms_give_back_what_was_written", round_trips),
        ("keys_come_in_any_order_with_defaults", keys_in_any_order),
        ("a_miss_names_the_nearest", misses),
        ("unknown_names_are_listed", unknown_names),
        ("every_flipped_byte_is_noticed", flips),
        ("every_truncation_is_noticed", truncations),
        ("damaged_directories_are_noticed", damaged_directories),
        ("other_versions_are_refused", versions),
        ("writing_replaces_and_cleans_up", rewriting),
        ("diff_names_what_changed", differences),
        ("shards_merge", merging),
        ("manifests_follow_their_schema", schema),
    ];
    let mut trials: Vec<Trial> = cases
        .into_iter()
        .map(|(name, case)| Trial::test(format!("bundle::{name}"), case))
        .collect();
    trials.push(Trial::test("bundle::one_hundred_thousand_keys", large));
    trials
}

const VALUES: [&[&str]; 4] =
    [&["none", "hard", "pcf_3x3"], &["false", "true"], &["1", "4", "10"], &["5", "9", "16"]];
const NAMES: [&str; 4] = ["shadow", "two_sided", "max_lights", "taps"];
const DEFAULTS: [&str; 4] = ["none", "false", "4", "9"];

fn axes() -> Vec<Axis> {
    let axis = |index: usize| Axis {
        name: NAMES[index].into(),
        values: VALUES[index].iter().map(|value| (*value).into()).collect(),
        default: DEFAULTS[index].into(),
        mode: "static".into(),
    };
    (0..4).map(axis).collect()
}

fn unit(text: &str, targets: &[Target]) -> Unit {
    let reflection = Reflection::of(Stage::Fragment);
    let native = Arc::new(Native { entry_name: "main".into(), ..Native::default() });
    let artifact = |target: &Target| {
        let bytes = format!("{}{target}: {text}", "the same text in every shader\n".repeat(40))
            .into_bytes()
            .into();
        (
            target.name().to_owned(),
            Artifact { bytes, extension: "txt".into(), native: native.clone() },
        )
    };
    Unit { reflection: Arc::new(reflection), targets: targets.iter().map(artifact).collect() }
}

/// Every permutation but those of `taps=16`; `two_sided` does not reach the shader.
fn small() -> Contents {
    let mut entry = EntryContents::default();
    for (shadow, two_sided, lights, taps) in product() {
        let key = format!("shadow={shadow},two_sided={two_sided},max_lights={lights},taps={taps}");
        if taps != "16" {
            let hash = entry
                .add(unit(&format!("{shadow} {lights} {taps}"), &[Target::SPIRV, Target::WGSL]))
                .unwrap();
            entry.keys.insert(canonical(&axes(), &key).unwrap(), hash);
        }
    }
    let mut languages = BTreeMap::new();
    languages.insert(
        Language::Wesl,
        BTreeMap::from([
            ("fs_main".to_owned(), entry.clone()),
            ("vs_main".to_owned(), entry.clone()),
        ]),
    );
    languages.insert(Language::Glsl, BTreeMap::from([("fragment".to_owned(), entry)]));
    let program = ProgramContents { axes: axes(), languages };
    Contents {
        programs: BTreeMap::from([
            ("depth".to_owned(), program.clone()),
            ("forward".to_owned(), program),
        ]),
    }
}

fn product() -> impl Iterator<Item = (&'static str, &'static str, &'static str, &'static str)> {
    VALUES[0].iter().flat_map(|a| {
        VALUES[1].iter().flat_map(move |b| {
            VALUES[2].iter().flat_map(move |c| VALUES[3].iter().map(move |d| (*a, *b, *c, *d)))
        })
    })
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).lines().last().unwrap_or_default().to_owned()
}

fn check(holds: bool, what: &str) -> Outcome {
    if holds { Ok(()) } else { Err(what.into()) }
}

fn round_trips() -> Outcome {
    let contents = small();
    let folder = tempfile::tempdir()?;
    write_directory(&contents, folder.path())?;
    let packed = pack(&contents)?;
    check(packed == pack(&contents)?, "packing twice gives other bytes")?;
    let file = folder.path().join("shaders.lamplight");
    write_file(&contents, &file)?;
    for bundle in [Bundle::open(folder.path())?, Bundle::open(&file)?, Bundle::from_bytes(packed)?]
    {
        bundle.verify()?;
        check(bundle.contents()? == contents, "the contents differ")?;
        let found = bundle
            .program("forward")?
            .entry(Language::Glsl, "fragment")?
            .get("shadow=hard,two_sided", Target::WGSL)?;
        check(text(&found.bytes) == "wgsl: hard 4 9", &text(&found.bytes))?;
    }
    check(
        pack(&Bundle::open(folder.path())?.contents()?)? == pack(&contents)?,
        "a directory packs to other bytes",
    )
}

fn keys_in_any_order() -> Outcome {
    let bundle = Bundle::from_bytes(pack(&small())?)?;
    let shader = bundle.program("forward")?.shader("fs_main")?;
    let expected = shader.find("shadow=hard,two_sided")?;
    for key in [
        "two_sided,shadow=hard",
        "two_sided=true, shadow=hard",
        "max_lights=4,shadow=hard,taps=9,two_sided=true",
    ] {
        check(shader.find(key)? == expected, key)?;
    }
    check(
        shader.find("shadow=hard")? == expected,
        "permutations that share a unit have its number",
    )?;
    check(shader.get("", Target::SPIRV).is_ok(), "the defaults are the empty key")
}

fn misses() -> Outcome {
    let folder = tempfile::tempdir()?;
    write_directory(&small(), folder.path())?;
    for bundle in [Bundle::open(folder.path())?, Bundle::from_bytes(pack(&small())?)?] {
        let error = bundle
            .program("forward")?
            .shader("fs_main")?
            .get("two_sided,taps=16,shadow=hard", Target::SPIRV)
            .err();
        let error = error.ok_or("a permutation that is not there was found")?;
        let miss = error.miss().ok_or_else(|| error.to_string())?;
        check(miss.asked == "shadow=hard,taps=16,two_sided", &miss.asked)?;
        check(miss.nearest.as_deref() == Some("shadow=hard,taps=5,two_sided"), &error.to_string())?;
    }
    Ok(())
}

/// Canonical, each once, missing ones too, from many threads; lists merge in their file.
fn recording() -> Outcome {
    let mut bundle = Bundle::from_bytes(pack(&small())?)?;
    check(
        bundle.program("forward")?.shader("fs_main")?.find("shadow=hard").is_ok()
            && bundle.usage().keys.is_empty(),
        "nobody asked for a list",
    )?;
    bundle.record();
    let shader = bundle.program("forward")?.shader("fs_main")?;
    std::thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| {
                ["two_sided,shadow=hard", "shadow=hard,two_sided=true", "", "default", "taps=16"]
                    .map(|key| shader.find(key).is_ok())
            });
        }
    });
    let text = bundle.usage().to_string();
    let lines: Vec<&str> = text.lines().skip(1).collect();
    check(lines == ["forward default", "forward shadow=hard,two_sided", "forward taps=16"], &text)?;
    let path = tempfile::tempdir()?;
    let path = path.path().join("used");
    std::fs::write(&path, "# earlier\nblur direction=across\n")?;
    bundle.usage().save(&path)?;
    bundle.usage().save(&path)?;
    let list =
        Usage::parse(&std::fs::read_to_string(&path)?).map_err(|line| format!("line {line}"))?;
    check(list.keys.len() == 2 && list.keys["forward"].len() == 3, "the lists did not merge")?;
    std::fs::write(&path, "word\n")?;
    check(
        bundle.usage().save(&path).is_err() && std::fs::read_to_string(&path)? == "word\n",
        "what is no list was overwritten",
    )
}

fn unknown_names() -> Outcome {
    let bundle = Bundle::from_bytes(pack(&small())?)?;
    let program = bundle.program("forward")?;
    let shader = program.shader("fs_main")?;
    let errors = [
        (
            bundle.program("froward").err(),
            "the bundle has no program `froward`; it has: depth, forward",
        ),
        (
            program.entry(Language::Wesl, "main").err(),
            "the bundle has no entry point `main`; it has: fs_main, vs_main",
        ),
        (shader.get("", Target::MSL).err(), "the bundle has no target `msl`; it has: spirv, wgsl"),
        (
            shader.get("tap=5", Target::SPIRV).err(),
            "`tap=5` is not a key of this program: there is no axis `tap`; there are: shadow, two_sided, max_lights, taps",
        ),
        (
            shader.get("taps=6", Target::SPIRV).err(),
            "`taps=6` is not a key of this program: axis `taps` has no value `6`; there are: 5, 9, 16",
        ),
        (
            shader.get("taps=5,taps=9", Target::SPIRV).err(),
            "`taps=5,taps=9` is not a key of this program: axis `taps` is named twice",
        ),
    ];
    errors.into_iter().try_for_each(|(error, expected)| {
        let error = error.map(|error| error.to_string()).unwrap_or_default();
        check(error == expected, &error)
    })
}

/// A generator good enough to choose positions: xorshift.
fn random(state: &mut u64, below: usize) -> usize {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    (*state % below as u64) as usize
}

fn flips() -> Outcome {
    let packed = pack(&small())?;
    let mut state = 0x1234_5678_9abc_def1;
    for round in 0..2_000 {
        // The header by every byte, the rest at random.
        let at = if round < 300 { round } else { random(&mut state, packed.len()) };
        let mut damaged = packed.clone();
        damaged[at] ^= 1 << random(&mut state, 8);
        use_all(damaged, &format!("byte {at}"))?;
    }
    Ok(())
}

/// Loading must not panic, whatever it gives; verifying must notice.
fn use_all(bytes: Vec<u8>, what: &str) -> Outcome {
    let Ok(bundle) = Bundle::from_bytes(bytes) else { return Ok(()) };
    if let Ok(shader) = bundle.program("forward").and_then(|program| program.shader("fs_main")) {
        let _ = shader.get("shadow=hard", Target::WGSL);
        let _ = shader.get("taps=16", Target::WGSL);
    }
    let _ = bundle.contents();
    check(bundle.verify().is_err(), &format!("damage was not noticed: {what}"))
}

fn truncations() -> Outcome {
    let packed = pack(&small())?;
    let mut state = 0xdead_beef_0bad_cafe;
    for round in 0..500 {
        let length = if round < 300 { round } else { random(&mut state, packed.len()) };
        use_all(packed[..length].to_vec(), &format!("cut to {length}"))?;
    }
    use_all([packed.as_slice(), b"x"].concat(), "one byte more")?;
    let folder = tempfile::tempdir()?;
    let empty = folder.path().join("empty");
    std::fs::write(&empty, b"")?;
    check(matches!(Bundle::open(empty), Err(Error::Corrupt { .. })), "an empty file was opened")
}

fn damaged_directories() -> Outcome {
    let folder = tempfile::tempdir()?;
    write_directory(&small(), folder.path())?;
    let manifest = std::fs::read(folder.path().join("manifest.json"))?;
    let mut state = 0x0123_4567_89ab_cdef;
    for round in 0..500 {
        let mut damaged = manifest.clone();
        if round % 5 == 0 {
            damaged.truncate(random(&mut state, manifest.len()));
        } else {
            damaged[random(&mut state, manifest.len())] ^= 1 << random(&mut state, 8);
        }
        std::fs::write(folder.path().join("manifest.json"), &damaged)?;
        check(Bundle::open(folder.path()).is_err(), "damage of the manifest was not noticed")?;
    }
    std::fs::write(folder.path().join("manifest.json"), &manifest)?;
    let bundle = Bundle::open(folder.path())?;
    bundle.verify()?;
    let blob = std::fs::read_dir(folder.path().join("blobs"))?.next().ok_or("no blob")??.path();
    let good = std::fs::read(&blob)?;
    let mut bad = good.clone();
    bad[0] ^= 1;
    std::fs::write(&blob, &bad)?;
    check(matches!(bundle.verify(), Err(Error::Corrupt { .. })), "a damaged blob was not noticed")?;
    std::fs::remove_file(&blob)?;
    check(bundle.verify().is_err(), "a missing blob was not noticed")
}

fn versions() -> Outcome {
    let mut packed = pack(&small())?;
    packed[8] = 9;
    check(
        matches!(Bundle::from_bytes(packed), Err(Error::Version { found: 9, known: 1 })),
        "a file of version 9 was read",
    )?;
    let folder = tempfile::tempdir()?;
    std::fs::write(
        folder.path().join("manifest.json"),
        "{\"version\": 9, \"something\": \"else\"}",
    )?;
    check(
        matches!(Bundle::open(folder.path()), Err(Error::Version { found: 9, known: 1 })),
        "a manifest of version 9 was read",
    )
}

fn rewriting() -> Outcome {
    let folder = tempfile::tempdir()?;
    let blobs = folder.path().join("blobs");
    let names = || -> std::io::Result<Vec<_>> {
        let mut names: Vec<_> = std::fs::read_dir(&blobs)?
            .map(|entry| entry.map(|entry| entry.file_name()))
            .collect::<Result<_, _>>()?;
        names.sort();
        Ok(names)
    };
    write_directory(&small(), folder.path())?;
    let first = (names()?, std::fs::read(folder.path().join("manifest.json"))?);
    // What a user puts there stays.
    std::fs::write(blobs.join("0000000000000000.txt"), "a user's")?;
    let fewer = fewer();
    let reader = Bundle::open(folder.path())?;
    write_directory(&fewer, folder.path())?;
    Bundle::open(folder.path())?.verify()?;
    // A program that has the older bundle open goes on reading it until the run after.
    reader.verify()?;
    write_directory(&fewer, folder.path())?;
    check(reader.verify().is_err(), "blobs of the bundle before are kept for ever")?;
    check(names()?.len() < first.0.len(), "stale blobs were left")?;
    check(blobs.join("0000000000000000.txt").exists(), "a user's file is gone")?;
    std::fs::remove_file(blobs.join("0000000000000000.txt"))?;
    write_directory(&small(), folder.path())?;
    check(
        first == (names()?, std::fs::read(folder.path().join("manifest.json"))?),
        "the same contents gave another directory",
    )
}

/// Without the permutations of hard shadows.
fn fewer() -> Contents {
    let mut fewer = small();
    fewer
        .programs
        .values_mut()
        .flat_map(|program| program.languages.values_mut())
        .flat_map(|entries| entries.values_mut())
        .for_each(|entry| {
            entry.keys.retain(|key, _| !key.contains("hard"));
            let used: Vec<_> = entry.keys.values().copied().collect();
            entry.units.retain(|hash, _| used.contains(hash));
        });
    fewer
}

fn differences() -> Outcome {
    let (old, mut new) = (small(), small());
    check(diff(&old, &new).is_empty(), "a bundle differs from itself")?;
    let entry = new
        .programs
        .get_mut("forward")
        .and_then(|program| program.languages.get_mut(&Language::Wesl))
        .and_then(|entries| entries.get_mut("fs_main"));
    let entry = entry.ok_or("no entry")?;
    let mut changed = entry.units[&entry.keys["shadow=hard"]].clone();
    changed.targets.get_mut("wgsl").ok_or("no target")?.bytes = b"other".as_slice().into();
    let hash = entry.add(changed)?;
    entry.keys.insert("shadow=hard".into(), hash);
    entry.keys.remove("default");
    let changes = diff(&old, &new).permutations;
    let told: Vec<String> = changes
        .iter()
        .map(|change| format!("{} {} {:?}", change.kind, change.key, change.parts))
        .collect();
    check(told == ["removed default []", "changed shadow=hard [\"wgsl\"]"], &format!("{told:?}"))
}

fn merging() -> Outcome {
    let mut shards = [Contents::default(), Contents::default()];
    for (index, shard) in shards.iter_mut().enumerate() {
        *shard = small();
        for entry in shard
            .programs
            .values_mut()
            .flat_map(|program| program.languages.values_mut())
            .flat_map(|entries| entries.values_mut())
        {
            let mut count = 0;
            entry.keys.retain(|_, _| {
                count += 1;
                count % 2 == index
            });
            let used: Vec<_> = entry.keys.values().copied().collect();
            entry.units.retain(|hash, _| used.contains(hash));
        }
    }
    let [mut merged, other] = shards;
    merged.merge(other)?;
    check(merged == small(), "two halves are not the whole")?;
    let mut other = small();
    other.programs.values_mut().for_each(|program| program.axes.clear());
    check(matches!(merged.merge(other), Err(Error::Conflict(_))), "other axes were merged")
}

fn schema() -> Outcome {
    let folder = tempfile::tempdir()?;
    write_directory(&small(), folder.path())?;
    let schema: Value = serde_json::from_str(SCHEMA)?;
    let manifest: Value =
        serde_json::from_slice(&std::fs::read(folder.path().join("manifest.json"))?)?;
    conforms(&schema, &schema, &manifest, "manifest")
}

/// The part of JSON Schema that the published schema uses.
pub fn conforms(root: &Value, schema: &Value, value: &Value, place: &str) -> Outcome {
    if let Some(name) = schema["$ref"].as_str() {
        return conforms(
            root,
            root.pointer(&name[1..]).ok_or("a reference leads nowhere")?,
            value,
            place,
        );
    }
    let is_type = match schema["type"].as_str() {
        Some("object") => value.is_object(),
        Some("array") => value.is_array(),
        Some("string") => value.is_string(),
        Some("integer") => value.is_u64(),
        Some("boolean") => value.is_boolean(),
        _ => true,
    };
    check(is_type, &format!("{place} has the wrong type"))?;
    check(schema.get("const").is_none_or(|only| only == value), place)?;
    check(
        schema["enum"].as_array().is_none_or(|known| known.contains(value)),
        &format!("{place}: {value}"),
    )?;
    for name in schema["required"].as_array().into_iter().flatten().filter_map(Value::as_str) {
        check(value.get(name).is_some(), &format!("{place} has no {name}"))?;
    }
    for (name, member) in value.as_object().into_iter().flatten() {
        let known = schema["properties"].get(name).unwrap_or(&schema["additionalProperties"]);
        check(known != &Value::Bool(false), &format!("{place} has an unknown {name}"))?;
        conforms(root, known, member, &format!("{place}.{name}"))?;
    }
    value
        .as_array()
        .into_iter()
        .flatten()
        .try_for_each(|item| conforms(root, &schema["items"], item, place))
}

/// 100,000 keys of 2,000 units, and the keys.
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
    (Contents { programs: BTreeMap::from([("forward".to_owned(), program)]) }, keys)
}

/// Opening, looking up and fetching stay quick; the figures are printed with `--nocapture`.
fn large() -> Outcome {
    let (contents, keys) = many();
    let folder = tempfile::tempdir()?;
    let path = folder.path().join("large.lamplight");
    let (_, packing) = timed(|| write_file(&contents, &path));
    let (bundle, opening) = timed(|| Bundle::open(&path));
    let bundle = bundle?;
    let shader = bundle.program("forward")?.shader("fs_main")?;
    let (_, first) = timed(|| shader.find(&keys[0]));
    // Copied in the order of asking: what is timed is the bundle's memory, not the test's.
    let asked: Vec<String> =
        (0..keys.len()).map(|index| keys[index * 7919 % keys.len()].clone()).collect();
    let (found, looking) = timed(|| asked.iter().filter(|key| shader.find(key).is_ok()).count());
    check(found == 100_000, "a key was not found")?;
    let (_, fetching) = timed(|| {
        asked.iter().take(1_000).filter(|key| shader.get(key, Target::SPIRV).is_ok()).count()
    });
    let (_, verifying) = timed(|| bundle.verify());
    let size = std::fs::metadata(&path)?.len();
    println!(
        "100,000 keys, {size} bytes: pack {packing:?}, open {opening:?}, first lookup {first:?}, lookup {:?}, fetch {:?}, verify {verifying:?}",
        looking / 100_000,
        fetching / 1_000
    );
    // Bounds for an unoptimised build on a busy machine; optimised builds are far below.
    check(opening < Duration::from_millis(50), &format!("opening took {opening:?}"))?;
    check(looking / 100_000 < Duration::from_micros(20), &format!("looking up took {looking:?}"))?;
    check(fetching / 1_000 < Duration::from_millis(2), &format!("fetching took {fetching:?}"))
}

fn timed<T>(work: impl FnOnce() -> T) -> (T, Duration) {
    let start = Instant::now();
    let value = work();
    (value, start.elapsed())
}
