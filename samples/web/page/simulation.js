// The worker in which the world runs: wadi.js and wadi.wasm, called through samples/web/page.h. The page asks by messages
// { id, call, args }, and gets { id, result } or { id, error }; { progress } comes in between. One request is answered after the other.
"use strict";

const MEMORY = { initial: 1024, maximum: 16384 }; // pages of 64 KiB, as CMakeLists.txt has them
const OUTPUTS = 9; // of page.h, in its order
const SNAPSHOT_SLOTS = 8; // for undo; the ninth is for measuring what effects cost

let wasm = null;
let shared = null; // the memory of the program with threads, any of which may let it grow
let level = null; // what the world was opened with
let threads = 1;
let stroke = 0, strokes = 0; // kept states: the newest one's number, and how many there are
let stamps = new Map();
let milliseconds = 0; // of a step, a mean over the last few
let hashed = { at: 0, step: -1, text: "" };

const memory = () => (shared ? shared.buffer : wasm.HEAPU8.buffer);

const encoder = new TextEncoder();

function text_of(address) {
  const bytes = new Uint8Array(memory());
  let end = address;
  while (bytes[end] !== 0) end++;
  return String.fromCharCode(...bytes.subarray(address, end));
}

function check(result) {
  if (result === -1 || result === null) throw new Error(text_of(wasm._page_error()));
  return result;
}

function hand_over(bytes) {
  const address = wasm._page_memory(bytes.length);
  if (address === 0) throw new Error("no memory left for " + bytes.length + " bytes");
  new Uint8Array(memory()).set(bytes, address);
  return address;
}

// Calls f with the address of each text as C has it.
function with_texts(texts, f) {
  const addresses = texts.map((text) => {
    const bytes = encoder.encode(text + "\0");
    const address = wasm._malloc(bytes.length);
    new Uint8Array(memory()).set(bytes, address);
    return address;
  });
  try {
    return f(...addresses);
  } finally {
    addresses.forEach((address) => wasm._free(address));
  }
}

function numbers() {
  const address = wasm._page_numbers();
  if (address === 0) throw new Error(text_of(wasm._page_error()));
  const [nx, ny, dx, dt, duration, steps, time] = new Float64Array(memory(), address, 7);
  return { nx, ny, dx, dt, duration, steps, time };
}

// All outputs one behind the other, rows with their padding, in memory that goes over to the page.
function frame_of(buffer) {
  const world = numbers();
  const parts = [];
  let floats = 0;
  for (let n = 0; n < OUTPUTS; n++) {
    const address = wasm._page_output(n);
    if (address === 0) throw new Error(text_of(wasm._page_error()));
    const row = wasm._page_row_floats(n), of_cell = n === 5 || n === 6 ? 2 : 1;
    const length = row * (world.ny - 1) + of_cell * world.nx;
    parts.push({ address, row: row / of_cell, length, offset: floats });
    floats += length;
  }
  if (!buffer || buffer.byteLength !== 4 * floats) buffer = new ArrayBuffer(4 * floats);
  for (const part of parts) {
    new Float32Array(buffer, 4 * part.offset, part.length).set(new Float32Array(memory(), part.address, part.length));
  }
  return { ...world, milliseconds, memory: memory().byteLength, hash: hashed.text, hash_step: hashed.step, undo: strokes, buffer,
    parts: parts.map(({ row, offset, length }) => ({ row, offset, length })) };
}

function take_hash(steps) {
  const address = wasm._page_hash(0);
  if (address === 0) throw new Error(text_of(wasm._page_error()));
  hashed = { at: performance.now(), step: steps, text: text_of(address) };
}

function open_world(which, { accuracy, draws } = level) {
  with_texts([level.text, level.variant, accuracy], (...texts) => check(wasm._page_open(which, ...texts, draws, threads)));
}

const edits = {
  // A state to come back to, ahead of what the hand does next.
  stroke() {
    stroke = (stroke + 1) % SNAPSHOT_SLOTS;
    check(wasm._page_keep(stroke));
    strokes = Math.min(strokes + 1, SNAPSHOT_SLOTS);
  },
  brush(layer, x0, y0, x1, y1, radius, softness, amount) {
    check(wasm._page_brush(layer, x0, y0, x1, y1, radius, softness, amount));
  },
  stamp(image, nx, ny, layer, x0, y0, x1, y1, amount) {
    const name = `${nx} ${ny}`;
    if (!stamps.has(name)) {
      hand_over(new Uint8Array(image.buffer));
      stamps.set(name, check(wasm._page_make_stamp(nx, ny)));
    }
    check(wasm._page_press(stamps.get(name), layer, x0, y0, x1, y1, amount));
  },
};

function pause_of(milliseconds) {
  return new Promise((resolve) => setTimeout(resolve, milliseconds));
}

