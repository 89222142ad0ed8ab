//! Runs compute entry points in OpenGL.

use glow::HasContext as _;

use super::{OpenGl, check_error, frame, link_stages};
use crate::dispatch::{Dispatch, DispatchResult, bound_buffers};
use crate::executor_failed;
use crate::frame::Buffers;
use crate::shipped::Shipped;
use lamplight_bundle::BindingKind;

/// A buffer that is bound: where the author bound it, and how many bytes it has.
struct BoundBuffer {
    place: (u32, u32),
    buffer: glow::Buffer,
    bytes: usize,
    is_written: bool,
}

impl OpenGl {
    /// Runs one entry point.
    pub fn compute(&self, dispatch: &Dispatch<'_>) -> DispatchResult {
        let shipped = dispatch.output(self.target)?;
        self.has_extensions(&shipped.bytes)?;
        let mut given = Vec::new();
        for binding in bound_buffers(shipped)? {
            given.push((binding, dispatch.buffer((binding.group, binding.binding))?));
        }
        let run = |gl: &glow::Context| {
            let program = link_stages(gl, &[(glow::COMPUTE_SHADER, &shipped.text())])?;
            let mut bound = Vec::new();
            for (binding, bytes) in given {
                let place = (binding.group, binding.binding);
                let of = match binding.kind {
                    BindingKind::Uniform | BindingKind::Immediate => glow::UNIFORM_BUFFER,
                    _ => glow::SHADER_STORAGE_BUFFER,
                };
                let buffer = bind_buffer(gl, of, slot(shipped, place)?, bytes)?;
                let is_written = binding.kind == BindingKind::Storage && binding.writable;
                bound.push(BoundBuffer { place, buffer, bytes: bytes.len(), is_written });
            }
            let written = run_program(gl, program, dispatch.groups, bound);
            check_error(gl)?;
            Ok(written)
        };
        self.context.with(run).map_err(executor_failed)
    }
}

/// The number that the text declares for a buffer.
fn slot(shipped: &Shipped, place: (u32, u32)) -> Result<u32, String> {
    let slots = &shipped.native.slots;
    let found = slots.iter().find(|slot| (slot.group, slot.binding) == place);
    found.and_then(|slot| slot.index).ok_or_else(|| format!("{place:?} has no number"))
}

fn bind_buffer(
    gl: &glow::Context,
    of: u32,
    slot: u32,
    bytes: &[u8],
) -> Result<glow::Buffer, String> {
    // SAFETY: the context is current.
    unsafe {
        let buffer = frame::create_buffer(gl, of, bytes)?;
        gl.bind_buffer_base(of, slot, Some(buffer));
        Ok(buffer)
    }
}

/// Runs a program, and gives the bytes of the buffers that it may write to.
fn run_program(
    gl: &glow::Context,
    program: glow::Program,
    [x, y, z]: [u32; 3],
    bound: Vec<BoundBuffer>,
) -> Buffers {
    let mut written = Buffers::new();
    // SAFETY: the context is current, and every name is of it.
    unsafe {
        gl.use_program(Some(program));
        gl.dispatch_compute(x, y, z);
        gl.memory_barrier(glow::BUFFER_UPDATE_BARRIER_BIT);
        for BoundBuffer { place, buffer, bytes, is_written } in bound {
            if is_written {
                let mut found = vec![0; bytes];
                gl.bind_buffer(glow::SHADER_STORAGE_BUFFER, Some(buffer));
                gl.get_buffer_sub_data(glow::SHADER_STORAGE_BUFFER, 0, &mut found);
                written.insert(place, found);
            }
            gl.delete_buffer(buffer);
        }
        gl.use_program(None);
        gl.delete_program(program);
    }
    written
}
