#version 450
//! The fragment stage of `depth`, which `depth.wesl` describes.
//!
//! Made from `depth.wesl` by `cargo xtask docs`: edit that, not this file.

void main() {
}
