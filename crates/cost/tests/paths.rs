//! Ranges of random machine code, beside every path through it. The paths are those of a machine
//! that runs the text line by line, and tries both ways where a branch depends on what is not known.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use lamplight_cost::machine::{Counting, Rates, Unit, count_machine};
use libtest_mimic::{Failed, Trial};

type Outcome = Result<(), Failed>;

pub fn tests() -> Vec<Trial> {
    vec![Trial::test("paths::as_all_paths", as_all_paths)]
}

/// Numbers after Marsaglia, "Xorshift RNGs".
struct Random(u64);

impl Random {
    fn below(&mut self, count: u64) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) % count
    }
}

/// Writes a text with nested conditions and loops.
struct Writer {
    random: Random,
    text: String,
    labels: usize,
    registers: usize,
    /// The label behind each loop around, for a jump out of it.
    behind: Vec<usize>,
}

impl Writer {
    fn label(&mut self) -> usize {
        self.labels += 1;
        self.labels
    }

    fn line(&mut self, line: &str) {
        let _ = writeln!(self.text, "\t{line}");
    }

    fn place(&mut self, label: usize) {
        let _ = writeln!(self.text, "BB{label}:");
    }

    /// A condition that nothing tells.
    fn unknown_flag(&mut self) {
        self.line("s_bitcmp1_b32 s99, 0");
    }

    fn work(&mut self) {
        for _ in 0..self.random.below(4) {
            let line = match self.random.below(5) {
                0 => "v_rcp_f32_e32 v0, v0",
                1 => "s_lshl_b32 s98, s98, 1",
                2 => "image_sample_lz v1, [v0, v4], s[8:15], s[4:7] dmask:0x1",
                _ => "v_add_f32_e32 v0, v0, v0",
            };
            self.line(line);
        }
    }

    fn statement(&mut self, depth: u64) {
        self.work();
        if depth == 0 {
            return;
        }
        match self.random.below(6) {
            0 => self.uniform_if(depth - 1),
            1 | 2 => self.divergent_if(depth - 1),
            3 | 4 => self.counted_loop(depth - 1),
            _ => self.jump_out(),
        }
        self.work();
    }

    fn uniform_if(&mut self, depth: u64) {
        let (other, end) = (self.label(), self.label());
        self.unknown_flag();
        self.line(&format!("s_cbranch_scc{} BB{other}", self.random.0 % 2));
        self.statement(depth);
        self.line(&format!("s_branch BB{end}"));
        self.place(other);
        self.statement(depth);
        self.place(end);
    }

    /// Each side may have a branch around it, as the compiler leaves it where a side is short.
    fn divergent_if(&mut self, depth: u64) {
        let (swap, end) = (self.label(), self.label());
        let mask = 40 + 2 * depth;
        self.line(&format!("s_and_saveexec_b64 s[{mask}:{}], vcc", mask + 1));
        if self.random.below(3) > 0 {
            self.line(&format!("s_cbranch_execz BB{swap}"));
        }
        self.statement(depth);
        self.place(swap);
        if self.random.below(3) > 0 {
            self.line(&format!("s_andn2_b64 exec, s[{mask}:{}], exec", mask + 1));
            if self.random.below(3) > 0 {
                self.line(&format!("s_cbranch_execz BB{end}"));
            }
            self.statement(depth);
        }
        self.place(end);
        self.line(&format!("s_mov_b64 exec, s[{mask}:{}]", mask + 1));
    }

    /// A loop whose counter is tested at its head or at its end, with a limit that is a constant or
    /// at most one.
    fn counted_loop(&mut self, depth: u64) {
        let (head, end) = (self.label(), self.label());
        let (counter, bound) = (self.registers, self.registers + 1);
        self.registers += 2;
        let limit = self.random.below(3);
        self.line(&format!("s_mov_b32 s{counter}, {}", self.random.0 % 2));
        let limit = match self.random.below(2) {
            0 => format!("{limit}"),
            _ => {
                self.line(&format!("s_min_u32 s{bound}, s97, {limit}"));
                format!("s{bound}")
            }
        };
        let is_first = self.random.below(2) == 0;
        self.behind.push(end);
        self.place(head);
        let test = format!("s_cmp_ge_u32 s{counter}, {limit}");
        let step = format!("s_add_u32 s{counter}, s{counter}, 1");
        if is_first {
            self.line(&test);
            self.line(&format!("s_cbranch_scc1 BB{end}"));
        }
        self.statement(depth);
        self.line(&step);
        match is_first {
            true => self.line(&format!("s_branch BB{head}")),
            false => {
                self.line(&test);
                self.line(&format!("s_cbranch_scc0 BB{head}"));
            }
        }
        self.place(end);
        self.behind.pop();
    }

    /// Out of the innermost loop, if a condition holds that nothing tells.
    fn jump_out(&mut self) {
        if let Some(behind) = self.behind.last().copied() {
            self.unknown_flag();
            self.line(&format!("s_cbranch_scc1 BB{behind}"));
        }
    }
}

