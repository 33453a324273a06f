"use strict";
// What is drawn over the gears in mesh: root stress in colour, deformed teeth, the tool; scales of colour.
const fegearLayers = (() => {
  const STOPS = { // of the scales of colours, on light and on dark ground
    stress: { light: ["#08519c", "#4292c6", "#c4c8cc", "#ef6548", "#990000"], dark: ["#9ecbff", "#3f8ae0", "#4b5158", "#f0603f", "#ffc2a8"] },
    pressure: { light: ["#fdd49e", "#fc8d59", "#d7301f", "#7f0000"], dark: ["#5b2a12", "#c8441c", "#ff9a3d", "#fff0b8"] },
  };
  const stops = (kind) => STOPS[kind][fegearFigure.theme()];
  const kept = new Map(); // palettes
  function shades(kind) { // 128 steps of a scale
    const key = `${kind} ${fegearFigure.theme()}`;
    if (!kept.has(key)) {
      const rgb = stops(kind).map((one) => [1, 3, 5].map((i) => parseInt(one.slice(i, i + 2), 16)));
      kept.set(key, Array.from({ length: 128 }, (_, i) => {
        const at = i / 127 * (rgb.length - 1), k = Math.min(Math.floor(at), rgb.length - 2);
        return `rgb(${rgb[k].map((one, c) => Math.round(one + (rgb[k + 1][c] - one) * (at - k))).join()})`;
      }));
    }
    return kept.get(key);
  }
  const shade = (scale, share) => scale[Math.max(0, Math.min(127, Math.round(127 * share)))];

  function unpack({ step, shape, data }) {
    return { step, shape, data: new Int16Array(fegearPacked.bytes(data)) };
  }
  function between(roll, place) { // number of the roll position before a place, and how far it is on to the next
    let low = 0, high = roll.length - 1;
    while (high - low > 1) { const middle = (low + high) >> 1; if (roll[middle] <= place) low = middle; else high = middle; }
    const share = (place - roll[low]) / (roll[high] - roll[low] || 1);
    return [low, high, Math.max(0, Math.min(1, share))];
  }

  // ---- what was sent, ready to be drawn ------------------------------------------------------------------------------
  function stressOf(sent) {
    const fillets = sent.fillets.map((one) => {
      const made = { ...one, stress: unpack(one.stress) };
      made.stress.shape = made.stress.shape.slice(-3); // (sections along the face,) roll positions, teeth, points
      return made;
    });
    return { ...sent, fillets };
  }
  function deformedOf(sent) {
    const gears = {};
    for (const [member, one] of Object.entries(sent.gears)) gears[member] = { places: one.places, moved: unpack(one.moved) };
    return { ...sent, gears };
  }
  function besides(deformed, member, pair, [xs, ys]) { // for points of a tooth: number of a point of its outline, and the share of the next
    const tooth = deformed.gears[member].places[deformed.pairs.indexOf(pair)], found = [];
    for (let i = 0; i < xs.length; i += 1) {
      let best = [0, 0], least = Infinity;
      for (let n = 0; n + 1 < tooth[0].length; n += 1) {
        const ax = tooth[0][n], ay = tooth[1][n], bx = tooth[0][n + 1] - ax, by = tooth[1][n + 1] - ay;
        const t = Math.max(0, Math.min(1, ((xs[i] - ax) * bx + (ys[i] - ay) * by) / (bx * bx + by * by || 1)));
        const off = (xs[i] - ax - t * bx) ** 2 + (ys[i] - ay - t * by) ** 2;
        if (off < least) { least = off; best = [n, t]; }
      }
      found.push(best);
    }
    return found;
  }
  function mover(deformed, member, factor, place) { // displacement of the outline's point n of tooth t, drawn
    const { moved } = deformed.gears[member], [low, high, share] = between(deformed.roll, place);
    const [, teeth, , points] = moved.shape, { data } = moved;
    return (t, c, n) => {
      const i = ((low * teeth + t) * 2 + c) * points + n, j = ((high * teeth + t) * 2 + c) * points + n;
      return factor * moved.step * (data[i] + (data[j] - data[i]) * share);
    };
  }
  function weights(stress, place, z, [positions]) { // [row of roll positions, weight] for a place, in a section along the face [mm]
    const [low, high, share] = between(stress.roll, place);
    const [below, above, far] = stress.z.length ? between(stress.z, z) : [0, 0, 0];
    return [[below, low, (1 - far) * (1 - share)], [below, high, (1 - far) * share], [above, low, far * (1 - share)], [above, high, far * share]]
      .filter((one) => one[2] > 0).map(([section, row, weight]) => [section * positions + row, weight]);
  }
  function aheadAt(deformed, place) {
    const [low, high, share] = between(deformed.roll, place);
    return deformed.ahead[low] + (deformed.ahead[high] - deformed.ahead[low]) * share;
  }

  // ---- gears ---------------------------------------------------------------------------------------------------------
  function gears(canvas, room, view, shown) { // room: width and height [px]; view: half width and height [mm] and the pair; shown: what is on, and the place
    const { stress, deformed, tool, place, factor, z = 0 } = shown, nothing = !stress && !deformed && !tool;
    if (nothing && canvas.dataset.empty) return;
    canvas.dataset.empty = nothing ? "yes" : "";
    const ratio = devicePixelRatio || 1, wide = Math.round(room.width * ratio), tall = Math.round(room.height * ratio);
    if (canvas.width !== wide || canvas.height !== tall) Object.assign(canvas, { width: wide, height: tall });
    const context = canvas.getContext("2d");
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, wide, tall);
    if (nothing) return;
    const scale = Math.min(wide / (2 * view.wide), tall / (2 * view.tall)), pixel = ratio / scale;
    const look = getComputedStyle(canvas), line = { driver: look.getPropertyValue("--driver"), driven: look.getPropertyValue("--driven") };
    const d = view.data, first = d.start + place * d.base_pitch - z * 1e-3 * d.twist; // in the section at z
    context.lineJoin = context.lineCap = "round";
    for (const member of ["driver", "driven"]) {
      const driver = member === "driver", centre = driver ? -d.driver_radius * 1e3 : d.driven_radius * 1e3;
      const base = driver ? d.driver_base : d.driven_base;
      const ahead = driver && deformed ? factor * aheadAt(deformed, place) / (base * 1e3) : 0;
      const turn = driver ? -first / base - ahead : first / base; // anticlockwise
      context.setTransform(scale, 0, 0, -scale, wide / 2, tall / 2);
      context.translate(0, centre);
      context.rotate(turn);
      context.translate(0, -centre);
      if (tool) {
        context.strokeStyle = look.getPropertyValue("--tool");
        context.lineWidth = 0.7 * pixel;
        context.save();
        context.beginPath(); // the tool ends where the gear does
        context.arc(0, centre, 1.004 * tool.tips[member], 0, 2 * Math.PI);
        context.clip();
        context.beginPath();
        for (const [xs, ys] of tool.lines[member]) xs.forEach((x, i) => i ? context.lineTo(x, ys[i]) : context.moveTo(x, ys[i]));
        context.stroke();
        context.restore();
      }
      const move = deformed && mover(deformed, member, factor, place);
      if (deformed) {
        context.strokeStyle = line[member];
        context.lineWidth = 2 * pixel;
        deformed.gears[member].places.forEach(([xs, ys], t) => {
          context.beginPath();
          for (let n = 0; n < xs.length; n += 1) {
            const x = xs[n] + move(t, 0, n), y = ys[n] + move(t, 1, n);
            if (n) context.lineTo(x, y); else context.moveTo(x, y);
          }
          context.stroke();
        });
      }
      if (stress) fillets(context, stress, deformed, move, member, place, z, pixel, look);
    }
  }
  function fillets(context, stress, deformed, move, member, place, z, pixel, look) {
    const scale = shades("stress"), NONE = -32768; // beside a contact it is no root stress
    context.lineWidth = 6 * pixel;
    context.lineCap = "butt";
    for (const fillet of stress.fillets) {
      if (fillet.member !== member) continue;
      const { data, step, shape, shape: [, teeth, points] } = fillet.stress, at_rows = weights(stress, place, z, shape);
      for (let t = 0; t < teeth; t += 1) {
        const [xs, ys] = fillet.places[t], tooth = deformed ? deformed.pairs.indexOf(stress.pairs[t]) : -1;
        let beside = null;
        if (tooth >= 0) {
          fillet.beside ??= new Map();
          if (fillet.of !== deformed) { fillet.beside.clear(); fillet.of = deformed; }
          if (!fillet.beside.has(t)) fillet.beside.set(t, besides(deformed, member, stress.pairs[t], fillet.places[t]));
          beside = fillet.beside.get(t);
        }
        const at = (i, c) => {
          const rest = c ? ys[i] : xs[i];
          if (!beside) return rest;
          const [n, far] = beside[i];
          return rest + move(tooth, c, n) * (1 - far) + move(tooth, c, n + 1) * far;
        };
        let x = at(0, 0), y = at(0, 1);
        for (let i = 1; i < points; i += 1) {
          const nx = at(i, 0), ny = at(i, 1);
          let value = 0, known = true;
          for (const [row, weight] of at_rows) {
            const a = (row * teeth + t) * points + i;
            known = known && data[a] !== NONE && data[a - 1] !== NONE;
            value += 0.5 * step * weight * (data[a] + data[a - 1]);
          }
          if (known) {
            context.strokeStyle = shade(scale, 0.5 + 0.5 * value / stress.limit);
            context.beginPath();
            context.moveTo(x, y);
            context.lineTo(nx, ny);
            context.stroke();
          }
          x = nx; y = ny;
        }
      }
    }
    context.lineCap = "round";
    const { largest } = stress;
    if (largest.member === member && Math.abs(largest.z - z) < 0.005 * ((stress.z.at(-1) ?? 0) - (stress.z[0] ?? 0)) + 1e-6) {
      context.strokeStyle = look.getPropertyValue("--ink");
      context.lineWidth = (Math.abs(largest.at - place) < 0.01 ? 2.6 : 1.2) * pixel;
      context.beginPath();
      let [x, y] = largest.place;
      const tooth = deformed ? deformed.pairs.indexOf(largest.pair) : -1;
      if (tooth >= 0) {
        const [[n, far]] = besides(deformed, member, largest.pair, [[x], [y]]);
        x += move(tooth, 0, n) * (1 - far) + move(tooth, 0, n + 1) * far;
        y += move(tooth, 1, n) * (1 - far) + move(tooth, 1, n + 1) * far;
      }
      context.arc(x, y, 8 * pixel, 0, 2 * Math.PI);
      context.stroke();
    }
  }

  function contactMoved(d, { deformed, factor, place }, pair, x, y, member = "driven") { // where a contact stands on a deformed gear [mm]
    const t = deformed ? deformed.pairs.indexOf(pair) : -1;
    if (t < 0) return [x, y];
    const driver = member === "driver", base = driver ? d.driver_base : d.driven_base;
    const centre = driver ? -d.driver_radius * 1e3 : d.driven_radius * 1e3, turn = (driver ? -1 : 1) * (d.start + place * d.base_pitch) / base;
    const turned = (u, v, angle) => [Math.cos(angle) * u - Math.sin(angle) * v, Math.sin(angle) * u + Math.cos(angle) * v];
    const [u, v] = turned(x, y - centre, -turn), move = mover(deformed, member, factor, place);
    const [[n, far]] = besides(deformed, member, pair, [[u], [v + centre]]);
    const [du, dv] = [0, 1].map((i) => move(t, i, n) * (1 - far) + move(t, i, n + 1) * far);
    const ahead = driver ? factor * aheadAt(deformed, place) / (base * 1e3) : 0;
    const [px, py] = turned(u + du, v + dv, turn - ahead);
    return [px, py + centre];
  }
  return { stressOf, deformedOf, gears, contactMoved, stops, shades, shade, unpack, between };
})();
