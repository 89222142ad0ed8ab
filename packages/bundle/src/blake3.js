// Checksums of bundles: the first 16 bytes of BLAKE3.

const IV = Int32Array.of(
  0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a, 0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19,
);
const ORDER = [2, 6, 3, 10, 7, 0, 4, 13, 1, 11, 12, 5, 9, 14, 15, 8];
const START = 1, END = 2, PARENT = 4, ROOT = 8;
const CHUNK = 1024;

/** Which word of a block each step of each round takes. */
const SCHEDULE = new Uint8Array(7 * 16);
for (let i = 0; i < 16; i++) SCHEDULE[i] = i;
for (let i = 16; i < SCHEDULE.length; i++) {
  SCHEDULE[i] = SCHEDULE[i - 16 - (i % 16) + ORDER[i % 16]];
}

/**
 * One block into the chaining value `cv`. The state is in variables, and the steps of a round are
 * written out: that is ten times as fast as a function for a step.
 */
function compress(cv, m, counter, length, flags) {
  let s0 = cv[0], s1 = cv[1], s2 = cv[2], s3 = cv[3], s4 = cv[4], s5 = cv[5], s6 = cv[6], s7 = cv[7];
  let s8 = IV[0], s9 = IV[1], s10 = IV[2], s11 = IV[3];
  let s12 = counter | 0, s13 = (counter / 0x1_0000_0000) | 0, s14 = length, s15 = flags;
  for (let i = 0; i < 112; i += 16) {
    s0 = (s0 + s4 + m[SCHEDULE[i + 0]]) | 0; s12 ^= s0; s12 = (s12 >>> 16) | (s12 << 16);
    s8 = (s8 + s12) | 0; s4 ^= s8; s4 = (s4 >>> 12) | (s4 << 20);
    s0 = (s0 + s4 + m[SCHEDULE[i + 1]]) | 0; s12 ^= s0; s12 = (s12 >>> 8) | (s12 << 24);
    s8 = (s8 + s12) | 0; s4 ^= s8; s4 = (s4 >>> 7) | (s4 << 25);
    s1 = (s1 + s5 + m[SCHEDULE[i + 2]]) | 0; s13 ^= s1; s13 = (s13 >>> 16) | (s13 << 16);
    s9 = (s9 + s13) | 0; s5 ^= s9; s5 = (s5 >>> 12) | (s5 << 20);
    s1 = (s1 + s5 + m[SCHEDULE[i + 3]]) | 0; s13 ^= s1; s13 = (s13 >>> 8) | (s13 << 24);
    s9 = (s9 + s13) | 0; s5 ^= s9; s5 = (s5 >>> 7) | (s5 << 25);
    s2 = (s2 + s6 + m[SCHEDULE[i + 4]]) | 0; s14 ^= s2; s14 = (s14 >>> 16) | (s14 << 16);
    s10 = (s10 + s14) | 0; s6 ^= s10; s6 = (s6 >>> 12) | (s6 << 20);
    s2 = (s2 + s6 + m[SCHEDULE[i + 5]]) | 0; s14 ^= s2; s14 = (s14 >>> 8) | (s14 << 24);
    s10 = (s10 + s14) | 0; s6 ^= s10; s6 = (s6 >>> 7) | (s6 << 25);
    s3 = (s3 + s7 + m[SCHEDULE[i + 6]]) | 0; s15 ^= s3; s15 = (s15 >>> 16) | (s15 << 16);
    s11 = (s11 + s15) | 0; s7 ^= s11; s7 = (s7 >>> 12) | (s7 << 20);
    s3 = (s3 + s7 + m[SCHEDULE[i + 7]]) | 0; s15 ^= s3; s15 = (s15 >>> 8) | (s15 << 24);
    s11 = (s11 + s15) | 0; s7 ^= s11; s7 = (s7 >>> 7) | (s7 << 25);
    s0 = (s0 + s5 + m[SCHEDULE[i + 8]]) | 0; s15 ^= s0; s15 = (s15 >>> 16) | (s15 << 16);
    s10 = (s10 + s15) | 0; s5 ^= s10; s5 = (s5 >>> 12) | (s5 << 20);
    s0 = (s0 + s5 + m[SCHEDULE[i + 9]]) | 0; s15 ^= s0; s15 = (s15 >>> 8) | (s15 << 24);
    s10 = (s10 + s15) | 0; s5 ^= s10; s5 = (s5 >>> 7) | (s5 << 25);
    s1 = (s1 + s6 + m[SCHEDULE[i + 10]]) | 0; s12 ^= s1; s12 = (s12 >>> 16) | (s12 << 16);
    s11 = (s11 + s12) | 0; s6 ^= s11; s6 = (s6 >>> 12) | (s6 << 20);
    s1 = (s1 + s6 + m[SCHEDULE[i + 11]]) | 0; s12 ^= s1; s12 = (s12 >>> 8) | (s12 << 24);
    s11 = (s11 + s12) | 0; s6 ^= s11; s6 = (s6 >>> 7) | (s6 << 25);
    s2 = (s2 + s7 + m[SCHEDULE[i + 12]]) | 0; s13 ^= s2; s13 = (s13 >>> 16) | (s13 << 16);
    s8 = (s8 + s13) | 0; s7 ^= s8; s7 = (s7 >>> 12) | (s7 << 20);
    s2 = (s2 + s7 + m[SCHEDULE[i + 13]]) | 0; s13 ^= s2; s13 = (s13 >>> 8) | (s13 << 24);
    s8 = (s8 + s13) | 0; s7 ^= s8; s7 = (s7 >>> 7) | (s7 << 25);
    s3 = (s3 + s4 + m[SCHEDULE[i + 14]]) | 0; s14 ^= s3; s14 = (s14 >>> 16) | (s14 << 16);
    s9 = (s9 + s14) | 0; s4 ^= s9; s4 = (s4 >>> 12) | (s4 << 20);
    s3 = (s3 + s4 + m[SCHEDULE[i + 15]]) | 0; s14 ^= s3; s14 = (s14 >>> 8) | (s14 << 24);
    s9 = (s9 + s14) | 0; s4 ^= s9; s4 = (s4 >>> 7) | (s4 << 25);
  }
  cv[0] = s0 ^ s8;
  cv[1] = s1 ^ s9;
  cv[2] = s2 ^ s10;
  cv[3] = s3 ^ s11;
  cv[4] = s4 ^ s12;
  cv[5] = s5 ^ s13;
  cv[6] = s6 ^ s14;
  cv[7] = s7 ^ s15;
}

