//! Cells of the tables from every column, and the limit of smooth surfaces. Which row of a column is
//! taken depends on the table's hash, so another table has another sample.

use std::f64::consts::PI;
use std::fs;

use libtest_mimic::Failed;

use super::{Direction, Outcome, SIDE, cell, folder, ggx, values, viewer};

/// Rings and azimuths of the half vectors.
const STEPS: usize = 256;

/// A table's hash, from its file.
pub fn hash_of(name: &str) -> Result<blake3::Hash, Failed> {
    Ok(blake3::hash(&fs::read(folder().join(format!("{name}.bin")))?))
}

/// One cell of each column. Rows whose viewer is at the horizon are left out.
fn sampled_cells(name: &str) -> Result<Vec<(usize, usize)>, Failed> {
    let hash = hash_of(name)?;
    let row = |column: usize| {
        let index = column % (hash.as_bytes().len() / 2);
        let [low, high] = [hash.as_bytes()[2 * index], hash.as_bytes()[2 * index + 1]];
        (usize::from(low) + 256 * usize::from(high) + 29 * column) % (SIDE - 1)
    };
    Ok((0..SIDE).map(|column| (column, row(column))).collect())
}

/// The published error of each column. A single one holds for all columns.
fn published_errors(name: &str) -> Result<Vec<f64>, Failed> {
    let description: toml::Table =
        fs::read_to_string(folder().join(format!("{name}.toml")))?.parse()?;
    let worst = description.get("worst").and_then(|worst| worst.as_array()).ok_or("no `worst`")?;
    let worst: Vec<f64> = worst.iter().filter_map(toml::Value::as_float).collect();
    match worst[..] {
        [one] => Ok(vec![one; SIDE]),
        _ if worst.len() == SIDE => Ok(worst),
        _ => Err(format!("{name}: `worst` has {} numbers", worst.len()).into()),
    }
}

/// Directions of light that half vectors mirror to a viewer, with their solid angles and half
/// vectors. For a number in [0, 1], `cosine` gives the half vector's cosine, and the derivative by
/// which the solid angle is scaled.
fn mirrored_lights(
    v: Direction,
    cosine: impl Fn(f64) -> (f64, f64),
) -> impl Iterator<Item = (Direction, f64, Direction)> {
    (0..STEPS * STEPS).filter_map(move |index| {
        let (z, slope) = cosine(((index / STEPS) as f64 + 0.5) / STEPS as f64);
        let azimuth = PI * ((index % STEPS) as f64 + 0.5) / STEPS as f64;
        let s = (1.0 - z * z).max(0.0).sqrt();
        let h = [s * azimuth.cos(), s * azimuth.sin(), z];
        let vh = v[0] * h[0] + v[2] * h[2];
        let l = [0, 1, 2].map(|i| 2.0 * vh * h[i] - v[i]);
        let size = 4.0 * vh * slope.abs() * 2.0 * PI / (STEPS * STEPS) as f64;
        (vh > 0.0 && l[2] > 0.0).then_some((l, size, h))
    })
}

/// Half vectors with the slope `alpha * r / (1 - r)`, so that most of them are where a lobe of this
/// alpha has its facets.
fn by_slopes(alpha: f64) -> impl Fn(f64) -> (f64, f64) {
    move |r| {
        let slope = alpha * r / (1.0 - r);
        let z = 1.0 / slope.hypot(1.0);
        (z, z.powi(3) * slope * alpha / (1.0 - r).powi(2))
    }
}

/// Cells of `dfg` are the albedo of GGX with Schlick's term, integrated over the half vectors'
/// slopes.
pub fn dfg() -> Outcome {
    let (table, errors) = (values("dfg", 2)?, published_errors("dfg")?);
    for (column, row) in sampled_cells("dfg")? {
        let (alpha, nv) = cell(column, row);
        let (alpha, v) = (alpha.max(1e-4), viewer(nv));
        let mut wanted = [0.0; 2];
        for (l, size, h) in mirrored_lights(v, by_slopes(alpha)) {
            let all = ggx(v, l, alpha) * size;
            let grazing = (1.0 - (v[0] * h[0] + v[2] * h[2])).powi(5);
            wanted = [wanted[0] + all * (1.0 - grazing), wanted[1] + all * grazing];
        }
        compare_cell(&table, (column, row), wanted, errors[column] + 5e-4)?;
    }
    Ok(())
}

