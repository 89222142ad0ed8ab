//! Functions in HLSL or MSL with a kernel around them, for the compilers of these languages.
//!
//! As in [`crate::source`], nothing of naga is between the text and the result. The text is that of
//! [`Kernel::source`]. Arguments and results are reached number by number, so structures and arrays
//! need no constructors.

use std::fmt::Write as _;

use crate::kernel::{ECHO, INPUT_WIDTH, Kernel, ParameterKind, ResourceClass, TARGET_WIDTH};
use crate::{Session, executors};
use lamplight_bundle::{BindingSlot, Native, Target};
use lamplight_diagnostic::{Diagnostic, codes};
use naga::{ArraySize, Handle, ImageClass, ImageDimension, Module, ScalarKind, Type, TypeInner};

/// A session that compiles the text of a kernel's source as HLSL or MSL.
///
/// # Errors
/// A message: what is not installed, or that there is no such session for the target.
pub fn open_written(target: Target) -> Result<Box<dyn Session>, String> {
    executors::open_written(target).map_err(|unavailable| unavailable.reason)
}

/// The language of a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum WrittenLanguage {
    Hlsl,
    Msl,
}

const ENTRY: &str = "lamplight_main";

/// The fragment stage of a kernel, and where its bindings are.
pub(crate) fn fragment_text(
    kernel: &Kernel,
    language: WrittenLanguage,
) -> Result<(String, Native), Diagnostic> {
    let source = kernel.source.as_deref().ok_or_else(|| {
        Diagnostic::error(codes::EXECUTOR_LACKS, "the function has no text in this language")
    })?;
    let writer = KernelWriter { kernel, language };
    let bindings = writer.bindings()?;
    let mut text = format!("{source}\n");
    let declared: Vec<String> = bindings.iter().map(|one| writer.declared(one)).collect();
    match language {
        WrittenLanguage::Hlsl => {
            declared.iter().for_each(|line| text += &format!("{line};\n"));
            let _ =
                writeln!(text, "uint4 {ENTRY}(float4 lamplight_at : SV_Position) : SV_Target0 {{");
        }
        WrittenLanguage::Msl => {
            let _ = writeln!(
                text,
                "struct lamplight_output {{ uint4 words [[color(0)]]; }};\n\
                 fragment lamplight_output {ENTRY}(float4 lamplight_at [[position]], {}) {{",
                declared.join(", ")
            );
        }
    }
    text += &writer.body()?;
    let slots = bindings
        .iter()
        .map(|one| BindingSlot {
            group: 0,
            binding: one.binding,
            space: None,
            index: Some(one.binding),
            register: None,
            name: None,
        })
        .collect();
    let native = Native { entry_name: ENTRY.to_owned(), slots, ..Native::default() };
    Ok((text, native))
}

/// A texture or a sampler of a kernel.
struct KernelBinding {
    binding: u32,
    name: String,
    ty: String,
    is_sampler: bool,
}

struct KernelWriter<'a> {
    kernel: &'a Kernel,
    language: WrittenLanguage,
}