function chunk(bytes, counter, root) {
  const cv = IV.slice(), block = new Int32Array(16);
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.length);
  let flags = START;
  for (let at = 0; ; at += 64) {
    const part = Math.min(64, bytes.length - at);
    const isLast = bytes.length - at <= 64;
    if (part === 64) {
      for (let i = 0; i < 16; i++) block[i] = view.getInt32(at + 4 * i, true);
    } else {
      block.fill(0);
      for (let i = 0; i < part; i++) block[i >> 2] |= bytes[at + i] << (8 * (i & 3));
    }
    compress(cv, block, counter, part, flags | (isLast ? END | root : 0));
    if (isLast) return cv;
    flags = 0;
  }
}

function subtree(bytes, counter, root) {
  if (bytes.length <= CHUNK) return chunk(bytes, counter, root);
  let left = CHUNK;
  while (left < bytes.length - left) left *= 2;
  const block = new Int32Array(16);
  block.set(subtree(bytes.subarray(0, left), counter, 0));
  block.set(subtree(bytes.subarray(left), counter + left / CHUNK, 0), 8);
  const cv = IV.slice();
  compress(cv, block, 0, 64, PARENT | root);
  return cv;
}

/** Whether `hash` is the checksum of `bytes`. */
export function matches(bytes, hash) {
  const cv = subtree(bytes, 0, ROOT);
  for (let i = 0; i < 16; i++) {
    if (((cv[i >> 2] >>> (8 * (i & 3))) & 255) !== hash[i]) return false;
  }
  return true;
}
