//! Wraps a function under test into a fragment shader that every executor can run.
//!
//! Each invocation is one call. Its arguments are 32-bit words in a `Rgba32Uint` texture, and its
//! result goes as words to a `Rgba32Uint` target. So results are exact to the bit. Every backend
//! can render to this format, but not every one to `Rgba32Float`: Mesa's GL driver cannot. Storage
//! buffers are avoided, since on software drivers derivatives of their values are wrong along the
//! diagonal of a full-screen triangle.
//!
//! | texture | texel | holds |
//! |---|---|---|
//! | inputs, [`INPUT_WIDTH`] wide | 0 | count of invocations, pixels of the target, run number, 0 |
//! | | `1 + i*t ..` | words of invocation `i`, in `t` = [`Kernel::input_texels`] texels |
//! | target, [`TARGET_WIDTH`] wide | first, last | echo: the header with `ECHO ^ index` as last word |
//! | | `1 + i*p + j` | words `4j..4j+4` of invocation `i`, `p` = [`Kernel::result_texels`] |
//!
//! Pixels after the last invocation repeat it, so that no fragment returns early.
//!
//! A [`TypeShape`] is the shape of a value as 32-bit words, which is how arguments and results are
//! flattened.

mod wrap;

use crate::fixture::Fixture;
use lamplight_diagnostic::{Diagnostic, codes};
use lamplight_files::limits::CASE_WORK;
use naga::{
    ArraySize, Function, Handle, ImageClass, ImageDimension, Module, ScalarKind, Type, TypeInner,
};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
pub use wrap::{FunctionBody, KernelValue, varying_modules};

/// Texels in a row of the input texture.
pub const INPUT_WIDTH: u32 = 1024;
/// Pixels in a row of the target. A row has 4,096 bytes, so it needs no padding when it is copied.
pub const TARGET_WIDTH: u32 = 256;
/// The most rows of a texture that every backend allows.
pub const MAX_ROWS: u32 = 8192;
/// The most invocations of one draw, if their words fit.
pub const BATCH: u32 = 65_536;
/// The last word of an echo pixel is this, exclusive-or the pixel's index.
pub const ECHO: u32 = 0x6c61_6d70;
/// The value of every word of a pixel that nothing was written to.
pub const SENTINEL: u32 = 0xdead_beef;
/// Name of the fragment entry point.
pub const ENTRY: &str = "lamplight_kernel";

/// A parameter of the function, in the order of declaration.
#[derive(Debug, Clone)]
pub struct Parameter {
    pub name: String,
    pub kind: ParameterKind,
}

/// Where a parameter's value comes from.
#[derive(Debug, Clone)]
pub enum ParameterKind {
    /// Words of the input, beginning with the one at `offset`.
    Words { offset: u32, shape: TypeShape },
    /// A global binding, filled from a fixture.
    Resource(Resource),
}

/// A texture or a sampler bound in group 0.
#[derive(Debug, Clone)]
pub struct Resource {
    pub binding: u32,
    pub class: ResourceClass,
    pub fixture: Arc<Fixture>,
}

/// What the shader declares a binding as.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ResourceClass {
    Texture { dim: ImageDimension, arrayed: bool, class: ImageClass },
    Sampler { comparison: bool },
}

/// A function with an entry point around it, ready for any [`super::Session`].
#[derive(Debug)]
pub struct Kernel {
    /// Distinguishes the kernels of a process.
    pub id: u64,
    /// The id of the first kernel with the same code and the same fixtures. Sessions keep under it
    /// what they have compiled.
    pub code: u64,
    /// Name of the function under test.
    pub name: String,
    /// The module with [`ENTRY`] as its only entry point.
    pub module: Module,
    /// The function under test in `module`.
    pub function: Handle<Function>,
    pub parameters: Vec<Parameter>,
    /// The function's result, then the values behind its pointer parameters after the call.
    pub results: Vec<TypeShape>,
    /// Steps that all calls of it together may take on the evaluator.
    pub steps: u64,
    /// For a function of GLSL, the text that declares it and what it needs, with combined samplers
    /// and without a version: for drivers that compile the text themselves.
    pub source: Option<Arc<str>>,
}

impl Kernel {
    /// Words of one invocation's arguments.
    pub fn input_words(&self) -> u32 {
        self.words().map(|(_, shape)| shape.words()).sum()
    }

    /// Words of one invocation's results.
    pub fn result_words(&self) -> u32 {
        self.results.iter().map(TypeShape::words).sum()
    }

