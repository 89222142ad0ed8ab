fn main() {
        inner();
}
fn inner() { }
