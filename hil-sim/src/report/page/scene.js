"use strict";
// A flight in space, on a canvas: drawn back to front, seen from a camera that all scenes share.

const SCALE = ["#2c7bb6", "#00a6ca", "#7bc96f", "#f0c808", "#f17c0e", "#c81d25"];
const SCALE_FROM = -3, SCALE_TO = 1; // d_C of 1 mm to 10 m, decades

function shade(distance) {
  const share = (Math.log10(Math.max(distance || 0, 1e-9)) - SCALE_FROM) / (SCALE_TO - SCALE_FROM);
  return Math.min(Math.max(Math.floor(share * SCALE.length), 0), SCALE.length - 1);
}

function theme(name) {
  return getComputedStyle(document.documentElement).getPropertyValue("--" + name).trim();
}

class Camera {
  constructor() {
    Object.assign(this, { azimuth: -0.6, elevation: 0.45, zoom: 1, follows: false });
  }
}

class Scene {
  constructor(canvas, flight, camera) {
    Object.assign(this, { canvas, flight, camera, pen: canvas.getContext("2d") });
    this.measure();
  }

  // What has to be in the picture.
  measure() {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    const take = (point) => point.forEach((part, axis) => {
      if (!Number.isFinite(part)) return;
      low[axis] = Math.min(low[axis], part);
      high[axis] = Math.max(high[axis], part);
    });
    const path = this.flight.path;
    for (let k = 0; k < path.length; k += 3) take([path[k], path[k + 1], path[k + 2]]);
    // A vehicle that is lost may be anywhere: what is far from the path is left out.
    const reach = 3 * Math.max(5, ...high.map((part, axis) => part - low[axis]));
    const middle = low.map((part, axis) => 0.5 * (part + high[axis]));
    const n = this.flight.time.length;
    for (const name of ["p", "uav_p"]) {
      const columns = [1, 2, 3].map((axis) => this.flight.column(name + axis));
      for (let row = 0; row < n; row += Math.ceil(n / 2000)) {
        const point = columns.map((column) => column[row]);
        if (Math.hypot(...point.map((part, axis) => part - middle[axis])) < reach) take(point);
      }
    }
    this.middle = low.map((part, axis) => 0.5 * (part + high[axis]));
    this.radius = Math.max(1.5, 0.5 * Math.hypot(...high.map((part, axis) => part - low[axis])));
    this.ground = this.flight.ground ?? high[2] + 0.12 * this.radius;
  }

  // Screen x, y and depth of a point of N.
  project(point) {
    const { cos: ca, sin: sa } = this.azimuth, { cos: ce, sin: se } = this.tilt;
    const east = point[1] - this.centre[1], north = point[0] - this.centre[0], up = this.centre[2] - point[2];
    const right = ca * east + sa * north, ahead = -sa * east + ca * north;
    const depth = this.distance + ce * ahead - se * up;
    const scale = this.focal / Math.max(depth, 0.05 * this.distance);
    return [this.width / 2 + scale * right, this.height / 2 - scale * (ce * up + se * ahead), depth, scale];
  }

  line(points, colour, width, dash = []) {
    const pen = this.pen;
    pen.beginPath();
    points.forEach((point, k) => {
      const [x, y] = this.project(point);
      if (k === 0) pen.moveTo(x, y); else pen.lineTo(x, y);
    });
    pen.strokeStyle = colour;
    pen.lineWidth = width;
    pen.setLineDash(dash);
    pen.stroke();
    pen.setLineDash([]);
  }

  text(words, x, y, colour) {
    this.pen.font = "13px system-ui, sans-serif";
    this.pen.fillStyle = colour;
    this.pen.fillText(words, x, y);
  }

