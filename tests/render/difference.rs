//! Measures how different two pictures look.
//!
//! Both are blurred over three by three pixels, since nobody sees an edge that moved by part of a
//! pixel. They are compared in CIELAB (1976, D65), where a distance of about 2 is just noticeable.

use std::path::PathBuf;

use lamplight::picture::Picture;

use super::{read, reviewed_path};

/// The largest mean distance of pictures that look alike.
const MEAN: f64 = 0.6;
/// The largest distance of pixels in pictures that look alike, apart from 1 % of the pixels.
const MOST: f64 = 4.0;

/// The distances of the pixels of two pictures.
pub struct Difference {
    width: u32,
    height: u32,
    distances: Vec<f64>,
}

impl Difference {
    pub fn new(a: &Picture, b: &Picture) -> Result<Self, String> {
        if (a.width, a.height) != (b.width, b.height) {
            return Err(format!(
                "one picture has {} x {} pixels, the other {} x {}",
                a.width, a.height, b.width, b.height
            ));
        }
        let (lab_a, lab_b) = (seen(a), seen(b));
        let distance = |(a, b): (&[f64; 3], &[f64; 3])| {
            (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
        };
        let distances = lab_a.iter().zip(&lab_b).map(distance).collect();
        Ok(Self { width: a.width, height: a.height, distances })
    }

    pub fn mean(&self) -> f64 {
        self.distances.iter().sum::<f64>() / self.distances.len() as f64
    }

    /// The distance that 99 % of the pixels do not exceed.
    pub fn most(&self) -> f64 {
        let mut sorted = self.distances.clone();
        sorted.sort_by(f64::total_cmp);
        sorted[sorted.len() * 99 / 100]
    }

    /// The share of the pixels whose distance is larger than another.
    pub fn share(&self, distance: f64) -> f64 {
        let count = self.distances.iter().filter(|found| **found > distance).count();
        count as f64 / self.distances.len() as f64
    }

    pub fn is_visible(&self) -> bool {
        !(self.mean() <= MEAN && self.most() <= MOST)
    }

    /// The distances as a picture, which is white where the distance is 10 or more.
    fn picture(&self) -> Picture {
        let byte = |distance: &f64| [(distance * 25.5).min(255.0) as u8; 3];
        Picture {
            width: self.width,
            height: self.height,
            pixels: self.distances.iter().flat_map(byte).collect(),
        }
    }
}

/// The blurred picture in CIELAB.
fn seen(picture: &Picture) -> Vec<[f64; 3]> {
    let linear: Vec<[f64; 3]> =
        picture.pixels.chunks(3).map(|rgb| [0, 1, 2].map(|i| decoded(rgb[i]))).collect();
    let (width, height) = (picture.width as usize, picture.height as usize);
    let at = |x: usize, y: usize| linear[y * width + x];
    let blurred = |index: usize| {
        let (x, y) = (index % width, index / width);
        let (mut sum, mut count) = ([0.0; 3], 0.0);
        for (i, j) in (y.saturating_sub(1)..(y + 2).min(height))
            .flat_map(|j| (x.saturating_sub(1)..(x + 2).min(width)).map(move |i| (i, j)))
        {
            (0..3).for_each(|channel| sum[channel] += at(i, j)[channel]);
            count += 1.0;
        }
        sum.map(|channel| channel / count)
    };
    (0..linear.len()).map(|index| lab(blurred(index))).collect()
}

fn decoded(byte: u8) -> f64 {
    let encoded = f64::from(byte) / 255.0;
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

fn lab([r, g, b]: [f64; 3]) -> [f64; 3] {
    let x = (0.4124 * r + 0.3576 * g + 0.1805 * b) / 0.9505;
    let y = 0.2126 * r + 0.7152 * g + 0.0722 * b;
    let z = (0.0193 * r + 0.1192 * g + 0.9505 * b) / 1.089;
    let f =
        |t: f64| if t > 216.0 / 24389.0 { t.cbrt() } else { (24389.0 / 27.0 * t + 16.0) / 116.0 };
    [116.0 * f(y) - 16.0, 500.0 * (f(x) - f(y)), 200.0 * (f(y) - f(z))]
}

/// Whether pictures and pages that differ are recorded.
pub fn is_recorded() -> bool {
    std::env::var("INSTA_UPDATE").is_ok_and(|update| update == "always")
}

/// Fails unless a picture looks like the reviewed one of its name. Then it leaves a picture of both,
/// and of their difference, in the folder of temporary files. `INSTA_UPDATE=always` records Vulkan's
/// picture as the reviewed one.
pub fn reviewed(picture: &Picture, name: &str, backend: &str) -> Result<(), String> {
    let known = read(&reviewed_path(name));
    let is_known = known.as_ref().is_ok_and(|known| {
        Difference::new(known, picture).is_ok_and(|difference| !difference.is_visible())
    });
    if is_recorded() && backend == "vulkan" && !is_known {
        let written = lamplight::output::write(&reviewed_path(name), &picture.png()?);
        return written.map_err(|error| error.to_string());
    }
    let wanted = known?;
    let difference = Difference::new(&wanted, picture)?;
    if !difference.is_visible() {
        return Ok(());
    }
    let path = PathBuf::from(env!("CARGO_TARGET_TMPDIR"))
        .join("render")
        .join(format!("{name}.{backend}.png"));
    let shown = side_by_side(&[&wanted, picture, &difference.picture()]);
    lamplight::output::write(&path, &shown.png()?).map_err(|error| error.to_string())?;
    Err(format!(
        "{name} looks different from the reviewed picture: {:.2} on average, {:.1} for all but 1 %; see {} (reviewed, drawn, difference)",
        difference.mean(),
        difference.most(),
        path.display()
    ))
}

/// Pictures of the same size, side by side.
fn side_by_side(pictures: &[&Picture]) -> Picture {
    let (width, height) = (pictures[0].width, pictures[0].height);
    let row = |y: u32| {
        pictures.iter().flat_map(move |picture| {
            &picture.pixels[(y * width * 3) as usize..((y + 1) * width * 3) as usize]
        })
    };
    let pixels = (0..height).flat_map(row).copied().collect();
    Picture { width: width * pictures.len() as u32, height, pixels }
}
