//! What callers can notice of a function besides its signature.

use std::collections::BTreeSet;

use naga::valid::FunctionInfo;
use naga::{
    Block, Expression, Function, Handle, ImageClass, ImageDimension, Module, SampleLevel,
    ShaderStage, Statement, TypeInner,
};

use super::outline::{ContentKey, hash_parts};

/// Facts about a callee that writers, the reflection and the lints use.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct FunctionSummary {
    /// Names of the module's variables that it uses, itself or through its callees. Metal passes
    /// them as arguments.
    pub globals: BTreeSet<String>,
    /// Textures and samplers that it uses together. GLSL combines them.
    pub pairs: BTreeSet<SampledPair>,
    /// What its callers notice of it by the rules of WGSL.
    pub rules: lamplight_rules::Summary,
    /// It, or a function that it calls, breaks one of these.
    pub breaks_rules: bool,
    /// It cannot be called in a vertex stage.
    pub only_fragments: bool,
    /// A hash of all of the above.
    pub key: ContentKey,
}

/// A texture and a sampler that are used together.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct SampledPair {
    pub texture: ResourceOrigin,
    pub sampler: ResourceOrigin,
    pub shape: TextureShape,
}

/// Where a texture or a sampler comes from.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub enum ResourceOrigin {
    Global(String),
    /// The argument at that index.
    Argument(u32),
}

/// What kind of texture it is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct TextureShape {
    /// Components of a coordinate.
    pub coordinates: u8,
    pub arrayed: bool,
    /// `depth` is for a depth texture, `compares` for a comparison sampler.
    pub depth: bool,
    pub compares: bool,
}

/// Names of the module's variables that a function uses. `None` if one of them has no name.
pub fn used_globals(module: &Module, info: &FunctionInfo) -> Option<BTreeSet<String>> {
    let used = module.global_variables.iter().filter(|(handle, _)| !info[*handle].is_empty());
    used.map(|(_, variable)| variable.name.clone()).collect()
}

/// Summarises a function. `callee` gives the summaries of the functions that it calls. `None` where
/// a texture or a sampler comes neither from a variable nor from an argument.
pub fn summarise_function<'s>(
    module: &Module,
    info: &FunctionInfo,
    function: &Function,
    callee: &dyn Fn(Handle<Function>) -> Option<&'s FunctionSummary>,
) -> Option<FunctionSummary> {
    let mut summary =
        FunctionSummary { globals: used_globals(module, info)?, ..FunctionSummary::default() };
    for (_, expression) in function.expressions.iter() {
        summary.only_fragments |= is_derivative(expression);
        if let Expression::ImageSample { image, sampler, .. } = expression {
            let shape = sample_shape(module, info, *image, *sampler)?;
            let (texture, sampler) = (
                resource_place(module, function, *image)?,
                resource_place(module, function, *sampler)?,
            );
            summary.pairs.insert(SampledPair { texture, sampler, shape });
        }
    }
    let mut walk = SummaryWalk { module, function, callee, summary };
    walk.block(&function.body)?;
    Some(walk.summary)
}

fn is_derivative(expression: &Expression) -> bool {
    matches!(
        expression,
        Expression::Derivative { .. }
            | Expression::ImageSample { level: SampleLevel::Auto | SampleLevel::Bias(_), .. }
    )
}

fn resource_place(
    module: &Module,
    function: &Function,
    handle: Handle<Expression>,
) -> Option<ResourceOrigin> {
    match function.expressions[handle] {
        Expression::GlobalVariable(variable) => {
            module.global_variables[variable].name.clone().map(ResourceOrigin::Global)
        }
        Expression::FunctionArgument(number) => Some(ResourceOrigin::Argument(number)),
        _ => None,
    }
}

fn sample_shape(
    module: &Module,
    info: &FunctionInfo,
    image: Handle<Expression>,
    sampler: Handle<Expression>,
) -> Option<TextureShape> {
    let TypeInner::Image { dim, arrayed, class } = *info[image].ty.inner_with(&module.types) else {
        return None;
    };
    let compares = matches!(
        info[sampler].ty.inner_with(&module.types),
        TypeInner::Sampler { comparison: true }
    );
    let depth = match class {
        ImageClass::Depth { multi: false } => true,
        ImageClass::Sampled { kind: naga::ScalarKind::Float, multi: false } => false,
        _ => return None,
    };
    let coordinates = match dim {
        ImageDimension::D1 => 1,
        ImageDimension::D2 => 2,
        ImageDimension::D3 | ImageDimension::Cube => 3,
    };
    Some(TextureShape { coordinates, arrayed, depth, compares })
}

/// Walks over a function's statements.
struct SummaryWalk<'w, 's> {
    module: &'w Module,
    function: &'w Function,
    callee: &'w dyn Fn(Handle<Function>) -> Option<&'s FunctionSummary>,
    summary: FunctionSummary,
}

impl SummaryWalk<'_, '_> {
    fn block(&mut self, block: &Block) -> Option<()> {
        block.iter().try_for_each(|statement| self.statement(statement))
    }

    fn statement(&mut self, statement: &Statement) -> Option<()> {
        match statement {
            Statement::Block(block) => self.block(block)?,
            Statement::If { condition: _, accept, reject } => {
                self.block(accept)?;
                self.block(reject)?;
            }
            Statement::Switch { selector: _, cases } => {
                cases.iter().try_for_each(|case| self.block(&case.body))?;
            }
            Statement::Loop { body, continuing, break_if: _ } => {
                self.block(body)?;
                self.block(continuing)?;
            }
            Statement::Kill => self.summary.only_fragments = true,
            Statement::Call { function, arguments, result: _ } => {
                self.call(*function, arguments)?
            }
            _ => {}
        }
        Some(())
    }

    fn call(&mut self, function: Handle<Function>, arguments: &[Handle<Expression>]) -> Option<()> {
        let callee = (self.callee)(function)?;
        self.summary.only_fragments |= callee.only_fragments;
        for pair in &callee.pairs {
            let at_call = |place: &ResourceOrigin| match place {
                ResourceOrigin::Global(_) => Some(place.clone()),
                ResourceOrigin::Argument(number) => {
                    let argument = *arguments.get(*number as usize)?;
                    self::resource_place(self.module, self.function, argument)
                }
            };
            let (texture, sampler) = (at_call(&pair.texture)?, at_call(&pair.sampler)?);
            self.summary.pairs.insert(SampledPair { texture, sampler, shape: pair.shape });
        }
        Some(())
    }
}

impl FunctionSummary {
    /// The same with its key.
    pub fn with_key(mut self) -> Self {
        self.key = hash_parts([format!("{self:?}").as_bytes()]);
        self
    }

    /// Whether an entry point of the stage may reach the function.
    pub fn is_for(&self, stage: ShaderStage) -> bool {
        stage == ShaderStage::Fragment || !self.only_fragments
    }
}
