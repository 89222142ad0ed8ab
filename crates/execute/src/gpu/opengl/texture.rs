//! Uploads fixtures and words as textures and samplers of OpenGL.

use glow::HasContext as _;

use crate::fixture::{Address, Compare, FixtureSampler, FixtureTexture};

/// Uploads the fixture as a texture; also returns its target.
pub fn upload_fixture(
    gl: &glow::Context,
    texture: &FixtureTexture,
) -> Result<(u32, glow::Texture), String> {
    let (internal, format) = if texture.kind.is_depth() {
        (glow::DEPTH_COMPONENT32F, glow::DEPTH_COMPONENT)
    } else {
        (glow::RGBA32F, glow::RGBA)
    };
    let cube = texture.kind.layers() == 6;
    let target = if cube { glow::TEXTURE_CUBE_MAP } else { glow::TEXTURE_2D };
    let layer = texture.texels.len() / texture.kind.layers() as usize;
    let bytes: Vec<u8> = texture.texels.iter().flat_map(|value| value.to_ne_bytes()).collect();
    // SAFETY: the context is current. Each slice has the texels of one layer, with four bytes for
    // each component.
    unsafe {
        let made = gl.create_texture()?;
        gl.active_texture(glow::TEXTURE0);
        gl.bind_texture(target, Some(made));
        for (face, texels) in bytes.chunks(layer * 4).enumerate() {
            let target =
                if cube { glow::TEXTURE_CUBE_MAP_POSITIVE_X + face as u32 } else { target };
            gl.tex_image_2d(
                target,
                0,
                internal as i32,
                texture.width as i32,
                texture.height as i32,
                0,
                format,
                glow::FLOAT,
                glow::PixelUnpackData::Slice(Some(texels)),
            );
        }
        set_nearest(gl, target);
        Ok((target, made))
    }
}

/// A texture of words, bound to unit 0.
pub fn words_texture(
    gl: &glow::Context,
    size: [u32; 2],
    texels: Option<&[u8]>,
) -> Result<glow::Texture, String> {
    make_texture(gl, size, (glow::RGBA32UI, glow::RGBA_INTEGER, glow::UNSIGNED_INT), texels)
}

/// A texture to draw into, with four floats or four words for each texel.
pub fn target_texture(
    gl: &glow::Context,
    size: [u32; 2],
    is_float: bool,
) -> Result<glow::Texture, String> {
    match is_float {
        true => make_texture(gl, size, (glow::RGBA32F, glow::RGBA, glow::FLOAT), None),
        false => words_texture(gl, size, None),
    }
}

fn make_texture(
    gl: &glow::Context,
    [width, height]: [u32; 2],
    (internal, format, ty): (u32, u32, u32),
    texels: Option<&[u8]>,
) -> Result<glow::Texture, String> {
    // SAFETY: the context is current, and the slice has 16 bytes for each texel.
    unsafe {
        let made = gl.create_texture()?;
        gl.active_texture(glow::TEXTURE0);
        gl.bind_texture(glow::TEXTURE_2D, Some(made));
        gl.tex_image_2d(
            glow::TEXTURE_2D,
            0,
            internal as i32,
            width as i32,
            height as i32,
            0,
            format,
            ty,
            glow::PixelUnpackData::Slice(texels),
        );
        set_nearest(gl, glow::TEXTURE_2D);
        Ok(made)
    }
}

/// Sets what a texture with one level needs to be complete, where no sampler object is bound.
///
/// # Safety
///
/// The context is current, and a texture is bound to the target.
pub unsafe fn set_nearest(gl: &glow::Context, target: u32) {
    // SAFETY: a texture is bound to the target.
    unsafe {
        gl.tex_parameter_i32(target, glow::TEXTURE_MIN_FILTER, glow::NEAREST as i32);
        gl.tex_parameter_i32(target, glow::TEXTURE_MAG_FILTER, glow::NEAREST as i32);
        gl.tex_parameter_i32(target, glow::TEXTURE_MAX_LEVEL, 0);
    }
}

/// A sampler object with these settings.
pub fn create_sampler(
    gl: &glow::Context,
    settings: FixtureSampler,
) -> Result<glow::Sampler, String> {
    let filter = if settings.linear { glow::LINEAR } else { glow::NEAREST };
    let wrap = match settings.address {
        Address::Clamp => glow::CLAMP_TO_EDGE,
        Address::Repeat => glow::REPEAT,
        Address::Mirror => glow::MIRRORED_REPEAT,
    };
    let compare = settings.compare.map(|compare| match compare {
        Compare::Less => glow::LESS,
        Compare::LessEqual => glow::LEQUAL,
        Compare::Greater => glow::GREATER,
        Compare::GreaterEqual => glow::GEQUAL,
        Compare::Equal => glow::EQUAL,
        Compare::NotEqual => glow::NOTEQUAL,
    });
    // SAFETY: the context is current.
    unsafe {
        let sampler = gl.create_sampler()?;
        let set = |name: u32, value: u32| gl.sampler_parameter_i32(sampler, name, value as i32);
        set(glow::TEXTURE_MIN_FILTER, filter);
        set(glow::TEXTURE_MAG_FILTER, filter);
        for axis in [glow::TEXTURE_WRAP_S, glow::TEXTURE_WRAP_T, glow::TEXTURE_WRAP_R] {
            set(axis, wrap);
        }
        if let Some(compare) = compare {
            set(glow::TEXTURE_COMPARE_MODE, glow::COMPARE_REF_TO_TEXTURE);
            set(glow::TEXTURE_COMPARE_FUNC, compare);
        }
        Ok(sampler)
    }
}
