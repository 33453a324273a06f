"use strict";
// A planetary set turning: real teeth in mesh, the load of every planet in colour, forces and contacts at its meshes.
const fegearSets = (() => {
  const { cos, sin, abs, max, min, hypot, PI } = Math;
  const shown = new Map(); // name -> what is drawn of it
  const waiting = new Map(); // name -> loads that came before the set
  const made = (tag, cls, text) => Object.assign(document.createElement(tag), cls ? { className: cls } : {}, text === undefined ? {} : { textContent: text });
  const digits = (value, count) => String(Number(value.toPrecision(count)));

  function outline(gear) { // all teeth, tooth 0 with its centre line along +x
    const path = new Path2D(), [xs, ys] = gear.tooth;
    if (!xs.length) { path.arc(0, 0, gear.radius, 0, 2 * PI); return path; }
    for (let k = 0; k < gear.teeth; k += 1) {
      const turn = -2 * PI * k / gear.teeth - PI / 2, c = cos(turn), s = sin(turn);
      for (let i = 0; i < xs.length; i += 1) {
        const x = c * xs[i] - s * ys[i], y = s * xs[i] + c * ys[i];
        if (k + i) path.lineTo(x, y); else path.moveTo(x, y);
      }
    }
    path.closePath();
    return path;
  }
  function hollow(gear) { // with the circle where the body ends, inside or, of a ring, outside
    const path = outline(gear);
    if (gear.tooth[0].length) { path.moveTo(gear.radius, 0); path.arc(0, 0, gear.radius, 0, 2 * PI); }
    return path;
  }
  function forceAt(loads, mesh, planet, q) {
    const { s, force: { step, shape, data } } = loads, at = ((q % 1) + 1) % 1, count = shape[2], row = (mesh * shape[1] + planet) * count;
    let high = s.findIndex((one) => one > at), low = high - 1;
    if (high < 0) { high = 0; low = count - 1; }
    if (low < 0) low = count - 1;
    const span = ((s[high] - s[low]) % 1 + 1) % 1, share = span ? (((at - s[low]) % 1 + 1) % 1) / span : 0;
    return step * (data[row + low] + (data[row + high] - data[row + low]) * min(1, share));
  }

  function setOf(name) {
    const host = made("section", "hand"), stage = made("div", "mesh-stage"), canvas = made("canvas"), scale = made("p", "mesh-scale below");
    host.dataset.set = name;
    stage.tabIndex = 0;
    canvas.setAttribute("role", "img");
    const tools = made("p", "mesh-tools"), angle = Object.assign(made("input"), { type: "range", min: 0, max: 7200, value: 0 }), now = made("b"), told = made("p", "quiet mesh-told");
    const seen = made("select"), label = made("label", "mesh-measure"), kept = { name, host, data: null, loads: null, turned: 0, playing: false, focus: -1, frames: [] };
    seen.append(...[["housing", "view fixed to housing"], ["carrier", "seen from the carrier"]].map(([value, textContent]) => Object.assign(made("option"), { value, textContent })));
    seen.setAttribute("aria-label", "Seen from");
    label.append(seen);
    const play = fegearGears.button("Play", "Turn the set", () => { kept.playing = !kept.playing; play.textContent = kept.playing ? "Pause" : "Play"; if (kept.playing) requestAnimationFrame(turn); });
    const nearer = fegearGears.button("Nearer", "One planet after the other, large (or click on it)", () => { kept.focus = kept.focus + 1 < kept.data.angles.length ? kept.focus + 1 : -1; draw(); });
    stage.append(canvas);
    tools.append(play, angle, now, label, nearer);
    host.append(made("h2", "", `Set ${name}`), stage, scale, tools, told);
    angle.oninput = () => { kept.turned = angle.value / 7200 * 2 * PI; draw(); };
    seen.onchange = () => draw();
    let last = 0;
    function turn(time) {
      if (!kept.playing || !canvas.isConnected) return;
      kept.frames.push(time);
      if (kept.frames.length > 200) kept.frames.shift();
      kept.turned = (kept.turned + min(100, time - last) / 4000 * abs(kept.data.per_cycle)) % (2 * PI); // a base pitch in four seconds
      last = time;
      draw();
      requestAnimationFrame(turn);
    }
    function draw() {
      const d = kept.data, size = stage.getBoundingClientRect(), ratio = devicePixelRatio || 1;
      if (!d || !size.width) return;
      const q = kept.turned / abs(d.per_cycle), look = getComputedStyle(canvas), colour = (key) => look.getPropertyValue(key).trim();
      const wide = Math.round(size.width * ratio), tall = Math.round(size.height * ratio);
      if (canvas.width !== wide || canvas.height !== tall) Object.assign(canvas, { width: wide, height: tall });
      const context = canvas.getContext("2d"), { sun, planet, ring } = d.gears, carrier = seen.value === "carrier" ? 0 : d.carrier * q;
      const reach = 1.04 * (ring.tooth[0].length ? ring.radius : 1.06 * ring.radius), near = kept.focus >= 0;
      const zoom = near ? 0.42 * min(size.width, size.height) / (0.6 * (reach - d.meshes.sun.radius) + 2 * d.module) : 0.5 * min(size.width, size.height) / reach;
      const at = near ? d.angles[kept.focus] + carrier : 0, cx = near ? d.centre_distance * cos(at) : 0, cy = near ? d.centre_distance * sin(at) : 0;
      const view = () => context.setTransform(ratio * zoom, 0, 0, -ratio * zoom, ratio * (size.width / 2 - zoom * cx), ratio * (size.height / 2 + zoom * cy));
      const line = (pixels) => { context.lineWidth = pixels / zoom; };
      context.setTransform(1, 0, 0, 1, 0, 0);
      context.clearRect(0, 0, wide, tall);
      view();
      const gear = (one, path, copy, x, y, fill, stroke) => {
        context.save();
        context.translate(x, y);
        context.rotate(one.start[copy] + one.turn * q + carrier);
        if (fill) { context.fillStyle = fill; context.fill(path, "evenodd"); }
        context.strokeStyle = stroke;
        line(1.2);
        context.stroke(path);
        context.restore();
      };
      const body = colour("--paper"), soft = colour("--soft"), ink = colour("--ink");
      if (ring.tooth[0].length) gear(ring, kept.paths.ring, 0, 0, 0, body, soft);
      else { context.setLineDash([6 / zoom, 4 / zoom]); gear(ring, kept.paths.ring, 0, 0, 0, null, soft); context.setLineDash([]); }
      const centres = d.angles.map((psi) => [d.centre_distance * cos(psi + carrier), d.centre_distance * sin(psi + carrier)]);
      context.lineCap = "round";
      context.strokeStyle = colour("--line");
      context.lineWidth = max(2.2 * planet.radius, 2 * d.module);
      context.beginPath();
      for (const [x, y] of centres) { context.moveTo(0, 0); context.lineTo(x, y); }
      context.stroke();
      gear(sun, kept.paths.sun, 0, 0, 0, body, colour("--driver"));
      const loads = fegearGlance.hides() ? null : kept.loads, shades = fegearLayers.shades("pressure"), words = [];
      centres.forEach(([x, y], n) => {
        const force = loads ? [0, 1].map((mesh) => forceAt(loads, mesh, n, q)) : null;
        gear(planet, kept.paths.planet, n, x, y, force ? fegearLayers.shade(shades, 0.5 * (force[0] + force[1]) / loads.limit) : body, colour("--driven"));
        words.push([n, x, y, force]);
      });
      // contacts and forces: both on the planet, at the pitch points
      const arrow = (x, y, dx, dy) => {
        const long = hypot(dx, dy), [ux, uy] = [dx / long, dy / long], tip = 9 / zoom;
        context.beginPath();
        context.moveTo(x, y);
        context.lineTo(x + dx - tip * ux, y + dy - tip * uy);
        context.stroke();
        context.beginPath();
        context.moveTo(x + dx, y + dy);
        context.lineTo(x + dx - tip * ux - 0.45 * tip * uy, y + dy - tip * uy + 0.45 * tip * ux);
        context.lineTo(x + dx - tip * ux + 0.45 * tip * uy, y + dy - tip * uy - 0.45 * tip * ux);
        context.fill();
      };
      words.forEach(([n, , , force]) => {
        const psi = d.angles[n] + carrier, [ox, oy] = [cos(psi), sin(psi)];
        ["sun", "ring"].forEach((which, m) => {
          const mesh = d.meshes[which], [r, t] = mesh.along, ax = r * ox - t * oy, ay = r * oy + t * ox, px = mesh.radius * ox, py = mesh.radius * oy;
          context.fillStyle = context.strokeStyle = ink;
          if (mesh.end > mesh.start) {
            for (let k = -6; k <= 6; k += 1) {
              const x = (q - Math.floor(q) - mesh.delay[n] + k) * mesh.base_pitch;
              if (x < mesh.start || x > mesh.end) continue;
              context.beginPath();
              context.arc(px + x * ax, py + x * ay, max(2.2 / zoom, 0.08 * d.module), 0, 2 * PI);
              context.fill();
            }
          }
          if (!force || !(force[m] > 1e-9 * loads.largest)) return;
          const long = mesh.push * 0.42 * d.centre_distance * force[m] / loads.largest;
          for (const [pixels, shade] of [[5, body], [2, ink]]) { // dark arrows over dark planets
            line(pixels);
            context.fillStyle = context.strokeStyle = shade;
            arrow(px, py, long * ax, long * ay);
          }
        });
      });
      context.setTransform(ratio, 0, 0, ratio, 0, 0);
      context.textAlign = "center";
      context.textBaseline = "middle";
      for (const [n, x, y, force] of words) {
        const [sx, sy] = [size.width / 2 + zoom * (x - cx), size.height / 2 - zoom * (y - cy)], lines = [String(n + 1)];
        if (force && zoom * planet.radius > 4) lines.push(`${digits(0.5 * (force[0] + force[1]), 4)} N`);
        lines.forEach((text, i) => {
          context.font = `${i ? "" : "bold "}12px ${look.fontFamily}`;
          const across = context.measureText(text).width + 8, up = sy + (i - 0.5 * (lines.length - 1)) * 15;
          context.fillStyle = body;
          context.globalAlpha = 0.85;
          context.fillRect(sx - across / 2, up - 8, across, 16);
          context.globalAlpha = 1;
          context.fillStyle = ink;
          context.fillText(text, sx, up);
        });
      }
      angle.value = Math.round(kept.turned / (2 * PI) * 7200);
      now.textContent = `${(kept.turned * 180 / PI).toFixed(2)}°`;
    }
    function tell() {
      const d = kept.data, parts = (values) => values.map((one) => Number(one.toFixed(3))).join(", ");
      angle.setAttribute("aria-label", `Angle of the ${d.driving}`);
      now.title = `Angle of the ${d.driving}, which drives`;
      const ring = d.gears.ring.tooth[0].length ? "" : " The ring is not a gear of the case: its working pitch circle is drawn.";
      const loads = kept.loads ? ` Mean load over an equal share: ${kept.loads.shares.map((one) => one.toFixed(3)).join(", ")}. Arrows are the forces on the planets.` : "";
      told.textContent = `The ${d.driving} drives, the ${d.fixed} is fixed. Phases of planets 1 to ${d.angles.length} in base pitches: with the sun ${parts(d.meshes.sun.delay)}; with the ring ${parts(d.meshes.ring.delay.map((one) => one % 1))}.${loads}${ring}`;
      canvas.setAttribute("aria-label", `Planetary set ${name}, ${d.angles.length} planets. ${told.textContent}`);
      scale.hidden = !kept.loads;
      if (kept.loads) {
        const bar = made("i");
        bar.style.background = `linear-gradient(to right, ${fegearLayers.stops("pressure").join()})`;
        scale.replaceChildren(made("span", "", "mesh force of a planet:"), made("span", "", "0"), bar, made("span", "", `${digits(kept.loads.limit, 4)} N`));
      }
    }
    canvas.onclick = ({ offsetX, offsetY }) => { // a planet, larger; anywhere else the whole set
      const d = kept.data, box = canvas.getBoundingClientRect();
      if (kept.focus >= 0) { kept.focus = -1; draw(); return; }
      const reach = 1.04 * (d.gears.ring.tooth[0].length ? d.gears.ring.radius : 1.06 * d.gears.ring.radius), zoom = 0.5 * min(box.width, box.height) / reach;
      const x = (offsetX - box.width / 2) / zoom, y = (box.height / 2 - offsetY) / zoom, carrier = seen.value === "carrier" ? 0 : d.carrier * kept.turned / abs(d.per_cycle);
      const most = d.centre_distance - d.meshes.sun.radius;
      kept.focus = d.angles.findIndex((psi) => hypot(x - d.centre_distance * cos(psi + carrier), y - d.centre_distance * sin(psi + carrier)) < most);
      draw();
    };
    new ResizeObserver(() => draw()).observe(stage);
    let due = 0;
    kept.soon = () => { due ||= requestAnimationFrame(() => { due = 0; if (kept.data) { tell(); draw(); } }); };
    kept.set = (data) => {
      kept.data = data;
      kept.paths = { sun: hollow(data.gears.sun), planet: hollow(data.gears.planet), ring: hollow(data.gears.ring) };
      kept.soon();
    };
    return kept;
  }

  fegearFigure.dark.addEventListener("change", () => { for (const kept of shown.values()) kept.soon(); });
  return {
    show(sets) {
      for (const name of [...shown.keys()]) if (!(name in sets)) { fegearMiddle.remove(`set ${name}`); shown.delete(name); }
      for (const [name, data] of Object.entries(sets)) {
        if (!shown.get(name)?.host.isConnected) {
          const kept = setOf(name);
          shown.set(name, kept);
          kept.loads = waiting.get(name) ?? null;
          fegearMiddle.add(`set ${name}`, kept.host, `set ${name}`, () => fegearGlance.choose(name, "set"));
        }
        shown.get(name).set(data);
      }
    },
    meshed({ pair, ...content }) {
      const name = pair.slice(4), loads = { ...content, limit: max(content.largest, 1.5 * content.mean), force: fegearLayers.unpack(content.force) };
      waiting.set(name, loads);
      const kept = shown.get(name);
      if (kept) { kept.loads = loads; kept.soon(); }
    },
    of: (name) => shown.get(name),
    soon() { for (const kept of shown.values()) kept.soon(); }, // loads are shown or hidden
  };
})();
