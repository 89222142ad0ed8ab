//! Shared stores whose server fails in different ways. The run must end soon. If the store can be
//! opened, the bundle must be the same as without a store. Otherwise the exit code is 4.

use std::collections::BTreeMap;
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::process::Output;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use libtest_mimic::{Failed, Trial};
use tempfile::TempDir;

use super::{Outcome, fails, run_within};

/// How a server answers, after it has answered the first request as it should.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Manner {
    /// Answers as it should.
    Honest,
    /// Answers as it should, 100 ms later.
    Late,
    /// Takes every request and never answers.
    Silent,
    /// Ends the connection in the middle of an answer.
    Interrupted,
    /// Answers with bytes that mean nothing.
    Garbled,
    /// Answers that it has no memory left.
    Full,
    /// Answers with the record of another name.
    Mixed,
    /// Announces a record that is longer than any may be, and sends it.
    Endless,
}

/// How many requests are answered as they should be. They are those with which a run opens the
/// store.
const OPENING: usize = 1;
/// The longest time of a run whose server fails.
const SOON: Duration = Duration::from_secs(30);
/// The address space of a run, in KiB.
const LITTLE_KIB: u64 = 1 << 20;

pub fn tests() -> Vec<Trial> {
    let manners: [(&str, Manner, bool); 8] = [
        ("honest", Manner::Honest, false),
        ("late", Manner::Late, false),
        ("silent", Manner::Silent, true),
        ("interrupted", Manner::Interrupted, true),
        ("garbled", Manner::Garbled, true),
        ("full", Manner::Full, true),
        // A record that does not belong to its name counts as absent, which is not an error.
        ("mixed", Manner::Mixed, false),
        ("endless", Manner::Endless, true),
    ];
    let served = manners.map(|(name, manner, is_warned)| {
        Trial::test(format!("hostile::store_that_is_{name}"), move || serves(manner, is_warned))
    });
    let dead = Trial::test("hostile::store_that_is_dead", dead);
    let mute = Trial::test("hostile::store_that_never_answers", mute);
    let all = served.into_iter().chain([dead, mute]);
    // Without the feature `store` the command cannot use servers, so these tests are ignored.
    all.map(|test| test.with_ignored_flag(cfg!(not(feature = "store")))).collect()
}

fn package() -> Result<TempDir, Failed> {
    let folder = tempfile::tempdir()?;
    let manifest = "[program.p]\nwesl = \"s.wesl\"\ntargets = [\"wgsl\"]\n[program.p.axis]\n\
                    a = { values = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11] }\n";
    let shader = "@fragment fn fs_main() -> @location(0) vec4f {\n\
                  return vec4f(f32(constants::a), 0.0, 0.0, 1.0);\n}\n";
    fs::write(folder.path().join("lamplight.toml"), manifest)?;
    fs::write(folder.path().join("s.wesl"), shader)?;
    Ok(folder)
}

/// A run with an empty cache of its own and a shared store.
fn generate(folder: &TempDir, name: &str, address: &str) -> Result<Output, Failed> {
    let (out, cache) = (format!("{name}.lamplight"), format!("{name} cache"));
    let arguments = ["gen", "--store", address, "--cache", &cache, "-o", &out];
    run_within(LITTLE_KIB, folder, &arguments)
}

fn serves(manner: Manner, is_expected: bool) -> Outcome {
    let folder = package()?;
    let alone = ["gen", "--no-cache", "-o", "alone.lamplight"];
    fails(&run_within(LITTLE_KIB, &folder, &alone)?, 0, "12 permutations")?;
    let expected = fs::read(folder.path().join("alone.lamplight"))?;
    let server = Server::start()?;
    let address = format!("redis://127.0.0.1:{}", server.port);
    let first = generate(&folder, "first", &address)?;
    fails(&first, 0, "12 permutations")?;
    server.behave(manner);
    let start = Instant::now();
    let second = generate(&folder, "second", &address)?;
    let elapsed = start.elapsed();
    fails(&second, 0, "12 permutations")?;
    for name in ["first", "second"] {
        if fs::read(folder.path().join(name).with_extension("lamplight"))? != expected {
            let what = "differs from the bundle without a store";
            return Err(format!("{manner:?}: the bundle `{name}` {what}").into());
        }
    }
    if elapsed > SOON {
        return Err(format!("{manner:?}: the run took {elapsed:?}, at most {SOON:?}").into());
    }
    if server.requests.load(Ordering::Relaxed) <= OPENING {
        return Err(format!("{manner:?}: the second run only opened the store").into());
    }
    let is_warned =
        String::from_utf8_lossy(&second.stderr).contains("the cache or the store refused");
    match is_warned == is_expected {
        true => Ok(()),
        false => {
            let what = format!("the user was warned: {is_warned}, expected: {is_expected}");
            Err(format!("{manner:?}: {what}").into())
        }
    }
}

/// Nothing listens at the port, so the run ends with exit code 4.
fn dead() -> Outcome {
    let folder = package()?;
    let port = TcpListener::bind("127.0.0.1:0")?.local_addr()?.port();
    let output = generate(&folder, "dead", &format!("redis://127.0.0.1:{port}"))?;
    fails(&output, 4, "the store `redis://127.0.0.1")
}

/// Something listens at the port and never accepts a connection. The run gives up after its limit.
fn mute() -> Outcome {
    let folder = package()?;
    let listener = TcpListener::bind("127.0.0.1:0")?;
    let port = listener.local_addr()?.port();
    let start = Instant::now();
    let output = generate(&folder, "mute", &format!("redis://127.0.0.1:{port}"))?;
    fails(&output, 4, "does not answer within 5 s")?;
    match start.elapsed() < SOON {
        true => Ok(()),
        false => Err(format!("the run took {:?}, at most {SOON:?}", start.elapsed()).into()),
    }
}

