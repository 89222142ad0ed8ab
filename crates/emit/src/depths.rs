//! Depth textures that nothing compares with, in GLSL. naga declares each depth texture as one for
//! comparisons, which GLSL neither samples otherwise nor loads from. Here those that are never compared
//! are textures of floats, whose first component is the depth.

use std::collections::BTreeSet;

use naga::valid::ModuleInfo;
use naga::{
    Arena, Block, Expression, Function, GlobalVariable, Handle, ImageClass, Module, SampleLevel,
    ScalarKind, Span, Statement, Type, TypeInner,
};

use super::rebuild::rebuild;
use lamplight_validate::{info_unchecked, inner_blocks};

/// Where a texture comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Root {
    Global(Handle<GlobalVariable>),
    /// A parameter of a function.
    Parameter(Handle<Function>, u32),
}

/// The module with textures of floats, and naga's analysis of it; `None` where it has no depth texture
/// that is never compared.
///
/// # Errors
/// The message of naga, if it refuses the new module.
pub fn as_floats(module: &Module) -> Result<Option<(Module, ModuleInfo)>, String> {
    let globals = module.global_variables.iter().map(|(handle, _)| Root::Global(handle));
    let mut depths = globals.filter(|root| is_depth(module, *root)).peekable();
    if depths.peek().is_none() {
        return Ok(None);
    }
    let compared = compared_roots(module);
    let is_plain = |root: Root| is_depth(module, root) && !compared.contains(&root);
    if !depths.any(is_plain) {
        return Ok(None);
    }
    let mut changed = module.clone();
    for (handle, variable) in changed.global_variables.iter_mut() {
        if is_plain(Root::Global(handle)) {
            variable.ty = float_type(&mut changed.types, variable.ty);
        }
    }
    for (handle, function) in changed.functions.iter_mut() {
        for (index, argument) in function.arguments.iter_mut().enumerate() {
            if is_plain(Root::Parameter(handle, index as u32)) {
                argument.ty = float_type(&mut changed.types, argument.ty);
            }
        }
        take_depths(function, &|image| root_of(image, Some(handle)).is_some_and(is_plain));
    }
    for point in &mut changed.entry_points {
        take_depths(&mut point.function, &|image| root_of(image, None).is_some_and(is_plain));
    }
    let info = info_unchecked(&changed)
        .map_err(|error| format!("a module with other textures is not valid: {error}"))?;
    Ok(Some((changed, info)))
}

fn float_type(types: &mut naga::UniqueArena<Type>, ty: Handle<Type>) -> Handle<Type> {
    let TypeInner::Image { dim, arrayed, class: ImageClass::Depth { multi } } = types[ty].inner
    else {
        return ty;
    };
    let class = ImageClass::Sampled { kind: ScalarKind::Float, multi };
    types.insert(
        Type { name: None, inner: TypeInner::Image { dim, arrayed, class } },
        Span::UNDEFINED,
    )
}

/// Takes the first component of what is read from some textures.
fn take_depths(function: &mut Function, is_plain: &dyn Fn(&Expression) -> bool) {
    let plain: BTreeSet<Handle<Expression>> =
        function.expressions.iter().filter(|(_, one)| is_plain(one)).map(|(at, _)| at).collect();
    let read: BTreeSet<Handle<Expression>> = function
        .expressions
        .iter()
        .filter(|(_, one)| read_image(one).is_some_and(|image| plain.contains(&image)))
        .map(|(at, _)| at)
        .collect();
    if read.is_empty() {
        return;
    }
    let mut write = |old, expression, span, expressions: &mut Arena<Expression>| {
        if !read.contains(&old) {
            return expressions.append(expression, span);
        }
        let expression = with_float_level(expression, span, expressions);
        let is_gathered = matches!(expression, Expression::ImageSample { gather: Some(_), .. });
        let base = expressions.append(expression, span);
        match is_gathered {
            true => base,
            false => expressions.append(Expression::AccessIndex { base, index: 0 }, span),
        }
    };
    rebuild(function, &mut write);
}

/// The texture that an expression reads texels of.
fn read_image(expression: &Expression) -> Option<Handle<Expression>> {
    match expression {
        Expression::ImageSample { image, .. } | Expression::ImageLoad { image, .. } => Some(*image),
        _ => None,
    }
}