    /// Input texels of one invocation.
    pub fn input_texels(&self) -> u32 {
        self.input_words().div_ceil(4)
    }

    /// Pixels of one invocation.
    pub fn result_texels(&self) -> u32 {
        self.result_words().div_ceil(4).max(1)
    }

    /// The rows of the target of one draw, and the header of its inputs.
    pub fn draw_header(&self, count: u32, run: u32) -> (u32, [u32; 4]) {
        let rows = (count * self.result_texels() + 2).div_ceil(TARGET_WIDTH);
        (rows, [count, rows * TARGET_WIDTH, run, 0])
    }

    /// Scalar kind of each result word.
    pub fn result_kinds(&self) -> Vec<ScalarKind> {
        self.results.iter().flat_map(TypeShape::kinds).collect()
    }

    /// The parameters that are words: name and shape, in the order of their words.
    pub fn words(&self) -> impl Iterator<Item = (&str, &TypeShape)> {
        self.parameters.iter().filter_map(|parameter| match &parameter.kind {
            ParameterKind::Words { shape, .. } => Some((parameter.name.as_str(), shape)),
            ParameterKind::Resource(_) => None,
        })
    }

    /// Parameters that are bindings.
    pub fn resources(&self) -> impl Iterator<Item = &Resource> {
        self.parameters.iter().filter_map(|parameter| match &parameter.kind {
            ParameterKind::Resource(resource) => Some(resource),
            ParameterKind::Words { .. } => None,
        })
    }

    /// What is bound at a binding.
    pub fn fixture_at(&self, binding: u32) -> Option<&Fixture> {
        self.resources().find(|found| found.binding == binding).map(|found| &*found.fixture)
    }

    /// The most invocations of one draw.
    pub fn batch(&self) -> u32 {
        let by_inputs = (MAX_ROWS * INPUT_WIDTH - 1) / self.input_texels().max(1);
        let by_results = (MAX_ROWS * TARGET_WIDTH - 2) / self.result_texels();
        BATCH.min(by_inputs).min(by_results)
    }
}

/// The kernels that are still to be compiled: the first one of each code that is not kept.
pub fn kernels_to_compile<'k>(
    kernels: &[&'k Kernel],
    is_kept: impl Fn(u64) -> bool,
) -> Vec<&'k Kernel> {
    let mut seen = BTreeSet::new();
    let is_new = |kernel: &&Kernel| !is_kept(kernel.code) && seen.insert(kernel.code);
    kernels.iter().copied().filter(is_new).collect()
}

/// Wraps `function` of a module; textures and samplers among its parameters are bound to the
/// fixtures of their names.
///
/// It is an error if there is no such function, if a parameter or the result does not consist of
/// 32-bit values, or if a fixture is missing.
pub fn build_kernel(
    module: &Module,
    function: &str,
    fixtures: &BTreeMap<String, Arc<Fixture>>,
) -> Result<Kernel, Diagnostic> {
    let handle = find_function(module, function)?;
    let parameters = kernel_parameters(module, handle, fixtures)?;
    let results = kernel_results(module, handle)?;
    let id = next_id();
    let kernel = Kernel {
        id,
        code: id,
        name: function.to_owned(),
        module: Module::default(),
        function: handle,
        parameters,
        results,
        steps: CASE_WORK,
        source: None,
    };
    if kernel.batch() == 0 {
        return Err(Diagnostic::error(
            codes::UNTESTABLE_FUNCTION,
            format!("the words of `{function}` do not fit into a texture"),
        ));
    }
    let (module, function) = wrap::wrap_kernel(module, &kernel)?;
    Ok(Kernel { module, function, ..kernel })
}

fn next_id() -> u64 {
    static NEXT: AtomicU64 = AtomicU64::new(0);
    NEXT.fetch_add(1, Ordering::Relaxed)
}

fn find_function(module: &Module, name: &str) -> Result<Handle<Function>, Diagnostic> {
    let named = |function: &Function| function.name.as_deref() == Some(name);
    module
        .functions
        .iter()
        .find(|(_, function)| named(function))
        .map(|(handle, _)| handle)
        .ok_or_else(|| {
            let known =
                module.functions.iter().filter_map(|(_, function)| function.name.as_deref());
            Diagnostic::error(codes::UNKNOWN_FUNCTION, format!("there is no function `{name}`"))
                .suggest(name, known)
        })
}

