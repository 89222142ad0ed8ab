// Reads bundles of Lamplight: the single file, whole or by range requests, and directories.

import { matches } from "./blake3.js";
import { canonicalKey, keyDistance } from "./key.js";
import { Tree } from "./tree.js";
import { unzstd } from "./zstd.js";

/** The version of bundles that this reader reads. */
export const VERSION = 3;

const HEADER = 24 + 6 * 32 + 16;
const [META, KEYS, UNITS, VALUES, BLOBS, DATA] = [0, 1, 2, 3, 4, 5];
const NONE = 0xffff_ffff;

/** The most bytes of a group before compression. */
const MOST_GROUP = 16 << 20;

/** How many decompressed groups are kept. */
const KEPT_GROUPS = 64;

/** How many bytes are asked for first: all tables of most bundles. */
const FIRST_BYTES = 1 << 18;

const utf8 = new TextDecoder();

/** Why a bundle, or a part of it, cannot be used. */
export class BundleError extends Error {
  constructor(code, message, nearest) {
    super(message);
    this.name = "BundleError";
    /** `corrupt`, `format`, `not_found`, `bad_key`, `miss` or `read`. */
    this.code = code;
    /** The nearest key that there is, of a miss. */
    this.nearest = nearest;
  }
}

function damaged(reason) {
  throw new BundleError("corrupt", `the bundle is damaged: ${reason}`);
}

function notFound(what, name, known) {
  const names = [...new Set(known)].join(", ");
  throw new BundleError("not_found", `the bundle has no ${what} \`${name}\`; it has: ${names}`);
}

/** Eight bytes as a number; one beyond 2^53 is out of range anyway. */
const hexOf = (bytes) => Array.from(bytes, (byte) => byte.toString(16).padStart(2, "0")).join("");

const long = (view, at) => view.getUint32(at, true) + view.getUint32(at + 4, true) * 2 ** 32;

const viewOf = (bytes) => new DataView(bytes.buffer, bytes.byteOffset, bytes.length);

/** Where each section is, from a header whose checksum is right. */
function readHeader(bytes, size) {
  const view = viewOf(bytes);
  if (bytes.length < 12 || utf8.decode(bytes.subarray(0, 8)) !== "LAMPLGHT") {
    throw new BundleError("corrupt", "this is not a Lamplight bundle");
  }
  const version = view.getUint32(8, true);
  if (version !== VERSION) {
    const reads = `this reader reads version ${VERSION}`;
    throw new BundleError("format", `the bundle has format version ${version}, ${reads}`);
  }
  if (bytes.length < HEADER) damaged("it is cut off");
  if (!matches(bytes.subarray(0, HEADER - 16), bytes.subarray(HEADER - 16, HEADER))) {
    damaged("header: the checksum does not match");
  }
  const length = long(view, 16);
  if (view.getUint32(12, true) !== 6 || (size !== undefined && length !== size)) {
    damaged(`header: the file has ${size} bytes, not those it was written with`);
  }
  const sections = [];
  let next = HEADER;
  for (let at = 24; at < HEADER - 16; at += 32) {
    const section = { at: long(view, at), length: long(view, at + 8) };
    section.sum = bytes.slice(at + 16, at + 32);
    if (section.at !== next || section.at + section.length > length) {
      damaged("header: a section is not where the one before ends");
    }
    next += section.length;
    sections.push(section);
  }
  if (next !== length) damaged("header: bytes follow the last section");
  return { sections, length };
}

/** An open bundle. Made by {@link open} and {@link openBytes}. */
export class Bundle {
  /** `index` has all bytes before the section DATA; `source` gives the rest. */
  constructor(index, sections, source) {
    this.source = source;
    this.sections = sections;
    this.parts = sections.slice(0, DATA).map(({ at, length, sum }) => {
      const part = index.subarray(at, at + length);
      if (part.length !== length || !matches(part, sum)) {
        damaged("the checksum of a section does not match");
      }
      return part;
    });
    this.views = this.parts.map(viewOf);
    this.meta = new Tree(this.parts[META], "meta", damaged).root(0);
    this.values = new Tree(this.parts[VALUES], "values", damaged);
    const { units, artifacts, blobs, pieces, groups, programs, targets } = this.meta ?? {};
    const isWhole = programs && Array.isArray(targets) &&
      (units + artifacts) * 12 === this.parts[UNITS].length &&
      (blobs + groups) * 32 + pieces * 16 === this.parts[BLOBS].length;
    if (!isWhole) damaged("a table has another size");
    this.groups = new Map();
  }

