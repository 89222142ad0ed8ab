//! Files and limits: what reads and writes files safely, every bound on input from outside, and
//! child processes for work that might end the process.

pub mod input;
pub mod limits;
pub mod output;
pub mod sandbox;
#[cfg(target_os = "linux")]
#[path = "syncing/system.rs"]
mod syncing;
#[cfg(not(target_os = "linux"))]
#[path = "syncing/each.rs"]
mod syncing;
