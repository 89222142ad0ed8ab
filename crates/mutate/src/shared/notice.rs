//! What notices a mistake that the reference has too: numbers that a case states, and laws. Values of a
//! reference, of a formula, or of the code itself in f64 are not compared with: they have the mistake.

use lamplight_bundle::Language;
use lamplight_check::check::job::{BoundLaw, BoundOracle};
use lamplight_check::check::law::RowResults;
use lamplight_check::check::{law, partner, verdict};
use lamplight_check::tolerance;
use lamplight_diagnostic::Diagnostic;
use lamplight_execute::Session;
use lamplight_execute::interpreter::Interpreter;
use lamplight_execute::kernel::Kernel;
use naga::{Expression, Function, Handle, Module};

use crate::site::{Site, apply_mutation};
use crate::suite::{ReadyCase, RowRunner, Subject, Suite, exact_result, find_function};

/// What noticed a mistake: a stated number, or a law by its name.
pub type Notice = &'static str;

/// A number of a table.
pub const STATED: Notice = "rows";
/// A call that does not end, or cannot be run.
pub const ENDLESS: Notice = "no end";

/// A mistake in a function of a module.
#[derive(Clone, Copy)]
pub struct Mistake<'a, 's> {
    pub suite: &'a Suite<'s>,
    pub subject: &'a Subject,
    pub site: Option<&'a Site>,
}

impl Mistake<'_, '_> {
    fn original(&self) -> &Function {
        &self.suite.whole.functions[self.subject.function]
    }

    /// The function in a module that has it, maybe under a longer name.
    fn place(&self, module: &Module) -> Option<Handle<Function>> {
        let own = find_function(module, &self.subject.name);
        let is_same = |handle: &Handle<Function>| {
            let (found, original) = (&module.functions[*handle], self.original());
            found.expressions.len() == original.expressions.len()
                && found.arguments.len() == original.arguments.len()
                && found.body.len() == original.body.len()
        };
        own.filter(is_same).or_else(|| {
            let longer = format!("_{}", self.subject.name);
            let ends = |function: &Function| {
                function.name.as_ref().is_some_and(|name| name.ends_with(&longer))
            };
            let all = module.functions.iter().filter(|(_, function)| ends(function));
            {
                let mut longer = all.map(|(handle, _)| handle);
                longer.find(is_same)
            }
        })
    }

    /// The module with the mistake; `None` if it does not have the function, or has no place for it.
    fn module(&self, module: &Module) -> Option<Module> {
        let place = self.place(module)?;
        let Some(site) = self.site else { return Some(module.clone()) };
        let mut changed = module.clone();
        let info = &self.suite.info[self.subject.function];
        let ty = |handle: Handle<Expression>| {
            Some(info[handle].ty.inner_with(&self.suite.whole.types).clone())
        };
        apply_mutation(changed.functions.get_mut(place), site, ty).then_some(changed)
    }

    fn reaches(&self, kernel: &Kernel) -> bool {
        self.place(&kernel.module).is_some()
    }

    /// The kernel's function with the mistake, where it reaches that.
    fn interpreter(&self, kernel: &Kernel) -> Result<Interpreter, Diagnostic> {
        let changed = self.module(&kernel.module);
        Ok(Interpreter::of(kernel, changed.as_ref().unwrap_or(&kernel.module))?
            .with_steps_times(u64::from(u16::MAX)))
    }

