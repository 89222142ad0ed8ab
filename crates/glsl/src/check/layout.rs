//! Qualifiers and `layout(...)`.

use super::{Checker, Res};
use crate::ast::{self, Qual};
use crate::lexer::At;
use crate::tree::{Access, Interpolation, Layout, Packing, Stage};

/// Where a declaration puts its variables.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Storage {
    Const,
    In,
    Out,
    InOut,
    Uniform,
    Buffer,
    Shared,
    /// Input of a fragment shader, output of a vertex shader.
    Varying,
}

/// The qualifiers of a declaration.
#[derive(Debug, Default)]
pub(super) struct Quals {
    pub storage: Option<Storage>,
    /// `const` beside another one, as in `const in`.
    pub constant: bool,
    pub layout: Layout,
    pub interpolation: Interpolation,
    pub access: Access,
    /// `local_size_x` and its siblings, with `local_size_x_id`.
    pub local_size: [Option<u32>; 3],
    pub local_ids: [Option<u32>; 3],
    pub early_tests: bool,
    pub depth: Option<String>,
    /// `std140` and what else is for a block as a whole.
    pub packs: bool,
    pub offset: Option<u32>,
    pub align: Option<u32>,
}

/// Formats of images.
const FORMATS: &[&str] = &[
    "rgba32f",
    "rgba16f",
    "rg32f",
    "rg16f",
    "r11f_g11f_b10f",
    "r32f",
    "r16f",
    "rgba16",
    "rgb10_a2",
    "rgba8",
    "rg16",
    "rg8",
    "r16",
    "r8",
    "rgba16_snorm",
    "rgba8_snorm",
    "rg16_snorm",
    "rg8_snorm",
    "r16_snorm",
    "r8_snorm",
    "rgba32i",
    "rgba16i",
    "rgba8i",
    "rg32i",
    "rg16i",
    "rg8i",
    "r32i",
    "r16i",
    "r8i",
    "rgba32ui",
    "rgba16ui",
    "rgb10_a2ui",
    "rgba8ui",
    "rg32ui",
    "rg16ui",
    "rg8ui",
    "r32ui",
    "r16ui",
    "r8ui",
];

/// Words of `layout(...)` that change nothing here.
const IGNORED: &[&str] = &[
    "shared",
    "packed",
    "column_major",
    "origin_upper_left",
    "depth_any",
    "depth_unchanged",
    "buffer_reference_align",
];

/// The words that are for a block as a whole.
const PACKING: [&str; 5] = ["std140", "std430", "scalar", "shared", "packed"];

/// The place of a word in the order of qualifiers, if it has one.
fn rank_of(word: &str) -> Option<u32> {
    Some(match word {
        "invariant" => 0,
        "smooth" | "flat" | "noperspective" => 1,
        "const" => 2,
        "centroid" => 3,
        "in" | "out" | "inout" | "uniform" | "attribute" | "varying" | "buffer" | "shared" => 4,
        "highp" | "mediump" | "lowp" => 5,
        _ => return None,
    })
}

