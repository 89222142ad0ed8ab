//! Lowers statements. Blocks become jumps.

use super::{Loc, LoweredBody};
use crate::code::{Instruction, JumpTable};
use crate::error::Error;
use crate::program::{Branch, CoveragePoint, FunctionId};
use naga::{Block, Expression, Function, Handle, Span, Statement, SwitchCase, SwitchValue};

/// Deepest nesting of blocks.
const MAX_DEPTH: u32 = 200;

impl LoweredBody<'_, '_> {
    /// Lowers the body of a function.
    pub(super) fn whole(&mut self, function: &Function) -> Result<(), Error> {
        for (_, variable) in function.local_variables.iter() {
            let size = self.build.layout.size(variable.ty)?;
            self.locals.push(self.build.alloc(size)?);
        }
        for (handle, variable) in function.local_variables.iter() {
            let to = self.locals[handle.index()];
            let n = self.build.layout.size(variable.ty)?;
            self.span = function.local_variables.get_span(handle);
            match variable.init {
                Some(init) => {
                    // This constant expression is one that no statement emits.
                    self.constant = true;
                    let from = self.operand(init)?;
                    self.constant = false;
                    self.emit(Instruction::spread(to, from, n));
                }
                None => self.emit(Instruction::Zero { to, n }),
            }
        }
        self.block(&function.body, Some(Branch::Entry))?;
        self.emit(Instruction::Return);
        Ok(())
    }

