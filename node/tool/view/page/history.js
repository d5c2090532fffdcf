// The last minutes, to look back at. Bounded: the oldest moment goes.
// @ts-check
/** @typedef {import("./types.js").Moment} Moment */
/** @typedef {import("./types.js").Picture} Picture */
/** @typedef {import("./types.js").Details} Details */
/** @typedef {import("./types.js").SampleStore} SampleStore */

const LEAST_INTERVAL_MS = 200;
const MOST_MOMENTS = 900;  // three minutes
const MOST_RUNS_COUNTED = 500;

export class History {
  constructor() {
    /** @type {Moment[]} */
    this.moments = [];
  }

  /** @param {Picture|null} picture @param {Details|null} details @param {SampleStore|null} store */
  add(picture, details, store) {
    const last = this.moments[this.moments.length - 1];
    const now = Date.now();
    if (last && now - last.timeMs < LEAST_INTERVAL_MS) this.moments.pop();
    const timeMs = last && now - last.timeMs < LEAST_INTERVAL_MS ? last.timeMs : now;
    const counts = (store?.runs ?? []).slice(0, MOST_RUNS_COUNTED).map((run) => run.points.length / 2);
    this.moments.push({timeMs, picture, details, store, counts});
    if (this.moments.length > MOST_MOMENTS) this.moments.shift();
  }
}
