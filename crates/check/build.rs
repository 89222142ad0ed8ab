//! Lists the files of `src/references/`.

use lamplight_build::{every_file, modules, write_table};

fn main() -> std::io::Result<()> {
    write_table(
        "references.rs",
        &modules("src/references", "REFERENCES", "ReferenceEntry", every_file)?,
    )
}
