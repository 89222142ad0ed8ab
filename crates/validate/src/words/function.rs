//! Statements, calls and local variables of a function.

use naga::front::Typifier;
use naga::proc::ResolveContext;
use naga::valid::{CallError, FunctionError, LocalVariableError, SubgroupError};
use naga::{Block, Expression, Function, Handle, Module, Statement};

use super::{
    Sentence, bare_type, expression, foreign_words, inner_type_text, lacking_words, type_text,
};
use crate::advice::Wrong;
use lamplight_diagnostic::codes;

pub fn function_words(module: &Module, of: &Function, error: &FunctionError) -> Sentence {
    let text = match error {
        FunctionError::Expression { source, .. } => {
            return expression::expression_words(module, of, source);
        }
        FunctionError::LocalVariable { handle, name, source } => {
            return local_words(module, of, *handle, name, source);
        }
        FunctionError::InvalidArgumentType { name, .. } => {
            format!("`{name}` has a type that no function can take")
        }
        FunctionError::NonConstructibleReturnType => {
            "the result has a type that no function can return".to_owned()
        }
        FunctionError::InvalidArgumentPointerSpace { name, .. } => {
            format!("what a call passes for the pointer `{name}` has another type")
        }
        FunctionError::BreakOutsideOfLoopOrSwitch => {
            return Sentence::plain("`break` is outside of a loop or `switch`")
                .note("help: write `return` with a value to leave the function, or leave it out");
        }
        FunctionError::ContinueOutsideOfLoop => {
            return Sentence::plain("`continue` is outside of a loop")
                .note("help: write `return` to leave the function, or leave it out");
        }
        FunctionError::InvalidReturnSpot => "`return` is in a `continuing` block".to_owned(),
        FunctionError::InvalidReturnType { expression, expected_ty } => {
            return returned_words(module, of, *expression, *expected_ty);
        }
        FunctionError::InvalidIfType(condition) => {
            return condition_words(module, of, *condition);
        }
        FunctionError::InvalidSwitchType(_) => "`switch` needs an integer".to_owned(),
        FunctionError::ConflictingSwitchCase(_) => "a case occurs twice".to_owned(),
        FunctionError::ConflictingCaseType => "the cases have different types".to_owned(),
        FunctionError::MissingDefaultCase => {
            return Sentence::plain("`switch` needs a `default`")
                .note("help: write `default: {}` as its last case");
        }
        FunctionError::MultipleDefaultCases => "`switch` has several `default`s".to_owned(),
        FunctionError::LastCaseFallTrough => "the last case does not end in `break`".to_owned(),
        FunctionError::InvalidStorePointer(pointer) => {
            return read_only_words(module, of, *pointer);
        }
        FunctionError::InvalidStoreTexture { .. } => {
            "only storage textures can be written to".to_owned()
        }
        FunctionError::InvalidStoreValue { actual_ty, expected_ty, .. } => {
            let (actual, expected) =
                (inner_type_text(module, actual_ty), inner_type_text(module, expected_ty));
            return mismatch_words(format!("the texture stores {expected}, and this is {actual}"));
        }
        FunctionError::InvalidStoreTypes { pointer, value } => {
            return stored_words(module, of, *pointer, *value);
        }
        FunctionError::InvalidImageStore(error) | FunctionError::InvalidImageAtomic(error) => {
            return expression::expression_words(module, of, error);
        }
        FunctionError::InvalidCall { function, error } => {
            return call_words(module, of, *function, error);
        }
        FunctionError::MissingCapability(capabilities) => return lacking_words(*capabilities),
        FunctionError::NonUniformControlFlow(..) => {
            "control flow is not uniform here: fragments of one quad may take different branches"
                .to_owned()
        }
        FunctionError::NonUniformWorkgroupUniformLoad(_) => {
            "control flow is not uniform here: invocations of one workgroup may take different branches"
                .to_owned()
        }
        FunctionError::PipelineInputRegularFunction { name } => format!(
            "`{name}` has `@location` or `@builtin`, which only entry points' parameters have"
        ),
        FunctionError::PipelineOutputRegularFunction => {
            "the result has `@location` or `@builtin`, which only entry points' results have"
                .to_owned()
        }
        FunctionError::ExpressionAlreadyInScope(_)
        | FunctionError::WorkgroupUniformLoadExpressionMismatch(_)
        | FunctionError::WorkgroupUniformLoadInvalidPointer(_)
        | FunctionError::EmitResult(_)
        | FunctionError::UnvisitedExpression(_) => {
            "internal error in naga: its parser made a function that its validator refuses; please report it"
                .to_owned()
        }
        FunctionError::InvalidAtomic(_)
        | FunctionError::InvalidImageAtomicFunction(_)
        | FunctionError::InvalidImageAtomicValue(_) => {
            "this operation on an atomic does not exist, or its operands have other types"
                .to_owned()
        }
        FunctionError::InvalidSubgroup(error) => return subgroup_words(error),
        FunctionError::InvalidRayQueryExpression(_)
        | FunctionError::InvalidAccelerationStructure(_)
        | FunctionError::MissingAccelerationStructureVertexReturn(..)
        | FunctionError::MissingRayQueryVertexReturn(_)
        | FunctionError::InvalidRayDescriptor(_)
        | FunctionError::InvalidRayQueryType(_)
        | FunctionError::InvalidHitDistanceType(_)
        | FunctionError::InvalidPayloadType
        | FunctionError::InvalidPayloadAddressSpace(_)
        | FunctionError::MismatchedPayloadType(..)
        | FunctionError::PayloadPointerNotGlobal => return foreign_words("ray tracing"),
        FunctionError::InvalidCooperativeStoreTarget(_)
        | FunctionError::InvalidCooperativeDataPointer(_) => {
            return foreign_words("cooperative matrices");
        }
        FunctionError::InvalidMeshFunctionCall(_)
        | FunctionError::ConflictingMeshOutputTypes(..)
        | FunctionError::ConflictingTaskPayloadVariables(..)
        | FunctionError::InvalidMeshShaderOutputType(_) => {
            return foreign_words("mesh and task shaders");
        }
    };
    Sentence::plain(text)
}

