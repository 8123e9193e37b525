// A state as a link: the level, how it was opened, and the command log, in the address behind #.
const WORDS = {
  level: /^[a-z_]+$/,
  variant: /^[a-z_]*$/,
  accuracy: /^(draft|balanced|accurate)$/,
  draws: /^[0-7]$/,
  steps: /^\d{1,9}$/,
  hash: /^[0-9a-f]{16}$/,
};
const MOST_LOG = 16 << 20; // bytes that a link may unfold to

function base64url(bytes) {
  let text = "";
  for (let n = 0; n < bytes.length; n += 0x8000) text += String.fromCharCode(...bytes.subarray(n, n + 0x8000));
  return btoa(text).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
}

function bytes_of(text) {
  const plain = atob(text.replaceAll("-", "+").replaceAll("_", "/"));
  return Uint8Array.from(plain, (letter) => letter.charCodeAt(0));
}

async function through(bytes, stream, most = Infinity) {
  const parts = [], reader = new Blob([bytes]).stream().pipeThrough(stream).getReader();
  let size = 0;
  for (;;) {
    const { done, value } = await reader.read();
    if (done) break;
    size += value.length;
    if (size > most) throw new Error("it is too long");
    parts.push(value);
  }
  const all = new Uint8Array(size);
  let at = 0;
  for (const part of parts) {
    all.set(part, at);
    at += part.length;
  }
  return all;
}

/** The text behind # for { level, variant, accuracy, draws, steps, hash, log }; log: the command log's bytes, may be empty. */
export async function to_fragment(state) {
  const words = Object.keys(WORDS).map((key) => `${key}=${state[key]}`);
  if (state.log.length > 0) words.push("log=" + base64url(await through(state.log, new CompressionStream("deflate-raw"))));
  return words.join("&");
}

/** What to_fragment was given; null where the address has no such text; throws an Error that says what is wrong with it. */
export async function from_fragment(text) {
  const found = new URLSearchParams(text.replace(/^#/, ""));
  if (!found.has("level")) return null;
  const state = {};
  for (const [key, allowed] of Object.entries(WORDS)) {
    const value = found.get(key);
    const told = value === null ? "missing" : `"${value}"`;
    if (value === null || !allowed.test(value)) throw new Error(`This link is damaged: ${key} is ${told}.`);
    state[key] = key === "steps" || key === "draws" ? Number(value) : value;
  }
  state.log = new Uint8Array(0);
  if (found.has("log")) {
    try {
      state.log = await through(bytes_of(found.get("log")), new DecompressionStream("deflate-raw"), MOST_LOG);
    } catch (error) {
      throw new Error(`This link is damaged: its log cannot be read (${error.message}).`);
    }
  }
  return state;
}
