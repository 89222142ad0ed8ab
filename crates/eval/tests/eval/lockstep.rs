//! Lanes in lock-step give the same bits as lanes that run alone: for random programs, whose lanes
//! diverge and reconverge in every kind of statement, and for every function of the library.

mod draft;

use super::library::{library_program, random_word};
use super::program;
use crate::LIBRARY_FILES;
pub use draft::Dice;
use draft::draft_program;
use lamplight_diagnostic::source::Files as _;
use lamplight_eval::{
    Address, Batch, Error, Filter, FunctionId, LOOP_LIMIT, Machine, Program, Resources, Sampler,
    SlotKind, Texture, TextureDimension,
};
use lamplight_testing::random::Random;
use libtest_mimic::{Failed, Trial};

/// How many random programs run.
const PROGRAMS: u32 = 300;
/// Quads of each run: more than fit in a batch, and not a whole number of batches.
const QUADS: usize = 6;

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("eval/lockstep/random", random_programs),
        Trial::test("eval/lockstep/library", library_functions),
        Trial::test("eval/lockstep/limits", limits),
    ]
}

fn resources() -> Resources {
    let mut dice = Dice(77);
    let mut texels = |count: usize| -> Vec<[f64; 4]> {
        (0..count).map(|_| std::array::from_fn(|_| f64::from(dice.roll(99)) / 99.0)).collect()
    };
    let mut image = Texture::flat(TextureDimension::D2, 8, 4, 1, texels(32));
    image.levels.extend(Texture::flat(TextureDimension::D2, 4, 2, 1, texels(8)).levels);
    let sampler = Sampler {
        address: [Address::Repeat, Address::Mirror, Address::Clamp],
        mag: Filter::Linear,
        min: Filter::Linear,
        mipmap: Filter::Linear,
        levels: (0.0, 32.0),
        compare: None,
    };
    let comparison = Sampler { compare: Some(lamplight_eval::Compare::LessEqual), ..sampler };
    let given = (0..12u16).flat_map(|word| (f32::from(word) / 4.0).to_le_bytes()).collect();
    Resources {
        buffers: [((0, 4), given)].into(),
        textures: [
            ((0, 0), image),
            ((0, 2), Texture::flat(TextureDimension::D2, 4, 4, 1, texels(16))),
        ]
        .into(),
        samplers: [((0, 1), sampler), ((0, 3), comparison)].into(),
    }
}

fn random_programs() -> Result<(), Failed> {
    let (mut parted, mut refused, mut finite) = (0, 0, 0);
    for seed in 0..PROGRAMS {
        let text = draft_program(seed);
        let program = program(&text)
            .map_err(|error| format!("{}\n{text}", error.message().unwrap_or_default()))?;
        let id = program.function("f").ok_or("f")?;
        let mut dice = Dice(seed + 1);
        let lanes: Vec<Vec<f32>> = (0..4 * QUADS)
            .map(|_| {
                let mut lane: Vec<f32> = (0..6).map(|_| dice.number()).collect();
                lane.push(f32::from_bits(dice.roll(5)));
                lane
            })
            .collect();
        let limit = if seed % 8 == 0 { 20 } else { LOOP_LIMIT };
        let results = compare_quads(&program, id, &lanes, limit)
            .map_err(|problem| format!("program {seed}: {problem}\n{text}"))?;
        match results {
            Some(results) => {
                parted += u32::from(results.iter().any(|result| *result != results[0]));
                let numbers = results.iter().flatten().flatten();
                finite += numbers.filter(|bits| f32::from_bits(**bits).is_finite()).count();
            }
            None => refused += 1,
        }
    }
    // Programs that end at once, or give all lanes the same result, would test nothing.
    println!("{parted} of {PROGRAMS} programs give lanes different results, {refused} fail");
    println!("{finite} lanes give finite numbers");
    assert!(finite > PROGRAMS as usize * QUADS, "too few lanes give finite numbers");
    assert!(parted > PROGRAMS / 2, "the lanes part too seldom");
    assert!(refused > 0 && refused < PROGRAMS / 4, "too few or too many programs fail");
    Ok(())
}

/// Runs quads by themselves and in lock-step, and gives their results; `None` if both fail alike.
fn compare_quads(
    program: &Program,
    id: FunctionId,
    lanes: &[Vec<f32>],
    loop_limit: u64,
) -> Result<Option<Vec<Option<Vec<u32>>>>, String> {
    let message_of = |error: Error| error.to_string();
    let machine = || -> Result<Machine<'_, f32>, String> {
        let mut machine = Machine::<f32>::new(program).map_err(message_of)?;
        machine.bind(resources()).map_err(message_of)?;
        machine.loop_limit = loop_limit;
        Ok(machine)
    };
    let quads: Vec<[&[f32]; 4]> =
        lanes.as_chunks::<4>().0.iter().map(|quad| quad.each_ref().map(Vec::as_slice)).collect();
    let mut alone = Vec::new();
    let mut one = machine()?;
    let mut problem = None;
    for quad in &quads {
        match one.quad(id, *quad) {
            Ok(results) => {
                let killed = one.quad_discarded();
                let kept = results.iter().zip(killed);
                alone.extend(kept.map(|(result, killed)| (!killed).then(|| bits_of(result))));
            }
            Err(error) => {
                problem = Some(error.to_string());
                break;
            }
        }
    }
    let mut together = vec![None; lanes.len()];
    let outcome = Batch::new(machine()?).quads(id, &quads, &mut |lane, result, is_killed| {
        together[lane] = (!is_killed).then(|| bits_of(result));
    });
    let in_lockstep = outcome.err().map(|error| error.to_string());
    if problem != in_lockstep {
        return Err(format!("by themselves {problem:?}, in lock-step {in_lockstep:?}"));
    }
    if problem.is_some() {
        return Ok(None);
    }
    match alone.iter().zip(&together).position(|(alone, together)| alone != together) {
        None => Ok(Some(alone)),
        Some(lane) => Err(format!(
            "lane {lane} gives {:?} by itself and {:?} in lock-step",
            alone[lane], together[lane]
        )),
    }
}

