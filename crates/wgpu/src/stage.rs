//! Stages of pipelines.

use std::fmt;

use lamplight_bundle::{Found, Reflection};

/// Why a shader cannot be a stage.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum StageError {
    /// It is not text: ask the bundle for the target `wgsl`.
    NotText,
    /// A constant that the key chooses has a value that is no number.
    NotNumber(String),
}

impl fmt::Display for StageError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotText => f.write_str("the shader is not WGSL: ask for the target `wgsl`"),
            Self::NotNumber(name) => write!(f, "the value of the constant `{name}` is no number"),
        }
    }
}

impl std::error::Error for StageError {}

/// A module with its entry point, and the constants that the key chooses.
#[derive(Debug, Clone)]
pub struct Stage {
    /// For `module` of a stage.
    pub module: wgpu::ShaderModule,
    /// For `entry_point` of a stage.
    pub entry: String,
    constants: Vec<(String, f64)>,
}

impl Stage {
    /// Makes the module of a shader for the target `wgsl`.
    ///
    /// # Errors
    /// [`StageError::NotText`] for a shader of another target.
    pub fn new(device: &wgpu::Device, found: &Found) -> Result<Self, StageError> {
        let text = str::from_utf8(&found.bytes).map_err(|_| StageError::NotText)?;
        let constants = named_constants(found)?;
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some(&found.native.entry_name),
            source: wgpu::ShaderSource::Wgsl(text.into()),
        });
        Ok(Self { module, entry: found.native.entry_name.clone(), constants })
    }

    /// For `constants` of a stage's compilation options.
    pub fn constants(&self) -> Vec<(&str, f64)> {
        self.constants.iter().map(|(name, value)| (name.as_str(), *value)).collect()
    }
}

/// The values of overrides by the names that WGSL has for them: a number, or the name.
fn named_constants(found: &Found) -> Result<Vec<(String, f64)>, StageError> {
    let named = found.constants.iter().map(|constant| {
        let choice = found.native.choices.iter().find(|choice| choice.name == constant.name);
        let id = choice.and_then(|choice| choice.id).map(|id| id.to_string());
        let symbol = choice.and_then(|choice| choice.symbol.clone());
        let name = id.or(symbol).unwrap_or_else(|| constant.name.clone());
        let value = match constant.value.as_str() {
            "false" => 0.0,
            "true" => 1.0,
            number => number.parse().map_err(|_| StageError::NotNumber(name.clone()))?,
        };
        Ok((name, value))
    });
    named.collect()
}

/// The attributes of a vertex stage in one buffer without padding, and the bytes of a vertex.
/// Built-in inputs, and inputs of types that no vertex format has, are left out.
pub fn vertex_attributes(reflection: &Reflection) -> (u64, Vec<wgpu::VertexAttribute>) {
    let (mut stride, mut attributes) = (0, Vec::new());
    for input in &reflection.inputs {
        let format = input
            .shape
            .as_ref()
            .and_then(|shape| vertex_format(shape.scalar.as_deref()?, shape.rows.unwrap_or(1)));
        if let (Some(shader_location), Some(format)) = (input.location, format) {
            attributes.push(wgpu::VertexAttribute { format, offset: stride, shader_location });
            stride += format.size();
        }
    }
    (stride, attributes)
}

fn vertex_format(scalar: &str, rows: u32) -> Option<wgpu::VertexFormat> {
    use wgpu::VertexFormat as Format;
    Some(match (scalar, rows) {
        ("f32", 1) => Format::Float32,
        ("f32", 2) => Format::Float32x2,
        ("f32", 3) => Format::Float32x3,
        ("f32", 4) => Format::Float32x4,
        ("i32", 1) => Format::Sint32,
        ("i32", 2) => Format::Sint32x2,
        ("i32", 3) => Format::Sint32x3,
        ("i32", 4) => Format::Sint32x4,
        ("u32", 1) => Format::Uint32,
        ("u32", 2) => Format::Uint32x2,
        ("u32", 3) => Format::Uint32x3,
        ("u32", 4) => Format::Uint32x4,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use lamplight_bundle::{
        Constant, Native, OverrideChoice, Shape, Stage as BundleStage, Varying,
    };

    use super::*;

    fn found(value: &str) -> Found {
        let choice = OverrideChoice { name: "taps".to_owned(), id: Some(7), symbol: None };
        Found {
            bytes: Vec::new(),
            reflection: Arc::new(Reflection::of(BundleStage::Fragment)),
            native: Arc::new(Native { choices: vec![choice], ..Native::default() }),
            constants: vec![Constant {
                name: "taps".to_owned(),
                ty: "i32".to_owned(),
                value: value.to_owned(),
                bits: 0,
            }],
        }
    }

    #[test]
    fn constants_have_the_names_of_wgsl() {
        assert_eq!(named_constants(&found("-4")).unwrap(), [("7".to_owned(), -4.0)]);
        assert_eq!(named_constants(&found("true")).unwrap(), [("7".to_owned(), 1.0)]);
        let error = named_constants(&found("many")).unwrap_err();
        assert_eq!(error, StageError::NotNumber("7".to_owned()));
    }

    #[test]
    fn attributes_follow_each_other() {
        let input = |location: Option<u32>, rows: u32| Varying {
            name: None,
            location,
            builtin: None,
            ty: String::new(),
            shape: Some(Shape {
                scalar: Some("f32".to_owned()),
                rows: Some(rows),
                ..Shape::default()
            }),
            interpolation: None,
            sampling: None,
            blend_src: None,
        };
        let inputs = vec![input(Some(0), 3), input(None, 4), input(Some(2), 2)];
        let (stride, attributes) =
            vertex_attributes(&Reflection { inputs, ..Reflection::of(BundleStage::Vertex) });
        assert_eq!((stride, attributes.len()), (20, 2));
        assert_eq!((attributes[1].offset, attributes[1].shader_location), (12, 2));
    }
}
