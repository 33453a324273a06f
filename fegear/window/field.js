"use strict";
// Stress inside the teeth in colour: tables for unit loads are superposed with the loads of the pairs as they are now.
const fegearField = (() => {
  const MEASURES = { // what may be shown: its name, and whether it has a sign
    mises: ["von Mises stress", false], tension: ["maximum principal stress", true], pressure: ["minimum principal stress", true],
  };
  const STOPS = {
    light: ["#e6ebf1", "#9cc3e2", "#58b59b", "#efc455", "#e0662f", "#8c0d1c"],
    dark: ["#242e3a", "#2c639c", "#2a9478", "#d8ac38", "#f0763f", "#ffd3c6"],
  };
  const stops = (measure) => MEASURES[measure][1] ? fegearLayers.stops("stress") : STOPS[fegearFigure.theme()];
  const PLACES = 12; // of the base pitch at which the end of the scale is looked for

  const tables = new Map(); // colours -> 256 steps, as a canvas stores them
  function tableOf(measure) {
    const shades = stops(measure), key = shades.join();
    if (!tables.has(key)) {
      const rgb = shades.map((one) => [1, 3, 5].map((i) => parseInt(one.slice(i, i + 2), 16)));
      tables.set(key, Uint32Array.from({ length: 256 }, (_, i) => {
        const at = i / 255 * (rgb.length - 1), k = Math.min(Math.floor(at), rgb.length - 2);
        const [r, g, b] = rgb[k].map((one, c) => Math.round(one + (rgb[k + 1][c] - one) * (at - k)));
        return (255 << 24 | b << 16 | g << 8 | r) >>> 0;
      }));
    }
    return tables.get(key);
  }

  function made(sent) { // what was sent, ready to be superposed
    const gears = {};
    for (const [member, one] of Object.entries(sent.gears)) {
      const { step, shape, data } = fegearLayers.unpack(one.stress), count = shape[3];
      gears[member] = { ...one, x: Float64Array.from(one.places[0]), y: Float64Array.from(one.places[1]), step, data, teeth: shape[1], count,
        triangles: Uint16Array.from(one.triangles), sum: [0, 1, 2].map(() => new Float64Array(count)), value: new Float64Array(count),
        px: new Float64Array(count), py: new Float64Array(count) };
    }
    return { ...sent, gears };
  }
  /** Loads of the pairs in contact while the first is a share of the base pitch behind the start: [pair, x in mm, N]. */
  function loaded(d, place, loadAt) {
    const found = [], first = d.start + place * d.base_pitch;
    for (let k = -6; first + k * d.base_pitch <= d.end + 6 * d.base_pitch; k += 1) {
      const x = first + k * d.base_pitch, load = loadAt(x, k);
      if (load > 0) found.push([k, x, load]);
    }
    return found;
  }
  function superposed(field, member, d, loads, pair, measure) { // at the points of the tooth of a pair, MPa; null where nothing acts
    const gear = field.gears[member], { sum: [a, b, c], value, count, data, roll } = gear, driver = member === "driver";
    let acts = false;
    a.fill(0); b.fill(0); c.fill(0);
    const touches = d[`${member}_base`] * Math.tan(d.pressure_angle); // negative on the hollow flank of a ring gear
    for (const [number, x, load] of loads) {
      const k = driver ? pair - number : number - pair; // counted clockwise from the loaded tooth
      if (Math.abs(k) > gear.reach) continue;
      acts = true;
      const [low, high, share] = fegearLayers.between(roll, (touches + (driver ? x : -x)) * 1e3);
      for (const [row, weight] of [[low, 1 - share], [high, share]]) {
        if (!weight) continue;
        const factor = gear.step * gear.per_load * load * weight;
        let i = ((row * gear.teeth + k + gear.reach) * 3) * count;
        for (let n = 0; n < count; n += 1, i += 1) { a[n] += factor * data[i]; b[n] += factor * data[i + count]; c[n] += factor * data[i + 2 * count]; }
      }
    }
    if (!acts) return null;
    for (let n = 0; n < count; n += 1) {
      const half = 0.5 * (a[n] + b[n]), radius = Math.sqrt(0.25 * (a[n] - b[n]) ** 2 + c[n] * c[n]), z = 2 * gear.across * half;
      if (measure === "mises") value[n] = Math.sqrt((half - z) ** 2 + 3 * radius * radius);
      else value[n] = measure === "tension" ? half + radius : half - radius;
    }
    return value;
  }
  function nice(value) { // two digits, no less than a value
    const power = 10 ** (Math.floor(Math.log10(value)) - 1);
    return Math.ceil(value / power) * power;
  }
  /** End of the scale: the largest value on a fillet over the mesh; under the contacts it is higher. */
  function limitOf(field, d, loadAt, measure) {
    let most = 0;
    for (let i = 0; i < PLACES; i += 1) {
      const loads = loaded(d, i / PLACES, loadAt);
      for (const [pair] of loads) for (const member of ["driver", "driven"]) {
        const value = superposed(field, member, d, loads, pair, measure);
        for (const n of field.gears[member].fillet) most = Math.max(most, Math.abs(value[n]));
      }
    }
    return most > 0 ? nice(most) : 0;
  }

  function fill(pixels, wide, tall, gear, table, low, range) { // triangles with a colour that runs between their corners
    const { triangles, px, py, value } = gear, scale = 255 / range;
    for (let t = 0, n = triangles.length / 3; t < n; t += 1) {
      const i = triangles[t], j = triangles[n + t], k = triangles[2 * n + t];
      const x0 = px[i], y0 = py[i], x1 = px[j], y1 = py[j], x2 = px[k], y2 = py[k];
      const left = Math.max(0, Math.floor(Math.min(x0, x1, x2))), right = Math.min(wide - 1, Math.ceil(Math.max(x0, x1, x2)));
      const top = Math.max(0, Math.floor(Math.min(y0, y1, y2))), bottom = Math.min(tall - 1, Math.ceil(Math.max(y0, y1, y2)));
      const area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0);
      if (left > right || top > bottom || !area) continue;
      const v0 = (value[i] - low) * scale, v1 = (value[j] - low) * scale, v2 = (value[k] - low) * scale;
      const edge = -0.5 / Math.sqrt(Math.abs(area)); // half a pixel over: no gaps between neighbours
      const ax = (y1 - y2) / area, bx = (y2 - y0) / area, ay = (x2 - x1) / area, by = (x0 - x2) / area, cx = -ax - bx;
      const rise = ax * v0 + bx * v1 + cx * v2;
      for (let y = top; y <= bottom; y += 1) { // the pixels of a row between the sides
        const a = ay * (y - y2) - ax * x2, b = by * (y - y2) - bx * x2, c = 1 - a - b; // where x is 0
        let from = left, to = right;
        if (ax > 0) from = Math.max(from, (edge - a) / ax); else if (ax < 0) to = Math.min(to, (edge - a) / ax); else if (a < edge) continue;
        if (bx > 0) from = Math.max(from, (edge - b) / bx); else if (bx < 0) to = Math.min(to, (edge - b) / bx); else if (b < edge) continue;
        if (cx > 0) from = Math.max(from, (edge - c) / cx); else if (cx < 0) to = Math.min(to, (edge - c) / cx); else if (c < edge) continue;
        from = Math.ceil(from);
        let shade = a * v0 + b * v1 + c * v2 + rise * from;
        for (let at = y * wide + from, end = y * wide + to; at <= end; at += 1, shade += rise) pixels[at] = table[shade < 0 ? 0 : shade > 255 ? 255 : shade | 0];
      }
    }
  }
  const images = new WeakMap(); // canvas -> what it was drawn of last: a megabyte each time would have to be collected
  function imageOf(canvas) {
    const last = images.get(canvas);
    if (last?.width !== canvas.width || last?.height !== canvas.height) images.set(canvas, new ImageData(canvas.width, canvas.height));
    return images.get(canvas);
  }
  /** Draws the teeth of both gears; the view is that of the outlines over them. */
  function draw(canvas, room, view, field, shown) { // room: its width and height [px]
    const context = canvas.getContext("2d"), wide = Math.max(1, Math.round(room.width)), tall = Math.max(1, Math.round(room.height));
    if (canvas.width !== wide || canvas.height !== tall) Object.assign(canvas, { width: wide, height: tall });
    context.clearRect(0, 0, wide, tall);
    if (!field || !view || !(shown.limit > 0)) return;
    const d = view.data, { measure, limit, place, loadAt } = shown, signed = MEASURES[measure][1];
    const loads = loaded(d, place, loadAt), image = imageOf(canvas), pixels = new Uint32Array(image.data.buffer);
    pixels.fill(0);
    const scale = Math.min(wide / (2 * view.wide), tall / (2 * view.tall)), first = d.start + place * d.base_pitch;
    const table = tableOf(measure), reach = 1e3 * Math.max(d.driver_base, d.driven_base);
    for (const member of ["driver", "driven"]) {
      const driver = member === "driver", gear = field.gears[member], base = d[`${member}_base`];
      const centre = (driver ? -1 : 1) * d[`${member}_radius`] * 1e3;
      for (let pair = -6; pair <= 6; pair += 1) {
        const on = -(driver ? 1 : -1) * (pair * d.base_pitch + first) / base; // anticlockwise
        if (Math.abs(on) * reach > 8 * view.wide && Math.abs(pair) > 2) continue;
        if (Math.abs(on) > Math.PI) continue;
        const c = Math.cos(on), s = Math.sin(on);
        let left = Infinity, right = -Infinity, top = Infinity, bottom = -Infinity;
        for (let n = 0; n < gear.count; n += 1) {
          const x = gear.x[n], y = gear.y[n] - centre, px = wide / 2 + scale * (c * x - s * y), py = tall / 2 - scale * (s * x + c * y + centre);
          gear.px[n] = px;
          gear.py[n] = py;
          if (px < left) left = px;
          if (px > right) right = px;
          if (py < top) top = py;
          if (py > bottom) bottom = py;
        }
        if (right < 0 || left > wide || bottom < 0 || top > tall) continue; // out of sight
        if (!superposed(field, member, d, loads, pair, measure)) gear.value.fill(0);
        fill(pixels, wide, tall, gear, table, signed ? -limit : 0, signed ? 2 * limit : limit);
      }
    }
    context.putImageData(image, 0, 0);
  }
  return { MEASURES, stops, tableOf, fill, made, loaded, superposed, limitOf, draw };
})();
