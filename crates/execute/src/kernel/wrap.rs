//! Builds the fragment entry point around a function. It works on naga's modules, so it is the same
//! for WESL and for GLSL.
//!
//! [`varying_modules`] builds a fragment stage whose inputs are interpolated and whose result is
//! used, so that a driver cannot remove the call. The cost on real GPUs is measured with this. A
//! [`Body`] writes the body of a function, and converts values to words and back.

use crate::kernel::{
    ECHO, ENTRY, INPUT_WIDTH, Kernel, Parameter, ParameterKind, TARGET_WIDTH, TypeShape,
    find_function, pointed_type, resource_class, untestable_function,
};
use lamplight_diagnostic::{Diagnostic, codes};
use naga::{
    AddressSpace, BinaryOperator as Op, Binding, BuiltIn, EntryPoint, Expression, Function,
    FunctionArgument, FunctionResult, GlobalVariable, Handle, ImageClass, ImageDimension,
    Interpolation, Literal, LocalVariable, MathFunction, Module, Range, ResourceBinding, Sampling,
    Scalar, ScalarKind, ShaderStage, Span, Statement, SwizzleComponent, Type, TypeInner,
    VectorSize,
};

/// The module with its entry points replaced by the kernel's, and the function's handle in it.
pub fn wrap_kernel(
    module: &Module,
    kernel: &Kernel,
) -> Result<(Module, Handle<Function>), Diagnostic> {
    let module = with_entry(module, |body| body.main(kernel))?;
    let function = called_function(&module).ok_or_else(|| lost_function(&kernel.name))?;
    Ok((module, function))
}

