"use strict";
// The gears in mesh, drawn true to shape: they turn through the path of contact, with the loads of the tooth pairs.
const fegearGears = (() => {
  const SVG = "http://www.w3.org/2000/svg";
  const shown = new Map(); // pair -> what is drawn of it
  const loadsOf = new Map(); // pair -> { x, load }
  const KINDS = { // what can be switched on
    stress: ["Root stress", "Root stress along the fillets of all teeth, in colour"],
    deformed: ["Deformed", "Deformed teeth (displacements magnified)"],
    tool: ["Tool", "Positions of the rack tool that generates the teeth, in one tooth space of each gear"],
  };

  const FINE = 1e-4; // mm: outlines are whole numbers of it, which are written four times as fast as decimals

  const svg = (tag, attributes, parent) => {
    const one = document.createElementNS(SVG, tag);
    for (const [name, value] of Object.entries(attributes)) one.setAttribute(name, value);
    parent?.append(one);
    return one;
  };
  const digits = (value, count) => String(Number(value.toPrecision(count))); // 10100, where toPrecision writes 1.010e+4
  const button = (words, title, pressed) => {
    const one = document.createElement("button");
    Object.assign(one, { type: "button", className: "button", textContent: words, title, onclick: pressed });
    return one;
  };

  function meshOf(pair, host) {
    const kept = { place: 0, playing: false, data: null, on: {}, sent: {}, factor: null, room: { width: 0, height: 0 } };
    const stage = document.createElement("div"), canvas = document.createElement("canvas"), inside = document.createElement("canvas");
    stage.className = "mesh-stage";
    inside.className = "inside";
    const picture = svg("svg", { class: "mesh", role: "img", "aria-label": `Gears of pair ${pair} in mesh` });
    stage.append(inside, canvas, picture);
    const tools = document.createElement("p");
    tools.className = "mesh-tools";
    const scrub = Object.assign(document.createElement("input"), { type: "range", min: 0, max: 1000, value: 0 });
    scrub.setAttribute("aria-label", "Roll position");
    const play = button("Play", "Turn the gears", () => { kept.playing = !kept.playing; play.textContent = kept.playing ? "Pause" : "Play"; if (kept.playing) requestAnimationFrame(turn); });
    const step = (way) => () => { kept.place = (kept.place + way * 0.05 + 2) % 1; draw(); };
    const told = document.createElement("span");
    told.className = "loads";
    const large = button("Enlarge", "Gears only", () => {
      const on = host.classList.toggle("large");
      large.textContent = on ? "Back" : "Enlarge";
      large.setAttribute("aria-pressed", String(on));
    });
    const back = button("◀", "Previous position", step(-1)), on = button("▶", "Next position", step(1));
    back.setAttribute("aria-label", "Previous position");
    on.setAttribute("aria-label", "Next position");
    tools.append(play, back, on, scrub, large);
    scrub.oninput = () => { kept.place = scrub.value / 1000; draw(); };
    const more = layersOf(pair, kept, () => draw());
    stage.append(told, more.scales);
    host.append(...more.flanks, stage, tools, ...more.elements);
    let last = 0;
    const frames = kept.frames = []; // when they were drawn [ms]
    function turn(time) {
      if (!kept.playing || !picture.isConnected) return;
      frames.push(time);
      if (frames.length > 200) frames.shift();
      kept.place = (kept.place + Math.min(100, time - last) / 6000) % 1; // a base pitch in six seconds
      last = time;
      draw();
      requestAnimationFrame(turn);
    }
    kept.set = (data) => {
      if (!data) return;
      more.allow(data.refused ?? {});
      if (JSON.stringify(data) === JSON.stringify(kept.data)) return draw();
      if (kept.data) kept.old = kept.sent.field; // stress inside other teeth
      kept.data = data;
      const m = data.module * 1e3, wide = Math.max(6 * m, 1.3e3 * Math.max(-data.start, data.end)), tall = 3.2 * m;
      picture.replaceChildren();
      picture.setAttribute("viewBox", `${-wide} ${-tall} ${2 * wide} ${2 * tall}`);
      kept.unit = m;
      kept.view = { wide, tall, data };
      const up = svg("g", { transform: "scale(1,-1)" }, picture);
      const line = (member, centre) => { // teeth are alike: one is sent, the others are turned from it
        const [xs, ys] = data[member].map((all) => all.map((one) => one * 1e3 / FINE)), [count, turn] = data.rows[member];
        let text = "M";
        for (let k = -count; k <= count; k += 1) {
          const cosine = Math.cos(k * turn), sine = Math.sin(k * turn);
          for (let i = 0; i < xs.length; i += 1) {
            const y = ys[i] - centre;
            text += `${i || k > -count ? "L" : ""}${Math.round(cosine * xs[i] - sine * y)},${Math.round(sine * xs[i] + cosine * y + centre)}`;
          }
        }
        return text;
      };
      kept.driver = svg("path", { d: line("driver", -1e3 / FINE * data.driver_radius), class: "driver" }, up);
      kept.driven = svg("path", { d: line("driven", 1e3 / FINE * data.driven_radius), class: "driven" }, up);
      const c = Math.cos(data.pressure_angle), s = Math.sin(data.pressure_angle), a = data.start * 1e3, e = data.end * 1e3;
      svg("line", { x1: a * c, y1: a * s, x2: e * c, y2: e * s, class: "path" }, up);
      let beside = -Infinity; // letters of points close to each other stand apart
      for (const [letter, x] of data.points) {
        svg("circle", { cx: x * 1e3 * c, cy: x * 1e3 * s, r: 0.07 * m, class: "point" }, up);
        const below = letter === "C"; // B and D may be close to it
        if (!below) beside = Math.max(x * 1e3 * c + 0.12 * m, beside + 0.36 * m);
        const word = svg("text", { x: below ? x * 1e3 * c + 0.08 * m : beside, y: -x * 1e3 * s + (below ? 0.5 : -0.26) * m, "font-size": 0.36 * m }, picture);
        word.textContent = letter.replace(/_\{(.*)\}/, "$1");
      }
      fegearCircles.draw(data, up, picture, { wide, tall, unit: m });
      kept.arrows = svg("g", {}, up);
      draw();
    };
    function overFace(k) { // load of pair k of gears with a width; after the last roll position it is the next pair's again
      const { roll, pairs, load } = kept.sent.pressure, at = (i) => {
        const turn = Math.floor(i / roll.length), row = pairs.indexOf(k + turn);
        return [roll[i - turn * roll.length] + turn, row < 0 ? 0 : load[row][i - turn * roll.length]];
      };
      let i = roll.findIndex((one) => one > kept.place);
      if (i < 0) i = roll.length;
      const [before, a] = at(i - 1), [after, b] = at(i);
      const span = after - before; // two positions may stand at one jump
      return span > 1e-6 ? a + (b - a) * Math.max(0, Math.min(1, (kept.place - before) / span)) : b;
    }
    function loadAt(x, k) {
      const table = loadsOf.get(pair);
      if (!table && kept.sent.pressure) return overFace(k);
      if (!table || x < table.x[0] || x > table.x[table.x.length - 1]) return null;
      let i = table.x.findIndex((one) => one > x);
      if (i < 0) i = table.x.length - 1;
      const h = table.x[i] - table.x[i - 1];
      // Both sides of a jump are a hair apart; point A is in between for the pair at D: it has the load after the jump.
      return h > 1e-6 * kept.data.base_pitch ? table.load[i - 1] + (table.load[i] - table.load[i - 1]) * (x - table.x[i - 1]) / h : table.load[i];
    }
    function draw() {
      const d = kept.data;
      if (!d) return;
      scrub.value = Math.round(kept.place * 1000);
      const layers = fegearGlance.hides() ? { ...more.now(), stress: null, deformed: null } : more.now(), off = layers.z * 1e-3 * d.twist; // the section at z stands so far behind the middle of the face
      picture.classList.toggle("at-rest", !!layers.deformed);
      picture.classList.toggle("circled", !!fegearGlance.view().circles);
      const field = layers.deformed || kept.sent.field === kept.old ? null : kept.sent.field, loads = fegearField.loaded(d, kept.place, loadAt);
      fegearField.draw(inside, kept.room, kept.view, field, { place: kept.place, loadAt, limit: more.limit(), measure: more.measure() });
      picture.classList.toggle("filled", !!field);
      fegearLayers.gears(canvas, kept.room, kept.view, layers);
      fegearGlance.at(pair, d, kept.place, loads);
      more.draw();
      const first = d.start + kept.place * d.base_pitch; // the pair that came into contact last
      const degrees = (x, base) => x / base * 180 / Math.PI;
      fegearPlots.set(kept.driver, { transform: `rotate(${-degrees(first - off, d.driver_base)} 0 ${-d.driver_radius * 1e3}) scale(${FINE})` });
      fegearPlots.set(kept.driven, { transform: `rotate(${degrees(first - off, d.driven_base)} 0 ${d.driven_radius * 1e3}) scale(${FINE})` });
      const arrows = fegearPlots.pen(kept.arrows);
      const c = Math.cos(d.pressure_angle), s = Math.sin(d.pressure_angle), found = [];
      const largest = Math.max(...(loadsOf.get(pair)?.load ?? kept.sent.pressure?.load.flat() ?? [1]));
      for (let k = -6; first + k * d.base_pitch <= d.end + 6 * d.base_pitch; k += 1) {
        const x = first + k * d.base_pitch, load = loadAt(x, k), moved = x - off, on = moved >= d.start && moved <= d.end;
        if (!on && !(load > 0)) continue;
        const beside = !on && kept.sent.pressure && d.twist; // the contact line of a helical pair stands elsewhere on the face
        const at = beside ? Math.min(Math.max(moved, d.start), d.end) : moved;
        const [px, py] = fegearLayers.contactMoved(d, layers, k, at * 1e3 * c, at * 1e3 * s);
        if (!beside) arrows("circle", { cx: px, cy: py, r: 0.13 * kept.unit, class: "contact" });
        if (load > 0) {
          const length = 2.6 * kept.unit * load / largest, tip = 0.22 * kept.unit;
          const qx = px + length * c, qy = py + length * s;
          const look = beside ? " beside" : "";
          arrows("line", { x1: px, y1: py, x2: qx, y2: qy, class: `load${look}` });
          arrows("path", { d: `M${qx + tip * c},${qy + tip * s}L${qx - 0.5 * tip * s},${qy + 0.5 * tip * c}L${qx + 0.5 * tip * s},${qy - 0.5 * tip * c}Z`, class: `load-tip${look}` });
          const [letter] = d.points.find(([, point]) => Math.abs(point - x) < 2e-3 * d.base_pitch) ?? [], here = `x = ${(x * 1e3).toFixed(2)} mm`.replace("-", "−");
          found.push(`${digits(load, 4)} N at ${letter ? `${letter.replace(/_\{(.*)\}/, "$1")} (${here})` : here}${beside ? " (pale: not in this section)" : ""}`);
        }
      }
      arrows.end();
      told.title = told.textContent = found.length ? found.join(", ") : `roll position ${(first * 1e3).toFixed(3)} mm`;
    }
    // Its size as it was laid out last: to ask for it has the page laid out in between.
    new ResizeObserver(([{ contentRect: { width, height } }]) => { kept.room = { width, height }; draw(); }).observe(stage);
    let due = 0; // at most once in a frame
    kept.soon = () => { due ||= requestAnimationFrame(() => { due = 0; draw(); }); };
    kept.draw = draw;
    kept.loadAt = loadAt;
    kept.take = more.take;
    kept.retell = () => { more.tell(); more.rest(); };
    kept.rest = more.rest;
    kept.again = more.again;
    kept.started = () => more.limit() > 0;
    kept.canvasIsThere = () => canvas.isConnected;
    shown.set(pair, kept);
    for (const content of waiting.get(pair)?.values() ?? []) kept.take(content);
    waiting.delete(pair);
    return kept;
  }

  // ---- what is switched on -----------------------------------------------------------------------------------------
  function layersOf(pair, kept, draw) {
    const switches = document.createElement("p"), told = document.createElement("p"), scale = document.createElement("p");
    const scales = document.createElement("div"), fieldScale = document.createElement("p");
    scales.className = "mesh-scales";
    fieldScale.className = "mesh-scale";
    scales.append(fieldScale, scale);
    fieldScale.hidden = true;
    const which = document.createElement("select"), whichLabel = document.createElement("label");
    whichLabel.className = "mesh-measure";
    for (const [value, words] of [...Object.entries(fegearField.MEASURES).map(([name, [words]]) => [name, words]), ["none", "no stress inside"]]) {
      which.append(Object.assign(document.createElement("option"), { value, textContent: words }));
    }
    which.setAttribute("aria-label", "Stress inside the teeth");
    which.title = "Stress inside the teeth, from the loads of all pairs and the solved gears; not shown on deformed teeth";
    which.value = fegearGlance.view().measure ?? "mises";
    which.onchange = () => { fegearGlance.keep({ measure: which.value }); rest(); };
    whichLabel.append(which);
    whichLabel.hidden = which.value !== "none"; // teeth by formulas have no stress inside
    let limit = 0;
    const measure = () => (which.value === "none" ? "mises" : which.value);
    function rest() { // the scale of the field, which stays while a value moves
      const field = kept.sent.field, shown = field && which.value !== "none" && kept.data;
      const wanted = shown ? fegearField.limitOf(field, kept.data, kept.loadAt, measure()) : 0;
      if (wanted !== limit || !shown) limit = wanted;
      fieldScale.hidden = !(limit > 0);
      if (field) whichLabel.hidden = false;
      if (limit > 0) {
        const title = document.createElement("span"), [words, signed] = fegearField.MEASURES[measure()], number = digits(limit, 3);
        title.textContent = `${words}:`;
        fieldScale.title = "The colour scale ends at the maximum fillet stress over the mesh cycle. In contacts the pressure is distributed over 0.3 modules; the Hertzian pressure, which is higher, is one of the values.";
        fieldScale.replaceChildren(title, ...bar(fegearField.stops(measure()), signed ? `−${number}` : "0", number, "MPa"));
      }
      kept.soon();
    }
    switches.append(whichLabel);
    const flanks = document.createElement("canvas"), pressed = document.createElement("p");
    switches.className = "mesh-tools";
    told.className = "quiet mesh-told";
    pressed.className = "quiet mesh-pressed";
    scale.className = "mesh-scale";
    flanks.className = "flanks";
    flanks.setAttribute("role", "img");
    flanks.setAttribute("aria-label", `A tooth of either gear of pair ${pair} with the pressure on its flank and the contact lines`);
    const turned = fegearFlanks.turns(flanks, draw);
    scale.hidden = flanks.hidden = pressed.hidden = true;
    const buttons = {};
    for (const [kind, [words, title]] of Object.entries(KINDS)) {
      buttons[kind] = button(words, title, () => turn(kind, !kept.on[kind]));
      buttons[kind].setAttribute("aria-pressed", "false");
      buttons[kind].dataset.shows = kind;
      switches.append(buttons[kind]);
    }
    const circles = button("Circles", "Pitch, base and tip circles, the line of action with its points of tangency, and the names of the gears", () => {
      fegearGlance.keep({ circles: !fegearGlance.view().circles });
      tell();
      draw();
    });
    switches.append(circles);
    const label = document.createElement("label"), words = document.createElement("span"), value = document.createElement("b");
    const slider = Object.assign(document.createElement("input"), { type: "range", min: 0, max: 300, value: 0 });
    slider.setAttribute("aria-label", "Displacement scale factor");
    label.className = "mesh-factor";
    label.hidden = true;
    words.textContent = "magnified";
    label.append(words, slider, value);
    const section = document.createElement("label"), at = document.createElement("b");
    const along = Object.assign(document.createElement("input"), { type: "range", min: 0, max: 200, value: 100 });
    along.setAttribute("aria-label", "Section along the face");
    section.className = "mesh-factor";
    section.hidden = true;
    section.append("section at z =", along, at);
    along.oninput = () => {
      const { z } = kept.sent.stress, { z: most } = kept.sent.stress.largest, free = z[0] + (z.at(-1) - z[0]) * along.value / 200;
      kept.z = Math.abs(free - most) < 0.004 * (z.at(-1) - z[0]) ? null : free; // it stays where stress is largest
      tell();
      draw();
    };
    const faced = () => { const stress = has("stress"); return stress?.z.length ? stress : null; };
    const sectionAt = () => { const one = faced(); return one ? Math.min(Math.max(kept.z ?? one.largest.z, one.z[0]), one.z.at(-1)) : 0; };
    switches.append(section, label);
    slider.oninput = () => {
      const power = 10 ** Math.floor(slider.value / 100), exact = 10 ** (slider.value / 100);
      kept.factor = Math.min(1000, Math.round(exact / power * 10) / 10 * power);
      tell();
      draw();
    };
    const factor = () => kept.factor ?? kept.sent.deformed?.factor ?? 1;
    let vain = {}; // kind -> why it cannot be had of this pair
    function allow(refused) { // what is on stays a button, to be switched off
      vain = refused;
      for (const [kind, [, title]] of Object.entries(KINDS)) {
        const why = fegearGlance.hides() && kind !== "tool" ? "Hidden until the answers are shown." : vain[kind];
        buttons[kind].disabled = why !== vain[kind] || (!!why && !kept.on[kind]);
        buttons[kind].title = why ? `${title}. ${why}` : title;
      }
    }
    function turn(kind, on) {
      kept.on[kind] = on;
      allow(vain);
      buttons[kind].setAttribute("aria-pressed", String(on));
      emitEvent("shows", { pair, kind, on });
      tell();
      draw();
    }
    const has = (kind) => (kept.on[kind] && kept.sent[kind] && !kept.sent[kind].refused ? kept.sent[kind] : null);
    function bar(stops, low, high, unit) { // a scale of colours with its ends
      const strip = document.createElement("i"), ends = [low, high].map((one) => {
        const end = document.createElement("span");
        end.textContent = `${one} ${unit}`;
        return end;
      });
      strip.style.background = `linear-gradient(to right, ${stops.join()})`;
      return [ends[0], strip, ends[1]];
    }
    function tell() {
      const stress = has("stress"), deformed = has("deformed"), lines = [];
      scale.hidden = !stress;
      section.hidden = !faced();
      label.hidden = !kept.on.deformed;
      if (stress) {
        const { largest, limit } = stress, number = digits(limit, 4), title = document.createElement("span");
        title.textContent = "tangential root stress:";
        scale.replaceChildren(title, ...bar(fegearLayers.stops("stress"), `−${number}`, number, "MPa"));
        const wide = faced(), where = wide ? `, z = ${largest.z.toFixed(3)} mm` : "";
        const touches = wide ? "contact line crosses mid-face" : "contact is";
        lines.push(`Maximum root stress (tension side) over the mesh cycle${wide ? " and the face" : ""}: ${digits(largest.value, 5)} MPa in the ${largest.member} gear, at radius `
          + `${largest.radius.toFixed(3)} mm${where} when its ${touches} at x = ${largest.x.toFixed(3)} mm (circled).`);
        if (wide) {
          const span = wide.z.at(-1) - wide.z[0];
          along.value = Math.round(200 * (sectionAt() - wide.z[0]) / span);
          at.textContent = `${sectionAt().toFixed(2)} mm`;
          lines.push("The gears are drawn in the section at z (thin line over the flanks); stress is that along the section. Arrows are the loads of whole tooth pairs, x that of their contact lines in the middle of the face.");
        }
      }
      if (deformed) {
        slider.value = Math.round(100 * Math.log10(factor()));
        value.textContent = `${factor()} ×`;
        lines.push(`Displacements, transmission error and relief are drawn ${factor()} times as large (largest: `
          + `${digits(deformed.largest, 3)} µm); pale lines: unloaded gears. Loaded flanks are in contact at the dots; `
          + "elsewhere flanks may appear to overlap, because gaps are not magnified.");
      }
      if (has("tool")) lines.push("The profile is the envelope of the tool's positions.");
      const circled = !!fegearGlance.view().circles;
      circles.setAttribute("aria-pressed", String(circled));
      if (circled) lines.push(fegearCircles.words);
      for (const kind of Object.keys(KINDS)) {
        if (!kept.on[kind]) continue;
        if (kept.sent[kind]?.refused) lines.push(`${KINDS[kind][0]}: ${kept.sent[kind].refused}`);
        else if (!kept.sent[kind]) lines.push(`${KINDS[kind][0]}: comes with the next results.`); // at once, or when the case holds
      }
      told.textContent = lines.join(" ");
      told.hidden = !lines.length;
      const pressure = kept.sent.pressure;
      flanks.hidden = pressed.hidden = !pressure;
      whichLabel.hidden = !kept.sent.field && !!kept.data?.wide;
      if (pressure) {
        const title = document.createElement("span");
        title.textContent = "Hertzian pressure:";
        pressed.replaceChildren(title, ...bar(fegearLayers.stops("pressure"), "0", digits(pressure.limit, 4), "MPa"), now);
      }
    }
    const now = document.createElement("span");
    pressed.classList.add("mesh-scale");
    return {
      tell,
      allow,
      again: () => allow(vain),
      flanks: [flanks, pressed],
      elements: [switches, told],
      scales,
      rest,
      limit: () => limit,
      measure,
      now: () => ({ place: kept.place, factor: factor(), stress: has("stress"), deformed: has("deformed"), tool: has("tool"), z: sectionAt() }),
      draw() {
        const pressure = kept.sent.pressure;
        if (!pressure || !kept.data) return;
        const largest = fegearFlanks.draw(flanks, kept.data, pressure, kept.place, turned);
        now.textContent = `up to ${digits(largest, 4)} MPa at this position; colours: maximum over the mesh cycle, excluding tips and form circles`;
      },
      take(content) {
        const { kind } = content, made = content.refused ? content : { stress: fegearLayers.stressOf, deformed: fegearLayers.deformedOf, field: fegearField.made }[kind]?.(content) ?? content;
        kept.sent[kind] = content.gone ? null : made;
        if (kind in KINDS && kept.on[kind] === undefined) { // a page that opened later
          kept.on[kind] = true;
          buttons[kind].setAttribute("aria-pressed", "true");
          allow(vain);
        }
        tell();
        if (kind === "field" && (!limit || !fegear.isMoving())) rest();
        kept.soon(); // stress, deformed teeth and loads of one answer come one after the other
      },
    };
  }
  const waiting = new Map(); // pair -> what was told of it before it was drawn
  function meshed(content) {
    if (shown.has(content.pair) && shown.get(content.pair).canvasIsThere()) return shown.get(content.pair).take(content);
    if (!waiting.has(content.pair)) waiting.set(content.pair, new Map());
    waiting.get(content.pair).set(content.kind, content);
  }
  fegearFigure.dark.addEventListener("change", () => { for (const kept of shown.values()) { kept.retell(); kept.draw(); } });
  return {
    button,
    meshOf,
    meshed,
    plan(tasks) { // what is computed no longer is shown no longer
      for (const [pair, kept] of shown) {
        for (const [kind, stage] of [["pressure", "loaded-flanks"], ["field", "stress-inside"]]) {
          if (kept.sent[kind] && !tasks.includes(`${stage} of ${pair}`)) kept.take({ kind, gone: true });
        }
      }
    },
    inside: (pair) => ({ field: shown.get(pair)?.sent.field, data: shown.get(pair)?.data, loadAt: shown.get(pair)?.loadAt }),
    frames: (pair) => shown.get(pair)?.frames ?? [],
    soon() { for (const kept of shown.values()) { kept.again(); kept.soon(); } }, // answers are shown or hidden
    rest() { for (const kept of shown.values()) kept.rest(); }, // nothing moves any more
    loads({ pair, x, load }) {
      loadsOf.set(pair, { x, load });
      const kept = shown.get(pair);
      if (kept && !kept.started()) kept.rest();
      kept?.soon();
    },
  };
})();
