//! The order in which rows are tried.

use lamplight_check::cases::Rows;

/// An order of the rows in which rows with simple values, or at the ends of their columns,
/// alternate with rows from everywhere.
pub fn row_order(rows: &Rows) -> Vec<usize> {
    let column = |index: usize| (0..rows.len()).map(move |row| rows.row(row)[index]);
    let ends: Vec<(f64, f64)> = (0..rows.stride.min(rows.row(0).len()))
        .map(|index| {
            (
                column(index).fold(f64::INFINITY, f64::min),
                column(index).fold(f64::NEG_INFINITY, f64::max),
            )
        })
        .collect();
    let is_edge = |(value, (low, high)): (&f64, &(f64, f64))| {
        value == low || value == high || *value == 0.0 || value.abs() == 1.0
    };
    let edges = |row: usize| rows.row(row).iter().zip(&ends).filter(|pair| is_edge(*pair)).count();
    // With a step near the golden section the rows are visited evenly.
    let count = rows.len();
    let step = (1..=count)
        .rev()
        .find(|step| *step as f64 <= count as f64 * 0.618 && gcd(*step, count) == 1)
        .unwrap_or(1);
    let spread = (0..count).map(|index| index * step % count);
    let mut by_edges: Vec<usize> = spread.clone().collect();
    by_edges.sort_by_key(|row| std::cmp::Reverse(edges(*row)));
    let mut seen = vec![false; count];
    spread
        .zip(by_edges)
        .flat_map(|(even, edge)| [even, edge])
        .filter(|row| !std::mem::replace(&mut seen[*row], true))
        .collect()
}

fn gcd(a: usize, b: usize) -> usize {
    if b == 0 { a } else { gcd(b, a % b) }
}
