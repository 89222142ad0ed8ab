// A decoder for frames of zstd, as the groups of a bundle are. See RFC 8878, whose names are used.

class Damage extends Error {}

const fail = () => {
  throw new Damage("a group cannot be decompressed");
};

const log2 = (value) => 31 - Math.clz32(value);

/** Bits of `bytes` from bit `at`; those outside are zeros. At most 31. */
function bitsAt(bytes, at, count) {
  if (count === 0) return 0;
  if (at < 0) return at + count <= 0 ? 0 : bitsAt(bytes, 0, at + count) << -at;
  const first = at >> 3, shift = at & 7;
  const low = (bytes[first] | (bytes[first + 1] << 8) | (bytes[first + 2] << 16)) >>> 0;
  const all = low + ((bytes[first + 3] | 0) + (bytes[first + 4] | 0) * 256) * 0x100_0000;
  return Math.floor(all / (1 << shift)) % 2 ** count;
}

/** A stream that is read from its end. */
class Backwards {
  constructor(bytes) {
    const last = bytes[bytes.length - 1];
    if (!last) fail();
    this.bytes = bytes;
    this.left = (bytes.length - 1) * 8 + log2(last);
  }

  take(count) {
    this.left -= count;
    return bitsAt(this.bytes, this.left, count);
  }
}

/** A table of states, each with a symbol, a number of bits and a base. */
function build(counts, log) {
  const size = 1 << log, step = (size >> 1) + (size >> 3) + 3;
  const table = {
    log, symbol: new Uint8Array(size), bits: new Uint8Array(size), base: new Uint16Array(size),
  };
  let high = size, at = 0;
  const next = counts.map((count, symbol) => {
    if (count === -1) table.symbol[--high] = symbol;
    return Math.abs(count);
  });
  counts.forEach((count, symbol) => {
    for (let n = 0; n < count; n++) {
      table.symbol[at] = symbol;
      do at = (at + step) & (size - 1);
      while (at >= high);
    }
  });
  if (at !== 0) fail();
  for (let i = 0; i < size; i++) {
    const number = next[table.symbol[i]]++;
    table.bits[i] = log - log2(number);
    table.base[i] = (number << table.bits[i]) - size;
  }
  return table;
}

/** Reads the counts of a table. Returns the table and the bytes that they take. */
function readTable(bytes, symbols, most) {
  if (!bytes.length) fail();
  const log = (bytes[0] & 15) + 5, counts = [];
  if (log > most) fail();
  let at = 4, left = 1 << log;
  while (left > 0 && counts.length < symbols) {
    const count = log2(left + 1) + 1;
    const half = (1 << (count - 1)) - 1, bound = (1 << count) - 2 - left;
    let value = bitsAt(bytes, at, count);
    at += count;
    if ((value & half) < bound) {
      at--;
      value &= half;
    } else if (value > half) {
      value -= bound;
    }
    left -= Math.abs(--value);
    counts.push(value);
    for (let repeat = value === 0 ? 3 : 0; repeat === 3; ) {
      repeat = bitsAt(bytes, at, 2);
      at += 2;
      if (counts.length + repeat > symbols || at > bytes.length * 8) fail();
      for (let i = 0; i < repeat; i++) counts.push(0);
    }
  }
  if (left !== 0 || at > bytes.length * 8) fail();
  return [build(counts, log), (at + 7) >> 3];
}

/** Weights of a Huffman table that are compressed. */
function readWeights(bytes) {
  const [table, used] = readTable(bytes, 16, 6);
  const bits = new Backwards(bytes.subarray(used));
  const states = [bits.take(table.log), bits.take(table.log)], weights = [];
  if (bits.left < 0) fail();
  for (let turn = 0; ; turn ^= 1) {
    const state = states[turn];
    if (weights.length >= 254) fail();
    weights.push(table.symbol[state]);
    states[turn] = table.base[state] + bits.take(table.bits[state]);
    if (bits.left < 0) {
      weights.push(table.symbol[states[turn ^ 1]]);
      return weights;
    }
  }
}

/** Reads a Huffman table. Returns it and the bytes that it takes. */
function readHuffman(bytes) {
  if (!bytes.length) fail();
  const head = bytes[0];
  const used = 1 + (head < 128 ? head : (head - 126) >> 1);
  if (used > bytes.length) fail();
  let weights = [];
  if (head < 128) {
    weights = readWeights(bytes.subarray(1, used));
  } else {
    for (let i = 0; i < head - 127; i++) {
      weights.push(i & 1 ? bytes[1 + (i >> 1)] & 15 : bytes[1 + (i >> 1)] >> 4);
    }
  }
  const sum = weights.reduce((sum, weight) => sum + (weight ? 1 << (weight - 1) : 0), 0);
  const log = log2(sum) + 1, left = (1 << log) - sum;
  if (!sum || log > 11 || left & (left - 1)) fail();
  weights.push(log2(left) + 1);
  const table = { log, symbol: new Uint8Array(1 << log), length: new Uint8Array(1 << log) };
  let at = 0;
  for (let rank = 1; rank <= log; rank++) {
    weights.forEach((weight, symbol) => {
      if (weight !== rank) return;
      const end = at + (1 << (rank - 1));
      table.symbol.fill(symbol, at, end);
      table.length.fill(log + 1 - rank, at, end);
      at = end;
    });
  }
  if (at !== 1 << log) fail();
  return [table, used];
}

