// The viewer's passes in WebGL 2 (samples/viewer/renderer.cpp): those over cells once per state, those over pixels once per picture.
import texts from "./shaders.js";

const VERTICES = `#version 300 es
void main() { gl_Position = vec4(vec2(float((gl_VertexID << 1) & 2), float(gl_VertexID & 2)) * 2.0 - 1.0, 0.0, 1.0); }`;

// Texture units of the samplers of the shaders.
const UNITS = ["heights", "slopes", "matter", "flow", "light", "pyramid", "summit_image", "noise_image", "seen_picture", "colour_picture",
  "sand_surface", "sand_depth", "water_depth", "saturation", "foam", "water_velocity", "sand_velocity", "wetness", "silt",
  "host_field"];
// The plugin's outputs in the order of page.h.
const SOURCES = ["sand_surface", "sand_depth", "water_depth", "saturation", "foam", "water_velocity", "sand_velocity", "wetness",
  "silt"];
const NOISE = 64;

// Presets of samples/viewer/look.cpp: steps of rays, of reflections, of refractions, sky sectors, octaves of a pattern.
export const QUALITIES = { low: [192, 32, 32, 6, 4], medium: [256, 64, 64, 8, 6], high: [512, 128, 128, 16, 8] };

export class Renderer {
  constructor(canvas) {
    const gl = canvas.getContext("webgl2", { antialias: false, alpha: false, depth: false, powerPreference: "high-performance" });
    if (!gl) throw new Error("This browser has no WebGL 2, by which the page draws.");
    const floats = "EXT_color_buffer_float"; // by which passes draw into pictures of floats
    if (!gl.getExtension(floats)) throw new Error(`This device lacks ${floats}, by which the page draws.`);
    this.gl = gl;
    this.canvas = canvas;
    this.linear_floats = gl.getExtension("OES_texture_float_linear") !== null;
    const names = gl.getExtension("WEBGL_debug_renderer_info");
    this.software = names !== null && /swiftshader|llvmpipe|software/i.test(gl.getParameter(names.UNMASKED_RENDERER_WEBGL));
    this.programs = {};
    this.parallel = gl.getExtension("KHR_parallel_shader_compile");
    const vertices = this.#shader(gl.VERTEX_SHADER, VERTICES);
    for (const [name, text] of Object.entries(texts)) {
      const program = gl.createProgram(), fragments = this.#shader(gl.FRAGMENT_SHADER, text);
      gl.attachShader(program, vertices);
      gl.attachShader(program, fragments);
      gl.linkProgram(program);
      this.programs[name] = { program, fragments };
    }
    this.vertices = gl.createVertexArray();
    this.frame = gl.createBuffer();
    this.params = new ArrayBuffer(33 * 16);
    this.textures = {};
    this.targets = {};
    this.grid = null;
    this.size = [0, 0];
  }

