//! Rewrites fragment entry points to return words: the bits of their colour, and of their inputs.

use naga::{
    Binding, EntryPoint, Expression, Function, FunctionResult, Handle, Module, ScalarKind, Span,
    Statement, StructMember, Type, TypeInner, VectorSize,
};

use lamplight_execute::kernel::{FunctionBody, KernelValue};

/// A rewritten module.
#[derive(Debug)]
pub struct Watched {
    /// The module. Its fragment entry point has the same name and returns four words at each
    /// location: the bits of the colour at location 0, then its inputs, flattened. Words after the
    /// last input are 0.
    pub module: Module,
    /// How many locations it returns.
    pub targets: u32,
}

/// The module with a fragment entry point that also returns its inputs. `None` without such an
/// entry point, or if that returns no colour at location 0.
pub fn watch_entry(module: &Module, entry: &str) -> Option<Watched> {
    let (mut module, index) = (module.clone(), find_entry(module, entry)?);
    let inner = inner_function(&mut module, index)?;
    let mut body = entry_body(&mut module, index);
    let mut components = vec![color_bits(&mut body, inner, 0)?];
    components.extend(input_words(&mut body));
    let targets = components.len() as u32;
    finish_entry(body, components, index);
    Some(Watched { module, targets })
}

/// The name of an entry point of [`inputs_module`].
pub const INPUTS_ENTRY: &str = "lamplight_inputs";

/// The module with a fragment entry point, named [`INPUTS_ENTRY`], that only returns its inputs, from
/// location 0 on. `None` without a fragment entry point, or if that has no inputs.
pub fn inputs_module(module: &Module, entry: &str) -> Option<Watched> {
    let (mut module, index) = (module.clone(), find_entry(module, entry)?);
    let mut body = entry_body(&mut module, index);
    let components = input_words(&mut body);
    let targets = components.len() as u32;
    (targets > 0).then(|| finish_entry(body, components, index))?;
    // No other declaration is left, so no writer changes the name.
    let mut entry_point = module.entry_points.swap_remove(index);
    entry_point.name = INPUTS_ENTRY.to_owned();
    (module.functions, module.global_variables) = Default::default();
    module.entry_points = vec![entry_point];
    Some(Watched { module, targets })
}

/// The module with a fragment entry point that returns, at location 0, the bits of what it returned
/// at a location. `None` as for [`watch_entry`].
pub fn bits_module(module: &Module, entry: &str, location: u32) -> Option<Module> {
    let (mut module, index) = (module.clone(), find_entry(module, entry)?);
    let inner = inner_function(&mut module, index)?;
    let mut body = entry_body(&mut module, index);
    let color = color_bits(&mut body, inner, location)?;
    finish_entry(body, vec![color], index);
    Some(module)
}

fn find_entry(module: &Module, entry: &str) -> Option<usize> {
    module
        .entry_points
        .iter()
        .position(|point| point.name == entry && point.stage == naga::ShaderStage::Fragment)
}

/// Adds a copy of the entry point to the module as a plain function.
fn inner_function(module: &mut Module, index: usize) -> Option<Handle<Function>> {
    let mut function = module.entry_points[index].function.clone();
    function.result.as_mut()?.binding = None;
    function.arguments.iter_mut().for_each(|argument| argument.binding = None);
    function.name = Some("lamplight_inner".to_owned());
    Some(module.functions.append(function, Span::UNDEFINED))
}

/// An empty body with the arguments of an entry point.
fn entry_body(module: &mut Module, index: usize) -> FunctionBody<'_> {
    let arguments = module.entry_points[index].function.arguments.clone();
    FunctionBody { module, function: Function { arguments, ..Function::default() } }
}

fn argument_values(body: &mut FunctionBody<'_>) -> Vec<KernelValue> {
    (0..body.function.arguments.len() as u32)
        .map(|index| body.add(Expression::FunctionArgument(index)))
        .collect()
}

