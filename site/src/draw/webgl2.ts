// Drawings on WebGL2.
import type { Drawing, SamplerInfo, Stage, TextureInfo } from "@lamplight/toolchain";
import { type Device, type Frames, RefusedText, SENTINEL, buffers, floats, spent } from "./common";

type Slot = { group: number; binding: number; index?: number; name?: string };
type Combined = { texture: [number, number]; sampler?: [number, number]; name: string };

const NOTHING = "#version 300 es\nvoid main() {}\n";

/** Depth cannot be read back: it is drawn as words. */
const TRIANGLE = `#version 300 es
void main() {
    vec2 corner = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2);
    gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
}`;
const DEPTH = `#version 300 es
precision highp float;
uniform highp sampler2D stored;
out highp uvec4 words;
void main() {
    words = uvec4(floatBitsToUint(texelFetch(stored, ivec2(gl_FragCoord.xy), 0).x));
}`;

export async function open(): Promise<Device | undefined> {
    const gl = document.createElement("canvas").getContext("webgl2");
    if (!gl) return undefined;
    gl.getExtension("EXT_color_buffer_float");
    gl.getExtension("OES_texture_float_linear");
    const programs = new Map<string, WebGLProgram>();
    return { name: "WebGL2", target: "essl300", draw: async (drawing) => draw(gl, programs, drawing), isLost: () => gl.isContextLost() };
}

function draw(gl: WebGL2RenderingContext, programs: Map<string, WebGLProgram>, drawing: Drawing): Frames {
    const { width, height, vertex, fragment } = drawing;
    const begun = performance.now();
    const program = linked(gl, programs, vertex.text, fragment?.text ?? NOTHING);
    const compiled = performance.now();
    spent.compiling += compiled - begun;
    const stages = [vertex, ...(fragment ? [fragment] : [])];
    const blocks = boundBlocks(gl, program, stages);
    const owned: (() => void)[] = [];
    const units = boundUnits(gl, program, stages, drawing, owned);
    const pixels = width * height;
    const words = new Uint32Array(4 * pixels * drawing.targets * drawing.views.length);
    const depths = new Float32Array(drawing.keepDepth ? pixels * drawing.views.length : 0);
    for (let view = 0; view < drawing.views.length; view++) {
        const frame = framebuffer(gl, drawing, owned);
        states(gl, drawing);
        gl.useProgram(program);
        for (const [unit, place, texture, sampler] of units) {
            gl.activeTexture(gl.TEXTURE0 + unit);
            gl.bindTexture(place, texture);
            gl.bindSampler(unit, sampler);
        }
        for (let mesh = 0; mesh < drawing.meshes.length; mesh++) {
            drawMesh(gl, drawing, view, mesh, blocks, owned);
        }
        for (let index = 0; index < drawing.targets; index++) {
            gl.readBuffer(gl.COLOR_ATTACHMENT0 + index);
            const start = 4 * pixels * (view * drawing.targets + index);
            gl.readPixels(0, 0, width, height, gl.RGBA_INTEGER, gl.UNSIGNED_INT, words.subarray(start, start + 4 * pixels));
        }
        if (drawing.keepDepth && frame.depth) {
            depths.set(readDepth(gl, programs, frame.depth, width, height, owned), view * pixels);
        }
    }
    for (const [unit] of units) gl.bindSampler(unit, null);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    owned.forEach((free) => free());
    const error = gl.getError();
    if (error !== gl.NO_ERROR) throw new Error(`WebGL2 reports error 0x${error.toString(16)}`);
    spent.drawing += performance.now() - compiled;
    return { words, depths };
}

function linked(gl: WebGL2RenderingContext, programs: Map<string, WebGLProgram>, vertex: string, fragment: string) {
    const key = `${vertex}\0${fragment}`;
    const known = programs.get(key);
    if (known) return known;
    if (programs.size > 64) {
        programs.forEach((program) => gl.deleteProgram(program));
        programs.clear();
    }
    const program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]] as const) {
        const shader = gl.createShader(kind)!;
        gl.shaderSource(shader, text);
        gl.compileShader(shader);
        if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw refusal(gl.getShaderInfoLog(shader) ?? "", text);
        gl.attachShader(program, shader);
        gl.deleteShader(shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program) ?? "");
    programs.set(key, program);
    return program;
}

/** What the browser says of a text that it refuses: `ERROR: 0:12: 'x' : undeclared identifier`. */
function refusal(log: string, text: string): RefusedText {
    const [, line, message] = /^ERROR: \d+:(\d+): (.*)/m.exec(log) ?? [];
    return new RefusedText(message ?? log, text.split("\n")[Number(line) - 1] ?? "");
}

