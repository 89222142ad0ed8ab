//! The checker: resolves names, gives every expression its type, and makes conversions explicit.
//!
//! It reports in the words of GLSL, and goes on after an error with the next statement.

mod call;
mod called;
mod construct;
mod decl;
mod expr;
pub(crate) mod fold;
mod function;
mod layout;
mod operator;
mod reserved;
mod stmt;
mod version;

use std::collections::BTreeSet;

use lamplight_diagnostic::source::{SourceId, Span};
use lamplight_diagnostic::{Code, Diagnostic, Diagnostics, codes};
use rustc_hash::{FxHashMap, FxHashSet};

use crate::ast;
use crate::builtin::variables::{CONSTANTS, find_builtin};
use crate::lexer::At;
use crate::parse::Parsed;
use crate::tree::{
    Access, Expr, ExprKind, Interpolation, Item, Layout, Number, Place, Shader, Stage, Var,
};
use crate::types::{INT, OpaqueKind, Type, UINT};
pub use version::Version;

/// An error that was reported.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Failed;

pub(crate) type Res<T> = Result<T, Failed>;

/// What a name means.
#[derive(Debug, Clone)]
enum Symbol {
    Var(u32),
    Struct(u32),
    /// A member of a block without an instance name: the variable and the member.
    Member(u32, u32),
    Functions(Vec<u32>),
}

/// Checks a parsed text of a stage, and gives its typed tree. The spans of diagnostics are in `source`.
///
/// # Errors
/// Every mistake of the text: of its grammar, or of its types.
pub fn check(
    text: &str,
    parsed: &Parsed<'_>,
    stage: Stage,
    source: SourceId,
) -> Result<Shader, Diagnostics> {
    let version = Version::read(text, &parsed.lexed);
    let mut checker = Checker::new(stage, version, source);
    for error in &parsed.errors {
        checker.report(codes::GLSL_ERROR, error.at, &error.message, "");
    }
    for (item, at) in &parsed.items {
        let _: Res<()> = checker.item(item, *at);
    }
    checker.finish();
    if checker.problems.is_empty() { Ok(checker.shader) } else { Err(checker.problems) }
}

pub(crate) struct Checker<'a> {
    source: SourceId,
    version: Version,
    shader: Shader,
    scopes: Vec<FxHashMap<&'a str, Symbol>>,
    /// How deep each structure nests, and how many members it has with those of inner ones.
    shapes: Vec<(u32, u32)>,
    /// Variables of the language that the text names.
    builtins: FxHashMap<&'a str, u32>,
    /// How large arrays without a size must be for the constant indices into them.
    grown: FxHashMap<u32, u32>,
    /// The function that is read, and what it calls.
    function: Option<u32>,
    calls: BTreeSet<u32>,
    effects: bool,
    discards: bool,
    /// Where `early_fragment_tests` is.
    early_tests: Option<At>,
    /// How packing and matrices lie in blocks, as `layout(...) uniform;` sets it.
    packing: [Layout; 2],
    /// The names of blocks, which nothing else has at the same place.
    blocks: FxHashSet<&'a str>,
    /// How many loops and switches are around.
    loops: u32,
    switches: u32,
    problems: Diagnostics,
    /// Names whose declarations have mistakes. What uses them has none of its own.
    unread: FxHashSet<&'a str>,
}

impl<'a> Checker<'a> {
    fn new(stage: Stage, version: Version, source: SourceId) -> Self {
        let shader = Shader {
            stage,
            structs: Vec::new(),
            vars: Vec::new(),
            functions: Vec::new(),
            order: Vec::new(),
            local_size: [1; 3],
            local_size_ids: [None; 3],
            depth_mode: None,
        };
        Self {
            source,
            version,
            shader,
            scopes: vec![FxHashMap::default()],
            shapes: Vec::new(),
            builtins: FxHashMap::default(),
            grown: FxHashMap::default(),
            function: None,
            calls: BTreeSet::new(),
            effects: false,
            discards: false,
            early_tests: None,
            packing: [Layout::default(), Layout::default()],
            blocks: FxHashSet::default(),
            loops: 0,
            switches: 0,
            problems: Vec::new(),
            unread: FxHashSet::default(),
        }
    }

    fn report(&mut self, code: &'static Code, at: At, message: &str, note: &str) {
        let mut problem = Diagnostic::error(code, message).at(self.span(at), "here");
        if !note.is_empty() {
            problem = problem.note(format!("help: {note}"));
        }
        if self.problems.len() < 100 {
            self.problems.push(problem);
        }
    }

