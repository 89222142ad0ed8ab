//! The mathematics of lighting for the host: matrices of lights, bounds fitted around what is seen,
//! normals, lists of lamps, skies, and kernels of samples.
//!
//! Everything is in f64 and for column vectors. World and view spaces are right-handed; a view
//! looks down its -z axis, with +y up. Lengths are in scene units, angles in radians. Cast the
//! results (`as_mat4`, `as_vec3`) where they enter a uniform buffer.

mod clusters;
mod frustum;
mod kernel;
mod mesh;
mod mirror_ball;
mod probe;
mod projection;
pub mod quadrature;
mod sky;
mod summed;
mod view;

pub use clusters::{Cells, ClusterError, Clusters, MOST_CELLS, MOST_INDICES, MOST_LAMPS, Reach};
pub use frustum::{Bounds, bounding_sphere, cascade_splits, corners, depth_range, fit};
pub use kernel::gaussian;
pub use mesh::{MeshError, UNUSED_NORMAL, face_normals, normal_matrix, smooth_normals};
pub use mirror_ball::{MirrorBall, ProbeMapping};
pub use probe::{CubeMap, directions, irradiance_sh9, prefilter, sh9_basis, sh9_project};
pub use projection::{
    Clip, Depth, cube_projection, orthographic, perspective, polygon_offset, shadow_matrix,
};
#[doc(hidden)]
pub use sky::DECODER;
pub use sky::{Equirect, Sky};
pub use summed::SummedArea;
pub use view::{FACES, cube_view, from_angles, look_along, look_at};
