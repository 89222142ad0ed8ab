//! Every bound on what comes from outside, in one table.
//!
//! A stage that loops or allocates takes its bound from here, so that every bound exists exactly
//! once. `docs/guide/limits.md` has the same table, and a trial compares the two. Bounds on work
//! are counted in steps and never in seconds: the same input has the same answer on every machine.

use std::cell::Cell;

/// A bound in a form for people.
#[derive(Debug, Clone, Copy)]
pub struct Limit {
    /// What is counted.
    pub what: &'static str,
    pub value: u64,
    pub unit: Measure,
    /// What would be exhausted without it.
    pub protects: &'static str,
    /// The code or the text of the error.
    pub error: &'static str,
}

/// How a bound is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Measure {
    Count,
    Bytes,
    Seconds,
}

impl Limit {
    /// The value as a person writes it: `4 MiB`, `1,048,576`, `5 s`.
    pub fn written(&self) -> String {
        match self.unit {
            Measure::Count => with_commas(self.value),
            Measure::Seconds => format!("{} s", self.value),
            Measure::Bytes if self.value >= 1 << 30 => format!("{} GiB", self.value >> 30),
            Measure::Bytes if self.value >= 1 << 20 => format!("{} MiB", self.value >> 20),
            Measure::Bytes => format!("{} KiB", self.value >> 10),
        }
    }
}

/// With a comma between groups of three digits.
fn with_commas(number: u64) -> String {
    match number / 1000 {
        0 => number.to_string(),
        more => format!("{},{:03}", with_commas(more), number % 1000),
    }
}

/// Steps of a stage that are left of its bound.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Steps {
    most: u64,
    left: u64,
    is_exhausted: bool,
}

thread_local! {
    /// Steps that stages took on this thread, for trials: what time depends on and is not time.
    static TAKEN: Cell<u64> = const { Cell::new(0) };
}

/// Steps that stages took on this thread so far.
pub fn steps_taken() -> u64 {
    TAKEN.get()
}

/// Counts steps of a loop that has a bound of another kind, such as on what it gives.
pub fn count_steps(steps: u64) {
    TAKEN.set(TAKEN.get().wrapping_add(steps));
}

/// More steps were asked for than were left.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Exhausted;

impl Steps {
    /// None taken yet.
    pub const fn new(most: u64) -> Self {
        Self { most, left: most, is_exhausted: false }
    }

    /// Takes so many.
    ///
    /// # Errors
    /// Where fewer are left. Nothing is left afterwards.
    pub fn spend(&mut self, steps: u64) -> Result<(), Exhausted> {
        count_steps(steps);
        let left = self.left.checked_sub(steps);
        self.left = left.unwrap_or(0);
        self.is_exhausted |= left.is_none();
        left.map(|_| ()).ok_or(Exhausted)
    }

    /// Adds to the bound, as more input comes.
    pub fn grant(&mut self, steps: u64) {
        self.most = self.most.saturating_add(steps);
        if !self.is_exhausted {
            self.left = self.left.saturating_add(steps);
        }
    }

    /// Whether more were asked for than there were.
    pub fn is_exhausted(self) -> bool {
        self.is_exhausted
    }

    /// Steps that there were.
    pub fn most(self) -> u64 {
        self.most
    }

    /// Steps taken so far.
    pub fn taken(self) -> u64 {
        self.most - self.left
    }
}

