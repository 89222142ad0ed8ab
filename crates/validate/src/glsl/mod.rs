//! GLSL as naga reads it: refuses the valid GLSL that naga's front end would translate to something
//! else, and repairs what it reads almost rightly.
//!
//! The checks look at tokens, before naga reads the text. They know no types. So they are coarse
//! where an exact answer would need a front end of our own.

mod construct;
mod declared;
mod effects;
mod repair;
mod statements;
mod tokens;

use std::ops::Range;

use naga::front::glsl::{Frontend, Options, ParseErrors};
use naga::valid::ModuleInfo;
use naga::{Block, Expression, Handle, Module, ScalarKind, ShaderStage, Statement, TypeInner};

use construct::Construct;
use declared::FileScope;
use effects::{Effects, FunctionLocals};
use lamplight_bundle::{Language, Stage};
use lamplight_compose::Composed;
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use statements::StatementWalk;
use tokens::Tokens;

/// What was found, with the places in the text.
#[derive(Default)]
pub struct Found {
    list: Vec<(&'static Construct, Range<usize>)>,
}

impl Found {
    fn add(&mut self, construct: &'static Construct, place: Range<usize>) {
        self.list.push((construct, place));
    }

    /// The errors, in the order of the text.
    fn errors(mut self, composed: &Composed) -> Result<(), Diagnostics> {
        self.list.sort_by_key(|(_, place)| place.start);
        let error = |(construct, place): (&'static Construct, Range<usize>)| {
            let error = Diagnostic::error(codes::GLSL_NOT_TRANSLATED, construct.message);
            let place = composed.map.lookup(place);
            let error =
                place.into_iter().fold(error, |error, span| error.at(span, construct.label));
            error.note(format!("help: {}", construct.help))
        };
        let errors: Diagnostics = self.list.into_iter().map(error).collect();
        if errors.is_empty() { Ok(()) } else { Err(errors) }
    }
}

/// Refuses what naga would read in another way. A text of another language passes.
///
/// # Errors
/// `glsl-not-translated` for each place.
pub fn check_glsl(composed: &Composed) -> Result<(), Diagnostics> {
    if composed.language != Language::Glsl {
        return Ok(());
    }
    let Some(tokens) = Tokens::read(&composed.text) else { return Ok(()) };
    let mut found = Found::default();
    let has_stage_inputs = composed.stage != Some(Stage::Compute);
    let mut scope = FileScope::read(&tokens, has_stage_inputs, &mut found);
    let functions = std::mem::take(&mut scope.functions);
    let locals = |function| {
        let locals = StatementWalk::run(&tokens, &mut scope, function, &mut found);
        FunctionLocals { function, locals }
    };
    let functions: Vec<FunctionLocals<'_, '_>> = functions.iter().map(locals).collect();
    let effects = Effects::of(&tokens, &functions);
    for one in &functions {
        effects.check(one.function.body.clone(), &mut found);
    }
    found.errors(composed)
}

/// Reads a GLSL text, and repairs the module.
pub fn parse_glsl(stage: ShaderStage, text: &str) -> Result<Module, ParseErrors> {
    let mut module = Frontend::default().parse(&Options::from(stage), text)?;
    repair::repair_module(&mut module);
    Ok(module)
}

/// Refuses a global variable whose initial value naga dropped, since it is not a constant to naga.
///
/// # Errors
/// `glsl-not-translated` for each.
pub fn check_initial_values(composed: &Composed, module: &Module) -> Result<(), Diagnostics> {
    let Some(tokens) = Tokens::read(&composed.text) else { return Ok(()) };
    let scope = FileScope::read(&tokens, false, &mut Found::default());
    let mut found = Found::default();
    for variable in scope.initialised {
        let is_dropped = module.global_variables.iter().any(|(_, global)| {
            global.name.as_deref() == Some(variable.name) && global.init.is_none()
        });
        if let Some(value) = variable.value.filter(|_| is_dropped) {
            found.add(&construct::INITIAL_VALUE, tokens.bytes(value.start, value.end - 1));
        }
    }
    found.errors(composed)
}

/// Refuses a `switch` over a vector, which naga's validator accepts.
///
/// # Errors
/// `glsl-not-translated` for each.
pub fn check_switches(
    composed: &Composed,
    module: &Module,
    info: &ModuleInfo,
) -> Result<(), Diagnostics> {
    let mut found = Found::default();
    let functions = module.functions.iter().map(|(handle, one)| (one, &info[handle]));
    let points = module.entry_points.iter().enumerate();
    let points = points.map(|(index, point)| (&point.function, info.get_entry_point(index)));
    for (function, info) in functions.chain(points) {
        let is_integer = |selector: Handle<Expression>| {
            let ty = info[selector].ty.inner_with(&module.types);
            let TypeInner::Scalar(scalar) = ty else { return false };
            matches!(scalar.kind, ScalarKind::Sint | ScalarKind::Uint)
        };
        refuse_switches(&function.body, &is_integer, &mut found);
    }
    found.errors(composed)
}

fn refuse_switches(
    block: &Block,
    is_integer: &dyn Fn(Handle<Expression>) -> bool,
    found: &mut Found,
) {
    for (statement, span) in block.span_iter() {
        match statement {
            Statement::Block(inner) => refuse_switches(inner, is_integer, found),
            Statement::If { condition: _, accept, reject } => {
                refuse_switches(accept, is_integer, found);
                refuse_switches(reject, is_integer, found);
            }
            Statement::Loop { body, continuing, break_if: _ } => {
                refuse_switches(body, is_integer, found);
                refuse_switches(continuing, is_integer, found);
            }
            Statement::Switch { selector, cases } => {
                if !is_integer(*selector) {
                    found.add(&construct::SWITCH_VECTOR, span.to_range().unwrap_or(0..0));
                }
                cases.iter().for_each(|case| refuse_switches(&case.body, is_integer, found));
            }
            _ => {}
        }
    }
}