/// The bits of slots. Every NaN has the same bits here.
fn bits_of(slots: &[f32]) -> Vec<u32> {
    let canonical = |slot: &f32| if slot.is_nan() { f32::NAN } else { *slot };
    slots.iter().map(|slot| canonical(slot).to_bits()).collect()
}

/// Calls of every function of the library agree. Each lane has its own inputs, and the number of
/// lanes is not a multiple of [`Batch::LANES`].
fn library_functions() -> Result<(), Failed> {
    let modules = LIBRARY_FILES.list(&["wesl"]);
    let is_module = |path: &&String| path.contains('/') && !path.starts_with("programs/");
    let mut compared = 0;
    for path in modules.iter().filter(is_module) {
        let program = library_program(path)?;
        for (id, function) in program.functions() {
            if function.error.is_some() || function.arguments.contains(&SlotKind::Handle) {
                continue;
            }
            compare_calls(&program, id)
                .map_err(|problem| format!("{path}: {}: {problem}", function.name))?;
            compared += 1;
        }
    }
    println!("compared {compared} functions");
    assert!(compared > 100, "the library has more functions");
    Ok(())
}

fn compare_calls(program: &Program, id: FunctionId) -> Result<(), String> {
    let message_of = |error: Error| error.to_string();
    let function = program.signature(id).ok_or("no function")?;
    let mut random = Random(5);
    let lanes: Vec<Vec<f32>> = (0..3 * Batch::LANES + 5)
        .map(|_| {
            let word = |kind: &SlotKind| f32::from_bits(random_word(*kind, &mut random));
            function.arguments.iter().map(word).collect()
        })
        .collect();
    let mut machine = Machine::<f32>::new(program).map_err(message_of)?;
    let mut alone = Vec::new();
    for lane in &lanes {
        match machine.call(id, lane) {
            Ok(result) => alone.push(bits_of(result)),
            Err(error) => {
                alone.push(error.to_string().bytes().map(u32::from).collect());
                break;
            }
        }
    }
    let slices: Vec<&[f32]> = lanes.iter().map(Vec::as_slice).collect();
    let mut together = Vec::new();
    let mut batch = Batch::new(Machine::<f32>::new(program).map_err(message_of)?);
    if let Err(error) = batch.calls(id, &slices, &mut |_, result, _| together.push(bits_of(result)))
    {
        together.push(error.to_string().bytes().map(u32::from).collect());
    }
    match alone.iter().zip(&together).position(|(alone, together)| alone != together) {
        None if alone.len() == together.len() => Ok(()),
        lane => Err(format!("the results differ at lane {lane:?}")),
    }
}

/// A lane that exceeds the limit of loop trips stops the call, whatever the other lanes do. A
/// program that takes too much memory for many lanes runs lane by lane.
fn limits() -> Result<(), Failed> {
    let text = "fn spin(n: f32) -> f32 { var s = n; for (var i = 0.0; i < n; i += 1.0) { s += i; } return s; }
        var<private> large: array<f32, 300000>;
        fn deep(n: f32) -> f32 { large[i32(n)] = n; return large[7]; }";
    let program = program(text)?;
    let run = |name: &str, most: f32, loop_limit: u64| -> Result<Vec<f32>, Failed> {
        let id = program.function(name).ok_or("no function")?;
        let mut machine = Machine::<f32>::new(&program)?;
        machine.loop_limit = loop_limit;
        let lanes: Vec<[f32; 1]> = (0..20).map(|lane| [most - lane as f32]).collect();
        let slices: Vec<&[f32]> = lanes.iter().map(<[f32; 1]>::as_slice).collect();
        let mut results = Vec::new();
        Batch::new(machine).calls(id, &slices, &mut |_, result, _| results.push(result[0]))?;
        Ok(results)
    };
    let short: Vec<f32> = (0..20).map(|lane| (20 - lane) as f32).collect();
    let sums: Vec<f32> = short.iter().map(|n| n + n * (n - 1.0) / 2.0).collect();
    assert_eq!(run("spin", 20.0, 21)?, sums);
    let stopped = run("spin", 20.0, 20).err().ok_or("a lane makes more trips than it may")?;
    assert!(stopped.message().unwrap_or_default().contains("more than 20 trips"));
    let seventh: Vec<f32> = short.iter().map(|n| if *n == 7.0 { 7.0 } else { 0.0 }).collect();
    assert_eq!(run("deep", 20.0, LOOP_LIMIT)?, seventh);
    Ok(())
}
