/* Reads bundles of Lamplight: the single file, and the index of a directory.
 *
 * In one source file of your program:
 *
 *     #define LAMPLIGHT_IMPLEMENTATION
 *     #include "lamplight.h"
 *
 * C99 or C++11. Nothing is allocated: a `lamplight` and the bytes of the bundle are yours, and must
 * stay where they are while something from them is used. What a lookup returns points into these
 * bytes. After `lamplight_open`, several threads may read if each has its own copy of the
 * `lamplight`.
 *
 * Functions that can fail return 0 for success; `lamplight_error` is then the reason of a failure,
 * as a sentence. No bundle, however it is damaged, makes a function read or write out of bounds.
 *
 * The format is described in docs/guide/format.md.
 */
#ifndef LAMPLIGHT_H
#define LAMPLIGHT_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* The version of bundles that this reader reads. */
#define LAMPLIGHT_VERSION 3

/* The longest key, in bytes, and the most axes of a program. */
#define LAMPLIGHT_KEY_BYTES 1024
#define LAMPLIGHT_AXES 128

/* What functions return. */
enum {
    LAMPLIGHT_OK = 0,
    LAMPLIGHT_CORRUPT = -1,   /* damaged, or no bundle at all */
    LAMPLIGHT_FORMAT = -2,    /* of an older or a newer version of the format */
    LAMPLIGHT_NOT_FOUND = -3, /* no such program, entry point or target */
    LAMPLIGHT_BAD_KEY = -4,   /* the key names an axis or a value that there is not */
    LAMPLIGHT_MISS = -5,      /* the bundle has no such permutation */
    LAMPLIGHT_ROOM = -6,      /* a buffer is too small */
    LAMPLIGHT_READ = -7       /* no decompressor, or it failed, or a file was not read */
};

/* Decompresses a frame of zstd to at most `size` bytes at `out`, and returns how many there were; 0
 * where it failed. `lamplight_unzstd` of lamplight_zstd.h is one; with libzstd it is
 *
 *     size_t n = ZSTD_decompress(out, size, in, in_size);
 *     return ZSTD_isError(n) ? 0 : n;
 */
typedef size_t (*lamplight_decompress)(void *user, void *out, size_t size, const void *in,
                                       size_t in_size);

/* Reads a file of a bundle that is a directory, such as `blobs/0123456789abcdef.spv`: `size` bytes
 * to `out`. Returns how many there were. */
typedef size_t (*lamplight_read_file)(void *user, const char *name, void *out, size_t size);

/* Values in binary form, in the bytes of the bundle. */
typedef struct lamplight_tree {
    const uint8_t *roots, *texts, *words, *bytes;
    uint32_t root_count, text_count, word_count, byte_count;
} lamplight_tree;

/* An open bundle. Set `decompress` for single files, or `read_file` for directories. */
typedef struct lamplight {
    lamplight_decompress decompress;
    lamplight_read_file read_file;
    void *user; /* passed to these two */
    const uint8_t *bytes;
    size_t size;
    size_t offset[6], length[6];
    lamplight_tree meta, values;
    uint32_t unit_count, artifact_count, blob_count, piece_count, group_count;
    uint32_t piece_room; /* bytes of the largest group that has pieces */
    char error[1024];
    char key[LAMPLIGHT_KEY_BYTES];
} lamplight;

/* A value of a bundle, as JSON has them. One that is not there is null, and has no members. */
typedef struct lamplight_value {
    const lamplight_tree *tree;
    uint32_t word, before;
} lamplight_value;

/* One shader: a permutation of an entry point, for one target. */
typedef struct lamplight_shader {
    const char *entry;                 /* its name in the output */
    const char *stage;                 /* vertex, fragment or compute */
    const char *target;                /* as it was asked for */
    lamplight_value reflection;        /* what every target has */
    lamplight_value native;            /* names and numbers of this target */
    lamplight_value constants;         /* values of overrides that the key chooses */
    lamplight_value layout;            /* as lamplight_layout, for the language of the shader */
    uint32_t unit;                     /* equal numbers are equal shaders */
    uint32_t size;                     /* bytes of the output */
    uint32_t group, group_size, offset;
    uint32_t words;                    /* of its list of pieces; 0 where it is stored whole */
    size_t work_size;
    uint8_t hash[16];
    char file[64];                     /* in a directory: the name of its file */
} lamplight_shader;

/* A specialisation constant, macro or pipeline constant to set. */
typedef struct lamplight_constant {
    const char *name;   /* the axis */
    const char *symbol; /* the macro (GLSL, HLSL) or other name (WGSL); null where there is none */
    const char *type;   /* bool, i32, u32, f32 */
    const char *value;  /* as text */
    uint32_t bits;      /* as a specialisation constant */
    uint32_t id;        /* of the specialisation constant; only with `has_id` */
    int has_id;
} lamplight_constant;

/* A binding of a shader or of a program's layout. Numbers that are not there are 0, texts null. */
typedef struct lamplight_binding {
    uint32_t group, binding;
    const char *name;
    const char *kind; /* uniform, storage, texture, storage_texture, sampler, comparison_sampler,
                         immediate */
    const char *dimension, *sample_type, *format, *access; /* of textures */
    uint32_t count; /* elements of an array of bindings; 1 otherwise */
    uint32_t size;  /* bytes of a buffer */
    int writable, multisampled;
    int vertex, fragment, compute; /* the stages that use it; only in a layout */
    lamplight_value members;       /* of a buffer */
    lamplight_value value;         /* all of it */
} lamplight_binding;

/* Opens a bundle: the bytes of a single file, or of `index.bin` of a directory. Set `decompress` or
 * `read_file` before or after. Everything but the shaders is checked here. */
int lamplight_open(lamplight *bundle, const void *bytes, size_t size);

/* Why the last function failed. */
const char *lamplight_error(const lamplight *bundle);

/* Finds the shader of a key, such as `shadow=hard` or `default`, for a target, such as `spirv`. If
 * two languages have an entry point of that name, it is the one in WESL. */
int lamplight_find(lamplight *bundle, const char *program, const char *entry, const char *key,
                   const char *target, lamplight_shader *shader);

/* As lamplight_find, in one source language: `wesl` or `glsl`. */
int lamplight_find_in(lamplight *bundle, const char *program, const char *language,
                      const char *entry, const char *key, const char *target,
                      lamplight_shader *shader);

/* How many bytes of working memory lamplight_read needs for a shader; 0 in a directory. */
size_t lamplight_work_size(const lamplight_shader *shader);

/* Writes the `size` bytes of a shader to `out`, and checks them. */
int lamplight_read(lamplight *bundle, const lamplight_shader *shader, void *out, size_t out_size,
                   void *work, size_t work_size);

/* What all permutations of a program in one language bind: a list for lamplight_binding_at. */
lamplight_value lamplight_layout(const lamplight *bundle, const char *program,
                                 const char *language);

/* The bindings of a shader, for lamplight_binding_at. */
lamplight_value lamplight_bindings(const lamplight_shader *shader);

/* The binding of that number in a list. Returns 0 where the list has no more. */
int lamplight_binding_at(lamplight_value list, uint32_t index, lamplight_binding *binding);

