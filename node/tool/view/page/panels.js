// The words, tables and charts next to the picture.
// @ts-check
import {byId, data, html, number} from "./picture.js";
import {Chart} from "./chart.js";

/** @typedef {import("./types.js").Details} Details */
/** @typedef {import("./types.js").Overview} Overview */

/** @param {(string|HTMLElement)[]} cells @param {string=} className */
function row(cells, className = "") {
  const element = html("tr", "", className);
  for (const cell of cells) {
    const td = html("td");
    td.append(cell);
    element.append(td);
  }
  return element;
}

/** @param {string} id @param {HTMLElement[]} rows */
function fill(id, rows) {
  byId(id).querySelector("tbody").replaceChildren(...rows);
}

/** Text for people. @param {string} text */
function readable(text) {
  return text.replace("+-", "±").replace(/ um$/, " µm").replace(" deg", "°");
}

/** @param {number} probability */
function percentText(probability) {
  return probability > 0 && probability < 1e-5 ? "< 0.001 %" : `${number(100 * probability, 3)} %`;
}

/** @param {number} seconds */
function age(seconds) {
  return seconds < 9.95 ? `${seconds.toFixed(1)} s` : `${Math.round(seconds)} s`;
}

export class Panels {
  constructor() {
    this.curvature = new Chart(byId("curvature"), "arc length [mm]", "κ [1/m]");
    this.signature = new Chart(byId("signature"), "κ [1/m]", "dκ/ds [1/m²]");
  }

  /** @param {Details|null} details */
  show(details) {
    byId("class").textContent = details?.hasAnswer ? details.class : "nothing yet";
    byId("class").dataset.status = details?.status ?? "collecting";
    byId("status").textContent = details?.statusText ?? "";
    byId("advice").textContent = details?.advice ?? "Waiting for contacts.";
    byId("gain").textContent = details?.residuals ? `× ${number(details.residuals.gain)}` : "";
    byId("band-width").textContent = details?.bandWidth ? `± ${readable(details.bandWidth)}` : "";
    this.showQuantities(details);
    this.showHypotheses(details);
    this.showDecisions(details);
    this.showCharts(details);
  }

  /** @param {Details|null} details */
  showQuantities(details) {
    const rows = (details?.quantities ?? []).map((quantity) => {
      const value = data(quantity.value, readable(quantity.text));
      value.dataset.sigma = quantity.sigma === null ? "" : String(quantity.sigma);
      value.id = `quantity-${quantity.name}`;
      return row([quantity.name === "theta" ? "θ" : quantity.name, value]);
    });
    if (details?.hasAnswer) {
      const spikes = details.outlierCount > 0 ? `, of which ${details.outlierCount} set aside as spikes` : "";
      const dwelling = details.dwellingCount > 0 ? `, ${details.dwellingCount} while the probe stood still` : "";
      const samples = data(details.sampleCount, `${details.sampleCount}${spikes}${dwelling}`);
      samples.id = "sample-count";
      rows.push(row(["samples", samples]));
      const correlated = details.noiseCorrelationMm > 0 ?
          `, correlated over ${number(details.noiseCorrelationMm)} mm` : "";
      rows.push(row(["noise", readable(details.noise) + correlated]));
      rows.push(row(["frame", details.frame]));
      const latency = html("span", details.touchMs > 0 ?
          `${number(details.answerMs - details.touchMs, 3)} ms after the touch, ` : "");
      latency.id = "latency";
      latency.append(`${number(details.computeMs, 3)} ms computed, ${number(details.answersPerS, 3)} a second`);
      rows.push(row(["answer", latency]));
    }
    fill("quantities", rows);
  }

