/* Reads crafted bundles: copies of a good one with changed words, whose checksums are right again.
 *
 *     fuzz BUNDLE COUNT SEED
 *
 * Everything that can be read is read. A sanitizer ends the program at the first fault.
 */
#define LAMPLIGHT_IMPLEMENTATION
#define LAMPLIGHT_ZSTD_IMPLEMENTATION
#include "lamplight.h"
#include "lamplight_zstd.h"

#include <stdio.h>
#include <stdlib.h>

static uint64_t state;
static unsigned long opened, found, read;

static uint32_t random_below(uint32_t bound) {
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return (uint32_t)(state >> 32) % bound;
}

static void put(uint8_t *at, uint32_t value) {
    int i;
    for (i = 0; i < 4; i++) at[i] = (uint8_t)(value >> (8 * i));
}

static void seal(const uint8_t *bytes, size_t size, uint8_t *sum) {
    uint32_t cv[8];
    int i;
    lamplight__subtree(bytes, size, 0, LAMPLIGHT__ROOT, cv);
    for (i = 0; i < 4; i++) put(sum + 4 * i, cv[i]);
}

static uint32_t interesting(uint32_t old) {
    static const uint32_t known[] = {0, 1, 2, 3, 4, 5, 7, 8, 0x7f, 0xff, 0xffff, 0x7fffffff,
                                     0x80000000u, 0xfffffff8u, 0xfffffffeu, 0xffffffffu};
    switch (random_below(4)) {
    case 0: return known[random_below(16)];
    case 1: return old + random_below(9) - 4;
    case 2: return old ^ 1u << random_below(32);
    default: return random_below(4096);
    }
}

/* Where a section is, from a good header. */
static size_t place(const uint8_t *bytes, int section, size_t *size) {
    *size = (size_t)lamplight__u64(bytes + 24 + section * 32 + 8);
    return (size_t)lamplight__u64(bytes + 24 + section * 32);
}

static void change(uint8_t *bytes) {
    int changes = 1 + (int)random_below(4), section = (int)random_below(6);
    size_t size, at = place(bytes, section, &size);
    for (; changes; changes--) {
        uint8_t *word;
        if (size < 4) return;
        word = bytes + at + (random_below(4) ? random_below((uint32_t)(size - 3)) & ~3u
                                             : random_below((uint32_t)(size - 3)));
        put(word, interesting(lamplight__u32(word)));
    }
}

static void seal_all(uint8_t *bytes) {
    size_t size, at, blobs, data, i;
    int section;
    uint32_t groups = 1; /* as many as the small bundle has */
    data = place(bytes, 5, &size);
    blobs = place(bytes, 4, &at) + at - 32 * groups;
    for (i = 0; i < groups; i++) {
        uint64_t offset = lamplight__u64(bytes + blobs + i * 32);
        uint32_t packed = lamplight__u32(bytes + blobs + i * 32 + 8);
        if (offset <= size && packed <= size - offset)
            seal(bytes + data + (size_t)offset, packed, bytes + blobs + i * 32 + 16);
    }
    for (section = 0; section < 5; section++) {
        at = place(bytes, section, &size);
        seal(bytes + at, size, bytes + 24 + section * 32 + 16);
    }
    seal(bytes, LAMPLIGHT__HEADER - 16, bytes + LAMPLIGHT__HEADER - 16);
}

static void walk(lamplight_value value, int depth) {
    uint32_t i, count = lamplight_count(value);
    lamplight_value member;
    lamplight_number(value, 0);
    lamplight_text(value);
    for (i = 0; i < count && i < 8 && depth < 5; i++) walk(lamplight_item(value, i), depth + 1);
    for (i = 0; i < 8 && depth < 5; i++)
        if (lamplight__member(value, i, &member)) walk(member, depth + 1);
}

static void read_shader(lamplight *bundle, const lamplight_shader *shader) {
    lamplight_constant constant;
    lamplight_binding binding;
    uint32_t i;
    walk(shader->reflection, 0);
    for (i = 0; i < 4 && lamplight_constant_at(shader, i, &constant); i++) continue;
    for (i = 0; i < 8 && lamplight_binding_at(lamplight_bindings(shader), i, &binding); i++)
        walk(lamplight_slot(shader, binding.group, binding.binding), 3);
    if (shader->size <= 1 << 16 && lamplight_work_size(shader) <= 1 << 20) {
        uint8_t *out = (uint8_t *)malloc(shader->size + 1);
        uint8_t *work = (uint8_t *)malloc(lamplight_work_size(shader) + 1);
        if (out && work && !lamplight_read(bundle, shader, out, shader->size, work,
                                           lamplight_work_size(shader)))
            read++;
        free(out);
        free(work);
    }
}

static void look(lamplight *bundle, const uint8_t *bytes, size_t size) {
    static const char *keys[] = {"default", "fog", "fog,taps=8", "shadow=hard,taps=-4", "taps=8"};
    static const char *targets[] = {"spirv", "wgsl", "glsl330"};
    lamplight_shader shader;
    if (lamplight_open(bundle, bytes, size)) return;
    opened++;
    walk(lamplight_layout(bundle, "lit", "wesl"), 0);
    if (!lamplight_find(bundle, "lit", random_below(2) ? "fs_main" : "vs_main",
                        keys[random_below(5)], targets[random_below(3)], &shader)) {
        found++;
        read_shader(bundle, &shader);
    }
    lamplight_find(bundle, "lit", "fs_main", "fog,shadow=hard", "spirv", &shader);
    lamplight_find(bundle, "blank", "main", "default", "spirv", &shader);
}

int main(int count, char **arguments) {
    static uint8_t good[1 << 20];
    lamplight bundle;
    unsigned long i, runs;
    size_t size;
    FILE *file;
    if (count < 4) return 1;
    file = fopen(arguments[1], "rb");
    if (!file) return 1;
    size = fread(good, 1, sizeof good, file);
    fclose(file);
    runs = strtoul(arguments[2], NULL, 10);
    state = 0x9e3779b97f4a7c15u ^ strtoul(arguments[3], NULL, 10);
    memset(&bundle, 0, sizeof bundle);
    bundle.decompress = lamplight_unzstd;
    for (i = 0; i < runs; i++) {
        uint8_t *bytes = (uint8_t *)malloc(size);
        if (!bytes) return 1;
        memcpy(bytes, good, size);
        change(bytes);
        seal_all(bytes);
        look(&bundle, bytes, size);
        free(bytes);
    }
    printf("%lu bundles: %lu opened, %lu lookups found, %lu shaders read\n", runs, opened, found,
           read);
    return 0;
}
