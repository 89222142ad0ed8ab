import { OWN, toolchain } from "../client";
import { h, route } from "../dom";
import { device, picture } from "../draw";
import { spent } from "../draw/common";

/** What is measured: its name, how often, and the longest that it should take, in milliseconds. */
type Task = {
    name: string; count: number; limit?: number; run: (index: number) => Promise<unknown>;
    /** Whether pictures are drawn, so that the table says where the time goes. */
    isDrawn?: boolean;
};

const KEYS = ["shadow=hard", "shadow=pcf_3x3", "specular=ggx", "diffuse=oren_nayar", ""];
const [FORWARD, MANIFEST] = ["programs/forward.wesl", "lamplight.toml"];
const EXPRESSION = "brdf::specular::d_ggx(0.9, 0.19, 0.3)";

/** Keys whose permutations nothing was drawn with before. Each differs from the one before it in one
 * axis or two. */
const NEW = ["half_lambert", "wrap", "oren_nayar"].flatMap((diffuse) =>
    ["phong", "blinn_phong_normalized", "ggx"].map((specular) => `diffuse=${diffuse},specular=${specular}`));

const key = (index: number) => KEYS[(index + KEYS.length) % KEYS.length];

async function compiled(request: Parameters<typeof toolchain.call<"compile">>[2]) {
    const made = await toolchain.call(OWN, "compile", request);
    if (!made.ok) throw new Error(made.diagnostics[0]?.message ?? "the program has errors");
}

async function permutation(index: number, targets: string[]) {
    const { settings } = await toolchain.call(OWN, "point", { program: "forward", key: key(index) });
    return compiled({ root: FORWARD, settings, targets });
}

async function tasks(): Promise<Task[]> {
    // As an author has it who took the program over: the rest of the library is imported.
    const text = (await toolchain.call(OWN, "file", FORWARD))!.replaceAll("import package::", "import lamplight::");
    const manifest = (await toolchain.call(OWN, "file", MANIFEST))!;
    const all = await toolchain.call(OWN, "targets");
    const found: Task[] = [
        {
            name: "a keystroke in forward, to its WGSL and diagnostics", count: 31, limit: 50,
            run: (index) => compiled({
                files: { [MANIFEST]: manifest, [FORWARD]: text.replace("fn fs_main", `// ${index}\nfn fs_main`) },
                root: FORWARD, targets: ["wgsl"],
            }),
        },
        { name: "composing a permutation of forward", count: 31, run: (index) => permutation(index, []) },
        { name: "composing and emitting it in WGSL", count: 31, run: (index) => permutation(index, ["wgsl"]) },
        { name: "composing and emitting it in all languages", count: 31, run: (index) => permutation(index, all) },
        {
            name: `evaluating ${EXPRESSION}`, count: 31,
            run: async () => {
                const { value, diagnostics } = await toolchain.call(OWN, "evaluate", { expression: EXPRESSION });
                if (value === undefined) throw new Error(diagnostics[0]?.message ?? "the expression has no value");
            },
        },
    ];
    if (!await device()) return found;
    const drawn = (key: string, size = 256) => picture({ key, width: size, height: size, samples: 1 });
    return [...found, {
        name: "a switched axis of forward, to a picture of 256 × 256", count: 30, limit: 100, isDrawn: true,
        run: (index) => drawn(key(index)),
    }, {
        name: "the same, each permutation for the first time", count: NEW.length, isDrawn: true,
        run: (index) => drawn(index < 0 ? "" : NEW[index]),
    }, {
        name: "a switched axis of forward, to the coarse picture that slow devices show first", count: 30, limit: 100,
        isDrawn: true, run: (index) => drawn(key(index), 96),
    }];
}

/** Milliseconds that went by, and on what. */
type Times = { all: number; toolchain: number; compiling: number; drawing: number };

const clocks = (): Times => ({ all: performance.now(), toolchain: toolchain.spent, ...spent });

async function measured({ count, run }: Task): Promise<Times[]> {
    await run(-1);
    const times: Times[] = [];
    for (let turn = 0; turn < count; turn++) {
        const start = clocks();
        await run(turn);
        const end = clocks();
        times.push({
            all: end.all - start.all, toolchain: end.toolchain - start.toolchain,
            compiling: end.compiling - start.compiling, drawing: end.drawing - start.drawing,
        });
    }
    return times;
}

const sorted = (times: number[]) => [...times].sort((a, b) => a - b);
const median = (times: number[]) => sorted(times)[Math.floor(times.length / 2)];

/** Where the time of pictures goes, as medians. */
function parts(times: Times[]): [string, number[]][] {
    const of = (part: (one: Times) => number) => times.map(part);
    return [
        ["the toolchain", of((one) => one.toolchain)],
        ["the driver compiles shaders", of((one) => one.compiling)],
        ["the driver draws (some compile only now) and is read", of((one) => one.drawing)],
        ["the browser hands results from one to the other", of((one) => one.all - one.toolchain - one.compiling - one.drawing)],
    ];
}

/** How long a keystroke and a switched axis take in this browser. `cargo xtask bench site` puts the
 * times of the native tool into the address, in the order of the table: `?native=2.1,1.5,30`. */
export async function page(into: HTMLElement) {
    const native = (route().query.get("native") ?? "").split(",").map(Number).filter((time) => time > 0);
    const heads = ["", "median, ms", "slowest, ms", "at most, ms", ...(native.length ? ["native tool, ms", "ratio"] : [])];
    const rows = h("tbody", {});
    const row = (name: string, times: number[], limit?: number, other?: number, note = false) => {
        const middle = median(times);
        const cells = [middle.toFixed(1), Math.max(...times).toFixed(1), String(limit ?? "–"),
            ...(native.length ? [other ? other.toFixed(1) : "–", other ? `${(middle / other).toFixed(2)} x` : "–"] : [])];
        rows.append(h("tr", { class: note ? "note" : undefined, "data-median": middle.toFixed(1) },
            h("th", { scope: "row" }, name), ...cells.map((one) => h("td", {}, one))));
    };
    into.replaceChildren(h("h1", {}, "Speed"), h("p", {}, "Measured now, in this browser."),
        h("div", { class: "scrolled", tabindex: "0" },
            h("table", {}, h("thead", {}, h("tr", {}, ...heads.map((one) => h("th", {}, one)))), rows)));
    for (const [index, task] of (await tasks()).entries()) {
        const times = await measured(task);
        row(task.name, times.map((one) => one.all), task.limit, native[index]);
        if (task.isDrawn) parts(times).forEach(([name, part]) => row(`– ${name}`, part, undefined, undefined, true));
    }
    into.dataset.done = "1";
}
