//! The loader: a single file of 100,000 permutations opened, asked and read.

use std::collections::BTreeMap;
use std::hint::black_box;
use std::sync::Arc;
use std::time::{Duration, Instant};

use lamplight::bundle::{
    Artifact, Axis, Bundle, Contents, EntryContents, Language, Native, ProgramContents, Reflection,
    Stage, Target, Unit, canonical, write_file,
};

use crate::Outcome;

const AXES: [&str; 5] = ["ambient", "attenuation", "specular", "shadow", "lights"];
const VALUES: usize = 10;
const KEYS: usize = VALUES.pow(AXES.len() as u32);
const UNITS: usize = 2_000;
const FETCHES: usize = 2_000;
const OPENINGS: usize = 101;
/// How many lookups are timed together, since reading the clock takes as long as one lookup.
const BATCH: usize = 500;

/// Prints what opening, a lookup and a fetch take.
pub fn run() -> Outcome {
    let (contents, keys) = contents()?;
    let path =
        std::env::temp_dir().join(format!("lamplight-bench-{}.lamplight", std::process::id()));
    write_file(&contents, &path)?;
    drop(contents);
    // Keys are asked in an order that the processor's caches cannot predict. They are copied in
    // that order too, so that the time is that of the bundle's memory and not of the benchmark's.
    let requested: Vec<String> =
        (0..KEYS).map(|index| keys[index * 7_919 % KEYS].clone()).collect();
    let open = median((0..OPENINGS).map(|_| timed(|| Bundle::open(&path).is_ok())))?;
    let bundle = Bundle::open(&path)?;
    let shader = bundle.program("forward")?.shader("fs_main")?;
    let first = median([timed(|| shader.find(&requested[0]).is_ok())].into_iter())?;
    let lookup = median(
        requested
            .chunks(BATCH)
            .map(|batch| timed(|| batch.iter().all(|key| shader.find(key).is_ok()))),
    )?;
    let fetch = median(
        requested
            .iter()
            .take(FETCHES)
            .map(|key| timed(|| black_box(shader.get(key, Target::SPIRV)).is_ok())),
    )?;
    println!("load: {KEYS} permutations, {:.1} MB", std::fs::metadata(&path)?.len() as f64 / 1e6);
    println!(
        "load: open {open:.1?}, first lookup with its checksum {first:.1?}, lookup {:.0?}, fetch {fetch:.1?}",
        lookup / BATCH as u32
    );
    Ok(std::fs::remove_file(&path)?)
}

/// The median, since others use the machine too and interrupt some runs. Fails if any of the work
/// failed.
fn median(times: impl Iterator<Item = (bool, Duration)>) -> Result<Duration, String> {
    let times: Option<Vec<Duration>> = times.map(|(done, time)| done.then_some(time)).collect();
    let mut times = times.ok_or("a bundle or a key was not found")?;
    times.sort();
    times.get(times.len() / 2).copied().ok_or_else(|| "nothing was timed".to_owned())
}

fn timed(work: impl FnOnce() -> bool) -> (bool, Duration) {
    let start = Instant::now();
    let done = work();
    (done, start.elapsed())
}

fn contents() -> Result<(Contents, Vec<String>), Box<dyn std::error::Error>> {
    let axis = |name: &str| Axis {
        name: name.into(),
        values: (0..VALUES).map(|value| format!("value_{value}")).collect(),
        default: "value_0".into(),
        mode: "static".into(),
    };
    let axes: Vec<Axis> = AXES.map(axis).into();
    let mut entry = EntryContents::default();
    let hashes = (0..UNITS).map(|index| entry.add(unit(index))).collect::<Result<Vec<_>, _>>()?;
    for index in 0..KEYS {
        let value = |axis: usize| index / VALUES.pow(axis as u32) % VALUES;
        let key: Vec<String> = AXES
            .iter()
            .enumerate()
            .map(|(axis, name)| format!("{name}=value_{}", value(axis)))
            .collect();
        entry.keys.insert(canonical(&axes, &key.join(","))?, hashes[index % UNITS]);
    }
    let keys = entry.keys.keys().cloned().collect();
    let languages =
        BTreeMap::from([(Language::Wesl, BTreeMap::from([("fs_main".to_owned(), entry)]))]);
    Ok((
        Contents {
            programs: BTreeMap::from([("forward".to_owned(), ProgramContents { axes, languages })]),
            shard: None,
        },
        keys,
    ))
}

/// About as large as a shader of the library: some 8 kB in each of two targets.
fn unit(index: usize) -> Unit {
    let reflection = Reflection::of(Stage::Fragment);
    let native = Arc::new(Native { entry_name: "main".into(), ..Native::default() });
    let artifact = |target: Target| {
        let lines = (0..200).map(|line| {
            format!("{target}: line {line} of {}, much like others\n", index * 31 % (line + 7))
        });
        let bytes = lines.collect::<String>() + &index.to_string();
        (
            target.name().to_owned(),
            Artifact {
                bytes: bytes.into_bytes().into(),
                extension: "txt".into(),
                native: native.clone(),
            },
        )
    };
    Unit {
        reflection: Arc::new(reflection),
        targets: [Target::SPIRV, Target::WGSL].map(artifact).into(),
    }
}