function boundBlocks(gl: WebGL2RenderingContext, program: WebGLProgram, stages: Stage[]): Map<string, number> {
    const blocks = new Map<string, number>();
    for (const stage of stages) {
        for (const binding of stage.reflection.bindings.filter((one) => one.kind === "uniform")) {
            const place = `${binding.group},${binding.binding}`;
            const number = blocks.get(place) ?? blocks.size;
            blocks.set(place, number);
            const slot = (stage.native.slots as Slot[]).find((one) => `${one.group},${one.binding}` === place);
            const index = slot?.name ? gl.getUniformBlockIndex(program, slot.name) : gl.INVALID_INDEX;
            if (index !== gl.INVALID_INDEX) gl.uniformBlockBinding(program, index, number);
        }
    }
    return blocks;
}

type Unit = [number, GLenum, WebGLTexture, WebGLSampler | null];

function boundUnits(
    gl: WebGL2RenderingContext, program: WebGLProgram, stages: Stage[], drawing: Drawing, owned: (() => void)[],
): Unit[] {
    const units: Unit[] = [];
    gl.useProgram(program);
    for (const combined of stages.flatMap((stage) => (stage.native.combined ?? []) as Combined[])) {
        const at = ([group, binding]: [number, number]) => (one: { group: number; binding: number }) =>
            one.group === group && one.binding === binding;
        const texture = drawing.textures.find(at(combined.texture));
        if (!texture) throw new Error(`${combined.name} has no texture`);
        const sampler = combined.sampler && drawing.samplers.find(at(combined.sampler));
        const unit = units.length;
        gl.activeTexture(gl.TEXTURE0 + unit);
        const made = uploaded(gl, texture);
        const sampling = sampler ? sampled(gl, sampler, texture.levels.length > 1) : null;
        owned.push(() => { gl.deleteTexture(made); gl.deleteSampler(sampling); });
        units.push([unit, texture.cube ? gl.TEXTURE_CUBE_MAP : gl.TEXTURE_2D, made, sampling]);
        gl.uniform1i(gl.getUniformLocation(program, combined.name), unit);
    }
    return units;
}

function uploaded(gl: WebGL2RenderingContext, texture: TextureInfo): WebGLTexture {
    const made = gl.createTexture();
    const of = texture.cube ? gl.TEXTURE_CUBE_MAP : gl.TEXTURE_2D;
    const [internal, format] = texture.depth
        ? [gl.DEPTH_COMPONENT32F, gl.DEPTH_COMPONENT] : [gl.RGBA32F, gl.RGBA];
    gl.bindTexture(of, made);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    const layers = texture.cube ? 6 : 1;
    texture.levels.forEach((level, index) => {
        const texels = floats(level.bytes);
        const size = texels.length / layers;
        for (let layer = 0; layer < layers; layer++) {
            const face = texture.cube ? gl.TEXTURE_CUBE_MAP_POSITIVE_X + layer : gl.TEXTURE_2D;
            gl.texImage2D(
                face, index, internal, level.width, level.height, 0, format, gl.FLOAT,
                texels.subarray(layer * size, (layer + 1) * size),
            );
        }
    });
    gl.texParameteri(of, gl.TEXTURE_MAX_LEVEL, texture.levels.length - 1);
    gl.texParameteri(of, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(of, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    return made;
}

function sampled(gl: WebGL2RenderingContext, one: SamplerInfo, mipped: boolean): WebGLSampler {
    const made = gl.createSampler();
    const filter = one.linear ? gl.LINEAR : gl.NEAREST;
    const mips = one.linear && !one.compare ? gl.LINEAR_MIPMAP_LINEAR : gl.NEAREST_MIPMAP_NEAREST;
    const address = one.address === "repeat" ? gl.REPEAT
        : one.address === "mirror-repeat" ? gl.MIRRORED_REPEAT : gl.CLAMP_TO_EDGE;
    gl.samplerParameteri(made, gl.TEXTURE_MAG_FILTER, filter);
    gl.samplerParameteri(made, gl.TEXTURE_MIN_FILTER, mipped ? mips : filter);
    for (const axis of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T, gl.TEXTURE_WRAP_R]) {
        gl.samplerParameteri(made, axis, address);
    }
    if (one.compare) {
        const compare = { less: gl.LESS, "less-equal": gl.LEQUAL, greater: gl.GREATER, "greater-equal": gl.GEQUAL };
        gl.samplerParameteri(made, gl.TEXTURE_COMPARE_MODE, gl.COMPARE_REF_TO_TEXTURE);
        gl.samplerParameteri(made, gl.TEXTURE_COMPARE_FUNC, compare[one.compare as keyof typeof compare]);
    }
    return made;
}

function framebuffer(gl: WebGL2RenderingContext, drawing: Drawing, owned: (() => void)[]) {
    const { width, height } = drawing;
    const frame = gl.createFramebuffer();
    owned.push(() => gl.deleteFramebuffer(frame));
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    gl.activeTexture(gl.TEXTURE0 + 15);
    const points = [];
    for (let index = 0; index < drawing.targets; index++) {
        const texture = stored(gl, gl.RGBA32UI, width, height, owned);
        gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0 + index, gl.TEXTURE_2D, texture, 0);
        points.push(gl.COLOR_ATTACHMENT0 + index);
    }
    let depth: WebGLTexture | undefined;
    if (drawing.depthTest) {
        depth = stored(gl, gl.DEPTH_COMPONENT32F, width, height, owned);
        gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, depth, 0);
    }
    gl.drawBuffers(points.length ? points : [gl.NONE]);
    gl.viewport(0, 0, width, height);
    gl.depthMask(true);
    points.forEach((_, index) => {
        gl.clearBufferuiv(gl.COLOR, index, [SENTINEL, SENTINEL, SENTINEL, SENTINEL]);
    });
    if (depth) gl.clearBufferfv(gl.DEPTH, 0, [1]);
    return { depth };
}

