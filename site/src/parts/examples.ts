// Shaders to begin with. Each is a file, or two, of the folder `examples`.
import type { Look } from "./sketch";

type Files = Record<string, string>;
export type Example = { name: string; files: Files; look?: Look };

const TEXTS = import.meta.glob<string>("../../examples/*", { query: "?raw", import: "default", eager: true });

/** An example of the files with these names, of which the first is open. */
const example = (name: string, files: string[], look?: Look): Example =>
    ({ name, files: Object.fromEntries(files.map((file) => [file, TEXTS[`../../examples/${file}`]])), look });

export const EXAMPLES: { title: string; examples: Example[] }[] = [
    { title: "First light", examples: [
        example("Lambert", ["lambert.wesl"]), example("Highlights", ["highlights.wesl"]), example("Normals as colours", ["normals.wesl"], { model: "vase" }),
        example("Sky and ground", ["hemisphere.wesl"], { model: "torus" }), example("Toon", ["toon.wesl"], { model: "torus" }),
    ] },
    { title: "Materials", examples: [
        example("A lit glTF material", ["gltf.wesl"]), example("Metal", ["metal.wesl"], { model: "vase", uniforms: { "metal.metal_color": [1, 0.71, 0.29] } }),
        example("Car paint", ["coat.wesl"], { uniforms: { "paint.base_color": [0.55, 0.02, 0.03], "paint.roughness": [0.5], "paint.coat_strength": [1] } }),
        example("Velvet", ["velvet.wesl"], { model: "vase", uniforms: { "cloth.base_color": [0.3, 0.02, 0.08], "cloth.sheen_color": [0.9, 0.25, 0.4] } }),
        example("Soap film", ["soap.wesl"]), example("Clay", ["oren_nayar.wesl"]), example("Bumps by a formula", ["bumps.wesl"]),
        example("Texture from three sides", ["triplanar.wesl"], { model: "vase" }),
    ] },
    { title: "Light and air", examples: [
        example("Swinging spot light", ["spot.wesl"], { model: "spheres" }), example("Fog", ["fog.wesl"], { model: "street" }),
        example("Water with a vertex stage", ["water.wesl"], { model: "plane" }),
    ] },
    { title: "Whole pictures", examples: [example("Evening sky", ["sky.wesl"]), example("Tone curves", ["curves.wesl"])] },
    { title: "GLSL", examples: [
        example("Highlights in GLSL", ["lambert.frag.glsl"]), example("Toon in GLSL", ["toon.frag.glsl"], { model: "torus" }),
        example("A lit glTF material in GLSL", ["gltf.frag.glsl"]), example("OpenGL 3.3 with a vertex stage", ["twist.frag.glsl", "twist.vert.glsl"], { model: "cube" }),
        example("Plasma", ["plasma.frag.glsl"]),
    ] },
];