pub fn mismatch_words(message: impl Into<String>) -> Sentence {
    Sentence::coded(codes::TYPE_MISMATCH, message)
}

fn returned_words(
    module: &Module,
    of: &Function,
    value: Option<Handle<Expression>>,
    expected: Option<Handle<naga::Type>>,
) -> Sentence {
    let statement = statement_span(
        &of.body,
        &|found| matches!(found, Statement::Return { value: returned } if *returned == value),
    );
    let bare = value.and_then(|value| value_type(module, of, value));
    let found = bare.as_ref().map(|found| format!("`{found}`"));
    let wrong = Wrong::Returned {
        found: bare,
        expected: expected.map(|expected| type_text(module, expected).replace('`', "")),
    };
    let sentence = match (expected.map(|expected| type_text(module, expected)), found) {
        (Some(expected), Some(found)) => {
            mismatch_words(format!("the function returns {expected}, and this is {found}"))
        }
        (Some(expected), None) if value.is_none() => {
            mismatch_words(format!("the function returns {expected}, and can end without a value"))
        }
        (Some(expected), None) => {
            mismatch_words(format!("the function returns {expected}, and this has another type"))
        }
        (None, Some(found)) => {
            mismatch_words(format!("the function returns nothing, and this is {found}"))
                .note(format!("help: write `-> {}` after its parameters", found.replace('`', "")))
        }
        (None, None) => mismatch_words("the function returns nothing"),
    };
    Sentence { statement, ..sentence.about(wrong) }
}

