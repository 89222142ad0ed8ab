//! The results that the functions of `functions/*.metal` should give, computed from their definitions
//! in f64, or exactly in u32.

use lamplight::eval::{half_from, half_to};

/// The inputs of a text, and its expected results.
pub enum Reference {
    /// The inputs are numbers from `from` to `to`. `share` is the relative error that is allowed, and
    /// `least` the absolute one. `expected` gives the components of all targets.
    Numbers { from: f64, to: f64, share: f64, least: f64, expected: fn(&[f64; 12]) -> Vec<f64> },
    /// The inputs are any words. The function gives the words of all targets.
    Words(fn(&[u32; 12]) -> Vec<u32>),
}

const fn numbers(
    from: f64,
    to: f64,
    share: f64,
    least: f64,
    expected: fn(&[f64; 12]) -> Vec<f64>,
) -> Reference {
    Reference::Numbers { from, to, share, least, expected }
}

/// The references, by the names of files.
pub const REFERENCES: &[(&str, Reference)] = &[
    ("angles", numbers(-6.0, 6.0, 1e-6, 2e-7, |w| each(w, &[f64::sin, f64::cos, f64::tan]))),
    (
        "angles_back",
        numbers(-1.0, 1.0, 3e-7, 2e-7, |w| {
            let back = zip(a(w), b(w), f64::atan2);
            [each(w, &[f64::asin, f64::acos, f64::atan]), back].concat()
        }),
    ),
    ("bits", Reference::Words(bits)),
    ("choices", numbers(-2.0, 2.0, 1e-7, 0.0, choices)),
    ("constructors", numbers(-4.0, 4.0, 1e-6, 4e-6, constructors)),
    (
        "exponents",
        numbers(0.01, 6.0, 4e-7, 2e-7, |w| {
            let first = each(w, &[f64::exp, f64::exp2, f64::ln, f64::log2]);
            let last = each(w, &[f64::sqrt, |x| 1.0 / x.sqrt()]);
            [first, zip(a(w), b(w), f64::powf), last].concat()
        }),
    ),
    ("geometry", numbers(-3.0, 3.0, 2e-6, 4e-6, geometry)),
    ("halves", numbers(-5.0, 5.0, 0.0, 0.0, halves)),
    (
        "hyperbolic",
        numbers(-3.0, 3.0, 6e-7, 4e-7, |w| {
            let last: [fn(f64) -> f64; 3] =
                [f64::asinh, |x| (x.abs() + 1.5).acosh(), |x| (x * 0.25).atanh()];
            [each(w, &[f64::sinh, f64::cosh, f64::tanh]), each(w, &last)].concat()
        }),
    ),
    ("integers", Reference::Words(integers)),
    ("matrices", numbers(-2.0, 2.0, 2e-6, 2e-5, matrices)),
    ("packing", Reference::Words(packing)),
    ("parts", numbers(-40.0, 40.0, 0.0, 0.0, parts)),
    ("ranges", numbers(-2.0, 2.0, 6e-7, 6e-7, ranges)),
    (
        "rounding",
        numbers(-3.0, 3.0, 2e-7, 6e-8, |w| {
            let all: [fn(f64) -> f64; 8] = [
                f64::abs,
                f64::ceil,
                f64::floor,
                |x| x - x.floor(),
                f64::round_ties_even,
                f64::round,
                |x| if x == 0.0 { 0.0 } else { x.signum() },
                f64::trunc,
            ];
            each(w, &all)
        }),
    ),
];

fn a(words: &[f64; 12]) -> &[f64] {
    &words[..4]
}

fn b(words: &[f64; 12]) -> &[f64] {
    &words[4..8]
}

fn c(words: &[f64; 12]) -> &[f64] {
    &words[8..]
}

/// Applies functions to each component of `a`.
fn each(words: &[f64; 12], functions: &[fn(f64) -> f64]) -> Vec<f64> {
    functions.iter().flat_map(|function| a(words).iter().map(|x| function(*x))).collect()
}

fn zip(a: &[f64], b: &[f64], function: fn(f64, f64) -> f64) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| function(*a, *b)).collect()
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn length(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}

fn scaled(a: &[f64], by: f64) -> Vec<f64> {
    a.iter().map(|x| x * by).collect()
}

