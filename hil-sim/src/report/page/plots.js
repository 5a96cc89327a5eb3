"use strict";
// Plots over time by uPlot, linked in zoom and cursor; bands for modes, faults and what holds the
// vehicle.

const PLOTS = [
  { title: "Distance from the curve d_C, m", log: true, lines: [["d_C", (f) => f.column("d_c")]] },
  { title: "Speed, m/s", lines: [["load", norm("v")], ["UAV", norm("uav_v")], ["set", "set_speed"], ["limits allow", "allowed_speed"]] },
  { title: "Thrust and tension, N", lines: [["thrust", "thrust"], ["tension", (f) => f.column("lambda").map((value) => -value * f.payload_mass), "lambda"], ["thrust logged", "logged_thrust"]] },
  { title: "Torque, N m", lines: [["τ1", "torque1"], ["τ2", "torque2"], ["τ3", "torque3"], ["τ1 logged", "logged_torque1"], ["τ2 logged", "logged_torque2"], ["τ3 logged", "logged_torque3"]] },
  { title: "Margins: the law is singular at 0", lines: [["q·e3", "q3"], ["q·b3", "q_b3"], ["cos²φ", "cos_phi_squared"], ["reach", "reach"]] },
  { title: "Angles from the vertical, degrees", lines: [["cable", angle(cable)], ["UAV", angle(upright)]] },
  { title: "Estimated rod less the true one, with ±σ, rad", sigma: "rod_sigma", lines: [["q1", off("est_q", rod, 1), "est_q1"], ["q2", off("est_q", rod, 2), "est_q2"]] },
  { title: "Estimated load less the true one, with ±σ of navigation, m", sigma: "position_sigma", lines: [["n1", off("est_p", load, 1), "est_p1"], ["n2", off("est_p", load, 2), "est_p2"], ["n3", off("est_p", load, 3), "est_p3"]] },
  { title: "Speed error, m/s", lines: [["h3", "speed_error"]] },
  { title: "Yaw error, rad", lines: [["h4", "yaw_error"]] },
  { title: "Body rate ω, rad/s", lines: [["ω1", "omega1"], ["ω2", "omega2"], ["ω3", "omega3"]] },
  { title: "Force found on the payload, N", lines: [["d1", "payload_force1"], ["d2", "payload_force2"], ["d3", "payload_force3"]] },
  { title: "Force found on the UAV, N", lines: [["δ1", "uav_force1"], ["δ2", "uav_force2"], ["δ3", "uav_force3"]] },
  { title: "Torque found on the UAV, N m", lines: [["1", "disturbing_torque1"], ["2", "disturbing_torque2"], ["3", "disturbing_torque3"]] },
];

function norm(name) {
  return (flight) => {
    const [a, b, c] = [1, 2, 3].map((axis) => flight.column(name + axis));
    return a.map((part, row) => Math.hypot(part, b[row], c[row]));
  };
}

// An axis of the load's place, and of the rod, as they are.
function load(flight, axis) {
  return flight.column("p" + axis);
}

function rod(flight, axis) {
  const parts = [1, 2, 3].map((part) => flight.column("p" + part).map((value, row) => value - flight.column("uav_p" + part)[row]));
  return parts[axis - 1].map((value, row) => value / Math.hypot(...parts.map((part) => part[row])));
}

// An estimate less what is so.
function off(name, truth, axis) {
  return (flight) => {
    const so = truth(flight, axis);
    return flight.column(name + axis).map((value, row) => value - so[row]);
  };
}

// cos of the cable's angle, and of the UAV's, from the vertical.
function cable(flight) {
  const [load, uav] = ["p", "uav_p"].map((name) => [1, 2, 3].map((axis) => flight.column(name + axis)));
  return load[0].map((_, row) => {
    const parts = load.map((column, axis) => column[row] - uav[axis][row]);
    return parts[2] / Math.hypot(...parts);
  });
}

function upright(flight) {
  const [x, y] = [flight.column("att_x"), flight.column("att_y")];
  return x.map((part, row) => 1 - 2 * (part * part + y[row] * y[row]));
}

function angle(cosine) {
  return (flight) => cosine(flight).map((value) => (Math.acos(Math.min(Math.max(value, -1), 1)) * 180) / Math.PI);
}

