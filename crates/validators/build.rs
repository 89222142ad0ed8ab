//! Lists the files of `src/programs/`, and passes on the version of naga, which is one of them.

#![allow(clippy::print_stdout)]

use lamplight_build::{every_file, locked_version, modules, write_table};

fn main() -> std::io::Result<()> {
    println!("cargo::rustc-env=LAMPLIGHT_NAGA={}", locked_version("naga")?);
    write_table("programs.rs", &modules("src/programs", "VALIDATOR", "ValidatorEntry", every_file)?)
}
