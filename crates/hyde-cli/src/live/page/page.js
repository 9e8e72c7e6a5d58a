"use strict";
// Sliders of parameters beside the result of a run. One request is under way at a time, the newest values follow it.

// So many sliders are seen at once.
const FEW = 10;
const at = (id) => document.getElementById(id);
let sliders = [];
let wanted = false;
let running = false;
let begins = false;

// The values that differ from those of the file, by name.
function moved() {
  const values = {};
  for (const own of sliders) {
    if (own.now !== own.value) values[own.name] = own.now;
  }
  return values;
}

async function post(what, values) {
  const answer = await fetch(what, {
    method: "POST",
    headers: { "Content-Type": "application/json" },
    body: JSON.stringify(values),
  });
  return answer.json();
}

function show(id, text) {
  at(id).textContent = text || "";
  at(id).hidden = !text;
}

// Shows an answer; whether more of it is to come.
function shown(found, start) {
  if (found.ok) {
    at("result").innerHTML = found.body;
    at("rest").innerHTML = found.rest;
    at("result").classList.remove("old");
    show("error", "");
    const all = Math.round(performance.now() - start);
    at("status").textContent = found.partial
      ? "the beginning of the run, the rest follows"
      : `run ${Math.round(found.took_ms)} ms, shown after ${all} ms`;
  } else if (!found.superseded) {
    show("error", found.error);
    at("status").textContent = "";
  }
  return found.partial;
}

async function run() {
  wanted = true;
  if (running) return;
  running = true;
  while (wanted) {
    wanted = false;
    const start = performance.now();
    at("status").textContent = "running";
    try {
      const more = begins ? shown(await post("begin", moved()), start) : true;
      if (more && !wanted) {
        if (!begins) at("result").classList.add("old");
        shown(await post("run", moved()), start);
      }
    } catch (reason) {
      show("error", "hyde live has ended, or cannot be reached");
    }
  }
  // What takes longer follows the curves, unless something newer is wanted.
  at("frequencies").classList.add("old");
  const found = await post("frequencies", moved()).catch(() => ({}));
  if (found.ok) at("frequencies").innerHTML = found.body;
  else at("frequencies").replaceChildren(...(found.error ? [element("pre", {}, found.error)] : []));
  at("frequencies").classList.remove("old");
  running = false;
  if (wanted) return run();
  document.body.dataset.runs = String(Number(document.body.dataset.runs || 0) + 1);
}

function set(own, value, from) {
  if (!Number.isFinite(value)) return;
  own.now = value;
  if (from !== own.range) own.range.value = String(value);
  if (from !== own.number) own.number.value = String(Number(value.toPrecision(6)));
  own.box.classList.toggle("moved", own.now !== own.value);
  const any = Object.keys(moved()).length > 0;
  at("reset").disabled = !any;
  at("write").disabled = !any;
}

function element(name, attributes, ...inside) {
  const own = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) own.setAttribute(key, value);
  own.append(...inside);
  return own;
}

function slider(facts, kept) {
  const own = { ...facts, now: facts.value };
  const scale = { min: facts.min, max: facts.max, step: "any" };
  own.range = element("input", { type: "range", id: `p-${facts.name}`, ...scale });
  own.number = element("input", { type: "number", step: facts.step, "aria-label": `${facts.name} as a number` });
  const spread = facts.spread
    ? [element("small", {}, `${Number(facts.spread[0].toPrecision(4))} … ${Number(facts.spread[1].toPrecision(4))}`)]
    : [];
  own.box = element("div", { class: "slider", title: facts.source || "" },
    element("label", { for: `p-${facts.name}` }, facts.name, ...spread),
    element("div", { class: "row" }, own.range, own.number, element("span", { class: "unit" }, facts.unit)));
  // Arrow keys go by one step, with Shift by ten.
  own.range.addEventListener("keydown", (event) => {
    const way = { ArrowRight: 1, ArrowUp: 1, ArrowLeft: -1, ArrowDown: -1 }[event.key];
    if (!way) return;
    event.preventDefault();
    const next = own.now + way * facts.step * (event.shiftKey ? 10 : 1);
    set(own, Math.min(facts.max, Math.max(facts.min, next)), null);
    run();
  });
  own.range.addEventListener("input", () => {
    set(own, Number(Number(own.range.value).toPrecision(4)), own.range);
    run();
  });
  own.number.addEventListener("input", () => {
    set(own, own.number.valueAsNumber, own.number);
    run();
  });
  set(own, kept ?? facts.value, null);
  return own;
}

// Shows the sliders whose names have the text that is looked for.
function filter() {
  const text = at("wanted").value.trim().toLowerCase();
  for (const own of sliders) own.box.hidden = !own.name.toLowerCase().includes(text);
}

async function load() {
  const kept = moved();
  const state = await (await fetch("state")).json();
  at("title").textContent = state.experiment ? `${state.experiment} of ${state.model}` : "hyde live";
  document.title = at("title").textContent;
  at("file").textContent = state.file;
  show("warnings", state.warnings);
  if (state.error) {
    show("error", state.error);
    at("result").classList.add("old");
    return;
  }
  begins = state.begins;
  sliders = [];
  for (const facts of state.sliders) {
    // A value that stands in the file now is no longer moved.
    const same = Math.abs(kept[facts.name] - facts.value) <= 1e-6 * Math.abs(facts.value);
    sliders.push(slider(facts, same ? undefined : kept[facts.name]));
  }
  at("sliders").replaceChildren(...sliders.map((own) => own.box));
  for (const own of sliders) set(own, own.now, null);
  at("filter").hidden = sliders.length <= FEW;
  filter();
  await run();
}

at("wanted").addEventListener("input", filter);
at("sliders").addEventListener("submit", (event) => event.preventDefault());
at("reset").addEventListener("click", () => {
  for (const own of sliders) set(own, own.value, null);
  run();
});
at("write").addEventListener("click", async () => {
  const found = await post("write", moved());
  const notes = (found.notes || []).map((note) => `; ${note}`).join("");
  show("told", found.ok ? `written to the file${notes}` : found.error);
});
new EventSource("events").addEventListener("message", load);
load();
