@fragment fn fs_main(@location(0) @interpolate(flat) i: vec2i) -> @location(0) vec4f {
    let b = array<vec3f, 2>(vec3f(1, 2, 3), vec3f(4, 5, 6));
    var poly = vec4f(0);
    poly.x += b[i.x].y * b[i.y].z;
    return poly;
}
