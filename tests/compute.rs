//! Compute entry points, run by every executor that has them.
//!
//! `WESL -> outputs of every target -> executors -> bytes of storage buffers`
//!
//! Each file of `tests/compute/cases/` has a table beside it, with the buffers that it is given, and
//! what they hold afterwards, computed by hand.

mod cases;
mod random;
mod run;

use libtest_mimic::{Failed, Trial};

use lamplight::execute::on_thread;

type Outcome = Result<(), Failed>;

pub fn tests() -> Vec<Trial> {
    let on_thread = |run: fn() -> Outcome| {
        move || {
            let words = |failed: Failed| failed.message().unwrap_or_default().to_owned();
            on_thread(|| run().map_err(words)).ok_or("panicked")?.map_err(Failed::from)
        }
    };
    vec![
        Trial::test("compute::cases", on_thread(cases::all)),
        Trial::test("compute::random", on_thread(random::programs)),
    ]
}
