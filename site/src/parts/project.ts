// The files of the playground, and where they are kept: in the link and in the browser.
import { packed, unpacked } from "../pack";
import type { Look } from "./sketch";

export type Project = {
    files: Record<string, string>; open: string; target: string; expression: string; look: Look;
};

export const FIRST: Project = {
    files: {
        "lit.wesl": `import lamplight::brdf::diffuse::lambert;
import lamplight::brdf::specular::blinn_phong;
import package::lamp::falloff;

@fragment
fn fs_main(@location(0) normal: vec3f, @location(1) to_light: vec3f) -> @location(0) vec4f {
    let n = normalize(normal);
    let l = normalize(to_light);
    let light = lambert(n, l) + blinn_phong(n, l, vec3f(0.0, 0.0, 1.0), 32.0);
    return vec4f(vec3f(light * falloff(length(to_light))), 1.0);
}
`,
        "lamp.wesl": `import lamplight::lighting::attenuation::inverse_square;

fn falloff(distance: f32) -> f32 {
    return inverse_square(distance * distance, 0.01);
}
`,
        "lit.frag.glsl": `#version 450
#include <lamplight/brdf/diffuse.glsl>

layout(location = 0) in vec3 normal;
layout(location = 0) out vec4 color;

void main() {
    color = vec4(lambert(normalize(normal), vec3(0.0, 1.0, 0.0)));
}
`,
    },
    open: "lit.wesl", target: "wgsl", expression: "package::lamp::falloff(2.0)", look: {},
};

/** What somebody typed last, and what was there before links replaced it: the latest first. */
const [KEPT, EARLIER] = ["lamplight-playground", "lamplight-playground-earlier"];

/** How many projects are there from before a link. */
const MOST_EARLIER = 4;

/** Characters of a link that browsers and servers still take. */
const LONGEST = 60000;

/** A project, whatever a link has. */
function sound(found: unknown): Project {
    const given = (typeof found === "object" && found !== null ? found : {}) as Partial<Record<keyof Project, unknown>>;
    const files = Object.fromEntries(Object.entries(given.files ?? {}).filter(([, text]) => typeof text === "string"));
    const names = Object.keys(files);
    if (!names.length) return structuredClone(FIRST);
    const text = (key: "open" | "target" | "expression") => (typeof given[key] === "string" ? given[key] as string : FIRST[key]);
    const look = (typeof given.look === "object" && given.look !== null ? given.look : {}) as Look;
    const open = names.includes(text("open")) ? text("open") : names[0];
    return { files, open, target: text("target"), expression: text("expression"), look };
}

function parsed(text: string | null): { project: Project; visit: string } | undefined {
    try {
        const found = JSON.parse(text ?? "");
        return { project: sound(found.project ?? found), visit: String(found.visit) };
    } catch {
        return undefined;
    }
}

/** The visit that the present entry of the browser's history belongs to. A reload goes on with it,
 * even one that began before the address followed what was typed. A link begins another. */
function visit(): string {
    const known: unknown = history.state?.visit;
    if (typeof known === "string") return known;
    // `crypto.randomUUID` is only there in secure contexts.
    const made = `${Date.now()}-${Math.random()}`;
    history.replaceState({ visit: made }, "");
    return made;
}

/** What the browser keeps; nothing where it keeps nothing. */
function stored(key: string): string | null {
    try {
        return localStorage.getItem(key);
    } catch {
        return null;
    }
}

/** Keeps a project with the visit that it belongs to. False if the browser has no room. */
export function keep(project: Project): boolean {
    try {
        localStorage.setItem(KEPT, JSON.stringify({ project, visit: visit() }));
        return true;
    } catch {
        return false;
    }
}

/** The project of the link. If that was typed into in this visit, what was typed; without a link, what
 * was typed last. */
export async function opened(link: string | null): Promise<Project> {
    const text = stored(KEPT);
    const kept = parsed(text);
    if (kept && (!link || kept.visit === visit())) return kept.project;
    if (!link) return structuredClone(FIRST);
    let project: Project;
    try {
        project = sound(JSON.parse(await unpacked(link)));
    } catch {
        // A link that was cut short opens what was typed last.
        return kept?.project ?? structuredClone(FIRST);
    }
    if (text) keepEarlier(text);
    return project;
}

function earlierTexts(): string[] {
    const text = stored(EARLIER);
    try {
        const found: unknown = JSON.parse(text ?? "[]");
        // Older versions kept one project.
        return Array.isArray(found) ? found.filter((one) => typeof one === "string") : [text ?? ""];
    } catch {
        return [];
    }
}

/** The user's own files stay within reach, even if several links are opened and typed into. */
function keepEarlier(text: string) {
    const all = [text, ...earlierTexts().filter((one) => one !== text)].slice(0, MOST_EARLIER);
    try {
        localStorage.setItem(EARLIER, JSON.stringify(all));
    } catch {
        // Without room for them, what was typed last is still there until somebody types again.
    }
}

/** What was typed before links were opened, the latest first. */
export const earlier = (): Project[] =>
    earlierTexts().flatMap((text) => parsed(text)?.project ?? []);

/** The project as a part of a link; nothing if it is too large for one. */
export async function linked(project: Project): Promise<string | undefined> {
    const text = await packed(JSON.stringify(project));
    return text.length > LONGEST ? undefined : text;
}
