//! What pictures need from programs and from the values of their axes. It is read from
//! `pictures.toml` of the library, which explains its own format.
//!
//! The code knows what a row can say. Which value of which axis says it is data. So a new value of
//! an axis takes one line, and a missing line is an error that names it.

use std::collections::BTreeMap;

use serde::Deserialize;
use toml::Spanned;

use lamplight_catalogue::preset::PresetNumber;
use lamplight_catalogue::reader;
use lamplight_diagnostic::source::{Embedded, SourceId, SourceSet, Span};
use lamplight_diagnostic::{Diagnostic, Diagnostics};
use lamplight_permute::{Axis, Manifest, Program, Settings};
use lamplight_scenes::sets::{LampKind, LampProfile, LampShape};

/// Path below the library.
const PATH: &str = "pictures.toml";

/// Numbers of uniforms, by block and field.
type Uniforms = BTreeMap<String, BTreeMap<String, PresetNumber>>;

/// The table of the library.
#[derive(Debug)]
pub struct NeedsTable {
    uniforms: Uniforms,
    programs: BTreeMap<String, ProgramNeeds>,
}

/// What pictures need from one program.
#[derive(Debug)]
struct ProgramNeeds {
    scene: Option<String>,
    screen: bool,
    before: Vec<String>,
    /// By axis and value.
    axes: BTreeMap<String, BTreeMap<String, NeedsRow>>,
}

/// What a picture needs from a permutation: the rows of the values of all its axes combined.
#[derive(Debug, Clone, Default)]
pub struct Needs {
    /// The passes before it: programs, and keys where these are not the default.
    pub before: Vec<(String, String)>,
    /// The passes after those. They show what the viewer sees, and this one reads them.
    pub seen: Vec<(String, String)>,
    /// Whether it is a full-screen pass. It reads the pass right before it, which shows what the
    /// viewer sees.
    pub screen: bool,
    /// Whether the colours are already encoded for a display. A picture then has them unchanged.
    pub encoded: bool,
    /// How many texels to each side a shadow lookup reads.
    pub reach: f64,
    /// The kind of all lamps. With `None` lamps keep the kinds that the scene gives them.
    pub lamps: Option<LampKind>,
    /// How many lamps the program has room for, if no axis says so.
    pub room: Option<usize>,
    /// The kind of the lamp that casts the shadow.
    pub caster: Option<LampKind>,
    pub falloff: Falloff,
    /// The shape of the area of lamps that have a position. With `None` they are points.
    pub shape: Option<LampShape>,
    /// How the light of lamps depends on its direction. With `None` it is the same in all
    /// directions.
    pub profile: Option<LampProfile>,
    /// Whether no lamp shines.
    pub unlit: bool,
    /// Whether each triangle has the normal of its face.
    pub faceted: bool,
    /// Whether one block holds the materials of all objects.
    pub material_array: bool,
    /// Whether each entry of that array is two materials: of the front and of the back of a
    /// surface.
    pub sides: bool,
    /// Whether that array has the materials of the objects, and not those that all scenes share.
    pub own_materials: bool,
    pub background: BackgroundKind,
    /// Whether haze behind everything is brighter towards the sun.
    pub sun: bool,
    /// Whether the specular map of the surroundings has a level for each roughness.
    pub levels: bool,
    /// The technique that the moments of depth 1 belong to. Empty texels have these.
    pub cleared: Cleared,
    /// Whether the shadow map has four parts, for parts of the viewer's depth.
    pub cascades: bool,
    /// The near plane of a spot light's shadow map.
    pub near: Option<f64>,
    uniforms: Uniforms,
}

/// How lamps fade with distance.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Falloff {
    #[default]
    None,
    Polynomial,
    LinearRadius,
    InverseSquareWindow,
    RangeGltf,
}

/// What is visible where nothing was drawn. If several values of axes choose it, the last one
/// decides.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum BackgroundKind {
    /// A dark background, darker towards the edges.
    #[default]
    Backdrop,
    Hemisphere,
    /// The light probe, unless a lamp shines.
    Probe,
    Surroundings,
    Haze,
}

/// How the materials of objects are bound.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
enum Materials {
    Array,
}

/// The content of an empty texel in a map of moments: those of depth 1, by the technique.
#[derive(Debug, Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Cleared {
    #[default]
    Vsm,
    Evsm,
    Esm,
    Msm,
}

