@fragment fn m(@location(0) x: vec4f) -> @location(0) vec4f { return vec4f(x.xyzw > vec4f(1) && x < vec4f(2)); }
