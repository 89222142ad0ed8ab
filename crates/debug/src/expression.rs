//! Expressions in WGSL over the variables that a statement sees.
//!
//! An expression becomes a function of the text that takes the variables it names. So it may call
//! what the text declares, and its value has its bound as any other.

use std::collections::{BTreeMap, BTreeSet};

use lamplight_diagnostic::nearest_name;
use lamplight_eval::{
    Error, Executed, FunctionId, Machine, Observer, Paced, Program, Shape, SlotKind, Traced,
    Variable, VariableKind, VariablePlace,
};
use lamplight_syntax::words::has_word;

use crate::replay::Seen;
use crate::subject::Subject;
use crate::text::StatementId;
use crate::value::Value;

/// The most bytes of an expression, and of brackets in each other.
const LONGEST: usize = 2000;
const DEEPEST: usize = 48;
/// The most expressions that stay compiled.
const MOST: usize = 64;
/// The most turns of loops that a call in an expression may make.
const TURNS: u64 = 10_000;

const FUNCTION: &str = "lamplight_watch";
const RESULT: &str = "lamplight_watched";

/// An expression that is compiled for what a statement sees.
struct Expression {
    program: Program,
    function: FunctionId,
    result: Variable,
    /// The variables that it takes, by their numbers.
    takes: Vec<usize>,
    /// A run of it, which begins again for each value.
    run: Option<Paced<Traced>>,
}

/// Expressions that were compiled.
#[derive(Default)]
pub struct Expressions {
    known: BTreeMap<(String, FunctionId, Option<StatementId>), Result<Expression, String>>,
}

impl Expressions {
    /// Computes an expression in a function that is at a statement.
    ///
    /// # Errors
    /// Why it has no value, in words.
    pub fn value(
        &mut self,
        seen: &Seen<'_>,
        frame: (FunctionId, Option<StatementId>),
        text: &str,
    ) -> Result<Value, String> {
        self.compiled(seen.subject, frame, text)?.value(seen)
    }

    /// Whether a condition holds in a function that is at a statement.
    ///
    /// # Errors
    /// Why it has no value, in words.
    pub fn holds(
        &mut self,
        seen: &Seen<'_>,
        frame: (FunctionId, Option<StatementId>),
        text: &str,
    ) -> Result<bool, String> {
        self.check_condition(seen.subject, frame, text)?;
        let value = self.value(seen, frame, text)?;
        Ok(value.scalars.first().is_some_and(|one| one.word() != 0))
    }

    /// Says what is wrong with a condition, before there are values.
    ///
    /// # Errors
    /// What is wrong with it, in words.
    pub fn check_condition(
        &mut self,
        subject: &Subject,
        frame: (FunctionId, Option<StatementId>),
        text: &str,
    ) -> Result<(), String> {
        let shape = &self.compiled(subject, frame, text)?.result.shape;
        if *shape == Shape::Scalar(SlotKind::Bool) {
            return Ok(());
        }
        let found = subject.type_name(shape).unwrap_or_else(|| "a structure".to_owned());
        Err(format!(
            "`{text}` is no condition, but {found}: a condition is `bool`, such as `i == 3`"
        ))
    }

    fn compiled(
        &mut self,
        subject: &Subject,
        (function, statement): (FunctionId, Option<StatementId>),
        text: &str,
    ) -> Result<&mut Expression, String> {
        let key = (text.to_owned(), function, statement);
        if !self.known.contains_key(&key) && self.known.len() >= MOST {
            self.known.clear();
        }
        let compile = || Expression::new(subject, &subject.visible(function, statement), text);
        self.known.entry(key).or_insert_with(compile).as_mut().map_err(|words| words.clone())
    }
}

impl Expression {
    /// Compiles an expression over some of the variables of a subject.
    ///
    /// # Errors
    /// What is wrong with it, in words.
    fn new(subject: &Subject, visible: &[usize], text: &str) -> Result<Self, String> {
        refuse(text)?;
        let variables = subject.program.variables();
        let is_named = |index: &&usize| {
            let own = variables.get(**index).filter(|one| one.function.is_some());
            own.is_some_and(|one| has_word(text, &one.name))
        };
        let takes: Vec<usize> = visible.iter().filter(is_named).copied().collect();
        let source = format!("{}\n{}", subject.text(), function_text(subject, &takes, text)?);
        let wrong = |words: String| words.lines().next().unwrap_or_default().to_owned();
        let module = naga::front::wgsl::parse_str(&source).map_err(|error| {
            let words = wrong(error.message().to_owned());
            unknown(subject, visible, &words).unwrap_or(words)
        })?;
        let (flags, all) = (naga::valid::ValidationFlags::all(), naga::valid::Capabilities::all());
        let info = naga::valid::Validator::new(flags, all).validate(&module);
        let info = info.map_err(|error| wrong(innermost(error.as_inner())))?;
        let program = Program::with_names(&module, &info).map_err(|error| error.message)?;
        let function = program.function(FUNCTION).ok_or("it cannot be run")?;
        let is_result = |one: &&Variable| one.function == Some(function) && one.name == RESULT;
        let result = program.variables().iter().find(is_result).cloned();
        Ok(Self { result: result.ok_or("it has no value")?, function, takes, program, run: None })
    }

