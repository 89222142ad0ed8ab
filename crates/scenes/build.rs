//! Lists the files of `src/sets/`.

use lamplight_build::{every_file, modules, write_table};

fn main() -> std::io::Result<()> {
    write_table("sets.rs", &modules("src/sets", "SET", "Set", every_file)?)
}
