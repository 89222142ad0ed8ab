//! What is debugged: a call of a function, with everything that it reads.

use lamplight_compose::SourceMap;
use lamplight_diagnostic::source::{SourceSet, Span};
use lamplight_diagnostic::{Diagnostic, codes};
use lamplight_eval::{
    Error, Function, FunctionId, LOOP_LIMIT, Machine, Number, Observer, Paced, Program, Resources,
    Shape, SlotKind, Variable, VariableKind,
};
use lamplight_lint::{DocumentedParameter, documented_parameters};
use lamplight_syntax::words::words;

use crate::scope::Scopes;
use crate::text::{StatementId, Statements};
use crate::value::type_text;

/// A text that naga read, with the way back to its authors.
#[derive(Clone, Copy)]
pub struct SubjectText<'a> {
    /// The module of the text.
    pub module: &'a naga::Module,
    /// The text, in WGSL.
    pub text: &'a str,
    /// Leads from the text back to the authors' files.
    pub map: &'a SourceMap,
    /// The authors' files.
    pub sources: &'a SourceSet,
}

/// The arguments of a call, flattened to scalars: words as in [`Number::from_word`].
#[derive(Debug, Clone)]
pub enum Call {
    /// A function by itself.
    Alone(Vec<f32>),
    /// A fragment, by its number in a quad of four.
    Quad([Vec<f32>; 4], usize),
}

/// A call of a function that can be run again and again, each time with the same result.
pub struct Subject {
    /// The lowered module.
    pub program: Program,
    /// The statements that it runs.
    pub statements: Statements,
    scopes: Scopes,
    text: String,
    /// The structures of the text by name.
    structs: Vec<(String, Shape)>,
    function: FunctionId,
    call: Call,
    resources: Resources,
    /// How many turns all loops of a run may make.
    loop_limit: u64,
    /// What authors call functions, and where these are.
    names: Vec<FunctionName>,
    documented: Vec<DocumentedParameter>,
}

/// A function in its author's text.
#[derive(Debug, Clone, Default)]
pub struct FunctionName {
    /// Its name there.
    pub name: String,
    /// Where it is declared.
    pub span: Option<Span>,
}

impl Subject {
    /// Lowers a module for a call of one of its functions or entry points.
    ///
    /// # Errors
    /// A module that is not valid or too large, a function that does not exist or cannot be run.
    pub fn new(
        text: SubjectText<'_>,
        function: &str,
        call: Call,
        resources: Resources,
    ) -> Result<Self, Diagnostic> {
        let invalid = |message: String| Diagnostic::error(codes::EVAL_INTERNAL, message);
        let (flags, all) = (naga::valid::ValidationFlags::all(), naga::valid::Capabilities::all());
        let info = naga::valid::Validator::new(flags, all).validate(text.module);
        let info = info.map_err(|error| invalid(format!("the text is not valid: {error}")))?;
        let lowered = Program::with_names(text.module, &info);
        let program = lowered.map_err(|error| diagnosed(&error, text.map))?;
        // GLSL also has a plain function of that name. Entry points come after functions.
        let found = program.functions().filter(|(_, one)| one.name == function).last();
        let missing = || invalid(format!("there is no function `{function}`"));
        let (id, signature) = found.ok_or_else(missing)?;
        if let Some(error) = &signature.error {
            return Err(diagnosed(error, text.map));
        }
        let statements = Statements::new(&program, text.text, text.map, text.sources);
        let names = function_names(text);
        let documented = documented_parameters(text.text);
        Ok(Self {
            scopes: Scopes::new(&program, &statements, text.sources),
            text: text.text.to_owned(),
            structs: structs_of(text.module),
            statements,
            function: id,
            call,
            resources,
            loop_limit: LOOP_LIMIT,
            names,
            documented,
            program,
        })
    }

    /// The same with another limit for the turns that all loops of a run make.
    #[must_use]
    pub fn with_loop_limit(self, loop_limit: u64) -> Self {
        Self { loop_limit, ..self }
    }

