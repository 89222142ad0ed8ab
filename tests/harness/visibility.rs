//! Fragment stages that decide themselves what is visible: they discard fragments, or write depth.

use lamplight::execute::Session;
use lamplight::execute::frame::{
    Buffers, DrawItem, Drawing, EntryPoint, Mesh, PipelineState, VertexAttribute, VertexFormat,
};
use lamplight::execute::kernel::SENTINEL;
use std::collections::BTreeMap;

/// Every fragment of a triangle has its depth, and returns its number.
const PROGRAM: &str = "
struct Between { @builtin(position) position: vec4f, @location(0) @interpolate(flat) number: u32 }
struct Written { @location(0) words: vec4u, @builtin(frag_depth) depth: f32 }

@vertex fn corner(@location(0) at: vec3f, @location(1) number: u32) -> Between {
    return Between(vec4f(at, 1.0), number);
}

fn drop_some(between: Between) {
    let tile = vec2u(between.position.xy) / 2u;
    if (tile.x + between.number * tile.y) % 3u == 0u {
        discard;
    }
}

fn depth_of(between: Between) -> f32 {
    return fract(between.position.x / 16.0 + f32(between.number) * 0.375) * 1.5 - 0.25;
}

@fragment fn holes(between: Between) -> @location(0) vec4u {
    drop_some(between);
    return vec4u(between.number, 0u, 0u, 7u);
}

@fragment fn waves(between: Between) -> Written {
    return Written(vec4u(between.number, 0u, 0u, 7u), depth_of(between));
}

@fragment fn both(between: Between) -> Written {
    drop_some(between);
    return Written(vec4u(between.number, 0u, 0u, 7u), depth_of(between));
}";

const SIZE: [u32; 2] = [18, 10];
/// The number and the depth of each triangle, in the order in which they are drawn. All of them
/// cover the frame.
const TRIANGLES: [(u32, f32); 3] = [(1, 0.75), (2, 0.25), (3, 0.5)];
const STAGES: [(&str, bool, bool); 3] =
    [("holes", true, false), ("waves", false, true), ("both", true, true)];

/// An executor shows what is behind discarded fragments, and tests with the depth that is written.
pub fn holds(session: &dyn Session) -> Result<(), String> {
    let module = naga::front::wgsl::parse_str(PROGRAM).map_err(|error| error.to_string())?;
    let (mesh, none) = (mesh(), Buffers::new());
    for (entry, drops, writes) in STAGES {
        // Without a depth test there is no depth to write or to keep.
        for depth_test in [true, false].into_iter().filter(|tests| *tests || !writes) {
            let stage = |entry| EntryPoint { module: &module, entry };
            let fixtures = BTreeMap::new();
            let items = [DrawItem { mesh: &mesh, buffers: &none }];
            let state = PipelineState { depth_test, keep_depth: depth_test, ..Default::default() };
            let of_items =
                Drawing::of_items([stage("corner"), stage(entry)], &items, &fixtures, SIZE);
            let drawing = Drawing { state, ..of_items };
            let frame = session.draw_frames(&drawing).map_err(|problem| problem.message)?.remove(0);
            for pixel in 0..SIZE[0] * SIZE[1] {
                let place = [pixel % SIZE[0], pixel / SIZE[0]];
                let (number, depth) = expected(place, drops, writes, depth_test);
                let words = &frame.targets[0][4 * pixel as usize..][..4];
                let wanted = number.map_or([SENTINEL; 4], |number| [number, 0, 0, 7]);
                let stored = frame.depth.get(pixel as usize).copied();
                let is_kept = |stored: f32| (stored - depth).abs() <= 1e-6;
                if words != wanted || stored.is_some() != depth_test || !stored.is_none_or(is_kept)
                {
                    return Err(format!(
                        "`{entry}` with depth test {depth_test}, pixel {place:?}: {words:?} at \
                         depth {stored:?}, expected {wanted:?} at depth {depth}"
                    ));
                }
            }
        }
    }
    Ok(())
}

/// Three triangles over the whole frame.
fn mesh() -> Mesh {
    let corners = [[-1.0f32, -1.0], [3.0, -1.0], [-1.0, 3.0]];
    let attribute = |location, format| VertexAttribute { location, format };
    let vertex = |(number, depth): (u32, f32)| {
        corners.map(|[x, y]| [x.to_bits(), y.to_bits(), depth.to_bits(), number])
    };
    Mesh {
        attributes: vec![attribute(0, VertexFormat::Float32x3), attribute(1, VertexFormat::Uint32)],
        words: TRIANGLES.into_iter().flat_map(vertex).flatten().collect(),
        indices: Vec::new(),
    }
}

/// The triangle that a pixel shows, and its depth.
fn expected([x, y]: [u32; 2], drops: bool, writes: bool, depth_test: bool) -> (Option<u32>, f32) {
    let mut shown = (None, 1.0);
    for (number, own) in TRIANGLES {
        if drops && (x / 2 + number * (y / 2)).is_multiple_of(3) {
            continue;
        }
        let wave = ((x as f32 + 0.5) / 16.0 + number as f32 * 0.375).fract() * 1.5 - 0.25;
        let depth = if writes { wave.clamp(0.0, 1.0) } else { own };
        if !depth_test || depth < shown.1 {
            shown = (Some(number), depth);
        }
    }
    shown
}
