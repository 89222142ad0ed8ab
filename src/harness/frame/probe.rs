//! Fragment entry points rewritten to give words: the bits of what they return, or of what they
//! are given.

use naga::{
    Binding, EntryPoint, Expression, Function, FunctionResult, Handle, Literal, Module, Range, Scalar, ScalarKind, Span, Statement, Type,
    TypeInner, VectorSize,
};

/// The module with the fragment entry point returning the bits of its colour, and under the same
/// name. `None` without such an entry point, or where it returns no four numbers.
pub fn colors(module: &Module, entry: &str) -> Option<Module> {
    let (mut module, index) = (module.clone(), find(module, entry)?);
    let inner = inner(&mut module, index)?;
    let mut body = Body::new(&mut module, index);
    let arguments = body.arguments();
    let result = body.function.expressions.append(Expression::CallResult(inner), Span::UNDEFINED);
    body.function.body.push(Statement::Call { function: inner, arguments, result: Some(result) }, Span::UNDEFINED);
    let bits = body.add(Expression::As { expr: result, kind: ScalarKind::Uint, convert: None });
    body.finish(bits, index);
    Some(module)
}

/// The module with the fragment entry point returning four words of its inputs, flattened, from
/// the word `first` on; 0 behind the last one.
pub fn inputs(module: &Module, entry: &str, first: usize) -> Option<Module> {
    let (mut module, index) = (module.clone(), find(module, entry)?);
    let mut body = Body::new(&mut module, index);
    let mut words = Vec::new();
    let types: Vec<_> = body.function.arguments.iter().map(|argument| argument.ty).collect();
    for (value, ty) in body.arguments().into_iter().zip(types) {
        body.flatten(value, ty, &mut words);
    }
    let zero = body.literal(0);
    let components = (first..first + 4).map(|word| words.get(word).copied().unwrap_or(zero)).collect();
    let ty = body.words();
    let four = body.add(Expression::Compose { ty, components });
    body.finish(four, index);
    Some(module)
}

fn find(module: &Module, entry: &str) -> Option<usize> {
    module.entry_points.iter().position(|point| point.name == entry && point.stage == naga::ShaderStage::Fragment)
}

/// The entry point as a plain function.
fn inner(module: &mut Module, index: usize) -> Option<Handle<Function>> {
    let mut function = module.entry_points[index].function.clone();
    let result = function.result.as_mut()?;
    matches!(module.types[result.ty].inner, TypeInner::Vector { size: VectorSize::Quad, .. }).then_some(())?;
    result.binding = None;
    function.arguments.iter_mut().for_each(|argument| argument.binding = None);
    function.name = Some("lamplight_inner".to_owned());
    Some(module.functions.append(function, Span::UNDEFINED))
}

/// A new body for an entry point.
struct Body<'a> {
    module: &'a mut Module,
    function: Function,
}

type Value = Handle<Expression>;

impl<'a> Body<'a> {
    fn new(module: &'a mut Module, index: usize) -> Self {
        let arguments = module.entry_points[index].function.arguments.clone();
        Self { module, function: Function { arguments, ..Function::default() } }
    }

    fn arguments(&mut self) -> Vec<Value> {
        (0..self.function.arguments.len() as u32).map(|index| self.add(Expression::FunctionArgument(index))).collect()
    }

    fn finish(mut self, value: Value, index: usize) {
        let ty = self.words();
        let binding = Binding::Location { location: 0, interpolation: None, sampling: None, blend_src: None, per_primitive: false };
        self.function.result = Some(FunctionResult { ty, binding: Some(binding) });
        self.function.body.push(Statement::Return { value: Some(value) }, Span::UNDEFINED);
        let entry: &mut EntryPoint = &mut self.module.entry_points[index];
        entry.function = self.function;
    }

    fn flatten(&mut self, value: Value, ty: Handle<Type>, words: &mut Vec<Value>) {
        let parts: Vec<Handle<Type>> = match self.module.types[ty].inner.clone() {
            TypeInner::Scalar(scalar) => {
                let word = self.word(value, scalar.kind);
                return words.push(word);
            }
            TypeInner::Vector { size, scalar } => vec![self.ty(TypeInner::Scalar(scalar)); size as usize],
            TypeInner::Struct { members, .. } => members.iter().map(|member| member.ty).collect(),
            _ => Vec::new(),
        };
        for (index, part) in parts.into_iter().enumerate() {
            let component = self.add(Expression::AccessIndex { base: value, index: index as u32 });
            self.flatten(component, part, words);
        }
    }

    fn word(&mut self, value: Value, kind: ScalarKind) -> Value {
        match kind {
            ScalarKind::Uint => value,
            ScalarKind::Bool => {
                let (accept, reject) = (self.literal(1), self.literal(0));
                self.add(Expression::Select { condition: value, accept, reject })
            }
            _ => self.add(Expression::As { expr: value, kind: ScalarKind::Uint, convert: None }),
        }
    }

    fn words(&mut self) -> Handle<Type> {
        self.ty(TypeInner::Vector { size: VectorSize::Quad, scalar: Scalar::U32 })
    }

    fn ty(&mut self, inner: TypeInner) -> Handle<Type> {
        self.module.types.insert(Type { name: None, inner }, Span::UNDEFINED)
    }

    fn literal(&mut self, value: u32) -> Value {
        self.add(Expression::Literal(Literal::U32(value)))
    }

    fn add(&mut self, expression: Expression) -> Value {
        let emitted = !expression.needs_pre_emit();
        let value = self.function.expressions.append(expression, Span::UNDEFINED);
        if emitted {
            self.function.body.push(Statement::Emit(Range::new_from_bounds(value, value)), Span::UNDEFINED);
        }
        value
    }
}
