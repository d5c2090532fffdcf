// The picture of the touched plane: samples, the curve and its uncertainty. Drawn in millimetres from the object's
// origin, y upwards. The view is one transform, so that zooming and panning redraw nothing.
// @ts-check
import {MM, bandPath, pathOf} from "./outline.js";
import {axisText, svg, tickOffset, tickStep, ticks, tickText, unitOf} from "./picture.js";

/** @typedef {import("./types.js").Picture} Picture */
/** @typedef {import("./types.js").Details} Details */
/** @typedef {import("./types.js").SampleStore} SampleStore */
/** @typedef {{x: number, y: number, scale: number}} View centre [mm] and pixels per mm */

// Samples per path. When samples are appended, the browser redraws one path only.
const CHUNK = 500;
const COLOURS = 8;
const AXIS_PIXELS = 46;
const TANGENT_PIXELS = 20;
const WHOLE = 3;  // in sizes of what was touched
const NEAR = 1;
const MARGIN = 46;  // room for the numbers at the ticks [px]
const ALONE = 20;  // width shown of a place that is the only one: it has no size itself [mm]

export class Plane {
  /** @param {SVGSVGElement} root @param {() => void} onViewChange called when the user has moved the view */
  constructor(root, onViewChange) {
    this.root = root;
    this.onViewChange = onViewChange;
    this.size = {width: 600, height: 400};
    /** @type {View} */
    this.view = {x: 0, y: 0, scale: 10};
    this.isFitted = true;
    /** @type {Picture|null} */
    this.picture = null;
    /** @type {Details|null} */
    this.details = null;
    /** @type {SampleStore|null} */
    this.store = null;

    this.grid = svg("g", {class: "grid"}, root);
    const clip = svg("clipPath", {id: "plane-clip"}, svg("defs", {}, root));
    this.clipRect = svg("rect", {}, clip);
    const clipped = svg("g", {"clip-path": "url(#plane-clip)"}, root);
    this.world = svg("g", {class: "world"}, clipped);
    this.sweeps = svg("g", {class: "layer-tips sweeps"}, this.world);
    this.band = svg("path", {class: "layer-band band", "fill-rule": "evenodd"}, this.world);
    this.rivals = svg("g", {class: "layer-rivals"}, this.world);
    this.residuals = svg("path", {class: "layer-residuals residuals"}, this.world);
    this.points = svg("g", {class: "layer-samples"}, this.world);
    this.curve = svg("path", {class: "layer-curve curve", id: "curve-path"}, this.world);
    this.tips = svg("g", {class: "layer-tips"}, this.world);
    this.origin = svg("ellipse", {class: "layer-frame origin"}, this.world);
    // In pixels: constant size at any zoom.
    this.far = svg("path", {class: "layer-samples far"}, clipped);
    this.tangents = svg("path", {class: "layer-samples tangents"}, clipped);
    this.marks = svg("g", {class: "layer-frame frame"}, clipped);
    this.labels = svg("g", {class: "labels"}, clipped);
    this.gridKey = "";
    /** @type {{path: SVGElement, d: string, count: number}[][]} */
    this.chunks = [];
    /** @type {{path: SVGElement, d: string}[]} */
    this.sweepPaths = [];
    this.wireInput();
  }

  resize() {
    const box = this.root.getBoundingClientRect();
    this.size = {width: Math.max(box.width, 50), height: Math.max(box.height, 50)};
    this.root.setAttribute("viewBox", `0 0 ${this.size.width} ${this.size.height}`);
    const inner = {x: MARGIN, y: 0, width: this.size.width - MARGIN, height: this.size.height - 24};
    for (const [key, value] of Object.entries(inner)) this.clipRect.setAttribute(key, String(value));
    this.place();
  }

  /** @param {Picture|null} picture @param {Details|null} details @param {SampleStore|null} store */
  show(picture, details, store) {
    if (picture !== this.picture) {
      this.picture = picture;
      this.drawCurve();
    }
    if (details !== this.details) {
      this.details = details;
      this.drawResiduals();
    }
    this.drawSamples(store);
    if (this.isFitted) this.fit();
    this.place();
  }

