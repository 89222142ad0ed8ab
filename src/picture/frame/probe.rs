//! Rewrites fragment entry points to return words: the bits of their colour, and of their inputs.

use naga::{
    Binding, EntryPoint, Expression, Function, FunctionResult, Handle, Literal, Module, Range,
    Scalar, ScalarKind, Span, Statement, StructMember, Type, TypeInner, VectorSize,
};

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
/// entry point, or if that does not return four numbers at location 0.
pub fn watch_entry(module: &Module, entry: &str) -> Option<Watched> {
    let (mut module, index) = (module.clone(), find_entry(module, entry)?);
    let inner = inner_function(&mut module, index)?;
    let mut body = Body::new(&mut module, index);
    let mut components = vec![body.colour(inner, 0)?];
    components.extend(body.inputs());
    let targets = components.len() as u32;
    body.finish(components, index);
    Some(Watched { module, targets })
}

/// The name of an entry point of [`told_inputs`].
pub const TELLS: &str = "lamplight_tells";

/// The module with a fragment entry point, named [`TELLS`], that only returns its inputs, from
/// location 0 on. `None` without a fragment entry point, or if that has no inputs.
pub fn told_inputs(module: &Module, entry: &str) -> Option<Watched> {
    let (mut module, index) = (module.clone(), find_entry(module, entry)?);
    let mut body = Body::new(&mut module, index);
    let components = body.inputs();
    let targets = components.len() as u32;
    (targets > 0).then(|| body.finish(components, index))?;
    // No other declaration is left, so no writer changes the name.
    let mut told = module.entry_points.swap_remove(index);
    told.name = TELLS.to_owned();
    (module.functions, module.global_variables) = Default::default();
    module.entry_points = vec![told];
    Some(Watched { module, targets })
}

/// The module with a fragment entry point that returns, at location 0, the bits of what it returned
/// at a location. `None` as for [`watch_entry`].
pub fn bits_module(module: &Module, entry: &str, location: u32) -> Option<Module> {
    let (mut module, index) = (module.clone(), find_entry(module, entry)?);
    let inner = inner_function(&mut module, index)?;
    let mut body = Body::new(&mut module, index);
    let colour = body.colour(inner, location)?;
    body.finish(vec![colour], index);
    Some(module)
}

fn find_entry(module: &Module, entry: &str) -> Option<usize> {
    module
        .entry_points
        .iter()
        .position(|point| point.name == entry && point.stage == naga::ShaderStage::Fragment)
}

/// Turns the entry point into a plain function.
fn inner_function(module: &mut Module, index: usize) -> Option<Handle<Function>> {
    let mut function = module.entry_points[index].function.clone();
    function.result.as_mut()?.binding = None;
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
        (0..self.function.arguments.len() as u32)
            .map(|index| self.add(Expression::FunctionArgument(index)))
            .collect()
    }

    /// The words of all arguments in groups of four. Words after the last argument are 0.
    fn inputs(&mut self) -> Vec<Value> {
        let types: Vec<_> = self.function.arguments.iter().map(|argument| argument.ty).collect();
        let mut words = Vec::new();
        for (value, ty) in self.arguments().into_iter().zip(types) {
            self.flatten(value, ty, &mut words);
        }
        let zero = self.literal(0);
        words.resize(words.len().next_multiple_of(4), zero);
        let ty = self.words();
        let four = |four: &[Value]| Expression::Compose { ty, components: four.to_vec() };
        words.chunks(4).map(|words| self.add(four(words))).collect()
    }

    /// The bits of what the function returns at a location.
    fn colour(&mut self, inner: Handle<Function>, location: u32) -> Option<Value> {
        let arguments = self.arguments();
        let ty = self.module.functions[inner].result.as_ref()?.ty;
        let member = match &self.module.types[ty].inner {
            TypeInner::Vector { size: VectorSize::Quad, .. } => None,
            TypeInner::Struct { members, .. } => {
                Some(members.iter().position(|member| is_colour(self.module, member, location))?)
            }
            _ => return None,
        };
        let result =
            self.function.expressions.append(Expression::CallResult(inner), Span::UNDEFINED);
        self.function.body.push(
            Statement::Call { function: inner, arguments, result: Some(result) },
            Span::UNDEFINED,
        );
        let index = |index: usize| Expression::AccessIndex { base: result, index: index as u32 };
        let colour = member.map_or(result, |member| self.add(index(member)));
        Some(self.add(Expression::As { expr: colour, kind: ScalarKind::Uint, convert: None }))
    }

    /// Returns one value of four words at each location.
    fn finish(mut self, components: Vec<Value>, index: usize) {
        let four = self.words();
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
        let ty = self.ty(TypeInner::Struct { span: 16 * members.len() as u32, members });
        let value = self.add(Expression::Compose { ty, components });
        self.function.result = Some(FunctionResult { ty, binding: None });
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
            TypeInner::Vector { size, scalar } => {
                vec![self.ty(TypeInner::Scalar(scalar)); size as usize]
            }
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
            self.function
                .body
                .push(Statement::Emit(Range::new_from_bounds(value, value)), Span::UNDEFINED);
        }
        value
    }
}

fn is_colour(module: &Module, member: &StructMember, location: u32) -> bool {
    matches!(member.binding, Some(Binding::Location { location: found, .. }) if found == location)
        && matches!(module.types[member.ty].inner, TypeInner::Vector { size: VectorSize::Quad, .. })
}
