@fragment
fn main(@location(0) in: vec4f) -> @location(0) vec4f {
    var color = in.rgb;
    // Rotate the hue.
        let turned = color.gbr;
        // Twice.
        color = turned.gbr;

        color = color.brg;
    color = vec3f(dot(turned, vec3f(0.3)));
    {
        let color = 1.0;
    }
    if (color.x > 1.0) {
            discard;
    }
    return vec4f(color, in.a);
}
