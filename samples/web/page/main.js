// The page: the worker's states become pictures, and the hand's strokes edits.
import { Camera } from "./camera.js";
import { QUALITIES, Renderer } from "./renderer.js";
import { Hand, TOOLS, meet } from "./tools.js";
import { from_fragment, to_fragment } from "./link.js";
import { EFFECTS, SANDS } from "./material.js";
import { ICONS } from "./icons.js";

const at = (id) => document.getElementById(id);
const NUMBERS = [...new Set(["porosity", ...[...EFFECTS, ...SANDS].flatMap(({ numbers }) => Object.keys(numbers))])]; // of the material
const ALL_DRAWS = 7; // of page_open: foam, wet ground, muddy water
const LEAST_SCALE = 0.25; // share of the canvas' width that is drawn at least, and then enlarged
const MOST_THREADS = 6; // build.sh makes eight, of which two order steps and save
const PICTURE_BUDGET = [24, 40]; // a picture's time [ms] below which more pixels are drawn, and above which fewer

// ---- The worker ----

const worker = new Worker("simulation.js");
const open_requests = new Map();
let requests = 0, on_progress = null;

worker.onmessage = ({ data }) => {
  if (data.progress) return on_progress?.(data.progress);
  const { resolve, reject } = open_requests.get(data.id);
  open_requests.delete(data.id);
  if (data.error === undefined) resolve(data.result);
  else reject(new Error(data.error));
};
worker.onerror = (event) => fail(new Error(event.message));

function ask(call, args, transfer = []) {
  return new Promise((resolve, reject) => {
    open_requests.set(++requests, { resolve, reject });
    worker.postMessage({ id: requests, call, args }, transfer);
  });
}

// ---- What is shown ----

const page = {
  levels: null,
  name: "", variant: "", accuracy: "", draws: 0, // what is open
  state: null, // of the worker, newest
  block: null,
  busy: true, // while a level is opened or a link replayed
  paused: false,
  camera: new Camera(),
  hand: new Hand(),
  costs: {},
  first_picture: 0, // [ms] since the page was asked for
  pictures: 0,
};
// For tests and the curious.
window.page = Object.assign(page, { ask, surface_at, take, open_level, set_paused });

let renderer = null, scale = 0.5, fixed_scale = 0, quality = "low", changed = true, fresh = true;
let spare = null; // a state's memory that goes back to the worker

function fail(error) {
  console.error(error);
  at("cover").hidden = false;
  at("cover").classList.remove("light");
  at("cover_text").textContent = error.message;
  at("cover_bar").hidden = true;
}

function cover(text, share = 0, light = false) {
  at("cover").hidden = text === null;
  at("cover").classList.toggle("light", light);
  at("cover_text").textContent = text ?? "";
  at("cover_bar").firstElementChild.style.width = `${100 * share}%`;
}

function take(state) {
  if (page.state && page.state.buffer.byteLength > 0) spare = page.state.buffer;
  page.state = state;
  changed = fresh = true;
}

// Elevation of the visible surface at a place, or of the sand below the water.
function surface_at(x, y, seen = true) {
  const { state } = page, solid = state.parts[0], water = state.parts[2];
  const clamp = (value, most) => Math.min(Math.max(value, 0), most);
  const a = clamp(x / state.dx - 0.5, state.nx - 1), b = clamp(y / state.dx - 0.5, state.ny - 1);
  const i = Math.min(Math.floor(a), state.nx - 2), j = Math.min(Math.floor(b), state.ny - 2), f = a - i, g = b - j;
  page.floats = page.floats?.buffer === state.buffer ? page.floats : new Float32Array(state.buffer);
  const cell = (i, j) => page.floats[solid.offset + j * solid.row + i] + (seen ? page.floats[water.offset + j * water.row + i] : 0);
  return (cell(i, j) * (1 - f) + cell(i + 1, j) * f) * (1 - g) + (cell(i, j + 1) * (1 - f) + cell(i + 1, j + 1) * f) * g;
}