/// Levels of depth textures are integers, and those of others are floats.
fn with_float_level(
    mut expression: Expression,
    span: Span,
    expressions: &mut Arena<Expression>,
) -> Expression {
    if let Expression::ImageSample { level: SampleLevel::Exact(level), .. } = &mut expression {
        let float = Expression::As { expr: *level, kind: ScalarKind::Float, convert: Some(4) };
        *level = expressions.append(float, span);
    }
    expression
}

fn is_depth(module: &Module, root: Root) -> bool {
    let ty = match root {
        Root::Global(handle) => module.global_variables[handle].ty,
        Root::Parameter(function, index) => module.functions[function].arguments[index as usize].ty,
    };
    matches!(
        module.types[ty].inner,
        TypeInner::Image { dim: _, arrayed: _, class: ImageClass::Depth { multi: _ } }
    )
}

fn root_of(image: &Expression, function: Option<Handle<Function>>) -> Option<Root> {
    match image {
        Expression::GlobalVariable(handle) => Some(Root::Global(*handle)),
        Expression::FunctionArgument(index) => Some(Root::Parameter(function?, *index)),
        _ => None,
    }
}

/// The textures that are compared with, and those that are given where others are that are: a parameter
/// has one type.
fn compared_roots(module: &Module) -> BTreeSet<Root> {
    let (mut compared, mut given) = (BTreeSet::new(), Vec::new());
    let functions = module.functions.iter().map(|(handle, function)| (Some(handle), function));
    let points = module.entry_points.iter().map(|point| (None, &point.function));
    for (handle, function) in functions.chain(points) {
        for (_, expression) in function.expressions.iter() {
            if let Expression::ImageSample { image, depth_ref: Some(_), .. } = expression {
                compared.extend(root_of(&function.expressions[*image], handle));
            }
        }
        find_given(&function.body, function, handle, &mut given);
    }
    loop {
        let before = compared.len();
        for (one, other) in &given {
            if compared.contains(one) || compared.contains(other) {
                compared.extend([*one, *other]);
            }
        }
        if compared.len() == before {
            return compared;
        }
    }
}

/// What calls pass, and the parameters that they pass it to.
fn find_given(
    block: &Block,
    caller: &Function,
    handle: Option<Handle<Function>>,
    given: &mut Vec<(Root, Root)>,
) {
    for statement in block {
        if let Statement::Call { function, arguments, result: _ } = statement {
            let roots = arguments.iter().enumerate().filter_map(|(index, argument)| {
                let root = root_of(&caller.expressions[*argument], handle)?;
                Some((root, Root::Parameter(*function, index as u32)))
            });
            given.extend(roots);
        }
        for inner in inner_blocks(statement) {
            find_given(inner, caller, handle, given);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "
        @group(0) @binding(0) var first: texture_depth_2d;
        @group(0) @binding(1) var second: texture_depth_2d;
        @group(0) @binding(2) var plain: sampler;
        @group(0) @binding(3) var compare: sampler_comparison;
        fn read(t: texture_depth_2d, at: vec2f) -> f32 { return textureSampleLevel(t, plain, at, 1); }
        fn shade(t: texture_depth_2d, at: vec2f) -> f32 {
            return textureSampleCompare(t, compare, at, 0.5);
        }";

    /// The names of the globals that stay depth textures.
    fn depths(body: &str) -> Vec<String> {
        let text = format!(
            "{HEAD}\n@fragment fn f(@location(0) at: vec2f) -> @location(0) vec4f {{ {body} }}"
        );
        let module = naga::front::wgsl::parse_str(&text).unwrap();
        let changed = as_floats(&module).unwrap().map_or(module, |(module, _)| module);
        let globals = changed.global_variables.iter();
        globals
            .filter(|(handle, _)| is_depth(&changed, Root::Global(*handle)))
            .filter_map(|(_, variable)| variable.name.clone())
            .collect()
    }

    #[test]
    fn what_is_compared_stays() {
        let loads = "textureLoad(first, vec2i(at), 0) + textureGather(first, plain, at).w";
        let compares = "textureSampleCompare(second, compare, at, 0.5)";
        assert_eq!(depths(&format!("return vec4f({loads} + {compares});")), ["second"]);
        assert_eq!(depths("return vec4f(read(first, at) + shade(second, at));"), ["second"]);
        // `read` has one type.
        let both = "return vec4f(read(first, at) + read(second, at) + shade(second, at));";
        assert_eq!(depths(both), ["first", "second"]);
    }
}
