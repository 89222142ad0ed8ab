//! A digester remembers the hashes of values that several units share. Each of its digests must be
//! equal to [`Unit::digest`], which remembers nothing.

use std::sync::Arc;

use lamplight_bundle::{Digester, Native, Target, Unit};

use super::{Outcome, check, unit};

/// More units than a digester remembers values of.
const UNITS: usize = 6_000;

/// Some units share the `Arc`s of an earlier unit. Others have equal values in `Arc`s of their own,
/// or different values, perhaps at the address of a value that was freed.
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
        // A unit that is not kept is freed, so that a later value may reuse its address.
        kept = (number % 4 != 3).then_some(unit);
    }
    Ok(())
}
