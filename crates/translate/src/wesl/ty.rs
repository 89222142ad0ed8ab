//! Types as WGSL writes them.

use lamplight_diagnostic::Diagnostic;
use lamplight_diagnostic::source::Span;
use lamplight_syntax::wesl::TokenKind;

use super::Reader;
use crate::tree::Type;
use crate::tree::{Count, ExpressionKind, NumberValue, Scalar, Shape, Space, Texture, TextureKind};

/// Scalars, and the letter that ends the names of their vectors and matrices.
const SCALARS: [(&str, &str, Scalar); 4] = [
    ("f32", "f", Scalar::F32),
    ("i32", "i", Scalar::I32),
    ("u32", "u", Scalar::U32),
    ("bool", "", Scalar::Bool),
];

/// Textures: the end of the name after `texture_`, shape, and whether it is an array.
const SHAPES: [(&str, Shape, bool); 6] = [
    ("1d", Shape::D1, false),
    ("2d", Shape::D2, false),
    ("2d_array", Shape::D2, true),
    ("3d", Shape::D3, false),
    ("cube", Shape::Cube, false),
    ("cube_array", Shape::Cube, true),
];

/// The types that are written as one word, without arguments.
pub fn plain_type(name: &str) -> Option<Type> {
    if let Some((.., scalar)) = SCALARS.iter().find(|(known, ..)| *known == name) {
        return Some(Type::Scalar(*scalar));
    }
    match name {
        "sampler" => return Some(Type::Sampler { compares: false }),
        "sampler_comparison" => return Some(Type::Sampler { compares: true }),
        "array" => return Some(Type::OpenArray),
        "texture_depth_multisampled_2d" => {
            let kind = TextureKind::DepthMultisampled;
            return Some(Type::Texture(Texture { shape: Shape::D2, is_array: false, kind }));
        }
        _ => {}
    }
    if let Some(end) = name.strip_prefix("texture_depth_") {
        let (_, shape, is_array) = SHAPES.iter().find(|(known, ..)| *known == end)?;
        let kind = TextureKind::Depth;
        return Some(Type::Texture(Texture { shape: *shape, is_array: *is_array, kind }));
    }
    let open = open_type(name)?;
    match open {
        (open, "") => Some(open),
        (open, letter) => {
            let (.., scalar) = SCALARS.iter().find(|(_, known, _)| *known == letter)?;
            filled_type(&open, *scalar)
        }
    }
}

/// `vec3` or `mat4x3` at the start of a word, and the letters after it.
fn open_type(name: &str) -> Option<(Type, &str)> {
    let size = |digit: Option<&u8>| digit.filter(|d| (b'2'..=b'4').contains(d)).map(|d| d - b'0');
    if let Some(rest) = name.strip_prefix("vec") {
        let count = size(rest.as_bytes().first())?;
        return Some((Type::OpenVector(count), &rest[1..]));
    }
    let rest = name.strip_prefix("mat")?;
    let bytes = rest.as_bytes();
    let (columns, rows) = (size(bytes.first())?, size(bytes.get(2))?);
    (bytes[1] == b'x').then(|| (Type::OpenMatrix { columns, rows }, &rest[3..]))
}

/// A vector or a matrix with its scalar.
pub fn filled_type(open: &Type, scalar: Scalar) -> Option<Type> {
    match open {
        Type::OpenVector(size) => Some(Type::Vector(*size, scalar)),
        Type::OpenMatrix { columns, rows } => {
            Some(Type::Matrix { columns: *columns, rows: *rows, scalar })
        }
        _ => None,
    }
}

