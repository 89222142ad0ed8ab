/* Programs of OpenGL 3.3, OpenGL ES 3 and later from bundles of Lamplight.
 *
 * Include the header of your OpenGL, or your loader of its functions, before this one. In one source
 * file:
 *
 *     #define LAMPLIGHT_IMPLEMENTATION
 *     #define LAMPLIGHT_GL_IMPLEMENTATION
 *     #include "lamplight_gl.h"
 *
 * Targets: `glsl330` and `essl300`.
 */
#ifndef LAMPLIGHT_GL_H
#define LAMPLIGHT_GL_H

#include "lamplight.h"
#include "lamplight_zstd.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A program with its two shaders. */
typedef struct lamplight_gl {
    GLuint program;
    lamplight_shader vertex, fragment;
} lamplight_gl;

/* Finds both shaders of a key, and links them: the constants of the key are set, uniform blocks and
 * textures have their numbers. Memory comes from LAMPLIGHT_MALLOC, and is given back. */
int lamplight_gl_open(lamplight *bundle, const char *program, const char *vertex,
                      const char *fragment, const char *key, const char *target, lamplight_gl *out);

/* Binds a buffer to the uniform block that the author calls so; nothing where the program has none. */
void lamplight_gl_block(const lamplight_gl *gl, const char *name, GLuint buffer);

/* Binds a texture, and a sampler object (or 0), wherever a shader samples the texture of that name. */
void lamplight_gl_texture(const lamplight_gl *gl, const char *name, GLenum kind, GLuint texture,
                          GLuint sampler);

/* The front face, for triangles that are counter-clockwise in the picture: for glFrontFace. */
GLenum lamplight_gl_front_face(const lamplight_gl *gl);

/* Whether the first row of a frame that was drawn is the top of the picture: see the page on the
 * conventions of each target. */
int lamplight_gl_top_first(const lamplight_gl *gl);

#ifdef __cplusplus
}
#endif
#endif /* LAMPLIGHT_GL_H */

#ifdef LAMPLIGHT_GL_IMPLEMENTATION
#ifndef LAMPLIGHT_GL_IMPLEMENTED
#define LAMPLIGHT_GL_IMPLEMENTED

#ifndef LAMPLIGHT_MALLOC
#include <stdlib.h>
#define LAMPLIGHT_MALLOC malloc
#define LAMPLIGHT_FREE free
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* The macros that choose constants, one a line. */
static int lamplight__gl_macros(const lamplight_shader *shader, char *text, size_t size) {
    lamplight_constant constant;
    uint32_t i;
    size_t used = 0;
    text[0] = 0;
    for (i = 0; lamplight_constant_at(shader, i, &constant); i++) {
        int added;
        if (!constant.symbol) continue;
        added = snprintf(text + used, size - used, "#define %s %s\n", constant.symbol,
                         constant.value);
        if (added < 0 || (size_t)added >= size - used) return 0;
        used += (size_t)added;
    }
    return 1;
}

/* Compiles a text, with the macros after its first line, which has the version. */
static GLuint lamplight__gl_compile(GLenum stage, const char *text, size_t size,
                                    const char *macros) {
    const char *line = (const char *)memchr(text, '\n', size), *parts[3];
    size_t first = line ? (size_t)(line + 1 - text) : size;
    GLint lengths[3];
    GLuint made = glCreateShader(stage);
    parts[0] = text;
    parts[1] = macros;
    parts[2] = text + first;
    lengths[0] = (GLint)first;
    lengths[1] = (GLint)strlen(macros);
    lengths[2] = (GLint)(size - first);
    glShaderSource(made, 3, parts, lengths);
    glCompileShader(made);
    return made;
}

static int lamplight__gl_stage(lamplight *bundle, const lamplight_shader *shader, GLenum stage,
                               GLuint *made) {
    size_t work = lamplight_work_size(shader);
    char *memory = (char *)LAMPLIGHT_MALLOC(shader->size + work + 1);
    char macros[2048];
    int code;
    GLint is_compiled = 0;
    *made = 0;
    if (!memory)
        return lamplight__fail(bundle, LAMPLIGHT_ROOM, "there is no memory for a shader", "", "");
    if (!bundle->decompress) bundle->decompress = lamplight_unzstd;
    code = lamplight_read(bundle, shader, memory, shader->size, memory + shader->size, work);
    if (!code && !lamplight__gl_macros(shader, macros, sizeof macros))
        code = lamplight__fail(bundle, LAMPLIGHT_ROOM, "a shader has too many constants", "", "");
    if (!code) {
        *made = lamplight__gl_compile(stage, memory, shader->size, macros);
        glGetShaderiv(*made, GL_COMPILE_STATUS, &is_compiled);
        if (!is_compiled) {
            char log[512] = "";
            glGetShaderInfoLog(*made, sizeof log, NULL, log);
            code = lamplight__fail(bundle, LAMPLIGHT_READ, "a shader does not compile: ", log, "");
        }
    }
    LAMPLIGHT_FREE(memory);
    return code;
}

/* Immediates are a uniform block in GLSL. */
static int lamplight__gl_is_block(const lamplight_binding *binding) {
    return strcmp(binding->kind, "uniform") == 0 || strcmp(binding->kind, "immediate") == 0;
}

/* Gives each uniform block the number that it has in the layout of the program. */
static void lamplight__gl_blocks(GLuint program, const lamplight_shader *shader) {
    lamplight_binding binding;
    uint32_t i;
    for (i = 0; lamplight_binding_at(lamplight_bindings(shader), i, &binding); i++) {
        const char *name = lamplight_text(
            lamplight_field(lamplight_slot(shader, binding.group, binding.binding), "name"));
        GLuint index = name && lamplight__gl_is_block(&binding)
                           ? glGetUniformBlockIndex(program, name)
                           : GL_INVALID_INDEX;
        if (index != GL_INVALID_INDEX)
            glUniformBlockBinding(program, index, lamplight_index_of(shader->layout, &binding));
    }
}

