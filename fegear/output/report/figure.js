"use strict";
// What every page does with a figure before plotly draws it: shades for light or dark ground, room, buttons.
const fegearFigure = (() => {
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const printing = matchMedia("print");
  const theme = () => (dark.matches && !printing.matches ? "dark" : "light");
  // Figures come as plotly's own JSON in the shades of light ground; `darker` says what stands for each on dark ground.
  const shadesOf = (text, mode, darker) =>
    JSON.parse(mode === "dark" ? text.replace(/#[0-9A-F]{6}/g, (shade) => darker[shade] ?? shade) : text);
  function fitted(layout, look, width) { // on narrow screens every name of the legend has a line of its own
    const { names, inner, beside } = layout.meta, narrow = width < 560;
    const more = narrow && names > 1 ? 21 * (names - Math.ceil(names / beside)) : 0, below = narrow ? 16 : 0;
    const made = { ...layout, template: look, dragmode: narrow ? false : "zoom", height: layout.height + more + below,
      font: { family: getComputedStyle(document.body).fontFamily },
      margin: { ...layout.margin, t: layout.margin.t + more, b: layout.margin.b + below, ...(narrow ? { l: 58, r: 12 } : {}) } };
    if (layout.updatemenus) made.updatemenus = layout.updatemenus.map((menu) => ({ ...menu, y: menu.y + more / inner }));
    if (narrow) for (const [name, axis] of Object.entries(layout)) {
      if (name.startsWith("xaxis")) made[name] = { ...axis, title: { text: axis.title.text.replace(/(.{24,}?) /, "$1<br>") } };
    }
    return made;
  }
  function optionsOf(key) {
    // The buttons are named one by one: plotly's own choice holds one that sends the data away.
    return { responsive: true, displaylogo: false, showTips: false, displayModeBar: "hover", plotlyServerURL: "",
      modeBarButtons: [["toImage"], ["zoom2d", "pan2d", "resetScale2d"]],
      toImageButtonOptions: { format: "svg", filename: key } };
  }
  async function draw(place, spec, look, again) {
    const layout = fitted(spec.layout, look, place.clientWidth);
    if (again && place.data.length === spec.data.length) { // what the reader has hidden or chosen stays so
      const menu = place.layout.updatemenus?.[0];
      spec.data.forEach((trace, i) => { if (place.data[i]?.visible !== undefined) trace.visible = place.data[i].visible; });
      if (menu?.active && layout.updatemenus) {
        layout.updatemenus[0].active = menu.active;
        for (const [path, value] of Object.entries(layout.updatemenus[0].buttons[menu.active]?.args[1] ?? {})) {
          const [name, part] = path.split(".");
          if (!part) layout[name] = value; // words and marks of this view
          if (part === "title") layout[name] = { ...layout[name], title: { text: value } };
        }
      }
    } else if (!again) place.replaceChildren();
    place.style.height = `${layout.height}px`; // the room stays taken while plotly fits the plot to a new width
    await (again ? Plotly.react : Plotly.newPlot)(place, spec.data, layout, optionsOf(spec.key));
  }
  function drop(element) { // else the window's own listeners hold every plot that was ever drawn
    for (const plot of element.querySelectorAll(".js-plotly-plot")) Plotly.purge(plot);
    element.remove();
  }
  return { dark, printing, theme, shadesOf, draw, drop };
})();
