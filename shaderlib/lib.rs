//! The files of the shader library, for programs that carry it with them.

include!(concat!(env!("OUT_DIR"), "/files.rs"));
