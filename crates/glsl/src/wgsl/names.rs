//! Names: WGSL has one scope for functions, types and variables, and no overloads.

use super::Writer;
use crate::tree::{Place, Struct};
use crate::types::{Dim, Opaque, OpaqueKind, Scalar, Type};

/// Keywords and reserved words of WGSL, which no name can be.
const RESERVED: &str = "
alias break case const const_assert continue continuing default diagnostic discard else enable
false fn for if let loop override requires return struct switch true var while
NULL Self abstract active alignas alignof as asm asm_fragment async attribute auto await become
cast catch class co_await co_return co_yield coherent column_major common compile
compile_fragment concept const_cast consteval constexpr constinit crate debugger decltype delete
demote demote_to_helper do dynamic_cast enum explicit export extends extern external fallthrough
filter final finally friend from fxgroup get goto groupshared highp impl implements import inline
instanceof interface layout lowp macro macro_rules match mediump meta mod module move mut mutable
namespace new nil noexcept noinline nointerpolation non_coherent noncoherent noperspective null
nullptr of operator package packoffset parameter_modifier pass patch pixelfragment precise
precision premerge priv protected pub public readonly ref regardless register reinterpret_cast require
resource restrict self set shared sizeof smooth snorm static static_assert static_cast std
subroutine super target template this thread_local throw trait try type typedef typeid typename
typeof union unless unorm unsafe unsized use using varying virtual volatile wgsl where with
writeonly yield
";

/// Types and functions of WGSL: a name of the module or of a function that is one of them is renamed, since
/// the translator writes them itself. Members may have such names.
const PREDECLARED: &str = "
bool f16 f32 i32 u32 f64 i64 u64 array atomic bitcast ptr sampler sampler_comparison binding_array
vec2 vec3 vec4 vec2f vec3f vec4f vec2i vec3i vec4i vec2u vec3u vec4u vec2h vec3h vec4h
mat2x2 mat2x3 mat2x4 mat3x2 mat3x3 mat3x4 mat4x2 mat4x3 mat4x4
mat2x2f mat2x3f mat2x4f mat3x2f mat3x3f mat3x4f mat4x2f mat4x3f mat4x4f
mat2x2h mat2x3h mat2x4h mat3x2h mat3x3h mat3x4h mat4x2h mat4x3h mat4x4h
texture_1d texture_2d texture_2d_array texture_3d texture_cube texture_cube_array
texture_multisampled_2d texture_depth_2d texture_depth_2d_array texture_depth_cube
texture_depth_cube_array texture_depth_multisampled_2d texture_storage_1d texture_storage_2d
texture_storage_2d_array texture_storage_3d texture_external read write read_write function private
workgroup uniform storage immediate handle
abs acos acosh all any asin asinh atan atan2 atanh ceil clamp cos cosh countLeadingZeros
countOneBits countTrailingZeros cross degrees determinant distance dot dot4U8Packed dot4I8Packed
exp exp2 extractBits faceForward firstLeadingBit firstTrailingBit floor fma fract frexp
insertBits inverseSqrt ldexp length log log2 max min mix modf normalize pow quantizeToF16 radians
reflect refract reverseBits round saturate select sign sin sinh smoothstep sqrt step tan tanh
transpose trunc dpdx dpdxCoarse dpdxFine dpdy dpdyCoarse dpdyFine fwidth fwidthCoarse fwidthFine
arrayLength textureDimensions textureGather textureGatherCompare textureLoad textureNumLayers
textureNumLevels textureNumSamples textureSample textureSampleBias textureSampleCompare
textureSampleCompareLevel textureSampleGrad textureSampleLevel
textureSampleBaseClampToEdge textureStore atomicLoad atomicStore atomicAdd atomicSub atomicMax
atomicMin atomicAnd atomicOr atomicXor atomicExchange atomicCompareExchangeWeak pack4x8snorm
pack4x8unorm pack2x16snorm pack2x16unorm pack2x16float unpack4x8snorm unpack4x8unorm
unpack2x16snorm unpack2x16unorm unpack2x16float storageBarrier textureBarrier workgroupBarrier
workgroupUniformLoad outerProduct inverse isNan isInf isNormal isFinite modf_result
";

