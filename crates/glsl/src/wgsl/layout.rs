//! Reads and writes of values whose form in memory is another one.

use std::rc::Rc;

use super::Writer;
use super::memory::Mem;
use super::output::Lines;
use super::value::Value;
use crate::lexer::At;
use crate::types::{Scalar, Type};

impl Writer<'_> {
    /// The value of a path in memory.
    pub(super) fn load(&mut self, text: &str, ty: &Type, mem: &Mem) -> Value {
        match mem {
            Mem::Value => Value::primary(text, false),
            Mem::Atomic => Value::primary(format!("atomicLoad(&{text})"), false),
            Mem::Bool => {
                let zero = match ty.as_vector() {
                    Some((_, size @ 2..)) => format!("vec{size}u(0u)"),
                    _ => "0u".to_owned(),
                };
                Value {
                    text: format!("{text} != {zero}"),
                    strength: super::value::Strength::Relation,
                    stable: false,
                }
            }
            Mem::Columns => {
                let Type::Matrix(_, columns, _) = ty else { return Value::primary(text, false) };
                let parts: Vec<String> =
                    (0..*columns).map(|column| format!("{text}[{column}].value")).collect();
                let name = self.type_text(ty);
                Value::primary(format!("{name}({})", parts.join(", ")), false)
            }
            Mem::RowMajor(inner) => {
                let value = self.load(text, &transposed(ty), inner);
                Value::primary(format!("transpose({})", value.text), false)
            }
            Mem::Array { element, wrapped, name } => {
                let helper = self.array_loader(ty, element, *wrapped, name);
                Value::primary(format!("{helper}({text})"), false)
            }
            Mem::Struct(name, fields) => {
                let helper = self.struct_loader(ty, name, fields);
                Value::primary(format!("{helper}({text})"), false)
            }
        }
    }

    /// A function that gives an array in memory as a value.
    fn array_loader(&mut self, ty: &Type, element: &Rc<Mem>, wrapped: bool, name: &str) -> String {
        let Type::Array(inner, Some(size)) = ty else { return String::new() };
        let path = if wrapped { "stored[i].value" } else { "stored[i]" };
        let loaded = self.load(path, inner, element).text;
        let result = self.type_text(ty);
        self.helper_for("load_array", &format!("{result} {name}"), |helper| {
            format!(
                "fn {helper}(given: {name}) -> {result} {{\n    var stored = given;\n    \
                 var loaded: {result};\n    for (var i = 0u; i < {size}u; i++) {{\n        \
                 loaded[i] = {loaded};\n    }}\n    return loaded;\n}}"
            )
        })
    }

    fn struct_loader(&mut self, ty: &Type, name: &str, fields: &[Rc<Mem>]) -> String {
        let Type::Struct(index) = ty else { return String::new() };
        let shader = self.shader;
        let members = &shader.structs[*index as usize].members;
        let mut parts = Vec::with_capacity(fields.len());
        for (at, mem) in fields.iter().enumerate() {
            let path = format!("stored.{}", self.member_name(*index, at as u32));
            parts.push(self.load(&path, &members[at].ty, mem).text);
        }
        let result = self.type_text(ty);
        self.helper_for("load", &format!("{result} {name}"), |helper| {
            format!(
                "fn {helper}(stored: {name}) -> {result} {{\n    return {result}({});\n}}",
                parts.join(", ")
            )
        })
    }

    /// Writes a value to a path in memory.
    pub(super) fn store(&mut self, at: At, path: &str, ty: &Type, mem: &Mem, value: &Value) {
        match mem {
            Mem::Value => self.line(at, format!("{path} = {};", value.text)),
            Mem::Atomic => self.line(at, format!("atomicStore(&{path}, {});", value.text)),
            Mem::Bool => {
                let stored = self.type_text(&ty.with_scalar(Scalar::Uint));
                self.line(at, format!("{path} = {stored}({});", value.text));
            }
            Mem::Columns => {
                let name = self.kept(at, value);
                let Type::Matrix(_, columns, _) = ty else { return };
                for column in 0..*columns {
                    self.line(at, format!("{path}[{column}].value = {name}[{column}];"));
                }
            }
            Mem::RowMajor(inner) => {
                let turned = Value::primary(format!("transpose({})", value.text), value.stable);
                self.store(at, path, &transposed(ty), inner, &turned);
            }
            Mem::Array { element, wrapped, .. } => {
                self.store_array(at, path, ty, (element, *wrapped), value);
            }
            Mem::Struct(_, fields) => {
                let Type::Struct(index) = ty else { return };
                let name = self.kept(at, value);
                let shader = self.shader;
                let members = &shader.structs[*index as usize].members;
                for (number, mem) in fields.iter().enumerate() {
                    let member = self.member_name(*index, number as u32);
                    let part = Value::primary(format!("{name}.{member}"), true);
                    self.store(at, &format!("{path}.{member}"), &members[number].ty, mem, &part);
                }
            }
        }
    }

    fn store_array(
        &mut self,
        at: At,
        path: &str,
        ty: &Type,
        (element, wrapped): (&Rc<Mem>, bool),
        value: &Value,
    ) {
        let Type::Array(inner, Some(size)) = ty else { return };
        let name = self.temporary();
        let index = self.temporary();
        self.line(at, format!("var {name} = {};", value.text));
        let suffix = if wrapped { ".value" } else { "" };
        let target = format!("{path}[{index}]{suffix}");
        let part = Value::primary(format!("{name}[{index}]"), true);
        let ((), body): ((), Lines) =
            self.capture(|writer| writer.store(at, &target, inner, element, &part));
        self.line(at, format!("for (var {index} = 0u; {index} < {size}u; {index}++) {{"));
        self.lines.nest(body);
        self.line(at, "}");
    }

    /// The name of a value that is used more than once.
    pub(super) fn kept(&mut self, at: At, value: &Value) -> String {
        if value.stable && value.is_simple() {
            return value.text.clone();
        }
        let name = self.temporary();
        self.line(at, format!("let {name} = {};", value.text));
        name
    }
}

/// The type of a matrix with rows and columns exchanged.
pub(super) fn transposed(ty: &Type) -> Type {
    match ty {
        Type::Matrix(scalar, columns, rows) => Type::Matrix(*scalar, *rows, *columns),
        other => other.clone(),
    }
}