    /// Its value at a place of a run.
    ///
    /// # Errors
    /// Why it has none, in words.
    fn value(&mut self, seen: &Seen<'_>) -> Result<Value, String> {
        let variables = seen.subject.program.variables();
        let mut arguments = Vec::new();
        for variable in self.takes.iter().filter_map(|index| variables.get(*index)) {
            let slot = |index| variable.place.slot(index, seen.memory) as usize;
            let slots = (0..variable.shape.scalars()).map(slot);
            arguments.extend(slots.map(|at| seen.memory.get(at).copied().unwrap_or_default()));
        }
        self.run(seen, &arguments).map_err(|error| error.message)
    }

    fn run(&mut self, seen: &Seen<'_>, arguments: &[Traced]) -> Result<Value, Error> {
        let Self { program, function, result, takes: _, run } = self;
        let run = match run {
            Some(run) => {
                run.again(program, arguments)?;
                run
            }
            None => {
                let mut machine = Machine::<Traced>::new(program)?;
                machine.loop_limit = TURNS;
                machine.bind(seen.subject.resources().clone())?;
                run.insert(machine.pace_call(*function, arguments)?)
            }
        };
        // What the text declares reads the variables of the module as they are now.
        run.take_module(program, &seen.subject.program, seen.memory);
        run.finish(program, &mut Nobody)?;
        Ok(Value::read(&result.shape, result.place, run.memory()))
    }
}

struct Nobody;

impl Observer<Traced> for Nobody {
    fn ahead(&mut self, _: &mut Executed<'_, Traced>) -> Result<(), Error> {
        Ok(())
    }

    fn see(&mut self, _: &mut Executed<'_, Traced>) -> Result<(), Error> {
        Ok(())
    }
}

/// The function whose variable has the value of an expression.
fn function_text(subject: &Subject, takes: &[usize], text: &str) -> Result<String, String> {
    let (mut parameters, mut before) = (Vec::new(), String::new());
    for variable in takes.iter().filter_map(|index| subject.program.variables().get(*index)) {
        let name = &variable.name;
        let ty = subject.type_name(&variable.shape);
        let ty = ty.ok_or_else(|| format!("the type of `{name}` has no name in the text"))?;
        match variable.place {
            VariablePlace::At { .. } => parameters.push(format!("{name}: {ty}")),
            VariablePlace::Through { .. } => {
                parameters.push(format!("{RESULT}_{name}: {ty}"));
                before += &format!(
                    "var {RESULT}_of_{name} = {RESULT}_{name};\nlet {name} = &{RESULT}_of_{name};\n"
                );
            }
        }
    }
    before += &members_text(subject, takes, text);
    let parameters = parameters.join(", ");
    Ok(format!("fn {FUNCTION}({parameters}) {{\n{before}var {RESULT} = (\n{text}\n);\n}}\n"))
}

/// Names the members of buffers that an expression names: to authors of GLSL they are variables.
fn members_text(subject: &Subject, takes: &[usize], text: &str) -> String {
    let (variables, mut known) = (subject.program.variables(), BTreeSet::new());
    known.extend(takes.iter().filter_map(|index| variables.get(*index)).map(|one| &one.name));
    known.extend(variables.iter().filter(|one| one.function.is_none()).map(|one| &one.name));
    let mut before = String::new();
    for buffer in variables.iter().filter(|one| one.kind == VariableKind::Buffer) {
        let Shape::Struct(members) = &buffer.shape else { continue };
        for (name, _) in members {
            if has_word(text, name) && known.insert(name) {
                before += &format!("let {name} = {}.{name};\n", buffer.name);
            }
        }
    }
    before
}

/// Refuses what is no expression before naga reads it.
fn refuse(text: &str) -> Result<(), String> {
    if text.trim().is_empty() {
        return Err("there is no expression: write one in WGSL, such as `2.0 * x`".to_owned());
    }
    if text.len() > LONGEST {
        return Err(format!(
            "an expression has at most {LONGEST} bytes, and this one {}",
            text.len()
        ));
    }
    if text.contains([';', '{', '}', '@']) || text.contains("/*") || text.contains("//") {
        return Err("an expression of WGSL has no `;`, no braces and no comments".to_owned());
    }
    let (mut depth, mut deepest) = (0_usize, 0);
    for byte in text.bytes() {
        match byte {
            b'(' | b'[' | b'<' => depth += 1,
            b')' | b']' => depth = depth.saturating_sub(1),
            _ => {}
        }
        deepest = deepest.max(depth);
    }
    let signs =
        text.bytes().filter(|byte| matches!(byte, b'!' | b'-' | b'~' | b'&' | b'*')).count();
    match deepest.max(signs) > DEEPEST {
        true => Err(format!("an expression has at most {DEEPEST} brackets in each other")),
        false => Ok(()),
    }
}

/// The words for a name that naga does not know, with the nearest that is seen.
fn unknown(subject: &Subject, visible: &[usize], words: &str) -> Option<String> {
    let name = words.strip_prefix("no definition in scope for identifier: `")?.strip_suffix('`')?;
    let variables = visible.iter().filter_map(|index| subject.program.variables().get(*index));
    let functions = subject.program.functions().map(|(_, function)| function.name.as_str());
    let seen = variables.map(|variable| variable.name.as_str()).chain(functions);
    let help = nearest_name(name, seen).map(|near| format!(": did you mean `{near}`?"));
    Some(format!("nothing is named `{name}` at this line{}", help.unwrap_or_default()))
}

/// The cause of an error.
fn innermost(error: &dyn std::error::Error) -> String {
    match error.source() {
        Some(source) => innermost(source),
        None => error.to_string(),
    }
}
