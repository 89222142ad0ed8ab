// Keys as text: `shadow=pcf_3x3,two_sided`.

/** The parts of a key: pairs of an axis and a value. */
function partsOf(key) {
  const text = key.trim();
  if (text === "" || text === "default") return [];
  return text.split(",").map((part) => {
    const at = part.indexOf("=");
    return at < 0 ? [part.trim(), "true"] : [part.slice(0, at).trim(), part.slice(at + 1).trim()];
  });
}

const byName = ([a], [b]) => (a < b ? -1 : a > b ? 1 : 0);

/** The canonical form: axes sorted, defaults left out. `fail` is called with a reason. */
export function canonicalKey(axes, key, fail) {
  const chosen = new Map();
  for (const [name, value] of partsOf(key)) {
    const axis = axes.find((axis) => axis.name === name);
    if (!axis) fail(`there is no axis \`${name}\``);
    if (axis.mode === "dynamic") fail(`axis \`${name}\` is dynamic: its value is chosen while running`);
    if (chosen.has(name)) fail(`axis \`${name}\` is named twice`);
    if (!axis.values.includes(value)) {
      fail(`axis \`${name}\` has no value \`${value}\`; there are: ${axis.values.join(", ")}`);
    }
    chosen.set(name, value);
  }
  const differing = [...chosen].filter(
    ([name, value]) => axes.find((axis) => axis.name === name).default !== value,
  );
  const words = differing.sort(byName);
  const text = words.map(([name, value]) => (value === "true" ? name : `${name}=${value}`));
  return text.join(",") || "default";
}

/** In how many axes two canonical keys differ. */
export function keyDistance(a, b) {
  const left = new Map(partsOf(a)), right = new Map(partsOf(b));
  const names = new Set([...left.keys(), ...right.keys()]);
  return [...names].filter((name) => left.get(name) !== right.get(name)).length;
}
