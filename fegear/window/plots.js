"use strict";
// Small plots: one panel of a figure as an SVG, quick enough to be drawn anew at every step of a value that moves.
const fegearPlots = (() => {
  const SVG = "http://www.w3.org/2000/svg";
  const ROOM = { left: 46, right: 8, top: 6, bottom: 30, large: 34 }; // about what is drawn [px]; `large`: below it, in large type
  const MOST_TICKS = 6, DASHES = { dash: "6 4", dot: "2 3", dashdot: "6 3 2 3" };

  const node = (tag, attributes, parent) => {
    const one = document.createElementNS(SVG, tag);
    for (const [name, value] of Object.entries(attributes)) one.setAttribute(name, value);
    parent?.append(one);
    return one;
  };
  const given = new WeakMap(); // element -> its attributes as they were set last
  /** Gives an element these attributes of ours and no others; those that it has are not touched, which would cost a layout. */
  function set(one, attributes) {
    const before = given.get(one) ?? {};
    for (const name of Object.keys(before)) if (!(name in attributes)) one.removeAttribute(name);
    for (const [name, value] of Object.entries(attributes)) if (before[name] !== value) one.setAttribute(name, value);
    given.set(one, attributes);
  }
  /** A pen for a group: what stands there already in the same place stays, and takes what is different of it alone. */
  function pen(group) {
    let next = group.firstChild;
    const put = (tag, attributes, words) => {
      const stays = next?.tagName === tag, one = stays ? next : document.createElementNS(SVG, tag);
      if (stays) next = next.nextSibling; else group.insertBefore(one, next);
      set(one, attributes);
      if (words !== undefined && one.textContent !== words) one.textContent = words;
      return one;
    };
    put.end = () => { while (next) { const one = next; next = next.nextSibling; one.remove(); } };
    return put;
  }
  const { numbers, ends } = fegearPacked;
  const anchor = (panel) => (panel === 1 ? "" : String(panel));
  const ofPanel = (spec, panel) => spec.data.filter((one) => (one.yaxis ?? "y") === `y${anchor(panel)}` && (one.xaxis ?? "x") === `x${anchor(panel)}`);
  function endsOf(arrays) {
    const found = arrays.filter(Boolean).map(ends), low = Math.min(...found.map(([one]) => one)), high = Math.max(...found.map(([, one]) => one));
    return low <= high ? [low, high] : [0, 1];
  }
  function step(span, most) { // 1, 2 or 5 times a power of ten
    const power = 10 ** Math.floor(Math.log10(span / most)), times = span / most / power;
    return power * (times <= 1 ? 1 : times <= 2 ? 2 : times <= 5 ? 5 : 10);
  }
  function ticks([low, high], most) {
    const found = [];
    let by = step(high - low, most);
    const inside = () => Math.floor(high / by + 1e-9) - Math.ceil(low / by - 1e-9) + 1;
    for (let more = 2; inside() < 2 && more < 17; more *= 2) by = step(high - low, more * most); // one number alone is no scale
    for (let i = Math.ceil(low / by - 1e-9); i * by <= high + 1e-9 * by; i += 1) found.push(i * by);
    return [found, Math.max(0, -Math.floor(Math.log10(by) + 1e-9))];
  }
  function rangesOf(spec, panel, held) {
    const traces = ofPanel(spec, panel), name = anchor(panel), found = {};
    for (const way of ["x", "y"]) {
      const axis = spec.layout[`${way}axis${name}`] ?? {};
      if (axis.range && !axis.type?.startsWith("log")) { found[way] = axis.range.map(Number); continue; }
      let [low, high] = endsOf(traces.map((one) => one[way]));
      if (way === "y" && (traces.some((one) => one.type === "bar") || axis.rangemode === "tozero")) { low = Math.min(low, 0); high = Math.max(high, 0); }
      const bars = way === "x" && traces.some((one) => one.type === "bar") ? 0.6 : 0, room = way === "y" ? 0.08 * (high - low || Math.abs(high) || 1) : 0;
      found[way] = [low - bars - (low === 0 ? 0 : room), high + bars + room];
      if (found[way][0] === found[way][1]) found[way] = [low - 1, high + 1];
    }
    // While a value moves an axis only grows: it would be hard to see what moves otherwise.
    if (held) found.y = [Math.min(found.y[0], held.y[0]), Math.max(found.y[1], held.y[1])];
    return found;
  }
  const plain = (text) => text.replace(/<[^>]*>/g, "");

  const enlarged = () => document.documentElement.classList.contains("large-type");
  const letter = () => (enlarged() ? 7.5 : 5.4); // about its width [px]
  const axis = () => (enlarged() ? 6.2 : 5.4); // of an axis' title
  function fitting(text, most) { // words from the end are left away, but for the unit
    const [, words, unit] = /^(.*?)\s*(\[[^\]]*\])?$/.exec(text), kept = words.split(" ");
    while (kept.length > 1 && kept.join(" ").length + (unit?.length ?? 0) > most) kept.pop();
    while (kept.length > 1 && (["the", "of", "on", "from", "over", "one", "in"].includes(kept.at(-1)) || kept.at(-1).endsWith("'s"))) kept.pop();
    return [...kept, unit].filter(Boolean).join(" ");
  }

  /** A small plot in a place; `draw` shows a figure's panel. */
  function plot(host) {
    const svg = node("svg", { class: "small-plot", role: "img" }, host);
    const kept = { svg, ranges: null, box: null, room: null };
    // Its size as it was laid out last: to ask for it while others are drawn has the page laid out each time.
    new ResizeObserver(([{ contentRect: { width, height } }]) => { kept.room = { width, height }; }).observe(host);
    kept.x = (value) => kept.box.x0 + (value - kept.ranges.x[0]) / (kept.ranges.x[1] - kept.ranges.x[0]) * (kept.box.x1 - kept.box.x0);
    kept.y = (value) => kept.box.y0 - (value - kept.ranges.y[0]) / (kept.ranges.y[1] - kept.ranges.y[0]) * (kept.box.y0 - kept.box.y1);
    kept.atX = (px) => kept.ranges.x[0] + (px - kept.box.x0) / (kept.box.x1 - kept.box.x0) * (kept.ranges.x[1] - kept.ranges.x[0]);
    kept.atY = (px) => kept.ranges.y[0] + (kept.box.y0 - px) / (kept.box.y0 - kept.box.y1) * (kept.ranges.y[1] - kept.ranges.y[0]);
    kept.mark = (places) => { // places along x, moved without drawing anything else anew
      if (!kept.box || !kept.nows) return;
      const { y0, y1 } = kept.box, put = pen(kept.nows);
      for (const x of places) if (x >= kept.ranges.x[0] && x <= kept.ranges.x[1]) put("line", { class: "now", x1: kept.x(x), x2: kept.x(x), y1: y0, y2: y1 });
      put.end();
    };
    let shade = (colour) => colour; // on the ground as it is
    function path(trace) {
      const x = numbers(trace.x), y = numbers(trace.y);
      let line = "", down = false;
      for (let i = 0; i < x.length; i += 1) {
        if (!Number.isFinite(y[i]) || !Number.isFinite(x[i])) { down = false; continue; }
        line += `${down ? "L" : "M"}${kept.x(x[i]).toFixed(1)},${kept.y(y[i]).toFixed(1)}`;
        down = true;
      }
      return line;
    }
    function curve(trace, put, pinned) {
      const colour = shade(trace.line?.color ?? trace.marker?.color ?? "currentColor");
      if (trace.type === "bar") {
        const x = numbers(trace.x), y = numbers(trace.y), half = pinned ? 0.45 : 0.36;
        for (let i = 0; i < x.length; i += 1) {
          const a = kept.y(0), b = kept.y(y[i]);
          put("rect", { x: kept.x(x[i] - half), width: kept.x(x[i] + half) - kept.x(x[i] - half), y: Math.min(a, b), height: Math.abs(a - b),
            ...(pinned ? { class: "pinned-bar" } : { fill: colour }) });
        }
        return;
      }
      if (trace.type !== "scatter" || (trace.fill === "toself" && pinned)) return;
      const { mode = "lines" } = trace, line = path(trace);
      if (trace.fill === "toself") put("path", { d: `${line}Z`, fill: shade(trace.fillcolor), stroke: "none" });
      else if (mode.includes("lines")) {
        if (trace.fill) put("path", { d: `${line}V${kept.y(0).toFixed(1)}`, fill: shade(trace.fillcolor), stroke: "none" });
        put("path", { d: line, ...(pinned ? { class: "pinned" } : { stroke: colour, "stroke-width": trace.line?.width ?? 2, "stroke-dasharray": DASHES[trace.line?.dash] ?? "none" }), fill: "none" });
      } else if (!pinned) {
        const x = numbers(trace.x), y = numbers(trace.y);
        for (let i = 0; i < x.length; i += 1) put("circle", { cx: kept.x(x[i]), cy: kept.y(y[i]), r: 3, fill: colour });
      }
    }
    function map(trace, put) { // a map in colour
      const x = numbers(trace.x), y = numbers(trace.y), z = numbers(trace.z), { zmin, zmax } = trace, wide = x.length, tall = y.length;
      const canvas = Object.assign(document.createElement("canvas"), { width: wide, height: tall }), context = canvas.getContext("2d");
      const image = context.createImageData(wide, tall), shades = fegearLayers.stops("pressure").map((one) => [1, 3, 5].map((i) => parseInt(one.slice(i, i + 2), 16)));
      for (let row = 0; row < tall; row += 1) for (let i = 0; i < wide; i += 1) {
        const value = z[row * wide + i], to = 4 * ((tall - 1 - row) * wide + i);
        if (!Number.isFinite(value)) continue;
        const at = Math.max(0, Math.min(1, (value - zmin) / (zmax - zmin))) * (shades.length - 1), k = Math.min(Math.floor(at), shades.length - 2);
        for (let c = 0; c < 3; c += 1) image.data[to + c] = shades[k][c] + (shades[k + 1][c] - shades[k][c]) * (at - k);
        image.data[to + 3] = 255;
      }
      context.putImageData(image, 0, 0);
      const [low, high] = [endsOf([trace.x]), endsOf([trace.y])];
      put("image", { href: canvas.toDataURL(), x: kept.x(low[0]), y: kept.y(high[1]), width: kept.x(low[1]) - kept.x(low[0]),
        height: kept.y(high[0]) - kept.y(high[1]), preserveAspectRatio: "none" });
    }
    function says(spec, put) { // why nothing is to be seen, where the figure says it in its title
      const said = plain(spec.layout.annotations?.find(({ xref, text }) => xref === "paper" && /^(<b>)?none/.test(text))?.text ?? "");
      const { x0, x1, y0, y1 } = kept.box, most = (x1 - x0) / 5.6, lines = [""];
      for (const word of said.split(" ")) if (`${lines.at(-1)} ${word}`.length > most) lines.push(word); else lines.push(`${lines.pop()} ${word}`.trim());
      lines.forEach((line, i) => { put("text", { x: (x0 + x1) / 2, y: (y0 + y1) / 2 + 14 * (i - 0.5 * (lines.length - 1)), "text-anchor": "middle" }, line); });
    }
    /** Draws a panel of a figure: `held`: keep its axes; `pinned`: the same figure of A; `marks`: places along x. */
    kept.draw = (spec, panel = 1, { held = false, pinned = null, marks = [], words = "", darker = {} } = {}) => {
      const { width, height } = kept.room ?? svg.getBoundingClientRect();
      if (width < 40 || height < 40) return false;
      kept.box = { x0: ROOM.left, x1: width - ROOM.right, y0: height - (enlarged() ? ROOM.large : ROOM.bottom), y1: ROOM.top };
      shade = fegearFigure.theme() === "dark" ? (colour) => (typeof colour === "string" && darker[colour.slice(0, 7)] ? darker[colour.slice(0, 7)] + colour.slice(7) : colour) : (colour) => colour;
      kept.ranges = rangesOf(spec, panel, held && kept.ranges);
      if (pinned) { // A never leaves the axes, whatever the figure says of its own
        const other = rangesOf(pinned, panel, null);
        for (const way of ["x", "y"]) kept.ranges[way] = [Math.min(kept.ranges[way][0], other[way][0]), Math.max(kept.ranges[way][1], other[way][1])];
      }
      if (held === "fixed" && kept.fixed) kept.ranges = kept.fixed; else kept.fixed = kept.ranges;
      const { x0, x1, y0, y1 } = kept.box, within = { x: x0, y: y1, width: x1 - x0, height: y0 - y1 };
      if (!kept.group) {
        const id = `clip-${Math.random().toString(36).slice(2)}`, group = node("g", {});
        kept.clip = node("clipPath", { id }, group);
        const parts = [{}, { "clip-path": `url(#${id})` }, { "clip-path": `url(#${id})` }, {}].map((one) => node("g", one, group));
        [kept.axes, kept.inner, kept.nows, kept.over] = parts;
        kept.group = group;
        svg.prepend(group);
      }
      const [axes, inner, over, clip] = [kept.axes, kept.inner, kept.over, kept.clip].map(pen);
      clip("rect", within);
      for (const [way, most] of [["x", Math.max(2, Math.min(MOST_TICKS, (x1 - x0) / 60))], ["y", Math.max(2, Math.min(MOST_TICKS, (y0 - y1) / 24))]]) {
        const [at, digits] = ticks(kept.ranges[way], most);
        for (const one of at) {
          const text = Math.abs(one) >= 1e5 ? one.toExponential(0) : one.toFixed(digits).replace("-", "−"), px = kept[way](one);
          if (way === "x") axes("text", { x: px, y: y0 + 4 + 1.5 * letter(), "text-anchor": "middle" }, text);
          else {
            axes("line", { x1: x0, x2: x1, y1: px, y2: px, class: one === 0 ? "zero" : "grid" });
            axes("text", { x: x0 - 4, y: px + 3.5, "text-anchor": "end" }, text);
          }
        }
      }
      const along = spec.layout[`xaxis${anchor(panel)}`]?.title?.text;
      if (along) axes("text", { x: (x0 + x1) / 2, y: y0 + 14.7 + 1.9 * letter(), "text-anchor": "middle", class: "axis" }, fitting(plain(along), (x1 - x0 + 2 * ROOM.right) / axis()));
      let last = -Infinity;
      for (const shape of spec.layout.shapes ?? []) {
        if (shape.xref !== `x${anchor(panel)}` || shape.x0 !== shape.x1) continue;
        inner("line", { x1: kept.x(shape.x0), x2: kept.x(shape.x0), y1: y0, y2: y1, class: "mark" });
      }
      for (const note of [...spec.layout.annotations ?? []].sort((one, other) => one.x - other.x)) {
        if (note.xref !== `x${anchor(panel)}` || !note.text || note.text.length > 3) continue;
        const px = Math.max(kept.x(note.x) + 3, last + 4.6 + letter()); // letters of places next to each other stand side by side
        last = px;
        inner("text", { x: px, y: y1 + 0.9 + 1.5 * letter(), class: "letter" }, note.text);
      }
      const traces = ofPanel(spec, panel);
      for (const trace of traces) if (trace.type === "heatmap") map(trace, inner);
      if (pinned) for (const trace of ofPanel(pinned, panel)) curve(trace, inner, true);
      for (const trace of traces) curve(trace, inner, false);
      if (traces.length && traces.every(({ y }) => numbers(y).every((one) => one === 0))) says(spec, over);
      over("rect", { ...within, class: "frame" });
      for (const one of [axes, inner, over]) one.end();
      kept.mark(marks);
      if (words && svg.getAttribute("aria-label") !== words) svg.setAttribute("aria-label", words);
      return true;
    };
    return kept;
  }
  return { plot, node, pen, set, ofPanel, plain };
})();
