//! Every bound on what comes from outside, in one table.
//!
//! A stage that loops or allocates takes its bound from here, so that every bound exists exactly
//! once. `docs/guide/limits.md` has the same table, and a test compares the two. Bounds on work
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
    /// Steps that stages took on this thread. Tests compare these counts, since times vary.
    static TAKEN: Cell<u64> = const { Cell::new(0) };
}

/// Steps that stages took on this thread so far.
pub fn steps_taken() -> u64 {
    TAKEN.get()
}

/// Counts steps of a loop that has a bound of another kind, such as one on its output.
pub fn count_steps(steps: u64) {
    TAKEN.set(TAKEN.get().wrapping_add(steps));
}

/// More steps were asked for than were left.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Exhausted;

impl Steps {
    /// A bound of `most` steps, of which none is taken.
    pub const fn new(most: u64) -> Self {
        Self { most, left: most, is_exhausted: false }
    }

    /// Takes this many steps.
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

    /// The bound, with all that was granted.
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
    NESTING: usize = 256, Count, "depth of nested brackets, blocks and conditions",
        "the stack of compilers behind the composer", "`nesting-too-deep`";
    FILES: usize = 10_000, Count, "files of one composition", "time", "`too-many-files`";
    INCLUDE_DEPTH: usize = 64, Count, "depth of nested `#include`s",
        "the stack, against endless includes", "`include-too-deep`";
    EXPANSION_BYTES: usize = 16 << 20, Bytes, "bytes of one composed text",
        "memory, against macros and includes that multiply",
        "`expansion-too-large`, `output-too-large`";
    RESOLVE_STEPS: u64 = 1 << 18, Count, "steps to resolve the names of a package", "time",
        "`limit-exceeded`";
    RESOLVE_FACTOR: u64 = 16, Count, "further such steps for each byte that was read", "time",
        "`limit-exceeded`";
    LINT_WHOLE_FILES: u64 = 1 << 14, Count,
        "files that `lint` reads, counted again for each module that reaches them", "time",
        "no error: functions that are far from a module are then read without their bodies";
    LINT_FILES: u64 = 1 << 20, Count, "files that `lint` reads after these", "time",
        "`limit-exceeded`";
    COMPILED_BYTES: usize = 4 << 20, Bytes, "bytes of a composed text that naga compiles",
        "the stack and time of naga", "`limit-exceeded`";
    COMPILED_NESTING: usize = 256, Count, "depth of nested brackets in it", "the stack of naga",
        "`limit-exceeded`";
    OPERATORS: usize = 4096, Count, "operators of one expression in it", "the stack of naga",
        "`limit-exceeded`";
    BODIES: usize = 4096, Count, "functions and structs in it",
        "time: that of naga grows with the square of their number", "`limit-exceeded`";
    DECLARATIONS: usize = 4096, Count, "variables, constants and aliases in it",
        "time: that of naga grows with the square of their number", "`limit-exceeded`";
    OVERRIDES: usize = 256, Count, "overrides in it",
        "time: that of naga grows with the square of their number", "`limit-exceeded`";
    ENTRY_POINTS: usize = 128, Count, "entry points in it",
        "time: each is compiled from the whole text", "`limit-exceeded`";
    STATEMENTS: usize = 8192, Count,
        "statements, `switch` clauses and their values in one function",
        "time: that of naga grows with the square of their number", "`limit-exceeded`";
    CONSTANT_PARTS: u64 = 1 << 16, Count,
        "subexpressions of one constant, including those of the constants it uses",
        "memory: naga copies them", "`limit-exceeded`";
    CONSTANT_USES: u64 = 1 << 20, Count,
        "subexpressions of all constants, counted again at each use", "memory: naga copies them",
        "`limit-exceeded`";
    VALUE_SCALARS: u64 = 1 << 20, Count, "scalars in all variables, constants and values of it",
        "memory: outputs initialise each with a zero", "`limit-exceeded`";
    PADDING_BYTES: u64 = 1 << 16, Bytes, "bytes of padding between the members of a structure",
        "memory: HLSL has a member for each four bytes", "`limit-exceeded`";
    TYPE_NESTING: usize = 64, Count, "depth of nested types", "the stack of naga",
        "`limit-exceeded`";
    PLACED_EXPRESSIONS: usize = 1 << 18, Count,
        "expressions of all functions that are made for the places of their pointers",
        "memory: a function is made for each place", "`limit-exceeded`";
    LINKED_BYTES: usize = 8 << 20, Bytes,
        "bytes of all functions of one text, each with the declarations that it uses",
        "time: naga reads each function with these", "no error: the text is compiled as a whole";
    CALM_PART: usize = 8, Count,
        "divisor of the limits on composed texts: a text beyond this part of one is first \
         compiled in another process", "the run, if naga would end its process", "`naga-exhausted`";
    SANDBOX_BYTES: u64 = 1 << 30, Bytes, "memory of that process", "memory", "`naga-exhausted`";
    SANDBOX_SECONDS: u64 = 5, Seconds, "processor time of that process", "time",
        "`naga-exhausted`";
    AXES: usize = 128, Count, "axes of a program, values of an axis",
        "time and memory to count permutations", "`axis-limit`";
    CONSTRAINT_NESTING: usize = 64, Count, "depth of a nested constraint", "the stack",
        "`nesting-too-deep`";
    CONSTRAINTS: usize = 4096, Count, "constraints of a program", "time", "`space-too-complex`";
    SPACE_STEPS: u64 = 1 << 22, Count, "steps to count a program's permutations", "time",
        "`space-too-complex`";
    PERMUTATIONS: usize = 1_000_000, Count, "permutations of a program", "time, disk space",
        "`too-many-permutations`";
    PACKAGES: usize = 1000, Count, "packages in `wesl.toml`", "time", "`wesl-toml`";
    MESSAGE_BYTES: u64 = 64 << 20, Bytes, "bytes of one message to the language server", "memory",
        "the message is skipped, and answered with an error";
    EDITOR_FILES: usize = 256, Count,
        "modules of a package whose diagnostics editors get while they are closed", "time",
        "no error: the language server checks only open files then, and `lint` checks all";
    WORKSPACE_FOLDERS: usize = 20_000, Count,
        "folders that the language server searches for packages that use a name", "time",
        "nothing that other packages may name is renamed";
    EDIT_STEPS: u64 = 1 << 29, Count,
        "bytes of a document that the edits of one message read or move", "time",
        "the document is closed, and the editor shows a message";
    DIAGNOSTICS: usize = 100, Count, "diagnostics that one run prints", "the reader", "`not-shown`";
    MANIFEST_BYTES: u64 = 1 << 30, Bytes, "bytes of a bundle's `manifest.json`", "memory",
        "the bundle cannot be read";
    GROUP_BYTES: usize = 16 << 20, Bytes, "bytes of one compiled shader in a bundle",
        "memory: a few compressed bytes may expand to many", "the bundle is damaged";
    BUNDLE_BYTES: u64 = 256 << 20, Bytes, "bytes of one part of a bundle, decompressed",
        "memory, time", "the bundle is damaged";
    BUNDLE_FACTOR: u64 = 512, Count, "further such bytes for each byte of its file", "memory, time",
        "the bundle is damaged";
    BUNDLE_OUTPUTS: u64 = 1 << 14, Count,
        "bytes of all outputs of a bundle for each byte of its file, where one is read at a time",
        "time", "the bundle is refused";
    BUNDLE_VALUES: u32 = 1 << 22, Count, "values in one reflection of a bundle, or in its list of programs",
        "memory, time: equal ones are stored once", "the bundle is damaged";
    BUNDLE_NESTING: u32 = 64, Count, "depth of nested values in a bundle", "the stack",
        "the bundle is damaged";
    ENVIRONMENT_BYTES: u64 = 128 << 20, Bytes, "bytes of a Radiance file", "memory",
        "has ... bytes, more than the ... that are allowed";
    ENVIRONMENT_PIXELS: u64 = 1 << 24, Count, "pixels of the image, by its header", "memory",
        "... pixels are more than ...";
    MODEL_BYTES: u64 = 256 << 20, Bytes, "bytes of a model", "memory", "... bytes are more than ...";
    MODEL_JSON_BYTES: usize = 4 << 20, Bytes, "bytes of the JSON document in it", "memory",
        "its document has more bytes than ...";
    MODEL_NODES: usize = 100_000, Count, "nodes of a model, counted at each place where they occur",
        "time", "more than ... nodes, or nesting deeper than ...";
    MODEL_NESTING: usize = 256, Count, "depth of nested nodes",
        "the stack, against cycles of nodes", "more than ... nodes, or nesting deeper than ...";
    MODEL_CORNERS: usize = 5 << 20, Count, "vertices of all triangles of a model", "memory",
        "more than ... vertices of triangles";
    MODEL_MOVED: usize = 1 << 25, Count, "vertices that morph targets and joints move, for each of these", "time",
        "move more than ... vertices";
    MODEL_TEXTURES: usize = 1024, Count, "sets of textures of a model", "time", "more than ... sets of textures";
    MODEL_PIXELS: u64 = 1 << 24, Count, "pixels of one of its images", "memory",
        "... pixels are more than ...";
    MODEL_ALL_PIXELS: u64 = 1_u64 << 32, Count, "pixels of all its images, counted each time that one is decoded",
        "time", "all images have more than ... pixels";
    CACHE_BYTES: usize = 64 << 20, Bytes, "bytes of a cache record, compressed or not", "memory",
        "no error: the record counts as missing";
    CASE_ROWS: usize = 1 << 20, Count, "inputs of the numeric cases of a file", "memory, time",
        "`case-invalid`";
    CASE_WORDS: usize = 1 << 24, Count, "scalars of those inputs, including the inputs of laws",
        "memory", "`case-invalid`";
    CASES: usize = 4096, Count, "numeric cases of a file", "time: each is compiled",
        "`case-invalid`";
    CASE_WORK: u64 = 1u64 << 31, Count,
        "steps of all cases of a file on `eval`, divided equally among the cases", "time",
        "`case-invalid`, `eval-loop-limit`";
    FORMULA_PARTS: usize = 1024, Count, "operators and operands of a formula", "the stack",
        "`case-invalid`";
    FORMULA_NESTING: usize = 100, Count, "depth of nested parentheses in a formula", "the stack",
        "`case-invalid`";
    LOOP_TRIPS: u64 = 1_000_000, Count, "iterations of all loops of one call, on `eval`",
        "time, against endless loops", "`eval-loop-limit`";
    EVAL_STEPS: u64 = 1 << 26, Count, "steps of one call, on `eval`",
        "time, against calls that multiply", "`eval-loop-limit`";
    EVAL_SLOTS: u32 = 1 << 21, Count, "scalars in memory, on `eval`", "memory", "`eval-too-large`";
}
