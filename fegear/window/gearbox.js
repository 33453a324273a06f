"use strict";
// The gearbox in space: shafts, gears and bearings as bodies of revolution, bent as the meshes bend them, many times as
// much. The pointer turns it; a mesh that is pressed opens its pair.
const fegearGearbox = (() => {
  const { cos, sin, max, min, hypot, PI, round } = Math;
  const AROUND = 48, NEAR = 24, FINE = 2; // patches around a body; pixels from a mesh that still mean it; drawn so much finer
  const made = (tag, cls, text) => Object.assign(document.createElement(tag), cls ? { className: cls } : {}, text === undefined ? {} : { textContent: text });
  const digits = (value, count) => String(Number(value.toPrecision(count)));
  let kept = null, waiting = null;

  const colours = new Map(), surface = document.createElement("canvas"); // what is drawn finer than it is shown
  function rgb(colour) { // of any colour that a style may have
    if (!colours.has(colour)) {
      const one = surface.getContext("2d");
      one.fillStyle = colour;
      colours.set(colour, [1, 3, 5].map((i) => parseInt(one.fillStyle.slice(i, i + 2), 16)));
    }
    return colours.get(colour);
  }
  function fill(pixels, depth, wide, tall, [[ax, ay, az], [bx, by, bz], [cx, cy, cz]], value) { // a triangle, where nothing is nearer
    const area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay), edge = -1e-6;
    if (!area) return;
    const left = max(0, Math.floor(min(ax, bx, cx))), right = min(wide - 1, Math.ceil(max(ax, bx, cx)));
    for (let y = max(0, Math.floor(min(ay, by, cy))), last = min(tall - 1, Math.ceil(max(ay, by, cy))); y <= last; y += 1) {
      for (let x = left; x <= right; x += 1) {
        const u = ((by - cy) * (x - cx) + (cx - bx) * (y - cy)) / area, v = ((cy - ay) * (x - cx) + (ax - cx) * (y - cy)) / area, w = 1 - u - v;
        if (u < edge || v < edge || w < edge) continue;
        const z = u * az + v * bz + w * cz, at = y * wide + x;
        if (z <= depth[at]) continue;
        depth[at] = z;
        pixels[at] = value;
      }
    }
  }

  function boxOf() {
    const host = made("section", "hand"), stage = made("div", "mesh-stage"), canvas = made("canvas"), tools = made("p", "mesh-tools"), told = made("p", "quiet mesh-told");
    const label = made("label", "mesh-factor"), slider = Object.assign(made("input"), { type: "range", min: 0, max: 600, value: 0 }), value = made("b"), pairs = made("span", "mesh-pairs");
    slider.setAttribute("aria-label", "Deflection scale factor");
    label.append("deflection", slider, value);
    canvas.setAttribute("role", "img");
    stage.append(canvas);
    tools.append(label, pairs);
    host.append(made("h2", "", "Gearbox"), stage, tools, told);
    const one = { host, data: null, bent: null, factor: null, places: [] };
    const turned = fegearFlanks.turns(canvas, () => draw());
    Object.assign(turned, { yaw: -0.35, pitch: 0.45 });
    slider.oninput = () => {
      const exact = 10 ** (slider.value / 100), power = 10 ** Math.floor(slider.value / 100);
      one.factor = slider.value === "0" ? 0 : round(exact / power * 10) / 10 * power;
      tell();
      draw();
    };
    const factor = () => (one.bent ? one.factor ?? one.bent.factor : 0);

    function patches(look) { // [corners with their depth, colour, light], seen from where the pointer has turned it
      const { data, bent } = one, f = factor(), found = [], [cy, sy, cp, sp] = [cos(turned.yaw), sin(turned.yaw), cos(turned.pitch), sin(turned.pitch)];
      const drivers = new Set(data.drivers), shades = { shaft: look("--soft"), bearing: look("--line"), driver: look("--driver"), driven: look("--driven") };
      const seen = ([x, y, z]) => { const off = -x * cy + z * sy; return [z * cy + x * sy, y * cp - off * sp, off * cp + y * sp]; };
      data.bodies.forEach((body, b) => {
        const [sx, sY, sz] = data.places[body.shaft], moved = bent?.moved[b], base = shades[body.kind === "gear" ? drivers.has(body.name) ? "driver" : "driven" : body.kind];
        const ring = (i, radius) => Array.from({ length: AROUND }, (_, k) => {
          const angle = 2 * PI * k / AROUND, x = radius * cos(angle), y = radius * sin(angle), z = body.z[i] - body.moves_with[i];
          const m = (c) => (moved ? f * moved.step * moved.data[6 * i + c] * 1e-3 : 0);
          const [tx, ty, tz] = [m(3), m(4), m(5)];
          return seen([sx + x + m(0) + ty * z - tz * y, sY + y + m(1) + tz * x - tx * z, sz + body.z[i] + m(2) + tx * y - ty * x]);
        });
        const quad = (corners, tone) => {
          const [a, p, q] = corners, u = [p[0] - a[0], p[1] - a[1], p[2] - a[2]], v = [q[0] - a[0], q[1] - a[1], q[2] - a[2]];
          const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]], long = hypot(...n);
          if (!(long > 0) || n[2] <= 0) return; // from behind
          const light = 0.45 + 0.55 * max(0, (0.35 * n[0] + 0.6 * n[1] + 0.72 * n[2]) / long);
          found.push([corners, base, tone * light]);
        };
        const rings = body.z.map((_, i) => ring(i, body.outer[i])), last = body.z.length - 1;
        for (let i = 0; i < last; i += 1) {
          for (let k = 0; k < AROUND; k += 1) { const next = (k + 1) % AROUND; quad([rings[i][k], rings[i][next], rings[i + 1][next], rings[i + 1][k]], k === 0 && body.kind === "shaft" ? 0.75 : 1); }
        }
        for (const [i, back] of [[0, true], [last, false]]) {
          const inner = ring(i, body.inner[i]);
          for (let k = 0; k < AROUND; k += 1) {
            const next = (k + 1) % AROUND, corners = [inner[k], rings[i][k], rings[i][next], inner[next]];
            quad(body.inner[i] > 0 ? (back ? corners.reverse() : corners) : back ? [inner[0], rings[i][next], rings[i][k]] : [inner[0], rings[i][k], rings[i][next]], 1);
          }
        }
      });
      one.places = Object.entries(data.meshes).map(([pair, at]) => [pair, seen(at)]);
      return found;
    }
    function draw() {
      const size = stage.getBoundingClientRect(), ratio = devicePixelRatio || 1;
      if (!one.data || !size.width) return;
      const wide = round(size.width * ratio), tall = round(size.height * ratio), style = getComputedStyle(canvas), look = (key) => style.getPropertyValue(key).trim();
      if (canvas.width !== wide || canvas.height !== tall) Object.assign(canvas, { width: wide, height: tall });
      const context = canvas.getContext("2d"), all = patches(look), xs = all.flatMap(([corners]) => corners.map((c) => c[0])), ys = all.flatMap(([corners]) => corners.map((c) => c[1]));
      const ends = (values) => values.reduce(([low, high], v) => [min(low, v), max(high, v)], [Infinity, -Infinity]), [[x0, x1], [y0, y1]] = [ends(xs), ends(ys)];
      const zoom = 0.9 * min(size.width / (x1 - x0), size.height / (y1 - y0)), X = (x) => size.width / 2 + zoom * (x - (x0 + x1) / 2), Y = (y) => size.height / 2 - zoom * (y - (y0 + y1) / 2);
      const fine = FINE * wide, high = FINE * tall, times = FINE * ratio, image = new ImageData(fine, high), pixels = new Uint32Array(image.data.buffer), depth = new Float32Array(fine * high).fill(-Infinity);
      const paper = rgb(look("--paper"));
      for (const [corners, base, light] of all) {
        const shade = rgb(base).map((one, i) => round(paper[i] + light * (one - paper[i]))), points = corners.map(([x, y, z]) => [times * X(x), times * Y(y), z]);
        const value = (255 << 24 | shade[2] << 16 | shade[1] << 8 | shade[0]) >>> 0;
        for (let i = 2; i < points.length; i += 1) fill(pixels, depth, fine, high, [points[0], points[i - 1], points[i]], value);
      }
      surface.width = fine;
      surface.height = high;
      surface.getContext("2d").putImageData(image, 0, 0);
      context.setTransform(ratio, 0, 0, ratio, 0, 0);
      context.clearRect(0, 0, size.width, size.height);
      context.drawImage(surface, 0, 0, size.width, size.height);
      context.lineWidth = 0.7;
      context.textAlign = "center";
      context.textBaseline = "middle";
      context.font = `bold 12px ${style.fontFamily}`;
      one.places = one.places.map(([pair, [x, y]]) => [pair, X(x), Y(y)]);
      for (const [pair, x, y] of one.places) {
        const words = `pair ${pair}`, across = context.measureText(words).width + 12;
        context.fillStyle = look("--paper");
        context.strokeStyle = look("--ink");
        context.beginPath();
        context.roundRect(x - across / 2, y - 10, across, 20, 6);
        context.fill();
        context.stroke();
        context.fillStyle = look("--ink");
        context.fillText(words, x, y);
      }
    }
    function tell() {
      const { bent, data } = one, f = factor();
      label.hidden = !bent;
      value.textContent = `${digits(f, 3)} ×`;
      if (bent) slider.value = f > 0 ? round(100 * Math.log10(f)) : 0;
      told.textContent = bent ? `Deflection of the shafts drawn ${digits(f, 3)} times as large; maximum displacement ${digits(bent.largest, 3)} µm. Bearings are shown in their unloaded position.` : "The deflection of the shafts comes with the next results.";
      canvas.setAttribute("aria-label", `Gearbox: shafts ${Object.keys(data.places).join(", ")}; meshes ${Object.keys(data.meshes).join(", ")}. ${told.textContent}`);
    }
    let pressed = null;
    canvas.addEventListener("pointerdown", ({ offsetX, offsetY }) => { pressed = [offsetX, offsetY]; });
    canvas.addEventListener("click", ({ offsetX, offsetY }) => {
      if (pressed && hypot(offsetX - pressed[0], offsetY - pressed[1]) > 5) return; // it was turned
      const [pair, off] = one.places.map(([name, x, y]) => [name, hypot(offsetX - x, offsetY - y)]).sort((a, b) => a[1] - b[1])[0] ?? [];
      if (off <= NEAR) fegearMiddle.choose(pair);
    });
    new ResizeObserver(() => draw()).observe(stage);
    let due = 0;
    one.soon = () => { due ||= requestAnimationFrame(() => { due = 0; if (one.data) { tell(); draw(); } }); };
    one.set = (data) => {
      one.data = data;
      pairs.replaceChildren(...Object.keys(data.meshes).map((pair) => fegearGears.button(`Open pair ${pair}`, "Its gears in mesh", () => fegearMiddle.choose(pair))));
      one.soon();
    };
    return one;
  }
  const fits = (bent, data) => bent && bent.moved.length === data.bodies.length && bent.moved.every((one, i) => one.shape[0] === data.bodies[i].z.length);
  const take = () => { if (kept?.data) { kept.bent = fits(waiting, kept.data) ? waiting : null; kept.soon(); } };
  fegearFigure.dark.addEventListener("change", () => kept?.soon());
  return {
    show(data) {
      if (!data) { if (kept) fegearMiddle.remove("gearbox"); kept = null; return; }
      if (!kept?.host.isConnected) {
        kept = boxOf();
        fegearMiddle.add("gearbox", kept.host, "gearbox", () => {});
      }
      kept.set(data);
      take();
    },
    meshed(content) { waiting = { ...content, moved: content.moved.map(fegearLayers.unpack) }; take(); },
    of: () => kept, // for tests
  };
})();
