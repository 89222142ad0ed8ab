//! Conversations with the adapter about small texts.

#![allow(clippy::unwrap_used, clippy::panic)]

mod session;
