"use strict";
// What a lecture draws at two gears in mesh: pitch, base and tip circles, and the line of action between its points of tangency.
const fegearCircles = (() => {
  const SVG = "http://www.w3.org/2000/svg";
  const put = (tag, attributes, parent, text) => {
    const one = document.createElementNS(SVG, tag);
    for (const [name, value] of Object.entries(attributes)) one.setAttribute(name, value);
    if (text !== undefined) one.textContent = text;
    parent.append(one);
    return one;
  };
  /** Centre above the pitch point, radii [mm] and place of the point of tangency on the line of action, of a gear in mesh. */
  function of(data, member) {
    const driver = member === "driver", working = 1e3 * data[`${member}_radius`], centre = driver ? -working : working;
    const ring = driver ? data.pressure_angle < 0 : working < 0 && data.pressure_angle > 0;
    const radii = data[member][0].map((x, i) => Math.hypot(1e3 * x, 1e3 * data[member][1][i] - centre));
    return {
      centre, pitch: Math.abs(working), base: Math.abs(1e3 * data[`${member}_base`]),
      tip: radii.reduce((most, one) => (ring ? Math.min(most, one) : Math.max(most, one))), tangent: centre * Math.sin(data.pressure_angle),
    };
  }
  /** Draws them; up has the ordinate upwards, letters stand in the picture itself. */
  function draw(data, up, picture, { wide, tall, unit }) {
    const lines = put("g", { class: "circles" }, up), letters = put("g", { class: "circles" }, picture);
    const both = ["driver", "driven"].map((member) => [member, of(data, member)]), [c, s] = [Math.cos(data.pressure_angle), Math.sin(data.pressure_angle)];
    for (const [member, one] of both) for (const kind of ["pitch", "base", "tip"]) put("circle", { cx: 0, cy: one.centre, r: one[kind], class: `${member} round ${kind}` }, lines);
    const [first, second] = both.map(([, one]) => one.tangent);
    put("line", { x1: first * c, y1: first * s, x2: second * c, y2: second * s, class: "action" }, lines);
    both.forEach(([member, { tangent }], i) => {
      put("circle", { cx: tangent * c, cy: tangent * s, r: 0.07 * unit, class: "point" }, lines);
      put("text", { x: tangent * c + 0.12 * unit, y: -tangent * s + 0.45 * unit, "font-size": 0.36 * unit }, letters, `T${i + 1}`);
      put("text", { x: 0.97 * wide, y: (i ? -0.62 : 0.92) * tall, "font-size": 0.42 * unit, "text-anchor": "end", "stroke-width": 0.14 * unit, class: `name of-${member}` }, letters, member);
    });
  }
  return { of, draw, words: "Circles: working pitch (dash-dotted), base (dashed), tip (dotted); T1 and T2: where the line of action is tangent to the base circles of driver and driven gear." };
})();