/* The number of a binding in a list, among those of its kind: for APIs that number blocks by
 * themselves. With the `layout` of a shader, it is the same in all shaders of the program. */
uint32_t lamplight_index_of(lamplight_value list, const lamplight_binding *binding);

/* The slot that the target has for a binding: an item of `slots` of its native part, or null. */
lamplight_value lamplight_slot(const lamplight_shader *shader, uint32_t group, uint32_t binding);

/* The constant of that number. Returns 0 where the shader has no more. */
int lamplight_constant_at(const lamplight_shader *shader, uint32_t index,
                          lamplight_constant *constant);

/* Members of records, items of lists, and what values are. */
lamplight_value lamplight_field(lamplight_value record, const char *name);
uint32_t lamplight_count(lamplight_value list);
lamplight_value lamplight_item(lamplight_value list, uint32_t index);
int lamplight_is_null(lamplight_value value);
int lamplight_is_true(lamplight_value value);
/* A whole number; `otherwise` where it is none, or does not fit. */
int64_t lamplight_number(lamplight_value value, int64_t otherwise);
/* A text in UTF-8, with a zero after it; null where the value is none. */
const char *lamplight_text(lamplight_value value);

#ifdef __cplusplus
}
#endif
#endif /* LAMPLIGHT_H */

#ifdef LAMPLIGHT_IMPLEMENTATION
#ifndef LAMPLIGHT_IMPLEMENTED
#define LAMPLIGHT_IMPLEMENTED

#include <stdio.h>
#include <string.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Checksums: the first 16 bytes of BLAKE3. */

static const uint32_t lamplight__iv[8] = {0x6a09e667u, 0xbb67ae85u, 0x3c6ef372u, 0xa54ff53au,
                                          0x510e527fu, 0x9b05688cu, 0x1f83d9abu, 0x5be0cd19u};

enum { LAMPLIGHT__START = 1, LAMPLIGHT__END = 2, LAMPLIGHT__PARENT = 4, LAMPLIGHT__ROOT = 8 };

static uint32_t lamplight__u32(const uint8_t *at) {
    return (uint32_t)at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 | (uint32_t)at[3] << 24;
}

static uint64_t lamplight__u64(const uint8_t *at) {
    return (uint64_t)lamplight__u32(at) | (uint64_t)lamplight__u32(at + 4) << 32;
}

static uint32_t lamplight__rotate(uint32_t value, int bits) {
    return value >> bits | value << (32 - bits);
}

static void lamplight__mix(uint32_t *s, int a, int b, int c, int d, uint32_t x, uint32_t y) {
    s[a] = s[a] + s[b] + x;
    s[d] = lamplight__rotate(s[d] ^ s[a], 16);
    s[c] = s[c] + s[d];
    s[b] = lamplight__rotate(s[b] ^ s[c], 12);
    s[a] = s[a] + s[b] + y;
    s[d] = lamplight__rotate(s[d] ^ s[a], 8);
    s[c] = s[c] + s[d];
    s[b] = lamplight__rotate(s[b] ^ s[c], 7);
}

/* One block into the chaining value `cv`. */
static void lamplight__compress(uint32_t cv[8], const uint32_t block[16], uint64_t counter,
                                uint32_t length, uint32_t flags) {
    static const uint8_t order[16] = {2, 6, 3, 10, 7, 0, 4, 13, 1, 11, 12, 5, 9, 14, 15, 8};
    uint32_t s[16], m[16], next[16];
    int round, i;
    memcpy(m, block, sizeof m);
    for (i = 0; i < 8; i++) s[i] = cv[i];
    for (i = 0; i < 4; i++) s[8 + i] = lamplight__iv[i];
    s[12] = (uint32_t)counter;
    s[13] = (uint32_t)(counter >> 32);
    s[14] = length;
    s[15] = flags;
    for (round = 0; round < 7; round++) {
        lamplight__mix(s, 0, 4, 8, 12, m[0], m[1]);
        lamplight__mix(s, 1, 5, 9, 13, m[2], m[3]);
        lamplight__mix(s, 2, 6, 10, 14, m[4], m[5]);
        lamplight__mix(s, 3, 7, 11, 15, m[6], m[7]);
        lamplight__mix(s, 0, 5, 10, 15, m[8], m[9]);
        lamplight__mix(s, 1, 6, 11, 12, m[10], m[11]);
        lamplight__mix(s, 2, 7, 8, 13, m[12], m[13]);
        lamplight__mix(s, 3, 4, 9, 14, m[14], m[15]);
        for (i = 0; i < 16; i++) next[i] = m[order[i]];
        memcpy(m, next, sizeof m);
    }
    for (i = 0; i < 8; i++) cv[i] = s[i] ^ s[i + 8];
}

static void lamplight__chunk(const uint8_t *bytes, size_t size, uint64_t counter, uint32_t root,
                             uint32_t cv[8]) {
    uint32_t flags = LAMPLIGHT__START, block[16];
    memcpy(cv, lamplight__iv, sizeof lamplight__iv);
    for (;;) {
        uint8_t raw[64];
        size_t part = size < 64 ? size : 64;
        int i;
        memset(raw, 0, sizeof raw);
        if (part) memcpy(raw, bytes, part);
        for (i = 0; i < 16; i++) block[i] = lamplight__u32(raw + 4 * i);
        if (size <= 64) flags |= LAMPLIGHT__END | root;
        lamplight__compress(cv, block, counter, (uint32_t)part, flags);
        if (size <= 64) return;
        bytes += 64;
        size -= 64;
        flags = 0;
    }
}

static void lamplight__subtree(const uint8_t *bytes, size_t size, uint64_t counter, uint32_t root,
                               uint32_t cv[8]) {
    uint32_t block[16];
    size_t left = 1024;
    if (size <= 1024) {
        lamplight__chunk(bytes, size, counter, root, cv);
        return;
    }
    while (left < size - left) left *= 2;
    lamplight__subtree(bytes, left, counter, 0, block);
    lamplight__subtree(bytes + left, size - left, counter + left / 1024, 0, block + 8);
    memcpy(cv, lamplight__iv, sizeof lamplight__iv);
    lamplight__compress(cv, block, 0, 64, LAMPLIGHT__PARENT | root);
}

static int lamplight__matches(const uint8_t *bytes, size_t size, const uint8_t hash[16]) {
    uint32_t cv[8];
    int i;
    lamplight__subtree(bytes, size, 0, LAMPLIGHT__ROOT, cv);
    for (i = 0; i < 4; i++)
        if (cv[i] != lamplight__u32(hash + 4 * i)) return 0;
    return 1;
}

/* Errors. */

static int lamplight__fail(lamplight *bundle, int code, const char *before, const char *name,
                           const char *after) {
    char *at;
    snprintf(bundle->error, sizeof bundle->error, "%s%.300s%s", before, name, after);
    for (at = bundle->error; *at; at++)
        if ((unsigned char)*at < 32 || *at == 127) *at = '?';
    return code;
}

static int lamplight__damaged(lamplight *bundle, const char *reason) {
    return lamplight__fail(bundle, LAMPLIGHT_CORRUPT, "the bundle is damaged: ", reason, "");
}