const LITERAL_COUNTS = [
  4, 3, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 1, 1, 1, 2, 2, 2, 2, 2, 2, 2, 2, 2, 3, 2, 1, 1, 1, 1, 1,
  -1, -1, -1, -1,
];
const MATCH_COUNTS = [1, 4, 3, 2, 2, 2, 2, 2, 2].concat(Array(37).fill(1), Array(7).fill(-1));
const OFFSET_COUNTS = [1, 1, 1, 1, 1, 1, 2, 2, 2].concat(Array(15).fill(1), Array(5).fill(-1));
const LITERAL_BITS = Array(16).fill(0).concat(1, 1, 1, 1, 2, 2, 3, 3, 4, 6, 7, 8, 9, 10, 11, 12, 13,
  14, 15, 16);
const MATCH_BITS = Array(32).fill(0).concat(1, 1, 1, 1, 2, 2, 3, 3, 4, 4, 5, 7, 8, 9, 10, 11, 12, 13,
  14, 15, 16);

/** The first length of each code: after those of all codes before it. */
const bases = (bits, first) => bits.map((count) => (first += 1 << count) - (1 << count));
const LITERAL_BASE = bases(LITERAL_BITS, 0);
const MATCH_BASE = bases(MATCH_BITS, 3);

class Frame {
  constructor(size) {
    this.out = new Uint8Array(size);
    this.used = 0;
    this.repeated = [1, 4, 8];
    this.huffman = this.lengths = this.offsets = this.matches = undefined;
  }

  append(bytes) {
    if (bytes.length > this.out.length - this.used) fail();
    this.out.set(bytes, this.used);
    this.used += bytes.length;
  }

  /** Decodes one stream of literals to the whole of `to`. */
  decodeStream(bytes, to) {
    const { log, symbol, length } = this.huffman;
    const bits = new Backwards(bytes);
    for (let i = 0; i < to.length; i++) {
      const code = bitsAt(bytes, bits.left - log, log);
      to[i] = symbol[code];
      bits.left -= length[code];
      if (bits.left < 0) fail();
    }
    if (bits.left !== 0) fail();
  }

  decodeStreams(bytes, size, streams) {
    const literals = new Uint8Array(size);
    const segment = streams === 1 ? size : (size + 3) >> 2;
    let at = streams === 1 ? 0 : 6;
    if (at > bytes.length) fail();
    for (let i = 0; i < streams; i++) {
      const isLast = i + 1 === streams;
      const end = isLast ? bytes.length : at + (bytes[2 * i] | (bytes[2 * i + 1] << 8));
      if (end > bytes.length || segment * i > size) fail();
      const to = literals.subarray(segment * i, isLast ? size : Math.min(size, segment * (i + 1)));
      this.decodeStream(bytes.subarray(at, end), to);
      at = end;
    }
    return literals;
  }

  /** The literals of a block, and the bytes that they take. */
  readLiterals(bytes) {
    const kind = bytes[0] & 3, format = (bytes[0] >> 2) & 3;
    if (kind <= 1) {
      const at = format === 3 ? 3 : format === 1 ? 2 : 1;
      const size = at === 1 ? bytes[0] >> 3 : bitsAt(bytes, 4, at === 2 ? 12 : 20);
      const end = at + (kind === 0 ? size : 1);
      if (end > bytes.length || size > 1 << 17) fail();
      if (kind === 0) return [bytes.subarray(at, end), end];
      return [new Uint8Array(size).fill(bytes[at]), end];
    }
    const width = [10, 10, 14, 18][format], at = [3, 3, 4, 5][format];
    const size = bitsAt(bytes, 4, width), packed = bitsAt(bytes, 4 + width, width);
    if (at + packed > bytes.length || size > 1 << 17 || !size) fail();
    let body = bytes.subarray(at, at + packed);
    if (kind === 2) {
      const [huffman, used] = readHuffman(body);
      this.huffman = huffman;
      body = body.subarray(used);
    }
    if (!this.huffman) fail();
    return [this.decodeStreams(body, size, format ? 4 : 1), at + packed];
  }

