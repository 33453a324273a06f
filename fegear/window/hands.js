"use strict";
// What is changed by hand beside the form: the gears in mesh turn, points of reliefs are dragged, the load slides.
const fegearHands = (() => {
  const SVG = "http://www.w3.org/2000/svg";
  const shown = new Map(); // pair -> { host, mesh, load }
  const loadsOf = new Map(); // pair -> { x, load }
  const EVERY = 100; // ms between two changes while something is moved
  let held = null; // what the pointer holds

  const svg = (tag, attributes, parent) => {
    const one = document.createElementNS(SVG, tag);
    for (const [name, value] of Object.entries(attributes)) one.setAttribute(name, value);
    parent?.append(one);
    return one;
  };
  const button = (words, title, pressed) => {
    const one = document.createElement("button");
    Object.assign(one, { type: "button", className: "button", textContent: words, title, onclick: pressed });
    return one;
  };
  function throttled(send) { // at most one change in EVERY ms, and always the last one
    let next = 0, waiting = null;
    return (content) => {
      clearTimeout(waiting);
      const wait = Math.max(0, next - performance.now());
      const now = () => { next = performance.now() + EVERY; send(content); };
      if (content.moving && wait > 0) waiting = setTimeout(now, wait); else now();
    };
  }

  // ---- gears in mesh ----------------------------------------------------------------------------------------------
  function meshOf(pair, host) {
    const kept = { place: 0, playing: false, data: null };
    const picture = svg("svg", { class: "mesh", role: "img", "aria-label": `Gears of pair ${pair} in mesh` });
    const tools = document.createElement("p");
    tools.className = "mesh-tools";
    const scrub = Object.assign(document.createElement("input"), { type: "range", min: 0, max: 1000, value: 0 });
    scrub.setAttribute("aria-label", "Roll position");
    const play = button("Play", "Turn the gears", () => { kept.playing = !kept.playing; play.textContent = kept.playing ? "Pause" : "Play"; if (kept.playing) requestAnimationFrame(turn); });
    const step = (way) => () => { kept.place = (kept.place + way * 0.05 + 2) % 1; draw(); };
    const told = document.createElement("span");
    told.className = "quiet";
    tools.append(play, button("◀", "A step back", step(-1)), button("▶", "A step on", step(1)), scrub, told);
    scrub.oninput = () => { kept.place = scrub.value / 1000; draw(); };
    host.append(picture, tools);
    let last = 0;
    function turn(time) {
      if (!kept.playing || !picture.isConnected) return;
      kept.place = (kept.place + Math.min(100, time - last) / 6000) % 1; // a base pitch in six seconds
      last = time;
      draw();
      requestAnimationFrame(turn);
    }
    kept.set = (data) => {
      if (!data) return;
      if (JSON.stringify(data) === JSON.stringify(kept.data)) return draw();
      kept.data = data;
      const m = data.module * 1e3, wide = Math.max(6 * m, 1.3e3 * Math.max(-data.start, data.end)), tall = 3.2 * m;
      picture.replaceChildren();
      picture.setAttribute("viewBox", `${-wide} ${-tall} ${2 * wide} ${2 * tall}`);
      kept.unit = m;
      const up = svg("g", { transform: "scale(1,-1)" }, picture);
      const line = (points) => `M${points[0].map((x, i) => `${(x * 1e3).toFixed(4)},${(points[1][i] * 1e3).toFixed(4)}`).join("L")}`;
      kept.driver = svg("path", { d: line(data.driver), class: "driver" }, up);
      kept.driven = svg("path", { d: line(data.driven), class: "driven" }, up);
      const c = Math.cos(data.pressure_angle), s = Math.sin(data.pressure_angle), a = data.start * 1e3, e = data.end * 1e3;
      svg("line", { x1: a * c, y1: a * s, x2: e * c, y2: e * s, class: "path" }, up);
      for (const [letter, x] of data.points) {
        svg("circle", { cx: x * 1e3 * c, cy: x * 1e3 * s, r: 0.07 * m, class: "point" }, up);
        const word = svg("text", { x: x * 1e3 * c + 0.12 * m, y: -x * 1e3 * s - 0.12 * m, "font-size": 0.36 * m }, picture);
        word.textContent = letter.replace(/_\{(.*)\}/, "$1");
      }
      kept.arrows = svg("g", {}, up);
      draw();
    };
    function loadAt(x) {
      const table = loadsOf.get(pair);
      if (!table || x < table.x[0] || x > table.x[table.x.length - 1]) return null;
      let i = table.x.findIndex((one) => one > x);
      if (i < 0) i = table.x.length - 1;
      const h = table.x[i] - table.x[i - 1];
      return h > 0 ? table.load[i - 1] + (table.load[i] - table.load[i - 1]) * (x - table.x[i - 1]) / h : table.load[i];
    }
    function draw() {
      const d = kept.data;
      if (!d) return;
      scrub.value = Math.round(kept.place * 1000);
      const first = d.start + kept.place * d.base_pitch; // the pair that came into contact last
      const degrees = (x, base) => x / base * 180 / Math.PI;
      kept.driver.setAttribute("transform", `rotate(${-degrees(first, d.driver_base)} 0 ${-d.driver_radius * 1e3})`);
      kept.driven.setAttribute("transform", `rotate(${degrees(first, d.driven_base)} 0 ${d.driven_radius * 1e3})`);
      kept.arrows.replaceChildren();
      const c = Math.cos(d.pressure_angle), s = Math.sin(d.pressure_angle), found = [];
      const largest = Math.max(...(loadsOf.get(pair)?.load ?? [1]));
      for (let k = -1; first + k * d.base_pitch <= d.end + d.base_pitch; k += 1) {
        const x = first + k * d.base_pitch, load = loadAt(x), on = x >= d.start && x <= d.end;
        if (!on && !(load > 0)) continue;
        const px = x * 1e3 * c, py = x * 1e3 * s;
        svg("circle", { cx: px, cy: py, r: 0.13 * kept.unit, class: "contact" }, kept.arrows);
        if (load > 0) {
          const length = 2.6 * kept.unit * load / largest, tip = 0.22 * kept.unit;
          const qx = px + length * c, qy = py + length * s;
          svg("line", { x1: px, y1: py, x2: qx, y2: qy, class: "load" }, kept.arrows);
          svg("path", { d: `M${qx + tip * c},${qy + tip * s}L${qx - 0.5 * tip * s},${qy + 0.5 * tip * c}L${qx + 0.5 * tip * s},${qy - 0.5 * tip * c}Z`, class: "load-tip" }, kept.arrows);
          found.push(`${load.toPrecision(4)} N at x = ${(x * 1e3).toFixed(3)} mm`);
        }
      }
      told.textContent = found.length ? found.join(", ") : `roll position ${(first * 1e3).toFixed(3)} mm`;
    }
    kept.draw = draw;
    return kept;
  }

  // ---- reliefs ----------------------------------------------------------------------------------------------------
  const sendRelief = throttled((content) => emitEvent("relief", content));
  function placeHandles(figure, relief) {
    const plot = figure.querySelector(".plot"), layout = plot._fullLayout;
    let layer = plot.querySelector(".handles");
    if (!layer) { layer = document.createElement("div"); layer.className = "handles"; plot.append(layer); }
    const wanted = relief.handles.flatMap((handle) => [{ handle, part: "start" }, { handle, part: "amount" }]);
    const buttons = [...layer.children];
    while (buttons.length > wanted.length) buttons.pop().remove();
    wanted.forEach(({ handle, part }, i) => {
      let one = buttons[i];
      if (!one) { one = document.createElement("button"); one.type = "button"; layer.append(one); }
      one.className = `handle ${part}`;
      one.dataset.handle = `${relief.gear} ${handle.end} ${part}`;
      const value = () => part === "start" ? `${handle.start.toFixed(3)} deg` : `${handle.amount.toFixed(2)} µm`;
      one.setAttribute("aria-label", `${handle.end} relief of gear ${relief.gear}: ${part}, ${value()}`);
      one.title = `${handle.end} relief, ${part}: ${value()}; drag it, or use the arrow keys`;
      const put = () => {
        const x = part === "start" ? handle.start : handle.at, y = part === "start" ? 0 : handle.amount;
        one.style.left = `${layout.xaxis._offset + layout.xaxis.l2p(x)}px`;
        one.style.top = `${layout.yaxis._offset + layout.yaxis.l2p(y)}px`;
      };
      const send = (moving) => sendRelief({ gear: relief.gear, end: handle.end, start: handle.start, amount: handle.amount, moving });
      const room = 0.01 * (relief.high - relief.low);
      const within = () => {
        const ends = handle.end === "tip" ? [relief.low, Math.min(handle.at, relief.high) - room] : [Math.max(handle.at, relief.low) + room, relief.high];
        handle.start = Math.min(Math.max(handle.start, ends[0]), ends[1]);
        handle.amount = Math.max(handle.amount, 0);
      };
      one.onpointerdown = (event) => { one.setPointerCapture(event.pointerId); held = one; event.preventDefault(); one.focus(); };
      one.onpointermove = (event) => {
        if (held !== one) return;
        const box = plot.getBoundingClientRect(), now = plot._fullLayout;
        if (part === "start") handle.start = now.xaxis.p2l(event.clientX - box.x - now.xaxis._offset);
        else handle.amount = now.yaxis.p2l(event.clientY - box.y - now.yaxis._offset);
        within(); put(); send(true);
      };
      one.onpointerup = () => { if (held === one) { held = null; send(false); } };
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
  function reliefTools(figure, relief) {
    let tools = figure.querySelector(".tools");
    if (!tools) { tools = document.createElement("p"); tools.className = "tools"; figure.append(tools); }
    tools.replaceChildren();
    for (const end of ["tip", "root"]) {
      if (relief.given.includes(end)) continue;
      tools.append(button(`Add ${end} relief`, "10 µm from the usual point", () => emitEvent("relief", {
        gear: relief.gear, end, start: relief.usual[end], amount: 10, moving: false })));
    }
    if (relief.given.length) tools.append(button("Without relief", "Leave the relief of this gear out", () => emitEvent("drop", { gear: relief.gear })));
    if (relief.given.length && !relief.on) tools.append(Object.assign(document.createElement("span"), { className: "quiet", textContent: "The effect relief is off: it changes no result." }));
  }

  // ---- load -------------------------------------------------------------------------------------------------------
  const sendLoad = throttled((content) => emitEvent("load", content));
  function loadOf(pair, host) {
    const label = document.createElement("label"), slider = Object.assign(document.createElement("input"), { type: "range", min: 2, max: 200, value: 100 });
    const words = document.createElement("span"), value = document.createElement("b");
    label.className = "load-slider";
    slider.dataset.slider = pair;
    label.append(words, slider, value);
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
      if (kept.key !== load.key || kept.unit !== found[2] || number > 2 * kept.base || number < 0.02 * kept.base) kept.base = number;
      Object.assign(kept, { key: load.key, unit: found[2] });
      words.textContent = `${load.key} of pair ${pair}`;
      slider.value = 100 * number / kept.base;
      value.textContent = load.text;
    };
    return kept;
  }

  async function show({ pairs }, { made, paint, sections }) {
    for (const [pair, kept] of shown) {
      if (!(pair in pairs) || !kept.host.isConnected) { kept.host.remove(); shown.delete(pair); sections.delete(`hand ${pair}`); }
    }
    for (const [pair, content] of Object.entries(pairs)) {
      if (!shown.has(pair)) {
        const host = made("section", "task hand");
        host.append(made("h2", "", `Pair ${pair} by hand`));
        const kept = { host };
        kept.mesh = meshOf(pair, host);
        kept.load = loadOf(pair, host);
        host.append(made("div", "figures"), made("p", "tools pair-tools"));
        document.getElementById("hands").append(host);
        shown.set(pair, kept);
        sections.set(`hand ${pair}`, { element: host, specs: new Map(), shown: new Map(), darker: {} });
      }
      const kept = shown.get(pair), section = sections.get(`hand ${pair}`);
      kept.mesh.set(content.mesh);
      kept.load.set(content.load);
      const tools = kept.host.querySelector(".pair-tools");
      tools.replaceChildren(...(content.reliefs.length > 1 && content.load ? [button("Remove the transmission error", "Reliefs of both gears that leave none at this load (Mark, Eq. 4.6)", () => emitEvent("design", { pair }))] : []));
      for (const relief of content.reliefs) {
        const key = relief.figure.key, text = JSON.stringify(relief);
        if (section.shown.get(key) === text) continue;
        section.shown.set(key, text);
        section.darker = { ...section.darker, ...relief.darker };
        section.specs.set(key, relief.figure);
        await paint(section, key);
        const figure = [...kept.host.querySelectorAll("figure")].find((one) => one.dataset.key === key);
        const plot = figure.querySelector(".plot");
        if (!(held && figure.contains(held))) placeHandles(figure, relief);
        reliefTools(figure, relief);
        plot.removeAllListeners?.("plotly_afterplot");
        plot.on?.("plotly_afterplot", () => { if (!held) placeHandles(figure, relief); });
      }
      for (const figure of [...kept.host.querySelectorAll(".figures figure")]) {
        if (!content.reliefs.some((one) => one.figure.key === figure.dataset.key)) figure.remove();
      }
    }
  }
  return { show, loads({ pair, x, load }) { loadsOf.set(pair, { x, load }); shown.get(pair)?.mesh.draw(); } };
})();