    fn block(&mut self, block: &Block, branch: Option<Branch>) -> Result<(), Error> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            return Err(Error::too_large(format!("statements nest deeper than {MAX_DEPTH}")));
        }
        let whole = self.span;
        if let Some(branch) = branch {
            self.mark(branch);
            if block.is_empty() {
                // An empty block has no statements, so it gets the span of the statement that it is
                // a part of.
                self.cover(whole);
            }
        }
        for (statement, span) in block.span_iter() {
            if self.point.is_none() {
                self.mark(Branch::After);
            }
            self.span = *span;
            self.cover(*span);
            self.statement(statement).map_err(|error| error.or_at(*span))?;
        }
        self.depth -= 1;
        Ok(())
    }

    /// Begins a block that coverage counts.
    fn mark(&mut self, branch: Branch) {
        let points = &mut self.build.program.points;
        let point = points.len() as u32;
        points.push(CoveragePoint {
            function: FunctionId(self.function),
            branch,
            span: Span::UNDEFINED,
        });
        self.point = Some(point);
        self.emit(Instruction::Mark { point });
    }

    fn cover(&mut self, span: Span) {
        if let Some(point) =
            self.point.and_then(|point| self.build.program.points.get_mut(point as usize))
        {
            point.span.subsume(span);
        }
    }

    fn statement(&mut self, statement: &Statement) -> Result<(), Error> {
        match *statement {
            Statement::Emit(ref range) => self.evaluate_all(range.clone()),
            Statement::Block(ref block) => self.block(block, None),
            Statement::If { condition, ref accept, ref reject } => {
                self.branch(condition, accept, reject)
            }
            Statement::Switch { selector, ref cases } => self.switch(selector, cases),
            Statement::Loop { ref body, ref continuing, break_if } => {
                self.repeat(body, continuing, break_if)
            }
            Statement::Break => self.leave(true),
            Statement::Continue => self.leave(false),
            Statement::Return { value } => self.give_back(value),
            Statement::Kill => self.kill(),
            Statement::Store { pointer, value } => self.store(pointer, value),
            Statement::Call { function, ref arguments, result } => {
                self.call(function, arguments, result)
            }
            Statement::ControlBarrier(_) => self.barrier(),
            // Invocations run one after another, so each sees what the others have written.
            Statement::MemoryBarrier(_) => Ok(()),
            Statement::WorkGroupUniformLoad { pointer, result } => {
                self.uniform_load(pointer, result)
            }
            Statement::Atomic { pointer, ref fun, value, result } => {
                self.atomic(pointer, fun, value, result)
            }
            ref other => {
                let text = format!("{other:?}");
                Err(Error::unsupported(format!(
                    "the statement `{}`",
                    text.split([' ', '(', '{']).next().unwrap_or("?")
                )))
            }
        }
    }

    fn evaluate_all(&mut self, range: naga::Range<Expression>) -> Result<(), Error> {
        let statement = self.span;
        for handle in range {
            // Loads that nobody wrote have no place of their own.
            let own = self.expressions.get_span(handle);
            self.span = if own.is_defined() { own } else { statement };
            self.evaluate(handle)?;
        }
        self.span = statement;
        Ok(())
    }

    fn branch(
        &mut self,
        condition: Handle<Expression>,
        accept: &Block,
        reject: &Block,
    ) -> Result<(), Error> {
        let condition = self.operand(condition)?.slot;
        let skip = self.jump(Instruction::JumpUnless { condition, to: 0 });
        self.block(accept, Some(Branch::Accept))?;
        let end = self.jump(Instruction::Jump { to: 0 });
        self.land(skip);
        self.block(reject, Some(Branch::Reject))?;
        self.land(end);
        self.point = None;
        Ok(())
    }

    fn switch(&mut self, selector: Handle<Expression>, cases: &[SwitchCase]) -> Result<(), Error> {
        let selector = self.operand(selector)?.slot;
        let table = self.build.program.tables.len();
        self.build.program.tables.push(JumpTable::default());
        self.emit(Instruction::Switch { selector, table: table as u32 });
        self.breaks.push(Vec::new());
        let mut entries = JumpTable { default: u32::MAX, ..JumpTable::default() };
        for case in cases {
            let here = self.here() as u32;
            match case.value {
                SwitchValue::I32(value) => entries.cases.push((value as u32, here)),
                SwitchValue::U32(value) => entries.cases.push((value, here)),
                SwitchValue::Default => entries.default = here,
            }
            self.block(&case.body, Some(Branch::Case))?;
            if !case.fall_through {
                self.leave(true)?;
            }
        }
        entries.default = entries.default.min(self.here() as u32);
        self.build.program.tables[table] = entries;
        self.land_all(true);
        self.point = None;
        Ok(())
    }

    fn repeat(
        &mut self,
        body: &Block,
        continuing: &Block,
        break_if: Option<Handle<Expression>>,
    ) -> Result<(), Error> {
        let start = self.here() as u32;
        self.breaks.push(Vec::new());
        self.continues.push(Vec::new());
        self.emit(Instruction::Trip);
        self.block(body, Some(Branch::Body))?;
        self.land_all(false);
        self.block(continuing, Some(Branch::Continuing))?;
        if let Some(condition) = break_if {
            let condition = self.operand(condition)?.slot;
            self.emit(Instruction::JumpUnless { condition, to: start });
        } else {
            self.emit(Instruction::Jump { to: start });
        }
        self.land_all(true);
        self.point = None;
        Ok(())
    }

    /// Emits the jump of a `break` (`out`) or a `continue`. Its target is set by
    /// [`Self::land_all`].
    fn leave(&mut self, out: bool) -> Result<(), Error> {
        let jump = self.jump(Instruction::Jump { to: 0 });
        let targets = if out { &mut self.breaks } else { &mut self.continues };
        let target =
            targets.last_mut().ok_or_else(|| Error::unsupported("`break` outside of a loop"))?;
        target.push(jump);
        Ok(())
    }

    fn give_back(&mut self, value: Option<Handle<Expression>>) -> Result<(), Error> {
        if let Some(value) = value {
            let to = self.build.program.functions[self.function as usize].result_slot;
            let (from, n) = (self.operand(value)?, self.slots(value)?);
            self.emit(Instruction::spread(to, from, n));
        }
        self.emit(Instruction::Return);
        Ok(())
    }

    /// Implements `discard`: the lane continues as a helper invocation of its quad. If its function
    /// ends without a further `return`, the result is zero.
    fn kill(&mut self) -> Result<(), Error> {
        let function = &self.build.program.functions[self.function as usize];
        let (to, n) = (function.result_slot, function.returned);
        self.emit(Instruction::Zero { to, n });
        self.emit(Instruction::Kill);
        Ok(())
    }

    fn call(
        &mut self,
        function: Handle<Function>,
        arguments: &[Handle<Expression>],
        result: Option<Handle<Expression>>,
    ) -> Result<(), Error> {
        let callee = &self.build.program.functions[function.index()];
        let (result_slot, entry, n) = (callee.result_slot, callee.entry, callee.returned);
        let slots: Vec<u32> = callee.parameters.iter().map(|parameter| parameter.slot).collect();
        if let Some(error) = &callee.error {
            return Err(error.clone());
        }
        for (argument, to) in arguments.iter().zip(slots) {
            let (from, n) = (self.operand(*argument)?, self.slots(*argument)?);
            self.emit(Instruction::spread(to, from, n));
        }
        self.emit(Instruction::Call { to: entry });
        if let Some(result) = result {
            let (to, _) = self.fresh(result)?;
            self.emit(Instruction::Copy { to, from: result_slot, n });
            self.locs[result.index()] = Some(Loc::dense(to, false));
        }
        Ok(())
    }

    fn here(&self) -> usize {
        self.build.program.code.len()
    }

    fn jump(&mut self, instruction: Instruction) -> usize {
        self.emit(instruction);
        self.here() - 1
    }

    /// Makes a jump end here.
    fn land(&mut self, jump: usize) {
        let here = self.here() as u32;
        match &mut self.build.program.code[jump] {
            Instruction::Jump { to } | Instruction::JumpUnless { to, .. } => *to = here,
            _ => {}
        }
    }

    fn land_all(&mut self, out: bool) {
        let targets = if out { self.breaks.pop() } else { self.continues.pop() };
        targets.unwrap_or_default().into_iter().for_each(|jump| self.land(jump));
    }
}
