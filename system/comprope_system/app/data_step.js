// The first step: files, what their columns are taken for, corrections, and the campaign that is saved.
import { ask, find, make, showPage, tell } from "./elements.js";

const LEFT_OUT = "left out", DELAY = 250; // ms after a correction until the files are read again
let stated = { columns: {}, roles: {}, changes: {}, car: "", model: "" };
const earlier = []; // `stated` before each correction, the latest last
let state = null, found = null, waiting = null, reads = 0, known = "", uploading = false;

export function showData(now) {
  state = now;
  find("#describing").hidden = now.exists;
  find("#described").hidden = !now.exists;
  find("#described-text").textContent = `${now.folder} is described in its campaign.toml, which can be edited; results follow its content.`;
  if (now.exists) return;
  const list = find("#uploads"), names = now.uploads.map((one) => one.name).join("|");
  if (!find("#model").options.length) models(now.presets);
  if (names === known || uploading) return;
  known = names;
  list.replaceChildren();
  for (const { name, size } of now.uploads) {
    const item = make(list, "li", {}, `${name} (${Math.ceil(size / 1000)} kB)`);
    make(item, "button", { type: "button", "aria-label": `remove ${name}` }, "×").addEventListener("click", () => ask("DELETE", `/files/${encodeURIComponent(name)}`));
  }
  const own = now.uploads.find((one) => one.name.endsWith(".toml"));
  find("#model").hidden = Boolean(own);
  find("#model-told").textContent = own ? own.name : "a preset; or drop a model file";
  if (now.uploads.length) describe(); else find("#guess").hidden = true;
}

function models(presets) {
  for (const name of presets) make(find("#model"), "option", {}, name);
  find("#model").addEventListener("change", (event) => correct(() => { stated.model = event.target.value; }));
}

// -- files ------------------------------------------------------------------------------------------
async function upload(files) {
  uploading = true;
  for (const file of files) if (!(await ask("PUT", `/files/${encodeURIComponent(file.name)}`, file))) break;
  uploading = false;
  const now = await ask("GET", "/state");
  if (now) showData(now);
}

const drop = find("#drop");
for (const name of ["dragenter", "dragover"]) drop.addEventListener(name, (event) => { event.preventDefault(); drop.classList.add("over"); });
for (const name of ["dragleave", "drop"]) drop.addEventListener(name, () => drop.classList.remove("over"));
drop.addEventListener("drop", (event) => { event.preventDefault(); upload([...event.dataTransfer.files]); });
find("#files").addEventListener("change", (event) => { upload([...event.target.files]); event.target.value = ""; });

// -- description ------------------------------------------------------------------------------------
// Makes a correction that can be undone; the files are read again a moment later.
function correct(act) {
  earlier.push(structuredClone(stated));
  act();
  find("#undo").disabled = false;
  clearTimeout(waiting);
  waiting = setTimeout(describe, DELAY);
}

find("#undo").addEventListener("click", () => {
  stated = earlier.pop();
  find("#undo").disabled = earlier.length === 0;
  const models = find("#model");
  models.value = stated.model || models.options[0].value;
  describe();
});

async function describe() {
  clearTimeout(waiting);
  const mine = ++reads;
  find("#busy").textContent = "reading the files";
  find("#save").disabled = true;
  const answer = await ask("POST", "/describe", { ...stated, model: stated.model || find("#model").value });
  if (mine !== reads) return;
  find("#busy").textContent = "";
  if (!answer) return;
  found = answer;
  find("#guess").hidden = false;
  render();
  find("#save").disabled = found.problems.length > 0;
  if (found.preview) showPage(find("#preview"), "/preview", `${mine}`); else find("#preview").hidden = true;
}

// Redraws the tables and keeps the focus where it was.
function render() {
  const focus = document.activeElement?.id;
  carRow();
  columnTable();
  runTable();
  const problems = find("#problems");
  problems.replaceChildren();
  for (const one of found.problems) make(problems, "li", {}, one);
  if (found.remarks.length) make(problems, "li", { class: "head" }, "Remarks. The keys named are those of campaign.toml, which is written with what stands above:");
  for (const one of found.remarks) make(problems, "li", { class: "soft" }, one);
  if (focus) document.getElementById(focus)?.focus();
}

function select(cell, id, label, options, chosen, act) {
  const box = make(cell, "select", { id, "aria-label": label });
  for (const [value, text] of options) make(box, "option", { value }, text).selected = value === chosen;
  box.addEventListener("change", () => correct(() => act(box.value)));
}