  drawCurve() {
    const picture = this.picture;
    const curve = picture?.curve;
    this.curve.setAttribute("d", curve ? pathOf(curve.points, curve.closed) : "");
    const band = curve?.left && curve.right ? bandPath(curve.points, curve.left, curve.right, curve.closed) : null;
    this.band.setAttribute("d", band?.d ?? "");
    this.band.setAttribute("fill-rule", band?.isWide ? "nonzero" : "evenodd");
    this.band.classList.toggle("wide", band?.isWide ?? false);
    this.rivals.replaceChildren();
    for (const rival of picture?.rivals ?? []) {
      const path = svg("path", {class: "rival", d: pathOf(rival.points, rival.closed)}, this.rivals);
      path.style.opacity = String(0.25 + 0.65 * rival.probability);
      svg("title", {}, path).textContent = `${rival.class} ${(100 * rival.probability).toPrecision(3)} %`;
    }
    this.drawOrigin();
  }

  drawResiduals() {
    let d = "";
    const lines = this.details?.residuals?.lines ?? [];
    for (let i = 0; i + 3 < lines.length; i += 4) {
      d += `M${lines[i] * MM} ${-lines[i + 1] * MM}L${lines[i + 2] * MM} ${-lines[i + 3] * MM}`;
    }
    this.residuals.setAttribute("d", d);
  }

  /** Draws the ellipse that contains the frame's origin with 95 % probability. */
  drawOrigin() {
    const pose = this.picture?.pose;
    const ellipse = pose?.ellipse;
    if (!pose || !ellipse) return this.origin.setAttribute("display", "none");
    const [x, y] = [pose.at[0] * MM, -pose.at[1] * MM];
    const shape = {cx: x, cy: y, rx: ellipse.long * MM, ry: ellipse.short * MM,
                   transform: `rotate(${-ellipse.angle * 180 / Math.PI} ${x} ${y})`};
    for (const [key, value] of Object.entries(shape)) this.origin.setAttribute(key, String(value));
    this.origin.removeAttribute("display");
  }

  /** @param {SampleStore|null} store */
  drawSamples(store) {
    if (store !== this.store) {
      this.points.replaceChildren();
      this.sweeps.replaceChildren();
      this.chunks = [];
      this.sweepPaths = [];
    }
    this.store = store;
    this.tips.replaceChildren();
    const colours = this.coloursOfProbes();
    const newest = new Map();
    (store?.runs ?? []).forEach((run, number) => {
      const total = run.points.length / 2;
      if (total === 0) return;
      const colour = colours.get(run.probe);
      this.appendSamples(number, run, total, colour);
      newest.set(run.probe, {run, total, colour});
    });
    for (const {run, total, colour} of newest.values()) {
      const x = run.points[2 * total - 2] * MM, y = -run.points[2 * total - 1] * MM;
      svg("circle", {class: `tip run${colour}`, cx: x, cy: y, r: run.tipRadius * MM}, this.tips);
    }
    this.newest = newest;
  }

  coloursOfProbes() {
    const colours = new Map();
    for (const run of this.store?.runs ?? []) {
      if (!colours.has(run.probe)) colours.set(run.probe, colours.size % COLOURS);
    }
    return colours;
  }

