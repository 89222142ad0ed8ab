diagnostic(off, derivative_uniformity);
enable f16;
enable f16, dual_source_blending;
diagnostic(info, derivative_uniformity);

// package::m

const h = 1h;

// package::main

fn main() -> f16 { return h; }
