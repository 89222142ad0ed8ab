//! Presets: each is a published example, as a permutation with a scene and its numbers.
//!
//! `presets.toml` is one table a preset:
//!
//! ```toml
//! [hpg_5_shadow]
//! doc = "A hard shadow that takes away half of the diffuse light."
//! look = "The rim of a shadow has steps, and no shadow is darker than half of the light."
//! source = "Movania et al., OpenGL: Build High Performance Graphics, 2017, chapter 4, shadow mapping"
//! program = "published"
//! key = "example=hpg_5"
//! safe = "ambient=none,lights=point,max_lights=1,shadow=hard,specular=none"
//! scene = "casters"
//! passes = [{ program = "depth", key = "default" }]
//! light = { shadow_strength = 0.5 }
//! open = ["light.color", "light.position"]
//! deviations = ["The scene is a ball, a ring and a box. The recipe's is a cube and a sphere on a plane."]
//! ```
//!
//! `look` says what to look for in the picture. The tables `object`, `light`, `area`, `material`,
//! `layers`, `surroundings`, `haze`, `caster`, `moments`, `display`, `march`, `horizon` and `lobe`
//! have the numbers that the source publishes, named after the fields of the uniform they go to.
//! Those of `object` are for all objects. `depth_pass` has what the shadow map is drawn with:
//! `polygon_offset`, `cull_front`, `size` in texels along an edge of a map of depths (maps of
//! moments and the faces of cube maps have half of it), and of a spot light the whole angle `fov`
//! in degrees and the planes `near` and `far` in scene units. `open` names the numbers that the
//! source leaves to its reader, or to models of its own: the scene and the renderer choose them.
//! Every number that the permutation reads is in one or the other; those of the blocks `cascades`,
//! `clusters`, `probes` and `room` are neither, since they must agree with maps and lists that are
//! made of the scene. `deviations` says how the picture differs from the example, and why. It is
//! empty if it does not differ. `safe` is the key of `forward` for the same example in the form that
//! is safe to use, if the preset draws what is printed.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};
use toml::Spanned;

use super::probe::Probe;
use super::{natural, reader};
use lamplight_diagnostic::source::{Embedded, SourceId, SourceSet, Span};
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_permute::{Manifest, Program, Quoted, key};
use lamplight_scenes::sets;

/// One example.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Preset {
    pub name: String,
    pub doc: String,
    /// What to look for in the picture.
    pub look: String,
    /// The publication and the place in it.
    pub source: String,
    /// What is drawn last, into the picture.
    pub program: String,
    /// Its permutation, canonical.
    pub key: String,
    /// One of [`sets::ALL`].
    pub scene: String,
    /// One of the light probes, if the example is about one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub probe: Option<String>,
    /// The passes before it, in order.
    pub passes: Vec<PresetPass>,
    /// Published numbers by group, then by field.
    pub numbers: BTreeMap<String, BTreeMap<String, PresetNumber>>,
    /// Numbers that the source leaves open, as `group.field`, sorted.
    pub open: BTreeSet<String>,
    /// How the picture differs from the example: one or more sentences for each difference.
    pub deviations: Vec<String>,
    /// The key of [`SAFE`] that draws the example in the form that is safe to use, if the preset
    /// draws it as it is printed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub safe: Option<String>,
    /// Numbers of lamps that the safe form has instead of those of `numbers`: where lamps fade in
    /// another way, as much light has to leave them that the same arrives.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    pub safe_light: BTreeMap<String, PresetNumber>,
}

/// The program that draws examples in the form that is safe to use.
pub const SAFE: &str = "forward";

/// The headings of presets, by the prefixes of their names: the authors of the work that they are
/// from, or what those have in common that show a technique instead of an example from a book.
const WORKS: [(&str, &str); 5] = [
    ("oglpg_", "Kessenich, Sellers, Shreiner"),
    ("hpg_", "Movania et al."),
    ("ncl_", "Newcastle University"),
    ("igl_", "Igalia"),
    ("tech_", "Techniques of today"),
];

impl Preset {
    /// The authors of the work that it is from. All techniques are together.
    pub fn work(&self) -> &str {
        let known = WORKS.iter().find(|(prefix, _)| self.name.starts_with(prefix));
        known.map_or_else(|| self.source.split(", ").next().unwrap_or_default(), |(_, work)| work)
    }

    /// The example in the form that is safe to use, with the same scene, and the same numbers but for
    /// those of [`Self::safe_light`].
    #[must_use]
    pub fn safe_form(&self) -> Option<Self> {
        let key = self.safe.clone()?;
        let mut safe = Self { program: SAFE.to_owned(), key, safe: None, ..self.clone() };
        let lamps = std::mem::take(&mut safe.safe_light);
        if !lamps.is_empty() {
            safe.numbers.entry("light".to_owned()).or_default().extend(lamps);
        }
        Some(safe)
    }
}

