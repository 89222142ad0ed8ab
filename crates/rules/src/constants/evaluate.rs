//! Computes constant expressions.

use std::cell::RefCell;

use rustc_hash::FxHashMap;

use super::builtin;
use super::value::{Kind, Shape, Value};
use crate::names::{Global, Module};
use crate::syntax::{DeclarationKind, ExprId, ExprKind};

/// How deep expressions and the constants that they name are followed.
const DEPTH: usize = 200;

/// The constants of a module, each of which is computed once.
pub struct Constants<'t, 'm, 'a> {
    pub module: &'a Module<'t, 'm>,
    known: RefCell<FxHashMap<ExprId, Option<Value>>>,
}

impl<'t, 'm, 'a> Constants<'t, 'm, 'a> {
    pub fn of(module: &'a Module<'t, 'm>) -> Self {
        Self { module, known: RefCell::default() }
    }

    /// The value of an expression; `None` where it is not constant, where it has no value, or where
    /// it is of a type that is not followed here.
    pub fn value(&self, id: ExprId) -> Option<Value> {
        self.value_at(id, 0)
    }

    /// The type of the numbers of an expression, if it is constant or the name of a variable.
    pub fn kind(&self, id: ExprId) -> Option<Kind> {
        self.type_of(id).map(|(kind, _)| kind)
    }

    /// The type of an expression, if it is constant or the name of a variable.
    pub fn type_of(&self, id: ExprId) -> Option<(Kind, Shape)> {
        match self.value(id) {
            Some(value) => Some((value.kind, value.shape)),
            None => self.type_at(self.module.declared_type(id)?),
        }
    }

    /// A type of numbers that is written out.
    pub fn type_at(&self, id: ExprId) -> Option<(Kind, Shape)> {
        let (name, template) = self.module.type_of(id)?;
        let (kind, shape) = self.named_type(name, template)?;
        Some((kind?, shape))
    }

    fn value_at(&self, id: ExprId, depth: usize) -> Option<Value> {
        if let Some(known) = self.known.borrow().get(&id) {
            return known.clone();
        }
        if depth > DEPTH {
            return None;
        }
        // What leads back to itself has no value.
        self.known.borrow_mut().insert(id, None);
        let value = self.computed(id, depth + 1);
        self.known.borrow_mut().insert(id, value.clone());
        value
    }

    fn computed(&self, id: ExprId, depth: usize) -> Option<Value> {
        let tree = self.module.tree;
        match tree.kind(id) {
            ExprKind::Literal(text) => Value::literal(text),
            ExprKind::Parenthesized(inner) => self.value_at(*inner, depth),
            ExprKind::Unary { operator, operand } => {
                builtin::unary(operator, &self.value_at(*operand, depth)?)
            }
            ExprKind::Binary { operator, left, right } => {
                builtin::binary(operator, &self.value_at(*left, depth)?, || {
                    self.value_at(*right, depth)
                })
            }
            ExprKind::Name { name: _, template: _, local: Some(local) } => {
                let local = &tree.locals[*local as usize];
                self.declared(local.of_type, local.constant?, depth)
            }
            ExprKind::Name { name, template, local: None } if template.is_empty() => {
                let Some(Global::Constant(at)) = self.module.find(name) else { return None };
                let found = &tree.declarations[at];
                (found.kind == DeclarationKind::Const).then_some(())?;
                self.declared(found.of_type, found.value?, depth)
            }
            ExprKind::Call { callee, template, arguments } => {
                self.call(callee, template, arguments, depth)
            }
            ExprKind::Member { base, name } => self.member(*base, name, depth),
            ExprKind::Index { base, index } => {
                let (base, index) = (self.value_at(*base, depth)?, self.value_at(*index, depth)?);
                element(&base, index.number().filter(|_| index.kind.is_int())?)
            }
            ExprKind::Name { .. } | ExprKind::AddressOf(_) | ExprKind::Indirection(_) => None,
        }
    }

    /// The value that a declaration gives to a name.
    fn declared(&self, of_type: Option<ExprId>, value: ExprId, depth: usize) -> Option<Value> {
        let value = self.value_at(value, depth)?;
        let Some(of_type) = of_type else { return Some(value) };
        let (name, template) = self.module.type_of(of_type)?;
        let (kind, shape) = self.named_type(name, template)?;
        (value.shape == shape).then(|| value.converted(kind?)).flatten()
    }

