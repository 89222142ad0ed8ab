//! Textures and samplers: separate ones, as GLSL for Vulkan has them. Functions of a library take
//! pairs by macros, which also have a form for combined ones.

use std::collections::BTreeMap;

use lamplight_diagnostic::Diagnostic;

use super::dialect::Dialect;
use super::expression::{Bound, LocalRole, POSTFIX, Writer, Written};
use super::function::calls_builtin;
use super::words::texture_name;
use crate::tree::{
    Argument, Expression, ExpressionKind, Item, Meaning, Node, Scalar, Shape, Texture,
};
use crate::tree::{TextureKind, Type};
use crate::wesl::untranslated;

/// The macros of a library for a pair of a texture and a sampler.
struct PairMacros {
    parameter: &'static str,
    argument: &'static str,
    sampler: &'static str,
}

/// The macros for a kind of texture, read with a sampler that compares or does not.
fn macros_of(texture: &Texture, compares: bool) -> Option<PairMacros> {
    match (&texture.kind, texture.shape, texture.is_array, compares) {
        (TextureKind::Sampled(Scalar::F32), Shape::D2, false, false) => Some(PairMacros {
            parameter: "LAMPLIGHT_COLOR_MAP",
            argument: "LAMPLIGHT_COLOR_ARG",
            sampler: "LAMPLIGHT_COLOR_SAMPLER",
        }),
        (TextureKind::Depth, Shape::D2, false, true) => Some(PairMacros {
            parameter: "LAMPLIGHT_DEPTH_MAP",
            argument: "LAMPLIGHT_DEPTH_ARG",
            sampler: "LAMPLIGHT_DEPTH_SAMPLER",
        }),
        (TextureKind::Depth, Shape::Cube, false, true) => Some(PairMacros {
            parameter: "LAMPLIGHT_DEPTH_CUBE",
            argument: "LAMPLIGHT_DEPTH_ARG",
            sampler: "LAMPLIGHT_CUBE_SAMPLER",
        }),
        _ => None,
    }
}

/// A pair of parameters as a macro.
pub fn pair_parameter(texture: &Type, sampler: &Type, names: (&str, &str)) -> Option<String> {
    let (Type::Texture(texture), Type::Sampler { compares }) = (texture, sampler) else {
        return None;
    };
    let macros = macros_of(texture, *compares)?;
    Some(format!("{}({}, {})", macros.parameter, names.0, names.1))
}

