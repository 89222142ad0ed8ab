//! A shader of the user's own, drawn as `lamplight render FILE` draws it.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::rc::Rc;

use glam::DVec4;
use lamplight::bundle::SourceClip;
use lamplight::compose::glsl::named_stage;
use lamplight::diagnostic::Diagnostics;
use lamplight::source::SourceSet;
use lamplight_picture::Shot;
use lamplight_picture::own::table::{Origin, RowKind};
use lamplight_picture::own::{
    GivenTexture, NAMED_TEXTURES, OwnPicture, OwnRequest, OwnStages, OwnText, SOURCES,
    TextureContent, choose_stages, holds_numbers, model_names, named_sky, named_texture,
    prepare_own, turned_scene,
};
use lamplight_scenes::sets::TextureMap;
use lamplight_scenes::{ENVIRONMENTS, linear_from_srgb};
use wasm_bindgen::prelude::wasm_bindgen;

use super::controls::uniform_info;
use super::refused;
use super::sketch::{InputInfo, LAMP, SketchControls, SketchRequest, TextureChoice, shot};
use crate::shader::{ShaderRequest, composed_text};

/// The most images that are kept, and the most pixels of each.
const IMAGES: usize = 16;
const PIXELS: usize = 1 << 20;

/// How many trips the loops of a fragment may make, so that a text that never ends does not stop the
/// browser.
const TRIPS: u32 = 4096;

/// What names an image of the user's begins with.
const FILE: &str = "file:";

/// An image as the browser decoded it: four bytes a pixel, row by row from the top.
struct Image {
    width: usize,
    rgba: Vec<u8>,
}

thread_local! {
    static KEPT: RefCell<BTreeMap<String, Image>> = const { RefCell::new(BTreeMap::new()) };
    /// The stages of the last text: while time passes or a model is turned, they stay.
    static LAST: RefCell<Option<(ShaderRequest, Rc<OwnStages>)>> = const { RefCell::new(None) };
}

/// Takes an image of the user's for textures: four bytes a pixel, row by row from the top. False if it is
/// too large, or one too many.
#[wasm_bindgen(js_name = keepImage)]
pub fn keep_image(name: String, width: u32, rgba: Vec<u8>) -> bool {
    let width = width as usize;
    let is_whole = width > 0 && !rgba.is_empty() && rgba.len().is_multiple_of(4 * width);
    KEPT.with_borrow_mut(|kept| {
        let has_room = kept.len() < IMAGES || kept.contains_key(&name);
        let is_taken = is_whole && has_room && rgba.len() <= 4 * PIXELS;
        if is_taken {
            kept.insert(name, Image { width, rgba });
        }
        is_taken
    })
}

fn kept_image(name: &str, linear: bool) -> Option<TextureMap> {
    KEPT.with_borrow(|kept| {
        let Image { width, rgba } = kept.get(name)?;
        let part = |byte: u8| f64::from(byte) / 255.0;
        let light = |byte: u8| if linear { linear_from_srgb(part(byte)) } else { part(byte) };
        let texels = rgba
            .as_chunks::<4>()
            .0
            .iter()
            .map(|[r, g, b, a]| DVec4::new(light(*r), light(*g), light(*b), part(*a)));
        let texels: Vec<DVec4> = texels.collect();
        Some(TextureMap { width: *width, height: texels.len() / width, texels })
    })
}

/// What can be changed in the picture of an author's text.
pub fn author_controls(
    request: &SketchRequest,
    sources: &mut SourceSet,
) -> Result<SketchControls, Diagnostics> {
    let stages = stages_of(request, sources)?;
    let picture = drawn(&stages, request, &shot(request)?)?;
    let rows = || picture.rows.iter();
    let input = rows().filter(|row| row.kind == RowKind::Input).map(|row| InputInfo {
        name: row.name.clone(),
        ty: row.ty.clone(),
        source: row.value.clone(),
    });
    let texture = |(name, ty): (String, String)| {
        let found = rows().find(|row| row.kind == RowKind::Texture && row.name == name);
        let value = found.map_or_else(String::new, |row| row.value.clone());
        TextureChoice { choices: texture_choices(&ty), name, ty, value }
    };
    Ok(SketchControls {
        inputs: if picture.is_flat { Vec::new() } else { input.collect() },
        textures: stages.open_textures().into_iter().map(texture).collect(),
        is_flat: picture.is_flat,
        is_linear: is_linear(&stages),
        models: model_names().map(str::to_owned).collect(),
        sources: SOURCES.iter().map(|source| source.text().to_owned()).collect(),
        uniforms: picture.uniforms.into_iter().map(uniform_info).collect(),
        diagnostics: Vec::new(),
    })
}

