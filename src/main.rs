//! The `lamplight` command.

fn main() -> std::process::ExitCode {
    lamplight::cli::main()
}
