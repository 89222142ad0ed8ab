import type { CostInfo, PictureControls, PictureRequest, Point, ProgramInfo } from "@lamplight/toolchain";
import { OWN, toolchain } from "../client";
import { choose, h, reason, remember, repeated, route } from "../dom";
import { Screen, device, looked, picture, show } from "../draw";
import { output, texts } from "../output";
import { axes } from "../parts/axes";
import { Lamps } from "../parts/lamps";
import { latest } from "../parts/latest";
import { Listed } from "../parts/listed";
import { Pixel } from "../parts/pixel";
import { Uniforms } from "../parts/uniforms";

/** Numbers by name, as the address has them: `a:1,2;b:3`. */
type Numbers = Record<string, number[]>;

function read(text: string | null): Numbers {
    const pairs = (text ?? "").split(";").map((one) => one.split(":"));
    const numbers = pairs.map(([name, list = ""]): [string, number[]] => [name, list.split(",").map(Number)]);
    return Object.fromEntries(numbers.filter(([name, list]) => name && list.every(Number.isFinite)));
}

const written = (numbers: Numbers) => Object.entries(numbers).map(([name, list]) => `${name}:${list}`).join(";");

/** A link has the same numbers as the page, so they are short. */
const short = (list: number[]) => list.map((one) => Number(one.toPrecision(5)));

function begun(query: URLSearchParams, path: string, published?: { program: string; key: string; scene: string }) {
    return {
        program: path || published?.program || "forward", key: query.get("key") ?? published?.key ?? "",
        scene: query.get("scene") ?? published?.scene ?? "", environment: query.get("environment") ?? "",
        target: query.get("target") ?? "wgsl", preset: query.get("preset") ?? "",
        lamps: read(query.get("lamps")), set: read(query.get("set")),
        /** The permutation that this one is compared with. */
        against: query.get("against") ?? undefined,
    };
}

/** Pixels along the edges of the picture. */
const SIZE = 384;

/** How many places of each pixel are averaged for smooth edges. */
const SAMPLES = 4;

/** Letters of a key. The longest of the library's has some hundreds. */
const LONGEST_KEY = 4096;

const problems = (all: { message: string }[]) => all.map((one) => one.message).join(" ");

