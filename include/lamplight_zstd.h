/* A small decoder for zstd: what `decompress` of a `lamplight` needs, without a library.
 *
 * In one source file of your program:
 *
 *     #define LAMPLIGHT_ZSTD_IMPLEMENTATION
 *     #include "lamplight_zstd.h"
 *     ...
 *     bundle.decompress = lamplight_unzstd;
 *
 * It allocates nothing and takes about 12 KiB of stack. libzstd is several times as fast: use it
 * where you have it. Frames with dictionaries are refused; a checksum of a frame is not looked at,
 * since bundles have their own. See RFC 8878, whose names are used here.
 */
#ifndef LAMPLIGHT_ZSTD_H
#define LAMPLIGHT_ZSTD_H

#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Decompresses one frame to at most `size` bytes at `out`. Returns how many there were; 0 where the
 * frame is damaged or has more. `user` is not used. */
size_t lamplight_unzstd(void *user, void *out, size_t size, const void *in, size_t in_size);

#ifdef __cplusplus
}
#endif
#endif /* LAMPLIGHT_ZSTD_H */

#ifdef LAMPLIGHT_ZSTD_IMPLEMENTATION
#ifndef LAMPLIGHT_ZSTD_IMPLEMENTED
#define LAMPLIGHT_ZSTD_IMPLEMENTED

#include <stdint.h>
#include <string.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Bits of a stream that is read from its end. `left` is negative where more were read than there
 * are; these are zeros. */
typedef struct lamplight__bits {
    const uint8_t *bytes;
    int64_t left;
} lamplight__bits;

typedef struct lamplight__state {
    uint8_t symbol, bits;
    uint16_t base;
} lamplight__state;

typedef struct lamplight__fse {
    lamplight__state states[512];
    int log; /* accuracy; -1 where there is no table */
} lamplight__fse;

typedef struct lamplight__unzstd {
    uint8_t *out;
    size_t size, used;
    uint64_t repeated[3];
    uint8_t huffman_symbol[2048], huffman_length[2048];
    int huffman_log; /* 0 where there is no table */
    lamplight__fse literal_lengths, offsets, match_lengths;
    uint32_t literal_base[36], match_base[53];
    /* Literals of the block: bytes, one repeated byte, or streams. */
    const uint8_t *literals;
    int literal_kind, stream, streams;
    uint32_t literal_left, segment, segment_left;
    const uint8_t *stream_start[4];
    size_t stream_size[4];
    lamplight__bits bits;
} lamplight__unzstd;

static uint32_t lamplight__bits_at(const uint8_t *bytes, int64_t at, int count) {
    uint64_t value = 0;
    int64_t first, last, i;
    if (at < 0) {
        if (at + count <= 0) return 0;
        return lamplight__bits_at(bytes, 0, (int)(at + count)) << -at;
    }
    first = at / 8;
    last = (at + count + 7) / 8;
    for (i = last - 1; i >= first; i--) value = value << 8 | bytes[i];
    return (uint32_t)(value >> (at & 7) & (((uint64_t)1 << count) - 1));
}

static uint32_t lamplight__take(lamplight__bits *bits, int count) {
    bits->left -= count;
    return lamplight__bits_at(bits->bytes, bits->left, count);
}

/* Bits of a stream that is read from its start. Bits after its end are zeros. */
static uint32_t lamplight__forward(const uint8_t *bytes, size_t size, int64_t at, int count) {
    uint8_t part[8];
    size_t first = (size_t)(at / 8), length = first < size ? size - first : 0;
    memset(part, 0, sizeof part);
    if (length) memcpy(part, bytes + first, length < sizeof part ? length : sizeof part);
    return lamplight__bits_at(part, at % 8, count);
}

static int lamplight__log2(uint32_t value) {
    int log = -1;
    for (; value; value >>= 1) log++;
    return log;
}

