// run.mjs - replays a capsule on the core compiled to WebAssembly and prints its hash.
//   node run.mjs REPLAY.wasm CAPSULE
import { readFileSync } from 'node:fs';

const [wasmPath, capsulePath] = process.argv.slice(2);
const { instance } = await WebAssembly.instantiate(readFileSync(wasmPath), {});
const core = instance.exports;
const capsule = readFileSync(capsulePath);
const TICK_BYTES = 32; // sizeof(capsule_tick)

const ticks = capsule.readUInt32LE(4);
const headerBytes = capsule.length - ticks * TICK_BYTES;
const put = (place, from, bytes) =>
  new Uint8Array(core.memory.buffer, place, bytes).set(capsule.subarray(from, from + bytes));

put(core.header_place(), 0, headerBytes);
let error = core.begin();
for (let tick = 0; tick < ticks && error === 0; tick++) {
  put(core.tick_place(), headerBytes + tick * TICK_BYTES, TICK_BYTES);
  error = core.step();
}
if (error !== 0) throw new Error(`the rod answered ${error}`);
const hex = word => (word >>> 0).toString(16).padStart(8, '0');
console.log(`ticks ${ticks}\nhash ${hex(core.hash_high())}${hex(core.hash_low())}`);
