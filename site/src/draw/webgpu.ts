// Drawings on WebGPU.
import type { Drawing, SamplerInfo, TextureInfo } from "@lamplight/toolchain";
import { type Device, type Frames, RefusedText, SENTINEL, buffers, floats, half, same, spent } from "./common";

/** Depth cannot be copied into a texture, only drawn. */
const DEPTH = `
@group(0) @binding(0) var stored: texture_2d<f32>;
@vertex fn triangle(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = vec2u((index << 1u) & 2u, index & 2u);
    return vec4f(vec2f(corner) * 2.0 - 1.0, 0.0, 1.0);
}
@fragment fn depth(@builtin(position) position: vec4f) -> @builtin(frag_depth) f32 {
    return textureLoad(stored, vec2u(position.xy), 0).x;
}`;

/** What is kept from drawing to drawing. */
type Kept = {
    device: GPUDevice;
    /** Whether textures of 32-bit floats can be filtered. */
    filters: boolean;
    pipelines: Map<string, Promise<GPURenderPipeline>>;
    /** What draws depths into a texture. */
    deep?: GPURenderPipeline;
    /** Textures by what they are bound to, which seldom changes. */
    textures: Map<string, { given: TextureInfo; made: GPUTexture }>;
    /** Samplers by their settings: a driver may compile shaders again for a new one. */
    samplers: Map<string, GPUSampler>;
};

export async function open(): Promise<Device | undefined> {
    const adapter = await navigator.gpu?.requestAdapter().catch(() => null);
    if (!adapter) return undefined;
    const filters = adapter.features.has("float32-filterable");
    const device = await adapter.requestDevice({ requiredFeatures: filters ? ["float32-filterable"] : [] });
    const kept: Kept = { device, filters, pipelines: new Map(), textures: new Map(), samplers: new Map() };
    let isLost = false;
    device.lost.then(() => { isLost = true; });
    return {
        name: "WebGPU",
        target: "wgsl",
        draw: (drawing) => draw(kept, drawing),
        isLost: () => isLost,
    };
}

async function draw(kept: Kept, drawing: Drawing): Promise<Frames> {
    const owned: { destroy(): void }[] = [];
    try {
        return await drawWith(kept, drawing, owned);
    } finally {
        for (const one of owned) one.destroy();
    }
}

