"use strict";
// The page: which flights are shown, and the time that all of it shows.

function start() {
  const read = (text) => JSON.parse(text).map((given) => new Flight(given));
  let flights = read(document.getElementById("flights").textContent);
  const isLive = "live" in document.documentElement.dataset;
  // An interrupted run has a report of no flight.
  if (flights.length === 0 && !isLive) return;
  const element = (id) => document.getElementById(id);
  const camera = new Camera();
  const shown = { flights: [], scenes: [], plots: null, t: 0, playing: false, last: 0 };
  const slider = element("time"), clock = element("clock"), play = element("play");

  function end() {
    return Math.max(...shown.flights.map((flight) => flight.end));
  }

  function draw() {
    for (const scene of shown.scenes) scene.draw(Math.min(shown.t, scene.flight.end));
  }

  function go(t) {
    if (!shown.plots) return;
    shown.t = Math.min(Math.max(t, 0), end());
    slider.value = String(shown.t);
    clock.textContent = `${shown.t.toFixed(2)} s of ${end().toFixed(1)} s`;
    slider.setAttribute("aria-valuetext", `${shown.t.toFixed(1)} seconds`);
    draw();
    shown.plots.time(shown.t);
    shown.scenes.forEach((scene) => scene.tell(shown.t));
  }

  function setPlaying(playing) {
    if (!shown.plots) return;
    if (playing && shown.t >= end()) go(0);
    shown.playing = playing;
    shown.last = performance.now();
    play.textContent = playing ? "Pause" : "Play";
    play.setAttribute("aria-pressed", String(playing));
    if (playing) requestAnimationFrame(step);
  }

  function step(now) {
    if (!shown.playing) return;
    const passed = ((now - shown.last) / 1000) * Number(element("speed").value);
    shown.last = now;
    go(shown.t + passed);
    if (shown.t >= end()) setPlaying(false); else requestAnimationFrame(step);
  }

  // A flight's scene with its numbers, its modes and its events.
  function panel(flight, letter) {
    const panel = document.createElement("section");
    panel.className = "scene";
    const canvas = document.createElement("canvas");
    canvas.tabIndex = 0;
    canvas.setAttribute("role", "img");
    const what = document.createElement("div");
    what.className = "what";
    const heading = document.createElement("h2");
    heading.textContent = letter ? `${letter}: ${flight.name}` : flight.name;
    const title = document.createElement("div");
    title.textContent = flight.title;
    const numbers = document.createElement("dl");
    numbers.className = "now";
    const cells = ["d_C", "speed", "thrust", "tension", "tilt", "mode"].map((name) => {
      const row = document.createElement("div"), term = document.createElement("dt"), cell = document.createElement("dd");
      term.textContent = name;
      row.append(term, cell);
      numbers.append(row);
      return cell;
    });
    what.append(heading, title, numbers);
    panel.append(canvas, what);
    if (flight.lost) {
      const lost = document.createElement("div");
      lost.className = "bad";
      lost.textContent = flight.lost;
      what.append(lost);
    }
    element("scenes").append(panel);
    const scene = new Scene(canvas, flight, camera);
    scene.tell = (t) => {
      const now = flight.at(Math.min(t, flight.end));
      const unit = (value, unit, digits) => (Number.isFinite(value) ? `${value.toFixed(digits)} ${unit}` : "–");
      const distance = now.distance < 0.1 ? unit(1000 * now.distance, "mm", now.distance < 0.001 ? 3 : 1) : unit(now.distance, "m", 2);
      const texts = [distance, unit(now.speed, "m/s", 2), unit(now.thrust, "N", 1), unit(now.tension, "N", 1), unit(now.tilt, "°", 1), now.fault ? `${now.mode}: ${now.fault}` : now.mode || "held"];
      cells.forEach((cell, k) => { cell.textContent = texts[k]; });
      if (!shown.playing) canvas.setAttribute("aria-label", `${flight.name} in space at ${t.toFixed(1)} s: ${texts.map((text, k) => `${cells[k].previousSibling.textContent} ${text}`).join(", ")}`);
    };
    turn(canvas);
    return scene;
  }

  // The pointer turns the camera, the wheel and two fingers bring it nearer.
  function turn(canvas) {
    const fingers = new Map();
    const spread = () => { const [a, b] = [...fingers.values()]; return Math.hypot(a[0] - b[0], a[1] - b[1]); };
    canvas.addEventListener("pointerdown", (event) => { canvas.setPointerCapture(event.pointerId); fingers.set(event.pointerId, [event.clientX, event.clientY]); });
    canvas.addEventListener("pointermove", (event) => {
      const from = fingers.get(event.pointerId);
      if (!from) return;
      const before = fingers.size === 2 ? spread() : 0;
      fingers.set(event.pointerId, [event.clientX, event.clientY]);
      if (fingers.size === 2) camera.zoom *= Math.max(spread(), 1) / Math.max(before, 1);
      else look(-(event.clientX - from[0]) * 0.008, (event.clientY - from[1]) * 0.008);
      draw();
    });
    for (const over of ["pointerup", "pointercancel"]) canvas.addEventListener(over, (event) => fingers.delete(event.pointerId));
    canvas.addEventListener("wheel", (event) => {
      if (document.activeElement !== canvas && !event.ctrlKey) return;
      event.preventDefault();
      nearer(Math.exp(-0.0015 * event.deltaY));
    }, { passive: false });
  }

  function look(right, up) {
    camera.azimuth += right;
    camera.elevation = Math.min(Math.max(camera.elevation + up, -0.2), 1.57);
    draw();
  }

  function nearer(factor) {
    camera.zoom = Math.min(Math.max(camera.zoom * factor, 0.1), 40);
    draw();
  }

  function strips() {
    const holder = element("strips");
    holder.replaceChildren();
    shown.flights.forEach((flight, place) => {
      const strip = document.createElement("div");
      strip.className = "strip";
      strip.setAttribute("role", "img");
      const parts = spans(flight.modes, flight.end).map(([from, to, word]) => [from, to, word || "held", MODES[word] ?? "s1"]);
      const faults = spans(flight.faults, flight.end).filter(([, , word]) => word).map(([from, to, word]) => [from, to, word, "alarm"]);
      const cables = spans(flight.cables, flight.end).filter(([, , word]) => word === "slack").map(([from, to]) => [from, to, "cable slack", "muted"]);
      const estimates = spans(flight.estimates, flight.end).filter(([, , word]) => word && word !== "valid").map(([from, to, word]) => [from, to, `rod ${word}`, "s6"]);
      const below = [...cables, ...estimates];
      if (below.length > 0) strip.classList.add("two");
      const words = [...parts, ...faults, ...below].map(([from, to, word]) => `${word} from ${from.toFixed(1)} to ${to.toFixed(1)} s`);
      strip.setAttribute("aria-label", `${flight.name}: ${words.join("; ")}`);
      for (const [from, to, word, colour] of [...parts, ...faults, ...below]) {
        const part = document.createElement("span");
        const share = 100 / (end() || 1);
        part.style.cssText = `left:${from * share}%;width:${Math.max((to - from) * share, 0.3)}%;background:color-mix(in srgb, var(--${colour}) ${colour === "alarm" ? 45 : 22}%, var(--panel))`;
        if (below.some((other) => other[2] === word)) part.className = "below";
        part.textContent = shown.flights.length > 1 && from === 0 ? `${"AB"[place]}: ${word}` : word;
        part.title = `${word}, ${from.toFixed(2)} to ${to.toFixed(2)} s`;
        strip.append(part);
      }
      holder.append(strip);
    });
    const events = element("events");
    events.replaceChildren();
    shown.flights.forEach((flight, place) => {
      const list = [...flight.modes.map(([t, word]) => [t, word || "held"]), ...flight.faults.filter(([, word]) => word).map(([t, word]) => [t, `fault: ${word}`])];
      list.push(...flight.touches().map(([t, who]) => [t, `${who} on the ground`]));
      for (const [t, word] of flight.cables.slice(1)) list.push([t, `cable ${word}`]);
      if (flight.lost) list.push([flight.end, flight.lost]);
      list.sort((a, b) => a[0] - b[0]);
      for (const [t, word] of list.slice(0, 60)) {
        const item = document.createElement("li"), button = document.createElement("button");
        button.textContent = `${t.toFixed(2)} s`;
        button.addEventListener("click", () => go(t));
        item.append(button, ` ${shown.flights.length > 1 ? `${"AB"[place]}: ` : ""}${word}`);
        events.append(item);
      }
    });
  }

  function show() {
    if (flights.length === 0) return;
    const [first, second] = ["first", "second"].map((id) => element(id).value);
    shown.flights = [flights[Number(first)], second === "" ? null : flights[Number(second)]].filter(Boolean);
    element("scenes").replaceChildren();
    shown.plots?.remove();
    shown.scenes = shown.flights.map((flight, place) => panel(flight, shown.flights.length > 1 ? "AB"[place] : ""));
    slider.max = String(end());
    slider.step = String(end() / 2000 || 1);
    shown.plots = new Plots(element("plots"), shown.flights, (t) => { setPlaying(false); go(t); });
    shown.plots.fit();
    strips();
    go(Math.min(shown.t, end()));
  }

  function choices() {
    for (const id of ["first", "second"]) {
      const from = element(id).options.length - (id === "second" ? 1 : 0);
      flights.slice(from).forEach((flight, place) => element(id).append(new Option(flight.lost ? `${flight.name} (lost)` : flight.name, String(from + place))));
    }
    element("compare").hidden = flights.length < 2;
  }

  // While they fly: what has come since, at the end of it unless somebody looks at what was before.
  function listen() {
    const events = new EventSource("events");
    const fetched = async () => {
      const before = flights.length, isFollowing = before === 0 || (!shown.playing && shown.t >= end() - 0.01);
      flights = read(await (await fetch("flights.json")).text());
      if (flights.length === 0) return;
      const focused = [...document.querySelectorAll(".scene canvas")].indexOf(document.activeElement);
      const zoomed = isFollowing ? null : shown.plots?.shown;
      choices();
      if (flights.length > before && isFollowing) element("first").value = String(flights.length - 1);
      if (isFollowing) shown.t = Infinity;
      show();
      if (zoomed) shown.plots.between(...zoomed);
      document.querySelectorAll(".scene canvas")[focused]?.focus();
      element("live").textContent = `Flying ${flights[flights.length - 1].name}`;
    };
    events.addEventListener("message", fetched);
    events.addEventListener("over", async () => {
      events.close();
      await fetched();
      element("live").textContent = "The flights are over";
    });
  }

  choices();
  for (const id of ["first", "second"]) element(id).addEventListener("change", show);
  // The flight that was lost is what is looked for; two flights are there to be compared.
  element("first").value = String(Math.max(flights.findIndex((flight) => flight.lost), 0));
  if (flights.length === 2) element("second").value = element("first").value === "0" ? "1" : "0";
  play.addEventListener("click", () => setPlaying(!shown.playing));
  slider.addEventListener("input", () => { setPlaying(false); go(Number(slider.value)); });
  element("follow").addEventListener("click", (event) => {
    camera.follows = !camera.follows;
    camera.zoom = 1;
    event.target.setAttribute("aria-pressed", String(camera.follows));
    draw();
  });
  element("view").addEventListener("change", (event) => {
    [camera.azimuth, camera.elevation] = { space: [-0.6, 0.45], above: [0, 1.57], north: [0, 0], east: [1.5708, 0] }[event.target.value];
    camera.zoom = 1;
    draw();
  });
  element("unzoom").addEventListener("click", () => { shown.plots?.zoom(Infinity, 0); camera.zoom = 1; draw(); });
  const keys = {
    " ": () => setPlaying(!shown.playing), ArrowLeft: () => go(shown.t - 0.1), ArrowRight: () => go(shown.t + 0.1),
    PageDown: () => go(shown.t + 0.05 * end()), PageUp: () => go(shown.t - 0.05 * end()), Home: () => go(0), End: () => go(end()),
    "+": () => shown.plots.zoom(0.5, shown.t), "-": () => shown.plots.zoom(2, shown.t), 0: () => shown.plots.zoom(Infinity, 0),
    a: () => look(0.1, 0), d: () => look(-0.1, 0), w: () => look(0, 0.1), s: () => look(0, -0.1), q: () => nearer(0.85), e: () => nearer(1.18), f: () => element("follow").click(),
  };
  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.matches("input, select, textarea, button, a")) return;
    const act = keys[event.key];
    if (!act || !shown.plots) return;
    event.preventDefault();
    act();
  });
  const again = () => { if (!shown.plots) return; shown.plots.remove(); shown.plots = new Plots(element("plots"), shown.flights, go); shown.plots.fit(); go(shown.t); };
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", again);
  // Paper is white.
  addEventListener("beforeprint", () => { setPlaying(false); document.documentElement.classList.add("paper"); again(); });
  addEventListener("afterprint", () => { document.documentElement.classList.remove("paper"); again(); });
  addEventListener("resize", draw);
  if (isLive) {
    shown.t = Infinity;
    element("first").value = String(flights.length - 1);
  }
  show();
  if (isLive) listen();
  performance.mark("ready");
}

start();
