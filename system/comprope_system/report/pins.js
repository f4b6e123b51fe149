// Settings of a preview that stay drawn beside the present one, with their errors.
"use strict";
(() => {
  const STYLES = ["2", "3", "6", "7"]; // of their curves: as many as can be told apart
  const number = (value) => `${+value.toPrecision(3)}`.replaceAll("-", "−");
  const percent = (share) => (share === null || share === undefined ? "–" : `${number(100 * share)} %`);

  function make(parent, name, attributes = {}, text = "") {
    const element = document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    element.textContent = text;
    return parent.appendChild(element);
  }

  class Pins {
    // `preview.setting(effect, at)` is a setting with its errors and curves; `preview.go(setting)` moves the sliders there.
    constructor(preview, box, button) {
      [this.preview, this.box, this.button] = [preview, box, button];
      this.key = `pins ${location.pathname} ${preview.figure.id}`;
      button.addEventListener("click", () => this.add(preview.setting()));
      this.all = this._kept();
      this.show();
    }

    // Those of this page before it was loaded again, as previews.
    _kept() {
      let kept = [];
      try { kept = JSON.parse(sessionStorage.getItem(this.key) ?? "[]"); } catch { /* a page without storage begins anew */ }
      return kept.map(({ effect, at, style }) => ({ ...this.preview.setting(effect, at), style })).filter((one) => one.values);
    }

    add(setting) {
      const style = STYLES.find((one) => this.all.every((other) => other.style !== one));
      if (!style || this.all.some((one) => one.label === setting.label && one.simulated === setting.simulated)) return;
      this.all.push({ ...setting, style });
      this.show();
    }

    remove(one) {
      this.all = this.all.filter((other) => other !== one);
      this.show();
    }

    show() {
      const { box, all, preview } = this;
      box.replaceChildren();
      box.hidden = !all.length;
      this.button.disabled = all.length === STYLES.length;
      this.button.title = this.button.disabled ? `${STYLES.length} settings are pinned: remove one first` : "keep these curves and errors drawn while the sliders move on";
      preview.curves.pin(all.map(({ label, style, values }) => ({ name: label, style, values })));
      try { sessionStorage.setItem(this.key, JSON.stringify(all.map(({ effect, at, style }) => ({ effect, at, style })))); } catch { /* see above */ }
      if (!all.length) return;
      const table = make(make(box, "div", { class: "scroll" }), "table"), head = make(make(table, "thead"), "tr"), body = make(table, "tbody");
      const roles = Object.keys(preview.bars);
      for (const name of ["pinned", ...roles.map((role) => `NRMSE, ${preview.roles[role]}`), "", ""]) make(head, "th", name.startsWith("NRMSE") ? { class: "number" } : {}, name);
      for (const one of all) {
        const row = make(body, "tr"), name = make(row, "td");
        make(name, "i", { style: `--own: var(--series-${one.style})` });
        name.append(one.label);
        for (const role of roles) make(row, "td", { class: "number" }, percent(one.errors[role]));
        make(row, "td", { class: "soft" }, one.simulated ? "replayed" : "preview");
        const cell = make(row, "td");
        make(cell, "button", { type: "button" }, "go there").addEventListener("click", () => preview.go(one));
        make(cell, "button", { type: "button", "aria-label": `remove ${one.label}` }, "remove").addEventListener("click", () => this.remove(one));
      }
    }
  }

  window.compropePins = Pins;
})();
