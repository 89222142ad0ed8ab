//! Where the textures of a material are on its surface: which set of coordinates they have, and how
//! KHR_texture_transform moves, turns and scales it.

use glam::{DAffine2, DMat2, DVec2};
use serde_json::Value;

/// The name of the extension.
pub const TRANSFORM: &str = "KHR_texture_transform";

/// The set of coordinates that a texture or its extension names, if it names one.
///
/// # Errors
/// It is not the number of a set.
pub fn set_of(value: &Value, place: &str) -> Result<Option<u32>, String> {
    let Some(named) = value.get("texCoord") else { return Ok(None) };
    let set = named.as_u64().and_then(|set| u32::try_from(set).ok());
    let wrong = || format!("{place}.texCoord: expected the number of a set, found {named}");
    set.map(Some).ok_or_else(wrong)
}

/// The coordinates of one texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Default)]
pub struct Coordinates {
    /// The set: `TEXCOORD_0` and so on.
    pub set: u32,
    /// The bits of the offset, the angle and the scale; `None` changes nothing.
    transform: Option<[u64; 5]>,
}

impl Coordinates {
    /// Those of a set, unchanged.
    pub fn of_set(set: u32) -> Self {
        Self { set, transform: None }
    }

    /// Those of a texture with a set of its own, and the value of the extension, if it has one.
    ///
    /// # Errors
    /// A value that is not valid, with its place.
    pub fn read(set: u32, extension: Option<&Value>, place: &str) -> Result<Self, String> {
        let Some(value) = extension else { return Ok(Self { set, transform: None }) };
        let place = format!("{place}.extensions.{TRANSFORM}");
        if !value.is_object() {
            return Err(format!("{place}: expected an object, found {value}"));
        }
        let wrong = |what: &str| format!("{place}.{what}");
        let pair = |key: &str, usual: f64| match value.get(key) {
            None => Ok([usual; 2]),
            Some(pair) => {
                let numbers = pair.as_array().map(|all| all.iter().map(Value::as_f64).collect());
                let numbers: Option<Vec<f64>> = numbers.unwrap_or_default();
                let numbers = numbers.and_then(|all| <[f64; 2]>::try_from(all).ok());
                numbers.ok_or_else(|| wrong(&format!("{key}: expected two numbers, found {pair}")))
            }
        };
        let ([x, y], [across, down]) = (pair("offset", 0.0)?, pair("scale", 1.0)?);
        let angle = match value.get("rotation") {
            None => 0.0,
            Some(angle) => angle
                .as_f64()
                .ok_or_else(|| wrong(&format!("rotation: expected a number, found {angle}")))?,
        };
        let set = set_of(value, &place)?.unwrap_or(set);
        Ok(Self { set, transform: Some([x, y, angle, across, down].map(f64::to_bits)) })
    }

    /// Those of a texture that the parser knows with its extension.
    pub fn of_texture(info: &gltf::texture::Info<'_>) -> Self {
        let Some(own) = info.texture_transform() else {
            return Self { set: info.tex_coord(), transform: None };
        };
        let ([x, y], [across, down]) = (own.offset(), own.scale());
        let numbers = [x, y, own.rotation(), across, down];
        Self {
            set: own.tex_coord().unwrap_or(info.tex_coord()),
            transform: Some(numbers.map(|number| f64::from(number).to_bits())),
        }
    }

    /// From the set to the texture. The angle is counter-clockwise as one looks at the image, whose
    /// second coordinate points down.
    pub fn texture_from_set(&self) -> DAffine2 {
        let Some(bits) = self.transform else { return DAffine2::IDENTITY };
        let [x, y, angle, across, down] = bits.map(f64::from_bits);
        let turned = DMat2::from_angle(-angle) * DMat2::from_diagonal(DVec2::new(across, down));
        DAffine2::from_mat2_translation(turned, DVec2::new(x, y))
    }
}

/// Coordinates that are this close to the edge of an image are meant to be at the edge.
const ROUNDING: f64 = 1e-4;

/// The part of the coordinates that a cell of the sheet shows.
#[derive(Debug, Clone, Copy)]
pub struct Window {
    pub low: DVec2,
    pub size: DVec2,
}

impl Window {
    pub const UNIT: Self = Self { low: DVec2::ZERO, size: DVec2::ONE };

    /// The smallest window of whole repetitions around some coordinates.
    pub fn around(low: DVec2, high: DVec2) -> Self {
        /// With more repetitions, each would get too few texels.
        const MOST: f64 = 32.0;
        if !low.is_finite() || !high.is_finite() {
            return Self::UNIT;
        }
        let low = (low + ROUNDING).floor();
        let size = ((high - ROUNDING).ceil() - low).clamp(DVec2::ONE, DVec2::splat(MOST));
        Self { low, size }
    }

    /// Where in the window coordinates are, in [0, 1]; those beyond it are repeated.
    pub fn share(&self, at: DVec2) -> DVec2 {
        let share = (at - self.low) / self.size;
        let is_within = |x: f64| (-ROUNDING..=1.0 + ROUNDING).contains(&x);
        let within = |x: f64| if is_within(x) { x.clamp(0.0, 1.0) } else { x - x.floor() };
        DVec2::new(within(share.x), within(share.y))
    }

    /// The coordinates at a share of it.
    pub fn at(&self, share: DVec2) -> DVec2 {
        self.low + share * self.size
    }
}