    /// The function that is called.
    pub fn function(&self) -> FunctionId {
        self.function
    }

    /// The signature of the function that is called.
    pub fn signature(&self) -> Option<&Function> {
        self.program.signature(self.function)
    }

    /// How its author calls a function.
    pub fn name_of(&self, function: FunctionId) -> FunctionName {
        let name = || self.program.signature(function).map_or("", |one| &one.name).to_owned();
        self.names
            .get(function.index())
            .cloned()
            .unwrap_or_else(|| FunctionName { name: name(), span: None })
    }

    /// What documentation says of a parameter.
    pub fn documented(&self, function: FunctionId, name: &str) -> Option<&DocumentedParameter> {
        let function = &self.program.signature(function)?.name;
        self.documented.iter().find(|one| one.function == *function && one.name == name)
    }

    /// The variables of a function, with their numbers.
    pub fn variables_of(
        &self,
        function: FunctionId,
    ) -> impl Iterator<Item = (usize, &Variable)> + '_ {
        let all = self.program.variables().iter().enumerate();
        all.filter(move |(_, variable)| variable.function == Some(function))
    }

    /// The variables that a function sees where it is at a statement, by their numbers: those of the
    /// module last.
    pub fn visible(&self, function: FunctionId, statement: Option<StatementId>) -> Vec<usize> {
        self.scopes.visible(&self.program, &self.statements, function, statement)
    }

    /// The function that has a statement.
    pub fn function_of(&self, statement: StatementId) -> Option<FunctionId> {
        self.statements.first_code(statement).and_then(|pc| self.program.function_around(pc))
    }

    /// The text, in WGSL.
    pub(crate) fn text(&self) -> &str {
        &self.text
    }

    /// What the function reads.
    pub(crate) fn resources(&self) -> &Resources {
        &self.resources
    }

    /// The type of a value as the text writes it; `None` for a structure without a name.
    pub fn type_name(&self, shape: &Shape) -> Option<String> {
        match shape {
            Shape::Struct(_) => {
                self.structs.iter().find(|(_, known)| known == shape).map(|(name, _)| name.clone())
            }
            Shape::Array(count, element) => {
                Some(format!("array<{}, {count}>", self.type_name(element)?))
            }
            _ => Some(type_text(shape)),
        }
    }

    /// The variable that has the result.
    pub fn result(&self) -> Option<&Variable> {
        let mut all = self.variables_of(self.function);
        all.find(|(_, one)| one.kind == VariableKind::Result).map(|(_, one)| one)
    }

    /// Runs the call with any kind of number, watched.
    ///
    /// # Errors
    /// The evaluator's, and those of the observer.
    pub fn run<N: Number>(&self, observer: &mut dyn Observer<N>) -> Result<Ended<N>, Error> {
        self.run_changed(&|_, value| value, observer)
    }

    /// The same, with arguments that `change` gives from their number and value.
    ///
    /// # Errors
    /// Those of [`Self::run`].
    pub fn run_changed<N: Number>(
        &self,
        change: &dyn Fn(usize, N) -> N,
        observer: &mut dyn Observer<N>,
    ) -> Result<Ended<N>, Error> {
        let mut run = self.start_changed(change)?;
        run.finish(&self.program, observer)?;
        Ok(Ended { result: run.result(&self.program), is_discarded: run.is_discarded() })
    }

    /// The call before its first instruction.
    ///
    /// # Errors
    /// The evaluator's, about the function and what it reads.
    pub fn start<N: Number>(&self) -> Result<Paced<N>, Error> {
        self.start_changed(&|_, value| value)
    }

    /// What runs it, with what it reads.
    pub(crate) fn machine<N: Number>(&self, resources: Resources) -> Result<Machine<'_, N>, Error> {
        let mut machine = Machine::<N>::new(&self.program)?;
        machine.sanitize(true);
        machine.loop_limit = self.loop_limit;
        machine.bind(resources)?;
        Ok(machine)
    }

    fn start_changed<N: Number>(&self, change: &dyn Fn(usize, N) -> N) -> Result<Paced<N>, Error> {
        let machine = self.machine(self.resources.clone())?;
        let kinds = self.signature().map_or(&[][..], |signature| &signature.arguments);
        let slots = |words: &[f32]| -> Vec<N> {
            let all = argument_slots(words, kinds).into_iter().enumerate();
            all.map(|(index, value)| change(index, value)).collect()
        };
        match &self.call {
            Call::Alone(words) => machine.pace_call(self.function, &slots(words)),
            Call::Quad(words, lane) => {
                let all = words.each_ref().map(|words| slots(words));
                machine.pace_quad(self.function, all.each_ref().map(Vec::as_slice), *lane)
            }
        }
    }
}

