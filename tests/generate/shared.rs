//! Caches that several machines share.

use std::fs;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use super::{Outcome, Package, compiled, equal};

pub fn shared_folder() -> Outcome {
    shared(&format!("fs:{}", tempfile::tempdir()?.path().display()))
}

/// What one machine made, another one takes; a third without a cache of its own too.
fn shared(store: &str) -> Outcome {
    let package = Package::new()?;
    package.generate(&["--store", store, "-o", "one"])?;
    fs::rename(package.path().join("cache"), package.path().join("cache of another machine"))?;
    equal(compiled(&package.generate(&["--store", store, "-o", "two"])?), 0)?;
    equal(package.files("one")?, package.files("two")?)?;
    // What came from the store is near from now on.
    equal(compiled(&package.generate(&["-o", "three"])?), 0)
}

/// With the feature `store` against a server that is started here; without, only that the
/// command says what is missing.
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