impl KernelWriter<'_> {
    fn module(&self) -> &Module {
        &self.kernel.module
    }

    /// The inputs, then the fixtures.
    fn bindings(&self) -> Result<Vec<KernelBinding>, Diagnostic> {
        let ty = match self.language {
            WrittenLanguage::Hlsl => "Texture2D<uint4>",
            WrittenLanguage::Msl => "texture2d<uint>",
        };
        let mut bindings = vec![KernelBinding {
            binding: 0,
            name: "lamplight_inputs".to_owned(),
            ty: ty.to_owned(),
            is_sampler: false,
        }];
        for resource in self.kernel.resources() {
            let (ty, is_sampler) = match resource.class {
                ResourceClass::Sampler { comparison } => (self.sampler(comparison), true),
                ResourceClass::Texture { dim, arrayed, class } => {
                    (self.texture(dim, arrayed, class).ok_or_else(unknown_texture)?, false)
                }
            };
            let name = format!("lamplight_binding{}", resource.binding);
            let ty = ty.to_owned();
            bindings.push(KernelBinding { binding: resource.binding, name, ty, is_sampler });
        }
        Ok(bindings)
    }

    fn sampler(&self, compares: bool) -> &'static str {
        match (self.language, compares) {
            (WrittenLanguage::Hlsl, false) => "SamplerState",
            (WrittenLanguage::Hlsl, true) => "SamplerComparisonState",
            (WrittenLanguage::Msl, _) => "sampler",
        }
    }

    fn texture(
        &self,
        dim: ImageDimension,
        arrayed: bool,
        class: ImageClass,
    ) -> Option<&'static str> {
        let is_depth = match class {
            ImageClass::Sampled { kind: ScalarKind::Float, multi: false } => false,
            ImageClass::Depth { multi: false } => true,
            ImageClass::Sampled { .. }
            | ImageClass::Depth { .. }
            | ImageClass::Storage { .. }
            | ImageClass::External => return None,
        };
        let of = |hlsl, msl| match self.language {
            WrittenLanguage::Hlsl => Some(hlsl),
            WrittenLanguage::Msl => Some(msl),
        };
        match (dim, is_depth) {
            _ if arrayed => None,
            (ImageDimension::D2, false) => of("Texture2D<float4>", "texture2d<float>"),
            (ImageDimension::D2, true) => of("Texture2D<float>", "depth2d<float>"),
            (ImageDimension::Cube, false) => of("TextureCube<float4>", "texturecube<float>"),
            (ImageDimension::Cube, true) => of("TextureCube<float>", "depthcube<float>"),
            (ImageDimension::D1 | ImageDimension::D3, _) => None,
        }
    }

    fn declared(&self, binding: &KernelBinding) -> String {
        let KernelBinding { binding, name, ty, is_sampler } = binding;
        let word = if *is_sampler { "sampler" } else { "texture" };
        match self.language {
            WrittenLanguage::Hlsl => format!("[[vk::binding({binding}, 0)]] {ty} {name}"),
            WrittenLanguage::Msl => format!("{ty} {name} [[{word}({binding})]]"),
        }
    }

    /// A texel of the inputs.
    fn texel(&self, number: &str) -> String {
        let place = format!("{number} % {INPUT_WIDTH}u, {number} / {INPUT_WIDTH}u");
        match self.language {
            WrittenLanguage::Hlsl => format!("lamplight_inputs.Load(int3({place}, 0))"),
            WrittenLanguage::Msl => format!("lamplight_inputs.read(uint2({place}), 0u)"),
        }
    }

    fn body(&self) -> Result<String, Diagnostic> {
        let (texels, pixels) = (self.kernel.input_texels(), self.kernel.result_texels());
        let mut text = format!(
            "    uint4 lamplight_header = {};
    uint lamplight_index = uint(lamplight_at.y) * {TARGET_WIDTH}u + uint(lamplight_at.x);
    uint lamplight_pixel = lamplight_index - min(lamplight_index, 1u);
    uint lamplight_call = min(lamplight_pixel / {pixels}u, lamplight_header.x - 1u);
    uint lamplight_part = 4u * (lamplight_pixel % {pixels}u);
    uint lamplight_first = 1u + lamplight_call * {texels}u;
",
            self.texel("0u")
        );
        for texel in 0..texels {
            let read = self.texel(&format!("(lamplight_first + {texel}u)"));
            let _ = writeln!(text, "    uint4 lamplight_input{texel} = {read};");
        }
        let words = self.call(&mut text)?;
        let count = words.len().div_ceil(4).max(1) * 4;
        let _ = writeln!(text, "    uint lamplight_words[{count}];");
        for index in 0..count {
            let word = words.get(index).map_or("0u", String::as_str);
            let _ = writeln!(text, "    lamplight_words[{index}] = {word};");
        }
        let part = |at: u32| format!("lamplight_words[lamplight_part + {at}u]");
        let _ = write!(
            text,
            "    uint4 lamplight_result = uint4({}, {}, {}, {});
    if (lamplight_index == 0u || lamplight_index == lamplight_header.y - 1u) {{
        lamplight_result = uint4(lamplight_header.xyz, {ECHO}u ^ lamplight_index);
    }}
",
            part(0),
            part(1),
            part(2),
            part(3)
        );
        text += match self.language {
            WrittenLanguage::Hlsl => "    return lamplight_result;\n}\n",
            WrittenLanguage::Msl => {
                "    lamplight_output lamplight_out;\n    lamplight_out.words = lamplight_result;\n    \
                 return lamplight_out;\n}\n"
            }
        };
        Ok(text)
    }

    /// Writes the call of the function; returns the words of its results.
    fn call(&self, text: &mut String) -> Result<Vec<String>, Diagnostic> {
        let function = &self.module().functions[self.kernel.function];
        let (mut arguments, mut changed) = (Vec::new(), Vec::new());
        let mut offset = 0;
        let parameters = self.kernel.parameters.iter().zip(&function.arguments);
        for (index, (parameter, argument)) in parameters.enumerate() {
            if let ParameterKind::Resource(resource) = &parameter.kind {
                arguments.push(format!("lamplight_binding{}", resource.binding));
                continue;
            }
            let (ty, is_pointer) = match self.module().types[argument.ty].inner {
                TypeInner::Pointer { base, .. } => (base, true),
                _ => (argument.ty, false),
            };
            let name = format!("lamplight_argument{index}");
            let _ = writeln!(text, "    {};", self.variable(ty, &name)?);
            self.assign(ty, &name, &mut offset, text)?;
            if is_pointer {
                changed.push((name.clone(), ty));
            }
            arguments.push(name);
        }
        let call = format!("{}({})", self.kernel.name, arguments.join(", "));
        let mut words = Vec::new();
        match &function.result {
            Some(result) => {
                let declared = self.variable(result.ty, "lamplight_value")?;
                let _ = writeln!(text, "    {declared} = {call};");
                self.words_of(result.ty, "lamplight_value", &mut words)?;
            }
            None => {
                let _ = writeln!(text, "    {call};");
            }
        }
        for (name, ty) in changed {
            self.words_of(ty, &name, &mut words)?;
        }
        Ok(words)
    }

    fn unknown(&self, ty: Handle<Type>) -> Diagnostic {
        let name = self.module().types[ty].name.as_deref().unwrap_or("a type");
        Diagnostic::error(codes::EXECUTOR_LACKS, format!("`{name}` has no spelling here"))
    }

    /// A declaration without a value.
    fn variable(&self, ty: Handle<Type>, name: &str) -> Result<String, Diagnostic> {
        let TypeInner::Array { base, size, stride: _ } = self.module().types[ty].inner else {
            return Ok(format!("{} {name}", self.type_name(ty)?));
        };
        let ArraySize::Constant(count) = size else { return Err(self.unknown(ty)) };
        match self.language {
            WrittenLanguage::Hlsl => self.variable(base, &format!("{name}[{count}]")),
            WrittenLanguage::Msl => Ok(format!("{} {name}", self.type_name(ty)?)),
        }
    }

    fn type_name(&self, ty: Handle<Type>) -> Result<String, Diagnostic> {
        let found = &self.module().types[ty];
        Ok(match &found.inner {
            TypeInner::Scalar(scalar) => scalar_name(scalar.kind).to_owned(),
            TypeInner::Vector { size, scalar } => {
                format!("{}{}", scalar_name(scalar.kind), *size as u32)
            }
            TypeInner::Matrix { columns, rows, .. } => {
                format!("float{}x{}", *columns as u32, *rows as u32)
            }
            TypeInner::Array { base, size: ArraySize::Constant(count), .. } => {
                format!("array<{}, {count}>", self.type_name(*base)?)
            }
            TypeInner::Struct { .. } => found.name.clone().ok_or_else(|| self.unknown(ty))?,
            _ => return Err(self.unknown(ty)),
        })
    }

    /// The numbers of a value, in the order of their words, each with its kind.
    fn numbers(
        &self,
        ty: Handle<Type>,
        value: &str,
        found: &mut Vec<(String, ScalarKind)>,
    ) -> Result<(), Diagnostic> {
        match &self.module().types[ty].inner {
            TypeInner::Scalar(scalar) => found.push((value.to_owned(), scalar.kind)),
            TypeInner::Vector { size, scalar } => {
                let names = ["x", "y", "z", "w"].iter().take(*size as usize);
                found.extend(names.map(|name| (format!("{value}.{name}"), scalar.kind)));
            }
            TypeInner::Matrix { columns, rows, scalar } => {
                for column in 0..*columns as u32 {
                    let names = ["x", "y", "z", "w"].iter().take(*rows as usize);
                    let one = |name| (format!("{value}[{column}].{name}"), scalar.kind);
                    found.extend(names.map(one));
                }
            }
            TypeInner::Array { base, size: ArraySize::Constant(count), .. } => {
                for at in 0..count.get() {
                    self.numbers(*base, &format!("{value}[{at}]"), found)?;
                }
            }
            TypeInner::Struct { members, .. } => {
                for member in members {
                    let name = member.name.as_deref().ok_or_else(|| self.unknown(ty))?;
                    self.numbers(member.ty, &format!("{value}.{name}"), found)?;
                }
            }
            _ => return Err(self.unknown(ty)),
        }
        Ok(())
    }

    /// Gives a variable its words of the input, from `offset` on.
    fn assign(
        &self,
        ty: Handle<Type>,
        value: &str,
        offset: &mut usize,
        text: &mut String,
    ) -> Result<(), Diagnostic> {
        let mut numbers = Vec::new();
        self.numbers(ty, value, &mut numbers)?;
        for (place, kind) in numbers {
            let part = ["x", "y", "z", "w"][*offset % 4];
            let word = format!("lamplight_input{}.{part}", *offset / 4);
            *offset += 1;
            let number = match (kind, self.language) {
                (ScalarKind::Sint, _) => format!("int({word})"),
                (ScalarKind::Uint, _) => word,
                (ScalarKind::Bool, _) => format!("({word} != 0u)"),
                (_, WrittenLanguage::Hlsl) => format!("asfloat({word})"),
                (_, WrittenLanguage::Msl) => format!("as_type<float>({word})"),
            };
            let _ = writeln!(text, "    {place} = {number};");
        }
        Ok(())
    }

    fn words_of(
        &self,
        ty: Handle<Type>,
        value: &str,
        words: &mut Vec<String>,
    ) -> Result<(), Diagnostic> {
        let mut numbers = Vec::new();
        self.numbers(ty, value, &mut numbers)?;
        words.extend(numbers.into_iter().map(|(number, kind)| match (kind, self.language) {
            (ScalarKind::Sint, _) => format!("uint({number})"),
            (ScalarKind::Bool, _) => format!("({number} ? 1u : 0u)"),
            (ScalarKind::Uint, _) => number,
            (_, WrittenLanguage::Hlsl) => format!("asuint({number})"),
            (_, WrittenLanguage::Msl) => format!("as_type<uint>({number})"),
        }));
        Ok(())
    }
}

fn unknown_texture() -> Diagnostic {
    Diagnostic::error(codes::EXECUTOR_LACKS, "a texture of the function has no spelling here")
}

fn scalar_name(kind: ScalarKind) -> &'static str {
    match kind {
        ScalarKind::Sint => "int",
        ScalarKind::Uint => "uint",
        ScalarKind::Bool => "bool",
        _ => "float",
    }
}
