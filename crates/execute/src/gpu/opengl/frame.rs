//! Draws frames from the texts of a bundle.

use std::collections::BTreeMap;

use glow::HasContext as _;

use super::{
    TextureUnit, check_error, create_sampler, link_program, plain_state, set_block, set_unit,
    target_texture, upload_fixture,
};
use crate::ShippedPair;
use crate::fixture::Fixture;
use crate::frame::{BindingPlace, Buffers, DrawItem, Drawing, Frame, Mesh};
use crate::gpu::opengl::context::OpenGlApi;
use crate::kernel::SENTINEL;
use crate::shipped::{ColorFormat, Shipped};
use lamplight_bundle::{BindingSlot, Combined, FrontFace};

/// A program, with what is the same for all its frames.
struct FrameProgram {
    program: glow::Program,
    units: Vec<TextureUnit>,
    /// The binding of each uniform block.
    blocks: BTreeMap<BindingPlace, u32>,
}

/// Draws the frame of each view. Errors are messages.
pub fn draw_frames(
    gl: &glow::Context,
    api: OpenGlApi,
    pair: ShippedPair<'_>,
    drawing: &Drawing<'_>,
) -> Result<Vec<Frame>, String> {
    if !drawing.state.is_plain() || !drawing.levels.is_empty() {
        return Err("shipped texts are drawn without culling and smaller levels".into());
    }
    let formats = pair.fragment.targets()?;
    let ready = prepare_frame(gl, pair, drawing)?;
    let turned = pair.vertex.native.clip.is_some_and(|clip| clip.front_face == FrontFace::Reversed);
    plain_state(gl, api);
    // SAFETY: the context is current.
    unsafe { gl.front_face(if turned { glow::CW } else { glow::CCW }) };
    let frames = drawing
        .views
        .iter()
        .map(|view| draw_frame(gl, &ready, drawing, view, &formats))
        .collect::<Result<_, _>>();
    // SAFETY: the context is current and every name is of it.
    unsafe {
        gl.delete_program(ready.program);
        for unit in ready.units {
            gl.delete_texture(unit.texture);
            unit.sampler.into_iter().for_each(|sampler| gl.delete_sampler(sampler));
        }
    }
    check_error(gl)?;
    frames
}

fn prepare_frame(
    gl: &glow::Context,
    pair: ShippedPair<'_>,
    drawing: &Drawing<'_>,
) -> Result<FrameProgram, String> {
    let program = link_program(gl, &pair.vertex.text(), &pair.fragment.text())?;
    let (mut blocks, mut units) = (BTreeMap::new(), Vec::new());
    for stage in [pair.vertex, pair.fragment] {
        for place in stage.blocks() {
            let slot = find_slot(stage, place)?;
            let next = blocks.len() as u32;
            let number = *blocks.entry(place).or_insert(slot.index.unwrap_or(next));
            if let (None, Some(name)) = (slot.index, &slot.name) {
                set_block(gl, program, name, number);
            }
        }
        for combined in &stage.native.combined {
            let next = units.len() as u32;
            units.push(texture_unit(gl, program, stage, combined, next, drawing)?);
        }
    }
    check_error(gl)?;
    Ok(FrameProgram { program, units, blocks })
}

fn find_slot(stage: &Shipped, (group, binding): BindingPlace) -> Result<&BindingSlot, String> {
    let mut slots = stage.native.slots.iter();
    slots
        .find(|slot| (slot.group, slot.binding) == (group, binding))
        .ok_or_else(|| format!("group {group}, binding {binding} has no slot"))
}

/// The unit of a combined sampler: the one that the text declares. Where the language has no such
/// declaration, the next free one is assigned by name.
fn texture_unit(
    gl: &glow::Context,
    program: glow::Program,
    stage: &Shipped,
    combined: &Combined,
    next: u32,
    drawing: &Drawing<'_>,
) -> Result<TextureUnit, String> {
    let [group, binding] = combined.texture;
    let fixture = drawing.fixtures.get(&(group, binding)).map(|fixture| &**fixture);
    let Some(Fixture::Texture(fixture)) = fixture else {
        return Err(format!("`{}` has no fixture", combined.name));
    };
    let index = find_slot(stage, (group, binding))?.index.unwrap_or_else(|| {
        set_unit(gl, program, &combined.name, next);
        next
    });
    let settings = combined.sampler.and_then(|place| drawing.sampler_at(place));
    let sampler = settings.map(|settings| create_sampler(gl, settings)).transpose()?;
    let (target, texture) = upload_fixture(gl, fixture)?;
    Ok(TextureUnit { index, target, texture, sampler })
}

