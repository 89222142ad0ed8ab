//! Overrides in WGSL where naga's writer does not write them: in the size of a workgroup, in the
//! length of an array, in the default of another override, and in the initial value of a variable.
//!
//! naga writes a module that has numbers or nothing in these places, and the expressions are put
//! into its text.

use naga::back::binary_operation_str;
use naga::common::wgsl::TryToWgsl;
use naga::{
    ArraySize, Expression, Handle, Literal, Module, Override, Scalar, ScalarKind, ShaderStage,
    Type, TypeInner, UnaryOperator,
};

use super::fixed::{deciding, is_computed, is_length, pending_length};
use super::literal_of;

/// The length of the first array whose length is an override, as naga writes it. Those of the
/// others follow. Text and author's arrays have smaller numbers.
const FIRST_LENGTH: u32 = 0xfff0_0000;

/// The attributes of a compute shader, up to its size.
const SIZE: &str = "@compute @workgroup_size(";

/// The module that naga writes; `None` where it writes all overrides itself.
///
/// # Errors
/// A message, where the module has too many such arrays.
pub fn written_module(module: &Module) -> Result<Option<Module>, String> {
    if deciding(module).is_empty()
        && !module.global_variables.iter().any(|(_, one)| is_open(module, one))
    {
        return Ok(None);
    }
    let mut written = module.clone();
    for (number, (handle, _)) in pending_types(module).into_iter().enumerate() {
        let length = FIRST_LENGTH + number as u32;
        if number >= 1 << 16 || has_length(module, length) {
            return Err("an array has a length that is too large".to_owned());
        }
        let Type { name, mut inner } = written.types[handle].clone();
        if let TypeInner::Array { base: _, size, stride: _ }
        | TypeInner::BindingArray { base: _, size } = &mut inner
        {
            *size = ArraySize::Constant(std::num::NonZeroU32::MIN.saturating_add(length - 1));
        }
        written.types.replace(handle, Type { name, inner });
    }
    for (handle, found) in module.overrides.iter() {
        if is_length(found) || is_computed(module, found) {
            written.overrides[handle].init = None;
        }
    }
    for (handle, _) in module.global_variables.iter().filter(|(_, one)| is_open(module, one)) {
        written.global_variables[handle].init = None;
    }
    Ok(Some(written))
}

/// Whether naga does not write the initial value of a variable, since it computes with overrides.
fn is_open(module: &Module, variable: &naga::GlobalVariable) -> bool {
    variable.init.is_some_and(|init| computes(module, init))
}

fn computes(module: &Module, expression: Handle<Expression>) -> bool {
    match &module.global_expressions[expression] {
        Expression::Literal(_)
        | Expression::Constant(_)
        | Expression::Override(_)
        | Expression::ZeroValue(_) => false,
        Expression::Compose { ty: _, components } => {
            components.iter().any(|component| computes(module, *component))
        }
        Expression::Splat { size: _, value } => computes(module, *value),
        _ => true,
    }
}

/// The text that naga wrote of [`written_module`], with the expressions in their places. `names` are
/// those of all overrides, as naga wrote them.
///
/// # Errors
/// A message, where an expression has a form that only functions have.
pub fn with_expressions(text: &str, module: &Module, names: &[String]) -> Result<String, String> {
    let print = ExpressionText { module, names };
    let mut overrides = module.overrides.iter();
    let mut variables = module.global_variables.iter();
    let mut points = module.entry_points.iter().filter(|one| one.stage == ShaderStage::Compute);
    let mut out = String::with_capacity(text.len());
    for line in text.split_inclusive('\n') {
        if super::is_override_line(line) {
            let (_, found) = overrides.next().ok_or("an override was written twice")?;
            match found.init {
                _ if is_length(found) => {}
                Some(init) if is_computed(module, found) => {
                    let declared = line.trim_end().trim_end_matches(';');
                    out += &format!("{declared} = {};\n", print.expression(init)?);
                }
                _ => out.push_str(line),
            }
        } else if line.starts_with("var<") || line.starts_with("var ") {
            let (_, found) = variables.next().ok_or("a variable was written twice")?;
            match found.init.filter(|_| is_open(module, found)) {
                Some(init) => {
                    let declared = line.trim_end().trim_end_matches(';');
                    out += &format!("{declared} = {};\n", print.expression(init)?);
                }
                None => out.push_str(line),
            }
        } else if let Some(rest) = line.strip_prefix(SIZE) {
            let point = points.next().ok_or("a compute shader was written twice")?;
            let (_, rest) = rest.split_once(')').ok_or("a size has no end")?;
            out += &format!("{SIZE}{}){rest}", print.size(point)?);
        } else {
            out.push_str(line);
        }
    }
    for (number, (_, length)) in pending_types(module).into_iter().enumerate() {
        let marked = format!(", {}>", FIRST_LENGTH + number as u32);
        out = out.replace(&marked, &format!(", {}>", print.name(length)?));
    }
    Ok(out)
}

