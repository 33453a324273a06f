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
  document.querySelectorAll("div.data:not(.side, .brief)").forEach((block) => {
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
      const texts = [...block.querySelectorAll("th")].map((head) => head.className);
      body.replaceChildren(...(all ? rows : rows.slice(0, preview)).map((row) => {
        const line = document.createElement("tr");
        line.append(...row.map((cell, k) => { const td = document.createElement("td"); td.textContent = shown(cell); td.className = texts[k]; return td; }));
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
  const { dark, printing, theme, shadesOf, draw } = fegearFigure;
  function shadedFigures() {
    const shades = JSON.parse($("shades").textContent), mode = theme();
    return [shadesOf($("figures").textContent, mode, shades.darker), shadesOf(JSON.stringify(shades.template), mode, shades.darker)];
  }
  async function repaint() {
    const [specs, look] = shadedFigures();
    for (const spec of specs) await draw($(`plot-${spec.key}`), spec, look, true);
  }

  async function start() {
    const [specs, look] = shadedFigures();
    if (!specs.length) return;
    if ($("plotly-missing")) throw new Error($("plotly-missing").textContent);
    const script = document.createElement("script");
    script.textContent = new TextDecoder().decode(await unpack(bytes($("plotly").textContent), "gzip"));
    document.head.append(script);
    for (const spec of specs) {
      await draw($(`plot-${spec.key}`), spec, look, false);
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