/* A further name of a list in an error. */
static void lamplight__append(lamplight *bundle, const char *between, const char *name) {
    size_t used = strlen(bundle->error);
    char *at = bundle->error + used;
    if (used + 1 >= sizeof bundle->error) return;
    snprintf(at, sizeof bundle->error - used, "%s%.100s", between, name);
    for (; *at; at++)
        if ((unsigned char)*at < 32 || *at == 127) *at = '?';
}

const char *lamplight_error(const lamplight *bundle) { return bundle->error; }

/* Trees of values. */

enum {
    LAMPLIGHT__SIMPLE,
    LAMPLIGHT__NATURAL,
    LAMPLIGHT__NEGATIVE,
    LAMPLIGHT__TEXT,
    LAMPLIGHT__LIST,
    LAMPLIGHT__RECORD,
    LAMPLIGHT__LARGE
};

static int lamplight__read_tree(lamplight_tree *tree, const uint8_t *bytes, size_t size) {
    uint64_t roots, texts, words;
    if (size < 16) return 0;
    tree->root_count = lamplight__u32(bytes);
    tree->text_count = lamplight__u32(bytes + 4);
    tree->word_count = lamplight__u32(bytes + 8);
    tree->byte_count = lamplight__u32(bytes + 12);
    roots = (uint64_t)tree->root_count * 4;
    texts = (uint64_t)tree->text_count * 8;
    words = (uint64_t)tree->word_count * 4;
    if (16 + roots + texts + words + tree->byte_count != size) return 0;
    tree->roots = bytes + 16;
    tree->texts = tree->roots + roots;
    tree->words = tree->texts + texts;
    tree->bytes = tree->words + words;
    return 1;
}

static lamplight_value lamplight__null(void) {
    lamplight_value none;
    none.tree = NULL;
    none.word = 0;
    none.before = 0;
    return none;
}

static lamplight_value lamplight__root(const lamplight_tree *tree, uint32_t index) {
    lamplight_value root;
    if (index >= tree->root_count) return lamplight__null();
    root.tree = tree;
    root.word = lamplight__u32(tree->roots + 4 * (size_t)index);
    root.before = UINT32_MAX;
    return root;
}

static const char *lamplight__tree_text(const lamplight_tree *tree, uint32_t number) {
    uint32_t start, length;
    if (number >= tree->text_count) return NULL;
    start = lamplight__u32(tree->texts + 8 * (size_t)number);
    length = lamplight__u32(tree->texts + 8 * (size_t)number + 4);
    if (start >= tree->byte_count || length >= tree->byte_count - start) return NULL;
    if (tree->bytes[start + length] != 0) return NULL;
    return (const char *)tree->bytes + start;
}

/* The words of a list or a record after its length, and the length; null for other values. */
static const uint8_t *lamplight__node(lamplight_value value, uint32_t kind, uint32_t width,
                                      uint32_t *count) {
    uint32_t at = value.word >> 3;
    *count = 0;
    if (!value.tree || (value.word & 7) != kind || at >= value.before) return NULL;
    if (at >= value.tree->word_count) return NULL;
    *count = lamplight__u32(value.tree->words + 4 * (size_t)at);
    if ((uint64_t)*count * width > value.tree->word_count - at - 1) {
        *count = 0;
        return NULL;
    }
    return value.tree->words + 4 * ((size_t)at + 1);
}

static lamplight_value lamplight__child(lamplight_value parent, const uint8_t *word) {
    lamplight_value child;
    child.tree = parent.tree;
    child.word = lamplight__u32(word);
    child.before = parent.word >> 3;
    return child;
}

lamplight_value lamplight_field(lamplight_value record, const char *name) {
    uint32_t count, i;
    const uint8_t *words = lamplight__node(record, LAMPLIGHT__RECORD, 2, &count);
    for (i = 0; name && i < count; i++) {
        const uint8_t *pair = words + 8 * (size_t)i;
        const char *found = lamplight__tree_text(record.tree, lamplight__u32(pair));
        if (found && strcmp(found, name) == 0) return lamplight__child(record, pair + 4);
    }
    return lamplight__null();
}

/* The name and the value of a member of a record. */
static const char *lamplight__member(lamplight_value record, uint32_t index,
                                     lamplight_value *value) {
    uint32_t count;
    const uint8_t *words = lamplight__node(record, LAMPLIGHT__RECORD, 2, &count);
    if (index >= count) return NULL;
    *value = lamplight__child(record, words + 8 * (size_t)index + 4);
    return lamplight__tree_text(record.tree, lamplight__u32(words + 8 * (size_t)index));
}

uint32_t lamplight_count(lamplight_value list) {
    uint32_t count;
    lamplight__node(list, LAMPLIGHT__LIST, 1, &count);
    return count;
}

lamplight_value lamplight_item(lamplight_value list, uint32_t index) {
    uint32_t count;
    const uint8_t *words = lamplight__node(list, LAMPLIGHT__LIST, 1, &count);
    if (index >= count) return lamplight__null();
    return lamplight__child(list, words + 4 * (size_t)index);
}

int lamplight_is_null(lamplight_value value) { return !value.tree || value.word == 0; }

int lamplight_is_true(lamplight_value value) { return value.tree && value.word == 2u << 3; }

static int64_t lamplight__digits(const char *text, int64_t otherwise) {
    int negative = *text == '-', digits = 0;
    uint64_t value = 0;
    for (text += negative; *text >= '0' && *text <= '9' && digits < 18; text++, digits++)
        value = value * 10 + (uint64_t)(*text - '0');
    if (!digits || *text) return otherwise;
    return negative ? -(int64_t)value : (int64_t)value;
}

int64_t lamplight_number(lamplight_value value, int64_t otherwise) {
    uint32_t rest = value.word >> 3;
    const char *text;
    if (!value.tree) return otherwise;
    switch (value.word & 7) {
    case LAMPLIGHT__NATURAL: return rest;
    case LAMPLIGHT__NEGATIVE: return -1 - (int64_t)rest;
    case LAMPLIGHT__LARGE:
        text = lamplight__tree_text(value.tree, rest);
        return text ? lamplight__digits(text, otherwise) : otherwise;
    default: return otherwise;
    }
}

const char *lamplight_text(lamplight_value value) {
    if (!value.tree || (value.word & 7) != LAMPLIGHT__TEXT) return NULL;
    return lamplight__tree_text(value.tree, value.word >> 3);
}

static int lamplight__is(lamplight_value value, const char *text) {
    const char *found = lamplight_text(value);
    return found && strcmp(found, text) == 0;
}

static uint32_t lamplight__natural(lamplight_value value) {
    int64_t number = lamplight_number(value, 0);
    return number < 0 || number > (int64_t)UINT32_MAX ? 0 : (uint32_t)number;
}

/* The file. */

enum { LAMPLIGHT__META, LAMPLIGHT__KEYS, LAMPLIGHT__UNITS, LAMPLIGHT__VALUES, LAMPLIGHT__BLOBS,
       LAMPLIGHT__DATA };

#define LAMPLIGHT__HEADER (24 + 6 * 32 + 16)

/* The most bytes of a blob, and of a group after decompression. */
#define LAMPLIGHT__MOST_BYTES ((uint32_t)16 << 20)

