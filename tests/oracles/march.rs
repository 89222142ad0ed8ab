//! Soft shadows: what a march through spheres beside a ray finds of the light's cone, compared with
//! the distances at very many points of the ray.

use super::Calls;
use crate::random::Random;
use lamplight::execute::kernel::Kernel;

/// Where the marches end, and where they begin.
const RANGE: f64 = 8.0;
const START: f64 = 0.05;
/// Points of the dense march.
const DENSE: usize = 4096;
const RAYS: usize = 400;

/// Spheres beside a ray along x: centres and radii.
struct Scene(Vec<([f64; 2], f64)>);

impl Scene {
    fn random(random: &mut Random) -> Self {
        let count = 1 + (random.fraction() * 3.0) as usize;
        let sphere = |random: &mut Random| {
            let radius = random.between(0.1, 1.0);
            let beside = radius + random.between(0.05, 1.5);
            ([random.between(1.0, RANGE - 1.0), beside], radius)
        };
        Self((0..count).map(|_| sphere(random)).collect())
    }

    fn distance(&self, t: f64) -> f64 {
        let one = |([x, y], radius): &([f64; 2], f64)| (x - t).hypot(*y) - radius;
        self.0.iter().map(one).fold(f64::INFINITY, f64::min)
    }

    /// The smallest share at the points of sphere tracing, without estimates between the points.
    fn plain_march(&self, k: f64) -> f64 {
        let (mut t, mut least) = (START, 1.0_f64);
        while t < RANGE {
            let distance = self.distance(t);
            least = least.min(k * distance / t);
            t += distance.max(1e-3);
        }
        least
    }

    /// The smallest visible share of the light's cone by its definition: at each point of the ray,
    /// `k` times the distance to the scene, over the distance along the ray.
    fn least(&self, k: f64) -> f64 {
        let place = |i: usize| START + (RANGE - START) * i as f64 / (DENSE - 1) as f64;
        let share = |t: f64| k * self.distance(t) / t;
        (0..DENSE).map(place).map(share).fold(1.0, f64::min)
    }
}

/// A ray that is being marched: its scene, the sharpness `k`, the distance `t` so far, and what the
/// function returned: the smallest share `res`, and the previous distance to the scene, `ph`.
struct Ray {
    scene: Scene,
    k: f64,
    t: f64,
    res: f64,
    ph: f64,
}

fn random_rays() -> Vec<Ray> {
    let mut random = Random(3);
    let ray = |_| {
        let scene = Scene::random(&mut random);
        Ray { scene, k: random.between(1.0, 16.0), t: START, res: 1.0, ph: 0.0 }
    };
    (0..RAYS).map(ray).collect()
}

/// One step of all rays that are not at their end.
fn advance_rays(
    calls: &mut Calls<'_>,
    kernel: &Kernel,
    rays: &mut [Ray],
    step: &dyn Fn(&mut Ray, f64),
) -> Result<usize, String> {
    let mut open: Vec<&mut Ray> = rays.iter_mut().filter(|ray| ray.t < RANGE).collect();
    let row = |ray: &&mut Ray| vec![ray.res, ray.scene.distance(ray.t), ray.ph, ray.t, ray.k];
    let rows: Vec<Vec<f64>> = open.iter().map(row).collect();
    if rows.is_empty() {
        return Ok(0);
    }
    let found = calls.run(kernel, &rows)?;
    let (found, _) = found.as_chunks::<2>();
    for (ray, [res, ph]) in open.iter_mut().zip(found) {
        ray.res = *res;
        step(ray, *ph);
    }
    Ok(rows.len())
}

/// In small steps, each with a previous distance of 0, the function gives the share of the
/// definition.
pub fn small_steps(calls: &mut Calls<'_>) -> Result<(), String> {
    let (kernel, mut rays) = (calls.kernel("shadow::sdf", "sdf_soft_step")?, random_rays());
    let length = (RANGE - START) / 512.0;
    while advance_rays(calls, &kernel, &mut rays, &|ray, _| ray.t += length)? > 0 {}
    let apart = |ray: &Ray| (ray.res - ray.scene.least(ray.k)).abs();
    let worst = rays.iter().map(apart).fold(0.0, f64::max);
    match worst > 2e-3 {
        true => Err(format!("off by {worst}")),
        false => Ok(()),
    }
}

/// In sphere tracing, the function estimates the nearest point between two steps, where the spheres
/// of both meet. That is no bound: the share is up to a tenth too small, and a little too large,
/// though less so than with the distances at the march's points alone.
pub fn large_steps(calls: &mut Calls<'_>) -> Result<(), String> {
    let (kernel, mut rays) = (calls.kernel("shadow::sdf", "sdf_soft_step")?, random_rays());
    let advanced = |ray: &mut Ray, ph: f64| {
        ray.ph = ph;
        ray.t += ph.max(1e-3);
    };
    while advance_rays(calls, &kernel, &mut rays, &advanced)? > 0 {}
    let off = |ray: &Ray| ray.res - ray.scene.least(ray.k);
    let off: Vec<f64> = rays.iter().map(off).collect();
    let plain = rays.iter().map(|ray| ray.scene.plain_march(ray.k) - ray.scene.least(ray.k));
    let most = off.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let least = off.iter().copied().fold(f64::INFINITY, f64::min);
    let plain = plain.fold(f64::NEG_INFINITY, f64::max);
    match most > 0.06 || least < -0.1 || most > plain {
        true => Err(format!("off from {least} to {most}; the plain march up to {plain}")),
        false => Ok(()),
    }
}
