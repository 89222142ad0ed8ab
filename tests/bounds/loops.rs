//! Which loops get no counter under `restrict`: random ones that the evaluator runs, those whose form
//! is documented, and those of the library's programs.

use std::collections::BTreeSet;

use lamplight::bundle::{Bundle, Language, Target};
use lamplight::diagnostic::codes;
use lamplight::emit::LoopProofs;
use lamplight::eval::{Machine, Program};
use lamplight::validate::functions;
use lamplight_testing::random::Random;
use naga::valid::{Capabilities, ValidationFlags, Validator};

use super::Outcome;
use crate::frames::{PROGRAMS, Sources, covering};
use crate::validators::{Package, expect};

/// How many random loops are tried.
const LOOPS: u64 = 2000;
/// A loop that makes more turns runs on. Those that end make a few thousand at most, with the turns
/// of loops within them.
const MOST_TURNS: u64 = 20_000;

/// A loop over an integer of a type, which it begins at `start`.
struct Draft {
    random: Random,
    ty: &'static str,
    /// Whether the usual step goes up.
    up: bool,
    /// Whether the loop goes on until its variable has one value. It makes as many turns as there
    /// are numbers unless it steps towards that value.
    exact: bool,
}

impl Draft {
    fn new(seed: u64) -> Self {
        let mut random = Random(seed);
        let (ty, up) = (*random.pick(&["i32", "u32"]), random.chance(60));
        Self { random, ty, up, exact: false }
    }

    /// The number that is so far from the end of the type towards which the loop counts.
    fn near_end(&self, distance: u32) -> String {
        match (self.ty, self.up) {
            ("i32", true) => format!("{}i", i64::from(i32::MAX) - i64::from(distance)),
            ("i32", false) => format!("i32({})", i64::from(i32::MIN) + i64::from(distance)),
            (_, true) => format!("{}u", u32::MAX - distance),
            _ => format!("{distance}u"),
        }
    }

    fn word(&self, distance: u32) -> u32 {
        match (self.ty, self.up) {
            ("i32", true) => i32::MAX as u32 - distance,
            ("i32", false) => (i32::MIN as u32) + distance,
            (_, true) => u32::MAX - distance,
            _ => distance,
        }
    }

    fn step(&mut self) -> String {
        let size = *self.random.pick(&[1, 1, 1, 1, 2, 3, 7]);
        let (with, against) = if self.up { ("+", "-") } else { ("-", "+") };
        let sign = if self.exact || self.random.chance(92) { with } else { against };
        match self.random.below(14) {
            0 => format!("i = {size} + i;"),
            1 => "i = n;".to_owned(),
            2 => "i = i * 2;".to_owned(),
            3 => format!("i = other {sign} {size};"),
            4 => format!("let p = &i; *p {sign}= {size};"),
            _ => format!("i {sign}= {size};"),
        }
    }

    /// A condition that holds while the loop goes on.
    fn condition(&mut self) -> String {
        let usual = if self.up { ["<", "<", "<="] } else { [">", ">", ">="] };
        let other = ["<", "<=", ">", ">=", "!=", "=="];
        let op = if self.random.chance(80) {
            self.random.pick(&usual)
        } else {
            self.random.pick(&other)
        };
        self.exact = *op == "!=";
        let distance = if self.exact { 0 } else { self.random.below(20) as u32 };
        let number = if self.random.chance(50) { "n".to_owned() } else { self.near_end(distance) };
        let test = match self.random.below(8) {
            0 => {
                let op = op.replace('<', "^").replace('>', "<").replace('^', ">");
                format!("{number} {op} i")
            }
            1 => format!("i + 0 {op} {number}"),
            _ => format!("i {op} {number}"),
        };
        match self.random.below(8) {
            0 => format!("{test} && turns != 500u"),
            1 => format!("turns != 500u && {test}"),
            2 => format!("{test} || turns == 500u"),
            3 => format!("!(!({test}))"),
            _ => test,
        }
    }

    /// What else the loop does.
    fn rest(&mut self) -> String {
        let (sign, turn) = (if self.up { "+" } else { "-" }, self.random.below(3));
        match self.random.below(16) {
            0 => format!("if turns % 3u == {turn}u {{ continue; }}"),
            1 => "if turns % 3u == 1u { i = n; }".to_owned(),
            2 => format!("n {sign}= 1;"),
            3 => format!("n {sign}= 3;"),
            4 => "bump(&i);".to_owned(),
            5 => "other = i;".to_owned(),
            6 => "for (var k = 0; k < 3; k++) { if k == 1 { continue; } other += 1; }".to_owned(),
            7 => "switch turns % 4u { case 1u: { continue; } default: {} }".to_owned(),
            8 => format!("if turns % 2u == 0u {{ i = i {sign} 1; }}"),
            9 => "if turns > 40u && n == i { return turns; }".to_owned(),
            10 => "{ other += 2; }".to_owned(),
            11 => "if other == n { break; }".to_owned(),
            _ => String::new(),
        }
    }

    fn text(&mut self) -> String {
        let (condition, step, rest) = (self.condition(), self.step(), self.rest());
        let count = "turns++;";
        let looped = match self.random.below(7) {
            0 | 1 if !step.starts_with("let") => {
                format!("for (; {condition}; {}) {{ {count} {rest} }}", step.trim_end_matches(';'))
            }
            2 => format!("while {condition} {{ {count} {rest} {step} }}"),
            3 => format!("while {condition} {{ {count} {{ {step} }} {rest} }}"),
            4 => format!(
                "loop {{ if !({condition}) {{ break; }} {count} {rest} continuing {{ {step} }} }}"
            ),
            5 => format!(
                "loop {{ {count} {rest} continuing {{ {step} break if !({condition}); }} }}"
            ),
            _ => format!("loop {{ {count} {rest} if {condition} {{ }} else {{ break; }} {step} }}"),
        };
        let ty = self.ty;
        format!(
            "fn bump(i: ptr<function, {ty}>) {{ *i = *i / 2; }}\n\
             fn run(start: {ty}, bound: {ty}) -> u32 {{\n\
             var i = start; var n = bound; var other = bound; var turns = 0u;\n\
             {looped}\nreturn turns; }}"
        )
    }
}