    /// The kind and the shape of a type. Constructors need not name the kind.
    fn named_type(&self, name: &str, template: &[ExprId]) -> Option<(Option<Kind>, Shape)> {
        if let Some(kind) = Kind::named(name) {
            return Some((Some(kind), Shape::Scalar));
        }
        let (shape, suffix) = shape_of(name)?;
        let kind = match template {
            [] if suffix.is_empty() => None,
            [] => Some(Kind::of_suffix(suffix)?),
            [kind] if suffix.is_empty() => {
                let (name, _) = self.module.type_of(*kind)?;
                Some(Kind::named(name)?)
            }
            _ => return None,
        };
        Some((kind, shape))
    }

    fn call(
        &self,
        callee: &str,
        template: &[ExprId],
        arguments: &[ExprId],
        depth: usize,
    ) -> Option<Value> {
        let (callee, template) = match self.module.find(callee) {
            None => (callee, template),
            Some(Global::Alias(at)) if template.is_empty() => {
                self.module.type_of(self.module.tree.aliases[at].of_type)?
            }
            Some(_) => return None,
        };
        let values: Option<Vec<Value>> =
            arguments.iter().map(|id| self.value_at(*id, depth)).collect();
        let values = values?;
        match self.named_type(callee, template) {
            Some((kind, shape)) => construct(kind, shape, &values),
            None if template.is_empty() => builtin::call(callee, &values),
            None => None,
        }
    }

    fn member(&self, base: ExprId, name: &str, depth: usize) -> Option<Value> {
        let tree = self.module.tree;
        if let ExprKind::Call { callee, template: _, arguments } = tree.kind(tree.inner(base))
            && let ("modf" | "frexp", [only]) = (*callee, arguments.as_slice())
            && self.module.find(callee).is_none()
        {
            return builtin::part_of(callee, name, &self.value_at(*only, depth)?);
        }
        let base = self.value_at(base, depth)?;
        let Shape::Vector(_) = base.shape else { return None };
        let part = |letter: char| {
            let at = "xyzw".find(letter).or_else(|| "rgba".find(letter))?;
            base.parts.get(at).copied()
        };
        let parts: Option<Vec<f64>> = name.chars().map(part).collect();
        let parts = parts?;
        let shape = if parts.len() == 1 { Shape::Scalar } else { Shape::Vector(parts.len()) };
        Value::new(base.kind, shape, &parts)
    }
}

/// The shape that the name of a vector or a matrix stands for, and the rest of the name.
fn shape_of(name: &str) -> Option<(Shape, &str)> {
    let digit = |text: &str| {
        let count = text.chars().next()?.to_digit(10)? as usize;
        (2..=4).contains(&count).then_some(count)
    };
    if let Some(rest) = name.strip_prefix("vec") {
        return Some((Shape::Vector(digit(rest)?), &rest[1..]));
    }
    let (columns, rest) = name.strip_prefix("mat")?.split_once('x')?;
    let columns = digit(columns).filter(|_| columns.len() == 1)?;
    Some((Shape::Matrix(columns, digit(rest)?), &rest[1..]))
}

/// A column or a component.
fn element(base: &Value, index: f64) -> Option<Value> {
    let at = (index >= 0.0).then_some(index as usize)?;
    match base.shape {
        Shape::Scalar => None,
        Shape::Vector(_) => Value::scalar(base.kind, *base.parts.get(at)?),
        Shape::Matrix(_, rows) => {
            Value::new(base.kind, Shape::Vector(rows), base.parts.chunks(rows).nth(at)?)
        }
    }
}

/// The value of a constructor or a conversion.
fn construct(kind: Option<Kind>, shape: Shape, values: &[Value]) -> Option<Value> {
    let kind = match (kind, values) {
        (Some(kind), _) => kind,
        (None, []) => Kind::AbstractInt,
        (None, [first, rest @ ..]) => {
            let common = |kind: Kind, value: &Value| kind.common(value.kind);
            rest.iter().try_fold(first.kind, common)?
        }
    };
    // Matrices of whole numbers are of abstract floats.
    let kind = match (shape, kind) {
        (Shape::Matrix(..), Kind::AbstractInt) => Kind::AbstractFloat,
        _ => kind,
    };
    // One value of the same shape is converted; parts convert only by themselves.
    let is_conversion = matches!(values, [one] if one.shape == shape);
    let parts: Option<Vec<Value>> = values
        .iter()
        .map(|value| if is_conversion { value.cast(kind) } else { value.converted(kind) })
        .collect();
    let parts: Vec<f64> = parts?.into_iter().flat_map(|value| value.parts).collect();
    match (parts.as_slice(), shape) {
        ([], _) => Value::new(kind, shape, &vec![0.0; shape.count()]),
        ([one], Shape::Vector(count)) => Value::new(kind, shape, &vec![*one; count]),
        _ => Value::new(kind, shape, &parts),
    }
}
