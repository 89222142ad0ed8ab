//! Textures as objects with methods: HLSL and MSL.

use lamplight_diagnostic::Diagnostic;

use super::dialect::Dialect;
use super::expression::{Bound, POSTFIX, Writer, Written};
use super::{hlsl, msl};
use crate::tree::{Argument, Expression, Scalar, Texture, TextureKind, Type};
use crate::wesl::untranslated;

impl Writer<'_> {
    /// A function that reads a texture.
    pub fn method_call(
        &self,
        name: &str,
        arguments: &[Argument],
        value: &Expression,
        indent: usize,
    ) -> Written {
        let refused = || untranslated(value.span, format!("`{name}` with these arguments"));
        let [map, rest @ ..] = arguments else { return Err(refused()) };
        let Type::Texture(texture) = &map.value.ty else { return Err(refused()) };
        let map = self.operand(&map.value, POSTFIX, indent)?;
        let rest: Vec<&Expression> = rest.iter().map(|argument| &argument.value).collect();
        let text = match name {
            "textureDimensions" => self.texture_size(texture, &map, &rest, value, indent)?,
            "textureLoad" => self.texture_load(texture, &map, &rest, value, indent)?,
            _ => {
                let [sampler, rest @ ..] = rest.as_slice() else { return Err(refused()) };
                let sampler = self.whole(sampler, indent)?;
                let texts: Result<Vec<String>, Diagnostic> =
                    rest.iter().map(|one| self.whole(one, indent)).collect();
                let read = MethodRead { name, texture, map, sampler, texts: texts? };
                read.written(self.dialect()).ok_or_else(refused)?
            }
        };
        Ok(Bound(text, POSTFIX))
    }

    fn texture_size(
        &self,
        texture: &Texture,
        map: &str,
        rest: &[&Expression],
        value: &Expression,
        indent: usize,
    ) -> Result<String, Diagnostic> {
        let level = rest.first().map(|level| self.whole(level, indent)).transpose()?;
        if self.dialect() == Dialect::Hlsl {
            hlsl::size_function(texture, value.span)?;
            let level = level.unwrap_or_else(|| "0u".to_owned());
            return Ok(format!("texture_size({map}, {level})"));
        }
        let level = level.unwrap_or_default();
        match value.ty {
            Type::Vector(2, _) => {
                Ok(format!("uint2({map}.get_width({level}), {map}.get_height({level}))"))
            }
            _ => Err(untranslated(value.span, "the size of this kind of texture")),
        }
    }

    fn texture_load(
        &self,
        texture: &Texture,
        map: &str,
        rest: &[&Expression],
        value: &Expression,
        indent: usize,
    ) -> Result<String, Diagnostic> {
        let [at, level] = rest else {
            return Err(untranslated(value.span, "`textureLoad` with these arguments"));
        };
        let is_known = matches!(texture.kind, TextureKind::Sampled(_) | TextureKind::Depth);
        let Type::Vector(size, scalar) = at.ty else {
            return Err(untranslated(value.span, "`textureLoad` of this kind of texture"));
        };
        if texture.is_array || !is_known {
            return Err(untranslated(value.span, "`textureLoad` of this kind of texture"));
        }
        let (at, level) = (self.whole(at, indent)?, self.whole(level, indent)?);
        if self.dialect() == Dialect::Hlsl {
            return Ok(format!("{map}.Load(int{}({at}, {level}))", size + 1));
        }
        let at = if scalar == Scalar::U32 { at } else { format!("uint{size}({at})") };
        Ok(format!("{map}.read({at}, {level})"))
    }
}

/// A read with a sampler, its arguments as texts: the coordinates first.
struct MethodRead<'a> {
    name: &'a str,
    texture: &'a Texture,
    map: String,
    sampler: String,
    texts: Vec<String>,
}

impl MethodRead<'_> {
    fn written(self, dialect: Dialect) -> Option<String> {
        let Self { name, texture, map, sampler, texts } = self;
        let coordinates = 1 + usize::from(texture.is_array);
        let (place, rest) = texts.split_at_checked(coordinates)?;
        if dialect == Dialect::Msl {
            let (method, rest) = msl::argument_of(name, texture, rest)?;
            return Some(format!("{map}.{method}({sampler}, {}{rest})", place.join(", ")));
        }
        let (method, count) = hlsl::method_name(name)?;
        let place = match place {
            [one] => one.clone(),
            all => {
                let dimensions = if texture.shape == crate::tree::Shape::D2 { 2 } else { 3 };
                format!("float{}({})", dimensions + 1, all.join(", "))
            }
        };
        let rest: Vec<String> =
            (rest.len() == count).then(|| rest.iter().map(|one| format!(", {one}")).collect())?;
        Some(format!("{map}.{method}({sampler}, {place}{})", rest.concat()))
    }
}
