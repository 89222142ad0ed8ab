//! Frames: what an executor that draws is given, and what it gives back.
//!
//! The targets of a frame hold words, four for each pixel, so that results are exact to the bit on
//! every device.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::fixture::{Fixture, FixtureSampler, FixtureTexture};

/// Triangles. The attributes of a vertex are interleaved.
#[derive(Debug, Clone, Default)]
pub struct Mesh {
    /// Without attributes the vertex stage makes the triangles from the vertex index: one triangle,
    /// or those of the indices.
    pub attributes: Vec<VertexAttribute>,
    /// Words of every vertex, attribute after attribute.
    pub words: Vec<u32>,
    /// Three vertices for each triangle. If this is empty, each three vertices in order are a
    /// triangle.
    pub indices: Vec<u32>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct VertexAttribute {
    pub location: u32,
    pub format: VertexFormat,
}

/// The format of a vertex attribute.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VertexFormat {
    Uint32,
    Uint32x2,
    Uint32x3,
    Uint32x4,
    Sint32,
    Sint32x2,
    Sint32x3,
    Sint32x4,
    Float32,
    Float32x2,
    Float32x3,
    Float32x4,
}

impl VertexFormat {
    /// How many words of 32 bits it has.
    pub fn words(self) -> u32 {
        match self {
            Self::Uint32 | Self::Sint32 | Self::Float32 => 1,
            Self::Uint32x2 | Self::Sint32x2 | Self::Float32x2 => 2,
            Self::Uint32x3 | Self::Sint32x3 | Self::Float32x3 => 3,
            Self::Uint32x4 | Self::Sint32x4 | Self::Float32x4 => 4,
        }
    }

    /// Whether its numbers are integers, and whether those have a sign.
    pub fn integers(self) -> Option<bool> {
        match self {
            Self::Uint32 | Self::Uint32x2 | Self::Uint32x3 | Self::Uint32x4 => Some(false),
            Self::Sint32 | Self::Sint32x2 | Self::Sint32x3 | Self::Sint32x4 => Some(true),
            Self::Float32 | Self::Float32x2 | Self::Float32x3 | Self::Float32x4 => None,
        }
    }
}

/// An entry point of a module.
#[derive(Debug, Clone, Copy)]
pub struct EntryPoint<'a> {
    pub module: &'a naga::Module,
    pub entry: &'a str,
}

/// The bytes of uniform buffers, by group and binding.
pub type Buffers = BTreeMap<(u32, u32), Vec<u8>>;

/// Everything that frames are drawn with. Buffers, textures and samplers that the entry points do
/// not use are ignored.
#[derive(Debug)]
pub struct Drawing<'a> {
    pub vertex: EntryPoint<'a>,
    /// Returns four words at each of the locations 0 to `targets - 1`. With `None` only depth is
    /// drawn.
    pub fragment: Option<EntryPoint<'a>>,
    pub targets: u32,
    /// The meshes. All are drawn into each frame, in this order.
    pub items: &'a [DrawItem<'a>],
    /// A frame is drawn for each view, which has buffers of its own.
    pub views: &'a [Buffers],
    /// Uniform buffers that all frames and items share.
    pub buffers: &'a Buffers,
    /// The uniform buffers on which no texture coordinate depends. Where a driver fails with too
    /// many uniform buffers, these are the first to be bound as storage buffers.
    pub plain: &'a [(u32, u32)],
    /// Textures and samplers.
    pub fixtures: &'a BTreeMap<(u32, u32), Arc<Fixture>>,
    /// The smaller levels of textures that have some, the larger ones first.
    pub levels: &'a BTreeMap<(u32, u32), Vec<FixtureTexture>>,
    /// Width and height in pixels.
    pub size: [u32; 2],
    pub state: PipelineState,
}

static NO_BUFFERS: [Buffers; 1] = [Buffers::new()];
static NO_LEVELS: BTreeMap<(u32, u32), Vec<FixtureTexture>> = BTreeMap::new();

impl<'a> Drawing<'a> {
    /// The sampler at a group and binding.
    pub fn sampler_at(&self, [group, binding]: [u32; 2]) -> Option<FixtureSampler> {
        self.fixtures.get(&(group, binding))?.sampler()
    }