function stored(gl: WebGL2RenderingContext, format: GLenum, width: number, height: number, owned: (() => void)[]) {
    const texture = gl.createTexture();
    owned.push(() => gl.deleteTexture(texture));
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, format, width, height);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    return texture;
}

function states(gl: WebGL2RenderingContext, drawing: Drawing) {
    const set = (what: GLenum, on: boolean) => (on ? gl.enable(what) : gl.disable(what));
    const clip = drawing.vertex.native.clip as { front_face?: string } | undefined;
    const turned = clip?.front_face === "reversed";
    gl.disable(gl.BLEND);
    gl.disable(gl.DITHER);
    set(gl.DEPTH_TEST, drawing.depthTest);
    gl.depthFunc(gl.LESS);
    set(gl.CULL_FACE, drawing.cull !== "none");
    gl.cullFace(drawing.cull === "front" ? gl.FRONT : gl.BACK);
    gl.frontFace(turned !== drawing.mirrored ? gl.CW : gl.CCW);
    set(gl.POLYGON_OFFSET_FILL, drawing.offset.some((value) => value !== 0));
    gl.polygonOffset(drawing.offset[0], drawing.offset[1]);
}

function drawMesh(
    gl: WebGL2RenderingContext, drawing: Drawing, view: number, index: number,
    blocks: Map<string, number>, owned: (() => void)[],
) {
    const mesh = drawing.meshes[index];
    const buffer = (of: GLenum, bytes: Uint8Array) => {
        const made = gl.createBuffer();
        owned.push(() => gl.deleteBuffer(made));
        gl.bindBuffer(of, made);
        gl.bufferData(of, bytes, gl.STATIC_DRAW);
        return made;
    };
    const given = buffers(drawing, view, index);
    for (const [place, number] of blocks) {
        const bytes = given.get(place);
        if (!bytes) throw new Error(`nothing is given for the binding ${place}`);
        // std140 rounds the size of a block up, and WebGL draws nothing from a smaller buffer.
        const whole = new Uint8Array(Math.ceil(bytes.length / 16) * 16);
        whole.set(bytes);
        gl.bindBufferBase(gl.UNIFORM_BUFFER, number, buffer(gl.UNIFORM_BUFFER, whole));
    }
    const array = gl.createVertexArray();
    owned.push(() => gl.deleteVertexArray(array));
    gl.bindVertexArray(array);
    if (mesh.words.length) buffer(gl.ARRAY_BUFFER, mesh.words);
    for (const { location, format, offset } of mesh.attributes) {
        gl.enableVertexAttribArray(location);
        if (format === "uint32") gl.vertexAttribIPointer(location, 1, gl.UNSIGNED_INT, mesh.stride, offset);
        else gl.vertexAttribPointer(location, Number(format.split("x")[1] ?? 1), gl.FLOAT, false, mesh.stride, offset);
    }
    if (mesh.indices.length) {
        buffer(gl.ELEMENT_ARRAY_BUFFER, mesh.indices);
        gl.drawElements(gl.TRIANGLES, mesh.indices.length / 4, gl.UNSIGNED_INT, 0);
    } else {
        gl.drawArrays(gl.TRIANGLES, 0, mesh.vertices);
    }
    gl.bindVertexArray(null);
}

function readDepth(
    gl: WebGL2RenderingContext, programs: Map<string, WebGLProgram>, depth: WebGLTexture,
    width: number, height: number, owned: (() => void)[],
): Float32Array {
    const program = linked(gl, programs, TRIANGLE, DEPTH);
    const frame = gl.createFramebuffer();
    owned.push(() => gl.deleteFramebuffer(frame));
    gl.bindFramebuffer(gl.FRAMEBUFFER, frame);
    gl.activeTexture(gl.TEXTURE0 + 15);
    const words = stored(gl, gl.RGBA32UI, width, height, owned);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, words, 0);
    gl.drawBuffers([gl.COLOR_ATTACHMENT0]);
    gl.disable(gl.DEPTH_TEST);
    gl.disable(gl.CULL_FACE);
    gl.bindTexture(gl.TEXTURE_2D, depth);
    gl.bindSampler(15, null);
    gl.useProgram(program);
    gl.uniform1i(gl.getUniformLocation(program, "stored"), 15);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    const read = new Uint32Array(4 * width * height);
    gl.readPixels(0, 0, width, height, gl.RGBA_INTEGER, gl.UNSIGNED_INT, read);
    return new Float32Array(Uint32Array.from({ length: width * height }, (_, index) => read[4 * index]).buffer);
}
