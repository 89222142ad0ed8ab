//! Plans a picture: which permutations are drawn, in which order, with which numbers.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::DVec3;

use super::needs::Needs;
use crate::frame::Programs;
use lamplight_catalogue::preset::{Preset, PresetNumber};
use lamplight_catalogue::probe::Probe;
use lamplight_diagnostic::source::SourceSet;
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_permute::manifest::Program;
use lamplight_permute::{Assignment, Quoted, Setting, Settings, key};
use lamplight_scenes::sets::{self, Lamp, Scene};

/// The axis that says how many lamps a program can have.
pub(super) const LAMPS: &str = "max_lights";

/// Everything about a picture, except how it is taken.
#[derive(Debug, Clone)]
pub struct Plan {
    /// The name of the scene, one of [`sets::ALL`](lamplight_scenes::sets::ALL).
    pub scene: String,
    /// A scene that was read from a file, instead of the named one.
    pub model: Option<Arc<Scene>>,
    /// The passes in order. The last one draws the picture.
    pub passes: Vec<Pass>,
    /// Published numbers by group and field, as in [`Preset`].
    pub numbers: BTreeMap<String, BTreeMap<String, PresetNumber>>,
    /// The nine coefficients of the ambient light, if a probe is given.
    pub probe: Option<[[f64; 3]; 9]>,
    /// What somebody changed in the picture.
    pub changes: Changes,
}

/// Changes. They take precedence over what the source published and over what the scene has.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Changes {
    /// Places of lamps by their index. A lamp that is moved shines at the same point as before.
    pub lamps: BTreeMap<usize, DVec3>,
    /// Numbers of uniforms by path, such as `lamps.lights[2].color`.
    pub uniforms: BTreeMap<String, Vec<f64>>,
    /// How far the viewer has walked around the point that is looked at, and up, in radians.
    pub turn: [f64; 2],
}

#[derive(Debug, Clone)]
pub struct Pass {
    pub program: String,
    pub key: String,
    pub settings: Settings,
    /// What a picture needs from it.
    pub needs: Needs,
}

impl Plan {
    /// The passes and numbers of a preset.
    ///
    /// # Errors
    /// Programs and keys that the manifest does not have. The library's presets have no such error.
    pub fn of_preset(
        programs: &Programs,
        preset: &Preset,
        probes: &[Probe],
    ) -> Result<Self, Diagnostics> {
        let earlier = preset.passes.iter().map(|pass| (pass.program.as_str(), pass.key.as_str()));
        let all = earlier.chain([(preset.program.as_str(), preset.key.as_str())]);
        let probe =
            preset.probe.as_ref().and_then(|name| probes.iter().find(|probe| probe.name == *name));
        Ok(Self {
            scene: preset.scene.clone(),
            model: None,
            passes: all
                .map(|(program, key)| Pass::new(programs, program, key))
                .collect::<Result<_, _>>()?,
            numbers: preset.numbers.clone(),
            probe: probe.map(|probe| probe.coefficients),
            changes: Changes::default(),
        })
    }

    /// A point of a program's space by its key, with the passes that it needs before it.
    ///
    /// # Errors
    /// A program or key that the manifest does not have, or that breaks a constraint.
    pub fn of_key(programs: &Programs, program: &str, text: &str) -> Result<Self, Diagnostics> {
        let found = known_program(programs, program)?;
        let point = programs.with_texts(|texts| {
            let id = texts.add("key", text.to_owned());
            key::parse(&found.space, &Quoted::whole(texts, id))
        })?;
        if let Some(constraint) = found.space.broken(&point).next() {
            let sentence = constraint.doc.as_ref().unwrap_or(&constraint.text);
            let message = format!("`{text}` is not a permutation of `{program}`: {sentence}");
            return Err(vec![Diagnostic::error(codes::INVALID_PERMUTATION, message)]);
        }
        Self::of_point(programs, found, &point)
    }

    /// A point of a program's space, with the passes that it needs before it.
    ///
    /// # Errors
    /// The program does not draw a picture.
    pub fn of_point(
        programs: &Programs,
        program: &Program,
        point: &Assignment,
    ) -> Result<Self, Diagnostics> {
        let Some(scene) = programs.pictures().scene(&program.name) else {
            let message = format!("the program `{}` draws no picture by itself", program.name);
            let note = format!("programs that do: {}", programs.pictures().pictures().join(", "));
            return Err(vec![Diagnostic::error(codes::UNKNOWN_PROGRAM, message).note(note)]);
        };
        let last = Pass::at(programs, program, point);
        let earlier = last
            .needs
            .before
            .iter()
            .chain(&last.needs.seen)
            .map(|(program, key)| Pass::new(programs, program, key))
            .collect::<Result<Vec<_>, _>>()?;
        let passes = earlier.into_iter().chain([last]).collect();
        Ok(Self {
            scene: scene.to_owned(),
            model: None,
            passes,
            numbers: BTreeMap::new(),
            probe: None,
            changes: Changes::default(),
        })
    }