fn minus(a: &[f64], b: &[f64]) -> Vec<f64> {
    zip(a, b, |a, b| a - b)
}

fn normalized(a: &[f64]) -> Vec<f64> {
    scaled(a, 1.0 / length(a))
}

fn ranges(w: &[f64; 12]) -> Vec<f64> {
    let (a, b, c) = (a(w), b(w), c(w));
    let at = |function: &dyn Fn(usize) -> f64| (0..4).map(function).collect::<Vec<f64>>();
    [
        zip(a, b, f64::min),
        zip(a, b, f64::max),
        at(&|i| a[i].max(-b[i].abs()).min(c[i].abs())),
        at(&|i| a[i].clamp(0.0, 1.0)),
        at(&|i| if b[i] < a[i] { 0.0 } else { 1.0 }),
        at(&|i| {
            let t = ((a[i] + 1.0) / (b[i].abs() + 1.5)).clamp(0.0, 1.0);
            t * t * (3.0 - 2.0 * t)
        }),
        at(&|i| a[i] * (1.0 - c[0]) + b[i] * c[0]),
        vec![a[0].min(b[0]), a[1].max(b[1]), a[2].clamp(-0.5, 0.5), a[3].clamp(0.0, 1.0)],
    ]
    .concat()
}

fn refract(i: &[f64], n: &[f64], eta: f64) -> Vec<f64> {
    let cosine = dot(n, i);
    let k = 1.0 - eta * eta * (1.0 - cosine * cosine);
    if k < 0.0 {
        return vec![0.0; i.len()];
    }
    minus(&scaled(i, eta), &scaled(n, eta * cosine + k.sqrt()))
}

fn geometry(w: &[f64; 12]) -> Vec<f64> {
    let (a, b, c) = (a(w), b(w), c(w));
    let (n, i) = (normalized(&b[..3]), normalized(&a[..3]));
    let cross = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let facing = if dot(&n, &i) < 0.0 { a[..3].to_vec() } else { scaled(&a[..3], -1.0) };
    let (flat_i, flat_n) = (normalized(&a[..2]), normalized(&b[..2]));
    [
        vec![dot(a, b), length(&a[..3]), length(&minus(&a[..2], &b[..2])), dot(&a[..2], &c[2..])],
        cross.to_vec(),
        vec![dot(&a[..3], &b[..3])],
        normalized(a),
        minus(&i, &scaled(&n, 2.0 * dot(&n, &i))),
        vec![length(b)],
        refract(&i, &n, f64::from(0.7f32)),
        vec![length(&minus(a, b))],
        facing,
        vec![a[0] % 0.75],
        (0..4).map(|i| a[i] * b[i] + c[i]).collect(),
        flat_i.clone(),
        refract(&flat_i, &flat_n, 1.5),
    ]
    .concat()
}

/// A matrix, given as columns, times a vector.
fn times(columns: &[Vec<f64>], by: &[f64]) -> Vec<f64> {
    (0..columns[0].len())
        .map(|row| columns.iter().zip(by).map(|(column, by)| column[row] * by).sum())
        .collect()
}

fn transposed(columns: &[Vec<f64>]) -> Vec<Vec<f64>> {
    (0..columns[0].len()).map(|row| columns.iter().map(|column| column[row]).collect()).collect()
}

fn determinant(columns: &[Vec<f64>]) -> f64 {
    let n = columns.len();
    if n == 1 {
        return columns[0][0];
    }
    let minor = |skipped: usize| -> Vec<Vec<f64>> {
        (0..n).filter(|i| *i != skipped).map(|i| columns[i][1..].to_vec()).collect()
    };
    (0..n)
        .map(|i| if i % 2 == 0 { 1.0 } else { -1.0 } * columns[i][0] * determinant(&minor(i)))
        .sum()
}