    fn span(&self, at: At) -> Span {
        Span::new(self.source, at.range())
    }

    /// A mistake by the rules of GLSL.
    fn fail<T>(&mut self, at: At, message: impl AsRef<str>) -> Res<T> {
        self.report(codes::GLSL_ERROR, at, message.as_ref(), "");
        Err(Failed)
    }

    /// Valid GLSL that has no translation.
    fn refuse<T>(&mut self, at: At, message: impl AsRef<str>) -> Res<T> {
        self.report(codes::GLSL_NOT_TRANSLATED, at, message.as_ref(), "");
        Err(Failed)
    }

    /// A type in the words of the text.
    fn type_name(&self, ty: &Type) -> String {
        let name = |index: u32| self.shader.structs[index as usize].name.clone();
        match ty {
            Type::Struct(index) => name(*index),
            Type::Array(..) => match ty.innermost() {
                Type::Struct(index) => format!("{}[]", name(*index)),
                _ => ty.to_string(),
            },
            _ => ty.to_string(),
        }
    }

    /// Declares a name in the innermost scope.
    fn declare(&mut self, name: ast::Name<'a>, symbol: Symbol) -> Res<()> {
        self.check_name(name)?;
        if name.text.len() > 1000 {
            return self.fail(name.at, "the name is longer than 1000 bytes");
        }
        if self.scopes.len() == 1 && self.blocks.contains(name.text) {
            return self.fail(name.at, format!("there is a block `{}` already", name.text));
        }
        let Some(scope) = self.scopes.last_mut() else { return Ok(()) };
        if scope.contains_key(name.text) {
            return self.fail(name.at, format!("`{}` is declared twice in this scope", name.text));
        }
        scope.insert(name.text, symbol);
        Ok(())
    }

    /// Refuses a name that the language keeps for itself.
    fn check_name(&mut self, name: ast::Name<'a>) -> Res<()> {
        if name.text.starts_with("gl_") {
            return self.fail(name.at, "names that begin with `gl_` are reserved");
        }
        if reserved::is_reserved(name.text, self.version) {
            return self.fail(name.at, format!("`{}` is a reserved word of GLSL", name.text));
        }
        Ok(())
    }

    fn lookup(&self, name: &str) -> Option<&Symbol> {
        self.scopes.iter().rev().find_map(|scope| scope.get(name))
    }

    fn scoped<T>(&mut self, check: impl FnOnce(&mut Self) -> T) -> T {
        self.scopes.push(FxHashMap::default());
        let result = check(self);
        self.scopes.pop();
        result
    }

    fn new_var(&mut self, name: &str, ty: Type, place: Place, at: At) -> u32 {
        let var = Var {
            name: name.to_owned(),
            ty,
            place,
            at,
            init: None,
            known: None,
            layout: Layout::default(),
            interpolation: Interpolation::default(),
            access: Access::default(),
            written: false,
            indexed: false,
            users: Vec::new(),
            open: false,
        };
        self.shader.vars.push(var);
        self.shader.vars.len() as u32 - 1
    }

    fn var(&self, index: u32) -> &Var {
        &self.shader.vars[index as usize]
    }

    fn var_mut(&mut self, index: u32) -> &mut Var {
        &mut self.shader.vars[index as usize]
    }

    /// The expression that a name is.
    fn name_expr(&mut self, name: &'a str, at: At) -> Res<Expr> {
        match self.lookup(name).cloned() {
            Some(Symbol::Var(var)) => Ok(self.var_expr(var, at)),
            Some(Symbol::Member(var, member)) => {
                let base = self.var_expr(var, at);
                let Type::Struct(index) = base.ty else { return Err(Failed) };
                let ty = self.shader.structs[index as usize].members[member as usize].ty.clone();
                Ok(Expr { kind: ExprKind::Member(Box::new(base), member), ty, at, known: None })
            }
            Some(Symbol::Struct(_)) => self.fail(at, format!("`{name}` is a type")),
            Some(Symbol::Functions(_)) => {
                self.fail(at, format!("`{name}` is a function, and is not called here"))
            }
            None => match self.builtin_var(name, at)? {
                Some(expr) => Ok(expr),
                None => self.fail_unknown(name, at),
            },
        }
    }

    fn fail_unknown<T>(&mut self, name: &str, at: At) -> Res<T> {
        if self.unread.contains(name) {
            return Err(Failed);
        }
        let known: Vec<&str> = self.scopes.iter().flat_map(|scope| scope.keys().copied()).collect();
        let mut sorted = known;
        sorted.sort_unstable();
        let problem = Diagnostic::error(codes::GLSL_ERROR, format!("`{name}` is not declared"))
            .at(self.span(at), "here")
            .suggest(name, sorted);
        self.problems.push(problem);
        Err(Failed)
    }