  /** @param {Details|null} details */
  showHypotheses(details) {
    const worth = (details?.hypotheses ?? []).filter((h, i) => i < 3 || h.probability >= 1e-3);
    fill("hypotheses", worth.map((hypothesis) => {
      const bar = /** @type {HTMLMeterElement} */ (html("meter"));
      bar.max = 1;
      bar.value = hypothesis.probability;
      const percent = data(hypothesis.probability, percentText(hypothesis.probability));
      const fit = hypothesis.atLimit ? "at its limit" :
          hypothesis.dof > 0 ? `χ² ${number(hypothesis.chi2, 4)} / ${hypothesis.dof}` : "";
      return row([hypothesis.class, bar, percent, html("small", fit)]);
    }));
  }

  /** @param {Details|null} details */
  showDecisions(details) {
    const decisions = details?.decisions ?? [];
    fill("decisions", decisions.map((decision) => row([
      decision.test, number(decision.value, 3), `against ${number(decision.threshold, 3)}`,
      html("span", decision.passed ? "passed" : "failed", decision.passed ? "good" : "bad"),
      decision.pValue === null ? "" : `p = ${number(decision.pValue, 2)}`,
    ])));
    fill("invariants", (details?.invariants ?? []).map((invariant) => row([
      html("i", invariant.name), `of ${invariant.class}`, readable(invariant.text),
    ])));
    byId("path").hidden = decisions.length === 0;
  }

  /** @param {Details|null} details */
  showCharts(details) {
    const {contacts, rivals, curve} = details?.charts ?? {contacts: [], rivals: [], curve: undefined};
    const probes = [...new Set(contacts.map((contact) => contact.probe))];
    const colour = (/** @type {string} */ probe) => probes.indexOf(probe) % 8;
    this.curvature.show(
        curve ? [{x: curve.arc.map((s) => 1e3 * s), y: curve.kappa, sigma: curve.kappaSigma, className: "curve"}] : [],
        contacts.map((c) => ({x: 1e3 * c.arc, y: c.kappa, dy: c.kappaSigma, colour: colour(c.probe)})));
    const lines = rivals.map((rival) => ({x: rival.kappa, y: rival.kappaS, className: "rival"}));
    if (curve) lines.push({x: curve.kappa, y: curve.kappaS, className: "curve"});
    this.signature.show(lines, contacts.map((c) => (
      {x: c.kappa, y: c.kappaS, dx: c.kappaSigma, dy: c.kappaSSigma, colour: colour(c.probe)})));
  }

  /** @param {{kept: number, received: number}|null} store */
  showSampleCounts(store) {
    const said = !store || store.kept === store.received ? "" :
        `${store.kept} of ${store.received} samples are drawn: of more than 20,000 every second one is left out.`;
    byId("shown").textContent = said;
    byId("shown").hidden = said === "";
  }

  /** @param {Overview} overview @param {string} drawn latency to the pixel, in words */
  showHealth(overview, drawn) {
    const probes = overview.nodes.flatMap((node) => node.probes);
    fill("probes", probes.map((probe) => {
      const state = html("span", probe.alive ? "alive" : `silent for ${age(probe.ageS)}`,
                         probe.alive ? "good" : "bad");
      const element = row([probe.name, probe.group, state, number(probe.samplesPerS, 3), String(probe.gaps),
                           String(probe.missing), String(probe.rejected)]);
      element.dataset.probe = probe.name;
      return element;
    }));
    fill("nodes", overview.nodes.map((node) => {
      const silent = node.silentS > SILENT_S;
      const unanswered = node.objectsSuperseded > 0 ? `, ${node.objectsSuperseded} objects without an answer` : "";
      return row([node.name, html("span", silent ? `silent for ${age(node.silentS)}` : "alive",
                                  silent ? "bad" : "good"),
                  `up ${age(node.uptimeS)}, computing ${number(node.computeP50Ms, 2)} ms (p99 ` +
                  `${number(node.computeP99Ms, 2)} ms), ${node.accepted} of ${node.received} messages taken` +
                  unanswered + drawn]);
    }));
  }
}

/** A recognizer publishes its status every second; after this time without it, it is shown as silent. [s] */
export const SILENT_S = 2.5;
