//! Tells Zed how `lamplight lsp` is started.

use zed_extension_api::settings::LspSettings;
use zed_extension_api::{self as zed, Command, LanguageServerId, Result, Worktree};

struct Lamplight;

impl zed::Extension for Lamplight {
    fn new() -> Self {
        Self
    }

    /// The program that the settings name, or else the one in a folder of `PATH`.
    fn language_server_command(
        &mut self,
        server: &LanguageServerId,
        worktree: &Worktree,
    ) -> Result<Command> {
        let settings = LspSettings::for_worktree(server.as_ref(), worktree)?;
        let named = settings.binary.and_then(|binary| binary.path);
        let command = named
            .or_else(|| worktree.which("lamplight"))
            .ok_or("no folder of `PATH` has `lamplight`: see the README of Lamplight")?;
        Ok(Command { command, args: vec!["lsp".to_owned()], env: worktree.shell_env() })
    }
}

zed::register_extension!(Lamplight);
