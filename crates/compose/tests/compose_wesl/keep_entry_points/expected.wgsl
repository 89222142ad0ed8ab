const used = 2;
const_assert used == 2;
@vertex fn vs() -> @builtin(position) vec4f { return vec4f(helper()); }
fn helper() -> f32 { return f32(used); }
