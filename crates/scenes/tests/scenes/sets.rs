//! Shapes, scenes and environments are valid: volumes, normals, radiance.

use std::f64::consts::PI;

use glam::{DMat4, DVec2, DVec3};
use lamplight_scene as scene;
use lamplight_scenes::{ENVIRONMENTS, Shape, environment, sets};

use super::Outcome;
use lamplight_testing::numbers::{near, near_vector};

/// Shapes have the volumes of their formulas. The volume would be negative if faces were inside out.
pub fn volumes() -> Outcome {
    let volume = |shape: &Shape| -> f64 {
        let corner = |index: u32| shape.vertices[index as usize].position;
        shape
            .indices
            .chunks(3)
            .map(|three| corner(three[0]).dot(corner(three[1]).cross(corner(three[2]))) / 6.0)
            .sum()
    };
    let can = [0.0, 1.0, 2.0].map(|height| DVec2::new(1.0, height));
    let pipe = [(DVec2::ZERO, 0.5), (DVec2::new(1.0, 0.0), 0.5), (DVec2::new(2.0, 0.0), 0.5)];
    near("a ball", volume(&Shape::sphere(2.0, (96, 48))), 4.0 / 3.0 * PI * 8.0, 0.1)?;
    near("a ring", volume(&Shape::torus(2.0, 0.5, (96, 48))), 2.0 * PI * PI * 2.0 * 0.25, 0.05)?;
    near("a box", volume(&Shape::cuboid(DVec3::new(1.0, 2.0, 3.0), 3)), 48.0, 1e-9)?;
    // These two are open at their ends. One end is at the origin, where it adds nothing; at the other
    // the sum lacks a cone, a third of the volume.
    near("a can", volume(&Shape::lathe(&can, (96, 24))), PI * 2.0 * 2.0 / 3.0, 0.02)?;
    near("a pipe", volume(&Shape::tube(&pipe, (96, 24))), PI * 0.25 * 2.0 * 2.0 / 3.0, 0.02)?;
    let moved = Shape::sphere(1.0, (24, 12))
        .transformed(DMat4::from_translation(DVec3::X) * DMat4::from_scale(DVec3::splat(2.0)));
    near("a larger ball", volume(&moved), 4.0 / 3.0 * PI * 8.0, 1.5)
}

/// What is wrong with a scene that has nothing to show.
pub fn nothing_is_shown(objects: &[sets::Object]) -> Option<String> {
    let corners: usize = objects.iter().map(|object| object.shape.vertices.len()).sum();
    (corners < 3).then(|| {
        format!("its {} objects have {corners} vertices, expected at least 3", objects.len())
    })
}

/// Normals of vertices have unit length, and point to the same side as the faces around them.
pub fn scenes() -> Outcome {
    for sets::Set { name, make, .. } in sets::ALL {
        if let Some(problem) = nothing_is_shown(&make().objects) {
            return Err(format!("scene {name}: {problem}").into());
        }
        for object in make().objects {
            let positions: Vec<DVec3> =
                object.shape.vertices.iter().map(|vertex| vertex.position).collect();
            let faces = scene::face_normals(&positions, Some(&object.shape.indices))?;
            for (three, face) in
                object.shape.indices.chunks(3).zip(&faces).filter(|(_, face)| **face != DVec3::ZERO)
            {
                for vertex in three.iter().map(|index| &object.shape.vertices[*index as usize]) {
                    near(name, vertex.normal.length(), 1.0, 1e-9)?;
                    if vertex.normal.dot(*face) < 0.0 {
                        return Err(format!(
                            "{name}: at {} the normal points to the back of its face",
                            vertex.position
                        )
                        .into());
                    }
                }
            }
            let flat = object.shape.faceted();
            near(name, flat.indices.len() as f64, object.shape.indices.len() as f64, 0.0)?;
        }
    }
    Ok(())
}

/// Environments have positive, finite radiance from everywhere, and the constant one has the
/// irradiance of a constant sky.
pub fn environments() -> Outcome {
    for (name, _, radiance_from) in ENVIRONMENTS {
        for (direction, _) in scene::directions(24) {
            let radiance = radiance_from(direction);
            if !(radiance.is_finite() && radiance.min_element() > 0.0) {
                let what = "should be positive and finite";
                return Err(format!("{name}: {radiance} from {direction} {what}").into());
            }
        }
    }
    let constant = environment("constant").ok_or("no constant environment")?;
    let samples = scene::directions(8)
        .into_iter()
        .map(|(direction, angle)| (direction, angle, constant(direction)));
    near_vector(
        "irradiance",
        scene::irradiance_sh9(DVec3::Y, &scene::sh9_project(samples)),
        DVec3::splat(PI),
        1e-12,
    )
}

/// Objects get the indices of their materials. Equal materials have the same index, each material
/// has an entry for both sides, and more materials than the array can hold are an error.
pub fn numbers() -> Outcome {
    let mut scene = sets::scene("spheres").ok_or("no such scene")?;
    for (object, roughness) in scene.objects.iter_mut().zip([0.2, 0.5, 0.2, 0.7, 0.5]) {
        object.material = sets::Material { roughness, ..sets::Material::default() };
    }
    scene.number_materials()?;
    let numbers: Vec<u32> = scene.objects.iter().map(|object| object.material_index).collect();
    let kept = scene.materials.iter().map(|sides| sides.map(|side| side.roughness));
    let kept: Vec<[f64; 2]> = kept.collect();
    if numbers != [0, 1, 0, 2, 1] || kept != [[0.2; 2], [0.5; 2], [0.7; 2]] {
        return Err(format!("numbers {numbers:?} of {kept:?}").into());
    }
    let mut many = sets::scene("grid").ok_or("no such scene")?;
    many.number_materials()?;
    let extra = sets::Material { roughness: 0.01, ..sets::Material::default() };
    many.objects.push(sets::Object { material: extra, ..many.objects[0].clone() });
    match many.number_materials() {
        Err(error) if error.contains("15 materials") => Ok(()),
        other => Err(format!("15 materials in one array: {other:?}").into()),
    }
}
