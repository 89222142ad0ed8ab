//! What pictures show is valid: shapes, scenes, environments, rays and fields of light probes.

mod probes;
mod sets;

use libtest_mimic::{Failed, Trial};

type Outcome = Result<(), Failed>;
type Case = (&'static str, fn() -> Outcome);

pub fn tests() -> Vec<Trial> {
    let cases: [Case; 7] = [
        ("rays", probes::rays),
        ("rays_of_scenes", probes::rays_of_scenes),
        ("fields_of_probes", probes::fields),
        ("volumes_of_shapes", sets::volumes),
        ("normals_of_scenes", sets::scenes),
        ("environments", sets::environments),
        ("numbers_of_materials", sets::numbers),
    ];
    cases.into_iter().map(|(name, run)| Trial::test(format!("scenes::{name}"), run)).collect()
}