function block_of(state) {
  const floats = new Float32Array(state.buffer), solid = state.parts[0], water = state.parts[2];
  let lowest = Infinity, highest = -Infinity;
  for (let j = 0; j < state.ny; j++) {
    for (let i = 0; i < state.nx; i++) {
      const ground = floats[solid.offset + j * solid.row + i];
      lowest = Math.min(lowest, ground);
      highest = Math.max(highest, ground + floats[water.offset + j * water.row + i]);
    }
  }
  const lengths = [state.nx * state.dx, state.ny * state.dx], longest = Math.max(...lengths);
  return { low: [0, 0, lowest - 0.03 * longest], high: [...lengths, Math.max(highest, lowest + 0.02 * longest)] };
}

const aspect = () => innerWidth / innerHeight;

function place_camera() {
  const [yaw, pitch, share, east, north] = page.levels[page.name].camera;
  // A tall picture shows a part of the block: all of its width would be a strip.
  page.camera.place([yaw, pitch, aspect() < 1 ? 0.62 * share : share, east, north], page.block, aspect());
}

// ---- Levels and links ----

const files = new Map();
async function fetch_bytes(path) {
  if (!files.has(path)) {
    const answer = await fetch(path);
    if (!answer.ok) throw new Error(`${path}: the server says ${answer.status}`);
    files.set(path, new Uint8Array(await answer.arrayBuffer()));
  }
  return files.get(path);
}

async function open_level(name, { variant = "", accuracy, draws, camera = true } = {}) {
  page.busy = true;
  const level = page.levels[name];
  if (!level) throw new Error(`There is no level "${name}" here.`);
  const folder = `levels/${name}/`;
  const text = new TextDecoder().decode(await fetch_bytes(folder + "level.json"));
  const maps = await Promise.all(level.files.map(async (file) => ({ name: file, bytes: await fetch_bytes(folder + file) })));
  accuracy ??= level.accuracy[page.threads > 1 ? 0 : 1];
  draws ??= level.foam === false ? ALL_DRAWS - 1 : ALL_DRAWS;
  const state = await ask("open", { text, files: maps, variant, accuracy, draws });
  const other = page.name !== name;
  Object.assign(page, { name, variant, accuracy, draws, costs: other ? {} : page.costs });
  page.block = block_of(state);
  state.lowest = page.block.low[2];
  take(state);
  page.material = await ask("material", NUMBERS);
  page.begun_material = { ...page.material };
  page.hand.enter(state, page.material.porosity);
  if (camera && other) place_camera();
  page.busy = false;
  show_level();
}

async function open_link(link) {
  await open_level(link.level, link);
  if (link.steps === 0) return;
  page.busy = true;
  cover("doing what the link's maker did", 0, true);
  on_progress = ({ share, frame }) => {
    take(frame);
    cover("doing what the link's maker did", share, true);
  };
  try {
    take(await ask("replay", { log: link.log, steps: link.steps }));
  } finally {
    on_progress = null;
  }
  page.material = await ask("material", Object.keys(page.material));
  show_options();
  cover(null);
  page.same = page.state.hash === link.hash;
  set_paused(true);
  const other = `This is another state than the link's: ${page.state.hash}, not ${link.hash}.`;
  tell_shared(page.same ? `The same state, to the bit: ${link.hash}. Press Space to go on.` : `${other} Page and link are of different versions.`);
  page.busy = false;
}

function tell_shared(text) {
  at("shared").hidden = text === "";
  at("shared").textContent = text;
}

async function share() {
  const { log, steps, hash } = await ask("log");
  const { name: level, variant, accuracy, draws } = page;
  const fragment = await to_fragment({ level, variant, accuracy, draws, steps, hash, log });
  history.replaceState(null, "", "#" + fragment);
  page.link = location.href;
  const letters = page.link.length, size = letters < 2000 ? `${letters} characters` : `${(letters / 1000).toFixed(1)} thousand characters`;
  try {
    await navigator.clipboard.writeText(page.link);
    tell_shared(`Copied: ${size}.`);
  } catch {
    tell_shared(`It is in the address bar now: ${size}.`);
  }
}

// ---- Panel ----

function fill(select, words, chosen) {
  const made = ([value, textContent, title = ""]) => Object.assign(document.createElement("option"), { value, textContent, title });
  select.replaceChildren(...words.map(made));
  select.value = chosen;
}

