"use strict";
// What the page says to its server in one message, in pieces where it is long; what is too long stays here, and says so.
const fegearPieces = (() => {
  const longer = (said, most) => typeof said === "string" && said.length > most && String(JSON.parse(said)).length > most;
  function begin({ piece, most }) {
    const { socket } = window;
    if (!socket || socket.inPieces) return;
    const emit = socket.emit.bind(socket), unheard = new Map(); // a page that lays out a long text is not heard for long, and loses its connection
    const say = (name, pieces) => pieces.forEach((said, at) => emit("piece", said, ...(at + 1 < pieces.length ? [] : [() => unheard.delete(name)])));
    socket.inPieces = true;
    socket.on("connect", () => unheard.forEach((pieces, name) => say(name, pieces)));
    socket.emit = (kind, message, ...rest) => {
      const whole = kind === "event" ? JSON.stringify(message) : "";
      if (whole.length <= piece) return emit(kind, message, ...rest);
      if (message.args?.some((said) => longer(said, most))) { emitEvent("untaken"); return socket; }
      const text = whole.replace(/[^ -~]/g, (sign) => `\\u${sign.charCodeAt(0).toString(16).padStart(4, "0")}`); // no piece ends within a character
      const name = Math.random().toString(36).slice(2), count = Math.ceil(text.length / piece);
      unheard.set(name, Array.from({ length: count }, (_, at) => ({ client_id: message.client_id, name, count, at, text: text.slice(at * piece, (at + 1) * piece) })));
      if (socket.connected) say(name, unheard.get(name));
      return socket;
    };
    document.addEventListener("beforeinput", (event) => { // pasted, dropped or typed: before the browser lays it out
      const { data, target } = event, kept = target.value === undefined ? target.textContent.length : target.value.length - (target.selectionEnd - target.selectionStart);
      if (!data || kept + data.length <= most) return;
      event.preventDefault();
      emitEvent("unwritten");
    }, true);
    document.addEventListener("input", ({ target }) => { if (target.value?.length > most) emitEvent("untaken"); }, true); // put there by a script
  }
  return { begin };
})();
