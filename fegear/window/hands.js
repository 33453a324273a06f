"use strict";
// What is changed by hand beside the form: points of reliefs are dragged, the load slides; the gears are gears.js.
const fegearHands = (() => {
  const { button, meshOf } = fegearGears;
  const shown = new Map(); // pair -> { host, mesh, load }
  const EVERY = 100; // ms between two changes while something is moved
  let held = null; // what the pointer holds

  function throttled(send) { // at most one change in EVERY ms, and always the last one
    let next = 0, waiting = null;
    return (content) => {
      clearTimeout(waiting);
      const wait = Math.max(0, next - performance.now());
      const now = () => { next = performance.now() + EVERY; send(content); };
      if (content.moving && wait > 0) waiting = setTimeout(now, wait); else now();
    };
  }

  // ---- reliefs ----------------------------------------------------------------------------------------------------
  const sendRelief = throttled((content) => emitEvent("relief", content));
  function placeHandles(kept, relief) {
    const { plot, layer } = kept;
    const wanted = relief.handles.flatMap((handle) => handle.end === "crowning" ? [{ handle, part: "amount" }] : [{ handle, part: "start" }, { handle, part: "amount" }]);
    const alone = (handle) => relief.handles.filter((one) => one.end === handle.end).length === 1;
    const buttons = [...layer.children];
    while (buttons.length > wanted.length) buttons.pop().remove();
    wanted.forEach(({ handle, part }, i) => {
      let one = buttons[i];
      if (!one) { one = document.createElement("button"); one.type = "button"; layer.append(one); }
      one.className = `handle ${part}`;
      const kind = handle.end === "crowning" ? "crowning" : `${handle.end} relief`;
      const which = alone(handle) ? kind : `${kind} ${handle.index + 1}`;
      one.dataset.handle = `${relief.gear} ${handle.end}${alone(handle) ? "" : ` ${handle.index + 1}`} ${part}`;
      const put = () => {
        const value = part === "start" ? `${handle.start.toFixed(3)} deg` : `${handle.amount.toFixed(2)} µm`;
        const x = part === "start" ? handle.start : handle.at, y = part === "start" ? 0 : handle.amount;
        one.style.left = `${plot.x(x)}px`;
        one.style.top = `${plot.y(y)}px`;
        one.setAttribute("aria-label", `${which} of gear ${relief.gear}: ${part}, ${value}`);
        one.title = `${which}, ${part}: ${value}; drag it, or use the arrow keys`;
      };
      const send = (moving) => sendRelief({ gear: relief.gear, end: handle.end, index: handle.index, start: handle.start, amount: handle.amount, moving });
      const room = 0.01 * (relief.high - relief.low);
      const within = () => {
        handle.amount = Math.max(handle.amount, 0);
        if (handle.end === "crowning") return;
        const ends = handle.end === "tip" ? [relief.low, Math.min(handle.at, relief.high) - room] : [Math.max(handle.at, relief.low) + room, relief.high];
        handle.start = Math.min(Math.max(handle.start, ends[0]), ends[1]);
      };
      one.onpointerdown = (event) => { one.setPointerCapture(event.pointerId); held = one; event.preventDefault(); one.focus(); };
      one.onpointermove = (event) => {
        if (held !== one) return;
        const before = { ...handle };
        const box = plot.svg.getBoundingClientRect();
        if (part === "start") handle.start = plot.atX(event.clientX - box.x);
        else handle.amount = plot.atY(event.clientY - box.y);
        within(); put(); kept.follow(before, handle); send(true);
      };
      one.onpointerup = one.onpointercancel = () => { if (held === one) { held = null; send(false); kept.draw(); } };
      one.onkeydown = (event) => {
        const way = { ArrowLeft: -1, ArrowRight: 1, ArrowUp: 1, ArrowDown: -1 }[event.key];
        if (!way) return;
        event.preventDefault();
        if (part === "start") handle.start += way * (event.shiftKey ? 1 : 0.1); else handle.amount += way * (event.shiftKey ? 5 : 0.5);
        within(); put(); send(false);
      };
      put();
    });
  }
  function removal({ end, start, at, amount, power }, roll) { // of one part, as EndRelief and Crowning have it [um]
    const share = end === "crowning" ? Math.abs(2 * roll - start - at) / (at - start) : Math.max(0, (roll - start) / (at - start));
    return amount * share ** power;
  }
  function reliefOf(host, relief) { // a gear's relief over the roll angle, with its handles
    const figure = document.createElement("figure"), title = document.createElement("div"), body = document.createElement("div"), layer = document.createElement("div");
    figure.className = "relief";
    figure.dataset.key = relief.figure.key;
    title.className = "plot-title";
    body.className = "small-body";
    layer.className = "handles";
    const kept = { figure, layer, plot: fegearPlots.plot(body), relief };
    body.append(layer);
    figure.append(title, body);
    host.append(figure);
    kept.draw = () => {
      const { figure: spec, darker } = kept.relief, mine = held && layer.contains(held);
      title.textContent = `${spec.heading}: removal [µm]`;
      title.title = spec.caption;
      // A handle that is held stays under the pointer: its axes do not change before it is let go of.
      const done = kept.plot.draw(spec, 1, { held: mine ? "fixed" : false, pinned: fegearGlance.against(spec.key)?.spec, darker, words: `${spec.heading}. ${spec.caption}` });
      if (done && !mine) placeHandles(kept, kept.relief);
      if (done) figure.dataset.count = Number(figure.dataset.count ?? 0) + 1;
    };
    // The curve goes with the handle at once; what the server makes of it comes with the next answers.
    kept.follow = (before, now) => {
      const spec = kept.relief.figure, x = fegearPacked.numbers(spec.data[0].x), y = fegearPacked.numbers(spec.data[0].y);
      const moved = Float64Array.from(y, (one, i) => one + removal(now, x[i]) - removal(before, x[i]));
      const rest = spec.data.slice(1).map((one) => ({ ...one, x: [], y: [] })); // its points, which the handles cover
      kept.relief = { ...kept.relief, figure: { ...spec, data: [{ ...spec.data[0], y: moved }, ...rest] } };
      kept.draw();
    };
    kept.watch = new ResizeObserver(() => kept.draw());
    kept.watch.observe(body);
    return kept;
  }
  function reliefTools(figure, relief) {
    let tools = figure.querySelector(".tools");
    if (!tools) { tools = document.createElement("p"); tools.className = "tools"; figure.append(tools); }
    const offered = JSON.stringify([relief.gear, relief.given, relief.usual, relief.over_face, relief.on]);
    if (tools.dataset.offered === offered) return; // most changes leave them as they are
    tools.dataset.offered = offered;
    tools.replaceChildren();
    for (const end of ["tip", "root"]) {
      if (relief.given.includes(end)) continue;
      tools.append(button(`Add ${end} relief`, "10 µm from the usual point", () => emitEvent("relief", {
        gear: relief.gear, end, start: relief.usual[end], amount: 10, moving: false })));
    }
    if (relief.given.length) tools.append(button("Without relief", "Remove the relief of this gear", () => emitEvent("drop", { gear: relief.gear })));
    if (relief.given.includes("table")) tools.append(Object.assign(document.createElement("span"), { className: "quiet", textContent: "The curve includes a relief table; edit it in the form or the text." }));
    if (relief.over_face.length) tools.append(Object.assign(document.createElement("span"), { className: "quiet", textContent: `Modifications over the face width (${relief.over_face.join(", ")}) are edited in the form or the text.` }));
    if (relief.given.length && !relief.on) tools.append(Object.assign(document.createElement("span"), { className: "quiet", textContent: "No influence: effects.relief is off." }));
  }

  // ---- load -------------------------------------------------------------------------------------------------------
  const sendLoad = throttled((content) => emitEvent("load", content));
  function loadOf(pair, host) {
    const label = document.createElement("label"), slider = Object.assign(document.createElement("input"), { type: "range", min: 2, max: 200, value: 100 });
    const words = document.createElement("span"), value = document.createElement("b"), marks = document.createElement("datalist");
    label.className = "load-slider";
    slider.dataset.slider = pair;
    marks.id = `marks-${Math.random().toString(36).slice(2)}`;
    slider.setAttribute("list", marks.id);
    label.append(words, slider, value, marks);
    host.append(label);
    const kept = { base: null, unit: "", key: "" };
    const text = () => `${Number((kept.base * slider.value / 100).toPrecision(4))}${kept.unit}`;
    const send = (moving) => { value.textContent = text(); sendLoad({ pair, key: kept.key, text: text(), moving }); };
    slider.oninput = () => { held = slider; send(true); };
    slider.onchange = () => { held = null; send(false); };
    kept.set = (load) => {
      const found = load && /^\s*([-+]?[\d.]+(?:[eE][-+]?\d+)?)(.*)$/.exec(load.text);
      label.hidden = !found;
      if (!found || held === slider) return;
      const number = Number(found[1]);
      const range = load.range, low = range && Math.min(...range, number), high = range && Math.max(...range, number);
      if (range) kept.base = high; // it goes from the least to the largest that the case gives, each a mark
      else if (kept.key !== load.key || kept.unit !== found[2] || kept.ranged || number > 2 * kept.base || number < 0.02 * kept.base) kept.base = number;
      Object.assign(slider, range ? { min: 100 * low / high, max: 100, step: "any" } : { min: 2, max: 200, step: 1 });
      marks.replaceChildren(...(range ?? []).map((one) => Object.assign(document.createElement("option"), { value: 100 * one / high })));
      Object.assign(kept, { key: load.key, unit: found[2], ranged: !!range });
      words.textContent = load.key;
      slider.setAttribute("aria-label", `${load.key} of pair ${pair}`);
      slider.value = 100 * number / kept.base;
      value.textContent = load.text;
    };
    return kept;
  }

  fegearFigure.dark.addEventListener("change", () => { for (const kept of shown.values()) for (const one of kept.plots.values()) one.draw(); });
  async function show({ pairs }, { made, sections }) {
    for (const [pair, kept] of shown) {
      if (!(pair in pairs) || !kept.host.isConnected) { fegearFigure.drop(kept.map); fegearMiddle.remove(pair); shown.delete(pair); sections.delete(`hand map ${pair}`); }
    }
    for (const [pair, content] of Object.entries(pairs)) {
      if (!shown.has(pair)) {
        const host = made("section", "hand");
        host.dataset.pair = pair;
        host.append(made("h2", "", `Pair ${pair} by hand`));
        const kept = { host, plots: new Map(), shown: new Map(), remarks: [] };
        kept.mesh = meshOf(pair, host);
        kept.load = loadOf(pair, host.querySelector(".mesh-tools"));
        kept.map = made("div", "map");
        kept.map.append(made("div", "figures"));
        document.getElementById("maps").append(kept.map);
        kept.reliefs = made("div", "reliefs");
        kept.tools = made("p", "tools pair-tools");
        host.append(kept.reliefs, kept.tools);
        fegearMiddle.add(pair, host, `pair ${pair}`, () => fegearGlance.choose(pair));
        shown.set(pair, kept);
      }
      const kept = shown.get(pair);
      kept.mesh.set(content.mesh);
      if (!content.reliefs) continue; // gears alone, while a value moves
      kept.load.set(content.load);
      const { tools } = kept, offered = content.load ? `${!!content.designs} ${content.reliefs.length}` : "";
      if (kept.offered !== offered) tools.replaceChildren(...(!content.designs && content.load ? [
        Object.assign(document.createElement("span"), { className: "quiet", textContent: "Available for plane (2D) teeth only; for 3D gears (tip relief, lead crowning, helix slope) use the result flank-design." }),
      ] : content.reliefs.length === 1 && content.load ? [
        button("Create a separate driven gear", "Driver and driven are one gear of the case; relief by theory gives each its own", () => emitEvent("name_driven", { pair })),
      ] : content.reliefs.length > 1 && content.load ? [
        button("Design for zero transmission error", "Profile modification of both gears for zero transmission error at this load (Mark, Eq. 4.6), stored as tables", () => emitEvent("design", { pair, how: "exact" })),
        button("Best grindable tip relief", "Linear or parabolic tip relief of both gears with minimum transmission error at this load", () => emitEvent("design", { pair, how: "ground" })),
      ] : []));
      kept.offered = offered;
      for (const relief of content.reliefs) {
        const { key } = relief.figure, text = JSON.stringify(relief);
        if (kept.shown.get(key) === text) continue;
        kept.shown.set(key, text);
        if (!kept.plots.has(key)) kept.plots.set(key, reliefOf(kept.reliefs, relief));
        const one = kept.plots.get(key);
        if (!(held && one.layer.contains(held))) one.relief = relief; // in the hand it is newer than any answer
        else kept.shown.delete(key);
        one.draw();
        reliefTools(one.figure, relief);
      }
      for (const [key, one] of kept.plots) {
        if (content.reliefs.some((other) => other.figure.key === key)) continue;
        one.watch.disconnect();
        one.figure.remove();
        kept.shown.delete(key);
        kept.plots.delete(key);
      }
    }
    fegearGlance.hands(pairs);
  }
  // ---- the Harris map: made at rest, its present load followed while the slider moves -----------------------------------
  async function harris({ pairs }, { paint, sections }) {
    fegearGlance.halved(pairs);
    for (const [pair, kept] of shown) {
      const content = pairs[pair], key = `hand map ${pair}`;
      if (!content) { [...kept.map.querySelectorAll("figure")].forEach(fegearFigure.drop); sections.delete(key); kept.now = null; continue; }
      const section = sections.get(key) ?? { element: kept.map, specs: new Map(), shown: new Map(), darker: {} };
      sections.set(key, section);
      section.darker = content.darker;
      const { figure } = content, text = JSON.stringify(figure);
      kept.now = { label: content.now, key: figure.key, section };
      if (section.shown.get(figure.key) === text) continue;
      section.shown.set(figure.key, text);
      section.specs.set(figure.key, figure);
      await paint(section, figure.key);
    }
  }
  function follow({ pair, load, x, te }) {
    const kept = shown.get(pair), plot = kept?.now && kept.map.querySelector(".js-plotly-plot");
    if (!plot) return;
    const at = plot.data.flatMap((one, i) => one.name === kept.now.label ? [i] : []);
    if (at.length !== 2) return;
    kept.now.section.shown.delete(kept.now.key); // it is another figure now, though it may come back to what it was
    return Plotly.restyle(plot, { x: [x, [load]], y: [te, [Math.max(...te) - Math.min(...te)]] }, at);
  }
  /** Puts a remark to the pair that it is about, folded; false where there is none. */
  function remark(subject, words, made) {
    const kept = shown.get(subject) ?? [...shown.values()].find((one) => [...one.plots.values()].some(({ relief }) => relief.gear === subject));
    if (!kept) return false;
    let fold = kept.host.querySelector(".hand-remarks");
    if (!fold) {
      fold = made("details", "hand-remarks");
      fold.append(made("summary"), made("ul"));
      kept.host.querySelector(".mesh-stage").append(fold);
    }
    const list = fold.querySelector("ul");
    if (![...list.children].some((one) => one.textContent === words)) list.append(made("li", "", words));
    fold.querySelector("summary").textContent = `${list.children.length} ${list.children.length === 1 ? "note" : "notes"}`;
    return true;
  }
  return { show, harris, follow, remark, of: (subject) => shown.has(subject) };
})();
