//! Lists the files of `src/judges/`, and passes on the version of naga, which is one of them.

#![allow(clippy::print_stdout)]

use lamplight_build::{every_file, locked_version, modules, write_table};

fn main() -> std::io::Result<()> {
    println!("cargo::rustc-env=LAMPLIGHT_NAGA={}", locked_version("naga")?);
    write_table("judges.rs", &modules("src/judges", "JUDGE", "JudgeEntry", every_file)?)
}
