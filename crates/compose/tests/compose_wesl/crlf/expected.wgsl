// doc
fn main() {
    let y = 2; // y
}
