//! Functions of textures and images. Their names are made of parts, so one rule reads all of them.

use crate::types::{Dim, Opaque, OpaqueKind, Scalar, Type};

/// How a level is chosen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lod {
    /// By derivatives, with an optional bias.
    Implicit,
    /// A number.
    Level,
    /// Two gradients.
    Gradient,
    /// A texel, without filtering.
    Fetch,
}

/// What a function of textures or images does.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Access {
    /// It reads a texture.
    Sample {
        /// Whether the coordinate is divided by its last number.
        projected: bool,
        /// How the level is chosen.
        lod: Lod,
        /// Whether there is an offset.
        offset: bool,
    },
    /// Four texels.
    Gather {
        /// Whether there is an offset.
        offset: bool,
    },
    /// `textureSize`
    Size,
    /// `textureQueryLevels`
    Levels,
    /// `textureQueryLod`
    QueryLod,
    /// `textureSamples`, `imageSamples`
    Samples,
    /// `imageLoad`
    Load,
    /// `imageStore`
    Store,
    /// `imageSize`
    ImageSize,
    /// `subpassLoad`
    Subpass,
}

/// The functions of older versions: what they are now, and for which textures.
const OLD: &[(&str, &str)] = &[
    ("texture1D", "texture"),
    ("texture2D", "texture"),
    ("texture3D", "texture"),
    ("textureCube", "texture"),
    ("texture2DRect", "texture"),
    ("shadow1D", "texture"),
    ("shadow2D", "texture"),
    ("texture1DProj", "textureProj"),
    ("texture2DProj", "textureProj"),
    ("texture3DProj", "textureProj"),
    ("texture2DRectProj", "textureProj"),
    ("shadow1DProj", "textureProj"),
    ("shadow2DProj", "textureProj"),
    ("texture1DLod", "textureLod"),
    ("texture2DLod", "textureLod"),
    ("texture3DLod", "textureLod"),
    ("textureCubeLod", "textureLod"),
    ("shadow1DLod", "textureLod"),
    ("shadow2DLod", "textureLod"),
    ("texture1DProjLod", "textureProjLod"),
    ("texture2DProjLod", "textureProjLod"),
    ("texture3DProjLod", "textureProjLod"),
    ("shadow1DProjLod", "textureProjLod"),
    ("shadow2DProjLod", "textureProjLod"),
    ("texture2DLodEXT", "textureLod"),
    ("textureCubeLodEXT", "textureLod"),
    ("texture2DProjLodEXT", "textureProjLod"),
    ("texture2DGradEXT", "textureGrad"),
    ("textureCubeGradEXT", "textureGrad"),
    ("texture2DProjGradEXT", "textureProjGrad"),
    ("shadow2DEXT", "texture"),
    ("shadow2DProjEXT", "textureProj"),
    ("texture1DGradARB", "textureGrad"),
    ("texture2DGradARB", "textureGrad"),
    ("texture3DGradARB", "textureGrad"),
    ("textureCubeGradARB", "textureGrad"),
    ("shadow1DGradARB", "textureGrad"),
    ("shadow2DGradARB", "textureGrad"),
    ("texture1DProjGradARB", "textureProjGrad"),
    ("texture2DProjGradARB", "textureProjGrad"),
    ("texture3DProjGradARB", "textureProjGrad"),
    ("shadow1DProjGradARB", "textureProjGrad"),
    ("shadow2DProjGradARB", "textureProjGrad"),
];

/// The function of that name.
pub fn find_texture_function(name: &str) -> Option<Access> {
    let old = OLD.iter().find(|(old, _)| *old == name);
    let name = old.map_or(name, |(_, new)| *new);
    match name {
        "textureSize" => return Some(Access::Size),
        "textureQueryLevels" => return Some(Access::Levels),
        "textureQueryLod" => return Some(Access::QueryLod),
        "textureSamples" | "imageSamples" => return Some(Access::Samples),
        "imageLoad" => return Some(Access::Load),
        "imageStore" => return Some(Access::Store),
        "imageSize" => return Some(Access::ImageSize),
        "subpassLoad" => return Some(Access::Subpass),
        "textureGather" => return Some(Access::Gather { offset: false }),
        "textureGatherOffset" => return Some(Access::Gather { offset: true }),
        "texelFetch" | "texelFetchOffset" => {
            let offset = name.ends_with("Offset");
            return Some(Access::Sample { projected: false, lod: Lod::Fetch, offset });
        }
        _ => {}
    }
    let rest = name.strip_prefix("texture")?;
    let (projected, rest) = take_part(rest, "Proj");
    let (level, rest) = take_part(rest, "Lod");
    let (gradient, rest) = take_part(rest, "Grad");
    let (offset, rest) = take_part(rest, "Offset");
    let lod = match (level, gradient) {
        (false, false) => Lod::Implicit,
        (true, false) => Lod::Level,
        (false, true) => Lod::Gradient,
        (true, true) => return None,
    };
    rest.is_empty().then_some(Access::Sample { projected, lod, offset })
}

fn take_part<'a>(text: &'a str, part: &str) -> (bool, &'a str) {
    match text.strip_prefix(part) {
        Some(rest) => (true, rest),
        None => (false, text),
    }
}

/// A call's parameters after the texture, the number of them that may be missing, and its result.
/// Alternatives are separate lists.
#[derive(Debug)]
pub struct Form {
    /// Types of the parameters.
    pub params: Vec<Type>,
    /// How many of the last may be missing.
    pub optional: usize,
    /// The result.
    pub ret: Type,
}

