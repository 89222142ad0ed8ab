@group(0) @binding(0) var<storage, read_write> counter: atomic<u32>;

@compute @workgroup_size(1)
fn cs_main() {
    loop {
        let result = atomicCompareExchangeWeak(&counter, 1u, 2u);
        continuing {
            break if result.exchanged;
        }
    }
}
