//! Source: Sousa, Kasyan and Schulz, 2011.

use super::{Arguments, Entry, Expected};

pub const REFERENCES: Entry = Entry {
    module: "shadow::contact",
    functions: &[("contact_hit", hit), ("march_point", march_point), ("edge_fade", edge_fade)],
};

fn hit(a: &mut Arguments<'_>) -> Expected {
    let (ray, scene, bias, thickness) = (a.f64(), a.f64(), a.f64(), a.f64());
    (ray > scene + bias && ray < scene + thickness).into()
}

fn march_point(a: &mut Arguments<'_>) -> Expected {
    let (start, l, reach, index, count, jitter) =
        (a.vec3(), a.vec3(), a.f64(), a.f64(), a.f64(), a.f64());
    (start + l * reach * (index + jitter) / count.max(1.0)).into()
}

/// The least distance to the four edges over the width of the fade.
fn edge_fade(a: &mut Arguments<'_>) -> Expected {
    let (uv, border) = (a.vec2(), a.f64());
    let nearest = [uv.x, 1.0 - uv.x, uv.y, 1.0 - uv.y].into_iter().fold(1.0, f64::min);
    if nearest <= 0.0 {
        return 0.0.into();
    }
    if nearest >= border { 1.0.into() } else { (nearest / border).into() }
}