export async function page(into: HTMLElement) {
    const [{ programs }, studio, known] = await Promise.all([
        toolchain.call(OWN, "programs", {}), toolchain.call(OWN, "studio"), toolchain.call(OWN, "targets"),
    ]);
    const { path, query } = route();
    if (path && !programs.some((one) => one.name === path)) {
        return into.replaceChildren(h("h1", {}, "Not found"), h("p", {}, `The library has no program ${repeated(path)}.`));
    }
    const long = ["key", "against"].find((name) => (query.get(name) ?? "").length > LONGEST_KEY);
    if (long) {
        return into.replaceChildren(h("h1", {}, "Not found"), h("p", {}, `The ${long} of the address has more than ${LONGEST_KEY} characters.`));
    }
    const state = begun(query, path, studio.presets.find((one) => one.name === query.get("preset")));
    type State = typeof state;
    const canvas = h("canvas", {
        width: 256, height: 256, role: "img", tabindex: "0",
        "aria-label": "The picture. A click or Enter shows the values of a pixel, which arrow keys move until Escape.",
    });
    const screen = new Screen(canvas);
    const over = h("div", { class: "picture" }, canvas);
    const status = h("p", { role: "status", class: "status" });
    const form = h("form", { "aria-label": "Axes" });
    const text = h("div", { class: "texts" });
    const info = h("p", { class: "note" });
    const costNote = h("p", { class: "note" });
    const numbers = h("div", { class: "uniforms" });
    const uniforms = new Uniforms(numbers, (name, list) => set({ set: { ...state.set, [name]: short(list) } }, false));
    const lamps = new Lamps(over, (index, place, isDone) =>
        set({ lamps: { ...state.lamps, [index]: short(place) } }, false, isDone));
    const forget = { lamps: {}, set: {} };
    const scene = choose("scene", ["", ...studio.scenes.map((one) => one.name)], state.scene, (value) => set({ scene: value, lamps: {} }, false));
    const around = choose("environment", ["", ...studio.environments], state.environment, (value) => set({ environment: value }, false));
    const programChoice = choose("program", programs.map((one) => one.name), state.program,
        (value) => set({ program: value, key: "", scene: "", preset: "", against: undefined, ...forget }));
    const targets = choose("output", ["composed", ...known], state.target, (value) => set({ target: value }));
    const compare = h("button", {
        type: "button", "aria-pressed": "false",
        onclick: () => set({ against: state.against === undefined ? point?.key ?? "" : undefined }),
    });
    const reset = h("button", { type: "button", onclick: () => set({ ...forget }, false) }, "Numbers and lamps as they were");

    let point: Point | undefined;
    let found: ProgramInfo = programs[0];
    let wanted = { texts: true, controls: true };

    const request = (): Omit<PictureRequest, "target"> => ({
        program: found.name, key: point!.key, width: SIZE, height: SIZE, samples: 1,
        ...(state.environment && { environment: state.environment }), ...(state.preset && { preset: state.preset }), ...(state.scene && { scene: state.scene }),
        uniforms: state.set, lamps: state.lamps,
    });
    /** The picture on the screen. */
    let last: Omit<PictureRequest, "target"> | undefined;
    const listed = new Listed();
    const pixel = new Pixel(over, canvas, {
        size: [SIZE, SIZE], shown: (moment) => listed.show(moment),
        run: (at) => looked(last ?? request(), (asked) => toolchain.call(OWN, "picturePixel", asked, at)),
        marks: () => looked(last ?? request(), (asked) => toolchain.call(OWN, "pictureMarks", asked)),
    });
    // They are recorded, and do not change.
    const recorded = new Map<string, Promise<CostInfo>>();
    const costsOf = (name: string) => {
        const known = recorded.get(name) ?? toolchain.call(OWN, "costs", name);
        recorded.set(name, known);
        // What failed is asked for again.
        known.catch(() => recorded.delete(name));
        return known;
    };
    async function draw(withControls: boolean, isOld: () => boolean) {
        const start = performance.now();
        const requested = request();
        delete canvas.dataset.smooth;
        try {
            const take = (factor: number) => picture({ ...requested, width: requested.width / factor, height: requested.height / factor });
            await screen.show(take, isOld);
            if (isOld()) {
                wanted.controls ||= withControls;
                return;
            }
            last = requested;
            status.textContent = `${(await device())?.name}: ${Math.round(performance.now() - start)} ms, ${requested.key || "default"}`;
            canvas.dataset.drawn = String(Number(canvas.dataset.drawn ?? 0) + 1);
            canvas.dataset.key = requested.key;
            pixel.renew();
        } catch (error) {
            status.textContent = reason(error);
        }
        if (!withControls) return;
        const controls: PictureControls = await toolchain.call(OWN, "pictureControls", { ...requested, target: "wgsl" });
        if (controls.diagnostics.length) status.textContent = problems(controls.diagnostics);
        lamps.show(controls);
        uniforms.show(controls.uniforms);
        canvas.dataset.controls = String(controls.uniforms.length);
    }
    /** The same picture again, with smooth edges: it comes after everything else. */
    async function smooth(isOld: () => boolean) {
        if (!last || !await device()) return;
        const finer = { ...last, samples: SAMPLES };
        const made = await picture(finer);
        if (isOld()) return;
        show(canvas, made);
        last = finer;
        canvas.dataset.smooth = canvas.dataset.drawn;
    }
    async function write() {
        if (!found.wesl) return;
        const shader = (settings: Point["settings"]) => toolchain.call(OWN, "compile", {
            root: found.wesl!, settings, targets: state.target === "composed" ? [] : [state.target],
        });
        const made = await shader(point!.settings);
        if (!made.ok) return text.replaceChildren(h("p", { class: "wrong" }, problems(made.diagnostics)));
        if (state.against === undefined) return text.replaceChildren(...output(made, state.target));
        const [{ differences }, other] = await Promise.all([
            import("../parts/differences"), toolchain.call(OWN, "point", { program: found.name, key: state.against }),
        ]);
        if (!other.valid) {
            const why = other.broken.join(" ") || problems(other.diagnostics);
            return text.replaceChildren(h("p", { class: "wrong" }, `${repeated(state.against)}: ${why}`));
        }
        const before = texts(await shader(other.settings), state.target);
        const after = texts(made, state.target);
        const names = [...new Set([...before, ...after].map((one) => one.title))];
        const of = (some: typeof before, title: string) => some.find((one) => one.title === title)?.text ?? "";
        text.replaceChildren(
            h("p", {}, "From ", h("code", {}, other.key || "default"), " to ", h("code", {}, point!.key || "default")),
            ...names.map((title) => differences(of(before, title), of(after, title), title)));
    }
    const update = latest(async (isAsked) => {
        // A page that was left leaves the device to the next one.
        const isOld = () => isAsked() || !into.isConnected;
        const now = wanted;
        wanted = { texts: false, controls: false };
        try {
            await renew(now, isOld);
        } catch (error) {
            status.textContent = reason(error);
        }
    });
    async function renew(now: typeof wanted, isOld: () => boolean) {
        const { program, key, scene, environment, target, preset, against } = state;
        if (into.isConnected) document.title = `${program} – Programs – Lamplight`;
        remember(into, "programs", program, {
            key, scene, environment, target, preset, lamps: written(state.lamps), set: written(state.set),
        }, { against });
        if (now.texts || !point) {
            found = programs.find((one) => one.name === program) ?? programs[0];
            const [next, costs] = await Promise.all([
                toolchain.call(OWN, "point", { program: found.name, key }), costsOf(found.name),
            ]);
            point = next;
            axes(form, found, point, costs, (next) => set({ key: next }));
            info.textContent = `${found.doc} ${found.valid.toLocaleString("en")} permutations are possible, ${found.shipped.toLocaleString("en")} ship.`;
            costNote.textContent = costs.axes.length ? `Costs are medians against the default of the axis, over pairs of permutations, on one AMD GPU, ${costs.gpu} (${costs.generation}), as ${costs.driver} compiles for it.` : "";
            compare.textContent = state.against === undefined ? "Compare from here" : "End the comparison";
            compare.setAttribute("aria-pressed", String(state.against !== undefined));
        }
        if (!point.valid) {
            status.textContent = point.broken.join(" ") || point.diagnostics[0]?.message || "";
            return;
        }
        if (!into.isConnected) return;
        await draw(now.controls, isOld);
        if (isOld()) wanted.texts ||= now.texts;
        else if (now.texts) await write();
        if (!isOld()) await smooth(isOld);
    }
    /** Without new texts, only the picture changes; while a lamp is dragged, its controls stay. */
    function set(change: Partial<State>, withTexts = true, withControls = true) {
        Object.assign(state, change);
        wanted = { texts: wanted.texts || withTexts, controls: wanted.controls || withControls };
        update();
    }
    into.replaceChildren(
        h("h1", { class: "quiet" }, "Programs"),
        h("div", { class: "columns wide" },
            h("div", {}, over, status, pixel.element, listed.element,
                h("div", { class: "row" }, programChoice, scene, around, reset), info, form, costNote,
                h("details", {}, h("summary", {}, "Uniforms"), numbers)),
            h("div", {}, h("div", { class: "row" }, targets, compare), text)),
    );
    await update();
}
