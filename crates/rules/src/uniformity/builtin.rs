//! The built-in functions that ask for uniform control flow, or whose results vary.

use crate::names::is_of_subgroups;

/// What a built-in function asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Demand {
    Nothing,
    /// Uniform control flow, and nothing filters that.
    Barrier,
    Derivative,
    Subgroup,
}

/// A built-in function whose rules are its own.
#[derive(Debug, Clone, Copy)]
pub struct Builtin {
    pub demand: Demand,
    /// Its result may vary even if its arguments do not.
    pub varies: bool,
    /// The argument that must be uniform.
    pub uniform_argument: Option<usize>,
}

const PLAIN: Builtin = Builtin { demand: Demand::Nothing, varies: false, uniform_argument: None };

/// The built-in function of that name.
pub fn find(name: &str) -> Builtin {
    let of = |demand: Demand, varies: bool| Builtin { demand, varies, uniform_argument: None };
    match name {
        "storageBarrier" | "textureBarrier" | "workgroupBarrier" => of(Demand::Barrier, false),
        "workgroupUniformLoad" => {
            Builtin { uniform_argument: Some(0), ..of(Demand::Barrier, false) }
        }
        "dpdx"
        | "dpdxCoarse"
        | "dpdxFine"
        | "dpdy"
        | "dpdyCoarse"
        | "dpdyFine"
        | "fwidth"
        | "fwidthCoarse"
        | "fwidthFine"
        | "textureSample"
        | "textureSampleBias"
        | "textureSampleCompare" => of(Demand::Derivative, true),
        "subgroupShuffleUp" | "subgroupShuffleDown" | "subgroupShuffleXor" => {
            Builtin { uniform_argument: Some(1), ..of(Demand::Subgroup, true) }
        }
        _ if is_of_subgroups(name) => of(Demand::Subgroup, true),
        _ if name.starts_with("atomic") => of(Demand::Nothing, true),
        _ => PLAIN,
    }
}