/// An earlier pass.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PresetPass {
    pub program: String,
    pub key: String,
}

/// A number or a vector.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged, rename = "Number")]
pub enum PresetNumber {
    Scalar(f64),
    Vector(Vec<f64>),
}

impl PresetNumber {
    pub fn to_vec(&self) -> Vec<f64> {
        match self {
            Self::Scalar(value) => vec![*value],
            Self::Vector(values) => values.clone(),
        }
    }
}

impl std::fmt::Display for PresetNumber {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Scalar(value) => write!(f, "{value}"),
            Self::Vector(values) => {
                f.write_str(&values.iter().map(f64::to_string).collect::<Vec<_>>().join(", "))
            }
        }
    }
}

type NumberGroup = BTreeMap<String, PresetNumber>;
type PresetEntries = BTreeMap<Spanned<String>, PresetEntry>;

/// A preset in the form of the file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename = "Entry")]
struct PresetEntry {
    doc: String,
    look: String,
    source: String,
    program: Spanned<String>,
    key: Spanned<String>,
    scene: Spanned<String>,
    probe: Option<Spanned<String>>,
    #[serde(default)]
    passes: Vec<PassEntry>,
    #[serde(default)]
    object: NumberGroup,
    #[serde(default)]
    light: NumberGroup,
    #[serde(default)]
    area: NumberGroup,
    #[serde(default)]
    material: NumberGroup,
    #[serde(default)]
    layers: NumberGroup,
    #[serde(default)]
    surroundings: NumberGroup,
    #[serde(default)]
    haze: NumberGroup,
    #[serde(default)]
    caster: NumberGroup,
    #[serde(default)]
    moments: NumberGroup,
    #[serde(default)]
    display: NumberGroup,
    #[serde(default)]
    march: NumberGroup,
    #[serde(default)]
    horizon: NumberGroup,
    #[serde(default)]
    lobe: NumberGroup,
    #[serde(default)]
    depth_pass: NumberGroup,
    #[serde(default)]
    open: Vec<Spanned<String>>,
    deviations: Vec<String>,
    safe: Option<Spanned<String>>,
    safe_light: Option<Spanned<NumberGroup>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PassEntry {
    program: Spanned<String>,
    key: Spanned<String>,
}

/// Path of the presets below the library's root.
pub const PATH: &str = "presets.toml";

/// The library's presets, in their natural order; its manifest comes from
/// [`lamplight_compose::project::library_manifest`].
pub fn library_presets(
    library: Embedded,
    sources: &mut SourceSet,
    manifest: &Manifest,
    probes: &[Probe],
) -> Result<Vec<Preset>, Diagnostics> {
    let id = reader::add_own(library, sources, PATH)?;
    parse_presets(sources, id, manifest, probes)
}

/// Reads the presets that are in the set, in their natural order; programs and keys are the
/// manifest's.
///
/// Every mistake is reported: programs, scenes and probes that do not exist, keys that are not
/// canonical, break a constraint or do not ship.
pub fn parse_presets(
    sources: &SourceSet,
    id: SourceId,
    manifest: &Manifest,
    probes: &[Probe],
) -> Result<Vec<Preset>, Diagnostics> {
    let entries: PresetEntries = reader::read_data(sources, id)?;
    let mut checker = Checker { sources, id, manifest, probes, problems: Vec::new() };
    let mut presets: Vec<Preset> =
        entries.into_iter().map(|(name, entry)| checker.preset(name.into_inner(), entry)).collect();
    presets.sort_by(|a, b| natural::natural_order(&a.name, &b.name));
    if checker.problems.is_empty() { Ok(presets) } else { Err(checker.problems) }
}

struct Checker<'s> {
    sources: &'s SourceSet,
    id: SourceId,
    manifest: &'s Manifest,
    probes: &'s [Probe],
    problems: Diagnostics,
}