    fn builtin_var(&mut self, name: &'a str, at: At) -> Res<Option<Expr>> {
        if let Some((_, value)) = CONSTANTS.iter().find(|(constant, _)| *constant == name) {
            let number = Number::Int(*value);
            return Ok(Some(literal(number, at)));
        }
        if name == "gl_WorkGroupSize" && self.shader.stage == Stage::Compute {
            return Ok(Some(self.group_size(at)));
        }
        let Some(index) = self.builtin_index(name, at)? else { return Ok(None) };
        Ok(Some(self.var_expr(index, at)))
    }

    fn group_size(&mut self, at: At) -> Expr {
        let parts: Vec<Expr> = (0..3)
            .map(|axis| match self.size_constant(axis) {
                Some(index) => fold::converted(self.var_expr(index, at), &UINT),
                None => literal(Number::Uint(self.shader.local_size[axis]), at),
            })
            .collect();
        let ty = Type::Vector(crate::types::Scalar::Uint, 3);
        let known = fold::constructed(&ty, &parts);
        Expr { kind: ExprKind::Construct(parts), ty, at, known }
    }

    /// The specialisation constant that decides an axis of the workgroup. An id without a
    /// declaration makes one, which begins with the size that is written.
    fn size_constant(&mut self, axis: usize) -> Option<u32> {
        let id = self.shader.local_size_ids[axis]?;
        if let Some(index) = self.constant_with(id) {
            return Some(index);
        }
        let name = ["local_size_x", "local_size_y", "local_size_z"][axis];
        let init = literal(Number::Uint(self.shader.local_size[axis]), At::default());
        let index = self.new_var(name, UINT, Place::Override, At::default());
        let var = self.var_mut(index);
        var.init = Some(init);
        var.layout.constant_id = Some(id);
        self.shader.order.push(Item::Var(index));
        Some(index)
    }

    /// The specialisation constant with an id.
    fn constant_with(&self, id: u32) -> Option<u32> {
        let has_it = |var: &Var| var.layout.constant_id == Some(id);
        self.shader.vars.iter().position(has_it).map(|index| index as u32)
    }

    /// The variable of the language with that name.
    fn builtin_index(&mut self, name: &'a str, at: At) -> Res<Option<u32>> {
        if let Some(index) = self.builtins.get(name) {
            return Ok(Some(*index));
        }
        let Some(builtin) = find_builtin(name, self.shader.stage) else { return Ok(None) };
        let Some(ty) = crate::types::named_type(builtin.ty) else { return Ok(None) };
        let ty = match builtin.array {
            Some(0) => ty.array(None),
            Some(size) => ty.array(Some(size)),
            None if name == "gl_SampleMaskIn" => ty.array(Some(1)),
            None => ty,
        };
        let index = self.new_var(name, ty, Place::Builtin(builtin), at);
        self.builtins.insert(name, index);
        Ok(Some(index))
    }

    fn var_expr(&mut self, index: u32, at: At) -> Expr {
        if let Some(function) = self.function {
            let users = &mut self.var_mut(index).users;
            if users.last() != Some(&function) {
                users.push(function);
            }
        }
        let var = self.var(index);
        let known = var.known.clone();
        Expr { kind: ExprKind::Var(index), ty: var.ty.clone(), at, known }
    }

    /// Facts that need the whole text.
    fn finish(&mut self) {
        let mut changed = true;
        while changed {
            changed = false;
            for index in 0..self.shader.functions.len() {
                let function = &self.shader.functions[index];
                let reached =
                    function.calls.iter().any(|call| self.shader.functions[*call as usize].effects);
                if reached && !function.effects {
                    self.shader.functions[index].effects = true;
                    changed = true;
                }
            }
        }
        self.shader.vars.iter_mut().for_each(|var| {
            var.users.sort_unstable();
            var.users.dedup();
        });
        for axis in 0..3 {
            self.size_constant(axis);
        }
        self.size_arrays();
        self.refuse_recursion();
        self.refuse_early_tests();
        self.refuse_same_locations();
        let unfinished: Vec<(At, String)> = self
            .shader
            .functions
            .iter()
            .filter(|callee| callee.body.is_none())
            .filter(|callee| self.is_called(callee.name.as_str()))
            .map(|callee| (callee.at, format!("`{}` has no definition", callee.name)))
            .collect();
        for (at, message) in unfinished {
            let _: Res<()> = self.fail(at, message);
        }
        let is_main = |function: &&crate::tree::Function| function.name == "main";
        if self.problems.is_empty() && !self.shader.functions.iter().any(|f| is_main(&f)) {
            let end = At::default();
            self.report(codes::NO_ENTRY_POINT, end, "the file has no function `main`", "");
        }
    }

