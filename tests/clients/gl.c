/* Draws the scene with OpenGL 3.3, or with OpenGL ES 3 if ES is defined, on no window.
 *
 *     gl BUNDLE PICTURES         18 pictures, one after the other: RGBA, 8 bits, the top row first
 *     gl BUNDLE PICTURES FIRST   only those from a number on
 */
#ifdef ES
#include <GLES3/gl3.h>
#define TARGET "essl300"
#else
#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>
#define TARGET "glsl330"
#endif

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include "scene.h"

/* lamplight */
#define LAMPLIGHT_IMPLEMENTATION
#define LAMPLIGHT_GL_IMPLEMENTATION
#include "lamplight_gl.h"
/* lamplight end */

static void open_context(void) {
    static const EGLint version[] = {EGL_CONTEXT_MAJOR_VERSION, 3,
#ifndef ES
                                     EGL_CONTEXT_MINOR_VERSION, 3,
#endif
                                     EGL_NONE};
    EGLDisplay display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, NULL, NULL);
    EGLContext context;
    eglInitialize(display, NULL, NULL);
#ifdef ES
    eglBindAPI(EGL_OPENGL_ES_API);
#else
    eglBindAPI(EGL_OPENGL_API);
#endif
    context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, version);
    if (!context || !eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
        fprintf(stderr, "no context of " TARGET "\n");
        exit(1);
    }
}

static GLuint make_buffer(GLenum kind, const void *bytes, size_t size) {
    GLuint buffer;
    glGenBuffers(1, &buffer);
    glBindBuffer(kind, buffer);
    glBufferData(kind, (GLsizeiptr)size, bytes, GL_STATIC_DRAW);
    return buffer;
}

static GLuint make_texture(GLint format, int width, int height, GLenum data, GLenum type,
                           const void *bytes) {
    GLuint texture;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, format, width, height, 0, data, type, bytes);
    return texture;
}

static GLuint make_sampler(int compares) {
    GLuint sampler;
    glGenSamplers(1, &sampler);
    glSamplerParameteri(sampler, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glSamplerParameteri(sampler, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glSamplerParameteri(sampler, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glSamplerParameteri(sampler, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    if (compares) {
        glSamplerParameteri(sampler, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
        glSamplerParameteri(sampler, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
    }
    return sampler;
}

static void open_frame(void) {
    GLuint frame, color = make_texture(GL_RGBA8, WIDTH, HEIGHT, GL_RGBA, GL_UNSIGNED_BYTE, NULL);
    glGenFramebuffers(1, &frame);
    glBindFramebuffer(GL_FRAMEBUFFER, frame);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color, 0);
    glViewport(0, 0, WIDTH, HEIGHT);
    glEnable(GL_CULL_FACE);
}

static void open_vertices(void) {
    GLuint array;
    glGenVertexArrays(1, &array);
    glBindVertexArray(array);
    make_buffer(GL_ARRAY_BUFFER, scene_vertices, sizeof scene_vertices);
    glEnableVertexAttribArray(LIT_INPUT_POSITION); /* lamplight */
    glEnableVertexAttribArray(LIT_INPUT_UV);       /* lamplight */
    glVertexAttribPointer(LIT_INPUT_POSITION, 3, GL_FLOAT, GL_FALSE, 20, NULL);
    glVertexAttribPointer(LIT_INPUT_UV, 2, GL_FLOAT, GL_FALSE, 20, (const void *)12);
}

static int failed(const char *reason) {
    fprintf(stderr, "%s\n", reason);
    return 1;
}

/* Writes what was drawn, the top row first. */
static void write_picture(FILE *out, int top_first) {
    static uint8_t pixels[HEIGHT][WIDTH][4];
    int y;
    glReadPixels(0, 0, WIDTH, HEIGHT, GL_RGBA, GL_UNSIGNED_BYTE, pixels);
    for (y = 0; y < HEIGHT; y++)
        fwrite(pixels[top_first ? y : HEIGHT - 1 - y], 1, sizeof pixels[0], out);
}

int main(int count, char **arguments) {
    float depths[8][8];
    lit_camera camera = scene_camera(); /* lamplight */
    lit_lamps light = scene_light();    /* lamplight */
    GLuint camera_buffer, light_buffer, image, shadow, plain, compare;
    int picture;
    size_t size;
    void *bytes;
    FILE *out;
    if (count < 3) return 1;
    bytes = scene_file(arguments[1], &size);
    out = fopen(arguments[2], "wb");
    open_context();
    open_frame();
    open_vertices();
    scene_shadow(depths);
    camera_buffer = make_buffer(GL_UNIFORM_BUFFER, &camera, sizeof camera);
    light_buffer = make_buffer(GL_UNIFORM_BUFFER, &light, sizeof light);
    image = make_texture(GL_RGBA8, 4, 3, GL_RGBA, GL_UNSIGNED_BYTE, scene_image);
    shadow = make_texture(GL_DEPTH_COMPONENT32F, 8, 8, GL_DEPTH_COMPONENT, GL_FLOAT, depths);
    plain = make_sampler(0);
    compare = make_sampler(1);
    /* lamplight */
    lamplight bundle = {0};
    lamplight_gl lit;
    if (lamplight_open(&bundle, bytes, size)) return failed(lamplight_error(&bundle));
    /* lamplight end */
    for (picture = count > 3 ? atoi(arguments[3]) : 0; picture < 18; picture++) {
        char key[64];
        scene_key(picture, key);
        glClearColor(0.2f, 0.1f, 0.3f, 1.0f);
        glClear(GL_COLOR_BUFFER_BIT);
        /* lamplight */
        if (lamplight_gl_open(&bundle, "lit", "vs_main", "fs_main", key, TARGET, &lit))
            return failed(lamplight_error(&bundle));
        lamplight_gl_block(&lit, "camera", camera_buffer);
        lamplight_gl_block(&lit, "lamps", light_buffer);
        lamplight_gl_texture(&lit, "image", GL_TEXTURE_2D, image, plain);
        lamplight_gl_texture(&lit, "shadow_map", GL_TEXTURE_2D, shadow, compare);
        glFrontFace(lamplight_gl_front_face(&lit));
        /* lamplight end */
        glDrawArrays(GL_TRIANGLES, 0, 6);
        write_picture(out, lamplight_gl_top_first(&lit)); /* lamplight */
        glDeleteProgram(lit.program);
    }
    fclose(out);
    free(bytes);
    return glGetError() != GL_NO_ERROR;
}