/// The forms that a function has for a texture. There are none if it does not take it.
pub fn forms_of(access: Access, opaque: &Opaque) -> Vec<Form> {
    use OpaqueKind::{Combined, Image, Subpass, Texture};
    let fits = match access {
        Access::Load | Access::Store | Access::ImageSize => opaque.kind == Image,
        Access::Subpass => opaque.kind == Subpass,
        Access::Sample { lod: Lod::Fetch, .. } if opaque.shadow => false,
        Access::Sample { lod: Lod::Fetch, .. } | Access::Size | Access::Levels => {
            matches!(opaque.kind, Combined | Texture)
        }
        Access::Samples => matches!(opaque.kind, Combined | Texture | Image),
        _ => opaque.kind == Combined,
    };
    if !fits {
        return Vec::new();
    }
    let texel = Type::Vector(opaque.scalar, 4);
    match access {
        Access::Sample { projected, lod, offset } => sample_forms(opaque, projected, lod, offset),
        Access::Gather { offset } => gather_forms(opaque, offset),
        Access::Size => {
            let whole = opaque.multisampled || matches!(opaque.dim, Dim::Rect | Dim::Buffer);
            let params = if whole { Vec::new() } else { vec![int(1)] };
            vec![Form { params, optional: 0, ret: int(size_numbers(opaque)) }]
        }
        Access::ImageSize => {
            vec![Form { params: Vec::new(), optional: 0, ret: int(size_numbers(opaque)) }]
        }
        Access::Levels | Access::Samples => {
            vec![Form { params: Vec::new(), optional: 0, ret: int(1) }]
        }
        Access::QueryLod => {
            vec![Form { params: vec![float(opaque.flat())], optional: 0, ret: float(2) }]
        }
        Access::Load => {
            vec![Form { params: with_sample(opaque), optional: 0, ret: texel }]
        }
        Access::Store => {
            let mut params = with_sample(opaque);
            params.push(texel);
            vec![Form { params, optional: 0, ret: Type::Void }]
        }
        Access::Subpass => {
            let params = if opaque.multisampled { vec![int(1)] } else { Vec::new() };
            vec![Form { params, optional: 0, ret: texel }]
        }
    }
}

fn with_sample(opaque: &Opaque) -> Vec<Type> {
    let mut params = vec![int(opaque.coordinates())];
    if opaque.multisampled {
        params.push(int(1));
    }
    params
}

/// How many numbers a size has: a cube has two.
fn size_numbers(opaque: &Opaque) -> u8 {
    let flat = if opaque.dim == Dim::Cube { 2 } else { opaque.flat() };
    flat + u8::from(opaque.arrayed)
}

fn float(size: u8) -> Type {
    Type::vector(Scalar::Float, size)
}

fn int(size: u8) -> Type {
    Type::vector(Scalar::Int, size)
}

fn sample_forms(opaque: &Opaque, projected: bool, lod: Lod, offset: bool) -> Vec<Form> {
    let texel = Type::Vector(opaque.scalar, 4);
    let ret = if opaque.shadow { float(1) } else { texel };
    if lod == Lod::Fetch {
        let mut params = vec![int(opaque.coordinates())];
        if !matches!(opaque.dim, Dim::Rect | Dim::Buffer) {
            params.push(int(1));
        }
        if offset {
            params.push(int(opaque.flat()));
        }
        return vec![Form { params, optional: 0, ret }];
    }
    if opaque.multisampled || opaque.dim == Dim::Buffer {
        return Vec::new();
    }
    let forms = coordinate_forms(opaque, projected);
    let add = |mut params: Vec<Type>| {
        let mut optional = 0;
        match lod {
            Lod::Level => params.push(float(1)),
            Lod::Gradient => params.extend([float(opaque.flat()), float(opaque.flat())]),
            Lod::Implicit | Lod::Fetch => {}
        }
        if offset {
            params.push(int(opaque.flat()));
        }
        if lod == Lod::Implicit {
            params.push(float(1));
            optional = 1;
        }
        Form { params, optional, ret: ret.clone() }
    };
    forms.into_iter().map(add).collect()
}

/// What stands before levels and offsets: the coordinate, and where it has no room for it, the
/// reference value.
fn coordinate_forms(opaque: &Opaque, projected: bool) -> Vec<Vec<Type>> {
    let flat = opaque.flat();
    if projected {
        // The divisor is the last number; sampler2D takes a vec4 with an unused number too.
        return match (opaque.dim, opaque.shadow) {
            _ if opaque.arrayed => Vec::new(),
            (Dim::Cube, _) => Vec::new(),
            (_, true) => vec![vec![float(4)]],
            (Dim::D3, _) => vec![vec![float(4)]],
            _ => vec![vec![float(flat + 1)], vec![float(4)]],
        };
    }
    let numbers = opaque.coordinates();
    match (opaque.shadow, numbers) {
        (false, _) => vec![vec![float(numbers)]],
        // sampler1DShadow has an unused number.
        (true, 1) => vec![vec![float(3)]],
        (true, 2 | 3) => vec![vec![float(numbers + 1)]],
        (true, _) => vec![vec![float(4), float(1)]],
    }
}

fn gather_forms(opaque: &Opaque, offset: bool) -> Vec<Form> {
    if opaque.multisampled || !matches!(opaque.dim, Dim::D2 | Dim::Cube | Dim::Rect) {
        return Vec::new();
    }
    let mut params = vec![float(opaque.coordinates())];
    if opaque.shadow {
        params.push(float(1));
    }
    if offset {
        params.push(int(opaque.flat()));
    }
    let optional = usize::from(!opaque.shadow);
    if !opaque.shadow {
        params.push(int(1));
    }
    vec![Form { params, optional, ret: Type::Vector(opaque.scalar, 4) }]
}
