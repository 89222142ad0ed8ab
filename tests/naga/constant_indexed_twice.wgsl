@vertex fn vs_main(@builtin(vertex_index) i: u32) -> @builtin(position) vec4f {
    const positions = array(vec2(-1.0, -1.0), vec2(-1.0, 1.0), vec2(1.0, -1.0));
    return vec4f(positions[i], positions[i] / 2 + 0.5);
}
