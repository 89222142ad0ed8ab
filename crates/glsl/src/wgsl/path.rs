//! Paths: variables with members and indices, which are read and written.

use std::borrow::Cow;
use std::rc::Rc;

use super::Writer;
use super::constant::is_refused_beside;
use super::memory::Mem;
use super::output::Line;
use super::value::Value;
use crate::lexer::At;
use crate::tree::{Dir, Expr, ExprKind, Op, Place, Shader};
use crate::types::{Scalar, Type};

/// A place that is read or written.
#[derive(Debug, Clone)]
pub(super) struct Path {
    pub(super) text: String,
    pub(super) ty: Type,
    pub(super) mem: Rc<Mem>,
    /// A column of a matrix whose rows are stored: the text is the matrix.
    column: Option<String>,
}

impl Writer<'_> {
    /// The path that an expression is. `None` for values.
    pub(super) fn path(&mut self, expr: &Expr) -> Option<Path> {
        match &expr.kind {
            ExprKind::Var(index) => Some(self.var_path(*index, expr)),
            ExprKind::Member(base, member) => {
                let path = self.path(base)?;
                let Type::Struct(index) = base.ty else { return None };
                let mem = match &*path.mem {
                    _ if self.is_atomic(base, *member) => Rc::new(Mem::Atomic),
                    Mem::Struct(_, fields) => Rc::clone(&fields[*member as usize]),
                    _ => Rc::new(Mem::Value),
                };
                let text = format!("{}.{}", path.text, self.member_name(index, *member));
                Some(Path { text, ty: expr.ty.clone(), mem, column: None })
            }
            ExprKind::Index(base, index) => {
                if let Some(path) = self.block_of_array(base, index, expr) {
                    return Some(path);
                }
                let path = self.path(base)?;
                let index = self.index_text(index);
                Some(indexed(path, &base.ty, &index, expr.ty.clone()))
            }
            _ => None,
        }
    }

    /// Members that are atomic are known by their block and number.
    fn is_atomic(&self, base: &Expr, member: u32) -> bool {
        match base.kind {
            ExprKind::Var(index) => self.atomics.contains(&(index, Some(member))),
            _ => false,
        }
    }

    fn var_path(&mut self, index: u32, expr: &Expr) -> Path {
        let mem = self.memory.get(&index).cloned().unwrap_or_else(|| Rc::new(Mem::Value));
        let ty = expr.ty.clone();
        let var = self.var(index);
        let name = self.var_name(index);
        let is_pointer = matches!(var.place, Place::Param(Dir::Out | Dir::InOut));
        let text = if is_pointer {
            format!("(*{name})")
        } else if var.place == Place::Uniform {
            format!("{}.{name}", self.entry.uniforms)
        } else {
            name
        };
        Path { text, ty, mem, column: None }
    }

    /// One of an array of blocks, which are variables of their own.
    fn block_of_array(&mut self, base: &Expr, index: &Expr, expr: &Expr) -> Option<Path> {
        let ExprKind::Var(var) = base.kind else { return None };
        if !matches!(self.place(var), Place::UniformBlock | Place::StorageBlock) {
            return None;
        }
        let mem = self.memory.get(&var).cloned().unwrap_or_else(|| Rc::new(Mem::Value));
        if self.is_bound(base) {
            let at = self.index_text(index);
            let text = format!("{}[{at}]", self.var_name(var));
            return Some(Path { text, ty: expr.ty.clone(), mem, column: None });
        }
        let number = index.known.as_deref().and_then(|known| known.first()?.as_size());
        if number.is_none() {
            self.refuse(index.at, "an array of blocks is indexed by constants in WGSL");
        }
        let text = format!("{}_{}", self.var_name(var), number.unwrap_or(0));
        Some(Path { text, ty: expr.ty.clone(), mem, column: None })
    }

    /// An index, as a number where it is known.
    fn index_text(&mut self, index: &Expr) -> String {
        if let Some([number]) = index.known.as_deref()
            && let Some(number) = number.as_size()
        {
            return number.to_string();
        }
        self.value(index).text
    }

    /// What is at a path.
    pub(super) fn read(&mut self, path: &Path) -> Value {
        let Some(column) = &path.column else { return self.load(&path.text, &path.ty, &path.mem) };
        let rows: Vec<String> = row_texts(path, column);
        let name = self.type_text(&path.ty);
        Value::primary(format!("{name}({})", rows.join(", ")), false)
    }

    /// Writes a value to a path.
    pub(super) fn write_path(&mut self, at: At, path: &Path, value: &Value) {
        let Some(column) = &path.column else {
            self.store(at, &path.text, &path.ty, &path.mem, value);
            return;
        };
        let name = self.kept(at, value);
        for (row, text) in row_texts(path, column).into_iter().enumerate() {
            self.line(at, format!("{text} = {name}[{row}];"));
        }
    }

    /// An assignment, with the value of the left side before it if that is asked for.
    pub(super) fn assign(&mut self, op: Option<Op>, left: &Expr, right: &Expr, at: At) {
        let effects = has_effects(left, self.shader) || has_effects(right, self.shader);
        let left = &*self.settled(left, effects);
        if let ExprKind::Swizzle(base, letters) = &left.kind {
            self.assign_swizzle(op, (base, letters), left, right, at);
        } else if let Some(path) = self.path(left) {
            self.assign_path(op, &path, (left, right), at);
        } else {
            self.refuse(left.at, "this place is not written in WGSL");
        }
    }

    fn assign_path(&mut self, op: Option<Op>, path: &Path, pair: (&Expr, &Expr), at: At) {
        let (left, right) = pair;
        let mut value = self.value(right);
        let Some(op) = op else {
            self.write_path(at, path, &value);
            return;
        };
        if is_refused_beside(op, &left.ty, right) {
            value = self.unfolded(&right.ty, &value);
        }
        let plain = *path.mem == Mem::Value && path.column.is_none();
        let matrices = |expr: &Expr| matches!(expr.ty, Type::Matrix(..));
        let product = op == Op::Mul || (matches!(op, Op::Add | Op::Sub) && left.ty == right.ty);
        let direct = (!matrices(left) && !matrices(right)) || product;
        let bits = matches!(op, Op::And | Op::Or | Op::Xor) && left.ty != right.ty;
        let folds = left.known.is_some();
        if let Some(text) = Self::direct_operator(op)
            && plain
            && direct
            && !bits
            && !folds
        {
            self.line(at, format!("{} {text} {};", path.text, value.text));
            return;
        }
        let before = self.read(path);
        let result = self.binary_values(op, (&left.ty, before), (&right.ty, value));
        self.write_path(at, path, &result);
    }

    /// `a.xy = b`. Components are written one by one, or the rest of the vector stays as it is.
    fn assign_swizzle(
        &mut self,
        op: Option<Op>,
        (base, letters): (&Expr, &[u8]),
        left: &Expr,
        right: &Expr,
        at: At,
    ) {
        let (base, letters) = innermost_swizzle(base, letters);
        let Some(path) = self.path(base) else {
            self.refuse(left.at, "this place is not written in WGSL");
            return;
        };
        let value = self.value(right);
        let size = base.ty.as_vector().map_or(1, |(_, size)| size);
        let value = match op {
            None => value,
            Some(op) => {
                let base = self.read(&path);
                let before = swizzled(&base, size, &letters);
                self.binary_values(op, (&left.ty, before), (&right.ty, value))
            }
        };
        if let [letter] = letters.as_slice() {
            if size == 1 {
                self.write_path(at, &path, &value);
                return;
            }
            let scalar = base.ty.scalar().unwrap_or(Scalar::Float);
            let index = letter.to_string();
            let mut part = indexed(path, &base.ty, &index, Type::Scalar(scalar));
            if let Some(text) = part.text.strip_suffix(&format!("[{letter}]"))
                && *part.mem == Mem::Value
            {
                part.text = format!("{text}.{}", letter_name(*letter));
            }
            self.write_path(at, &part, &value);
            return;
        }
        self.assign_components(&path, base, &letters, &value, at);
    }

    fn assign_components(
        &mut self,
        path: &Path,
        base: &Expr,
        letters: &[u8],
        value: &Value,
        at: At,
    ) {
        let size = base.ty.as_vector().map_or(1, |(_, size)| size);
        let name = self.type_text(&base.ty);
        let in_order = letters.iter().enumerate().all(|(at, letter)| at == usize::from(*letter));
        let old = self.read(path);
        if in_order && letters.len() == usize::from(size) {
            self.write_path(at, path, value);
            return;
        }
        let text = if in_order {
            let rest: Vec<u8> = (letters.len() as u8..size).collect();
            format!("{name}({}, {})", value.text, swizzled(&old, size, &rest).text)
        } else {
            let kept = self.kept(at, value);
            let parts: Vec<String> = (0..size)
                .map(|component| match letters.iter().position(|letter| *letter == component) {
                    Some(from) => format!("{kept}.{}", letter_name(from as u8)),
                    None => swizzled(&old, size, &[component]).text,
                })
                .collect();
            format!("{name}({})", parts.join(", "))
        };
        self.write_path(at, path, &Value::primary(text, false));
    }

    /// `++a` and its siblings; the value before or after it is kept if it is asked for.
    pub(super) fn step(&mut self, adds: bool, new: bool, operand: &Expr, keep: bool) -> Value {
        let at = operand.at;
        let op = if adds { Op::Add } else { Op::Sub };
        let one = crate::check::fold::converted(
            crate::check::int_literal(1, at),
            &Type::Scalar(operand.ty.scalar().unwrap_or(Scalar::Int)),
        );
        let operand = &*self.settled(operand, keep || has_effects(operand, self.shader));
        let old = if keep && !new {
            let value = self.value(operand);
            let name = self.temporary();
            self.line(at, format!("let {name} = {};", value.text));
            Some(name)
        } else {
            None
        };
        let integer = matches!(operand.ty, Type::Scalar(Scalar::Int | Scalar::Uint));
        let path = if integer { self.path(operand) } else { None };
        match path {
            Some(path) if *path.mem == Mem::Value && path.column.is_none() => {
                let text = if adds { "++" } else { "--" };
                self.lines.push(Line::new(format!("{}{text};", path.text), at));
            }
            _ => self.assign(Some(op), operand, &one, at),
        }
        match old {
            Some(name) => Value::primary(name, true),
            None if keep => self.value(operand),
            None => Value::primary("", true),
        }
    }

    /// A place whose indices are evaluated now, if what comes between may change them.
    pub(super) fn settled<'e>(&mut self, place: &'e Expr, needed: bool) -> Cow<'e, Expr> {
        if needed { Cow::Owned(self.with_kept_indices(place)) } else { Cow::Borrowed(place) }
    }

    /// The same place with indices that do not change any more.
    pub(super) fn with_kept_indices(&mut self, place: &Expr) -> Expr {
        let mut settled = place.clone();
        match &mut settled.kind {
            ExprKind::Index(base, index) => {
                **base = self.with_kept_indices(base);
                if index.known.is_none() {
                    let value = self.value(index);
                    index.kind = ExprKind::Kept(self.kept(index.at, &value));
                }
            }
            ExprKind::Member(base, _) | ExprKind::Swizzle(base, _) => {
                **base = self.with_kept_indices(base);
            }
            _ => {}
        }
        settled
    }
}

