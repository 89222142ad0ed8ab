//! Compares the mathematics for the host with closed forms: matrices, cascades, normals, kernels,
//! spherical harmonics. Lists of lamps miss none.

mod balls;
mod clusters;
mod parts;

use std::f64::consts::{FRAC_PI_2, FRAC_PI_3, PI};

use glam::{DMat3, DMat4, DVec3, Vec4Swizzles};
use lamplight_scene::{self as scene, Bounds, Clip, CubeMap, Depth, Equirect, MeshError};
use lamplight_testing::numbers::{near, near_vector};
use libtest_mimic::{Failed, Trial};

type Outcome = Result<(), Failed>;
type Case = (&'static str, fn() -> Outcome);

const CLIPS: [Clip; 3] = [Clip::Wgpu, Clip::Vulkan, Clip::OpenGl];
const DEPTHS: [Depth; 2] = [Depth::Normal, Depth::Reversed];

pub fn tests() -> Vec<Trial> {
    let cases: [Case; 18] = [
        ("views", views),
        ("views_by_angles", angles),
        ("perspective", perspective),
        ("frusta_by_their_corners", frusta),
        ("tight_boxes", tight),
        ("faces_of_a_cube", faces),
        ("shadow_matrices", shadow_matrices),
        ("cascades", parts::cascades),
        ("spheres_of_cascades", parts::spheres),
        ("clusters", clusters::clusters),
        ("normals", normals),
        ("normal_matrix", normal_matrix),
        ("gaussian", gaussian),
        ("harmonics_of_skies", harmonics),
        ("harmonics_of_images", images),
        ("filtered_skies", filtered),
        ("mirrored_balls", balls::mirror),
        ("skies_of_balls", balls::round_trip),
    ];
    cases.into_iter().map(|(name, run)| Trial::test(format!("scene::{name}"), run)).collect()
}

/// A view matrix maps the eye to the origin and the target to -z, also for views along `up`.
fn views() -> Outcome {
    let (eye, target) = (DVec3::new(1.0, 2.0, 3.0), DVec3::new(4.0, -2.0, 3.0));
    let view = scene::look_at(eye, target, DVec3::Z);
    near_vector("the eye", view.transform_point3(eye), DVec3::ZERO, 1e-12)?;
    near_vector("the target", view.transform_point3(target), DVec3::new(0.0, 0.0, -5.0), 1e-12)?;
    near_vector("up", view.transform_vector3(DVec3::Z), DVec3::Y, 1e-12)?;
    for direction in [DVec3::Y, DVec3::NEG_Y, DVec3::X, DVec3::new(1e-9, 1.0, 0.0)] {
        let view = scene::look_along(DVec3::ZERO, direction, DVec3::Y);
        near_vector(
            "straight up",
            view.transform_vector3(direction.normalize()),
            DVec3::NEG_Z,
            1e-12,
        )?;
        near("a rotation", DMat3::from_mat4(view).determinant(), 1.0, 1e-12)?;
    }
    near_vector(
        "no direction",
        scene::look_at(eye, eye, DVec3::Y).transform_point3(DVec3::ZERO),
        -eye,
        0.0,
    )
}

/// A view from angles is the inverse of the object's placement.
fn angles() -> Outcome {
    let (origin, turn) = (DVec3::new(1.0, 2.0, 3.0), DVec3::new(0.3, -0.7, 1.1));
    let place = DMat4::from_translation(origin)
        * DMat4::from_rotation_z(turn.z)
        * DMat4::from_rotation_y(turn.y)
        * DMat4::from_rotation_x(turn.x);
    let product = scene::from_angles(origin, turn) * place;
    for (column, wanted) in [DVec3::X, DVec3::Y, DVec3::Z].into_iter().enumerate() {
        near_vector("a column", product.col(column).xyz(), wanted, 1e-12)?;
    }
    // A quarter turn about x looks up.
    let up = scene::from_angles(DVec3::ZERO, DVec3::new(FRAC_PI_2, 0.0, 0.0));
    near_vector("up", up.transform_vector3(DVec3::Y), DVec3::NEG_Z, 1e-12)
}

fn depth_of(clip: Clip, depth: Depth) -> (f64, f64) {
    match (clip, depth) {
        (Clip::OpenGl, Depth::Normal) => (-1.0, 1.0),
        (Clip::OpenGl, Depth::Reversed) => (1.0, -1.0),
        (_, Depth::Normal) => (0.0, 1.0),
        (_, Depth::Reversed) => (1.0, 0.0),
    }
}

fn perspective() -> Outcome {
    for (clip, depth) in CLIPS.into_iter().flat_map(|clip| DEPTHS.map(|depth| (clip, depth))) {
        let projection = scene::perspective(FRAC_PI_3, 2.0, 0.5, 20.0, clip, depth);
        let (first, last) = depth_of(clip, depth);
        near("near", projection.project_point3(DVec3::new(0.0, 0.0, -0.5)).z, first, 1e-12)?;
        near("far", projection.project_point3(DVec3::new(0.0, 0.0, -20.0)).z, last, 1e-12)?;
        // The upper edge is 30 degrees above the axis, and the right one twice as far from it.
        let height = 4.0 * (FRAC_PI_3 / 2.0).tan();
        let edge = projection.project_point3(DVec3::new(2.0 * height, height, -4.0));
        near("right", edge.x, 1.0, 1e-12)?;
        near("top", edge.y, if clip == Clip::Vulkan { -1.0 } else { 1.0 }, 1e-12)?;
    }
    near("offset", scene::polygon_offset(2.0, 4.0, 0.25, 0.125), 1.0, 0.0)
}

/// The corners of a frustum are where its angle and its planes put them.
fn frusta() -> Outcome {
    let view = scene::look_at(DVec3::new(3.0, 1.0, -2.0), DVec3::ZERO, DVec3::Y);
    for (clip, depth) in CLIPS.into_iter().flat_map(|clip| DEPTHS.map(|depth| (clip, depth))) {
        let corners = scene::corners(
            scene::perspective(FRAC_PI_2, 1.0, 1.0, 10.0, clip, depth) * view,
            clip,
            depth,
        );
        for (index, corner) in corners.into_iter().enumerate() {
            // With an angle of 90 degrees, a plane is as wide to each side as it is away.
            let away = if index < 4 { 1.0 } else { 10.0 };
            let y = if (index & 2 == 0) == (clip != Clip::Vulkan) { -away } else { away };
            let wanted = DVec3::new(if index & 1 == 0 { -away } else { away }, y, -away);
            near_vector("a corner", view.transform_point3(corner), wanted, 1e-9)?;
        }
        let (first, last) = scene::depth_range(view, &corners).ok_or("no range")?;
        near("near", first, 1.0, 1e-9)?;
        near("far", last, 10.0, 1e-9)?;
    }
    Ok(())
}

/// An orthographic projection that is fitted to points touches them on all six sides.
fn tight() -> Outcome {
    let view = scene::look_along(DVec3::ZERO, DVec3::new(1.0, -2.0, 0.5), DVec3::Y);
    let points: Vec<DVec3> = (0..8)
        .map(|i| DVec3::new(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) * 3.0)
        .collect();
    let bounds = scene::fit(view, &points).ok_or("no bounds")?;
    for (clip, depth) in CLIPS.into_iter().flat_map(|clip| DEPTHS.map(|depth| (clip, depth))) {
        let projection = scene::orthographic(&bounds, clip, depth) * view;
        let seen: Vec<DVec3> =
            points.iter().map(|point| projection.project_point3(*point)).collect();
        let (low, high) = (
            seen.iter().copied().reduce(DVec3::min).ok_or("none")?,
            seen.iter().copied().reduce(DVec3::max).ok_or("none")?,
        );
        let (first, last) = depth_of(clip, depth);
        near_vector("low", low, DVec3::new(-1.0, -1.0, first.min(last)), 1e-12)?;
        near_vector("high", high, DVec3::new(1.0, 1.0, first.max(last)), 1e-12)?;
        let nearest = points
            .iter()
            .min_by(|a, b| view.transform_point3(**b).z.total_cmp(&view.transform_point3(**a).z))
            .ok_or("none")?;
        near("the nearest", projection.project_point3(*nearest).z, first, 1e-12)?;
    }
    match scene::fit(view, &[]) {
        None => Ok(()),
        Some(_) => Err("no points should have no bounds".into()),
    }
}

/// Every texel's direction is seen on the texel's face only, at the texel's place.
fn faces() -> Outcome {
    let (size, light) = (8, DVec3::new(1.0, -2.0, 0.5));
    for clip in [Clip::Wgpu, Clip::OpenGl] {
        let projection = scene::cube_projection(0.1, 10.0, clip, Depth::Normal);
        for (face, column, row) in (0..6).flat_map(|face| {
            (0..size).flat_map(move |row| (0..size).map(move |column| (face, column, row)))
        }) {
            let direction = CubeMap::direction(size, face, column, row);
            let inside = (0..6).filter(|face| {
                let seen = projection
                    * scene::cube_view(light, *face)
                    * (light + direction * 3.0).extend(1.0);
                seen.w > 0.0 && seen.x.abs() <= seen.w && seen.y.abs() <= seen.w
            });
            if inside.collect::<Vec<_>>() != [face] {
                return Err(format!("{direction} is not on face {face} alone").into());
            }
            let seen = (projection * scene::cube_view(light, face))
                .project_point3(light + direction * 3.0);
            let middle = |index: usize| 2.0 * (index as f64 + 0.5) / size as f64 - 1.0;
            near("column", seen.x, middle(column), 1e-12)?;
            near("row", -seen.y, middle(row), 1e-12)?;
        }
    }
    // Graphics APIs define that on the face +x columns run to -z and rows to -y.
    near_vector(
        "+x",
        CubeMap::direction(2, 0, 1, 1),
        DVec3::new(1.0, -0.5, -0.5).normalize(),
        1e-12,
    )?;
    near_vector(
        "-y",
        CubeMap::direction(2, 3, 1, 1),
        DVec3::new(0.5, -1.0, -0.5).normalize(),
        1e-12,
    )
}

fn shadow_matrices() -> Outcome {
    let view = scene::look_at(DVec3::new(0.0, 5.0, 5.0), DVec3::ZERO, DVec3::Y);
    let bounds = Bounds { left: -4.0, right: 4.0, bottom: -2.0, top: 2.0, near: 1.0, far: 9.0 };
    let back = view.inverse();
    for clip in CLIPS {
        let matrix =
            scene::shadow_matrix(scene::orthographic(&bounds, clip, Depth::Normal), view, clip);
        // The point is a quarter from the left, an eighth from the top, and halfway in depth.
        let point = back.transform_point3(DVec3::new(-2.0, 1.5, -5.0));
        let v = if clip == Clip::OpenGl { 0.875 } else { 0.125 };
        near_vector("a place", matrix.project_point3(point), DVec3::new(0.25, v, 0.5), 1e-12)?;
        let reversed =
            scene::shadow_matrix(scene::orthographic(&bounds, clip, Depth::Reversed), view, clip);
        near(
            "near is 1",
            reversed.project_point3(back.transform_point3(DVec3::new(0.0, 0.0, -1.0))).z,
            1.0,
            1e-12,
        )?;
    }
    Ok(())
}

fn normals() -> Outcome {
    // The mesh is a roof of two faces that share an edge, an unused vertex, and a degenerate face.
    let positions = [
        DVec3::new(0.0, 0.0, 0.0),
        DVec3::new(0.0, 0.0, -2.0),
        DVec3::new(-1.0, -1.0, 0.0),
        DVec3::new(1.0, -1.0, 0.0),
        DVec3::new(9.0, 9.0, 9.0),
    ];
    let indices = [0, 1, 2, 0, 3, 1, 0, 0, 1];
    let faces = scene::face_normals(&positions, Some(&indices))?;
    let slope = 0.5_f64.sqrt();
    near_vector("left", faces[0], DVec3::new(-slope, slope, 0.0), 1e-12)?;
    near_vector("right", faces[1], DVec3::new(slope, slope, 0.0), 1e-12)?;
    near_vector("degenerate", faces[2], DVec3::ZERO, 0.0)?;
    let smooth = scene::smooth_normals(&positions, Some(&indices))?;
    near_vector("the ridge", smooth[0], DVec3::Y, 1e-12)?;
    near_vector("the eaves", smooth[2], faces[0], 1e-12)?;
    near_vector("unused", smooth[4], scene::UNUSED_NORMAL, 0.0)?;
    let loose: Vec<DVec3> = indices[..6].iter().map(|index| positions[*index as usize]).collect();
    let welded = scene::smooth_normals(&loose, None)?;
    near_vector("welded", welded[0], DVec3::Y, 1e-12)?;
    near_vector("welded again", welded[3], DVec3::Y, 1e-12)?;
    match (
        scene::face_normals(&positions, Some(&[0, 1])),
        scene::smooth_normals(&positions, Some(&[0, 1, 5])),
    ) {
        (
            Err(MeshError::Incomplete { corners: 2 }),
            Err(MeshError::Beyond { index: 5, vertices: 5 }),
        ) => Ok(()),
        other => Err(format!("expected 2 corners and index 5 to be refused: {other:?}").into()),
    }
}

/// A normal stays perpendicular to its surface under any scale.
fn normal_matrix() -> Outcome {
    let model = DMat4::from_rotation_y(0.4)
        * DMat4::from_scale(DVec3::new(1.0, 3.0, -0.5))
        * DMat4::from_translation(DVec3::ONE);
    let matrix = scene::normal_matrix(model);
    let (along, across) = (DVec3::new(1.0, 2.0, -1.0), DVec3::new(0.5, -1.0, 2.0));
    let normal = matrix * along.cross(across);
    near("along", normal.dot(model.transform_vector3(along)), 0.0, 1e-12)?;
    near("across", normal.dot(model.transform_vector3(across)), 0.0, 1e-12)?;
    let flat = scene::normal_matrix(DMat4::from_scale(DVec3::new(1.0, 0.0, 1.0)));
    near_vector("flattened", flat * DVec3::new(0.3, 1.0, 0.2), DVec3::Y, 0.0)
}

/// The kernel adds up to 1, is symmetric, and has the published weights.
fn gaussian() -> Outcome {
    let kernel = scene::gaussian(10, 8.0);
    near("the sum", kernel.iter().sum(), 1.0, 1e-15)?;
    for (offset, wanted) in
        [0.14107424, 0.132526984, 0.109868729, 0.080381679].into_iter().enumerate()
    {
        near("as published", kernel[10 + offset], wanted, 5e-9)?;
        near("symmetric", kernel[10 - offset], kernel[10 + offset], 0.0)?;
    }
    Ok(())
}

/// The irradiance of a constant sky is pi. That of 1 + y is pi + 2 pi / 3 towards y. Each basis
/// function has the coefficient 1 for itself and 0 for the others. A cosine lobe has the irradiance
/// that bands 0 to 2 keep of it.
fn harmonics() -> Outcome {
    let of = |sky: &scene::Sky<'_>| {
        scene::sh9_project(
            scene::directions(64)
                .into_iter()
                .map(|(direction, weight)| (direction, weight, sky(direction))),
        )
    };
    let constant = of(&|_| DVec3::ONE);
    near("L00", constant[0].x, 2.0 * PI.sqrt(), 1e-12)?;
    constant[1..]
        .iter()
        .try_for_each(|coefficient| near_vector("the others", *coefficient, DVec3::ZERO, 1e-12))?;
    near_vector("irradiance", scene::irradiance_sh9(DVec3::Y, &constant), DVec3::splat(PI), 1e-12)?;
    let linear = of(&|d| DVec3::splat(1.0 + d.y));
    near_vector(
        "of 1 + y",
        scene::irradiance_sh9(DVec3::Y, &linear),
        DVec3::splat(PI + 2.0 * PI / 3.0),
        1e-12,
    )?;
    near_vector(
        "of 1 + y, below",
        scene::irradiance_sh9(DVec3::NEG_Y, &linear),
        DVec3::splat(PI / 3.0),
        1e-12,
    )?;
    for index in 0..9 {
        let found = of(&|d| DVec3::splat(scene::sh9_basis(d)[index]));
        for (other, coefficient) in found.iter().enumerate() {
            near("orthonormal", coefficient.x, f64::from(u8::from(index == other)), 1e-12)?;
        }
    }
    // max(cos, 0) = 1/4 + cos/2 + 5/32 (3 cos^2 - 1) + ...; irradiance multiplies the three bands by
    // pi, 2 pi/3 and pi/4.
    let lobe = of(&|d| DVec3::splat(d.y.max(0.0)));
    near(
        "a cosine sky",
        scene::irradiance_sh9(DVec3::Y, &lobe).x,
        PI / 4.0 + PI / 3.0 + 5.0 * PI / 64.0,
        2e-4,
    )
}