fn draw_frame(
    gl: &glow::Context,
    ready: &FrameProgram,
    drawing: &Drawing<'_>,
    view: &Buffers,
    formats: &[ColorFormat],
) -> Result<Frame, String> {
    let targets = formats
        .iter()
        .map(|format| target_texture(gl, drawing.size, *format == ColorFormat::Float))
        .collect::<Result<Vec<_>, _>>()?;
    let [width, height] = drawing.size.map(|size| size as i32);
    // SAFETY: the context is current, and every name is of it.
    unsafe {
        let framebuffer = gl.create_framebuffer()?;
        gl.bind_framebuffer(glow::FRAMEBUFFER, Some(framebuffer));
        let points = attach_targets(gl, &targets);
        let depths =
            drawing.state.depth_test.then(|| attach_depths(gl, [width, height])).transpose()?;
        gl.draw_buffers(&points);
        if gl.check_framebuffer_status(glow::FRAMEBUFFER) != glow::FRAMEBUFFER_COMPLETE {
            return Err("the driver draws into no such targets".to_owned());
        }
        gl.viewport(0, 0, width, height);
        clear_targets(gl, formats);
        gl.use_program(Some(ready.program));
        for unit in &ready.units {
            gl.active_texture(glow::TEXTURE0 + unit.index);
            gl.bind_texture(unit.target, Some(unit.texture));
            gl.bind_sampler(unit.index, unit.sampler);
        }
        for item in drawing.items {
            draw_item(gl, ready, drawing, view, item)?;
        }
        let read = points.iter().zip(formats).map(|(point, format)| {
            gl.read_buffer(*point);
            read_target(gl, [width, height], *format)
        });
        let words = read.collect();
        gl.disable(glow::DEPTH_TEST);
        gl.bind_framebuffer(glow::FRAMEBUFFER, None);
        gl.delete_framebuffer(framebuffer);
        depths.into_iter().for_each(|depths| gl.delete_renderbuffer(depths));
        targets.into_iter().for_each(|target| gl.delete_texture(target));
        check_error(gl)?;
        Ok(Frame { targets: words, depth: Vec::new(), detour: None })
    }
}

/// Gives the bound framebuffer its targets; returns their attachment points.
///
/// # Safety
///
/// The context is current, and a framebuffer is bound.
unsafe fn attach_targets(gl: &glow::Context, targets: &[glow::Texture]) -> Vec<u32> {
    let attach = |(target, point): (&glow::Texture, u32)| {
        let (of, kind) = (glow::FRAMEBUFFER, glow::TEXTURE_2D);
        // SAFETY: the context is current and a framebuffer is bound.
        unsafe { gl.framebuffer_texture_2d(of, point, kind, Some(*target), 0) };
        point
    };
    targets.iter().zip(glow::COLOR_ATTACHMENT0..).map(attach).collect()
}

/// Gives the bound framebuffer depths, all at the far plane, and turns the test on.
///
/// # Safety
///
/// The context is current, and a framebuffer is bound.
unsafe fn attach_depths(
    gl: &glow::Context,
    [width, height]: [i32; 2],
) -> Result<glow::Renderbuffer, String> {
    // SAFETY: the context is current and a framebuffer is bound.
    unsafe {
        let made = gl.create_renderbuffer()?;
        gl.bind_renderbuffer(glow::RENDERBUFFER, Some(made));
        gl.renderbuffer_storage(glow::RENDERBUFFER, glow::DEPTH_COMPONENT32F, width, height);
        let (of, point) = (glow::FRAMEBUFFER, glow::DEPTH_ATTACHMENT);
        gl.framebuffer_renderbuffer(of, point, glow::RENDERBUFFER, Some(made));
        gl.enable(glow::DEPTH_TEST);
        gl.depth_func(glow::LESS);
        gl.depth_mask(true);
        gl.clear_buffer_f32_slice(glow::DEPTH, 0, &[1.0]);
        Ok(made)
    }
}

/// Fills every target with [`SENTINEL`].
///
/// # Safety
///
/// The context is current, and a framebuffer with a target for each format is bound.
unsafe fn clear_targets(gl: &glow::Context, formats: &[ColorFormat]) {
    for (index, format) in (0..).zip(formats) {
        // SAFETY: a framebuffer with so many targets is bound.
        unsafe {
            match format {
                ColorFormat::Float => {
                    let value = f32::from_bits(SENTINEL);
                    gl.clear_buffer_f32_slice(glow::COLOR, index, &[value; 4]);
                }
                ColorFormat::Uint => gl.clear_buffer_u32_slice(glow::COLOR, index, &[SENTINEL; 4]),
            }
        }
    }
}

