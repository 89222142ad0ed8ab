//! The materials of a scene's objects, numbered for the array that holds those of all objects.

use super::sets::{Material, Scene};

/// How many entries the array of materials has in the library's programs.
const MATERIALS: usize = 14;

impl Scene {
    /// Puts the materials of the objects into the array, each as front and back, and gives the
    /// objects their indices. Materials from which a glTF surface reads the same share one entry.
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

/// Whether a glTF surface reads the same from both materials. It reads everything else from the
/// block `layers`.
fn is_same(one: &Material, other: &Material) -> bool {
    let read = |material: &Material| (material.emission, material.ambient, material.roughness);
    read(one) == read(other)
}
