"use strict";
// The results side of the page: keeps each task's section, and changes of it what has changed.
const fegear = (() => {
  const $ = (id) => document.getElementById(id);
  const sections = new Map(); // task -> { element, specs, darker, ... }
  const { dark, shadesOf, draw } = fegearFigure;
  let template = null;
  const made = (tag, cls, text) => {
    const one = document.createElement(tag);
    if (cls) one.className = cls;
    if (text !== undefined) one.textContent = text;
    return one;
  };

  // Figures out of sight are painted when they come near it.
  const MARGIN = 200, owners = new WeakMap(), late = new Set();
  const away = new WeakSet();
  function drop(element) { // what is shown no longer is not kept for a later painting either
    for (const figure of late) if (element.contains(figure)) late.delete(figure);
    fegearFigure.drop(element);
  }
  const watch = new IntersectionObserver((entries) => {
    for (const { target, isIntersecting } of entries) {
      if (!isIntersecting) { away.add(target); continue; }
      away.delete(target);
      const { kept, key } = owners.get(target);
      if (late.has(target) && kept.specs.has(key)) line = line.then(() => paint(kept, key));
    }
  }, { rootMargin: `${MARGIN}px` });

  // The server is told which results are in sight: those are computed before the others.
  const owner = new Map(); // figure -> its task
  const seen = new Set();
  let telling = 0;
  const sight = new IntersectionObserver((entries) => {
    for (const { target, isIntersecting } of entries) {
      const { task } = target.dataset, kept = sections.get(task);
      if (isIntersecting) seen.add(task); else seen.delete(task);
      if (isIntersecting && kept?.late) line = line.then(() => put(kept));
    }
    clearTimeout(telling);
    telling = setTimeout(() => emitEvent("sight", { tasks: [...seen].filter((task) => sections.has(task)) }), 300);
  });

  function section(task) {
    if (!sections.has(task)) {
      const element = made("section", "task");
      element.dataset.task = task;
      element.append(made("h2"), made("p", "draft"), made("div", "figures"), made("div", "stills"), made("div", "numbers"));
      element.hidden = true;
      $("results").append(element);
      sight.observe(element);
      sections.set(task, { element, specs: new Map(), drawn: new Map(), darker: {}, late: null, dim: 0 });
    }
    return sections.get(task);
  }

  // A page that flickers at every step of a moved value is no use: only what takes a while is dimmed.
  const AWHILE = 250; // ms
  function wait(kept) {
    kept.dim ||= setTimeout(() => kept.element.classList.add("stale"), AWHILE);
  }
  function answered(kept) {
    clearTimeout(kept?.dim);
    if (kept) kept.dim = 0;
    kept?.element.classList.remove("stale");
  }

  function otherTexts(old, now) { // texts in which two elements differ; null if they differ in more
    if (old.nodeName !== now.nodeName || old.childNodes.length !== now.childNodes.length) return null;
    if (old.nodeType === Node.TEXT_NODE) return old.data === now.data ? [] : [[old, now.data]];
    if (old.attributes && !old.cloneNode().isEqualNode(now.cloneNode())) return null;
    const found = [...old.childNodes].map((one, i) => otherTexts(one, now.childNodes[i]));
    return found.includes(null) ? null : found.flat();
  }
  function renew(host, html) { // made and escaped by the report's own templates
    const now = host.cloneNode();
    now.innerHTML = html;
    const others = otherTexts(host, now);
    if (others) for (const [text, words] of others) text.data = words;
    else host.replaceChildren(...now.childNodes);
  }

  // plotly.js is large: it is fetched once the form can be used, and figures wait for it.
  let fetched = null;
  const plotly = new Promise((there) => { fetched = there; });
  function fetchPlotly(address) {
    const script = Object.assign(made("script"), { src: address, onload: fetched });
    requestAnimationFrame(() => setTimeout(() => document.head.append(script)));
  }

  function refit(host) { // another figure beside them makes columns narrower, or wider where one has gone
    for (const plot of host.querySelectorAll(".js-plotly-plot")) if (plot.clientWidth) Plotly.Plots.resize(plot);
  }

  async function paint(kept, key) { // one figure, in the shades of the ground
    await plotly;
    const spec = kept.specs.get(key), mode = fegearFigure.theme();
    const host = kept.element.querySelector(".figures");
    let figure = [...host.children].find((one) => one.dataset.key === key);
    if (!figure) {
      figure = made("figure", "plot-figure");
      figure.dataset.key = key;
      const plot = made("div", "plot");
      plot.id = `plot-${key}`;
      plot.setAttribute("role", "group"); // plotly's own buttons are in it
      plot.ariaLabel = `${spec.heading}. ${spec.caption}`;
      figure.append(made("div", "plot-title"), plot, made("figcaption"));
      host.append(figure);
      watch.observe(figure);
      refit(host);
    }
    const place = figure.querySelector(".plot"), drawn = place.classList.contains("js-plotly-plot");
    owners.set(figure, { kept, key });
    late.delete(figure);
    const words = `${spec.heading}. ${spec.caption}`;
    if (figure.querySelector(".plot-title").textContent !== spec.heading || place.ariaLabel !== words) {
      figure.querySelector(".plot-title").textContent = spec.heading;
      figure.querySelector("figcaption").textContent = spec.caption;
      place.ariaLabel = words;
    }
    if ((drawn && away.has(figure)) || !figure.checkVisibility()) { late.add(figure); return; } // painted when it comes into sight
    kept.drawn?.set(key, spec);
    if (drawn && moving && await fegearMoved.move(place, spec, mode)) return;
    const shaded = shadesOf(JSON.stringify({ data: spec.data, layout: spec.layout }), mode, kept.darker);
    const look = shadesOf(JSON.stringify(template), mode, kept.darker);
    shaded.layout.uirevision = key; // what the reader has zoomed into stays
    const roomy = drawn && moving ? fegearMoved.roomy(place, spec, shaded) : {};
    await draw(place, { key, ...shaded }, look, drawn);
    fegearMoved.whole(place, spec, mode, roomy);
    place.dataset.count = Number(place.dataset.count || 0) + 1;
  }

  async function put(kept) { // what was found last
    const { title, values, figures, draft } = kept.late, keys = figures.map((one) => one.key);
    kept.late = null;
    for (const [name, words] of [["h2", title], [".draft", draft ?? ""]]) {
      const one = kept.element.querySelector(name);
      if (one.textContent !== words) one.textContent = words;
    }
    if (values !== null) renew(kept.element.querySelector(".numbers"), values); // else out of sight: they come at rest
    kept.element.hidden = !(values ?? true) && !figures.length;
    const gone = [...kept.element.querySelectorAll(".figures figure")].filter((figure) => !keys.includes(figure.dataset.key));
    for (const figure of gone) { drop(figure); kept.specs.delete(figure.dataset.key); kept.drawn.delete(figure.dataset.key); }
    if (gone.length) refit(kept.element.querySelector(".figures"));
    for (const key of keys) if (kept.drawn.get(key) !== kept.specs.get(key)) await paint(kept, key);
  }

  const FOLLOWED = 250; // ms
  const loadsNow = new Map(); // pair -> what its load has come to
  let following = null;
  let moving = false; // whether a value is being moved
  let ended = ""; // what the last computation came to
  let step = ""; // the task that is at work
  /** So many seconds in words that do not pretend to know them. */
  function leftWords(seconds) {
    if (!(seconds >= 2)) return "";
    const round = (value) => (value < 10 ? Math.round(value) : 5 * Math.round(value / 5));
    return `, about ${seconds < 100 ? `${round(seconds)} s` : `${Math.round(seconds / 60)} min`} left`;
  }
  // What has been going on for a while can be stopped, and taken up again.
  let offering = 0;
  function offer(words) {
    clearTimeout(offering);
    const show = () => { const one = $("stop"); if (one) Object.assign(one, { hidden: !words, textContent: words, onclick: () => emitEvent(words === "Stop" ? "stop" : "compute") }); };
    if (words === "Stop") offering = setTimeout(show, LONG); else show();
  }
  const LONG = 700; // ms
  const early = () => $("first-gears")?.remove(); // what stood in the page before it could draw
  const say = (words) => { if ($("state") && $("state").textContent !== words) Object.assign($("state"), { textContent: words, title: words }); };
  /** Why the case is refused, where the field that says so is out of sight: further down, or in a form that is folded away. */
  let because = 0, reason = "";
  function refusedBecause(sentence) {
    clearTimeout(because);
    reason = sentence ?? "";
    if (!sentence) return $("refused-because")?.remove();
    because = setTimeout(() => { // the form is told of it, too
      const inSight = [...document.querySelectorAll(".inputs .q-field--error .q-field__messages, .inputs .refusal")].some((one) => {
        const { top, bottom, width } = one.getBoundingClientRect();
        return one.textContent.trim() && width > 0 && top > 40 && bottom <= innerHeight; // all of it
      });
      if (inSight) return $("refused-because")?.remove();
      const line = $("refused-because") ?? Object.assign(made("p"), { id: "refused-because" });
      line.setAttribute("role", "alert");
      line.textContent = sentence;
      document.body.append(line);
    }, 300);
  }
  document.addEventListener("click", ({ target }) => { if (target.closest?.("#to-fold")) refusedBecause(reason); });
  const heard = {
    hands(content) { const shown = fegearHands.show(content, { made, sections }); early(); return shown; },
    harris(content) {
      loadsNow.clear(); // of places on the way to where it stands now
      return fegearHands.harris(content, { paint, sections });
    },
    load_now(content) { // after the results that are waited for, and not for every one of them
      following ??= setTimeout(() => {
        line = line.then(async () => {
          following = null;
          for (const [pair, now] of loadsNow) { loadsNow.delete(pair); await fegearHands.follow(now); }
        }).catch((problem) => console.error(problem));
      }, FOLLOWED);
      loadsNow.set(content.pair, content);
    },
    meshed(content) { ({ loads: fegearSets, bent: fegearGearbox, crack: fegearCrack }[content.kind] ?? fegearGears).meshed(content); },
    assemblies({ sets, gearbox, racks }) { fegearSets.show(sets); fegearGearbox.show(gearbox); fegearGlance.racks(racks ?? {}); },
    asked(content) {
      if (content.moving !== undefined) ({ moving } = content); // not asked beside the case
      document.body.classList.add("computing");
      if (!moving) offer("Stop");
      refusedBecause("");
      say("computing ...");
    },
    begin({ step: number, count, title, left }) {
      if (!$("stop")?.textContent && !moving) offer("Stop"); // an export has begun
      step = `${number} of ${count}: ${title}`;
      say(`${step} ...${leftWords(left)}`);
    },
    exercise(content) { fegearGlance.exercise(content); }, // what one page asked for holds for all
    advance({ fraction, left }) { say(`${step}, ${Math.round(100 * fraction)} %${leftWords(left)}`); },
    outdated({ stopped, sentence }) { // the case is refused, or nobody computes it
      refusedBecause(sentence);
      document.body.classList.remove("computing");
      document.body.classList.add("outdated");
      offer(stopped ? "Compute" : "");
      say(stopped ? "stopped; results are of an earlier case" : "case refused; results are of an earlier case");
    },
    plan({ tasks }) {
      fegearGears.plan(tasks);
      fegearCrack.plan(tasks);
      fegearGlance.plan(tasks, owner);
      for (const [task, kept] of sections) {
        if (task !== "compared" && !task.startsWith("hand ") && !tasks.includes(task)) { sight.unobserve(kept.element); seen.delete(task); drop(kept.element); sections.delete(task); }
      }
      const host = $("results"), wanted = tasks.map((task) => section(task).element);
      for (const task of tasks) wait(sections.get(task));
      if (wanted.some((element, i) => host.children[i] !== element)) host.append(...wanted);
    },
    async found(content) {
      const { task, figures, darker, loads } = content, kept = section(task);
      if (loads) fegearGears.loads(loads);
      for (const still of kept.element.querySelector(".stills").children) still.classList.add("old"); // drawn anew after all results
      answered(kept);
      kept.darker = darker;
      for (const spec of figures) { if (!spec.same) kept.specs.set(spec.key, spec); owner.set(spec.key, task); }
      fegearGlance.found(content);
      for (const spec of figures) if (spec.key === enlarged?.key && !spec.same) await enlarge(spec.key, enlarged.words);
      kept.late = { ...content, values: content.values ?? kept.late?.values ?? null };
      // While a value moves, what is out of sight waits until it is in sight or all is at rest.
      if (!moving || kept.element.hidden || seen.has(task)) await put(kept);
    },
    picture({ task, key, heading, caption, data }) {
      const kept = section(task), host = kept.element.querySelector(".stills");
      let figure = [...host.children].find((one) => one.dataset.key === key);
      if (!figure) {
        figure = made("figure");
        figure.dataset.key = key;
        figure.append(made("div", "plot-title"), made("img"), made("figcaption"));
        host.append(figure);
      }
      figure.querySelector(".plot-title").textContent = heading;
      figure.querySelector("figcaption").textContent = caption;
      figure.querySelector("img").src = `data:image/png;base64,${data}`;
      figure.classList.remove("old");
      figure.querySelector("img").alt = `${heading}. ${caption}`;
      kept.element.hidden = false;
      answered(kept);
    },
    async done({ notes, told, moving: goesOn, seconds, tolerance, level, answer }) {
      if (!goesOn) { fegearGears.rest(); fegearGlance.settle(); }
      ended = `${seconds.toFixed(2)} s at tolerance ${Number(tolerance.toPrecision(3))}${level}`;
      $("answer").replaceChildren(...answer.map((one) => made("li", "", one)));
      if (goesOn) return; // remarks and errors come when it stands still
      document.body.classList.remove("outdated");
      offer("");
      say(ended);
      for (const kept of sections.values()) {
        answered(kept);
        for (const key of kept.specs.keys()) if (fegearMoved.rough($(`plot-${key}`))) await paint(kept, key);
      }
      document.body.classList.remove("computing");
      // What to act on first stands above all; beside that, each note stands with its result, and folded with its pair.
      document.querySelectorAll(".remarks").forEach((one) => one.remove());
      document.querySelectorAll(".hand-remarks").forEach((one) => one.remove());
      for (const [task, subject, words, kind] of told) {
        fegearHands.remark(subject, words, made);
        const place = sections.get(task)?.element;
        if (!place || place.hidden) continue;
        if (!place.querySelector(":scope > .remarks")) place.querySelector(":scope > h2").after(made("ul", "remarks"));
        place.querySelector(":scope > .remarks").append(made("li", kind, words));
      }
      const line = ([kind, words, text]) => { const one = made("li", kind); one.append(made("b", "", `${words}: `), text); return one; };
      const rows = notes.open.map(line);
      if (notes.folded.length) {
        const fold = made("li", "fold"), all = made("details"), list = made("ul", "all");
        list.append(...notes.folded.map(line));
        all.append(made("summary", "", notes.counted), list);
        fold.append(all);
        rows.push(fold);
      }
      $("remarks").replaceChildren(...rows);
    },
    refused({ sentence }) { document.body.classList.remove("computing"); offer(""); say(sentence); },
    exported() { if (!document.body.classList.contains("computing")) offer(""); say(ended); },
    failed() { document.body.classList.remove("computing"); offer(""); say(ended); }, // the bar has the sentence
    async compared({ sections: parts, figures, darker }) {
      say(ended);
      const host = $("compared");
      const kept = sections.get("compared") ?? { element: made("section", "task"), specs: new Map(), };
      if (!kept.element.isConnected) {
        kept.element.append(made("h2", "", "A, pinned, and B, as it is now"), made("div", "numbers"), made("div", "figures"));
        host.replaceChildren(kept.element);
        sections.set("compared", kept);
      }
      kept.darker = darker;
      kept.element.querySelector(".numbers").innerHTML = parts.map(([title, html]) => `<h3>${title}</h3>${html}`).join("");
      for (const figure of [...kept.element.querySelectorAll(".figures figure")]) {
        if (!figures.some((one) => one.key === figure.dataset.key)) drop(figure);
      }
      for (const spec of figures) { kept.specs.set(spec.key, spec); await paint(kept, spec.key); }
    },
    async designed({ pair, told, figures, darker }) {
      offer("");
      say(ended);
      const key = `hand design ${pair}`;
      if (!sections.get(key)?.element.isConnected) {
        const element = made("section", "task design");
        element.append(made("h2", "", `Relief of pair ${pair} by theory`), made("p"), made("div", "figures"));
        $("designed").append(element);
        sections.set(key, { element, specs: new Map(), darker: {} });
      }
      const kept = sections.get(key);
      kept.element.querySelector("p").textContent = told;
      kept.darker = darker;
      for (const spec of figures) { kept.specs.set(spec.key, spec); await paint(kept, spec.key); }
    },
    pinned(content) { fegearGlance.pinned(content); },
    unpinned() {
      fegearGlance.unpinned();
      if (sections.has("compared")) drop(sections.get("compared").element);
      sections.delete("compared");
    },
    laid() {
      early();
      refusedBecause("");
      fegearMiddle.clear();
      sections.clear();
      unpainted.clear();
      seen.clear();
      sight.disconnect();
      owner.clear();
      document.querySelectorAll("#answer, #results, #remarks, #compared, #designed, #maps, #hands").forEach((one) => [...one.children].forEach(drop));
    },
  };

  // ---- a small picture, enlarged: the whole figure, which follows as well --------------------------------------------
  const LARGER = 1.4; // type of an enlarged figure, for a room
  /** Makes all type of a figure larger, and the room about its panels with it. */
  function larger(layout, look) {
    const grow = (one) => {
      for (const [name, value] of Object.entries(one ?? {})) {
        if (name.endsWith("font") && value.size) value.size *= LARGER;
        if (value && typeof value === "object") grow(value);
      }
    };
    look.layout.font = { size: 12, ...look.layout.font };
    grow(look);
    grow(layout);
    const before = layout.margin;
    layout.margin = Object.fromEntries(Object.entries(before).map(([side, room]) => [side, Math.round(LARGER * room)]));
    layout.height += layout.margin.t - before.t + layout.margin.b - before.b;
  }
  let enlarged = null;
  async function enlarge(key, words) {
    await plotly;
    const found = fegearGlance.spec(key);
    if (!found) return;
    let dialog = $("enlarged");
    if (!dialog) {
      dialog = made("dialog");
      dialog.id = "enlarged";
      const close = Object.assign(made("button", "button", "Close"), { type: "button", onclick: () => dialog.close() });
      dialog.append(made("h2"), close, made("div", "plot"), made("p", "quiet"));
      dialog.onclick = ({ target }) => { if (target === dialog) dialog.close(); };
      dialog.onclose = () => { enlarged = null; Plotly.purge(dialog.querySelector(".plot")); };
      document.body.append(dialog);
    }
    const again = enlarged?.key === key, mode = fegearFigure.theme(), { spec, darker } = found;
    enlarged = { key, words };
    if (!dialog.open) dialog.showModal();
    dialog.setAttribute("aria-label", spec.heading);
    dialog.querySelector("h2").textContent = spec.heading;
    dialog.querySelector("p").textContent = spec.caption;
    const shaded = shadesOf(JSON.stringify({ data: spec.data, layout: spec.layout }), mode, darker), look = shadesOf(JSON.stringify(template), mode, darker);
    if (document.documentElement.classList.contains("large-type")) larger(shaded.layout, look);
    await draw(dialog.querySelector(".plot"), { key, ...shaded }, look, again);
  }

  let line = Promise.resolve(); // one after the other: a figure is not painted twice at a time
  const newest = new Map(); // what is overtaken before its turn is not shown
  const OVERTAKEN = new Set(["found", "hands", "plan", "harris", "load_now", "meshed"]);
  // A figure that is the same as before travels as its key alone: it may have come with results whose turn is still to come.
  const unpainted = new Map(); // task -> figures that came and were not shown yet
  function withFigures(content) {
    const before = unpainted.get(content.task) ?? [];
    const figures = content.figures.map((one) => (one.same && before.find((other) => other.key === one.key)) || one);
    unpainted.set(content.task, figures);
    return { ...content, figures };
  }
  let unshown = {}; // outlines of gears that came and were not shown yet; the same ones are not sent again
  function withGears(content) {
    const pairs = {};
    for (const [pair, one] of Object.entries(content.pairs)) pairs[pair] = { ...one, mesh: one.mesh ?? unshown[pair]?.mesh };
    unshown = pairs;
    return { ...content, pairs };
  }
  function hear(what, content) {
    if (!heard[what]) return line;
    if (what === "found") content = withFigures(content);
    if (what === "hands") content = withGears(content);
    const kind = `${what} ${content?.task ?? ""} ${content?.pair ?? ""} ${content?.kind ?? ""}`, number = (newest.get(kind) ?? 0) + 1;
    newest.set(kind, number);
    line = line.then(() => {
      if (OVERTAKEN.has(what) && newest.get(kind) !== number) return undefined;
      if (what === "found") unpainted.delete(content.task);
      if (what === "hands") unshown = {};
      return heard[what](content);
    }).catch((problem) => console.error(problem));
    return line;
  }
  dark.addEventListener("change", () => {
    line = line.then(async () => {
      for (const kept of sections.values()) for (const key of kept.specs.keys()) await paint(kept, key);
    });
  });
  addEventListener("keydown", (event) => {
    if ((event.ctrlKey || event.metaKey) && event.key === "s") { event.preventDefault(); emitEvent("save"); }
  });
  return { enlarge, isMoving: () => moving, showReport() { for (const kept of sections.values()) if (kept.late) line = line.then(() => put(kept)); },
    hear, hearAll(all) { for (const one of all) fegear.hear(...one); }, begin(look, address) { template = look; document.documentElement.dataset.ready = "yes"; fetchPlotly(address); } };
})();
