//! Expressions as GLSL.

use std::collections::BTreeMap;

use lamplight_diagnostic::Diagnostic;
use lamplight_diagnostic::source::Span;

use super::dialect::Dialect;
use super::facts::{Facts, StageField};
use super::names::{Names, free_name};
use super::place::{Pairs, Samplers};
use super::range::{Counters, range_of};
use super::words::macro_name;
use crate::tree::{Argument, Binary, Callee, Expression, ExpressionKind, LineBreak, Meaning};
use crate::tree::{Number, NumberValue, Scalar, Type, Unary};
use crate::types::{Folded, Globals, fold};
use crate::wesl::untranslated;

/// How tightly things bind. Binary operators have the numbers of [`crate::tree::BINARY`].
pub const CHOICE: u8 = 0;
pub const UNARY: u8 = 15;
pub const POSTFIX: u8 = 19;

/// What writes the body of a function.
pub struct Writer<'a> {
    pub globals: &'a Globals,
    pub facts: &'a Facts,
    pub names: &'a Names,
    /// Whether pairs of a texture and a sampler are written with the library's macros.
    pub has_macros: bool,
    /// What the parameters and locals are, by where they are declared.
    pub locals: BTreeMap<u32, LocalRole>,
    pub counters: Counters,
    /// The samplers that textures of the module are read with.
    pub samplers: &'a Samplers,
    /// The same for parameters.
    pub pairs: Pairs,
}

/// What a parameter or a local has become.
#[derive(Debug, Clone, PartialEq)]
pub enum LocalRole {
    Named(String),
    /// An input of the stage, as it is written.
    Input(String),
    /// What a stage takes: its members are variables of the stage.
    Stage(Vec<StageField>),
    /// What a stage returns.
    Outputs(Vec<StageField>),
}

/// A text, and how tightly its outermost operator binds.
pub struct Bound(pub String, pub u8);

impl Bound {
    pub fn primary(text: impl Into<String>) -> Self {
        Self(text.into(), 20)
    }
}

/// The text of an expression, or why there is none.
pub type Written = Result<Bound, Diagnostic>;

