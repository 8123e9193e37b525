// What the page calculates without a browser: links, and the hand's edits. parts.py lays the scripts beside this one.
import assert from "node:assert/strict";
import { from_fragment, to_fragment } from "./link.mjs";
import { Hand, castle_image, meet } from "./tools.mjs";

const log = new Uint8Array(5000).map((_, n) => (n * n) % 251);
const link = { level: "beach", variant: "", accuracy: "draft", draws: 3, steps: 1234, hash: "0123456789abcdef", log };
const text = await to_fragment(link);
assert.match(text, /^[\w=&-]+$/, "letters that every address may have");
assert.deepEqual(await from_fragment("#" + text), link);
assert.deepEqual((await from_fragment(await to_fragment({ ...link, log: new Uint8Array(0) }))).log.length, 0);
assert.equal(await from_fragment(""), null);
assert.equal(await from_fragment("#keys"), null);
for (const [from, to] of [["steps=1234", "steps=-1"], ["level=beach", "level=../x"], ["hash=0123", "hash=012"], ["accuracy=draft", "accuracy=best"], ["&draws=3", ""]]) {
  await assert.rejects(from_fragment(text.replace(from, to)), /^Error: This link is damaged: /, `${from} to ${to}`);
}
await assert.rejects(from_fragment(text.slice(0, -20)), /its log cannot be read/);
const bomb = await to_fragment({ ...link, log: new Uint8Array(17 << 20) });
assert.ok(bomb.length < 40000);
await assert.rejects(from_fragment(bomb), /too long/);

const grid = { nx: 160, ny: 128, dx: 0.2 };
const hand = new Hand();
hand.enter(grid, 0.4);
assert.deepEqual(hand.act(0.1), [], "a hand that does nothing");
hand.press([3, 4]);
let list = hand.act(0.5);
assert.deepEqual(list.map(([kind]) => kind), ["stroke", "brush"]);
assert.ok(list[1].at(-1) < 0, "digging takes away");
hand.move([5, 4]);
assert.deepEqual(hand.act(0.01), [], "not for every hundredth of a second");
const moved = hand.act(0.49)[0];
assert.deepEqual(moved.slice(2, 6), [3, 4, 5, 4], "from the last place to this");
assert.equal(moved.at(-1), list[1].at(-1), "as much as for half a second at once");
hand.release();
assert.deepEqual(hand.act(0.5), []);
hand.tool = "damp";
hand.press([3, 4]);
list = hand.act(1);
assert.deepEqual(list.slice(1).map((edit) => edit[1]), [1, 2], "damp sand is sand and water");
assert.ok(Math.abs(list[2].at(-1) / list[1].at(-1) - 0.1) < 1e-3, "a quarter of 0.4");
hand.release();
hand.tool = "wall";
hand.press([1, 1]);
assert.deepEqual(hand.act(1), [["stroke"]], "a wall comes when it is let go");
hand.move([6, 1]);
hand.release();
assert.deepEqual(hand.act(1)[0].slice(0, 6), ["brush", 1, 1, 1, 6, 1]);
hand.press([1, 1]);
hand.release(false);
assert.deepEqual(hand.act(1), [], "a second finger ends the tool");

const castle = castle_image(32);
assert.ok(Math.max(...castle) > 0.75 && Math.min(...castle) === 0 && castle.every((height, n) => Math.abs(height - castle[32 * Math.floor(n / 32) + 31 - (n % 32)]) < 0.11));

const state = { ...grid, lowest: -1 }, slope = (x, y) => 0.1 * x + 0.05 * y;
const place = meet(state, slope, [10, -5, 8], [0, 0.8, -0.6]);
assert.ok(Math.abs(place[2] - slope(place[0], place[1])) < 1e-3, "on the ground");
assert.equal(meet(state, slope, [10, -5, 8], [0, 0.8, 0.6]), null, "into the sky");
assert.equal(meet(state, slope, [10, -5, 8], [0, -0.8, -0.6]), null, "beside the block");