/// An element of a path.
pub(super) fn indexed(path: Path, base: &Type, index: &str, ty: Type) -> Path {
    if let Some(column) = &path.column {
        // A component of a column of stored rows.
        let text = row_text(&path, column, index);
        return Path { text, ty, mem: Rc::new(Mem::Value), column: None };
    }
    match &*path.mem {
        Mem::Array { element, wrapped, .. } => {
            let suffix = if *wrapped { ".value" } else { "" };
            let text = format!("{}[{index}]{suffix}", path.text);
            Path { text, ty, mem: Rc::clone(element), column: None }
        }
        Mem::Columns => {
            let text = format!("{}[{index}].value", path.text);
            Path { text, ty, mem: Rc::new(Mem::Value), column: None }
        }
        Mem::RowMajor(_) => {
            Path { text: path.text, ty, mem: path.mem, column: Some(index.to_owned()) }
        }
        Mem::Bool | Mem::Atomic | Mem::Value | Mem::Struct(..) => {
            let mem = match (&*path.mem, base) {
                (Mem::Bool, Type::Vector(..)) => Mem::Bool,
                (Mem::Atomic, _) => Mem::Atomic,
                _ => Mem::Value,
            };
            let text = format!("{}[{index}]", path.text);
            Path { text, ty, mem: Rc::new(mem), column: None }
        }
    }
}