/* Begins to read a stream, whose last bit that is set marks its end. */
static int lamplight__begin(lamplight__bits *bits, const uint8_t *bytes, size_t size) {
    if (!size || !bytes[size - 1]) return 0;
    bits->bytes = bytes;
    bits->left = (int64_t)(size - 1) * 8 + lamplight__log2(bytes[size - 1]);
    return 1;
}

static int lamplight__build(lamplight__fse *table, const int16_t *counts, int symbols, int log) {
    uint16_t next[64];
    uint32_t size = 1u << log, high = size, at = 0, step = (size >> 1) + (size >> 3) + 3, i;
    int symbol, n;
    table->log = -1;
    for (symbol = 0; symbol < symbols; symbol++) {
        if (counts[symbol] == -1) table->states[--high].symbol = (uint8_t)symbol;
        next[symbol] = (uint16_t)(counts[symbol] == -1 ? 1 : counts[symbol]);
    }
    for (symbol = 0; symbol < symbols; symbol++) {
        for (n = 0; n < counts[symbol]; n++) {
            table->states[at].symbol = (uint8_t)symbol;
            do at = (at + step) & (size - 1);
            while (at >= high);
        }
    }
    if (at != 0) return 0;
    for (i = 0; i < size; i++) {
        lamplight__state *state = &table->states[i];
        uint32_t number = next[state->symbol]++;
        state->bits = (uint8_t)(log - lamplight__log2(number));
        state->base = (uint16_t)((number << state->bits) - size);
    }
    table->log = log;
    return 1;
}

/* Reads the counts of a table, and builds it. Returns how many bytes they take; 0 for damage. */
static size_t lamplight__counts(lamplight__fse *table, const uint8_t *bytes, size_t size,
                                int symbols, int most_log) {
    int16_t counts[64];
    int64_t at = 4, bits = (int64_t)size * 8;
    int log, symbol = 0;
    int32_t left;
    if (!size) return 0;
    log = (bytes[0] & 15) + 5;
    if (log > most_log) return 0;
    left = 1 << log;
    while (left > 0 && symbol < symbols) {
        int count = lamplight__log2((uint32_t)left + 1) + 1;
        int32_t half = (1 << (count - 1)) - 1, bound = (1 << count) - 1 - (left + 1), value;
        if (at > bits) return 0;
        value = (int32_t)lamplight__forward(bytes, size, at, count);
        at += count;
        if ((value & half) < bound) {
            at--;
            value &= half;
        } else if (value > half) {
            value -= bound;
        }
        value--;
        left -= value < 0 ? 1 : value;
        counts[symbol++] = (int16_t)value;
        if (value == 0) {
            int repeat = 3;
            while (repeat == 3) {
                int i;
                if (at + 2 > bits) return 0;
                repeat = (int)lamplight__bits_at(bytes, at, 2);
                at += 2;
                for (i = 0; i < repeat; i++) {
                    if (symbol >= symbols) return 0;
                    counts[symbol++] = 0;
                }
            }
        }
    }
    if (left != 0 || at > bits || !lamplight__build(table, counts, symbol, log)) return 0;
    return (size_t)((at + 7) / 8);
}

/* The weights of a Huffman table that are compressed. Returns how many there are; 0 for damage. */
static int lamplight__weights(const uint8_t *bytes, size_t size, uint8_t weights[256]) {
    lamplight__fse table;
    lamplight__bits bits;
    uint32_t states[2];
    int count = 0, turn = 0;
    size_t used = lamplight__counts(&table, bytes, size, 16, 6);
    if (!used || used >= size || !lamplight__begin(&bits, bytes + used, size - used)) return 0;
    states[0] = lamplight__take(&bits, table.log);
    states[1] = lamplight__take(&bits, table.log);
    if (bits.left < 0) return 0;
    for (;; turn ^= 1) {
        const lamplight__state *state = &table.states[states[turn]];
        if (count >= 254) return 0;
        weights[count++] = state->symbol;
        states[turn] = state->base + lamplight__take(&bits, state->bits);
        if (bits.left < 0) {
            weights[count++] = table.states[states[turn ^ 1]].symbol;
            return count;
        }
    }
}

