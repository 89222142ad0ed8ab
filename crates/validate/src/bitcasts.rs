//! Refuses a `bitcast` to a type of another shape than its operand has. naga reads the kind of its
//! numbers alone from the type, and keeps the shape of the operand: `bitcast<vec3f>(1u)` is an `f32`
//! for it, and so is `bitcast<vec2<f16>>(1u)`, which WGSL allows.

use naga::valid::{FunctionInfo, ModuleInfo};
use naga::{Expression, Function, Module, Scalar, Span, TypeInner};

use lamplight_compose::Composed;
use lamplight_diagnostic::{Diagnostic, codes};

/// Components, and bytes of each.
type Shape = (u32, u32);

/// A cast that naga reads otherwise.
struct ChangedCast {
    place: Span,
    from: Shape,
    into: Shape,
}

/// Refuses the first such cast of a module.
pub fn refuse_changed_shapes(
    composed: &Composed,
    module: &Module,
    info: &ModuleInfo,
) -> Result<(), Diagnostic> {
    let found = first_change(&composed.text, module, info);
    found.map_or(Ok(()), |cast| Err(describe(composed, &cast)))
}

/// Whether a text in WGSL, which naga read as the module, has such a cast.
pub fn has_changed_shapes(text: &str, module: &Module, info: &ModuleInfo) -> bool {
    first_change(text, module, info).is_some()
}

fn first_change(text: &str, module: &Module, info: &ModuleInfo) -> Option<ChangedCast> {
    let functions = module.functions.iter().map(|(handle, function)| (function, &info[handle]));
    let points = module.entry_points.iter().enumerate();
    let points = points.map(|(index, point)| (&point.function, info.get_entry_point(index)));
    let mut all = functions.chain(points);
    all.find_map(|(function, info)| first(text, module, function, info))
}

fn first(
    text: &str,
    module: &Module,
    function: &Function,
    info: &FunctionInfo,
) -> Option<ChangedCast> {
    function.expressions.iter().find_map(|(handle, expression)| {
        let Expression::As { expr, kind: _, convert: None } = *expression else { return None };
        let place = function.expressions.get_span(handle);
        let into = written_shape(text.get(place.to_range()?)?)?;
        let from = match *info[expr].ty.inner_with(&module.types) {
            TypeInner::Scalar(Scalar { kind: _, width }) => (1, width.into()),
            TypeInner::Vector { size, scalar } => (size as u32, scalar.width.into()),
            _ => return None,
        };
        (from != into).then_some(ChangedCast { place, from, into })
    })
}

/// The shape of the type that a cast names; `None` for a name of the author's.
fn written_shape(cast: &str) -> Option<Shape> {
    let ty = cast.strip_prefix("bitcast")?.trim_start().strip_prefix('<')?;
    let ty = ty.split_once('(').map_or(ty, |(ty, _)| ty).trim_end();
    let ty: String = ty.strip_suffix('>')?.split_whitespace().collect();
    let width = |scalar: &str| match scalar {
        "f32" | "i32" | "u32" | "f" | "i" | "u" => Some(4),
        "f16" | "h" => Some(2),
        _ => None,
    };
    let Some(vector) = ty.strip_prefix("vec") else {
        return (ty.len() == 3).then(|| width(&ty)).flatten().map(|width| (1, width));
    };
    let count = vector.chars().next()?.to_digit(10)?;
    let scalar = vector.get(1..)?;
    let scalar = match scalar.strip_prefix('<') {
        Some(named) => named.strip_suffix('>').filter(|named| named.len() == 3)?,
        None => Some(scalar).filter(|letter| letter.len() == 1)?,
    };
    width(scalar).map(|width| (count, width))
}

fn describe(composed: &Composed, cast: &ChangedCast) -> Diagnostic {
    let bits = |(count, width): Shape| count * width * 8;
    let (from, into) = (bits(cast.from), bits(cast.into));
    let error = if from == into {
        let message = "no target has a `bitcast` between numbers of 16 and of 32 bits";
        Diagnostic::error(codes::NOT_PORTABLE, message)
            .note("help: `unpack2x16float` and `pack2x16float` convert between the two")
    } else {
        let message = format!("`bitcast` of {from} bits into {into}");
        Diagnostic::error(codes::WGSL_ERROR, message)
    };
    match cast.place.to_range().and_then(|range| composed.map.lookup(range)) {
        Some(span) => error.at(span, "this cast"),
        None => error,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_of_written_types() {
        for (cast, shape) in [
            ("bitcast<f32>(x)", Some((1, 4))),
            ("bitcast<vec3f>(x)", Some((3, 4))),
            ("bitcast < vec2<f16> > (f(x))", Some((2, 2))),
            ("bitcast<vec4<u32>>(a < b)", Some((4, 4))),
            ("bitcast<Number>(x)", None),
            ("bitcast<f>(x)", None),
            ("x", None),
        ] {
            assert_eq!(written_shape(cast), shape, "{cast}");
        }
    }
}
