// What a shader needs from its pipeline, whatever the API.

/** The constants that the key chooses, each with the `id` or the `symbol` that the target has. */
export function constantChoices(shader) {
  return shader.constants.map((constant) => {
    const choice = shader.native.choices?.find(({ name }) => name === constant.name);
    const { id, symbol } = choice ?? {};
    return { ...constant, id, symbol };
  });
}

/** The value of a constant as a number: 0 and 1 for truth values. */
export function constantNumber({ type, value }) {
  return type === "bool" ? Number(value === "true") : Number(value);
}

const SIZES = { f32: "setFloat32", i32: "setInt32", u32: "setUint32" };

function writeVector(view, at, scalar, components, values, from) {
  const write = SIZES[scalar];
  if (!write) throw new TypeError(`there is no way to write a \`${scalar}\``);
  for (let i = 0; i < components; i++) view[write](at + 4 * i, values[from + i], true);
  return from + components;
}

/** Writes numbers, column after column, without padding between them. */
function writeNumbers(view, at, path, member, values) {
  const { scalar, rows = 1, columns = 1, matrix_stride = 0, count = 1 } = member.shape;
  const list = typeof values === "number" ? [values] : values;
  const needed = rows * columns * count;
  if (!(list?.length === needed)) {
    throw new TypeError(`\`${path}\` needs ${needed} numbers, not ${list?.length ?? "none"}`);
  }
  let from = 0;
  for (let element = 0; element < count; element++) {
    const start = at + element * (member.stride ?? 0);
    for (let column = 0; column < columns; column++) {
      from = writeVector(view, start + column * matrix_stride, scalar, rows, list, from);
    }
  }
}

function writeMember(view, at, path, member, values) {
  if (!member.members) return writeNumbers(view, at, path, member, values);
  const count = member.shape?.count;
  if (count === undefined) return writeMembers(view, at, path, member.members, values);
  if (!(values.length <= count)) throw new TypeError(`\`${path}\` has ${count} elements`);
  values.forEach((value, i) => {
    writeMembers(view, at + i * member.stride, `${path}[${i}]`, member.members, value);
  });
}

function writeMembers(view, at, path, members, values) {
  const unknown = Object.keys(values).find((name) => !members.some((known) => known.name === name));
  if (unknown) {
    const names = members.map(({ name }) => name).join(", ");
    throw new TypeError(`\`${path}\` has no member \`${unknown}\`; it has: ${names}`);
  }
  for (const member of members) {
    const value = values[member.name];
    if (value === undefined) continue;
    writeMember(view, at + member.offset, `${path}.${member.name}`, member, value);
  }
}

/**
 * The bytes of a uniform buffer. `binding` is one of a layout or a reflection; `values` has a number
 * or a list of numbers for each member, a record for a struct, and a list of records for an array of
 * structs. Matrices are lists of columns without padding. What is left out is 0.
 */
export function packBlock(binding, values) {
  const buffer = new ArrayBuffer(Math.ceil(binding.size / 16) * 16);
  writeMembers(new DataView(buffer), 0, binding.name, binding.members ?? [], values);
  return buffer;
}
