// What a module asks of manifests: calls whose program, entry point, key and target are literals.

const SKIPPED = new Set(["type", "start", "end", "loc", "range", "parent"]);

/** The child nodes of a node, each with the name of its place. */
function* childrenOf(node) {
  for (const [name, value] of Object.entries(node)) {
    if (SKIPPED.has(name) || value === null || typeof value !== "object") continue;
    for (const child of Array.isArray(value) ? value : [value]) {
      if (child && typeof child.type === "string") yield [name, child];
    }
  }
}

/** `import.meta.hot`, or what builds put in its place. */
function isHot(node) {
  if (node.type === "ChainExpression") return isHot(node.expression);
  if (node.type === "MemberExpression") {
    const { object, property } = node;
    return (object.type === "MetaProperty" && property.name === "hot") || isHot(object);
  }
  if (node.type === "CallExpression") return isHot(node.callee);
  return (node.type === "Identifier" && node.name === "undefined") ||
    (node.type === "UnaryExpression" && node.operator === "void");
}

/** The part of a node that only runs while developing. */
function hotPart(node) {
  if (node.type === "IfStatement" && isHot(node.test)) return node.consequent;
  if (node.type === "LogicalExpression" && node.operator === "&&" && isHot(node.left)) return node.right;
  if (node.type === "CallExpression" && isHot(node.callee)) return node;
  return undefined;
}

const isProperty = (parent, name) =>
  (name === "property" && parent.type === "MemberExpression" && !parent.computed) ||
  (name === "key" && !parent.computed && !parent.shorthand);

/** Every mention of a name, with the nodes that it is in, the innermost last. */
function mentions(root, name, isBuild) {
  const found = [];
  const walk = (node, parents, place) => {
    const parent = parents.at(-1);
    if (node.type === "ImportDeclaration") return;
    if (node.type === "Identifier" && node.name === name && !isProperty(parent, place)) {
      found.push([node, parents]);
    }
    const skipped = isBuild ? hotPart(node) : undefined;
    if (skipped === node) return;
    const inner = [...parents, node];
    for (const [at, child] of childrenOf(node)) if (child !== skipped) walk(child, inner, at);
  };
  walk(root, [], "");
  return found;
}

const BINDERS = new Set(["VariableDeclarator", "FunctionDeclaration", "FunctionExpression", "ClassDeclaration",
  "ArrowFunctionExpression", "CatchClause", "RestElement", "AssignmentPattern", "ArrayPattern", "ObjectPattern"]);

/** Whether a mention may be another thing of the same name: a parameter, a variable. */
const isBinding = (node, parents) => {
  const parent = parents.at(-1);
  if (parent.type === "Property") return parents.at(-2)?.type === "ObjectPattern";
  if (!BINDERS.has(parent.type)) return false;
  return parent.init !== node && parent.body !== node && parent.right !== node;
};

function literal(node) {
  if (node?.type === "Literal" && node.value !== null) return node.value;
  const isText = node?.type === "TemplateLiteral" && node.expressions.length === 0;
  if (isText) return node.quasis[0].value.cooked;
  const isMinus = node?.type === "UnaryExpression" && node.operator === "-";
  return isMinus && node.argument.type === "Literal" ? -node.argument.value : undefined;
}

/** An object of literals; undefined where it has anything else. */
function literalKey(node) {
  if (node?.type !== "ObjectExpression") return undefined;
  const key = {};
  for (const property of node.properties) {
    if (property.type !== "Property" || property.computed) return undefined;
    const name = property.key.name ?? property.key.value, value = literal(property.value);
    if (value === undefined) return undefined;
    key[name] = value;
  }
  return key;
}

const memberName = (node) => (node.computed ? literal(node.property) : node.property.name);

/** The call `LOCAL.PROGRAM.METHOD(...)` that a mention is the start of. */
function callOf(node, parents) {
  const [call, method, member] = [parents.at(-3), parents.at(-2), parents.at(-1)];
  const isChain = member?.type === "MemberExpression" && member.object === node &&
    method?.type === "MemberExpression" && method.object === member &&
    call?.type === "CallExpression" && call.callee === method;
  if (!isChain || call.optional || method.optional || member.optional) return undefined;
  const place = { start: call.start, end: call.end, program: memberName(member) };
  if (memberName(method) === "layout") return { ...place, layout: true };
  if (memberName(method) !== "find" || call.arguments.length !== 3) return undefined;
  const [entry, key, target] = call.arguments;
  const asked = { entry: literal(entry), key: literalKey(key), target: literal(target) };
  return Object.values(asked).includes(undefined) ? undefined : { ...place, ...asked };
}

/** The import declarations of a module: where each is, its source, and its default name. */
export function importsOf(root) {
  const declared = root.body.filter(({ type }) => type === "ImportDeclaration");
  return declared.map(({ start, end, source, specifiers }) => {
    const [only] = specifiers;
    const isDefault = specifiers.length === 1 &&
      (only.type === "ImportDefaultSpecifier" || only.imported?.name === "default");
    return { start, end, source: source.value, local: isDefault ? only.local.name : undefined };
  });
}

/**
 * What a module asks of the manifest that it calls `local`. `calls` are those of literals; `isAll`
 * says that it uses the manifest in no other way. In a build, code for hot updates does not count.
 */
export function usageOf(root, local, isBuild) {
  const found = mentions(root, local, isBuild);
  if (found.some(([node, parents]) => isBinding(node, parents))) return { calls: [], isAll: false };
  const calls = found.map(([node, parents]) => callOf(node, parents));
  return { calls: calls.filter(Boolean), isAll: calls.every(Boolean) };
}
