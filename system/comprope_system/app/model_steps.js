// Steps after the data: reports, the running job, new models, and what can be taken away.
import { ask, duration, find, make, percent, showPage } from "./elements.js";

const SHORT = { check: "Check", compare: "Compare" };
const SETTLED = 400; // ms without a further movement until what a slider was moved to is simulated
const ticked = new Set(); // names of the models to be drawn together
let state = null, busy = null, chosen = null, touched = false, drawing = false;

export function showModels(now) {
  state = now;
  const results = Object.fromEntries(now.results.map((one) => [one.name, one])), running = now.job?.state === "running";
  for (const frame of document.querySelectorAll("iframe[data-report]")) {
    const name = frame.dataset.report, one = results[name];
    if (one) showPage(frame, `/report/${name}`, `${one.finished}`, name === "check" ? undefined : (inner) => follow(inner, name)); else { frame.hidden = true; delete frame.dataset.key; }
  }
  for (const button of document.querySelectorAll("[data-run]")) button.disabled = !now.exists || busy !== null;
  for (const button of document.querySelectorAll("[data-job]")) button.disabled = !now.exists || running;
  showJob(now);
  effects(results.diagnose);
  variants(now.results.filter((one) => one.model));
  takeAway(now);
}

for (const button of document.querySelectorAll("[data-run]")) {
  button.addEventListener("click", async () => {
    busy = button.dataset.run;
    button.disabled = true;
    button.textContent = "working …";
    await ask("POST", `/run/${busy}`, {});
    button.textContent = SHORT[busy];
    busy = null;
    button.disabled = false;
  });
}

for (const button of document.querySelectorAll("[data-job]")) button.addEventListener("click", () => start(button.dataset.job, { effect: find("#effect").value }));
const start = (name, given) => ask("POST", "/jobs", name === "add" ? { name, ...given } : { name });

// -- the running job -----------------------------------------------------------------------------------
function showJob({ job, interrupted }) {
  const box = find("#job"), shown = job && (job.state === "running" || job.state !== "done") ? job : null;
  box.hidden = !shown && !interrupted;
  box.replaceChildren();
  if (shown) runningJob(box, shown); else if (interrupted) offer(box, interrupted, `${title(interrupted)} was interrupted when the app was closed.`, "Resume");
}

const title = ({ name, arguments: given }) => ({ diagnose: "The diagnosis", add: `Adding ${given?.effect}`, improve: "Improving the model" })[name];

function offer(box, job, text, word) {
  make(box, "p", { class: "title" }, text);
  const row = make(box, "p");
  make(row, "button", { type: "button", class: "main" }, word).addEventListener("click", () => start(job.name, job.arguments));
  make(row, "button", { type: "button" }, "Dismiss").addEventListener("click", () => ask("DELETE", "/job"));
}

function runningJob(box, job) {
  if (job.state !== "running") { offer(box, job, `${title(job)}: ${job.state}. ${job.message}`, "Try again"); return; }
  make(box, "p", { class: "title", role: "status" }, `${title(job)}: ${job.stage}`);
  make(box, "progress", { max: job.total, value: job.done, "aria-label": "replays" });
  const left = job.seconds_left === null ? "" : `, about ${duration(job.seconds_left)} left`;
  make(box, "p", { class: "soft" }, `${job.done} of about ${job.total} replays, ${duration(job.seconds)}${left}`);
  make(make(box, "p"), "button", { type: "button", id: "cancel" }, "Cancel").addEventListener("click", () => ask("DELETE", "/job"));
  leaders(box, job.stages);
  const list = make(box, "ol", { "aria-label": "stages so far", tabindex: 0 });
  for (const one of job.stages) make(list, "li", {}, one.replaceAll("_", " "));
  list.scrollTop = list.scrollHeight;
}

// The effects that a diagnosis has fitted so far, the best first: of some it tells what they leave unexplained.
function leaders(box, stages) {
  const fits = stages.map((one) => one.match(/^(.+): fitted, reduced chi-square (.+)$/)).filter(Boolean);
  if (!fits.length) return;
  const best = [...new Map(fits.map(([, name, left]) => [name, +left]).sort((a, b) => b[1] - a[1]))].sort((a, b) => a[1] - b[1]);
  const body = table(box, ["effects fitted so far", "reduced chi-square (1: noise alone)"]);
  for (const [name, left] of best) row(body, [name.replaceAll("_", " "), `${left}`]);
}

function table(parent, names) {
  const found = make(parent, "table"), head = make(make(found, "thead"), "tr");
  for (const one of names) make(head, "th", {}, one);
  return make(found, "tbody");
}

function row(body, cells) {
  const line = make(body, "tr");
  for (const one of cells) make(line, "td", {}, one);
  return line;
}

// -- true replays of what a slider was moved to ---------------------------------------------------------
function follow(inner, source) {
  const told = find(`.replayed[data-source=${source}]`), preview = inner.compropePreviews?.get("preview");
  let latest = null, waiting = null, simulating = false;
  told.textContent = "";
  if (!preview) return;
  inner.document.documentElement.classList.add("in-app");
  if (source === "diagnose") fitFromHere(preview);
  const simulate = async () => {
    if (simulating) return; // one at a time; the latest values are next
    simulating = true;
    for (let mine = null; mine !== latest;) {
      mine = latest;
      told.textContent = "Simulating with the values of the sliders …";
      const found = await ask("POST", "/replay", { source, ...mine });
      if (mine === latest && found) preview.replayed(mine, found);
      told.textContent = found ? "The curves below are simulated with the values of the sliders." : "";
    }
    simulating = false;
  };
  inner.document.addEventListener("comprope:released", (event) => {
    latest = event.detail;
    clearTimeout(waiting);
    waiting = setTimeout(simulate, SETTLED);
  });
}