/// No random loop that runs on is proved to end. Variables begin some steps before the end of their
/// type, so that a loop which ends does so soon, and one that wraps runs on.
pub fn random() -> Outcome {
    let (mut proved, mut endless) = (0, 0);
    for seed in 0..LOOPS {
        let mut draft = Draft::new(seed);
        let text = draft.text();
        // A random text may assign a value of another type.
        let Ok(module) = naga::front::wgsl::parse_str(&text) else {
            return Err(format!("seed {seed} is no WGSL:\n{text}").into());
        };
        let info =
            Validator::new(ValidationFlags::all(), Capabilities::empty()).validate(&module)?;
        let is_last = |one: &&naga::Function| one.name.as_deref() == Some("run");
        let function = functions(&module).find(is_last).ok_or("no function")?;
        let is_proved = LoopProofs::new(&module, function).open().first() == Some(&false);
        let runs_on = runs_on(&Program::new(&module, &info)?, &mut draft)?;
        if is_proved && runs_on {
            return Err(format!("seed {seed} runs on, and is proved to end:\n{text}").into());
        }
        proved += u64::from(is_proved);
        endless += u64::from(runs_on);
    }
    println!("{proved} of {LOOPS} loops proved, {endless} run on");
    if proved > LOOPS / 5 && endless > LOOPS / 20 {
        Ok(())
    } else {
        Err("too few of a kind".into())
    }
}

/// Whether a loop runs on for some beginnings.
fn runs_on(program: &Program, draft: &mut Draft) -> Result<bool, libtest_mimic::Failed> {
    let run = program.function("run").ok_or("no function")?;
    let mut machine = Machine::<f64>::new(program)?;
    machine.loop_limit = MOST_TURNS;
    for _ in 0..12 {
        let distances = [8 + draft.random.below(40) as u32, draft.random.below(20) as u32];
        let words = distances.map(|distance| draft.word(distance));
        match machine.call_words(run, &words, &mut Vec::new()) {
            Ok(()) => {}
            Err(error) if error.code.name == codes::EVAL_LOOP_LIMIT.name => return Ok(true),
            Err(error) => return Err(error.to_string().into()),
        }
    }
    Ok(false)
}

/// The loops that the guide says get no counter.
const COUNTED: &str = "
struct Lamps { count: u32, last: i32 }
@group(0) @binding(0) var<uniform> lamps: Lamps;
const STEPS = 16;
@fragment fn fs_main(@location(0) at: vec2f) -> @location(0) vec4f {
    var sum = vec4f(0.0);
    for (var i = 0u; i < lamps.count; i++) { if sum.x > 4.0 { continue; } sum += vec4f(0.125); }
    for (var i = 1; i <= STEPS; i += 3) { sum += vec4f(0.25); }
    for (var i = lamps.last; i >= 0; i--) { if sum.y > 2.0 { break; } sum *= 2.0; }
    for (var i = 0u; i < lamps.count && sum.z < at.x; i++) { sum += at.xyxy; }
    var left = 8u;
    while left != 0u { left -= 1u; sum *= 0.5; }
    loop { if left >= 4u { break; } sum += at.yyxx; continuing { left++; } }
    loop { sum *= 0.75; continuing { left++; break if left >= 9u; } }
    return sum;
}
";

/// Counted loops cost nothing: the outputs are those without checks, byte for byte.
pub fn counted() -> Outcome {
    let package = Package::new(super::MANIFEST, COUNTED)?;
    for bounds in ["unchecked", "restrict"] {
        let run = ["gen", "--no-cache", "--bounds", bounds, "-o", bounds];
        expect(&package.run(&run)?, 0, &[])?;
    }
    for target in Target::ALL {
        let of = |out: &str| {
            let bundle = Bundle::open(package.path(out))?;
            bundle.program("one")?.shader("fs_main")?.get("default", *target)
        };
        let [unchecked, restrict] = [of("unchecked")?.bytes, of("restrict")?.bytes];
        if unchecked != restrict {
            let text = String::from_utf8_lossy(&restrict);
            return Err(format!("{target} has something for its loops:\n{text}").into());
        }
    }
    Ok(())
}

/// The functions of the library's programs with a loop that gets a counter: `pcf_grid` goes on while
/// `x <= reach`, and `reach` is what its caller gives.
const REMAINING: &[&str] = &["pcf_grid"];

/// In each value of each axis of the library's programs, all loops end by themselves, except those
/// that are listed.
pub fn library() -> Outcome {
    let (mut remaining, mut loops) = (BTreeSet::new(), 0);
    for program in PROGRAMS {
        let sources = Sources::load(program, Language::Wesl)?;
        for point in covering(&sources.space) {
            let scene = sources.scene(&point)?;
            for stage in [&scene.vertex, &scene.fragment] {
                let module = &stage.validated.module;
                for function in functions(module) {
                    let open = LoopProofs::new(module, function).open();
                    loops += open.len();
                    if open.contains(&true) {
                        remaining.insert(function.name.clone().unwrap_or_default());
                    }
                }
            }
        }
    }
    println!("{loops} loops");
    match loops > 100 && remaining.iter().eq(REMAINING) {
        true => Ok(()),
        false => Err(format!("{loops} loops; with a counter: {remaining:?}").into()),
    }
}