    /// The pass that draws the picture.
    pub fn last(&self) -> Option<&Pass> {
        self.passes.last()
    }

    pub(super) fn is_last(&self, pass: &Pass) -> bool {
        self.last().is_some_and(|last| std::ptr::eq(last, pass))
    }

    /// The pass whose axes say how the scene is lit: the last one that has lamps, or else the one
    /// that draws the picture.
    pub(super) fn lit(&self) -> Option<&Pass> {
        let mut passes = self.passes.iter().rev();
        passes.find(|pass| pass.integer(LAMPS).is_some()).or_else(|| self.last())
    }

    /// Whether a pass shows what the viewer sees, and not what the light sees: the last one, and
    /// the passes right before it that [`Needs::seen_before`] counts.
    pub(super) fn is_of_viewer(&self, pass: &Pass) -> bool {
        let over = self.last().map_or(0, |last| last.needs.seen_before());
        self.passes.iter().rev().take(1 + over).any(|one| std::ptr::eq(one, pass))
    }

    /// The scene, with its lamps where the source has them or where they were moved.
    ///
    /// # Errors
    /// There is no such scene, it has no lamp, or it has too many materials for one array.
    pub(super) fn staged(&self) -> Result<Scene, Diagnostics> {
        let failed = |message| vec![Diagnostic::error(codes::EXECUTOR_FAILED, message)];
        let scene = self.model.as_deref().cloned().or_else(|| sets::scene(&self.scene));
        let mut scene =
            scene.ok_or_else(|| failed(format!("there is no scene `{}`", self.scene)))?;
        let key = scene.lamps.first_mut();
        self.place(key.ok_or_else(|| failed("the scene has no lamp".to_owned()))?);
        for (index, place) in &self.changes.lamps {
            if let Some(lamp) = scene.lamps.get_mut(*index) {
                lamp.position = *place;
            }
        }
        if self.changes.turn != [0.0; 2] {
            scene.eye = scene.eye.turned(self.changes.turn);
        }
        match self.lit() {
            Some(lit) => with_numbers(scene, &lit.needs),
            None => Ok(scene),
        }
    }

    /// Moves a lamp to where the source has it, so that its shadow falls from there.
    fn place(&self, lamp: &mut Lamp) {
        let vector = |field| {
            self.number("light", field)
                .and_then(|values| values.try_into().ok())
                .map(DVec3::from_array)
        };
        let (axis, reach) = (lamp.axis(), lamp.reach());
        lamp.position = vector("position").unwrap_or(lamp.position);
        if let Some(axis) = vector("axis").or_else(|| vector("position").map(|_| axis)) {
            lamp.target = lamp.position + axis * reach;
        }
        if let Some(cutoff) =
            self.number("light", "cutoff").and_then(|values| values.first().copied())
        {
            lamp.half_angle = cutoff.clamp(-1.0, 1.0).acos();
        }
    }

    /// A published number.
    pub fn number(&self, group: &str, field: &str) -> Option<Vec<f64>> {
        self.numbers.get(group)?.get(field).map(PresetNumber::to_vec)
    }
}

/// The scene. If the picture needs the objects' own materials, the scene's array has these.
///
/// # Errors
/// It has too many materials for one array.
pub(super) fn with_numbers(mut scene: Scene, needs: &Needs) -> Result<Scene, Diagnostics> {
    if needs.own_materials {
        let failed = |message| vec![Diagnostic::error(codes::EXECUTOR_FAILED, message)];
        scene.number_materials().map_err(failed)?;
    }
    Ok(scene)
}

/// The program of that name.
///
/// # Errors
/// There is none.
pub(super) fn known_program<'p>(
    programs: &'p Programs,
    name: &str,
) -> Result<&'p Program, Diagnostics> {
    let unknown = || {
        let message = format!("there is no program `{name}`");
        vec![Diagnostic::error(codes::UNKNOWN_PROGRAM, message)]
    };
    programs.manifest().program(name).ok_or_else(unknown)
}

impl Pass {
    fn new(programs: &Programs, program: &str, text: &str) -> Result<Self, Diagnostics> {
        let found = known_program(programs, program)?;
        let mut texts = SourceSet::default();
        let id = texts.add("key", text.to_owned());
        let point = key::parse(&found.space, &Quoted::whole(&texts, id))?;
        Ok(Self::at(programs, found, &point))
    }

    fn at(programs: &Programs, program: &Program, point: &Assignment) -> Self {
        let settings = program.space.settings(point);
        Self {
            program: program.name.clone(),
            key: program.space.key(point).to_string(),
            needs: programs.pictures().needs(&program.name, &settings),
            settings,
        }
    }

    /// The integer value of an axis.
    pub fn integer(&self, axis: &str) -> Option<i64> {
        match self.settings.values.get(axis) {
            Some(Setting::Int(value)) => Some(*value),
            _ => None,
        }
    }
}
