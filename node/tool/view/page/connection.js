// The live feed. The server sends the next message only after this page has drawn the last one.
// @ts-check
/** @typedef {import("./types.js").Message} Message */

const RETRY_MS = 500;

/** Converts steps to metres. @param {number[]|undefined} places @param {number} step */
function toMetres(places, step) {
  for (let i = 0; places && i < places.length; ++i) places[i] *= step;
}

/** @param {Message} message */
export function decoded(message) {
  const {picture, details, samples} = message;
  if (picture) {
    for (const curve of [picture.curve, ...picture.rivals]) {
      for (const places of [curve?.points, curve?.left, curve?.right]) toMetres(places, picture.step);
    }
    for (const {at} of [...picture.contacts, ...(picture.pose ? [picture.pose] : [])]) toMetres(at, picture.step);
  }
  for (const places of [details?.residuals?.lines, details?.far]) toMetres(places, details?.step ?? 1);
  for (const run of samples?.runs ?? []) toMetres(run.points, samples?.step ?? 1);
  return message;
}

export class Connection {
  /**
   * @param {(message: Message) => void} onMessage
   * @param {(isOpen: boolean) => void} onChange
   */
  constructor(onMessage, onChange) {
    this.onMessage = onMessage;
    this.onChange = onChange;
    this.wanted = "";
    this.open();
  }

  open() {
    const socket = new WebSocket(`ws://${location.host}/live`);
    this.socket = socket;
    socket.onopen = () => {
      this.onChange(true);
      this.ready();
    };
    socket.onmessage = (event) => this.onMessage(decoded(JSON.parse(event.data)));
    socket.onclose = () => {
      this.onChange(false);
      setTimeout(() => this.open(), RETRY_MS);
    };
  }

  /** Asks for the next message. */
  ready() {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(this.wanted);
  }

  /** @param {string} group "" = the one being touched */
  want(group) {
    if (group === this.wanted) return;
    this.wanted = group;
    this.ready();
  }
}