/// The words of the bound target, row by row. OpenGL reads the bottom row first. This is the top
/// row of the frame, since the emitted vertex stages flip y.
///
/// # Safety
///
/// The context is current, and a framebuffer of this size and format is bound for reading.
unsafe fn read_target(
    gl: &glow::Context,
    [width, height]: [i32; 2],
    format: ColorFormat,
) -> Vec<u32> {
    let mut bytes = vec![0u8; width as usize * height as usize * 16];
    let (format, ty) = match format {
        ColorFormat::Float => (glow::RGBA, glow::FLOAT),
        ColorFormat::Uint => (glow::RGBA_INTEGER, glow::UNSIGNED_INT),
    };
    // SAFETY: `bytes` holds the whole target.
    unsafe {
        let slice = glow::PixelPackData::Slice(Some(&mut bytes));
        gl.read_pixels(0, 0, width, height, format, ty, slice);
    }
    bytes.as_chunks::<4>().0.iter().map(|bytes| u32::from_ne_bytes(*bytes)).collect()
}

/// # Safety
///
/// The context is current, and the program of `ready` is in use.
unsafe fn draw_item(
    gl: &glow::Context,
    ready: &FrameProgram,
    drawing: &Drawing<'_>,
    view: &Buffers,
    item: &DrawItem<'_>,
) -> Result<(), String> {
    // SAFETY: the context is current and the program is in use.
    unsafe {
        let mut made = Vec::new();
        for (place, number) in &ready.blocks {
            let bytes = drawing.buffer(view, item, *place);
            let bytes = bytes.ok_or_else(|| format!("nothing is given for {place:?}"))?;
            let buffer = create_buffer(gl, glow::UNIFORM_BUFFER, bytes)?;
            gl.bind_buffer_base(glow::UNIFORM_BUFFER, *number, Some(buffer));
            made.push(buffer);
        }
        let array = gl.create_vertex_array()?;
        gl.bind_vertex_array(Some(array));
        made.extend(bind_attributes(gl, item.mesh)?);
        if item.mesh.indices.is_empty() {
            gl.draw_arrays(glow::TRIANGLES, 0, item.mesh.vertices() as i32);
        } else {
            made.push(create_buffer(
                gl,
                glow::ELEMENT_ARRAY_BUFFER,
                &bytes_of_words(&item.mesh.indices),
            )?);
            let count = item.mesh.indices.len() as i32;
            gl.draw_elements(glow::TRIANGLES, count, glow::UNSIGNED_INT, 0);
        }
        gl.bind_vertex_array(None);
        gl.delete_vertex_array(array);
        made.into_iter().for_each(|buffer| gl.delete_buffer(buffer));
    }
    Ok(())
}

/// Describes the attributes of a mesh to the bound vertex array; returns the buffer with the data.
///
/// # Safety
///
/// The context is current, and a vertex array is bound.
unsafe fn bind_attributes(gl: &glow::Context, mesh: &Mesh) -> Result<Option<glow::Buffer>, String> {
    if mesh.attributes.is_empty() {
        return Ok(None);
    }
    let stride = mesh.stride() as i32;
    // SAFETY: the offsets are within the interleaved words.
    unsafe {
        let vertices = create_buffer(gl, glow::ARRAY_BUFFER, &bytes_of_words(&mesh.words))?;
        for (attribute, offset) in mesh.layout() {
            let size = attribute.format.words() as i32;
            let (location, offset) = (attribute.location, offset as i32);
            gl.enable_vertex_attrib_array(location);
            if let Some(is_signed) = attribute.format.integers() {
                let ty = if is_signed { glow::INT } else { glow::UNSIGNED_INT };
                gl.vertex_attrib_pointer_i32(location, size, ty, stride, offset);
            } else {
                gl.vertex_attrib_pointer_f32(location, size, glow::FLOAT, false, stride, offset);
            }
        }
        Ok(Some(vertices))
    }
}

/// # Safety
///
/// The context is current.
pub(super) unsafe fn create_buffer(
    gl: &glow::Context,
    of: u32,
    bytes: &[u8],
) -> Result<glow::Buffer, String> {
    // SAFETY: the context is current.
    unsafe {
        let buffer = gl.create_buffer()?;
        gl.bind_buffer(of, Some(buffer));
        gl.buffer_data_u8_slice(of, bytes, glow::STATIC_DRAW);
        Ok(buffer)
    }
}

fn bytes_of_words(words: &[u32]) -> Vec<u8> {
    words.iter().flat_map(|word| word.to_ne_bytes()).collect()
}
