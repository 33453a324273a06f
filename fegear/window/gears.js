"use strict";
// The gears in mesh, drawn true to shape: they turn through the path of contact, with the loads of the tooth pairs.
const fegearGears = (() => {
  const SVG = "http://www.w3.org/2000/svg";
  const shown = new Map(); // pair -> what is drawn of it
  const loadsOf = new Map(); // pair -> { x, load }

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
    shown.set(pair, kept);
    return kept;
  }
  return {
    button,
    meshOf,
    loads({ pair, x, load }) { loadsOf.set(pair, { x, load }); shown.get(pair)?.draw(); },
  };
})();