fn random_text(seed: u64) -> String {
    let random = Random(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
    let mut writer =
        Writer { random, text: "BB0:\n".to_owned(), labels: 0, registers: 0, behind: Vec::new() };
    let depth = 1 + writer.random.below(3);
    writer.statement(depth);
    writer.statement(depth);
    writer.line("s_endpgm");
    writer.text
}

/// A run that is not complete.
#[derive(Clone)]
struct Run {
    at: usize,
    registers: BTreeMap<String, u64>,
    flag: Option<bool>,
    /// Whether the side of an `if` that runs now has been entered by a wave that skipped the other.
    skipped: bool,
    sums: [i64; 3],
}

/// Too many paths to try them all.
struct TooMany;

/// Every path's cycles: of vector instructions, of textures, and of scalar instructions.
fn all_paths(text: &str) -> Result<Vec<[i64; 3]>, TooMany> {
    let lines: Vec<&str> = text.lines().collect();
    let place = |label: &str| lines.iter().position(|line| line.strip_suffix(':') == Some(label));
    let start = Run { at: 0, registers: BTreeMap::new(), flag: None, skipped: false, sums: [0; 3] };
    let (mut open, mut ends, mut steps) = (vec![start], Vec::new(), 0);
    while let Some(mut run) = open.pop() {
        steps += 1;
        if steps > 400_000 {
            return Err(TooMany);
        }
        let line = lines.get(run.at).copied().unwrap_or("s_endpgm").trim();
        run.at += 1;
        let (name, rest) = line.split_once(' ').unwrap_or((line, ""));
        let operands: Vec<&str> = rest.split(", ").collect();
        match name {
            "s_endpgm" => ends.push(run.sums),
            "s_branch" => {
                run.sums[2] += 1;
                run.at = place(operands[0]).unwrap_or(lines.len());
                run.skipped = false;
                open.push(run);
            }
            "s_cbranch_scc0" | "s_cbranch_scc1" | "s_cbranch_execz" => {
                run.sums[2] += 1;
                let target = place(operands[0]).unwrap_or(lines.len());
                open.extend(branch(run, name, target, &lines));
            }
            _ => {
                open.extend(execute(run, name, &operands));
            }
        }
    }
    Ok(ends)
}

/// Both ways of a branch, or the one that is known.
fn branch(run: Run, name: &str, target: usize, lines: &[&str]) -> Vec<Run> {
    let wanted = match name {
        "s_cbranch_scc0" => run.flag.map(|flag| !flag),
        "s_cbranch_scc1" => run.flag,
        // A wave that skipped the first side takes the second.
        _ if run.skipped => Some(false),
        _ => None,
    };
    let is_mask = name == "s_cbranch_execz";
    let is_swap = lines.get(target + 1).is_some_and(|line| line.contains("s_andn2_b64 exec"));
    let taken = Run { at: target, skipped: is_mask && is_swap, ..run.clone() };
    let on = Run { skipped: false, ..run };
    match wanted {
        Some(true) => vec![taken],
        Some(false) => vec![on],
        None => vec![taken, on],
    }
}

/// What an instruction does with the registers; each value of one that is not known.
fn execute(mut run: Run, name: &str, operands: &[&str]) -> Vec<Run> {
    let value = |run: &Run, operand: &str| {
        operand.parse::<u64>().ok().or_else(|| run.registers.get(operand).copied())
    };
    match name {
        _ if name.starts_with("v_rcp") => run.sums[0] += 4,
        _ if name.starts_with("v_") => run.sums[0] += 1,
        _ if name.starts_with("image_") => run.sums[1] += 1,
        _ if name.starts_with("s_") => run.sums[2] += 1,
        _ => {}
    }
    match name {
        "s_and_saveexec_b64" => run.skipped = false,
        "s_mov_b64" => run.skipped = false,
        "s_bitcmp1_b32" => run.flag = None,
        "s_mov_b32" => {
            let first = value(&run, operands[1]).unwrap_or_default();
            run.registers.insert(operands[0].to_owned(), first);
        }
        "s_add_u32" => {
            let sum = value(&run, operands[1]).unwrap_or_default() + 1;
            run.registers.insert(operands[0].to_owned(), sum);
        }
        "s_cmp_ge_u32" => {
            let [left, right] = [0, 1].map(|index| value(&run, operands[index]));
            run.flag = left.zip(right).map(|(left, right)| left >= right);
        }
        "s_min_u32" => {
            let most = value(&run, operands[2]).unwrap_or_default();
            let each = (0..=most).map(|limit| {
                let mut run = run.clone();
                run.registers.insert(operands[0].to_owned(), limit);
                run
            });
            return each.collect();
        }
        _ => {}
    }
    vec![run]
}

/// The range is that of all paths, in texts that have not too many of them.
fn as_all_paths() -> Outcome {
    let (mut compared, mut with_loops) = (0, 0);
    for seed in 1..=3000 {
        let text = random_text(seed);
        let Ok(paths) = all_paths(&text) else { continue };
        let rates = Rates::RDNA;
        let found = count_machine(&text, Counting { rates, wave: 64, iterations: &[] });
        let found = found.map_err(|error| format!("seed {seed}: {error}\n{text}"))?;
        for (index, unit) in [Unit::Cycles, Unit::Texture, Unit::Scalar].into_iter().enumerate() {
            let sums = || paths.iter().map(|sums| sums[index]);
            let wanted = (sums().min().unwrap_or(0), sums().max().unwrap_or(0));
            let range = (found.least.of(unit), found.most.of(unit));
            if range != wanted {
                let what = format!("{unit:?}: counted {range:?}, all paths have {wanted:?}");
                return Err(format!("seed {seed}: {what}\n{text}\n{found:?}").into());
            }
        }
        compared += 1;
        with_loops += usize::from(!found.loops.is_empty());
    }
    match compared > 1500 && with_loops > 500 {
        true => Ok(()),
        false => Err(format!("only {compared} texts, {with_loops} of them with loops").into()),
    }
}
