"use strict";
// The page's own script: unpacks the files that the page carries, draws the plots from their columns, hands files out.
// Everything it needs is in the page; it asks no one for anything.
(() => {
  const $ = (id) => document.getElementById(id);
  const bytes = (base64) => Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
  const unpack = async (data, kind) =>
    new Uint8Array(await new Response(new Blob([data]).stream().pipeThrough(new DecompressionStream(kind))).arrayBuffer());

  // ---- files: a ZIP archive in the link "download all" -------------------------------------------------------------
  const files = new Map();
  const link = $("all-files");
  if (link) {
    const data = bytes(link.href.slice(link.href.indexOf(",") + 1));
    const view = new DataView(data.buffer);
    let end = data.length - 22;
    while (view.getUint32(end, true) !== 0x06054b50) end -= 1;
    let at = view.getUint32(end + 16, true);
    for (let i = view.getUint16(end + 10, true); i > 0; i -= 1) {
      const size = view.getUint32(at + 20, true), name = view.getUint16(at + 28, true);
      const local = view.getUint32(at + 42, true);
      const start = local + 30 + view.getUint16(local + 26, true) + view.getUint16(local + 28, true);
      files.set(new TextDecoder().decode(data.subarray(at + 46, at + 46 + name)), data.subarray(start, start + size));
      at += 46 + name + view.getUint16(at + 30, true) + view.getUint16(at + 32, true);
    }
    // A blob instead of the long address: browsers bound the length of those.
    link.addEventListener("click", (event) => { event.preventDefault(); handOut(data, link.download, "application/zip"); });
  }
  const content = (name) => unpack(files.get(name), "deflate-raw");

  function handOut(data, name, kind) {
    const made = document.createElement("a");
    made.href = URL.createObjectURL(new Blob([data], { type: kind }));
    made.download = name.split("/").pop();
    made.click();
    setTimeout(() => URL.revokeObjectURL(made.href), 10000);
  }

  document.querySelectorAll("button[data-file]").forEach((button) => button.addEventListener("click", async () => {
    const name = button.dataset.file;
    handOut(await content(name), name, name.endsWith(".csv") ? "text/csv" : "application/octet-stream");
  }));

  // ---- tables ------------------------------------------------------------------------------------------------------
  function rowsOf(text) { // RFC 4180
    const rows = [];
    let row = [], cell = "", quoted = false;
    for (let i = 0; i < text.length; i += 1) {
      const c = text[i];
      if (quoted) {
        if (c !== '"') cell += c;
        else if (text[i + 1] === '"') { cell += c; i += 1; } else quoted = false;
      } else if (c === '"') quoted = true;
      else if (c === ",") { row.push(cell); cell = ""; }
      else if (c === "\n") { row.push(cell); rows.push(row); row = []; cell = ""; }
      else cell += c;
    }
    return rows;
  }
  const tables = new Map();
  function table(name) {
    if (!tables.has(name)) tables.set(name, content(name).then((data) => rowsOf(new TextDecoder().decode(data)).slice(1)));
    return tables.get(name);
  }
  const number = (cell) => (cell === "" || cell === "nan" ? null : Number(cell));
  const numeric = (cell) => cell !== "" && (cell === "nan" || Number.isFinite(Number(cell)) || /^-?inf$/.test(cell));
  const superscript = (text) => text.replace(/[-\d]/g, (c) => "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"["-0123456789".indexOf(c)]);
  function shown(cell) {
    if (!numeric(cell)) return cell;
    if (cell === "nan") return "none";
    if (/^-?\d+$/.test(cell)) return cell.replace("-", "−");
    const value = Number(cell);
    const size = Math.abs(value);
    if (size !== 0 && (size < 1e-4 || size >= 1e6)) {
      const [mantissa, power] = value.toExponential(5).split("e");
      return `${Number(mantissa)}·10${superscript(String(Number(power)))}`.replace("-", "−");
    }
    return String(Number(value.toPrecision(6))).replace("-", "−");
  }
  document.querySelectorAll("div.data").forEach((block) => {
    const body = block.querySelector("tbody"), more = block.querySelector(".more");
    const preview = body.rows.length;
    let all = !more, sorted = null;
    async function fill() {
      let rows = await table(block.dataset.file);
      if (sorted) {
        const { column, down } = sorted;
        const words = rows.some((row) => !numeric(row[column]) && row[column] !== "");
        const order = words ? (a, b) => a[column].localeCompare(b[column], "en") : (a, b) => number(a[column]) - number(b[column]);
        rows = [...rows].sort((a, b) => (down ? order(b, a) : order(a, b)));
      }
      body.replaceChildren(...(all ? rows : rows.slice(0, preview)).map((row) => {
        const line = document.createElement("tr");
        line.append(...row.map((cell) => { const td = document.createElement("td"); td.textContent = shown(cell); return td; }));
        return line;
      }));
    }
    if (more) {
      const label = more.textContent;
      more.addEventListener("click", () => { all = !all; more.textContent = all ? "Show the first rows" : label; fill(); });
    }
    block.querySelectorAll("th").forEach((head, column) => head.querySelector("button").addEventListener("click", () => {
      sorted = { column, down: sorted && sorted.column === column ? !sorted.down : false };
      block.querySelectorAll("th").forEach((other) => other.removeAttribute("aria-sort"));
      head.setAttribute("aria-sort", sorted.down ? "descending" : "ascending");
      fill();
    }));
  });

  // ---- paper: nobody can click on it, so what is folded opens ------------------------------------------------------
  let opened = [];
  addEventListener("beforeprint", () => {
    opened = [...document.querySelectorAll("details:not([open])")];
    opened.forEach((fold) => { fold.open = true; });
  });
  addEventListener("afterprint", () => opened.forEach((fold) => { fold.open = false; }));

  // ---- figures -----------------------------------------------------------------------------------------------------
  const dark = matchMedia("(prefers-color-scheme: dark)");
  const printing = matchMedia("print");
  const SHADES = { // Okabe and Ito's palette, and lighter shades of it on dark ground
    light: { blue: "#0072B2", orange: "#E69F00", green: "#009E73", red: "#D55E00", purple: "#CC79A7", sky: "#56B4E9",
      ink: "#1c2430", grey: "#8a94a3", grid: "#e3e8ee", paper: "#ffffff" },
    dark: { blue: "#4fa8e0", orange: "#f0b429", green: "#2fc79a", red: "#f07c38", purple: "#dc96bf", sky: "#8fd0f5",
      ink: "#e6eaf0", grey: "#94a0b0", grid: "#2f3946", paper: "#161b22" },
  };
  const RAMPS = {
    light: ["#bddf26", "#5ec962", "#21918c", "#31688e", "#443983", "#440154"],
    dark: ["#fde725", "#a0da39", "#4ac16d", "#1fa187", "#3b8fb5", "#8a86d6"],
  };
  const VIRIDIS = ["#440154", "#443983", "#31688e", "#21918c", "#35b779", "#90d743", "#fde725"];
  const DIVERGING = ["#0072B2", "#8FC1E3", "#FFFFFF", "#F2C46D", "#E69F00"];
  const even = (colours) => colours.map((colour, i) => [i / (colours.length - 1), colour]);
  const rgb = (hex) => [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16));
  const theme = () => (dark.matches && !printing.matches ? "dark" : "light");
  function colour(name, mode) {
    if (typeof name !== "string" || name[0] !== "@") return name;
    const [told, alpha] = name.slice(1).split("/");
    const [kind, share] = told.split(":");
    let hex = SHADES[mode][kind];
    if (kind === "ramp") {
      const steps = RAMPS[mode], at = Number(share) * (steps.length - 1), i = Math.min(Math.floor(at), steps.length - 2);
      const a = rgb(steps[i]), b = rgb(steps[i + 1]);
      hex = `#${a.map((v, k) => Math.round(v + (at - i) * (b[k] - v)).toString(16).padStart(2, "0")).join("")}`;
    }
    return alpha ? `rgba(${rgb(hex).join(",")},${alpha})` : hex;
  }

  async function resolve(of) { // references to columns, see figure.py
    if (!of || of.$ === undefined) return of;
    const parts = async (list) => Promise.all(list.map(resolve));
    if (of.$ === "column") {
      let rows = await table(`tables/${of.table}.csv`);
      for (const [index, wanted] of of.where || []) {
        const test = !Array.isArray(wanted) ? (cell) => cell === wanted
          : wanted[0] === "min" ? (cell) => Number(cell) >= wanted[1]
          : wanted[0] === "max" ? (cell) => Number(cell) <= wanted[1]
          : (cell) => cell !== "nan" && (wanted[1] === null || Number(cell) >= wanted[1]) && (wanted[2] === null || Number(cell) < wanted[2]);
        rows = rows.filter((row) => test(row[index]));
      }
      const cells = rows.map((row) => row[of.column]);
      return cells.some((cell) => cell !== "" && !numeric(cell)) ? cells : cells.map(number);
    }
    if (of.$ === "size") { const [a, b] = await parts(of.of); return a.map((v, i) => Math.hypot(v, b[i])); }
    if (of.$ === "log") return (await resolve(of.of)).map((v) => Math.log10(v));
    if (of.$ === "short") return (await resolve(of.of)).map((v) => String(Number(v.toPrecision(5))));
    if (of.$ === "rows") { const list = await parts(of.of); return list[0].map((_, i) => list.map((one) => one[i])); }
    if (of.$ === "centred") {
      const values = await resolve(of.of);
      const mean = values.reduce((sum, v) => sum + v, 0) / values.length;
      return values.map((v) => v - mean);
    }
    if (of.$ === "unique") return [...new Set(await resolve(of.of))];
    if (of.$ === "by") {
      const keys = await resolve(of.key), values = await resolve(of.values), found = new Map();
      const better = of.how === "max" ? Math.max : Math.min;
      keys.forEach((key, i) => found.set(key, found.has(key) ? better(found.get(key), values[i]) : values[i]));
      return [...found.values()];
    }
    if (of.$ === "grid") {
      const rows = await resolve(of.rows), columns = await resolve(of.columns), values = await resolve(of.values);
      const up = [...new Set(rows)], across = [...new Set(columns)];
      const grid = up.map(() => across.map(() => null));
      values.forEach((value, i) => { grid[up.indexOf(rows[i])][across.indexOf(columns[i])] = value; });
      return grid;
    }
    if (of.$ === "coordinates") {
      const uprights = await Promise.all(of.of.map(async (one) => ({ ...one, values: await resolve(one.values) })));
      return (uprights[0].values).flatMap((_, row) => [...uprights.map((one) => {
        const value = one.values[row];
        if (of.part === "x") return one.label;
        if (of.part === "text") return value === null ? "none" : shown(String(value));
        if (value === null) return null;
        if (one.names) return one.names.length < 2 ? 0.5 : one.names.indexOf(String(value)) / (one.names.length - 1);
        return one.high > one.low ? (value - one.low) / (one.high - one.low) : 0.5;
      }), null]);
    }
    throw new Error(`unknown reference ${of.$}`);
  }

  async function filled(item) { // a copy with every reference in its place
    if (Array.isArray(item)) return Promise.all(item.map(filled));
    if (item === null || typeof item !== "object") return item;
    if (item.$ !== undefined) return resolve(item);
    const entries = await Promise.all(Object.entries(item).map(async ([key, value]) => [key, await filled(value)]));
    return Object.fromEntries(entries.filter(([, value]) => value !== null));
  }

  function painted(item, mode) { // a copy with every colour in the page's shade
    if (typeof item === "string") {
      if (item === "@ramp") return even(VIRIDIS);
      if (item === "@diverging") return even(DIVERGING);
      return colour(item, mode);
    }
    if (Array.isArray(item)) return item.length > 64 ? item : item.map((one) => painted(one, mode));
    if (item === null || typeof item !== "object") return item;
    return Object.fromEntries(Object.entries(item).map(([key, value]) => [key, painted(value, mode)]));
  }

  const axis = (number) => (number === 1 ? "" : String(number));
  async function traces(spec) {
    const made = [];
    for (const raw of spec.traces) {
      const { band, stems, panel, ...rest } = raw;
      const trace = { ...(await filled(rest)), xaxis: `x${axis(panel)}`, yaxis: `y${axis(panel)}` };
      if (trace.mode === null || trace.mode === undefined) delete trace.mode;
      if (band) {
        const all = await Promise.all(band.map(resolve));
        const [x, y, spread] = all.map((column) => column.filter((_, i) => all.every((one) => one[i] !== null)));
        trace.x = [...x, ...[...x].reverse()];
        trace.y = [...y.map((v, i) => v + spread[i]), ...y.map((v, i) => v - spread[i]).reverse()];
      }
      if (stems) trace.error_y = { type: "data", symmetric: false, array: trace.y.map(() => 0),
        arrayminus: trace.y.map((v) => v * 0.999999), width: 0, thickness: 1 };
      if (trace.type === "histogram") delete trace.y;
      made.push(trace);
    }
    if (spec.menu.length) {
      const first = new Set(spec.menu[0][1]);
      const chosen = new Set(spec.menu.flatMap(([, members]) => members));
      made.forEach((trace, i) => { if (chosen.has(i)) trace.visible = first.has(i); });
    }
    return made;
  }

  function calm(data, number) { // curves that hardly vary are drawn level, not their last digits over the whole height
    const all = data.filter((t) => t.yaxis === `y${axis(number)}` && t.type === "scatter" && t.hoverinfo !== "skip").flatMap((t) => t.y);
    const numbers = all.filter((v) => typeof v === "number" && Number.isFinite(v));
    if (!numbers.length) return {};
    const low = numbers.reduce((a, b) => Math.min(a, b)), high = numbers.reduce((a, b) => Math.max(a, b));
    const size = Math.max(Math.abs(low), Math.abs(high)), middle = (low + high) / 2;
    return high - low < 1e-3 * size ? { range: [middle - 0.05 * size, middle + 0.05 * size] } : {};
  }

  async function layout(spec, data, mode, width) {
    const count = spec.panels.length, narrow = width < 560;
    const weights = spec.panels.map((panel) => panel.height);
    const total = weights.reduce((sum, weight) => sum + weight, 0);
    const first = new Set(spec.menu.length ? spec.menu[0][1] : []), movable = new Set(spec.menu.flatMap(([, list]) => list));
    const named = spec.traces.filter((trace, i) => trace.showlegend && (!movable.has(i) || first.has(i)));
    const names = new Set(named.map((trace) => trace.name));
    const lines = Math.ceil(names.size / (narrow ? 1 : 4));
    const bottom = narrow ? 72 : 56;
    const top = 34 + (spec.menu.length ? 46 : 0) + (names.size > 1 ? 21 * lines - 10 : 0);
    const inner = (count === 1 ? 350 : 240) * total;
    const height = top + inner + bottom + 2 + (count - 1) * 60;
    const gap = (78 / (inner + (count - 1) * 60));
    const room = (1 - gap * (count - 1)) / total;
    const made = {
      height, margin: { l: narrow ? 58 : 74, r: narrow ? 12 : 24, t: top, b: bottom }, showlegend: names.size > 1, barmode: "group",
      hovermode: spec.shared ? "x unified" : "closest", dragmode: narrow ? false : "zoom",
      modebar: { bgcolor: "rgba(0,0,0,0)", color: "@grey", activecolor: "@blue" },
      paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)",
      font: { family: getComputedStyle(document.body).fontFamily, size: 13, color: "@ink" },
      hoverlabel: { bgcolor: "@paper", bordercolor: "@grid", font: { color: "@ink", size: 13 } },
      legend: { orientation: "h", x: 0, xanchor: "left", y: 1 + 8 / (height - top - bottom), yanchor: "bottom", traceorder: "normal" },
      shapes: [], annotations: [],
    };
    let upper = 1;
    for (const [i, panel] of spec.panels.entries()) {
      const name = axis(i + 1), lower = Math.max(0, upper - weights[i] * room);
      const grid = { gridcolor: "@grid", zerolinecolor: "@grid", linecolor: "@grey", automargin: true, minexponent: 5, ticks: "outside", ticklen: 4, tickcolor: "@grid" };
      const broken = narrow ? panel.x.replace(/(.{24,}?) /, "$1<br>") : panel.x;
      const [title, unit] = [panel.x.split(" [")[0], (panel.x.match(/\[(.*)\]$/) || ["", ""])[1]];
      made[`xaxis${name}`] = { ...grid, anchor: `y${name}`, title: { text: broken, standoff: 8, font: { size: 13 } }, hoverformat: ".5~g",
        unifiedhovertitle: { text: `${title} %{x}${unit ? ` ${unit}` : ""}` }, type: panel.logX ? "log" : panel.categories ? "category" : "-",
        domain: [0, 1], exponentformat: "power", ...(i > 0 && panel.x === spec.panels[0].x && !panel.categories ? { matches: "x" } : {}) };
      const level = panel.logY || panel.zero ? {} : calm(data, i + 1);
      made[`yaxis${name}`] = { ...grid, ...level, anchor: `x${name}`, title: { text: panel.y, standoff: 8, font: { size: 13 } }, domain: [lower, upper],
        type: panel.logY ? "log" : "-", exponentformat: "power", ...(panel.zero ? { rangemode: "tozero" } : {}),
        ...(panel.limits ? { range: panel.limits } : {}),
        ...(panel.bare ? { visible: false, range: [-0.12, 1.12], fixedrange: true } : {}) };
      if (panel.bare) Object.assign(made[`xaxis${name}`], { gridcolor: "@grey", showline: false, tickangle: narrow ? -60 : -20, fixedrange: true });
      if (panel.title) made.annotations.push({ text: `<b>${panel.title}</b>`, xref: "paper", yref: "paper", x: 0, xanchor: "left",
        y: upper, yanchor: "bottom", yshift: 2, showarrow: false });
      for (const [along, at, label] of panel.marks) {
        const value = await resolve(at), across = along === "x" ? "y" : "x";
        const where = { [`${along}0`]: value, [`${along}1`]: value, [`${across}0`]: 0, [`${across}1`]: 1 };
        made.shapes.push({ type: "line", [`${along}ref`]: `${along}${name}`, [`${across}ref`]: `${across}${name} domain`, ...where,
          line: { color: "@grey", width: 1.2, dash: "dot" } });
        if (label) made.annotations.push({ text: label, [`${along}ref`]: `${along}${name}`, [`${across}ref`]: `${across}${name} domain`,
          [along]: (along === "x" ? panel.logX : panel.logY) ? Math.log10(value) : value, [across]: 1, showarrow: false,
          xanchor: along === "x" ? "left" : "right", yanchor: along === "x" ? "top" : "bottom", xshift: along === "x" ? 4 : 0,
          font: { size: 11, color: "@grey" } });
      }
      upper = lower - gap;
    }
    if (spec.menu.length) made.updatemenus = [{ x: 0, xanchor: "left", y: 1 + (top - 8) / (height - top - bottom), yanchor: "top", direction: "down",
      bgcolor: "@paper", bordercolor: "@grid", font: { color: "@ink" }, showactive: true, pad: { t: 0 },
      buttons: spec.menu.map(([label, members, ordinate]) => {
        const chosen = new Set(members);
        const visible = spec.traces.map((_, k) => (movable.has(k) ? chosen.has(k) : true));
        return { label, method: "update", args: [{ visible }, ordinate ? { "yaxis.title.text": ordinate, "yaxis.autorange": true } : {}] };
      }) }];
    return painted(made, mode);
  }

  // Figures come as plotly's own JSON in the shades of light ground; `shades` says what stands for each on dark ground.
  const drawn = [];
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
  const plain = [];
  async function drawPlain(number, again) {
    const shades = JSON.parse($("shades").textContent), mode = theme();
    const spec = shadesOf($("figures").textContent, mode, shades.darker)[number];
    const place = $(`plot-${spec.key}`);
    const look = shadesOf(JSON.stringify(shades.template), mode, shades.darker);
    const layout = fitted(spec.layout, look, place.clientWidth);
    if (again) { // what the reader has hidden or chosen stays so
      const menu = place.layout.updatemenus?.[0];
      spec.data.forEach((trace, i) => { if (place.data[i].visible !== undefined) trace.visible = place.data[i].visible; });
      if (menu?.active) {
        layout.updatemenus[0].active = menu.active;
        for (const [path, value] of Object.entries(layout.updatemenus[0].buttons[menu.active].args[1])) {
          const [name, part] = path.split(".");
          if (part === "title") layout[name] = { ...layout[name], title: { text: value } };
        }
      }
    } else place.replaceChildren();
    place.style.height = `${layout.height}px`; // the room stays taken while plotly fits the plot to a new width
    await (again ? Plotly.react : Plotly.newPlot)(place, spec.data, layout, optionsOf(spec.key));
    if (!again) plain.push(number);
  }

  async function draw(spec) {
    const place = $(`plot-${spec.key}`);
    const data = await traces(spec), mode = theme();
    // The buttons are named one by one: plotly's own choice holds one that sends the data away.
    const options = { responsive: true, displaylogo: false, showTips: false, displayModeBar: "hover", plotlyServerURL: "",
      modeBarButtons: [["toImage"], ["zoom2d", "pan2d", "resetScale2d"]],
      toImageButtonOptions: { format: "svg", filename: spec.key } };
    place.replaceChildren();
    const axes = await layout(spec, data, mode, place.clientWidth);
    place.style.height = `${axes.height}px`; // the room stays taken while plotly fits the plot to a new width
    await Plotly.newPlot(place, painted(data, mode), axes, options);
    drawn.push({ spec, place, data, options });
  }
  async function repaint() {
    for (const number of plain) await drawPlain(number, true);
    const mode = theme();
    for (const { spec, place, data, options } of drawn) {
      const hidden = place.data.map((trace) => trace.visible);
      const again = painted(data, mode).map((trace, i) => (hidden[i] === undefined ? trace : { ...trace, visible: hidden[i] }));
      const axes = await layout(spec, data, mode, place.clientWidth);
      place.style.height = `${axes.height}px`;
      await Plotly.react(place, again, axes, options);
    }
  }

  async function start() {
    const specs = JSON.parse($("figures").textContent);
    if (!specs.length) return;
    if ($("plotly-missing")) throw new Error($("plotly-missing").textContent);
    const script = document.createElement("script");
    script.textContent = new TextDecoder().decode(await unpack(bytes($("plotly").textContent), "gzip"));
    document.head.append(script);
    for (const [number, spec] of specs.entries()) {
      await (spec.data ? drawPlain(number, false) : draw(spec));
      await new Promise((done) => { setTimeout(done, 0); }); // the page stays alive between two plots
    }
    dark.addEventListener("change", repaint);
    printing.addEventListener("change", repaint);
  }
  start().then(
    () => { document.documentElement.dataset.ready = "yes"; },
    (problem) => {
      document.documentElement.dataset.ready = "no";
      const why = $("plotly-missing") ? problem.message : `This browser cannot draw the plots (${problem.message}).`;
      document.querySelectorAll(".plot").forEach((place) => {
        if (!place.querySelector(".main-svg")) place.textContent = `${why} The same pictures are in the folder plots/.`;
      });
      if (!$("plotly-missing")) throw problem;
    },
  );
})();