static int lamplight__header(lamplight *bundle) {
    const uint8_t *bytes = bundle->bytes;
    size_t next = LAMPLIGHT__HEADER, i;
    char number[48];
    if (bundle->size < 12 || memcmp(bytes, "LAMPLGHT", 8) != 0)
        return lamplight__fail(bundle, LAMPLIGHT_CORRUPT, "this is not a Lamplight bundle", "", "");
    if (lamplight__u32(bytes + 8) != LAMPLIGHT_VERSION) {
        snprintf(number, sizeof number, "%lu", (unsigned long)lamplight__u32(bytes + 8));
        return lamplight__fail(bundle, LAMPLIGHT_FORMAT, "the bundle has format version ", number,
                               ", and this reader reads version 3");
    }
    if (bundle->size < LAMPLIGHT__HEADER) return lamplight__damaged(bundle, "it is cut off");
    if (!lamplight__matches(bytes, LAMPLIGHT__HEADER - 16, bytes + LAMPLIGHT__HEADER - 16))
        return lamplight__damaged(bundle, "the checksum of its header does not match");
    if (lamplight__u32(bytes + 12) != 6 || lamplight__u64(bytes + 16) != bundle->size)
        return lamplight__damaged(bundle, "it does not have the bytes that it was written with");
    for (i = 0; i < 6; i++) {
        uint64_t offset = lamplight__u64(bytes + 24 + i * 32);
        uint64_t length = lamplight__u64(bytes + 24 + i * 32 + 8);
        if (offset != next || length > bundle->size - next)
            return lamplight__damaged(bundle, "a section is not where the one before ends");
        bundle->offset[i] = next;
        bundle->length[i] = (size_t)length;
        next += (size_t)length;
    }
    if (next != bundle->size) return lamplight__damaged(bundle, "bytes follow the last section");
    for (i = 0; i < LAMPLIGHT__DATA; i++)
        if (!lamplight__matches(bytes + bundle->offset[i], bundle->length[i],
                                bytes + 24 + i * 32 + 16))
            return lamplight__damaged(bundle, "the checksum of a section does not match");
    return LAMPLIGHT_OK;
}

static lamplight_value lamplight__meta(const lamplight *bundle, const char *name) {
    return lamplight_field(lamplight__root(&bundle->meta, 0), name);
}

/* The records of a blob, a piece and a group: see `BLOBS` in the description of the format. */
static const uint8_t *lamplight__blob_record(const lamplight *bundle, uint32_t blob) {
    return bundle->bytes + bundle->offset[LAMPLIGHT__BLOBS] + (size_t)blob * 32;
}

static const uint8_t *lamplight__piece(const lamplight *bundle, uint32_t piece) {
    return lamplight__blob_record(bundle, bundle->blob_count) + (size_t)piece * 16;
}

static const uint8_t *lamplight__group_record(const lamplight *bundle, uint32_t group) {
    return lamplight__piece(bundle, bundle->piece_count) + (size_t)group * 32;
}

int lamplight_open(lamplight *bundle, const void *bytes, size_t size) {
    int code;
    uint32_t i;
    uint64_t units, blobs;
    bundle->bytes = (const uint8_t *)bytes;
    bundle->size = size;
    bundle->error[0] = 0;
    bundle->unit_count = bundle->artifact_count = bundle->blob_count = 0;
    bundle->piece_count = bundle->group_count = bundle->piece_room = 0;
    memset(&bundle->meta, 0, sizeof bundle->meta);
    memset(&bundle->values, 0, sizeof bundle->values);
    code = lamplight__header(bundle);
    if (code) return code;
    if (!lamplight__read_tree(&bundle->meta, bundle->bytes + bundle->offset[LAMPLIGHT__META],
                              bundle->length[LAMPLIGHT__META]) ||
        !lamplight__read_tree(&bundle->values, bundle->bytes + bundle->offset[LAMPLIGHT__VALUES],
                              bundle->length[LAMPLIGHT__VALUES]))
        return lamplight__damaged(bundle, "a table has another size");
    bundle->unit_count = lamplight__natural(lamplight__meta(bundle, "units"));
    bundle->artifact_count = lamplight__natural(lamplight__meta(bundle, "artifacts"));
    bundle->blob_count = lamplight__natural(lamplight__meta(bundle, "blobs"));
    bundle->piece_count = lamplight__natural(lamplight__meta(bundle, "pieces"));
    bundle->group_count = lamplight__natural(lamplight__meta(bundle, "groups"));
    units = (uint64_t)bundle->unit_count * 12 + (uint64_t)bundle->artifact_count * 12;
    blobs = (uint64_t)bundle->blob_count * 32 + (uint64_t)bundle->piece_count * 16 +
            (uint64_t)bundle->group_count * 32;
    if (units != bundle->length[LAMPLIGHT__UNITS] || blobs != bundle->length[LAMPLIGHT__BLOBS])
        return lamplight__damaged(bundle, "a table has another size");
    for (i = 0; i < bundle->piece_count; i++) {
        uint32_t group = lamplight__u32(lamplight__piece(bundle, i)), size = 0;
        if (group < bundle->group_count)
            size = lamplight__u32(lamplight__group_record(bundle, group) + 12);
        if (size > bundle->piece_room && size <= LAMPLIGHT__MOST_BYTES) bundle->piece_room = size;
    }
    return LAMPLIGHT_OK;
}

/* A word of a section; `ok` becomes 0 where it is outside. */
static uint32_t lamplight__word(const lamplight *bundle, int section, uint64_t at, int *ok) {
    if (at > bundle->length[section] || bundle->length[section] - at < 4) {
        *ok = 0;
        return 0;
    }
    return lamplight__u32(bundle->bytes + bundle->offset[section] + (size_t)at);
}

/* Keys. */

/* The index of a text in a list; UINT32_MAX where it is not there. */
static uint32_t lamplight__position(lamplight_value list, const char *text, size_t length) {
    uint32_t count = lamplight_count(list), i;
    for (i = 0; i < count; i++) {
        const char *found = lamplight_text(lamplight_item(list, i));
        if (found && strlen(found) == length && memcmp(found, text, length) == 0) return i;
    }
    return UINT32_MAX;
}

static int lamplight__is_blank(char byte) { return byte == ' ' || (byte >= '\t' && byte <= '\r'); }

static const char *lamplight__trim(const char *start, const char *end, size_t *length) {
    while (start < end && lamplight__is_blank(*start)) start++;
    while (end > start && lamplight__is_blank(end[-1])) end--;
    *length = (size_t)(end - start);
    return start;
}

/* Reads one part of a key, `axis=value` or `axis`, into the value that its axis has. */
static const char *lamplight__part(lamplight_value axes, const char *start, const char *end,
                                   uint32_t *chosen) {
    const char *equals = (const char *)memchr(start, '=', (size_t)(end - start));
    const char *value = "true";
    size_t name_length, value_length = 4;
    const char *name = lamplight__trim(start, equals ? equals : end, &name_length);
    uint32_t count = lamplight_count(axes), i, found;
    if (equals) value = lamplight__trim(equals + 1, end, &value_length);
    for (i = 0; i < count; i++) {
        lamplight_value axis = lamplight_item(axes, i);
        const char *known = lamplight_text(lamplight_field(axis, "name"));
        if (!known || strlen(known) != name_length || memcmp(known, name, name_length) != 0)
            continue;
        if (lamplight__is(lamplight_field(axis, "mode"), "dynamic"))
            return "an axis is dynamic: its value is chosen while running";
        if (chosen[i] != UINT32_MAX) return "an axis is named twice";
        found = lamplight__position(lamplight_field(axis, "values"), value, value_length);
        if (found == UINT32_MAX) return "an axis does not have this value";
        chosen[i] = found;
        return NULL;
    }
    return "it names an axis that there is not";
}

