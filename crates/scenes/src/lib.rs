//! What pictures show: shapes, environments and scenes, all made by formulas, and models in glTF.
//!
//! Units and spaces are those of `lamplight-scene`.

mod bulbs;
mod chessmen;
mod environment;
mod field;
mod interior;
mod lathe;
mod layers;
mod maps;
#[cfg(not(target_family = "wasm"))]
pub mod model;
mod palette;
mod rays;
pub mod sets;
mod shape;

pub use environment::{ENVIRONMENTS, Environment, environment};
pub use field::{PROBE_SIDES, ProbeField, ProbeGrid};
pub use layers::Layers;
pub use maps::{between_middles, luminaire, window};
pub use maps::{blank_texel, brick_materials, bricks, linear_from_srgb};
pub use rays::{Hit, Look, Surfaces};
pub use shape::{Shape, Vertex};