type Records = BTreeMap<Vec<u8>, Vec<u8>>;

/// A server that understands the requests of a store, in the protocol of Redis.
struct Server {
    port: u16,
    manner: Arc<Mutex<Manner>>,
    /// The number of requests about records since the manner was set.
    requests: Arc<AtomicUsize>,
}

impl Server {
    fn start() -> Result<Self, Failed> {
        let listener = TcpListener::bind("127.0.0.1:0")?;
        let port = listener.local_addr()?.port();
        let (manner, requests) = (Arc::new(Mutex::new(Manner::Honest)), Arc::default());
        let server = Self { port, manner: Arc::clone(&manner), requests: Arc::clone(&requests) };
        let records: Arc<Mutex<Records>> = Arc::default();
        thread::spawn(move || {
            for stream in listener.incoming().flatten() {
                let guest = Guest {
                    manner: Arc::clone(&manner),
                    requests: Arc::clone(&requests),
                    records: Arc::clone(&records),
                };
                // The result is not needed: an error ends the connection just as the client does.
                thread::spawn(move || guest.serve(stream));
            }
        });
        Ok(server)
    }

    fn behave(&self, manner: Manner) {
        *self.manner.lock().unwrap_or_else(PoisonError::into_inner) = manner;
        self.requests.store(0, Ordering::Relaxed);
    }
}

/// One connection of a client.
struct Guest {
    manner: Arc<Mutex<Manner>>,
    requests: Arc<AtomicUsize>,
    records: Arc<Mutex<Records>>,
}

impl Guest {
    fn serve(&self, stream: TcpStream) -> std::io::Result<()> {
        let mut answers = stream.try_clone()?;
        let mut requests = BufReader::new(stream);
        while let Some(request) = request(&mut requests)? {
            self.answer(&request, &mut answers)?;
        }
        Ok(())
    }

    fn answer(&self, request: &[Vec<u8>], answers: &mut TcpStream) -> std::io::Result<()> {
        let command = request.first().map(|word| word.to_ascii_uppercase()).unwrap_or_default();
        if !matches!(&command[..], b"EXISTS" | b"STRLEN" | b"GET" | b"GETRANGE" | b"SET") {
            return answers.write_all(b"+OK\r\n");
        }
        let number = self.requests.fetch_add(1, Ordering::Relaxed);
        let manner = match number < OPENING {
            true => Manner::Honest,
            false => *self.manner.lock().unwrap_or_else(PoisonError::into_inner),
        };
        match manner {
            Manner::Honest | Manner::Mixed => {}
            Manner::Late => thread::sleep(Duration::from_millis(100)),
            Manner::Silent => return Ok(()),
            Manner::Interrupted => {
                answers.write_all(b"$100\r\nhalf of it")?;
                return answers.shutdown(std::net::Shutdown::Both);
            }
            Manner::Garbled => return answers.write_all(b"\xff\x00 what?\r\n\r\n"),
            Manner::Full => return answers.write_all(b"-OOM command not allowed\r\n"),
            Manner::Endless => return endless(&command, answers),
        }
        answers.write_all(&self.honest(&command, request, manner == Manner::Mixed))
    }

    fn honest(&self, command: &[u8], request: &[Vec<u8>], is_mixed: bool) -> Vec<u8> {
        let mut records = self.records.lock().unwrap_or_else(PoisonError::into_inner);
        let name = request.get(1).cloned().unwrap_or_default();
        if command == b"SET" {
            records.insert(name, request.get(2).cloned().unwrap_or_default());
            return b"+OK\r\n".to_vec();
        }
        let other = || records.iter().find(|(other, _)| **other != name).map(|(_, record)| record);
        let record = if is_mixed { other() } else { records.get(&name) };
        match (command, record) {
            (b"EXISTS", record) => format!(":{}\r\n", u8::from(record.is_some())).into_bytes(),
            (b"STRLEN", record) => format!(":{}\r\n", record.map_or(0, Vec::len)).into_bytes(),
            (_, Some(record)) => {
                [format!("${}\r\n", record.len()).as_bytes(), record, b"\r\n"].concat()
            }
            (_, None) => b"$-1\r\n".to_vec(),
        }
    }
}

/// Answers as if every record had 16 GiB.
fn endless(command: &[u8], answers: &mut TcpStream) -> std::io::Result<()> {
    const BYTES: u64 = 16 << 30;
    match command {
        b"EXISTS" => answers.write_all(b":1\r\n"),
        b"STRLEN" => answers.write_all(format!(":{BYTES}\r\n").as_bytes()),
        b"SET" => answers.write_all(b"+OK\r\n"),
        _ => {
            answers.write_all(format!("${BYTES}\r\n").as_bytes())?;
            let block = vec![b'x'; 1 << 20];
            (0..BYTES >> 20).try_for_each(|_| answers.write_all(&block))
        }
    }
}

/// Reads a request: an array of strings, each with its length. `None` at the end.
fn request(requests: &mut BufReader<TcpStream>) -> std::io::Result<Option<Vec<Vec<u8>>>> {
    let Some(count) = length(requests)? else { return Ok(None) };
    let mut words = Vec::new();
    for _ in 0..count {
        let Some(length) = length(requests)? else { return Ok(None) };
        let mut word = vec![0; length + 2];
        requests.read_exact(&mut word)?;
        word.truncate(length);
        words.push(word);
    }
    Ok(Some(words))
}

/// Reads the number after `*` or `$`. `None` at the end.
fn length(requests: &mut BufReader<TcpStream>) -> std::io::Result<Option<usize>> {
    let mut line = String::new();
    requests.read_line(&mut line)?;
    Ok(line.get(1..).and_then(|number| number.trim().parse().ok()))
}
