import { OWN, toolchain } from "../client";
import { h } from "../dom";
import { device, picture } from "../draw";

/** How long a keystroke and a switched axis take in this browser. */
export async function page(into: HTMLElement) {
    const rows = h("tbody", {});
    const table = h("table", {}, h("thead", {}, h("tr", {}, ...["", "median, ms", "slowest, ms"].map((one) => h("th", {}, one)))), rows);
    into.replaceChildren(h("h1", {}, "Speed"), h("p", {}, "Measured now, in this browser."), table);
    const measure = async (name: string, count: number, run: (index: number) => Promise<unknown>) => {
        await run(-1);
        const times: number[] = [];
        for (let index = 0; index < count; index++) {
            const start = performance.now();
            await run(index);
            times.push(performance.now() - start);
        }
        times.sort((a, b) => a - b);
        const row = [times[Math.floor(count / 2)], times[count - 1]].map((time) => time.toFixed(1));
        rows.append(h("tr", { "data-median": row[0] }, h("th", { scope: "row" }, name), ...row.map((one) => h("td", {}, one))));
    };
    const files: Record<string, string> = {};
    for (const path of await toolchain.call(OWN, "files", ["wesl"])) {
        const text = path.startsWith("programs/forward") && await toolchain.call(OWN, "file", path);
        if (text) files["forward.wesl"] = text;
    }
    await measure("a keystroke in forward to its WGSL and diagnostics", 15, (index) => {
        const text = files["forward.wesl"].replace("fn fs_main", `// ${index}\nfn fs_main`);
        return toolchain.call(OWN, "compile", { files: { "programs/forward.wesl": text.replaceAll("import super::super", "import lamplight") }, root: "programs/forward.wesl", targets: ["wgsl"] });
    });
    const keys = ["shadow=hard", "shadow=pcf_3x3", "specular=ggx", "diffuse=oren_nayar", ""];
    await measure("a permutation of forward to WGSL", 15, async (index) => {
        const { settings } = await toolchain.call(OWN, "point", { program: "forward", key: keys[(index + 5) % 5] });
        return toolchain.call(OWN, "compile", { root: "programs/forward.wesl", settings, targets: ["wgsl"] });
    });
    if (await device()) {
        await measure("a switched axis to a new picture, 256 × 256", 5, (index) =>
            picture({ key: keys[(index + 5) % 5], width: 256, height: 256, samples: 1 }));
    }
    into.dataset.done = "1";
}
