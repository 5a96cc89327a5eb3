"use strict";
// A flight as the page has it: columns of single-precision numbers over time, and what stands
// between its samples.

function numbers(text) {
  const bytes = Uint8Array.from(atob(text), (character) => character.charCodeAt(0));
  return new Float32Array(bytes.buffer);
}

class Flight {
  constructor(given) {
    Object.assign(this, given);
    this.time = numbers(given.time);
    this.path = numbers(given.path);
    this.decoded = new Map();
    this.end = this.time[this.time.length - 1];
  }

  has(name) {
    return name in this.columns;
  }

  // A column that does not change is kept as one number.
  column(name) {
    if (!this.decoded.has(name)) {
      const given = this.columns[name];
      this.decoded.set(name, typeof given === "string" ? numbers(given) : new Float32Array(this.time.length).fill(given ?? NaN));
    }
    return this.decoded.get(name);
  }

  // The last sample not after t.
  row(t) {
    let low = 0, high = this.time.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.time[middle] <= t) low = middle; else high = middle - 1;
    }
    return low;
  }

  value(name, row) {
    return this.column(name)[row];
  }

  // Position by the cubic that has the samples' positions and velocities.
  place(row, t, position, velocity) {
    const next = Math.min(row + 1, this.time.length - 1);
    const span = this.time[next] - this.time[row];
    const u = span > 0 ? Math.min(Math.max((t - this.time[row]) / span, 0), 1) : 0;
    return [1, 2, 3].map((axis) => {
      const p = this.column(position + axis), v = this.column(velocity + axis);
      const [a, b] = [p[row], p[next]], [da, db] = [v[row] * span, v[next] * span];
      const smooth = a + u * (da + u * (3 * (b - a) - 2 * da - db + u * (2 * (a - b) + da + db)));
      // Where an obstacle stops the vehicle the velocity jumps.
      return Math.abs(da) + Math.abs(db) > 4 * Math.abs(b - a) + 0.05 ? a + u * (b - a) : smooth;
    });
  }

  // Rotation body to N, as columns b1, b2, b3.
  attitude(row, t) {
    const next = Math.min(row + 1, this.time.length - 1);
    const span = this.time[next] - this.time[row];
    const u = span > 0 ? Math.min(Math.max((t - this.time[row]) / span, 0), 1) : 0;
    const names = ["att_w", "att_x", "att_y", "att_z"];
    const a = names.map((name) => this.value(name, row)), b = names.map((name) => this.value(name, next));
    const same = a.reduce((sum, part, k) => sum + part * b[k], 0) < 0 ? -1 : 1;
    const q = a.map((part, k) => (1 - u) * part + u * same * b[k]);
    const norm = Math.hypot(...q) || 1;
    const [w, x, y, z] = q.map((part) => part / norm);
    return [
      [1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)],
      [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)],
      [2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)],
    ];
  }

  // When load or UAV came to the ground: [t, who].
  touches() {
    const on = (word, who) => word === who || word === "both";
    return this.grounds.flatMap(([t, word], k) => ["load", "UAV"]
      .filter((who) => k > 0 && on(word, who) && !on(this.grounds[k - 1][1], who)).map((who) => [t, who]));
  }

  // The word of a list of [from, word] at t.
  static word(list, t) {
    let found = "";
    for (const [from, word] of list) if (from <= t) found = word;
    return found;
  }

  // Everything that a scene shows at t.
  at(t) {
    const row = this.row(t);
    const load = this.place(row, t, "p", "v"), uav = this.place(row, t, "uav_p", "uav_v");
    const length = Math.hypot(...load.map((part, axis) => part - uav[axis]));
    const lambda = this.has("lambda") ? this.value("lambda", row) : NaN;
    const norm = (name) => Math.hypot(...[1, 2, 3].map((axis) => this.value(name + axis, row)));
    const axes = this.attitude(row, t);
    return {
      t, row, load, uav, axes, length,
      thrust: this.has("thrust") ? this.value("thrust", row) : NaN,
      torque: this.has("torque1") ? [1, 2, 3].map((axis) => this.value("torque" + axis, row)) : [0, 0, 0],
      distance: this.value("d_c", row), speed: norm("v"),
      tilt: (Math.acos(Math.min(Math.max(axes[2][2], -1), 1)) * 180) / Math.PI,
      tension: -lambda * this.payload_mass,
      slack: this.cables.length > 0 ? Flight.word(this.cables, t) === "slack" : length < 0.99 * this.rod_length || lambda >= 0,
      ground: Flight.word(this.grounds, t),
      mode: Flight.word(this.modes, t), fault: Flight.word(this.faults, t),
    };
  }
}
