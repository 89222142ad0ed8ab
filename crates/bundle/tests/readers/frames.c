/* Decompresses frames of zstd to the bytes that they were made of.
 *
 *     frames FOLDER COUNT
 *
 * Frame 7 is in `7.zst`, its bytes are in `7.raw`. Each frame is also read damaged, and to a buffer
 * that is too small. A sanitizer ends the program at the first fault.
 */
#define LAMPLIGHT_ZSTD_IMPLEMENTATION
#include "lamplight_zstd.h"

#include <stdio.h>
#include <stdlib.h>

static uint8_t *read_whole(const char *folder, int number, const char *extension, size_t *size) {
    static uint8_t all[1 << 22];
    char path[1024];
    FILE *file;
    uint8_t *bytes;
    snprintf(path, sizeof path, "%s/%d.%s", folder, number, extension);
    file = fopen(path, "rb");
    if (!file) exit(2);
    *size = fread(all, 1, sizeof all, file);
    fclose(file);
    bytes = (uint8_t *)malloc(*size + 1);
    if (!bytes) exit(2);
    memcpy(bytes, all, *size);
    return bytes;
}

/* Changes one byte after the other, at most thirty of them. */
static void damage(uint8_t *frame, size_t size, size_t raw_size) {
    uint8_t *out = (uint8_t *)malloc(raw_size + 1);
    size_t at, step = size / 30 + 1;
    if (!out) exit(2);
    for (at = 4; at < size; at += step) {
        frame[at] ^= (uint8_t)(1u << (at / step & 7));
        lamplight_unzstd(NULL, out, raw_size, frame, size);
        lamplight_unzstd(NULL, out, raw_size, frame, at);
        frame[at] ^= (uint8_t)(1u << (at / step & 7));
    }
    free(out);
}

int main(int count, char **arguments) {
    int number, frames = count > 2 ? atoi(arguments[2]) : 0;
    for (number = 0; number < frames; number++) {
        size_t size, raw_size;
        uint8_t *frame = read_whole(arguments[1], number, "zst", &size);
        uint8_t *raw = read_whole(arguments[1], number, "raw", &raw_size);
        uint8_t *out = (uint8_t *)malloc(raw_size + 1);
        if (!out) return 2;
        if (lamplight_unzstd(NULL, out, raw_size, frame, size) != raw_size ||
            memcmp(out, raw, raw_size) != 0) {
            fprintf(stderr, "frame %d gives other bytes\n", number);
            return 1;
        }
        if (raw_size && lamplight_unzstd(NULL, out, raw_size - 1, frame, size) != 0) {
            fprintf(stderr, "frame %d fits into too few bytes\n", number);
            return 1;
        }
        damage(frame, size, raw_size);
        free(frame);
        free(raw);
        free(out);
    }
    printf("%d\n", frames);
    return 0;
}
