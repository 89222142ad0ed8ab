// A fragment stage around a function of the library, so that it can be seen on a model.
import type { ItemInfo } from "@lamplight/toolchain";

/** What a parameter can be given, by its type: an expression of the stage below. */
const SOURCES: Record<string, Record<string, string>> = {
    f32: {
        "n · l": "max(dot(n, l), 0.0)", "n · v": "max(dot(n, v), 0.0)", "n · h": "max(dot(n, h), 0.0)",
        "l · h": "max(dot(l, h), 0.0)", "|n × h|²": "dot(cross(n, h), cross(n, h))",
        "distance of the light": "length(to_light)", "u": "uv.x", "v": "uv.y",
    },
    vec3f: {
        "n": "n", "l": "l", "v": "v", "h": "h", "reflected v": "reflect(-v, n)", "position": "position",
    },
    vec2f: { "uv": "uv" },
};

/** What a parameter can be given beside a texture. The ground in the map of depths, which sketches
 * have, is at 0.6, and what casts a shadow is nearer. */
const TEXTURED: typeof SOURCES = {
    ShadowUv: { "place in the map": "ShadowUv(uv, 0.595, true)" },
    f32: { "depth of the ground": "0.595" },
    vec2f: { "pixel": "floor(uv * 144.0)" },
    vec4f: { "place in the map": "vec4f(uv.x * 2.0 - 1.0, 1.0 - uv.y * 2.0, 0.595, 1.0)" },
};

/** Names of parameters by the library's conventions, with the source that they mean. */
const MEANT: Record<string, string> = {
    nl: "n · l", n_dot_l: "n · l", nv: "n · v", n_dot_v: "n · v", nh: "n · h", n_dot_h: "n · h", lh: "l · h", n_cross_h2: "|n × h|²",
    vh: "l · h", cos_theta: "n · l", n: "n", l: "l", v: "v", h: "h", r: "reflected v", p: "position",
    uv: "uv", dir: "n", normal: "n", x: "u",
};

/** The same beside a texture. */
const MEANT_TEXTURED: Record<string, string> = {
    at: "place in the map", sc: "place in the map", depth: "depth of the ground", pixel: "pixel", offset: "position",
};

/** What a texture or a sampler is given. */
const BOUND = "of the playground";
const TEXTURE = /^(texture_2d<f32>|texture_cube<f32>|texture_depth_2d|texture_depth_cube|sampler|sampler_comparison)$/;

/** A parameter that is a number of its own. */
export const OWN_NUMBER = "a number";

export type Parameter = { name: string; type: string; sources: string[]; source: string };

const DRAWN = /^(f32|u32|i32|bool|vec[234][fiu])$/;

/** The parameters of a function, or why it cannot be drawn. */
export function parameters(item: ItemInfo, structs: Map<string, ItemInfo>): Parameter[] | string {
    if (item.kind !== "function") return "Only functions are drawn.";
    const refused = item.members.find(({ type }) => /texture|sampler|ptr</.test(type) && !TEXTURE.test(type));
    if (refused) return `The parameter ${refused.name} is a ${refused.type.split("<")[0]}, which comes from a scene: see the programs that use the function.`;
    const isTextured = item.members.some(({ type }) => TEXTURE.test(type));
    const meant = isTextured ? { ...MEANT, ...MEANT_TEXTURED } : MEANT;
    if (!shownResult(item, structs)) return `A result of type ${item.result} is no colour.`;
    return item.members.map(({ name, type }) => {
        if (TEXTURE.test(type)) return { name, type, sources: [BOUND], source: BOUND };
        const sources = Object.keys({ ...SOURCES[type], ...(isTextured ? TEXTURED[type] : {}) });
        const source = sources.includes(meant[name]) ? meant[name] : OWN_NUMBER;
        return { name, type, sources: [...sources, OWN_NUMBER], source };
    });
}

/** The result as a colour. */
function shownResult(item: ItemInfo, structs: Map<string, ItemInfo>): string | undefined {
    const colour = (type: string, value: string): string | undefined => {
        if (!DRAWN.test(type)) return undefined;
        if (type === "vec3f") return value;
        if (type === "vec4f") return `${value}.xyz`;
        if (type === "vec2f") return `vec3f(${value}, 0.0)`;
        if (type === "f32") return `vec3f(${value})`;
        if (type.startsWith("vec")) return undefined;
        return `vec3f(f32(${value}))`;
    };
    const type = item.result ?? "";
    const member = structs.get(type)?.members.find((one) => colour(one.type, ""));
    return member ? colour(member.type, `value.${member.name}`) : colour(type, "value");
}

/** The stage, as an author would write it. */
export function stage(item: ItemInfo, chosen: Parameter[], structs: Map<string, ItemInfo>): string {
    const own = chosen.filter((one) => one.source === OWN_NUMBER);
    const types = [...new Set(chosen.map((one) => one.type).filter((type) => structs.has(type)))];
    const bound = chosen.filter((one) => one.source === BOUND).map(({ name, type }, index) =>
        `@group(0) @binding(${index + 1}) var ${name}: ${type};`);
    const stored = (type: string) => (type === "bool" ? "u32" : type);
    const knobs = own.length ? [
        "struct Knobs {", ...own.map((one) => `    ${one.name}: ${stored(one.type)},`), "}",
        "@group(0) @binding(0) var<uniform> knobs: Knobs;", "",
    ] : [];
    const given = ({ name, type, source }: Parameter) =>
        source === BOUND ? name : source !== OWN_NUMBER ? { ...TEXTURED[type], ...SOURCES[type] }[source]
            : type === "bool" ? `knobs.${name} != 0u` : `knobs.${name}`;
    return [
        item.import, ...types.map((type) => structs.get(type)!.import), "", ...knobs, ...bound,
        "@fragment", "fn fs_main(",
        "    @location(0) position: vec3f,", "    @location(1) normal: vec3f,", "    @location(2) to_light: vec3f,",
        "    @location(3) to_eye: vec3f,", "    @location(4) uv: vec2f,", ") -> @location(0) vec4f {",
        "    let n = normalize(normal);", "    let l = normalize(to_light);", "    let v = normalize(to_eye);",
        "    let h = normalize(l + v);",
        `    let value = ${item.name}(${chosen.map(given).join(", ")});`,
        `    return vec4f(${shownResult(item, structs)}, 1.0);`, "}", "",
    ].join("\n");
}
