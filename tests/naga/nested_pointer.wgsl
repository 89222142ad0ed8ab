@group(0) @binding(0) var<storage, read_write> result: array<i32>;
fn raise(target_value: ptr<function, i32>) { *target_value += 5; }
fn nested(all: ptr<function, array<array<array<i32, 2>, 3>, 4>>, first: u32, last: u32) { raise(&(*all)[first][0][last]); }
@compute @workgroup_size(1) fn cs_main(@builtin(local_invocation_index) at: u32) {
    var all = array<array<array<i32, 2>, 3>, 4>();
    nested(&all, at, 1u);
    result[0] = all[at][0][1];
}
