//! Checks the tables of `shaderlib/tables` with formulas that do not share code with the generator.

mod sample;

use std::f64::consts::PI;
use std::fs;
use std::path::{Path, PathBuf};

use libtest_mimic::{Failed, Trial};

type Outcome = Result<(), Failed>;
type Direction = [f64; 3];

const SIDE: usize = 64;

pub fn tests() -> Vec<Trial> {
    vec![
        Trial::test("tables::files_agree", files_agree),
        Trial::test("tables::dfg", dfg),
        Trial::test("tables::sheen", sheen),
        Trial::test("tables::ltc", ltc),
        Trial::test("tables::dfg_of_all_columns", sample::dfg),
        Trial::test("tables::sheen_of_all_columns", sample::sheen),
        Trial::test("tables::ltc_of_all_columns", sample::ltc),
        Trial::test("tables::blue_noise", blue_noise),
    ]
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("shaderlib/tables")
}

/// The values of a table, `channels` for each cell.
fn values(name: &str, channels: usize) -> Result<Vec<f64>, Failed> {
    let bytes = fs::read(folder().join(format!("{name}.bin")))?;
    if bytes.len() != 4 * channels * SIDE * SIDE {
        let expected = 4 * channels * SIDE * SIDE;
        return Err(format!("{name}.bin has {} bytes, expected {expected}", bytes.len()).into());
    }
    let (words, _) = bytes.as_chunks::<4>();
    Ok(words.iter().map(|word| f64::from(f32::from_le_bytes(*word))).collect())
}

/// The texture `.ktx2` has the values of the `.bin`, read with the crate `ktx2`. The description
/// `.toml` has the same number of channels, an error, and the hash of the `.bin`.
fn files_agree() -> Outcome {
    let formats = [
        ("blue_noise", 1, ktx2::Format::R32_SFLOAT),
        ("dfg", 2, ktx2::Format::R32G32_SFLOAT),
        ("ltc", 4, ktx2::Format::R32G32B32A32_SFLOAT),
        ("sheen", 2, ktx2::Format::R32G32_SFLOAT),
    ];
    for (name, channels, format) in formats {
        let bytes = fs::read(folder().join(format!("{name}.ktx2")))?;
        let reader = ktx2::Reader::new(&bytes).map_err(|error| format!("{name}: {error:?}"))?;
        let head = reader.header();
        let size = [head.pixel_width, head.pixel_height].map(|side| side as usize);
        let level = reader.levels().next().ok_or("no level")?;
        let wanted = fs::read(folder().join(format!("{name}.bin")))?;
        if head.format != Some(format) || size != [SIDE; 2] || level.data != wanted {
            return Err(format!("{name}.ktx2 differs from {name}.bin: {head:?}").into());
        }
        let text = fs::read_to_string(folder().join(format!("{name}.toml")))?;
        let description: toml::Table = text.parse()?;
        let listed =
            description.get("channels").and_then(|channels| channels.as_array()).map(Vec::len);
        let hash = description.get("blake3").and_then(|hash| hash.as_str());
        if hash != Some(&*sample::hash_of(name)?.to_hex()) {
            return Err(format!("{name}.toml describes another {name}.bin").into());
        }
        if listed != Some(channels) || description.get("error").is_none_or(|error| !error.is_str())
        {
            return Err(format!("{name}.toml does not describe the table: {text}").into());
        }
    }
    Ok(())
}

/// The parameters of a cell: the width of the lobe, and the cosine of the viewer.
fn cell(column: usize, row: usize) -> (f64, f64) {
    let share = |index: usize| index as f64 / (SIDE - 1) as f64;
    (share(column).powi(2), 1.0 - share(row).powi(2))
}

/// Cells whose lobes are wide enough for a sum over the light's directions.
fn wide_cells() -> impl Iterator<Item = (usize, usize)> {
    let columns = [24, 32, 40, 51, 63];
    columns.into_iter().flat_map(|column| [0, 13, 29, 47, 57].map(|row| (column, row)))
}

fn viewer(nv: f64) -> Direction {
    [(1.0 - nv * nv).sqrt(), 0.0, nv]
}