function show_level() {
  const level = page.levels[page.name];
  fill(at("level"), Object.entries(page.levels).map(([name, { title }]) => [name, title]), page.name);
  const presets = Object.entries(level.variants).map(([name, about]) => [name, name.replaceAll("_", " "), about]);
  fill(at("variant"), [["", "as it is"], ...presets], page.variant);
  at("variant").disabled = Object.keys(level.variants).length === 0;
  fill(at("sand"), [["", "the level's"], ...SANDS.map((sand) => [sand.name, `${sand.name}: ${sand.about}`])], "");
  at("about").textContent = page.variant ? level.variants[page.variant] : level.about;
  const { nx, ny, dx } = page.state;
  at("cells").textContent = `${nx} × ${ny} of ${dx.toFixed(2)} m`;
  hint_until = Infinity;
  show_options();
}

const cost_text = (milliseconds) => (milliseconds === undefined ? "" : `${milliseconds.toFixed(2)} ms`);
const is_on = (effect) => Object.keys(effect.numbers).some((name) => page.material[name] > 0);

// The numbers of the material by which an effect is on, as the level has them, or off.
function switched(effect, on) {
  return Object.fromEntries(Object.entries(effect.numbers).map(([name, value]) => [name, on ? page.begun_material[name] || value : 0]));
}

function option(type, name, text, checked, cost, act) {
  const label = document.createElement("label"), input = document.createElement("input"), ms = document.createElement("span");
  label.className = "option";
  Object.assign(input, { type, name, checked, onchange: () => act(input.checked).catch(fail) });
  ms.className = "ms";
  ms.textContent = cost;
  label.append(input, text, ms);
  return label;
}

function show_options() {
  at("accuracies").replaceChildren(...["draft", "balanced", "accurate"].map((name) => {
    const { cost, dt } = page.costs[name] ?? {};
    const told = cost === undefined ? "" : `${cost.toFixed(1)} of ${(1e3 * dt).toFixed(1)} ms`;
    return option("radio", "accuracy", name, page.accuracy === name, told, () => restart({ accuracy: name }));
  }));
  const effects = EFFECTS.map((effect) => {
    const { with: more, without } = page.costs[effect.name] ?? {};
    return option("checkbox", effect.name, effect.title, is_on(effect), cost_text(more - without || undefined), async (on) => {
      const numbers = switched(effect, on);
      await ask("set_material", numbers);
      Object.assign(page.material, numbers);
    });
  });
  const { with: more, without } = page.costs.draws ?? {};
  const seen = option("checkbox", "draws", "foam, mud and wet ground (begins again)", page.draws !== 0, cost_text(more - without || undefined),
    (on) => restart({ draws: on ? undefined : 0 }));
  at("effects").replaceChildren(...effects, seen);
}

let measuring = false;
async function measure() {
  if (measuring || page.busy) return;
  measuring = true;
  at("measure").textContent = "measuring";
  try {
    const { name, accuracy, draws } = page, on = Object.fromEntries(EFFECTS.map((effect) => [effect.name, is_on(effect)]));
    const numbers = Object.fromEntries(EFFECTS.map((effect) => [effect.name, switched(effect, !on[effect.name])]));
    const starts = { draws: { accuracy, draws: draws ? 0 : ALL_DRAWS } };
    for (const key of ["draft", "balanced", "accurate"]) starts[key] = { accuracy: key, draws };
    const found = await ask("costs", { numbers, starts });
    if (name !== page.name) return;
    const pair = (here, there, is) => (is ? { with: here, without: there } : { with: there, without: here });
    for (const effect of EFFECTS) page.costs[effect.name] = pair(...found[effect.name], on[effect.name]);
    page.costs.draws = pair(found[accuracy], found.draws, draws !== 0);
    const factor = { draft: 2, balanced: 1, accurate: 0.5 }, level_dt = page.state.dt / factor[accuracy];
    for (const key of Object.keys(factor)) page.costs[key] = { cost: found[key], dt: level_dt * factor[key] };
    show_options();
  } finally {
    measuring = false;
    at("measure").textContent = "measure again";
  }
}