fn kernel_parameters(
    module: &Module,
    function: Handle<Function>,
    fixtures: &BTreeMap<String, Arc<Fixture>>,
) -> Result<Vec<Parameter>, Diagnostic> {
    let (mut offset, mut binding) = (0, 0);
    let mut found = Vec::new();
    for (index, argument) in module.functions[function].arguments.iter().enumerate() {
        let name = argument.name.clone().unwrap_or_else(|| format!("parameter {index}"));
        let kind = match resource_class(module, argument.ty) {
            Some(class) => {
                binding += 1;
                ParameterKind::Resource(Resource {
                    binding,
                    class,
                    fixture: named_fixture(fixtures, &name, class)?,
                })
            }
            None => {
                let shape = TypeShape::of(module, pointed_type(module, argument.ty))
                    .ok_or_else(|| untestable_function(&name))?;
                let first = offset;
                offset = shape.words().saturating_add(offset);
                ParameterKind::Words { offset: first, shape }
            }
        };
        found.push(Parameter { name, kind });
    }
    Ok(found)
}

fn kernel_results(
    module: &Module,
    function: Handle<Function>,
) -> Result<Vec<TypeShape>, Diagnostic> {
    let function = &module.functions[function];
    let returned = function.result.as_ref().map(|result| result.ty);
    let written = function
        .arguments
        .iter()
        .filter(|argument| pointed_type(module, argument.ty) != argument.ty);
    let types =
        returned.into_iter().chain(written.map(|argument| pointed_type(module, argument.ty)));
    types.map(|ty| TypeShape::of(module, ty).ok_or_else(|| untestable_function("result"))).collect()
}

/// The type behind a pointer to a local variable, or the type itself.
fn pointed_type(module: &Module, ty: Handle<naga::Type>) -> Handle<naga::Type> {
    match module.types[ty].inner {
        TypeInner::Pointer { base, space: naga::AddressSpace::Function } => base,
        _ => ty,
    }
}

fn resource_class(module: &Module, ty: Handle<naga::Type>) -> Option<ResourceClass> {
    match module.types[ty].inner {
        TypeInner::Image { dim, arrayed, class } => {
            Some(ResourceClass::Texture { dim, arrayed, class })
        }
        TypeInner::Sampler { comparison } => Some(ResourceClass::Sampler { comparison }),
        _ => None,
    }
}

fn named_fixture(
    fixtures: &BTreeMap<String, Arc<Fixture>>,
    name: &str,
    class: ResourceClass,
) -> Result<Arc<Fixture>, Diagnostic> {
    let Some(found) = fixtures.get(name) else {
        let error = Diagnostic::error(
            codes::FIXTURE_MISMATCH,
            format!("the parameter `{name}` needs a fixture"),
        );
        return Err(error.suggest(name, fixtures.keys().map(String::as_str)));
    };
    if !found.fits(class) {
        let message = format!(
            "the fixture of `{name}` is {}, the shader declares {}",
            found.describe(),
            describe_class(class)
        );
        return Err(Diagnostic::error(codes::FIXTURE_MISMATCH, message));
    }
    Ok(found.clone())
}

fn describe_class(class: ResourceClass) -> String {
    match class {
        ResourceClass::Texture { dim, arrayed, class } => {
            format!("a texture ({dim:?}, arrayed: {arrayed}, {class:?})")
        }
        ResourceClass::Sampler { comparison: true } => "a comparison sampler".to_owned(),
        ResourceClass::Sampler { comparison: false } => "a sampler".to_owned(),
    }
}

fn untestable_function(name: &str) -> Diagnostic {
    Diagnostic::error(
        codes::UNTESTABLE_FUNCTION,
        format!("`{name}` has a type that is not made of 32-bit values"),
    )
}

/// One word as a number.
pub fn word_value(word: u32, kind: ScalarKind) -> f64 {
    match kind {
        ScalarKind::Sint => f64::from(word as i32),
        ScalarKind::Uint => f64::from(word),
        ScalarKind::Bool => f64::from(u8::from(word != 0)),
        _ => f64::from(f32::from_bits(word)),
    }
}

/// A type without layout: its words follow each other in the order of declaration, matrices by
/// columns, without padding.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum TypeShape {
    /// One word: f32, i32, u32 or bool.
    Scalar(ScalarKind),
    /// Two to four words.
    Vector { size: u32, kind: ScalarKind },
    /// `columns * rows` words, column by column; always f32.
    Matrix { columns: u32, rows: u32 },
    /// The elements in order.
    Array { base: Box<TypeShape>, count: u32 },
    /// The members in order, by name.
    Struct { members: Vec<(String, TypeShape)> },
}