  draw(t) {
    const { canvas, pen, camera, flight } = this;
    const ratio = window.devicePixelRatio || 1;
    const width = canvas.clientWidth, height = canvas.clientHeight;
    if (width === 0) return;
    if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
      canvas.width = Math.round(width * ratio);
      canvas.height = Math.round(height * ratio);
    }
    const now = flight.at(t);
    this.width = width;
    this.height = height;
    this.azimuth = { cos: Math.cos(camera.azimuth), sin: Math.sin(camera.azimuth) };
    this.tilt = { cos: Math.cos(camera.elevation), sin: Math.sin(camera.elevation) };
    const near = camera.follows ? 2.2 * flight.rod_length : this.radius;
    this.centre = camera.follows ? now.load.map((part, axis) => 0.5 * (part + now.uav[axis])) : this.middle;
    this.distance = (2.7 * near) / camera.zoom;
    this.focal = 1.35 * Math.min(height, 0.9 * width);
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.lineJoin = pen.lineCap = "round";
    pen.fillStyle = theme("sky");
    pen.fillRect(0, 0, width, height);
    this.drawGround();
    this.drawCurve();
    this.drawTrail(now);
    this.drawTouches(now);
    this.drawShadow(now);
    if (now.uav[2] > now.load[2]) { this.drawUav(now); this.drawCable(now); this.drawLoad(now); }
    else { this.drawLoad(now); this.drawCable(now); this.drawUav(now); }
    this.drawWords(now);
  }

  drawGround() {
    const pen = this.pen, half = 1.6 * this.radius;
    const step = [0.5, 1, 2, 5, 10, 20, 50, 100, 200].find((step) => half / step < 9) ?? 500;
    const from = [0, 1].map((axis) => Math.floor((this.middle[axis] - half) / step) * step);
    const to = [0, 1].map((axis) => Math.ceil((this.middle[axis] + half) / step) * step);
    const corner = (n1, n2) => this.project([n1, n2, this.ground]);
    pen.beginPath();
    [corner(from[0], from[1]), corner(to[0], from[1]), corner(to[0], to[1]), corner(from[0], to[1])]
      .forEach(([x, y], k) => (k === 0 ? pen.moveTo(x, y) : pen.lineTo(x, y)));
    pen.closePath();
    pen.fillStyle = theme("ground");
    pen.fill();
    const colour = theme("grid"), down = this.ground;
    for (let n1 = from[0]; n1 <= to[0] + 1e-9; n1 += step) this.line([[n1, from[1], down], [n1, to[1], down]], colour, 1);
    for (let n2 = from[1]; n2 <= to[1] + 1e-9; n2 += step) this.line([[from[0], n2, down], [to[0], n2, down]], colour, 1);
    const muted = theme("muted");
    const [x1, y1] = corner(to[0], 0.5 * (from[1] + to[1])), [x2, y2] = corner(0.5 * (from[0] + to[0]), to[1]);
    this.text("n1", x1 + 4, y1 - 4, muted);
    this.text("n2", x2 + 4, y2 - 4, muted);
    this.text(`a square is ${step} m`, 12, this.height - 12, muted);
  }

  drawCurve() {
    const path = this.flight.path, points = [];
    for (let k = 0; k < path.length; k += 3) points.push([path[k], path[k + 1], path[k + 2]]);
    this.line(points, theme("curve"), 1.5, [6, 5]);
    // A route's waypoints by their numbers; those where it stops are filled.
    this.flight.waypoints.forEach(([point, stops], number) => {
      const [x, y, depth] = this.project(point);
      if (depth < 0.1 * this.distance) return;
      this.pen.beginPath();
      this.pen.arc(x, y, 4, 0, 2 * Math.PI);
      this.pen.strokeStyle = this.pen.fillStyle = theme("curve");
      this.pen.lineWidth = 1.5;
      if (stops) this.pen.fill(); else this.pen.stroke();
      this.text(String(number), x + 6, y - 6, theme("muted"));
    });
  }

  // What has been flown in the colours of d_C, what is to come pale.
  drawTrail(now) {
    const { pen, flight } = this;
    const columns = [1, 2, 3].map((axis) => flight.column("p" + axis)), distance = flight.column("d_c");
    const parts = SCALE.map(() => []);
    let last = null, ahead = [];
    for (let row = 0; row < flight.time.length; row += 1) {
      const point = columns.map((column) => column[row]);
      if (!point.every(Number.isFinite)) continue;
      const [x, y, depth] = this.project(point);
      const here = depth > 0.1 * this.distance ? [x, y] : null;
      if (row > now.row) ahead.push(here);
      else if (last && here) parts[shade(distance[row])].push([last, here]);
      last = here;
      if (row === now.row) ahead.push(here);
    }
    pen.globalAlpha = 0.25;
    pen.strokeStyle = theme("muted");
    pen.lineWidth = 1;
    pen.beginPath();
    ahead.forEach((point, k) => {
      if (!point) return;
      if (k === 0 || !ahead[k - 1]) pen.moveTo(...point); else pen.lineTo(...point);
    });
    pen.stroke();
    pen.globalAlpha = 1;
    pen.lineWidth = 2.5;
    parts.forEach((segments, bin) => {
      pen.strokeStyle = SCALE[bin];
      pen.beginPath();
      for (const [from, to] of segments) {
        pen.moveTo(...from);
        pen.lineTo(...to);
      }
      pen.stroke();
    });
    const [x, y] = this.project(columns.map((column) => column[0]));
    pen.strokeStyle = theme("text");
    pen.lineWidth = 1.5;
    pen.strokeRect(x - 4, y - 4, 8, 8);
  }

  // Where load and UAV have come to the ground until now.
  drawTouches(now) {
    const size = 0.03 * this.radius;
    for (const [t, who] of this.flight.touches()) {
      if (t > now.t) break;
      const at = this.flight.at(t), [n1, n2] = who === "load" ? at.load : at.uav;
      const ring = Array.from({ length: 25 }, (_, k) => [n1 + size * Math.cos((k * Math.PI) / 12), n2 + size * Math.sin((k * Math.PI) / 12), this.ground]);
      this.line(ring, theme(who === "load" ? "load" : "uav"), 2);
    }
  }

  // Where the vehicle is above the ground.
  drawShadow(now) {
    const foot = [now.load[0], now.load[1], this.ground];
    if (now.load[2] < this.ground) this.line([now.load, foot], theme("muted"), 1, [2, 4]);
    const [x, y, , scale] = this.project(foot);
    const pen = this.pen;
    pen.globalAlpha = 0.3;
    pen.fillStyle = theme("text");
    pen.beginPath();
    pen.ellipse(x, y, Math.max(3, 0.2 * scale), Math.max(1.5, 0.2 * scale * Math.sin(Math.max(this.camera.elevation, 0.1))), 0, 0, 7);
    pen.fill();
    pen.globalAlpha = 1;
  }

  drawCable(now) {
    if (!now.slack) {
      this.line([now.uav, now.load], theme("cable"), 2);
      return;
    }
    const sag = Math.sqrt(Math.max(this.flight.rod_length ** 2 - now.length ** 2, 0)) * 0.5 + 0.08 * this.flight.rod_length;
    const points = Array.from({ length: 17 }, (_, k) => {
      const u = k / 16;
      const straight = now.uav.map((part, axis) => part + u * (now.load[axis] - part));
      // What would hang below the ground lies on it.
      const hanging = Math.min(straight[2] + 4 * u * (1 - u) * sag, Math.max(this.ground, straight[2]));
      return [straight[0], straight[1], hanging];
    });
    this.line(points, theme("alarm"), 2, [5, 5]);
  }

  drawLoad(now) {
    const pen = this.pen, [x, y, , scale] = this.project(now.load);
    const radius = Math.max(6, 0.14 * scale), light = pen.createRadialGradient(x - radius / 3, y - radius / 3, 1, x, y, radius);
    light.addColorStop(0, "#ffffff");
    light.addColorStop(0.25, theme("load"));
    light.addColorStop(1, theme("load"));
    pen.fillStyle = light;
    pen.beginPath();
    pen.arc(x, y, radius, 0, 7);
    pen.fill();
  }

  // Arms, rotors and their thrusts; from afar larger than it is.
  drawUav(now) {
    const { pen, flight } = this, [, , , scale] = this.project(now.uav);
    const arm = Math.max(flight.arm, 20 / scale), [b1, b2, b3] = now.axes;
    const at = (x, y, z) => now.uav.map((part, axis) => part + x * b1[axis] + y * b2[axis] + z * b3[axis]);
    const half = arm / Math.SQRT2, lever = 4 * (flight.arm / Math.SQRT2);
    const hover = flight.hover_n / 4, colour = theme("uav"), front = theme("front");
    // In the order of quad-x; thrust is along -b3 and the torque of a rotor at r is r x thrust.
    for (const [sx, sy, spin] of [[1, 1, 1], [-1, -1, 1], [1, -1, -1], [-1, 1, -1]]) {
      const force = now.thrust / 4 - (sy * now.torque[0]) / lever + (sx * now.torque[1]) / lever
        + (flight.drag ? (spin * now.torque[2]) / (4 * flight.drag) : 0);
      const hub = [sx * half, sy * half];
      this.line([at(0, 0, 0), at(...hub, 0)], sx > 0 ? front : colour, 3);
      const disc = Array.from({ length: 25 }, (_, k) => {
        const angle = (2 * Math.PI * k) / 24;
        return at(hub[0] + 0.55 * arm * Math.cos(angle), hub[1] + 0.55 * arm * Math.sin(angle), -0.05 * arm);
      });
      this.line(disc, sx > 0 ? front : colour, 1.5);
      pen.globalAlpha = 0.15;
      pen.fillStyle = sx > 0 ? front : colour;
      pen.fill();
      pen.globalAlpha = 1;
      if (Number.isFinite(force)) {
        const length = Math.min(Math.max(force / hover, -3), 3) * arm;
        this.line([at(...hub, -0.05 * arm), at(...hub, -0.05 * arm - length)], force < 0 ? theme("alarm") : theme("s3"), 3);
      }
    }
    this.line([at(0, 0, 0), at(0.9 * arm, 0, 0)], front, 2);
  }

  drawWords(now) {
    const { flight, pen } = this, text = theme("text");
    const wind = Math.hypot(...flight.wind);
    if (wind > 0) {
      const from = this.middle, to = from.map((part, axis) => part + (flight.wind[axis] / wind) * 0.3 * this.radius);
      const [x0, y0] = this.project(from), [x1, y1] = this.project(to), [x, y] = [this.width - 70, 46];
      const length = Math.hypot(x1 - x0, y1 - y0) || 1, ux = ((x1 - x0) / length) * 26, uy = ((y1 - y0) / length) * 26;
      pen.strokeStyle = text;
      pen.lineWidth = 2.5;
      pen.beginPath();
      pen.moveTo(x - ux, y - uy);
      pen.lineTo(x + ux, y + uy);
      pen.lineTo(x + ux - 0.35 * ux + 0.25 * uy, y + uy - 0.35 * uy - 0.25 * ux);
      pen.moveTo(x + ux, y + uy);
      pen.lineTo(x + ux - 0.35 * ux - 0.25 * uy, y + uy - 0.35 * uy + 0.25 * ux);
      pen.stroke();
      this.text(`wind ${wind.toFixed(1)} m/s`, this.width - 112, 92, text);
    }
    if (now.fault) this.text(now.fault, 12, 22, theme("alarm"));
    else {
      const words = [now.slack ? "cable slack" : "", now.ground ? `on the ground: ${now.ground}` : ""].filter(Boolean);
      if (words.length > 0) this.text(words.join(", "), 12, 22, theme(now.slack ? "alarm" : "text"));
    }
  }
}
