//! Every bound on what comes from outside, in one table.
//!
//! A stage that loops or allocates takes its bound from here, so that every bound exists exactly
//! once. `docs/guide/limits.md` has the same table, and a trial compares the two. Bounds on work
//! are counted in steps and never in seconds: the same input has the same answer on every machine.

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
            Measure::Count => thousands(self.value),
            Measure::Seconds => format!("{} s", self.value),
            Measure::Bytes if self.value >= 1 << 30 => format!("{} GiB", self.value >> 30),
            Measure::Bytes if self.value >= 1 << 20 => format!("{} MiB", self.value >> 20),
            Measure::Bytes => format!("{} KiB", self.value >> 10),
        }
    }
}

/// With a comma between groups of three digits.
fn thousands(number: u64) -> String {
    match number / 1000 {
        0 => number.to_string(),
        more => format!("{},{:03}", thousands(more), number % 1000),
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
    SPACE_STEPS: usize = 1 << 22, Count, "steps to count a program's permutations", "time",
        "`space-too-complex`";
    PERMUTATIONS: usize = 1_000_000, Count, "permutations of a program", "time, and your disk",
        "`too-many-permutations`";
    PACKAGES: usize = 1000, Count, "packages in `wesl.toml`", "time", "`wesl-toml`";
    MESSAGE_BYTES: u64 = 64 << 20, Bytes, "bytes of one message to the language server", "memory",
        "skipped, and answered with an error";
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
    CASE_ROWS: usize = 1 << 20, Count, "inputs of a numeric case", "memory, time",
        "`case-invalid`";
    CASE_WORDS: usize = 1 << 24, Count, "scalars of all inputs of a numeric case", "memory",
        "`case-invalid`";
    FORMULA_PARTS: usize = 1024, Count, "signs and operands of a formula", "the stack",
        "`case-invalid`";
    FORMULA_NESTING: usize = 100, Count, "parentheses of a formula", "the stack", "`case-invalid`";
    LOOP_TRIPS: u64 = 1_000_000, Count, "rounds of all loops of one call, on `eval`",
        "loops without end", "`eval-loop-limit`";
    EVAL_STEPS: u64 = 1 << 26, Count, "steps of one call, on `eval`", "calls that multiply",
        "`eval-loop-limit`";
    EVAL_SLOTS: u32 = 1 << 21, Count, "scalars in memory, on `eval`", "memory", "`eval-too-large`";
}
