//! What the stages ask for, and what they get: uniforms, textures, samplers and buffers.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use lamplight_bundle::{Binding, BindingKind, Member};
use lamplight_diagnostic::{Diagnostic, Diagnostics};
use lamplight_execute::fixture::{Fixture, FixtureTexture};
use lamplight_execute::frame::Buffers;
use lamplight_scene::Clip;
use lamplight_scenes::sets::TextureMap;

use super::around::Around;
use super::defaults::default_numbers;
use super::matrices::{is_model_view, lacks_view};
use super::shape::{NumberType, short_type};
use super::stages::{OwnStage, OwnStages};
use super::table::{Origin, Row, RowKind, numbers_text};
use super::textures::{
    default_content, default_texture, named_texture, plain_sampler, texture_levels,
};
use super::values::{Chosen, GivenValue, Leaf, UniformValue, assign_values};
use super::{GivenTexture, OwnRequest, TextureContent, at_given, refused};
use crate::controls::Uniform;
use crate::frame::{buffer_leaves, pack_buffer};
use crate::sketch::{LISTED, UNIFORM_BYTES};
use crate::{Shot, Surroundings};

/// The most bytes of a storage buffer of zeros.
const STORAGE_BYTES: u32 = 16 << 20;
/// Bytes that a storage buffer has beyond what is declared, for an array without a length.
const BEYOND: u32 = 1 << 10;
/// How many rows back an earlier element of the same array is looked for.
const NEAR: usize = 64;
/// The most rows of uniforms in a table.
const ROWS: usize = 200;

/// The place of a binding.
type Place = (u32, u32);

/// A binding of one stage, or of both.
#[derive(Clone, Copy)]
struct Bound<'s> {
    binding: &'s Binding,
    stage: &'s OwnStage,
}

/// The bindings of both stages, with what does not depend on the object.
pub struct BoundStages<'s> {
    bound: Vec<Bound<'s>>,
    chosen: Chosen,
    texture_rows: Vec<Row>,
    notes: Vec<String>,
    /// Storage buffers.
    pub shared: Buffers,
    pub fixtures: BTreeMap<Place, Arc<Fixture>>,
    pub levels: BTreeMap<Place, Vec<FixtureTexture>>,
}

impl<'s> BoundStages<'s> {
    /// Finds values and textures for all bindings.
    ///
    /// # Errors
    /// Those of [`prepare_own`](super::prepare_own).
    pub fn new(
        stages: &'s OwnStages,
        request: &OwnRequest,
        shot: &Shot,
    ) -> Result<Self, Diagnostics> {
        let bound = all_bindings(stages);
        let errors: Diagnostics = bound.iter().filter_map(refusal).collect();
        if !errors.is_empty() {
            return Err(errors);
        }
        let leaves = bound.iter().flat_map(leaves_of).map(|(_, leaf)| leaf).collect::<Vec<_>>();
        let chosen = assign_values(&leaves, &request.given, request.linear)?;
        let mut found = Self {
            bound,
            chosen,
            texture_rows: Vec::new(),
            notes: Vec::new(),
            shared: Buffers::new(),
            fixtures: BTreeMap::new(),
            levels: BTreeMap::new(),
        };
        found.check_textures(request)?;
        found.bind_all(request, shot)?;
        Ok(found)
    }

    fn check_textures(&self, request: &OwnRequest) -> Result<(), Diagnostics> {
        let known: Vec<&str> = self.textures().map(|one| one.binding.name.as_str()).collect();
        let is_known =
            |name: &str| known.contains(&name) || known.contains(&member_name(name).as_str());
        let wrong = request.textures.iter().filter(|(name, _)| !is_known(name));
        let error = |(name, given): (&String, &GivenTexture)| {
            let error = refused(&format!("no stage reads a texture `{name}`"));
            let error = error.suggest(name, known.iter().copied());
            let error = match known.is_empty() {
                true => error.note("help: there are no textures"),
                false => error.note(format!("textures: {}", known.join(", "))),
            };
            at_given(error, given.span)
        };
        let errors: Diagnostics = wrong.map(error).collect();
        if errors.is_empty() { Ok(()) } else { Err(errors) }
    }

