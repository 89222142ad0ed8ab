//! A Redis server as a shared cache, also one that is killed or stopped in the middle of a run.

use std::fs;
use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use libtest_mimic::Failed;
use tempfile::TempDir;

use super::shared::shared;
use super::{Outcome, Package, equal};

/// How long a server may take to start, and a run to use it.
const PATIENCE: Duration = Duration::from_secs(30);
/// The values of an axis of a run that is disturbed: enough that its middle is found.
const MANY: usize = 128;

/// A Redis server with an empty folder, which ends with this value.
struct RedisServer {
    process: Child,
    port: u16,
    _folder: TempDir,
}

impl RedisServer {
    fn start() -> Result<Self, Failed> {
        let port = TcpListener::bind("127.0.0.1:0")?.local_addr()?.port();
        let folder = tempfile::tempdir()?;
        let process = Command::new("redis-server")
            .args(["--bind", "127.0.0.1", "--port", &port.to_string(), "--save", "", "--dir"])
            .arg(folder.path())
            .stdout(Stdio::null())
            .spawn();
        let process = process.map_err(|error| {
            format!("redis-server: {error}; install it with `apt-get install redis-server`")
        })?;
        let server = Self { process, port, _folder: folder };
        wait_until("the server listens", || TcpStream::connect(("127.0.0.1", port)).is_ok())?;
        Ok(server)
    }

    fn address(&self) -> String {
        format!("redis://127.0.0.1:{}", self.port)
    }

    /// The number of records, or none if the server does not answer.
    fn records(&self) -> Option<usize> {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).ok()?;
        stream.set_read_timeout(Some(Duration::from_secs(1))).ok()?;
        stream.write_all(b"DBSIZE\r\n").ok()?;
        let mut answer = [0; 32];
        let length = stream.read(&mut answer).ok()?;
        let text = std::str::from_utf8(&answer[..length]).ok()?;
        text.trim().strip_prefix(':')?.parse().ok()
    }

    fn signal(&self, name: &str) -> Outcome {
        let id = self.process.id().to_string();
        equal(Command::new("kill").args([name, &id]).status()?.success(), true)
    }
}

impl Drop for RedisServer {
    fn drop(&mut self) {
        // Both fail only if the server has ended.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

fn wait_until(what: &str, is_so: impl Fn() -> bool) -> Outcome {
    let start = Instant::now();
    while !is_so() {
        if start.elapsed() > PATIENCE {
            return Err(format!("not within {PATIENCE:?}: {what}").into());
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    Ok(())
}

/// Whether the command can use servers. Without the feature `store`, it must say that it cannot.
fn can_use_servers() -> Result<bool, Failed> {
    let package = Package::new()?;
    let refused = package.run(&["gen", "--store", "redis://127.0.0.1:1"])?;
    equal(refused.status.code(), Some(4))?;
    Ok(!String::from_utf8_lossy(&refused.stderr).contains("--features store"))
}

pub fn shared_server() -> Outcome {
    if !can_use_servers()? {
        return Ok(());
    }
    let server = RedisServer::start()?;
    shared(&server.address())
}

/// The server is killed after it has stored some of a run's records.
pub fn killed_server() -> Outcome {
    disturbed("-KILL")
}

/// The server is stopped, so that it takes connections and never answers.
pub fn stopped_server() -> Outcome {
    disturbed("-STOP")
}

/// A run whose server gets a signal in its middle says so, and makes the bundle that it would make
/// alone. The next run finds no server, which is an error.
fn disturbed(signal: &str) -> Outcome {
    if !can_use_servers()? {
        return Ok(());
    }
    let package = Package::new()?;
    let steps: Vec<String> = (1..=MANY).map(|step| step.to_string()).collect();
    let manifest = format!(
        "[program.small]\nwesl = \"small.wesl\"\ntargets = [\"wgsl\"]\n[program.small.axis]\n\
         tint = {{ values = [\"red\", \"green\", \"blue\"] }}\nshaded = {{ values = [false, true] }}\n\
         steps = {{ values = [{}] }}\n",
        steps.join(", ")
    );
    package.write("lamplight.toml", &manifest)?;
    package.generate(&["-o", "alone"])?;
    let server = RedisServer::start()?;
    let address = server.address();
    let disturbed = package
        .command(&["gen", "--cache", "other", "--store", &address, "-o", "disturbed"])
        .stderr(Stdio::piped())
        .stdout(Stdio::null())
        .spawn()?;
    wait_until("the server has a record", || server.records().is_some_and(|count| count > 10))?;
    server.signal(signal)?;
    let start = Instant::now();
    let output = disturbed.wait_with_output()?;
    let message = String::from_utf8_lossy(&output.stderr).into_owned();
    equal(output.status.code(), Some(0)).map_err(|_| message.clone())?;
    if !message.contains("the cache or the store refused") {
        return Err(format!("{signal} was not in the middle of the run: {message}").into());
    }
    equal(package.files("alone")?, package.files("disturbed")?)?;
    if start.elapsed() > 2 * PATIENCE {
        return Err(format!("{signal}: the run took {:?} more", start.elapsed()).into());
    }
    let refused = package.run(&["gen", "--cache", "third", "--store", &address, "-o", "third"])?;
    equal(refused.status.code(), Some(4))?;
    equal(fs::exists(package.path().join("third"))?, false)
}
