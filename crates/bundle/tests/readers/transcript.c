/* What lamplight.h says of the set of bundles, in the form of `transcript.rs`.
 *
 *     transcript FOLDER good         the file and the directory, which must say the same
 *     transcript FOLDER NAME...      the first failure of each damaged file
 */
#define LAMPLIGHT_IMPLEMENTATION
#define LAMPLIGHT_ZSTD_IMPLEMENTATION
#include "lamplight.h"
#include "lamplight_zstd.h"

#include <stdio.h>
#include <stdlib.h>

static const char *folder;

static uint8_t *read_whole(const char *name, size_t *size) {
    char path[1024];
    FILE *file;
    uint8_t *bytes = (uint8_t *)malloc(1 << 20);
    snprintf(path, sizeof path, "%s/%s", folder, name);
    file = fopen(path, "rb");
    if (!file || !bytes) {
        fprintf(stderr, "cannot read %s\n", path);
        exit(1);
    }
    *size = fread(bytes, 1, 1 << 20, file);
    fclose(file);
    return bytes;
}

static size_t read_blob(void *user, const char *name, void *out, size_t size) {
    char path[256];
    size_t found;
    uint8_t *bytes;
    (void)user;
    snprintf(path, sizeof path, "good/%s", name);
    bytes = read_whole(path, &found);
    if (found <= size) memcpy(out, bytes, found);
    free(bytes);
    return found <= size ? found : 0;
}

static const char *word_of(int code) {
    switch (code) {
    case LAMPLIGHT_CORRUPT: return "corrupt";
    case LAMPLIGHT_FORMAT: return "format";
    case LAMPLIGHT_NOT_FOUND: return "not_found";
    case LAMPLIGHT_BAD_KEY: return "bad_key";
    case LAMPLIGHT_MISS: return "miss";
    default: return "other";
    }
}

static uint64_t fnv(const uint8_t *bytes, size_t size) {
    uint64_t hash = 0xcbf29ce484222325u;
    size_t i;
    for (i = 0; i < size; i++) hash = (hash ^ bytes[i]) * 0x100000001b3u;
    return hash;
}

static const char *or_dash(const char *text) { return text ? text : "-"; }

static int number(lamplight_value record, const char *name) {
    return (int)lamplight_number(lamplight_field(record, name), 0);
}

static void members(lamplight_value list, int depth, FILE *out) {
    uint32_t i;
    for (i = 0; i < lamplight_count(list); i++) {
        lamplight_value member = lamplight_item(list, i);
        lamplight_value shape = lamplight_field(member, "shape");
        fprintf(out, "%*smember %s %d %d %s %d %d %d %d %d\n", depth * 2, "",
                or_dash(lamplight_text(lamplight_field(member, "name"))), number(member, "offset"),
                number(member, "size"), or_dash(lamplight_text(lamplight_field(shape, "scalar"))),
                number(shape, "columns"), number(shape, "rows"), number(shape, "matrix_stride"),
                number(shape, "count"), number(member, "stride"));
        members(lamplight_field(member, "members"), depth + 1, out);
    }
}

static void binding_line(const lamplight_binding *found, FILE *out) {
    fprintf(out, "binding %u %u %s %s %u %u", (unsigned)found->group, (unsigned)found->binding,
            found->kind, found->name, (unsigned)found->size, (unsigned)found->count);
    if (found->dimension)
        fprintf(out, " %s %s %s %s", found->dimension, or_dash(found->sample_type),
                or_dash(found->format), or_dash(found->access));
}