    /// Arrays without a size get that of the largest index into them.
    fn size_arrays(&mut self) {
        for (index, var) in self.shader.vars.iter_mut().enumerate() {
            if let Type::Array(element, None) = &var.ty
                && let Some(size) = self.grown.get(&(index as u32))
            {
                var.ty = Type::Array(std::rc::Rc::clone(element), Some(*size));
            }
        }
    }

    /// Two inputs, or two outputs, at one location: the components of one may be apart.
    fn refuse_same_locations(&mut self) {
        let mut taken: Vec<(bool, u32)> = Vec::new();
        let mut found = Vec::new();
        for var in &self.shader.vars {
            let is_input = match var.place {
                Place::Input => true,
                Place::Output => false,
                _ => continue,
            };
            let layout = &var.layout;
            let (Some(location), None, None) = (layout.location, layout.component, layout.index)
            else {
                continue;
            };
            if taken.contains(&(is_input, location)) {
                let free = (0..).find(|free| !taken.contains(&(is_input, *free)));
                found.push((var.at, var.name.clone(), location, free.unwrap_or_default()));
            }
            taken.push((is_input, location));
        }
        for (at, name, location, free) in found {
            let message = format!("`{name}` has the location {location}, which is taken");
            let note = format!("write `layout(location = {free})` before `{name}`");
            self.report(codes::BINDING_CONFLICT, at, &message, &note);
        }
    }

    fn is_called(&self, name: &str) -> bool {
        let functions = &self.shader.functions;
        functions.iter().any(|caller| {
            caller.calls.iter().any(|call| functions[*call as usize].name == name)
                && caller.body.is_some()
        }) && functions.iter().filter(|f| f.name == name).all(|f| f.body.is_none())
    }

    /// Functions must not call themselves, not even through others.
    fn refuse_recursion(&mut self) {
        let functions = &self.shader.functions;
        // Functions that are entered, with how many of their calls were followed.
        let mut entered: Vec<(usize, usize)> = Vec::new();
        let mut states = vec![Visit::Unseen; functions.len()];
        for root in 0..functions.len() {
            if states[root] == Visit::Unseen {
                states[root] = Visit::Entered;
                entered.push((root, 0));
            }
            while let Some((index, followed)) = entered.last_mut() {
                let index = *index;
                let Some(callee) = functions[index].calls.get(*followed) else {
                    states[index] = Visit::Left;
                    entered.pop();
                    continue;
                };
                *followed += 1;
                let callee = *callee as usize;
                if states[callee] == Visit::Entered {
                    let (at, name) = (functions[callee].at, functions[callee].name.clone());
                    let _: Res<()> = self.fail(at, format!("`{name}` calls itself"));
                    return;
                }
                if states[callee] == Visit::Unseen {
                    states[callee] = Visit::Entered;
                    entered.push((callee, 0));
                }
            }
        }
    }

    /// WebGPU tests the depth early only where nothing can tell the difference.
    fn refuse_early_tests(&mut self) {
        let Some(at) = self.early_tests else { return };
        let tells = |var: &Var| {
            let memory = match var.ty.innermost() {
                Type::Opaque(opaque) => opaque.kind == OpaqueKind::Image,
                _ => var.place == Place::StorageBlock || var.name == "gl_FragDepth",
            };
            memory && var.written
        };
        let discards = self.shader.functions.iter().any(|function| function.discards);
        if discards || self.shader.vars.iter().any(tells) {
            let message = "`early_fragment_tests` has no counterpart in WGSL beside `discard`, \
                           depths and writes to memory";
            let _: Res<()> = self.refuse(at, message);
        }
    }
}

/// How far the search for calls is with a function.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Visit {
    Unseen,
    Entered,
    Left,
}

/// A number that stands in the text.
pub(crate) fn literal(number: Number, at: At) -> Expr {
    Expr {
        kind: ExprKind::Literal(number, None),
        ty: Type::Scalar(number.scalar()),
        at,
        known: Some([number].into()),
    }
}

/// An `int` that stands in the text.
pub(crate) fn int_literal(value: i32, at: At) -> Expr {
    let expr = literal(Number::Int(value), at);
    debug_assert!(expr.ty == INT);
    expr
}
