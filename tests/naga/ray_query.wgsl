enable wgpu_ray_query;
@group(0) @binding(0) var acc: acceleration_structure;
@fragment fn fs_main() -> @location(0) vec4f { var q: ray_query; rayQueryInitialize(&q, acc, RayDesc(0, 0xff, 0, 1, vec3f(0), vec3f(1))); return vec4f(select(0.0, 1.0, rayQueryProceed(&q))); }
