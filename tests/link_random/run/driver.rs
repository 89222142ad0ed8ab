//! Drivers that give other numbers for the same module.
//!
//! SwiftShader prepares a module with SPIRV-Tools before it compiles it, and what comes of that may
//! depend on the numbers that ids have: of two modules that differ in nothing else, one gave an
//! infinity for a constant. Such an answer says nothing about the output that was drawn, so what was
//! drawn otherwise is drawn again with other numbers.

use std::collections::BTreeMap;

use lamplight::bundle::Target;
use lamplight::execute::shipped::Shipped;

use super::{Drawn, Opened, Ready, Stages};

/// Numberings that are tried.
const NUMBERINGS: usize = 4;

/// The name of an executor that draws what the evaluator computes once ids of the same SPIR-V have
/// other numbers.
pub fn renumbered(sessions: &[Opened], target: Target, ready: &Ready<'_>) -> Option<&'static str> {
    let (_, name, session) = sessions.iter().find(|(one, ..)| *one == target)?;
    let stages = ready.stages.get(&target)?.as_ref().ok()?;
    let is_right = |unused: usize| {
        let own = with_unused(&stages.own, unused)?;
        let stages = Stages { own, ..stages.clone() };
        let (outputs, inputs) = ready.draw(&stages, session.as_ref()).ok()?;
        let drawn = Drawn { target, name, outputs, inputs };
        ready.compare(&[drawn], &mut BTreeMap::new()).is_empty().then_some(*name)
    };
    (1..=NUMBERINGS).find_map(is_right)
}

/// HLSL with variables in front that nothing reads: glslangValidator numbers what follows otherwise,
/// and spirv-opt leaves them out.
fn with_unused(stage: &Shipped, count: usize) -> Option<Shipped> {
    let unused = |number| format!("static float naga_unused_{number}_ = {number}.0;\n");
    let unused: String = (0..count).map(unused).collect();
    let bytes = [unused.as_bytes(), &stage.bytes].concat();
    (stage.target == Target::HLSL).then(|| Shipped { bytes, ..stage.clone() })
}
