//! Sources: OpenGL Programming Guide, example 7.13; Karis, "Real Shading in Unreal Engine 4", 2013.

use super::{Arguments, Entry, Expected};

pub const REFERENCES: Entry = Entry {
    module: "ambient::ibl",
    functions: &[("ibl_mix", ibl_mix), ("reflect_world", reflect_world), ("split_sum", split_sum)],
};

/// c = mix(B, D*B, dp), then mix(c, S + c, sp).
fn ibl_mix(a: &mut Arguments<'_>) -> Expected {
    let (base, diffuse, specular, dp, sp) = (a.vec3(), a.vec3(), a.vec3(), a.f64(), a.f64());
    let c = base.lerp(diffuse * base, dp);
    c.lerp(specular + c, sp).into()
}

/// The mirrored view vector, turned from eye to world space.
fn reflect_world(a: &mut Arguments<'_>) -> Expected {
    let (view, n, v) = (a.mat3(), a.vec3(), a.vec3());
    (view.transpose() * (2.0 * n.dot(v) * n - v)).into()
}

fn split_sum(a: &mut Arguments<'_>) -> Expected {
    let (f0, dfg, prefiltered) = (a.vec3(), a.vec2(), a.vec3());
    (prefiltered * (f0 * dfg.x + dfg.y)).into()
}