/// A row as the file has it; [`Needs`] explains its fields.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, default, rename = "Row")]
struct NeedsRow {
    before: Vec<String>,
    /// By program.
    with: BTreeMap<String, String>,
    seen: Vec<String>,
    reach: Option<f64>,
    lamps: Option<LampKind>,
    room: Option<usize>,
    caster: Option<LampKind>,
    falloff: Option<Falloff>,
    shape: Option<LampShape>,
    profile: Option<LampProfile>,
    unlit: bool,
    faceted: bool,
    materials: Option<Materials>,
    sides: bool,
    own: bool,
    background: BackgroundKind,
    sun: bool,
    levels: bool,
    cleared: Option<Cleared>,
    encoded: bool,
    cascades: bool,
    near: Option<f64>,
    uniforms: Uniforms,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FileEntry {
    uniforms: Uniforms,
    program: BTreeMap<Spanned<String>, ProgramEntry>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ProgramEntry {
    scene: Option<String>,
    #[serde(default)]
    screen: bool,
    #[serde(default)]
    before: Vec<String>,
    #[serde(default)]
    axis: BTreeMap<Spanned<String>, BTreeMap<Spanned<String>, NeedsRow>>,
}

impl NeedsTable {
    /// The library's table. Each value of an axis that is listed has a row.
    ///
    /// # Errors
    /// Values without a row, and rows for values that no axis has.
    pub fn load(
        library: Embedded,
        sources: &mut SourceSet,
        manifest: &Manifest,
    ) -> Result<Self, Diagnostics> {
        let id = reader::add_own(library, sources, PATH)?;
        Self::parse(sources, id, manifest)
    }

    /// The table that a file holds.
    ///
    /// # Errors
    /// As of [`NeedsTable::load`].
    pub fn parse(
        sources: &SourceSet,
        id: SourceId,
        manifest: &Manifest,
    ) -> Result<Self, Diagnostics> {
        let entry: FileEntry = reader::read_data(sources, id)?;
        let problems: Diagnostics = entry
            .program
            .iter()
            .flat_map(|(name, entry)| check_needs(id, manifest, name, entry))
            .collect();
        if !problems.is_empty() {
            return Err(problems);
        }
        let programs = entry.program.into_iter();
        Ok(Self {
            uniforms: entry.uniforms,
            programs: programs.map(|(name, entry)| (name.into_inner(), entry.into())).collect(),
        })
    }

    /// The scene that a program shows where none is asked for; `None` if the program draws no
    /// picture by itself.
    pub fn scene(&self, program: &str) -> Option<&str> {
        self.programs.get(program)?.scene.as_deref()
    }

    /// Programs that draw pictures by themselves.
    pub fn pictures(&self) -> Vec<&str> {
        let shown = self.programs.iter().filter(|(_, needs)| needs.scene.is_some());
        shown.map(|(name, _)| name.as_str()).collect()
    }

    pub fn needs(&self, program: &str, settings: &Settings) -> Needs {
        let mut needs = Needs { reach: 1.0, uniforms: self.uniforms.clone(), ..Needs::default() };
        let Some(found) = self.programs.get(program) else { return needs };
        needs.before.extend(split_passes(&found.before));
        needs.screen = found.screen;
        let value = |axis: &String| settings.values.get(axis).map(ToString::to_string);
        let chosen = found.axes.iter().filter_map(|(axis, rows)| rows.get(&value(axis)?));
        let rows: Vec<&NeedsRow> = chosen.collect();
        rows.iter().for_each(|row| needs.add(row));
        // The pass may be that of a later row.
        rows.iter().flat_map(|row| &row.with).for_each(|more| needs.add_settings(more));
        needs
    }
}

impl Needs {
    /// The numbers of a uniform's field that has them in this table.
    pub fn uniform(&self, block: &str, field: &str) -> Option<Vec<f64>> {
        self.uniforms.get(block)?.get(field).map(PresetNumber::to_vec)
    }

    /// How many passes right before it show what the viewer sees.
    pub fn seen_before(&self) -> usize {
        self.seen.len() + usize::from(self.screen)
    }

    /// Whether something casts a shadow: a pass before draws the map of a light.
    pub fn has_shadow(&self) -> bool {
        self.before.len() > usize::from(self.screen)
    }

    /// Whether the shadow map may be one of several, for parts of the viewer's depth.
    pub fn takes_cascades(&self) -> bool {
        self.seen_before() == 0
            && self.has_shadow()
            && !self.cascades
            && self.caster == Some(LampKind::Directional)
    }

    fn add(&mut self, row: &NeedsRow) {
        self.before.extend(split_passes(&row.before));
        // Two axes may read one pass.
        let seen = split_passes(&row.seen).filter(|pass| !self.seen.contains(pass));
        self.seen.extend(seen.collect::<Vec<_>>());
        self.reach = row.reach.unwrap_or(self.reach);
        self.lamps = row.lamps.or(self.lamps);
        self.room = row.room.or(self.room);
        self.caster = row.caster.or(self.caster);
        self.falloff = row.falloff.unwrap_or(self.falloff);
        self.shape = row.shape.or(self.shape);
        self.profile = row.profile.or(self.profile);
        self.unlit |= row.unlit;
        self.faceted |= row.faceted;
        self.material_array |= row.materials.is_some();
        self.sides |= row.sides;
        self.own_materials |= row.own;
        self.background = self.background.max(row.background);
        self.sun |= row.sun;
        self.levels |= row.levels;
        self.cleared = row.cleared.unwrap_or(self.cleared);
        self.encoded |= row.encoded;
        self.cascades |= row.cascades;
        self.near = row.near.or(self.near);
        for (block, fields) in &row.uniforms {
            let all = self.uniforms.entry(block.clone()).or_default();
            all.extend(fields.iter().map(|(field, number)| (field.clone(), number.clone())));
        }
    }

    /// Adds settings to the keys of the passes of a program.
    fn add_settings(&mut self, (program, settings): (&String, &String)) {
        for (_, key) in self.before.iter_mut().filter(|(name, _)| name == program) {
            *key = if key.is_empty() { settings.clone() } else { format!("{key},{settings}") };
        }
    }
}

/// The program and the key of each pass.
fn split_passes(passes: &[String]) -> impl Iterator<Item = (String, String)> {
    passes.iter().map(|pass| {
        let (program, key) = pass.split_once(' ').unwrap_or((pass, ""));
        (program.to_owned(), key.trim().to_owned())
    })
}

impl From<ProgramEntry> for ProgramNeeds {
    fn from(entry: ProgramEntry) -> Self {
        let rows = |rows: BTreeMap<Spanned<String>, NeedsRow>| {
            rows.into_iter().map(|(value, row)| (value.into_inner(), row)).collect()
        };
        let axes = entry.axis.into_iter().map(|(axis, table)| (axis.into_inner(), rows(table)));
        Self {
            scene: entry.scene,
            screen: entry.screen,
            before: entry.before,
            axes: axes.collect(),
        }
    }
}

/// Errors in a program's tables.
fn check_needs(
    id: SourceId,
    manifest: &Manifest,
    name: &Spanned<String>,
    entry: &ProgramEntry,
) -> Diagnostics {
    let Some(program) = manifest.program(name.get_ref()) else {
        let message = format!("there is no program `{}`", name.get_ref());
        return vec![reader::invalid_data(Span::new(id, name.span()), message)];
    };
    entry.axis.iter().flat_map(|(axis, rows)| check_axis(id, program, axis, rows)).collect()
}

fn check_axis(
    id: SourceId,
    program: &Program,
    name: &Spanned<String>,
    rows: &BTreeMap<Spanned<String>, NeedsRow>,
) -> Diagnostics {
    let span = Span::new(id, name.span());
    let Some(axis) = program.space.axis(name.get_ref()) else {
        let message = format!("`{}` has no axis `{}`", program.name, name.get_ref());
        return vec![reader::invalid_data(span, message)];
    };
    let values = axis.value_names();
    let unknown = rows.keys().filter(|value| !values.contains(value.get_ref())).map(|value| {
        let message = format!("axis `{}` has no value `{}`", axis.name, value.get_ref());
        reader::invalid_data(Span::new(id, value.span()), message)
    });
    let is_listed = |value: &String| rows.keys().any(|row| row.get_ref() == value);
    let missing = values.iter().filter(|value| !is_listed(value));
    unknown.chain(missing.map(|value| without_row(axis, value, span))).collect()
}

fn without_row(axis: &Axis, value: &str, span: Span) -> Diagnostic {
    reader::invalid_data(span, format!("no row for `{}={value}`", axis.name))
        .at(axis.span, "the axis has the value")
        .note(format!("help: write `{value} = {{}}` if pictures need nothing for it"))
}
