// palpate view: connects the live feed to picture, panels and controls.
// @ts-check
import {Connection} from "./connection.js";
import {Panels, SILENT_S} from "./panels.js";
import {Past} from "./past.js";
import {byId, html, number} from "./picture.js";
import {Plane} from "./plane.js";
import {download, fromHash, standalone, toHash} from "./saving.js";

/** @typedef {import("./types.js").Message} Message */
/** @typedef {import("./types.js").Picture} Picture */
/** @typedef {import("./types.js").Details} Details */
/** @typedef {import("./types.js").SampleStore} SampleStore */
/** @typedef {import("./types.js").Samples} Samples */
/** @typedef {import("./types.js").Overview} Overview */

const FOLLOW = "";
const LATENCIES_KEPT = 500;

/** @type {{picture: Picture|null, details: Details|null, store: SampleStore|null, overview: Overview|null,
 *   group: string}} */
const live = {picture: null, details: null, store: null, overview: null, group: ""};
let isPaused = false;
let isOpen = false;
let isScheduled = false;
let isHealthNew = true;
/** @type {Details|null|undefined} the details that the panels show */
let shownDetails = undefined;
let measuredVersion = -1;
/** Time from touch to pixel of the last answers; tests read it. [ms] @type {number[]} */
const latencies = [];
Object.assign(window, {palpateLatenciesMs: latencies});

const past = new Past((moment) => {
  showMoment(moment);
  writeLink();
});
const panels = new Panels();
const plane = new Plane(byId("plane"), writeLink);
const layers = /** @type {HTMLInputElement[]} */ ([...document.querySelectorAll("#layers input")]);

/** @param {Samples} samples */
function takeSamples(samples) {
  if (samples.anew || !live.store) {
    live.store = {group: samples.group, origin: samples.origin, received: 0, kept: 0, runs: []};
  }
  live.store.received = samples.received;
  live.store.kept = samples.kept;
  for (const news of samples.runs) {
    const run = live.store.runs[news.run] ??=
        {probe: news.probe, patch: news.patch, tipRadius: news.tipRadius, points: []};
    for (const value of news.points) run.points.push(value);
  }
}

/** @param {Message} message */
function take(message) {
  if (message.group !== live.group) {
    isHealthNew = true;
    live.group = message.group;
    live.picture = null;
    live.details = null;
    live.store = null;
  }
  if (message.samples) takeSamples(message.samples);
  if (message.picture) live.picture = message.picture;
  if (message.details) live.details = message.details;
  if (message.overview) {
    live.overview = message.overview;
    isHealthNew = true;
  }
  schedule();
}

function schedule() {
  if (isScheduled) return;
  isScheduled = true;
  requestAnimationFrame(() => {
    isScheduled = false;
    draw();
    connection.ready();
  });
}

function draw() {
  if (isHealthNew) showHealth();
  isHealthNew = false;
  if (isPaused) return past.moment ? showMoment(past.moment) : undefined;
  plane.show(live.picture, live.details, live.store);
  panels.showSampleCounts(live.store);
  measureLatency(live.picture);
  drawPanels(live.details);
}

/** @param {Details|null} details */
function drawPanels(details) {
  if (details === shownDetails) return;
  shownDetails = details;
  panels.show(details);
  // For tests: the object that words and numbers belong to.
  Object.assign(window, {palpateObject: details?.object, palpateOrigin: live.picture?.origin});
}

/** @param {Picture|null} picture */
function measureLatency(picture) {
  // The first answers after the page has loaded are old.
  if (!picture || picture.version === measuredVersion) return;
  measuredVersion = picture.version;
  if (!(picture.touchMs > 0) || Date.now() - picture.answerMs > 1000) return;
  const touchMs = picture.touchMs;
  // The next frame begins when this one has been passed to the screen.
  requestAnimationFrame(() => {
    latencies.push(Date.now() - touchMs);
    if (latencies.length > LATENCIES_KEPT) latencies.shift();
  });
}

function latencyText() {
  if (latencies.length === 0) return "";
  const sorted = [...latencies].sort((a, b) => a - b);
  const at = (/** @type {number} */ part) => sorted[Math.min(sorted.length - 1, Math.floor(part * sorted.length))];
  return `; touch to pixel ${number(at(0.5), 3)} ms (p99 ${number(at(0.99), 3)} ms)`;
}

function showHealth() {
  const overview = live.overview;
  if (overview) panels.showHealth(overview, latencyText());
  const nodes = overview?.nodes ?? [];
  const silence = Math.min(...nodes.map((node) => node.silentS));
  const [text, good] = !isOpen ? ["palpate view does not answer: trying again", false] :
      nodes.length === 0 ? ["no recognizer heard yet", false] :
      silence > SILENT_S ? [`recognizer silent for ${Math.round(silence)} s`, false] : ["live", true];
  byId("link-state").textContent = text;
  byId("link-state").className = good ? "good" : "bad";
  showGroups(overview);
}

