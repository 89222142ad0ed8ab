// What the modules of the engine share.
#define_import_path engine::types

struct Light {
    colour: vec3<f32>, // linear
#ifdef SPOT
    axis: vec3<f32>,
    #ifdef SOFT
    inner: f32,
    #endif
    outer: f32,
#else
    radius: f32,
#endif
    /* the last one */ intensity: f32
#ifdef TINTED
    , tint: vec3<f32>
#endif
}

const PI: f32 = 3.14159;