    /// What a case notices it by; its own table, then its laws, those about several functions last.
    pub fn notice(&self, case: &ReadyCase<'_>) -> Result<Option<Notice>, Diagnostic> {
        let reached = self.reaches(case.job.kernel());
        let interpreter = self.interpreter(case.job.kernel())?;
        if reached && is_table(case) && case.is_off(&interpreter)? {
            return Ok(Some(STATED));
        }
        let meant = |law: &&BoundLaw<'_>| {
            let mut kernels = law.partners.iter().flat_map(|partner| &partner.kernels);
            reached || kernels.any(|(_, kernel)| self.reaches(kernel))
        };
        let (alone, others): (Vec<_>, Vec<_>) =
            case.job.laws.iter().filter(meant).partition(|law| law.partners.is_empty());
        if !is_table(case) && alone.is_empty() && others.is_empty() {
            return Ok(None);
        }
        let mut runner = RowRunner::new(case.job.kernel(), &interpreter)?;
        let results = runner.run(&case.job.rows.words)?;
        let stated = is_table(case) && reached && {
            let found =
                verdict::check_rows(&case.job, &case.job.rows, &case.job.expected, &results);
            !found.failing.is_empty()
        };
        if stated {
            return Ok(Some(STATED));
        }
        for law in alone {
            if breaks(case, law, &mut runner, &results)? {
                return Ok(Some(law.law.kind.name));
            }
        }
        for law in others {
            let mut session = ChangedSession(*self);
            let found =
                partner::check_partners(&case.job, law, Language::Wesl, &results, &mut session)?;
            if found.is_some_and(|verdict| verdict.broken > 0) {
                return Ok(Some(law.law.kind.name));
            }
        }
        Ok(None)
    }

    /// Whether the mistake changes the values of a case by no more than the case allows; `None` where
    /// the case compares no values.
    pub fn is_within(&self, case: &ReadyCase<'_>) -> Result<Option<bool>, Diagnostic> {
        let compares = !case.job.expected.is_empty();
        let Some(changed) = self.module(&case.job.kernel().module).filter(|_| compares) else {
            return Ok(None);
        };
        let kernel = case.job.kernel();
        let kinds = kernel.result_kinds();
        let own = Interpreter::new(kernel)?.with_steps_times(4);
        let other = Interpreter::of(kernel, &changed)?.with_steps_times(4);
        let (mut own, mut other) = (own.calls::<f64>()?, other.calls::<f64>()?);
        for index in 0..case.job.rows.len() {
            let words = case.job.rows.row_words(index);
            let wanted = exact_result(&mut own, words, &kinds)?;
            let found = exact_result(&mut other, words, &kinds)?;
            let values = tolerance::formula_values(&case.job.terms, case.job.rows.row(index));
            let errors = case.job.expected.get(index).map_or(&[][..], |goal| &goal.errors[..]);
            let is_near = |word: usize| {
                let (a, b) = (wanted[word], found[word]);
                let allowed = tolerance::allowed_error(&case.job.terms, &values, word, a)
                    + errors.get(word).copied().unwrap_or(0.0);
                a == b || (a.is_nan() && b.is_nan()) || (a - b).abs() <= allowed
            };
            if !(0..kinds.len()).all(is_near) {
                return Ok(Some(false));
            }
        }
        Ok(Some(true))
    }
}

/// Whether the case states its values as numbers.
fn is_table(case: &ReadyCase<'_>) -> bool {
    matches!(case.job.oracle, BoundOracle::Fixed) && !case.job.expected.is_empty()
}

/// Whether a law without other functions is broken.
fn breaks(
    case: &ReadyCase<'_>,
    law: &BoundLaw<'_>,
    runner: &mut RowRunner<'_>,
    results: &[u32],
) -> Result<bool, Diagnostic> {
    let transformed = law.rows.as_ref().map(|rows| runner.run(&rows.words)).transpose()?;
    let given = RowResults {
        rows: &case.job.rows,
        expected: &case.job.expected,
        results,
        transformed: law.rows.as_ref().zip(transformed.as_deref()),
    };
    Ok(law::check_law(&case.job, law.law, &given).broken > 0)
}

/// Runs kernels with the mistake in them.
struct ChangedSession<'a, 's>(Mistake<'a, 's>);

impl Session for ChangedSession<'_, '_> {
    fn adapter(&self) -> String {
        "the evaluator, with a mistake".to_owned()
    }

    fn run(&mut self, kernel: &Kernel, inputs: &[u32]) -> Result<Vec<u32>, Diagnostic> {
        let interpreter = self.0.interpreter(kernel)?;
        RowRunner::new(kernel, &interpreter)?.run(inputs)
    }
}
