//! The mathematics of lighting for the host: matrices of lights, bounds fitted around what is seen,
//! normals, lists of lamps, skies, and kernels of samples. Also the shapes, environments and scenes
//! of the pictures, all made by formulas.
//!
//! Everything is in f64 and for column vectors. World and view spaces are right-handed; a view
//! looks down its -z axis, with +y up. Lengths are in scene units, angles in radians. Cast the
//! results (`as_mat4`, `as_vec3`) where they enter a uniform buffer.

mod bulbs;
mod chessmen;
mod clusters;
mod environment;
mod field;
mod frustum;
mod interior;
mod kernel;
mod layers;
mod maps;
mod mesh;
mod numbering;
mod palette;
mod probe;
mod probing;
mod profiles;
mod projection;
mod rays;
pub mod sets;
mod shape;
mod sky;
mod turned;
mod view;

pub use clusters::{Cells, ClusterError, Clusters, MOST_CELLS, MOST_INDICES, MOST_LAMPS, Reach};
#[doc(hidden)]
pub use environment::DECODER;
pub use environment::{ENVIRONMENTS, Environment, environment};
pub use field::{PROBE_SIDES, ProbeField, ProbeGrid};
pub use frustum::{Bounds, bounding_sphere, cascade_splits, corners, depth_range, fit};
pub use kernel::gaussian;
pub use layers::Layers;
pub use maps::{blank_texel, brick_materials, bricks, linear_from_srgb};
pub use mesh::{MeshError, UNUSED_NORMAL, face_normals, normal_matrix, smooth_normals};
pub use probe::{CubeMap, directions, irradiance_sh9, prefilter, sh9_basis, sh9_project};
pub use profiles::{between_middles, luminaire, window};
pub use projection::{
    Clip, Depth, cube_projection, orthographic, perspective, polygon_offset, shadow_matrix,
};
pub use rays::{Hit, Look, Surfaces};
pub use shape::{Shape, Vertex};
pub use sky::{Equirect, Sky};
pub use view::{FACES, cube_view, from_angles, look_along, look_at};
