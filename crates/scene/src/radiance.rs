//! Environments from Radiance files (`.hdr`).

use glam::DVec3;
use image::ImageDecoder as _;
use image::codecs::hdr::HdrDecoder;
use lamplight_files::limits::ENVIRONMENT_PIXELS;
use lamplight_files::rehearse::rehearse;

use super::sky::Equirect;

/// The stage of [`rehearse`] that runs the decoder.
pub const DECODER: &str = "picture";

impl Equirect {
    /// The image of a Radiance file (`.hdr`).
    ///
    /// # Errors
    /// A message: the bytes are not such a file, the image is too large, or its decoder needs too
    /// much memory or time.
    pub fn from_radiance(bytes: &[u8]) -> Result<Self, String> {
        let decoder =
            HdrDecoder::new(std::io::Cursor::new(bytes)).map_err(|error| error.to_string())?;
        let (width, height) = decoder.dimensions();
        // The header alone decides how much memory is allocated, so it is checked first.
        if u64::from(width) * u64::from(height) > ENVIRONMENT_PIXELS {
            return Err(format!("{width} x {height} pixels are more than {ENVIRONMENT_PIXELS}"));
        }
        // Images up to 4096 x 2048 are decoded without a rehearsal.
        if u64::from(width) * u64::from(height) > ENVIRONMENT_PIXELS / 2 {
            rehearse(DECODER, bytes).map_err(|how| format!("its decoder {how}"))?;
        }
        let mut read =
            vec![0; usize::try_from(decoder.total_bytes()).map_err(|error| error.to_string())?];
        decoder.read_image(&mut read).map_err(|error| error.to_string())?;
        let number = |bytes: &[u8; 4]| f64::from(f32::from_ne_bytes(*bytes));
        let pixels = read.as_chunks::<12>().0.iter().map(|rgb| {
            let [red, green, blue] =
                [0, 4, 8].map(|at| rgb[at..].first_chunk().map_or(0.0, number));
            DVec3::new(red, green, blue)
        });
        let pixels = pixels.collect();
        Self::new(width as usize, height as usize, pixels)
            .ok_or_else(|| "the image is empty".to_owned())
    }
}
