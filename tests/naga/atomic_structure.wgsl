struct Inner { count: atomic<u32> }
struct Outer { inner: Inner }
@group(0) @binding(0) var<storage, read_write> outer: Outer;
@group(0) @binding(1) var<storage, read_write> result: u32;
@compute @workgroup_size(1) fn cs_main() {
    let copied = outer;
    result = 1u;
}
