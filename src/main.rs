//! The `lamplight` command.

/// naga allocates much and keeps little: a fifth of the time that generating takes goes to the
/// allocator of the C library, half of that to this one.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn main() -> std::process::ExitCode {
    lamplight::cli::main()
}