/// What cannot be assigned to.
fn read_only_words(module: &Module, of: &Function, pointer: Handle<Expression>) -> Sentence {
    let mut base = pointer;
    let variable = loop {
        match of.expressions[base] {
            Expression::Access { base: inner, index: _ }
            | Expression::AccessIndex { base: inner, index: _ } => base = inner,
            Expression::GlobalVariable(handle) => break &module.global_variables[handle],
            _ => return Sentence::plain("this expression is not assignable"),
        }
    };
    let name = variable.name.clone().unwrap_or_default();
    let (what, is_uniform) = match variable.space {
        naga::AddressSpace::Uniform => ("a uniform buffer, which a shader only reads", true),
        naga::AddressSpace::Storage { .. } => {
            ("a storage buffer that is declared to be read", false)
        }
        _ => return Sentence::plain(format!("`{name}` is not assignable")),
    };
    Sentence::plain(format!("`{name}` is {what}")).about(Wrong::ReadOnly { name, is_uniform })
}

/// A value of another type than what it is assigned to.
fn stored_words(
    module: &Module,
    of: &Function,
    pointer: Handle<Expression>,
    value: Handle<Expression>,
) -> Sentence {
    let expected = value_type(module, of, pointer).and_then(|pointer| {
        let inner = pointer.strip_prefix("ptr<")?.split_once(", ")?.1.strip_suffix('>')?.to_owned();
        // A pointer to a storage buffer has an access mode too.
        Some(inner.split_once(", read").map_or(inner.clone(), |(inner, _)| inner.to_owned()))
    });
    match (value_type(module, of, value), expected) {
        (Some(found), Some(expected)) => mismatch_words(format!(
            "what is assigned to is `{expected}`, and the value is `{found}`"
        ))
        .about(Wrong::Stored { found, expected }),
        _ => mismatch_words("the value does not have the type of what it is assigned to"),
    }
}

fn condition_words(module: &Module, of: &Function, condition: Handle<Expression>) -> Sentence {
    let statement = statement_span(&of.body, &|found| match found {
        Statement::If { condition: found, .. } => *found == condition,
        Statement::Loop { break_if, .. } => *break_if == Some(condition),
        _ => false,
    });
    let sentence = match value_type(module, of, condition) {
        Some(found) => mismatch_words(format!("the condition is `{found}`, and must be `bool`"))
            .about(Wrong::Condition { found }),
        None => Sentence::plain("the condition of `if` is not a `bool`"),
    };
    Sentence { statement, ..sentence }
}

/// The type of a value, as WGSL spells it.
pub fn value_type(module: &Module, of: &Function, value: Handle<Expression>) -> Option<String> {
    let mut typifier = Typifier::new();
    let context = ResolveContext::with_locals(module, &of.local_variables, &of.arguments);
    typifier.grow(value, &of.expressions, &context).ok()?;
    Some(bare_type(module, typifier.get(value, &module.types)))
}

/// Where the first statement is that satisfies `is_meant`, in the order of the text.
fn statement_span(block: &Block, is_meant: &dyn Fn(&Statement) -> bool) -> Option<naga::Span> {
    block.span_iter().find_map(|(statement, span)| {
        if is_meant(statement) {
            return Some(*span);
        }
        match statement {
            Statement::Block(block) => statement_span(block, is_meant),
            Statement::If { condition: _, accept, reject } => {
                statement_span(accept, is_meant).or_else(|| statement_span(reject, is_meant))
            }
            Statement::Switch { selector: _, cases } => {
                cases.iter().find_map(|case| statement_span(&case.body, is_meant))
            }
            Statement::Loop { body, continuing, break_if: _ } => {
                statement_span(body, is_meant).or_else(|| statement_span(continuing, is_meant))
            }
            _ => None,
        }
    })
}

