"use strict";
// What the page says to its server in one message, in pieces where it is long; what is too long stays here, and says so.
const fegearPieces = (() => {
  function begin({ piece, most }) {
    const { socket } = window;
    if (!socket || socket.inPieces) return;
    const emit = socket.emit.bind(socket);
    socket.inPieces = true;
    socket.emit = (kind, message, ...rest) => {
      const whole = kind === "event" ? JSON.stringify(message) : "";
      if (whole.length <= piece) return emit(kind, message, ...rest);
      const text = whole.replace(/[^ -~]/g, (sign) => `\\u${sign.charCodeAt(0).toString(16).padStart(4, "0")}`); // no piece ends within a character
      if (text.length > 4 * most) { emitEvent("untaken"); return socket; }
      const name = Math.random().toString(36).slice(2), count = Math.ceil(text.length / piece);
      for (let at = 0; at < count; at += 1) emit("piece", { client_id: message.client_id, name, count, at, text: text.slice(at * piece, (at + 1) * piece) });
      return socket;
    };
  }
  return { begin };
})();
