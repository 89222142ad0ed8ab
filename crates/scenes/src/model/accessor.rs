//! The numbers of accessors, each checked against the bytes that are there.

use crate::model::GltfReader;
use glam::DMat4;
use gltf::Accessor;
use gltf::accessor::sparse::{IndexType, Sparse};
use gltf::accessor::{DataType, Dimensions};
use lamplight_files::limits::MODEL_CORNERS;

/// How numbers lie in a view of a buffer.
struct Layout {
    offset: usize,
    /// Bytes from a row to the next.
    stride: usize,
    rows: usize,
    components: usize,
    kind: DataType,
    is_normalized: bool,
}

impl<'b> GltfReader<'b> {
    /// The bytes of a view of a buffer.
    pub fn view(&self, view: &gltf::buffer::View<'_>, place: &str) -> Result<&'b [u8], String> {
        let buffer = match self.buffers.get(view.buffer().index()) {
            Some(Ok(bytes)) => bytes,
            Some(Err(reason)) => return Err(format!("{place}: {reason}")),
            None => return Err(format!("{place}: its buffer is not there")),
        };
        let end = view.offset().checked_add(view.length());
        let bytes = end.and_then(|end| buffer.get(view.offset()..end));
        bytes.ok_or_else(|| {
            let (index, has) = (view.index(), buffer.len());
            format!("{place}: buffer view {index} ends beyond the {has} bytes of its buffer")
        })
    }

    /// The rows of an accessor as numbers, normalised ones in [0, 1] or [-1, 1].
    pub fn rows(&self, accessor: &Accessor<'_>, place: &str) -> Result<Vec<[f64; 4]>, String> {
        let components = match accessor.dimensions() {
            Dimensions::Scalar => 1,
            Dimensions::Vec2 => 2,
            Dimensions::Vec3 => 3,
            Dimensions::Vec4 => 4,
            _ => return Err(format!("{place}: accessor {} is a matrix", accessor.index())),
        };
        let numbers = self.numbers(accessor, components, place)?;
        let row = |own: &[f64]| {
            let mut row = [0.0; 4];
            row[..components].copy_from_slice(own);
            row
        };
        Ok(numbers.chunks_exact(components).map(row).collect())
    }

    /// The matrices of an accessor.
    pub fn matrices(&self, accessor: &Accessor<'_>, place: &str) -> Result<Vec<DMat4>, String> {
        if accessor.dimensions() != Dimensions::Mat4 || accessor.data_type() != DataType::F32 {
            let index = accessor.index();
            return Err(format!("{place}: accessor {index} has no matrices of 4 by 4 floats"));
        }
        let numbers = self.numbers(accessor, 16, place)?;
        let matrix = |own: &[f64]| <[f64; 16]>::try_from(own).ok();
        let matrices = numbers.chunks_exact(16).filter_map(matrix);
        Ok(matrices.map(|own| DMat4::from_cols_array(&own)).collect())
    }

    /// The whole numbers of an accessor of indices.
    pub fn indices(&self, accessor: &Accessor<'_>, place: &str) -> Result<Vec<u32>, String> {
        let rows = self.rows(accessor, place)?;
        Ok(rows.into_iter().map(|row| row[0].max(0.0) as u32).collect())
    }

    /// The numbers of all rows: zeros without a view, then those that a sparse accessor replaces.
    fn numbers(
        &self,
        accessor: &Accessor<'_>,
        components: usize,
        place: &str,
    ) -> Result<Vec<f64>, String> {
        let wrong = |what: String| format!("{place}: accessor {} {what}", accessor.index());
        let rows = accessor.count();
        if rows > MODEL_CORNERS {
            return Err(wrong(format!("has {rows} rows, more than {MODEL_CORNERS}")));
        }
        let (kind, is_normalized) = (accessor.data_type(), accessor.normalized());
        let packed = components * kind.size();
        let mut numbers = match accessor.view() {
            None => vec![0.0; rows * components],
            Some(view) => {
                let (offset, stride) = (accessor.offset(), view.stride().unwrap_or(packed));
                let layout = Layout { offset, stride, rows, components, kind, is_normalized };
                layout.read(self.view(&view, place)?).map_err(wrong)?
            }
        };
        if let Some(sparse) = accessor.sparse() {
            let own = Layout { offset: 0, stride: packed, rows, components, kind, is_normalized };
            self.replace_rows(&sparse, own, &mut numbers, place).map_err(wrong)?;
        }
        if numbers.iter().any(|number| !number.is_finite()) {
            return Err(wrong("has numbers that are not finite".to_owned()));
        }
        Ok(numbers)
    }

    /// Replaces the rows that the sparse part of an accessor lists. `all` is the layout of all rows.
    fn replace_rows(
        &self,
        sparse: &Sparse<'_>,
        all: Layout,
        numbers: &mut [f64],
        place: &str,
    ) -> Result<(), String> {
        let (indices, values) = (sparse.indices(), sparse.values());
        let (rows, count, components) = (all.rows, sparse.count(), all.components);
        if count > rows {
            return Err(format!("has {rows} rows, and {count} in its sparse part"));
        }
        let kind = match indices.index_type() {
            IndexType::U8 => DataType::U8,
            IndexType::U16 => DataType::U16,
            IndexType::U32 => DataType::U32,
        };
        let list = Layout {
            offset: indices.offset(),
            stride: kind.size(),
            rows: count,
            components: 1,
            kind,
            is_normalized: false,
        };
        let list = list.read(self.view(&indices.view(), place)?)?;
        let own = Layout { offset: values.offset(), rows: count, ..all };
        let own = own.read(self.view(&values.view(), place)?)?;
        for (index, row) in list.iter().zip(own.chunks_exact(components)) {
            let start = *index as usize * components;
            let replaced = numbers.get_mut(start..start + components);
            let beyond = || format!("has {rows} rows, and a sparse one at {index}");
            replaced.ok_or_else(beyond)?.copy_from_slice(row);
        }
        Ok(())
    }
}

impl Layout {
    fn read(&self, bytes: &[u8]) -> Result<Vec<f64>, String> {
        let size = self.kind.size();
        let last = self.rows.checked_sub(1).and_then(|rows| rows.checked_mul(self.stride));
        let row = self.components * size;
        let end = last.and_then(|at| at.checked_add(self.offset)?.checked_add(row));
        if self.rows > 0 && end.is_none_or(|end| end > bytes.len()) {
            let has = bytes.len();
            return Err(format!("ends beyond the {has} bytes of its buffer view"));
        }
        let starts = (0..self.rows).map(|row| row * self.stride + self.offset);
        let numbers =
            starts.flat_map(|start| (0..self.components).map(move |part| start + part * size));
        Ok(numbers.map(|at| self.number(&bytes[at..at + size])).collect())
    }

    fn number(&self, bytes: &[u8]) -> f64 {
        let mut four = [0; 4];
        four[..bytes.len()].copy_from_slice(bytes);
        let word = u32::from_le_bytes(four);
        let (value, largest) = match self.kind {
            DataType::F32 => return f64::from(f32::from_bits(word)),
            DataType::U32 => (f64::from(word), f64::from(u32::MAX)),
            DataType::U16 => (f64::from(word as u16), 65535.0),
            DataType::U8 => (f64::from(word as u8), 255.0),
            DataType::I16 => (f64::from(word as u16 as i16), 32767.0),
            DataType::I8 => (f64::from(word as u8 as i8), 127.0),
        };
        if self.is_normalized { (value / largest).max(-1.0) } else { value }
    }
}
