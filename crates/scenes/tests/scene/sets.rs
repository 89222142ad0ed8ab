//! Shapes, scenes and environments are valid: volumes, normals, radiance. Lists of lamps miss none.

use std::f64::consts::PI;

use crate::both as scene;
use glam::{DMat4, DVec2, DVec3};
use lamplight_scene::{Cells, Clip, ClusterError, Clusters, Depth, Reach};
use lamplight_scenes::{Shape, sets};

use super::{Outcome, close, near};

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
    for (name, _, environment) in scene::ENVIRONMENTS {
        for (direction, _) in scene::directions(24) {
            let radiance = environment(direction);
            if !(radiance.is_finite() && radiance.min_element() > 0.0) {
                let what = "should be positive and finite";
                return Err(format!("{name}: {radiance} from {direction} {what}").into());
            }
        }
    }
    let constant = scene::environment("constant").ok_or("no constant environment")?;
    let samples = scene::directions(8)
        .into_iter()
        .map(|(direction, angle)| (direction, angle, constant(direction)));
    close(
        "irradiance",
        scene::irradiance_sh9(DVec3::Y, &scene::sh9_project(samples)),
        DVec3::splat(PI),
        1e-12,
    )
}

/// Each cell lists every lamp that reaches a point of it, lists of far points are short, and inputs
/// that have no lists are errors.
pub fn clusters() -> Outcome {
    let cells = Cells { counts: [8, 6, 12], near: 0.5, far: 40.0 };
    let projection = scene::perspective(1.0, 1.5, 0.5, 60.0, Clip::Wgpu, Depth::Normal);
    let view = scene::look_at(DVec3::new(1.0, 2.0, 3.0), DVec3::new(-2.0, 0.5, -6.0), DVec3::Y);
    let spread = |index: usize, factor: f64| (factor * (index as f64 + 1.0)).fract() - 0.5;
    let at = |index: usize, size: f64| {
        let place = [0.618, 0.414, 0.732].map(|factor| size * spread(index, factor));
        view.inverse().transform_point3(DVec3::from_array(place) - DVec3::Z * 0.5 * size)
    };
    let lamp = |index: usize| Reach { position: at(index, 30.0), range: 0.5 + (index % 7) as f64 };
    let lamps: Vec<Reach> = (0..40).map(lamp).collect();
    let lists =
        Clusters::new(&cells, projection, view, &lamps).map_err(|error| error.to_string())?;
    let (mut tried, mut listed) = (0, 0);
    for point in (0..4000).map(|index| at(index + 99, 50.0)) {
        let clip = projection * view * point.extend(1.0);
        let [x, y] = [clip.x, clip.y].map(|side| 0.5 * side / clip.w + 0.5);
        if clip.w <= 0.0 || !(0.0..1.0).contains(&x) || !(0.0..1.0).contains(&y) {
            continue;
        }
        let z = -view.transform_point3(point).z;
        let slice = (12.0 * (z / 0.5).ln() / (80.0_f64).ln()).clamp(0.0, 11.0) as usize;
        let list = lists.list((x * 8.0) as usize + 8 * ((y * 6.0) as usize + 6 * slice));
        let reaching = |lamp: &&(usize, &Reach)| lamp.1.position.distance(point) <= lamp.1.range;
        let all: Vec<_> = lamps.iter().enumerate().collect();
        if let Some((missing, _)) =
            all.iter().filter(reaching).find(|(index, _)| !list.contains(&(*index as u8)))
        {
            return Err(format!("lamp {missing} reaches {point}, and {list:?} lacks it").into());
        }
        (tried, listed) = (tried + 1, listed + list.len());
    }
    if tried < 500 || listed > 20 * tried {
        return Err(format!("{listed} lamps in the lists of {tried} points").into());
    }
    refused_clusters(&cells, projection, view)
}

/// If all lamps reach everything, all cells share one list. Too many lamps or cells are errors.
fn refused_clusters(cells: &Cells, projection: DMat4, view: DMat4) -> Outcome {
    let made = |lamps: &[Reach]| Clusters::new(cells, projection, view, lamps);
    let endless = Reach { position: DVec3::ZERO, range: f64::INFINITY };
    let same = made(&[endless; 6]).map_err(|error| error.to_string())?;
    if same.indices.len() != 2 || (0..576).any(|cell| same.list(cell) != [0, 1, 2, 3, 4, 5]) {
        return Err("lists of lamps that reach everything should be one".into());
    }
    let of = |cells: Cells| Clusters::new(&cells, projection, view, &[endless]).err();
    let refused = [
        (made(&[endless; 256]).err(), ClusterError::Lamps),
        (of(Cells { counts: [0, 6, 12], ..*cells }), ClusterError::Cells),
        (of(Cells { counts: [u32::MAX; 3], ..*cells }), ClusterError::Cells),
        (of(Cells { far: 0.5, ..*cells }), ClusterError::Camera),
        (of(Cells { near: f64::NAN, ..*cells }), ClusterError::Camera),
    ];
    match refused.into_iter().find(|(found, wanted)| *found != Some(*wanted)) {
        None => Ok(()),
        Some((found, wanted)) => Err(format!("{found:?}, expected {wanted:?}").into()),
    }
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