fn matrices(w: &[f64; 12]) -> Vec<f64> {
    let (a, b, c) = (a(w).to_vec(), b(w).to_vec(), c(w).to_vec());
    let m = vec![a.clone(), b.clone(), c.clone(), a.iter().rev().copied().collect()];
    let tall = vec![a[..3].to_vec(), b[..3].to_vec()];
    let wide = vec![a[..2].to_vec(), b[..2].to_vec(), c[..2].to_vec()];
    let square = vec![a[..3].to_vec(), b[..3].to_vec(), c[..3].to_vec()];
    let across = transposed(&square);
    let small = [times(&wide, &tall[0]), times(&wide, &tall[1])];
    let third: Vec<f64> =
        (0..3).map(|i| (square[2][i] + across[2][i]) * 0.5 - square[2][i]).collect();
    let first_second = (square[0][1] + across[0][1]) * 0.5 - square[0][1];
    [
        times(&m, &c),
        times(&transposed(&m), &c),
        times(&m, &c),
        times(&tall, &c[..2]),
        vec![dot(&a[..3], &tall[1])],
        small.concat(),
        third,
        vec![first_second],
        vec![
            determinant(&m),
            determinant(&square),
            determinant(&[a[..2].to_vec(), b[..2].to_vec()]),
            -square[1][2],
        ],
        times(&wide, &c[..3]),
        vec![b[1], c[1]],
    ]
    .concat()
}

/// The fraction, in [0.5, 1), and the exponent of a number.
fn frexp(x: f64) -> (f64, f64) {
    if x == 0.0 {
        return (0.0, 0.0);
    }
    let exponent = x.abs().log2().floor() + 1.0;
    (x / exponent.exp2(), exponent)
}

fn parts(w: &[f64; 12]) -> Vec<f64> {
    let (one, e) = frexp(b(w)[0]);
    [
        a(w).iter().map(|x| x.fract()).collect(),
        a(w).iter().map(|x| x.trunc()).collect(),
        a(w).to_vec(),
        vec![one, e, c(w)[0] * 8.0, frexp(a(w)[1]).1],
    ]
    .concat()
}

fn halves(w: &[f64; 12]) -> Vec<f64> {
    let half = |x: f64| half_to(half_from(x));
    [
        a(w).iter().map(|x| half(*x)).collect(),
        vec![half(b(w)[0]), half(b(w)[1]), half(c(w)[0]), f64::from(half_from(b(w)[0]))],
        b(w).iter().map(|x| half(f64::from(*x as f32 * 0.00001f32))).collect(),
    ]
    .concat()
}

fn choices(w: &[f64; 12]) -> Vec<f64> {
    let (a, b) = (a(w), b(w));
    let truth = |fact: bool| f64::from(u8::from(fact));
    let below: Vec<bool> = a.iter().zip(b).map(|(a, b)| a < b).collect();
    let three: Vec<bool> = (0..3).map(|i| below[i] && b[i] >= 0.0).collect();
    let four = [truth(three[0]), truth(three[1]), truth(three[2]), truth(below[1])];
    let flags = [three[0], three[1], three[2], below[1]];
    [
        (0..4).map(|i| if below[i] { b[i] } else { a[i] }).collect(),
        vec![
            truth(below.iter().all(|fact| *fact)),
            truth(below[0] || a[1] > 0.0),
            1.0,
            truth(a[0] != 0.0),
        ],
        (0..4).map(|i| truth(below[i]) + truth(below[3 - i])).collect(),
        (0..4).map(|i| if below[3 - i] || flags[i] { 2.0 } else { four[i] }).collect(),
    ]
    .concat()
}

fn constructors(w: &[f64; 12]) -> Vec<f64> {
    let (a, b, c) = (a(w), b(w), c(w));
    let direction = [a[0], a[1] + b[0], a[2]];
    let whole: Vec<f64> = (0..3).map(|i| (a[i] * 8.0).clamp(-100.0, 100.0).trunc()).collect();
    [
        (0..3)
            .map(|i| direction[i] * 2.0 + c[i] * direction[i] - direction[i] / c[i])
            .collect::<Vec<f64>>(),
        vec![dot(&direction, &c[..3])],
        vec![a[0], b[2], b[1], a[0]],
        whole.clone(),
        vec![1.0],
        whole.iter().map(|x| x - 3.0).collect(),
        vec![6.0],
        vec![a[0], b[0], b[1], c[2]],
        vec![direction[2], direction[1], direction[0], direction[1]],
    ]
    .concat()
}

