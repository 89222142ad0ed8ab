//! Lists the files of `src/targets/`.

use lamplight_build::{every_file, modules, write_table};

fn main() -> std::io::Result<()> {
    write_table("targets.rs", &modules("src/targets", "TARGET", "TargetEntry", every_file)?)
}
