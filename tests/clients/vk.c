/* Draws the scene with Vulkan, on no window.
 *
 *     vk BUNDLE PICTURES     18 pictures, one after the other: RGBA, 8 bits, the top row first
 */
#include <vulkan/vulkan.h>

#include "scene.h"

/* lamplight */
#define LAMPLIGHT_IMPLEMENTATION
#define LAMPLIGHT_VK_IMPLEMENTATION
#include "lamplight_vk.h"
/* lamplight end */

#define CHECK(call)                                              \
    if ((call) != VK_SUCCESS) {                                  \
        fprintf(stderr, "line %d: %s failed\n", __LINE__, #call); \
        exit(1);                                                 \
    }

static VkPhysicalDevice physical;
static VkDevice device;
static VkQueue queue;
static VkCommandPool pool;

typedef struct image {
    VkImage image;
    VkImageView view;
} image;

static void open_device(void) {
    VkApplicationInfo application = {VK_STRUCTURE_TYPE_APPLICATION_INFO, NULL, "scene", 0, NULL, 0,
                                     VK_API_VERSION_1_1};
    VkInstanceCreateInfo instance_info = {VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, NULL, 0,
                                          &application, 0, NULL, 0, NULL};
    float priority = 1.0f;
    VkDeviceQueueCreateInfo queue_info = {VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, NULL, 0, 0, 1,
                                          &priority};
    VkDeviceCreateInfo info = {VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, NULL, 0, 1, &queue_info, 0,
                               NULL, 0, NULL, NULL};
    VkCommandPoolCreateInfo pool_info = {VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, NULL,
                                         VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT, 0};
    VkInstance instance;
    uint32_t count = 1;
    CHECK(vkCreateInstance(&instance_info, NULL, &instance));
    if (vkEnumeratePhysicalDevices(instance, &count, &physical) < 0 || !count) {
        fprintf(stderr, "no device of Vulkan\n");
        exit(1);
    }
    CHECK(vkCreateDevice(physical, &info, NULL, &device));
    vkGetDeviceQueue(device, 0, 0, &queue);
    CHECK(vkCreateCommandPool(device, &pool_info, NULL, &pool));
}

static VkDeviceMemory allocate(VkMemoryRequirements needs, VkMemoryPropertyFlags flags) {
    VkPhysicalDeviceMemoryProperties found;
    VkMemoryAllocateInfo info = {VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, NULL, needs.size, 0};
    VkDeviceMemory memory;
    vkGetPhysicalDeviceMemoryProperties(physical, &found);
    while (!(needs.memoryTypeBits >> info.memoryTypeIndex & 1) ||
           (found.memoryTypes[info.memoryTypeIndex].propertyFlags & flags) != flags)
        info.memoryTypeIndex++;
    CHECK(vkAllocateMemory(device, &info, NULL, &memory));
    return memory;
}

/* A buffer that the host sees, with these bytes. */
static VkBuffer make_buffer(VkBufferUsageFlags usage, const void *bytes, size_t size, void **mapped) {
    VkBufferCreateInfo info = {VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, NULL, 0, size, usage,
                               VK_SHARING_MODE_EXCLUSIVE, 0, NULL};
    VkMemoryRequirements needs;
    VkDeviceMemory memory;
    VkBuffer buffer;
    void *place;
    CHECK(vkCreateBuffer(device, &info, NULL, &buffer));
    vkGetBufferMemoryRequirements(device, buffer, &needs);
    memory = allocate(needs, VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
    CHECK(vkBindBufferMemory(device, buffer, memory, 0));
    CHECK(vkMapMemory(device, memory, 0, VK_WHOLE_SIZE, 0, &place));
    if (bytes) memcpy(place, bytes, size);
    if (mapped) *mapped = place;
    return buffer;
}

static image make_image(VkFormat format, uint32_t width, uint32_t height, VkImageUsageFlags usage,
                        VkImageAspectFlags aspect) {
    VkImageCreateInfo info = {0};
    VkImageViewCreateInfo view = {0};
    VkMemoryRequirements needs;
    image made;
    info.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = format;
    info.extent.width = width;
    info.extent.height = height;
    info.extent.depth = info.mipLevels = info.arrayLayers = 1;
    info.samples = VK_SAMPLE_COUNT_1_BIT;
    info.usage = usage;
    CHECK(vkCreateImage(device, &info, NULL, &made.image));
    vkGetImageMemoryRequirements(device, made.image, &needs);
    CHECK(vkBindImageMemory(device, made.image, allocate(needs, 0), 0));
    view.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    view.image = made.image;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = format;
    view.subresourceRange.aspectMask = aspect;
    view.subresourceRange.levelCount = view.subresourceRange.layerCount = 1;
    CHECK(vkCreateImageView(device, &view, NULL, &made.view));
    return made;
}

static VkCommandBuffer begin_commands(void) {
    VkCommandBufferAllocateInfo info = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, NULL, pool,
                                        VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
    VkCommandBufferBeginInfo begin = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, NULL, 0, NULL};
    VkCommandBuffer commands;
    CHECK(vkAllocateCommandBuffers(device, &info, &commands));
    CHECK(vkBeginCommandBuffer(commands, &begin));
    return commands;
}

static void end_commands(VkCommandBuffer commands) {
    VkSubmitInfo info = {VK_STRUCTURE_TYPE_SUBMIT_INFO, NULL, 0, NULL, NULL, 1, NULL, 0, NULL};
    info.pCommandBuffers = &commands;
    CHECK(vkEndCommandBuffer(commands));
    CHECK(vkQueueSubmit(queue, 1, &info, VK_NULL_HANDLE));
    CHECK(vkQueueWaitIdle(queue));
    vkFreeCommandBuffers(device, pool, 1, &commands);
}

static void change_layout(VkCommandBuffer commands, VkImage texture, VkImageAspectFlags aspect,
                          VkImageLayout before, VkImageLayout after) {
    VkImageMemoryBarrier barrier = {0};
    barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
    barrier.srcAccessMask = barrier.dstAccessMask =
        VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    barrier.oldLayout = before;
    barrier.newLayout = after;
    barrier.image = texture;
    barrier.subresourceRange.aspectMask = aspect;
    barrier.subresourceRange.levelCount = barrier.subresourceRange.layerCount = 1;
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                         VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, NULL, 0, NULL, 1, &barrier);
}