impl Writer<'_> {
    pub fn dialect(&self) -> Dialect {
        self.names.dialect
    }

    /// An expression that needs no parentheses around it.
    pub fn whole(&self, value: &Expression, indent: usize) -> Result<String, Diagnostic> {
        Ok(self.bound(value, indent)?.0)
    }

    /// An expression as an operand, in parentheses if it binds less tightly than `least`.
    pub fn operand(
        &self,
        value: &Expression,
        least: u8,
        indent: usize,
    ) -> Result<String, Diagnostic> {
        let Bound(text, binds) = self.bound(value, indent)?;
        Ok(if binds < least { format!("({text})") } else { text })
    }

    pub fn bound(&self, value: &Expression, indent: usize) -> Written {
        match &value.kind {
            ExpressionKind::Number(number) => Ok(number_text(number, &value.ty)),
            ExpressionKind::Bool(value) => Ok(Bound::primary(value.to_string())),
            ExpressionKind::Name(name, meaning) => self.name(name, meaning, value.span),
            ExpressionKind::Axis(axis) => Ok(Bound::primary(macro_name(axis))),
            ExpressionKind::Parenthesised(inner) if is_reference(inner) => {
                self.bound(inner, indent)
            }
            ExpressionKind::Parenthesised(inner) => {
                Ok(Bound::primary(format!("({})", self.whole(inner, indent)?)))
            }
            ExpressionKind::Convert(inner) => self.converted(inner, &value.ty, indent),
            ExpressionKind::Unary(operator, inner) => self.unary(*operator, inner, indent),
            ExpressionKind::Binary { operator, left, right, line_break } => {
                self.binary(*operator, left, right, *line_break, indent)
            }
            ExpressionKind::Member(object, member) => self.member(object, member, indent),
            ExpressionKind::Index(object, index) => {
                let object = self.operand(object, POSTFIX, indent)?;
                Ok(Bound(format!("{object}[{}]", self.whole(index, indent)?), POSTFIX))
            }
            ExpressionKind::Call { callee, arguments, is_broken } => {
                self.call(callee, arguments, *is_broken, value, indent)
            }
        }
    }

    fn name(&self, name: &str, meaning: &Meaning, span: Span) -> Written {
        match meaning {
            Meaning::Local(numbers) => match self.role(numbers) {
                Some(LocalRole::Named(name)) => Ok(Bound::primary(name)),
                Some(LocalRole::Input(text)) => Ok(Bound(text.clone(), POSTFIX)),
                Some(LocalRole::Stage(_) | LocalRole::Outputs(_)) => {
                    Err(untranslated(span, "the whole of what a stage takes or returns"))
                }
                None => Err(untranslated(span, format!("`{name}`"))),
            },
            Meaning::Item(path) => Ok(Bound::primary(self.names.item(path))),
            Meaning::Unknown => Err(untranslated(span, format!("`{name}`"))),
        }
    }

    /// What a local is; nothing if that depends on conditions.
    pub fn role(&self, numbers: &[u32]) -> Option<&LocalRole> {
        let mut roles = numbers.iter().map(|number| self.locals.get(number));
        let first = roles.next()??;
        roles.all(|other| other == Some(first)).then_some(first)
    }

    /// A value of another type: of an axis, of an abstract constant, or of integers that an axis
    /// decides.
    fn converted(&self, inner: &Expression, ty: &Type, indent: usize) -> Written {
        let same = matches!(
            (inner.ty.scalar(), ty.scalar()),
            (Some(Scalar::AbstractInteger | Scalar::I32), Some(Scalar::I32))
                | (Some(Scalar::AbstractFloat), Some(Scalar::F32))
        );
        if same {
            return self.bound(inner, indent);
        }
        if let (ExpressionKind::Name(..), Some(folded)) = (&inner.kind, fold(inner, self.globals)) {
            let value = match folded {
                Folded::Integer(value) => NumberValue::Integer(value),
                Folded::Float(value) => NumberValue::Float(value),
            };
            let text = match value {
                NumberValue::Integer(value) => value.to_string(),
                NumberValue::Float(value) => format!("{:?}", value as f32),
            };
            return Ok(number_text(&Number { text, value }, ty));
        }
        let name = self.names.type_name(ty, inner.span)?;
        Ok(Bound(format!("{name}({})", self.whole(inner, indent)?), POSTFIX))
    }

    fn unary(&self, operator: Unary, inner: &Expression, indent: usize) -> Written {
        let sign = match operator {
            Unary::Negate => "-",
            Unary::Not
                if matches!(inner.ty, Type::Vector(..)) && self.dialect() == Dialect::Glsl =>
            {
                let inner = self.whole(inner.bare(), indent)?;
                return Ok(Bound(format!("not({inner})"), POSTFIX));
            }
            Unary::Not => "!",
            Unary::Complement => "~",
            Unary::Address | Unary::Follow => return self.bound(inner, indent),
        };
        let text = self.operand(inner, UNARY, indent)?;
        Ok(match text.starts_with(sign) {
            true => Bound(format!("{sign}({text})"), UNARY),
            false => Bound(format!("{sign}{text}"), UNARY),
        })
    }

    fn member(&self, object: &Expression, member: &str, indent: usize) -> Written {
        if let ExpressionKind::Name(_, Meaning::Local(number)) = &object.bare().kind
            && let Some(LocalRole::Stage(fields) | LocalRole::Outputs(fields)) = self.role(number)
        {
            return stage_member(fields, member, object.span);
        }
        let member = match followed(&object.ty) {
            Type::Structure(path) => self.names.member(path, member),
            _ => member,
        };
        let object = self.operand(object, POSTFIX, indent)?;
        Ok(Bound(format!("{object}.{member}"), POSTFIX))
    }

    /// A call of a function or of a type.
    fn call(
        &self,
        callee: &Callee,
        arguments: &[Argument],
        is_broken: bool,
        value: &Expression,
        indent: usize,
    ) -> Written {
        match callee {
            Callee::Function(path) => {
                let kept: Vec<&Argument> = arguments
                    .iter()
                    .filter(|argument| !self.facts.is_stage_type(&argument.value.ty))
                    .collect();
                self.check_stage_arguments(arguments)?;
                let texts = self.paired_arguments(&kept, indent)?;
                Ok(Bound(listed(self.names.item(path), &texts, is_broken, indent), POSTFIX))
            }
            Callee::Construct(ty) => self.construct(ty, arguments, is_broken, value.span, indent),
            Callee::Bitcast(target) => {
                let [argument] = arguments else {
                    return Err(untranslated(value.span, "this `bitcast`"));
                };
                self.bitcast(target, &argument.value, indent)
            }
            Callee::Builtin(name) => self.builtin(name, arguments, value, is_broken, indent),
            Callee::Name(name) => Err(untranslated(value.span, format!("`{name}`"))),
        }
    }

    /// What a stage takes is passed on as it is, or not at all.
    fn check_stage_arguments(&self, arguments: &[Argument]) -> Result<(), Diagnostic> {
        for argument in arguments {
            let value = argument.value.bare();
            if !self.facts.is_stage_type(&value.ty) {
                continue;
            }
            let is_whole = match &value.kind {
                ExpressionKind::Name(_, Meaning::Local(number)) => {
                    matches!(self.role(number), Some(LocalRole::Stage(_)))
                }
                _ => false,
            };
            if !is_whole {
                return Err(untranslated(value.span, "a made value of what a stage takes"));
            }
        }
        Ok(())
    }

    fn construct(
        &self,
        ty: &Type,
        arguments: &[Argument],
        is_broken: bool,
        span: Span,
        indent: usize,
    ) -> Written {
        if arguments.is_empty() {
            return Ok(Bound(self.zero(ty, span)?, POSTFIX));
        }
        if self.dialect() == Dialect::Hlsl
            && let Some(made) = self.hlsl_construct(ty, arguments, is_broken, span, indent)?
        {
            return Ok(made);
        }
        let name = self.names.type_name(ty, span)?;
        if let ([argument], Type::Scalar(scalar)) = (arguments, ty) {
            let text = self.scalar_conversion(*scalar, &argument.value, indent)?;
            return Ok(Bound(text, POSTFIX));
        }
        if let ([argument], Some(Scalar::I32 | Scalar::U32), Some(Scalar::F32)) =
            (arguments, ty.scalar(), arguments[0].value.ty.scalar())
        {
            let size = argument.value.ty.clone();
            let text = self.in_range(&argument.value, ty, &size, indent)?;
            return Ok(Bound(format!("{name}({text})"), POSTFIX));
        }
        let texts = self.parts(ty, arguments, is_broken, indent)?;
        let is_braced = matches!(ty, Type::Structure(_) | Type::Array(..));
        let brackets = if is_braced && self.dialect() == Dialect::Msl { "{}" } else { "()" };
        Ok(Bound(listed_in(&name, brackets, &texts, is_broken, indent), POSTFIX))
    }

    /// The arguments of a constructor as texts.
    pub fn parts(
        &self,
        ty: &Type,
        arguments: &[Argument],
        is_broken: bool,
        indent: usize,
    ) -> Result<Vec<(String, bool)>, Diagnostic> {
        let mut texts = Vec::new();
        for argument in arguments {
            let text = match self.signed_size(&argument.value, indent)? {
                Some(size) if ty.scalar() == Some(Scalar::F32) => size,
                _ => self.whole(&argument.value, indent + usize::from(is_broken))?,
            };
            texts.push((text, argument.is_on_new_line));
        }
        Ok(texts)
    }

    /// A name that no local of the function has.
    pub fn free_local(&self, wanted: &str) -> String {
        let named = self.locals.values().filter_map(|role| match role {
            LocalRole::Named(name) => Some(name.clone()),
            _ => None,
        });
        free_name(wanted, &named.collect())
    }

    /// A number in each component of a vector.
    pub fn splat(&self, ty: &Type, number: &str, span: Span) -> Result<Bound, Diagnostic> {
        let name = self.names.type_name(ty, span)?;
        Ok(match self.dialect() {
            Dialect::Hlsl => Bound(format!("({name}){number}"), UNARY),
            Dialect::Glsl | Dialect::Msl => Bound(format!("{name}({number})"), POSTFIX),
        })
    }

    /// `int(x)` and its like. WGSL takes the nearest number of the type where GLSL leaves the result
    /// open.
    pub fn scalar_conversion(
        &self,
        scalar: Scalar,
        value: &Expression,
        indent: usize,
    ) -> Result<String, Diagnostic> {
        let name = self.names.type_name(&Type::Scalar(scalar), value.span)?;
        let from = value.ty.scalar();
        let text = match (scalar, from) {
            (Scalar::I32 | Scalar::U32, Some(Scalar::F32)) => {
                self.in_range(value, &Type::Scalar(scalar), &Type::F32, indent)?
            }
            _ => self.whole(value, indent)?,
        };
        Ok(format!("{name}({text})"))
    }

    /// A float within the range of an integer type.
    fn in_range(
        &self,
        value: &Expression,
        ty: &Type,
        size: &Type,
        indent: usize,
    ) -> Result<String, Diagnostic> {
        // The floats that are the first below these types, and the last in them.
        let (least, most, low, high) = match ty.scalar() {
            Some(Scalar::U32) => (-1.0, 4_294_967_040.0, "0.0", "4294967040.0"),
            _ => (-2_147_483_904.0, 2_147_483_520.0, "-2147483648.0", "2147483520.0"),
        };
        let range = range_of(value, &self.counters);
        let is_low = range.least <= least;
        let is_high = range.most > most;
        let text = self.whole(value, indent)?;
        let wide = |number: &str| match size {
            Type::Vector(..) => {
                self.splat(size, number, value.span).map_or(String::new(), |one| one.0)
            }
            _ => number.to_owned(),
        };
        Ok(match (is_low, is_high) {
            (true, true) => format!("clamp({text}, {}, {})", wide(low), wide(high)),
            (true, false) => format!("max({text}, {})", wide(low)),
            (false, true) => format!("min({text}, {})", wide(high)),
            (false, false) => text,
        })
    }

    fn bitcast(&self, target: &Type, value: &Expression, indent: usize) -> Written {
        let text = self.whole(value, indent)?;
        let name = match (target.scalar(), value.ty.scalar()) {
            (Some(to), Some(from)) if to == from => return self.bound(value, indent),
            (Some(_), Some(_)) if self.dialect() == Dialect::Msl => {
                format!("as_type<{}>", self.names.type_name(target, value.span)?)
            }
            (Some(Scalar::U32), Some(_)) if self.dialect() == Dialect::Hlsl => "asuint".to_owned(),
            (Some(Scalar::I32), Some(_)) if self.dialect() == Dialect::Hlsl => "asint".to_owned(),
            (Some(Scalar::F32), Some(_)) if self.dialect() == Dialect::Hlsl => "asfloat".to_owned(),
            (Some(Scalar::U32), Some(Scalar::F32)) => "floatBitsToUint".to_owned(),
            (Some(Scalar::I32), Some(Scalar::F32)) => "floatBitsToInt".to_owned(),
            (Some(Scalar::F32), Some(Scalar::U32)) => "uintBitsToFloat".to_owned(),
            (Some(Scalar::F32), Some(Scalar::I32)) => "intBitsToFloat".to_owned(),
            (Some(Scalar::I32 | Scalar::U32), Some(Scalar::I32 | Scalar::U32)) => {
                self.names.type_name(target, value.span)?
            }
            _ => return Err(untranslated(value.span, "this `bitcast`")),
        };
        Ok(Bound(format!("{name}({text})"), POSTFIX))
    }

    /// The zero of a type.
    pub fn zero(&self, ty: &Type, span: Span) -> Result<String, Diagnostic> {
        Ok(match ty {
            Type::Scalar(Scalar::Bool) => "false".to_owned(),
            Type::Scalar(Scalar::I32) => "0".to_owned(),
            Type::Scalar(Scalar::U32) => "0u".to_owned(),
            Type::Scalar(_) => "0.0".to_owned(),
            Type::Vector(_, scalar) => {
                let zero = self.zero(&Type::Scalar(*scalar), span)?;
                self.splat(ty, &zero, span)?.0
            }
            Type::Matrix { .. } => self.splat(ty, "0.0", span)?.0,
            Type::Structure(_) | Type::Array(..) if self.dialect() == Dialect::Msl => {
                format!("{}{{}}", self.names.type_name(ty, span)?)
            }
            Type::Structure(path) if self.facts.needs_zero(path) => {
                format!("{}()", self.names.zero(path))
            }
            Type::Structure(path) => {
                let members = self.globals.members(path);
                let zeros: Result<Vec<String>, Diagnostic> =
                    members.iter().map(|member| self.zero(&member.ty, span)).collect();
                let name = match self.dialect() {
                    Dialect::Hlsl => self.names.maker(path),
                    Dialect::Glsl | Dialect::Msl => self.names.item(path),
                };
                format!("{name}({})", zeros?.join(", "))
            }
            Type::Array(element, crate::tree::Count::Fixed(count)) if *count <= LONGEST_ZERO => {
                let zero = self.zero(element, span)?;
                let zeros = vec![zero; *count as usize].join(", ");
                match self.dialect() {
                    Dialect::Hlsl => format!("{{{zeros}}}"),
                    Dialect::Glsl | Dialect::Msl => {
                        format!("{}({zeros})", self.names.type_name(ty, span)?)
                    }
                }
            }
            other => return Err(untranslated(span, format!("the zero of {other}"))),
        })
    }

    /// Arguments as texts, and whether each begins a line. A texture and the sampler behind it may
    /// be one macro.
    pub fn paired_arguments(
        &self,
        arguments: &[&Argument],
        indent: usize,
    ) -> Result<Vec<(String, bool)>, Diagnostic> {
        let mut texts = Vec::new();
        let mut at = 0;
        let inner = indent + 1;
        while let Some(argument) = arguments.get(at) {
            let next = arguments.get(at + 1);
            if let Some(pair) = next.and_then(|next| self.pair_argument(argument, next)) {
                texts.push((pair, argument.is_on_new_line));
                at += 2;
                continue;
            }
            texts.push((self.whole(&argument.value, inner)?, argument.is_on_new_line));
            at += 1;
        }
        Ok(texts)
    }

    /// Whether something may be written twice: it has no effects, and costs nothing.
    pub fn is_cheap(&self, value: &Expression) -> bool {
        match &value.kind {
            ExpressionKind::Number(_)
            | ExpressionKind::Bool(_)
            | ExpressionKind::Axis(_)
            | ExpressionKind::Name(..) => true,
            ExpressionKind::Parenthesised(inner)
            | ExpressionKind::Unary(_, inner)
            | ExpressionKind::Member(inner, _)
            | ExpressionKind::Convert(inner) => self.is_cheap(inner),
            ExpressionKind::Index(object, index) => self.is_cheap(object) && self.is_cheap(index),
            // What writes its own operands twice would double the text each time.
            ExpressionKind::Binary { operator: Binary::Divide | Binary::Remainder, .. } => false,
            ExpressionKind::Binary { left, right, .. } => {
                self.is_cheap(left) && self.is_cheap(right)
            }
            ExpressionKind::Call { callee: Callee::Construct(_), arguments, .. } => {
                arguments.iter().all(|argument| self.is_cheap(&argument.value))
            }
            ExpressionKind::Call { .. } => false,
        }
    }

    fn binary(
        &self,
        operator: Binary,
        left: &Expression,
        right: &Expression,
        line_break: LineBreak,
        indent: usize,
    ) -> Written {
        if let Some(special) = self.special_binary(operator, left, right, indent)? {
            return Ok(special);
        }
        let is_truth = left.ty.scalar() == Some(Scalar::Bool);
        let operator = match operator {
            Binary::BitAnd if is_truth => Binary::And,
            Binary::BitOr if is_truth => Binary::Or,
            other => other,
        };
        let (sign, binds) = operator.spelling();
        let inner = indent + usize::from(line_break != LineBreak::None);
        let left = self.operand(left, binds, indent)?;
        let right = self.operand(right, binds + 1, inner)?;
        let line = format!("\n{}", "    ".repeat(inner));
        Ok(match line_break {
            LineBreak::None => Bound(format!("{left} {sign} {right}"), binds),
            LineBreak::Before => Bound(format!("{left}{line}{sign} {right}"), binds),
            LineBreak::After => Bound(format!("{left} {sign}{line}{right}"), binds),
        })
    }
}

