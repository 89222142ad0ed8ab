#define DEPTH 3
#ifdef FOG
fn far() -> f32 { return 9.0; }
