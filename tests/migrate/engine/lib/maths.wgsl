#define_import_path engine::maths::basic

// A comment that quotes `#ifdef SPOT` and /* nests */.
fn square(x: f32) -> f32 { return x * x; }

#ifdef FAST
fn root(x: f32) -> f32 { return x * inverseSqrt(x); }
#else ifdef ROUGH
fn root(x: f32) -> f32 { return x; }
#else
fn root(x: f32) -> f32 { return sqrt(x); }
#endif
