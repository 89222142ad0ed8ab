//! The author's own GLSL with a kernel around it, for the front ends of drivers.
//!
//! Other executors run what is written of naga's module. Here a driver compiles the text itself:
//! nothing of naga is between the author and the result. The text is that of a GLSL file, composed,
//! with combined samplers. The `main` around it reads and writes the same texels as the kernel in
//! naga's form ([`crate::kernel`]).

use std::fmt::Write as _;

use crate::kernel::{ECHO, INPUT_WIDTH, Kernel, ParameterKind, ResourceClass, TARGET_WIDTH};
use lamplight_diagnostic::{Diagnostic, codes};
use naga::{ArraySize, Handle, ImageClass, ImageDimension, Module, ScalarKind, Type, TypeInner};

/// The name of the texture of inputs.
pub const INPUTS: &str = "lamplight_inputs";

/// The name of a combined texture and sampler, by the binding of its texture.
pub fn texture_name(binding: u32) -> String {
    format!("lamplight_texture{binding}")
}

/// The fragment stage of a kernel in GLSL.
///
/// `head` is its version, with the precision of numbers where the version asks for that. The error
/// says why there is none: the kernel is not of a GLSL text, or has types without a spelling.
pub fn fragment_text(kernel: &Kernel, head: &str) -> Result<String, Diagnostic> {
    let source = kernel.source.as_deref().ok_or_else(|| {
        let message = "this executor runs the text of GLSL modules, and the function is in WESL";
        Diagnostic::error(codes::EXECUTOR_LACKS, message)
    })?;
    let mut text = format!("{head}uniform highp usampler2D {INPUTS};\n");
    for parameter in kernel.resources() {
        if let ResourceClass::Texture { dim, arrayed, class } = parameter.class {
            let kind = sampler_name(dim, arrayed, class).ok_or_else(|| {
                let message = "this executor has no spelling for a texture of the function";
                Diagnostic::error(codes::EXECUTOR_LACKS, message)
            })?;
            let name = texture_name(parameter.binding);
            let _ = writeln!(text, "uniform highp {kind} {name};");
        }
    }
    let _ = writeln!(text, "layout(location = 0) out highp uvec4 lamplight_result;\n{source}");
    text += &main_text(kernel)?;
    Ok(text)
}

/// The type of a combined texture and sampler.
fn sampler_name(dim: ImageDimension, arrayed: bool, class: ImageClass) -> Option<&'static str> {
    let is_depth = match class {
        ImageClass::Sampled { kind: ScalarKind::Float, multi: false } => false,
        ImageClass::Depth { multi: false } => true,
        ImageClass::Sampled { .. }
        | ImageClass::Depth { .. }
        | ImageClass::Storage { .. }
        | ImageClass::External => return None,
    };
    match (dim, is_depth) {
        _ if arrayed => None,
        (ImageDimension::D2, false) => Some("sampler2D"),
        (ImageDimension::D2, true) => Some("sampler2DShadow"),
        (ImageDimension::Cube, false) => Some("samplerCube"),
        (ImageDimension::Cube, true) => Some("samplerCubeShadow"),
        (ImageDimension::D1 | ImageDimension::D3, _) => None,
    }
}

fn main_text(kernel: &Kernel) -> Result<String, Diagnostic> {
    let (texels, pixels) = (kernel.input_texels(), kernel.result_texels());
    let mut text = format!(
        "
uint lamplight_word(uint first, uint index) {{
    uint texel = first + index / 4u;
    ivec2 place = ivec2(int(texel % {INPUT_WIDTH}u), int(texel / {INPUT_WIDTH}u));
    return texelFetch({INPUTS}, place, 0)[index % 4u];
}}

void main() {{
    uvec4 lamplight_header = texelFetch({INPUTS}, ivec2(0), 0);
    uint lamplight_index = uint(gl_FragCoord.y) * {TARGET_WIDTH}u + uint(gl_FragCoord.x);
    uint lamplight_pixel = lamplight_index - min(lamplight_index, 1u);
    uint lamplight_call = min(lamplight_pixel / {pixels}u, lamplight_header.x - 1u);
    uint lamplight_part = 4u * (lamplight_pixel % {pixels}u);
    uint lamplight_first = 1u + lamplight_call * {texels}u;
"
    );
    let words = call_text(kernel, &mut text)?;
    let count = words.len().div_ceil(4).max(1) * 4;
    let _ = writeln!(text, "    uint lamplight_words[{count}];");
    for index in 0..count {
        let word = words.get(index).map_or("0u", String::as_str);
        let _ = writeln!(text, "    lamplight_words[{index}] = {word};");
    }
    let _ = write!(
        text,
        "    lamplight_result = uvec4(lamplight_words[lamplight_part], lamplight_words[lamplight_part + 1u],
        lamplight_words[lamplight_part + 2u], lamplight_words[lamplight_part + 3u]);
    if (lamplight_index == 0u || lamplight_index == lamplight_header.y - 1u) {{
        lamplight_result = uvec4(lamplight_header.xyz, {ECHO}u ^ lamplight_index);
    }}
}}
"
    );
    Ok(text)
}

