//! What varies: settings, axes, constraints, keys.

mod setting;

pub use setting::{Setting, Settings};
