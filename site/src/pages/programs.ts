import type { Choice, Point, ProgramInfo } from "@lamplight/toolchain";
import { OWN, toolchain } from "../client";
import { choose, code, h, remember, route } from "../dom";
import { device, picture, show } from "../draw";
import { output } from "../output";

export async function page(into: HTMLElement) {
    const [{ programs }, studio, known] = await Promise.all([
        toolchain.call(OWN, "programs", {}), toolchain.call(OWN, "studio"), toolchain.call(OWN, "targets"),
    ]);
    const { path, query } = route();
    const preset = query.get("preset") ?? "";
    const published = studio.presets.find((one) => one.name === preset);
    const state = {
        program: path || published?.program || "forward", key: query.get("key") ?? published?.key ?? "",
        scene: query.get("scene") ?? published?.scene ?? "", environment: query.get("environment") ?? "studio",
        target: query.get("target") ?? "wgsl", light: query.get("light") ?? "", preset,
    };
    const canvas = h("canvas", {
        width: 256, height: 256, tabindex: "0", role: "img",
        "aria-label": "The picture. Arrow keys move the light.",
    });
    const told = h("p", { role: "status", class: "status" });
    const axes = h("form", { class: "axes", "aria-label": "Axes" });
    const text = h("div", { class: "texts" });
    const scene = choose("scene", ["", ...studio.scenes.map((one) => one.name)], state.scene, (value) => set({ scene: value }));
    const around = choose("environment", studio.environments, state.environment, (value) => set({ environment: value }));
    const programChoice = choose("program", programs.map((one) => one.name), state.program, (value) => set({ program: value, key: "", scene: "", preset: "" }));
    const targets = choose("output", ["composed", ...known], state.target, (value) => set({ target: value }));
    const info = h("p", { class: "note" });

    let turn = 0;
    async function update() {
        const now = ++turn;
        const start = performance.now();
        const { program, key, ...rest } = state;
        remember("programs", program, { key, ...rest });
        const found = programs.find((one) => one.name === program) ?? programs[0];
        const point = await toolchain.call(OWN, "point", { program: found.name, key });
        if (now !== turn) return;
        controls(axes, found, point, (next) => set({ key: next }));
        info.textContent = `${found.doc} ${found.valid.toLocaleString("en")} permutations are possible, ${found.shipped.toLocaleString("en")} ship.`;
        if (!point.valid) {
            told.textContent = point.broken.join(" ") || point.diagnostics[0]?.message || "";
            return;
        }
        try {
            const pixels = await picture({
                program: found.name, key: point.key, width: 384, height: 384, samples: 1, environment: state.environment,
                ...(state.preset && { preset: state.preset }), ...(state.scene && { scene: state.scene }),
                numbers: state.light ? { light: { position: state.light.split(",").map(Number) } } : {},
            });
            if (now !== turn) return;
            show(canvas, pixels);
            told.textContent = `${(await device())?.name}: ${Math.round(performance.now() - start)} ms, ${point.key || "default"}`;
            canvas.dataset.drawn = String(Number(canvas.dataset.drawn ?? 0) + 1);
            canvas.dataset.key = point.key;
        } catch (error) {
            told.textContent = error instanceof Error ? error.message : String(error);
        }
        if (found.wesl && now === turn) {
            const made = await toolchain.call(OWN, "compile", {
                root: found.wesl, settings: point.settings, targets: state.target === "composed" ? [] : [state.target],
            });
            if (now === turn) text.replaceChildren(...output(made, state.target));
        }
    }
    function set(change: Partial<typeof state>) {
        Object.assign(state, change);
        update();
    }
    // The light moves in the plane z = 2.5 of the scene.
    const move = (x: number, y: number) => {
        const place = [3 * (2 * x - 1), 3 * (1.2 - y), 2.5];
        set({ light: place.map((one) => one.toFixed(2)).join(",") });
    };
    const drag = (event: PointerEvent) => {
        const box = canvas.getBoundingClientRect();
        move((event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height);
    };
    canvas.addEventListener("pointerdown", (event) => { canvas.setPointerCapture(event.pointerId); drag(event); });
    canvas.addEventListener("pointermove", (event) => { if (event.buttons) drag(event); });
    const steps: Record<string, [number, number]> = { ArrowLeft: [-0.05, 0], ArrowRight: [0.05, 0], ArrowUp: [0, -0.05], ArrowDown: [0, 0.05] };
    canvas.addEventListener("keydown", (event) => {
        const step = steps[event.key];
        if (!step) return;
        event.preventDefault();
        const [x, y] = (state.light || "0,1.5,2.5").split(",").map(Number);
        move((x / 3 + 1) / 2 + step[0], 1.2 - y / 3 + step[1]);
    });
    into.replaceChildren(
        h("h1", { class: "quiet" }, "Programs"),
        h("div", { class: "columns wide" },
            h("div", {}, h("div", { class: "picture" }, canvas), told,
                h("div", { class: "row" }, programChoice, scene, around), info, axes),
            h("div", {}, h("div", { class: "row" }, targets), text)),
    );
    await update();
}

/** Every axis as a control: what cannot be chosen next to the others says why. */
function controls(form: HTMLFormElement, program: ProgramInfo, point: Point, change: (key: string) => void) {
    const focused = (document.activeElement as HTMLElement | null)?.dataset?.axis;
    const option = (choice: Choice) => h("option", {
        value: choice.key, disabled: choice.reasons.length > 0, title: choice.reasons.join(" ") || undefined,
        selected: String(point.settings[choice.axis]) === String(choice.value),
    }, choice.reasons.length ? `${choice.value} – ${choice.reasons[0]}` : String(choice.value));
    form.replaceChildren(...program.axes.map((axis) => {
        const choices = point.choices.filter((choice) => choice.axis === axis.name);
        const select = h("select", { "data-axis": axis.name, title: axis.doc, onchange: () => change(select.value) }, ...choices.map(option));
        return h("label", {}, h("span", {}, axis.name), select);
    }));
    if (focused) form.querySelector<HTMLElement>(`[data-axis="${focused}"]`)?.focus();
    if (point.valid) return;
    form.append(h("p", { class: "wrong" }, point.broken.join(" ")), code(point.key, "key"));
}
