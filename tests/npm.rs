//! Packages of npm that tests need, installed once for each lock file.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, PoisonError};

use libtest_mimic::Failed;

/// Tests of one group share what is installed.
static INSTALLS: Mutex<()> = Mutex::new(());

/// The folder `node_modules` with the packages of the lock file in `folder`.
pub fn installed(folder: &Path, name: &str) -> Result<PathBuf, Failed> {
    let _one = INSTALLS.lock().unwrap_or_else(PoisonError::into_inner);
    let lock = std::fs::read(folder.join("package-lock.json"))?;
    let place = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let installed = place.join("node_modules");
    if installed.is_dir()
        && std::fs::read(place.join("installed.json")).is_ok_and(|old| old == lock)
    {
        return Ok(installed);
    }
    std::fs::create_dir_all(&place)?;
    for name in ["package.json", "package-lock.json"] {
        std::fs::copy(folder.join(name), place.join(name))?;
    }
    let output = Command::new("npm")
        .args(["ci", "--no-audit", "--no-fund", "--loglevel=error"])
        .current_dir(&place)
        .output()
        .map_err(|error| format!("npm: {error}; install it with: apt-get install npm"))?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into_owned().into());
    }
    std::fs::write(place.join("installed.json"), lock)?;
    Ok(installed)
}