  /** @param {number} number @param {import("./types.js").Run} run @param {number} total @param {number} colour */
  appendSamples(number, run, total, colour) {
    const chunks = this.chunks[number] ??= [];
    let drawn = chunks.reduce((sum, chunk) => sum + chunk.count, 0);
    if (run.tipRadius > 0 && drawn < total) {
      const sweep = this.sweepPaths[number] ??=
          {path: svg("path", {class: `sweep run${colour}`, "stroke-width": 2 * run.tipRadius * MM},
                     this.sweeps), d: ""};
      for (let i = drawn; i < total; ++i) {
        sweep.d += `${i === 0 ? "M" : "L"}${run.points[2 * i] * MM} ${-run.points[2 * i + 1] * MM}`;
      }
      sweep.path.setAttribute("d", sweep.d);
    }
    while (drawn < total) {
      if (chunks.length === 0 || chunks[chunks.length - 1].count >= CHUNK) {
        chunks.push({path: svg("path", {class: `samples run${colour}`}, this.points), d: "", count: 0});
      }
      const chunk = chunks[chunks.length - 1];
      for (; drawn < total && chunk.count < CHUNK; ++drawn, ++chunk.count) {
        chunk.d += `M${run.points[2 * drawn] * MM} ${-run.points[2 * drawn + 1] * MM}h0`;
      }
      chunk.path.setAttribute("d", chunk.d);
    }
  }

  /** The box that contains everything to show. [mm] */
  bounds() {
    let low = [Infinity, Infinity], high = [-Infinity, -Infinity];
    const include = (/** @type {number} */ x, /** @type {number} */ y, pad = 0) => {
      low = [Math.min(low[0], x - pad), Math.min(low[1], y - pad)];
      high = [Math.max(high[0], x + pad), Math.max(high[1], y + pad)];
    };
    for (const run of this.store?.runs ?? []) {
      for (let i = 0; i + 1 < run.points.length; i += 2) {
        include(run.points[i] * MM, -run.points[i + 1] * MM, run.tipRadius * MM);
      }
    }
    for (const contact of this.picture?.contacts ?? []) include(contact.at[0] * MM, -contact.at[1] * MM);
    const touched = Math.max(high[0] - low[0], high[1] - low[1]);
    const centre = [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2];
    // Show all of a curve that is not much larger than what was touched. Of a larger one (such as an arc that is not
    // determined yet), show only the part nearby.
    const points = this.picture?.curve?.points ?? [];
    const distance = (/** @type {number[]} */ at, /** @type {number} */ i) => touched > 0 ?
        Math.max(Math.abs(at[i] * MM - centre[0]), Math.abs(at[i + 1] * MM + centre[1])) / touched : 0;
    let furthest = 0;
    for (let i = 0; i < points.length; i += 2) furthest = Math.max(furthest, distance(points, i));
    const shown = furthest < WHOLE ? WHOLE : NEAR;
    for (let i = 0; i < points.length; i += 2) {
      if (distance(points, i) < shown) include(points[i] * MM, -points[i + 1] * MM);
    }
    const origin = this.picture?.pose?.at;
    if (origin && this.picture?.class !== "line" && distance(origin, 0) < shown) {
      include(origin[0] * MM, -origin[1] * MM);
    }
    return low[0] <= high[0] ? {low, high} : null;
  }

  fit() {
    const bounds = this.bounds();
    if (!bounds) return;
    const width = this.size.width - MARGIN, height = this.size.height - 24;
    const size = [0, 1].map((i) => bounds.high[i] - bounds.low[i]);
    const least = Math.max(...size) > 0 ? 1e-6 : ALONE;
    const extent = size.map((length) => Math.max(length, least));
    const scale = 0.86 * Math.min(width / extent[0], height / extent[1]);
    const x = (bounds.low[0] + bounds.high[0]) / 2, y = (bounds.low[1] + bounds.high[1]) / 2;
    // While points arrive, the view stays until they leave it or much of it is empty.
    const off = Math.hypot(x - this.view.x, y - this.view.y) * scale;
    const isNear = scale / this.view.scale < 1.35 && scale / this.view.scale > 0.97 && off < 0.05 * width;
    if (!isNear) this.view = {x, y, scale};
  }

  /** Fits the view to everything, now and from now on. */
  fitAlways() {
    this.isFitted = true;
    this.view = {x: 0, y: 0, scale: 1e-9};
    this.fit();
    this.place();
    this.onViewChange();
  }

  /** @param {View} view */
  setView(view) {
    this.isFitted = false;
    this.view = view;
    this.place();
  }

