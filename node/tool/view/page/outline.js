// Outlines of curves and bands as paths of SVG, in millimetres, y downwards.
// @ts-check

export const MM = 1000;

/** @param {number[]} points @param {boolean} closed */
export function pathOf(points, closed = false) {
  let d = "";
  for (let i = 0; i < points.length; i += 2) {
    d += `${i === 0 ? "M" : "L"}${points[i] * MM} ${-points[i + 1] * MM}`;
  }
  return closed ? d + "Z" : d;
}

/** The area between two borders; for a closed curve it is a ring.
 * @param {number[]} left @param {number[]} right @param {boolean} closed */
function areaOf(left, right, closed) {
  if (closed) return pathOf(left, true) + pathOf(right, true);
  const back = [];
  for (let i = right.length - 2; i >= 0; i -= 2) back.push(right[i], right[i + 1]);
  return pathOf(left.concat(back), true);
}

/** Whether a border runs against the curve somewhere: there the band is wider than the curve's radius.
 * @param {number[]} points @param {number[]} border */
function turnsBack(points, border) {
  for (let i = 2; i < points.length; i += 2) {
    const [x, y] = [points[i] - points[i - 2], points[i + 1] - points[i - 1]];
    if ((border[i] - border[i - 2]) * x + (border[i + 1] - border[i - 1]) * y < 0) return true;
  }
  return false;
}

/** What lies beside the curve, step by step, as triangles that all turn the same way: they overlap.
 * @param {number[]} points @param {number[][]} borders */
function besideOf(points, borders) {
  let d = "";
  const add = (/** @type {number[]} */ a, /** @type {number[]} */ b, /** @type {number[]} */ c) => {
    const turn = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    d += pathOf(turn > 0 ? [...a, ...b, ...c] : [...a, ...c, ...b], true);
  };
  for (let i = 2; i < points.length; i += 2) {
    for (const border of borders) {
      const [from, to] = [points.slice(i - 2, i), points.slice(i, i + 2)];
      const [before, after] = [border.slice(i - 2, i), border.slice(i, i + 2)];
      add(from, to, after);
      add(from, after, before);
    }
  }
  return d;
}

/** The area of a band. Where a border turns back, what lies between the borders is not what lies beside the curve.
 * @param {number[]} points @param {number[]} left @param {number[]} right @param {boolean} closed */
export function bandPath(points, left, right, closed) {
  const isWide = turnsBack(points, left) || turnsBack(points, right);
  return {isWide, d: isWide ? besideOf(points, [left, right]) : areaOf(left, right, closed)};
}