fn images() -> Outcome {
    let constant = Equirect::of(&|_| DVec3::new(1.0, 2.0, 3.0), 64, 32).ok_or("no image")?;
    near("the whole sphere", constant.samples().map(|(_, angle, _)| angle).sum(), 4.0 * PI, 1e-12)?;
    let coefficients = scene::sh9_project(constant.samples());
    near_vector(
        "irradiance",
        scene::irradiance_sh9(DVec3::X, &coefficients),
        DVec3::new(1.0, 2.0, 3.0) * PI,
        0.02,
    )?;
    let sky = |d: DVec3| DVec3::new(1.0 + d.x, 1.0 + d.y, 1.0 + d.z);
    let image = Equirect::of(&sky, 256, 128).ok_or("no image")?;
    let found = scene::sh9_project(image.samples());
    for n in [DVec3::X, DVec3::NEG_Y, DVec3::Z, DVec3::new(0.6, 0.0, -0.8)] {
        near_vector(
            "a linear sky",
            scene::irradiance_sh9(n, &found),
            DVec3::splat(PI) + n * (2.0 * PI / 3.0),
            2e-3,
        )?;
        near_vector("read back", image.radiance(n), sky(n), 1e-3)?;
    }
    near_vector(
        "at the seam",
        image.radiance(DVec3::new(-1.0, 0.0, 1e-9)),
        sky(DVec3::NEG_X),
        1e-3,
    )?;
    if Equirect::new(2, 2, vec![DVec3::ZERO; 3]).is_none() {
        Ok(())
    } else {
        Err("an image with too few pixels was accepted".into())
    }
}

/// Filtering leaves a constant sky as it is. Over the sky 1 + y, the lobe of exponent k around n has
/// the mean 1 + n.y (k + 1) / (k + 2).
fn filtered() -> Outcome {
    for exponent in [1.0, 50.0] {
        let constant = scene::prefilter(&|_| DVec3::new(0.5, 1.0, 2.0), exponent, 4, 24);
        for texel in &constant.texels {
            near_vector("a constant", *texel, DVec3::new(0.5, 1.0, 2.0), 1e-12)?;
        }
        let linear = scene::prefilter(&|d| DVec3::splat(1.0 + d.y), exponent, 4, 64);
        for (index, texel) in linear.texels.iter().enumerate() {
            let n = CubeMap::direction(4, index / 16, index % 4, index / 4 % 4);
            near("a linear sky", texel.x, 1.0 + n.y * (exponent + 1.0) / (exponent + 2.0), 2e-3)?;
        }
    }
    Ok(())
}