fn local_words(
    module: &Module,
    of: &Function,
    handle: Handle<naga::LocalVariable>,
    name: &str,
    error: &LocalVariableError,
) -> Sentence {
    match error {
        LocalVariableError::InvalidType(handle) => {
            Sentence::plain(format!("`{name}` cannot have the type {}", type_text(module, *handle)))
        }
        LocalVariableError::InitializerType => {
            let declared = of.local_variables.iter().find(|(found, _)| *found == handle);
            let declared = declared.map_or(String::new(), |(_, variable)| {
                format!(": expected {}", type_text(module, variable.ty))
            });
            mismatch_words(format!("the initializer of `{name}` has the wrong type{declared}"))
        }
        LocalVariableError::NonConstOrOverrideInitializer => {
            Sentence::plain(format!("the initializer of `{name}` must be a constant expression"))
        }
    }
}

fn call_words(
    module: &Module,
    of: &Function,
    handle: Handle<Function>,
    error: &CallError,
) -> Sentence {
    let called = &module.functions[handle];
    let name = called.name.as_deref().unwrap_or("the function");
    let sentence = match error {
        CallError::ArgumentCount { required, seen } => {
            let message = format!("`{name}` takes {required} arguments, not {seen}");
            let sentence = Sentence::coded(codes::CALL_MISMATCH, message);
            match called.arguments.get(*seen) {
                Some(missing) => {
                    sentence.note(format!("help: `{}` is missing", parameter_text(module, missing)))
                }
                None => sentence,
            }
        }
        CallError::ArgumentType { index, required, seen_expression } => {
            argument_words(module, of, called, *index, *required, *seen_expression)
        }
        CallError::Argument { source, .. } => {
            return expression::expression_words(module, of, source);
        }
        CallError::ResultAlreadyInScope(_)
        | CallError::ResultAlreadyPopulated(_)
        | CallError::ExpressionMismatch(_) => Sentence::plain(
            "internal error in naga: its parser made a call that its validator refuses; please report it",
        ),
    };
    sentence.note(format!("declared: {}", signature_text(module, called)))
}

fn argument_words(
    module: &Module,
    of: &Function,
    called: &Function,
    at: usize,
    required: Handle<naga::Type>,
    seen: Handle<Expression>,
) -> Sentence {
    let name = called.name.as_deref().unwrap_or("the function");
    let expected = type_text(module, required);
    let found = value_type(module, of, seen);
    let seen = found
        .as_ref()
        .map_or_else(|| "has another type".to_owned(), |found| format!("is `{found}`"));
    let sentence = Sentence::coded(
        codes::CALL_MISMATCH,
        format!("argument {} of `{name}` is {expected}, and this {seen}", at + 1),
    );
    match found {
        Some(found) => sentence.about(Wrong::Argument {
            function: name.to_owned(),
            at,
            found,
            expected: expected.replace('`', ""),
        }),
        None => sentence,
    }
}

fn parameter_text(module: &Module, parameter: &naga::FunctionArgument) -> String {
    let name = parameter.name.as_deref().unwrap_or("_");
    format!("{name}: {}", type_text(module, parameter.ty).replace('`', ""))
}

/// A function as its callers see it.
fn signature_text(module: &Module, of: &Function) -> String {
    let plain = |handle| type_text(module, handle).replace('`', "");
    let arguments: Vec<String> =
        of.arguments.iter().map(|argument| parameter_text(module, argument)).collect();
    let result =
        of.result.as_ref().map_or(String::new(), |result| format!(" -> {}", plain(result.ty)));
    format!("`{}({}){result}`", of.name.as_deref().unwrap_or_default(), arguments.join(", "))
}

fn subgroup_words(error: &SubgroupError) -> Sentence {
    match error {
        SubgroupError::InvalidOperand(_)
        | SubgroupError::ResultTypeMismatch(_)
        | SubgroupError::UnsupportedOperation(_)
        | SubgroupError::UnknownOperation
        | SubgroupError::InvalidInvocationIdExprType(_) => foreign_words("subgroups"),
    }
}
