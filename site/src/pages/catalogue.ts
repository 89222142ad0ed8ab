import type { CurveResult, ItemInfo, LibraryInfo } from "@lamplight/toolchain";
import { OWN, toolchain } from "../client";
import { address, choose, code, h, reason, remember, repeated, route, sentence, visit } from "../dom";
import { packed } from "../pack";
import { type Computed, computed } from "../parts/computed";
import { latest } from "../parts/latest";
import { type Parameter, parameters, stage } from "../parts/preview";
import { type Look, Sketch } from "../parts/sketch";
import { colour, plot } from "../plot";

let library: Promise<LibraryInfo> | undefined;

export async function page(into: HTMLElement) {
    library ??= toolchain.call(OWN, "library");
    library.catch(() => { library = undefined; });
    const { modules } = await library;
    const items = new Map(modules.flatMap((module) => module.items.map((item) => [item.path, item])));
    const { path, query } = route();
    const list = h("nav", { class: "list", "aria-label": "Functions" });
    // What the file of the page has of the function stays until it is live.
    const place = document.querySelector<HTMLElement>("main[data-page=catalogue] article.entry") ?? h("article", { class: "entry" });
    const search = h("input", {
        type: "search", placeholder: "word, formula, author, technique", "aria-label": "Search the library",
        value: query.get("q") ?? "", oninput: () => filter(),
    });
    const link = (item: ItemInfo) => h("a", {
        href: address("catalogue", item.path), title: item.summary,
        "aria-current": item.path === place.dataset.path ? "page" : undefined,
        onclick: (event: MouseEvent) => {
            // With such a key, the browser opens it elsewhere.
            if (event.ctrlKey || event.metaKey || event.shiftKey || event.altKey) return;
            event.preventDefault();
            visit(address("catalogue", item.path));
            go(item.path);
        },
    }, item.name);
    let newest = 0;
    async function filter() {
        const now = ++newest;
        const text = search.value.trim();
        remember(into, "catalogue", place.dataset.path ?? "", { q: text });
        if (!text) {
            list.replaceChildren(...modules.filter((module) => module.items.length).map((module) =>
                h("details", { open: module.items.some((item) => item.path === place.dataset.path) },
                    h("summary", {}, module.path), ...module.items.map(link))));
            return;
        }
        const { hits } = await toolchain.call(OWN, "search", text);
        if (now !== newest) return;
        const found = hits.map((hit) => items.get(hit.path)!);
        list.replaceChildren(h("p", { role: "status" }, `${found.length} found`), ...found.map(link));
    }
    /** Opens what somebody chose: they read on there. */
    async function go(path: string) {
        try {
            await open(path, true);
        } catch (error) {
            place.replaceChildren(h("p", { class: "wrong", role: "alert" }, `${path} could not be opened: ${reason(error)}`));
        }
    }
    async function open(path: string, isChosen = false) {
        const item = items.get(path);
        if (!item) return place.replaceChildren(h("h1", {}, "Not found"), h("p", {}, `The library has no ${repeated(path)}.`));
        place.dataset.path = path;
        remember(into, "catalogue", path, { q: search.value.trim() });
        document.title = `${item.name} – Catalogue – Lamplight`;
        for (const one of list.querySelectorAll("a")) {
            if (one.getAttribute("href") === address("catalogue", path)) one.setAttribute("aria-current", "page");
            else one.removeAttribute("aria-current");
        }
        await entry(place, item, items, isChosen);
    }
    // There are many functions to pass for somebody who goes by keys.
    const skip = h("a", {
        class: "skip", href: address("catalogue"),
        onclick: (event: Event) => { event.preventDefault(); place.querySelector("h1")?.focus(); },
    }, "Skip the list");
    into.replaceChildren(h("div", { class: "columns" }, h("aside", {}, search, skip, list), place));
    const first = path || "brdf::specular::d_ggx";
    place.dataset.path = first;
    await filter();
    await open(items.has(first) ? first : path || [...items.keys()][0]);
}

