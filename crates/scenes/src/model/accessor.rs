//! Numbers of accessors, each checked against the bytes that are there.

use gltf::Accessor;
use gltf::accessor::{DataType, Dimensions};
use gltf::buffer::Source;

use super::GltfReader;
use lamplight_files::limits::MODEL_CORNERS;

impl<'b> GltfReader<'b> {
    /// The bytes of a view of the file's own buffer.
    pub fn view(&self, view: &gltf::buffer::View<'_>, place: &str) -> Result<&'b [u8], String> {
        let buffer = view.buffer();
        if let Source::Uri(_) = buffer.source() {
            let index = buffer.index();
            return Err(format!("{place}: buffer {index} is in another file; export one `.glb`"));
        }
        let end = view.offset().checked_add(view.length());
        let bytes = end.and_then(|end| self.blob.get(view.offset()..end));
        bytes.ok_or_else(|| {
            let (index, has) = (view.index(), self.blob.len());
            format!("{place}: buffer view {index} ends beyond the {has} bytes of the file's buffer")
        })
    }

    /// The rows of an accessor as numbers, normalised ones in [0, 1] or [-1, 1].
    pub fn rows(&self, accessor: &Accessor<'_>, place: &str) -> Result<Vec<[f64; 4]>, String> {
        let wrong = |what: String| format!("{place}: accessor {} {what}", accessor.index());
        let (count, size) = (accessor.count(), accessor.data_type().size());
        if count > MODEL_CORNERS {
            return Err(wrong(format!("has {count} rows, more than {MODEL_CORNERS}")));
        }
        if accessor.sparse().is_some() {
            return Err(wrong("is sparse, which is not read".to_owned()));
        }
        let components = match accessor.dimensions() {
            Dimensions::Scalar => 1,
            Dimensions::Vec2 => 2,
            Dimensions::Vec3 => 3,
            Dimensions::Vec4 => 4,
            _ => return Err(wrong("is a matrix".to_owned())),
        };
        let Some(view) = accessor.view() else { return Ok(vec![[0.0; 4]; count]) };
        let bytes = self.view(&view, place)?;
        let stride = view.stride().unwrap_or(components * size);
        let last = count.checked_sub(1).and_then(|rows| rows.checked_mul(stride));
        let end = last.and_then(|at| at.checked_add(accessor.offset() + components * size));
        if count > 0 && end.is_none_or(|end| end > bytes.len()) {
            let has = bytes.len();
            return Err(wrong(format!("ends beyond the {has} bytes of its buffer view")));
        }
        let row = |index: usize| {
            let start = index * stride + accessor.offset();
            let mut row = [0.0; 4];
            for (part, number) in row.iter_mut().enumerate().take(components) {
                let at = start + part * size;
                *number = number_at(&bytes[at..at + size], accessor);
            }
            row
        };
        let rows: Vec<[f64; 4]> = (0..count).map(row).collect();
        if rows.iter().flatten().any(|number| !number.is_finite()) {
            return Err(wrong("has numbers that are not finite".to_owned()));
        }
        Ok(rows)
    }

    /// The whole numbers of an accessor of indices.
    pub fn indices(&self, accessor: &Accessor<'_>, place: &str) -> Result<Vec<u32>, String> {
        let rows = self.rows(accessor, place)?;
        Ok(rows.into_iter().map(|row| row[0].max(0.0) as u32).collect())
    }
}

fn number_at(bytes: &[u8], accessor: &Accessor<'_>) -> f64 {
    let mut four = [0; 4];
    four[..bytes.len()].copy_from_slice(bytes);
    let word = u32::from_le_bytes(four);
    let (value, largest) = match accessor.data_type() {
        DataType::F32 => return f64::from(f32::from_bits(word)),
        DataType::U32 => (f64::from(word), f64::from(u32::MAX)),
        DataType::U16 => (f64::from(word as u16), 65535.0),
        DataType::U8 => (f64::from(word as u8), 255.0),
        DataType::I16 => (f64::from(word as u16 as i16), 32767.0),
        DataType::I8 => (f64::from(word as u8 as i8), 127.0),
    };
    if accessor.normalized() { (value / largest).max(-1.0) } else { value }
}
