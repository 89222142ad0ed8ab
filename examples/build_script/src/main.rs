//! Loads the bundle that the build script made, and prints the size of each permutation.

use lamplight_bundle::{Bundle, Error, Target};

fn main() -> Result<(), Error> {
    let bundle = Bundle::from_bytes(
        include_bytes!(concat!(env!("OUT_DIR"), "/shaders.lamplight")).to_vec(),
    )?;
    let lamp = bundle.program("lamp")?.shader("fs_main")?;
    for key in lamp.keys()? {
        println!("{key}: {} bytes of SPIR-V", lamp.get(&key, Target::SPIRV)?.bytes.len());
    }
    Ok(())
}