/// The call of the function, and the words of its results.
fn call_text(kernel: &Kernel, text: &mut String) -> Result<Vec<String>, Diagnostic> {
    let module = &kernel.module;
    let function = &module.functions[kernel.function];
    let mut arguments = Vec::new();
    let mut changed = Vec::new();
    let mut offset = 0;
    for (index, (parameter, argument)) in
        kernel.parameters.iter().zip(&function.arguments).enumerate()
    {
        match &parameter.kind {
            ParameterKind::Resource(resource) => {
                if let ResourceClass::Texture { .. } = resource.class {
                    arguments.push(texture_name(resource.binding));
                }
            }
            ParameterKind::Words { .. } => {
                let (ty, is_pointer) = match module.types[argument.ty].inner {
                    TypeInner::Pointer { base, .. } => (base, true),
                    _ => (argument.ty, false),
                };
                let name = format!("lamplight_argument{index}");
                let value = value_text(module, ty, &mut offset)?;
                let _ = writeln!(text, "    {} {name} = {value};", type_name(module, ty)?);
                if is_pointer {
                    changed.push((name.clone(), ty));
                }
                arguments.push(name);
            }
        }
    }
    let call = format!("{}({})", kernel.name, arguments.join(", "));
    let mut words = Vec::new();
    match &function.result {
        Some(result) => {
            let ty = type_name(module, result.ty)?;
            let _ = writeln!(text, "    {ty} lamplight_value = {call};");
            words_of(module, result.ty, "lamplight_value", &mut words)?;
        }
        None => {
            let _ = writeln!(text, "    {call};");
        }
    }
    for (name, ty) in changed {
        words_of(module, ty, &name, &mut words)?;
    }
    Ok(words)
}

fn unknown(module: &Module, ty: Handle<Type>) -> Diagnostic {
    let name = module.types[ty].name.as_deref().unwrap_or("a type");
    let message = format!("`{name}` has no spelling for this executor");
    Diagnostic::error(codes::EXECUTOR_LACKS, message)
}

fn scalar_name(kind: ScalarKind) -> (&'static str, &'static str) {
    match kind {
        ScalarKind::Sint => ("int", "i"),
        ScalarKind::Uint => ("uint", "u"),
        ScalarKind::Bool => ("bool", "b"),
        _ => ("float", ""),
    }
}

fn type_name(module: &Module, ty: Handle<Type>) -> Result<String, Diagnostic> {
    Ok(match &module.types[ty].inner {
        TypeInner::Scalar(scalar) => scalar_name(scalar.kind).0.to_owned(),
        TypeInner::Vector { size, scalar } => {
            format!("{}vec{}", scalar_name(scalar.kind).1, *size as u32)
        }
        TypeInner::Matrix { columns, rows, .. } => {
            format!("mat{}x{}", *columns as u32, *rows as u32)
        }
        TypeInner::Array { .. } => {
            // The first length is that of the outermost array.
            let (mut element, mut lengths) = (ty, String::new());
            while let TypeInner::Array { base, size, stride: _ } = module.types[element].inner {
                let ArraySize::Constant(count) = size else { return Err(unknown(module, ty)) };
                lengths += &format!("[{count}]");
                element = base;
            }
            type_name(module, element)? + &lengths
        }
        TypeInner::Struct { .. } => {
            module.types[ty].name.clone().ok_or_else(|| unknown(module, ty))?
        }
        _ => return Err(unknown(module, ty)),
    })
}

