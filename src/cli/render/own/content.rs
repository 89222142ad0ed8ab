//! What a shader is drawn with: its settings file, the model, and textures.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::watch::Seen;
use super::{Arguments, Failure};
use crate::cli::render::{model, unknown_name};
use crate::limits::{ENVIRONMENT_BYTES, MODEL_BYTES};
use crate::model::View;
use crate::picture::own::table::Origin;
use crate::picture::own::{
    GivenTexture, GivenValue, NAMED_TEXTURES, OwnSettings, TextureContent, decode_image,
    holds_numbers, model_names, named_scene, named_sky, named_texture,
};
use crate::picture::{Shot, Surroundings};
use crate::scene::sets::Scene;
use crate::scene::{ENVIRONMENTS, Equirect};
use crate::source::{LIMITS, SourceSet};

/// The settings beside a shader: `lamp.uniforms.toml` for `lamp.wesl`.
pub fn read_settings(
    file: &Path,
    sources: &mut SourceSet,
    seen: &mut Seen,
) -> Result<OwnSettings, Failure> {
    let path = file.with_extension("uniforms.toml");
    let Ok(bytes) = seen.read(&path, LIMITS.file_bytes as u64) else {
        return Ok(OwnSettings::default());
    };
    let shown = path.display().to_string();
    let text =
        String::from_utf8(bytes).map_err(|_| Failure::input(format!("`{shown}` is not UTF-8")))?;
    let id = sources.add(shown.as_str(), text);
    crate::picture::own::read_settings(sources, id)
        .map_err(|errors| Failure::Input(sources.clone(), errors))
}

/// The values of uniforms from the settings and from options.
pub fn given_values(arguments: &Arguments, settings: &OwnSettings) -> Vec<GivenValue> {
    let options = arguments.own.uniform.iter().map(|(name, value)| GivenValue {
        name: name.clone(),
        value: value.clone(),
        origin: Origin::Option,
        span: None,
    });
    settings.given.iter().cloned().chain(options).collect()
}

/// The model or scene with its name; `None` if nothing names one.
pub fn read_scene(
    arguments: &Arguments,
    settings: &OwnSettings,
    file: &Path,
    shot: &Shot,
    seen: &mut Seen,
) -> Result<Option<(Scene, String)>, Failure> {
    let beside = |name: &String| match named_scene(name) {
        Some(_) => PathBuf::from(name),
        None => folder_of(file).join(name),
    };
    let path = arguments.model.clone().or_else(|| settings.model.as_ref().map(beside));
    let Some(path) = path else {
        return match arguments.camera {
            Some(_) => camera_scene(arguments, "sphere").map(Some),
            None => Ok(None),
        };
    };
    let name = path.display().to_string();
    if named_scene(&name).is_some() {
        return camera_scene(arguments, &name).map(Some);
    }
    if !path.is_file() {
        return Err(unknown_name("model or file", &name, model_names()));
    }
    seen.add_file(&path);
    let own = Arguments { model: Some(path), ..arguments.clone() };
    let Some(mut model) = model::read_model(&own)? else { return Ok(None) };
    let [width, height] = shot.size.map(f64::from);
    model.fit(width / height);
    Ok(Some((model.scene, name)))
}

/// A model of ours, seen as `--camera` says.
fn camera_scene(arguments: &Arguments, name: &str) -> Result<(Scene, String), Failure> {
    let mut scene = named_scene(name).ok_or_else(|| unknown_name("model", name, model_names()))?;
    match arguments.camera {
        Some(View::At(position, target)) => {
            let far = 4.0 * position.distance(target).max(1.0) + scene.eye.far;
            scene.eye.far = scene.eye.far.max(far);
            scene.eye.near = scene.eye.near.min(0.05 * far);
            (scene.eye.position, scene.eye.target) = (position, target);
        }
        Some(View::Camera(index)) => {
            return Err(Failure::usage(format!(
                "`{name}` has no camera {index}\nhelp: `--camera X,Y,Z,X,Y,Z` says where the viewer \
                 is, and what it looks at"
            )));
        }
        Some(View::Own) | None => {}
    }
    Ok((scene, name.to_owned()))
}

fn folder_of(file: &Path) -> &Path {
    file.parent().unwrap_or(Path::new(""))
}

/// The textures of the settings and of options, by name.
pub fn read_textures(
    arguments: &Arguments,
    settings: &OwnSettings,
    file: &Path,
    linear: bool,
    seen: &mut Seen,
) -> Result<BTreeMap<String, GivenTexture>, Failure> {
    let mut textures = BTreeMap::new();
    for (name, (text, span)) in &settings.textures {
        let content = read_content(name, text, folder_of(file), linear, seen)?;
        let (text, origin, span) = (text.clone(), Origin::File, Some(*span));
        textures.insert(name.clone(), GivenTexture { content, text, origin, span });
    }
    for (name, text) in &arguments.own.texture {
        let content = read_content(name, text, Path::new(""), linear, seen)?;
        let (text, origin, span) = (text.clone(), Origin::Option, None);
        textures.insert(name.clone(), GivenTexture { content, text, origin, span });
    }
    Ok(textures)
}

/// What a texture holds, by a name of ours or from a file.
fn read_content(
    name: &str,
    text: &str,
    folder: &Path,
    linear: bool,
    seen: &mut Seen,
) -> Result<TextureContent, Failure> {
    if let Some(map) = named_texture(text) {
        return Ok(TextureContent::Map(map));
    }
    if let Some(sky) = named_sky(text) {
        return Ok(TextureContent::Sky(sky));
    }
    let path = folder.join(text);
    if !path.exists() {
        let known = NAMED_TEXTURES.iter().map(|(name, _)| *name);
        let skies = ENVIRONMENTS.iter().map(|(name, _, _)| *name);
        return Err(unknown_name("texture or file", text, known.chain(skies)));
    }
    let shown = path.display();
    let is_sky = path.extension().is_some_and(|ending| ending == "hdr");
    let most = if is_sky { ENVIRONMENT_BYTES } else { MODEL_BYTES };
    let bytes = seen
        .read(&path, most)
        .map_err(|error| Failure::input(format!("cannot read `{shown}`: {error}")))?;
    let wrong = |error: String| Failure::input(format!("`{shown}`: {error}"));
    if is_sky {
        let image = Equirect::from_radiance(&bytes).map_err(wrong)?;
        return Ok(TextureContent::Sky(Surroundings::Image(Arc::new(image))));
    }
    let map = decode_image(&bytes, linear && !holds_numbers(name)).map_err(wrong)?;
    Ok(TextureContent::Map(map))
}