/// The module with one fragment stage as its only entry point, and without anything that this does
/// not reach.
fn with_entry(
    module: &Module,
    write: impl FnOnce(&mut FunctionBody<'_>) -> Result<(), Diagnostic>,
) -> Result<Module, Diagnostic> {
    let mut module = module.clone();
    module.entry_points.clear();
    let mut body = FunctionBody { module: &mut module, function: Function::default() };
    write(&mut body)?;
    let function = body.function;
    module.entry_points.push(EntryPoint {
        name: ENTRY.to_owned(),
        stage: ShaderStage::Fragment,
        early_depth_test: None,
        workgroup_size: [0; 3],
        workgroup_size_overrides: None,
        function,
        mesh_info: None,
        task_payload: None,
        incoming_ray_payload: None,
    });
    naga::compact::compact(&mut module, naga::compact::KeepUnused::No);
    Ok(module)
}

/// Finds the function that the entry point calls, since compaction changes handles.
fn called_function(module: &Module) -> Option<Handle<Function>> {
    module.entry_points[0].function.body.iter().find_map(|statement| match statement {
        Statement::Call { function, .. } => Some(*function),
        _ => None,
    })
}

fn lost_function(name: &str) -> Diagnostic {
    Diagnostic::error(codes::UNTESTABLE_FUNCTION, format!("`{name}` could not be wrapped"))
}

/// Where an argument comes from.
pub enum ArgumentSource {
    /// A texture or a sampler, by its binding in group 0.
    Binding(u32),
    /// Words, of which this is the first.
    Words(u32),
}

impl ArgumentSource {
    fn of(parameter: &Parameter) -> Self {
        match &parameter.kind {
            ParameterKind::Resource(resource) => Self::Binding(resource.binding),
            ParameterKind::Words { offset, .. } => Self::Words(*offset),
        }
    }
}

/// What the fragment finds out from its position.
struct FragmentPlace {
    /// The pixel's index in the target.
    index: KernelValue,
    header: KernelValue,
    /// First input texel of the invocation.
    first: KernelValue,
    /// Which four words of the result the pixel holds.
    part: KernelValue,
}

impl FunctionBody<'_> {
    fn main(&mut self, kernel: &Kernel) -> Result<(), Diagnostic> {
        let position = self.vector(VectorSize::Quad, ScalarKind::Float);
        let target = self.vector(VectorSize::Quad, ScalarKind::Uint);
        let built_in = Binding::BuiltIn(BuiltIn::Position { invariant: false });
        let color = Binding::Location {
            location: 0,
            interpolation: None,
            sampling: None,
            blend_src: None,
            per_primitive: false,
        };
        self.function.arguments =
            vec![FunctionArgument { name: None, ty: position, binding: Some(built_in) }];
        self.function.result = Some(FunctionResult { ty: target, binding: Some(color) });

        let inputs = self.inputs();
        let place = self.place(inputs, kernel);
        let words = self.arguments(inputs, &place, kernel);
        let sources: Vec<ArgumentSource> =
            kernel.parameters.iter().map(ArgumentSource::of).collect();
        // The call is outside of any branch: all fragments of a quad make it together, as derivatives
        // within the function need.
        let results = self.call(&kernel.name, kernel.function, &sources, &words)?;
        let chosen = self.choose(&results, place.part);
        let value = self.echo(&place, chosen);
        self.drop_beyond(&place);
        self.function.body.push(Statement::Return { value: Some(value) }, Span::UNDEFINED);
        Ok(())
    }

    /// The input texture, binding 0.
    fn inputs(&mut self) -> KernelValue {
        let class = ImageClass::Sampled { kind: ScalarKind::Uint, multi: false };
        let ty = self.ty(TypeInner::Image { dim: ImageDimension::D2, arrayed: false, class });
        self.global("lamplight_inputs", ty, 0)
    }

    fn global(&mut self, name: &str, ty: Handle<Type>, binding: u32) -> KernelValue {
        let variable = GlobalVariable {
            name: Some(name.to_owned()),
            space: AddressSpace::Handle,
            binding: Some(ResourceBinding { group: 0, binding }),
            ty,
            init: None,
            memory_decorations: naga::MemoryDecorations::empty(),
        };
        let variable = self.module.global_variables.append(variable, Span::UNDEFINED);
        self.add(Expression::GlobalVariable(variable))
    }

    fn place(&mut self, inputs: KernelValue, kernel: &Kernel) -> FragmentPlace {
        let position = self.add(Expression::FunctionArgument(0));
        let x = self.component(position, 0);
        let y = self.component(position, 1);
        let x = self.convert(x, ScalarKind::Uint);
        let y = self.convert(y, ScalarKind::Uint);
        let width = self.literal(TARGET_WIDTH);
        let row = self.binary(Op::Multiply, y, width);
        let index = self.binary(Op::Add, row, x);
        let zero = self.literal(0);
        let header = self.load(inputs, zero);

        // Pixel 0 is the echo, so the results begin at pixel 1. The subtraction is of min(index, 1):
        // pixel 0 must not wrap to the largest index, although its result is not used.
        let one = self.literal(1);
        let echoed = self.math(MathFunction::Min, index, one);
        let pixel = self.binary(Op::Subtract, index, echoed);
        let pixels = self.literal(kernel.result_texels());
        let wanted = self.binary(Op::Divide, pixel, pixels);
        let part = self.binary(Op::Modulo, pixel, pixels);
        // What is beyond the last invocation repeats it: a fragment that returned early would take the
        // derivatives of its neighbours with it.
        let count = self.component(header, 0);
        let last = self.binary(Op::Subtract, count, one);
        let invocation = self.math(MathFunction::Min, wanted, last);
        let texels = self.literal(kernel.input_texels());
        // Texel 0 of the input is the header.
        let skipped = self.binary(Op::Multiply, invocation, texels);
        let first = self.binary(Op::Add, skipped, one);
        FragmentPlace { index, header, first, part }
    }

    /// One texel of the input texture.
    fn load(&mut self, inputs: KernelValue, index: KernelValue) -> KernelValue {
        let width = self.literal(INPUT_WIDTH);
        let x = self.binary(Op::Modulo, index, width);
        let y = self.binary(Op::Divide, index, width);
        let pair = self.vector(VectorSize::Bi, ScalarKind::Uint);
        let coordinate = self.add(Expression::Compose { ty: pair, components: vec![x, y] });
        let level = Some(self.add(Expression::Literal(Literal::I32(0))));
        self.add(Expression::ImageLoad {
            image: inputs,
            coordinate,
            array_index: None,
            sample: None,
            level,
        })
    }

    /// All words of the invocation's arguments, as u32.
    fn arguments(
        &mut self,
        inputs: KernelValue,
        place: &FragmentPlace,
        kernel: &Kernel,
    ) -> Vec<KernelValue> {
        let mut words = Vec::new();
        for texel in 0..kernel.input_texels() {
            let skipped = self.literal(texel);
            let index = self.binary(Op::Add, place.first, skipped);
            let loaded = self.load(inputs, index);
            words.extend((0..4).map(|component| self.component(loaded, component)));
        }
        words
    }

    /// Calls the function, and flattens what it returns and what is behind its pointers afterwards.
    pub(super) fn call(
        &mut self,
        name: &str,
        function: Handle<Function>,
        sources: &[ArgumentSource],
        words: &[KernelValue],
    ) -> Result<Vec<KernelValue>, Diagnostic> {
        let declared = self.module.functions[function].arguments.clone();
        let returned = self.module.functions[function].result.as_ref().map(|result| result.ty);
        let mut arguments = Vec::new();
        let mut written = Vec::new();
        for (source, argument) in sources.iter().zip(&declared) {
            let value = match source {
                ArgumentSource::Binding(binding) => {
                    let name = argument.name.as_deref().unwrap_or("resource");
                    self.global(name, argument.ty, *binding)
                }
                ArgumentSource::Words(offset) => {
                    let base = pointed_type(self.module, argument.ty);
                    let value = self
                        .unflatten(base, &mut words[*offset as usize..].iter().copied())
                        .ok_or_else(|| lost_function(name))?;
                    if base == argument.ty {
                        value
                    } else {
                        self.variable(base, value, &mut written)
                    }
                }
            };
            arguments.push(value);
        }
        let result = returned.map(|_| {
            self.function.expressions.append(Expression::CallResult(function), Span::UNDEFINED)
        });
        self.function.body.push(Statement::Call { function, arguments, result }, Span::UNDEFINED);
        let mut flat = Vec::new();
        if let (Some(result), Some(ty)) = (result, returned) {
            self.flatten(result, ty, &mut flat);
        }
        for (pointer, ty) in written {
            let value = self.add(Expression::Load { pointer });
            self.flatten(value, ty, &mut flat);
        }
        Ok(flat)
    }

    /// A local variable that holds the value of a pointer parameter.
    fn variable(
        &mut self,
        ty: Handle<Type>,
        value: KernelValue,
        written: &mut Vec<(KernelValue, Handle<Type>)>,
    ) -> KernelValue {
        let local = self
            .function
            .local_variables
            .append(LocalVariable { name: None, ty, init: None }, Span::UNDEFINED);
        let pointer = self.add(Expression::LocalVariable(local));
        self.function.body.push(Statement::Store { pointer, value }, Span::UNDEFINED);
        written.push((pointer, ty));
        pointer
    }

    /// Drops the fragment if it is beyond the target, which none is. A shader that may drop fragments
    /// is compiled once by llvmpipe; others it compiles a second time, for tiles that are covered
    /// whole.
    fn drop_beyond(&mut self, place: &FragmentPlace) {
        let pixels = self.component(place.header, 1);
        let condition = self.binary(Op::GreaterEqual, place.index, pixels);
        let mut accept = naga::Block::new();
        accept.push(Statement::Kill, Span::UNDEFINED);
        let statement = Statement::If { condition, accept, reject: naga::Block::new() };
        self.function.body.push(statement, Span::UNDEFINED);
    }

    /// The echo in the first and the last pixel, and `value` in all others.
    fn echo(&mut self, place: &FragmentPlace, value: KernelValue) -> KernelValue {
        let magic = self.literal(ECHO);
        let mark = self.binary(Op::ExclusiveOr, place.index, magic);
        let ty = self.vector(VectorSize::Quad, ScalarKind::Uint);
        let size = VectorSize::Tri;
        let pattern =
            [SwizzleComponent::X, SwizzleComponent::Y, SwizzleComponent::Z, SwizzleComponent::W];
        let header = self.add(Expression::Swizzle { size, vector: place.header, pattern });
        let accept = self.add(Expression::Compose { ty, components: vec![header, mark] });
        let (zero, one) = (self.literal(0), self.literal(1));
        let pixels = self.component(place.header, 1);
        let last = self.binary(Op::Subtract, pixels, one);
        let is_first = self.binary(Op::Equal, place.index, zero);
        let is_last = self.binary(Op::Equal, place.index, last);
        let condition = self.binary(Op::LogicalOr, is_first, is_last);
        self.add(Expression::Select { condition, accept, reject: value })
    }

    /// The four words of this pixel: those of part 0, unless `part` is another.
    fn choose(&mut self, words: &[KernelValue], part: KernelValue) -> KernelValue {
        let ty = self.vector(VectorSize::Quad, ScalarKind::Uint);
        let zero = self.literal(0);
        let mut chosen = self.add(Expression::Compose {
            ty,
            components: padded_words(words.get(..4).unwrap_or(words), zero),
        });
        for (index, four) in words.chunks(4).enumerate().skip(1) {
            let accept = self.add(Expression::Compose { ty, components: padded_words(four, zero) });
            let index = self.literal(index as u32);
            let condition = self.binary(Op::Equal, part, index);
            chosen = self.add(Expression::Select { condition, accept, reject: chosen });
        }
        chosen
    }
}

