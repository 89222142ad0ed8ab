// Texts in GLSL for `ShaderMaterial`.

/**
 * The text in GLSL ES 3.00 of some parts, with all that they need. Each is in it once, so take one chunk
 * for each shader.
 */
export function chunk(...parts) {
  const found = new Set();
  const add = (part) => {
    if (found.has(part)) return;
    for (const needed of part.needs()) if (needed.glsl) add(needed);
    found.add(part);
  };
  for (const part of parts) {
    if (!part.glsl) throw new Error(`\`${part.name}\` is not there in GLSL ES 3.00`);
    add(part);
  }
  return [...found].map(({ glsl }) => `${glsl}\n`).join("");
}
