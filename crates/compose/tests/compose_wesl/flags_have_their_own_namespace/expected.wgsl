const debug = 10;
fn main() -> i32 { return debug * 2; }
