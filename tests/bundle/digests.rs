//! A digester remembers the hashes of what units share. Each digest is that of the unit by itself.

use std::sync::Arc;

use lamplight::bundle::{Digester, Native, Target, Unit};

use super::{Outcome, check, unit};

/// More units than a digester remembers values of.
const UNITS: usize = 6_000;

/// Some units share a value of the unit before them, by its address. Others have an equal value of
/// their own, or another one, perhaps at an address that a unit had which is gone.
pub fn remembered() -> Outcome {
    let digester = Digester::default();
    let mut kept: Option<Unit> = None;
    for number in 0..UNITS {
        let mut unit = unit(&format!("unit {}", number / 3), &[Target::SPIRV, Target::WGSL]);
        for artifact in unit.targets.values_mut() {
            let entry_name = format!("main{}", number % 97);
            artifact.native = Arc::new(Native { entry_name, ..Native::default() });
        }
        let earlier = kept.as_ref().filter(|_| number % 5 < 2);
        if let Some(earlier) = earlier {
            unit.reflection = earlier.reflection.clone();
            for (target, artifact) in &mut unit.targets {
                artifact.native = earlier.targets[target].native.clone();
            }
        }
        let (found, alone) = (digester.digest(&unit)?, unit.digest()?);
        check(found == alone, &format!("unit {number}: {found:?} instead of {alone:?}"))?;
        // Nothing else holds the units that are not kept.
        kept = (number % 4 != 3).then_some(unit);
    }
    Ok(())
}
