//! Types as fields: what an engine needs to know of a type without parsing its name.

use naga::{
    ArraySize, GlobalVariable, Handle, ImageClass, ImageDimension, Module, ScalarKind,
    StorageAccess, StorageFormat, Type, TypeInner,
};

use lamplight_bundle::{Access, SampleType, Shape, TextureShape};

/// The shape of a type of numbers, or of an array of anything. `None` for structs, textures and
/// samplers.
pub(super) fn shape_of(module: &Module, ty: Handle<Type>) -> Option<Shape> {
    match module.types[ty].inner {
        TypeInner::Scalar(scalar) | TypeInner::Atomic(scalar) => {
            Some(Shape { scalar: Some(scalar_name(scalar)), ..Shape::default() })
        }
        TypeInner::Vector { size, scalar } => Some(Shape {
            scalar: Some(scalar_name(scalar)),
            rows: Some(size as u32),
            ..Shape::default()
        }),
        TypeInner::Matrix { columns, rows, scalar } => Some(Shape {
            scalar: Some(scalar_name(scalar)),
            rows: Some(rows as u32),
            columns: Some(columns as u32),
            matrix_stride: Some(column_stride(rows, scalar)),
            count: None,
        }),
        TypeInner::Array { base, size, stride: _ } => {
            let element = match module.types[base].inner {
                TypeInner::Array { base: _, size: _, stride: _ } => Shape::default(),
                _ => shape_of(module, base).unwrap_or_default(),
            };
            Some(Shape { count: Some(array_count(size)), ..element })
        }
        _ => None,
    }
}

/// Bytes from one column to the next: a column of three takes the room of four.
fn column_stride(rows: naga::VectorSize, scalar: naga::Scalar) -> u32 {
    let components = match rows {
        naga::VectorSize::Bi => 2,
        naga::VectorSize::Tri | naga::VectorSize::Quad => 4,
    };
    components * u32::from(scalar.width)
}

fn array_count(size: ArraySize) -> u32 {
    match size {
        ArraySize::Constant(count) => count.get(),
        ArraySize::Pending(_) | ArraySize::Dynamic => 0,
    }
}

fn scalar_name(scalar: naga::Scalar) -> String {
    let naga::Scalar { kind, width } = scalar;
    let bits = u32::from(width) * 8;
    match kind {
        ScalarKind::Float => format!("f{bits}"),
        ScalarKind::Sint => format!("i{bits}"),
        ScalarKind::Uint => format!("u{bits}"),
        ScalarKind::Bool => "bool".to_owned(),
        ScalarKind::AbstractInt | ScalarKind::AbstractFloat => "abstract".to_owned(),
    }
}

/// Whether a global is a sampler that may filter.
pub(super) fn is_filtering(module: &Module, sampler: Handle<GlobalVariable>) -> bool {
    let mut ty = module.global_variables[sampler].ty;
    if let TypeInner::BindingArray { base, size: _ } = module.types[ty].inner {
        ty = base;
    }
    matches!(module.types[ty].inner, TypeInner::Sampler { comparison: false })
}

/// The shape of a texture; `None` for everything else. `is_filtered` says whether a sampler that may
/// filter reads it.
pub(super) fn texture_shape(
    module: &Module,
    ty: Handle<Type>,
    is_filtered: bool,
) -> Option<TextureShape> {
    let TypeInner::Image { dim, arrayed, class } = module.types[ty].inner else { return None };
    let (multisampled, sample_type, storage) = match class {
        ImageClass::Sampled { kind, multi } => (multi, Some(sample_type(kind, is_filtered)), None),
        ImageClass::Depth { multi } => (multi, Some(SampleType::Depth), None),
        ImageClass::Storage { format, access } => (false, None, Some((format, access))),
        ImageClass::External => (false, Some(SampleType::Float), None),
    };
    Some(TextureShape {
        dimension: dimension_name(dim, arrayed).to_owned(),
        multisampled,
        sample_type,
        format: storage.map(|(format, _)| format_name(format)),
        access: storage.map(|(_, access)| access_of(access)),
    })
}

fn sample_type(kind: ScalarKind, is_filtered: bool) -> SampleType {
    match kind {
        ScalarKind::Sint => SampleType::Sint,
        ScalarKind::Uint => SampleType::Uint,
        _ if is_filtered => SampleType::Float,
        _ => SampleType::UnfilterableFloat,
    }
}

fn dimension_name(dim: ImageDimension, arrayed: bool) -> &'static str {
    match (dim, arrayed) {
        (ImageDimension::D1, false) => "1d",
        (ImageDimension::D1, true) => "1d_array",
        (ImageDimension::D2, false) => "2d",
        (ImageDimension::D2, true) => "2d_array",
        (ImageDimension::D3, _) => "3d",
        (ImageDimension::Cube, false) => "cube",
        (ImageDimension::Cube, true) => "cube_array",
    }
}

/// The name of a format in WGSL, which is naga's own in lower case.
fn format_name(format: StorageFormat) -> String {
    format!("{format:?}").to_lowercase()
}

fn access_of(access: StorageAccess) -> Access {
    let reads = access.intersects(StorageAccess::LOAD | StorageAccess::ATOMIC);
    match (reads, access.intersects(StorageAccess::STORE | StorageAccess::ATOMIC)) {
        (true, true) => Access::ReadWrite,
        (true, false) => Access::Read,
        _ => Access::Write,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn global_type(text: &str) -> (Module, Handle<Type>) {
        let module = naga::front::wgsl::parse_str(text).unwrap();
        let ty = module.global_variables.iter().next().unwrap().1.ty;
        (module, ty)
    }

    /// WGSL's table of alignments and sizes has these strides: section "Memory Layouts".
    #[test]
    fn columns_have_the_stride_of_the_specification() {
        for (name, stride) in [("mat3x3f", 16), ("mat2x2f", 8), ("mat4x3f", 16), ("mat3x2f", 8)] {
            let (module, ty) =
                global_type(&format!("@group(0) @binding(0) var<uniform> m: {name};"));
            assert_eq!(shape_of(&module, ty).unwrap().matrix_stride, Some(stride), "{name}");
        }
        let (module, ty) = global_type("@group(0) @binding(0) var<uniform> m: array<mat3x2f, 5>;");
        let shape = shape_of(&module, ty).unwrap();
        assert_eq!((shape.rows, shape.columns, shape.count), (Some(2), Some(3), Some(5)));
        assert_eq!(shape.scalar.as_deref(), Some("f32"));
    }

    #[test]
    fn textures_say_what_is_sampled() {
        let of = |name: &str, is_filtered| {
            let (module, ty) = global_type(&format!("@group(0) @binding(0) var t: {name};"));
            texture_shape(&module, ty, is_filtered).unwrap()
        };
        assert_eq!(of("texture_2d<f32>", true).sample_type, Some(SampleType::Float));
        assert_eq!(of("texture_2d<f32>", false).sample_type, Some(SampleType::UnfilterableFloat));
        assert_eq!(of("texture_2d<u32>", false).sample_type, Some(SampleType::Uint));
        assert_eq!(of("texture_depth_cube_array", false).dimension, "cube_array");
        assert!(of("texture_multisampled_2d<f32>", false).multisampled);
        let storage = of("texture_storage_2d<rgba8unorm, write>", false);
        assert_eq!(storage.format.as_deref(), Some("rgba8unorm"));
        assert_eq!((storage.access, storage.sample_type), (Some(Access::Write), None));
    }
}