static int lamplight__huffman(lamplight__unzstd *z, uint8_t *weights, int count) {
    uint32_t starts[13], ranks[13], sum = 0, left, size, at;
    int i, log;
    memset(ranks, 0, sizeof ranks);
    z->huffman_log = 0;
    for (i = 0; i < count; i++) {
        if (weights[i] > 11) return 0;
        sum += weights[i] ? 1u << (weights[i] - 1) : 0;
    }
    if (!sum) return 0;
    log = lamplight__log2(sum) + 1;
    if (log > 11) return 0;
    left = (1u << log) - sum;
    if (left & (left - 1)) return 0;
    weights[count++] = (uint8_t)(lamplight__log2(left) + 1);
    for (i = 0; i < count; i++) ranks[weights[i]]++;
    for (at = 0, i = 1; i <= log; i++) {
        starts[i] = at;
        at += ranks[i] << (i - 1);
    }
    size = 1u << log;
    if (at != size) return 0;
    for (i = 0; i < count; i++) {
        uint32_t length, place;
        if (!weights[i]) continue;
        length = 1u << (weights[i] - 1);
        place = starts[weights[i]];
        starts[weights[i]] += length;
        memset(z->huffman_symbol + place, i, length);
        memset(z->huffman_length + place, log + 1 - weights[i], length);
    }
    z->huffman_log = log;
    return 1;
}

/* Reads a Huffman table. Returns how many bytes it takes; 0 for damage. */
static size_t lamplight__tree(lamplight__unzstd *z, const uint8_t *bytes, size_t size) {
    uint8_t weights[257];
    size_t used;
    int count, i;
    if (!size) return 0;
    if (bytes[0] < 128) {
        used = 1 + (size_t)bytes[0];
        if (used > size) return 0;
        count = lamplight__weights(bytes + 1, bytes[0], weights);
        if (!count) return 0;
    } else {
        count = bytes[0] - 127;
        used = 1 + ((size_t)count + 1) / 2;
        if (used > size) return 0;
        for (i = 0; i < count; i++)
            weights[i] = i & 1 ? bytes[1 + i / 2] & 15 : bytes[1 + i / 2] >> 4;
    }
    return lamplight__huffman(z, weights, count) ? used : 0;
}

enum { LAMPLIGHT__RAW, LAMPLIGHT__RLE, LAMPLIGHT__COMPRESSED, LAMPLIGHT__TREELESS };

static int lamplight__next_stream(lamplight__unzstd *z) {
    int i = z->stream++;
    uint32_t left = z->literal_left;
    z->segment_left = i + 1 < z->streams && z->segment < left ? z->segment : left;
    return lamplight__begin(&z->bits, z->stream_start[i], z->stream_size[i]);
}

static int lamplight__streams(lamplight__unzstd *z, const uint8_t *bytes, size_t size) {
    size_t at = 0;
    int i;
    z->stream = 0;
    z->segment = z->streams == 1 ? z->literal_left : (z->literal_left + 3) / 4;
    if (z->streams == 4) {
        if (size < 6 || z->literal_left < 6) return 0;
        at = 6;
    }
    for (i = 0; i < z->streams; i++) {
        size_t length = i + 1 < z->streams
                            ? (size_t)bytes[2 * i] | (size_t)bytes[2 * i + 1] << 8
                            : size - at;
        if (length > size - at) return 0;
        z->stream_start[i] = bytes + at;
        z->stream_size[i] = length;
        at += length;
    }
    return lamplight__next_stream(z);
}

