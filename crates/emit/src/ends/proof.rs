//! Which loops end by themselves.
//!
//! A loop is proved to end if each of its turns tests an integer variable before anything else, or
//! after its step, and changes that variable exactly once, by a constant, so that it cannot wrap
//! before the test fails. Then it has at most as many turns as the variable has values. The proof
//! asks nothing of the number that the variable is compared with where the step is 1: a variable
//! that is below some number is not the largest one, so adding 1 to it does not wrap.

use std::collections::{BTreeMap, BTreeSet};

use naga::{
    BinaryOperator, Block, Expression, Function, Handle, Literal, LocalVariable, Module, Scalar,
    ScalarKind, Statement, TypeInner, UnaryOperator,
};

use lamplight_validate::{computed, inner_blocks, operands, used};

type Value = Handle<Expression>;
type Variable = Handle<LocalVariable>;

/// The parts of a loop.
#[derive(Clone, Copy)]
struct Loop<'f> {
    body: &'f Block,
    continuing: &'f Block,
    break_if: Option<Value>,
}

/// What is known of a function's loops.
pub struct LoopProofs<'f> {
    module: &'f Module,
    function: &'f Function,
    /// Variables whose pointers are used for more than loads and stores.
    shared: BTreeSet<Variable>,
}

/// What the tests of a loop say.
#[derive(Default)]
struct Tests {
    /// What holds in every turn that another turn follows.
    found: Vec<Comparison>,
    /// For a variable, a value of it from which a condition follows with the same value: `a && b` is
    /// such a variable, which is true only if `a` is.
    implied: BTreeMap<Variable, (bool, Value)>,
    /// The same for values that were loaded from these variables.
    loaded: BTreeMap<Value, (bool, Value)>,
}

/// A comparison that holds in every turn that another turn follows.
#[derive(Clone, Copy)]
struct Comparison {
    op: BinaryOperator,
    left: Value,
    right: Value,
}

impl<'f> LoopProofs<'f> {
    /// What is known of the loops of a function of a module.
    pub fn new(module: &'f Module, function: &'f Function) -> Self {
        let mut shared = BTreeSet::new();
        let variable_of = |value: Value| match function.expressions[value] {
            Expression::LocalVariable(variable) => Some(variable),
            _ => None,
        };
        for (_, expression) in function.expressions.iter() {
            if !matches!(expression, Expression::Load { pointer: _ }) {
                shared.extend(operands(expression).into_iter().filter_map(variable_of));
            }
        }
        let mut open = vec![&function.body];
        while let Some(block) = open.pop() {
            for statement in block {
                if !matches!(statement, Statement::Store { pointer: _, value: _ }) {
                    shared.extend(used(statement).into_iter().filter_map(variable_of));
                }
                open.extend(inner_blocks(statement));
            }
        }
        Self { module, function, shared }
    }

    /// For each loop, in the order in which they begin, whether it may go on for ever.
    pub fn open(&self) -> Vec<bool> {
        let mut found = Vec::new();
        self.visit(&self.function.body, &mut found);
        found
    }

    fn visit(&self, block: &Block, found: &mut Vec<bool>) {
        for statement in block {
            if let Statement::Loop { body, continuing, break_if } = statement {
                found.push(!self.ends(Loop { body, continuing, break_if: *break_if }));
            }
            inner_blocks(statement).into_iter().for_each(|inner| self.visit(inner, found));
        }
    }

    fn ends(&self, one: Loop<'_>) -> bool {
        let mut tests = Tests::default();
        self.tests_at_start(one.body, &mut tests);
        if let Some(condition) = one.break_if {
            self.read_test(condition, false, &mut tests);
        }
        let inside: BTreeSet<Value> =
            computed(one.body).into_iter().chain(computed(one.continuing)).collect();
        tests.found.iter().any(|test| self.is_counted(*test, one, &inside))
    }

    /// Reads the tests before anything else happens in a turn. Each turn passes them.
    fn tests_at_start(&self, body: &Block, tests: &mut Tests) {
        for statement in body {
            match statement {
                Statement::Emit(range) => {
                    for value in range.clone() {
                        let implied = self.variable_at(value);
                        let implied = implied.and_then(|variable| tests.implied.get(&variable));
                        tests.loaded.extend(implied.map(|implied| (value, *implied)));
                    }
                }
                Statement::If { condition, accept, reject } => {
                    match [accept, reject].map(|block| block.first()) {
                        [None, Some(Statement::Break)] => self.read_test(*condition, true, tests),
                        [Some(Statement::Break), None] => self.read_test(*condition, false, tests),
                        _ => match self.implication(accept, reject) {
                            Some((variable, value)) => {
                                tests.implied.insert(variable, (value, *condition));
                            }
                            None => return,
                        },
                    }
                }
                _ => return,
            }
        }
    }