impl Writer<'_> {
    /// A pair of arguments that are parameters themselves, as a macro.
    pub fn pair_argument(&self, texture: &Argument, sampler: &Argument) -> Option<String> {
        let (Type::Texture(ty), Type::Sampler { compares }) =
            (&texture.value.ty, &sampler.value.ty)
        else {
            return None;
        };
        let names = (self.parameter_name(&texture.value)?, self.parameter_name(&sampler.value)?);
        let macros = macros_of(ty, *compares).filter(|_| self.has_macros)?;
        Some(format!("{}({}, {})", macros.argument, names.0, names.1))
    }

    /// A texture as GLSL reads it: together with its sampler.
    fn combined(
        &self,
        texture: &Expression,
        sampler: Option<&Expression>,
        indent: usize,
    ) -> Result<String, Diagnostic> {
        let Type::Texture(ty) = &texture.ty else {
            return Err(untranslated(texture.span, "a texture that is computed"));
        };
        let name = self.whole(texture, indent)?;
        let (sampler_name, compares) = match sampler {
            Some(sampler) => {
                let compares = matches!(sampler.ty, Type::Sampler { compares: true });
                (self.whole(sampler, indent)?, compares)
            }
            None => self.sampler_of(texture).ok_or_else(|| {
                untranslated(texture.span, "the size or a texel of a texture without a sampler")
                    .note("help: GLSL reads textures with samplers: read it with one somewhere")
            })?,
        };
        if self.has_macros && self.parameter_name(texture).is_some() {
            let macros = macros_of(ty, compares).ok_or_else(|| {
                untranslated(texture.span, "a texture that the library has no macros for")
            })?;
            return Ok(format!("{}({name}, {sampler_name})", macros.sampler));
        }
        let shadow = if compares { "Shadow" } else { "" };
        let kind = texture_name(self.names.dialect, ty, "sampler", texture.span)?;
        Ok(format!("{kind}{shadow}({name}, {sampler_name})"))
    }

    /// A sampler for what is read without one, and whether it compares.
    fn sampler_of(&self, texture: &Expression) -> Option<(String, bool)> {
        let ExpressionKind::Name(_, meaning) = &texture.bare().kind else { return None };
        match meaning {
            Meaning::Item(path) => {
                let found = self.samplers.get(path)?;
                Some((self.names.item(&found.path).to_owned(), found.compares))
            }
            Meaning::Local(numbers) => {
                let [number] = numbers.as_slice() else { return None };
                let (sampler, compares) = self.pairs.get(number)?;
                match self.locals.get(sampler)? {
                    LocalRole::Named(name) => Some((name.clone(), *compares)),
                    _ => None,
                }
            }
            Meaning::Unknown => None,
        }
    }

    /// The name of a parameter, if an expression is one.
    fn parameter_name(&self, value: &Expression) -> Option<String> {
        let ExpressionKind::Name(_, Meaning::Local(numbers)) = &value.bare().kind else {
            return None;
        };
        match self.role(numbers)? {
            LocalRole::Named(name) => Some(name.clone()),
            _ => None,
        }
    }

    /// The size of a texture in the signed integers that GLSL gives, if the expression is one.
    pub fn signed_size(
        &self,
        value: &Expression,
        indent: usize,
    ) -> Result<Option<String>, Diagnostic> {
        match &value.kind {
            ExpressionKind::Call { arguments, .. }
                if calls_builtin(value, &["textureDimensions"])
                    && self.dialect() == Dialect::Glsl =>
            {
                let sampler = self.combined(&arguments[0].value, None, indent)?;
                let level = match arguments.get(1) {
                    Some(level) => self.as_int(&level.value, indent)?,
                    None => "0".to_owned(),
                };
                // The last component is the number of layers.
                let part = match &arguments[0].value.ty {
                    Type::Texture(texture) if texture.is_array => ".xy",
                    _ => "",
                };
                Ok(Some(format!("textureSize({sampler}, {level}){part}")))
            }
            _ => Ok(None),
        }
    }

    fn as_int(&self, value: &Expression, indent: usize) -> Result<String, Diagnostic> {
        let text = self.whole(value, indent)?;
        Ok(match &value.ty {
            Type::Scalar(Scalar::I32) => text,
            Type::Vector(size, Scalar::U32) => format!("ivec{size}({text})"),
            Type::Vector(..) => text,
            _ => format!("int({text})"),
        })
    }

    /// A function that reads a texture.
    pub fn texture_call(
        &self,
        name: &str,
        arguments: &[Argument],
        value: &Expression,
        indent: usize,
    ) -> Written {
        if self.dialect() != Dialect::Glsl {
            return self.method_call(name, arguments, value, indent);
        }
        if let Some(size) = self.signed_size(value, indent)? {
            let ty = self.names.type_name(&value.ty, value.span)?;
            return Ok(Bound(format!("{ty}({size})"), POSTFIX));
        }
        let refused = || untranslated(value.span, format!("`{name}` with these arguments"));
        let Some(Type::Texture(texture)) = arguments.first().map(|one| &one.value.ty) else {
            return Err(refused());
        };
        if name == "textureLoad" {
            return self.texel(texture, arguments, value, indent);
        }
        let [map, sampler, rest @ ..] = arguments else { return Err(refused()) };
        let sampler_text = self.combined(&map.value, Some(&sampler.value), indent)?;
        let mut rest: Vec<&Expression> = rest.iter().map(|argument| &argument.value).collect();
        let mut coordinates = vec![self.whole(take_first(&mut rest, value)?, indent)?];
        if texture.is_array {
            let layer = self.whole(take_first(&mut rest, value)?, indent)?;
            coordinates.push(format!("float({layer})"));
        }
        let rest: Result<Vec<String>, Diagnostic> =
            rest.into_iter().map(|one| self.whole(one, indent)).collect();
        let rest = rest?;
        let is_depth = texture.kind == TextureKind::Depth;
        let made = TextureRead { texture, sampler: sampler_text, coordinates, rest };
        let text = made.written(name).ok_or_else(refused)?;
        let compares = name.contains("Compare");
        Ok(Bound(if is_depth && !compares { format!("{text}.x") } else { text }, POSTFIX))
    }

    fn texel(
        &self,
        texture: &Texture,
        arguments: &[Argument],
        value: &Expression,
        indent: usize,
    ) -> Written {
        let [map, at, level] = arguments else {
            return Err(untranslated(value.span, "`textureLoad` with these arguments"));
        };
        let is_plain = matches!(texture.kind, TextureKind::Sampled(_)) && !texture.is_array;
        if !is_plain {
            return Err(untranslated(value.span, "`textureLoad` of this kind of texture"));
        }
        let sampler = self.combined(&map.value, None, indent)?;
        let at = self.as_int(&at.value, indent)?;
        let level = self.as_int(&level.value, indent)?;
        Ok(Bound(format!("texelFetch({sampler}, {at}, {level})"), POSTFIX))
    }
}

