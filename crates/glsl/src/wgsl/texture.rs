//! Reads and writes of textures and images.

use super::Writer;
use super::globals::OpaqueNames;
use super::path::swizzled;
use super::value::{Strength, Value};
use crate::builtin::textures::{Access, Lod};
use crate::lexer::At;
use crate::tree::{Expr, ExprKind, Number};
use crate::types::{Dim, Opaque, Scalar, Type};

/// How many textures an array may have that is indexed by what is not constant.
const MOST_ELEMENTS: u32 = 16;

/// What a coordinate of GLSL holds, as texts.
struct Coordinate {
    place: String,
    layer: Option<String>,
    reference: Option<String>,
}

impl Writer<'_> {
    pub(super) fn texture(&mut self, access: Access, arguments: &[Expr], expr: &Expr) -> Value {
        let Type::Opaque(opaque) = arguments[0].ty else { return Value::primary("", true) };
        if let ExprKind::Index(base, index) = &arguments[0].kind
            && index.known.is_none()
            && !self.is_bound(base)
            && let Some(value) = self.indexed_texture(access, (base, index), arguments, expr)
        {
            return value;
        }
        let Some(names) = self.opaque_names(&arguments[0]) else { return Value::primary("", true) };
        let rest: Vec<&Expr> = arguments[1..].iter().collect();
        let values = self.operands(&rest);
        let texture = names.texture.clone();
        match access {
            Access::Sample { lod: Lod::Fetch, offset, .. } => {
                self.fetch(&names, &opaque, (&rest, &values), offset)
            }
            Access::Sample { projected, lod, offset } => {
                if opaque.scalar != Scalar::Float {
                    self.refuse(expr.at, "WGSL does not filter textures of integers");
                }
                self.sample(&names, &opaque, (projected, lod, offset), (&rest, &values), expr.at)
            }
            Access::Gather { offset } => self.gather(&names, &opaque, (&rest, &values), offset),
            Access::Size | Access::ImageSize => {
                let level = values.first().map(|value| format!(", {}", value.text));
                let level = level.filter(|_| access == Access::Size).unwrap_or_default();
                self.dimensions(&texture, &opaque, &level, &expr.ty)
            }
            Access::Levels => Value::primary(format!("i32(textureNumLevels({texture}))"), true),
            Access::Samples => Value::primary(format!("i32(textureNumSamples({texture}))"), true),
            Access::QueryLod => {
                self.refuse(expr.at, "`textureQueryLod` has no counterpart in WGSL");
                Value::primary("vec2f()", true)
            }
            Access::Load => {
                let place = self.texel(&opaque, &rest, &values[0]);
                let text = format!("textureLoad({texture}, {place})");
                Value::primary(text, false)
            }
            Access::Store => {
                let place = self.texel(&opaque, &rest, &values[0]);
                let last = values.last().map_or("", |value| value.text.as_str());
                Value::primary(format!("textureStore({texture}, {place}, {last})"), false)
            }
            Access::Subpass => self.subpass(&texture, &values),
        }
    }

    /// An input attachment at the pixel.
    fn subpass(&self, texture: &str, values: &[Value]) -> Value {
        let position = &self.entry.fragment_position;
        let sample = values.first().map_or("0", |value| value.text.as_str());
        Value::primary(format!("textureLoad({texture}, vec2i({position}.xy), {sample})"), false)
    }

    /// Whether a read of an array's texture by an index that is not constant becomes a `switch`.
    pub(super) fn is_switched(&self, access: Access, arguments: &[Expr]) -> bool {
        let ExprKind::Index(base, _) = &arguments[0].kind else { return false };
        let Type::Array(_, Some(1..=MOST_ELEMENTS)) = base.ty else { return false };
        let Type::Opaque(opaque) = arguments[0].ty else { return false };
        let Access::Sample { projected: false, lod, offset: false } = access else { return false };
        let implicit = lod == Lod::Implicit && self.is_fragment();
        !(implicit && (opaque.shadow || arguments.len() > 2))
    }

    /// A texture of an array by an index that is not constant: a `switch` over its elements, with
    /// the derivatives taken before it.
    fn indexed_texture(
        &mut self,
        access: Access,
        (base, index): (&Expr, &Expr),
        arguments: &[Expr],
        expr: &Expr,
    ) -> Option<Value> {
        if !self.is_switched(access, arguments) {
            return None;
        }
        let Type::Array(_, Some(size)) = base.ty else { return None };
        let Type::Opaque(opaque) = arguments[0].ty else { return None };
        let Access::Sample { lod, .. } = access else { return None };
        let implicit = lod == Lod::Implicit && self.is_fragment();
        let selector = self.value(index);
        let selector = self.kept(index.at, &selector);
        let mut rest: Vec<Expr> = Vec::new();
        for argument in &arguments[1..] {
            let value = self.value(argument);
            let kept = self.kept(argument.at, &value);
            rest.push(Expr { kind: ExprKind::Kept(kept), ..argument.clone() });
        }
        let mut access = access;
        if implicit {
            access = Access::Sample { projected: false, lod: Lod::Gradient, offset: false };
            let slopes = self.slopes(&opaque, &rest[0]);
            rest.extend(slopes);
        }
        let suffix = if index.ty == crate::types::UINT { "u" } else { "" };
        let elements = (0..size).map(|number| {
            let at = crate::check::int_literal(number as i32, index.at);
            let kind = ExprKind::Index(Box::new(base.clone()), Box::new(at));
            let element = Expr { kind, ..arguments[0].clone() };
            let list: Vec<Expr> = std::iter::once(element).chain(rest.iter().cloned()).collect();
            let label = match number + 1 == size {
                true => "default: {".to_owned(),
                false => format!("case {number}{suffix}: {{"),
            };
            (label, list)
        });
        Some(self.texture_switch(access, &selector, elements.collect(), expr))
    }

    /// A `switch` whose clauses read a texture each.
    fn texture_switch(
        &mut self,
        access: Access,
        selector: &str,
        elements: Vec<(String, Vec<Expr>)>,
        expr: &Expr,
    ) -> Value {
        let name = self.temporary();
        let ty = self.type_text(&expr.ty);
        self.line(expr.at, format!("var {name}: {ty};"));
        self.line(expr.at, format!("switch {selector} {{"));
        for (label, list) in elements {
            let ((), lines) = self.capture(|writer| {
                let value = writer.texture(access, &list, expr);
                writer.line(expr.at, format!("{name} = {};", value.text));
            });
            self.line(expr.at, label);
            self.lines.nest(lines);
            self.line(expr.at, "}");
        }
        self.line(expr.at, "}");
        Value::primary(name, true)
    }

    /// The derivatives of a coordinate, as values that are kept.
    fn slopes(&mut self, opaque: &Opaque, coordinate: &Expr) -> [Expr; 2] {
        self.derivatives = true;
        let value = self.value(coordinate);
        let letters: Vec<u8> = (0..opaque.flat()).collect();
        let place = match opaque.arrayed {
            true => swizzled(&value, opaque.coordinates(), &letters).text,
            false => value.text,
        };
        let ty = Type::vector(Scalar::Float, opaque.flat());
        ["dpdx", "dpdy"].map(|function| {
            let name = self.temporary();
            self.line(coordinate.at, format!("let {name} = {function}({place});"));
            let (kind, at) = (ExprKind::Kept(name), coordinate.at);
            Expr { kind, ty: ty.clone(), at, known: None }
        })
    }

    fn dimensions(&mut self, texture: &str, opaque: &Opaque, level: &str, ty: &Type) -> Value {
        let size = format!("textureDimensions({texture}{level})");
        let name = self.type_text(ty);
        if !opaque.arrayed {
            return Value::primary(format!("{name}({size})"), level.is_empty());
        }
        let flat = if opaque.dim == Dim::Cube { 2 } else { opaque.flat() };
        let inner = self.type_text(&Type::vector(Scalar::Int, flat));
        let layers = format!("i32(textureNumLayers({texture}))");
        Value::primary(format!("{name}({inner}({size}), {layers})"), level.is_empty())
    }

    /// The coordinate of a texel, with the layer of an array.
    fn texel(&mut self, opaque: &Opaque, rest: &[&Expr], value: &Value) -> String {
        if !opaque.arrayed {
            return value.text.clone();
        }
        let kept = self.kept(rest[0].at, value);
        let kept = Value::primary(kept, true);
        let (size, flat) = (opaque.coordinates(), opaque.flat());
        let letters: Vec<u8> = (0..flat).collect();
        let (place, layer) = (swizzled(&kept, size, &letters), swizzled(&kept, size, &[flat]));
        format!("{}, {}", place.text, layer.text)
    }

    fn fetch(
        &mut self,
        names: &OpaqueNames,
        opaque: &Opaque,
        (rest, values): (&[&Expr], &[Value]),
        offset: bool,
    ) -> Value {
        let mut place = values[0].clone();
        if offset && let Some(last) = values.last() {
            if opaque.arrayed {
                self.refuse(rest[0].at, "`texelFetchOffset` of an array is not translated");
            }
            let text =
                format!("{} + {}", place.at_least(Strength::Sum), last.at_least(Strength::Product));
            place = Value { text, strength: Strength::Sum, stable: false };
        }
        let place = self.texel(opaque, rest, &place);
        let level = values.get(1).map_or("0", |value| value.text.as_str());
        let text = format!("textureLoad({}, {place}, {level})", names.texture);
        if names.depth {
            return Value::primary(format!("vec4f({text}, 0.0, 0.0, 1.0)"), false);
        }
        Value::primary(text, false)
    }

    fn coordinate(
        &mut self,
        opaque: &Opaque,
        projected: bool,
        (rest, values): (&[&Expr], &[Value]),
    ) -> Coordinate {
        let size = rest[0].ty.as_vector().map_or(1, |(_, size)| size);
        let flat = opaque.flat();
        let plain = !projected && !opaque.arrayed && !opaque.shadow && size == flat;
        if plain {
            return Coordinate { place: values[0].text.clone(), layer: None, reference: None };
        }
        let kept = Value::primary(self.kept(rest[0].at, &values[0]), true);
        let letters: Vec<u8> = (0..flat).collect();
        let mut place = swizzled(&kept, size, &letters).text;
        let mut reference = opaque.shadow.then(|| {
            let separate = opaque.coordinates() >= 4;
            if separate {
                return values.get(1).map_or(String::new(), |value| value.text.clone());
            }
            let at = opaque.coordinates().max(2);
            swizzled(&kept, size, &[at]).text
        });
        if projected {
            let divisor = swizzled(&kept, size, &[size - 1]).text;
            place = format!("{place} / {divisor}");
            reference = reference.map(|text| format!("{text} / {divisor}"));
        }
        let layer = opaque.arrayed.then(|| {
            let layer = swizzled(&kept, size, &[flat]).text;
            format!("i32(floor({layer} + 0.5))")
        });
        Coordinate { place, layer, reference }
    }

    fn sample(
        &mut self,
        names: &OpaqueNames,
        opaque: &Opaque,
        (projected, lod, offset): (bool, Lod, bool),
        (rest, values): (&[&Expr], &[Value]),
        at: At,
    ) -> Value {
        let coordinate = self.coordinate(opaque, projected, (rest, values));
        let separate = usize::from(opaque.shadow && !projected && opaque.coordinates() >= 4);
        let mut further = values[1 + separate..].iter().map(|value| value.text.clone());
        let mut exprs = rest[1 + separate..].iter();
        let sampler = names.sampler.clone().unwrap_or_default();
        let mut list = vec![names.texture.clone(), sampler, coordinate.place];
        list.extend(coordinate.layer);
        let levels: Vec<String> = match lod {
            Lod::Level => further.by_ref().take(1).collect(),
            Lod::Gradient => further.by_ref().take(2).collect(),
            Lod::Implicit | Lod::Fetch => Vec::new(),
        };
        let level_exprs: Vec<&&Expr> = exprs.by_ref().take(levels.len()).collect();
        let shift = if offset {
            further.next();
            exprs.next().and_then(|expr| self.offset_text(expr))
        } else {
            None
        };
        let bias = further.next();
        if let Some(reference) = coordinate.reference {
            let is_zero = level_exprs.iter().all(|expr| is_zero(expr));
            if !is_zero || bias.is_some() {
                self.refuse(at, "WGSL compares with a depth texture at level 0 or by derivatives");
            }
            list.push(reference);
            list.extend(shift);
            return self.compared(lod, &list);
        }
        if names.depth {
            return self.depth_sampled(lod, (&level_exprs, bias.is_some()), list, shift, at);
        }
        let name = self.sampling_function(lod, bias.is_some());
        self.derivatives |= matches!(name, "textureSampleBias" | "textureSample");
        let zero = name == "textureSampleLevel" && levels.is_empty() && bias.is_none();
        list.extend(levels);
        list.extend(bias);
        list.extend(zero.then(|| "0.0".to_owned()));
        list.extend(shift);
        Value::primary(format!("{name}({})", list.join(", ")), false)
    }

    /// A depth texture without a comparison. Its levels are integers in WGSL, and it has no gradients.
    fn depth_sampled(
        &mut self,
        lod: Lod,
        (levels, bias): (&[&&Expr], bool),
        mut list: Vec<String>,
        shift: Option<String>,
        at: At,
    ) -> Value {
        let level = match levels {
            [] if !self.is_fragment() => Some(0),
            [level] => Self::constant_of(level).and_then(whole_level),
            _ => None,
        };
        if bias || (level.is_none() && lod != Lod::Implicit) {
            let message = "a texture that is also compared with is sampled at a constant level that is \
                           whole, or by derivatives, in WGSL";
            self.refuse(at, message);
        }
        let name = if level.is_some() { "textureSampleLevel" } else { "textureSample" };
        self.derivatives |= level.is_none();
        list.extend(level.map(|level| level.to_string()));
        list.extend(shift);
        Value::primary(format!("vec4f({name}({}), 0.0, 0.0, 1.0)", list.join(", ")), false)
    }

    /// Only fragment shaders take derivatives.
    fn sampling_function(&self, lod: Lod, bias: bool) -> &'static str {
        match (lod, bias) {
            (Lod::Level, _) => "textureSampleLevel",
            (Lod::Gradient, _) => "textureSampleGrad",
            _ if !self.is_fragment() => "textureSampleLevel",
            (_, true) => "textureSampleBias",
            _ => "textureSample",
        }
    }

    /// A comparison with a depth texture.
    fn compared(&mut self, lod: Lod, list: &[String]) -> Value {
        let implicit = lod == Lod::Implicit && self.is_fragment();
        self.derivatives |= implicit;
        let name = if implicit { "textureSampleCompare" } else { "textureSampleCompareLevel" };
        Value::primary(format!("{name}({})", list.join(", ")), false)
    }

    /// An offset, which is a constant in WGSL.
    fn offset_text(&mut self, expr: &Expr) -> Option<String> {
        let Some(known) = &expr.known else {
            self.refuse(expr.at, "the offset of a texture function is a constant in WGSL");
            return None;
        };
        self.known_text(&expr.ty, known).map(|value| value.text)
    }

    fn gather(
        &mut self,
        names: &OpaqueNames,
        opaque: &Opaque,
        (rest, values): (&[&Expr], &[Value]),
        offset: bool,
    ) -> Value {
        let plain = Opaque { shadow: false, ..*opaque };
        let coordinate = self.coordinate(&plain, false, (rest, values));
        let mut next = 1;
        let mut list = vec![names.texture.clone()];
        list.push(names.sampler.clone().unwrap_or_default());
        list.push(coordinate.place);
        list.extend(coordinate.layer);
        if opaque.shadow {
            list.push(values[next].text.clone());
            next += 1;
        }
        if offset {
            list.extend(self.offset_text(rest[next]));
            next += 1;
        }
        if opaque.shadow {
            return Value::primary(format!("textureGatherCompare({})", list.join(", ")), false);
        }
        let component = match rest.get(next) {
            None => 0,
            Some(expr) => match Self::constant_of(expr).and_then(Number::as_size) {
                Some(component) => component,
                None => {
                    self.refuse(expr.at, "the component is a constant in WGSL");
                    0
                }
            },
        };
        let list = list.join(", ");
        let text = match (names.depth, component) {
            (false, _) => format!("textureGather({component}, {list})"),
            (true, 0) => format!("textureGather({list})"),
            // What a depth texture has beside its depth.
            (true, 1 | 2) => "vec4f()".to_owned(),
            (true, _) => "vec4f(1.0)".to_owned(),
        };
        Value::primary(text, false)
    }
}

/// Whether each number of a constant is 0.
fn is_zero(expr: &Expr) -> bool {
    let is_zero = |number: &Number| matches!(number, Number::Float(0.0));
    expr.known.as_deref().is_some_and(|known| known.iter().all(is_zero))
}

/// A level as an integer.
fn whole_level(level: Number) -> Option<u32> {
    match level {
        Number::Float(level) if level.fract() == 0.0 && (0.0..32.0).contains(&level) => {
            Some(level as u32)
        }
        _ => None,
    }
}