/** @param {Overview|null} overview */
function showGroups(overview) {
  const select = /** @type {HTMLSelectElement} */ (byId("group"));
  const names = (overview?.groups ?? []).map((group) => group.name);
  const wanted = connection.wanted;
  if (wanted && !names.includes(wanted)) names.push(wanted);
  const follow = `touched last${live.group && !wanted ? `: ${live.group}` : ""}`;
  const texts = [follow, ...names];
  const values = [FOLLOW, ...names];
  if (select.options.length !== values.length || values.some((value, i) => select.options[i].value !== value)) {
    select.replaceChildren(...values.map((value) => {
      const option = /** @type {HTMLOptionElement} */ (html("option"));
      option.value = value;
      return option;
    }));
  }
  texts.forEach((text, i) => {
    if (select.options[i].textContent !== text) select.options[i].textContent = text;
  });
  if (select.value !== wanted) select.value = wanted;
  for (const [id, target] of [["save-csv", `samples/${live.group}.csv`], ["save-json", `answer/${live.group}.json`]]) {
    if (live.group) byId(id).setAttribute("href", target);
    else byId(id).removeAttribute("href");
  }
}

/** @param {import("./types.js").Moment} moment */
function showMoment(moment) {
  plane.show(moment.picture, moment.details, moment.store);
  panels.showSampleCounts(moment.store);
  drawPanels(moment.details);
}

/** @param {boolean} pause @param {string=} group @param {number|null=} atMs Unix time of a moment */
function setPaused(pause, group = live.group, atMs = null) {
  isPaused = pause;
  byId("past").hidden = !pause;
  byId("pause").textContent = pause ? "Live" : "Pause";
  byId("pause").setAttribute("aria-pressed", String(pause));
  if (pause) {
    past.open(group, atMs);
    byId("scrub").focus();
  } else {
    past.close();
    writeLink();
  }
  draw();
}

function settings() {
  const base = new Map(layers.map((box) => [box.name, box.defaultChecked]));
  return {
    // A moment belongs to one group, whichever group is followed.
    group: past.moment ? past.group : connection.wanted,
    at: past.moment ? past.moment.timeMs : null,
    view: plane.isFitted ? null : plane.view,
    hidden: layers.filter((box) => !box.checked && base.get(box.name)).map((box) => box.name),
    shown: layers.filter((box) => box.checked && !base.get(box.name)).map((box) => box.name),
  };
}

function writeLink() {
  window.history.replaceState(null, "", "#" + toHash(settings()));
}

function readLink() {
  const wanted = fromHash(location.hash);
  for (const box of layers) {
    box.checked = box.defaultChecked ? !wanted.hidden.includes(box.name) : wanted.shown.includes(box.name);
  }
  applyLayers();
  if (wanted.view) plane.setView(wanted.view);
  else plane.isFitted = true;
  connection.want(wanted.group);
  if (wanted.at !== null) setPaused(true, wanted.group, wanted.at);
  else if (isPaused) setPaused(false);
  isHealthNew = true;
  schedule();
}

function applyLayers() {
  for (const box of layers) byId("plane").classList.toggle(`hide-${box.name}`, !box.checked);
}

function wireControls() {
  byId("pause").onclick = () => setPaused(!isPaused);
  byId("resume").onclick = () => setPaused(false);
  byId("fit").onclick = () => plane.fitAlways();
  byId("zoom-in").onclick = () => plane.zoom(1.4);
  byId("zoom-out").onclick = () => plane.zoom(1 / 1.4);
  byId("group").onchange = () => {
    connection.want(byId("group").value);
    isHealthNew = true;
    schedule();
    plane.isFitted = true;
    // While paused, show the past of the group just chosen.
    if (isPaused && connection.wanted) past.open(connection.wanted, past.moment?.timeMs ?? null);
    writeLink();
  };
  for (const box of layers) {
    box.onchange = () => {
      applyLayers();
      writeLink();
    };
  }
  byId("save-svg").onclick = () =>
      download(standalone(byId("plane"), `palpate: ${live.group}`), "image/svg+xml", `${live.group || "view"}.svg`);
  byId("copy-link").onclick = async () => {
    writeLink();
    let said = "Copied";
    try {
      await navigator.clipboard.writeText(location.href);
    } catch {
      said = "In the address bar";  // no permission to write to the clipboard
    }
    byId("copy-link").textContent = said;
    setTimeout(() => byId("copy-link").textContent = "Link", 1500);
  };
  document.addEventListener("keydown", (event) => {
    const target = /** @type {HTMLElement} */ (event.target);
    if (event.ctrlKey || event.metaKey || event.altKey || target.tagName === "SELECT") return;
    const isControl = ["BUTTON", "INPUT", "A"].includes(target.tagName);
    const actions = {
      " ": isControl ? null : () => setPaused(!isPaused),
      "f": () => plane.fitAlways(),
      "+": () => plane.zoom(1.4),
      "=": () => plane.zoom(1.4),
      "-": () => plane.zoom(1 / 1.4),
      "g": () => byId("group").focus(),
    };
    const action = actions[/** @type {keyof typeof actions} */ (event.key)];
    if (!action) return;
    event.preventDefault();
    action();
  });
  new ResizeObserver(() => {
    plane.resize();
    schedule();
  }).observe(byId("plane"));
  window.addEventListener("hashchange", readLink);
}

const connection = new Connection(take, (open) => {
  isOpen = open;
  isHealthNew = true;
  if (!open && live.overview) {
    // After reconnecting, the server sends everything again.
    live.store = null;
  }
  schedule();
});
wireControls();
readLink();