  /** @param {number} x [mm] @param {number} y downwards [mm] @returns {number[]} pixels */
  toPixels(x, y) {
    return [(MARGIN + this.size.width) / 2 + (x - this.view.x) * this.view.scale,
            (this.size.height - 24) / 2 + (y - this.view.y) * this.view.scale];
  }

  place() {
    const [tx, ty] = this.toPixels(0, 0);
    const scale = this.view.scale;
    this.world.setAttribute("transform", `matrix(${scale} 0 0 ${scale} ${tx} ${ty})`);
    const origin = (this.store ?? this.picture)?.origin ?? [];
    const gridKey = [this.size.width, this.size.height, tx, ty, scale, ...origin].join();
    if (gridKey !== this.gridKey) {
      this.gridKey = gridKey;
      this.drawGrid();
    }
    this.drawMarks();
  }

  /** Draws the world coordinates along both sides. */
  drawGrid() {
    this.grid.replaceChildren();
    const origin = (this.store ?? this.picture)?.origin;
    if (!origin) return;
    const {width, height} = this.size;
    const scale = this.view.scale;
    const stepMm = tickStep(Math.max(width, height) / scale, Math.max(width, height) / 90);
    const unit = unitOf(stepMm);
    const step = stepMm / unit.mm;
    // Both in the unit, y upwards.
    const at = [origin[0] * MM + this.view.x, origin[1] * MM - this.view.y].map((mm) => mm / unit.mm);
    const half = [width - MARGIN, height - 24].map((length) => length / 2 / scale / unit.mm);
    const offset = at.map((centre, i) => tickOffset(centre - half[i], centre + half[i], step));
    for (const i of [0, 1]) {
      const from = at[i] - offset[i];
      for (const label of ticks(from - half[i], from + half[i], step)) {
        const away = (label - from) * unit.mm;
        if (i === 0) {
          const [x] = this.toPixels(this.view.x + away, 0);
          svg("line", {x1: x, x2: x, y1: 0, y2: height - 24}, this.grid);
          if (x > MARGIN + 14 && x < width - this.room(offset[0], unit.name)) {
            svg("text", {x, y: height - 8, "text-anchor": "middle"}, this.grid).textContent = tickText(label, step);
          }
        } else {
          const [, y] = this.toPixels(0, this.view.y - away);
          svg("line", {x1: MARGIN, x2: width, y1: y, y2: y}, this.grid);
          if (y > 10 && y < height - 28) {
            svg("text", {x: MARGIN - 6, y: y + 4, "text-anchor": "end"}, this.grid).textContent = tickText(label, step);
          }
        }
      }
    }
    svg("text", {class: "unit", x: width - 4, y: height - 8, "text-anchor": "end"}, this.grid).textContent =
        axisText("x", offset[0], unit.name);
    if (offset[1] !== 0) {
      svg("text", {class: "unit", x: MARGIN + 6, y: 14}, this.grid).textContent = axisText("y", offset[1], unit.name);
    }
  }

  /** Room for the unit at the end of the x axis, and half a label. [px] @param {number} offset @param {string} unit */
  room(offset, unit) {
    return 26 + 7 * axisText("x", offset, unit).length;
  }

