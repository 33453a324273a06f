"use strict";
// A tooth of either gear with a width, in space: its loaded flank in the colours of the pressure that every place has while
// it is in contact, and the contact lines of the present roll position over it. The pointer turns it.
const fegearFlanks = (() => {
  const FACE = 30, HEIGHT = 16; // patches of a flank
  const { cos, sin, sqrt, hypot, atan, atan2, min, max, PI } = Math;
  const involute = (radius, base) => { const t = sqrt(max(0, (radius / base) ** 2 - 1)); return t - atan(t); };
  function at(xs, ys, x, beside = 1e-9) { // between points whose places grow; NaN farther beside them than that
    const last = xs.length - 1;
    if (last < 0 || x < xs[0] - beside || x > xs[last] + beside) return NaN;
    let i = 1;
    while (i < last && xs[i] < x) i += 1;
    const h = xs[i] - xs[i - 1];
    return last === 0 || !(h > 0) ? ys[min(i, last)] : ys[i - 1] + (ys[i] - ys[i - 1]) * max(0, min(1, (x - xs[i - 1]) / h));
  }
  function covered(sent, side) { // pressure at places of the flank: [face][height], from contact lines one after the other
    const [form, tip] = sent.ends[side ? "driven" : "driver"], columns = Array.from({ length: FACE }, () => []);
    sent.positions.forEach((lines) => lines.forEach((line) => {
      const order = line[1].map((_, i) => i).sort((a, b) => line[1][a] - line[1][b]);
      const [zs, rs, ps] = [1, 2 + side, 4].map((part) => order.map((i) => line[part][i]));
      columns.forEach((column, i) => {
        const z = sent.low + (i + 0.5) / FACE * (sent.high - sent.low), r = at(zs, rs, z);
        if (!Number.isNaN(r)) column.push([r, at(zs, ps, z)]);
      });
    }));
    return columns.map((column) => {
      column.sort((a, b) => a[0] - b[0]);
      const rs = column.map((one) => one[0]), ps = column.map((one) => one[1]);
      const apart = 1.2 * max(0, ...rs.slice(1).map((r, i) => r - rs[i])); // the last line of a section ends somewhat before the edge
      return Array.from({ length: HEIGHT }, (_, j) => at(rs, ps, form + (j + 0.5) / HEIGHT * (tip - form), apart));
    });
  }
  function solid(data, member) { // outline of a tooth in the middle of the face: [radius, angle from its flank at the working pitch circle]
    const way = member === "driver" ? 1 : -1, radius = data[`${member}_radius`] * 1e3, pitch = data.base_pitch / data[`${member}_base`];
    const [xs, ys] = data[member], found = [];
    let px = Infinity, py = 0;
    xs.forEach((x, i) => {
      const u = way * x * 1e3, v = way * ys[i] * 1e3 + radius, angle = atan2(u, v);
      if (angle > 0.25 * pitch || angle < -0.75 * pitch || hypot(u - px, v - py) < 0.06e3 * data.module) return;
      [px, py] = [u, v];
      found.push([hypot(u, v), angle]);
    });
    return found;
  }
  function tooth(context, box, member, data, sent, made, place, turned, look) {
    const side = member === "driver" ? 0 : 1, [form, tip] = sent.ends[member], base = data[`${member}_base`] * 1e3;
    const alpha = involute(data[`${member}_radius`] * 1e3, base), twist = data.twist / base, middle = 0.5 * (form + tip), scale = fegearLayers.shades("pressure");
    const [cy, sy, cp, sp] = [cos(turned.yaw), sin(turned.yaw), cos(turned.pitch), sin(turned.pitch)];
    const reach = 0.5 * hypot(sent.high - sent.low, 1.8 * (tip - form)), zoom = 0.42 * min(box.w, 1.5 * box.h) / reach;
    const seen = (r, angle, z) => { // on the page, and how near
      const turn = angle - z * twist, x = r * sin(turn), y = r * cos(turn) - middle;
      const across = -x * sy + z * cy, off = x * cy + z * sy;
      return [box.x + box.w / 2 - zoom * across, box.y + box.h / 2 - zoom * (y * cp - off * sp), off * cp + y * sp];
    };
    const onFlank = (r, z) => seen(r, alpha - involute(r, base), z);
    const patches = [];
    const patch = (corners, fill, nearer = 0) => patches.push([corners.reduce((sum, one) => sum + one[2], 0) / corners.length + nearer, corners, fill]);
    const ink = look.getPropertyValue("--soft"), paper = look.getPropertyValue("--paper"), outline = made.outline, parts = 8;
    const zs = Array.from({ length: parts + 1 }, (_, i) => sent.low + i / parts * (sent.high - sent.low));
    for (let i = 1; i < outline.length; i += 1) {
      for (let k = 0; k < parts; k += 1) patch([[i - 1, k], [i, k], [i, k + 1], [i - 1, k + 1]].map(([n, m]) => seen(...outline[n], zs[m])), paper);
    }
    const thick = made.columns.length ? (sent.high - sent.low) / FACE : 0, high = (tip - form) / HEIGHT;
    made.columns.forEach((column, i) => column.forEach((value, j) => {
      if (Number.isNaN(value)) return;
      const z = sent.low + i * thick, r = form + j * high;
      patch([onFlank(r, z), onFlank(r, z + thick), onFlank(r + high, z + thick), onFlank(r + high, z)], fegearLayers.shade(scale, value / (sent.limit || 1)), 0.12 * (tip - form));
    }));
    patches.sort((a, b) => a[0] - b[0]);
    context.lineWidth = 0.8;
    context.lineJoin = "round";
    context.save();
    context.beginPath();
    context.rect(box.x, box.y, box.w, box.h);
    context.clip(); // what sticks out is not drawn over the other tooth
    const path = (corners) => { context.beginPath(); corners.forEach(([x, y], i) => i ? context.lineTo(x, y) : context.moveTo(x, y)); };
    for (const [, corners, fill] of patches) {
      path(corners);
      context.fillStyle = context.strokeStyle = fill;
      context.fill();
      context.stroke();
    }
    context.strokeStyle = ink;
    const near = seen(middle, 0, sent.high)[2] > seen(middle, 0, sent.low)[2] ? sent.high : sent.low;
    path(outline.map((one) => seen(...one, near))); // the end that is seen
    context.fillStyle = look.getPropertyValue("--raised");
    context.fill();
    context.stroke();
    for (const end of [form, tip]) { path(zs.map((z) => onFlank(end, z))); context.stroke(); }
    // contact lines: of the nearest computed position, moved on along the line of action
    const far = sent.roll.map((one) => Math.abs(((place - one) % 1 + 1.5) % 1 - 0.5)), p = far.indexOf(min(...far));
    const on = (((place - sent.roll[p]) % 1 + 1.5) % 1 - 0.5) * data.base_pitch * (side ? -1e3 : 1e3);
    for (const line of sent.positions[p]) {
      const corners = line[1].map((z, i) => {
        const r = hypot(base, sqrt(max(0, line[2 + side][i] ** 2 - base * base)) + on);
        return r < form - 1e-6 || r > tip + 1e-6 ? null : onFlank(r, z);
      }).filter(Boolean);
      for (const [width, colour] of [[5, paper], [2.4, look.getPropertyValue("--ink")]]) {
        context.lineWidth = width;
        context.strokeStyle = colour;
        path(corners);
        context.stroke();
      }
    }
    context.fillStyle = look.getPropertyValue("--ink");
    context.textAlign = "left";
    context.fillText(member, box.x + 10, box.y + 18);
    context.fillStyle = ink;
    context.textAlign = "center";
    for (const z of [sent.low, sent.high]) {
      const [x, y] = onFlank(form, z), words = `z = ${z.toFixed(1)} mm`.replace("-", "−"), room = context.measureText(words).width / 2 + 4;
      context.fillText(words, max(box.x + room, min(box.x + box.w - room, x)), min(box.y + box.h - 5, y + 15));
    }
    context.restore();
    return max(0, ...sent.positions[p].flatMap((line) => line[4]));
  }
  const kept = new WeakMap(); // what was sent -> what is drawn of it
  function draw(canvas, data, sent, place, turned) {
    const size = canvas.getBoundingClientRect(), ratio = devicePixelRatio || 1;
    const wide = Math.round(size.width * ratio), tall = Math.round(size.height * ratio);
    if (canvas.width !== wide || canvas.height !== tall) Object.assign(canvas, { width: wide, height: tall });
    const context = canvas.getContext("2d"), look = getComputedStyle(canvas);
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, size.width, size.height);
    context.font = `12px ${look.fontFamily}`;
    const members = ["driver", "driven"].filter((member) => data[`${member}_base`] > 0); // not the hollow flank of a ring gear
    if (!kept.has(sent)) kept.set(sent, Object.fromEntries(members.map((member) => [member, { columns: covered(sent, member === "driver" ? 0 : 1), outline: solid(data, member) }])));
    const w = size.width / members.length;
    return max(...members.map((member, i) => tooth(context, { x: i * w, y: 0, w, h: size.height }, member, data, sent, kept.get(sent)[member], place, turned, look)));
  }
  function turns(canvas, redraw) { // by pointer and arrow keys
    const turned = { yaw: 0.5, pitch: 0.5 }, by = (x, y) => { turned.yaw += x; turned.pitch = max(-PI / 2, min(PI / 2, turned.pitch + y)); redraw(); };
    canvas.tabIndex = 0;
    canvas.title = "Drag, or arrow keys: turn";
    canvas.onpointerdown = ({ pointerId }) => canvas.setPointerCapture(pointerId);
    canvas.onpointermove = ({ buttons, movementX, movementY }) => { if (buttons) by(0.012 * movementX, 0.012 * movementY); };
    canvas.onkeydown = (event) => {
      const way = { ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, -0.1], ArrowDown: [0, 0.1] }[event.key];
      if (!way) return;
      event.preventDefault();
      by(...way);
    };
    return turned;
  }
  return { draw, turns, solid, involute };
})();