    fn textures(&self) -> impl Iterator<Item = &Bound<'s>> {
        self.bound.iter().filter(|one| one.binding.kind == BindingKind::Texture)
    }

    fn bind_all(&mut self, request: &OwnRequest, shot: &Shot) -> Result<(), Diagnostics> {
        let mut errors = Diagnostics::new();
        for bound in self.bound.clone() {
            let (binding, place) = (bound.binding, (bound.binding.group, bound.binding.binding));
            match binding.kind {
                BindingKind::Sampler | BindingKind::ComparisonSampler => {
                    self.fixtures.insert(place, Arc::new(plain_sampler(binding)));
                }
                BindingKind::Texture => {
                    errors.extend(self.bind_texture(&bound, request, shot).err());
                }
                BindingKind::Storage => {
                    let size = binding.size.unwrap_or(0).next_multiple_of(16) + BEYOND;
                    self.shared.insert(place, vec![0; size as usize]);
                    let note = format!("the storage buffer `{}` holds zeros", binding.name);
                    self.notes.push(note);
                }
                BindingKind::Uniform | BindingKind::StorageTexture | BindingKind::Immediate => {}
            }
        }
        if errors.is_empty() { Ok(()) } else { Err(errors) }
    }

    fn bind_texture(
        &mut self,
        bound: &Bound<'_>,
        request: &OwnRequest,
        shot: &Shot,
    ) -> Result<(), Diagnostic> {
        let binding = bound.binding;
        let mut all = request.textures.iter();
        let given = all
            .find(|(name, _)| **name == binding.name || member_name(name) == binding.name)
            .map(|(_, given)| given);
        let (map, sky, value, from) = match given {
            Some(given) => {
                let (map, sky) = given_content(bound, given, shot)?;
                (map, sky, given.text.clone(), given.origin)
            }
            None => {
                let (value, by_name) = default_content(&binding.name, &binding.ty);
                let map = named_texture(default_texture(&binding.name).0).unwrap_or_else(blank_map);
                let from = if by_name { Origin::Name } else { Origin::Type };
                (map, shot.surroundings.clone(), value.to_owned(), from)
            }
        };
        // OpenGL counts the rows of a texture from the bottom.
        let is_turned = bound.stage.is_glsl && bound.stage.clip == Clip::OpenGl;
        let map = if is_turned { upside_down(map) } else { map };
        let levels = texture_levels(&binding.ty, map, &sky).ok_or_else(|| unbound(bound))?;
        let mut levels = levels.into_iter();
        let place = (binding.group, binding.binding);
        if let Some(largest) = levels.next() {
            self.fixtures.insert(place, Arc::new(Fixture::Texture(largest)));
        }
        let smaller: Vec<FixtureTexture> = levels.collect();
        if !smaller.is_empty() {
            self.levels.insert(place, smaller);
        }
        let (name, ty) = (binding.name.clone(), binding.ty.clone());
        self.texture_rows.push(Row { kind: RowKind::Texture, name, ty, value, from });
        Ok(())
    }

    /// Whether the matrices of the stages take normals to view space, and whether that of the model
    /// leads there.
    pub fn seen_matrices(&self) -> (bool, bool) {
        let leaves: Vec<Leaf> =
            self.bound.iter().flat_map(leaves_of).map(|(_, leaf)| leaf).collect();
        let matrices = leaves.iter().filter(|leaf| leaf.ty.starts_with("mat4"));
        let names: Vec<&str> =
            matrices.map(|leaf| leaf.path.rsplit('.').next().unwrap_or_default()).collect();
        let lacks_view = lacks_view(&names);
        (names.into_iter().any(is_model_view) || lacks_view, lacks_view)
    }

    /// The uniform buffers of an object.
    ///
    /// # Errors
    /// A member that has no numbers, which is a mistake of ours.
    pub fn buffers(&self, around: &Around<'_>) -> Result<Buffers, Diagnostics> {
        let uniforms = self.bound.iter().filter(|one| one.binding.kind == BindingKind::Uniform);
        let buffer = |bound: &Bound<'_>| {
            let numbers: BTreeMap<String, Vec<f64>> = leaves_of(bound)
                .into_iter()
                .map(|(path, leaf)| (path, self.leaf_value(bound, &leaf, around).0))
                .collect();
            let packed = pack_buffer(bound.binding, &|path| numbers.get(path).cloned());
            let place = (bound.binding.group, bound.binding.binding);
            packed.map(|bytes| (place, bytes)).map_err(|error| vec![error])
        };
        uniforms.map(buffer).collect()
    }

    /// The numbers of a uniform, in words and where they come from.
    fn leaf_value(
        &self,
        bound: &Bound<'_>,
        leaf: &Leaf,
        around: &Around<'_>,
    ) -> (Vec<f64>, String, Origin) {
        let ty = NumberType::of(&leaf.ty);
        if let Some((numbers, origin)) = self.chosen.get(&leaf.path) {
            return (numbers.clone(), numbers_text(numbers), *origin);
        }
        let text = &bound.stage.ready.text;
        match default_numbers(&leaf.path, ty, around, &|path| is_negated(text, path)) {
            Some((numbers, text)) => (numbers, text, Origin::Name),
            None => (vec![0.0; ty.count()], "0".to_owned(), Origin::Zero),
        }
    }

    /// The numbers of uniforms, as many as a page has room for. Matrices are left out.
    pub fn uniforms(&self, around: &Around<'_>) -> Vec<Uniform> {
        let (mut uniforms, mut known) = (Vec::new(), BTreeSet::new());
        for bound in self.bound.iter().filter(|one| one.binding.kind == BindingKind::Uniform) {
            for (_, leaf) in leaves_of(bound) {
                let is_left_out = NumberType::of(&leaf.ty).is_matrix()
                    || is_padding(bound, &leaf.path)
                    || uniforms.len() == LISTED;
                if is_left_out || !known.insert(leaf.path.clone()) {
                    continue;
                }
                let (numbers, _, _) = self.leaf_value(bound, &leaf, around);
                let (program, path, ty) = (String::new(), leaf.path, leaf.ty);
                uniforms.push(Uniform { program, path, ty, numbers });
            }
        }
        uniforms
    }

    /// The rows of uniforms and textures, and what else a person has to know.
    pub fn rows(&self, around: &Around<'_>) -> (Vec<Row>, Vec<String>) {
        let (mut rows, mut known) = (Vec::new(), BTreeSet::new());
        for bound in self.bound.iter().filter(|one| one.binding.kind == BindingKind::Uniform) {
            for (_, leaf) in leaves_of(bound) {
                if is_padding(bound, &leaf.path) || !known.insert(leaf.path.clone()) {
                    continue;
                }
                let (_, value, from) = self.leaf_value(bound, &leaf, around);
                let (name, ty) = (leaf.path, short_type(&leaf.ty));
                rows.push(Row { kind: RowKind::Uniform, name, ty, value, from });
            }
        }
        let mut notes = self.notes.clone();
        let mut rows = merged_elements(rows);
        if rows.len() > ROWS {
            notes.push(format!("{} more uniforms are not listed", rows.len() - ROWS));
            rows.truncate(ROWS);
        }
        let zeros: Vec<&str> = rows
            .iter()
            .filter(|row| row.from == Origin::Zero)
            .map(|row| row.name.as_str())
            .collect();
        if !zeros.is_empty() {
            let names = zeros.join("`, `");
            notes.push(format!("nothing says what `{names}` shall be: `--uniform NAME=VALUE`"));
        }
        rows.extend(self.texture_rows.iter().cloned());
        (rows, notes)
    }
}

