// Saves the picture as a file and the view as a link.
// @ts-check

const STYLES = ["fill", "fill-opacity", "stroke", "stroke-width", "stroke-opacity", "stroke-dasharray",
                "stroke-linecap", "stroke-linejoin", "opacity", "font-family", "font-size", "font-weight",
                "vector-effect", "display", "paint-order"];

/** A copy of the picture that needs no style sheet.
 * @param {SVGSVGElement} root @param {string} title */
export function standalone(root, title) {
  const copy = /** @type {SVGSVGElement} */ (root.cloneNode(true));
  const originals = [root, ...root.querySelectorAll("*")];
  const copies = [copy, ...copy.querySelectorAll("*")];
  originals.forEach((original, i) => {
    const style = getComputedStyle(original);
    for (const name of STYLES) {
      const value = style.getPropertyValue(name);
      if (value) copies[i].setAttribute(name, value);
    }
    copies[i].removeAttribute("style");
    copies[i].removeAttribute("class");
  });
  const box = root.getBoundingClientRect();
  copy.setAttribute("width", String(box.width));
  copy.setAttribute("height", String(box.height));
  copy.setAttribute("xmlns", "http://www.w3.org/2000/svg");
  const background = document.createElementNS("http://www.w3.org/2000/svg", "rect");
  background.setAttribute("width", "100%");
  background.setAttribute("height", "100%");
  background.setAttribute("fill", getComputedStyle(document.body).backgroundColor);
  copy.prepend(background);
  const name = document.createElementNS("http://www.w3.org/2000/svg", "title");
  name.textContent = title;
  copy.prepend(name);
  return new XMLSerializer().serializeToString(copy);
}

/** @param {string} text @param {string} type @param {string} name */
export function download(text, type, name) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(new Blob([text], {type}));
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

/** `at`: Unix time of a moment, in ms.
 * @typedef {{group: string, at: number|null, view: import("./plane.js").View|null, hidden: string[], shown: string[]}} Settings */

/** @param {Settings} settings */
export function toHash(settings) {
  const words = new URLSearchParams();
  if (settings.group) words.set("group", settings.group);
  if (settings.at !== null) words.set("at", String(settings.at));
  if (settings.view) {
    words.set("view", [settings.view.x, settings.view.y, settings.view.scale]
        .map((value) => Number(value.toPrecision(9))).join(","));
  }
  if (settings.hidden.length) words.set("hide", settings.hidden.join(","));
  if (settings.shown.length) words.set("show", settings.shown.join(","));
  return words.toString();
}

/** @param {string} hash @returns {Settings} */
export function fromHash(hash) {
  const words = new URLSearchParams(hash.replace(/^#/, ""));
  const numbers = (words.get("view") ?? "").split(",").map(Number);
  const isView = numbers.length === 3 && numbers.every(Number.isFinite) && numbers[2] > 0;
  const list = (/** @type {string} */ name) => (words.get(name) ?? "").split(",").filter(Boolean);
  const group = /^[A-Za-z0-9_.-]{1,64}$/.test(words.get("group") ?? "") ? words.get("group") ?? "" : "";
  const at = /^\d{1,15}$/.test(words.get("at") ?? "") && group !== "" ? Number(words.get("at")) : null;
  return {
    group,
    at,
    view: isView ? {x: numbers[0], y: numbers[1], scale: numbers[2]} : null,
    hidden: list("hide"),
    shown: list("show"),
  };
}
