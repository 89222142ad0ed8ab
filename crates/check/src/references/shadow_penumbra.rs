//! Source: Fernando, 2005: similar triangles.

use super::Source::Published;
use super::{CallArguments, Expected, ReferenceEntry};

pub const REFERENCES: ReferenceEntry = ReferenceEntry {
    module: "shadow::penumbra",
    functions: &[("pcss_width", Published, near), ("pcss_width_directional", Published, distant)],
};

/// The penumbra by similar triangles: size*(receiver/blocker - 1).
fn near(a: &mut CallArguments<'_>) -> Expected {
    let (receiver, blocker, size) = (a.f64(), a.f64(), a.f64().max(0.0));
    if blocker <= 0.0 || receiver <= blocker {
        return 0.0.into();
    }
    (size * (receiver / blocker - 1.0).min(1e6)).into()
}

fn distant(a: &mut CallArguments<'_>) -> Expected {
    let (receiver, blocker, size) = (a.f64(), a.f64(), a.f64());
    if receiver <= blocker || size <= 0.0 {
        0.0.into()
    } else {
        ((receiver - blocker) * size).into()
    }
}