/// Cells of `sheen` are the albedos of both lobes of cloth, integrated over the half vectors'
/// cosines.
pub fn sheen() -> Outcome {
    let (table, errors) = (values("sheen", 2)?, published_errors("sheen")?);
    for (column, row) in sampled_cells("sheen")? {
        let (alpha, nv) = cell(column, row);
        let (alpha, v) = (alpha.max(1e-3), viewer(nv));
        let most = (9.0 * alpha.sqrt()).min(1.0);
        let mut wanted = [0.0; 2];
        for (l, size, h) in mirrored_lights(v, |r| (most * r, most)) {
            let both = super::cloth_lobe(l[2], nv, h[2], alpha);
            wanted = [0, 1].map(|i| wanted[i] + both[i] * size);
        }
        compare_cell(
            &table,
            (column, row),
            wanted,
            errors[column] + 2e-3 * (1.0 + wanted[0].max(wanted[1])),
        )?;
    }
    Ok(())
}

fn compare_cell(
    table: &[f64],
    (column, row): (usize, usize),
    wanted: [f64; 2],
    within: f64,
) -> Outcome {
    let found = &table[2 * (row * SIDE + column)..][..2];
    match wanted.iter().zip(found).all(|(wanted, found)| (wanted - found).abs() <= within) {
        true => Ok(()),
        false => {
            Err(format!("cell {column}, {row}: {found:?}, expected {wanted:?} within {within}")
                .into())
        }
    }
}

/// The light that the fits put elsewhere is no more than is published for their column.
pub fn ltc() -> Outcome {
    let (table, albedos, errors) = (values("ltc", 4)?, values("dfg", 2)?, published_errors("ltc")?);
    for (column, row) in sampled_cells("ltc")? {
        let (alpha, nv) = cell(column, row);
        let (alpha, v, index) = (alpha.max(1e-4), viewer(nv), row * SIDE + column);
        let albedo = albedos[2 * index] + albedos[2 * index + 1];
        let [a, b, c, d] = [0, 1, 2, 3].map(|part| table[4 * index + part]);
        let mut apart = 0.0;
        for (l, size, _) in mirrored_lights(v, by_slopes(alpha)) {
            let original = [a * l[0] + c * l[2], l[1], b * l[0] + d * l[2]];
            let length = original.iter().map(|part| part * part).sum::<f64>().sqrt();
            let fit = albedo * original[2].max(0.0) / PI * (a * d - b * c) / length.powi(4);
            apart += (fit - ggx(v, l, alpha)).abs() * size;
        }
        let misplaced = 0.5 * apart / albedo;
        if misplaced > errors[column] + 0.001 {
            let most = errors[column];
            return Err(format!(
                "cell {column}, {row}: {misplaced:.4} of the light is elsewhere, at most {most} is published"
            )
            .into());
        }
    }
    mirror_limit(&table)
}

/// The limit of smooth surfaces. A facet whose normal turns by an angle turns the mirrored light by
/// twice this angle in the plane of the viewer, and by this times the viewer's cosine across it. So
/// the lobe's axis becomes the mirrored direction, and its widths 2*alpha and 2*alpha*n.v.
fn mirror_limit(table: &[f64]) -> Outcome {
    for (row, column) in (0..SIDE - 1).flat_map(|row| (0..4).map(move |column| (row, column))) {
        let (alpha, nv) = cell(column, row);
        let (alpha, v) = (alpha.max(1e-4), viewer(nv));
        let [a, b, c, d] = [0, 1, 2, 3].map(|part| table[4 * (row * SIDE + column) + part]);
        // The axis is the third column of the matrix whose inverse is in the table, and the inverse's
        // last row is the axis again, times the width across, since the middle entry is 1.
        let off = (f64::atan2(-c, a) - f64::atan2(-v[0], v[2])).abs();
        let across = b.hypot(d);
        let along = across * across / (a * d - b * c);
        let is_near = |found: f64, wanted: f64| (found / wanted - 1.0).abs() < 0.02;
        if off > 0.03 * alpha || !is_near(along, 2.0 * alpha) || !is_near(across, 2.0 * alpha * nv)
        {
            return Err(format!(
                "cell {column}, {row}, alpha {alpha}: the axis is off by {off} rad, the widths are \
                 {along} and {across}, expected {} and {}",
                2.0 * alpha,
                2.0 * alpha * nv
            )
            .into());
        }
    }
    Ok(())
}