/// Columns of two to four rows.
static COLUMNS: [TypeShape; 3] = [column_shape(2), column_shape(3), column_shape(4)];
static SCALARS: [TypeShape; 4] = [
    TypeShape::Scalar(ScalarKind::Float),
    TypeShape::Scalar(ScalarKind::Sint),
    TypeShape::Scalar(ScalarKind::Uint),
    TypeShape::Scalar(ScalarKind::Bool),
];
const COMPONENTS: [&str; 4] = ["x", "y", "z", "w"];

const fn column_shape(size: u32) -> TypeShape {
    TypeShape::Vector { size, kind: ScalarKind::Float }
}

impl TypeShape {
    /// The shape of a naga type; `None` for a type whose values are not words.
    pub fn of(module: &Module, ty: Handle<Type>) -> Option<Self> {
        match module.types[ty].inner {
            TypeInner::Scalar(scalar) => word_kind(scalar).map(Self::Scalar),
            TypeInner::Vector { size, scalar } => {
                Some(Self::Vector { size: size as u32, kind: word_kind(scalar)? })
            }
            TypeInner::Matrix { columns, rows, scalar } => word_kind(scalar)
                .map(|_| Self::Matrix { columns: columns as u32, rows: rows as u32 }),
            TypeInner::Array { base, size: ArraySize::Constant(count), .. } => {
                Some(Self::Array { base: Box::new(Self::of(module, base)?), count: count.get() })
            }
            TypeInner::Struct { ref members, .. } => {
                let members = members
                    .iter()
                    .map(|member| Some((member.name.clone()?, Self::of(module, member.ty)?)));
                Some(Self::Struct { members: members.collect::<Option<_>>()? })
            }
            _ => None,
        }
    }

    /// Number of 32-bit words.
    pub fn words(&self) -> u32 {
        match self {
            Self::Scalar(_) => 1,
            Self::Vector { size, .. } => *size,
            Self::Matrix { columns, rows } => columns * rows,
            Self::Array { base, count } => base.words().saturating_mul(*count),
            Self::Struct { members } => {
                members.iter().map(|(_, shape)| shape.words()).fold(0, u32::saturating_add)
            }
        }
    }

    /// The scalar kind of every word, in order.
    pub fn kinds(&self) -> Vec<ScalarKind> {
        match self {
            Self::Scalar(kind) => vec![*kind],
            Self::Vector { size, kind } => vec![*kind; *size as usize],
            Self::Matrix { columns, rows } => vec![ScalarKind::Float; (columns * rows) as usize],
            Self::Array { base, count } => base.kinds().repeat(*count as usize),
            Self::Struct { members } => {
                members.iter().flat_map(|(_, shape)| shape.kinds()).collect()
            }
        }
    }

    /// The part at a path, with the index of its first word. A path consists of member names, array
    /// indices, numbers of matrix columns, and letters of vector components.
    pub fn part(&self, path: &[String]) -> Option<(u32, &Self)> {
        let Some((first, rest)) = path.split_first() else { return Some((0, self)) };
        let (skipped, inner) = match self {
            Self::Struct { members } => {
                let index = members.iter().position(|(name, _)| name == first)?;
                (members[..index].iter().map(|(_, shape)| shape.words()).sum(), &members[index].1)
            }
            Self::Array { base, count } => {
                let index: u32 = first.parse().ok().filter(|index| index < count)?;
                (index * base.words(), &**base)
            }
            Self::Matrix { columns, rows } => {
                let index: u32 = first.parse().ok().filter(|index| index < columns)?;
                (index * rows, COLUMNS.get(*rows as usize - 2)?)
            }
            Self::Vector { size, kind } => {
                let index = COMPONENTS
                    .iter()
                    .position(|name| name == first)
                    .filter(|index| *index < *size as usize)?;
                (index as u32, SCALARS.iter().find(|scalar| **scalar == Self::Scalar(*kind))?)
            }
            Self::Scalar(_) => return None,
        };
        let (offset, part) = inner.part(rest)?;
        Some((skipped + offset, part))
    }
}

fn word_kind(scalar: naga::Scalar) -> Option<ScalarKind> {
    let is_bool = scalar.kind == ScalarKind::Bool;
    (is_bool || scalar.width == 4).then_some(scalar.kind)
}