fn integers(w: &[u32; 12]) -> Vec<u32> {
    let at = |function: &dyn Fn(u32, u32, u32) -> u32| -> Vec<u32> {
        (0..4).map(|i| function(w[i], w[4 + i], w[8 + i])).collect()
    };
    let signed = |i: usize| w[i] as i32;
    let leading = |x: i32| {
        if x == 0 || x == -1 {
            -1i32 as u32
        } else {
            31 - (if x < 0 { !x } else { x }).leading_zeros()
        }
    };
    [
        at(&|a, b, _| a.wrapping_add(b)),
        at(&|a, b, c| a.wrapping_mul(b).wrapping_sub(c)),
        at(&|a, b, _| (a as i32 >> (b & 31)) as u32),
        at(&|a, b, _| a << (b & 31)),
        at(&|a, b, c| (a & b) ^ (!c | 5)),
        at(&|a, b, _| if (a as i32) < (b as i32) { b } else { a }),
        vec![
            signed(0).min(signed(4)) as u32,
            w[1].max(w[5]),
            signed(2).wrapping_abs() as u32,
            signed(3).clamp(-5, 5) as u32,
        ],
        vec![
            u32::from(w[0] > w[4]),
            u32::from(signed(1) > signed(5)),
            if w[2] == w[6] { w[6] } else { w[2] },
            leading(signed(3)),
        ],
    ]
    .concat()
}

fn bits(w: &[u32; 12]) -> Vec<u32> {
    let offset = w[4] & 31;
    let count = (w[5] & 63).min(32 - offset);
    let ones = |count: u32| if count == 32 { u32::MAX } else { (1 << count) - 1 };
    let mask = ones(count) << offset;
    let at = |function: &dyn Fn(u32, u32) -> u32| -> Vec<u32> {
        (0..4).map(|i| function(w[i], w[8 + i])).collect()
    };
    let signed = |x: u32| {
        if count == 0 { 0 } else { ((x << (32 - count - offset)) as i32 >> (32 - count)) as u32 }
    };
    [
        at(&|a, _| a.count_ones()),
        at(&|a, _| a.leading_zeros()),
        at(&|a, _| a.trailing_zeros()),
        at(&|a, _| a.reverse_bits()),
        at(&|a, _| a >> offset & ones(count)),
        at(&|a, _| signed(a)),
        at(&|a, c| if count == 0 { a } else { a & !mask | c << offset & mask }),
        vec![w[0].reverse_bits(), w[1].count_ones(), w[2] >> 8 & 255, w[11]],
    ]
    .concat()
}

fn packing(w: &[u32; 12]) -> Vec<u32> {
    let number = |i: usize| (w[i] >> 8) as f32 / 8_388_608.0 - 1.0;
    let pack = |places: &[usize], bits: u32, low: f32, most: f32| -> u32 {
        let scaled = |i: usize| f64::from(number(i).clamp(low, 1.0)) * f64::from(most);
        let word = |i: usize| scaled(i).round_ties_even() as i32 as u32;
        let mask = (1u32 << bits) - 1;
        places.iter().enumerate().map(|(n, i)| (word(*i) & mask) << (n as u32 * bits)).sum()
    };
    let byte = |word: u32, i: u32| (word >> (8 * i) & 255) as u8;
    let snorm = |word: u32, i: u32| (f32::from(byte(word, i) as i8) / 127.0).max(-1.0).to_bits();
    let unorm = |word: u32, i: u32| (f32::from(byte(word, i)) / 255.0).to_bits();
    [
        vec![
            pack(&[0, 1, 2, 3], 8, -1.0, 127.0),
            pack(&[0, 1, 2, 3], 8, 0.0, 255.0),
            pack(&[0, 1], 16, -1.0, 32767.0),
            pack(&[2, 3], 16, 0.0, 65535.0),
        ],
        (0..4).map(|i| snorm(w[4], i)).collect(),
        (0..4).map(|i| unorm(w[5], i)).collect(),
        vec![
            u32::from(byte(w[0], 1)),
            i32::from(byte(w[0], 2) as i8) as u32,
            (f32::from((w[6] >> 16) as i16) / 32767.0).max(-1.0).to_bits(),
            (f32::from(w[7] as u16) / 65535.0).to_bits(),
        ],
    ]
    .concat()
}
