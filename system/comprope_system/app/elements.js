// Elements, requests and frames, as all steps use them.
export const find = (selector) => document.querySelector(selector);

export function make(parent, name, attributes = {}, text = "") {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.textContent = text;
  return parent.appendChild(element);
}

export const percent = (share) => (share === null || share === undefined ? "–" : `${+(100 * share).toPrecision(3)} %`);

export function duration(seconds) {
  const whole = Math.round(seconds);
  return whole < 60 ? `${whole} s` : `${Math.floor(whole / 60)} min ${`${whole % 60}`.padStart(2, "0")} s`;
}

export function tell(problem) {
  find("#error").textContent = problem;
  find("#error").hidden = !problem;
}

// The answer of the server to a request; an error is told on the page and gives null.
export async function ask(method, path, content) {
  try {
    const file = content instanceof Blob;
    const response = await fetch(path, { method, body: content === undefined || file ? content : JSON.stringify(content) });
    const found = response.headers.get("content-type")?.startsWith("application/json") ? await response.json() : { error: await response.text() };
    tell(response.ok ? "" : found.error);
    return response.ok ? found : null;
  } catch {
    tell("The server does not answer. Is `comprope app` still running?");
    return null;
  }
}

// Shows a page in a frame as high as what it holds; `key` changes when it is to be loaded again.
export function showPage(frame, address, key, loaded = () => {}) {
  frame.hidden = false;
  if (frame.dataset.key === key) return;
  frame.dataset.key = key;
  frame.onload = () => {
    const inner = frame.contentDocument.documentElement;
    const fit = () => { frame.style.height = `${frame.contentDocument.body.scrollHeight + 4}px`; };
    new ResizeObserver(fit).observe(frame.contentDocument.body);
    inner.style.overflowY = "hidden";
    inner.classList.add("framed");
    fit();
    loaded(frame.contentWindow);
  };
  frame.src = address;
}
