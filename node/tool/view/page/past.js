// Looking back at the last minutes. The server keeps them, so a page opened later, or a link, can show them too.
// @ts-check
import {decoded} from "./connection.js";
import {byId} from "./picture.js";

/** @typedef {import("./types.js").Moment} Moment */

export class Past {
  /** @param {(moment: Moment) => void} onMoment called with the moment to show */
  constructor(onMoment) {
    this.onMoment = onMoment;
    this.group = "";
    /** @type {number[]} */
    this.times = [];
    /** @type {Moment|null} the moment shown */
    this.moment = null;
    this.isLoading = false;
    this.scrub = /** @type {HTMLInputElement} */ (byId("scrub"));
    this.scrub.oninput = () => this.load();
  }

  /** @param {string} group @param {number|null} atMs Unix time; null = the last moment */
  async open(group, atMs) {
    this.group = group;
    this.times = [];
    this.moment = null;
    this.scrub.max = this.scrub.value = "0";
    try {
      this.times = (await this.fetched(`moments/${group}.json`)).times;
    } catch {
      this.times = [];
    }
    if (this.group !== group) return;
    if (this.times.length === 0) return this.say("nothing is kept of this group");
    const distances = this.times.map((time) => Math.abs(time - (atMs ?? Infinity)));
    const nearest = atMs === null ? this.times.length - 1 : distances.indexOf(Math.min(...distances));
    this.scrub.max = String(this.times.length - 1);
    this.scrub.value = String(nearest);
    await this.load();
  }

  close() {
    this.group = "";
    this.moment = null;
  }

  /** Shows the moment of the slider's position; the slider may move on while one is being loaded. */
  async load() {
    if (this.isLoading) return;
    this.isLoading = true;
    for (let shown = NaN; this.group !== "" && shown !== Number(this.scrub.value);) {
      shown = Number(this.scrub.value);
      await this.show(this.group, this.times[shown]);
    }
    this.isLoading = false;
  }

  /** @param {string} group @param {number|undefined} time */
  async show(group, time) {
    if (time === undefined) return;
    try {
      const message = decoded(await this.fetched(`moment/${time}/${group}.json`));
      if (this.group !== group) return;
      const {picture = null, details = null, samples} = message;
      this.moment = {timeMs: message.timeMs ?? time, picture, details, store: samples ?? null};
    } catch {
      return this.say("this moment is no longer kept");
    }
    const back = (this.moment.timeMs - this.times[this.times.length - 1]) / 1000;
    this.say(`${back.toFixed(1)} s, ${new Date(this.moment.timeMs).toLocaleTimeString()}`);
    this.onMoment(this.moment);
  }

  /** @param {string} text */
  say(text) {
    byId("scrub-time").textContent = text;
  }

  /** @param {string} path @returns {Promise<any>} */
  async fetched(path) {
    const reply = await fetch(path);
    if (!reply.ok) throw new Error(`${path}: ${reply.status}`);
    return reply.json();
  }
}