/// A read of a texture, its arguments as texts.
struct TextureRead<'a> {
    texture: &'a Texture,
    sampler: String,
    coordinates: Vec<String>,
    rest: Vec<String>,
}

impl TextureRead<'_> {
    fn written(mut self, name: &str) -> Option<String> {
        let mut function = match name {
            "textureSample" | "textureSampleBias" | "textureSampleCompare" => "texture",
            "textureSampleLevel" | "textureSampleCompareLevel" => "textureLod",
            "textureSampleGrad" => "textureGrad",
            _ => return None,
        };
        let extra = match name {
            "textureSample" => 0,
            "textureSampleGrad" => 2,
            _ => 1,
        };
        if self.rest.len() != extra {
            return None;
        }
        if name.contains("Compare") {
            self.coordinates.append(&mut self.rest);
            let is_flat = self.texture.shape == Shape::D2 && !self.texture.is_array;
            if name == "textureSampleCompareLevel" && !is_flat {
                // Only the flat kind has `textureLod` in GLSL. Gradients of zero mean the first
                // level too.
                function = "textureGrad";
                let zero = match self.texture.shape {
                    Shape::Cube => "vec3(0.0)",
                    _ => "vec2(0.0)",
                };
                self.rest = vec![zero.to_owned(), zero.to_owned()];
            } else if name == "textureSampleCompareLevel" {
                self.rest = vec!["0.0".to_owned()];
            }
            if self.texture.shape == Shape::Cube && self.texture.is_array {
                return None;
            }
        }
        let place = self.place();
        let rest: String = self.rest.iter().map(|one| format!(", {one}")).collect();
        Some(format!("{function}({}, {place}{rest})", self.sampler))
    }

    /// The coordinates as one vector.
    fn place(&self) -> String {
        let dimensions = match self.texture.shape {
            Shape::D1 => 1,
            Shape::D2 => 2,
            Shape::D3 | Shape::Cube => 3,
        };
        match self.coordinates.as_slice() {
            [one] => one.clone(),
            all => {
                let size = dimensions + all.len() - 1;
                format!("vec{size}({})", all.join(", "))
            }
        }
    }
}

fn take_first<'a>(
    rest: &mut Vec<&'a Expression>,
    call: &Expression,
) -> Result<&'a Expression, Diagnostic> {
    match rest.is_empty() {
        true => Err(untranslated(call.span, "a texture without coordinates")),
        false => Ok(rest.remove(0)),
    }
}

/// The functions in HLSL that give sizes of textures, for what some items call.
pub fn size_functions(items: &[Node<Item>]) -> Result<BTreeMap<String, String>, Diagnostic> {
    let mut found = BTreeMap::new();
    let mut error = None;
    for node in items {
        let Item::Function(function) = &node.body else { continue };
        super::visit::block_expressions(&function.body, &mut |value| {
            let ExpressionKind::Call { arguments, .. } = &value.kind else { return };
            if let Some(Type::Texture(texture)) = arguments.first().map(|one| &one.value.ty)
                && calls_builtin(value, &["textureDimensions"])
            {
                match super::hlsl::size_function(texture, value.span) {
                    Ok((guard, text)) => drop(found.insert(guard, text)),
                    Err(refused) => error = Some(refused),
                }
            }
        });
    }
    error.map_or(Ok(found), Err)
}
