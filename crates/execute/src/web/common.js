// What both ways of drawing share.
"use strict";

// Texels in a row of the input texture, pixels in a row of the target, and every word of a pixel
// that nothing was written to: those of `kernel/mod.rs`.
const INPUT_WIDTH = 1024;
const TARGET_WIDTH = 256;
const SENTINEL = 0xdeadbeef;
const SENTINEL_FLOAT = new Float32Array(new Uint32Array([SENTINEL]).buffer)[0];

const bytesOf = (text) => Uint8Array.fromBase64(text);
const floatsOf = (text) => new Float32Array(bytesOf(text).buffer);
const textOf = (bytes) => bytes.toBase64();

// A reason that is told apart from other errors: `lacks` or `lost`.
class Reason extends Error {
  constructor(kind, words) {
    super(words);
    this.kind = kind;
  }
}

// What a function gives, or why it gives nothing, as `Answer` of `mod.rs` reads it.
async function answered(make) {
  try {
    return { value: (await make()) ?? null };
  } catch (error) {
    return { [error.kind ?? "error"]: String(error.message ?? error) };
  }
}