macro_rules! limits {
    ($($name:ident: $type:ty = $value:expr, $unit:ident, $what:literal, $protects:literal, $error:literal;)*) => {
        $(#[doc = concat!("Most: ", $what, ".")] pub const $name: $type = $value;)*

        /// The table, in the order of the stages.
        pub const ALL: &[Limit] = &[$(Limit {
            what: $what,
            value: $value as u64,
            unit: Measure::$unit,
            protects: $protects,
            error: $error,
        }),*];
    };
}

limits! {
    FILE_BYTES: usize = 4 << 20, Bytes, "bytes of one file", "memory", "`file-too-large`";
    FILE_TOKENS: usize = 1 << 20, Count, "tokens of one file", "memory, time", "`too-many-tokens`";
    NESTING: usize = 256, Count, "brackets, blocks and conditions within each other",
        "the stack of compilers behind the composer", "`nesting-too-deep`";
    FILES: usize = 10_000, Count, "files of one composition", "time", "`too-many-files`";
    INCLUDE_DEPTH: usize = 64, Count, "files open at once by `#include`", "includes without end",
        "`include-too-deep`";
    EXPANSION_BYTES: usize = 16 << 20, Bytes, "bytes of one composed text",
        "macros and includes that multiply", "`expansion-too-large`, `output-too-large`";
    LINK_STEPS: u64 = 1 << 18, Count,
        "steps to find what the names of a package mean", "time",
        "`limit-exceeded`";
    LINK_FACTOR: u64 = 16, Count, "such steps more for each byte that was read", "time",
        "`limit-exceeded`";
    COMPILED_BYTES: usize = 4 << 20, Bytes, "bytes of a composed text that is compiled",
        "the stack and time of naga", "`limit-exceeded`";
    COMPILED_NESTING: usize = 256, Count, "brackets in it", "the stack of naga", "`limit-exceeded`";
    OPERATORS: usize = 4096, Count, "operators of one expression in it", "the stack of naga",
        "`limit-exceeded`";
    BODIES: usize = 4096, Count, "functions and structs in it",
        "time: naga's grows with their square", "`limit-exceeded`";
    DECLARATIONS: usize = 4096, Count, "variables, constants and aliases in it",
        "time: naga's grows with their square", "`limit-exceeded`";
    OVERRIDES: usize = 256, Count, "overrides in it", "time: naga's grows with their square",
        "`limit-exceeded`";
    ENTRY_POINTS: usize = 128, Count, "entry points in it", "time: each is compiled from all of it",
        "`limit-exceeded`";
    STATEMENTS: usize = 8192, Count, "statements, cases and their values of one function in it",
        "time: naga's grows with their square", "`limit-exceeded`";
    CONSTANT_PARTS: u64 = 1 << 16, Count, "parts of one constant, those that it names included",
        "memory: naga copies them", "`limit-exceeded`";
    CONSTANT_USES: u64 = 1 << 20, Count, "parts of constants, counted where they are named",
        "memory: naga copies them", "`limit-exceeded`";
    VALUE_SCALARS: u64 = 1 << 20, Count, "scalars of variables, constants and values in it",
        "memory: a zero is written for each", "`limit-exceeded`";
    PADDING_BYTES: u64 = 1 << 16, Bytes, "bytes between the members of a structure",
        "memory: HLSL has a member for each four", "`limit-exceeded`";
    TYPE_NESTING: usize = 64, Count, "types within each other", "the stack of naga",
        "`limit-exceeded`";
    LINKED_BYTES: usize = 8 << 20, Bytes,
        "bytes of functions with all that they name, of one text that is put together from them",
        "time: naga reads each", "compiled as a whole";
    CALM_PART: usize = 8, Count,
        "part of a bound on composed texts, beyond which another process tries them first",
        "the process, where others' code would end it", "`naga-exhausted`";
    REHEARSAL_BYTES: u64 = 1 << 30, Bytes, "memory of that process", "memory",
        "`naga-exhausted`";
    REHEARSAL_SECONDS: u64 = 5, Seconds, "its time on a processor", "time", "`naga-exhausted`";
    AXES: usize = 128, Count, "axes of a program, values of an axis",
        "counting a space of permutations at once", "`axis-limit`";
    CONSTRAINT_NESTING: usize = 64, Count, "levels of a constraint", "the stack",
        "`nesting-too-deep`";
    CONSTRAINTS: usize = 4096, Count, "constraints of a program", "time", "`space-too-complex`";
    SPACE_STEPS: u64 = 1 << 22, Count, "steps to count a program's permutations", "time",
        "`space-too-complex`";
    PERMUTATIONS: usize = 1_000_000, Count, "permutations of a program", "time, and your disk",
        "`too-many-permutations`";
    PACKAGES: usize = 1000, Count, "packages in `wesl.toml`", "time", "`wesl-toml`";
    MESSAGE_BYTES: u64 = 64 << 20, Bytes, "bytes of one message to the language server", "memory",
        "skipped, and answered with an error";
    EDIT_STEPS: u64 = 1 << 29, Count,
        "bytes of a document that the edits of one message read and move", "time",
        "the document is closed, and its user is told";
    DIAGNOSTICS: usize = 100, Count, "diagnostics of one run", "your eyes", "`not-shown`";
    MANIFEST_BYTES: u64 = 1 << 30, Bytes, "bytes of a bundle's `manifest.json`", "memory",
        "the bundle cannot be read";
    GROUP_BYTES: usize = 16 << 20, Bytes, "bytes of one compiled shader in a bundle",
        "memory: what a few compressed bytes can become", "the bundle is damaged";
    BUNDLE_BYTES: u64 = 256 << 20, Bytes, "bytes that a part of a bundle holds",
        "memory, time", "the bundle is damaged";
    BUNDLE_FACTOR: u64 = 128, Count, "bytes more for each byte of its file", "memory, time",
        "the bundle is damaged";
    ENVIRONMENT_BYTES: u64 = 128 << 20, Bytes, "bytes of a Radiance file", "memory",
        "has more bytes than are allowed";
    ENVIRONMENT_PIXELS: u64 = 1 << 24, Count, "pixels that its header may name", "memory",
        "pixels are more than";
    MODEL_BYTES: u64 = 256 << 20, Bytes, "bytes of a model", "memory", "bytes are more than";
    MODEL_JSON_BYTES: usize = 4 << 20, Bytes, "bytes of the document in it", "memory",
        "has more bytes than";
    MODEL_NODES: usize = 100_000, Count, "nodes of a model, each where it is placed", "time",
        "more nodes than";
    MODEL_NESTING: usize = 256, Count, "nodes within each other", "nodes without end",
        "within each other";
    MODEL_CORNERS: usize = 1 << 20, Count, "corners of all triangles of a model", "memory",
        "corners";
    MODEL_TEXTURES: usize = 64, Count, "sets of textures of a model", "time",
        "sets of textures";
    MODEL_PIXELS: u64 = 1 << 24, Count, "pixels of one of its images", "memory",
        "pixels are more than";
    CACHE_BYTES: usize = 64 << 20, Bytes, "bytes of a cache record, packed or not", "memory",
        "taken as absent";
    CASE_ROWS: usize = 1 << 20, Count, "inputs of the numeric cases of a file", "memory, time",
        "`case-invalid`";
    CASE_WORDS: usize = 1 << 24, Count, "scalars of those inputs, each law's included",
        "memory",
        "`case-invalid`";
    CASES: usize = 4096, Count, "numeric cases of a file", "time: each is compiled",
        "`case-invalid`";
    CASE_WORK: u64 = 1u64 << 31, Count,
        "steps of all cases of a file, on `eval`: each may take its part of them", "time",
        "`case-invalid`, `eval-loop-limit`";
    FORMULA_PARTS: usize = 1024, Count, "signs and operands of a formula", "the stack",
        "`case-invalid`";
    FORMULA_NESTING: usize = 100, Count, "parentheses of a formula", "the stack", "`case-invalid`";
    LOOP_TRIPS: u64 = 1_000_000, Count, "rounds of all loops of one call, on `eval`",
        "loops without end", "`eval-loop-limit`";
    EVAL_STEPS: u64 = 1 << 26, Count, "steps of one call, on `eval`", "calls that multiply",
        "`eval-loop-limit`";
    EVAL_SLOTS: u32 = 1 << 21, Count, "scalars in memory, on `eval`", "memory", "`eval-too-large`";
}
