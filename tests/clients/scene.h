/* The scene that all clients draw: the same numbers, and nothing symmetric. */
#ifndef SCENE_H
#define SCENE_H

#include "lit.h" /* lamplight */

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH 48
#define HEIGHT 40

/* Positions and coordinates of textures: two triangles, counter-clockwise in the picture. */
static const float scene_vertices[6][5] = {
    {-0.9f, -0.7f, 0.1f, 0.0f, 1.0f}, {0.8f, -0.8f, 0.0f, 1.0f, 1.0f}, {0.7f, 0.9f, 0.2f, 1.0f, 0.0f},
    {-0.9f, -0.7f, 0.1f, 0.0f, 1.0f}, {0.7f, 0.9f, 0.2f, 1.0f, 0.0f}, {-0.5f, 0.4f, 0.0f, 0.0f, 0.0f},
};

/* Four columns and three rows, the first of which is at the top. */
static const uint8_t scene_image[3][4][4] = {
    {{255, 40, 30, 255}, {40, 200, 60, 255}, {50, 60, 220, 255}, {240, 230, 40, 255}},
    {{20, 180, 170, 255}, {200, 60, 190, 255}, {90, 90, 90, 255}, {255, 255, 255, 255}},
    {{130, 70, 20, 255}, {250, 150, 40, 255}, {30, 30, 100, 255}, {10, 90, 20, 255}},
};

static const char *const scene_lamps[2] = {"point", "spot"};
static const char *const scene_shadows[3] = {"none", "hard", "pcf"};
static const int scene_glosses[3] = {8, 32, 128};

/* Half of an 8 x 8 map is nearer than the surface: below a line that is not the diagonal. */
static void scene_shadow(float depths[8][8]) {
    int x, y;
    for (y = 0; y < 8; y++)
        for (x = 0; x < 8; x++) depths[y][x] = 2 * y > x + 5 ? 0.0f : 1.0f;
}

static lit_camera scene_camera(void) {
    lit_camera camera;
    memset(&camera, 0, sizeof camera);
    camera.clip_from_world[0][0] = 0.9f;
    camera.clip_from_world[0][1] = 0.1f;
    camera.clip_from_world[1][0] = -0.15f;
    camera.clip_from_world[1][1] = 0.8f;
    camera.clip_from_world[2][2] = 0.5f;
    camera.clip_from_world[2][3] = 0.3f;
    camera.clip_from_world[3][0] = 0.05f;
    camera.clip_from_world[3][1] = -0.1f;
    camera.clip_from_world[3][2] = 0.25f;
    camera.clip_from_world[3][3] = 1.0f;
    camera.normal_from_object[0][0] = 1.0f;
    camera.normal_from_object[0][1] = 0.3f;
    camera.normal_from_object[1][1] = 0.9f;
    camera.normal_from_object[1][2] = -0.4f;
    camera.normal_from_object[2][0] = -0.2f;
    camera.normal_from_object[2][2] = 1.1f;
    camera.eye[0] = 0.4f;
    camera.eye[1] = 0.3f;
    camera.eye[2] = 2.0f;
    camera.exposure = 0.8f;
    return camera;
}

static lit_lamps scene_light(void) {
    static const float positions[3][3] = {{0.6f, 0.5f, 1.2f}, {-0.7f, 0.2f, 0.9f}, {0, 0, 0.3f}};
    static const float colors[3][3] = {{1.0f, 0.8f, 0.5f}, {0.4f, 0.6f, 1.0f}, {9, 0, 9}};
    lit_lamps lamps;
    int i;
    memset(&lamps, 0, sizeof lamps);
    for (i = 0; i < 3; i++) {
        memcpy(lamps.all[i].position, positions[i], sizeof positions[i]);
        memcpy(lamps.all[i].color, colors[i], sizeof colors[i]);
        lamps.all[i].strength = 1.0f + 0.7f * (float)i;
    }
    lamps.axis[0] = 0.3f;
    lamps.axis[1] = 0.2f;
    lamps.axis[2] = 0.93f;
    lamps.count = 2;
    return lamps;
}

/* The key of a picture, of 18. */
static void scene_key(int picture, char key[64]) {
    snprintf(key, 64, "lamp=%s,shadow=%s,gloss=%d", scene_lamps[picture / 9],
             scene_shadows[picture / 3 % 3], scene_glosses[picture % 3]);
}

static void *scene_file(const char *path, size_t *size) {
    FILE *file = fopen(path, "rb");
    void *bytes = malloc(1 << 22);
    if (!file || !bytes) {
        fprintf(stderr, "cannot read %s\n", path);
        exit(1);
    }
    *size = fread(bytes, 1, 1 << 22, file);
    fclose(file);
    return bytes;
}

#endif
