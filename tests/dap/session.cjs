// Debugs two shaders with the client of `@vscode/debugadapter-testsupport`, and prints what is said.
const { DebugClient } = require('@vscode/debugadapter-testsupport');
const path = require('path');

const [program, folder] = process.argv.slice(2);
const rows = [];

/** A message without what differs from machine to machine. */
function shown(value) {
  const text = JSON.stringify(value ?? {}, (name, part) =>
    part && !Array.isArray(part) && typeof part === 'object'
      ? Object.fromEntries(Object.entries(part).sort(([a], [b]) => (a < b ? -1 : 1)))
      : part);
  return text.replaceAll(JSON.stringify(folder).slice(1, -1), 'FOLDER');
}

class Client {
  constructor() {
    this.debug = new DebugClient(program, 'dap', 'lamplight', { cwd: folder }, true);
    // Messages as they come in: what the client hands on later may be in another order.
    const dispatch = this.debug.dispatch.bind(this.debug);
    this.debug.dispatch = (text) => {
      const said = JSON.parse(text);
      if (said.event) rows.push(`  * ${said.event} ${shown(said.body)}`);
      else rows.push(said.success ? `  ${shown(said.body)}` : `  refused: ${said.message}`);
      dispatch(text);
    };
  }

  async ask(command, args = {}) {
    rows.push(`${command} ${shown(args)}`);
    const said = await this.debug.send(command, args).catch(() => ({}));
    return said.body;
  }

  async move(command, args = { threadId: 1 }) {
    const stop = this.debug.waitForEvent('stopped', 20000);
    await this.ask(command, args);
    await stop;
  }

  /** The lines of the stack, and what the innermost function sees. */
  async look() {
    const { stackFrames } = await this.ask('stackTrace', { threadId: 1 });
    const { scopes } = await this.ask('scopes', { frameId: stackFrames[0].id });
    for (const scope of scopes) {
      const { variables } = await this.ask('variables', {
        variablesReference: scope.variablesReference,
      });
      this.last = variables;
    }
    return stackFrames[0].id;
  }

  async open(file, launch) {
    await this.debug.start();
    await this.ask('initialize', { adapterID: 'lamplight', linesStartAt1: true });
    const ready = this.debug.waitForEvent('initialized', 20000);
    await this.ask('launch', { program: path.join(folder, file), ...launch });
    await ready;
  }

  breakpoints(file, breakpoints) {
    return this.ask('setBreakpoints', { source: { path: path.join(folder, file) }, breakpoints });
  }

  async close() {
    await this.ask('disconnect');
    this.debug.stopAdapter();
  }
}

async function wesl() {
  rows.push('--- a file in WESL with an import ---');
  const client = new Client();
  await client.open('main.wesl', {
    pixel: [40, 40], size: '128x128', uniform: { power: 2 }, cwd: folder, stopOnEntry: true,
  });
  // Line 6 has no statement that runs: that of line 8 is taken.
  await client.breakpoints('light.wesl', [{ line: 6, hitCondition: '2' }]);
  await client.breakpoints('main.wesl', [
    { line: 9, condition: 'i == 1 && share > -1.0' },
    { line: 10, condition: 'nothing > 1.0' },
    { line: 23, logMessage: 'light is {light}' },
    { line: 99 },
  ]);
  await client.ask('setExceptionBreakpoints', { filters: ['domain', 'nonsense'] });
  await client.move('configurationDone', {});
  await client.ask('threads');
  await client.look();
  await client.move('continue');
  await client.look();
  await client.move('next');
  await client.move('stepOut');
  await client.look();
  // A step back over the call, into which the breakpoint's second hit leads back.
  await client.move('stepBack');
  await client.ask('stackTrace', { threadId: 1, levels: 1 });
  await client.move('continue');
  const frame = await client.look();
  const lamps = await client.ask('evaluate', { expression: 'lamps[1]', frameId: frame });
  await client.ask('variables', { variablesReference: lamps.variablesReference });
  await client.ask('evaluate', { expression: 'lamp(n, lamps[0]) * power', frameId: frame });
  const share = await client.ask('evaluate', { expression: 'share', frameId: frame });
  await client.ask('variables', { variablesReference: share.variablesReference });
  await client.ask('evaluate', { expression: 'shar', frameId: frame, context: 'hover' });
  // Back over the turns of the loop.
  for (let step = 0; step < 6; step += 1) {
    await client.move('stepBack');
    await client.ask('stackTrace', { threadId: 1, levels: 1 });
  }
  await client.breakpoints('light.wesl', []);
  await client.breakpoints('main.wesl', [{ line: 23, logMessage: 'light is {light}' }]);
  await client.move('continue');
  await client.ask('exceptionInfo', { threadId: 1 });
  await client.look();
  await client.move('continue');
  await client.look();
  await client.move('stepBack');
  await client.move('stepIn');
  await client.move('reverseContinue');
  await client.move('reverseContinue');
  await client.move('restart', {});
  await client.breakpoints('main.wesl', [{ line: 10, condition: 'share' }, { line: -1 }]);
  await client.ask('restartFrame', { frameId: 1 });
  await client.ask('scopes', { frameId: -1 });
  await client.ask('cancel', { requestId: 1 });
  await client.close();
}

async function glsl() {
  rows.push('--- a file in GLSL ---');
  const client = new Client();
  await client.open('fog.frag', {
    pixel: '64,64', size: [128, 128], uniform: ['density=0.05', 'fog=0.5,0.5,0.5'], cwd: folder,
  });
  await client.breakpoints('fog.frag', [
    { line: 8 }, { line: 14, condition: 'i == 1 && density < 1.0' },
  ]);
  await client.move('configurationDone', {});
  await client.look();
  await client.move('continue');
  await client.look();
  await client.breakpoints('fog.frag', []);
  await client.move('stepOut');
  await client.look();
  // Over the call, and over the loop.
  for (let step = 0; step < 9; step += 1) {
    await client.move('stepBack');
    await client.ask('stackTrace', { threadId: 1 });
  }
  await client.ask('evaluate', { expression: 'clear(way) + view_position.z' });
  await client.move('continue');
  const end = client.debug.waitForEvent('terminated', 20000);
  await client.ask('continue', { threadId: 1 });
  await end;
  await client.close();
}

async function wrong() {
  rows.push('--- what cannot run ---');
  const client = new Client();
  await client.debug.start();
  await client.ask('initialize', { adapterID: 'lamplight' });
  await client.ask('next', { threadId: 1 });
  const launch = (file, more) =>
    client.ask('launch', { program: path.join(folder, file), cwd: folder, ...more });
  await launch('half.wesl', { pixel: [1, 1] });
  await launch('main.wesl', {});
  await launch('main.wesl', { pixel: [0, 0], size: '128x128' });
  await launch('missing.wesl', { pixel: [1, 1] });
  await launch('main.wesl', { pixel: 'one' });
  await client.close();
}

wesl().then(glsl).then(wrong).then(
  () => console.log(rows.join('\n')),
  (error) => {
    console.log(rows.join('\n'));
    console.error(error);
    process.exit(1);
  },
);
