// A small chart: a line with its band, points with their bars.
// @ts-check
import {svg, tickStep, ticks, tickText} from "./picture.js";

/** @typedef {{x: number, y: number, dx?: number|null, dy?: number|null, colour: number}} Dot */
/** @typedef {{x: (number|null)[], y: (number|null)[], sigma?: number[], className: string}} Line */

const LEFT = 70, BOTTOM = 34, TOP = 8, RIGHT = 10;
const HALF_DIGIT = 3.6;  // [px]
const BAND_SIGMAS = 1.959963984540054;

/** @param {(number|null|undefined)[]} values */
function finite(values) {
  return /** @type {number[]} */ (values.filter((v) => typeof v === "number"));
}

/** Limits of an axis that contain the dots and the line near them. Bars, and a line that runs off (a cusp), are clipped.
 * @param {number[]} dots @param {number[]} line */
function limits(dots, line) {
  if (dots.length === 0 && line.length === 0) return null;
  let low = Math.min(...(dots.length ? dots : line)), high = Math.max(...(dots.length ? dots : line));
  const room = dots.length ? 2.0 * Math.max(high - low, 0.2 * Math.abs(high), 1e-12) : 0;
  const [least, most] = [low - room, high + room];
  for (const value of line) {
    if (value >= least && value <= most) {
      low = Math.min(low, value);
      high = Math.max(high, value);
    }
  }
  const pad = 0.08 * Math.max(high - low, 0.02 * Math.abs(high), 1e-12);
  return [low - pad, high + pad];
}

export class Chart {
  /** @param {SVGSVGElement} root @param {string} xName @param {string} yName */
  constructor(root, xName, yName) {
    this.root = root;
    this.names = [xName, yName];
    const clip = svg("clipPath", {id: `${root.id}-clip`}, svg("defs", {}, root));
    this.clipRect = svg("rect", {}, clip);
    this.body = svg("g", {}, root);
    this.size = {width: 300, height: 140};
    /** @type {{lines: Line[], dots: Dot[]}} */
    this.shown = {lines: [], dots: []};
    // Reading the size while drawing would force a layout of the whole page each time.
    new ResizeObserver((entries) => {
      const box = entries[0].contentRect;
      this.size = {width: Math.max(box.width, 120), height: Math.max(box.height, 90)};
      this.show(this.shown.lines, this.shown.dots);
    }).observe(root);
  }

  /** @param {Line[]} lines @param {Dot[]} dots */
  show(lines, dots) {
    this.shown = {lines, dots};
    const {width, height} = this.size;
    this.root.setAttribute("viewBox", `0 0 ${width} ${height}`);
    this.body.replaceChildren();
    const usable = dots.filter((dot) => dot.dy === undefined || dot.dy !== null);
    const xs = limits(usable.map((dot) => dot.x), finite(lines.flatMap((line) => line.x)));
    const ys = limits(usable.map((dot) => dot.y), finite(lines.flatMap((line) => line.y)));
    if (!xs || !ys) {
      svg("text", {x: width / 2, y: height / 2, "text-anchor": "middle", class: "empty"}, this.body)
          .textContent = "nothing to show yet";
      return;
    }
    const px = (/** @type {number} */ x) => LEFT + (x - xs[0]) / (xs[1] - xs[0]) * (width - LEFT - RIGHT);
    const py = (/** @type {number} */ y) =>
        height - BOTTOM - (y - ys[0]) / (ys[1] - ys[0]) * (height - TOP - BOTTOM);
    this.drawAxes(width, height, xs, ys, px, py);
    const inner = {x: LEFT, y: TOP, width: width - LEFT - RIGHT, height: height - TOP - BOTTOM};
    for (const [key, value] of Object.entries(inner)) this.clipRect.setAttribute(key, String(value));
    const plot = svg("g", {"clip-path": `url(#${this.root.id}-clip)`}, this.body);
    for (const line of lines) this.drawLine(plot, line, px, py);
    for (const dot of usable) this.drawDot(plot, dot, px, py);
  }

  /** @param {number} width @param {number} height @param {number[]} xs @param {number[]} ys
   * @param {(x: number) => number} px @param {(y: number) => number} py */
  drawAxes(width, height, xs, ys, px, py) {
    const grid = svg("g", {class: "grid"}, this.body);
    const xStep = tickStep(xs[1] - xs[0], width / 80), yStep = tickStep(ys[1] - ys[0], height / 36);
    for (const x of ticks(xs[0], xs[1], xStep)) {
      svg("line", {x1: px(x), x2: px(x), y1: TOP, y2: height - BOTTOM}, grid);
      const text = tickText(x, xStep);
      if (px(x) + HALF_DIGIT * text.length > width) continue;
      svg("text", {x: px(x), y: height - BOTTOM + 15, "text-anchor": "middle"}, grid).textContent = text;
    }
    for (const y of ticks(ys[0], ys[1], yStep)) {
      svg("line", {x1: LEFT, x2: width - RIGHT, y1: py(y), y2: py(y)}, grid);
      svg("text", {x: LEFT - 5, y: py(y) + 4, "text-anchor": "end"}, grid).textContent = tickText(y, yStep);
    }
    svg("text", {x: (LEFT + width - RIGHT) / 2, y: height - 4, "text-anchor": "middle"}, grid).textContent =
        this.names[0];
    const y = (TOP + height - BOTTOM) / 2;
    svg("text", {x: 12, y, "text-anchor": "middle", transform: `rotate(-90 12 ${y})`}, grid).textContent =
        this.names[1];
  }

  /** @param {Element} plot @param {Line} line @param {(x: number) => number} px
   * @param {(y: number) => number} py */
  drawLine(plot, line, px, py) {
    let d = "", up = "", down = "", pen = "M";
    // Clamp what lies far outside: browsers cannot draw coordinates of any size.
    const cut = (/** @type {number} */ v) => Math.min(Math.max(v, -1e5), 1e5);
    line.x.forEach((x, i) => {
      const y = line.y[i];
      if (x === null || y === null) {
        pen = "M";
        return;
      }
      d += `${pen}${cut(px(x))} ${cut(py(y))}`;
      pen = "L";
      if (!line.sigma) return;
      const wide = BAND_SIGMAS * line.sigma[i];
      up += `${up === "" ? "M" : "L"}${cut(px(x))} ${cut(py(y + wide))}`;
      down = `L${cut(px(x))} ${cut(py(y - wide))}` + down;
    });
    if (up) svg("path", {class: "band", d: up + down + "Z"}, plot);
    svg("path", {class: line.className, d}, plot);
  }

  /** @param {Element} plot @param {Dot} dot @param {(x: number) => number} px
   * @param {(y: number) => number} py */
  drawDot(plot, dot, px, py) {
    const group = svg("g", {class: `dot run${dot.colour}`}, plot);
    if (dot.dy) {
      svg("line", {x1: px(dot.x), x2: px(dot.x), y1: py(dot.y - 2 * dot.dy), y2: py(dot.y + 2 * dot.dy)}, group);
    }
    if (dot.dx) {
      svg("line", {y1: py(dot.y), y2: py(dot.y), x1: px(dot.x - 2 * dot.dx), x2: px(dot.x + 2 * dot.dx)}, group);
    }
    svg("circle", {cx: px(dot.x), cy: py(dot.y), r: 3.5}, group);
  }
}