function carRow() {
  const row = find("#car-row"), names = [found.car, ...found.columns.map((one) => one.column)];
  row.replaceChildren();
  const label = make(row, "label", {}, "Motion of the car ");
  select(label, "car", "column of the car", names.map((one) => [one, one]), found.car, (value) => { stated.car = value; });
}

function head(table, names) {
  table.replaceChildren();
  const row = make(make(table, "thead"), "tr");
  for (const one of names) make(row, "th", {}, one);
  return make(table, "tbody");
}

function columnTable() {
  const body = head(find("#columns"), ["column", "taken for", "sensor", "unit", "sign", "zero", "how surely"]);
  found.columns.forEach((one, k) => {
    const row = make(body, "tr"), units = state.units[one.quantity] ?? [];
    const change = (values) => {
      const now = { quantity: one.quantity, unit: one.unit, sensor: one.sensor, sign: one.sign, reference: one.reference, ...values }, units = state.units[now.quantity] ?? [];
      if (!units.includes(now.unit)) now.unit = units[0] ?? "";
      if ("quantity" in values) now.reference = null; // the usual one of the new quantity
      if (now.quantity !== "lateral_displacement") now.sensor = null; else now.sensor ??= free(one);
      stated.columns[one.column] = now;
    };
    make(row, "td", {}, one.column);
    const quantities = [["", one.same_as ? `as ${one.same_as}` : LEFT_OUT], ...Object.keys(state.units).map((name) => [name, name.replaceAll("_", " ")])];
    select(make(row, "td"), `quantity-${k}`, `quantity of ${one.column}`, quantities, one.quantity ?? "", (value) => change({ quantity: value || null }));
    const sensor = make(row, "td"), unit = make(row, "td"), sign = make(row, "td"), zero = make(row, "td");
    if (one.quantity === "lateral_displacement") select(sensor, `sensor-${k}`, `sensor of ${one.column}`, found.sensors.map((name) => [name, name]), one.sensor, (value) => change({ sensor: value }));
    if (units.length) select(unit, `unit-${k}`, `unit of ${one.column}`, units.map((name) => [name, name]), one.unit, (value) => change({ unit: value }));
    if (one.quantity) select(sign, `sign-${k}`, `sign of ${one.column}`, [["1", "+"], ["-1", "−"]], `${one.sign}`, (value) => change({ sign: +value }));
    if (one.quantity) select(zero, `zero-${k}`, `zero of ${one.column}`, [["rest", "at rest"], ["absolute", "as recorded"]], one.reference, (value) => change({ reference: value }));
    make(row, "td", { class: "why" }, `${one.certainty}: ${one.why}`);
  });
}

// A sensor that no other column has.
function free(column) {
  const taken = found.columns.filter((one) => one !== column).map((one) => one.sensor);
  return found.sensors.find((name) => !taken.includes(name)) ?? found.sensors[0] ?? null;
}

function runTable() {
  const body = head(find("#runs"), ["file", "role", "mass of the sheave [kg]", "its inertia [kg m²]"]);
  found.runs.forEach(({ file, role }, k) => {
    const row = make(body, "tr");
    make(row, "td", {}, file);
    select(make(row, "td"), `role-${k}`, `role of ${file}`, [["fit", "fit"], ["validate", "validate"]], role, (value) => { stated.roles[file] = value; });
    for (const key of ["mass", "inertia"]) {
      const value = stated.changes[file]?.[`sheave.${key}`] ?? found.sheave?.[key] ?? "";
      const input = make(make(row, "td"), "input", { class: "number", id: `${key}-${k}`, "aria-label": `${key} of the sheave in ${file}`, inputmode: "decimal" });
      input.value = value === "" ? "" : `${+(+value).toPrecision(6)}`;
      input.addEventListener("change", () => correct(() => sheave(file, key, +input.value.replace(",", "."))));
    }
  });
}

// Mass and inertia of a run's sheave; of another mass the inertia is taken in proportion.
function sheave(file, key, value) {
  const base = found.sheave ?? {}, own = stated.changes[file] ?? { "sheave.mass": base.mass, "sheave.inertia": base.inertia };
  own[`sheave.${key}`] = value;
  if (key === "mass") own["sheave.inertia"] = +((base.inertia * value) / base.mass).toPrecision(6);
  stated.changes[file] = own;
}

find("#save").addEventListener("click", async () => {
  const from = location.hash;
  find("#save").disabled = true;
  const saved = await ask("POST", "/campaign", {});
  find("#save").disabled = saved !== null;
  if (saved !== null && location.hash === from) { tell(""); location.hash = "check"; } // whoever has gone to another step stays there
});
