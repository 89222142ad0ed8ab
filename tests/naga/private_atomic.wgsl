fn f(arg: ptr<private, atomic<i32>>) { atomicStore(arg, 0); }
@compute @workgroup_size(1) fn main() { }