impl OwnStages {
    /// The values among these that a uniform has room for. What somebody chose before a text changed may
    /// not fit it any more.
    pub fn fitting_values(&self, chosen: &BTreeMap<String, Vec<f64>>) -> Vec<GivenValue> {
        let leaves: Vec<Leaf> =
            all_bindings(self).iter().flat_map(leaves_of).map(|(_, leaf)| leaf).collect();
        let fits = |(path, numbers): &(&String, &Vec<f64>)| {
            let mut all = leaves.iter();
            all.any(|leaf| leaf.path == **path && NumberType::of(&leaf.ty).count() == numbers.len())
        };
        let given = |(path, numbers): (&String, &Vec<f64>)| GivenValue {
            name: path.clone(),
            value: UniformValue::Numbers(numbers.clone()),
            origin: Origin::Option,
            span: None,
        };
        chosen.iter().filter(fits).map(given).collect()
    }

    /// The names of textures that can be given, and their types in WGSL.
    pub fn open_textures(&self) -> Vec<(String, String)> {
        let is_open = |binding: &&Binding| {
            matches!(binding.ty.as_str(), "texture_2d<f32>" | "texture_cube<f32>")
        };
        let all = all_bindings(self).into_iter().map(|bound| bound.binding);
        all.filter(is_open).map(|one| (one.name.clone(), one.ty.clone())).collect()
    }
}

