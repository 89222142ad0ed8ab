//! A pass that is ready to be drawn, and the picture that it gives.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DMat4, DVec3};

use super::Shot;
use super::blend::{Slice, seen_color};
use super::pixels::{Background, Linear};
use super::values::PassCamera;
use crate::frame::{ReadyStage, Stages, pack_buffer, probe};
use lamplight_bundle::Binding;
use lamplight_diagnostic::{Diagnostic, Diagnostics, codes};
use lamplight_execute::Session;
use lamplight_execute::fixture::{Fixture, FixtureTexture};
use lamplight_execute::frame::{
    Buffers, DrawItem, Drawing, EntryPoint, Frame, Mesh, PipelineState,
};
use lamplight_execute::kernel::SENTINEL;
use lamplight_execute::raster::{PixelFragment, VisibleFragments, fragments_at, visible_fragments};
use lamplight_scenes::linear_from_srgb;

/// A pass with everything that it is drawn with.
pub struct PreparedPass {
    pub stages: Stages,
    pub items: Vec<(Mesh, Buffers)>,
    pub buffers: Buffers,
    pub fixtures: BTreeMap<(u32, u32), Arc<Fixture>>,
    pub levels: BTreeMap<(u32, u32), Vec<FixtureTexture>>,
    pub state: PipelineState,
    pub(super) plain: Vec<(u32, u32)>,
    /// The binding of the camera, which each view fills. A full-screen pass has none.
    pub(super) camera: Option<Binding>,
    pub(super) eye: PassCamera,
    pub(super) background: Background,
    /// Whether the colours are already encoded for a display.
    pub(super) encoded: bool,
    /// The factor of supersampling, along each side of the picture.
    pub(super) fine: u32,
    /// The same pass for the farther parts of the viewer's depth, nearest first. They are visible
    /// where no nearer part drew anything.
    pub farther: Vec<Self>,
    /// The same pass for objects that are blended over the others.
    pub blended: Option<Box<Self>>,
}

impl PreparedPass {
    pub(super) fn view(&self, camera: &PassCamera) -> Result<Buffers, Diagnostic> {
        let buffer = |binding: &Binding| {
            let bytes = pack_buffer(binding, &|path| camera.number(path))?;
            Ok(((binding.group, binding.binding), bytes))
        };
        self.camera.iter().map(buffer).collect()
    }

    /// The buffers of the viewer, with the projection moved by `shift` pixels.
    ///
    /// # Errors
    /// A field of the camera without a number.
    pub fn eye_view(&self, shift: [f64; 2], size: [u32; 2]) -> Result<Buffers, Diagnostic> {
        let [x, y] = [0, 1].map(|axis| 2.0 * shift[axis] / f64::from(size[axis].max(1)));
        let moved = DMat4::from_translation(DVec3::new(x, y, 0.0)) * self.eye.clip_from_world;
        self.view(&PassCamera { clip_from_world: moved, ..self.eye })
    }

    fn eye_views(&self, shifts: &[[f64; 2]], size: [u32; 2]) -> Result<Vec<Buffers>, Diagnostics> {
        let views = shifts.iter().map(|shift| self.eye_view(*shift, size));
        views.collect::<Result<_, _>>().map_err(|problem| vec![problem])
    }

    /// Draws a frame for each view, with the stages as they are or with another fragment stage and
    /// its number of targets.
    ///
    /// # Errors
    /// The painter's.
    pub fn draw(
        &self,
        painter: &dyn Session,
        views: &[Buffers],
        size: [u32; 2],
        fragment: Option<(EntryPoint<'_>, u32)>,
    ) -> Result<Vec<Frame>, Diagnostics> {
        let items: Vec<DrawItem<'_>> = self.items().collect();
        let drawing = self.drawing(&items, views, size, fragment);
        painter.draw_frames(&drawing).map_err(|problem| vec![problem])
    }

    pub(super) fn items(&self) -> impl Iterator<Item = DrawItem<'_>> {
        self.items.iter().map(|(mesh, buffers)| DrawItem { mesh, buffers })
    }

