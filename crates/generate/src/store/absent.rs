//! Replaces [`crate::store`] in a build without the feature `store`: only folders are supported.

use crate::cache::{CacheFolder, Storage};

/// The help on addresses.
pub const HELP: &str = "A cache that machines share: `fs:/path`; read after `--cache`";

/// Opens the store at `fs:/path`.
pub fn open(address: &str) -> Result<Box<dyn Storage>, String> {
    match address.split_once(':') {
        Some(("fs", path)) => CacheFolder::open_store(path),
        _ => Err(format!(
            "this build supports only `fs:/path`, not `{address}`: build it with `cargo install lamplight --features store`"
        )),
    }
}