/* Reads the header of the literals. Returns how many bytes they take; 0 for damage. */
static size_t lamplight__literals(lamplight__unzstd *z, const uint8_t *bytes, size_t size) {
    uint64_t header = 0;
    size_t at, packed, used = 0, i;
    int format;
    if (!size) return 0;
    for (i = 0; i < 5 && i < size; i++) header |= (uint64_t)bytes[i] << (8 * i);
    z->literal_kind = bytes[0] & 3;
    format = bytes[0] >> 2 & 3;
    if (z->literal_kind <= LAMPLIGHT__RLE) {
        at = format == 3 ? 3 : format == 1 ? 2 : 1;
        z->literal_left = (uint32_t)(format == 3   ? header >> 4 & 0xfffff
                                     : format == 1 ? header >> 4 & 0xfff
                                                   : header >> 3 & 0x1f);
        packed = z->literal_kind == LAMPLIGHT__RAW ? z->literal_left : 1;
        if (at > size || packed > size - at || z->literal_left > 1u << 17) return 0;
        z->literals = bytes + at;
        return at + packed;
    }
    at = format < 2 ? 3 : (size_t)format + 2;
    if (at > size) return 0;
    i = format < 2 ? 10 : format == 2 ? 14 : 18;
    z->literal_left = (uint32_t)(header >> 4 & (((uint64_t)1 << i) - 1));
    packed = (size_t)(header >> (4 + i) & (((uint64_t)1 << i) - 1));
    if (packed > size - at || z->literal_left > 1u << 17 || !z->literal_left) return 0;
    if (z->literal_kind == LAMPLIGHT__COMPRESSED) {
        used = lamplight__tree(z, bytes + at, packed);
        if (!used) return 0;
    }
    if (!z->huffman_log) return 0;
    z->streams = format ? 4 : 1;
    return lamplight__streams(z, bytes + at + used, packed - used) ? at + packed : 0;
}

/* Writes the next literals. */
static int lamplight__copy_literals(lamplight__unzstd *z, size_t count) {
    uint8_t *out = z->out + z->used;
    size_t i;
    if (count > z->literal_left || count > z->size - z->used) return 0;
    z->used += count;
    if (z->literal_kind <= LAMPLIGHT__RLE) {
        z->literal_left -= (uint32_t)count;
        if (z->literal_kind == LAMPLIGHT__RLE) {
            memset(out, z->literals[0], count);
        } else {
            memcpy(out, z->literals, count);
            z->literals += count;
        }
        return 1;
    }
    for (i = 0; i < count; i++) {
        uint32_t code;
        if (!z->segment_left && (z->bits.left != 0 || !lamplight__next_stream(z))) return 0;
        code = lamplight__bits_at(z->bits.bytes, z->bits.left - z->huffman_log, z->huffman_log);
        out[i] = z->huffman_symbol[code];
        z->bits.left -= z->huffman_length[code];
        if (z->bits.left < 0) return 0;
        z->segment_left--;
        z->literal_left--;
    }
    return 1;
}

static int lamplight__copy_match(lamplight__unzstd *z, uint64_t offset, size_t count) {
    uint8_t *out = z->out + z->used;
    size_t i;
    if (!offset || offset > z->used || count > z->size - z->used) return 0;
    for (i = 0; i < count; i++) out[i] = out[(int64_t)i - (int64_t)offset];
    z->used += count;
    return 1;
}

static uint64_t lamplight__offset(lamplight__unzstd *z, uint64_t value, uint32_t literals) {
    uint64_t *known = z->repeated, offset;
    uint64_t which = value - 1 + (literals == 0);
    if (value > 3) {
        offset = value - 3;
        which = 3;
    } else {
        offset = which < 3 ? known[which] : known[0] - 1;
    }
    if (which >= 2) known[2] = known[1];
    if (which >= 1) known[1] = known[0];
    known[0] = offset;
    return offset;
}

static const int16_t lamplight__literal_counts[36] = {
    4, 3, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 2, 1, 1, 1, 2, 2,
    2, 2, 2, 2, 2, 2, 2, 3, 2, 1, 1, 1, 1, 1, -1, -1, -1, -1};
static const int16_t lamplight__match_counts[53] = {
    1, 4, 3, 2, 2, 2, 2, 2, 2, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1,
    1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, -1, -1, -1, -1, -1, -1, -1};
