//! A debug adapter: the Debug Adapter Protocol over a run that goes forth and back.
//!
//! `message -> Adapter -> messages`
//!
//! The adapter reads and writes nothing itself. A [`Host`] makes what is debugged of the arguments of
//! `launch`, and says where files are. What the protocol calls a thread is the fragment, or the call.
//!
//! No crate describes the protocol's types here: an adapter needs a few fields of each message, and
//! those that it gets may lack any of them.

mod answer;
mod breakpoints;
mod motion;
mod numbers;
mod present;
mod requests;
mod session;
mod stack;
mod texts;
mod variables;

pub use answer::{Adapter, Host, Launched, Refusal};