async function restart({ accuracy = page.accuracy, draws = page.draws, variant = page.variant } = {}) {
  if (page.busy) return;
  history.replaceState(null, "", location.pathname + location.search);
  tell_shared("");
  await open_level(page.name, { variant, accuracy, draws });
  set_paused(false);
}

function set_paused(paused) {
  page.paused = paused;
  at("pause").textContent = paused ? "go on" : "pause";
}

function choose_tool(name) {
  page.hand.tool = name;
  for (const button of at("tools").children) button.setAttribute("aria-pressed", String(button.dataset.tool === name));
}

function fold(folded) {
  at("panel").classList.toggle("folded", folded);
  at("fold").setAttribute("aria-expanded", String(!folded));
  resize();
}

async function undo() {
  if (page.busy) return;
  page.hand.release(false);
  await sent; // what is under way comes first
  take(await ask("undo", { buffer: null }));
  page.material = await ask("material", Object.keys(page.material));
  show_options();
}

// ---- Time ----

let sent = Promise.resolve(), under_way = false, last_sent = performance.now(), frames = [], simulated = [], one_step = false;

// Asks for the next state once the last one is there. The clock is the wall's; what the worker has no time for is left out.
function advance() {
  const now = performance.now();
  if (page.busy || document.hidden) last_sent = now;
  if (page.busy || document.hidden || under_way) return;
  const seconds = Math.min((now - last_sent) / 1000, 0.25), list = page.hand.act(Math.min(seconds, 0.1));
  const acts = list.length > 0, buffer = spare, transfer = buffer ? [buffer] : [];
  last_sent = now;
  if (page.paused && !acts && !one_step) return;
  spare = null;
  under_way = true;
  const asked = page.paused ? ask("step", { list, steps: 1, buffer }, transfer) : ask("advance", { list, seconds, buffer }, transfer);
  one_step = false;
  sent = asked.then((state) => {
    under_way = false;
    if (page.busy) return;
    state.lowest = page.block.low[2];
    simulated.push([performance.now(), state.time]);
    take(state);
    setTimeout(advance, Math.max(0, 14 - (performance.now() - now)));
  }).catch(fail);
}

// ---- Pictures ----

function draw() {
  const { camera, block } = page;
  if (fresh) renderer.upload(page.state);
  fresh = false;
  const moving = performance.now() / 1000;
  const { sun } = page.levels[page.name];
  const look = { camera, block, time: moving % 3600, sun_azimuth: sun[0], sun_elevation: sun[1], quality, foam_drifts: (page.draws & 1) !== 0 };
  renderer.draw(look, scale);
  draw_marks();
}

// What the tool would change, as a line on the ground.
function draw_marks() {
  const canvas = at("marks"), ink = canvas.getContext("2d"), { hand, camera } = page;
  ink.clearRect(0, 0, canvas.width, canvas.height);
  if (!hand.place || hand.tool === "look" || page.busy) return;
  const [x, y] = hand.place, line = [], begun = hand.tool === "wall" && hand.begun ? hand.begun : hand.place;
  const turn = Math.atan2(y - begun[1], x - begun[0]);
  const around = hand.tool === "castle" ? [[-3, -3], [3, -3], [3, 3], [-3, 3], [-3, -3]].flatMap(([a, b], n, all) => {
    const [c, d] = all[Math.min(n + 1, 4)];
    return [0, 0.25, 0.5, 0.75].map((f) => [x + hand.radius * (a + f * (c - a)), y + hand.radius * (b + f * (d - b))]);
  }) : Array.from({ length: 49 }, (_, n) => {
    const angle = turn - Math.PI / 2 + (n / 48) * 2 * Math.PI, end = n <= 24 ? hand.place : begun;
    return [end[0] + hand.radius * Math.cos(angle), end[1] + hand.radius * Math.sin(angle)];
  });
  if (hand.tool !== "castle") around.push(around[0]);
  for (const [a, b] of around) {
    const seen = camera.seen([a, b, surface_at(a, b)], aspect());
    if (seen) line.push([seen[0] * canvas.width, seen[1] * canvas.height]);
  }
  const pixel = canvas.width / innerWidth;
  for (const [width, colour] of [[4, "rgb(0 0 0 / 35%)"], [2, hand.pressed ? "#fff" : "#ffcf6b"]]) {
    ink.beginPath();
    line.forEach(([a, b], n) => (n === 0 ? ink.moveTo(a, b) : ink.lineTo(a, b)));
    ink.lineWidth = width * pixel;
    ink.strokeStyle = colour;
    ink.stroke();
  }
}

