//! Textures with something to see in them, for functions that are drawn by themselves.

use lamplight_execute::fixture::{FixtureTexture, TextureKind};

/// Texels in each direction.
const TEXELS: u32 = 64;

/// The depths of a fence of leaning posts, on a ground at depth 0.6. The lower a part of a post is
/// in the texture, the closer it is to the ground.
pub fn fence(kind: TextureKind) -> FixtureTexture {
    let depth = |index: u32| {
        let [x, y] = [index % TEXELS, index / TEXELS].map(|at| f64::from(at) / f64::from(TEXELS));
        let post = (x * 4.0 + y * 0.5 + 0.2).fract();
        if post < 0.4 && (0.12..0.9).contains(&y) { (0.2 + 0.35 * y) as f32 } else { 0.6 }
    };
    let texels = (0..TEXELS * TEXELS).flat_map(|index| vec![depth(index); kind.channels()]);
    FixtureTexture { kind, width: TEXELS, height: TEXELS, texels: texels.collect() }
}

/// Four columns around a lamp, at a quarter of the depth, on the four faces at its sides.
pub fn columns() -> FixtureTexture {
    let faces = TextureKind::DepthCube.layers();
    let depth = |index: u32| {
        let (face, x) = (index / (TEXELS * TEXELS), index % TEXELS);
        let is_side = face != 2 && face != 3;
        if is_side && (TEXELS * 3 / 8..TEXELS * 5 / 8).contains(&x) { 0.25 } else { 1.0 }
    };
    let texels = (0..faces * TEXELS * TEXELS).map(depth).collect();
    let kind = TextureKind::DepthCube;
    FixtureTexture { kind, width: TEXELS, height: TEXELS, texels }
}

/// Squares of four colours on black.
pub fn image() -> FixtureTexture {
    let color = |index: u32| {
        let [x, y] = [index % TEXELS, index / TEXELS];
        let [column, row] = [x / (TEXELS / 2), y / (TEXELS / 2)];
        let inside = [x, y].iter().all(|at| (8..24).contains(&(at % (TEXELS / 2))));
        let colors = [[0.9, 0.25, 0.1], [0.95, 0.8, 0.2], [0.1, 0.5, 0.9], [0.3, 0.8, 0.35]];
        let [r, g, b] = if inside { colors[(2 * row + column) as usize % 4] } else { [0.0; 3] };
        [r, g, b, 1.0]
    };
    let texels = (0..TEXELS * TEXELS).flat_map(color).collect();
    let kind = TextureKind::Color2d;
    FixtureTexture { kind, width: TEXELS, height: TEXELS, texels }
}