fn padded_words(words: &[KernelValue], zero: KernelValue) -> Vec<KernelValue> {
    words.iter().copied().chain(std::iter::repeat(zero)).take(4).collect()
}

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

/// A value within the body.
pub type KernelValue = Handle<Expression>;

/// The function that is being built, and the module that it is for.
pub struct FunctionBody<'a> {
    pub module: &'a mut Module,
    pub function: Function,
}

impl FunctionBody<'_> {
    /// Adds an expression, and the statement that evaluates it if it needs one.
    pub fn add(&mut self, expression: Expression) -> KernelValue {
        let emitted = !expression.needs_pre_emit();
        let value = self.function.expressions.append(expression, Span::UNDEFINED);
        if emitted {
            self.function
                .body
                .push(Statement::Emit(Range::new_from_bounds(value, value)), Span::UNDEFINED);
        }
        value
    }

    /// A type without a name.
    pub fn ty(&mut self, inner: TypeInner) -> Handle<Type> {
        self.module.types.insert(Type { name: None, inner }, Span::UNDEFINED)
    }

    pub fn scalar(&mut self, scalar: Scalar) -> Handle<Type> {
        self.ty(TypeInner::Scalar(scalar))
    }

    pub fn vector(&mut self, size: VectorSize, kind: ScalarKind) -> Handle<Type> {
        let width = if kind == ScalarKind::Bool { naga::BOOL_WIDTH } else { 4 };
        self.ty(TypeInner::Vector { size, scalar: Scalar { kind, width } })
    }

    /// A literal of `u32`.
    pub fn literal(&mut self, value: u32) -> KernelValue {
        self.add(Expression::Literal(Literal::U32(value)))
    }

    /// A component of a vector, a matrix, an array or a struct.
    pub fn component(&mut self, base: KernelValue, index: u32) -> KernelValue {
        self.add(Expression::AccessIndex { base, index })
    }

    pub fn binary(&mut self, op: Op, left: KernelValue, right: KernelValue) -> KernelValue {
        self.add(Expression::Binary { op, left, right })
    }

    /// A built-in function of two values.
    pub fn math(
        &mut self,
        fun: MathFunction,
        left: KernelValue,
        right: KernelValue,
    ) -> KernelValue {
        self.add(Expression::Math { fun, arg: left, arg1: Some(right), arg2: None, arg3: None })
    }

    /// A value converted to 32 bits of a kind.
    pub fn convert(&mut self, expr: KernelValue, kind: ScalarKind) -> KernelValue {
        self.add(Expression::As { expr, kind, convert: Some(4) })
    }

    /// A value of the type from words; `None` if the type does not consist of words.
    pub fn unflatten(
        &mut self,
        ty: Handle<Type>,
        words: &mut dyn Iterator<Item = KernelValue>,
    ) -> Option<KernelValue> {
        if let TypeInner::Scalar(scalar) = self.module.types[ty].inner {
            return words.next().map(|word| self.word_as(word, scalar.kind));
        }
        let components = self
            .parts(ty)?
            .into_iter()
            .map(|part| self.unflatten(part, words))
            .collect::<Option<_>>()?;
        Some(self.add(Expression::Compose { ty, components }))
    }

    fn word_as(&mut self, word: KernelValue, kind: ScalarKind) -> KernelValue {
        match kind {
            ScalarKind::Uint => word,
            ScalarKind::Bool => {
                let zero = self.literal(0);
                self.binary(Op::NotEqual, word, zero)
            }
            _ => self.add(Expression::As { expr: word, kind, convert: None }),
        }
    }

    /// Appends the words of a value.
    pub fn flatten(&mut self, value: KernelValue, ty: Handle<Type>, words: &mut Vec<KernelValue>) {
        if let TypeInner::Scalar(scalar) = self.module.types[ty].inner {
            let word = self.as_word(value, scalar.kind);
            return words.push(word);
        }
        for (index, part) in self.parts(ty).into_iter().flatten().enumerate() {
            let component = self.component(value, index as u32);
            self.flatten(component, part, words);
        }
    }

    /// The types of what a value is made of; `None` where it has no words.
    fn parts(&mut self, ty: Handle<Type>) -> Option<Vec<Handle<Type>>> {
        Some(match self.module.types[ty].inner.clone() {
            TypeInner::Vector { size, scalar } => vec![self.scalar(scalar); size as usize],
            TypeInner::Matrix { columns, rows, scalar } => {
                vec![self.vector(rows, scalar.kind); columns as usize]
            }
            TypeInner::Array { base, size: naga::ArraySize::Constant(count), .. } => {
                vec![base; count.get() as usize]
            }
            TypeInner::Struct { members, .. } => members.iter().map(|member| member.ty).collect(),
            _ => return None,
        })
    }

    fn as_word(&mut self, value: KernelValue, kind: ScalarKind) -> KernelValue {
        match kind {
            ScalarKind::Uint => value,
            ScalarKind::Bool => {
                let (accept, reject) = (self.literal(1), self.literal(0));
                self.add(Expression::Select { condition: value, accept, reject })
            }
            _ => self.add(Expression::As { expr: value, kind: ScalarKind::Uint, convert: None }),
        }
    }
}