const calls = {
  // What this machine and page can do; loads the program.
  async start(options) {
    threads = options.threads;
    const folder = new URL(threads > 1 ? "threads/" : "single/", self.location.href);
    importScripts(new URL("wadi.js", folder).href);
    const before = performance.now();
    if (threads > 1) shared = new WebAssembly.Memory({ ...MEMORY, shared: true });
    const locateFile = (file) => new URL(file, folder).href;
    wasm = await self.wadi({ locateFile, mainScriptUrlOrBlob: locateFile("wadi.js"), ...(shared && { wasmMemory: shared }) });
    return { milliseconds: performance.now() - before };
  },

  // { text, files: [{ name, bytes }], variant, accuracy, draws }
  open(options) {
    level = options;
    wasm._page_forget_files();
    for (const file of level.files) {
      hand_over(file.bytes);
      with_texts([file.name], (name) => check(wasm._page_add_file(name, file.bytes.length)));
    }
    stroke = strokes = milliseconds = 0;
    stamps = new Map();
    check(wasm._page_close(1));
    open_world(0);
    take_hash(0);
    return frame_of(null);
  },

  // Edits ahead of what so many seconds hold of steps, as many as fit a picture's time.
  advance({ list, seconds, buffer }) {
    for (const [kind, ...words] of list) edits[kind](...words);
    const most = Math.max(1, Math.min(64, Math.floor(60 / Math.max(milliseconds, 0.1))));
    const before = performance.now();
    const taken = check(wasm._page_advance(seconds, most));
    const now = performance.now();
    if (taken > 0) {
      const each = (now - before) / taken;
      milliseconds = milliseconds === 0 ? each : milliseconds + 0.1 * (each - milliseconds);
    }
    const { steps } = numbers();
    if (steps !== hashed.step && now - hashed.at > 400) take_hash(steps);
    return frame_of(buffer);
  },

  // So many steps, with edits ahead of the first.
  step({ list, steps, buffer }) {
    for (const [kind, ...words] of list) edits[kind](...words);
    const before = performance.now();
    check(wasm._page_step(0, steps));
    if (steps > 0) milliseconds = (performance.now() - before) / steps;
    take_hash(numbers().steps);
    return frame_of(buffer);
  },

  undo({ buffer }) {
    if (strokes > 0) {
      check(wasm._page_back(0, stroke));
      stroke = (stroke + SNAPSHOT_SLOTS - 1) % SNAPSHOT_SLOTS;
      strokes--;
    }
    take_hash(numbers().steps);
    return frame_of(buffer);
  },

  material(names) {
    return Object.fromEntries(names.map((name) => [name, with_texts([name], (text) => wasm._page_material(text))]));
  },
  set_material(values) {
    for (const [name, value] of Object.entries(values)) with_texts([name], (text) => check(wasm._page_set_material(0, text, value)));
  },

  // The command log, for a link.
  log() {
    const bytes = check(wasm._page_log());
    const log = new Uint8Array(memory(), wasm._page_memory(bytes), bytes).slice();
    const { steps } = numbers();
    take_hash(steps);
    return { log, steps, hash: hashed.text };
  },

  // Does what a log holds, up to its step, and tells how far it is; pictures of what comes by go to `show`.
  replay({ log, steps }) {
    hand_over(log);
    check(wasm._page_play(log.length));
    for (let done = 0, told = 0; done < steps; ) {
      const before = performance.now(), more = Math.min(steps - done, Math.max(1, Math.floor(60 / Math.max(milliseconds, 0.1))));
      check(wasm._page_step(0, more));
      milliseconds = (performance.now() - before) / more;
      done += more;
      if (performance.now() - told < 250) continue;
      told = performance.now();
      const frame = frame_of(null);
      self.postMessage({ progress: { share: done / steps, frame } }, [frame.buffer]);
    }
    take_hash(numbers().steps);
    return frame_of(null);
  },

  // What a step costs [ms]. numbers: { name: numbers of the material }: of the state as it is, as { name: [as it is, with those numbers] }, by turns,
  // since other work on the machine comes and goes. starts: { name: { accuracy, draws } }: of a level's first steps, as { name: milliseconds }.
  // A second world takes them, so that the one that is seen and its log stay as they are.
  async costs({ numbers, starts }) {
    const found = {}, slot = SNAPSHOT_SLOTS;
    // Code that has not run yet is slow until the browser has optimised it, beside this thread: half a second of steps, then a pause for it.
    const warm = async () => {
      const before = performance.now();
      while (performance.now() - before < 500) check(wasm._page_step(1, 1));
      await pause_of(150);
    };
    const least = (steps) => {
      let best = Infinity;
      check(wasm._page_step(1, 1));
      for (let n = 0; n < steps; n++) {
        const before = performance.now();
        check(wasm._page_step(1, 1));
        best = Math.min(best, performance.now() - before);
      }
      return best;
    };
    check(wasm._page_keep(slot));
    try {
      open_world(1);
      for (const [name, values] of Object.entries(numbers)) {
        const pair = [Infinity, Infinity];
        for (let turn = 0; turn < 6; turn++) {
          check(wasm._page_back(1, slot));
          if (turn % 2) for (const [key, value] of Object.entries(values)) with_texts([key], (text) => check(wasm._page_set_material(1, text, value)));
          if (turn === 1) await warm();
          pair[turn % 2] = Math.min(pair[turn % 2], least(3));
          await pause_of(0);
        }
        found[name] = pair;
      }
      for (const [name, start] of Object.entries(starts)) {
        open_world(1, start);
        await warm();
        found[name] = least(3);
        await pause_of(0);
      }
    } finally {
      check(wasm._page_close(1));
    }
    return found;
  },
};

let last = Promise.resolve(); // requests wait for those before, but for advance, which goes in between
self.onmessage = ({ data: { id, call, args } }) => {
  const answer = async () => {
    try {
      const result = await calls[call](args);
      self.postMessage({ id, result }, result && result.buffer ? [result.buffer] : []);
    } catch (error) {
      self.postMessage({ id, error: error.message });
    }
  };
  if (call === "advance") answer();
  else last = last.then(answer);
};