/// The words of all arguments in groups of four. Words after the last argument are 0.
fn input_words(body: &mut FunctionBody<'_>) -> Vec<KernelValue> {
    let types: Vec<_> = body.function.arguments.iter().map(|argument| argument.ty).collect();
    let mut words = Vec::new();
    for (value, ty) in argument_values(body).into_iter().zip(types) {
        body.flatten(value, ty, &mut words);
    }
    let zero = body.literal(0);
    words.resize(words.len().next_multiple_of(4), zero);
    let ty = four_words(body);
    let four = |four: &[KernelValue]| Expression::Compose { ty, components: four.to_vec() };
    words.chunks(4).map(|words| body.add(four(words))).collect()
}

/// The bits of what the function returns at a location.
fn color_bits(
    body: &mut FunctionBody<'_>,
    inner: Handle<Function>,
    location: u32,
) -> Option<KernelValue> {
    let arguments = argument_values(body);
    let ty = body.module.functions[inner].result.as_ref()?.ty;
    let (member, ty) = match &body.module.types[ty].inner {
        TypeInner::Struct { members, .. } => {
            let at = members.iter().position(|member| is_color(body.module, member, location))?;
            (Some(at), members[at].ty)
        }
        _ => (None, ty),
    };
    let parts = color_parts(body.module, ty)?;
    let result = body.function.expressions.append(Expression::CallResult(inner), Span::UNDEFINED);
    body.function.body.push(
        Statement::Call { function: inner, arguments, result: Some(result) },
        Span::UNDEFINED,
    );
    let index = |index: usize| Expression::AccessIndex { base: result, index: index as u32 };
    let color = member.map_or(result, |member| body.add(index(member)));
    let bits = body.add(Expression::As { expr: color, kind: ScalarKind::Uint, convert: None });
    Some(if parts == 4 { bits } else { whole_color(body, bits, parts) })
}

/// How many components a colour has; `None` for what is no colour.
fn color_parts(module: &Module, ty: Handle<Type>) -> Option<u32> {
    match module.types[ty].inner {
        TypeInner::Scalar(_) => Some(1),
        TypeInner::Vector { size, .. } => Some(size as u32),
        _ => None,
    }
}

/// Four words of fewer: a single number is grey, what else is missing is 0, and alpha is 1.
fn whole_color(body: &mut FunctionBody<'_>, bits: KernelValue, parts: u32) -> KernelValue {
    let alpha = body.literal(1.0_f32.to_bits());
    let mut components: Vec<_> = match parts {
        1 => vec![bits; 3],
        _ => (0..parts).map(|index| body.component(bits, index)).collect(),
    };
    let zero = body.literal(0);
    components.resize(3, zero);
    components.push(alpha);
    let ty = four_words(body);
    body.add(Expression::Compose { ty, components })
}

/// Returns one value of four words at each location.
fn finish_entry(mut body: FunctionBody<'_>, components: Vec<KernelValue>, index: usize) {
    let four = four_words(&mut body);
    let location = |location: usize| Binding::Location {
        location: location as u32,
        interpolation: None,
        sampling: None,
        blend_src: None,
        per_primitive: false,
    };
    let member = |index: usize| StructMember {
        name: Some(format!("target_{index}")),
        ty: four,
        binding: Some(location(index)),
        offset: 16 * index as u32,
    };
    let members: Vec<_> = (0..components.len()).map(member).collect();
    let ty = body.ty(TypeInner::Struct { span: 16 * members.len() as u32, members });
    let value = body.add(Expression::Compose { ty, components });
    body.function.result = Some(FunctionResult { ty, binding: None });
    body.function.body.push(Statement::Return { value: Some(value) }, Span::UNDEFINED);
    let entry: &mut EntryPoint = &mut body.module.entry_points[index];
    entry.function = body.function;
}

fn four_words(body: &mut FunctionBody<'_>) -> Handle<Type> {
    body.vector(VectorSize::Quad, ScalarKind::Uint)
}

fn is_color(module: &Module, member: &StructMember, location: u32) -> bool {
    matches!(member.binding, Some(Binding::Location { location: found, .. }) if found == location)
        && color_parts(module, member.ty).is_some()
}