  word(section, at) {
    const view = this.views[section];
    if (!(at >= 0 && at + 4 <= view.byteLength)) damaged("a position is out of range");
    return view.getUint32(at, true);
  }

  /** The names of the programs, sorted. */
  get programs() {
    return Object.keys(this.meta.programs);
  }

  program(name) {
    const found = this.meta.programs[name] ?? notFound("program", name, this.programs);
    const isWhole = [found.axes, found.entries].every(Array.isArray) &&
      found.axes.every((axis) => Array.isArray(axis?.values)) &&
      found.entries.every((entry) => entry?.keys);
    return isWhole ? found : damaged("a program has no axes, no entry points or no keys");
  }

  /** What all permutations of a program in one language bind together. */
  layout(program, language = "wesl") {
    return this.program(program).layouts?.[language] ?? [];
  }

  entry(program, name, language) {
    const entries = this.program(program).entries;
    const found = entries.filter(
      (entry) => entry.name === name && (language ?? entry.language) === entry.language,
    );
    const wesl = found.find((entry) => entry.language === "wesl") ?? found[0];
    return wesl ?? notFound("entry point", name, entries.map((entry) => entry.name));
  }

  keyAt(set, index) {
    const at = this.word(KEYS, set.records + index * 8);
    const length = this.word(KEYS, set.records + index * 8 + 4);
    if (at + length > this.parts[KEYS].length) damaged("a key is outside of its section");
    return utf8.decode(this.parts[KEYS].subarray(at, at + length));
  }

  /** Every key of an entry point, sorted. */
  keys(program, entry, { language } = {}) {
    const set = this.entry(program, entry, language).keys;
    return Array.from({ length: set.count }, (_, index) => this.keyAt(set, index));
  }

  /** The index of a canonical key, by binary search; -1 where it is not there. */
  search(set, key) {
    let [low, high] = [0, set.count];
    while (low < high) {
      const middle = (low + high) >>> 1, found = this.keyAt(set, middle);
      if (found === key) return middle;
      if (found < key) low = middle + 1;
      else high = middle;
    }
    return -1;
  }

  miss(set, key) {
    let nearest, best = Infinity;
    for (let index = 0; index < set.count; index++) {
      const known = this.keyAt(set, index), distance = keyDistance(key, known);
      if (distance < best) [nearest, best] = [known, distance];
    }
    const rest = nearest ? `the nearest is \`${nearest}\`` : "it has none at all";
    throw new BundleError("miss", `the bundle has no permutation \`${key}\`; ${rest}`, nearest);
  }

  /**
   * The shader of a key for a target. Axes may be in any order, and defaults may be written out.
   * Its bytes are read by `await shader.bytes()` or `await shader.text()`.
   */
  find(program, entry, key, target, { language } = {}) {
    const found = this.entry(program, entry, language), { axes } = this.program(program);
    const canonical = canonicalKey(axes, key, (reason) => {
      throw new BundleError("bad_key", `\`${key}\` is not a key of this program: ${reason}`);
    });
    const index = this.search(found.keys, canonical);
    if (index < 0) this.miss(found.keys, canonical);
    const unit = this.word(KEYS, found.units + index * 4);
    const constants =
      found.constants === undefined ? NONE : this.word(KEYS, found.constants + index * 4);
    return this.shader(unit, target, constants);
  }