/* Adds a text to a key. Returns the new length; SIZE_MAX where it does not fit. */
static size_t lamplight__add(char *key, size_t used, const char *text) {
    size_t length = strlen(text);
    if (used == SIZE_MAX || length >= LAMPLIGHT_KEY_BYTES - used) return SIZE_MAX;
    memcpy(key + used, text, length + 1);
    return used + length;
}

/* Writes the canonical form of the chosen values: sorted by axis, defaults left out. */
static const char *lamplight__write(lamplight_value axes, const uint32_t *chosen, char *key) {
    uint32_t count = lamplight_count(axes), i;
    const char *last = NULL;
    size_t used = 0;
    key[0] = 0;
    for (;;) {
        const char *name = NULL, *value = NULL;
        for (i = 0; i < count; i++) {
            lamplight_value axis = lamplight_item(axes, i);
            const char *found = lamplight_text(lamplight_field(axis, "name")), *with;
            if (chosen[i] == UINT32_MAX || !found) continue;
            with = lamplight_text(lamplight_item(lamplight_field(axis, "values"), chosen[i]));
            if (!with || lamplight__is(lamplight_field(axis, "default"), with)) continue;
            if ((last && strcmp(found, last) <= 0) || (name && strcmp(found, name) >= 0)) continue;
            name = found;
            value = with;
        }
        if (!name) break;
        if (last) used = lamplight__add(key, used, ",");
        used = lamplight__add(key, used, name);
        if (strcmp(value, "true") != 0) {
            used = lamplight__add(key, used, "=");
            used = lamplight__add(key, used, value);
        }
        if (used == SIZE_MAX) return "it is too long";
        last = name;
    }
    if (!last) lamplight__add(key, 0, "default");
    return NULL;
}

/* The canonical form of a key, in `bundle->key`. */
static int lamplight__canonical(lamplight *bundle, lamplight_value axes, const char *key) {
    uint32_t chosen[LAMPLIGHT_AXES], i;
    const char *reason = NULL, *start = key, *end, *last = key + strlen(key);
    size_t length;
    if (lamplight_count(axes) > LAMPLIGHT_AXES) return lamplight__damaged(bundle, "too many axes");
    for (i = 0; i < LAMPLIGHT_AXES; i++) chosen[i] = UINT32_MAX;
    start = lamplight__trim(key, last, &length);
    if (length && !(length == 7 && memcmp(start, "default", 7) == 0)) {
        for (start = key; !reason; start = end + 1) {
            end = (const char *)memchr(start, ',', (size_t)(last - start));
            if (!end) end = last;
            reason = lamplight__part(axes, start, end, chosen);
            if (end == last) break;
        }
    }
    if (!reason) reason = lamplight__write(axes, chosen, bundle->key);
    if (!reason) return LAMPLIGHT_OK;
    lamplight__fail(bundle, LAMPLIGHT_BAD_KEY, "`", key, "` is not a key of this program: ");
    lamplight__append(bundle, "", reason);
    return LAMPLIGHT_BAD_KEY;
}

typedef struct lamplight__keys {
    uint32_t count, records, units, constants;
    int has_constants;
} lamplight__keys;

/* A key of a set, which has no zero at its end. */
static const char *lamplight__key(const lamplight *bundle, const lamplight__keys *set,
                                  uint32_t index, size_t *length) {
    int ok = 1;
    uint64_t record = (uint64_t)set->records + (uint64_t)index * 8;
    uint32_t at = lamplight__word(bundle, LAMPLIGHT__KEYS, record, &ok);
    *length = lamplight__word(bundle, LAMPLIGHT__KEYS, record + 4, &ok);
    if (!ok || at > bundle->length[LAMPLIGHT__KEYS] ||
        *length > bundle->length[LAMPLIGHT__KEYS] - at)
        return NULL;
    return (const char *)bundle->bytes + bundle->offset[LAMPLIGHT__KEYS] + at;
}

static int lamplight__compare(const char *key, size_t length, const char *wanted, size_t size) {
    int order = memcmp(key, wanted, length < size ? length : size);
    if (order) return order;
    return length < size ? -1 : length > size;
}

/* The index of a canonical key; the count of the set where it is not there. */
static int lamplight__search(lamplight *bundle, const lamplight__keys *set, uint32_t *index) {
    uint32_t low = 0, high = set->count;
    size_t size = strlen(bundle->key), length;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        const char *key = lamplight__key(bundle, set, middle, &length);
        int order;
        if (!key) return lamplight__damaged(bundle, "a key is outside of its section");
        order = lamplight__compare(key, length, bundle->key, size);
        if (order == 0) {
            *index = middle;
            return LAMPLIGHT_OK;
        }
        if (order < 0)
            low = middle + 1;
        else
            high = middle;
    }
    *index = set->count;
    return LAMPLIGHT_OK;
}

/* The first part of a key and how long it is; `default` has none. */
static size_t lamplight__first(const char *key, size_t length) {
    const char *comma = length ? (const char *)memchr(key, ',', length) : NULL;
    if (length == 7 && memcmp(key, "default", 7) == 0) return 0;
    return comma ? (size_t)(comma - key) : length;
}

static size_t lamplight__axis(const char *part, size_t length) {
    const char *equals = length ? (const char *)memchr(part, '=', length) : NULL;
    return equals ? (size_t)(equals - part) : length;
}

/* In how many axes two canonical keys differ. */
static uint32_t lamplight__distance(const char *a, size_t a_size, const char *b, size_t b_size) {
    uint32_t differing = 0;
    for (;;) {
        size_t one = lamplight__first(a, a_size), other = lamplight__first(b, b_size);
        int order = one && other ? lamplight__compare(a, lamplight__axis(a, one), b,
                                                      lamplight__axis(b, other))
                                 : one ? -1 : 1;
        if (!one && !other) return differing;
        if (order != 0 || one != other || memcmp(a, b, one) != 0) differing++;
        if (order <= 0) {
            size_t step = one < a_size ? one + 1 : one;
            a += step;
            a_size -= step;
        }
        if (order >= 0) {
            size_t step = other < b_size ? other + 1 : other;
            b += step;
            b_size -= step;
        }
        if (!a_size) a = "";
        if (!b_size) b = "";
    }
}