  /** One of the three tables, and the bytes that it takes. */
  readMode(mode, bytes, before, counts, log, symbols, most) {
    if (mode === 0) return [build(counts, log), 0];
    if (mode === 2) return readTable(bytes, symbols, most);
    if (mode === 3) return before ? [before, 0] : fail();
    if (!(bytes[0] < symbols)) fail();
    return [{ log: 0, symbol: bytes.slice(0, 1), bits: [0], base: [0] }, 1];
  }

  readBlock(bytes) {
    if (bytes.length < 2) fail();
    const [literals, start] = this.readLiterals(bytes);
    let at = start, used;
    let count = bytes[at++];
    if (count === 255) {
      count = bytes[at] + (bytes[at + 1] << 8) + 0x7f00;
      at += 2;
    } else if (count >= 128) {
      count = ((count - 128) << 8) | bytes[at++];
    }
    if (count === 0 && at === bytes.length) return this.append(literals);
    const modes = bytes[at++];
    if (!count || at > bytes.length || modes & 3) fail();
    const read = (shift, ...table) => {
      const found = this.readMode((modes >> shift) & 3, bytes.subarray(at), ...table);
      at += found[1];
      return found[0];
    };
    this.lengths = read(6, this.lengths, LITERAL_COUNTS, 6, 36, 9);
    this.offsets = read(4, this.offsets, OFFSET_COUNTS, 5, 32, 8);
    this.matches = read(2, this.matches, MATCH_COUNTS, 6, 53, 9);
    used = this.runSequences(count, literals, bytes.subarray(at));
    return this.append(literals.subarray(used));
  }

  offsetOf(value, literals) {
    const known = this.repeated;
    let which = value - 1 + (literals === 0 ? 1 : 0), offset;
    if (value > 3) {
      offset = value - 3;
      which = 3;
    } else {
      offset = which < 3 ? known[which] : known[0] - 1;
    }
    if (which >= 2) known[2] = known[1];
    if (which >= 1) known[1] = known[0];
    return (known[0] = offset);
  }

  /** Returns how many literals were used. */
  runSequences(count, literals, bytes) {
    const { lengths, offsets, matches } = this;
    const bits = new Backwards(bytes);
    let used = 0;
    let length = bits.take(lengths.log), offset = bits.take(offsets.log);
    let match = bits.take(matches.log);
    for (; count; count--) {
      const [of, ml, ll] = [offsets.symbol[offset], matches.symbol[match], lengths.symbol[length]];
      const value = 2 ** of + bits.take(of);
      const size = MATCH_BASE[ml] + bits.take(MATCH_BITS[ml]);
      const before = LITERAL_BASE[ll] + bits.take(LITERAL_BITS[ll]);
      if (bits.left < 0 || used + before > literals.length) fail();
      this.append(literals.subarray(used, used + before));
      used += before;
      this.copyMatch(this.offsetOf(value, before), size);
      if (count === 1) break;
      length = lengths.base[length] + bits.take(lengths.bits[length]);
      match = matches.base[match] + bits.take(matches.bits[match]);
      offset = offsets.base[offset] + bits.take(offsets.bits[offset]);
    }
    if (bits.left !== 0) fail();
    return used;
  }

  copyMatch(offset, size) {
    const { out, used } = this;
    if (!(offset > 0 && offset <= used) || size > out.length - used) fail();
    if (offset >= size) out.copyWithin(used, used - offset, used - offset + size);
    else for (let i = 0; i < size; i++) out[used + i] = out[used + i - offset];
    this.used += size;
  }
}

/** Where the first block of a frame is. */
function headerSize(bytes) {
  const flags = bytes[4];
  const isFrame = bytes.length >= 6 && bitsAt(bytes, 0, 31) === 0x7d2fb528 && bytes[3] >> 7;
  if (!isFrame || flags & 0x0b) fail();
  return 5 + [0, 2, 4, 8][flags >> 6] + (flags & 0x20 ? (flags >> 6 === 0 ? 1 : 0) : 1);
}

/** Decompresses one frame that has `size` bytes. Throws where it is damaged or has another size. */
export function unzstd(bytes, size) {
  const frame = new Frame(size);
  let at = headerSize(bytes);
  for (let isLast = false; !isLast; ) {
    if (at + 3 > bytes.length) fail();
    const header = bytes[at] | (bytes[at + 1] << 8) | (bytes[at + 2] << 16);
    const type = (header >> 1) & 3, length = header >> 3;
    const end = at + 3 + (type === 1 ? 1 : length);
    if (end > bytes.length || length > 1 << 17 || type === 3) fail();
    const body = bytes.subarray(at + 3, end);
    if (type === 0) frame.append(body);
    else if (type === 1) frame.append(new Uint8Array(length).fill(body[0]));
    else frame.readBlock(body);
    at = end;
    isLast = (header & 1) === 1;
  }
  if (frame.used !== size) fail();
  return frame.out;
}
