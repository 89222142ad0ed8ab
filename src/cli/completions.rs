//! `lamplight completions SHELL` and `lamplight man`: files for shells and for `man`.

use std::io::Write;
use std::path::PathBuf;

use clap::{Args, Command};
use clap_complete::Shell;
use clap_mangen::Man;

use super::failure::Failure;
use super::overwrite::Overwrite;
use crate::cli::terminal::stdout;
use crate::diagnostic::nearest_name;
use crate::output;

/// Print a script with which a shell completes commands, options and values.
#[derive(Args)]
pub struct Completions {
    #[arg(value_enum)]
    shell: Shell,
}

/// Print a manual page, or write all of them.
#[derive(Args)]
pub struct Manual {
    /// The command whose page it is [default: `lamplight` itself].
    command: Option<String>,
    /// Folder for the pages of all commands.
    #[arg(short, long, value_name = "DIR", conflicts_with = "command")]
    out: Option<PathBuf>,
    #[command(flatten)]
    overwrite: Overwrite,
}

pub fn write_completions(arguments: &Completions, mut command: Command) -> Result<(), Failure> {
    let mut text = Vec::new();
    clap_complete::generate(arguments.shell, &mut command, "lamplight", &mut text);
    Ok(stdout().write_all(&text)?)
}

pub fn write_manual(arguments: &Manual, mut command: Command) -> Result<(), Failure> {
    command.build();
    let known = || command.get_subcommands().filter(|command| !command.is_hide_set());
    if let Some(folder) = &arguments.out {
        let mut pages = vec![("lamplight.1".to_owned(), manual_page(&command)?)];
        for one in known() {
            pages.push((format!("lamplight-{}.1", one.get_name()), manual_page(one)?));
        }
        let files = pages.iter().map(|(name, text)| (name.as_str(), text.as_slice()));
        output::write_folder(folder, files, arguments.overwrite.replace())?;
        return Ok(writeln!(stdout(), "{} pages in {}", pages.len(), folder.display())?);
    }
    let Some(name) = &arguments.command else {
        return Ok(stdout().write_all(&manual_page(&command)?)?);
    };
    match known().find(|command| command.get_name() == name) {
        Some(found) => Ok(stdout().write_all(&manual_page(found)?)?),
        None => {
            let hint = nearest_name(name, known().map(Command::get_name))
                .map_or(String::new(), |near| format!("; did you mean `{near}`?"));
            Err(Failure::usage(format!("there is no command `{name}`{hint}")))
        }
    }
}

fn manual_page(command: &Command) -> Result<Vec<u8>, Failure> {
    let mut text = Vec::new();
    Man::new(command.clone()).render(&mut text)?;
    Ok(text)
}