impl Checker<'_> {
    fn preset(&mut self, name: String, entry: PresetEntry) -> Preset {
        self.references(&entry);
        let groups = [
            ("object", entry.object),
            ("light", entry.light),
            ("area", entry.area),
            ("material", entry.material),
            ("layers", entry.layers),
            ("surroundings", entry.surroundings),
            ("haze", entry.haze),
            ("caster", entry.caster),
            ("moments", entry.moments),
            ("display", entry.display),
            ("march", entry.march),
            ("horizon", entry.horizon),
            ("lobe", entry.lobe),
            ("depth_pass", entry.depth_pass),
        ];
        for name in &entry.open {
            self.open(name, &groups);
        }
        Preset {
            name,
            doc: entry.doc,
            look: entry.look,
            source: entry.source,
            program: entry.program.into_inner(),
            key: entry.key.into_inner(),
            scene: entry.scene.into_inner(),
            probe: entry.probe.map(Spanned::into_inner),
            passes: entry.passes.into_iter().map(PresetPass::from).collect(),
            numbers: groups
                .into_iter()
                .filter(|(_, group)| !group.is_empty())
                .map(|(name, group)| (name.to_owned(), group))
                .collect(),
            open: entry.open.into_iter().map(Spanned::into_inner).collect(),
            deviations: entry.deviations,
            safe: entry.safe.map(Spanned::into_inner),
            safe_light: entry.safe_light.map(Spanned::into_inner).unwrap_or_default(),
        }
    }

    /// The scene, the probe and the permutations that a preset names must be there.
    fn references(&mut self, entry: &PresetEntry) {
        self.known("scene", &entry.scene, sets::ALL.iter().map(|set| set.name));
        if let Some(probe) = &entry.probe {
            self.known("light probe", probe, self.probes.iter().map(|probe| probe.name.as_str()));
        }
        self.permutation(&entry.program, &entry.key);
        for pass in &entry.passes {
            self.permutation(&pass.program, &pass.key);
        }
        let safe = |key: &Spanned<String>| Spanned::new(key.span(), SAFE.to_owned());
        entry.safe.iter().for_each(|key| self.permutation(&safe(key), key));
        if let (None, Some(lamps)) = (&entry.safe, &entry.safe_light) {
            let problem = "`safe_light` is for a preset that has a field `safe`".to_owned();
            self.problems.push(reader::invalid_data(self.span(lamps), problem));
        }
    }

    /// A number that is open must not be given, and must be in one of the groups.
    fn open(&mut self, name: &Spanned<String>, groups: &[(&str, NumberGroup)]) {
        let text = name.get_ref();
        let (group, field) = text.split_once('.').unwrap_or((text, ""));
        let problem = match groups.iter().find(|(known, _)| *known == group) {
            _ if field.is_empty() => format!("`{text}` is not of the form `group.field`"),
            Some((_, fields)) if fields.contains_key(field) => {
                format!("`{text}` is open, and has a number")
            }
            Some(_) => return,
            None => {
                let unknown = format!("there is no group `{group}`");
                let known = groups.iter().map(|(known, _)| *known);
                let problem = reader::invalid_data(self.span(name), unknown).suggest(group, known);
                return self.problems.push(problem);
            }
        };
        self.problems.push(reader::invalid_data(self.span(name), problem));
    }

    fn known<'a>(
        &mut self,
        what: &str,
        name: &Spanned<String>,
        known: impl Iterator<Item = &'a str> + Clone,
    ) {
        if !known.clone().any(|known| known == name.get_ref()) {
            let wrong = name.get_ref();
            self.problems.push(
                reader::invalid_data(self.span(name), format!("there is no {what} `{wrong}`"))
                    .suggest(wrong, known),
            );
        }
    }

    fn permutation(&mut self, program: &Spanned<String>, key: &Spanned<String>) {
        let name = program.get_ref();
        let Some(found) = self.manifest.program(name) else {
            let unknown =
                Diagnostic::error(codes::UNKNOWN_PROGRAM, format!("there is no program `{name}`"));
            let known = self.manifest.programs.iter().map(|program| program.name.as_str());
            self.problems
                .push(unknown.at(self.span(program), "not in the manifest").suggest(name, known));
            return;
        };
        let quoted = Quoted::toml(self.sources, self.span(key), key.get_ref());
        let problems = check_key(found, &quoted);
        self.problems.extend(problems);
    }

    fn span<T>(&self, text: &Spanned<T>) -> Span {
        Span::new(self.id, text.span())
    }
}

/// Errors in a preset's key, which must be canonical, valid and shipped.
fn check_key(program: &Program, text: &Quoted) -> Diagnostics {
    let point = match key::parse(&program.space, text) {
        Ok(point) => point,
        Err(problems) => return problems,
    };
    let broken = program.space.broken(&point).map(|constraint| {
        Diagnostic::error(
            codes::INVALID_PERMUTATION,
            format!("permutation `{}` breaks the constraint `{}`", text.text, constraint.text),
        )
        .at(text.span, "this permutation")
    });
    let mut problems: Diagnostics = broken.collect();
    let canonical = program.space.key(&point);
    if canonical.as_str() != text.text {
        problems.push(reader::invalid_data(
            text.span,
            format!("the permutation's name is `{canonical}`"),
        ));
    }
    if problems.is_empty() && !program.space.contains(&point) {
        let message = format!("permutation `{canonical}` of `{}` does not ship", program.name);
        problems.push(
            reader::invalid_data(text.span, message)
                .note("help: add it to `include` in the manifest"),
        );
    }
    problems
}

impl From<PassEntry> for PresetPass {
    fn from(entry: PassEntry) -> Self {
        Self { program: entry.program.into_inner(), key: entry.key.into_inner() }
    }
}