static int lamplight__miss(lamplight *bundle, const lamplight__keys *set) {
    uint32_t i, best = UINT32_MAX, at = 0;
    size_t size = strlen(bundle->key), length;
    const char *key;
    char nearest[LAMPLIGHT_KEY_BYTES];
    for (i = 0; i < set->count; i++) {
        uint32_t distance;
        key = lamplight__key(bundle, set, i, &length);
        if (!key) return lamplight__damaged(bundle, "a key is outside of its section");
        distance = lamplight__distance(bundle->key, size, key, length);
        if (distance < best) {
            best = distance;
            at = i;
        }
    }
    lamplight__fail(bundle, LAMPLIGHT_MISS, "the bundle has no permutation `", bundle->key, "`");
    key = set->count ? lamplight__key(bundle, set, at, &length) : NULL;
    if (!key) {
        lamplight__append(bundle, "; it has none at all", "");
        return LAMPLIGHT_MISS;
    }
    if (length >= sizeof nearest) length = sizeof nearest - 1;
    memcpy(nearest, key, length);
    nearest[length] = 0;
    lamplight__append(bundle, "; the nearest is `", "");
    snprintf(bundle->error + strlen(bundle->error),
             sizeof bundle->error - strlen(bundle->error), "%.300s`", nearest);
    return LAMPLIGHT_MISS;
}

/* Lookups. */

static int lamplight__program(lamplight *bundle, const char *name, lamplight_value *program) {
    lamplight_value programs = lamplight__meta(bundle, "programs"), value;
    const char *known;
    uint32_t i;
    *program = lamplight_field(programs, name);
    if (!lamplight_is_null(*program)) return LAMPLIGHT_OK;
    lamplight__fail(bundle, LAMPLIGHT_NOT_FOUND, "the bundle has no program `", name, "`; it has: ");
    for (i = 0; (known = lamplight__member(programs, i, &value)) != NULL; i++)
        lamplight__append(bundle, i ? ", " : "", known);
    return LAMPLIGHT_NOT_FOUND;
}

static int lamplight__entry(lamplight *bundle, lamplight_value program, const char *language,
                            const char *name, lamplight_value *entry) {
    lamplight_value entries = lamplight_field(program, "entries");
    uint32_t count = lamplight_count(entries), i;
    *entry = lamplight__null();
    for (i = 0; i < count; i++) {
        lamplight_value found = lamplight_item(entries, i);
        int is_wesl = lamplight__is(lamplight_field(found, "language"), "wesl");
        if (!lamplight__is(lamplight_field(found, "name"), name)) continue;
        if (language && !lamplight__is(lamplight_field(found, "language"), language)) continue;
        if (is_wesl || lamplight_is_null(*entry)) *entry = found;
    }
    if (!lamplight_is_null(*entry)) return LAMPLIGHT_OK;
    lamplight__fail(bundle, LAMPLIGHT_NOT_FOUND, "the program has no entry point `", name,
                    "`; it has: ");
    for (i = 0; i < count; i++) {
        const char *known = lamplight_text(lamplight_field(lamplight_item(entries, i), "name"));
        lamplight__append(bundle, i ? ", " : "", known ? known : "?");
    }
    return LAMPLIGHT_NOT_FOUND;
}

/* The place of the artifact of a unit for a target. */
static int lamplight__artifact(lamplight *bundle, uint32_t unit, const char *target,
                               uint64_t *place) {
    int ok = 1;
    uint32_t first, count, i;
    lamplight_value targets = lamplight__meta(bundle, "targets");
    if (unit >= bundle->unit_count) return lamplight__damaged(bundle, "a unit is out of range");
    first = lamplight__word(bundle, LAMPLIGHT__UNITS, (uint64_t)unit * 12 + 4, &ok);
    count = lamplight__word(bundle, LAMPLIGHT__UNITS, (uint64_t)unit * 12 + 8, &ok);
    if (!ok || first > bundle->artifact_count || count > bundle->artifact_count - first)
        return lamplight__damaged(bundle, "an artifact is out of range");
    lamplight__fail(bundle, LAMPLIGHT_NOT_FOUND, "the bundle has no target `", target,
                    "` for this shader; it has: ");
    for (i = first; i < first + count; i++) {
        const char *name;
        *place = (uint64_t)bundle->unit_count * 12 + (uint64_t)i * 12;
        name = lamplight_text(lamplight_field(
            lamplight_item(targets, lamplight__word(bundle, LAMPLIGHT__UNITS, *place, &ok)),
            "name"));
        if (!ok || !name) return lamplight__damaged(bundle, "a target is out of range");
        if (strcmp(name, target) == 0) {
            bundle->error[0] = 0;
            return LAMPLIGHT_OK;
        }
        lamplight__append(bundle, i > first ? ", " : "", name);
    }
    return LAMPLIGHT_NOT_FOUND;
}

static int lamplight__blob(lamplight *bundle, uint32_t blob, const char *extension,
                           lamplight_shader *shader) {
    static const char digits[] = "0123456789abcdef";
    int ok = 1, i;
    const uint8_t *record;
    uint32_t stored;
    if (blob >= bundle->blob_count) return lamplight__damaged(bundle, "a blob is out of range");
    record = lamplight__blob_record(bundle, blob);
    shader->group = lamplight__u32(record);
    shader->offset = lamplight__u32(record + 4);
    shader->size = lamplight__u32(record + 8);
    shader->words = lamplight__u32(record + 12);
    memcpy(shader->hash, record + 16, 16);
    shader->group_size = 0;
    shader->work_size = 0;
    shader->file[0] = 0;
    if (shader->size > LAMPLIGHT__MOST_BYTES || shader->words > LAMPLIGHT__MOST_BYTES / 4)
        return lamplight__damaged(bundle, "a blob is too large");
    if (shader->group == UINT32_MAX) {
        char name[17];
        for (i = 0; i < 8; i++) {
            name[2 * i] = digits[shader->hash[i] >> 4];
            name[2 * i + 1] = digits[shader->hash[i] & 15];
        }
        name[16] = 0;
        for (i = 0; extension[i]; i++)
            ok &= extension[i] == '.' || (extension[i] >= '0' && extension[i] <= '9') ||
                  (extension[i] >= 'a' && extension[i] <= 'z') ||
                  (extension[i] >= 'A' && extension[i] <= 'Z');
        if (!ok || i > 32) return lamplight__damaged(bundle, "a file has no proper extension");
        snprintf(shader->file, sizeof shader->file, "blobs/%s.%.32s", name, extension);
        return LAMPLIGHT_OK;
    }
    if (shader->group >= bundle->group_count)
        return lamplight__damaged(bundle, "a group is out of range");
    shader->group_size = lamplight__u32(lamplight__group_record(bundle, shader->group) + 12);
    stored = shader->words ? shader->words * 4 : shader->size;
    if (shader->group_size > LAMPLIGHT__MOST_BYTES || shader->offset > shader->group_size ||
        stored > shader->group_size - shader->offset)
        return lamplight__damaged(bundle, "a blob is out of range");
    shader->work_size = shader->group_size;
    if (shader->words) {
        if (shader->work_size < bundle->piece_room) shader->work_size = bundle->piece_room;
        shader->work_size += stored;
    }
    return LAMPLIGHT_OK;
}