type Words = rustc_hash::FxHashSet<&'static str>;

thread_local! {
    static RESERVED_SET: Words = RESERVED.split_whitespace().collect();
    static PREDECLARED_SET: Words = PREDECLARED.split_whitespace().collect();
}

/// Whether no name can be so in WGSL.
fn is_reserved(name: &str) -> bool {
    RESERVED_SET.with(|set| set.contains(name)) || name.starts_with("__") || name == "_"
}

/// Whether WGSL has another use for a name.
pub(super) fn is_word(name: &str) -> bool {
    is_reserved(name) || PREDECLARED_SET.with(|set| set.contains(name))
}

/// A name that WGSL takes, before clashes are looked for.
pub(super) fn plain_name(name: &str) -> String {
    if is_word(name) { changed_name(name) } else { name.to_owned() }
}

/// A name in the place of one that WGSL does not take.
fn changed_name(name: &str) -> String {
    match name.trim_start_matches('_') {
        // WGSL has no name of underscores alone.
        "" => "_0".to_owned(),
        stem => format!("{stem}_").replace("__", "_"),
    }
}

/// The name of a type for values.
pub(super) fn value_type(ty: &Type, structs: &[String]) -> String {
    match ty {
        Type::Void => String::new(),
        Type::Scalar(scalar) => scalar_name(*scalar).to_owned(),
        Type::Vector(Scalar::Bool, size) => format!("vec{size}<bool>"),
        Type::Vector(scalar, size) => format!("vec{size}{}", scalar_letter(*scalar)),
        Type::Matrix(_, columns, rows) => format!("mat{columns}x{rows}f"),
        Type::Array(element, Some(size)) => {
            format!("array<{}, {size}>", value_type(element, structs))
        }
        Type::Array(element, None) => format!("array<{}>", value_type(element, structs)),
        Type::Struct(index) => structs[*index as usize].clone(),
        Type::Opaque(_) => String::new(),
    }
}

/// The name of a number's type.
pub(super) fn scalar_name(scalar: Scalar) -> &'static str {
    match scalar {
        Scalar::Bool => "bool",
        Scalar::Int => "i32",
        Scalar::Uint => "u32",
        Scalar::Float | Scalar::Double => "f32",
    }
}

fn scalar_letter(scalar: Scalar) -> &'static str {
    match scalar {
        Scalar::Int => "i",
        Scalar::Uint => "u",
        _ => "f",
    }
}

/// The type of a texture. `None` for what WGSL lacks.
pub(super) fn texture_type(opaque: &Opaque, depth: bool) -> Option<String> {
    let shape = match (opaque.dim, opaque.arrayed) {
        (Dim::D1, false) => "1d",
        (Dim::D2, false) => "2d",
        (Dim::D2, true) => "2d_array",
        (Dim::D3, false) => "3d",
        (Dim::Cube, false) => "cube",
        (Dim::Cube, true) => "cube_array",
        _ => return None,
    };
    let number = scalar_name(opaque.scalar);
    if opaque.multisampled {
        return (shape == "2d").then(|| match depth {
            true => "texture_depth_multisampled_2d".to_owned(),
            false => format!("texture_multisampled_2d<{number}>"),
        });
    }
    if depth {
        return (shape != "1d" && shape != "3d").then(|| format!("texture_depth_{shape}"));
    }
    debug_assert!(opaque.kind != OpaqueKind::Sampler);
    Some(format!("texture_{shape}<{number}>"))
}

