"use strict";
// A page that only looks on: what would change something stays here; the server refuses it in any case.
const fegearLook = (() => {
  const KEPT = new Set(["handshake", "ack"]); // of the connection itself
  function begin() {
    document.body.classList.add("looking");
    window.emitEvent = () => {};
    const { socket } = window;
    if (!socket || socket.looking) return;
    const emit = socket.emit.bind(socket);
    socket.looking = true;
    socket.emit = (kind, ...rest) => (KEPT.has(kind) ? emit(kind, ...rest) : socket);
  }
  return { begin };
})();