/// One component of a column whose matrix is stored by rows.
fn row_text(path: &Path, column: &str, row: &str) -> String {
    let wrapped = matches!(&*path.mem, Mem::RowMajor(inner) if **inner == Mem::Columns);
    let suffix = if wrapped { ".value" } else { "" };
    format!("{}[{row}]{suffix}[{column}]", path.text)
}

fn row_texts(path: &Path, column: &str) -> Vec<String> {
    let size = path.ty.as_vector().map_or(1, |(_, size)| size);
    (0..size).map(|row| row_text(path, column, &row.to_string())).collect()
}

/// The letter of a component.
pub(super) fn letter_name(letter: u8) -> char {
    ['x', 'y', 'z', 'w'][usize::from(letter.min(3))]
}

/// Components of a value.
pub(super) fn swizzled(value: &Value, size: u8, letters: &[u8]) -> Value {
    let names: String = letters.iter().map(|letter| letter_name(*letter)).collect();
    if size == 1 {
        return value.clone();
    }
    let text = format!("{}.{names}", value.at_least(super::value::Strength::Primary));
    Value::primary(text, value.stable)
}

/// A swizzle of a swizzle as one.
fn innermost_swizzle<'e>(base: &'e Expr, letters: &[u8]) -> (&'e Expr, Vec<u8>) {
    match &base.kind {
        ExprKind::Swizzle(inner, outer) => {
            let letters: Vec<u8> = letters.iter().map(|at| outer[usize::from(*at)]).collect();
            innermost_swizzle(inner, &letters)
        }
        _ => (base, letters.to_vec()),
    }
}

/// Whether evaluating an expression changes anything.
pub(super) fn has_effects(expr: &Expr, shader: &Shader) -> bool {
    let mut found = false;
    expr.each_part(&mut |part| found |= changes(part, shader));
    found
}

/// Whether an expression by itself changes anything, whatever its parts do.
fn changes(expr: &Expr, shader: &Shader) -> bool {
    match &expr.kind {
        ExprKind::Assign(..) | ExprKind::Step(..) => true,
        ExprKind::Call(function, _) => {
            let callee = &shader.functions[*function as usize];
            let is_written = |param: &u32| {
                matches!(shader.vars[*param as usize].place, Place::Param(Dir::Out | Dir::InOut))
            };
            callee.effects || callee.params.iter().any(is_written)
        }
        ExprKind::Builtin(name, _) => {
            matches!(*name, "modf" | "frexp" | "uaddCarry" | "usubBorrow")
                || name.starts_with("atomic")
                || expr.ty == Type::Void
        }
        ExprKind::Texture(..) => expr.ty == Type::Void,
        _ => false,
    }
}
