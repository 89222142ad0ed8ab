//! The tables that techniques read, from first principles: `cargo xtask tables`.
//!
//! Each table becomes `NAME.bin` (32-bit floats, little-endian, row by row), `NAME.ktx2` (the same
//! as a texture) and `NAME.toml` (what it is, and how far off it is at most). Columns are of
//! perceptual roughness, rows of the viewer's cosine, as `lighting::area::ltc_uv` reads them.
//!
//! `cargo xtask tables --check` computes every cell of the files again by a finer rule, and fails
//! if one is further off than its description says. `cargo xtask fit` prints the coefficients of a
//! function that is fitted to one of them.

#![allow(clippy::print_stdout, clippy::print_stderr)]

mod dfg;
mod fit;
mod header;
mod ktx2;
mod ltc;
mod noise;
mod quadrature;
mod sheen;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Cells along each side.
pub const SIDE: usize = 64;

/// For every table, surfaces smoother than this are mirrors.
pub const LEAST_ALPHA: f64 = 1e-4;

/// One table.
pub struct Table {
    pub name: &'static str,
    pub about: &'static str,
    pub source: &'static str,
    /// What each channel is.
    pub channels: &'static [&'static str],
    make: fn() -> Vec<Vec<f64>>,
    /// The errors of the values that are shipped.
    errors: fn(&[f32]) -> Errors,
}

/// How far a table is off.
pub struct Errors {
    pub text: String,
    /// The worst of each column, rounded up. A table whose errors do not depend on the column has
    /// one number, an exact one has none.
    pub worst: Vec<f64>,
    /// For a table whose last row, of a viewer on the horizon, is worse: that row by itself.
    pub horizon: Vec<f64>,
}

const TABLES: &[Table] = &[
    Table {
        name: "blue_noise",
        about: "Ranks of the cells of a square that repeats: the cells below any threshold are spread evenly",
        source: "Ulichney, \"The Void-and-Cluster Method for Dither Array Generation\", 1993",
        channels: &["rank over the number of cells, in (0, 1)"],
        make: noise::rows,
        errors: |_| Errors {
            text: "none: every rank is there once".to_owned(),
            worst: Vec::new(),
            horizon: Vec::new(),
        },
    },
    Table {
        name: "dfg",
        about: "Directional albedo of GGX with Smith's correlated visibility: f0 times the first, plus f90 times the second",
        source: "Karis, \"Real Shading in Unreal Engine 4\", 2013; Heitz, \"Understanding the Masking-Shadowing Function in Microfacet-Based BRDFs\", 2014, equation 99",
        channels: &["scale of f0, in [0, 1]", "scale of f90, in [0, 1]"],
        make: || cells(dfg::cell),
        errors: |values| worst(values, |at| dfg::albedo(at.nv(), at.alpha(), 200).to_vec()),
    },
    Table {
        name: "ltc",
        about: "Linearly transformed cosines of that lobe without Fresnel's term: what `lighting::area::ltc_matrix` takes",
        source: "Heitz, Dupuy, Hill, Neubelt, \"Real-Time Polygonal-Light Shading with Linearly Transformed Cosines\", 2016",
        channels: &[
            "inverse matrix: x of the first column",
            "z of the first column",
            "x of the third column",
            "z of the third column",
        ],
        make: ltc::rows,
        errors: misplaced,
    },
    Table {
        name: "sheen",
        about: "Directional albedo of cloth: Charlie's distribution with either visibility",
        source: "Estevez, Kulla, \"Production Friendly Microfacet Sheen BRDF\", 2017",
        channels: &["with `v_neubelt`", "with `v_charlie`"],
        make: || cells(sheen::cell),
        errors: |values| worst(values, |at| sheen::albedo(at.nv(), at.alpha(), 200).to_vec()),
    },
];

/// A cell. Its column belongs to a roughness, its row to a viewer.
#[derive(Debug, Clone, Copy)]
pub struct Cell {
    column: usize,
    row: usize,
}

impl Cell {
    /// Its index among the values.
    fn index(self) -> usize {
        self.row * SIDE + self.column
    }

    /// The width of the lobe: the square of the perceptual roughness.
    pub fn alpha(self) -> f64 {
        (share(self.column) * share(self.column)).max(LEAST_ALPHA)
    }

    /// Cosine between the normal and the viewer, [1e-4, 1].
    pub fn nv(self) -> f64 {
        (1.0 - share(self.row) * share(self.row)).max(1e-4)
    }
}

/// Texels are read at their centres, so both ranges end at the centres of the outermost texels.
fn share(index: usize) -> f64 {
    index as f64 / (SIDE - 1) as f64
}

fn cells(of: fn(Cell) -> Vec<f64>) -> Vec<Vec<f64>> {
    by_rows(&of)
}

/// Computes something for every cell. Each core takes a part of the rows.
fn by_rows<T: Send>(of: &(dyn Fn(Cell) -> T + Sync)) -> Vec<T> {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let rows: Vec<usize> = (0..SIDE).collect();
    let part = |rows: &[usize]| -> Vec<T> {
        let cells = rows.iter().flat_map(|row| (0..SIDE).map(|column| Cell { column, row: *row }));
        cells.map(of).collect()
    };
    std::thread::scope(|scope| {
        let parts: Vec<_> =
            rows.chunks(SIDE.div_ceil(cores)).map(|rows| scope.spawn(move || part(rows))).collect();
        parts.into_iter().flat_map(|part| part.join().unwrap_or_default()).collect()
    })
}