    /// The variable of a value that is loaded from one, which is used for nothing but loads and
    /// stores.
    fn variable_at(&self, value: Value) -> Option<Variable> {
        let Expression::Load { pointer } = self.function.expressions[value] else { return None };
        match self.function.expressions[pointer] {
            Expression::LocalVariable(variable) => {
                (!self.shared.contains(&variable)).then_some(variable)
            }
            _ => None,
        }
    }

    /// The variable that both blocks store to and nothing else, and a value that it has only where
    /// the condition has the same: `&&` stores false where its left side is false, `||` stores true
    /// where it is true.
    fn implication(&self, accept: &Block, reject: &Block) -> Option<(Variable, bool)> {
        let only_store = |block: &Block| {
            let mut rest = block.iter().filter(|one| !matches!(one, Statement::Emit(_)));
            let Some(Statement::Store { pointer, value }) = rest.next() else { return None };
            match (&self.function.expressions[*pointer], rest.next()) {
                (Expression::LocalVariable(variable), None) => Some((*variable, *value)),
                _ => None,
            }
        };
        let ((variable, accepted), (other, rejected)) = (only_store(accept)?, only_store(reject)?);
        let literal = |value: Value| match self.function.expressions[value] {
            Expression::Literal(Literal::Bool(value)) => Some(value),
            _ => None,
        };
        match (literal(accepted), literal(rejected)) {
            _ if variable != other => None,
            (_, Some(false)) => Some((variable, true)),
            (Some(true), _) => Some((variable, false)),
            _ => None,
        }
    }

    /// Reads what holds where a condition has a value.
    fn read_test(&self, condition: Value, value: bool, tests: &mut Tests) {
        use BinaryOperator as B;
        match self.function.expressions[condition] {
            Expression::Unary { op: UnaryOperator::LogicalNot, expr } => {
                self.read_test(expr, !value, tests);
            }
            Expression::Binary { op: B::LogicalAnd, left, right } if value => {
                [left, right].into_iter().for_each(|side| self.read_test(side, value, tests));
            }
            Expression::Binary { op: B::LogicalOr, left, right } if !value => {
                [left, right].into_iter().for_each(|side| self.read_test(side, value, tests));
            }
            Expression::Binary { op, left, right } => {
                let op = if value { Some(op) } else { negated(op) };
                if let Some(op) = op {
                    tests.found.push(Comparison { op, left, right });
                    let mirrored = mirrored(op);
                    tests.found.extend(mirrored.map(|op| Comparison {
                        op,
                        left: right,
                        right: left,
                    }));
                }
            }
            _ => match tests.loaded.get(&condition) {
                Some((known, implied)) if *known == value => {
                    self.read_test(*implied, value, tests);
                }
                _ => {}
            },
        }
    }

    /// Whether the left side of a test is a variable that counts towards its right side.
    fn is_counted(&self, test: Comparison, one: Loop<'_>, inside: &BTreeSet<Value>) -> bool {
        let counted = || {
            let variable = self.loaded(test.left, inside)?;
            let range = self.range_of(variable)?;
            let step = self.step_of(variable, one, inside)?;
            Some(cannot_wrap(test.op, step, self.constant(test.right), range))
        };
        counted() == Some(true)
    }

    /// The variable that a value was loaded from, in this loop.
    fn loaded(&self, value: Value, inside: &BTreeSet<Value>) -> Option<Variable> {
        self.variable_at(value).filter(|_| inside.contains(&value))
    }

    /// The smallest and the largest number that a variable can have, if it has integers.
    fn range_of(&self, variable: Variable) -> Option<[i128; 2]> {
        let ty = self.function.local_variables[variable].ty;
        let TypeInner::Scalar(Scalar { kind, width }) = self.module.types[ty].inner else {
            return None;
        };
        let bits = 8 * u32::from(width);
        match kind {
            ScalarKind::Uint => Some([0, (1 << bits) - 1]),
            ScalarKind::Sint => Some([-(1 << (bits - 1)), (1 << (bits - 1)) - 1]),
            _ => None,
        }
    }

