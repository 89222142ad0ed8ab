@group(0) @binding(0) var map: texture_2d<f32>;
@group(0) @binding(1) var smp: sampler;

fn bumps(at: vec2f) -> f32 {
    return dpdx(at.x * at.y) + fwidth(at.x);
}

@fragment fn fs(@location(0) a: vec4f, @location(1) b: vec4f) -> @location(0) vec4f {
    var sum = dpdx(a) + 2.0 * dpdy(b) + 3.0 * fwidth(a * b);
    sum.x += bumps(a.xy) + 2.0 * bumps(b.zw);
    // Only some fragments of a quad come here; those alone decide.
    if a.x > 0.5 {
        sum.y += dpdx(b.x);
    } else {
        sum.z += 3.0 * dpdy(b.y) + textureSample(map, smp, a.xy).x;
    }
    for (var i = 0; i < 3; i++) {
        sum.w += dpdx(sum.x * a.w) * f32(i);
    }
    return sum;
}
