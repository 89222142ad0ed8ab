//! Lists of the lamps that reach each cell.

use glam::{DMat4, DVec3};
use lamplight_scene::{self as scene, Cells, Clip, ClusterError, Clusters, Depth, Reach};

use super::Outcome;

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