function taken(flight, [, source, needs]) {
  const name = needs ?? (typeof source === "string" ? source : null);
  if (name && !flight.has(name)) return null;
  const values = typeof source === "string" ? flight.column(source) : source(flight);
  // What never leaves zero says nothing.
  return values.some((value) => Math.abs(value) > 1e-6) ? values : null;
}

class Plots {
  // `flights` are one or two; `go` is called with the time that was clicked on.
  constructor(root, flights, go) {
    Object.assign(this, { root, flights, go, plots: [] });
    root.replaceChildren();
    const end = Math.max(...flights.map((flight) => flight.end));
    this.whole = [0, end > 0 ? end : 1];
    for (const plot of PLOTS) this.add(plot);
    this.observer = new ResizeObserver(() => this.fit());
    this.observer.observe(root);
  }

  add({ title, log, lines, sigma }) {
    const colours = ["s1", "s2", "s3", "s4", "s5", "s6"].map(theme);
    const tables = [], bands = [], series = [{ label: "t", value: (_, t) => (t == null ? "–" : `${t.toFixed(2)} s`) }];
    this.flights.forEach((flight, place) => {
      const table = [flight.time];
      lines.forEach((line, k) => {
        const values = taken(flight, line);
        if (!values) return;
        table.push(Array.from(values, (value) => (Number.isFinite(value) && (!log || value > 0) ? value : null)));
        series.push({
          label: this.flights.length > 1 ? `${line[0]} ${"AB"[place]}` : line[0],
          stroke: colours[k % colours.length],
          width: 1.5,
          dash: place === 1 ? [7, 4] : line[0].endsWith(" logged") ? [3, 3] : undefined,
          points: { show: false },
          spanGaps: this.flights.length > 1,
          value: (_, value) => (value == null ? "–" : Math.abs(value) >= 1e4 || (Math.abs(value) < 1e-3 && value !== 0) ? value.toExponential(2) : value.toPrecision(4)),
        });
      });
      if (table.length > 1 && sigma && flight.has(sigma)) {
        // Of one axis: the two together have √2 of it.
        const one = flight.column(sigma).map((value) => value * Math.SQRT1_2);
        for (const [sign, end] of [["+", 1], ["−", -1]]) {
          table.push(Array.from(one, (value) => (Number.isFinite(value) ? end * value : null)));
          series.push({ label: `${sign}σ`, stroke: theme("muted"), width: 0.75, dash: [2, 3], points: { show: false }, spanGaps: this.flights.length > 1, value: (_, value) => (value == null ? "–" : value.toPrecision(3)) });
        }
        bands.push({ series: [series.length - 2, series.length - 1], fill: `${theme("muted")}2e` });
      }
      if (table.length > 1) tables.push(table);
    });
    if (tables.length === 0) return;
    const figure = document.createElement("figure"), caption = document.createElement("figcaption"), holder = document.createElement("div");
    caption.textContent = title;
    figure.append(caption, holder);
    this.root.append(figure);
    const axis = { stroke: theme("muted"), grid: { stroke: theme("line"), width: 0.5 }, ticks: { stroke: theme("line"), width: 0.5 }, font: "12px system-ui, sans-serif" };
    const options = {
      width: 400,
      height: 200,
      series,
      bands,
      axes: [{ ...axis, values: (_, ticks) => ticks.map((t) => `${+t.toFixed(6)} s`) }, { ...axis, size: 64, values: (_, ticks) => ticks.map((value) => label(value, log)) }],
      scales: { x: { time: false, min: this.whole[0], max: this.whole[1] }, y: log ? { distr: 3, range: (_, low, high) => decades(low, high) } : { range: (_, low, high) => range(low, high) } },
      cursor: { sync: { key: "time" }, drag: { x: true, y: false }, points: { size: 6 } },
      legend: { live: true },
      hooks: {
        drawClear: [(plot) => this.bands(plot)],
        setScale: [(plot, key) => { if (key === "x") this.zoomed(plot); }],
      },
    };
    const plot = new uPlot(options, tables.length > 1 ? uPlot.join(tables) : tables[0], holder);
    plot.now = document.createElement("div");
    plot.now.className = "time-now";
    plot.over.append(plot.now);
    plot.over.addEventListener("click", (event) => this.go(plot.posToVal(event.offsetX, "x")));
    const words = this.flights.map((flight, place) => (this.flights.length > 1 ? `${"AB"[place]}: ${flight.name}` : flight.name)).join(", ");
    const canvas = plot.root.querySelector("canvas");
    canvas.setAttribute("role", "img");
    canvas.setAttribute("aria-label", `${title}, over time: ${words}`);
    this.plots.push(plot);
  }