/// Directions that divide the hemisphere into equal parts, with the size of a part. They cover half a
/// turn, and stand for the other half by symmetry.
fn directions() -> impl Iterator<Item = (Direction, f64)> {
    let (rings, azimuths) = (300, 300);
    (0..rings * azimuths).map(move |index| {
        let z = (f64::from(index / azimuths) + 0.5) / f64::from(rings);
        let azimuth = PI * (f64::from(index % azimuths) + 0.5) / f64::from(azimuths);
        let s = (1.0 - z * z).sqrt();
        ([s * azimuth.cos(), s * azimuth.sin(), z], 2.0 * PI / f64::from(rings * azimuths))
    })
}

fn half(v: Direction, l: Direction) -> (f64, f64) {
    let h = [v[0] + l[0], v[1] + l[1], v[2] + l[2]];
    let length = h.iter().map(|part| part * part).sum::<f64>().sqrt();
    (h[2] / length, (v[0] * h[0] + v[1] * h[1] + v[2] * h[2]) / length)
}

/// GGX with Smith's height-correlated masking, computed from lambda, times the light's cosine.
fn ggx(v: Direction, l: Direction, alpha: f64) -> f64 {
    let (nh, _) = half(v, l);
    let tan2 = (1.0 - nh * nh) / (nh * nh);
    let distribution =
        1.0 / (PI * alpha * alpha * nh.powi(4) * (1.0 + tan2 / (alpha * alpha)).powi(2));
    let lambda = |z: f64| 0.5 * ((1.0 + alpha * alpha * (1.0 - z * z) / (z * z)).sqrt() - 1.0);
    distribution / ((1.0 + lambda(v[2]) + lambda(l[2])) * 4.0 * v[2])
}

/// The albedo of GGX, in two parts, is that of a sum over the light's directions.
fn dfg() -> Outcome {
    let table = values("dfg", 2)?;
    for (column, row) in wide_cells() {
        let (alpha, nv) = cell(column, row);
        let v = viewer(nv);
        let mut wanted = [0.0; 2];
        for (l, size) in directions() {
            let (_, vh) = half(v, l);
            let (all, grazing) = (ggx(v, l, alpha) * size, (1.0 - vh).powi(5));
            wanted = [wanted[0] + all * (1.0 - grazing), wanted[1] + all * grazing];
        }
        let start = 2 * (row * SIDE + column);
        for (wanted, found) in wanted.iter().zip(&table[start..start + 2]) {
            if (wanted - found).abs() > 5e-4 {
                return Err(format!("cell {column}, {row}: {found}, expected {wanted}").into());
            }
        }
    }
    // No surface reflects more light than it receives, and a mirror reflects all of it.
    let sums = table.chunks(2).map(|pair| pair[0] + pair[1]);
    let most = sums.clone().fold(0.0, f64::max);
    let mirror = sums.step_by(SIDE).take(SIDE - 1).fold(1.0, f64::min);
    if most > 1.0 + 1e-4 || mirror < 0.999 {
        let what = format!("the albedo is up to {most}, and down to {mirror} for a mirror");
        return Err(format!("{what}, expected at most 1 and at least 0.999").into());
    }
    Ok(())
}

/// The cosine of the light times the lobe of cloth with the visibility of Neubelt, and of Charlie.
fn cloth_lobe(nl: f64, nv: f64, nh: f64, alpha: f64) -> [f64; 2] {
    let curve = |x: f64, t: f64| {
        let mix = |rough: f64, smooth: f64| rough * (1.0 - t) + smooth * t;
        mix(21.5473, 25.3245) / (1.0 + mix(3.82987, 3.32435) * x.powf(mix(0.19823, 0.16801)))
            + mix(-1.97760, -1.27393) * x
            + mix(-4.32054, -4.85967)
    };
    let lambda = |z: f64| {
        let t = (1.0 - alpha).powi(2);
        if z < 0.5 { curve(z, t).exp() } else { (2.0 * curve(0.5, t) - curve(1.0 - z, t)).exp() }
    };
    let sine = (1.0 - nh * nh).max(0.0).sqrt();
    let distribution = (2.0 + 1.0 / alpha) * sine.powf(1.0 / alpha) / (2.0 * PI);
    let neubelt = nl / (4.0 * (nl + nv - nl * nv));
    let charlie = 1.0 / ((1.0 + lambda(nl) + lambda(nv)) * 4.0 * nv);
    [neubelt, charlie].map(|visibility| distribution * visibility)
}

