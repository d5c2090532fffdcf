// Helpers to build SVG and HTML. Text is always set as text, never as markup.
// @ts-check

const SVG = "http://www.w3.org/2000/svg";

/**
 * @param {string} name
 * @param {Record<string, string|number>} attributes
 * @param {Element=} parent
 * @returns {SVGElement}
 */
export function svg(name, attributes = {}, parent = undefined) {
  const element = /** @type {SVGElement} */ (document.createElementNS(SVG, name));
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, String(value));
  if (parent) parent.append(element);
  return element;
}

/**
 * @param {string} name
 * @param {string} text
 * @param {string=} className
 * @returns {HTMLElement}
 */
export function html(name, text = "", className = "") {
  const element = document.createElement(name);
  element.textContent = text;
  if (className) element.className = className;
  return element;
}

/** @param {string} id @returns {any} */
export function byId(id) {
  return document.getElementById(id);
}

/** An element that shows `text` and keeps the exact value for programs.
 * @param {number|null} value
 * @param {string} text
 */
export function data(value, text) {
  const element = /** @type {HTMLDataElement} */ (html("data", text));
  element.value = value === null ? "" : String(value);
  return element;
}

/** The number to `digits` significant digits, without exponent where possible.
 * @param {number|null} value
 * @param {number} digits
 */
export function number(value, digits = 4) {
  if (value === null) return "∞";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e-3 && size < 1e6) return String(Number(value.toPrecision(digits)));
  return value.toExponential(digits - 1);
}

/** Step of an axis: 1, 2 or 5 times a power of ten, with at most `count` steps over `length`.
 * @param {number} length
 * @param {number} count
 */
export function tickStep(length, count) {
  const rough = length / count;
  const power = 10 ** Math.floor(Math.log10(rough));
  for (const factor of [1, 2, 5]) if (factor * power >= rough) return factor * power;
  return 10 * power;
}

/** Multiples of step in [low, high], at most 100.
 * @param {number} low
 * @param {number} high
 * @param {number} step
 */
export function ticks(low, high, step) {
  const result = [];
  for (let k = Math.ceil(low / step); k * step <= high && result.length < 100; ++k) result.push(k * step);
  return result;
}

/** Decimals that tell multiples of a step apart. @param {number} step */
function decimalsOf(step) {
  return Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
}

const LONGEST = 8;  // characters, for which a chart's axis has room

/** The number with as many digits as the step asks for, with an exponent where it would be too long.
 * @param {number} value
 * @param {number} step
 */
export function tickText(value, step) {
  const decimals = decimalsOf(step);
  if (decimals <= LONGEST) {
    const plain = value.toFixed(decimals);
    if (plain.length <= LONGEST) return plain;
  }
  if (Math.abs(value) < 1e-6 * step) return "0";
  const digits = Math.floor(Math.log10(Math.abs(value)) + 1e-9) - Math.floor(Math.log10(step) + 1e-9);
  return value.toExponential(Math.min(Math.max(digits, 0), 15));
}

/** The unit of length in which a step has few digits. @param {number} stepMm */
export function unitOf(stepMm) {
  const units = [{name: "nm", mm: 1e-6}, {name: "µm", mm: 1e-3}, {name: "mm", mm: 1}, {name: "m", mm: 1e3}];
  return units.find((unit) => stepMm < 999 * unit.mm) ?? {name: "km", mm: 1e6};
}

/** What the labels of an axis are less, so that each has six characters at most: 0, or a round number near by.
 * @param {number} low
 * @param {number} high
 * @param {number} step
 */
export function tickOffset(low, high, step) {
  const room = [1e5, 1e3, 1e2][Math.min(decimalsOf(step), 2)];
  if (Math.max(Math.abs(low), Math.abs(high)) < room) return 0;
  const grid = 10 ** Math.ceil(Math.log10(high - low));
  return Math.round((low + high) / 2 / grid) * grid;
}

/** "mm", or "x − 100000 mm" where the labels are less an offset.
 * @param {string} name
 * @param {number} offset
 * @param {string} unit
 */
export function axisText(name, offset, unit) {
  // Fifteen digits, without the noise of the last bits.
  const less = String(Number(Math.abs(offset).toPrecision(15)));
  return offset === 0 ? unit : `${name} ${offset > 0 ? "−" : "+"} ${less} ${unit}`;
}
