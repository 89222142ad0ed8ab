//! Caches that several machines share: a folder, and a Redis server.

use std::fs;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use super::{Outcome, Package, compiled, equal};

pub fn shared_folder() -> Outcome {
    shared(&format!("fs:{}", tempfile::tempdir()?.path().display()))
}

/// A folder that has something else in it is no store, and nothing is written to it.
pub fn foreign_folder() -> Outcome {
    let (package, folder) = (Package::new()?, tempfile::tempdir()?);
    fs::write(folder.path().join("notes.txt"), "mine")?;
    let store = format!("fs:{}", folder.path().display());
    let refused = package.run(&["gen", "--cache", "cache", "--store", &store])?;
    equal(refused.status.code(), Some(4))?;
    equal(String::from_utf8_lossy(&refused.stderr).contains("`notes.txt`"), true)?;
    equal(fs::read_dir(folder.path())?.count(), 1)
}

/// Another machine, which has an empty cache, takes everything from the store and compiles nothing.
fn shared(store: &str) -> Outcome {
    let package = Package::new()?;
    package.generate(&["--store", store, "-o", "one"])?;
    fs::rename(package.path().join("cache"), package.path().join("cache of another machine"))?;
    equal(compiled(&package.generate(&["--store", store, "-o", "two"])?), 0)?;
    equal(package.files("one")?, package.files("two")?)?;
    // Records that came from the store are now in the machine's own cache.
    equal(compiled(&package.generate(&["-o", "three"])?), 0)
}

/// Starts a Redis server and shares it. Without the feature `store`, the command must say that the
/// feature is missing, and no server is started.
pub fn shared_server() -> Outcome {
    let package = Package::new()?;
    let port = std::net::TcpListener::bind("127.0.0.1:0")?.local_addr()?.port();
    let address = format!("redis://127.0.0.1:{port}");
    let unanswered = package.run(&["gen", "--store", &address])?;
    equal(unanswered.status.code(), Some(4))?;
    if String::from_utf8_lossy(&unanswered.stderr).contains("--features store") {
        return Ok(());
    }
    let folder = tempfile::tempdir()?;
    let server = Command::new("redis-server")
        .args(["--bind", "127.0.0.1", "--port", &port.to_string(), "--save", "", "--dir"])
        .arg(folder.path())
        .stdout(Stdio::null())
        .spawn();
    let mut server = server.map_err(|error| {
        format!("redis-server: {error}; install it with `apt-get install redis-server`")
    })?;
    let start = Instant::now();
    while std::net::TcpStream::connect(("127.0.0.1", port)).is_err()
        && start.elapsed() < Duration::from_secs(10)
    {
        std::thread::sleep(Duration::from_millis(20));
    }
    let outcome = shared(&address);
    server.kill()?;
    server.wait()?;
    outcome
}
