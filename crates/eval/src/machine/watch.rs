//! What a run reports: coverage, and trouble with numbers.

use super::super::code::{Binary, Convert, Geometry, Instruction, Operand, Unary, Word2};
use super::super::error::{Finding, FindingKind};
use super::super::number::Number;
use super::super::program::Program;
use std::collections::BTreeMap;

/// The most places that are remembered. A run with more has enough to look at.
const MAX_FINDINGS: usize = 10_000;

/// Coverage and findings of one machine.
#[derive(Debug, Clone, Default)]
pub struct Watch {
    pub sanitize: bool,
    pub hits: Vec<u64>,
    findings: BTreeMap<(FindingKind, u32), u64>,
    /// The kinds of findings that were new, for an observer. They are as many as the findings.
    fresh: Vec<FindingKind>,
}

impl Watch {
    pub fn new(program: &Program) -> Self {
        let hits = vec![0; program.points.len()];
        Self { sanitize: false, hits, findings: BTreeMap::new(), fresh: Vec::new() }
    }

    pub fn forget(&mut self) {
        self.hits.fill(0);
        self.findings.clear();
        self.fresh.clear();
    }

    /// Moves the kinds of findings that are new since the last call.
    pub fn take_fresh(&mut self, to: &mut Vec<FindingKind>) {
        to.clear();
        to.append(&mut self.fresh);
    }

    /// Counts a finding at an instruction.
    #[cold]
    pub fn note(&mut self, kind: FindingKind, pc: u32) {
        if let Some(count) = self.findings.get_mut(&(kind, pc)) {
            *count += 1;
        } else if self.findings.len() < MAX_FINDINGS {
            self.findings.insert((kind, pc), 1);
            self.fresh.push(kind);
        }
    }

    /// Findings by kind and place. Those of several instructions at the same place are added up.
    pub fn findings(&self, program: &Program) -> Vec<Finding> {
        let mut found: Vec<Finding> = Vec::new();
        for (&(kind, pc), &count) in &self.findings {
            let span = program.spans.get(pc as usize).copied().unwrap_or_default();
            match found.iter_mut().find(|finding| finding.kind == kind && finding.span == span) {
                Some(finding) => finding.count += count,
                None => found.push(Finding { kind, span, count }),
            }
        }
        found
    }

    /// Looks for trouble in the operands and the result of an instruction that has just run.
    #[cold]
    pub fn inspect<N: Number>(&mut self, instruction: &Instruction, memory: &[N], pc: u32) {
        let read = |slot: u32| memory[slot as usize].value();
        match *instruction {
            Instruction::Float1 { op, n, to, a } => {
                let outside = (0..n).any(|i| outside1(op, memory[a.at(u32::from(i))].value()));
                let trouble = outside.then_some(FindingKind::Domain);
                self.note_result(trouble, memory, &[(a, n)], (to, n), pc);
            }
            Instruction::Float2 { op, n, to, a, b } => {
                let trouble = (0..u32::from(n))
                    .find_map(|i| outside2(op, memory[a.at(i)].value(), memory[b.at(i)].value()));
                self.note_result(trouble, memory, &[(a, n), (b, n)], (to, n), pc);
            }
            Instruction::Float3 { n, to, a, b, c, .. } => {
                self.note_result(None, memory, &[(a, n), (b, n), (c, n)], (to, n), pc)
            }
            Instruction::Convert { op, n, a, .. } => {
                let wild = (0..u32::from(n)).any(|i| does_not_fit(op, memory[a.at(i)].value()));
                self.note_if(wild, FindingKind::Conversion, pc);
            }
            Instruction::Word2 {
                op: Word2::DivideS | Word2::DivideU | Word2::RemainderS | Word2::RemainderU,
                n,
                b,
                ..
            } => {
                let zero = (0..u32::from(n)).any(|i| memory[b.at(i)].word() == 0);
                self.note_if(zero, FindingKind::DivisionByZero, pc);
            }
            Instruction::Geometry { op: Geometry::Normalize, n, a, .. } => {
                let zero = (a..a + u32::from(n)).all(|slot| read(slot) == 0.0);
                self.note_if(zero, FindingKind::Domain, pc);
            }
            Instruction::Geometry { op: Geometry::Length, n, to, a, .. } => {
                self.note_result(None, memory, &[(Operand { slot: a, stride: 1 }, n)], (to, 1), pc);
            }
            Instruction::Geometry { op: Geometry::Dot, n, to, a, b, .. } => {
                let operands = [a, b].map(|slot| (Operand { slot, stride: 1 }, n));
                self.note_result(None, memory, &operands, (to, 1), pc);
            }
            Instruction::Index { index, count, .. } => {
                let outside = memory[index as usize].word() >= memory[count as usize].word();
                self.note_if(outside, FindingKind::OutOfBounds, pc);
            }
            Instruction::Pick { index, count, .. } => {
                self.note_if(memory[index as usize].word() >= count, FindingKind::OutOfBounds, pc)
            }
            _ => {}
        }
    }

    fn note_if(&mut self, when: bool, kind: FindingKind, pc: u32) {
        if when {
            self.note(kind, pc);
        }
    }

    /// Reports `trouble` if there is any. Otherwise reports a result that is not finite, if all
    /// operands are finite.
    fn note_result<N: Number>(
        &mut self,
        trouble: Option<FindingKind>,
        memory: &[N],
        operands: &[(Operand, u8)],
        to: (u32, u8),
        pc: u32,
    ) {
        let finite = |(operand, n): &(Operand, u8)| {
            (0..u32::from(*n)).all(|i| memory[operand.at(i)].value().is_finite())
        };
        let results = &memory[to.0 as usize..(to.0 + u32::from(to.1)) as usize];
        let nan = results.iter().any(|result| result.value().is_nan());
        let infinite = results.iter().any(|result| result.value().is_infinite());
        match trouble {
            Some(kind) => self.note(kind, pc),
            None if !operands.iter().all(finite) => {}
            None if nan => self.note(FindingKind::NotANumber, pc),
            None if infinite => self.note(FindingKind::Infinity, pc),
            None => {}
        }
    }
}

fn outside1(op: Unary, x: f64) -> bool {
    match op {
        Unary::Sqrt => x < 0.0,
        Unary::InverseSqrt | Unary::Log | Unary::Log2 => x <= 0.0,
        Unary::Acos | Unary::Asin | Unary::Atanh => x.abs() > 1.0,
        Unary::Acosh => x < 1.0,
        _ => false,
    }
}

fn outside2(op: Binary, a: f64, b: f64) -> Option<FindingKind> {
    match op {
        Binary::Divide | Binary::Remainder if b == 0.0 => Some(FindingKind::DivisionByZero),
        Binary::Pow if a < 0.0 || a == 0.0 && b <= 0.0 => Some(FindingKind::Domain),
        Binary::Atan2 if a == 0.0 && b == 0.0 => Some(FindingKind::Domain),
        _ => None,
    }
}

/// Whether the number, truncated to an integer, does not fit the integer type.
fn does_not_fit(op: Convert, x: f64) -> bool {
    let whole = x.trunc();
    match op {
        Convert::SFromFloat => !(-2147483648.0..=2147483647.0).contains(&whole),
        Convert::UFromFloat => !(0.0..=4294967295.0).contains(&whole),
        _ => false,
    }
}