async function entry(place: HTMLElement, item: ItemInfo, items: Map<string, ItemInfo>, isChosen: boolean) {
    const written = await toolchain.call(OWN, "written", item.path);
    const section = (title: string, text: string | undefined) =>
        text ? h("p", {}, h("strong", {}, `${title}: `), ...sentence(text)) : undefined;
    const users = written.usedBy.map((path) => path.replace(/\.wesl$/, "").replaceAll("/", "::"));
    const live = h("section", { class: "live", "aria-label": "Live plot" });
    const seen = h("section", { class: "live", "aria-label": "On a model" });
    const title = h("h1", { tabindex: "-1" }, item.name);
    place.replaceChildren(
        title, h("p", { class: "path" }, item.path),
        ...item.doc.map((text) => h("p", {}, ...sentence(text))),
        live, seen,
        h("h2", {}, "Use it"),
        code(item.import, "import in WESL", "wgsl"), code(item.include, "include in GLSL", "glsl"),
        item.members.length ? h("dl", {}, ...item.members.flatMap((member) => [
            h("dt", {}, h("code", {}, `${member.name}: ${member.type}`)), h("dd", {}, ...sentence(member.doc)),
        ])) : undefined!,
        ...[section("Source", item.source), section("Edges", item.edges), section("Error model", item.errorModel),
            section("Used by", users.join(", "))].filter((one) => one !== undefined),
        h("h2", {}, "WESL"), code(written.wesl, "WESL source", "wgsl"),
        ...(written.glsl ? [h("h2", {}, "GLSL"), code(written.glsl, "GLSL source", "glsl")] : []),
    );
    if (isChosen) {
        title.focus({ preventScroll: true });
        const { top } = title.getBoundingClientRect();
        // On a narrow screen it is below the list.
        if (top < 0 || top > innerHeight / 2) title.scrollIntoView({ block: "start" });
    }
    if (item.kind === "function") preview(seen, item, items);
    if (item.plot) await curves(live, item);
}

/** Milliseconds for which something is in view before the GPU is asked for it: nobody waits for what is
 * passed by. */
const SETTLED = 150;

/** The look is kept from entry to entry. */
const look: Look = {};

/** The function on a model. Each parameter is a number, or something of the surface. */
function preview(place: HTMLElement, item: ItemInfo, items: Map<string, ItemInfo>) {
    const structs = new Map([...items.values()].filter((one) => one.kind === "struct").map((one) => [one.name, one]));
    const chosen = parameters(item, structs);
    place.append(h("h2", {}, "On a model"));
    if (typeof chosen === "string") return place.append(h("p", { class: "note" }, chosen));
    // The plot knows which number shows something.
    const { parameter, values = [] } = item.plot ?? {};
    if (parameter && values.length) look.uniforms = { ...look.uniforms, [`knobs.${parameter}`]: [values[Math.floor(values.length / 2)]] };
    const link = h("a", { href: address("playground") }, "Open in the playground");
    const sketch = new Sketch(() => look, () => {}, false);
    const draw = async () => {
        const files = { "preview.wesl": stage(item, chosen, structs) };
        link.href = address("playground", "", `state=${await packed(JSON.stringify({ files, open: "preview.wesl", look }))}`);
        await sketch.draw({ files, root: "preview.wesl" });
    };
    const source = (parameter: Parameter) => parameter.sources.length > 1 ? [choose(
        `${parameter.name}: ${parameter.type}`, parameter.sources, parameter.source,
        (value) => { parameter.source = value; draw(); },
    )] : [];
    const sources = h("div", { class: "row" }, ...chosen.flatMap(source));
    place.append(sources, sketch.element, link);
    let timer = 0;
    const seen = new IntersectionObserver((entries) => {
        clearTimeout(timer);
        // A busy page gets several changes at once, of which only the last one holds.
        if (!place.isConnected) seen.disconnect();
        else if (entries.at(-1)?.isIntersecting) timer = window.setTimeout(() => { seen.disconnect(); draw(); }, SETTLED);
    });
    seen.observe(sketch.element);
}

/** A value between two of those that have curves, so that the slider's curve is seen beside them. */
function between(values: number[]): number {
    const sorted = [...values].sort((one, other) => one - other);
    const middle = Math.floor(sorted.length / 2);
    return middle ? (sorted[middle - 1] + sorted[middle]) / 2 : sorted[0];
}