static int lamplight__unit(lamplight *bundle, uint32_t unit, const char *target,
                           lamplight_shader *shader) {
    uint64_t place = 0;
    int ok = 1, code = lamplight__artifact(bundle, unit, target, &place);
    const char *extension;
    uint32_t reflection, native, blob, number;
    if (code) return code;
    reflection = lamplight__word(bundle, LAMPLIGHT__UNITS, (uint64_t)unit * 12, &ok);
    number = lamplight__word(bundle, LAMPLIGHT__UNITS, place, &ok);
    native = lamplight__word(bundle, LAMPLIGHT__UNITS, place + 4, &ok);
    blob = lamplight__word(bundle, LAMPLIGHT__UNITS, place + 8, &ok);
    extension = lamplight_text(lamplight_field(
        lamplight_item(lamplight__meta(bundle, "targets"), number), "extension"));
    shader->unit = unit;
    shader->target = target;
    shader->reflection = lamplight__root(&bundle->values, reflection);
    shader->native = lamplight__root(&bundle->values, native);
    shader->entry = lamplight_text(lamplight_field(shader->native, "entry_name"));
    shader->stage = lamplight_text(lamplight_field(shader->reflection, "stage"));
    if (!ok || !extension || !shader->entry || !shader->stage)
        return lamplight__damaged(bundle, "a shader has no name or no stage");
    return lamplight__blob(bundle, blob, extension, shader);
}

static void lamplight__key_set(lamplight_value entry, lamplight__keys *set) {
    lamplight_value keys = lamplight_field(entry, "keys");
    lamplight_value constants = lamplight_field(entry, "constants");
    set->count = lamplight__natural(lamplight_field(keys, "count"));
    set->records = lamplight__natural(lamplight_field(keys, "records"));
    set->units = lamplight__natural(lamplight_field(entry, "units"));
    set->constants = lamplight__natural(constants);
    set->has_constants = !lamplight_is_null(constants);
}

int lamplight_find_in(lamplight *bundle, const char *program, const char *language,
                      const char *entry, const char *key, const char *target,
                      lamplight_shader *shader) {
    lamplight_value found, shaders;
    lamplight__keys set;
    uint32_t index = 0, unit, number = UINT32_MAX;
    int ok = 1, code;
    memset(shader, 0, sizeof *shader);
    code = lamplight__program(bundle, program, &found);
    if (!code) code = lamplight__entry(bundle, found, language, entry, &shaders);
    if (!code) code = lamplight__canonical(bundle, lamplight_field(found, "axes"), key);
    if (code) return code;
    lamplight__key_set(shaders, &set);
    code = lamplight__search(bundle, &set, &index);
    if (code) return code;
    if (index >= set.count) return lamplight__miss(bundle, &set);
    unit = lamplight__word(bundle, LAMPLIGHT__KEYS, (uint64_t)set.units + (uint64_t)index * 4, &ok);
    if (set.has_constants)
        number = lamplight__word(bundle, LAMPLIGHT__KEYS,
                                 (uint64_t)set.constants + (uint64_t)index * 4, &ok);
    if (!ok) return lamplight__damaged(bundle, "a key is outside of its section");
    code = lamplight__unit(bundle, unit, target, shader);
    shader->layout = lamplight_field(lamplight_field(found, "layouts"),
                                     lamplight_text(lamplight_field(shaders, "language")));
    shader->constants = number == UINT32_MAX ? lamplight__null()
                                             : lamplight__root(&bundle->values, number);
    return code;
}

int lamplight_find(lamplight *bundle, const char *program, const char *entry, const char *key,
                   const char *target, lamplight_shader *shader) {
    return lamplight_find_in(bundle, program, NULL, entry, key, target, shader);
}

/* Bytes. */

size_t lamplight_work_size(const lamplight_shader *shader) { return shader->work_size; }

/* Decompresses a group to `work`. */
static int lamplight__group(lamplight *bundle, uint32_t group, uint8_t *work) {
    const uint8_t *record = lamplight__group_record(bundle, group);
    uint64_t offset = lamplight__u64(record);
    uint32_t packed = lamplight__u32(record + 8), size = lamplight__u32(record + 12);
    const uint8_t *data = bundle->bytes + bundle->offset[LAMPLIGHT__DATA];
    size_t length = bundle->length[LAMPLIGHT__DATA];
    if (offset > length || packed > length - offset)
        return lamplight__damaged(bundle, "a group is outside of its section");
    data += (size_t)offset;
    if (!lamplight__matches(data, packed, record + 16))
        return lamplight__damaged(bundle, "the checksum of a group does not match");
    if (!bundle->decompress)
        return lamplight__fail(bundle, LAMPLIGHT_READ, "set `decompress`: shaders are compressed",
                               "", "");
    if (bundle->decompress(bundle->user, work, size, data, packed) != size)
        return lamplight__damaged(bundle, "a group cannot be decompressed");
    return LAMPLIGHT_OK;
}

static void lamplight__set_u32(uint8_t *at, uint32_t value) {
    at[0] = (uint8_t)value;
    at[1] = (uint8_t)(value >> 8);
    at[2] = (uint8_t)(value >> 16);
    at[3] = (uint8_t)(value >> 24);
}

/* Checks a list of pieces, and makes values of the differences in it. */
static int lamplight__check_list(lamplight *bundle, const lamplight_shader *shader,
                                 uint8_t *list) {
    uint32_t at, left, before = 0, size = 0;
    for (at = 0; at < shader->words;) {
        uint32_t number = lamplight__u32(list + 4 * (size_t)at++), length;
        const uint8_t *piece;
        if (number >= bundle->piece_count)
            return lamplight__damaged(bundle, "a piece is out of range");
        piece = lamplight__piece(bundle, number);
        length = lamplight__u32(piece + 8);
        if (length == 0 || length > shader->size - size)
            return lamplight__damaged(bundle, "a shader has other bytes than it should");
        size += length;
        left = lamplight__u32(piece + 12);
        if (left > shader->words - at)
            return lamplight__damaged(bundle, "a list ends before its values");
        for (; left > 0; left--, at++) {
            before += lamplight__u32(list + 4 * (size_t)at);
            lamplight__set_u32(list + 4 * (size_t)at, before);
        }
    }
    if (size != shader->size)
        return lamplight__damaged(bundle, "a shader has other bytes than it should");
    return LAMPLIGHT_OK;
}

/* Writes a piece from its decompressed group, and fills its holes. Returns 0 where it is damaged. */
static int lamplight__place(const uint8_t *piece, const uint8_t *group, uint32_t group_size,
                             const uint8_t *list, uint8_t *out) {
    uint32_t offset = lamplight__u32(piece + 4), length = lamplight__u32(piece + 8);
    uint32_t values = lamplight__u32(piece + 12), holes = values ? (length / 4 + 7) / 8 : 0, i;
    if (offset > group_size || length > group_size - offset) return 0;
    if (holes > group_size - offset - length) return 0;
    memcpy(out, group + offset, length);
    for (i = 0; values && i < length / 4; i++) {
        uint32_t index = lamplight__u32(out + 4 * (size_t)i);
        if (!(group[offset + length + i / 8] >> i % 8 & 1)) continue;
        if (index >= values) return 0;
        memcpy(out + 4 * (size_t)i, list + 4 * (size_t)index, 4);
    }
    return 1;
}

