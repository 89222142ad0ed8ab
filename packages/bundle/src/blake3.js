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

const state = new Int32Array(16);

function mix(a, b, c, d, x, y) {
  const s = state;
  s[a] = s[a] + s[b] + x;
  let t = s[d] ^ s[a];
  s[d] = (t >>> 16) | (t << 16);
  s[c] = s[c] + s[d];
  t = s[b] ^ s[c];
  s[b] = (t >>> 12) | (t << 20);
  s[a] = s[a] + s[b] + y;
  t = s[d] ^ s[a];
  s[d] = (t >>> 8) | (t << 24);
  s[c] = s[c] + s[d];
  t = s[b] ^ s[c];
  s[b] = (t >>> 7) | (t << 25);
}

/** One block into the chaining value `cv`. */
function compress(cv, m, counter, length, flags) {
  const s = state;
  s.set(cv);
  for (let i = 0; i < 4; i++) s[8 + i] = IV[i];
  s[12] = counter | 0;
  s[13] = Math.floor(counter / 0x1_0000_0000);
  s[14] = length;
  s[15] = flags;
  for (let i = 0; i < 112; i += 16) {
    const w = (step) => m[SCHEDULE[i + step]];
    mix(0, 4, 8, 12, w(0), w(1));
    mix(1, 5, 9, 13, w(2), w(3));
    mix(2, 6, 10, 14, w(4), w(5));
    mix(3, 7, 11, 15, w(6), w(7));
    mix(0, 5, 10, 15, w(8), w(9));
    mix(1, 6, 11, 12, w(10), w(11));
    mix(2, 7, 8, 13, w(12), w(13));
    mix(3, 4, 9, 14, w(14), w(15));
  }
  for (let i = 0; i < 8; i++) cv[i] = s[i] ^ s[i + 8];
}

function chunk(bytes, counter, root) {
  const cv = IV.slice();
  const block = new Int32Array(16);
  let flags = START;
  for (let at = 0; ; at += 64) {
    const part = Math.min(64, bytes.length - at);
    const isLast = bytes.length - at <= 64;
    block.fill(0);
    for (let i = 0; i < part; i++) block[i >> 2] |= bytes[at + i] << (8 * (i & 3));
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
