// The app: steps, and the state of the server that all of them show.
import { showData } from "./data_step.js";
import { find, tell } from "./elements.js";
import { showModels } from "./model_steps.js";

const STEPS = ["data", "check", "compare", "diagnose", "add", "take"];
const tabs = [...document.querySelectorAll("[data-step]")];
let first = true;

history.replaceState(null, "", `${location.pathname}${location.hash}`); // the token stays in a cookie, not in the address

function go(step) {
  const shown = STEPS.includes(step) ? step : "data";
  for (const one of STEPS) find(`#step-${one}`).hidden = one !== shown;
  for (const tab of tabs) {
    tab.setAttribute("aria-selected", tab.dataset.step === shown);
    tab.tabIndex = tab.dataset.step === shown ? 0 : -1;
  }
}

tabs.forEach((tab, k) => {
  tab.addEventListener("click", () => { location.hash = tab.dataset.step; });
  tab.addEventListener("keydown", (event) => {
    const turn = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!turn) return;
    const next = tabs[(k + turn + tabs.length) % tabs.length];
    next.focus();
    next.click();
  });
});
addEventListener("hashchange", () => { tell(""); go(location.hash.slice(1)); });

function show(state) {
  find("#folder").textContent = state.folder;
  find("#stage").textContent = state.exists ? "" : ": a new one, nothing is saved yet";
  find("#welcome").hidden = state.exists;
  const names = new Set(state.results.map((one) => one.name)), done = { data: state.exists, check: names.has("check"), compare: names.has("compare"), diagnose: names.has("diagnose"), add: state.results.some((one) => one.model) };
  for (const tab of tabs) tab.classList.toggle("done", Boolean(done[tab.dataset.step]));
  if (first) go(location.hash.slice(1) || (state.exists ? "compare" : "data"));
  first = false;
  showData(state);
  showModels(state);
}

const news = new EventSource("/events");
news.onmessage = (event) => { show(JSON.parse(event.data)); };