/// The picture of an author's text, ready to be drawn.
pub fn author_picture(
    request: &SketchRequest,
    shot: &Shot,
    sources: &mut SourceSet,
) -> Result<OwnPicture, Diagnostics> {
    let stages = stages_of(request, sources)?;
    drawn(&stages, request, shot)
}

/// Shaders for OpenGL write what the display shows.
fn is_linear(stages: &OwnStages) -> bool {
    !stages.is_for_opengl()
}

fn drawn(
    stages: &OwnStages,
    request: &SketchRequest,
    shot: &Shot,
) -> Result<OwnPicture, Diagnostics> {
    let scene = |name: &str| turned_scene(name, request.turn, request.lamp.unwrap_or(LAMP).into());
    let linear = is_linear(stages);
    let mut own = OwnRequest {
        scene: None,
        given: stages.fitting_values(&request.uniforms),
        textures: textures_of(stages, request, linear)?,
        time: request.time,
        linear,
        vertices: None,
        inputs: request.inputs.clone(),
    };
    if request.model.is_empty() {
        // The text says whether it is drawn on a model. If it is, the viewer can walk around it.
        let free = prepare_own(stages, &own, shot)?;
        if free.is_flat {
            return Ok(free);
        }
    }
    let name = if request.model.is_empty() { "sphere" } else { &request.model };
    let found = scene(name);
    own.scene = Some(found.ok_or_else(|| vec![refused(&format!("there is no model `{name}`"))])?);
    prepare_own(stages, &own, shot)
}

/// The stages of the file, and of the one beside it that has the other stage in GLSL.
fn stages_of(
    request: &SketchRequest,
    sources: &mut SourceSet,
) -> Result<Rc<OwnStages>, Diagnostics> {
    let shader = &request.shader;
    let is_it = |(known, _): &&(ShaderRequest, Rc<OwnStages>)| known == shader;
    let known = LAST.with_borrow(|last| last.as_ref().filter(is_it).map(|(_, one)| one.clone()));
    if let Some(found) = known {
        // What runs for a pixel leads back to the texts, so they are read again.
        composed_text(shader, sources)?;
        if let Some(root) = partner_of(shader) {
            composed_text(&ShaderRequest { root, entry: None, ..shader.clone() }, sources)?;
        }
        return Ok(found);
    }
    let mut texts = vec![read_text(shader, sources)?];
    if let Some(root) = partner_of(shader) {
        let partner = ShaderRequest { root, entry: None, ..shader.clone() };
        texts.push(read_text(&partner, sources)?);
    }
    let entries: Vec<String> = shader.entry.iter().cloned().collect();
    let stages = Rc::new(choose_stages(&texts, &entries)?.with_trips(TRIPS));
    LAST.set(Some((shader.clone(), stages.clone())));
    Ok(stages)
}

fn read_text(shader: &ShaderRequest, sources: &mut SourceSet) -> Result<OwnText, Diagnostics> {
    let composed = composed_text(shader, sources)?;
    Ok(OwnText::read(&composed, SourceClip::Auto)?.0)
}

/// The file of the other stage: `lit.vert.glsl` beside `lit.frag.glsl`, or `lit.vert` beside `lit.frag`.
fn partner_of(shader: &ShaderRequest) -> Option<String> {
    named_stage(&shader.root)?;
    let files = shader.files.as_ref()?;
    [(".frag", ".vert"), (".vert", ".frag")].iter().find_map(|(own, other)| {
        let at = shader.root.rfind(own)?;
        let path = format!("{}{other}{}", &shader.root[..at], &shader.root[at + own.len()..]);
        files.contains_key(&path).then_some(path)
    })
}

fn textures_of(
    stages: &OwnStages,
    request: &SketchRequest,
    linear: bool,
) -> Result<BTreeMap<String, GivenTexture>, Diagnostics> {
    let mut given = BTreeMap::new();
    for (name, ty) in stages.open_textures() {
        let Some(text) = request.textures.get(&name) else { continue };
        let is_cube = ty == "texture_cube<f32>";
        let content = match text.strip_prefix(FILE) {
            Some(file) if !is_cube => {
                kept_image(file, linear && !holds_numbers(&name)).map(TextureContent::Map)
            }
            None if is_cube => named_sky(text).map(TextureContent::Sky),
            None => named_texture(text).map(TextureContent::Map),
            Some(_) => None,
        };
        // What was chosen before the text changed may not fit any more.
        if let Some(content) = content {
            let texture =
                GivenTexture { content, text: text.clone(), origin: Origin::Option, span: None };
            given.insert(name, texture);
        }
    }
    Ok(given)
}

fn texture_choices(ty: &str) -> Vec<String> {
    match ty {
        "texture_cube<f32>" => ENVIRONMENTS.iter().map(|(name, ..)| (*name).to_owned()).collect(),
        _ => NAMED_TEXTURES.iter().map(|(name, _)| (*name).to_owned()).collect(),
    }
}
