// Draws the curves of a page: data as encoded by `report/curves.py`, with uPlot. No network access.
"use strict";
(() => {
  const HEIGHT = 168, RESIDUAL_HEIGHT = 112, AXIS = 68, PRINTED_WIDTH = 660; // in pixels
  const PAN = 0.2, ZOOM = 0.6; // share of the shown span that a step moves, or that remains
  const MARGIN = 0.15; // of a phase, shown before and after it
  const DASHES = { before: [6, 3] }, PINNED = [7, 2, 2, 2];
  const root = document.documentElement;

  // -- data ---------------------------------------------------------------------------------------
  function unpack(text) {
    const bytes = Uint8Array.from(atob(text), (one) => one.charCodeAt(0)), view = new DataView(bytes.buffer);
    return Array.from({ length: bytes.length / 4 }, (_, k) => {
      const value = view.getFloat32(4 * k, true);
      return Number.isFinite(value) ? value : null;
    });
  }

  function readPanel(panel) {
    const curves = panel.curves.map((one) => ({ ...one, value: unpack(one.value) }));
    const measured = curves.find((one) => one.style === "measured");
    const less = (a, b) => a.map((value, k) => (value === null || b[k] === null ? null : value - b[k]));
    const residuals = measured
      ? curves.filter((one) => one !== measured).map((one) => ({ ...one, residual: true, value: less(measured.value, one.value) }))
      : [];
    const largest = curves.reduce((most, one) => one.value.reduce((a, b) => Math.max(a, Math.abs(b)), most), 0);
    return { ...panel, source: panel, place: unpack(panel.place), curves, residuals, largest };
  }

  // A value of three digits; what is below the digits of the data is zero.
  function shown(value, largest) {
    if (value === null || value === undefined) return "–";
    return `${Math.abs(value) < 1e-6 * largest ? 0 : +value.toPrecision(3)}`.replaceAll("-", "−");
  }

  // -- elements -----------------------------------------------------------------------------------
  function make(parent, name, attributes = {}, text = "") {
    const element = document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    element.textContent = text;
    return parent.appendChild(element);
  }

  const colour = (name) => getComputedStyle(root).getPropertyValue(`--${name}`).trim();
  const styled = (style) => colour(/^\d+$/.test(style) ? `series-${style}` : style);

  // Buttons that switch something on and off; returns a function that sets one of them.
  function switches(parent, title, names, pressed, act) {
    if (names.length < 2) return () => {};
    const box = make(parent, "div", { class: "switches", role: "group", "aria-label": title });
    make(box, "span", { class: "title" }, title);
    const buttons = names.map(({ name, style }, k) => {
      const button = make(box, "button", { type: "button", "aria-pressed": pressed(k) });
      if (style) make(button, "i", { style: `--own: var(--${/^\d+$/.test(style) ? `series-${style}` : style})`, class: DASHES[style] ? "dashed" : "" });
      make(button, "span", {}, name);
      button.addEventListener("click", () => set(k, button.getAttribute("aria-pressed") !== "true"));
      return button;
    });
    const set = (k, on) => { buttons[k].setAttribute("aria-pressed", on); act(k, on); };
    return set;
  }

  // -- one plot -----------------------------------------------------------------------------------
  function series({ name, style, pinned }) {
    return { label: name, stroke: () => styled(style), width: style === "measured" ? 1.6 : 1.3, dash: pinned ? PINNED : DASHES[style], points: { show: false } };
  }

  function axes(residual, axis) {
    const common = { stroke: () => colour("soft"), grid: { stroke: () => colour("line"), width: 1 }, ticks: { show: false }, font: "12px system-ui, sans-serif" };
    const numbers = (plot, values) => values.map((value) => (value === null ? "" : `${+value.toPrecision(6)}`.replaceAll("-", "−")));
    return [{ ...common, show: residual !== "above", size: 26, values: (plot, values) => numbers(plot, values).map((one, k) => (k === values.length - 1 ? `${one} ${axis}` : one)) },
      { ...common, size: AXIS, space: 26, values: numbers }];
  }

  // Background of a plot: phases of the trip and the band of the noise.
  function background(group, panel, residual) {
    return (plot) => {
      const { ctx, bbox } = plot, clip = (value, low, high) => Math.min(Math.max(value, low), high);
      const x = (value) => clip(plot.valToPos(value, "x", true), bbox.left, bbox.left + bbox.width);
      const y = (value) => clip(plot.valToPos(value, "y", true), bbox.top, bbox.top + bbox.height);
      const fill = (name, a, b, top, bottom) => { ctx.fillStyle = colour(name); ctx.fillRect(a, top, b - a, bottom - top); };
      ctx.save();
      ctx.font = `${11 * devicePixelRatio}px system-ui, sans-serif`;
      for (const span of group.spans) {
        const a = x(span.start), b = x(span.end);
        if (span.tinted) fill("tint", a, b, bbox.top, bbox.top + bbox.height);
        if (residual || ctx.measureText(span.name).width > b - a - 4) continue;
        ctx.fillStyle = colour("soft");
        ctx.textAlign = "center";
        ctx.fillText(span.name, (a + b) / 2, bbox.top + 11 * devicePixelRatio);
      }
      if (residual) for (const [from, to, half] of panel.noise) fill("noise", x(from), x(to), y(half), y(-half));
      ctx.restore();
    };
  }

  // -- a group of panels on one axis ------------------------------------------------------------------
  class Group {
    constructor(parent, data, owner) {
      this.data = data;
      this.owner = owner;
      this.plots = [];
      this.box = make(parent, "div", { class: "group", tabindex: 0, role: "group", "aria-label": `${data.title}. Arrow keys move the cursor, with Shift the view; plus and minus zoom; 0 shows the whole.` });
      const head = make(this.box, "div", { class: "head" });
      make(head, "h3", {}, data.title);
      for (const [text, what, act] of [["◀", "earlier", () => this.pan(-PAN)], ["▶", "later", () => this.pan(PAN)],
        ["+", "zoom in", () => this.zoom(ZOOM)], ["−", "zoom out", () => this.zoom(1 / ZOOM)], ["whole", "show the whole", () => this.whole()]]) {
        make(head, "button", { type: "button", title: what, "aria-label": what }, text).addEventListener("click", act);
      }
      this.box.addEventListener("keydown", (event) => this.key(event));
      this.range = [...data.range];
    }

    // Draws the panels when they are first shown: what is switched off costs nothing.
    draw() {
      if (this.panels) return;
      this.panels = this.data.panels.map((panel) => this._panel(readPanel(panel)));
      new ResizeObserver(() => this.resize()).observe(this.box);
    }

    _panel(panel) {
      const box = make(this.box, "div", { class: "panel" }), head = make(box, "p", { class: "name" });
      make(head, "b", {}, panel.unit ? `${panel.name} [${panel.unit}]` : panel.name);
      const told = make(head, "span", { class: "told" }, panel.detail), parts = [];
      const own = { panel, box, told, plots: [] };
      parts.push([panel.curves, panel.residuals.length ? "above" : "alone"]);
      if (panel.residuals.length) parts.push([panel.residuals, "residual"]);
      for (const [curves, place] of parts) {
        const holder = make(box, "div", { class: place });
        if (place === "residual") make(holder, "p", { class: "note" }, panel.noise.length ? "measured less model; band: ± 2 standard deviations of the noise" : "measured less model");
        own.plots.push(this._plot(holder, own, curves, place));
      }
      return own;
    }

    _plot(holder, own, curves, place) {
      const residual = place === "residual", move = (plot) => this.tell(own, plot), { panel } = own;
      const options = {
        width: this.width(), height: residual ? RESIDUAL_HEIGHT : HEIGHT, legend: { show: false }, 
        padding: [6, 12, place === "above" ? 8 : 0, 0], // so that the lowest number of an axis is not cut
        scales: { x: { time: false, range: () => this.range }, y: { range: (plot, low, high) => this.owner.limits(own.panel, residual) ?? (low === null ? [null, null] : uPlot.rangeNum(low, high, 0.1, true)) } }, axes: axes(place, this.owner.data.unit), series: [{}, ...curves.map(series)],
        hooks: { drawClear: [background(this.data, panel, residual)], setCursor: [move], setSelect: [(plot) => this.select(plot)] },
        cursor: {
          y: false, drag: { x: true, y: false, setScale: false }, points: { size: 6 },
          sync: { key: `${this.owner.data.key}:${this.data.name}`, setSeries: false, scales: ["x", null], filters: { pub: (type) => type === "mousemove" || type === "mouseleave" } },
          bind: { mousedown: (plot, target, handler) => (event) => (event.shiftKey ? this.grab(event) : handler(event)), dblclick: () => () => this.whole() },
        },
      };
      const plot = new uPlot(options, [panel.place, ...curves.map((one) => one.value)], holder);
      plot.over.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
      plot.curves = curves;
      this.plots.push(plot);
      return plot;
    }

    width() { return root.classList.contains("printing") ? PRINTED_WIDTH : Math.max(this.box.clientWidth, 240); }

    resize() {
      const width = this.width();
      if (this.box.clientWidth) for (const plot of this.plots) if (plot.width !== width) plot.setSize({ width, height: plot.height });
    }

    redraw() { for (const plot of this.plots) plot.redraw(false); }

    // -- view
    view(from, to) {
      const [low, high] = this.data.range, span = Math.min(Math.max(to - from, (high - low) * 1e-4), high - low);
      const start = Math.min(Math.max(from, low), high - span);
      this.range = [start, start + span];
      [this.box.dataset.from, this.box.dataset.to] = this.range;
      for (const plot of this.plots) plot.setScale("x", { min: start, max: start + span });
    }

    whole() { this.view(...this.data.range); }
    around({ start, end }) {
      const [low, high] = this.data.range, margin = MARGIN * (end - start);
      this.view(Math.max(start - margin, low), Math.min(end + margin, high));
    }

    pan(share) { const [a, b] = this.range, by = share * (b - a); this.view(a + by, b + by); }
    zoom(factor, about) {
      const [a, b] = this.range, middle = about ?? this.time() ?? (a + b) / 2;
      this.view(middle - factor * (middle - a), middle + factor * (b - middle));
    }

    select(plot) {
      const { left, width } = plot.select;
      if (width < 3) return;
      plot.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
      this.view(plot.posToVal(left, "x"), plot.posToVal(left + width, "x"));
    }

    // Dragging with Shift held down moves the view.
    grab(event) {
      const [a, b] = this.range, from = event.clientX, width = this.plots[0].over.clientWidth;
      const move = (next) => { const by = ((from - next.clientX) / width) * (b - a); this.view(a + by, b + by); };
      addEventListener("mousemove", move);
      addEventListener("mouseup", () => removeEventListener("mousemove", move), { once: true });
      event.preventDefault();
    }

    // The wheel scrolls the page; with Ctrl it zooms, with Shift it moves the view.
    wheel(event) {
      if (!event.ctrlKey && !event.shiftKey) return;
      event.preventDefault();
      const turn = Math.sign(event.deltaY || event.deltaX);
      if (event.ctrlKey) this.zoom(turn < 0 ? ZOOM : 1 / ZOOM); else this.pan(turn * PAN);
    }

    key(event) {
      if (event.target !== this.box || event.ctrlKey || event.altKey || event.metaKey) return;
      const turn = event.key === "ArrowLeft" ? -1 : 1, acts = {
        ArrowLeft: () => (event.shiftKey ? this.pan(-PAN) : this.step(turn)), ArrowRight: () => (event.shiftKey ? this.pan(PAN) : this.step(turn)),
        "+": () => this.zoom(ZOOM), "=": () => this.zoom(ZOOM), "-": () => this.zoom(1 / ZOOM), 0: () => this.whole(), Escape: () => this.whole(),
      };
      if (!acts[event.key]) return;
      acts[event.key]();
      event.preventDefault();
    }

    // -- cursor
    time() {
      const plot = this.plots.find((one) => one.cursor.left >= 0);
      return plot ? plot.posToVal(plot.cursor.left, "x") : null;
    }

    step(turn) {
      const plot = this.plots.find((one) => one.over.clientWidth);
      if (!plot) return;
      const width = plot.over.clientWidth, now = plot.cursor.left >= 0 ? plot.cursor.left : turn > 0 ? 0 : width;
      const left = Math.min(Math.max(now + (turn * width) / 200, 0), width - 1);
      for (const one of this.plots) one.setCursor({ left, top: 10 });
    }

    // Values at the cursor, in the head of the panel.
    tell(own, plot) {
      const { idx, left } = plot.cursor, { panel, told } = own;
      told.textContent = "";
      if (left < 0 || idx === null || idx === undefined) { told.textContent = panel.detail; return; }
      make(told, "span", {}, `${+panel.place[idx].toPrecision(5)} ${this.owner.data.unit}`);
      for (const one of panel.curves) make(told, "span", { style: `color: var(--${/^\d+$/.test(one.style) ? `series-${one.style}` : one.style})` }, `${one.name} ${shown(one.value[idx], panel.largest)}`);
      for (const one of panel.residuals) make(told, "span", {}, `residual${panel.residuals.length > 1 ? ` ${one.name}` : ""} ${shown(one.value[idx], panel.largest)}`);
      make(told, "span", {}, panel.unit);
    }
  }

  // -- all groups of a figure -------------------------------------------------------------------------
  const unique = (all) => [...new Map(all.map((one) => [one.name, one])).values()];

  class Curves {
    constructor(figure) {
      this.data = JSON.parse(figure.querySelector("script").textContent);
      this.data.key = figure.id;
      const controls = figure.querySelector(".controls"), place = figure.querySelector(".groups"), { groups } = this.data;
      const panels = unique(groups.flatMap((one) => one.panels)), curves = unique(panels.flatMap((one) => one.curves));
      this.panels = panels.map((one) => one.name);
      this.curves = curves.map((one) => one.name);
      this.off = { panels: new Set(), curves: new Set(), residual: false };
      this.pinned = [];
      this.groups = groups.map((one) => new Group(place, one, this));
      this.setGroup = switches(controls, this.data.kind, groups, (k) => groups[k].shown, (k, on) => this.showGroup(k, on));
      this.setPanel = switches(controls, "channels", panels, () => true, (k, on) => this.toggle("panels", this.panels[k], on));
      const residual = curves.some((one) => one.style === "measured") ? [{ name: "residual" }] : [];
      switches(controls, "curves", [...curves, ...residual], () => true, (k, on) => (k < curves.length ? this.toggle("curves", this.curves[k], on) : this.residual(on)));
      this.groups.forEach((one, k) => this.showGroup(k, groups[k].shown));
    }

    showGroup(k, on) {
      const group = this.groups[k];
      group.box.hidden = !on;
      if (on) { this._drawn(group); this.drawn?.(); this.apply(group); group.resize(); }
    }

    _drawn(group) {
      if (group.panels) return;
      group.draw();
      if (this.pinned.length) this._pinned(group);
    }

    toggle(what, name, on) {
      if (on) this.off[what].delete(name); else this.off[what].add(name);
      this.applyAll();
    }

    residual(on) { this.off.residual = !on; this.applyAll(); }
    applyAll() { for (const group of this.groups) if (!group.box.hidden) this.apply(group); }

    apply(group) {
      for (const { panel, box, plots } of group.panels) {
        box.hidden = this.off.panels.has(panel.name);
        if (plots.length > 1) plots[1].root.parentElement.hidden = this.off.residual;
        for (const plot of plots) plot.curves.forEach((one, k) => {
          const on = !this.off.curves.has(one.name);
          if (plot.series[k + 1].show !== on) plot.setSeries(k + 1, { show: on });
        });
      }
    }

    // Further curves of each panel, below the last one: `all` are { name, style, values: by group and panel }.
    pin(all) {
      this.pinned = all;
      for (const group of this.groups) this._pinned(group);
    }

    _pinned(group) {
      for (const { panel, plots: [plot] } of group.panels ?? []) {
        for (let k = panel.curves.length - 1; k >= 0; k -= 1) if (panel.curves[k].pinned) { panel.curves.splice(k, 1); plot.delSeries(k + 1); }
        for (const { name, style, values } of this.pinned) {
          const value = values.get(group.data.name)?.[panel.name], at = panel.curves.length - 1;
          if (!value) continue;
          panel.curves.splice(at, 0, { name, style, value, pinned: true });
          plot.addSeries(series(panel.curves[at]), at + 1);
        }
        if (panel.source.limits) panel.source.limits.found = null;
        plot.setData([panel.place, ...panel.curves.map((one) => one.value)], false);
        plot.redraw();
      }
    }

    // Other values of the last curve of a panel, as of a preview; its residual follows.
    replace(k, panel, values) {
      const shown = this.groups[k].panels?.[panel];
      if (!shown) return;
      const { curves, residuals } = shown.panel, last = curves.length - 1, measured = curves.find((one) => one.style === "measured");
      curves[last].value = values;
      for (const one of residuals.slice(-1)) one.value = values.map((value, j) => (value === null || measured.value[j] === null ? null : measured.value[j] - value));
      for (const plot of shown.plots) {
        plot.setData([shown.panel.place, ...plot.curves.map((one) => one.value)], false);
        plot.redraw();
      }
    }

    // Axes of a panel that hold the measured curve and all of some values of the model, and their residuals.
    limit(k, panel, all) { (this.groups[k].data.panels[panel].limits = { all }); }

    limits(panel, residual) {
      const { limits } = panel.source;
      if (!limits) return null;
      if (!limits.found || limits.found.of !== limits.all) {
        const measured = panel.curves.find((one) => one.style === "measured").value, less = (one) => one.map((value, j) => (value === null ? null : measured[j] - value));
        const reach = (rows) => { const known = rows.flat().filter((one) => one !== null); return uPlot.rangeNum(Math.min(...known), Math.max(...known), 0.1, true); };
        limits.found = { of: limits.all, curves: reach([measured, ...limits.all, ...panel.curves.filter((one) => one.pinned).map((one) => one.value)]), residuals: reach(limits.all.map(less)) };
      }
      return residual ? limits.found.residuals : limits.found.curves;
    }

    // Shows one panel, over one span of its axis.
    visit(k, panel, span) {
      const group = this.groups[k], named = group.data.panels[panel];
      this.setGroup(k, true);
      this.showGroup(k, true);
      if (named) { this.setPanel(this.panels.indexOf(named.name), true); this.toggle("panels", named.name, true); }
      const found = group.data.spans.find((one) => one.name === span);
      if (found) group.around(found); else group.whole();
      (named ? group.panels[panel].box : group.box).scrollIntoView({ block: "start" });
      group.box.focus({ preventScroll: true });
    }
  }

  const all = new Map([...document.querySelectorAll("figure.curves")].map((one) => [one.id, new Curves(one)]));
  window.compropeCurves = all;
  const each = (act) => { for (const one of all.values()) for (const group of one.groups) act(group); };

  document.addEventListener("click", (event) => {
    const link = event.target.closest("a[data-curves]");
    if (!link) return;
    event.preventDefault();
    const { curves, group, panel, span } = link.dataset;
    all.get(curves).visit(+group, +panel, span);
  });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => each((group) => group.redraw()));
  const printing = (on) => { root.classList.toggle("printing", on); each((group) => { group.resize(); group.redraw(); }); };
  addEventListener("beforeprint", () => printing(true));
  addEventListener("afterprint", () => printing(false));
})();
