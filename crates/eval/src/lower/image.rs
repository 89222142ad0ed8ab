//! Lowers accesses to textures.

use super::{Loc, LoweredBody};
use crate::code::{Access, Instruction, Lod, Slot, TextureOp};
use crate::error::Error;
use crate::layout::SlotKind;
use naga::{Expression, Handle, ImageClass, ImageQuery, SampleLevel, TypeInner};

impl LoweredBody<'_, '_> {
    pub(super) fn image(&mut self, handle: Handle<Expression>) -> Result<Loc, Error> {
        let (to, n) = self.fresh(handle)?;
        let words = self.kind(handle)? != SlotKind::Float;
        let mut access = Access {
            image: 0,
            coordinate: 0,
            dimensions: 0,
            layer: None,
            ask: TextureOp::Levels,
            to,
            n: n as u8,
            words,
            depth: false,
        };
        match self.expressions[handle] {
            Expression::ImageSample {
                image,
                sampler,
                gather,
                coordinate,
                array_index,
                offset,
                level,
                depth_ref,
                clamp_to_edge,
            } => {
                self.coordinates(&mut access, image, Some(coordinate), array_index)?;
                let (sampler, offset, reference) =
                    (self.operand(sampler)?.slot, self.maybe(offset)?, self.maybe(depth_ref)?);
                let (level, gather) = (self.level(level)?, gather.map(|component| component as u8));
                access.ask =
                    TextureOp::Sample { sampler, gather, level, offset, reference, clamp_to_edge };
            }
            Expression::ImageLoad { image, coordinate, array_index, level, .. } => {
                self.coordinates(&mut access, image, Some(coordinate), array_index)?;
                access.ask = TextureOp::Load { level: self.maybe(level)? };
            }
            Expression::ImageQuery { image, query } => {
                self.coordinates(&mut access, image, None, None)?;
                access.ask = self.query(query)?;
            }
            _ => return Err(Error::unsupported("this access to a texture")),
        }
        let index = self.build.program.images.len() as u32;
        self.build.program.images.push(access);
        self.emit(Instruction::Image { access: index });
        Ok(Loc::dense(to, false))
    }

    fn coordinates(
        &mut self,
        access: &mut Access,
        image: Handle<Expression>,
        coordinate: Option<Handle<Expression>>,
        layer: Option<Handle<Expression>>,
    ) -> Result<(), Error> {
        let TypeInner::Image { class, .. } = *self.inner(image) else {
            return Err(Error::unsupported("arrays of textures"));
        };
        if matches!(class, ImageClass::Storage { .. } | ImageClass::External) {
            return Err(Error::unsupported("storage and external textures"));
        }
        access.depth = matches!(class, ImageClass::Depth { .. });
        access.image = self.operand(image)?.slot;
        if let Some(coordinate) = coordinate {
            (access.coordinate, access.dimensions) =
                (self.dense(coordinate)?, self.slots(coordinate)? as u8);
        }
        access.layer = self.maybe(layer)?;
        Ok(())
    }

    fn maybe(&mut self, handle: Option<Handle<Expression>>) -> Result<Option<Slot>, Error> {
        handle.map(|handle| self.dense(handle)).transpose()
    }

    fn level(&mut self, level: SampleLevel) -> Result<Lod, Error> {
        Ok(match level {
            SampleLevel::Auto => Lod::Auto,
            SampleLevel::Zero => Lod::Zero,
            // The level of a depth texture is an integer, which is converted to a float here.
            SampleLevel::Exact(level) if self.kind(level)? != SlotKind::Float => {
                Lod::Exact(self.float_of(level)?)
            }
            SampleLevel::Exact(level) => Lod::Exact(self.dense(level)?),
            SampleLevel::Bias(bias) => Lod::Bias(self.dense(bias)?),
            SampleLevel::Gradient { x, y } => Lod::Gradient(self.dense(x)?, self.dense(y)?),
        })
    }

    fn float_of(&mut self, handle: Handle<Expression>) -> Result<Slot, Error> {
        let (a, to) = (self.operand(handle)?, self.build.alloc(1)?);
        self.emit(Instruction::Convert { op: crate::code::Convert::FloatFromS, n: 1, to, a });
        Ok(to)
    }

    fn query(&mut self, query: ImageQuery) -> Result<TextureOp, Error> {
        Ok(match query {
            ImageQuery::Size { level } => TextureOp::Size { level: self.maybe(level)? },
            ImageQuery::NumLevels => TextureOp::Levels,
            ImageQuery::NumLayers => TextureOp::Layers,
            ImageQuery::NumSamples => TextureOp::Samples,
        })
    }
}
