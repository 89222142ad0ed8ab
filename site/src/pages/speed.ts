import { OWN, toolchain } from "../client";
import { h, route } from "../dom";
import { device, picture } from "../draw";

/** What is measured: its name, how often, and the longest that it should take, in milliseconds. */
type Task = { name: string; count: number; limit?: number; run: (index: number) => Promise<unknown> };

const KEYS = ["shadow=hard", "shadow=pcf_3x3", "specular=ggx", "diffuse=oren_nayar", ""];
const [FORWARD, MANIFEST] = ["programs/forward.wesl", "lamplight.toml"];

async function compiled(request: Parameters<typeof toolchain.call<"compile">>[2]) {
    const made = await toolchain.call(OWN, "compile", { ...request, targets: ["wgsl"] });
    if (!made.ok) throw new Error(made.diagnostics[0]?.message ?? "the program has errors");
}

async function tasks(): Promise<Task[]> {
    // As an author has it who took the program over: the rest of the library is imported.
    const text = (await toolchain.call(OWN, "file", FORWARD))!.replaceAll("import package::", "import lamplight::");
    const manifest = (await toolchain.call(OWN, "file", MANIFEST))!;
    const found: Task[] = [
        {
            name: "a keystroke in forward, to its WGSL and diagnostics", count: 15, limit: 50,
            run: (index) => compiled({
                files: { [MANIFEST]: manifest, [FORWARD]: text.replace("fn fs_main", `// ${index}\nfn fs_main`) },
                root: FORWARD,
            }),
        },
        {
            name: "a permutation of forward, to WGSL", count: 15,
            run: async (index) => {
                const { settings } = await toolchain.call(OWN, "point", { program: "forward", key: KEYS[(index + 5) % 5] });
                return compiled({ root: FORWARD, settings });
            },
        },
    ];
    if (!await device()) return found;
    return [...found, {
        name: "a switched axis of forward, to a picture of 256 × 256", count: 10, limit: 100,
        run: (index) => picture({ key: KEYS[(index + 5) % 5], width: 256, height: 256, samples: 1 }),
    }];
}

/** How long a keystroke and a switched axis take in this browser. `cargo xtask bench site` puts the
 * times of the native tool into the address, `?native=2.1,1.5,30`. */
export async function page(into: HTMLElement) {
    const native = (route().query.get("native") ?? "").split(",").map(Number).filter((time) => time > 0);
    const heads = ["", "median, ms", "slowest, ms", "at most, ms", ...(native.length ? ["native tool, ms", "ratio"] : [])];
    const rows = h("tbody", {});
    into.replaceChildren(h("h1", {}, "Speed"), h("p", {}, "Measured now, in this browser."),
        h("div", { class: "scrolled", tabindex: "0" },
            h("table", {}, h("thead", {}, h("tr", {}, ...heads.map((one) => h("th", {}, one)))), rows)));
    for (const [index, { name, count, limit, run }] of (await tasks()).entries()) {
        await run(-1);
        const times: number[] = [];
        for (let turn = 0; turn < count; turn++) {
            const start = performance.now();
            await run(turn);
            times.push(performance.now() - start);
        }
        times.sort((a, b) => a - b);
        const median = times[Math.floor(count / 2)];
        const other = native[index];
        const cells = [median.toFixed(1), times[count - 1].toFixed(1), String(limit ?? "–"),
            ...(native.length ? [other ? other.toFixed(1) : "–", other ? `${(median / other).toFixed(2)} x` : "–"] : [])];
        rows.append(h("tr", { "data-median": median.toFixed(1) }, h("th", { scope: "row" }, name), ...cells.map((one) => h("td", {}, one))));
    }
    into.dataset.done = "1";
}
