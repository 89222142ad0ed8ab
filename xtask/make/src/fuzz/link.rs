//! `cargo xtask fuzz link`: random programs, which the test `link::random` makes,
//! validates, runs and compares.

use xtask::{CommandFailure, CommandResult, process};

const USAGE: &str =
    "usage: cargo xtask fuzz link [--programs N] [--seed N] [--every N] [--most N] [--run N] [--shrink]

  --programs N  how many (20000)
  --seed N      the seed of the first (1)
  --every N     the external validators see one program in N (1)
  --most N      so many outputs of such a program, in each target (2)
  --run N       the outputs of one program in N are run, 0 for none (8)
  --shrink      make the first finding of each kind small";

/// Runs the test. Findings are left in `target/fuzz/link/` and give exit code 3.
pub fn run(arguments: &[String]) -> CommandResult {
    let mut settings = vec![("PROGRAMS", "20000".to_owned()), ("VALIDATED", "1".to_owned())];
    settings.extend([("MOST", "2".to_owned()), ("RUN", "8".to_owned())]);
    let mut rest = arguments.iter();
    while let Some(argument) = rest.next() {
        let name = match argument.as_str() {
            "--programs" => "PROGRAMS",
            "--seed" => "SEED",
            "--every" => "VALIDATED",
            "--most" => "MOST",
            "--run" => "RUN",
            "--shrink" => {
                settings.push(("SHRINK", "1".to_owned()));
                continue;
            }
            _ => return Err(CommandFailure::usage(USAGE)),
        };
        let value = rest.next().filter(|value| value.parse::<u64>().is_ok());
        let value = value.ok_or_else(|| CommandFailure::usage(USAGE))?;
        settings.push((name, value.clone()));
    }
    let settings =
        settings.into_iter().map(|(name, value)| (format!("LAMPLIGHT_LINK_{name}"), value));
    let command =
        ["test", "--quiet", "--package", "lamplight", "--features", "store", "--test", "all"];
    process::cargo_with(&command, &["link::random".to_owned()], &settings.collect::<Vec<_>>())
}