function resize() {
  const ratio = Math.min(devicePixelRatio || 1, 1.5);
  for (const id of ["picture", "marks"]) { // setting them clears them
    at(id).width = Math.max(1, Math.round(innerWidth * ratio));
    at(id).height = Math.max(1, Math.round(innerHeight * ratio));
  }
  page.camera.shift = at("panel").classList.contains("folded") || innerWidth <= 700 ? 0 : -330 / innerWidth;
  changed = true;
}

// Fewer pixels where pictures take long, more where there is time; far too long ones count at once.
function adapt(took) {
  if (fixed_scale) return;
  slow = took > 3 * PICTURE_BUDGET[1] ? took : slow + 0.1 * (took - slow);
  if (slow > PICTURE_BUDGET[1]) {
    scale = Math.max(LEAST_SCALE, scale * Math.max(0.5, Math.sqrt(PICTURE_BUDGET[1] / slow)));
    slow = 0.5 * (PICTURE_BUDGET[0] + PICTURE_BUDGET[1]);
  } else if (slow < PICTURE_BUDGET[0] && scale < 1) {
    scale = Math.min(1, scale * 1.02);
  }
}

let last_picture = 0, slow = 30;
function every_picture(now) {
  requestAnimationFrame(every_picture);
  if (!page.state) return;
  keys_held((now - last_picture) / 1000);
  advance();
  // Water at rest ripples; with the world paused one picture in four is enough.
  if (!changed && (page.busy || (page.paused && page.pictures++ % 4 !== 0))) return;
  changed = false;
  const took = now - last_picture;
  last_picture = now;
  if (page.pictures > 1 && took < 5000) adapt(took);
  frames.push(now);
  draw();
  if (page.pictures++ === 0) {
    page.first_picture = performance.now();
    cover(null);
  }
}

let hint_until = Infinity;
function every_quarter_second() {
  if (!page.state || page.busy) return;
  const now = performance.now();
  frames = frames.filter((time) => now - time < 2000);
  simulated = simulated.filter(([time]) => now - time < 2000);
  const { state } = page;
  const passed = simulated.length > 1 ? (simulated.at(-1)[1] - simulated[0][1]) / ((simulated.at(-1)[0] - simulated[0][0]) / 1000) : 0;
  at("step").textContent = `${state.milliseconds.toFixed(1)} of ${(1000 * state.dt).toFixed(1)} ms`;
  at("speed").textContent = page.paused ? "paused" : passed > 0.97 ? "real time" : `${passed.toFixed(2)} × real time`;
  at("pictures").textContent = `${Math.round(frames.length / 2)} /s, ${Math.round(100 * scale)} % fine`;
  at("time").textContent = `${state.time.toFixed(1)} s, step ${state.steps}`;
  at("hash").textContent = state.hash;
  at("hash").title = `of step ${state.hash_step}`;
  at("undo").disabled = state.undo === 0;
  const level = page.levels[page.name];
  let hint = level.hint;
  if (level.waves) {
    const { first, period } = level.waves;
    const left = state.time < first ? first - state.time : period - ((state.time - first) % period);
    hint += `; the next wave comes in ${Math.ceil(left)}\u00a0s`;
  }
  if (page.hand.pressed && hint_until === Infinity) hint_until = now + 20000;
  at("hint").textContent = now < hint_until || level.waves ? hint : "";
  if (at("costs").open && Object.keys(page.costs).length === 0) measure().catch(fail);
}

// ---- Hand ----

const pointers = new Map();
let turning = null; // what the pointers turn or move: "turn", "move" or null

function place_of(event) {
  const along = page.camera.ray(event.clientX / innerWidth, event.clientY / innerHeight, aspect());
  return page.state ? (meet(page.state, surface_at, page.camera.eye(), along)?.slice(0, 2) ?? null) : null;
}

