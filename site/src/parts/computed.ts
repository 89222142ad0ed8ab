// Curves of a function as the GPU of the page computes them.
import type { CurveResult, Drawing, ShaderResult } from "@lamplight/toolchain";
import { OWN, toolchain } from "../client";
import { drawn } from "../draw";

/** What the GPU gave: a row for each curve. */
export type Computed = { name: string; rows: number[][] };

/** Each pixel of a frame is a value: the column says the input, the row says the curve. */
const stages = (module: string, columns: number, rows: number) => `${module}
struct LamplightRequest {
    inputs: array<vec4f, ${Math.ceil(columns / 4)}>,
    values: array<vec4f, ${Math.ceil(rows / 4)}>,
}
@group(0) @binding(0) var<uniform> lamplight_request: LamplightRequest;

@vertex
fn vs_main(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = vec2u((index << 1u) & 2u, index & 2u);
    return vec4f(vec2f(corner) * 2.0 - 1.0, 0.0, 1.0);
}

@fragment
fn fs_main(@builtin(position) place: vec4f) -> @location(0) vec4u {
    let at = vec2u(place.xy);
    let x = lamplight_request.inputs[at.x / 4u][at.x % 4u];
    let value = lamplight_request.values[at.y / 4u][at.y % 4u];
    return vec4u(bitcast<u32>(lamplight_plot(x, value)), at, 0u);
}
`;

const padded = (numbers: number[]) => [...numbers, ...Array<number>(3 - ((numbers.length + 3) % 4)).fill(0)];

/** The stages of the last plot: its sliders ask for the same ones again. */
let known: { key: string; made: Promise<ShaderResult> } | undefined;

/** The values of curves, from the same inputs. `undefined` where the page has no GPU. */
export async function computed({ module, inputs, curves }: CurveResult): Promise<Computed | undefined> {
    const [width, height] = [inputs.length, curves.length];
    const found = await drawn(async (target) => {
        const key = `${target} ${width} ${height} ${module}`;
        if (known?.key !== key) {
            const files = { "plot.wesl": stages(module!, width, height) };
            const made = toolchain.call(OWN, "compile", { files, root: "plot.wesl", targets: [target] });
            known = { key, made };
            // What failed is asked for again.
            made.catch(() => { if (known?.made === made) known = undefined; });
        }
        const numbers = [...padded(inputs), ...padded(curves.map((curve) => curve.parameter))];
        return drawing(await known.made, width, height, new Uint8Array(new Float32Array(numbers).buffer));
    });
    if (!found) return undefined;
    const rows = curves.map(() => Array<number>(width).fill(NaN));
    const values = new Float32Array(found.frames.words.buffer);
    for (let pixel = 0; pixel < width * height; pixel++) {
        const [x, y] = found.frames.words.subarray(4 * pixel + 1, 4 * pixel + 3);
        if (y < height && x < width) rows[y][x] = values[4 * pixel];
    }
    return { name: found.name, rows };
}

function drawing(made: ShaderResult, width: number, height: number, bytes: Uint8Array): Drawing {
    if (!made.ok) throw new Error(made.diagnostics[0]?.message ?? "the function cannot be run");
    const stage = (name: string) => {
        const { reflection, outputs: [{ text, native }] } = made.entries.find((entry) => entry.stage === name)!;
        return { text: text!, native, reflection };
    };
    const none = new Uint8Array();
    return {
        vertex: stage("vertex"), fragment: stage("fragment"), targets: 1, width, height,
        meshes: [{ attributes: [], stride: 0, vertices: 3, words: none, indices: none, buffers: [] }],
        views: [[]], buffers: [{ group: 0, binding: 0, bytes }], textures: [], samplers: [],
        depthTest: false, keepDepth: false, cull: "none", mirrored: false, offset: [0, 0],
    };
}