static int ask(lamplight *bundle, const char *query, FILE *out) {
    char program[32], language[32], entry[32], key[64], target[32], *at;
    lamplight_shader shader;
    lamplight_constant constant;
    lamplight_binding binding;
    uint8_t *bytes, *work;
    uint32_t i;
    int code;
    if (sscanf(query, "%31s %31s %31s %63s %31s", program, language, entry, key, target) != 5) exit(1);
    for (at = key; *at; at++)
        if (*at == '+') *at = ' ';
    code = lamplight_find_in(bundle, program, language[0] == '-' ? NULL : language, entry, key,
                             target, &shader);
    if (code) {
        if (!lamplight_error(bundle)[0]) exit(1);
        fprintf(out, "! %s", word_of(code));
        fprintf(out, code == LAMPLIGHT_MISS ? " %s\n" : "\n", lamplight_error(bundle));
        return code;
    }
    bytes = (uint8_t *)malloc(shader.size + 1);
    work = (uint8_t *)malloc(lamplight_work_size(&shader) + 1);
    code = bytes && work ? lamplight_read(bundle, &shader, bytes, shader.size, work,
                                          lamplight_work_size(&shader))
                         : LAMPLIGHT_ROOM;
    if (!code)
        fprintf(out, "%s %s %u %016llx\n", shader.stage, shader.entry, (unsigned)shader.size,
                (unsigned long long)fnv(bytes, shader.size));
    free(bytes);
    free(work);
    if (code) return code;
    for (i = 0; lamplight_constant_at(&shader, i, &constant); i++)
        fprintf(out, "constant %s %s %s %08x %d %s\n", constant.name, constant.type,
                constant.value, (unsigned)constant.bits, constant.has_id ? (int)constant.id : -1,
                or_dash(constant.symbol));
    for (i = 0; lamplight_binding_at(lamplight_bindings(&shader), i, &binding); i++) {
        lamplight_value slot = lamplight_slot(&shader, binding.group, binding.binding);
        binding_line(&binding, out);
        fprintf(out, "\n  slot %d %d %s\n", number(slot, "space"), number(slot, "index"),
                or_dash(lamplight_text(lamplight_field(slot, "name"))));
        members(binding.members, 1, out);
    }
    return 0;
}

static void layout(lamplight *bundle, const char *program, FILE *out) {
    static const char *axes[] = {"fog", "shadow", "taps"};
    lamplight_value list = lamplight_layout(bundle, program, "wesl");
    lamplight_binding found;
    uint32_t i, j, k;
    fprintf(out, "> layout %s wesl\n", program);
    for (i = 0; lamplight_binding_at(list, i, &found); i++) {
        binding_line(&found, out);
        fprintf(out, " %s%s%s\n", found.vertex ? "vertex" : "", found.fragment ? "fragment" : "",
                found.compute ? "compute" : "");
        for (j = 0; j < 3; j++) {
            lamplight_value values =
                lamplight_field(lamplight_field(found.value, "when"), axes[j]);
            if (lamplight_is_null(values)) continue;
            fprintf(out, "  when %s", axes[j]);
            for (k = 0; k < lamplight_count(values); k++)
                fprintf(out, " %s", lamplight_text(lamplight_item(values, k)));
            fprintf(out, "\n");
        }
    }
}

/* All queries; only the first seven, and only until one fails, for a damaged bundle. */
static int queries(lamplight *bundle, int is_damaged, FILE *out) {
    size_t size;
    char *text = (char *)read_whole("queries.txt", &size), *line = text, *end;
    int code = 0, count = 0;
    text[size] = 0;
    for (; (end = strchr(line, '\n')) != NULL; line = end + 1) {
        *end = 0;
        if (is_damaged && (code || count++ >= 7)) break;
        fprintf(out, "> %s\n", line);
        code = ask(bundle, line, out);
    }
    free(text);
    return code;
}

static void good(const char *name, FILE *out) {
    lamplight bundle;
    size_t size;
    uint8_t *bytes = read_whole(name, &size);
    memset(&bundle, 0, sizeof bundle);
    bundle.decompress = lamplight_unzstd;
    bundle.read_file = read_blob;
    if (lamplight_open(&bundle, bytes, size)) {
        fprintf(stderr, "%s: %s\n", name, lamplight_error(&bundle));
        exit(1);
    }
    queries(&bundle, 0, out);
    layout(&bundle, "lit", out);
    layout(&bundle, "write", out);
    free(bytes);
}

static void damaged(const char *name, FILE *out) {
    lamplight bundle;
    size_t size;
    uint8_t *bytes = read_whole(name, &size);
    uint8_t *exact = (uint8_t *)malloc(size + 1); /* so that a read behind it is noticed */
    int code;
    if (!exact) exit(1);
    if (size) memcpy(exact, bytes, size);
    free(bytes);
    memset(&bundle, 0, sizeof bundle);
    bundle.decompress = lamplight_unzstd;
    code = lamplight_open(&bundle, exact, size);
    if (!code) code = queries(&bundle, 1, out);
    if (code && !lamplight_error(&bundle)[0]) code = 1;
    printf("%s %s\n", name, code ? word_of(code) : "is read");
    free(exact);
}

int main(int count, char **arguments) {
    FILE *nowhere = tmpfile();
    int i;
    if (count < 3 || !nowhere) return 1;
    folder = arguments[1];
    if (strcmp(arguments[2], "good") == 0) {
        good(count > 3 ? "good/index.bin" : "good.lamplight", stdout);
        return 0;
    }
    for (i = 2; i < count; i++) damaged(arguments[i], nowhere);
    fclose(nowhere);
    return 0;
}
