//! The files of the shader library, for programs that carry it with them.
//!
//! # Conventions
//!
//! - `n`, `l`, `v` and `h` are unit vectors. `l` and `v` point away from the surface. The `axis` of
//!   a spot light points from the light into the scene, and `c = dot(-l, axis)`.
//! - Colours are linear, and distances are in scene units. An angle that a shader compares is given
//!   as its cosine; other angles are in radians.
//! - Visibility and the spot factor are in [0, 1], where 1 means fully lit. Attenuation is at least
//!   0; a physical falloff such as `inverse_square` is above 1 near the light. The light loop
//!   multiplies the three; no function combines them earlier.
//! - Depth is in [0, 1] from near to far, unless it is reversed. The z of normalised device
//!   coordinates is in [0, 1]. Only `shadow::project` and one host function handle the ranges of
//!   OpenGL.
//! - Functions are pure: they use no bindings and no global variables. Shadow lookups take the
//!   texture and the sampler as parameters.
//! - Results are finite for finite arguments up to 1e9 in magnitude, whether they have a meaning or
//!   not: zero vectors, negative parameters, cosines above 1. The line `Edges:` says what they are,
//!   for each parameter whose description does not allow any value
//!   (`tests/shaderlib/documented.rs`). `lamplight check` checks every function by this law
//!   (`finite`). A case that narrows it gives a reason: forms that reproduce a published flaw, and
//!   parts of other functions. NaN is left open, as WGSL leaves it.
//! - A name without a suffix is the numerically safe form. A name with the suffix `_oglpg`, `_hpg`,
//!   `_ncl` or `_igl` reproduces a published form, including its flaws.

include!(concat!(env!("OUT_DIR"), "/files.rs"));

/// The version of the library.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
