/* Layouts and stages of Vulkan from bundles of Lamplight.
 *
 * Include <vulkan/vulkan.h>, or your loader of its functions, before this one. In one source file:
 *
 *     #define LAMPLIGHT_IMPLEMENTATION
 *     #define LAMPLIGHT_VK_IMPLEMENTATION
 *     #include "lamplight_vk.h"
 *
 * Target: `spirv`.
 */
#ifndef LAMPLIGHT_VK_H
#define LAMPLIGHT_VK_H

#include "lamplight.h"
#include "lamplight_zstd.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The most constants that one shader may take from its key. */
#define LAMPLIGHT_VK_CONSTANTS 32

/* A stage of a pipeline. It points into itself, so it must not be copied. */
typedef struct lamplight_vk {
    lamplight_shader shader;
    VkPipelineShaderStageCreateInfo stage;
    VkSpecializationInfo constants;
    VkSpecializationMapEntry entries[LAMPLIGHT_VK_CONSTANTS];
    uint32_t words[LAMPLIGHT_VK_CONSTANTS];
} lamplight_vk;

/* Finds the shader of a key, makes its module, and fills `out->stage` with the constants of the key.
 * Memory comes from LAMPLIGHT_MALLOC, and is given back. Destroy `out->stage.module`. */
int lamplight_vk_open(lamplight *bundle, VkDevice device, const char *program, const char *entry,
                      const char *key, lamplight_vk *out);

/* The bindings of one descriptor set for all permutations of a program: a layout of
 * lamplight_layout, or the `layout` of a shader. Returns how many there are; writes at most `most`. */
uint32_t lamplight_vk_bindings(lamplight_value layout, uint32_t set,
                               VkDescriptorSetLayoutBinding *out, uint32_t most);

/* The push constants of all permutations of a program, for its pipeline layout; of size 0 if it has
 * none. */
VkPushConstantRange lamplight_vk_push(lamplight_value layout);

/* The kind of descriptor of a binding. Immediates have none. */
VkDescriptorType lamplight_vk_descriptor(const lamplight_binding *binding);

/* Attributes of a vertex stage in one buffer without padding. Returns how many there are; writes at
 * most `most`. `stride` becomes the bytes of a vertex. Built-in inputs, and inputs of types other than
 * `f32`, `i32` and `u32`, are left out. */
uint32_t lamplight_vk_attributes(const lamplight_shader *vertex,
                                 VkVertexInputAttributeDescription *out, uint32_t most,
                                 uint32_t *stride);

/* The viewport that a vertex stage expects, for a frame of that size. */
VkViewport lamplight_vk_viewport(const lamplight_shader *vertex, float width, float height);

/* The front face, for triangles that are counter-clockwise in the picture. */
VkFrontFace lamplight_vk_front_face(const lamplight_shader *vertex);

#ifdef __cplusplus
}
#endif
#endif /* LAMPLIGHT_VK_H */

#ifdef LAMPLIGHT_VK_IMPLEMENTATION
#ifndef LAMPLIGHT_VK_IMPLEMENTED
#define LAMPLIGHT_VK_IMPLEMENTED

#ifndef LAMPLIGHT_MALLOC
#include <stdlib.h>
#define LAMPLIGHT_MALLOC malloc
#define LAMPLIGHT_FREE free
#endif

