//! A scene of the pictures.

use super::{Kind, Made, Repository, check_name, refuse_rest};

pub const KIND: Kind = Kind { name: "scene", example: &["staircase"], rest: "", make };

fn make(repository: &Repository<'_>, name: &str, rest: &[&str]) -> Result<Made, String> {
    refuse_rest(rest)?;
    check_name(name, '_')?;
    let file = format!("src/scene/sets/{name}.rs");
    repository.refuse_existing(&file)?;
    let next = vec![
        format!("{file}: `about`, objects, the viewer and the lamp (trial scene)"),
        "shaderlib/presets.toml: `scene = \"...\"` in the presets that show it".to_owned(),
        "cargo xtask docs".to_owned(),
        format!(
            "cargo run --release -- render --set default --scene {name} -o target/{name}.png; look"
        ),
    ];
    Ok(Made { files: vec![(file, TEXT.replace("NAME", name))], next })
}

const TEXT: &str = r#"//! NAME.

use glam::DVec3;

use super::{Eye, Lamp, LampKind, Scene, Set, base_scene, palette};

/// The scene, for the table of all.
pub const SET: Set = Set { name: "NAME", about: "", make: scene };

/// The scene itself.
pub fn scene() -> Scene {
    let objects = Vec::new();
    let eye = Eye {
        position: DVec3::new(0.0, 2.0, 8.0),
        target: DVec3::ZERO,
        fov_y: 0.6,
        near: 0.5,
        far: 40.0,
    };
    let key = Lamp {
        color: DVec3::ONE,
        position: DVec3::new(-2.0, 5.0, 4.0),
        target: DVec3::ZERO,
        half_angle: 0.5,
        kind: LampKind::Directional,
    };
    base_scene(objects, eye, palette::lamps(key, 4.5, 2.8, 0.22))
}
"#;