/* A copy between a buffer and all of an image. */
static VkBufferImageCopy whole_copy(VkImageAspectFlags aspect, uint32_t width, uint32_t height) {
    VkBufferImageCopy copy = {0};
    copy.imageSubresource.aspectMask = aspect;
    copy.imageSubresource.layerCount = 1;
    copy.imageExtent.width = width;
    copy.imageExtent.height = height;
    copy.imageExtent.depth = 1;
    return copy;
}

/* A texture of these bytes. */
static image make_texture(VkFormat format, VkImageAspectFlags aspect, uint32_t width,
                          uint32_t height, const void *bytes, size_t size) {
    image made = make_image(format, width, height,
                            VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT, aspect);
    VkBuffer from = make_buffer(VK_BUFFER_USAGE_TRANSFER_SRC_BIT, bytes, size, NULL);
    VkBufferImageCopy copy = whole_copy(aspect, width, height);
    VkCommandBuffer commands = begin_commands();
    change_layout(commands, made.image, aspect, VK_IMAGE_LAYOUT_UNDEFINED,
                  VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    vkCmdCopyBufferToImage(commands, from, made.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1,
                           &copy);
    change_layout(commands, made.image, aspect, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                  VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
    end_commands(commands);
    return made;
}

static VkSampler make_sampler(VkBool32 compares) {
    VkSamplerCreateInfo info = {0};
    VkSampler sampler;
    info.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
    info.addressModeU = info.addressModeV = info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
    info.compareEnable = compares;
    info.compareOp = VK_COMPARE_OP_LESS_OR_EQUAL;
    CHECK(vkCreateSampler(device, &info, NULL, &sampler));
    return sampler;
}

static VkRenderPass make_pass(VkFormat format) {
    VkAttachmentDescription color = {0};
    VkAttachmentReference reference = {0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass = {0};
    VkRenderPassCreateInfo info = {0};
    VkRenderPass pass;
    color.format = format;
    color.samples = VK_SAMPLE_COUNT_1_BIT;
    color.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    color.finalLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
    subpass.colorAttachmentCount = 1;
    subpass.pColorAttachments = &reference;
    info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO;
    info.attachmentCount = info.subpassCount = 1;
    info.pAttachments = &color;
    info.pSubpasses = &subpass;
    CHECK(vkCreateRenderPass(device, &info, NULL, &pass));
    return pass;
}

static VkPipeline make_pipeline(const lamplight_vk *vs, const lamplight_vk *fs,
                                VkPipelineLayout layout, VkRenderPass pass) {
    VkPipelineShaderStageCreateInfo stages[2];
    VkVertexInputAttributeDescription attributes[4];
    VkVertexInputBindingDescription buffer = {0, 0, VK_VERTEX_INPUT_RATE_VERTEX};
    VkPipelineVertexInputStateCreateInfo input = {0};
    VkPipelineInputAssemblyStateCreateInfo assembly = {0};
    VkPipelineViewportStateCreateInfo view = {0};
    VkPipelineRasterizationStateCreateInfo raster = {0};
    VkPipelineMultisampleStateCreateInfo samples = {0};
    VkPipelineColorBlendAttachmentState channel = {0};
    VkPipelineColorBlendStateCreateInfo blend = {0};
    VkGraphicsPipelineCreateInfo info = {0};
    VkViewport viewport = lamplight_vk_viewport(&vs->shader, WIDTH, HEIGHT); /* lamplight */
    VkRect2D scissor = {{0, 0}, {WIDTH, HEIGHT}};
    VkPipeline pipeline;
    stages[0] = vs->stage; /* lamplight */
    stages[1] = fs->stage; /* lamplight */
    input.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
    input.vertexAttributeDescriptionCount =
        lamplight_vk_attributes(&vs->shader, attributes, 4, &buffer.stride); /* lamplight */
    input.pVertexAttributeDescriptions = attributes;
    input.vertexBindingDescriptionCount = 1;
    input.pVertexBindingDescriptions = &buffer;
    assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    view.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
    view.viewportCount = view.scissorCount = 1;
    view.pViewports = &viewport;
    view.pScissors = &scissor;
    raster.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
    raster.cullMode = VK_CULL_MODE_BACK_BIT;
    raster.frontFace = lamplight_vk_front_face(&vs->shader); /* lamplight */
    raster.lineWidth = 1.0f;
    samples.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
    samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
    channel.colorWriteMask = 15;
    blend.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
    blend.attachmentCount = 1;
    blend.pAttachments = &channel;
    info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
    info.stageCount = 2;
    info.pStages = stages;
    info.pVertexInputState = &input;
    info.pInputAssemblyState = &assembly;
    info.pViewportState = &view;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &samples;
    info.pColorBlendState = &blend;
    info.layout = layout;
    info.renderPass = pass;
    CHECK(vkCreateGraphicsPipelines(device, VK_NULL_HANDLE, 1, &info, NULL, &pipeline));
    return pipeline;
}

/* Layouts of the two sets, and the layout of all pipelines. */
static VkPipelineLayout make_layout(lamplight_value program, VkDescriptorSetLayout sets[2]) {
    VkPipelineLayoutCreateInfo info = {0};
    VkPipelineLayout layout;
    uint32_t set;
    for (set = 0; set < 2; set++) {
        VkDescriptorSetLayoutBinding bindings[8];
        VkDescriptorSetLayoutCreateInfo own = {0};
        own.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
        own.bindingCount = lamplight_vk_bindings(program, set, bindings, 8); /* lamplight */
        own.pBindings = bindings;
        CHECK(vkCreateDescriptorSetLayout(device, &own, NULL, &sets[set]));
    }
    info.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    info.setLayoutCount = 2;
    info.pSetLayouts = sets;
    CHECK(vkCreatePipelineLayout(device, &info, NULL, &layout));
    return layout;
}

static void write_set(VkDescriptorSet set, uint32_t binding, VkDescriptorType type,
                      const VkDescriptorImageInfo *texture, const VkDescriptorBufferInfo *buffer) {
    VkWriteDescriptorSet write = {VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, NULL, set, binding, 0, 1,
                                  type, texture, buffer, NULL};
    vkUpdateDescriptorSets(device, 1, &write, 0, NULL);
}

static void write_texture(VkDescriptorSet set, uint32_t binding, VkDescriptorType type,
                          VkImageView view, VkSampler sampler) {
    VkDescriptorImageInfo texture = {sampler, view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
    write_set(set, binding, type, &texture, NULL);
}

static void write_buffer(VkDescriptorSet set, uint32_t binding, const void *bytes, size_t size) {
    VkDescriptorBufferInfo buffer = {VK_NULL_HANDLE, 0, VK_WHOLE_SIZE};
    buffer.buffer = make_buffer(VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT, bytes, size, NULL);
    write_set(set, binding, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, NULL, &buffer);
}

static void fill_sets(const VkDescriptorSetLayout layouts[2], VkDescriptorSet sets[2]) {
    VkDescriptorPoolSize sizes[3] = {{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 2},
                                     {VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 2},
                                     {VK_DESCRIPTOR_TYPE_SAMPLER, 2}};
    VkDescriptorPoolCreateInfo info = {VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO, NULL, 0, 2, 3,
                                       sizes};
    VkDescriptorPool descriptors;
    VkDescriptorSetAllocateInfo own = {VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO, NULL,
                                       VK_NULL_HANDLE, 2, layouts};
    lit_camera camera = scene_camera(); /* lamplight */
    lit_lamps light = scene_light();    /* lamplight */
    float depths[8][8];
    image picture, shadow;
    scene_shadow(depths);
    picture = make_texture(VK_FORMAT_R8G8B8A8_UNORM, VK_IMAGE_ASPECT_COLOR_BIT, 4, 3, scene_image,
                           sizeof scene_image);
    shadow = make_texture(VK_FORMAT_D32_SFLOAT, VK_IMAGE_ASPECT_DEPTH_BIT, 8, 8, depths, sizeof depths);
    CHECK(vkCreateDescriptorPool(device, &info, NULL, &descriptors));
    own.descriptorPool = descriptors;
    CHECK(vkAllocateDescriptorSets(device, &own, sets));
    write_buffer(sets[LIT_CAMERA_GROUP], LIT_CAMERA_BINDING, &camera, sizeof camera);
    write_buffer(sets[LIT_LAMPS_GROUP], LIT_LAMPS_BINDING, &light, sizeof light);
    write_texture(sets[1], LIT_IMAGE_BINDING, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, picture.view, NULL);
    write_texture(sets[1], LIT_SHADOW_MAP_BINDING, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, shadow.view, NULL);
    write_texture(sets[1], LIT_IMAGE_SAMPLER_BINDING, VK_DESCRIPTOR_TYPE_SAMPLER, NULL,
                  make_sampler(VK_FALSE));
    write_texture(sets[1], LIT_SHADOW_SAMPLER_BINDING, VK_DESCRIPTOR_TYPE_SAMPLER, NULL,
                  make_sampler(VK_TRUE));
}

static void draw(VkRenderPass pass, VkFramebuffer frame, VkPipeline pipeline,
                 VkPipelineLayout layout, const VkDescriptorSet sets[2], VkBuffer vertices,
                 VkImage target, VkBuffer out) {
    VkClearValue clear = {{{0.2f, 0.1f, 0.3f, 1.0f}}};
    VkRenderPassBeginInfo begin = {VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO, NULL, pass, frame,
                                   {{0, 0}, {WIDTH, HEIGHT}}, 1, &clear};
    VkDeviceSize start = 0;
    VkBufferImageCopy copy = whole_copy(VK_IMAGE_ASPECT_COLOR_BIT, WIDTH, HEIGHT);
    VkCommandBuffer commands = begin_commands();
    vkCmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout, 0, 2, sets, 0, NULL);
    vkCmdBindVertexBuffers(commands, 0, 1, &vertices, &start);
    vkCmdDraw(commands, 6, 1, 0, 0);
    vkCmdEndRenderPass(commands);
    change_layout(commands, target, VK_IMAGE_ASPECT_COLOR_BIT, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                  VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
    vkCmdCopyImageToBuffer(commands, target, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, out, 1, &copy);
    end_commands(commands);
}

static int failed(const char *reason) {
    fprintf(stderr, "%s\n", reason);
    return 1;
}

int main(int count, char **arguments) {
    VkDescriptorSetLayout layouts[2];
    VkDescriptorSet sets[2];
    VkPipelineLayout layout;
    VkRenderPass pass;
    VkFramebuffer frame;
    VkFramebufferCreateInfo info = {0};
    VkBuffer vertices, pixels;
    image target;
    void *mapped, *bytes;
    FILE *out;
    size_t size;
    int picture;
    if (count < 3) return 1;
    bytes = scene_file(arguments[1], &size);
    out = fopen(arguments[2], "wb");
    open_device();
    /* lamplight */
    lamplight bundle = {0};
    lamplight_vk vs, fs;
    if (lamplight_open(&bundle, bytes, size)) return failed(lamplight_error(&bundle));
    layout = make_layout(lamplight_layout(&bundle, "lit", "wesl"), layouts);
    /* lamplight end */
    fill_sets(layouts, sets);
    vertices = make_buffer(VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, scene_vertices, sizeof scene_vertices, NULL);
    pixels = make_buffer(VK_BUFFER_USAGE_TRANSFER_DST_BIT, NULL, WIDTH * HEIGHT * 4, &mapped);
    pass = make_pass(VK_FORMAT_R8G8B8A8_UNORM);
    target = make_image(VK_FORMAT_R8G8B8A8_UNORM, WIDTH, HEIGHT,
                        VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                        VK_IMAGE_ASPECT_COLOR_BIT);
    info.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
    info.renderPass = pass;
    info.attachmentCount = info.layers = 1;
    info.pAttachments = &target.view;
    info.width = WIDTH;
    info.height = HEIGHT;
    CHECK(vkCreateFramebuffer(device, &info, NULL, &frame));
    for (picture = 0; picture < 18; picture++) {
        char key[64];
        VkPipeline pipeline;
        scene_key(picture, key);
        /* lamplight */
        if (lamplight_vk_open(&bundle, device, "lit", "vs_main", key, &vs) ||
            lamplight_vk_open(&bundle, device, "lit", "fs_main", key, &fs))
            return failed(lamplight_error(&bundle));
        /* lamplight end */
        pipeline = make_pipeline(&vs, &fs, layout, pass);
        draw(pass, frame, pipeline, layout, sets, vertices, target.image, pixels);
        fwrite(mapped, 1, WIDTH * HEIGHT * 4, out);
        vkDestroyPipeline(device, pipeline, NULL);
        vkDestroyShaderModule(device, vs.stage.module, NULL);
        vkDestroyShaderModule(device, fs.stage.module, NULL);
    }
    fclose(out);
    free(bytes);
    return 0;
}
