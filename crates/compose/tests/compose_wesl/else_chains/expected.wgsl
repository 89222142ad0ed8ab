const x = 2;

fn main() -> i32 {
    return x + 20;
}
