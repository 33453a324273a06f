"use strict";
// The gears in mesh as they are shown, as one SVG file: outlines, loads and letters as lines, stress as the picture that it is.
const fegearSaved = (() => {
  const SVG = "http://www.w3.org/2000/svg";
  const LOOK = ["fill", "fill-opacity", "stroke", "stroke-width", "stroke-dasharray", "stroke-linejoin", "paint-order", "opacity", "vector-effect", "font-family"];
  const seen = (one) => !one.hidden && getComputedStyle(one).visibility !== "hidden" && one.getClientRects().length > 0;
  const made = (tag, attributes, parent, text) => {
    const one = document.createElementNS(SVG, tag);
    for (const [name, value] of Object.entries(attributes)) one.setAttribute(name, value);
    if (text !== undefined) one.textContent = text;
    parent?.append(one);
    return one;
  };
  /** A copy of a drawing that looks the same without the page's styles; what is hidden stays out. */
  function copied(drawing) {
    const copy = drawing.cloneNode(true), places = [...copy.querySelectorAll("*")];
    [...drawing.querySelectorAll("*")].forEach((one, i) => {
      const look = getComputedStyle(one);
      if (look.visibility === "hidden" || look.display === "none") return places[i].remove();
      places[i].removeAttribute("class");
      for (const name of LOOK) places[i].style.setProperty(name, look.getPropertyValue(name));
    });
    copy.removeAttribute("class");
    return copy;
  }
  /** A scale of colours below the drawing: its words, and a bar between its ends. */
  function scaled(scale, y, colour, id, host) {
    const [title, low, bar, high] = scale.children, style = { y: y + 11, "font-size": 12, "font-family": "sans-serif", fill: colour };
    made("text", { x: 8, ...style }, host, title.textContent);
    made("text", { x: 258, "text-anchor": "end", ...style }, host, low.textContent);
    made("text", { x: 406, ...style }, host, high.textContent);
    const shades = bar.style.background.match(/rgba?\([^)]*\)|#[0-9a-f]+/gi) ?? [], run = made("linearGradient", { id }, made("defs", {}, host));
    shades.forEach((shade, i) => made("stop", { offset: i / Math.max(1, shades.length - 1), "stop-color": shade }, run));
    made("rect", { x: 264, y, width: 136, height: 12, fill: `url(#${id})` }, host);
  }
  /** The whole of a stage as text. */
  function text(stage) {
    const { width, height } = stage.getBoundingClientRect(), look = getComputedStyle(document.body), colour = look.color;
    const scales = [...stage.querySelectorAll(".mesh-scale")].filter((one) => seen(one) && one.children.length === 4), tall = height + 20 * scales.length;
    const host = made("svg", { xmlns: SVG, width, height: tall, viewBox: `0 0 ${width} ${tall}` });
    made("rect", { width, height: tall, fill: look.backgroundColor }, host);
    for (const canvas of stage.querySelectorAll("canvas")) {
      if (seen(canvas) && canvas.width > 1) made("image", { width, height, preserveAspectRatio: "none", href: canvas.toDataURL("image/png") }, host);
    }
    const drawing = copied(stage.querySelector("svg.mesh"));
    for (const [name, value] of Object.entries({ x: 0, y: 0, width, height })) drawing.setAttribute(name, value);
    host.append(drawing);
    const loads = stage.querySelector(".loads");
    if (seen(loads)) made("text", { x: 8, y: 18, "font-size": 13, "font-family": "sans-serif", fill: colour }, host, loads.textContent);
    scales.forEach((scale, i) => scaled(scale, height + 20 * i + 2, colour, `scale-${i}`, host));
    return new XMLSerializer().serializeToString(host);
  }
  return {
    text,
    /** Saves the gears that are shown; false where none are. */
    gears(name) {
      const stage = [...document.querySelectorAll(".mesh-stage")].find((one) => one.querySelector("svg.mesh") && seen(one));
      if (!stage) return false;
      const link = document.createElement("a"), url = URL.createObjectURL(new Blob([text(stage)], { type: "image/svg+xml" }));
      Object.assign(link, { href: url, download: `${name}_gears.svg` }).click();
      setTimeout(() => URL.revokeObjectURL(url), 1000);
      return true;
    },
  };
})();