static const int16_t lamplight__offset_counts[29] = {1, 1, 1, 1, 1, 1, 2, 2, 2, 1,  1,  1,  1,  1, 1,
                                                     1, 1, 1, 1, 1, 1, 1, 1, 1, -1, -1, -1, -1, -1};
static const uint8_t lamplight__literal_bits[36] = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0,  0,  0,
                                                    0, 0, 0, 0, 1, 1, 1, 1, 2, 2,  3,  3,
                                                    4, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16};
static const uint8_t lamplight__match_bits[53] = {
    0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0,  0,  0,
    0, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 3, 3, 4, 4, 5, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16};

/* The first length of each code: after those of all codes before it. */
static void lamplight__bases(uint32_t *bases, const uint8_t *bits, int codes, uint32_t first) {
    int i;
    for (i = 0; i < codes; i++) {
        bases[i] = first;
        first += 1u << bits[i];
    }
}

/* Reads one of the three tables. Returns how many bytes it takes; SIZE_MAX for damage. */
static size_t lamplight__table(lamplight__fse *table, int mode, const uint8_t *bytes, size_t size,
                               const int16_t *counts, int symbols, int log, int most) {
    size_t used;
    switch (mode) {
    case 0: return lamplight__build(table, counts, symbols, log) ? 0 : SIZE_MAX;
    case 1:
        if (!size || bytes[0] >= most) return SIZE_MAX;
        table->states[0].symbol = bytes[0];
        table->states[0].bits = 0;
        table->states[0].base = 0;
        table->log = 0;
        return 1;
    case 2:
        used = lamplight__counts(table, bytes, size, most, log == 5 ? 8 : 9);
        return used ? used : SIZE_MAX;
    default: return table->log < 0 ? SIZE_MAX : 0;
    }
}

static size_t lamplight__tables(lamplight__unzstd *z, uint8_t modes, const uint8_t *bytes,
                                size_t size) {
    size_t at = 0, used;
    used = lamplight__table(&z->literal_lengths, modes >> 6, bytes, size,
                            lamplight__literal_counts, 36, 6, 36);
    if (used == SIZE_MAX) return used;
    at += used;
    used = lamplight__table(&z->offsets, modes >> 4 & 3, bytes + at, size - at,
                            lamplight__offset_counts, 29, 5, 32);
    if (used == SIZE_MAX) return used;
    at += used;
    used = lamplight__table(&z->match_lengths, modes >> 2 & 3, bytes + at, size - at,
                            lamplight__match_counts, 53, 6, 53);
    return used == SIZE_MAX ? used : at + used;
}

static int lamplight__run(lamplight__unzstd *z, uint32_t count, const uint8_t *bytes, size_t size) {
    lamplight__bits bits;
    uint32_t lengths, offsets, matches;
    if (!lamplight__begin(&bits, bytes, size)) return 0;
    lengths = lamplight__take(&bits, z->literal_lengths.log);
    offsets = lamplight__take(&bits, z->offsets.log);
    matches = lamplight__take(&bits, z->match_lengths.log);
    while (count--) {
        const lamplight__state *length = &z->literal_lengths.states[lengths];
        const lamplight__state *offset = &z->offsets.states[offsets];
        const lamplight__state *match = &z->match_lengths.states[matches];
        uint64_t far = ((uint64_t)1 << offset->symbol) + lamplight__take(&bits, offset->symbol);
        uint32_t match_size = z->match_base[match->symbol] +
                              lamplight__take(&bits, lamplight__match_bits[match->symbol]);
        uint32_t literals = z->literal_base[length->symbol] +
                            lamplight__take(&bits, lamplight__literal_bits[length->symbol]);
        if (bits.left < 0 || !lamplight__copy_literals(z, literals)) return 0;
        if (!lamplight__copy_match(z, lamplight__offset(z, far, literals), match_size)) return 0;
        if (!count) break;
        lengths = length->base + lamplight__take(&bits, length->bits);
        matches = match->base + lamplight__take(&bits, match->bits);
        offsets = offset->base + lamplight__take(&bits, offset->bits);
        if (bits.left < 0) return 0;
    }
    return bits.left == 0;
}