/** Draws with buffers and textures that it adds to `owned`. */
async function drawWith(kept: Kept, drawing: Drawing, owned: { destroy(): void }[]): Promise<Frames> {
    const begun = performance.now();
    const pipeline = await prepared(kept, drawing);
    const compiled = performance.now();
    spent.compiling += compiled - begun;
    const { device } = kept;
    const used = bindings(drawing);
    const textures = new Map<string, GPUTextureView>();
    // What the browser refuses is an error of this drawing, and not only a line in its console.
    device.pushErrorScope("validation");
    for (const texture of drawing.textures) {
        const place = `${texture.group},${texture.binding}`;
        if (!used.has(place)) continue;
        textures.set(place, uploaded(kept, place, texture).createView({ dimension: texture.cube ? "cube" : "2d" }));
    }
    const samplers = new Map(drawing.samplers.map((one) => [`${one.group},${one.binding}`, sampler(kept, one)]));
    const { width, height } = drawing;
    const reads: Promise<ArrayBuffer>[] = [];
    const depthReads: Promise<ArrayBuffer>[] = [];
    const meshes = drawing.meshes.map((mesh) => ({
        vertices: mesh.words.length ? filled(device, GPUBufferUsage.VERTEX, mesh.words, owned) : undefined,
        indices: mesh.indices.length ? filled(device, GPUBufferUsage.INDEX, mesh.indices, owned) : undefined,
        count: mesh.indices.length ? mesh.indices.length / 4 : mesh.vertices,
    }));
    for (let view = 0; view < drawing.views.length; view++) {
        const encoder = device.createCommandEncoder();
        const colours = Array.from({ length: drawing.targets }, () => target(device, drawing, "rgba32uint", owned));
        const depth = drawing.depthTest ? target(device, drawing, "depth32float", owned) : undefined;
        const pass = encoder.beginRenderPass({
            colorAttachments: colours.map((texture) => ({
                view: texture.createView(), loadOp: "clear" as const, storeOp: "store" as const,
                clearValue: [SENTINEL, SENTINEL, SENTINEL, SENTINEL],
            })),
            depthStencilAttachment: depth && {
                view: depth.createView(), depthLoadOp: "clear", depthStoreOp: "store", depthClearValue: 1,
            },
        });
        pass.setPipeline(pipeline);
        meshes.forEach((mesh, index) => {
            const given = buffers(drawing, view, index);
            for (const [group, entries] of groups(used)) {
                const resource = (place: string): GPUBindingResource => {
                    const bytes = given.get(place);
                    if (bytes) return { buffer: filled(device, GPUBufferUsage.UNIFORM, bytes, owned) };
                    return textures.get(place) ?? samplers.get(place) ?? missing(place);
                };
                pass.setBindGroup(group, device.createBindGroup({
                    layout: pipeline.getBindGroupLayout(group),
                    entries: entries.map((binding) => ({ binding, resource: resource(`${group},${binding}`) })),
                }));
            }
            if (mesh.vertices) pass.setVertexBuffer(0, mesh.vertices);
            if (mesh.indices) {
                pass.setIndexBuffer(mesh.indices, "uint32");
                pass.drawIndexed(mesh.count);
            } else {
                pass.draw(mesh.count);
            }
        });
        pass.end();
        const copies = colours.map((texture) => copied(device, encoder, texture, width, height, 16, owned));
        const depthCopy = depth && drawing.keepDepth
            ? copied(device, encoder, depth, width, height, 4, owned) : undefined;
        device.queue.submit([encoder.finish()]);
        for (const copy of copies) reads.push(read(copy, width, height, 16));
        if (depthCopy) depthReads.push(read(depthCopy, width, height, 4));
    }
    const wrong = device.popErrorScope();
    const drawn = Promise.all([Promise.all(reads), Promise.all(depthReads)]);
    drawn.catch(() => {});
    const refused = await wrong;
    if (refused) throw new Error(`WebGPU refuses the drawing: ${refused.message}`);
    const [words, depths] = await drawn.then((all) => all.map(joined));
    spent.drawing += performance.now() - compiled;
    return { words: new Uint32Array(words), depths: new Float32Array(depths) };
}

function missing(place: string): never {
    throw new Error(`nothing is given for the binding ${place}`);
}

/** The texture of a place: that of the drawing before, if it has the same texels. */
function uploaded(kept: Kept, place: string, given: TextureInfo): GPUTexture {
    const known = kept.textures.get(place);
    const isKnown = known && known.given.cube === given.cube && known.given.depth === given.depth
        && known.given.levels.length === given.levels.length
        && known.given.levels.every(({ width, bytes }, index) =>
            width === given.levels[index].width && same(bytes, given.levels[index].bytes));
    if (isKnown) return known.made;
    known?.made.destroy();
    const made = given.depth ? stored(kept, given) : coloured(kept, given);
    kept.textures.set(place, { given, made });
    return made;
}

