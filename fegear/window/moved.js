"use strict";
// Figures while a value moves: where only numbers of curves and bars differ and they fit the axes, curves and bars are
// moved and nothing else is drawn anew, at a third of the cost. Axes stay where they are then, which is easier to read.
const fegearMoved = (() => {
  const NUMBERS = ["x", "y", "base", "customdata"]; // of a trace
  const LEAST = 0.6, ROOM = 0.25; // of an axis: what values have to take up, and what they get once they exceed it
  const painted = new WeakMap(); // place -> { spec, mode, spans }: how it was drawn last as a whole, and what is drawn now
  const rough = new WeakSet(); // places that are not as they would be drawn at rest
  const forms = new WeakMap();

  function formOf(spec) { // all but the numbers
    if (!forms.has(spec)) {
      const data = spec.data.map((trace) => ({ ...trace, ...Object.fromEntries(NUMBERS.filter((name) => trace[name]?.bdata).map((name) => [name, 0])) }));
      forms.set(spec, JSON.stringify([data, spec.layout]));
    }
    return forms.get(spec);
  }
  const endsOf = (array, log) => (log ? fegearPacked.ends(array).map(Math.log10) : fegearPacked.ends(array));
  function spansOf(place, spec) { // axis -> ends of what is shown along it
    const spans = {};
    spec.data.forEach((trace, i) => {
      if ((place.data[i]?.visible ?? true) !== true) return;
      for (const way of ["x", "y"]) {
        if (!trace[way]?.bdata) continue;
        const name = `${way}axis${(trace[`${way}axis`] ?? way).slice(1)}`, [low, high] = endsOf(trace[way], spec.layout[name]?.type === "log");
        const [least, most] = spans[name] ?? [Infinity, -Infinity];
        spans[name] = [Math.min(least, low), Math.max(most, high)];
      }
    });
    return spans;
  }
  function exceeded(place, spec, drawn) { // axes that what is shown does not fit any longer
    const layout = place._fullLayout;
    return Object.entries(spansOf(place, spec)).filter(([name, [low, high]]) => {
      const axis = layout[name];
      if (!(low <= high) || !(axis.autorange || drawn.roomy?.[name])) return false; // ends of its own, or the reader's
      const [from, to] = [Math.min(...axis.range), Math.max(...axis.range)], [least, most] = drawn.spans[name] ?? [low, high];
      return low < from || high > to || high - low < LEAST * (most - least);
    });
  }

  /** Moves what is drawn to other numbers; false where it has to be drawn as a whole. */
  async function move(place, spec, mode) {
    const drawn = painted.get(place);
    if (!drawn || drawn.mode !== mode || place.data.length !== spec.data.length || formOf(drawn.spec) !== formOf(spec)) return false;
    if (!spec.data.every(({ type }) => type === "scatter" || type === "bar") || exceeded(place, spec, drawn).length) return false;
    const traces = [], data = [];
    spec.data.forEach((trace, i) => {
      const other = NUMBERS.filter((name) => trace[name]?.bdata && trace[name].bdata !== drawn.spec.data[i][name].bdata);
      if (!other.length) return;
      traces.push(i);
      data.push(Object.fromEntries(other.map((name) => [name, trace[name]])));
    });
    drawn.spec = spec;
    if (!traces.length) return true;
    rough.add(place);
    await Plotly.animate(place, { data, traces }, { mode: "immediate", frame: { duration: 0, redraw: false }, transition: { duration: 0 } });
    return true;
  }
  /** The layout to draw as a whole while a value moves: more room where the last numbers have left the axis. */
  function roomy(place, spec, shaded) {
    const drawn = painted.get(place), found = {};
    if (!drawn || place.data.length !== spec.data.length || formOf(drawn.spec) !== formOf(spec)) return found;
    for (const [name, [low, high]] of exceeded(place, spec, drawn)) {
      const axis = place._fullLayout[name], [from, to] = axis.range;
      if (!name.startsWith("y") || axis.type !== "linear" || !(from < to) || (low >= from && high <= to)) continue;
      const room = ROOM * (high - low);
      found[name] = [low < from ? low - room : from, high > to ? high + room : to];
      shaded.layout[name] = { ...shaded.layout[name], range: found[name], autorange: false };
    }
    return found;
  }
  /** Notes that a figure was drawn as a whole. */
  function whole(place, spec, mode, roomy = {}) {
    painted.set(place, { spec, mode, roomy, spans: spansOf(place, spec) });
    if (Object.keys(roomy).length) rough.add(place); else rough.delete(place);
  }
  return { move, roomy, whole, rough: (place) => rough.has(place) };
})();
