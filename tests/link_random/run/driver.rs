//! Finds differences that are a defect of a driver.
//!
//! SwiftShader optimises a module with SPIRV-Tools before it compiles it. The result may depend on
//! the numbers of ids: of two modules that differed in nothing else, one gave an infinity for a
//! constant. Then the output is right and the driver is wrong. So a stage that was drawn differently
//! is drawn again with other numbers of ids.

use std::collections::BTreeMap;

use lamplight::bundle::Target;
use lamplight::execute::shipped::Shipped;

use super::{Drawn, Opened, Ready};

/// How many other numberings are tried.
const NUMBERINGS: usize = 12;

/// Draws a stage again with other numbers of ids. If the result is then the evaluator's, gives the
/// name of the executor.
pub fn renumbered(sessions: &[Opened], target: Target, ready: &Ready<'_>) -> Option<&'static str> {
    let (_, name, session) = sessions.iter().find(|(one, ..)| *one == target)?;
    let stages = ready.stages.get(&target)?.as_ref().ok()?;
    let is_right = |unused: usize| {
        let mut stages = stages.clone();
        let own = stages.own();
        *own = with_unused(own, unused)?;
        let (outputs, inputs) = ready.draw(&stages, session.as_ref()).ok()?;
        let drawn = Drawn { target, name, outputs, inputs };
        ready.compare(&[drawn], &mut BTreeMap::new()).is_empty().then_some(*name)
    };
    (1..=NUMBERINGS).find_map(is_right)
}

/// HLSL with unused variables in front. They change the numbers that glslangValidator gives to all
/// later ids, and spirv-opt removes them.
fn with_unused(stage: &Shipped, count: usize) -> Option<Shipped> {
    let unused = |number| format!("static float naga_unused_{number}_ = {number}.0;\n");
    let unused: String = (0..count).map(unused).collect();
    let bytes = [unused.as_bytes(), &stage.bytes].concat();
    (stage.target == Target::HLSL).then(|| Shipped { bytes, ..stage.clone() })
}
