"use strict";
// Cracked teeth under load: open, with stress in colour; the tip of a straight crack is dragged by the pointer or by keys.
const fegearCrack = (() => {
  const shown = new Map(); // gear -> its section
  const EVERY = 100; // ms between two changes while the tip is moved
  let held = null, next = 0, waiting = null;
  const made = (tag, className, text = "") => Object.assign(document.createElement(tag), { className, textContent: text });

  function send(content) { // at most one change in EVERY ms, and always the last one
    clearTimeout(waiting);
    const wait = Math.max(0, next - performance.now()), now = () => { next = performance.now() + EVERY; emitEvent("crack", content); };
    if (content.moving && wait > 0) waiting = setTimeout(now, wait); else now();
  }
  const across = (crack) => (crack.back ? 1 : -1);
  function polar({ crack, side }, x, y) { // of a tip: length [mm], angle to the centre line [deg]
    const dx = x - crack.path[0][0], dy = y - crack.path[1][0];
    return { depth: Math.hypot(dx, dy), angle: Math.atan2(across(crack) * dx, -side * dy) * 180 / Math.PI };
  }
  function tipOf({ crack, side }, { depth, angle }) {
    const a = angle * Math.PI / 180;
    return [crack.path[0][0] + across(crack) * depth * Math.sin(a), crack.path[1][0] - side * depth * Math.cos(a)];
  }
  function within(one, at) { // a tip inside the tooth: not shorter than a fiftieth of a module, clear of the next surface
    const angle = Math.min(Math.max(at.angle, 0), 135), a = angle * Math.PI / 180, { crack, side, module } = one;
    const x = crack.path[0][0], y = crack.path[1][0], wx = across(crack) * Math.sin(a), wy = -side * Math.cos(a), [xs, ys] = crack.outline;
    let most = 3 * module;
    for (let i = 0; i + 1 < xs.length; i += 1) {
      const ex = xs[i + 1] - xs[i], ey = ys[i + 1] - ys[i], cross = wx * ey - wy * ex;
      if (!cross) continue;
      const s = ((xs[i] - x) * ey - (ys[i] - y) * ex) / cross, t = ((xs[i] - x) * wy - (ys[i] - y) * wx) / cross;
      if (s > 0.05 * module && t >= 0 && t <= 1) most = Math.min(most, 0.95 * s);
    }
    return { depth: Math.min(Math.max(at.depth, 0.02 * module), most), angle };
  }

  function make(gear) {
    const host = made("section", "hand crack"), title = made("h2", ""), body = made("div", "crack-body"), canvas = made("canvas", ""), layer = made("div", "handles");
    const scale = made("p", "mesh-scale"), words = made("p", "crack-words"), tools = made("p", "mesh-tools"), label = made("label", "mesh-factor"), value = made("b", "");
    const slider = Object.assign(document.createElement("input"), { type: "range", min: 0, max: 300, value: 0 });
    host.dataset.gear = gear;
    canvas.setAttribute("role", "img");
    slider.setAttribute("aria-label", `Displacement scale factor of the cracked tooth of gear ${gear}`);
    label.append("magnified", slider, value);
    tools.append(label);
    body.append(canvas, layer);
    host.append(title, body, scale, words, tools);
    const kept = { gear, host, canvas, layer, scale, words, slider, value, at: 0, factor: null, room: { width: 0, height: 0 }, data: null, follow: null };
    slider.oninput = () => { kept.factor = 10 ** (slider.value / 100); kept.draw(); };
    kept.draw = () => draw(kept);
    const choice = made("select", "");
    choice.setAttribute("aria-label", `Cracked tooth of gear ${gear}`);
    choice.onchange = () => { kept.at = Number(choice.value); kept.follow = null; put(kept); };
    kept.choice = choice;
    tools.prepend(choice);
    new ResizeObserver(([{ contentRect: { width, height } }]) => { kept.room = { width, height }; kept.draw(); }).observe(body);
    return kept;
  }
  const now = (kept) => ({ crack: kept.data.cracks[kept.at], side: kept.data.side, module: kept.data.module });

  function placed(kept) { // millimetres to pixels: the tooth and some body fill the room
    const { crack: { outline: [xs, ys], points }, side, module } = now(kept), { width, height } = kept.room;
    const top = Math.max(...ys) + 0.15 * module, low = Math.min(...points[1]), half = Math.max(...xs.map(Math.abs)) + 0.1 * module;
    const high = side > 0 ? top : Math.max(...points[1]), bottom = side > 0 ? Math.max(low, Math.min(...ys) - 1.3 * module) : Math.min(...ys) - 0.15 * module;
    const scale = Math.min(width / (2 * half), height / (high - bottom));
    return { scale, x: (v) => width / 2 + scale * v, y: (v) => height / 2 - scale * (v - 0.5 * (high + bottom)), half };
  }
  function draw(kept) {
    const { canvas, room } = kept, context = canvas.getContext("2d"), ratio = devicePixelRatio || 1;
    const wide = Math.max(1, Math.round(room.width * ratio)), tall = Math.max(1, Math.round(room.height * ratio));
    if (canvas.width !== wide || canvas.height !== tall) Object.assign(canvas, { width: wide, height: tall });
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, wide, tall);
    if (!kept.data || room.width < 20) return;
    const one = now(kept), { crack } = one, view = placed(kept), factor = kept.factor ?? crack.factor, count = crack.points[0].length;
    const x = (n) => view.x(crack.points[0][n] + factor * crack.d[n]), y = (n) => view.y(crack.points[1][n] + factor * crack.d[count + n]);
    const image = context.createImageData(wide, tall), gear = { triangles: crack.triangles, px: new Float64Array(count), py: new Float64Array(count), value: crack.stress };
    for (let n = 0; n < count; n += 1) { gear.px[n] = ratio * x(n); gear.py[n] = ratio * y(n); }
    fegearField.fill(new Uint32Array(image.data.buffer), wide, tall, gear, fegearField.tableOf("mises"), 0, crack.limit);
    context.putImageData(image, 0, 0);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    const look = getComputedStyle(canvas), line = (points, style, width, dashes = []) => {
      context.strokeStyle = style; context.lineWidth = width; context.setLineDash(dashes); context.lineJoin = "round";
      context.beginPath();
      points.forEach(([px, py], i) => (i ? context.lineTo(px, py) : context.moveTo(px, py)));
      context.stroke();
    };
    const ink = look.getPropertyValue("--ink") || "#000", pale = look.getPropertyValue("--quiet") || "#888";
    line(crack.outline[0].map((v, i) => [view.x(v), view.y(crack.outline[1][i])]), pale, 1, [4, 3]);
    for (const face of crack.faces) line(face.map((n) => [x(n), y(n)]), ink, 1.6);
    const [cx, cy] = crack.contact; // the load, along the line of action
    context.fillStyle = ink;
    context.beginPath();
    context.arc(view.x(cx), view.y(cy), 4, 0, 2 * Math.PI);
    context.fill();
    if (kept.follow) { // while it is moved the line goes ahead of the answer
      const [tx, ty] = tipOf(one, kept.follow), ahead = Math.hypot(tx - crack.path[0].at(-1), ty - crack.path[1].at(-1));
      if (ahead > 0.005 * one.module) line([[view.x(crack.path[0][0]), view.y(crack.path[1][0])], [view.x(tx), view.y(ty)]], look.getPropertyValue("--accent") || "#06c", 2, [5, 3]);
    }
    kept.value.textContent = `${Number(factor.toPrecision(2))} ×`;
    kept.slider.value = Math.round(100 * Math.log10(factor));
    handle(kept, view);
    canvas.dataset.count = Number(canvas.dataset.count ?? 0) + 1;
  }
  function handle(kept, view) {
    const one = now(kept), { crack } = one;
    let knob = kept.layer.firstElementChild;
    if (crack.ends === "path") { knob?.remove(); return; }
    if (!knob) {
      knob = made("button", "handle crack-tip");
      knob.type = "button";
      kept.layer.append(knob);
    }
    const last = crack.path[0].length - 1, at = kept.follow ?? polar(one, crack.path[0][last], crack.path[1][last]), [tx, ty] = tipOf(one, at);
    knob.style.left = `${view.x(tx)}px`;
    knob.style.top = `${view.y(ty)}px`;
    knob.dataset.handle = `${kept.gear} crack ${crack.tooth}`;
    const told = `depth ${at.depth.toFixed(3)} mm, angle ${at.angle.toFixed(1)} deg`;
    knob.setAttribute("aria-label", `Tip of the crack of tooth ${crack.tooth} of gear ${kept.gear}: ${told}`);
    knob.title = `${told}; drag it, or use the arrow keys`;
    const move = (to, moving) => {
      kept.follow = within(now(kept), to);
      send({ gear: kept.gear, place: now(kept).crack.place, ...kept.follow, moving });
      kept.draw();
    };
    knob.onpointerdown = (event) => { knob.setPointerCapture(event.pointerId); held = knob; event.preventDefault(); knob.focus(); };
    knob.onpointermove = (event) => {
      if (held !== knob) return;
      const box = kept.canvas.getBoundingClientRect(), seen = placed(kept);
      const x0 = seen.x(0), y0 = seen.y(0);
      move(polar(now(kept), (event.clientX - box.x - x0) / seen.scale, -(event.clientY - box.y - y0) / seen.scale), true);
    };
    knob.onpointerup = knob.onpointercancel = () => { if (held === knob) { held = null; if (kept.follow) move(kept.follow, false); } };
    knob.onkeydown = (event) => {
      const way = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
      if (!way) return;
      event.preventDefault();
      const much = event.shiftKey ? 5 : 1, from = kept.follow ?? at;
      move({ depth: from.depth + 0.02 * one.module * much * way[0], angle: from.angle + much * way[1] }, false);
    };
  }
  function put(kept) { // words and numbers of what was computed
    const { data } = kept, { crack } = now(kept), digits = (v, n = 3) => String(Number(v.toPrecision(n)));
    const k = ({ value, error }) => (error ? `${digits(value, 4)} ± ${digits(error, 1)}` : digits(value, 4));
    kept.choice.hidden = data.cracks.length < 2;
    kept.choice.replaceChildren(...data.cracks.map((one, i) => Object.assign(made("option", "", `tooth ${one.tooth}`), { value: i, selected: i === kept.at })));
    const length = Math.hypot(...[0, 1].map((c) => crack.path[c].at(-1) - crack.path[c][0]));
    const under = data.of ? `the whole load of pair ${data.of} (${digits(data.load, 4)} N/mm) at the outer end of single contact` : `${digits(data.load, 4)} N/mm`;
    const faces = crack.closed > 0 ? `, ${Math.round(100 * crack.closed)} % of its faces in contact` : "";
    kept.words.textContent = `Crack ${digits(length)} mm${faces}: K_I = ${k(crack.k[0])}, K_II = ${k(crack.k[1])} MPa·√m, opening at the fillet ${digits(crack.opening)} µm, `
      + `stiffness of the tooth −${digits(100 * crack.loss)} %; under ${under}, radius ${data.radius.toFixed(3)} mm.`;
    kept.canvas.setAttribute("aria-label", `Cracked tooth of gear ${kept.gear} under load, displacements magnified. ${kept.words.textContent}`);
    const strip = made("i", ""), ends = ["0 MPa", `${digits(crack.limit, 3)} MPa`].map((text) => made("span", "", text));
    strip.style.background = `linear-gradient(to right, ${fegearField.stops("mises").join()})`;
    kept.scale.replaceChildren(made("span", "", "von Mises stress:"), ends[0], strip, ends[1]);
    kept.scale.title = "The colour scale ends at the maximum of both fillets; at the crack tip and below the load stress is higher.";
    kept.draw();
  }
  function take({ pair: gear, cracks, ...rest }) {
    let kept = shown.get(gear);
    if (!document.getElementById("hands")) return;
    if (!kept || !kept.host.isConnected) {
      kept = make(gear);
      shown.set(gear, kept);
      fegearMiddle.add(`crack ${gear}`, kept.host, `cracked tooth of gear ${gear}`, () => {});
    }
    kept.data = { ...rest, cracks: cracks.map((one) => {
      const moved = fegearLayers.unpack(one.moved), mises = fegearLayers.unpack(one.mises);
      return { ...one, d: Float64Array.from(moved.data, (v) => v * moved.step), stress: Float64Array.from(mises.data, (v) => v * mises.step), triangles: Uint16Array.from(one.triangles) };
    }) };
    kept.at = Math.min(kept.at, cracks.length - 1);
    if (!held || !kept.layer.contains(held)) kept.follow = null;
    put(kept);
  }
  fegearFigure.dark.addEventListener("change", () => { for (const kept of shown.values()) if (kept.data) put(kept); });
  return {
    meshed: take,
    plan(tasks) {
      for (const [gear, kept] of shown) if (!tasks.includes(`crack-shown of ${gear}`)) { fegearMiddle.remove(`crack ${gear}`); shown.delete(gear); }
    },
  };
})();