impl Writer<'_> {
    /// Names everything outside of functions.
    pub(super) fn name_all(&mut self) {
        let shader = self.shader;
        self.taken.extend(shader.vars.iter().map(|var| var.name.clone()));
        self.taken.extend(shader.functions.iter().map(|function| function.name.clone()));
        self.taken.extend(shader.structs.iter().map(|content| content.name.clone()));
        self.globals.insert("main".to_owned());
        for content in &shader.structs {
            let name = if content.name.is_empty() { "Unnamed" } else { &content.name };
            let name = self.global_name(name);
            self.struct_names.push(name);
            self.member_names.push(member_names(content));
        }
        for index in 0..shader.functions.len() {
            let name = self.function_name(index);
            self.function_names.push(name);
        }
        for (index, var) in shader.vars.iter().enumerate() {
            if matches!(var.place, Place::Local | Place::Param(_)) || self.is_local_const(index) {
                continue;
            }
            let name = if var.open { first_lower(&var.name) } else { var.name.clone() };
            let name = self.global_name(&name);
            self.var_names.insert(index as u32, name);
        }
    }

    /// Constants of functions are not in the order of the text.
    pub(super) fn is_local_const(&self, index: usize) -> bool {
        let var = &self.shader.vars[index];
        let is_it = |item: &crate::tree::Item| match item {
            crate::tree::Item::Var(found) => *found as usize == index,
            _ => false,
        };
        var.place == Place::Const && !self.shader.order.iter().any(is_it)
    }

    /// A name of the module's scope that nothing else has.
    pub(super) fn global_name(&mut self, name: &str) -> String {
        let plain = plain_name(name);
        let mut found = plain.clone();
        let mut number = 0;
        while self.globals.contains(&found) {
            number += 1;
            found = format!("{plain}_{number}");
        }
        self.globals.insert(found.clone());
        found
    }

    /// Overloads are distinguished by the types of their parameters.
    fn function_name(&mut self, index: usize) -> String {
        let shader = self.shader;
        let function = &shader.functions[index];
        if function.name == "main" {
            return "main".to_owned();
        }
        let siblings = shader.functions.iter().filter(|f| f.name == function.name).count();
        if siblings == 1 {
            return self.global_name(&function.name);
        }
        let types: Vec<String> = function
            .params
            .iter()
            .map(|param| {
                let ty = &shader.vars[*param as usize].ty;
                match ty.innermost() {
                    Type::Struct(index) => shader.structs[*index as usize].name.clone(),
                    _ => ty.to_string().replace(['[', ']'], "_"),
                }
            })
            .collect();
        let name = format!("{}_{}", function.name, types.join("_"));
        self.global_name(name.trim_end_matches('_'))
    }

    /// A name of the function's scope.
    pub(super) fn local_name(&mut self, name: &str) -> String {
        let plain = plain_name(name);
        let mut found = plain.clone();
        let mut number = 0;
        while self.globals.contains(&found) || self.scopes.iter().any(|set| set.contains(&found)) {
            number += 1;
            found = format!("{plain}_{number}");
        }
        if let Some(scope) = self.scopes.last_mut() {
            scope.insert(found.clone());
        }
        found
    }

    /// Declares a variable of a function.
    pub(super) fn name_local(&mut self, index: u32) -> String {
        let name = self.var(index).name.clone();
        let name = self.local_name(&name);
        self.var_names.insert(index, name.clone());
        name
    }

    pub(super) fn var_name(&self, index: u32) -> String {
        self.var_names.get(&index).cloned().unwrap_or_else(|| self.var(index).name.clone())
    }

    /// The name of a member of a structure.
    pub(super) fn member_name(&self, index: u32, member: u32) -> String {
        self.member_names[index as usize][member as usize].clone()
    }

    pub(super) fn scoped<T>(&mut self, run: impl FnOnce(&mut Self) -> T) -> T {
        self.scopes.push(rustc_hash::FxHashSet::default());
        let result = run(self);
        self.scopes.pop();
        result
    }
}

/// The names of members: one that WGSL reserves gets another name than all the others.
fn member_names(content: &Struct) -> Vec<String> {
    let mut taken: Vec<String> = content.members.iter().map(|field| field.name.clone()).collect();
    for at in 0..taken.len() {
        let name = &taken[at];
        let mut found = if is_reserved(name) { changed_name(name) } else { name.clone() };
        while taken.iter().enumerate().any(|(other, name)| other != at && *name == found) {
            found.push('_');
        }
        taken[at] = found;
    }
    taken
}

/// `UBO` as the name of a variable: `ubo`; `CameraData`: `cameraData`.
fn first_lower(name: &str) -> String {
    if name.chars().all(|letter| !letter.is_ascii_lowercase()) {
        return name.to_ascii_lowercase();
    }
    let mut letters = name.chars();
    let first = letters.next().map(|letter| letter.to_ascii_lowercase());
    first.into_iter().chain(letters).collect()
}
