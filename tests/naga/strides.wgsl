struct P { x: array<array<vec3f, 2>, 3>, y: f32 }
@group(0) @binding(0) var<storage> p: P;
@group(0) @binding(1) var<storage, read_write> q: array<P>;
@compute @workgroup_size(1) fn cs_main(@builtin(global_invocation_id) i: vec3u) {
    let all = p; let x = p.x; let row = p.x[i.x];
    q[i.y] = all; q[1].x = x; q[2].x[i.z] = row; q[3].y = f32(arrayLength(&q));
}