static int lamplight__compressed(lamplight__unzstd *z, const uint8_t *bytes, size_t size) {
    size_t at = lamplight__literals(z, bytes, size), used;
    uint32_t count;
    if (!at || at >= size) return 0;
    count = bytes[at++];
    if (count >= 128) {
        size_t more = count == 255 ? 2 : 1;
        if (more > size - at) return 0;
        count = more == 2 ? bytes[at] + ((uint32_t)bytes[at + 1] << 8) + 0x7f00
                          : (count - 128) << 8 | bytes[at];
        at += more;
    }
    if (count) {
        uint8_t modes;
        if (at >= size) return 0;
        modes = bytes[at++];
        if (modes & 3) return 0;
        used = lamplight__tables(z, modes, bytes + at, size - at);
        if (used == SIZE_MAX) return 0;
        at += used;
        if (!lamplight__run(z, count, bytes + at, size - at)) return 0;
    } else if (at != size) {
        return 0;
    }
    if (!lamplight__copy_literals(z, z->literal_left)) return 0;
    return z->literal_kind <= LAMPLIGHT__RLE || z->bits.left == 0;
}

static int lamplight__block(lamplight__unzstd *z, int type, const uint8_t *bytes, size_t size,
                            size_t *used) {
    *used = type == 1 ? 1 : size;
    if (type == 2) return lamplight__compressed(z, bytes, size);
    if (type == 3 || size > z->size - z->used) return 0;
    if (type == 1)
        memset(z->out + z->used, bytes[0], size);
    else if (size)
        memcpy(z->out + z->used, bytes, size);
    z->used += size;
    return 1;
}

/* The size of the header of a frame; 0 for one that is not read. */
static size_t lamplight__frame(const uint8_t *bytes, size_t size) {
    static const uint8_t magic[4] = {0x28, 0xb5, 0x2f, 0xfd}, sizes[4] = {0, 2, 4, 8};
    size_t header;
    if (size < 6 || memcmp(bytes, magic, 4) != 0 || bytes[4] & 0x0b) return 0;
    header = 5 + (size_t)sizes[bytes[4] >> 6];
    header += bytes[4] & 0x20 ? bytes[4] >> 6 == 0 : 1;
    return header > size ? 0 : header;
}

size_t lamplight_unzstd(void *user, void *out, size_t size, const void *in, size_t in_size) {
    lamplight__unzstd z;
    const uint8_t *bytes = (const uint8_t *)in;
    size_t at = lamplight__frame(bytes, in_size), used;
    uint32_t header = 0;
    (void)user;
    if (!at) return 0;
    z.out = (uint8_t *)out;
    z.size = size;
    z.used = 0;
    z.repeated[0] = 1;
    z.repeated[1] = 4;
    z.repeated[2] = 8;
    z.huffman_log = 0;
    lamplight__bases(z.literal_base, lamplight__literal_bits, 36, 0);
    lamplight__bases(z.match_base, lamplight__match_bits, 53, 3);
    z.literal_lengths.log = z.offsets.log = z.match_lengths.log = -1;
    while (!(header & 1)) {
        size_t length;
        int type;
        if (in_size - at < 3) return 0;
        header = (uint32_t)bytes[at] | (uint32_t)bytes[at + 1] << 8 | (uint32_t)bytes[at + 2] << 16;
        at += 3;
        type = header >> 1 & 3;
        length = header >> 3;
        if (length > 1u << 17 || (type == 1 ? 1 : length) > in_size - at) return 0;
        if (!lamplight__block(&z, type, bytes + at, length, &used)) return 0;
        at += used;
    }
    return z.used;
}

#ifdef __cplusplus
}
#endif
#endif /* LAMPLIGHT_ZSTD_IMPLEMENTED */
#endif /* LAMPLIGHT_ZSTD_IMPLEMENTATION */
