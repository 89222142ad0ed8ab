//! The materials of a scene's objects, numbered for the array that holds those of all objects.

use super::sets::{Material, Scene};

/// How many materials the array of the library's programs has.
const MATERIALS: usize = 14;

impl Scene {
    /// Puts the materials of the objects into the array, each for both of its sides, and gives the
    /// objects their numbers. Materials are one if a surface of glTF reads the same from them.
    ///
    /// # Errors
    /// The objects have more materials than the array.
    pub fn number_materials(&mut self) -> Result<(), String> {
        let mut found: Vec<Material> = Vec::new();
        for object in &mut self.objects {
            let known = found.iter().position(|one| is_same(one, &object.material));
            object.material_index = known.unwrap_or(found.len()) as u32;
            if known.is_none() {
                found.push(object.material);
            }
        }
        if found.len() > MATERIALS {
            let count = found.len();
            return Err(format!("the scene has {count} materials, and one array has {MATERIALS}"));
        }
        self.materials = found.into_iter().map(|material| [material; 2]).collect();
        Ok(())
    }
}

/// Whether surfaces of glTF read the same from both. The block `layers` has the rest.
fn is_same(one: &Material, other: &Material) -> bool {
    let read = |material: &Material| (material.emission, material.ambient, material.roughness);
    read(one) == read(other)
}