static uint32_t lamplight__gl_count(const lamplight_shader *shader) {
    return lamplight_count(lamplight_field(shader->native, "combined"));
}

/* Gives each texture with its sampler a unit: those of the vertex stage first. */
static void lamplight__gl_units(GLuint program, const lamplight_shader *shader, uint32_t first) {
    lamplight_value combined = lamplight_field(shader->native, "combined");
    uint32_t i;
    for (i = 0; i < lamplight_count(combined); i++) {
        const char *name = lamplight_text(lamplight_field(lamplight_item(combined, i), "name"));
        GLint place = name ? glGetUniformLocation(program, name) : -1;
        if (place >= 0) glUniform1i(place, (GLint)(first + i));
    }
}

static int lamplight__gl_link(lamplight *bundle, lamplight_gl *gl, const GLuint stages[2]) {
    GLint is_linked = 0;
    GLuint program = glCreateProgram();
    glAttachShader(program, stages[0]);
    glAttachShader(program, stages[1]);
    glLinkProgram(program);
    glGetProgramiv(program, GL_LINK_STATUS, &is_linked);
    if (!is_linked) {
        char log[512] = "";
        glGetProgramInfoLog(program, sizeof log, NULL, log);
        glDeleteProgram(program);
        return lamplight__fail(bundle, LAMPLIGHT_READ, "a program does not link: ", log, "");
    }
    glUseProgram(program);
    lamplight__gl_blocks(program, &gl->vertex);
    lamplight__gl_blocks(program, &gl->fragment);
    lamplight__gl_units(program, &gl->vertex, 0);
    lamplight__gl_units(program, &gl->fragment, lamplight__gl_count(&gl->vertex));
    gl->program = program;
    return LAMPLIGHT_OK;
}

int lamplight_gl_open(lamplight *bundle, const char *program, const char *vertex,
                      const char *fragment, const char *key, const char *target,
                      lamplight_gl *out) {
    GLuint stages[2] = {0, 0};
    int code;
    memset(out, 0, sizeof *out);
    code = lamplight_find(bundle, program, vertex, key, target, &out->vertex);
    if (!code) code = lamplight_find(bundle, program, fragment, key, target, &out->fragment);
    if (!code) code = lamplight__gl_stage(bundle, &out->vertex, GL_VERTEX_SHADER, &stages[0]);
    if (!code) code = lamplight__gl_stage(bundle, &out->fragment, GL_FRAGMENT_SHADER, &stages[1]);
    if (!code) code = lamplight__gl_link(bundle, out, stages);
    glDeleteShader(stages[0]);
    glDeleteShader(stages[1]);
    return code;
}

void lamplight_gl_block(const lamplight_gl *gl, const char *name, GLuint buffer) {
    lamplight_binding binding;
    uint32_t i;
    for (i = 0; lamplight_binding_at(gl->fragment.layout, i, &binding); i++)
        if (lamplight__gl_is_block(&binding) && strcmp(binding.name, name) == 0)
            glBindBufferBase(GL_UNIFORM_BUFFER, lamplight_index_of(gl->fragment.layout, &binding),
                             buffer);
}

static void lamplight__gl_bind(const lamplight_shader *shader, uint32_t first, const char *name,
                               GLenum kind, GLuint texture, GLuint sampler) {
    lamplight_value combined = lamplight_field(shader->native, "combined");
    lamplight_binding binding;
    uint32_t i, j;
    for (i = 0; i < lamplight_count(combined); i++) {
        lamplight_value place = lamplight_field(lamplight_item(combined, i), "texture");
        int64_t group = lamplight_number(lamplight_item(place, 0), -1);
        int64_t number = lamplight_number(lamplight_item(place, 1), -1);
        for (j = 0; lamplight_binding_at(lamplight_bindings(shader), j, &binding); j++) {
            if (binding.group != group || binding.binding != number) continue;
            if (strcmp(binding.name, name) != 0) continue;
            glActiveTexture(GL_TEXTURE0 + first + i);
            glBindTexture(kind, texture);
            glBindSampler(first + i, sampler);
        }
    }
}

void lamplight_gl_texture(const lamplight_gl *gl, const char *name, GLenum kind, GLuint texture,
                          GLuint sampler) {
    uint32_t first = lamplight__gl_count(&gl->vertex);
    lamplight__gl_bind(&gl->vertex, 0, name, kind, texture, sampler);
    lamplight__gl_bind(&gl->fragment, first, name, kind, texture, sampler);
}

GLenum lamplight_gl_front_face(const lamplight_gl *gl) {
    lamplight_value clip = lamplight_field(gl->vertex.native, "clip");
    const char *face = lamplight_text(lamplight_field(clip, "front_face"));
    return face && strcmp(face, "reversed") == 0 ? GL_CW : GL_CCW;
}

int lamplight_gl_top_first(const lamplight_gl *gl) {
    lamplight_value clip = lamplight_field(gl->vertex.native, "clip");
    const char *rows = lamplight_text(lamplight_field(clip, "rows"));
    return !rows || strcmp(rows, "top_first") == 0;
}

#ifdef __cplusplus
}
#endif
#endif /* LAMPLIGHT_GL_IMPLEMENTED */
#endif /* LAMPLIGHT_GL_IMPLEMENTATION */

#if defined(LAMPLIGHT_GL_IMPLEMENTATION) && !defined(LAMPLIGHT_ZSTD_IMPLEMENTED)
#define LAMPLIGHT_ZSTD_IMPLEMENTATION
#include "lamplight_zstd.h"
#endif
