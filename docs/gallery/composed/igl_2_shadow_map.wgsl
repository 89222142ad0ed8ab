// package::shadow::coord

/// The brightness Igalia's tutorial shows for a depth.
///
/// It differs from `linearize_depth` in that it is not linear in distance: it magnifies the last hundredth of the depths.
///
/// Parameters: `d` depth, [0, 1] from near to far.
/// Returns: `1 - (1 - d)*100`: in [0, 1] for d in [0.99, 1], below 0 before.
/// Source: Igalia, "Working with lights and shadows", part II: the shadow map.
/// Edges: not clamped.
/// Error model: absolute 2^-23*(1 + 100*|1 - d|).
fn depth_view_igl(d: f32) -> f32 {
    return 1.0 - (1.0 - d) * 100.0;
}

// package::programs::depth_view

@group(0) @binding(0) var depths: texture_2d<f32>;
@group(0) @binding(1) var depth_sampler: sampler;

/// From the corners to the fragments.
struct Varyings {
    @builtin(position) clip: vec4f,
    @location(0) uv: vec2f,
}

@vertex
fn vs_main(@builtin(vertex_index) corner: u32) -> Varyings {
    let uv = vec2f(f32(corner & 1u), f32(corner >> 1u)) * 2.0;
    return Varyings(vec4f(2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.y, 0.0, 1.0), uv);
}

@fragment
fn fs_main(in: Varyings) -> @location(0) vec4f {
    let depth = textureSampleLevel(depths, depth_sampler, in.uv, 0.0).x;
    let shade = depth_view_igl(depth);
    return vec4f(vec3f(shade), 1.0);
}