  // Behind the curves: what held the vehicle, faults, and modes other than following.
  bands(plot) {
    const flight = this.flights[0], { ctx: pen, bbox: box } = plot;
    pen.save();
    pen.beginPath();
    pen.rect(box.left, box.top, box.width, box.height);
    pen.clip();
    const fill = (from, to, colour, alpha) => {
      const [x0, x1] = [from, to].map((t) => plot.valToPos(t, "x", true));
      pen.globalAlpha = alpha;
      pen.fillStyle = colour;
      pen.fillRect(x0, box.top, Math.max(x1 - x0, 2), box.height);
    };
    for (const [from, to, word] of spans(flight.modes, flight.end)) if (MODES[word]) fill(from, to, theme(MODES[word]), word ? 0.1 : 0.3);
    for (const [from, to, word] of spans(flight.faults, flight.end)) if (word) fill(from, to, theme("alarm"), 0.16);
    for (const [from, to, word] of spans(flight.cables, flight.end)) if (word === "slack") fill(from, to, theme("muted"), 0.14);
    pen.restore();
  }

  zoomed(plot) {
    if (this.zooming) return;
    this.zooming = true;
    const { min, max } = plot.scales.x;
    for (const other of this.plots) if (other !== plot) other.setScale("x", { min, max });
    this.shown = [min, max];
    this.zooming = false;
  }

  // Shows `share` of what is shown now, around t.
  zoom(share, t) {
    const [from, to] = this.shown ?? this.whole;
    const width = Math.min((to - from) * share, this.whole[1] - this.whole[0]);
    const start = Math.min(Math.max(t - 0.5 * width, this.whole[0]), this.whole[1] - width);
    this.between(start, start + width);
  }

  between(min, max) {
    this.plots[0]?.setScale("x", { min, max });
  }

  fit() {
    for (const plot of this.plots) {
      const width = Math.floor(plot.root.parentElement.clientWidth);
      if (width > 0 && width !== plot.width) plot.setSize({ width, height: 200 });
    }
    this.time(this.now ?? 0);
  }

  time(t) {
    this.now = t;
    for (const plot of this.plots) {
      const x = plot.valToPos(t, "x");
      plot.now.style.display = x >= 0 && x <= plot.over.clientWidth ? "" : "none";
      plot.now.style.transform = `translateX(${x - 1}px)`;
      if (!plot.over.matches(":hover")) plot.setCursor({ left: x, top: 0 }, false);
    }
  }

  remove() {
    this.observer.disconnect();
    for (const plot of this.plots) plot.destroy();
    this.plots = [];
  }
}

// Colours of modes; following has none, and without a mode the vehicle is held.
const MODES = { "": "muted", off: "muted", idle: "muted", engage: "s4", join: "s4", hold: "s2", land: "s3", fault: "alarm", "take off": "s5", takeoff: "s5" };

// [from, to, word] of a list of [from, word].
function spans(list, end) {
  return list.map(([from, word], k) => [from, list[k + 1]?.[0] ?? end, word]);
}

function label(value, log) {
  if (value == null) return "";
  if (log) return Number.isInteger(Math.round(1e6 * Math.log10(value)) / 1e6) ? (value >= 0.01 && value < 1e4 ? String(+value.toPrecision(1)) : value.toExponential(0)) : "";
  return Math.abs(value) >= 1e5 ? value.toExponential(1) : String(+value.toPrecision(6) + 0);
}

// Whole decades, six at most: what is below says no more.
function decades(low, high) {
  if (low == null || high == null) return [1e-3, 1];
  const top = Math.ceil(Math.log10(high) - 0.1), bottom = Math.floor(Math.log10(low));
  return [10 ** Math.max(bottom, top - 6), 10 ** Math.max(top, bottom + 1)];
}

// A range with room, and not so narrow that rounding fills it.
function range(low, high) {
  if (low == null || high == null) return [0, 1];
  const least = Math.max(1e-3, 1e-3 * Math.max(Math.abs(low), Math.abs(high)));
  const half = Math.max(0.54 * (high - low), least), middle = 0.5 * (low + high);
  return [middle - half, middle + half];
}
