//! Bundles: written, loaded, compared, merged, damaged and timed.

mod damage;
mod digests;
mod in_place;
mod large;
mod schema;
mod stopped;

use std::collections::BTreeMap;
use std::sync::Arc;

use lamplight_bundle::{
    Artifact, Axis, Bundle, Contents, EntryContents, Error, Language, Native, ProgramContents,
    Reflection, Stage, Target, Unit, Usage, canonical, diff, pack, write_directory, write_file,
};
use libtest_mimic::{Failed, Trial};

use damage::{damaged_directories, flips, truncations, versions};
use digests::remembered;
use large::large;
use schema::schema;

type Outcome = Result<(), Failed>;
type Case = (&'static str, fn() -> Outcome);

pub fn tests() -> Vec<Trial> {
    let cases: [Case; 17] = [
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
        ("rewriting_in_place_ends_no_reader", in_place::rewritten),
        ("a_replaced_file_stays_readable", in_place::replaced),
        ("a_run_killed_between_its_renames_loses_no_blob", stopped::between_the_renames),
        ("remembered_hashes_are_those_of_the_unit", remembered),
    ];
    let mut tests: Vec<Trial> = cases
        .into_iter()
        .map(|(name, case)| Trial::test(format!("bundle::{name}"), case))
        .collect();
    tests.push(Trial::test("bundle::one_hundred_thousand_keys", large));
    tests
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

/// Every permutation except those with `taps=16`. The axis `two_sided` does not change the text, so
/// permutations that differ only in it share a unit.
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
        shard: None,
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

/// A folder, a file and bytes in memory each give back what was written, and packing is a function
/// of the contents alone.
fn round_trips() -> Outcome {
    let contents = small();
    let folder = tempfile::tempdir()?;
    write_directory(&contents, folder.path())?;
    let packed = pack(&contents)?;
    check(packed == pack(&contents)?, "packing twice gives other bytes")?;
    let file = folder.path().join("shaders.lamplight");
    write_file(&contents, &file)?;
    let forms =
        [Bundle::open(folder.path())?, Bundle::open(&file)?, Bundle::from_bytes(packed.clone())?];
    for bundle in forms {
        bundle.verify()?;
        check(bundle.pack()? == packed, "a form packs to other bytes")?;
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

/// A key may name axes in any order, leave out defaults, or spell them out.
fn keys_in_any_order() -> Outcome {
    let bundle = Bundle::from_bytes(pack(&small())?)?;
    let shader = bundle.program("forward")?.shader("fs_main")?;
    let expected = shader.find("shadow=hard,two_sided")?;
    for key in [
        "two_sided,shadow=hard",
        "two_sided=true, shadow=hard",
        "max_lights=4,shadow=hard,taps=9,two_sided=true",
    ] {
        let what = format!("`{key}` is not found as `shadow=hard,two_sided` is");
        check(shader.find(key)? == expected, &what)?;
    }
    check(
        shader.find("shadow=hard")? == expected,
        "permutations that share a unit should have the same number",
    )?;
    check(shader.get("", Target::SPIRV).is_ok(), "the empty key should find the defaults")
}

/// A permutation that the bundle does not have gives an error with the canonical key and the
/// nearest key that the bundle has.
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
        check(miss.requested == "shadow=hard,taps=16,two_sided", &miss.requested)?;
        check(miss.nearest.as_deref() == Some("shadow=hard,taps=5,two_sided"), &error.to_string())?;
    }
    Ok(())
}

/// A recorded list has canonical keys, each once, also those that the bundle does not have. Several
/// threads may ask at once. A list that is saved is merged with the one in the file.
fn recording() -> Outcome {
    let mut bundle = Bundle::from_bytes(pack(&small())?)?;
    check(
        bundle.program("forward")?.shader("fs_main")?.find("shadow=hard").is_ok()
            && bundle.usage().keys.is_empty(),
        "keys were recorded before `record` was called",
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
        "a file that is not a usage list was overwritten",
    )
}

/// Unknown programs, entry points, targets, axes and values are refused with the names that exist.
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
        check(error == expected, &format!("expected `{expected}`, found `{error}`"))
    })
}

/// Writing over a bundle keeps files of users, removes old blobs one run later, and gives the same
/// folder for the same contents.
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
    // A file that the writer did not write stays.
    std::fs::write(blobs.join("0000000000000000.txt"), "a user's")?;
    let fewer = fewer();
    let reader = Bundle::open(folder.path())?;
    write_directory(&fewer, folder.path())?;
    Bundle::open(folder.path())?.verify()?;
    // A program that has the older bundle open can read it until the run after next.
    reader.verify()?;
    write_directory(&fewer, folder.path())?;
    check(reader.verify().is_err(), "blobs of the older bundle were kept for a second run")?;
    check(names()?.len() < first.0.len(), "blobs that nothing uses were left")?;
    check(blobs.join("0000000000000000.txt").exists(), "a user's file was deleted")?;
    std::fs::remove_file(blobs.join("0000000000000000.txt"))?;
    write_directory(&small(), folder.path())?;
    check(
        first == (names()?, std::fs::read(folder.path().join("manifest.json"))?),
        "the same contents gave another directory",
    )
}

/// The same contents without the permutations with hard shadows.
fn fewer() -> Contents {
    let mut fewer = small();
    for entry in fewer.entries_mut() {
        entry.keys.retain(|key, _| !key.contains("hard"));
        let used: Vec<_> = entry.keys.values().copied().collect();
        entry.units.retain(|hash, _| used.contains(hash));
    }
    fewer
}

/// `diff` names exactly the permutations that were removed or changed, and in which target.
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
    let listed: Vec<String> = changes
        .iter()
        .map(|change| format!("{} {} {:?}", change.kind, change.key, change.parts))
        .collect();
    check(
        listed == ["removed default []", "changed shadow=hard [\"wgsl\"]"],
        &format!(
            "`default` was removed and `shadow=hard` changed in wgsl, `diff` lists {listed:?}"
        ),
    )
}

/// Two shards merge to the whole, and bundles with other axes are not merged.
fn merging() -> Outcome {
    let mut shards = [Contents::default(), Contents::default()];
    for (index, shard) in shards.iter_mut().enumerate() {
        *shard = small();
        for entry in shard.entries_mut() {
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
    check(merged == small(), "two merged halves differ from the whole")?;
    let mut other = small();
    other.programs.values_mut().for_each(|program| program.axes.clear());
    check(
        matches!(merged.merge(other), Err(Error::Conflict(_))),
        "merging a bundle with other axes should be a conflict",
    )
}