impl<'a> Checker<'a> {
    pub(super) fn quals(&mut self, list: &'a [Qual<'a>]) -> Res<Quals> {
        let mut quals = Quals::default();
        let mut words: Vec<&str> = Vec::new();
        for qual in list {
            match qual {
                Qual::Word(name) if words.contains(&name.text) => {
                    return self.fail(name.at, format!("`{}` stands twice", name.text));
                }
                Qual::Word(name) => {
                    self.check_order(words.last().copied(), *name)?;
                    words.push(name.text);
                    self.qual_word(&mut quals, *name)?;
                }
                Qual::Layout(entries) => {
                    for (name, value) in entries {
                        self.layout_entry(&mut quals, *name, value.as_ref())?;
                    }
                }
            }
        }
        Ok(quals)
    }

    /// GLSL ES 1.00 and 3.00 want qualifiers in one order.
    fn check_order(&mut self, before: Option<&str>, name: ast::Name<'a>) -> Res<()> {
        if !self.version.es || self.version.number > 300 {
            return Ok(());
        }
        match (before.and_then(rank_of), rank_of(name.text)) {
            (Some(before), Some(rank)) if before > rank => {
                self.fail(name.at, format!("`{}` stands before the words before it", name.text))
            }
            _ => Ok(()),
        }
    }

    fn qual_word(&mut self, quals: &mut Quals, name: ast::Name<'a>) -> Res<()> {
        let storage = match name.text {
            "const" => {
                quals.constant = true;
                match quals.storage {
                    None => Storage::Const,
                    Some(Storage::In) => return Ok(()),
                    Some(_) => return self.fail(name.at, "`const` contradicts a word before it"),
                }
            }
            "in" => Storage::In,
            "out" => Storage::Out,
            "inout" => Storage::InOut,
            "attribute" => Storage::In,
            "varying" => Storage::Varying,
            "uniform" => Storage::Uniform,
            "buffer" => Storage::Buffer,
            "shared" => Storage::Shared,
            other => return self.other_word(quals, other, name.at),
        };
        match quals.storage {
            Some(Storage::Const) if quals.constant && storage == Storage::In => {}
            Some(before) if before != storage => {
                return self.fail(name.at, format!("`{}` contradicts a word before it", name.text));
            }
            _ => {}
        }
        quals.storage = Some(storage);
        Ok(())
    }

    fn other_word(&mut self, quals: &mut Quals, word: &str, at: At) -> Res<()> {
        match word {
            "flat" => quals.interpolation.flat = true,
            "noperspective" => quals.interpolation.linear = true,
            "centroid" => quals.interpolation.centroid = true,
            "sample" => quals.interpolation.sample = true,
            "invariant" => quals.interpolation.invariant = true,
            "readonly" => quals.access.readonly = true,
            "writeonly" => quals.access.writeonly = true,
            "coherent" | "volatile" => quals.access.coherent = true,
            "smooth" | "highp" | "mediump" | "lowp" | "precise" | "restrict" => {}
            _ => return self.refuse(at, format!("`{word}` has no counterpart in WGSL")),
        }
        Ok(())
    }

    fn layout_entry(
        &mut self,
        quals: &mut Quals,
        name: ast::Name<'a>,
        value: Option<&'a ast::Expr<'a>>,
    ) -> Res<()> {
        let number = match value {
            Some(value) => Some(self.layout_number(value)?),
            None => None,
        };
        let layout = &mut quals.layout;
        match (name.text, number) {
            ("location", Some(value)) => layout.location = Some(value),
            ("component", Some(value)) => layout.component = Some(value),
            ("index", Some(value)) => layout.index = Some(value),
            ("set", Some(value)) => layout.set = Some(value),
            ("binding", Some(value)) => layout.binding = Some(value),
            ("constant_id", Some(value)) => layout.constant_id = Some(value),
            ("input_attachment_index", Some(value)) => layout.attachment = Some(value),
            ("offset", Some(value)) => quals.offset = Some(value),
            ("align", Some(value)) => quals.align = Some(value),
            ("local_size_x", Some(value)) => quals.local_size[0] = Some(value),
            ("local_size_y", Some(value)) => quals.local_size[1] = Some(value),
            ("local_size_z", Some(value)) => quals.local_size[2] = Some(value),
            ("local_size_x_id", Some(value)) => quals.local_ids[0] = Some(value),
            ("local_size_y_id", Some(value)) => quals.local_ids[1] = Some(value),
            ("local_size_z_id", Some(value)) => quals.local_ids[2] = Some(value),
            _ => return self.layout_word(quals, name, number.is_some()),
        }
        Ok(())
    }

    fn layout_number(&mut self, value: &'a ast::Expr<'a>) -> Res<u32> {
        let number = self.constant_int(value, "a number of a layout")?;
        match number.as_size() {
            Some(size) if size < 1 << 24 => Ok(size),
            _ => self.fail(value.at, "a number of a layout is from 0 to 16777215"),
        }
    }

    fn layout_word(&mut self, quals: &mut Quals, name: ast::Name<'a>, has_value: bool) -> Res<()> {
        quals.packs |= PACKING.contains(&name.text);
        let layout = &mut quals.layout;
        match name.text {
            _ if IGNORED.contains(&name.text) => {
                if name.text == "column_major" {
                    layout.row_major = Some(false);
                }
            }
            _ if has_value => {
                let message = format!("`{}` is not known in a layout", name.text);
                return self.refuse(name.at, message);
            }
            "std140" => layout.packing = Some(Packing::Std140),
            "std430" => layout.packing = Some(Packing::Std430),
            "scalar" => layout.packing = Some(Packing::Scalar),
            "row_major" => layout.row_major = Some(true),
            "push_constant" => layout.push = true,
            "early_fragment_tests" => quals.early_tests = true,
            "depth_greater" | "depth_less" => quals.depth = Some(name.text.to_owned()),
            format if FORMATS.contains(&format) => layout.format = Some(format.to_owned()),
            _ => {
                let message = format!("`{}` is not known in a layout", name.text);
                return self.refuse(name.at, message);
            }
        }
        Ok(())
    }

    /// `layout(...) in;` and its siblings: what holds for the whole text.
    pub(super) fn global_layout(&mut self, quals: Quals, at: At) -> Res<()> {
        if quals.local_size.iter().chain(&quals.local_ids).any(Option::is_some)
            && self.shader.stage != Stage::Compute
        {
            return self.fail(at, "only a compute shader has a `local_size`");
        }
        for axis in 0..3 {
            if let Some(size) = quals.local_size[axis] {
                self.shader.local_size[axis] = size;
            }
            if let Some(id) = quals.local_ids[axis] {
                self.shader.local_size_ids[axis] = Some(id);
            }
        }
        if quals.early_tests {
            self.early_tests = Some(at);
        }
        let index = match quals.storage {
            Some(Storage::Uniform) => 0,
            Some(Storage::Buffer) => 1,
            _ => return Ok(()),
        };
        let kept = &mut self.packing[index];
        kept.packing = quals.layout.packing.or(kept.packing);
        kept.row_major = quals.layout.row_major.or(kept.row_major);
        Ok(())
    }
}
