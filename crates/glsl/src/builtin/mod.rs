//! What the language brings: functions, variables and constants, as tables.

pub mod functions;
pub mod textures;
pub mod variables;
