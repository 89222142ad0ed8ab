//! Which kernels of a file are compiled together.

use std::sync::Arc;

use super::job::CaseJob;
use lamplight_execute::fixture::Fixture;
use lamplight_execute::kernel::Kernel;

/// Gives the kernels of one function with the same fixtures the same code, so that executors
/// compile it once for all its cases and laws.
pub fn share_code(jobs: &mut [CaseJob<'_>]) {
    let mut known: Vec<(String, Vec<Arc<Fixture>>, Vec<u64>)> = Vec::new();
    let mut share = |path: String, fixtures: &[Arc<Fixture>], kernels: &mut [(_, Kernel)]| {
        let is_same =
            |(other, others, _): &&(String, Vec<_>, _)| *other == path && others == fixtures;
        match known.iter().find(is_same) {
            Some((_, _, codes)) => {
                kernels.iter_mut().zip(codes).for_each(|((_, kernel), code)| kernel.code = *code);
            }
            None => {
                let codes = kernels.iter().map(|(_, kernel)| kernel.code).collect();
                known.push((path, fixtures.to_vec(), codes));
            }
        }
    };
    for job in jobs {
        let CaseJob { module, case, fixtures, kernels, laws, .. } = job;
        share(format!("{module}::{}", case.function), fixtures, kernels);
        for law in laws {
            for (partner, name) in law.partners.iter_mut().zip(&law.law.partners) {
                let is_path = name.contains("::");
                let path = if is_path { name.clone() } else { format!("{module}::{name}") };
                share(path, &[], &mut partner.kernels);
            }
        }
    }
}