impl Reader<'_> {
    /// Whether a type with a template begins here: `vec3<f32>`. Only words of the language have
    /// templates, so `a < b` is a comparison for all others.
    pub fn is_template(&self) -> bool {
        let text = self.text();
        let is_known = matches!(text, "array" | "ptr" | "atomic" | "bitcast")
            || text.starts_with("texture_")
            || open_type(text).is_some_and(|(_, rest)| rest.is_empty());
        is_known && self.tokens.is(self.at + 1, b'<')
    }

    /// A type.
    pub fn ty(&mut self) -> Result<Type, Diagnostic> {
        let first = self.at;
        if self.is_template() {
            let name = self.text().to_owned();
            self.at += 2;
            let found = self.template(&name, first)?;
            self.take(b',');
            self.expect(b'>')?;
            return Ok(found);
        }
        let path = self.path("a type")?;
        if let Some(open @ (Type::OpenArray | Type::OpenVector(_))) = plain_type(&path) {
            return Err(self.tokens.expected(self.at, &format!("`<` and what `{open}` is of")));
        }
        if matches!(path.as_str(), "f16" | "vec2h" | "vec3h" | "vec4h") {
            return Err(self.untranslated(self.span_from(first), "16-bit floats"));
        }
        Ok(plain_type(&path).unwrap_or(Type::Named(path)))
    }

    fn template(&mut self, name: &str, first: usize) -> Result<Type, Diagnostic> {
        match name {
            "array" => {
                let element = self.ty()?;
                let count = match self.take(b',') && !self.is(b'>') {
                    true => self.count()?,
                    false => Count::Runtime,
                };
                Ok(Type::Array(Box::new(element), count))
            }
            "ptr" => self.pointer(first),
            "atomic" => {
                let ty = self.ty()?;
                ty.scalar().map(Type::Atomic).ok_or_else(|| self.wrong_template(first))
            }
            _ if name.starts_with("texture_") => self.texture(name, first),
            _ => {
                let scalar = self.ty()?;
                let filled = match (open_type(name), scalar) {
                    (Some((open, "")), Type::Scalar(scalar)) => filled_type(&open, scalar),
                    _ => None,
                };
                filled.ok_or_else(|| self.wrong_template(first))
            }
        }
    }

    fn wrong_template(&self, first: usize) -> Diagnostic {
        self.untranslated(self.span_from(first), "this is not a type that is known")
    }

    fn pointer(&mut self, first: usize) -> Result<Type, Diagnostic> {
        let space = self.identifier("an address space")?;
        self.expect(b',')?;
        let target = self.ty()?;
        if self.take(b',') && !self.is(b'>') {
            self.identifier("an access")?;
        }
        let space = match space.as_str() {
            "function" => Space::Function,
            "private" => Space::Private,
            _ => {
                let what = format!("a pointer into `{space}`");
                return Err(self.untranslated(self.span_from(first), &what));
            }
        };
        Ok(Type::Pointer(space, Box::new(target)))
    }

    fn texture(&mut self, name: &str, first: usize) -> Result<Type, Diagnostic> {
        let argument = self.ty()?;
        let scalar = argument.scalar();
        let shape_of = |end: &str| SHAPES.iter().find(|(known, ..)| *known == end);
        let made = |(_, shape, is_array): &(&str, Shape, bool), kind| {
            Type::Texture(Texture { shape: *shape, is_array: *is_array, kind })
        };
        if let Some(end) = name.strip_prefix("texture_storage_") {
            self.expect(b',')?;
            let access = self.identifier("an access")?;
            let format = argument.to_string();
            let kind = TextureKind::Storage { format, access };
            return shape_of(end)
                .map(|shape| made(shape, kind))
                .ok_or_else(|| self.wrong_template(first));
        }
        let (end, kind): (&str, fn(Scalar) -> TextureKind) =
            match name.strip_prefix("texture_multisampled_") {
                Some(end) => (end, TextureKind::Multisampled),
                None => (&name["texture_".len()..], TextureKind::Sampled),
            };
        let found = shape_of(end).zip(scalar).map(|(shape, scalar)| made(shape, kind(scalar)));
        found.ok_or_else(|| self.wrong_template(first))
    }

    /// The number of elements of an array: a number, an axis or a constant.
    fn count(&mut self) -> Result<Count, Diagnostic> {
        let first = self.at;
        let value = self.additive()?;
        let span: Span = self.span_from(first);
        let refused = || self.untranslated(span, "the length of an array that is computed");
        match value.bare().kind.clone() {
            ExpressionKind::Number(number) => match number.value {
                NumberValue::Integer(count @ 1..=0xffff_ffff) => Ok(Count::Fixed(count as u32)),
                _ => Err(refused()),
            },
            ExpressionKind::Axis(name) => Ok(Count::Axis(name)),
            ExpressionKind::Name(name, _) => Ok(Count::Named(name)),
            _ => Err(refused()),
        }
    }

    /// `a::b::c`, with the `::` in it; a single name as a rule.
    pub fn path(&mut self, what: &str) -> Result<String, Diagnostic> {
        let mut path = String::new();
        loop {
            let is_start = matches!(self.text(), "package" | "super")
                && self.tokens.kind(self.at + 1) == Some(TokenKind::Path);
            if is_start {
                path += self.text();
                self.at += 1;
            } else {
                path += &self.identifier(what)?;
            }
            if self.tokens.kind(self.at) != Some(TokenKind::Path) {
                return Ok(path);
            }
            path += "::";
            self.at += 1;
        }
    }
}
