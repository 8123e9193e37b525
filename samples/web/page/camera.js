// The viewer's camera (samples/viewer/camera.cpp). World axes: x east, y north, z up [m]; yaw 0 looks north.
const STEEPEST = 1.553;

export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const plus = (a, b, factor = 1) => [a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]];
const times = (a, factor) => [a[0] * factor, a[1] * factor, a[2] * factor];
const clamp = (value, low, high) => Math.min(Math.max(value, low), high);

export class Camera {
  field = 0.7; // angle of view, upright [radians]
  yaw = 0;
  pitch = -0.6;
  distance = 10;
  target = [0, 0, 0];
  shift = 0; // of the middle to the right, in half widths: beside a panel

  forward() {
    return [Math.sin(this.yaw) * Math.cos(this.pitch), Math.cos(this.yaw) * Math.cos(this.pitch), Math.sin(this.pitch)];
  }
  right() {
    return [Math.cos(this.yaw), -Math.sin(this.yaw), 0];
  }
  up() {
    const [a, b] = [this.right(), this.forward()];
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
  }
  eye() {
    return plus(this.target, this.forward(), -this.distance);
  }

  orbit(yaw, pitch) {
    this.yaw += yaw;
    this.pitch = clamp(this.pitch + pitch, -STEEPEST, -0.1);
  }
  /** Shares of the picture's height. The target stays over the block. */
  pan(across, up, block) {
    const ahead = [Math.sin(this.yaw), Math.cos(this.yaw), 0];
    this.target = plus(plus(this.target, this.right(), across * this.distance), ahead, up * this.distance);
    for (const axis of [0, 1]) this.target[axis] = clamp(this.target[axis], block.low[axis], block.high[axis]);
  }
  zoom(factor, block) {
    const longest = Math.max(block.high[0], block.high[1]);
    this.distance = clamp(this.distance * factor, 0.05 * longest, 3 * longest);
  }

  /** [yaw, pitch] in degrees, the share of the block that fills the picture, and what is in the middle (0 ... 1 east and north). */
  place([yaw, pitch, share, east, north], block, aspect) {
    const mix = (axis, part) => block.low[axis] + part * (block.high[axis] - block.low[axis]);
    const size = plus(block.high, block.low, -1);
    this.yaw = (yaw * Math.PI) / 180;
    this.pitch = (pitch * Math.PI) / 180;
    const middle = [mix(0, east), mix(1, north), mix(2, 0.35)];
    this.target = middle;
    this.distance = 2 * Math.hypot(...size);
    const tan_up = Math.tan(0.5 * this.field), tan_right = tan_up * aspect * (1 - Math.abs(this.shift));
    for (let turn = 0; turn < 12; turn++) {
      const low = [1e9, 1e9], high = [-1e9, -1e9];
      for (let corner = 0; corner < 8; corner++) {
        const half = size.map((length, axis) => 0.5 * share * length * (corner & (1 << axis) ? 1 : -1));
        const at = plus(plus(middle, half), this.eye(), -1);
        const depth = Math.max(dot(at, this.forward()), 1e-3);
        const seen = [dot(at, this.right()) / (depth * tan_right), dot(at, this.up()) / (depth * tan_up)];
        for (const axis of [0, 1]) {
          low[axis] = Math.min(low[axis], seen[axis]);
          high[axis] = Math.max(high[axis], seen[axis]);
        }
      }
      const off = [0.5 * (low[0] + high[0]) * tan_right * this.distance, 0.5 * (low[1] + high[1]) * tan_up * this.distance];
      this.target = plus(plus(this.target, this.right(), off[0]), this.up(), off[1]);
      this.distance *= clamp((0.5 * Math.max(high[0] - low[0], high[1] - low[1])) / 0.93, 0.6, 1.6);
    }
  }

  /** The unit vector through a place of the picture, 0 ... 1 from its upper left corner. */
  ray(x, y, aspect) {
    const tan_up = Math.tan(0.5 * this.field);
    const along = plus(plus(this.forward(), this.right(), (2 * x - 1 - this.shift) * tan_up * aspect), this.up(), (1 - 2 * y) * tan_up);
    return times(along, 1 / Math.hypot(...along));
  }
  /** Where in the picture a place of the world is, or null behind the eye. */
  seen(place, aspect) {
    const at = plus(place, this.eye(), -1), depth = dot(at, this.forward()), tan_up = Math.tan(0.5 * this.field);
    if (depth <= 0) return null;
    return [0.5 + 0.5 * (dot(at, this.right()) / (depth * tan_up * aspect) + this.shift), 0.5 - (0.5 * dot(at, this.up())) / (depth * tan_up)];
  }
}
