// What a hand does to the world: edits of wadi.h, as lists for the worker. Their sizes follow the level's.
const SAND = 1, WATER = 2; // wadi_layer
const DAMP = 0.25; // share of the pores that is full
const PAUSE = 0.04; // between the edits of a stroke [s]: links stay short
// Numbers of few bits, for the same reason: places to 4 mm, amounts to 0.2 mm.
const round_place = (place) => place.map((at) => Math.round(256 * at) / 256);
const round_amount = (amount) => Math.round(4096 * amount) / 4096;

/** In the order of the keys 1 ... 7. */
export const TOOLS = [
  { name: "dig", key: "1", title: "Dig", help: "takes sand away; the water in it stays" },
  { name: "damp", key: "2", title: "Damp sand", help: "pours sand that stands" },
  { name: "dry", key: "3", title: "Dry sand", help: "pours sand that runs" },
  { name: "wall", key: "4", title: "Wall", help: "drag from one end to the other" },
  { name: "castle", key: "5", title: "Castle", help: "presses a castle of damp sand onto the ground" },
  { name: "water", key: "6", title: "Water", help: "pours water" },
  { name: "look", key: "7", title: "Look round", help: "turns the view" },
];

// samples/viewer/stamps.cpp: x, y from -1 to 1.
function castle(x, y) {
  const across = Math.max(Math.abs(x), Math.abs(y)), along = Math.min(Math.abs(x), Math.abs(y));
  let height = across < 0.9 ? 0.12 : 0;
  if (across > 0.56 && across < 0.7) height = 0.5;
  if (across > 0.64 && across < 0.7 && along % 0.14 < 0.07) height = 0.58;
  if (Math.abs(x) < 0.1 && y < -0.5 && y > -0.75) height = 0.12;
  if (Math.hypot(Math.abs(x) - 0.63, Math.abs(y) - 0.63) < 0.17) height = 0.75;
  if (across < 0.26) height = 0.8;
  if (Math.hypot(x, y) < 0.13) height = 1;
  return height;
}

/** The castle as cells along each side, each the mean of 5 x 5 places. */
export function castle_image(cells) {
  const image = new Float32Array(cells * cells), parts = 5;
  for (let j = 0; j < cells; j++) {
    for (let i = 0; i < cells; i++) {
      let sum = 0;
      for (let part = 0; part < parts * parts; part++) {
        const x = i + ((part % parts) + 0.5) / parts, y = j + (Math.floor(part / parts) + 0.5) / parts;
        sum += castle((2 * x) / cells - 1, (2 * y) / cells - 1);
      }
      image[j * cells + i] = sum / (parts * parts);
    }
  }
  return image;
}

export class Hand {
  tool = "dig";
  size = 1; // 1 = as the level has it
  radius = 1; // [m]
  porosity = 0.4;
  grid = null;
  place = null; // where the pointer is on the ground, [x, y]
  last = null;
  begun = null;
  pressed = false;
  #waiting = [];
  #seconds = 0; // of the stroke that are not in an edit yet

  enter(grid, porosity) {
    this.grid = grid;
    this.porosity = porosity;
    this.base = 0.024 * Math.max(grid.nx, grid.ny) * grid.dx;
    this.resize(this.size);
    this.release(false);
  }
  resize(size) {
    this.size = Math.min(Math.max(size, 0.4), 4);
    this.radius = round_amount(Math.max(this.base * this.size, 1.5 * this.grid.dx));
  }

  press(place) {
    if (!place) return;
    place = round_place(place);
    this.#seconds = 0;
    this.pressed = true;
    this.place = this.begun = place;
    this.last = null;
    this.#waiting.push(["stroke"]);
    if (this.tool === "castle") this.#press_castle();
  }
  move(place) {
    if (place || !this.pressed) this.place = place && round_place(place);
  }
  release(act = true) {
    if (act && this.pressed && this.tool === "wall") {
      this.#add_sand(["brush", SAND, ...this.begun, ...this.place, 0.7 * this.radius, 0.25, 1.1 * this.radius]);
    }
    if (!act) this.#waiting = [];
    this.pressed = false;
    this.begun = this.last = null;
  }

  // Sand, and the water in the pores of damp sand. The amount is the last word.
  #add_sand(edit) {
    this.#waiting.push(edit);
    const water = [...edit];
    water[edit[0] === "stamp" ? 4 : 1] = WATER;
    water[water.length - 1] = round_amount(water[water.length - 1] * DAMP * this.porosity);
    this.#waiting.push(water);
  }

  #press_castle() {
    const { dx } = this.grid, cells = Math.max(12, Math.round((6 * this.radius) / dx));
    const [x, y] = this.place.map((at) => Math.round(at / dx - cells / 2) * dx);
    this.#add_sand(["stamp", castle_image(cells), cells, cells, SAND, x, y, x + cells * dx, y + cells * dx, 0.17 * cells * dx]);
  }

  /** The edits of so many seconds of the hand, to be sent to the worker. */
  act(seconds) {
    const list = this.#waiting.splice(0);
    if (!this.pressed || !this.place || !["dig", "damp", "dry", "water"].includes(this.tool)) return list;
    this.#seconds += seconds;
    if (this.#seconds < PAUSE) return list;
    const from = this.last ?? this.place, rate = this.radius * { dig: 1.6, damp: 1.2, dry: 1.2, water: 1 }[this.tool];
    const amount = round_amount((this.tool === "dig" ? -rate : rate) * this.#seconds);
    const edit = ["brush", this.tool === "water" ? WATER : SAND, ...from, ...this.place, this.radius, 1, amount];
    if (this.tool === "damp") {
      this.#add_sand(edit);
      list.push(...this.#waiting.splice(0));
    } else {
      list.push(edit);
    }
    this.last = this.place;
    this.#seconds = 0;
    return list;
  }
}

/** Where a ray meets the surface of a state, sand or water, as [x, y, z]; null where it meets none. */
export function meet(state, surface_at, eye, along) {
  const east = state.nx * state.dx, north = state.ny * state.dx, step = 0.5 * state.dx;
  let last = 0;
  for (let t = 0; t < 20 * (east + north); t += Math.max(step, 0.002 * t)) {
    const x = eye[0] + along[0] * t, y = eye[1] + along[1] * t, z = eye[2] + along[2] * t;
    if (x < 0 || y < 0 || x > east || y > north) {
      if (z < state.lowest) return null;
    } else if (z <= surface_at(x, y)) {
      let low = last, high = t;
      for (let turn = 0; turn < 10; turn++) {
        const middle = 0.5 * (low + high);
        if (eye[2] + along[2] * middle > surface_at(eye[0] + along[0] * middle, eye[1] + along[1] * middle)) low = middle;
        else high = middle;
      }
      const place = [0, 1, 2].map((axis) => eye[axis] + along[axis] * high);
      return place[0] >= 0 && place[1] >= 0 && place[0] <= east && place[1] <= north ? place : null;
    }
    last = t;
  }
  return null;
}