/// The largest difference of a shipped value from a finer rule's.
fn worst(values: &[f32], finer: fn(Cell) -> Vec<f64>) -> Errors {
    let wanted = by_rows(&finer).into_iter().flatten();
    let apart = values.iter().zip(wanted).map(|(found, wanted)| (f64::from(*found) - wanted).abs());
    let most = apart.fold(0.0, f64::max);
    Errors {
        text: format!("at most {most:.1e}, against a rule with more than twice as many nodes"),
        worst: vec![rounded_up(most, 1e5)],
        horizon: Vec::new(),
    }
}

fn rounded_up(value: f64, steps: f64) -> f64 {
    (value * steps).ceil() / steps
}

/// The share of light that the fits put in the wrong place: the largest, and the mean.
fn misplaced(values: &[f32]) -> Errors {
    let share = |at: Cell| {
        let start = 4 * at.index();
        let numbers = [0, 1, 2, 3].map(|i| f64::from(values[start + i]));
        let [scale, offset] = dfg::albedo(at.nv(), at.alpha(), 96);
        ltc::misplaced(numbers, scale + offset, at)
    };
    let shares = by_rows(&share);
    let (above, horizon) = shares.split_at(SIDE * (SIDE - 1));
    let most = |shares: &[f64]| 100.0 * shares.iter().copied().fold(0.0, f64::max);
    let mean = 100.0 * shares.iter().sum::<f64>() / shares.len() as f64;
    let column =
        |column: usize| above.iter().skip(column).step_by(SIDE).copied().fold(0.0, f64::max);
    Errors {
        text: format!(
            "of a lobe's light {mean:.1} % lies elsewhere in the fit on average, at most {:.1} %, and {:.1} % \
             in the last row, of a viewer on the horizon",
            most(above),
            most(horizon)
        ),
        worst: (0..SIDE).map(|index| rounded_up(column(index), 1e3)).collect(),
        horizon: horizon.iter().map(|share| rounded_up(*share, 1e3)).collect(),
    }
}

/// Makes one table and writes its files.
fn make(folder: &Path, table: &Table) -> Result<(), String> {
    let values: Vec<f32> = (table.make)().into_iter().flatten().map(|value| value as f32).collect();
    let errors = (table.errors)(&values);
    let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
    let texture = ktx2::file(table, &values).ok_or("no format has so many channels")?;
    let header = header::header_text(table, &errors, &bytes);
    let files = [("bin", bytes), ("ktx2", texture), ("toml", header.into_bytes())];
    for (extension, bytes) in files {
        let path = folder.join(format!("{}.{extension}", table.name));
        lamplight::output::write(&path, &bytes).map_err(|error| error.to_string())?;
    }
    println!("{}: {}", table.name, errors.text);
    Ok(())
}

/// Compares the files of one table with each other, and its errors with those that are published.
/// Its description must be what is computed now, so no error may be larger.
fn check_table(folder: &Path, table: &Table) -> Result<(), String> {
    let read = |extension: &str| {
        let path = folder.join(format!("{}.{extension}", table.name));
        std::fs::read(&path).map_err(|error| format!("{}: {error}", path.display()))
    };
    let bytes = read("bin")?;
    let (words, rest) = bytes.as_chunks::<4>();
    let values: Vec<f32> = words.iter().map(|word| f32::from_le_bytes(*word)).collect();
    if values.len() != SIDE * SIDE * table.channels.len() || !rest.is_empty() {
        return Err(format!("{}.bin has {} bytes", table.name, bytes.len()));
    }
    if ktx2::file(table, &values) != Some(read("ktx2")?) {
        return Err(format!("{}.ktx2 has other values than {}.bin", table.name, table.name));
    }
    let published = String::from_utf8_lossy(&read("toml")?).into_owned();
    let errors = (table.errors)(&values);
    header::check_header(&published, &errors, &bytes)
        .map_err(|error| format!("{}: {error}", table.name))?;
    println!("{}: {}, as published", table.name, errors.text);
    Ok(())
}

/// `FOLDER [--check] [NAME]...`: writes, or checks, all tables or those that are named.
/// `--fit`: prints coefficients.
fn main() -> ExitCode {
    let mut arguments = std::env::args().skip(1);
    let Some(folder) = arguments.next().map(PathBuf::from) else {
        eprintln!("usage: lamplight-tables FOLDER [--check] [NAME]..., or --fit");
        return ExitCode::from(2);
    };
    if folder == Path::new("--fit") {
        print!("{}", fit::report());
        return ExitCode::SUCCESS;
    }
    let mut names: Vec<String> = arguments.collect();
    let is_check = names.iter().any(|name| name == "--check");
    names.retain(|name| name != "--check");
    if let Some(name) = names.iter().find(|name| TABLES.iter().all(|table| table.name != **name)) {
        let known: Vec<&str> = TABLES.iter().map(|table| table.name).collect();
        eprintln!("there is no table `{name}`; there are: {}", known.join(", "));
        return ExitCode::from(2);
    }
    let is_wanted =
        |table: &&Table| names.is_empty() || names.iter().any(|name| name == table.name);
    for table in TABLES.iter().filter(is_wanted) {
        let work = if is_check { check_table } else { make };
        if let Err(reason) = work(&folder, table) {
            eprintln!("{reason}");
            return ExitCode::from(1);
        }
    }
    ExitCode::SUCCESS
}