/// Whether a member only fills a gap that GLSL's layout leaves.
fn is_padding(bound: &Bound<'_>, path: &str) -> bool {
    let name = path.rsplit('.').next().unwrap_or(path);
    bound.stage.is_glsl && name.starts_with("before_")
}

/// Elements of an array that got the same are one row.
fn merged_elements(rows: Vec<Row>) -> Vec<Row> {
    let parts = |row: &Row| {
        let (before, rest) = row.name.split_once('[')?;
        let (index, after) = rest.split_once(']')?;
        Some((before.to_owned(), index.parse::<u32>().ok()?, after.to_owned()))
    };
    let mut merged: Vec<(Row, u32)> = Vec::new();
    for row in rows {
        let own = parts(&row);
        let earlier = own.as_ref().and_then(|(before, index, after)| {
            merged.iter_mut().rev().take(NEAR).find(|(kept, count)| {
                let is_next = |(first_before, first, first_after): (String, u32, String)| {
                    (&first_before, &first_after) == (before, after) && first + *count == *index
                };
                (&kept.ty, &kept.value, kept.from) == (&row.ty, &row.value, row.from)
                    && parts(kept).is_some_and(is_next)
            })
        });
        match earlier {
            Some((_, count)) => *count += 1,
            None => merged.push((row, 1)),
        }
    }
    let named = |(row, count): (Row, u32)| match parts(&row) {
        Some((before, first, after)) if count > 1 => {
            let name = format!("{before}[{first}..{}]{after}", first + count - 1);
            Row { name, ..row }
        }
        _ => row,
    };
    merged.into_iter().map(named).collect()
}

fn blank_map() -> TextureMap {
    TextureMap { width: 1, height: 1, texels: vec![glam::DVec4::ONE] }
}

fn upside_down(map: TextureMap) -> TextureMap {
    let rows = map.texels.chunks(map.width.max(1)).rev();
    TextureMap { texels: rows.flatten().copied().collect(), ..map }
}

/// The name of a sampler in a structure of GLSL, `material.diffuse`, as a texture of its own.
fn member_name(name: &str) -> String {
    name.replace('.', "_")
}

/// What a texture that was given holds. A cube holds an environment, and no other texture does.
fn given_content(
    bound: &Bound<'_>,
    given: &GivenTexture,
    shot: &Shot,
) -> Result<(TextureMap, Surroundings), Diagnostic> {
    let Binding { name, ty, .. } = bound.binding;
    match (&given.content, ty.as_str()) {
        (TextureContent::Map(map), "texture_2d<f32>") => {
            Ok((map.clone(), shot.surroundings.clone()))
        }
        (TextureContent::Sky(sky), "texture_cube<f32>") => Ok((blank_map(), sky.clone())),
        (content, _) => {
            let what = match content {
                TextureContent::Map(_) => "an image",
                TextureContent::Sky(_) => "an environment",
            };
            let error = refused(&format!("`{name}: {ty}` cannot hold `{}`, {what}", given.text));
            Err(at_given(error, given.span))
        }
    }
}

/// All bindings, those of the vertex stage first. What both stages read is one binding.
fn all_bindings(stages: &OwnStages) -> Vec<Bound<'_>> {
    let mut found: Vec<Bound<'_>> = Vec::new();
    for stage in stages.vertex.iter().chain([&stages.fragment]) {
        for binding in &stage.ready.reflection.bindings {
            let place = (binding.group, binding.binding);
            if !found.iter().any(|one| (one.binding.group, one.binding.binding) == place) {
                found.push(Bound { binding, stage });
            }
        }
    }
    found
}

/// The uniforms of a binding: the path in its buffer, and the author's.
fn leaves_of(bound: &Bound<'_>) -> Vec<(String, Leaf)> {
    let binding = bound.binding;
    if binding.kind != BindingKind::Uniform {
        return Vec::new();
    }
    // The uniforms of GLSL outside of blocks are a structure here.
    let is_loose = bound.stage.is_glsl && binding.ty.starts_with("Uniforms");
    let shown = |path: &str| match path.split_once('.') {
        Some((_, member)) if is_loose => member.to_owned(),
        _ => path.to_owned(),
    };
    let leaf = |leaf: crate::frame::BufferLeaf<'_>| {
        let (path, ty) = (shown(&leaf.path), leaf.ty.to_owned());
        (leaf.path, Leaf { path, ty })
    };
    buffer_leaves(binding).into_iter().map(leaf).collect()
}