/// The value of a type from the words of the input, from `offset` on.
fn value_text(module: &Module, ty: Handle<Type>, offset: &mut u32) -> Result<String, Diagnostic> {
    let mut parts = Vec::new();
    match &module.types[ty].inner {
        TypeInner::Scalar(scalar) => return Ok(word_text(scalar.kind, offset)),
        TypeInner::Vector { size, scalar } => {
            parts.extend((0..*size as u32).map(|_| word_text(scalar.kind, offset)));
        }
        TypeInner::Matrix { columns, rows, .. } => {
            let count = *columns as u32 * *rows as u32;
            parts.extend((0..count).map(|_| word_text(ScalarKind::Float, offset)));
        }
        TypeInner::Array { base, size: ArraySize::Constant(count), .. } => {
            for _ in 0..count.get() {
                parts.push(value_text(module, *base, offset)?);
            }
        }
        TypeInner::Struct { members, .. } => {
            for member in members {
                parts.push(value_text(module, member.ty, offset)?);
            }
        }
        _ => return Err(unknown(module, ty)),
    }
    Ok(format!("{}({})", type_name(module, ty)?, parts.join(", ")))
}

fn word_text(kind: ScalarKind, offset: &mut u32) -> String {
    let word = format!("lamplight_word(lamplight_first, {offset}u)");
    *offset += 1;
    match kind {
        ScalarKind::Sint => format!("int({word})"),
        ScalarKind::Uint => word,
        ScalarKind::Bool => format!("({word} != 0u)"),
        _ => format!("uintBitsToFloat({word})"),
    }
}

/// The words of a value.
fn words_of(
    module: &Module,
    ty: Handle<Type>,
    value: &str,
    words: &mut Vec<String>,
) -> Result<(), Diagnostic> {
    let word = |kind: ScalarKind, value: &str| match kind {
        ScalarKind::Sint | ScalarKind::Bool => format!("uint({value})"),
        ScalarKind::Uint => value.to_owned(),
        _ => format!("floatBitsToUint({value})"),
    };
    match &module.types[ty].inner {
        TypeInner::Scalar(scalar) => words.push(word(scalar.kind, value)),
        TypeInner::Vector { size, scalar } => {
            let parts = (0..*size as u32).map(|at| word(scalar.kind, &format!("{value}[{at}]")));
            words.extend(parts);
        }
        TypeInner::Matrix { columns, rows, .. } => {
            for column in 0..*columns as u32 {
                for row in 0..*rows as u32 {
                    words.push(word(ScalarKind::Float, &format!("{value}[{column}][{row}]")));
                }
            }
        }
        TypeInner::Array { base, size: ArraySize::Constant(count), .. } => {
            for at in 0..count.get() {
                words_of(module, *base, &format!("{value}[{at}]"), words)?;
            }
        }
        TypeInner::Struct { members, .. } => {
            for member in members {
                let name = member.name.as_deref().ok_or_else(|| unknown(module, ty))?;
                words_of(module, member.ty, &format!("{value}.{name}"), words)?;
            }
        }
        _ => return Err(unknown(module, ty)),
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// GLSL 4.60, section 4.1.9: `vec4[3][2]` is an array of three arrays of two vectors.
    #[test]
    fn lengths_of_arrays_go_inwards() {
        let text = "fn f(a: array<array<i32, 2>, 3>) -> i32 { return a[0][0]; }";
        let module = naga::front::wgsl::parse_str(text).unwrap();
        let (_, function) = module.functions.iter().next().unwrap();
        assert_eq!(type_name(&module, function.arguments[0].ty).ok().as_deref(), Some("int[3][2]"));
    }

    #[test]
    fn other_textures_have_no_spelling() {
        let sampled = ImageClass::Sampled { kind: ScalarKind::Float, multi: false };
        let integers = ImageClass::Sampled { kind: ScalarKind::Uint, multi: false };
        assert_eq!(sampler_name(ImageDimension::D2, false, sampled), Some("sampler2D"));
        assert_eq!(sampler_name(ImageDimension::D2, true, sampled), None);
        assert_eq!(sampler_name(ImageDimension::D3, false, sampled), None);
        assert_eq!(sampler_name(ImageDimension::D2, false, integers), None);
    }
}