/// Whether an expression is a pointer that is followed or made, which GLSL does not write.
fn is_reference(value: &Expression) -> bool {
    match &value.kind {
        ExpressionKind::Unary(Unary::Address | Unary::Follow, _) => true,
        ExpressionKind::Parenthesised(inner) => is_reference(inner),
        _ => false,
    }
}

/// The longest array whose zero is written as a list.
const LONGEST_ZERO: u32 = 64;

/// The type that a pointer leads to, or the type itself.
pub fn followed(ty: &Type) -> &Type {
    match ty {
        Type::Pointer(_, target) => target,
        other => other,
    }
}

fn stage_member(fields: &[StageField], member: &str, span: Span) -> Written {
    let mut found = fields.iter().filter(|field| field.name == member);
    let field = found.next().ok_or_else(|| untranslated(span, format!("`{member}`")))?;
    Ok(Bound(field.variable.clone(), POSTFIX))
}

/// A call with its arguments, on lines of their own where they were.
pub fn listed(name: &str, arguments: &[(String, bool)], is_broken: bool, indent: usize) -> String {
    listed_in(name, "()", arguments, is_broken, indent)
}

/// The same with other brackets.
pub fn listed_in(
    name: &str,
    brackets: &str,
    arguments: &[(String, bool)],
    is_broken: bool,
    indent: usize,
) -> String {
    let mut text = format!("{name}{}", &brackets[..1]);
    for (index, (argument, is_on_new_line)) in arguments.iter().enumerate() {
        if index > 0 {
            text.push(',');
        }
        match (is_on_new_line, index) {
            (true, _) => text += &format!("\n{}", "    ".repeat(indent + 1)),
            (false, 0) => {}
            (false, _) => text.push(' '),
        }
        text += argument;
    }
    if is_broken {
        text += &format!("\n{}", "    ".repeat(indent));
    }
    text + &brackets[1..]
}

/// A number as GLSL writes it.
pub fn number_text(number: &Number, ty: &Type) -> Bound {
    let is_hex = number.text.starts_with("0x") || number.text.starts_with("0X");
    let text = match (ty.scalar(), number.value) {
        (Some(Scalar::F32 | Scalar::AbstractFloat), NumberValue::Float(value)) if is_hex => {
            format!("{:?}", value as f32)
        }
        (Some(Scalar::F32 | Scalar::AbstractFloat), NumberValue::Float(_)) => {
            let has_point = number.text.contains(['.', 'e', 'E']);
            if has_point { number.text.clone() } else { format!("{}.0", number.text) }
        }
        (Some(Scalar::F32 | Scalar::AbstractFloat), NumberValue::Integer(value)) => {
            if is_hex {
                format!("{value}.0")
            } else {
                format!("{}.0", number.text)
            }
        }
        (Some(Scalar::U32), _) => format!("{}u", number.text),
        (Some(Scalar::I32), NumberValue::Integer(value)) if value == i64::from(i32::MIN) => {
            return Bound("-2147483647 - 1".to_owned(), 10);
        }
        _ => number.text.clone(),
    };
    match text.starts_with('-') {
        true => Bound(text, UNARY),
        false => Bound::primary(text),
    }
}