  shader(unit, target, constants) {
    const { units, artifacts, targets } = this.meta;
    if (unit >= units) damaged("a unit is out of range");
    const [reflection, first, count] = [0, 4, 8].map((at) => this.word(UNITS, unit * 12 + at));
    if (first + count > artifacts) damaged("an artifact is out of range");
    const names = [];
    for (let artifact = first; artifact < first + count; artifact++) {
      const at = (units + artifact) * 12;
      const known = targets[this.word(UNITS, at)] ?? damaged("a target is out of range");
      names.push(known.name);
      if (known.name !== target) continue;
      return new Shader(this, {
        unit,
        target,
        reflection: this.values.root(reflection),
        native: this.values.root(this.word(UNITS, at + 4)),
        constants: constants === NONE ? [] : this.values.root(constants),
        blob: this.blob(this.word(UNITS, at + 8), known.extension),
      });
    }
    return notFound("target", target, names);
  }

  blob(blob, extension) {
    const { blobs, groups } = this.meta;
    if (blob >= blobs) damaged("a blob is out of range");
    const [group, offset, size, words] = this.record(blob * 32);
    const hash = this.parts[BLOBS].subarray(blob * 32 + 16, blob * 32 + 32);
    if (group === NONE) {
      if (!/^[a-z0-9]+(\.[a-z0-9]+)*$/i.test(extension)) damaged("a file has no proper extension");
      return { file: `blobs/${hexOf(hash.subarray(0, 8))}.${extension}`, offset, size, hash };
    }
    if (group >= groups) damaged("a group is out of range");
    return { group, offset, size, words, hash };
  }

  /** The four words of a record in BLOBS. */
  record(at) {
    return [0, 4, 8, 12].map((word) => this.word(BLOBS, at + word));
  }

  async readGroup(group) {
    const { blobs, pieces } = this.meta, { at: start, length } = this.sections[DATA];
    const at = (blobs + group) * 32 + pieces * 16;
    const offset = long(this.views[BLOBS], at);
    const [packed, size] = [this.word(BLOBS, at + 8), this.word(BLOBS, at + 12)];
    if (offset + packed > length || size > MOST_GROUP) damaged("a group is out of range");
    const bytes = await this.source.range(start + offset, start + offset + packed);
    if (!matches(bytes, this.parts[BLOBS].subarray(at + 16, at + 32))) {
      damaged("the checksum of a group does not match");
    }
    try {
      return unzstd(bytes, size);
    } catch (error) {
      return damaged(error.message);
    }
  }

  group(group) {
    const known = this.groups.get(group);
    if (known) return known;
    const read = this.readGroup(group);
    this.groups.set(group, read);
    read.catch(() => this.groups.delete(group));
    if (this.groups.size > KEPT_GROUPS) this.groups.delete(this.groups.keys().next().value);
    return read;
  }

  async readBlob(blob) {
    const { file, group, offset, size, words, hash } = blob;
    let bytes = file ? await this.source.file(file) : await this.group(group);
    if (words) bytes = await this.join(bytes.slice(offset, offset + words * 4), blob);
    else if (!file) bytes = bytes.subarray(offset, offset + size);
    if (bytes.length !== size || !matches(bytes, hash)) {
      damaged("the checksum of a shader does not match");
    }
    return bytes;
  }

  /** The bytes of an output that is a list of pieces. Each has values for the holes of its piece. */
  async join(list, { size, words }) {
    const view = viewOf(list), parts = [];
    if (list.length !== words * 4 || size > MOST_GROUP) damaged("a blob is out of range");
    let [end, before] = [0, 0];
    for (let at = 0; at < words;) {
      const piece = view.getUint32(4 * at++, true);
      if (piece >= this.meta.pieces) damaged("a piece is out of range");
      const [group, offset, length, count] = this.record(this.meta.blobs * 32 + piece * 16);
      const isOut = group >= this.meta.groups || length === 0 || length > size - end;
      if (isOut || count > words - at) damaged("a piece is out of range");
      const values = Array.from({ length: count }, () => {
        before = (before + view.getUint32(4 * at++, true)) >>> 0;
        return before;
      });
      parts.push({ group, offset, length, values, end });
      end += length;
    }
    if (end !== size) damaged("a shader has other bytes than it should");
    const numbers = [...new Set(parts.map(({ group }) => group))];
    const groups = new Map(
      await Promise.all(numbers.map(async (number) => [number, await this.group(number)])),
    );
    const bytes = new Uint8Array(size);
    for (const part of parts) place(bytes, groups.get(part.group), part);
    return bytes;
  }
}

