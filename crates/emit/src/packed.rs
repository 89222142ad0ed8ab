//! Vectors of three that are bound by themselves, in Metal. They have 12 bytes in a buffer, and
//! Metal's `float3` has 16. naga packs them where they are members, so they become members.

use naga::valid::ModuleInfo;
use naga::{
    AddressSpace, Arena, Expression, GlobalVariable, Handle, Module, Span, StructMember, Type,
    TypeInner, VectorSize,
};

use super::rebuild::rebuild;
use lamplight_validate::info_unchecked;

/// The module in which each such vector is the only member of a structure, and naga's analysis of
/// it; `None` where there are none.
///
/// # Errors
/// The message of naga, if it refuses the new module.
pub fn with_packed_vectors(module: &Module) -> Result<Option<(Module, ModuleInfo)>, String> {
    let all = module.global_variables.iter();
    let bound: Vec<Handle<GlobalVariable>> =
        all.filter(|(_, one)| is_bound_vector(module, one)).map(|(handle, _)| handle).collect();
    if bound.is_empty() {
        return Ok(None);
    }
    let mut made = module.clone();
    for variable in &bound {
        wrap(&mut made, *variable);
    }
    let replace = &mut |_, expression, span, expressions: &mut Arena<Expression>| {
        let is_wrapped = match expression {
            Expression::GlobalVariable(variable) => bound.contains(&variable),
            _ => false,
        };
        let base = expressions.append(expression, span);
        match is_wrapped {
            true => expressions.append(Expression::AccessIndex { base, index: 0 }, span),
            false => base,
        }
    };
    let functions = made.functions.iter_mut().map(|(_, function)| function);
    for function in functions.chain(made.entry_points.iter_mut().map(|point| &mut point.function)) {
        rebuild(function, replace);
    }
    let info = info_unchecked(&made)
        .map_err(|error| format!("a module with packed vectors is not valid: {error}"))?;
    Ok(Some((made, info)))
}

fn is_bound_vector(module: &Module, variable: &GlobalVariable) -> bool {
    let is_buffer =
        matches!(variable.space, AddressSpace::Uniform | AddressSpace::Storage { access: _ });
    let ty = &module.types[variable.ty].inner;
    is_buffer && matches!(ty, TypeInner::Vector { size: VectorSize::Tri, scalar: _ })
}

/// Makes the variable's type a structure with no padding behind its member.
fn wrap(module: &mut Module, variable: Handle<GlobalVariable>) {
    let ty = module.global_variables[variable].ty;
    let span = module.types[ty].inner.size(module.to_ctx());
    let member = StructMember { name: Some("value".to_owned()), ty, binding: None, offset: 0 };
    let inner = TypeInner::Struct { members: vec![member], span };
    let packed = Type { name: Some("Packed".to_owned()), inner };
    module.global_variables[variable].ty = module.types.insert(packed, Span::UNDEFINED);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_bound_vectors_of_three_are_members() {
        let text = |bound: &str| {
            let module = naga::front::wgsl::parse_str(&format!(
                "struct S {{ v: vec3f }}
                 @group(0) @binding(0) var<uniform> a: {bound};
                 var<private> b: vec3f;
                 @fragment fn f() -> @location(0) vec4f {{ _ = a; return vec4f(b, 1.0); }}"
            ));
            with_packed_vectors(&module.unwrap()).unwrap()
        };
        for bound in ["S", "vec2f", "vec4f", "array<vec3f, 2>"] {
            assert!(text(bound).is_none(), "{bound}");
        }
        let (module, _) = text("vec3f").unwrap();
        let sizes = module
            .global_variables
            .iter()
            .map(|(_, one)| (one.space, module.types[one.ty].inner.size(module.to_ctx())));
        assert_eq!(
            sizes.collect::<Vec<_>>(),
            [(AddressSpace::Uniform, 12), (AddressSpace::Private, 12)]
        );
    }
}
