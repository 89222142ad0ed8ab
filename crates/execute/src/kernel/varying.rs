//! Wraps a function into a fragment stage whose inputs are interpolated and whose result is used,
//! so that a driver cannot remove the call. The cost on real GPUs is measured with this.

use naga::{
    BinaryOperator as Op, Binding, Expression, FunctionArgument, FunctionResult, Interpolation,
    Module, Sampling, ScalarKind, Span, Statement, VectorSize,
};

use super::body::{FunctionBody, KernelValue};
use super::wrap::{ArgumentSource, with_entry};
use super::{TypeShape, find_function, pointed_type, resource_class, untestable_function};
use lamplight_diagnostic::{Diagnostic, codes};

/// The most vectors of four words that a stage can take: vertices have 32 attributes, and one of
/// them is the position.
const VECTORS: u32 = 31;

/// Two modules with [`super::ENTRY`] as their only entry point: one that calls the function, and
/// one that only takes its arguments.
///
/// Both take the words of the arguments as components of interpolated vectors, and write the
/// exclusive-or of all of them. The first also includes the words of the result. So the difference
/// between the two is what the function costs.
///
/// # Errors
/// There is no such function, or it has a parameter that is not made of 32-bit values, or more of
/// them than a stage can take.
pub fn varying_modules(module: &Module, function: &str) -> Result<[Module; 2], Diagnostic> {
    let handle = find_function(module, function)?;
    let (mut sources, mut words, mut binding) = (Vec::new(), 0_u32, 0);
    for (index, argument) in module.functions[handle].arguments.iter().enumerate() {
        sources.push(if resource_class(module, argument.ty).is_some() {
            binding += 1;
            ArgumentSource::Binding(binding)
        } else {
            let named = || argument.name.clone().unwrap_or_else(|| format!("parameter {index}"));
            let shape = TypeShape::of(module, pointed_type(module, argument.ty))
                .ok_or_else(|| untestable_function(&named()))?;
            let first = words;
            words = words.saturating_add(shape.words());
            ArgumentSource::Words(first)
        });
    }
    if words > 4 * VECTORS {
        return Err(Diagnostic::error(
            codes::UNTESTABLE_FUNCTION,
            format!(
                "the parameters of `{function}` have {words} words, and a fragment stage takes {}",
                4 * VECTORS
            ),
        ));
    }
    let called = with_entry(module, |body| {
        let inputs = body.inputs_that_vary(words);
        let results = body.call(function, handle, &sources, &inputs)?;
        body.mix(&inputs, &results);
        Ok(())
    })?;
    let empty = with_entry(module, |body| {
        let inputs = body.inputs_that_vary(words);
        body.mix(&inputs, &[]);
        Ok(())
    })?;
    Ok([called, empty])
}

impl FunctionBody<'_> {
    /// The stage's inputs, as words.
    fn inputs_that_vary(&mut self, words: u32) -> Vec<KernelValue> {
        let ty = self.vector(VectorSize::Quad, ScalarKind::Float);
        let mut values = Vec::new();
        for location in 0..words.div_ceil(4) {
            let binding = Some(location_binding(location, Some(Interpolation::Perspective)));
            self.function.arguments.push(FunctionArgument { name: None, ty, binding });
            let vector = self.add(Expression::FunctionArgument(location));
            let kind = ScalarKind::Uint;
            let bits = self.add(Expression::As { expr: vector, kind, convert: None });
            let count = (words - 4 * location).min(4);
            values.extend((0..count).map(|index| self.component(bits, index)));
        }
        values
    }

    /// Returns four words that depend on all inputs and on all results.
    fn mix(&mut self, inputs: &[KernelValue], results: &[KernelValue]) {
        let ty = self.vector(VectorSize::Quad, ScalarKind::Uint);
        let zero = self.add(Expression::Literal(naga::Literal::U32(0)));
        let mixed =
            inputs.iter().fold(zero, |mixed, word| self.binary(Op::ExclusiveOr, mixed, *word));
        let mut components = vec![mixed; 4];
        for (index, word) in results.iter().enumerate() {
            let component = &mut components[index % 4];
            *component = self.binary(Op::ExclusiveOr, *component, *word);
        }
        let value = Some(self.add(Expression::Compose { ty, components }));
        let binding = location_binding(0, None);
        self.function.result = Some(FunctionResult { ty, binding: Some(binding) });
        self.function.body.push(Statement::Return { value }, Span::UNDEFINED);
    }
}

fn location_binding(location: u32, interpolation: Option<Interpolation>) -> Binding {
    Binding::Location {
        location,
        interpolation,
        sampling: interpolation.map(|_| Sampling::Center),
        blend_src: None,
        per_primitive: false,
    }
}
