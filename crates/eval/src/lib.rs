//! The evaluator: runs functions of a naga module on the CPU, in `f64`, in `f32`, or as a value
//! with a bound of its error.
//!
//! [`Program::new`] lowers a module once; [`Machine::new`] gives it memory; [`Machine::call`] runs
//! a function on scalars, [`Machine::quad`] on the four fragments that derivatives need. Arguments
//! and results are flattened to scalars in the order of declaration. An [`Observer`] sees every
//! instruction of a run, for which [`Program::with_names`] keeps what the author called its values.
//!
//! ```
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! use lamplight_eval::{Machine, Program};
//! let module = naga::front::wgsl::parse_str("fn half(x: f32) -> f32 { return 0.5 * x; }")?;
//! let info = naga::valid::Validator::new(Default::default(), Default::default()).validate(&module)?;
//! let program = Program::new(&module, &info)?;
//! let half = program.function("half").ok_or("no such function")?;
//! let mut machine = Machine::<f64>::new(&program)?;
//! assert_eq!(machine.call(half, &[3.0])?, &[1.5]);
//! # Ok(())
//! # }
//! ```

mod batch;
mod code;
mod dual;
mod error;
mod flow;
mod layout;
mod lower;
mod machine;
mod names;
mod number;
mod operation;
mod program;
mod resources;
mod shape;
mod traced;

pub use batch::Batch;
pub use code::Compare;
pub use dual::{DUAL_SEEDS, Dual};
pub use error::{Error, Finding, FindingKind};
pub use flow::SlotRange;
pub use layout::{MAX_SLOTS, SlotKind};
pub use machine::{Action, Executed, LOOP_LIMIT, Machine, Observer, Paced, TexelRead, TextureRead};
pub use names::{Variable, VariableKind, VariablePlace};
pub use number::{Bounded, Number, half_from, half_to};
pub use program::{Branch, CoveragePoint, Function, FunctionId, Program};
pub use resources::{
    Address, Filter, MipLevel, Resources, Sampler, Texels, Texture, TextureDimension,
};
pub use shape::{Shape, ShapePart};
pub use traced::Traced;