/** Copies a piece, and fills its holes. A bit behind it says for each of its words if it is one. */
function place(bytes, group, { offset, length, values, end }) {
  const piece = group.subarray(offset, offset + length), view = viewOf(bytes);
  if (piece.length !== length) damaged("a piece is out of range");
  bytes.set(piece, end);
  for (let word = 0; values.length > 0 && word < length >> 2; word++) {
    if (!((group[offset + length + (word >> 3)] >> (word & 7)) & 1)) continue;
    const value = values[view.getUint32(end + 4 * word, true)];
    view.setUint32(end + 4 * word, value ?? damaged("a piece is out of range"), true);
  }
}

/** One permutation of an entry point, for one target. */
export class Shader {
  constructor(bundle, { unit, target, reflection, native, constants, blob }) {
    if (!native?.entry_name || !reflection?.stage || !Array.isArray(constants)) {
      damaged("a shader has no name or no stage");
    }
    this.bundle = bundle;
    /** Equal numbers are equal shaders, in every target. */
    this.unit = unit;
    this.target = target;
    this.entry = native.entry_name;
    this.stage = reflection.stage;
    this.size = blob.size;
    this.hash = hexOf(blob.hash);
    this.reflection = reflection;
    this.native = native;
    this.constants = constants;
    this.blob = blob;
  }

  /** The bytes of the output, checked. They belong to the bundle: do not change them. */
  bytes() {
    return this.bundle.readBlob(this.blob);
  }

  /** The output as text. */
  async text() {
    return utf8.decode(await this.bytes());
  }
}

/** A bundle that is in memory: a single file, or the `index.bin` of a directory with `file`. */
export function openBytes(bytes, { file } = {}) {
  const all = bytes instanceof Uint8Array ? bytes : new Uint8Array(bytes);
  const { sections } = readHeader(all, all.length);
  const range = async (start, end) => all.subarray(start, end);
  const noFile = () => {
    throw new BundleError("read", "shaders are in files: pass `file`");
  };
  return new Bundle(all, sections, { range, file: file ?? noFile });
}

async function request(url, start, end) {
  const headers = start === undefined ? {} : { Range: `bytes=${start}-${end - 1}` };
  const answer = await fetch(url, { headers });
  if (!answer.ok) throw new BundleError("read", `${url}: ${answer.status} ${answer.statusText}`);
  return { bytes: new Uint8Array(await answer.arrayBuffer()), isPart: answer.status === 206 };
}

/**
 * Opens a bundle by its address. A single file is read by range requests, if the server answers
 * them: first its tables, and then the groups that shaders are in. An address that ends in `/` is
 * that of a directory.
 */
export async function open(url) {
  const address = String(url);
  if (address.endsWith("/")) {
    const { bytes } = await request(`${address}index.bin`);
    return openBytes(bytes, { file: async (name) => (await request(address + name)).bytes });
  }
  const first = await request(address, 0, FIRST_BYTES);
  if (!first.isPart) return openBytes(first.bytes);
  const { sections } = readHeader(first.bytes);
  const end = sections[DATA].at;
  let index = first.bytes;
  if (index.length < end) {
    const rest = await request(address, index.length, end);
    index = new Uint8Array(end);
    index.set(first.bytes);
    index.set(rest.bytes.subarray(0, end - first.bytes.length), first.bytes.length);
  }
  const range = async (start, end) =>
    end <= index.length ? index.subarray(start, end) : (await request(address, start, end)).bytes;
  const file = () => damaged("a blob is in a file");
  return new Bundle(index, sections, { range, file });
}

export { constantChoices, constantNumber, packBlock } from "./describe.js";
