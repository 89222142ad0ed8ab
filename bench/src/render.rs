//! Pictures: how long each preset takes at 512 x 512 pixels, and the goal that it should stay
//! under.

use std::error::Error;
use std::time::{Duration, Instant};

use lamplight::LIBRARY_FILES;
use lamplight::bundle::Language;
use lamplight::catalogue::{preset, probe};
use lamplight::diagnostic::Diagnostics;
use lamplight::execute::{Session, executors, on_thread};
use lamplight::picture::frame::Programs;
use lamplight::picture::{Plan, Shot, Surroundings, render_plan};

use crate::Outcome;

/// Width and height of the pictures.
const SIZE: [u32; 2] = [512; 2];
/// The executors, and the seconds that a picture may take on two cores.
const GOALS: [(&str, f64); 2] = [("vulkan", 1.0), ("eval", 2.0)];
/// How many of the slowest presets are printed for each executor.
const SHOWN: usize = 20;

/// A preset with the time that its picture took.
type Timed = (String, Duration);

/// Prints the slowest presets on each executor. Run it with `taskset` to choose the cores.
pub fn run() -> Outcome {
    let threads = std::thread::available_parallelism()?;
    println!("{} x {} pixels, {threads} threads", SIZE[0], SIZE[1]);
    for (name, goal) in GOALS {
        let entry = executors::ALL.iter().find(|entry| entry.name == name).ok_or("no executor")?;
        let timed = on_thread(|| {
            let session = entry.start()?;
            let samples = entry.samples.unwrap_or(1);
            time_presets(session.as_ref(), samples).map_err(|error| error.to_string())
        });
        match timed.ok_or("the renderer panicked")? {
            Ok(timed) => print_table(name, goal, timed),
            Err(reason) => println!("\n{name}: not measured: {reason}"),
        }
    }
    Ok(())
}

/// Draws each preset once.
fn time_presets(painter: &dyn Session, samples: u32) -> Result<Vec<Timed>, Box<dyn Error>> {
    let message_of = |problems: Diagnostics| format!("{problems:?}");
    let programs = Programs::load(LIBRARY_FILES).map_err(|(_, problems)| message_of(problems))?;
    let (presets, probes) = programs.with_texts(|texts| {
        let probes = probe::library_probes(LIBRARY_FILES, texts).map_err(message_of)?;
        let presets = preset::library_presets(LIBRARY_FILES, texts, programs.manifest(), &probes);
        presets.map(|presets| (presets, probes)).map_err(message_of)
    })?;
    let shot = Shot {
        size: SIZE,
        samples,
        exposure: 0.0,
        cascades: 1,
        language: Language::Wesl,
        surroundings: Surroundings::Usual,
    };
    let mut timed = Vec::new();
    for preset in &presets {
        let plan = Plan::of_preset(&programs, preset, &probes).map_err(message_of)?;
        let start = Instant::now();
        render_plan(painter, &programs, &plan, &shot).map_err(message_of)?;
        timed.push((preset.name.clone(), start.elapsed()));
    }
    Ok(timed)
}

/// The slowest presets, and how their times compare with the goal.
fn print_table(executor: &str, goal: f64, mut timed: Vec<Timed>) {
    timed.sort_by_key(|(_, time)| std::cmp::Reverse(*time));
    let is_over = |(_, time): &&Timed| time.as_secs_f64() > goal;
    let over = timed.iter().filter(is_over).count();
    let all: f64 = timed.iter().map(|(_, time)| time.as_secs_f64()).sum();
    println!(
        "\n{executor}: {} presets in {all:.1} s, {over} over the goal of {goal} s",
        timed.len()
    );
    println!("{:<32} {:>8} {:>8}", "preset", "seconds", "of goal");
    for (name, time) in timed.iter().take(SHOWN) {
        let seconds = time.as_secs_f64();
        println!("{name:<32} {seconds:>8.2} {:>7.0}%", 100.0 * seconds / goal);
    }
}
