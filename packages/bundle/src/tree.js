// Values in binary form. docs/guide/format.md says how they are laid out.

const SIMPLE = [null, false, true];
const decoder = new TextDecoder("utf-8", { fatal: true });

/** The most values that a root may have. */
const MOST_VALUES = 1 << 22;
const MOST_DEPTH = 64;

/** A tree of values. Throws where it is damaged. */
export class Tree {
  constructor(bytes, part, fail) {
    this.fail = (reason) => fail(`${part}: ${reason}`);
    if (bytes.length < 16) this.fail("it is cut off");
    this.view = new DataView(bytes.buffer, bytes.byteOffset, bytes.length);
    const [roots, texts, words, length] = [0, 4, 8, 12].map((at) => this.view.getUint32(at, true));
    this.rootCount = roots;
    this.textCount = texts;
    this.wordCount = words;
    this.texts = 16 + roots * 4;
    this.words = this.texts + texts * 8;
    const start = this.words + words * 4;
    if (start + length !== bytes.length) this.fail("it has another size");
    this.bytes = bytes.subarray(start);
    this.known = new Map();
  }

  word(at) {
    if (at + 4 > this.view.byteLength) this.fail("a position is out of range");
    return this.view.getUint32(at, true);
  }

  text(number) {
    const known = this.known.get(number);
    if (known !== undefined) return known;
    if (number >= this.textCount) this.fail("a text is out of range");
    const at = this.word(this.texts + number * 8), length = this.word(this.texts + number * 8 + 4);
    if (this.bytes[at + length] !== 0) this.fail("no zero follows a text");
    let text;
    try {
      text = decoder.decode(this.bytes.subarray(at, at + length));
    } catch {
      this.fail("a text is not UTF-8");
    }
    this.known.set(number, text);
    return text;
  }

  /** A root, as JSON would give it. */
  root(number) {
    if (number >= this.rootCount) this.fail("a number is out of range");
    this.left = MOST_VALUES;
    return this.value(this.word(16 + number * 4), Infinity, 0);
  }

  value(word, before, depth) {
    const kind = word & 7, rest = word >>> 3;
    if (--this.left < 0) this.fail("there are too many values");
    switch (kind) {
      case 0:
        return rest < 3 ? SIMPLE[rest] : this.fail("a value has an unknown kind");
      case 1:
        return rest;
      case 2:
        return -1 - rest;
      case 3:
        return this.text(rest);
      case 4:
      case 5:
        return this.node(kind, rest, before, depth);
      case 6:
        return Number(this.text(rest));
      default:
        return this.fail("a value has an unknown kind");
    }
  }

  node(kind, at, before, depth) {
    if (at >= before) this.fail("a value is not before what it is in");
    if (depth >= MOST_DEPTH) this.fail("values are nested too deeply");
    const start = this.words + at * 4, count = this.word(start);
    if (at + 1 + count * (kind - 3) > this.wordCount) this.fail("a list is out of range");
    if (kind === 4) {
      const list = [];
      for (let i = 1; i <= count; i++) {
        list.push(this.value(this.word(start + i * 4), at, depth + 1));
      }
      return list;
    }
    const record = Object.create(null);
    for (let i = 0; i < count; i++) {
      const name = this.text(this.word(start + 4 + i * 8));
      record[name] = this.value(this.word(start + 8 + i * 8), at, depth + 1);
    }
    return record;
  }
}
