// Plays every animation of the page: a film of frames and traces, as encoded by `simulation/animation/encoding.py`. No library, no network access.
"use strict";
(() => {
  const NOTHING = -32768;
  const COLOURS = ["#0b4f8a", "#b3361b", "#1b7a45", "#7d3c98", "#8a5c00", "#1f7482"];
  const MEASURED = "#1d2733", PLAIN = "#5c6b7a";
  const CENTRE = 220, GAP = 68, TOP = 60, GROUND = 436, AXLE = 530, ROOM = 100, EYE = 185, SINK = 14; // of the shaft's picture, in its own units
  const CLEAR = 6, FINE = 2; // least distance of the two sides, and length of the pieces in which the rope is led around the sheave
  const WIDE = 520, HIGH = 84, LEFT = 52, RIGHT = 512, UPPER = 18, LOWER = 66; // of a trace's picture

  // -- data ---------------------------------------------------------------------------------------
  function unpack(table) {
    const text = atob(table.data), bytes = new DataView(new ArrayBuffer(text.length));
    for (let k = 0; k < text.length; k++) bytes.setUint8(k, text.charCodeAt(k));
    const values = new Float64Array(text.length / 2);
    for (let k = 0; k < values.length; k++) {
      const whole = bytes.getInt16(2 * k, true);
      values[k] = whole === NOTHING ? NaN : whole * table.scale;
    }
    return values;
  }

  // The `count` values of one frame, interpolated linearly between frames.
  function between(values, count, at) {
    const low = Math.floor(at), part = at - low, found = new Float64Array(count);
    const next = (low + 1) * count < values.length ? count : 0;
    for (let k = 0; k < count; k++) {
      const here = values[low * count + k];
      found[k] = part === 0 ? here : here + part * (values[low * count + k + next] - here);
    }
    return found;
  }

  function valueAt(curve, time) {
    let low = 0, high = curve.time.length - 1;
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (curve.time[middle] <= time) low = middle; else high = middle;
    }
    const span = curve.time[high] - curve.time[low];
    const part = span > 0 ? Math.min(1, Math.max(0, (time - curve.time[low]) / span)) : 0;
    return part === 0 ? curve.value[low] : curve.value[low] + part * (curve.value[high] - curve.value[low]);
  }

  function largest(values) {
    let found = 0;
    for (const value of values) if (Math.abs(value) > found) found = Math.abs(value);
    return found;
  }

  function extremes(values) {
    let low = Infinity, high = -Infinity;
    for (const value of values) if (value < low) low = value; else if (value > high) high = value;
    return [low, high].filter(Number.isFinite);
  }

  // Round numbers between two, about `count` of them.
  function ticks(low, high, count) {
    const step = round125(((high - low) / count) * 1.5) || 1, found = [];
    for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) found.push(+(k * step).toPrecision(12));
    return found;
  }

  function fixed(value) {
    return (Math.abs(value) < 0.005 ? 0 : value).toFixed(2);
  }

  // The nearest of 1, 2, 5, 10, ... below a number.
  function round125(value) {
    const ten = 10 ** Math.floor(Math.log10(value));
    return ten * [5, 2, 1].find((one) => one * ten <= value * 1.0000001);
  }

  // -- drawing ------------------------------------------------------------------------------------
  function draw(parent, name, attributes, text) {
    const element = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    if (text !== undefined) element.textContent = text;
    return parent.appendChild(element);
  }

  // A path through points; a point that is not a number breaks it.
  function path(count, x, y) {
    let text = "", pen = "M";
    for (let k = 0; k < count; k++) {
      const a = x(k), b = y(k);
      if (Number.isFinite(a) && Number.isFinite(b)) { text += `${pen}${a.toFixed(2)} ${b.toFixed(2)}`; pen = "L"; } else pen = "M";
    }
    return text;
  }

  function wheel(parent, radius, stroke) {
    const group = draw(parent, "g", { class: "wheel" });
    draw(group, "circle", { r: radius, fill: "#eef2f6", stroke: "#5c6b7a", "stroke-width": stroke });
    for (let k = 0; k < 6; k++) {
      const angle = (k * Math.PI) / 3, x = radius * Math.cos(angle), y = radius * Math.sin(angle);
      draw(group, "line", { x1: 0, y1: 0, x2: x, y2: y, stroke: k ? "#aab4bf" : "#b3361b", "stroke-width": k ? stroke : 2 * stroke });
    }
    draw(group, "circle", { r: radius / 8, fill: "#5c6b7a" });
    return group;
  }

  // -- the whole shaft ----------------------------------------------------------------------------
  class Shaft {
    constructor(svg, film) {
      this.film = film;
      this.scale = (GROUND - TOP) / film.height; // per metre of height above the bottom landing
      this.sheaveScale = SINK / (largest(film.axle.map((one) => one - film.axle[0])) || 1); // per metre of the sheave's rise
      this.views = { shape: film.sides, swing: film.sides.map((value, k) => value - film.rest[k]) };
      this.view("swing");
      this._room(svg);
      this.wheel = wheel(svg, GAP, 1.5);
      this.rope = [0, 1].map(() => draw(svg, "path", { class: "rope", fill: "none", stroke: "#1d2733", "stroke-width": 2 }));
      this.boxes = [0, 1].map((k) => this._box(svg, ["car", "counterweight"][k]));
      this.sensors = film.sensors.map((one, k) => this._sensor(svg, one, COLOURS[k % COLOURS.length]));
    }

    // "swing": displacement relative to the static shape; "shape": relative to the vertical through the sheave's side.
    view(name) {
      this.shown = this.views[name];
      const inward = -Math.min(0, ...extremes(this.shown)), outward = Math.max(0, ...extremes(this.shown));
      this.lateral = Math.min(ROOM / (outward || 1e-9), (GAP - CLEAR) / (inward || 1e-9), 1e6); // per metre of lateral displacement
      this.stretch = 1;
    }

    // Below the bottom landing the picture is stretched down to the axle, so that the sheave has room below the car.
    y(height, rise = 0, axle = AXLE) {
      return height >= 0 ? GROUND - height * this.scale : GROUND - (height / (this.film.pit - rise)) * (axle - GROUND);
    }
    x(side, outward) { return CENTRE + (side ? 1 : -1) * (GAP + this.lateral * this.stretch * outward); }

    // A side of the rope through points (x, y): however much it is magnified, it passes the sheave and the other side outside.
    side(side, points, axle) {
      const fine = [points[0]];
      for (let k = 1; k < points.length; k++) {
        const [a, b] = [points[k - 1], points[k]], pieces = b[1] > axle - GAP - FINE ? Math.ceil(Math.hypot(b[0] - a[0], b[1] - a[1]) / FINE) : 1;
        for (let j = 1; j <= pieces; j++) fine.push([a[0] + ((b[0] - a[0]) * j) / pieces, a[1] + ((b[1] - a[1]) * j) / pieces]);
      }
      return path(fine.length, (k) => this.outside(side, ...fine[k], axle), (k) => fine[k][1]);
    }

    // The place nearest to x that lies on a side of the middle, outside of the sheave.
    outside(side, x, y, axle) {
      const out = side ? 1 : -1, rim = Math.sqrt(Math.max(0, GAP ** 2 - (y - axle) ** 2));
      return CENTRE + out * Math.max(out * (x - CENTRE), rim, CLEAR / 2);
    }

    _room(svg) {
      const step = round125(this.film.height / 4);
      for (let height = 0; height <= this.film.height + 1e-9; height += step) {
        draw(svg, "line", { x1: 28, x2: 412, y1: this.y(height), y2: this.y(height), stroke: "#eef1f4" });
        draw(svg, "text", { x: 0, y: this.y(height) + 4, class: "tick" }, height ? height : "0 m");
      }
      for (const side of [0, 1]) {
        const x = this.x(side, 0);
        draw(svg, "line", { x1: x, x2: x, y1: TOP, y2: AXLE, stroke: "#aab4bf", "stroke-dasharray": "2 4" });
      }
      this.bar = draw(svg, "path", { stroke: "#5c6b7a", fill: "none", "stroke-width": 1.5 });
      this.barText = draw(svg, "text", { x: CENTRE, y: 642, class: "tick", "text-anchor": "middle" });
    }

    _box(svg, name) {
      const group = draw(svg, "g", { class: `box ${name}` });
      const high = name === "car" ? 34 : 46, wide = name === "car" ? 46 : 26;
      draw(group, "rect", { x: -wide / 2, y: -high, width: wide, height: high, rx: 2, fill: "#fff", stroke: "#1d2733", "stroke-width": 1.5 });
      if (name === "car") draw(group, "path", { d: "M0 -30V-4", stroke: "#aab4bf" });
      draw(group, "text", { x: 0, y: -high - 5, class: "tick", "text-anchor": "middle" }, name);
      return group;
    }

    _sensor(svg, one, colour) {
      const side = one.side === "car" ? 0 : 1, y = this.y(one.height), out = side ? 1 : -1, x = CENTRE + out * EYE;
      draw(svg, "path", { d: `M${x} ${y}l${out * 9} -5v10z`, fill: colour });
      const ray = draw(svg, "line", { x1: x, y1: y, y2: y, stroke: colour, "stroke-width": 0.8, "stroke-dasharray": "3 3" });
      draw(svg, "text", { x: x - out * 2, y: y - 5, class: "name", fill: colour, "text-anchor": side ? "end" : "start" }, one.name);
      const dot = draw(svg, "circle", { cy: y, r: 4, fill: colour });
      const circle = draw(svg, "circle", { cy: y, r: 6, fill: "none", stroke: MEASURED, "stroke-width": 2 });
      return { side, height: one.height, ray, dot, circle };
    }

    show(at, time) {
      const { film } = this, ends = between(film.ends, 2, at), sides = between(this.shown, 2 * film.points, at);
      const rise = between(film.axle, 1, at)[0], n = film.points;
      const axle = AXLE - this.sheaveScale * (rise - film.axle[0]);
      this.wheel.setAttribute("transform", `translate(${CENTRE} ${axle}) rotate(${(between(film.angle, 1, at)[0] * 180) / Math.PI})`);
      for (const side of [0, 1]) {
        const low = rise - film.pit, height = (k) => ends[side] + film.down[k] * (low - ends[side]);
        const points = Array.from({ length: n }, (_, k) => [this.x(side, sides[side * n + k]), this.y(height(k), rise, axle)]);
        const arc = `L${this.x(side, 0)} ${axle}` + (side ? "" : `a${GAP} ${GAP} 0 0 0 ${2 * GAP} 0`);
        this.rope[side].setAttribute("d", this.side(side, points, axle) + arc);
        this.boxes[side].setAttribute("transform", `translate(${points[0].join(" ")})`);
      }
      this.sensors.forEach((one, k) => {
        const trace = film.traces[k], value = valueAt(trace, time), measured = trace.measured ? valueAt(trace.measured, time) : NaN;
        this._see(one, Number.isFinite(value), ends, rise, sides, axle);
        this._compare(one, (measured - value) / 1e3, this.y(one.height, rise, axle), axle);
      });
    }

    // The dot is on the rope as drawn, which in one of the views differs from the sensor's output.
    _see(one, seen, ends, rise, sides, axle) {
      const { film } = this, share = (ends[one.side] - one.height) / (ends[one.side] + film.pit - rise);
      const shape = { time: film.down, value: sides.subarray(one.side * film.points, (one.side + 1) * film.points) };
      const y = this.y(one.height, rise, axle), x = seen ? this.outside(one.side, this.x(one.side, valueAt(shape, share)), y, axle) : CENTRE;
      one.dot.setAttribute("cx", x);
      one.dot.setAttribute("cy", y);
      one.ray.setAttribute("x2", x);
      one.dot.style.display = one.ray.style.display = seen ? "" : "none";
    }

    // The circle is beside the dot by what was measured more than the model says [m].
    _compare(one, more, y, axle) {
      const known = Number.isFinite(more), by = (one.side ? 1 : -1) * this.lateral * this.stretch * more;
      one.circle.style.display = known ? "" : "none";
      if (!known) return;
      one.circle.setAttribute("cx", this.outside(one.side, +one.dot.getAttribute("cx") + by, y, axle));
      one.circle.setAttribute("cy", y);
    }

    // Sets the magnification relative to the one that fills the picture; returns the ratio of lateral to vertical scale.
    magnify(stretch) {
      this.stretch = stretch;
      const long = round125(90 / (this.lateral * stretch)), wide = long * this.lateral * stretch;
      this.bar.setAttribute("d", `M${CENTRE - wide / 2} 618v8h${wide}v-8`);
      this.barText.textContent = `${+(1e3 * long).toPrecision(3)} mm lateral`;
      return (this.lateral * stretch) / this.scale;
    }
  }

  // -- the rope around the sheave, in radii ---------------------------------------------------------
  class Sheave {
    constructor(svg, film) {
      this.film = film;
      const moves = largest(film.axle.map((one) => one - film.axle[0]));
      this.factor = moves > 0 ? Math.max(1, round125((0.3 * film.radius) / moves)) : 1;
      draw(svg, "line", { x1: -1.7, x2: 1.7, y1: 0, y2: 0, stroke: "#aab4bf", "stroke-width": 0.012, "stroke-dasharray": "0.06 0.06" });
      for (const x of [-1, 1]) {
        draw(svg, "line", { x1: x, x2: x, y1: -1.7, y2: 0, stroke: "#aab4bf", "stroke-width": 0.012, "stroke-dasharray": "0.03 0.06" });
      }
      this.group = draw(svg, "g", {});
      this.wheel = wheel(this.group, 0.97, 0.025);
      this.rope = draw(this.group, "path", { fill: "none", stroke: "#1d2733", "stroke-width": 0.045 });
      draw(svg, "text", { x: -1.7, y: 1.55, class: "tick" }, `vertical motion × ${this.factor}`);
    }

    show(at) {
      const { film } = this, n = film.around, arc = between(film.arc, 2 * n, at), rise = between(film.axle, 1, at)[0];
      this.group.setAttribute("transform", `translate(0 ${(-this.factor * (rise - film.axle[0])) / film.radius})`);
      this.wheel.setAttribute("transform", `rotate(${(between(film.angle, 1, at)[0] * 180) / Math.PI})`);
      this.rope.setAttribute("d", path(n, (k) => arc[k] / film.radius, (k) => -(arc[n + k] - rise) / film.radius));
    }
  }

  // -- a curve over time ----------------------------------------------------------------------------
  class Trace {
    constructor(parent, curve, end, pick) {
      this.curve = curve;
      const colour = curve.sensor === null ? PLAIN : COLOURS[curve.sensor % COLOURS.length];
      const svg = draw(parent, "svg", { viewBox: `0 0 ${WIDE} ${HIGH}`, class: "trace" });
      const all = [...curve.value, ...(curve.measured ? curve.measured.value : [])].filter(Number.isFinite);
      this.low = Math.min(...all, Infinity); this.high = Math.max(...all, -Infinity); this.end = end;
      draw(svg, "rect", { x: LEFT, y: UPPER, width: RIGHT - LEFT, height: LOWER - UPPER, fill: "#f5f7f9" });
      this._axes(svg, all.length);
      if (curve.measured) this._curve(svg, curve.measured, MEASURED);
      this._curve(svg, curve, colour);
      draw(svg, "text", { x: LEFT, y: 11, class: "name", fill: colour }, `${curve.name} [${curve.unit}]`);
      if (curve.measured) draw(svg, "text", { x: 180, y: 11, class: "name", fill: MEASURED }, "measured");
      this.text = draw(svg, "text", { x: RIGHT, y: 11, class: "name", fill: colour, "text-anchor": "end" });
      this.line = draw(svg, "line", { y1: UPPER, y2: LOWER, stroke: "#b3361b" });
      this._listen(svg, pick);
    }

    x(time) { return LEFT + ((RIGHT - LEFT) * time) / this.end; }
    y(value) { return this.high > this.low ? LOWER - 3 - ((LOWER - UPPER - 6) * (value - this.low)) / (this.high - this.low) : (UPPER + LOWER) / 2; }

    _axes(svg, seen) {
      for (const time of ticks(0, this.end, 8)) {
        draw(svg, "line", { x1: this.x(time), x2: this.x(time), y1: UPPER, y2: LOWER, stroke: "#dfe4ea" });
        draw(svg, "text", { x: this.x(time), y: LOWER + 12, class: "tick", "text-anchor": "middle" }, time ? `${time}` : "0 s");
      }
      for (const value of !seen ? [] : this.high > this.low ? ticks(this.low, this.high, 3) : [this.low]) {
        draw(svg, "line", { x1: LEFT, x2: RIGHT, y1: this.y(value), y2: this.y(value), stroke: "#dfe4ea" });
        draw(svg, "text", { x: LEFT - 4, y: this.y(value) + 4, class: "tick", "text-anchor": "end" }, `${+value.toPrecision(6)}`.replace("-", "−"));
      }
    }

    _curve(svg, { time, value }, colour) {
      draw(svg, "path", { d: path(time.length, (k) => this.x(time[k]), (k) => this.y(value[k])), fill: "none", stroke: colour, "stroke-width": 1.2 });
    }

    _listen(svg, pick) {
      const go = (event) => {
        const box = svg.getBoundingClientRect(), along = ((event.clientX - box.left) / box.width) * WIDE;
        pick(((along - LEFT) / (RIGHT - LEFT)) * this.end);
      };
      svg.addEventListener("pointerdown", (event) => { go(event); svg.setPointerCapture(event.pointerId); });
      svg.addEventListener("pointermove", (event) => { if (event.buttons) go(event); });
    }

    show(time) {
      const value = valueAt(this.curve, time);
      this.text.textContent = Number.isFinite(value) ? fixed(value) : "rope not in view";
      this.line.setAttribute("x1", this.x(time));
      this.line.setAttribute("x2", this.x(time));
    }
  }

  // -- one animation --------------------------------------------------------------------------------
  function readFilm(figure) {
    const film = JSON.parse(figure.querySelector(".film").textContent);
    film.points = film.sides.shape[2];
    film.around = film.arc.shape[2];
    for (const name of ["ends", "down", "sides", "rest", "arc", "axle", "angle"]) film[name] = unpack(film[name]);
    for (const one of film.traces) {
      for (const curve of one.measured ? [one, one.measured] : [one]) {
        curve.time = unpack(curve.time);
        curve.value = unpack(curve.value);
      }
    }
    return film;
  }

  class Player {
    constructor(figure) {
      this.find = (name) => figure.querySelector(`.${name}`);
      this.film = readFilm(figure);
      this.end = (this.film.frames - 1) * this.film.interval;
      this.time = 0;
      this.moved = null; // time at which the last frame was drawn, while playing
      this.shaft = new Shaft(this.find("shaft"), this.film);
      this.sheave = new Sheave(this.find("sheave"), this.film);
      this.traces = this.film.traces.map((one) => new Trace(this.find("traces"), one, this.end, (time) => this.show(time)));
      this.find("time").max = this.end;
      this.find("time").addEventListener("input", (event) => this.show(+event.target.value));
      this.find("play").addEventListener("click", () => this.toggle());
      this.find("magnify").addEventListener("input", () => this.magnify());
      this.find("view").addEventListener("change", () => this.magnify());
      this.magnify();
    }

    magnify() {
      this.shaft.view(this.find("view").value);
      const factor = this.shaft.magnify(2 ** +this.find("magnify").value);
      this.find("factor").textContent = `× ${+factor.toPrecision(2)}`;
      this.show(this.time);
    }

    show(time) {
      this.time = Math.min(this.end, Math.max(0, time));
      const at = Math.min(this.film.frames - 1, this.time / this.film.interval);
      this.find("time").value = this.time;
      this.find("clock").textContent = `${this.time.toFixed(2)} s of ${this.end.toFixed(1)} s`;
      for (const one of [this.shaft, this.sheave]) one.show(at, this.time);
      for (const one of this.traces) one.show(this.time);
      this._tell(at);
    }

    _tell(at) {
      const [car, counterweight] = between(this.film.ends, 2, at), [rise] = between(this.film.axle, 1, at);
      const turns = (between(this.film.angle, 1, at)[0] - this.film.angle[0]) / (2 * Math.PI);
      const rows = { car: `${car.toFixed(2)} m`, counterweight: `${counterweight.toFixed(2)} m`,
        "sheave displacement": `${(1e3 * (rise - this.film.axle[0])).toFixed(2)} mm`, "sheave rotation": `${turns.toFixed(2)} turns` };
      this.find("now").innerHTML = Object.entries(rows).map(([name, value]) => `<dt>${name}</dt><dd>${value}</dd>`).join("");
    }

    toggle() {
      this.moved = this.moved === null ? performance.now() : null;
      this.find("play").textContent = this.moved === null ? "Play" : "Pause";
      if (this.moved === null) return;
      if (this.time >= this.end) this.time = 0;
      requestAnimationFrame((now) => this.go(now));
    }

    go(now) {
      if (this.moved === null) return;
      this.show(this.time + Math.max(0, now - this.moved) / 1e3 * +this.find("speed").value);
      this.moved = now;
      if (this.time >= this.end) this.toggle(); else requestAnimationFrame((next) => this.go(next));
    }
  }

  for (const figure of document.querySelectorAll("figure.animation")) new Player(figure);
})();
