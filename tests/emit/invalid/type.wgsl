fn f(x: f32) -> f32 {
    let y: u32 = x;
    return x;
}