function listen() {
  const picture = at("picture"), { camera, hand } = page;
  picture.addEventListener("contextmenu", (event) => event.preventDefault());
  picture.addEventListener("pointerdown", (event) => {
    event.preventDefault();
    picture.focus({ preventScroll: true });
    picture.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, event);
    if (pointers.size === 2) { // a second finger: what the first began was none of the tool's
      hand.release(false);
      turning = "turn";
    } else if (event.button === 0 && hand.tool !== "look") {
      hand.press(place_of(event));
    } else {
      turning = event.button === 1 || event.shiftKey ? "move" : "turn";
    }
  });
  picture.addEventListener("pointermove", (event) => {
    const before = pointers.get(event.pointerId);
    if (before && turning) {
      const dx = (event.clientX - before.clientX) / innerHeight, dy = (event.clientY - before.clientY) / innerHeight;
      if (pointers.size === 2) {
        const other = [...pointers.values()].find((pointer) => pointer.pointerId !== event.pointerId);
        const apart = (pointer) => Math.hypot(pointer.clientX - other.clientX, pointer.clientY - other.clientY);
        camera.zoom(apart(before) / Math.max(apart(event), 1), page.block);
        camera.orbit(1.5 * dx, -1.0 * dy);
      } else if (turning === "turn") {
        camera.orbit(3 * dx, -2.5 * dy);
      } else {
        camera.pan(-0.8 * dx, 0.8 * dy, page.block);
      }
      changed = true;
    }
    if (before) pointers.set(event.pointerId, event);
    if (!turning) {
      hand.move(place_of(event));
      changed = true;
    }
  });
  const up = (event) => {
    pointers.delete(event.pointerId);
    if (pointers.size > 0) return;
    if (!turning) hand.release();
    turning = null;
    if (event.pointerType === "touch") hand.place = null;
  };
  picture.addEventListener("pointerup", up);
  picture.addEventListener("pointercancel", up);
  picture.addEventListener("wheel", (event) => {
    event.preventDefault();
    camera.zoom(Math.exp(0.0012 * event.deltaY), page.block);
    changed = true;
  }, { passive: false });
  picture.addEventListener("webglcontextlost", (event) => {
    event.preventDefault();
    fail(new Error("The graphics card has let the page go. Load it again."));
  });
  addEventListener("resize", resize);
  addEventListener("hashchange", () => location.reload());

  at("level").onchange = () => open_level(at("level").value).then(() => set_paused(false)).catch(fail);
  at("variant").onchange = () => restart({ variant: at("variant").value }).catch(fail);
  at("sand").onchange = async () => {
    const sand = SANDS.find(({ name }) => name === at("sand").value), numbers = {};
    for (const name of Object.keys(SANDS[0].numbers)) numbers[name] = sand ? sand.numbers[name] : page.begun_material[name];
    await ask("set_material", numbers).catch(fail);
    Object.assign(page.material, numbers);
    show_options();
  };
  at("pause").onclick = () => set_paused(!page.paused);
  at("restart").onclick = () => restart().catch(fail);
  at("undo").onclick = () => undo().catch(fail);
  at("size").oninput = () => page.hand.resize(Number(at("size").value));
  at("share").onclick = () => share().catch(fail);
  at("measure").onclick = () => measure().catch(fail);
  at("fold").onclick = () => fold(!at("panel").classList.contains("folded"));
}

// What is in the middle of the picture: where arrow keys begin to aim.
function middle_place() {
  return meet(page.state, surface_at, page.camera.eye(), page.camera.ray(0.5, 0.5, aspect()))?.slice(0, 2) ?? null;
}