/** The plot with its parameters as sliders, and the value at one place in f64 and on the GPU. */
async function curves(live: HTMLElement, item: ItemInfo) {
    const info = item.plot!;
    const [shown, numbers] = [h("div", { class: "plot" }), h("p", { class: "numbers", "aria-live": "polite" })];
    // Between whole numbers there is nothing to draw.
    const steps = info.unit === "integers" ? info.to - info.from : 320;
    const slider = (name: string, from: number, to: number, value: number, count = 320) => h("input", {
        type: "range", min: from, max: to, step: (to - from) / count, value, "aria-label": name, oninput: () => draw(),
    });
    const span = info.values.length ? Math.max(...info.values) - Math.min(...info.values) || 1 : 1;
    const x = slider(info.label, info.from, info.to, info.from + Math.round(0.4 * steps) / steps * (info.to - info.from), steps);
    const own = info.parameter && info.values.length
        ? slider(info.parameter, Math.min(...info.values), Math.max(...info.values, Math.min(...info.values) + span), between(info.values))
        : undefined;
    const note = h("p", { class: "note" });
    let gpu: Computed | undefined;
    let last: CurveResult | undefined;
    let isSettled = false;
    const draw = latest(async () => {
        try {
            await drawCurves();
        } catch (error) {
            numbers.textContent = reason(error);
        }
    });
    async function drawCurves() {
        const values = own ? [Number(own.value), ...info.values] : info.values;
        const found = await toolchain.call(OWN, "curves", {
            path: item.path, value: info.value, parameter: info.parameter, values, from: info.from, to: info.to, samples: steps + 1,
        });
        if (!found.curves.length) return numbers.replaceChildren(found.diagnostics[0]?.message ?? "");
        last = found;
        let failed = "";
        try {
            gpu = isSettled && live.isConnected ? await computed(found) : undefined;
        } catch (error) {
            gpu = undefined;
            failed = reason(error);
        }
        show(found);
        if (failed) note.append(` The GPU has no values: ${failed}`);
    }
    function show(found: CurveResult) {
        const at = Number(x.value);
        const picture = plot(info, found, at, gpu?.rows ?? found.curves.map((curve) => curve.single), live.clientWidth);
        shown.replaceChildren(picture, ...(info.parameter ? [legend(info.parameter, found, !!own)] : []));
        const index = Math.round(((at - info.from) / (info.to - info.from)) * steps);
        const curve = found.curves[0];
        const error = curve.error[index];
        numbers.textContent = `at ${Number(at.toPrecision(4))}${own ? `, ${info.parameter} ${Number(own.value).toPrecision(3)}` : ""}: `
            + `f64 ${curve.double[index]}, f32 on the CPU ${Math.fround(curve.single[index])}, `
            + `${gpu ? `${gpu.name} ${gpu.rows[0][index]}, ` : ""}`
            + `WGSL allows ±${Number.isFinite(error) ? error.toExponential(2) : "∞"}`;
        const dots = gpu?.name ?? "f32 on the CPU";
        const far = gpu && outside(found, gpu);
        note.textContent = `Lines are f64, dots are ${dots}, bands are what WGSL allows. `
            + (far === undefined ? "" : far ? `${far} values of ${dots} are outside.` : `All values of ${dots} are inside.`);
        live.dataset.drawn = String(Number(live.dataset.drawn ?? 0) + 1);
        if (gpu) Object.assign(live.dataset, { device: gpu.name, outside: String(far) });
    }
    live.replaceChildren(
        shown, h("label", {}, h("span", {}, info.label), x),
        ...(own ? [h("label", {}, h("span", {}, info.parameter!), own)] : []),
        numbers, note, ...(info.note ? [h("p", { class: "note" }, info.note)] : []),
    );
    await draw();
    let width = live.clientWidth;
    // The letters have the same size on a screen that was turned. They are drawn in the next frame:
    // drawing changes heights, which this observer must not do while it is notified of them.
    const turned = new ResizeObserver(() => {
        const again = last;
        if (!live.isConnected) turned.disconnect();
        else if (again && live.clientWidth !== width) requestAnimationFrame(() => show(again));
        width = live.clientWidth;
    });
    turned.observe(live);
    setTimeout(() => {
        isSettled = true;
        if (live.isConnected) draw();
    }, SETTLED);
}

/** Which curve is which. */
function legend(parameter: string, { curves }: CurveResult, hasSlider: boolean): HTMLElement {
    const one = (value: number, index: number) => h("span", { style: `--curve: ${colour(index)}` },
        `${parameter} = ${Number(value.toPrecision(3))}${hasSlider && index === 0 ? " (slider)" : ""}`);
    return h("p", { class: "legend" }, ...curves.map((curve, index) => one(curve.parameter, index)));
}

/** How many values of the GPU are farther from f64 than WGSL allows. */
function outside({ curves }: CurveResult, { rows }: Computed): number {
    return curves.flatMap(({ double, error }, row) =>
        double.filter((value, index) => !(Math.abs(rows[row][index] - value) <= error[index]) && Number.isFinite(error[index]))).length;
}
