//! Fields of light probes and the rays that fill them, against closed forms.

use glam::{DMat3, DMat4, DVec3};
use lamplight_scenes::sets::{self, Eye, Material, Object, Scene};
use lamplight_scenes::{ProbeField, ProbeGrid, Shape, Surfaces};

use super::Outcome;
use lamplight_testing::numbers::{near, near_vector};
use lamplight_testing::random::Random;

/// A box seen from inside, with walls that are diffuse and emissive.
fn closed_box(albedo: f64, emission: f64) -> Scene {
    let inside = Shape::cuboid(DVec3::new(2.0, 1.0, 1.5), 3);
    let mut turned = inside;
    turned.indices.chunks_mut(3).for_each(|three| three.swap(0, 1));
    let material = Material { emission: DVec3::splat(emission), ..Material::default() };
    let walls = Object::made(turned, DMat4::IDENTITY, DVec3::splat(albedo), material);
    let eye = Eye { position: DVec3::ZERO, target: DVec3::X, fov_y: 1.0, near: 0.1, far: 10.0 };
    Scene::of_model(vec![walls], eye, Vec::new())
}

fn grid() -> ProbeGrid {
    ProbeGrid::within(DVec3::new(-2.0, -1.0, -1.5), DVec3::new(2.0, 1.0, 1.5), [4, 3, 3])
}

/// Rays meet the nearest triangle, from either side.
pub fn rays() -> Outcome {
    let surfaces = Surfaces::of(&closed_box(0.5, 1.0));
    let from = DVec3::new(0.3, -0.2, 0.4);
    let cases = [
        (DVec3::X, 1.7, DVec3::NEG_X),
        (DVec3::NEG_Y, 0.8, DVec3::Y),
        (DVec3::new(0.0, 0.0, -2.0), 0.95, DVec3::Z),
    ];
    for (towards, distance, normal) in cases {
        let hit = surfaces.hit(from, towards).ok_or("no wall")?;
        near("distance", hit.distance, distance, 1e-12)?;
        near_vector("normal", hit.normal, normal, 1e-12)?;
    }
    let outside = surfaces.hit(DVec3::new(5.0, 0.1, 0.1), DVec3::NEG_X).ok_or("no wall")?;
    near("from outside", outside.distance, 3.0, 1e-12)?;
    let is_blocked = !surfaces.is_clear(from, DVec3::new(4.0, 0.0, 0.0));
    let misses = surfaces.hit(DVec3::new(5.0, 0.0, 0.0), DVec3::X).is_none();
    if is_blocked && misses && surfaces.is_clear(from, -from) {
        Ok(())
    } else {
        Err(format!("blocked {is_blocked}, misses {misses}, expected both").into())
    }
}

/// In every scene, rays from anywhere meet what the nearest of all triangles is, each of them tried;
/// and two points see each other exactly if none is between them.
pub fn rays_of_scenes() -> Outcome {
    const RAYS: usize = 40;
    const FAR: f64 = 20.0;
    let mut random = Random(7);
    let mut met = 0;
    for set in sets::ALL {
        let scene = (set.make)();
        let (surfaces, triangles) = (Surfaces::of(&scene), corners_of(&scene));
        let corners = || triangles.iter().flatten();
        let low = corners().fold(DVec3::INFINITY, |low, corner| low.min(*corner));
        let high = corners().fold(DVec3::NEG_INFINITY, |high, corner| high.max(*corner));
        let (low, high) = (low.max(DVec3::splat(-FAR)), high.min(DVec3::splat(FAR)));
        let place = |random: &mut Random| {
            DVec3::from_array([0, 1, 2].map(|axis| random.between(low[axis], high[axis])))
        };
        for _ in 0..RAYS {
            let (from, to) = (place(&mut random), place(&mut random));
            let towards = to - from;
            let nearest = triangles
                .iter()
                .filter_map(|corners| distance_to(corners, from, towards))
                .fold(f64::INFINITY, f64::min);
            let found = surfaces.hit(from, towards).map_or(f64::INFINITY, |hit| hit.distance);
            if found != nearest {
                near(&format!("{}: {from} towards {towards}", set.name), found, nearest, 1e-9)?;
            }
            let is_clear = surfaces.is_clear(from, to);
            let is_in_doubt = (nearest - (1.0 - 1e-6)).abs() < 1e-9;
            if is_clear != (nearest >= 1.0 - 1e-6) && !is_in_doubt {
                return Err(format!("{}: {from} to {to}: clear {is_clear}", set.name).into());
            }
            met += u32::from(nearest < f64::INFINITY);
        }
    }
    if met > 200 { Ok(()) } else { Err(format!("only {met} rays met a triangle").into()) }
}

/// The triangles of everything that casts a shadow, in world space.
fn corners_of(scene: &Scene) -> Vec<[DVec3; 3]> {
    let casting = scene.objects.iter().filter(|object| object.casts);
    let of_object = |object: &Object| -> Vec<[DVec3; 3]> {
        let place = |index: &u32| {
            object
                .world_from_object
                .transform_point3(object.shape.vertices[*index as usize].position)
        };
        let three = object.shape.indices.as_chunks::<3>().0.iter();
        three.map(|[a, b, c]| [place(a), place(b), place(c)]).collect()
    };
    casting.flat_map(of_object).collect()
}

/// Where a ray meets a triangle, by the inverse of the matrix of its sides and of the ray.
fn distance_to([a, b, c]: &[DVec3; 3], from: DVec3, towards: DVec3) -> Option<f64> {
    let matrix = DMat3::from_cols(-towards, b - a, c - a);
    if matrix.determinant() == 0.0 {
        return None;
    }
    let DVec3 { x: distance, y: u, z: v } = matrix.inverse() * (from - a);
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > 1e-6).then_some(distance)
}

/// In a closed box, emissive walls give the same light everywhere: the sum of a geometric series
/// over the bounces. Without surfaces, every probe has the light from beyond the scene.
pub fn fields() -> Outcome {
    let (albedo, emission): (f64, f64) = (0.5, 0.8);
    let glowing = ProbeField::new(
        grid(),
        &Surfaces::of(&closed_box(albedo, emission)),
        &|_, _| DVec3::ZERO,
        DVec3::ZERO,
    );
    let sum: f64 = (0..3).map(|bounce| emission * albedo.powi(bounce)).sum();
    let open = ProbeField::new(grid(), &Surfaces::default(), &|_, _| DVec3::ZERO, DVec3::X);
    let places = [DVec3::ZERO, DVec3::new(1.9, -0.9, 1.4), DVec3::new(-1.99, 0.3, -0.2)];
    for (at, normal) in places.into_iter().zip([DVec3::Y, DVec3::NEG_X, DVec3::X]) {
        near_vector("glowing box", glowing.light_at(at, normal), DVec3::splat(sum), 1e-9)?;
        near_vector("nothing", open.light_at(at, normal), DVec3::X, 1e-9)?;
    }
    Ok(())
}
