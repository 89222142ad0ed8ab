struct Block_1_ { gl_Color: vec4f, a__b: f32 }
@group(0) @binding(0) var<uniform> block__1: Block_1_;
fn gl_helper(x__y: f32) -> f32 { return x__y; }
@fragment fn fs_main() -> @location(0) vec4f { return block__1.gl_Color * gl_helper(block__1.a__b); }