/// The albedo of both sheen lobes is that of a sum over the light's directions.
fn sheen() -> Outcome {
    let table = values("sheen", 2)?;
    for (column, row) in wide_cells() {
        let (alpha, nv) = cell(column, row);
        let v = viewer(nv);
        let mut wanted = [0.0; 2];
        for (l, size) in directions() {
            let both = cloth_lobe(l[2], nv, half(v, l).0, alpha);
            wanted = [0, 1].map(|i| wanted[i] + both[i] * size);
        }
        let start = 2 * (row * SIDE + column);
        for (wanted, found) in wanted.iter().zip(&table[start..start + 2]) {
            if (wanted - found).abs() > 2e-3 * (1.0 + wanted) {
                return Err(format!("cell {column}, {row}: {found}, expected {wanted}").into());
            }
        }
    }
    Ok(())
}

/// A fitted lobe has about the direction and the shape of the GGX lobe that it replaces.
fn ltc() -> Outcome {
    let (table, albedos) = (values("ltc", 4)?, values("dfg", 2)?);
    for (column, row) in wide_cells() {
        let (alpha, nv) = cell(column, row);
        let (v, index) = (viewer(nv), row * SIDE + column);
        let albedo = albedos[2 * index] + albedos[2 * index + 1];
        let [a, b, c, d] = [0, 1, 2, 3].map(|part| table[4 * index + part]);
        let (mut apart, mut means) = (0.0, [[0.0; 3]; 2]);
        for (l, size) in directions() {
            let original = [a * l[0] + c * l[2], l[1], b * l[0] + d * l[2]];
            let length = original.iter().map(|part| part * part).sum::<f64>().sqrt();
            let fit = albedo * original[2].max(0.0) / PI * (a * d - b * c) / length.powi(4);
            let wanted = ggx(v, l, alpha);
            apart += (fit - wanted).abs() * size;
            for (mean, value) in means.iter_mut().zip([wanted, fit]) {
                *mean = [0, 1, 2].map(|i| mean[i] + l[i] * value * size);
            }
        }
        let [wanted, fit] = means.map(|mean| f64::atan2(mean[0], mean[2]));
        let misplaced = 0.5 * apart / albedo;
        if misplaced > 0.21 || (wanted - fit).abs() > 0.2 {
            return Err(format!(
                "cell {column}, {row}: {misplaced:.3} of the light is elsewhere (at most 0.21), \
                 the mean direction is off by {:.3} rad (at most 0.2)",
                (wanted - fit).abs()
            )
            .into());
        }
    }
    // Lobes of smooth surfaces are narrow, and the table has the inverse, which widens a lobe to a
    // cosine. So seen from above, its numbers fall with the roughness.
    let from_above = |column: usize| table[4 * column];
    let widths: Vec<f64> = (1..SIDE).map(from_above).collect();
    if widths.is_sorted_by(|smooth, rough| smooth >= rough) {
        Ok(())
    } else {
        Err(format!("seen from above, these should fall with the roughness: {widths:?}").into())
    }
}

/// Blue noise: every rank occurs once, and the cells below a threshold have hardly any low
/// frequencies.
fn blue_noise() -> Outcome {
    let table = values("blue_noise", 1)?;
    let count = SIDE * SIDE;
    let mut ranks: Vec<usize> = table.iter().map(|rank| (rank * count as f64) as usize).collect();
    let low = |threshold: f64| {
        let power = |x: usize, y: usize| {
            let (mut re, mut im) = (0.0, 0.0);
            for index in (0..count).filter(|index| table[*index] < threshold) {
                let turn =
                    2.0 * PI * (x * (index % SIDE) + y * (index / SIDE)) as f64 / SIDE as f64;
                (re, im) = (re + turn.cos(), im + turn.sin());
            }
            re * re + im * im
        };
        let frequencies = [(1, 0), (0, 1), (1, 1), (2, 1), (1, 3), (4, 0), (0, 4), (3, 3)];
        let sum: f64 = frequencies.iter().map(|(x, y)| power(*x, *y)).sum();
        // The power of white noise, in which cells are chosen at random.
        let white = count as f64 * threshold * (1.0 - threshold);
        sum / frequencies.len() as f64 / white
    };
    let shares = [0.1, 0.25, 0.5, 0.75].map(low);
    ranks.sort_unstable();
    if ranks != (0..count).collect::<Vec<_>>() {
        return Err("every rank from 0 to 4095 should occur once".into());
    }
    if shares.iter().any(|share| *share > 0.1) {
        let what = format!("low frequencies have {shares:?} of white noise's power");
        return Err(format!("{what}, expected at most 0.1").into());
    }
    Ok(())
}
