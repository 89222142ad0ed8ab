//! Bounds the sizes of a module's types, with checked arithmetic.
//!
//! Some outputs write a zero for each scalar of a variable, a member for each gap of a structure,
//! or a load for each part of a value. So a declaration of a few bytes can become gigabytes. Sizes
//! are known once naga has parsed the text, and a module whose types are too large goes no further.

use naga::{
    AddressSpace, ArraySize, Expression, Function, GlobalVariable, Handle, Module, Span, Type,
    TypeInner,
};

use super::uses::functions;
use lamplight_files::limits::{PADDING_BYTES, TYPE_NESTING, VALUE_SCALARS};

/// A type or a value that is too large.
pub struct Large {
    pub span: Span,
    pub message: String,
}

/// Something whose scalars an output may write one by one.
struct SizedValue<'m> {
    ty: Handle<Type>,
    what: &'static str,
    name: Option<&'m str>,
    span: Span,
}

/// The size of each type, in the order of the types, in which parts come before the types that have
/// them.
struct Sizes<'m> {
    module: &'m Module,
    scalars: Vec<u64>,
    depths: Vec<usize>,
}

/// The first type, constant or variable that is too large.
pub fn check_sizes(module: &Module) -> Option<Large> {
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
    /// How many scalars a value has, and how deeply its types nest.
    fn measure(&self, inner: &TypeInner) -> (u64, usize) {
        let part = |ty: Handle<Type>| (self.scalars_of(ty), self.depth_of(ty));
        match *inner {
            TypeInner::Vector { size, scalar: _ } => (size as u64, 1),
            TypeInner::Matrix { columns, rows, scalar: _ } => (columns as u64 * rows as u64, 1),
            TypeInner::Array { base, size, stride: _ } => {
                let (scalars, depth) = part(base);
                let count = match size {
                    ArraySize::Constant(count) => u64::from(count.get()),
                    _ => 1,
                };
                (scalars.saturating_mul(count), depth + 1)
            }
            TypeInner::Struct { ref members, span: _ } => members
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

    /// Reports gaps between the members of a structure that are too large, since HLSL fills them
    /// with members.
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

    /// The first value at which the total number of scalars is too large.
    fn values(&self) -> Option<Large> {
        let of_functions = functions(self.module).flat_map(|function| self.of_function(function));
        let mut left = VALUE_SCALARS;
        self.of_module().chain(of_functions).find_map(|value| {
            let scalars = self.scalars_of(value.ty);
            let Some(rest) = left.checked_sub(scalars) else { return Some(value.large(scalars)) };
            left = rest;
            None
        })
    }

    /// Variables and constants whose zeros or parts are written one by one.
    fn of_module(&self) -> impl Iterator<Item = SizedValue<'_>> {
        let (variables, constants) = (&self.module.global_variables, &self.module.constants);
        let is_written = |variable: &GlobalVariable| {
            use AddressSpace::{Function, Private, WorkGroup};
            matches!(variable.space, Private | WorkGroup | Function)
        };
        let written = variables.iter().filter(move |(_, variable)| is_written(variable));
        let written = written.map(|(handle, variable)| SizedValue {
            ty: variable.ty,
            what: "variable",
            name: variable.name.as_deref(),
            span: variables.get_span(handle),
        });
        written.chain(constants.iter().map(|(handle, constant)| SizedValue {
            ty: constant.ty,
            what: "constant",
            name: constant.name.as_deref(),
            span: constants.get_span(handle),
        }))
    }

    /// The variables of a function, and values that are written out in it.
    fn of_function<'f>(&self, function: &'f Function) -> impl Iterator<Item = SizedValue<'f>> {
        let (variables, expressions) = (&function.local_variables, &function.expressions);
        let locals = variables.iter().map(|(handle, local)| SizedValue {
            ty: local.ty,
            what: "variable",
            name: local.name.as_deref(),
            span: variables.get_span(handle),
        });
        locals.chain(expressions.iter().filter_map(|(handle, expression)| match *expression {
            Expression::ZeroValue(ty) | Expression::Compose { ty, .. }
                if self.scalars_of(ty) > 4 =>
            {
                Some(SizedValue {
                    ty,
                    what: "value",
                    name: None,
                    span: expressions.get_span(handle),
                })
            }
            _ => None,
        }))
    }
}

impl SizedValue<'_> {
    /// The error about a value that is too large.
    fn large(&self, scalars: u64) -> Large {
        let (what, name) = (self.what, self.name.unwrap_or("_"));
        let message = format!(
            "the {what} `{name}` has {scalars} scalars, and all variables and constants of a \
             module together may have {VALUE_SCALARS}"
        );
        Large { span: self.span, message }
    }
}