/// Whether a buffer has a matrix of four columns.
pub fn has_matrix(binding: &Binding) -> bool {
    fn inside(member: &Member) -> bool {
        member.ty.contains("mat4x") || member.members.iter().any(inside)
    }
    binding.ty.contains("mat4x") || binding.members.iter().any(inside)
}

/// The error about a binding that nothing can be bound to.
fn refusal(bound: &Bound<'_>) -> Option<Diagnostic> {
    let binding = bound.binding;
    let size = binding.size.unwrap_or(0);
    let is_fine = binding.count.is_none()
        && match binding.kind {
            BindingKind::Uniform => size <= UNIFORM_BYTES,
            BindingKind::Storage => !binding.writable && size <= STORAGE_BYTES,
            BindingKind::StorageTexture | BindingKind::Immediate => false,
            BindingKind::Texture | BindingKind::Sampler | BindingKind::ComparisonSampler => true,
        };
    (!is_fine).then(|| unbound(bound))
}

fn unbound(bound: &Bound<'_>) -> Diagnostic {
    let Binding { name, ty, kind, size, writable, count, .. } = bound.binding;
    let size = size.unwrap_or(0);
    let why = match kind {
        _ if count.is_some() => "arrays of bindings are not drawn",
        BindingKind::Uniform if size > UNIFORM_BYTES => "it has more than 64 KiB",
        BindingKind::Storage if *writable => "the stage may write to it",
        BindingKind::Storage => "it has more than 16 MiB",
        BindingKind::Immediate => "immediates are not drawn",
        BindingKind::StorageTexture => "textures that are written to are not drawn",
        BindingKind::Texture
        | BindingKind::Uniform
        | BindingKind::Sampler
        | BindingKind::ComparisonSampler => {
            "textures are `texture_2d<f32>`, `texture_cube<f32>`, `texture_depth_2d` or \
             `texture_depth_cube`"
        }
    };
    let message = format!("nothing can be bound to `{name}: {}`: {why}", short_type(ty));
    let error = refused(&message);
    match bound.stage.places.get(&(bound.binding.group, bound.binding.binding)) {
        Some(span) => error.at(*span, "declared here"),
        None => error,
    }
}

/// Whether a text has a minus before a name, which then points away from what it is named after.
fn is_negated(text: &str, path: &str) -> bool {
    let name = path.rsplit('.').next().unwrap_or(path);
    let is_inner = |letter: char| letter.is_alphanumeric() || letter == '_';
    text.match_indices(name).any(|(at, _)| {
        let after = text[at + name.len()..].chars().next();
        let before = &text[..at];
        if after.is_some_and(is_inner) || before.ends_with(is_inner) {
            return false;
        }
        let is_path = |letter: char| is_inner(letter) || matches!(letter, '.' | '[' | ']');
        let before = before.trim_end_matches(is_path).trim_end_matches(['(', ' ']);
        before.strip_suffix('-').is_some_and(|before| {
            let before = before.trim_end();
            before.ends_with(['(', ',', '=', '*', '/', '+', '{', ';']) || before.ends_with("return")
        })
    })
}

#[cfg(test)]
mod tests {
    use super::{is_negated, merged_elements};
    use crate::own::table::{Origin, Row, RowKind};

    #[test]
    fn elements_in_one_row() {
        let row = |name: &str, value: &str| Row {
            kind: RowKind::Uniform,
            name: name.to_owned(),
            ty: "f32".to_owned(),
            value: value.to_owned(),
            from: Origin::Name,
        };
        let rows = ["a[0].x", "a[0].y", "a[1].x", "a[1].y", "a[2].x"].map(|name| row(name, "1"));
        let mut rows = rows.to_vec();
        rows.push(row("a[2].y", "2"));
        let names: Vec<String> = merged_elements(rows).into_iter().map(|row| row.name).collect();
        assert_eq!(names, ["a[0..2].x", "a[0..1].y", "a[2].y"]);
    }

    #[test]
    fn names_with_a_minus() {
        for (text, expected) in [
            ("let l = normalize(-light.direction);", true),
            ("let l = normalize(-(lights[2].direction));", true),
            ("return -direction;", true),
            ("let l = a - light.direction;", false),
            ("let l = light.direction;", false),
            ("let l = -light.directions;", false),
        ] {
            assert_eq!(is_negated(text, "light.direction"), expected, "{text}");
        }
    }
}
