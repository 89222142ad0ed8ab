//! Writes branches, loops, switches and what ends them early.

use super::body::Body;
use super::scope::Named;
use super::types::{BOOL, FLOAT, INT, Scalar, Ty, UINT};

/// What may stand before a statement. It changes nothing.
const DIAGNOSTIC: &str = "@diagnostic(off, derivative_uniformity) ";

impl Body<'_> {
    fn attribute(&mut self) -> &'static str {
        if self.random.chance(6) { DIAGNOSTIC } else { "" }
    }

    pub fn branch(&mut self, nesting: usize) {
        let (condition, attribute) = (self.condition(2), self.attribute());
        self.block(&format!("{attribute}if {condition} {{"), nesting);
        if self.random.chance(30) {
            let condition = self.condition(1);
            self.line(format!("else if {condition}"));
            self.block("{", nesting);
        }
        if self.random.chance(50) {
            self.block("else {", nesting);
        }
    }

    /// A block. What it declares is out of scope behind it.
    fn block(&mut self, head: &str, nesting: usize) {
        self.line(head);
        let known = self.named.len();
        self.statements(3, nesting - 1);
        self.named.truncate(known);
        self.line("}");
    }

    pub fn counted(&mut self, nesting: usize) {
        let (name, count) = (self.name(), 1 + self.random.below(4));
        let known = self.named.len();
        self.named.push(Named::new(name.clone(), INT, false));
        let step = *self.random.pick(&["++", " += 1", " = 1 + NAME"]);
        let step = format!("{name}{}", step.replace("NAME", &name));
        let condition = match self.random.below(4) {
            0 => format!("{name} < {count} && {}", self.condition(1)),
            1 => format!("!({name} >= {count})"),
            _ => format!("{name} < {count}"),
        };
        self.loops += 1;
        // `continue` in a loop without a condition leaves by the first statement.
        match self.random.chance(15) {
            true => {
                self.line(format!("for (var {name} = 0; ; {step}) {{"));
                self.line(format!("if !({condition}) {{ break; }}"));
                self.block("{", nesting);
                self.line("}");
            }
            false => {
                let attribute = self.attribute();
                self.block(
                    &format!("{attribute}for (var {name} = 0; {condition}; {step}) {{"),
                    nesting,
                );
            }
        }
        self.loops -= 1;
        self.named.truncate(known);
    }

    pub fn while_loop(&mut self, nesting: usize) {
        let name = self.name();
        let count = 1 + self.random.below(4);
        self.line(format!("var {name} = 0u;"));
        self.line(format!("while bump(&{name}) < {count}u {{"));
        let known = self.named.len();
        self.named.push(Named::new(name, UINT, false));
        self.loops += 1;
        self.statements(3, nesting - 1);
        self.loops -= 1;
        self.named.truncate(known);
        self.line("}");
    }

    /// A loop with `continuing`, which uses values of the body.
    pub fn endless(&mut self, nesting: usize) {
        let counter = self.name();
        let first = self.random.below(3);
        self.line(format!("var {counter} = {first}u;"));
        let attribute = self.attribute();
        self.line(format!("{attribute}loop {{"));
        let known = self.named.len();
        self.named.push(Named::new(counter.clone(), UINT, false));
        let end = 3 + self.random.below(3);
        if self.random.chance(40) {
            self.line(format!("if {counter} >= {end}u {{ break; }}"));
        }
        let kept = self.name();
        let ty = self.random.pick(&[INT, UINT, FLOAT, BOOL, Ty::Vector(2, Scalar::Int)]).clone();
        let value = self.value(&ty, 2);
        self.line(format!("let {kept}: {} = {value};", ty.spelt(self.structs)));
        self.named.push(Named::new(kept, ty, false));
        self.loops += 1;
        self.statements(3, nesting - 1);
        self.loops -= 1;
        self.line("continuing {");
        self.named.truncate(known + 2);
        let result = self.result.take();
        let loops = std::mem::replace(&mut self.loops, 0);
        (0..1 + self.random.below(2)).for_each(|_| match self.random.below(5) {
            0 => self.variable(),
            1 => self.assignment(),
            2 if nesting > 1 => self.branch(1),
            3 if nesting > 1 => self.counted(1),
            _ => self.compound(),
        });
        (self.result, self.loops) = (result, loops);
        // Declarations of `continuing` are in scope of its condition.
        self.line(format!("{counter} += 1u;"));
        let more = match self.random.chance(60) {
            true => format!(" || {}", self.condition(1)),
            false => String::new(),
        };
        self.line(format!("break if {counter} > {end}u{more};"));
        self.line("}");
        self.line("}");
        self.named.truncate(known);
    }

    /// The head of a switch. It may have an effect.
    fn switched(&mut self, ty: &Ty) -> String {
        let value = self.value(ty, 2);
        let spelt = ty.spelt(self.structs);
        let changed = if *ty == INT { None } else { self.whole_variable(&UINT, &[]) };
        match changed {
            Some(Named { path, .. }) if !path.starts_with('(') && self.random.chance(30) => {
                format!("switch bump(&{path}) % 4u {{")
            }
            _ if self.random.chance(50) => format!("switch {spelt}({value}) & {spelt}(3) {{"),
            _ => format!("switch {spelt}({value}) {{"),
        }
    }

    pub fn switch(&mut self, nesting: usize) {
        let is_signed = self.random.chance(50);
        let (ty, suffix) = if is_signed { (INT, "") } else { (UINT, "u") };
        let head = self.switched(&ty);
        let attribute = self.attribute();
        self.line(format!("{attribute}{head}"));
        if self.random.chance(8) {
            self.case("default: {", nesting);
            return self.line("}");
        }
        let mut values: Vec<String> = (0..4).map(|number| format!("{number}{suffix}")).collect();
        let extreme = if is_signed { "-2147483648" } else { "4294967295u" };
        values.push(extreme.to_owned());
        if is_signed {
            values.push("-1".to_owned());
        }
        self.random.shuffle(&mut values);
        let default = self.random.below(4);
        for index in 0..4 {
            let count = self.random.below(3).min(values.len());
            let mut own: Vec<String> = values.drain(..count).collect();
            let head = if index == default {
                match own.is_empty() || self.random.chance(40) {
                    true => {
                        values.extend(own);
                        "default: {".to_owned()
                    }
                    false => {
                        let at = self.random.below(own.len() + 1);
                        own.insert(at, "default".to_owned());
                        format!("case {}: {{", own.join(", "))
                    }
                }
            } else if own.is_empty() {
                continue;
            } else {
                format!("case {}: {{", own.join(", "))
            };
            self.case(&head, nesting);
        }
        self.line("}");
    }

    fn case(&mut self, head: &str, nesting: usize) {
        self.line(head);
        let known = self.named.len();
        if self.random.chance(85) {
            self.statements(2, nesting - 1);
            if self.random.chance(30) {
                let condition = self.condition(1);
                self.line(format!("if {condition} {{ break; }}"));
                self.statements(1, 0);
            }
        }
        self.named.truncate(known);
        self.line("}");
    }

    /// A call whose result is not used, or only decides.
    pub fn effect(&mut self) {
        let ty = self.random.pick(&[INT, UINT, FLOAT, BOOL]).clone();
        match self.call(&ty, 1) {
            Some(call) => self.line(format!("_ = {call};")),
            None => match self.whole_variable(&UINT, &[]) {
                Some(Named { path: variable, .. }) if !variable.starts_with("(*") => {
                    let condition = self.condition(1);
                    let op = *self.random.pick(&["&&", "||"]);
                    let effect = format!("bump(&{variable}) > 2u");
                    self.block(&format!("if {condition} {op} {effect} {{"), 1);
                }
                _ => self.variable(),
            },
        }
    }

    /// `break`, `continue` or `return` under a condition.
    pub fn early(&mut self, nesting: usize) {
        let condition = self.condition(1);
        let result = self.result.clone();
        match (result, self.loops > 0) {
            (_, true) if self.random.chance(60) => {
                let word = *self.random.pick(&["continue", "break"]);
                self.line(format!("if {condition} {{ {word}; }}"));
            }
            (Some(ty), _) if nesting > 0 => {
                let value = self.value(&ty, 1);
                self.line(format!("if {condition} {{ return {value}; }}"));
            }
            _ => self.assignment(),
        }
    }
}