// Keys that act while they are held: the aim, the tool, the view.
const held = new Set();
function keys_held(seconds) {
  const { camera, hand, state } = page, speed = Math.min(seconds, 0.1);
  if (held.size === 0) return;
  const has = (key) => (held.has(key) ? 1 : 0);
  const across = has("ArrowRight") - has("ArrowLeft"), ahead = has("ArrowUp") - has("ArrowDown");
  if (across || ahead) {
    const from = hand.place ?? middle_place();
    if (from) {
      const step = 0.6 * camera.distance * speed, sin = Math.sin(camera.yaw), cos = Math.cos(camera.yaw);
      const to = [from[0] + step * (across * cos + ahead * sin), from[1] + step * (-across * sin + ahead * cos)];
      hand.move([Math.min(Math.max(to[0], 0), state.nx * state.dx), Math.min(Math.max(to[1], 0), state.ny * state.dx)]);
    }
  }
  camera.orbit(1.2 * speed * (has("d") - has("a")), 0.8 * speed * (has("w") - has("s")));
  if (has("+") - has("-")) camera.zoom(Math.exp(speed * (has("-") - has("+"))), page.block);
  changed = true;
}

function listen_to_keys() {
  addEventListener("keydown", (event) => {
    const { hand } = page;
    if (event.target instanceof HTMLSelectElement || event.target instanceof HTMLInputElement) return;
    if (event.target instanceof HTMLButtonElement && (event.key === "Enter" || event.key === " ")) return;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    if ((event.ctrlKey || event.metaKey) && key === "z") {
      event.preventDefault();
      undo().catch(fail);
      return;
    }
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const tool = TOOLS.find((tool) => tool.key === key);
    if (tool) choose_tool(tool.name);
    else if (key === " ") set_paused(!page.paused);
    else if (key === ".") one_step = true;
    else if (key === "r") restart().catch(fail);
    else if (key === "Tab") fold(!at("panel").classList.contains("folded"));
    else if (key === "[" || key === "]") {
      hand.resize(hand.size * (key === "]" ? 1.15 : 1 / 1.15));
      at("size").value = hand.size;
    } else if (key === "Enter") {
      if (!event.repeat) hand.press(hand.place ?? middle_place());
    } else if (["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown", "a", "d", "w", "s", "+", "-", "="].includes(key)) {
      held.add(key === "=" ? "+" : key);
    } else {
      return;
    }
    event.preventDefault();
  });
  addEventListener("keyup", (event) => {
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    held.delete(key === "=" ? "+" : key);
    if (key === "Enter") page.hand.release();
  });
  addEventListener("blur", () => held.clear());
}

function make_tools() {
  at("tools").replaceChildren(...TOOLS.map((tool) => {
    const button = document.createElement("button");
    button.title = `${tool.title}: ${tool.help} (${tool.key})`;
    button.innerHTML = `${ICONS[tool.name]}<kbd>${tool.key}</kbd>`;
    button.onclick = () => choose_tool(tool.name);
    button.dataset.tool = tool.name;
    button.setAttribute("aria-label", tool.title);
    return button;
  }));
  choose_tool("dig");
}

async function begin() {
  make_tools();
  fold(innerWidth <= 700 || innerHeight <= 460);
  resize();
  const words = new URLSearchParams(location.search);
  const cores = navigator.hardwareConcurrency || 2;
  page.threads = self.crossOriginIsolated && !words.has("single") ? Math.min(Math.max(cores - 1, 2), MOST_THREADS) : 1;
  if (QUALITIES[words.get("quality")]) quality = words.get("quality");
  if (words.has("scale")) fixed_scale = scale = Math.min(Math.max(Number(words.get("scale")) || 1, LEAST_SCALE), 1);
  const started = ask("start", { threads: page.threads });
  renderer = new Renderer(at("picture"));
  if (renderer.software && !fixed_scale) scale = LEAST_SCALE;
  page.levels = await (await fetch("levels.json")).json();
  const link = await from_fragment(location.hash);
  fetch_bytes(`levels/${link?.level ?? "beach"}/level.json`).catch(() => {}); // told of when it is opened
  await started;
  while (!renderer.ready()) await new Promise((resolve) => setTimeout(resolve, 10));
  renderer.finish_programs();
  const alone = self.crossOriginIsolated ? "one thread" : "one thread: this server sends no headers for more";
  at("how").textContent = page.threads > 1 ? `${page.threads} threads` : alone;
  requestAnimationFrame(every_picture);
  setInterval(every_quarter_second, 250);
  if (link) await open_link(link);
  else await open_level("beach");
  listen();
  listen_to_keys();
}

begin().catch(fail);