// A button beside the sliders: the fit begins at what they show.
function fitFromHere(preview) {
  const button = make(preview.figure.querySelector(".acts"), "button", { type: "button", class: "fit" }, "Fit from here");
  button.addEventListener("click", async () => {
    const { effect, at } = preview.setting();
    if (await start("add", { effect, values: at })) location.hash = "add";
  });
}

// -- new models -------------------------------------------------------------------------------------------
function effects(diagnosis) {
  const box = find("#effect"), facts = diagnosis?.facts, names = state.effects;
  if (box.dataset.names === names.join()) { if (!touched && facts?.verdict) box.value = best(facts); return; }
  box.dataset.names = names.join();
  box.replaceChildren();
  for (const one of names) make(box, "option", { value: one }, one.replaceAll("_", " "));
  box.addEventListener("change", () => { touched = true; });
  if (facts?.verdict) box.value = best(facts);
}

// The verdict as `comprope add` takes it: a fault of an instrument with its channel.
const best = ({ verdict, name }) => state.effects.find((one) => one === (name ?? verdict)) ?? state.effects.find((one) => one.startsWith(verdict)) ?? "";

function variants(models) {
  const table = find("#variants");
  table.replaceChildren();
  if (!models.length) { find("#variant").hidden = true; find("#together").hidden = true; return; }
  const row = make(make(table, "thead"), "tr");
  for (const one of ["", "model", "NRMSE, fit runs", "validation runs", "effect, with its 95 % interval", ""]) make(row, "th", {}, one);
  const body = make(table, "tbody");
  const { before, validate_before: held } = models[0].facts, given = make(body, "tr");
  for (const one of ["", "as given", percent(before), percent(held), "", ""]) make(given, "td", {}, one);
  for (const name of ticked) if (!models.some((one) => one.name === name)) ticked.delete(name);
  if (!state.results.some((one) => one.name === chosen && (one.model || one.name === "overlay"))) chosen = models[models.length - 1].name;
  for (const { name, facts } of models) {
    const line = make(body, "tr"), told = facts.effect ? name.replace("add ", "") : `improved: ${facts.effects.join(", ")}`;
    const tick = make(make(line, "td"), "input", { type: "checkbox", "aria-label": `draw ${name} together with others`, value: name });
    tick.checked = ticked.has(name);
    tick.addEventListener("change", () => { if (tick.checked) ticked.add(name); else ticked.delete(name); together(); });
    for (const one of [told.replaceAll("_", " "), percent(facts.after), percent(facts.validate_after)]) make(line, "td", {}, one);
    const values = make(line, "td", { class: "values" });
    for (const one of facts.values ?? []) make(values, "div", {}, one.replaceAll("_", " "));
    const cell = make(line, "td");
    make(cell, "button", { type: "button", "aria-pressed": name === chosen }, "show").addEventListener("click", () => { chosen = name; showModels(state); });
    make(cell, "button", { type: "button", "aria-label": `remove ${name}` }, "remove").addEventListener("click", () => ask("DELETE", `/results/${encodeURIComponent(name)}`));
  }
  together();
  const shown = state.results.find((one) => one.name === chosen);
  showPage(find("#variant"), `/report/${encodeURIComponent(chosen)}`, `${shown.name} ${shown.finished}`);
}

// Models drawn over one another, in the order in which they were ticked.
function together() {
  find("#together").hidden = state.results.filter((one) => one.model).length < 2;
  find("#overlay").disabled = drawing || ticked.size < 2;
}

find("#overlay").addEventListener("click", async () => {
  const button = find("#overlay"), text = button.textContent;
  drawing = true;
  button.disabled = true;
  button.textContent = "simulating …";
  const made = await ask("POST", "/overlay", { names: [...ticked] });
  drawing = false;
  button.textContent = text;
  if (made) { chosen = made.name; const now = await ask("GET", "/state"); if (now) showModels(now); }
  together();
});

function takeAway({ results, commands }) {
  const box = find("#takeaway");
  box.replaceChildren();
  if (!results.length) make(box, "p", {}, "Nothing yet.");
  for (const { name, headline, model, fmus } of results) {
    make(box, "h3", {}, `${name[0].toUpperCase()}${name.slice(1).replaceAll("_", " ")}`);
    make(box, "p", {}, headline);
    const row = make(box, "div", { class: "downloads" });
    const files = [...(model ? ["model.toml"] : []), "report.html", "output.json", ...fmus];
    for (const file of files) make(row, "a", { href: `/download/${encodeURIComponent(name)}/${file}`, download: "" }, file);
    if (model && !fmus.length) {
      const button = make(row, "button", { type: "button" }, "Build the FMUs"), native = make(row, "label", {}, ""), tick = make(native, "input", { type: "checkbox" });
      native.append(" also compiled, for hosts without Python");
      button.addEventListener("click", async () => { button.disabled = true; button.textContent = "building …"; if (!(await ask("POST", "/fmus", { name, native: tick.checked }))) { button.disabled = false; button.textContent = "Build the FMUs"; } });
    }
  }
  find("#commands").textContent = commands.join("\n") || "comprope --help";
}