  drawMarks() {
    let far = "";
    const points = this.details?.far ?? [];
    for (let i = 0; i < points.length; i += 2) {
      const [x, y] = this.toPixels(points[i] * MM, -points[i + 1] * MM);
      far += `M${x - 4} ${y - 4}l8 8m0 -8l-8 8`;
    }
    this.far.setAttribute("d", far);
    let tangents = "";
    for (const contact of this.picture?.contacts ?? []) {
      const [x, y] = this.toPixels(contact.at[0] * MM, -contact.at[1] * MM);
      tangents += `M${x - 4} ${y}a4 4 0 1 0 8 0a4 4 0 1 0 -8 0M${x} ${y}` +
          `l${TANGENT_PIXELS * Math.cos(contact.tangent)} ${-TANGENT_PIXELS * Math.sin(contact.tangent)}`;
    }
    this.tangents.setAttribute("d", tangents);
    this.marks.replaceChildren();
    const pose = this.picture?.pose;
    if (pose) {
      const [x, y] = this.toPixels(pose.at[0] * MM, -pose.at[1] * MM);
      for (const [name, turn] of /** @type {[string, number][]} */ ([["x", 0], ["y", Math.PI / 2]])) {
        const dx = Math.cos(pose.theta + turn), dy = -Math.sin(pose.theta + turn);
        svg("line", {class: `axis-${name}`, x1: x, y1: y, x2: x + AXIS_PIXELS * dx, y2: y + AXIS_PIXELS * dy},
            this.marks);
        svg("text", {class: `axis-${name}`, x: x + (AXIS_PIXELS + 9) * dx, y: y + (AXIS_PIXELS + 9) * dy + 4,
                     "text-anchor": "middle"}, this.marks).textContent = name;
      }
    }
    this.labels.replaceChildren();
    for (const [probe, {run, total, colour}] of this.newest ?? []) {
      const [x, y] = this.toPixels(run.points[2 * total - 2] * MM, -run.points[2 * total - 1] * MM);
      svg("text", {class: `run${colour}`, x: x + run.tipRadius * MM * this.view.scale + 6, y: y + 4},
          this.labels).textContent = probe;
    }
  }

  /** @param {number} factor @param {number=} px @param {number=} py the pixel that stays in place */
  zoom(factor, px = (MARGIN + this.size.width) / 2, py = (this.size.height - 24) / 2) {
    const scale = Math.min(Math.max(this.view.scale * factor, 1e-4), 1e8);
    const [cx, cy] = [(MARGIN + this.size.width) / 2, (this.size.height - 24) / 2];
    const x = this.view.x + (px - cx) * (1 / this.view.scale - 1 / scale);
    const y = this.view.y + (py - cy) * (1 / this.view.scale - 1 / scale);
    this.setView({x, y, scale});
    this.onViewChange();
  }

  /** @param {number} dx @param {number} dy [px] */
  pan(dx, dy) {
    this.setView({x: this.view.x - dx / this.view.scale, y: this.view.y - dy / this.view.scale,
                  scale: this.view.scale});
    this.onViewChange();
  }

  wireInput() {
    const at = (/** @type {MouseEvent} */ event) => {
      const box = this.root.getBoundingClientRect();
      return [event.clientX - box.left, event.clientY - box.top];
    };
    this.root.addEventListener("wheel", (event) => {
      event.preventDefault();
      const [x, y] = at(event);
      this.zoom(Math.exp(-0.0015 * event.deltaY), x, y);
    }, {passive: false});
    /** @type {Map<number, number[]>} */
    const fingers = new Map();
    this.root.addEventListener("pointerdown", (event) => {
      this.root.setPointerCapture(event.pointerId);
      fingers.set(event.pointerId, at(event));
    });
    this.root.addEventListener("pointermove", (event) => {
      const before = fingers.get(event.pointerId);
      if (!before) return;
      const now = at(event);
      fingers.set(event.pointerId, now);
      if (fingers.size === 1) return this.pan(now[0] - before[0], now[1] - before[1]);
      const other = [...fingers].find(([id]) => id !== event.pointerId)?.[1] ?? now;
      const grown = Math.hypot(now[0] - other[0], now[1] - other[1]) /
          Math.max(Math.hypot(before[0] - other[0], before[1] - other[1]), 1);
      this.zoom(grown, other[0], other[1]);
    });
    for (const end of ["pointerup", "pointercancel"]) {
      this.root.addEventListener(end, (event) =>
          fingers.delete(/** @type {PointerEvent} */ (event).pointerId));
    }
    this.root.addEventListener("dblclick", () => this.fitAlways());
    this.root.addEventListener("keydown", (event) => {
      const steps = {ArrowLeft: [40, 0], ArrowRight: [-40, 0], ArrowUp: [0, 40], ArrowDown: [0, -40]};
      const step = steps[/** @type {keyof typeof steps} */ (event.key)];
      if (!step) return;
      event.preventDefault();
      this.pan(step[0], step[1]);
    });
  }
}
