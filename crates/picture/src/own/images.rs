//! Images of users, as textures.

use std::io::Cursor;

use glam::DVec4;
use image::{ImageReader, Limits};

use lamplight_scenes::linear_from_srgb;
use lamplight_scenes::sets::TextureMap;

/// The most pixels along a side of an image that is read.
const LARGEST: u32 = 8192;
/// The most texels along a side of a texture: larger images are made smaller.
const TEXELS: u32 = 1024;

/// The texels of a PNG or JPEG file, from the top. `decode` makes linear light of what the file has
/// encoded for a display.
///
/// # Errors
/// In words.
pub fn decode_image(bytes: &[u8], decode: bool) -> Result<TextureMap, String> {
    let mut reader = ImageReader::new(Cursor::new(bytes))
        .with_guessed_format()
        .map_err(|error| error.to_string())?;
    let mut limits = Limits::default();
    (limits.max_image_width, limits.max_image_height) = (Some(LARGEST), Some(LARGEST));
    reader.limits(limits);
    let image = reader.decode().map_err(|error| error.to_string())?;
    let is_large = image.width().max(image.height()) > TEXELS;
    let image = if is_large { image.thumbnail(TEXELS, TEXELS) } else { image };
    let pixels = image.to_rgba8();
    let linear: Vec<f64> = (0..=255)
        .map(|byte| f64::from(byte) / 255.0)
        .map(|part| if decode { linear_from_srgb(part) } else { part })
        .collect();
    let texel = |pixel: &image::Rgba<u8>| {
        let [r, g, b, a] = pixel.0;
        let [r, g, b] = [r, g, b].map(|byte| linear[usize::from(byte)]);
        DVec4::new(r, g, b, f64::from(a) / 255.0)
    };
    let (width, height) = (pixels.width() as usize, pixels.height() as usize);
    Ok(TextureMap { width, height, texels: pixels.pixels().map(texel).collect() })
}

#[cfg(test)]
mod tests {
    use super::decode_image;
    use crate::Picture;

    #[test]
    fn texels_of_a_file() -> Result<(), String> {
        let mut picture = Picture::filled(2, 1, [255, 0, 0]);
        picture.set([1, 0], [128, 0, 255]);
        let bytes = picture.png()?;
        let map = decode_image(&bytes, true)?;
        assert_eq!((map.width, map.height), (2, 1));
        assert_eq!(map.texels[0].to_array(), [1.0, 0.0, 0.0, 1.0]);
        // 128/255 of sRGB in linear light (IEC 61966-2-1).
        assert!((map.texels[1].x - 0.215_860_5).abs() < 1e-6);
        assert!((decode_image(&bytes, false)?.texels[1].x - 128.0 / 255.0).abs() < 1e-12);
        assert!(decode_image(b"no image", true).is_err());
        Ok(())
    }
}
