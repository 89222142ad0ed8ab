// Decompresses frames of zstd to the bytes that they were made of.
//
//     node frames.mjs FOLDER COUNT
//
// Frame 7 is in `7.zst`, its bytes are in `7.raw`.

import { deepStrictEqual as same, throws } from "node:assert";
import { readFileSync } from "node:fs";

import { unzstd } from "../src/zstd.js";

const [folder, count] = process.argv.slice(2);

/** Damage is an error, or gives other bytes. */
function read(bytes, size) {
  try {
    unzstd(bytes, size);
  } catch (error) {
    same(error.message, "a group cannot be decompressed");
  }
}

function damage(frame, size) {
  const step = Math.ceil(frame.length / 10);
  for (let at = 4; at < frame.length; at += step) {
    const bytes = frame.slice();
    bytes[at] ^= 1 << (at & 7);
    read(bytes, size);
    read(frame.subarray(0, at), size);
  }
}

for (let number = 0; number < Number(count); number++) {
  const [frame, raw] = ["zst", "raw"].map(
    (extension) => new Uint8Array(readFileSync(`${folder}/${number}.${extension}`)),
  );
  same(Buffer.compare(unzstd(frame, raw.length), raw), 0, `frame ${number} gives other bytes`);
  if (raw.length) throws(() => unzstd(frame, raw.length - 1), /cannot be decompressed/);
  damage(frame, raw.length);
}
console.log(count);
