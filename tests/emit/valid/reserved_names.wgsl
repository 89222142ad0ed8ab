// Names that are keywords of other languages, `main` included.
struct constant { @location(0) buffer: vec4<f32> }
fn smooth_(texture: f32) -> f32 { return texture * 2.0; }
@fragment
fn main(@location(0) float: f32, @location(1) out_: vec2<f32>) -> constant {
    let sample = smooth_(float);
    return constant(vec4(sample, out_, 1.0));
}