#ifdef __cplusplus
extern "C" {
#endif

static int lamplight__vk_module(lamplight *bundle, VkDevice device, lamplight_vk *out) {
    /* The words of SPIR-V are first, so that they are aligned. */
    size_t size = (out->shader.size + 3) / 4 * 4, work = lamplight_work_size(&out->shader);
    uint8_t *memory = (uint8_t *)LAMPLIGHT_MALLOC(size + work + 1);
    VkShaderModuleCreateInfo info;
    int code;
    if (!memory)
        return lamplight__fail(bundle, LAMPLIGHT_ROOM, "there is no memory for a shader", "", "");
    if (!bundle->decompress) bundle->decompress = lamplight_unzstd;
    code = lamplight_read(bundle, &out->shader, memory, size, memory + size, work);
    if (!code) {
        memset(&info, 0, sizeof info);
        info.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
        info.codeSize = out->shader.size;
        info.pCode = (const uint32_t *)(const void *)memory;
        if (vkCreateShaderModule(device, &info, NULL, &out->stage.module) != VK_SUCCESS)
            code = lamplight__fail(bundle, LAMPLIGHT_READ, "the device takes no shader module `",
                                   out->shader.entry, "`");
    }
    LAMPLIGHT_FREE(memory);
    return code;
}

static int lamplight__vk_constants(lamplight *bundle, lamplight_vk *out) {
    lamplight_constant constant;
    uint32_t i, count = 0;
    for (i = 0; lamplight_constant_at(&out->shader, i, &constant); i++) {
        if (!constant.has_id) continue;
        if (count == LAMPLIGHT_VK_CONSTANTS)
            return lamplight__fail(bundle, LAMPLIGHT_ROOM, "a shader has too many constants", "", "");
        out->entries[count].constantID = constant.id;
        out->entries[count].offset = count * 4;
        out->entries[count].size = 4;
        out->words[count++] = constant.bits;
    }
    out->constants.mapEntryCount = count;
    out->constants.pMapEntries = out->entries;
    out->constants.dataSize = (size_t)count * 4;
    out->constants.pData = out->words;
    return LAMPLIGHT_OK;
}

int lamplight_vk_open(lamplight *bundle, VkDevice device, const char *program, const char *entry,
                      const char *key, lamplight_vk *out) {
    int code;
    memset(out, 0, sizeof *out);
    code = lamplight_find(bundle, program, entry, key, "spirv", &out->shader);
    if (!code) code = lamplight__vk_constants(bundle, out);
    if (!code) code = lamplight__vk_module(bundle, device, out);
    if (code) return code;
    out->stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    out->stage.stage = strcmp(out->shader.stage, "vertex") == 0     ? VK_SHADER_STAGE_VERTEX_BIT
                       : strcmp(out->shader.stage, "fragment") == 0 ? VK_SHADER_STAGE_FRAGMENT_BIT
                                                                    : VK_SHADER_STAGE_COMPUTE_BIT;
    out->stage.pName = out->shader.entry;
    out->stage.pSpecializationInfo = &out->constants;
    return LAMPLIGHT_OK;
}

VkDescriptorType lamplight_vk_descriptor(const lamplight_binding *binding) {
    if (strcmp(binding->kind, "uniform") == 0) return VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    if (strcmp(binding->kind, "storage") == 0) return VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    if (strcmp(binding->kind, "texture") == 0) return VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
    if (strcmp(binding->kind, "storage_texture") == 0) return VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;
    return VK_DESCRIPTOR_TYPE_SAMPLER;
}

static VkShaderStageFlags lamplight__vk_stages(const lamplight_binding *binding) {
    return (VkShaderStageFlags)((binding->vertex ? VK_SHADER_STAGE_VERTEX_BIT : 0) |
                                (binding->fragment ? VK_SHADER_STAGE_FRAGMENT_BIT : 0) |
                                (binding->compute ? VK_SHADER_STAGE_COMPUTE_BIT : 0));
}

uint32_t lamplight_vk_bindings(lamplight_value layout, uint32_t set,
                               VkDescriptorSetLayoutBinding *out, uint32_t most) {
    lamplight_binding binding;
    uint32_t i, count = 0;
    for (i = 0; lamplight_binding_at(layout, i, &binding); i++) {
        if (binding.group != set || strcmp(binding.kind, "immediate") == 0) continue;
        if (count < most) {
            memset(&out[count], 0, sizeof out[count]);
            out[count].binding = binding.binding;
            out[count].descriptorType = lamplight_vk_descriptor(&binding);
            out[count].descriptorCount = binding.count;
            out[count].stageFlags = lamplight__vk_stages(&binding);
        }
        count++;
    }
    return count;
}

VkPushConstantRange lamplight_vk_push(lamplight_value layout) {
    VkPushConstantRange range = {0, 0, 0};
    lamplight_binding binding;
    uint32_t i;
    for (i = 0; lamplight_binding_at(layout, i, &binding); i++) {
        if (strcmp(binding.kind, "immediate") != 0) continue;
        range.stageFlags |= lamplight__vk_stages(&binding);
        if (range.size < binding.size) range.size = (uint32_t)binding.size;
    }
    return range;
}

static VkFormat lamplight__vk_format(lamplight_value shape, uint32_t rows) {
    static const VkFormat formats[3][4] = {
        {VK_FORMAT_R32_SFLOAT, VK_FORMAT_R32G32_SFLOAT, VK_FORMAT_R32G32B32_SFLOAT,
         VK_FORMAT_R32G32B32A32_SFLOAT},
        {VK_FORMAT_R32_SINT, VK_FORMAT_R32G32_SINT, VK_FORMAT_R32G32B32_SINT,
         VK_FORMAT_R32G32B32A32_SINT},
        {VK_FORMAT_R32_UINT, VK_FORMAT_R32G32_UINT, VK_FORMAT_R32G32B32_UINT,
         VK_FORMAT_R32G32B32A32_UINT}};
    static const char *const scalars[3] = {"f32", "i32", "u32"};
    int i;
    if (rows < 1 || rows > 4) return VK_FORMAT_UNDEFINED;
    for (i = 0; i < 3; i++)
        if (lamplight__is(lamplight_field(shape, "scalar"), scalars[i])) return formats[i][rows - 1];
    return VK_FORMAT_UNDEFINED;
}

uint32_t lamplight_vk_attributes(const lamplight_shader *vertex,
                                 VkVertexInputAttributeDescription *out, uint32_t most,
                                 uint32_t *stride) {
    lamplight_value inputs = lamplight_field(vertex->reflection, "inputs");
    uint32_t i, count = 0;
    *stride = 0;
    for (i = 0; i < lamplight_count(inputs); i++) {
        lamplight_value input = lamplight_item(inputs, i);
        lamplight_value location = lamplight_field(input, "location");
        lamplight_value shape = lamplight_field(input, "shape");
        uint32_t rows = (uint32_t)lamplight_number(lamplight_field(shape, "rows"), 1);
        VkFormat format = lamplight__vk_format(shape, rows);
        if (lamplight_is_null(location) || format == VK_FORMAT_UNDEFINED) continue;
        if (count < most) {
            out[count].location = lamplight__natural(location);
            out[count].binding = 0;
            out[count].format = format;
            out[count].offset = *stride;
        }
        *stride += 4 * rows;
        count++;
    }
    return count;
}

VkViewport lamplight_vk_viewport(const lamplight_shader *vertex, float width, float height) {
    lamplight_value clip = lamplight_field(vertex->native, "clip");
    VkViewport viewport = {0, 0, 0, 0, 0, 1};
    viewport.width = width;
    viewport.height = height;
    if (lamplight__is(lamplight_field(clip, "viewport"), "negative")) {
        viewport.y = height;
        viewport.height = -height;
    }
    return viewport;
}

VkFrontFace lamplight_vk_front_face(const lamplight_shader *vertex) {
    lamplight_value clip = lamplight_field(vertex->native, "clip");
    return lamplight__is(lamplight_field(clip, "front_face"), "reversed")
               ? VK_FRONT_FACE_CLOCKWISE
               : VK_FRONT_FACE_COUNTER_CLOCKWISE;
}

#ifdef __cplusplus
}
#endif
#endif /* LAMPLIGHT_VK_IMPLEMENTED */
#endif /* LAMPLIGHT_VK_IMPLEMENTATION */

#if defined(LAMPLIGHT_VK_IMPLEMENTATION) && !defined(LAMPLIGHT_ZSTD_IMPLEMENTED)
#define LAMPLIGHT_ZSTD_IMPLEMENTATION
#include "lamplight_zstd.h"
#endif