/// The arguments of a call as numbers, from words as in [`Number::from_word`].
pub(crate) fn argument_slots<N: Number>(words: &[f32], kinds: &[SlotKind]) -> Vec<N> {
    let slot = |(word, kind): (&f32, &SlotKind)| match kind {
        SlotKind::Float => N::from_f64(f64::from(*word)),
        _ => N::from_word(word.to_bits()),
    };
    words.iter().zip(kinds).map(slot).collect()
}

fn structs_of(module: &naga::Module) -> Vec<(String, Shape)> {
    let named = |(_, ty): (naga::Handle<naga::Type>, &naga::Type)| {
        let shape = Shape::of(&module.types, &ty.inner)?;
        matches!(shape, Shape::Struct(_)).then(|| Some((ty.name.clone()?, shape)))?
    };
    module.types.iter().filter_map(named).collect()
}

/// The end of a run.
#[derive(Debug, Clone)]
pub struct Ended<N> {
    /// The flattened result.
    pub result: Vec<N>,
    /// Whether the fragment was discarded.
    pub is_discarded: bool,
}

/// An error of the evaluator at its place in the author's text.
pub fn diagnosed(error: &Error, map: &SourceMap) -> Diagnostic {
    let diagnostic = Diagnostic::error(error.code, error.message.clone());
    match error.span.to_range().and_then(|range| map.lookup(range)) {
        Some(span) => diagnostic.at(span, "here"),
        None => diagnostic,
    }
}

fn function_names(text: SubjectText<'_>) -> Vec<FunctionName> {
    let module = text.module;
    let functions = module.functions.iter().map(|(handle, function)| {
        (function.name.clone().unwrap_or_default(), module.functions.get_span(handle))
    });
    let points = module.entry_points.iter().map(|point| {
        let mut spans = point.function.body.span_iter().map(|(_, span)| *span);
        (point.name.clone(), spans.find(naga::Span::is_defined).unwrap_or_default())
    });
    let named = |(name, span): (String, naga::Span)| {
        let span = span.to_range().and_then(|range| text.map.lookup(range));
        let written = span.and_then(|span| written_name(text.sources.text(span)));
        FunctionName { name: written.unwrap_or(name), span }
    };
    let points: Vec<(String, naga::Span)> = points.collect();
    let of_point = |(name, span): (String, naga::Span)| {
        let span = span.to_range().and_then(|range| text.map.lookup(range));
        let written = span.and_then(|span| {
            let before = text.sources.get(span.source).text.get(..span.start as usize)?;
            let head = ["fn ", "void "].map(|word| before.rfind(word)).into_iter().max()??;
            written_name(&before[head..])
        });
        FunctionName { name: written.unwrap_or(name), span }
    };
    functions.map(named).chain(points.into_iter().map(of_point)).collect()
}

/// The name in the head of a function: the last word before its parameters.
fn written_name(head: &str) -> Option<String> {
    let (before, _) = head.split_once('(')?;
    // A type or `fn` comes first.
    words(before).skip(1).last().map(|name| name.text.to_owned())
}
