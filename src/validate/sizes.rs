//! What the types of a module amount to, by checked arithmetic.
//!
//! Some outputs spell out a zero for each scalar of a variable, a member for each gap of a
//! structure, or a load for each part of a value. A declaration of a few bytes can so stand for
//! gigabytes. The module that naga's parser gives has every type with its size; nothing behind the
//! parser sees a module whose types are too large.

use naga::{AddressSpace, ArraySize, Handle, Module, Span, Type, TypeInner};

use crate::limits::{PADDING_BYTES, TYPE_NESTING, VALUE_SCALARS};

/// A type or a value that is too large.
pub struct Large {
    pub span: Span,
    pub message: String,
}

/// The size of each type, in the order of the types: parts come before what they are in.
struct Sizes<'m> {
    module: &'m Module,
    scalars: Vec<u64>,
    depths: Vec<usize>,
}

/// The first type, constant or variable that is too large.
pub fn check(module: &Module) -> Option<Large> {
    let mut sizes = Sizes { module, scalars: Vec::new(), depths: Vec::new() };
    for (handle, ty) in module.types.iter() {
        let (scalars, depth) = sizes.measure(&ty.inner);
        sizes.scalars.push(scalars);
        sizes.depths.push(depth);
        let found = sizes.padding(ty).or_else(|| {
            (depth > TYPE_NESTING)
                .then(|| format!("types within each other are more than {TYPE_NESTING} deep"))
        });
        if let Some(message) = found {
            return Some(Large { span: module.types.get_span(handle), message });
        }
    }
    sizes.values()
}

impl Sizes<'_> {
    /// Scalars of a value, and how deep its types are.
    fn measure(&self, inner: &TypeInner) -> (u64, usize) {
        let part = |ty: Handle<Type>| (self.scalars_of(ty), self.depth_of(ty));
        match *inner {
            TypeInner::Vector { size, .. } => (size as u64, 1),
            TypeInner::Matrix { columns, rows, .. } => (columns as u64 * rows as u64, 1),
            TypeInner::Array { base, size, .. } => {
                let (scalars, depth) = part(base);
                let count = match size {
                    ArraySize::Constant(count) => u64::from(count.get()),
                    _ => 1,
                };
                (scalars.saturating_mul(count), depth + 1)
            }
            TypeInner::Struct { ref members, .. } => members
                .iter()
                .map(|member| part(member.ty))
                .fold((0, 1), |sum, (scalars, depth)| {
                    (u64::saturating_add(sum.0, scalars), sum.1.max(depth + 1))
                }),
            _ => (1, 1),
        }
    }

    fn scalars_of(&self, ty: Handle<Type>) -> u64 {
        self.scalars.get(ty.index()).copied().unwrap_or(1)
    }

    fn depth_of(&self, ty: Handle<Type>) -> usize {
        self.depths.get(ty.index()).copied().unwrap_or(1)
    }

    /// Bytes between the members of a structure, which HLSL spells out.
    fn padding(&self, ty: &Type) -> Option<String> {
        let TypeInner::Struct { ref members, span } = ty.inner else { return None };
        let mut used = 0u64;
        for member in members {
            let size = self.module.types[member.ty].inner.try_size(self.module.to_ctx());
            used = used.saturating_add(u64::from(size.unwrap_or(0)));
        }
        let gaps = u64::from(span).saturating_sub(used);
        let name = ty.name.as_deref().unwrap_or("structure");
        (gaps > PADDING_BYTES).then(|| {
            format!("the members of `{name}` are {gaps} bytes apart, more than {PADDING_BYTES}")
        })
    }

    /// Variables and constants whose zeros or parts are written one by one.
    fn values(&self) -> Option<Large> {
        let module = self.module;
        let mut left = VALUE_SCALARS;
        let mut take = |ty: Handle<Type>, what: &str, name: &Option<String>, span: Span| {
            let scalars = self.scalars_of(ty);
            match left.checked_sub(scalars) {
                Some(rest) => {
                    left = rest;
                    None
                }
                None => {
                    let name = name.as_deref().unwrap_or("_");
                    let message = format!(
                        "the {what} `{name}` has {scalars} scalars, and all variables and \
                         constants of a module together may have {VALUE_SCALARS}"
                    );
                    Some(Large { span, message })
                }
            }
        };
        for (handle, variable) in module.global_variables.iter() {
            let is_written = matches!(
                variable.space,
                AddressSpace::Private | AddressSpace::WorkGroup | AddressSpace::Function
            );
            let span = module.global_variables.get_span(handle);
            if is_written && let Some(large) = take(variable.ty, "variable", &variable.name, span) {
                return Some(large);
            }
        }
        for (handle, constant) in module.constants.iter() {
            let span = module.constants.get_span(handle);
            if let Some(large) = take(constant.ty, "constant", &constant.name, span) {
                return Some(large);
            }
        }
        let functions = module.functions.iter().map(|(_, function)| function);
        let points = module.entry_points.iter().map(|point| &point.function);
        for function in functions.chain(points) {
            for (handle, local) in function.local_variables.iter() {
                let span = function.local_variables.get_span(handle);
                if let Some(large) = take(local.ty, "variable", &local.name, span) {
                    return Some(large);
                }
            }
            for (handle, expression) in function.expressions.iter() {
                if let naga::Expression::ZeroValue(ty) | naga::Expression::Compose { ty, .. } =
                    *expression
                    && self.scalars_of(ty) > 4
                {
                    let span = function.expressions.get_span(handle);
                    if let Some(large) = take(ty, "value", &None, span) {
                        return Some(large);
                    }
                }
            }
        }
        None
    }
}
