//! A cache that machines share: a folder they all see, or a Redis server, through `opendal`.
//!
//! Records are named by what they were made of and verified when read, so that a store needs no
//! locks, no upkeep and no agreement between those that use it. It must be trusted, as any cache
//! of build results: whoever can write to it can choose what others take from it.

use std::time::Duration;

use opendal::services::Redis;
use opendal::{ErrorKind, Operator};
use tokio::runtime::{Builder, Runtime};
use tokio::time::timeout;

use crate::cache::{CacheFolder, MOST_RECORD_BYTES, Storage};

/// The help on addresses.
pub const HELP: &str =
    "A cache that machines share: `fs:/path` or `redis://host:port`; read after `--cache`";

/// How long a server may take for its first answer.
const PATIENCE: Duration = Duration::from_secs(5);

/// How long it may take for each later answer. A slower server would save no time. A server that
/// does not answer is not asked any more after a few failures.
const SHORT_PATIENCE: Duration = Duration::from_secs(2);

/// The start of all names in the store, so that others can use the same server.
const ROOT: &str = "/lamplight";

/// Opens the store at `fs:/path` or `redis://host:port`, if it answers.
pub fn open(address: &str) -> Result<Box<dyn Storage>, String> {
    match address.split_once(':') {
        Some(("fs", path)) => CacheFolder::open_store(path),
        Some(("redis", _)) => open_server(address),
        _ => Err(format!("`{address}` is not a store: write `fs:/path` or `redis://host:port`")),
    }
}

fn open_server(address: &str) -> Result<Box<dyn Storage>, String> {
    let operator = Operator::new(Redis::default().endpoint(address).root(ROOT))
        .map_err(|error| format!("the store `{address}` cannot be opened: {error}"))?;
    let runtime = Builder::new_multi_thread()
        .worker_threads(1)
        .enable_all()
        .build()
        .map_err(|error| error.to_string())?;
    let answer = runtime.block_on(async { timeout(PATIENCE, operator.read("units/00/0")).await });
    match answer {
        Ok(Err(error)) if error.kind() != ErrorKind::NotFound => {
            Err(format!("the store `{address}` refuses: {error}"))
        }
        Err(_) => {
            let patience = PATIENCE.as_secs();
            Err(format!("the store `{address}` does not answer within {patience} s"))
        }
        Ok(_) => Ok(Box::new(StoreServer { operator, runtime })),
    }
}

struct StoreServer {
    operator: Operator,
    /// Runs the operator's work, and ends with it.
    runtime: Runtime,
}

impl StoreServer {
    /// Waits for an answer, or fails once it takes too long.
    fn wait_for<T>(
        &self,
        answer: impl Future<Output = opendal::Result<T>>,
    ) -> Result<opendal::Result<T>, String> {
        let within = self.runtime.block_on(async { timeout(SHORT_PATIENCE, answer).await });
        within.map_err(|_| format!("no answer within {} s", SHORT_PATIENCE.as_secs()))
    }

    /// Reads a record unless it is longer than any of ours. Its length is asked for first, since a
    /// record is read into memory.
    async fn bounded(&self, name: &str) -> opendal::Result<Vec<u8>> {
        let length = self.operator.stat(name).await?.content_length();
        if length > MOST_RECORD_BYTES {
            let reason = format!("a record of {length} bytes");
            return Err(opendal::Error::new(ErrorKind::Unexpected, reason));
        }
        Ok(self.operator.read(name).await?.to_vec())
    }
}

impl Storage for StoreServer {
    fn get(&self, name: &str) -> Result<Option<Vec<u8>>, String> {
        match self.wait_for(self.bounded(name))? {
            Ok(bytes) => Ok(Some(bytes)),
            Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
            Err(error) => Err(error.to_string()),
        }
    }

    fn put(&self, name: &str, bytes: &[u8]) -> Result<(), String> {
        let written = self.wait_for(self.operator.write(name, bytes.to_vec()))?;
        written.map(|_| ()).map_err(|error| error.to_string())
    }
}
