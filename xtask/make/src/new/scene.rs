//! A scene of the pictures, and a preset that shows it.

use super::{NewFiles, Repository, TaskKind, check_name, refuse_rest};

pub const KIND: TaskKind = TaskKind { name: "scene", example: &["staircase"], rest: "", make };

const PRESETS: &str = "shaderlib/presets.toml";

fn make(repository: &Repository<'_>, name: &str, rest: &[&str]) -> Result<NewFiles, String> {
    refuse_rest(rest)?;
    check_name(name, '_')?;
    let file = format!("crates/scenes/src/sets/{name}.rs");
    repository.refuse_existing(&file)?;
    let presets = repository.read(PRESETS)?;
    if presets.contains(&format!("[tech_{name}]\n")) {
        return Err(format!("`{PRESETS}` has `[tech_{name}]` already"));
    }
    let palette = repository.read("crates/scenes/src/palette.rs")?;
    let shapes =
        declared(&repository.read("crates/scenes/src/shape.rs")?, "    pub fn ", " -> Self");
    let colors = declared(&palette, "pub const ", ": DVec3");
    let picture = format!("target/tech_{name}.png");
    let next = vec![
        format!(
            "{file}: `about`, objects, the viewer and the lamp (tests house::described, scene)"
        ),
        format!(
            "  shapes (a `cuboid`, a `sphere` and a `torus` lie around the origin; `placed_at(x, y, z, turn)` puts one elsewhere): {shapes}"
        ),
        format!("  colours: {colors}"),
        format!("  materials of `material=array`: {}", materials(&palette)?),
        format!("{PRESETS}: `doc`, `look` and `source` of `tech_{name}` (test catalogue)"),
        format!("cargo run --release -- render tech_{name} -o {picture}; look at it"),
        "cargo xtask record render/".to_owned(),
        "cargo xtask docs; cargo xtask record guide".to_owned(),
    ];
    let preset = format!("{}\n\n{}", presets.trim_end(), PRESET.replace("NAME", name));
    let files = vec![(file, TEXT.replace("NAME", name)), (PRESETS.to_owned(), preset)];
    Ok(NewFiles { files, next })
}

/// Of each line that begins with `start`, the text up to `end`, joined by commas. Functions that
/// take `self` are left out.
fn declared(text: &str, start: &str, end: &str) -> String {
    let lines = text.lines().filter_map(|line| line.strip_prefix(start)?.split_once(end));
    let made = lines.map(|(what, _)| what).filter(|what| !what.contains("self"));
    made.collect::<Vec<_>>().join(", ")
}

/// The colours of the array of materials, each with its index.
fn materials(palette: &str) -> Result<String, String> {
    let fronts = palette.split_once("const FRONTS").and_then(|(_, rest)| rest.split_once("];"));
    let (fronts, _) = fronts.ok_or("`crates/scenes/src/palette.rs` has no `FRONTS`")?;
    let colors = fronts.lines().filter_map(|line| {
        Some(line.trim().strip_prefix("(DVec3::new(")?.split_once(')')?.0.to_owned())
    });
    let listed = colors.enumerate().map(|(index, color)| format!("{index} ({color})"));
    Ok(listed.collect::<Vec<_>>().join(", "))
}

const TEXT: &str = r#"//! NAME.

use glam::{DMat4, DVec3};

use super::palette::{self, CHALK, CORAL};
use super::{Eye, Lamp, LampKind, Material, Object, Scene, Set, base_scene, placed_at};
use crate::scene::shape::Shape;

/// The scene, for the table of all.
pub const SET: Set = Set { name: "NAME", about: "", make: scene };

pub fn scene() -> Scene {
    let glossy = Material::default().glossy(0.3).shiny(60.0);
    // A corner, and the two sides that begin there. Seen from the front, the second side is to the
    // left of the first.
    let ground = Shape::patch(
        DVec3::new(-6.0, 0.0, 6.0),
        DVec3::new(12.0, 0.0, 0.0),
        DVec3::new(0.0, 0.0, -12.0),
        (24, 24),
    );
    // A place is x, y, z and the turn about y. The last number is the object's index into the array of
    // materials, for `material=array`.
    let objects = vec![
        Object::new(ground, DMat4::IDENTITY, CHALK).of(Material::default(), 7),
        Object::new(
            Shape::cuboid(DVec3::new(0.8, 0.6, 0.8), 4),
            placed_at(0.0, 0.6, 0.0, 0.5),
            CORAL,
        )
        .of(glossy, 0),
    ];
    let eye = Eye {
        position: DVec3::new(0.0, 3.2, 8.0),
        target: DVec3::new(0.0, 0.5, 0.0),
        fov_y: 0.6,
        near: 0.5,
        far: 40.0,
    };
    // The first lamp casts the shadow. `lamps` adds nine more on a ring: its radius, its height, and
    // how bright they are.
    let key = Lamp {
        color: DVec3::new(1.0, 0.96, 0.88),
        position: DVec3::new(-2.0, 5.0, 3.0),
        target: DVec3::ZERO,
        half_angle: 0.5,
        kind: LampKind::Spot,
    };
    base_scene(objects, eye, palette::lamps(key, 4.5, 2.8, 0.22))
}
"#;

/// A spot light with a hard shadow. The scene chooses all of its numbers.
const PRESET: &str = r#"[tech_NAME]
doc = ""
look = ""
source = ""
program = "forward"
key = "lights=spot,max_lights=1,shadow=hard"
scene = "NAME"
passes = [{ program = "depth", key = "default" }]
open = [
    "caster.bias", "caster.min_w", "caster.normal_offset", "depth_pass.cull_front",
    "depth_pass.far", "depth_pass.fov", "depth_pass.near", "depth_pass.polygon_offset",
    "light.ambient", "light.attenuation", "light.axis", "light.color", "light.cutoff",
    "light.exponent", "light.position", "light.shadow_strength", "light.strength",
    "material.ambient", "material.diffuse", "material.emission", "material.shininess",
    "material.specular", "surroundings.color",
]
deviations = []
"#;
