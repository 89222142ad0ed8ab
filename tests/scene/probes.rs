//! Fields of light probes and the rays that fill them, against closed forms.

use glam::{DMat4, DVec3};
use lamplight::scene::sets::{Eye, Material, Object, Scene};
use lamplight::scene::{ProbeField, ProbeGrid, Shape, Surfaces};

use super::{Outcome, close, near};

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
        close("normal", hit.normal, normal, 1e-12)?;
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
        close("glowing box", glowing.light_at(at, normal), DVec3::splat(sum), 1e-9)?;
        close("nothing", open.light_at(at, normal), DVec3::X, 1e-9)?;
    }
    Ok(())
}