  #shader(type, text) {
    const gl = this.gl, shader = gl.createShader(type);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    return shader;
  }

  /** Whether the driver has compiled all programs; asks without waiting where the browser can. */
  ready() {
    if (!this.parallel) return true;
    return Object.values(this.programs).every(({ program }) => this.gl.getProgramParameter(program, this.parallel.COMPLETION_STATUS_KHR));
  }

  /** Takes the compiled programs; once. */
  finish_programs() {
    const gl = this.gl;
    for (const [name, made] of Object.entries(this.programs)) {
      if (!gl.getProgramParameter(made.program, gl.LINK_STATUS)) {
        const why = gl.getShaderInfoLog(made.fragments) || gl.getProgramInfoLog(made.program);
        throw new Error(`The shader "${name}" cannot be compiled here: ${why}`);
      }
      gl.useProgram(made.program);
      UNITS.forEach((sampler, unit) => {
        const place = gl.getUniformLocation(made.program, sampler);
        if (place) gl.uniform1i(place, sampler === "host_field" ? UNITS.indexOf("sand_depth") : unit);
      });
      const block = gl.getUniformBlockIndex(made.program, "Frame");
      if (block !== gl.INVALID_INDEX) gl.uniformBlockBinding(made.program, block, 0);
      for (const word of ["level", "row_offset", "picture_size"]) made[word] = gl.getUniformLocation(made.program, word);
    }
    this.#bake();
  }

  #texture(name, format, width, height, linear) {
    const gl = this.gl;
    if (this.textures[name]) gl.deleteTexture(this.textures[name]);
    const texture = (this.textures[name] = gl.createTexture());
    gl.activeTexture(gl.TEXTURE0 + Math.max(UNITS.indexOf(name), 0));
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texStorage2D(gl.TEXTURE_2D, 1, format, width, height);
    const filter = linear ? gl.LINEAR : gl.NEAREST;
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, filter);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, filter);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
  }

  #target(name, ...textures) {
    const gl = this.gl;
    if (this.targets[name]) gl.deleteFramebuffer(this.targets[name]);
    this.targets[name] = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.targets[name]);
    textures.forEach((texture, n) => {
      gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0 + n, gl.TEXTURE_2D, this.textures[texture], 0);
    });
    gl.drawBuffers(textures.map((_, n) => gl.COLOR_ATTACHMENT0 + n));
    if (gl.checkFramebufferStatus(gl.FRAMEBUFFER) !== gl.FRAMEBUFFER_COMPLETE) throw new Error(`This device cannot draw into "${name}".`);
  }

  #pass(name, target, width, height, words = {}) {
    const gl = this.gl, made = this.programs[name];
    gl.useProgram(made.program);
    gl.bindFramebuffer(gl.FRAMEBUFFER, target === null ? null : this.targets[target]);
    gl.viewport(0, 0, width, height);
    if (made.level) gl.uniform1i(made.level, words.level ?? 0);
    if (made.row_offset) gl.uniform1i(made.row_offset, words.row_offset ?? 0);
    if (made.picture_size) gl.uniform2i(made.picture_size, width, height);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  // Gradient noise in space, slice by slice.
  #bake() {
    const gl = this.gl, texture = gl.createTexture(), target = gl.createFramebuffer();
    gl.bindVertexArray(this.vertices);
    gl.bindBufferBase(gl.UNIFORM_BUFFER, 0, this.frame);
    gl.bufferData(gl.UNIFORM_BUFFER, this.params.byteLength, gl.DYNAMIC_DRAW);
    gl.activeTexture(gl.TEXTURE0 + UNITS.indexOf("noise_image"));
    gl.bindTexture(gl.TEXTURE_3D, texture);
    gl.texStorage3D(gl.TEXTURE_3D, 1, gl.RGBA16F, NOISE, NOISE, NOISE);
    for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_3D, filter, gl.LINEAR);
    this.targets.noise = target;
    gl.bindFramebuffer(gl.FRAMEBUFFER, target);
    for (let slice = 0; slice < NOISE; slice++) {
      gl.bindFramebuffer(gl.FRAMEBUFFER, target);
      gl.framebufferTextureLayer(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, texture, 0, slice);
      this.#pass("bake", "noise", NOISE, NOISE, { row_offset: slice * NOISE });
    }
  }

  #enter({ nx, ny, dx }) {
    const gl = this.gl, floats = gl.RGBA32F, halves = gl.RGBA16F;
    this.grid = { nx, ny, dx };
    for (const name of SOURCES) this.#texture(name, name.endsWith("velocity") ? gl.RG32F : gl.R32F, nx, ny, false);
    this.#texture("heights", floats, nx, ny, this.linear_floats);
    for (const name of ["slopes", "matter", "flow", "light"]) this.#texture(name, halves, nx, ny, true);
    this.levels = 1;
    while ((Math.max(nx, ny) + 1) >> this.levels >= 8) this.levels++;
    const block = 1 << this.levels;
    this.base = [Math.floor((nx + block) / block) * block, Math.floor((ny + block) / block) * block];
    this.#texture("pyramid", gl.R32F, this.base[0], this.base[1] * 1.5, false);
    this.#texture("scratch", gl.R32F, this.base[0] / 2, this.base[1] / 2, false);
    this.#texture("summit_image", gl.R32F, 1, 1, false);
    this.#target("cells", "heights", "matter", "flow");
    this.#target("slopes", "slopes");
    this.#target("base", "pyramid");
    this.#target("reduced", "scratch");
    this.#target("summit", "summit_image");
    this.#target("light", "light");
    this.#bind();
  }

  #bind() {
    const gl = this.gl;
    UNITS.forEach((name, unit) => {
      if (!this.textures[name]) return;
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(gl.TEXTURE_2D, this.textures[name]);
    });
  }

  #resize(width, height) {
    if (this.size[0] === width && this.size[1] === height) return;
    this.size = [width, height];
    this.#texture("seen_picture", this.gl.RGBA32F, width, height, false);
    this.#texture("colour_picture", this.gl.RGBA16F, width, height, false);
    this.#target("see", "seen_picture");
    this.#target("shade", "colour_picture");
    this.#bind();
  }

  // samples/viewer/look.cpp: frame_params.
  #write_params(look, width, height) {
    const f = new Float32Array(this.params), n = new Int32Array(this.params), { grid } = this, { camera, block } = look;
    const lengths = [grid.nx * grid.dx, grid.ny * grid.dx], longest = Math.max(...lengths);
    const tan_up = Math.tan(0.5 * camera.field), tan_right = (tan_up * width) / height;
    const azimuth = (look.sun_azimuth * Math.PI) / 180, elevation = (look.sun_elevation * Math.PI) / 180;
    const sun = [Math.sin(azimuth) * Math.cos(elevation), Math.cos(azimuth) * Math.cos(elevation), Math.sin(elevation)];
    const share = Math.min(Math.max(sun[2] / 0.6, 0), 1), low_sun = 1 - share * share * (3 - 2 * share);
    const mix = (a, b) => a.map((value, k) => value + low_sun * (b[k] - value));
    const clarity = 0.02 * longest;
    const quality = QUALITIES[look.quality];
    const rows = [
      [...camera.eye(), 1],
      [...camera.right().map((x) => x * tan_right), 0],
      [...camera.up().map((x) => x * tan_up), 0],
      [...camera.forward().map((x, k) => x - camera.right()[k] * tan_right * camera.shift), 0],
      [...sun, 0.05],
      [...mix([2.6, 2.35, 2.0], [2.6, 1.6, 0.85]), 0.72],
      [0.2, 0.36, 0.72, 1.25],
      [0.62, 0.76, 0.94, look.time],
      [0.335, 0.315, 0.285, block.low[2]],
      [grid.dx, ...lengths, quality[4]],
      [0, 0, 1, (2 * tan_up) / height],
      [2.6 / clarity, 1.1 / clarity, 0.9 / clarity, Math.max(0.004 * grid.dx, 1e-4)],
      [0.01, 0.085, 0.11, 1],
      [0.56, 0.355, 0.165, 1.2],
      [0.155, 0.085, 0.04, 0.5],
      [0.215, 0.185, 0.155, 0.15 * grid.dx],
      [0, 1, longest / 40, longest / 160],
      [0, 0, 0, 0],
    ];
    rows.forEach((row, k) => f.set(row, 4 * k));
    n.set([grid.nx, grid.ny, this.levels, this.base[0]], 4 * 18);
    n.set([width, height, 0, this.base[1]], 4 * 19);
    n.set(quality.slice(0, 4), 4 * 20);
    n.set([0, 0, 0, 1], 4 * 21);
    n.set([-1, look.foam_drifts ? 1 : 0, 0, 0], 4 * 22);
    const gl = this.gl;
    gl.bindBuffer(gl.UNIFORM_BUFFER, this.frame);
    gl.bufferSubData(gl.UNIFORM_BUFFER, 0, this.params);
  }

  /** Brings a state of the worker to the device. */
  upload(state) {
    const gl = this.gl;
    if (!this.grid || this.grid.nx !== state.nx || this.grid.ny !== state.ny || this.grid.dx !== state.dx) this.#enter(state);
    SOURCES.forEach((name, k) => {
      const part = state.parts[k], two = name.endsWith("velocity");
      gl.activeTexture(gl.TEXTURE0 + UNITS.indexOf(name));
      gl.pixelStorei(gl.UNPACK_ROW_LENGTH, part.row);
      const floats = new Float32Array(state.buffer, 4 * part.offset, part.length);
      gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, state.nx, state.ny, two ? gl.RG : gl.RED, gl.FLOAT, floats);
    });
    gl.pixelStorei(gl.UNPACK_ROW_LENGTH, 0);
    this.fresh = true;
  }

  /** Draws the newest state, `scale` of the canvas' sides in pixels of its own. look: camera, block, time [s], sun, quality, foam_drifts. */
  draw(look, scale) {
    const gl = this.gl, { canvas, grid, base } = this;
    const width = Math.max(1, Math.round(canvas.width * scale)), height = Math.max(1, Math.round(canvas.height * scale));
    this.#resize(width, height);
    this.#write_params(look, width, height);
    if (this.fresh) {
      this.fresh = false;
      this.#pass("prepare", "cells", grid.nx, grid.ny);
      this.#pass("slopes", "slopes", grid.nx, grid.ny);
      this.#pass("base", "base", base[0], base[1]);
      for (let level = 1; level < this.levels; level++) {
        this.#pass("reduce", "reduced", base[0] >> level, base[1] >> level, { level });
        gl.activeTexture(gl.TEXTURE0 + UNITS.indexOf("pyramid"));
        gl.copyTexSubImage2D(gl.TEXTURE_2D, 0, base[0] - (base[0] >> (level - 1)), base[1], 0, 0, base[0] >> level, base[1] >> level);
      }
      this.#pass("summit", "summit", 1, 1);
      this.#pass("light", "light", grid.nx, grid.ny);
    }
    this.#pass("see", "see", width, height);
    this.#pass("shade", "shade", width, height);
    this.#pass("finish", null, canvas.width, canvas.height);
  }
}
