//! Names the page of the guide that explains a command, at the end of its help and of errors.

use std::collections::BTreeSet;

use clap::Command;

use super::terminal::is_person;
use crate::diagnostic::{Diagnostic, Severity, guide};

/// What is added to a command's help: the title of its page, and examples. They work in a package
/// that `lamplight init` has written, once `lamplight gen` has run there. The example of `migrate`
/// expects naga_oil shaders in `old/`.
struct HelpEntry {
    command: &'static str,
    page: &'static str,
    examples: &'static [&'static str],
}

const fn guide_entry(
    command: &'static str,
    page: &'static str,
    examples: &'static [&'static str],
) -> HelpEntry {
    HelpEntry { command, page, examples }
}

const FIRST: &str = "First shader in five minutes";
const PACKAGE: &str = "A package of your own";
const MANIFEST: &str = "Axes, constraints and the manifest";
const CASES: &str = "Numeric cases";

const ENTRIES: &[HelpEntry] = &[
    guide_entry("init", PACKAGE, &["lamplight init lamps"]),
    guide_entry("list", FIRST, &["lamplight list", "lamplight list axes --json"]),
    guide_entry(
        "show",
        FIRST,
        &["lamplight show brdf::specular::blinn_phong", "lamplight show fresnel"],
    ),
    guide_entry(
        "compose",
        "Conditions and constants",
        &["lamplight compose shaders/lamp.wesl --set fog=true"],
    ),
    guide_entry(
        "compile",
        PACKAGE,
        &[
            "lamplight compile shaders/lamp.wesl --target spirv,hlsl -o out",
            "lamplight compile shaders/lamp.wesl --target all --reflection -o out --depfile lamp.d",
            "lamplight compile - --lang wesl --target wgsl --feature fog < shaders/lamp.wesl",
        ],
    ),
    guide_entry(
        "translate",
        "Translating shaders",
        &["lamplight translate lamp.frag --to wgsl", "lamplight translate lamp.wesl --to hlsl"],
    ),
    guide_entry("lint", PACKAGE, &["lamplight lint", "lamplight lint shaders/lamp.wesl"]),
    guide_entry(
        "fmt",
        "Formatting shaders",
        &["lamplight fmt shaders", "lamplight fmt --check shaders/lamp.wesl"],
    ),
    guide_entry("migrate", "From naga_oil", &["lamplight migrate --from naga_oil old -o new"]),
    guide_entry(
        "gen",
        MANIFEST,
        &["lamplight gen", "lamplight gen --check", "lamplight gen -o lamp.lamplight"],
    ),
    guide_entry(
        "merge",
        "Many machines",
        &["lamplight gen --shard 1/1 -o part && lamplight merge whole part"],
    ),
    guide_entry("variants", MANIFEST, &["lamplight variants", "lamplight variants --keys lamp"]),
    guide_entry(
        "watch",
        "Hot reload",
        &["lamplight watch", "lamplight watch --program lamp --key fog"],
    ),
    guide_entry(
        "bundle",
        "Bundles",
        &[
            "lamplight bundle list bundle",
            "lamplight bundle get bundle lamp fs_main fog --target msl",
        ],
    ),
    guide_entry("keys", "In an engine", &["lamplight keys --lang rust"]),
    guide_entry("bindings", "In an engine", &["lamplight bindings bundle --lang c"]),
    guide_entry(
        "eval",
        FIRST,
        &[
            "lamplight eval 'lighting::spot::cone_exponent(0.9, 0.8, 4.0)'",
            "lamplight eval 'package::falloff::falloff(1.0, 2.0)'",
        ],
    ),
    guide_entry(
        "debug",
        "Why is this pixel black",
        &[
            "lamplight debug 'lighting::spot::cone_exponent(0.9, 0.8, 4.0)'",
            "lamplight debug shaders/lamp.wesl --pixel 256,256",
            "lamplight debug shaders/lamp.wesl --pixel 256,256 --why color.r",
        ],
    ),
    guide_entry(
        "check",
        CASES,
        &[
            "lamplight check",
            "lamplight check shaders/falloff.toml --report report",
            "lamplight check --record shaders.values",
            "lamplight check --against shaders.values",
        ],
    ),
    guide_entry("catalogue", FIRST, &["lamplight catalogue -o catalogue"]),
    guide_entry(
        "render",
        "A picture of your shader",
        &[
            "lamplight render shaders/lamp.wesl --executor eval",
            "lamplight render shaders/lamp.wesl --model torus --watch",
            "lamplight render hpg_4_spot --executor eval --size 32x32 -o spot.png",
        ],
    ),
    guide_entry("probe", "In an engine", &["lamplight probe studio"]),
    guide_entry("mutate", CASES, &[]),
    guide_entry("export", "WESL without this tool", &["lamplight export shaders/lamplight"]),
    guide_entry(
        "explain",
        "Troubleshooting by diagnostic",
        &["lamplight explain missing-module", "lamplight explain"],
    ),
    guide_entry("dap", "Why is this pixel black", &["lamplight dap < /dev/null"]),
    guide_entry("lsp", "In an editor", &["lamplight lsp < /dev/null"]),
    guide_entry("completions", FIRST, &["lamplight completions bash > lamplight.bash"]),
    guide_entry("man", FIRST, &["lamplight man -o man", "lamplight man gen"]),
    guide_entry("cost", "Cost on GPUs", &["lamplight cost lighting::spot --gpu navi21"]),
];

/// The most codes that the line names.
const CODES: usize = 3;

/// Adds examples and the page of each command to its help.
pub fn in_help(command: Command) -> Command {
    command.mut_subcommands(|command| {
        let found = ENTRIES.iter().find(|entry| entry.command == command.get_name());
        found.map_or(command.clone(), |entry| with_guide(command, entry))
    })
}

fn with_guide(command: Command, entry: &HelpEntry) -> Command {
    let examples: String = entry.examples.iter().map(|example| format!("  {example}\n")).collect();
    let page = format!("Guide: {}", entry.page);
    let after = |before: Option<&clap::builder::StyledStr>, examples: &str| {
        let before = before.map_or(String::new(), |text| format!("{text}\n\n"));
        match examples {
            "" => format!("{before}{page}"),
            examples => format!("{before}Examples:\n{examples}\n{page}"),
        }
    };
    let short = after(command.get_after_help(), "");
    let long = command.get_after_long_help().or(command.get_after_help());
    let long = after(long, &examples);
    command.after_help(short).after_long_help(long)
}

/// What to read about the errors, for a person at a terminal; `None` for a program.
pub fn after_errors(diagnostics: &[Diagnostic]) -> Option<String> {
    is_person().then(|| what_to_read(diagnostics)).flatten()
}

fn what_to_read(diagnostics: &[Diagnostic]) -> Option<String> {
    let errors = diagnostics.iter().filter(|error| error.severity == Severity::Error);
    let mut seen = BTreeSet::new();
    let codes: Vec<_> =
        errors.map(|error| error.code).filter(|code| seen.insert(code.name)).take(CODES).collect();
    let (first, rest) = codes.split_first()?;
    let others: String = rest.iter().map(|code| format!(", {}", code.name)).collect();
    let page =
        guide::page_of(first).map_or(String::new(), |page| format!("; guide: {}", page.title));
    Some(format!("more: lamplight explain {}{others}{page}\n", first.name))
}