    pub(super) fn drawing<'d>(
        &'d self,
        items: &'d [DrawItem<'d>],
        views: &'d [Buffers],
        size: [u32; 2],
        fragment: Option<(EntryPoint<'d>, u32)>,
    ) -> Drawing<'d> {
        Drawing {
            vertex: EntryPoint {
                module: &self.stages.vertex.validated.module,
                entry: self.stages.vertex.entry,
            },
            fragment: fragment.map(|(stage, _)| stage),
            targets: fragment.map_or(0, |(_, targets)| targets),
            items,
            views,
            buffers: &self.buffers,
            plain: &self.plain,
            fixtures: &self.fixtures,
            levels: &self.levels,
            size,
            state: self.state,
        }
    }

    /// How many colour targets the fragment stage writes.
    pub(super) fn targets(&self) -> u32 {
        let outputs = self.stages.fragment.iter().flat_map(|stage| &stage.reflection.outputs);
        outputs.filter_map(|output| output.location).map(|location| location + 1).max().unwrap_or(0)
    }

    /// Draws the bits of the colours of one target.
    pub(super) fn draw_colors(
        &self,
        painter: &dyn Session,
        views: &[Buffers],
        size: [u32; 2],
        location: u32,
    ) -> Result<Vec<Frame>, Diagnostics> {
        let items: Vec<DrawItem<'_>> = self.items().collect();
        self.colors_of(&items, painter, (views, size), location)
    }

    /// Draws some objects into a target of their own.
    pub(super) fn draw_colors_of(
        &self,
        items: &[DrawItem<'_>],
        painter: &dyn Session,
        views: &[Buffers],
        size: [u32; 2],
    ) -> Result<Vec<Frame>, Diagnostics> {
        self.colors_of(items, painter, (views, size), 0)
    }

    fn colors_of(
        &self,
        items: &[DrawItem<'_>],
        painter: &dyn Session,
        (views, size): (&[Buffers], [u32; 2]),
        location: u32,
    ) -> Result<Vec<Frame>, Diagnostics> {
        let stage = self.stages.fragment.as_ref().ok_or_else(|| vec![no_frame()])?;
        let module = probe::bits_module(&stage.validated.module, stage.entry, location)
            .ok_or_else(|| vec![no_frame()])?;
        let fragment = Some((EntryPoint { module: &module, entry: stage.entry }, 1));
        let drawing = self.drawing(items, views, size, fragment);
        painter.draw_frames(&drawing).map_err(|problem| vec![problem])
    }

    /// The picture's linear colours, averaged over the samples of each pixel.
    ///
    /// # Errors
    /// The painter's.
    pub fn photograph(&self, painter: &dyn Session, shot: &Shot) -> Result<Linear, Diagnostics> {
        if self.fine > 1 {
            let size = shot.size.map(|side| side * self.fine);
            let one = Shot { size, samples: 1, ..shot.clone() };
            return Ok(self.sampled(painter, &one)?.shrunk(self.fine));
        }
        self.sampled(painter, shot)
    }

    /// As [`Self::photograph`], without supersampling by smaller pixels.
    fn sampled(&self, painter: &dyn Session, shot: &Shot) -> Result<Linear, Diagnostics> {
        let shifts: Vec<[f64; 2]> =
            (0..shot.samples.max(1)).map(|index| sample_shift(index, shot.samples)).collect();
        let views = self.eye_views(&shifts, shot.size)?;
        let mut picture = Linear::new(shot.size);
        let views = if self.camera.is_some() { &views[..] } else { &views[..1] };
        let bytes = 16 * shot.size[0] as usize * shot.size[1] as usize * Slice::frames_of(self);
        let at_once = (AT_ONCE / bytes.max(1)).max(1);
        for (views, shifts) in views.chunks(at_once).zip(shifts.chunks(at_once)) {
            let mut slices = vec![Slice::draw(self, painter, views, shot.size)?];
            for slice in &self.farther {
                let views = slice.eye_views(shifts, shot.size)?;
                slices.push(Slice::draw(slice, painter, &views, shot.size)?);
            }
            for (index, shift) in shifts.iter().enumerate().take(views.len()) {
                let seen = |pixel: usize, background: &dyn Fn() -> DVec3| {
                    seen_color(&slices, index, pixel, background)
                };
                picture.add(seen, *shift, &self.background, shot.exposure);
            }
        }
        Ok(picture)
    }

    /// The colour of a pixel of a frame; `None` where nothing was drawn.
    pub(super) fn color(&self, frame: &Frame, pixel: usize) -> Option<[f32; 4]> {
        let color = pixel_color(frame.targets.first()?.get(4 * pixel..4 * pixel + 4)?)?;
        Some(if self.encoded { decoded_color(color) } else { color })
    }
}

/// A fragment of a picture with its stage, ready to be run.
pub struct PictureFragment {
    /// What it is given, and what it reads.
    pub fragment: PixelFragment,
    /// The fragment stage.
    pub stage: ReadyStage,
}

impl PreparedPass {
    /// The fragments that cover the middle of a pixel, the visible one first. Where fragments may be
    /// discarded, that is known only when they have run.
    ///
    /// # Errors
    /// `picture-invalid` for a pixel outside of the picture, and those of the vertex stage.
    pub fn fragments_at(
        &self,
        pixel: [u32; 2],
        shot: &Shot,
    ) -> Result<Vec<PictureFragment>, Diagnostics> {
        let [width, height] = shot.size;
        if pixel[0] >= width || pixel[1] >= height {
            let message = format!(
                "the pixel {},{} is outside of the picture, which has {width} x {height}",
                pixel[0], pixel[1]
            );
            let help = format!("help: columns are 0 to {}, rows 0 to {}", width - 1, height - 1);
            return Err(vec![Diagnostic::error(codes::PICTURE_INVALID, message).note(help)]);
        }
        let mut found = Vec::new();
        for slice in std::iter::once(self).chain(&self.farther) {
            let mut own = slice.own_fragments_at(pixel, shot).map_err(|problem| vec![problem])?;
            // Blended objects have a stage of their own, and are before the others or behind them.
            if let Some(blended) = &slice.blended {
                own.extend(blended.own_fragments_at(pixel, shot).map_err(|problem| vec![problem])?);
                own.sort_by(|one, other| one.fragment.depth.total_cmp(&other.fragment.depth));
            }
            found.extend(own);
        }
        Ok(found)
    }

    /// The fragments that pixels show, with their stage: first those of the nearest part of the depth.
    /// Surfaces that are blended are not among them.
    ///
    /// # Errors
    /// Those of the vertex stage.
    pub fn visible_fragments(
        &self,
        shot: &Shot,
    ) -> Result<Vec<(ReadyStage, VisibleFragments)>, Diagnostics> {
        let mut found = Vec::new();
        for slice in std::iter::once(self).chain(&self.farther) {
            let Some(stage) = &slice.stages.fragment else { continue };
            let view = slice.eye_view([0.0; 2], shot.size).map_err(|problem| vec![problem])?;
            let items: Vec<DrawItem<'_>> = slice.items().collect();
            let entry = EntryPoint { module: &stage.validated.module, entry: stage.entry };
            let views = std::slice::from_ref(&view);
            let drawing = slice.drawing(&items, views, shot.size, Some((entry, slice.targets())));
            let fragments = visible_fragments(&drawing, &view).map_err(|problem| vec![problem])?;
            found.push((stage.clone(), fragments));
        }
        Ok(found)
    }

    fn own_fragments_at(
        &self,
        pixel: [u32; 2],
        shot: &Shot,
    ) -> Result<Vec<PictureFragment>, Diagnostic> {
        let Some(stage) = &self.stages.fragment else { return Ok(Vec::new()) };
        let fine = self.fine.max(1);
        let (size, pixel) =
            (shot.size.map(|side| side * fine), pixel.map(|at| at * fine + fine / 2));
        let view = self.eye_view([0.0; 2], size)?;
        let items: Vec<DrawItem<'_>> = self.items().collect();
        let entry = EntryPoint { module: &stage.validated.module, entry: stage.entry };
        let views = std::slice::from_ref(&view);
        let drawing = self.drawing(&items, views, size, Some((entry, self.targets())));
        let found = fragments_at(&drawing, &view, pixel)?;
        Ok(found
            .into_iter()
            .map(|fragment| PictureFragment { fragment, stage: stage.clone() })
            .collect())
    }
}

/// The most bytes of the frames that are drawn at once.
const AT_ONCE: usize = 64 << 20;

/// The offset of a sample from the pixel's centre: points of Halton's sequence, or the centre for a
/// single sample.
pub(super) fn sample_shift(index: u32, samples: u32) -> [f64; 2] {
    let radical = |base: u32| {
        let (mut rest, mut place, mut value) = (index + 1, 1.0, 0.0);
        while rest > 0 {
            place /= f64::from(base);
            value += place * f64::from(rest % base);
            rest /= base;
        }
        value - 0.5
    };
    if samples <= 1 { [0.0; 2] } else { [radical(2), radical(3)] }
}

/// The colour of a pixel; `None` where nothing was drawn.
pub(super) fn pixel_color(pixel: &[u32]) -> Option<[f32; 4]> {
    let words: [u32; 4] = pixel.try_into().ok()?;
    (words != [SENTINEL; 4]).then(|| words.map(f32::from_bits))
}

/// The linear colour that a picture, which is sRGB, shows as these code values.
fn decoded_color([r, g, b, a]: [f32; 4]) -> [f32; 4] {
    let [r, g, b] = [r, g, b].map(|code| linear_from_srgb(f64::from(code)) as f32);
    [r, g, b, a]
}

pub(super) fn no_frame() -> Diagnostic {
    Diagnostic::error(codes::EXECUTOR_FAILED, "the pass gives no colour")
}