function prepared({ device, pipelines }: Kept, drawing: Drawing) {
    const { vertex, fragment, depthTest, cull, mirrored, offset, meshes } = drawing;
    const attributes = meshes[0]?.attributes ?? [];
    const key = JSON.stringify([
        vertex.text, fragment?.text, depthTest, cull, mirrored, offset, attributes, drawing.targets,
    ]);
    const known = pipelines.get(key);
    if (known) return known;
    if (pipelines.size > 64) pipelines.clear();
    const modules = [vertex, ...(fragment ? [fragment] : [])].map(({ text }) => ({ text, module: device.createShaderModule({ code: text }) }));
    const made = device.createRenderPipelineAsync({
        layout: "auto",
        vertex: {
            module: modules[0].module,
            entryPoint: vertex.native.entry_name,
            buffers: attributes.length ? [{
                arrayStride: meshes[0].stride,
                attributes: attributes.map(({ location, format, offset }) => ({
                    shaderLocation: location, format: format as GPUVertexFormat, offset,
                })),
            }] : [],
        },
        fragment: fragment && {
            module: modules[1].module,
            entryPoint: fragment.native.entry_name,
            targets: Array.from({ length: drawing.targets }, () => ({ format: "rgba32uint" as const })),
        },
        primitive: { frontFace: mirrored ? "cw" : "ccw", cullMode: cull as GPUCullMode },
        depthStencil: depthTest ? {
            format: "depth32float", depthWriteEnabled: true, depthCompare: "less",
            depthBias: Math.trunc(offset[1]), depthBiasSlopeScale: offset[0],
        } : undefined,
    }).catch(async (error) => { throw await refusal(modules) ?? error; });
    pipelines.set(key, made);
    made.catch(() => pipelines.delete(key));
    return made;
}

/** What the browser says of texts that it refuses. */
async function refusal(modules: { text: string; module: GPUShaderModule }[]): Promise<RefusedText | undefined> {
    for (const { text, module } of modules) {
        const { messages } = await module.getCompilationInfo();
        const found = messages.find(({ type }) => type === "error");
        if (found) return new RefusedText(found.message, text.split("\n")[found.lineNum - 1] ?? "");
    }
    return undefined;
}

function bindings(drawing: Drawing): Set<string> {
    const stages = [drawing.vertex, ...(drawing.fragment ? [drawing.fragment] : [])];
    return new Set(stages.flatMap((stage) => stage.reflection.bindings.map((one) => `${one.group},${one.binding}`)));
}

function groups(used: Set<string>): Map<number, number[]> {
    const found = new Map<number, number[]>();
    for (const place of used) {
        const [group, binding] = place.split(",").map(Number);
        found.set(group, [...(found.get(group) ?? []), binding]);
    }
    return found;
}

function filled(device: GPUDevice, usage: number, bytes: Uint8Array, owned: { destroy(): void }[]): GPUBuffer {
    const size = Math.max(16, Math.ceil(bytes.length / 4) * 4);
    const buffer = device.createBuffer({ size, usage: usage | GPUBufferUsage.COPY_DST });
    device.queue.writeBuffer(buffer, 0, bytes.slice());
    owned.push(buffer);
    return buffer;
}

function target(device: GPUDevice, { width, height }: Drawing, format: GPUTextureFormat, owned: { destroy(): void }[]) {
    const usage = GPUTextureUsage.RENDER_ATTACHMENT | GPUTextureUsage.COPY_SRC;
    const texture = device.createTexture({ size: [width, height], format, usage });
    owned.push(texture);
    return texture;
}

const row = (width: number, texel: number) => Math.ceil((width * texel) / 256) * 256;

function copied(
    device: GPUDevice, encoder: GPUCommandEncoder, texture: GPUTexture,
    width: number, height: number, texel: number, owned: { destroy(): void }[],
): GPUBuffer {
    const size = row(width, texel) * height;
    const buffer = device.createBuffer({ size, usage: GPUBufferUsage.COPY_DST | GPUBufferUsage.MAP_READ });
    encoder.copyTextureToBuffer({ texture }, { buffer, bytesPerRow: row(width, texel) }, [width, height]);
    owned.push(buffer);
    return buffer;
}

/** The texels without what pads the rows. */
async function read(buffer: GPUBuffer, width: number, height: number, texel: number): Promise<ArrayBuffer> {
    await buffer.mapAsync(GPUMapMode.READ);
    const all = new Uint8Array(buffer.getMappedRange());
    const found = new Uint8Array(width * height * texel);
    for (let y = 0; y < height; y++) {
        const start = y * row(width, texel);
        found.set(all.subarray(start, start + width * texel), y * width * texel);
    }
    return found.buffer;
}

