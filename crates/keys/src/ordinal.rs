//! The numbers of permutations from a lock file, in a form from which code can be written.

use lamplight_permute::{Axis, Lock, Mode, Program};

/// How the keys of a program become numbers and back.
pub struct Ordinals {
    /// What the dynamic axes, which keys leave out, add to each number.
    pub constant: u64,
    /// For each axis of keys, what each of its values adds.
    pub of_values: Vec<Vec<u64>>,
    pub digits: Vec<KeyDigit>,
    /// Every number is below this.
    pub range: u128,
}

/// One digit of a number: `number / weight % radix`.
pub struct KeyDigit {
    pub weight: u64,
    pub radix: u64,
    /// Index of the axis among those of keys.
    pub axis: usize,
    /// The meaning of each value of the digit.
    pub says: Vec<Says>,
}

/// What a digit says about its axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Says {
    /// The axis has the value of that index.
    Value(usize),
    /// Another digit has the value of the axis.
    Nothing,
    /// A value that the manifest no longer has.
    Gone,
}

/// How the keys of a program become numbers. `None` if the lock lacks a value of the program, or if
/// there are more than `most` numbers.
pub fn key_ordinals(program: &Program, lock: &Lock, most: u64) -> Option<Ordinals> {
    let space = &program.space;
    let default = lock.dense(&program.name, space, &space.default_assignment())?;
    let axes: Vec<&Axis> = super::key_axes(program).collect();
    let mut of_values: Vec<Vec<u64>> = axes.iter().map(|axis| vec![0; axis.values.len()]).collect();
    let (mut digits, mut range) = (Vec::new(), 1u128);
    for (weight, line) in lock.digits(&program.name) {
        let weight = u64::try_from(weight?).ok()?;
        range = u128::from(weight).checked_mul(line.radix())?;
        let Some(axis) = axes.iter().position(|axis| axis.name == line.axis) else { continue };
        let says: Vec<Says> = (0..line.radix())
            .map(|digit| digit_comment(axes[axis], line.setting(digit), digit))
            .collect();
        for (digit, says) in says.iter().enumerate() {
            if let Says::Value(value) = says {
                of_values[axis][*value] += weight * digit as u64;
            }
        }
        digits.push(KeyDigit { weight, radix: line.radix() as u64, axis, says });
    }
    if range > u128::from(most) || !has_all_values(&axes, &digits) {
        return None;
    }
    // Dynamic axes have digits too, which are always those of their defaults.
    let of_axes: u64 = axes.iter().zip(&of_values).map(|(axis, values)| values[axis.default]).sum();
    let constant = u64::try_from(default).ok()?.checked_sub(of_axes)?;
    debug_assert!(space.axes().iter().any(|axis| axis.mode == Mode::Dynamic) || constant == 0);
    Some(Ordinals { constant, of_values, digits, range })
}

/// Whether each value of each axis is in some digit.
fn has_all_values(axes: &[&Axis], digits: &[KeyDigit]) -> bool {
    axes.iter().enumerate().all(|(axis, of)| {
        let of_axis = || digits.iter().filter(|digit| digit.axis == axis);
        (0..of.values.len()).all(|value| of_axis().any(|d| d.says.contains(&Says::Value(value))))
    })
}

fn digit_comment(axis: &Axis, setting: Option<&lamplight_permute::Setting>, digit: u128) -> Says {
    match setting {
        None if digit == 0 => Says::Nothing,
        None => Says::Gone,
        Some(setting) => axis.ordinal(setting).map_or(Says::Gone, Says::Value),
    }
}