fn pending_types(module: &Module) -> Vec<(Handle<Type>, Handle<Override>)> {
    let types = module.types.iter();
    types.filter_map(|(handle, ty)| Some((handle, pending_length(&ty.inner)?))).collect()
}

fn has_length(module: &Module, length: u32) -> bool {
    module.types.iter().any(|(_, ty)| match &ty.inner {
        TypeInner::Array { base: _, size: ArraySize::Constant(size), stride: _ } => {
            size.get() == length
        }
        _ => false,
    })
}

/// Writes constant expressions, which may name overrides.
struct ExpressionText<'m> {
    module: &'m Module,
    names: &'m [String],
}

impl ExpressionText<'_> {
    fn size(&self, point: &naga::EntryPoint) -> Result<String, String> {
        let open = point.workgroup_size_overrides.unwrap_or_default();
        let sizes = open.iter().zip(point.workgroup_size);
        let sizes = sizes.map(|(open, number)| match open {
            Some(expression) => self.expression(*expression),
            None => Ok(number.to_string()),
        });
        Ok(sizes.collect::<Result<Vec<_>, String>>()?.join(", "))
    }

    fn name(&self, handle: Handle<Override>) -> Result<String, String> {
        let found = &self.module.overrides[handle];
        match found.init {
            Some(init) if is_length(found) => self.expression(init),
            _ => self
                .names
                .get(handle.index())
                .cloned()
                .ok_or_else(|| "a name is missing".to_owned()),
        }
    }

    fn expression(&self, handle: Handle<Expression>) -> Result<String, String> {
        if let Some(literal) = literal_of(self.module, handle) {
            return literal_text(literal);
        }
        let of = |handle: &Handle<Expression>| self.expression(*handle);
        Ok(match &self.module.global_expressions[handle] {
            Expression::Override(handle) => self.name(*handle)?,
            Expression::Constant(handle) => of(&self.module.constants[*handle].init)?,
            Expression::Compose { ty, components } => {
                let TypeInner::Vector { size, scalar } = self.module.types[*ty].inner else {
                    return Err(unwritable());
                };
                let parts = components.iter().map(of).collect::<Result<Vec<_>, String>>()?;
                let size = size as u8;
                format!("vec{size}<{}>({})", scalar_name(scalar)?, parts.join(", "))
            }
            Expression::Splat { size, value } => format!("vec{}({})", *size as u8, of(value)?),
            Expression::Unary { op, expr } => {
                let sign = match op {
                    UnaryOperator::Negate => "-",
                    UnaryOperator::LogicalNot => "!",
                    UnaryOperator::BitwiseNot => "~",
                };
                format!("{sign}({})", of(expr)?)
            }
            Expression::Binary { op, left, right } => {
                format!("({} {} {})", of(left)?, binary_operation_str(*op), of(right)?)
            }
            Expression::Select { condition, accept, reject } => {
                format!("select({}, {}, {})", of(reject)?, of(accept)?, of(condition)?)
            }
            Expression::As { expr, kind, convert } => {
                // Without conversion the bits are kept, of which overrides have 32.
                let ty = scalar_name(Scalar { kind: *kind, width: convert.unwrap_or(4) })?;
                let name = convert.map_or_else(|| format!("bitcast<{ty}>"), |_| ty.to_owned());
                format!("{name}({})", of(expr)?)
            }
            Expression::Math { fun, arg, arg1, arg2, arg3 } => {
                let name = fun.try_to_wgsl().ok_or_else(unwritable)?;
                let rest = [arg1, arg2, arg3].into_iter().flatten();
                let given = std::iter::once(arg).chain(rest).map(of);
                format!("{name}({})", given.collect::<Result<Vec<_>, String>>()?.join(", "))
            }
            _ => return Err(unwritable()),
        })
    }
}

fn unwritable() -> String {
    "a default or a size is computed from overrides in a way that only functions allow".to_owned()
}

/// The types that an `override` may have, but for `f16`, whose literals are not written either.
fn scalar_name(scalar: Scalar) -> Result<&'static str, String> {
    match scalar {
        Scalar::I32 => Ok("i32"),
        Scalar::U32 => Ok("u32"),
        Scalar::F32 => Ok("f32"),
        Scalar { kind: ScalarKind::Bool, width: _ } => Ok("bool"),
        _ => Err(unwritable()),
    }
}

fn literal_text(literal: Literal) -> Result<String, String> {
    Ok(match literal {
        Literal::I32(i32::MIN) => "i32(-2147483648)".to_owned(),
        Literal::I32(value) => format!("{value}i"),
        Literal::U32(value) => format!("{value}u"),
        Literal::F32(value) => format!("{value:?}f"),
        Literal::Bool(value) => value.to_string(),
        Literal::AbstractInt(value) => value.to_string(),
        Literal::AbstractFloat(value) => format!("{value:?}"),
        other => {
            let Scalar { kind, width } = other.scalar();
            return Err(format!("a default of {} bits of {kind:?} cannot be written", 8 * width));
        }
    })
}