function joined(parts: ArrayBuffer[]): ArrayBuffer {
    const all = new Uint8Array(parts.reduce((sum, part) => sum + part.byteLength, 0));
    let at = 0;
    for (const part of parts) {
        all.set(new Uint8Array(part), at);
        at += part.byteLength;
    }
    return all.buffer;
}

function coloured({ device, filters }: Kept, texture: TextureInfo): GPUTexture {
    const layers = texture.cube ? 6 : 1;
    const [{ width, height }] = texture.levels;
    const made = device.createTexture({
        size: [width, height, layers], mipLevelCount: texture.levels.length,
        format: filters ? "rgba32float" : "rgba16float",
        usage: GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.COPY_DST,
    });
    texture.levels.forEach((level, mipLevel) => {
        const texels = floats(level.bytes);
        const data = filters ? texels.slice() : Uint16Array.from(texels, half);
        const bytesPerRow = level.width * (filters ? 16 : 8);
        device.queue.writeTexture(
            { texture: made, mipLevel }, data, { bytesPerRow, rowsPerImage: level.height },
            [level.width, level.height, layers],
        );
    });
    return made;
}

function deepened(device: GPUDevice): GPURenderPipeline {
    const module = device.createShaderModule({ code: DEPTH });
    const layout = device.createBindGroupLayout({
        entries: [{ binding: 0, visibility: GPUShaderStage.FRAGMENT, texture: { sampleType: "unfilterable-float" } }],
    });
    return device.createRenderPipeline({
        layout: device.createPipelineLayout({ bindGroupLayouts: [layout] }),
        vertex: { module, entryPoint: "triangle" },
        fragment: { module, entryPoint: "depth", targets: [] },
        depthStencil: { format: "depth32float", depthWriteEnabled: true, depthCompare: "always" },
    });
}

function stored(kept: Kept, texture: TextureInfo): GPUTexture {
    const { device } = kept;
    const pipeline = kept.deep ??= deepened(device);
    const layers = texture.cube ? 6 : 1;
    const [{ width, height, bytes }] = texture.levels;
    const made = device.createTexture({
        size: [width, height, layers], format: "depth32float",
        usage: GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.RENDER_ATTACHMENT,
    });
    const layout = pipeline.getBindGroupLayout(0);
    for (let layer = 0; layer < layers; layer++) {
        const source = device.createTexture({
            size: [width, height], format: "r32float",
            usage: GPUTextureUsage.TEXTURE_BINDING | GPUTextureUsage.COPY_DST,
        });
        const texels = bytes.slice(4 * width * height * layer, 4 * width * height * (layer + 1));
        device.queue.writeTexture({ texture: source }, texels, { bytesPerRow: 4 * width }, [width, height]);
        const encoder = device.createCommandEncoder();
        const pass = encoder.beginRenderPass({
            colorAttachments: [],
            depthStencilAttachment: {
                view: made.createView({ dimension: "2d", baseArrayLayer: layer, arrayLayerCount: 1 }),
                depthLoadOp: "clear", depthStoreOp: "store", depthClearValue: 1,
            },
        });
        pass.setPipeline(pipeline);
        pass.setBindGroup(0, device.createBindGroup({ layout, entries: [{ binding: 0, resource: source.createView() }] }));
        pass.draw(3);
        pass.end();
        device.queue.submit([encoder.finish()]);
        source.destroy();
    }
    return made;
}

function sampler({ device, samplers }: Kept, one: SamplerInfo): GPUSampler {
    const key = JSON.stringify([one.linear, one.address, one.compare]);
    const made = samplers.get(key) ?? device.createSampler(settings(one));
    samplers.set(key, made);
    return made;
}

function settings(one: SamplerInfo): GPUSamplerDescriptor {
    const filter: GPUFilterMode = one.linear ? "linear" : "nearest";
    const address = one.address as GPUAddressMode;
    return {
        addressModeU: address, addressModeV: address, addressModeW: address,
        magFilter: filter, minFilter: filter,
        mipmapFilter: one.linear && !one.compare ? "linear" : "nearest",
        compare: one.compare as GPUCompareFunction | undefined,
    };
}