    /// One frame with one target, no buffers but those of the items, and the state's defaults.
    pub fn of_items(
        [vertex, fragment]: [EntryPoint<'a>; 2],
        items: &'a [DrawItem<'a>],
        fixtures: &'a BTreeMap<(u32, u32), Arc<Fixture>>,
        size: [u32; 2],
    ) -> Self {
        Self {
            vertex,
            fragment: Some(fragment),
            targets: 1,
            items,
            views: &NO_BUFFERS,
            buffers: &NO_BUFFERS[0],
            plain: &[],
            fixtures,
            levels: &NO_LEVELS,
            size,
            state: PipelineState::default(),
        }
    }
}

/// A mesh with uniform buffers of its own.
#[derive(Debug, Clone, Copy)]
pub struct DrawItem<'a> {
    pub mesh: &'a Mesh,
    pub buffers: &'a Buffers,
}

#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct PipelineState {
    /// Whether nearer fragments (of smaller depth) hide others.
    pub depth_test: bool,
    /// Whether [`Frame::depth`] is filled. This needs the depth test.
    pub keep_depth: bool,
    pub cull: Option<Face>,
    /// Whether front faces wind clockwise in the frame, because it is drawn mirrored.
    pub mirrored: bool,
    /// Polygon offset (depth bias): the factor of the slope, and a constant in smallest steps of
    /// depth.
    pub offset: [f32; 2],
}

impl PipelineState {
    /// Whether nothing differs from the defaults but the depth test.
    #[cfg(not(target_family = "wasm"))]
    pub(super) fn is_plain(self) -> bool {
        self == Self { depth_test: self.depth_test, ..Self::default() }
    }
}

/// A side of a triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Face {
    Front,
    Back,
}

/// What was drawn.
#[derive(Debug, Clone)]
pub struct Frame {
    /// The words of each target: four per pixel, row by row from the top. Pixels that nothing
    /// covers hold [`SENTINEL`](crate::kernel::SENTINEL).
    pub targets: Vec<Vec<u32>>,
    /// The depth of each pixel, 1 where nothing was drawn; empty unless it was to be kept.
    pub depth: Vec<f32>,
    /// What was done differently from what was asked for, since the driver would have failed.
    pub detour: Option<&'static str>,
}

/// Group and binding.
pub(super) type BindingPlace = (u32, u32);

impl Mesh {
    /// Bytes of a vertex.
    pub fn stride(&self) -> u64 {
        self.attributes.iter().map(|attribute| 4 * u64::from(attribute.format.words())).sum()
    }

    /// How many vertices there are.
    pub fn vertices(&self) -> u32 {
        if self.attributes.is_empty() {
            self.indices.iter().max().map_or(3, |last| last.saturating_add(1))
        } else {
            (self.words.len() as u64 * 4 / self.stride().max(4)) as u32
        }
    }

    /// Each attribute with its offset in a vertex, in bytes.
    pub fn layout(&self) -> Vec<(VertexAttribute, u64)> {
        let offsets = self.attributes.iter().scan(0, |offset, attribute| {
            Some(std::mem::replace(offset, *offset + 4 * u64::from(attribute.format.words())))
        });
        self.attributes.iter().copied().zip(offsets).collect()
    }
}

impl Drawing<'_> {
    /// The buffer of a binding: that of the view or the item, or else the shared one.
    pub fn buffer<'b>(
        &'b self,
        view: &'b Buffers,
        item: &'b DrawItem<'_>,
        place: BindingPlace,
    ) -> Option<&'b Vec<u8>> {
        view.get(&place).or_else(|| item.buffers.get(&place)).or_else(|| self.buffers.get(&place))
    }

    #[cfg(not(target_family = "wasm"))]
    pub(super) fn is_buffer(&self, place: BindingPlace) -> bool {
        let everywhere = self
            .views
            .iter()
            .chain(self.items.iter().map(|item| item.buffers))
            .chain([self.buffers]);
        everywhere.into_iter().any(|buffers| buffers.contains_key(&place))
    }
}
