//! Writes words into pictures.

use std::convert::Infallible;

use embedded_graphics::Pixel;
use embedded_graphics::mono_font::MonoTextStyle;
use embedded_graphics::mono_font::iso_8859_1::FONT_10X20;
use embedded_graphics::pixelcolor::Rgb888;
use embedded_graphics::prelude::{Dimensions, DrawTarget, Drawable, Point, RgbColor, Size};
use embedded_graphics::primitives::Rectangle;
use embedded_graphics::text::{Baseline, Text};

use crate::pixels::Picture;

const INK: Rgb888 = Rgb888::new(232, 234, 238);

/// Writes one line from a place to the right, as far as the width allows.
pub fn write_label(picture: &mut Picture, text: &str, [left, top]: [u32; 2], width: u32) {
    let mut page = LabelCanvas { picture, right: left + width };
    let style = MonoTextStyle::new(&FONT_10X20, INK);
    let place = Point::new(left as i32, top as i32);
    // Writing pixels in memory cannot fail.
    let Ok(_) = Text::with_baseline(text, place, style, Baseline::Top).draw(&mut page);
}

/// A picture to write on.
struct LabelCanvas<'p> {
    picture: &'p mut Picture,
    right: u32,
}

impl Dimensions for LabelCanvas<'_> {
    fn bounding_box(&self) -> Rectangle {
        Rectangle::new(Point::zero(), Size::new(self.right, self.picture.height))
    }
}

impl DrawTarget for LabelCanvas<'_> {
    type Color = Rgb888;
    type Error = Infallible;

    fn draw_iter<I>(&mut self, pixels: I) -> Result<(), Infallible>
    where
        I: IntoIterator<Item = Pixel<Rgb888>>,
    {
        for Pixel(Point { x, y }, color) in pixels {
            if let (Ok(x), Ok(y)) = (u32::try_from(x), u32::try_from(y))
                && x < self.right
            {
                self.picture.set([x, y], [color.r(), color.g(), color.b()]);
            }
        }
        Ok(())
    }
}
