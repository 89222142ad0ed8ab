//! Keeps a part of a bundle from replacing all of it by accident.

use std::collections::BTreeSet;
use std::path::Path;

use super::failure::Failure;
use crate::bundle::{self, Bundle};
use crate::generate::Request;
use crate::permute::{Manifest, Program};

/// Fails if the bundle at `out` has every permutation of a program, and the run would write fewer
/// permutations or leave out one of its targets.
pub fn refuse_partial(manifest: &Manifest, request: &Request, out: &Path) -> Result<(), Failure> {
    let Ok(there) = Bundle::open(out) else { return Ok(()) };
    for program in &manifest.programs {
        let Ok(known) = there.program(&program.name) else { continue };
        let Ok(Some(targets)) = targets_of_whole(&known, program) else { continue };
        let (all, made) = (program.space.count(), requested_count(request, program));
        let is_lost = |target: &&String| {
            let is = |one: &bundle::Target| one.name() == **target;
            !request.targets.is_empty()
                && !request.targets.iter().any(is)
                && program.targets.iter().any(is)
        };
        let (out, name) = (out.display(), &program.name);
        let loss = match targets.iter().find(is_lost) {
            _ if made < all => format!(
                "all {all} permutations of program `{name}`, and this run would leave {made}"
            ),
            Some(target) => format!("`{target}` for program `{name}`, and this run would not"),
            None => continue,
        };
        return Err(Failure::input(format!(
            "`{out}` has {loss}\nhelp: name another place with `-o`, or add `--force`"
        )));
    }
    Ok(())
}

/// The targets of a program in the bundle; `None` unless the bundle has every permutation of it.
fn targets_of_whole(
    known: &bundle::Program<'_>,
    program: &Program,
) -> Result<Option<BTreeSet<String>>, bundle::Error> {
    let mut targets = BTreeSet::new();
    for (language, name) in known.entries() {
        let shader = known.entry(language, name)?;
        let keys = shader.keys()?;
        match keys.first() {
            Some(key) if keys.len() as u128 == program.space.count() => {
                targets.extend(shader.targets(key)?);
            }
            _ => return Ok(None),
        }
    }
    Ok((!targets.is_empty()).then_some(targets))
}

/// How many permutations of a program a run makes.
fn requested_count(request: &Request, program: &Program) -> u128 {
    let all = program.space.count();
    if request.program.as_ref().is_some_and(|name| *name != program.name) {
        return 0;
    }
    match (&request.only, request.shard) {
        (Some(_), _) => 1,
        (None, Some(shard)) => shard.of(&vec![(); all as usize]).len() as u128,
        (None, None) => all,
    }
}