    /// By how much a variable changes in each turn that another turn follows.
    fn step_of(&self, variable: Variable, one: Loop<'_>, inside: &BTreeSet<Value>) -> Option<i128> {
        let mut stores = self.stores(one.body, variable);
        let in_continuing = self.stores(one.continuing, variable);
        let block = if stores.is_empty() { one.continuing } else { one.body };
        stores.extend(in_continuing);
        let [value] = stores.as_slice() else { return None };
        let is_certain = self.is_at_top(block, variable)
            && (std::ptr::eq(block, one.continuing) || !continues(one.body));
        if !is_certain {
            return None;
        }
        use BinaryOperator as B;
        let is_it = |side| self.loaded(side, inside) == Some(variable);
        match self.function.expressions[*value] {
            Expression::Binary { op: B::Add, left, right } if is_it(left) => self.constant(right),
            Expression::Binary { op: B::Add, left, right } if is_it(right) => self.constant(left),
            Expression::Binary { op: B::Subtract, left, right } if is_it(left) => {
                self.constant(right).map(|step| -step)
            }
            _ => None,
        }
    }

    fn is_store(&self, statement: &Statement, variable: Variable) -> Option<Value> {
        let Statement::Store { pointer, value } = statement else { return None };
        let stored = &self.function.expressions[*pointer];
        matches!(stored, Expression::LocalVariable(found) if *found == variable).then_some(*value)
    }

    /// What is stored in a variable in a block, and in the blocks within it.
    fn stores(&self, block: &Block, variable: Variable) -> Vec<Value> {
        let mut found = Vec::new();
        for statement in block {
            found.extend(self.is_store(statement, variable));
            let inner = inner_blocks(statement).into_iter();
            found.extend(inner.flat_map(|inner| self.stores(inner, variable)));
        }
        found
    }

    /// Whether whoever reaches the end of a block has stored to the variable.
    fn is_at_top(&self, block: &Block, variable: Variable) -> bool {
        block.iter().any(|statement| match statement {
            Statement::Block(inner) => self.is_at_top(inner, variable),
            _ => self.is_store(statement, variable).is_some(),
        })
    }

    /// The value of a constant integer.
    fn constant(&self, value: Value) -> Option<i128> {
        match self.function.expressions[value] {
            Expression::Literal(literal) => integer(literal),
            Expression::Constant(constant) => {
                let init = self.module.constants[constant].init;
                match self.module.global_expressions[init] {
                    Expression::Literal(literal) => integer(literal),
                    _ => None,
                }
            }
            _ => None,
        }
    }
}

fn integer(literal: Literal) -> Option<i128> {
    match literal {
        Literal::I32(value) => Some(value.into()),
        Literal::U32(value) => Some(value.into()),
        Literal::I64(value) => Some(value.into()),
        Literal::U64(value) => Some(value.into()),
        _ => None,
    }
}

/// The comparison of integers that holds where another does not.
fn negated(op: BinaryOperator) -> Option<BinaryOperator> {
    use BinaryOperator as B;
    Some(match op {
        B::Less => B::GreaterEqual,
        B::LessEqual => B::Greater,
        B::Greater => B::LessEqual,
        B::GreaterEqual => B::Less,
        B::Equal => B::NotEqual,
        B::NotEqual => B::Equal,
        _ => return None,
    })
}

/// The comparison with its sides exchanged.
fn mirrored(op: BinaryOperator) -> Option<BinaryOperator> {
    use BinaryOperator as B;
    Some(match op {
        B::Less => B::Greater,
        B::LessEqual => B::GreaterEqual,
        B::Greater => B::Less,
        B::GreaterEqual => B::LessEqual,
        B::Equal | B::NotEqual => op,
        _ => return None,
    })
}

/// Whether a variable that changes by `step` in each turn reaches the end of its comparison with a
/// number before it wraps, whatever it begins with. Where the number is not known, it may change.
fn cannot_wrap(
    op: BinaryOperator,
    step: i128,
    number: Option<i128>,
    [least, most]: [i128; 2],
) -> bool {
    use BinaryOperator as B;
    match (op, number) {
        // It stays below the number until the last turn, whose result is below number + step.
        (B::Less, Some(number)) => step > 0 && number - 1 + step <= most,
        (B::Less, None) => step == 1,
        (B::LessEqual, Some(number)) => step > 0 && number + step <= most,
        (B::Greater, Some(number)) => step < 0 && number + 1 + step >= least,
        (B::Greater, None) => step == -1,
        (B::GreaterEqual, Some(number)) => step < 0 && number + step >= least,
        // It has every value before it has one twice.
        (B::NotEqual, Some(_)) => step.abs() == 1,
        (B::Equal, Some(_)) => step != 0 && step.abs() <= most - least,
        _ => false,
    }
}

/// Whether a block has a `continue` of the loop that it is the body of.
fn continues(block: &Block) -> bool {
    block.iter().any(|statement| match statement {
        Statement::Continue => true,
        Statement::Loop { body: _, continuing: _, break_if: _ } => false,
        _ => inner_blocks(statement).into_iter().any(continues),
    })
}
