"use strict";
// Numbers of the form are dragged by the arrow in their corner: to the right they grow, to the left they fall.
const fegearScrub = (() => {
  const EVERY = 60; // ms between two changes
  const SLACK = 3; // px: less is a click
  const STEP = { whole: 12, part: 4 }; // px for a step
  const NUMBER = /^\s*([-+]?(?:\d+\.?\d*|\.\d+))(?![\d.eE])(.*)$/s;

  /** What a text becomes so many steps on: a tooth more, or a hundredth of a number's first digit (`fine`: of that). */
  function moved(text, steps, whole, fine = false) {
    const found = NUMBER.exec(text);
    if (!found) return null;
    const [, number, unit] = found, value = Number(number), given = (number.split(".")[1] ?? "").length;
    if (whole) return `${value + steps}${unit}`;
    const power = Math.floor(Math.log10(Math.abs(value) || 0.1)) - 1 - (fine ? 1 : 0);
    return `${(value + steps * 10 ** power).toFixed(Math.min(12, Math.max(given, -power, 0)))}${unit}`;
  }
  // The arrow is drawn by the style sheet; all else of this element lies below the field itself.
  const fieldOf = (target) => target.matches?.(".inputs .scrubs .q-field__inner") && target.closest(".scrubs");
  let held = null;
  function send(moving) {
    clearTimeout(held.waiting);
    const { field, text } = held, now = () => { held && (held.next = performance.now() + EVERY); emitEvent("value", { field, text, moving }); };
    const wait = held.next - performance.now();
    if (moving && wait > 0) held.waiting = setTimeout(now, wait); else now();
  }
  function begin() {
    addEventListener("pointerdown", (event) => {
      const host = event.button === 0 && fieldOf(event.target), input = host && host.querySelector("input");
      if (!input || held) return;
      const from = input.value || input.placeholder;
      if (moved(from, 1, false) === null) return;
      event.preventDefault(); // else it is typed into
      held = { input, field: input.dataset.key, from, text: from, whole: host.classList.contains("whole"), x: event.clientX, id: event.pointerId, next: 0, moved: false };
      document.documentElement.classList.add("scrubbing");
    }, true);
    addEventListener("pointermove", (event) => {
      if (!held || event.pointerId !== held.id) return;
      const way = event.clientX - held.x;
      if (!held.moved && Math.abs(way) < SLACK) return;
      held.moved = true;
      const text = moved(held.from, Math.round(way / STEP[held.whole ? "whole" : "part"]), held.whole, event.shiftKey);
      if (text === held.text) return;
      held.text = held.input.value = text; // at once, and by nobody else: to hear it from the server would draw the whole form anew
      send(true);
    }, true);
    const end = (event) => {
      if (!held || event.pointerId !== held.id) return;
      document.documentElement.classList.remove("scrubbing");
      if (held.moved) { held.next = 0; send(false); addEventListener("click", (click) => click.preventDefault(), { capture: true, once: true }); }
      held = null;
    };
    addEventListener("pointerup", end, true);
    addEventListener("pointercancel", end, true);
  }
  begin();
  return { moved };
})();
