// Types of the messages that the server sends (node/tool/view/picture_json.cpp, details_json.cpp, overview_json.cpp).
// Lengths are in metres. Places are sent as whole steps; connection.js converts them to metres relative to `origin` on
// arrival. Numbers that are not finite are sent as null.

/** @typedef {{class: string, probability: number, closed: boolean, points: number[], left?: number[],
 *   right?: number[]}} Curve */

/** The picture, redrawn with every answer.
 * @typedef {{group: string, object: string, version: number, origin: number[], step: number, class: string,
 *   contacts: {at: number[], tangent: number}[], curve?: Curve, rivals: Curve[],
 *   pose?: {at: number[], theta: number, ellipse?: {long: number, short: number, angle: number}},
 *   sampleCount: number, touchMs: number, answerMs: number}} Picture */

/** @typedef {{arc: number[], kappa: (number|null)[], kappaS: (number|null)[], kappaSigma?: number[]}} CurveChart */

/** @typedef {{probe: string, arc: number, kappa: number, kappaSigma: number|null, kappaS: number,
 *   kappaSSigma: number|null}} ContactChart */

/** @typedef {{name: string, value: number, sigma: number|null, text: string}} Quantity */

/** Words, numbers and charts, sent a few times a second.
 * @typedef {{group: string, object: string, hasAnswer: boolean,
 *   status: string, statusText: string, advice: string, class: string, frame: string,
 *   quantities: Quantity[],
 *   hypotheses: {class: string, probability: number, chi2: number, dof: number, atLimit: boolean}[],
 *   decisions: {test: string, value: number|null, threshold: number|null, passed: boolean,
 *     pValue: number|null}[],
 *   invariants: {name: string, class: string, text: string}[],
 *   charts: {contacts: ContactChart[], rivals: CurveChart[], curve?: CurveChart}, bandWidth?: string,
 *   step?: number, residuals?: {gain: number, lines: number[]}, far?: number[], sampleCount: number,
 *   outlierCount: number, dwellingCount: number, noise: string, noiseCorrelationMm: number, computeMs: number,
 *   answersPerS: number, touchMs: number, answerMs: number}} Details */

/** @typedef {{group: string, object: string, generation: number, anew: boolean, received: number,
 *   kept: number, origin: number[], step: number,
 *   runs: {run: number, probe: string, patch: number, tipRadius: number, points: number[]}[]}} Samples */

/** @typedef {{name: string, group: string, alive: boolean, samplesPerS: number, batchesPerS: number,
 *   ageS: number, gaps: number, missing: number, restarts: number, rejected: number}} Probe */

/** @typedef {{name: string, version: string, silentS: number, uptimeS: number, received: number,
 *   accepted: number, gaps: number, missing: number, objectsSuperseded: number, computeP50Ms: number,
 *   computeP99Ms: number, probes: Probe[]}} Node */

/** @typedef {{groups: {name: string, object: string, status: string, class: string, probability: number,
 *   ageS: number}[], nodes: Node[]}} Overview */

/** @typedef {{group: string, picture?: Picture, details?: Details, samples?: Samples, overview?: Overview,
 *   timeMs?: number}} Message */

/** One unbroken touch. @typedef {{probe: string, patch: number, tipRadius: number, points: number[]}} Run */

/** The samples of one object received so far.
 * @typedef {{group: string, origin: number[], received: number, kept: number, runs: Run[]}} SampleStore */

/** A moment of the past, as shown again.
 * @typedef {{timeMs: number, picture: Picture|null, details: Details|null, store: SampleStore|null}} Moment */

export {};
