// Moves curves and errors with the sliders of `report/preview.py`: interpolation between replays as in identification/preview.
"use strict";
(() => {
  const MISSING = -32768, STEPS = 200, BARS = 1.15; // steps of a slider; length of the bars over the largest error
  const bytes = (text) => Uint8Array.from(atob(text), (one) => one.charCodeAt(0)).buffer;

  // -- interpolation --------------------------------------------------------------------------------
  function hermite(nodes, x) {
    const falling = nodes[0] > nodes[nodes.length - 1];
    let j = 0;
    while (j < nodes.length - 2 && (falling ? x < nodes[j + 1] : x > nodes[j + 1])) j += 1;
    const h = nodes[j + 1] - nodes[j], t = (x - nodes[j]) / h, values = nodes.map(() => 0), slopes = nodes.map(() => 0);
    values[j] = (1 + 2 * t) * (1 - t) ** 2;
    values[j + 1] = t ** 2 * (3 - 2 * t);
    slopes[j] = h * t * (1 - t) ** 2;
    slopes[j + 1] = h * t ** 2 * (t - 1);
    return { values, slopes };
  }

  const product = (factors) => factors.reduce((a, b) => a * b, 1);
  const lagrange = (nodes, x) => nodes.map((a, k) => product(nodes.filter((_, j) => j !== k).map((b) => (x - b) / (a - b))));

  function lagrangeSlopes(nodes, centre) {
    const at = nodes[centre];
    const found = nodes.map((a, k) => (k === centre ? 0 : product(nodes.filter((_, j) => j !== k && j !== centre).map((b) => (at - b) / (a - b))) / (a - at)));
    found[centre] = -found.reduce((a, b) => a + b, 0);
    return found;
  }

  // Numbers of the nodes on each line: the centre is 0, the others follow line by line.
  function numbers(sliders) {
    let next = 1;
    return sliders.map(({ nodes, centre }) => nodes.map((_, j) => (j === centre ? 0 : next++)));
  }

  // Weights of all data, node by node: a value, then a derivative by each slider.
  function weights(sliders, at) {
    const count = sliders.length, width = 1 + count, places = numbers(sliders).map((one) => one.map((k) => k * width));
    const found = new Array((1 + sliders.reduce((sum, one) => sum + one.nodes.length - 1, 0)) * width).fill(0);
    found[0] = 1 - count;
    sliders.forEach(({ nodes }, k) => {
      const { values, slopes } = hermite(nodes, at[k]);
      places[k].forEach((place, j) => { found[place] += values[j]; found[place + 1 + k] += slopes[j]; });
    });
    if (count === 2) {
      const steps = sliders.map(({ nodes, centre }, k) => at[k] - nodes[centre]);
      sliders.forEach(({ nodes, centre }, k) => {
        const own = steps[k], other = steps[1 - k], along = lagrange(nodes, at[k]), slopes = lagrangeSlopes(nodes, centre);
        places[k].forEach((place, j) => { found[place + 2 - k] += other * (along[j] - 0.5 * own * slopes[j]); });
        found[2 - k] -= other;
      });
    }
    return found;
  }

  // -- data -----------------------------------------------------------------------------------------
  function readPanel({ data, scales, form }) {
    if (!data) return { form: form && new Float64Array(bytes(form)) };
    const size = new Float32Array(bytes(scales)), whole = new Int16Array(bytes(data)), count = whole.length / size.length;
    return { size, whole, count, form: form && new Float64Array(bytes(form)) };
  }

  function curve({ size, whole, count }, by) {
    const scaled = by.map((one, k) => one * size[k]), used = scaled.map((_, k) => k).filter((k) => by[k] !== 0);
    return Array.from({ length: count }, (_, i) => {
      let sum = 0;
      for (const k of used) {
        const value = whole[k * count + i];
        if (value === MISSING) return null;
        sum += scaled[k] * value;
      }
      return sum;
    });
  }

  function squaredError({ form }, by) {
    let sum = 0, at = 0;
    for (let i = 0; i < by.length; i += 1) for (let j = i; j < by.length; j += 1, at += 1) sum += (i === j ? 1 : 2) * by[i] * by[j] * form[at];
    return Math.max(sum, 0);
  }

  // NRMSE of the runs of a role; null where it is not defined.
  function nrmse(runs, role, by) {
    const squares = runs.filter((one) => one.role === role).flatMap((one) => one.panels).filter((one) => one.form).map((one) => squaredError(one, by));
    return squares.length ? Math.sqrt(squares.reduce((a, b) => a + b, 0) / squares.length) : null;
  }

  // -- elements -------------------------------------------------------------------------------------
  function make(parent, name, attributes = {}, text = "") {
    const element = document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    element.textContent = text;
    return parent.appendChild(element);
  }

  const number = (value) => `${+value.toPrecision(3)}`.replaceAll("-", "−");
  const percent = (share) => (share === null || share === undefined ? "–" : `${number(100 * share)} %`);
  const ROLES = { fit: "fit runs", validate: "validation runs" };

  class Preview {
    constructor(figure) {
      this.figure = figure;
      this.data = JSON.parse(figure.querySelector("script.preview-data").textContent);
      this.effects = this.data.effects.map((one) => {
        const runs = one.runs.map((run) => ({ ...run, panels: run.panels.map(readPanel) }));
        return { ...one, runs, drawn: runs.filter((run) => run.drawn) };
      });
      this.curves = window.compropeCurves.get(this.data.curves);
      this.curves.drawn = () => this.draw();
      this.badge = figure.querySelector(".badge");
      this.roles = ROLES;
      this.past = []; // settings before each release, the latest last
      this.back = figure.querySelector(".undo");
      this.back.addEventListener("click", () => this.undo());
      this._choices(figure.querySelector(".effects"));
      this._errors(figure.querySelector(".errors"));
      this.choose(0);
      this.settled = { effect: this.effect.name, at: [...this.at] };
      this.pins = new window.compropePins(this, figure.querySelector(".pins"), figure.querySelector(".pin"));
    }

    _choices(box) {
      this.buttons = this.effects.map((one, k) => {
        const button = make(box, "button", { type: "button", "aria-pressed": false }, one.name.replaceAll("_", " "));
        button.addEventListener("click", () => { this.choose(k); this.released(); });
        return button;
      });
      box.hidden = this.effects.length < 2;
    }

    _errors(box) {
      this.bars = {};
      const { errors } = this.data;
      for (const role of Object.keys(ROLES).filter((one) => errors[one] && this.effects[0].runs.some((run) => run.role === one))) {
        const row = make(box, "div", { class: "row" });
        make(row, "span", { class: "role" }, `NRMSE, ${ROLES[role]}`);
        const value = make(row, "output", { class: "value", "data-role": role }), bar = make(row, "div", { class: "bar", "aria-hidden": true });
        this.bars[role] = { value, fill: make(bar, "i"), given: make(bar, "b", { title: "as given" }), noise: make(bar, "u", { title: "noise alone" }) };
        make(row, "span", { class: "known" }, `as given ${percent(errors[role][0])}, noise alone ${percent(errors[role][1])}`);
      }
    }

    choose(k) {
      this.effect = this.effects[k];
      this.buttons.forEach((one, j) => one.setAttribute("aria-pressed", j === k));
      this.at = this.effect.sliders.map(({ nodes, centre }) => nodes[centre]);
      this.simulated = null;
      const all = this.effect.sliders.flatMap((one, j) => one.nodes.map((value) => this.at.map((x, i) => (i === j ? value : x))));
      this.most = Object.fromEntries(Object.keys(this.bars).map((role) =>
        [role, BARS * Math.max(this.data.errors[role][0] ?? 0, ...all.map((at) => nrmse(this.effect.runs, role, weights(this.effect.sliders, at)) ?? 0))]));
      this._sliders();
      this._limits();
      this.draw();
    }

    _sliders() {
      const box = this.figure.querySelector(".sliders");
      box.replaceChildren();
      this.inputs = this.effect.sliders.map((one, k) => {
        const { nodes } = one, [low, high] = [nodes[0], nodes[nodes.length - 1]].sort((a, b) => a - b), row = make(box, "div", { class: "slider" });
        const label = `${one.name}${one.unit ? ` [${one.unit}]` : ""}`, id = `${this.figure.id}-${k}`;
        make(row, "label", { for: id }, label);
        const input = make(row, "input", { type: "range", id, min: low, max: high, step: (high - low) / STEPS });
        const told = make(row, "output", { for: id });
        const off = make(row, "button", { type: "button", "aria-pressed": false }, "off"), back = make(row, "button", { type: "button" }, "as fitted");
        input.addEventListener("input", () => this.move(k, +input.value));
        input.addEventListener("change", () => this.released());
        off.addEventListener("click", () => { this.move(k, nodes[0]); this.released(); });
        back.addEventListener("click", () => { this.move(k, nodes[one.centre]); this.released(); });
        return { input, told, off };
      });
    }

    // Axes that hold all that the sliders can show, so that an error is seen to fall.
    _limits() {
      const lines = numbers(this.effect.sliders), width = 1 + lines.length, nodes = [...new Set(lines.flat())];
      this.curves.groups.forEach((group, r) => group.data.panels.forEach((_, p) => {
        this.curves.limit(r, p, nodes.map((k) => curve(this.effect.drawn[r].panels[p], new Array(nodes.length * width).fill(0).map((zero, j) => (j === k * width ? 1 : zero)))));
      }));
    }

    move(k, value) {
      const { nodes } = this.effect.sliders[k], edges = [nodes[0], nodes[nodes.length - 1]].sort((a, b) => a - b);
      this.at[k] = Math.min(Math.max(value, edges[0]), edges[1]);
      this.simulated = null;
      this.begun ??= performance.now();
      this.waiting ??= requestAnimationFrame(() => { this.waiting = undefined; this.draw(); setTimeout(() => this.timed()); });
    }

    // Milliseconds from the movement of the hand until its frame has been drawn, for measurements.
    timed() {
      if (this.begun === undefined) return;
      (this.figure.frames ??= []).push(performance.now() - this.begun);
      this.begun = undefined;
    }

    // Moves the sliders to a setting, as of a pin.
    go({ effect, at }, remember = true) {
      this.choose(this.effects.findIndex((one) => one.name === effect));
      this.at = [...at];
      this.draw();
      this.released(remember);
    }

    undo() { if (this.past.length) this.go(this.past.pop(), false); }

    // A setting with its errors and the curves of each drawn run, by default the present one; without curves for an unknown effect.
    setting(name = this.effect.name, at = this.at) {
      const effect = this.effects.find((one) => one.name === name), present = effect === this.effect && at === this.at;
      if (!effect || at.length !== effect.sliders.length) return { effect: name, at };
      const by = weights(effect.sliders, at), simulated = present && this.simulated;
      const label = `${name.replaceAll("_", " ")}: ${effect.sliders.map((one, k) => `${one.name} ${number(at[k])} ${one.unit}`.trim()).join(", ")}`;
      const errors = Object.fromEntries(Object.keys(this.bars).map((role) => [role, simulated ? simulated.errors[role] : nrmse(effect.runs, role, by)]));
      const values = new Map(this.curves.groups.map((group, r) => [group.data.name, Object.fromEntries(group.data.panels.map((panel, p) =>
        [panel.name, simulated ? simulated.curves[group.data.name][panel.name] : curve(effect.drawn[r].panels[p], by)]))]));
      return { effect: name, at: [...at], label, errors, values, simulated: Boolean(simulated) };
    }

    released(remember = true) {
      const now = { effect: this.effect.name, at: [...this.at] };
      if (remember && JSON.stringify(now) !== JSON.stringify(this.settled)) this.past.push(this.settled);
      this.settled = now;
      this.back.disabled = !this.past.length;
      this.figure.dispatchEvent(new CustomEvent("comprope:released", { bubbles: true, detail: { effect: this.effect.name, values: [...this.at] } }));
    }

    // What a simulation with these values shows, in place of the interpolation, unless the hand has moved on.
    replayed({ effect, values }, found) {
      if (effect !== this.effect.name || values.some((one, k) => one !== this.at[k])) return;
      this.simulated = found;
      this.draw();
    }

    _mark(simulated) {
      this.badge.textContent = simulated ? "replayed" : "preview";
      this.badge.title = simulated ? "the simulation was run with these values" : "interpolated between simulations";
    }

    draw() {
      const { sliders, runs, drawn } = this.effect, { simulated } = this, by = weights(sliders, this.at);
      this.inputs.forEach(({ input, told, off }, k) => {
        input.value = this.at[k];
        told.textContent = `${number(this.at[k])} ${sliders[k].unit}`;
        input.setAttribute("aria-valuetext", told.textContent);
        off.setAttribute("aria-pressed", this.at[k] === sliders[k].nodes[0]);
      });
      const atNode = sliders.every(({ nodes, centre }, k) => nodes.includes(this.at[k]) && (sliders.length === 1 || this.at[k] === nodes[centre]));
      this._mark(simulated || atNode);
      for (const [role, { value, fill, given, noise }] of Object.entries(this.bars)) {
        const error = simulated ? simulated.errors[role] : nrmse(runs, role, by), place = (share) => `${(100 * (share ?? 0)) / this.most[role]}%`;
        value.textContent = percent(error);
        fill.style.width = place(error);
        given.style.left = place(this.data.errors[role][0]);
        noise.style.left = place(this.data.errors[role][1]);
      }
      this.curves.groups.forEach((group, r) => {
        if (group.box.hidden) return;
        group.data.panels.forEach((panel, p) => this.curves.replace(r, p, simulated ? simulated.curves[group.data.name][panel.name] : curve(drawn[r].panels[p], by)));
      });
    }
  }

  window.compropePreviews = new Map([...document.querySelectorAll("figure.preview")].map((one) => [one.id, new Preview(one)]));
})();