/* Joins the pieces of a checked list, group by group, so that each is decompressed once. */
static int lamplight__join(lamplight *bundle, const lamplight_shader *shader, const uint8_t *list,
                           uint8_t *work, uint8_t *out) {
    uint32_t group = UINT32_MAX, size = 0;
    int code;
    for (;;) {
        uint32_t at = 0, next = UINT32_MAX;
        size_t end = 0;
        while (at < shader->words) {
            const uint8_t *piece =
                lamplight__piece(bundle, lamplight__u32(list + 4 * (size_t)at++));
            uint32_t found = lamplight__u32(piece);
            if (found == group &&
                !lamplight__place(piece, work, size, list + 4 * (size_t)at, out + end))
                return lamplight__damaged(bundle, "a piece is out of range");
            if ((group == UINT32_MAX || found > group) && found < next) next = found;
            at += lamplight__u32(piece + 12);
            end += lamplight__u32(piece + 8);
        }
        if (next == UINT32_MAX) return LAMPLIGHT_OK;
        group = next;
        if (group < bundle->group_count)
            size = lamplight__u32(lamplight__group_record(bundle, group) + 12);
        if (group >= bundle->group_count || size > bundle->piece_room)
            return lamplight__damaged(bundle, "a group is out of range");
        code = lamplight__group(bundle, group, work);
        if (code) return code;
    }
}

/* Decompresses a shader that is in a group. */
static int lamplight__unpack(lamplight *bundle, const lamplight_shader *shader, uint8_t *out,
                             uint8_t *work) {
    uint8_t *list = work, *group = work + (size_t)shader->words * 4;
    int code = lamplight__group(bundle, shader->group, group);
    if (code) return code;
    if (!shader->words) {
        memcpy(out, group + shader->offset, shader->size);
        return LAMPLIGHT_OK;
    }
    memcpy(list, group + shader->offset, (size_t)shader->words * 4);
    code = lamplight__check_list(bundle, shader, list);
    return code ? code : lamplight__join(bundle, shader, list, group, out);
}

int lamplight_read(lamplight *bundle, const lamplight_shader *shader, void *out, size_t out_size,
                   void *work, size_t work_size) {
    int code;
    if (out_size < shader->size || work_size < shader->work_size)
        return lamplight__fail(bundle, LAMPLIGHT_ROOM, "a buffer is too small for the shader", "",
                               "");
    if (shader->file[0]) {
        if (!bundle->read_file)
            return lamplight__fail(bundle, LAMPLIGHT_READ, "set `read_file`: shaders are in files",
                                   "", "");
        if (bundle->read_file(bundle->user, shader->file, out, shader->size) != shader->size)
            return lamplight__fail(bundle, LAMPLIGHT_READ, "`", shader->file,
                                   "` was not read, or is shorter than it was");
    } else {
        code = lamplight__unpack(bundle, shader, (uint8_t *)out, (uint8_t *)work);
        if (code) return code;
    }
    if (!lamplight__matches((const uint8_t *)out, shader->size, shader->hash))
        return lamplight__damaged(bundle, "the checksum of a shader does not match");
    return LAMPLIGHT_OK;
}

/* Descriptions. */

lamplight_value lamplight_layout(const lamplight *bundle, const char *program,
                                 const char *language) {
    lamplight_value found = lamplight_field(lamplight__meta(bundle, "programs"), program);
    return lamplight_field(lamplight_field(found, "layouts"), language);
}

lamplight_value lamplight_bindings(const lamplight_shader *shader) {
    return lamplight_field(shader->reflection, "bindings");
}

static int lamplight__has(lamplight_value list, const char *text) {
    return lamplight__position(list, text, strlen(text)) != UINT32_MAX;
}

int lamplight_binding_at(lamplight_value list, uint32_t index, lamplight_binding *binding) {
    lamplight_value value = lamplight_item(list, index), texture, stages;
    if (lamplight_is_null(value)) return 0;
    texture = lamplight_field(value, "texture");
    stages = lamplight_field(value, "stages");
    binding->value = value;
    binding->group = lamplight__natural(lamplight_field(value, "group"));
    binding->binding = lamplight__natural(lamplight_field(value, "binding"));
    binding->name = lamplight_text(lamplight_field(value, "name"));
    binding->kind = lamplight_text(lamplight_field(value, "kind"));
    if (!binding->name || !binding->kind) return 0;
    binding->dimension = lamplight_text(lamplight_field(texture, "dimension"));
    binding->sample_type = lamplight_text(lamplight_field(texture, "sample_type"));
    binding->format = lamplight_text(lamplight_field(texture, "format"));
    binding->access = lamplight_text(lamplight_field(texture, "access"));
    binding->multisampled = lamplight_is_true(lamplight_field(texture, "multisampled"));
    binding->count = (uint32_t)(lamplight_number(lamplight_field(value, "count"), 1) & 0xffffffff);
    binding->size = lamplight__natural(lamplight_field(value, "size"));
    binding->writable = lamplight_is_true(lamplight_field(value, "writable"));
    binding->vertex = lamplight__has(stages, "vertex");
    binding->fragment = lamplight__has(stages, "fragment");
    binding->compute = lamplight__has(stages, "compute");
    binding->members = lamplight_field(value, "members");
    return 1;
}

uint32_t lamplight_index_of(lamplight_value list, const lamplight_binding *binding) {
    lamplight_binding known;
    uint32_t i, index = 0;
    for (i = 0; lamplight_binding_at(list, i, &known); i++) {
        if (strcmp(known.kind, binding->kind) != 0) continue;
        if (known.group == binding->group && known.binding == binding->binding) break;
        index++;
    }
    return index;
}

lamplight_value lamplight_slot(const lamplight_shader *shader, uint32_t group, uint32_t binding) {
    lamplight_value slots = lamplight_field(shader->native, "slots");
    uint32_t count = lamplight_count(slots), i;
    for (i = 0; i < count; i++) {
        lamplight_value slot = lamplight_item(slots, i);
        if (lamplight_number(lamplight_field(slot, "group"), -1) == (int64_t)group &&
            lamplight_number(lamplight_field(slot, "binding"), -1) == (int64_t)binding)
            return slot;
    }
    return lamplight__null();
}

int lamplight_constant_at(const lamplight_shader *shader, uint32_t index,
                          lamplight_constant *constant) {
    lamplight_value value = lamplight_item(shader->constants, index);
    lamplight_value choices = lamplight_field(shader->native, "choices");
    uint32_t count = lamplight_count(choices), i;
    if (lamplight_is_null(value)) return 0;
    memset(constant, 0, sizeof *constant);
    constant->name = lamplight_text(lamplight_field(value, "name"));
    constant->type = lamplight_text(lamplight_field(value, "type"));
    constant->value = lamplight_text(lamplight_field(value, "value"));
    constant->bits = lamplight__natural(lamplight_field(value, "bits"));
    if (!constant->name || !constant->type || !constant->value) return 0;
    for (i = 0; i < count; i++) {
        lamplight_value choice = lamplight_item(choices, i), id;
        if (!lamplight__is(lamplight_field(choice, "name"), constant->name)) continue;
        id = lamplight_field(choice, "id");
        constant->symbol = lamplight_text(lamplight_field(choice, "symbol"));
        constant->has_id = !lamplight_is_null(id);
        constant->id = lamplight__natural(id);
    }
    return 1;
}

#ifdef __cplusplus
}
#endif
#endif /* LAMPLIGHT_IMPLEMENTED */
#endif /* LAMPLIGHT_IMPLEMENTATION */
