// The live feed. The server sends the next message only after this page has drawn the last one.
// @ts-check
/** @typedef {import("./types.js").Message} Message */

const RETRY_MS = 500;

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
    socket.onmessage = (event) => this.onMessage(JSON.parse(event.data));
    socket.onclose = () => {
      this.onChange(false);
      setTimeout(() => this.open(), RETRY_MS);
    };
  }

  /** Asks for the next message. */
  ready() {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(this.wanted);
  }

  /** @param {string} group "" = the one that is touched */
  want(group) {
    if (group === this.wanted) return;
    this.wanted = group;
    this.ready();
  }
}
