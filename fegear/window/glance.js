"use strict";
// One glance: small pictures on the right that follow what is moved, the numbers below with their errors and what they
// differ from A, and what of it is kept: which pictures, which stress, whether the form is folded away.
const fegearGlance = (() => {
  const { plot, plain, ofPanel } = fegearPlots, numbersOf = fegearPacked.numbers;
  const $ = (id) => document.getElementById(id);
  const RATIOS = { transverse: "contact ratio", overlap: "overlap ratio" };
  let told = null, view = {}, pair = null, pairs = {}, racks = {}, kind = "pair"; // the pair, or the set, that is shown
  let pinned = null; // of A: { specs, numbers }
  const specs = new Map(), numbers = new Map(); // key -> { spec, darker }; name -> number
  let halves = {}; // pair -> peak-to-peak transmission error at half the load and at all of it [um]
  const plots = new Map(); // name of a picture -> what is drawn of it
  let place = { marks: {} };
  const made = (tag, cls, text) => {
    const one = document.createElement(tag);
    if (cls) one.className = cls;
    if (text !== undefined) one.textContent = text;
    return one;
  };
  const keep = (change) => { Object.assign(view, change); emitEvent("view", change); };

  // ---- exercises ----------------------------------------------------------------------------------------------------
  const { ask } = fegearExercise({
    view: () => view,
    shown: () => ({ kind, pair, mesh: pairs[pair]?.mesh, exercises: pairs[pair]?.exercises ?? [], racks }),
    number: (name) => numbers.get(`${pair}.${name}`),
    half: () => halves[pair],
    spec: (key) => specs.get(key)?.spec,
    keep,
    changed: () => apply(),
  });

  // ---- what is shown, and how ---------------------------------------------------------------------------------------
  function apply() {
    const none = !Object.keys(pairs).length, report = view.report || none;
    document.body.classList.toggle("reporting", report);
    document.body.classList.toggle("folded", !!view.folded);
    document.documentElement.classList.toggle("large-type", !!view.large);
    document.documentElement.classList.toggle("all-digits", !!view.digits);
    document.body.classList.toggle("exercise", !!view.exercise);
    document.body.classList.toggle("revealed", !!view.revealed);
    ask();
    fegearSets.soon();
    fegearGears.soon();
    const hidden = !view.revealed;
    for (const [id, on, words] of [
      ["to-report", report, report ? "At a glance" : "All results"], ["to-fold", view.folded, view.folded ? "Show form" : "Fold form"],
      ["to-large", view.large, "Large type"], ["to-digits", view.digits, "All digits and estimated errors"], ["to-exercise", view.exercise, "Exercise: answers on request"],
      ["to-answers", !hidden, hidden ? "Show the answers" : "Hide the answers"],
    ]) {
      const one = $(id);
      if (!one) continue;
      one.textContent = words;
      one.setAttribute("aria-pressed", String(!!on));
      if (id === "to-report") one.hidden = none;
    }
    soon();
  }
  document.addEventListener("click", ({ target }) => {
    const id = target.closest?.("button")?.id;
    if (id === "to-report") { keep({ report: !view.report }); apply(); if (view.report) fegear.showReport(); }
    if (id === "to-fold") { keep({ folded: !view.folded }); apply(); }
    if (id === "to-large") { keep({ large: !view.large }); apply(); }
    if (id === "to-digits") { keep({ digits: !view.digits }); apply(); strip(); }
    if (id === "to-exercise") { keep({ exercise: !view.exercise, revealed: false }); apply(); }
    if (id === "to-answers") { keep({ revealed: !view.revealed }); apply(); }
    if (id === "to-large" || id === "to-exercise") target.closest("details.views")?.removeAttribute("open"); // it lies over the answers' button
  });
  const chosen = () => {
    const usual = told?.usual[kind === "set" ? "set" : pairs[pair]?.mesh?.wide ? "wide" : "plane"] ?? [];
    const names = (view.pictures ?? []).filter((name) => told?.pictures[name]?.of === kind);
    return names.length ? names : usual;
  };

  // ---- small pictures -----------------------------------------------------------------------------------------------
  function lay() {
    const host = $("small"), names = chosen(), wanted = JSON.stringify([kind, pair, names]);
    if (!host || !told || host.dataset.laid === wanted) return;
    host.dataset.laid = wanted;
    ask(); // what is shown has its own questions
    host.replaceChildren();
    plots.clear();
    for (const name of names) {
      const one = told.pictures[name], figure = made("figure", "small"), title = made("button", "small-title", one.words);
      Object.assign(title, { type: "button", title: `Enlarge: ${one.words}` });
      figure.dataset.picture = name;
      const body = made("div", "small-body"), empty = made("p", "quiet", "not yet available");
      body.append(empty);
      const legend = made("p", "small-legend");
      figure.append(title, legend, body);
      host.append(figure);
      const kept = { ...plot(body), figure, title, legend, empty, key: `${one.key}${pair}`, panel: one.panel, name };
      title.onclick = body.onclick = () => fegear.enlarge(kept.key, one.words);
      plots.set(name, kept);
      watch.observe(body);
    }
    const choice = made("details", "choice"), list = made("div");
    choice.append(made("summary", "", "Choose figures"), list);
    for (const [name, one] of Object.entries(told.pictures).filter(([, { of }]) => of === kind)) {
      const label = made("label"), box = Object.assign(made("input"), { type: "checkbox", checked: names.includes(name) });
      box.onchange = () => {
        const before = new Set([...chosen(), ...view.pictures.filter((other) => told.pictures[other]?.of !== kind)]);
        const next = Object.keys(told.pictures).filter((other) => (other === name ? box.checked : before.has(other)));
        keep({ pictures: next });
        host.dataset.laid = "";
        lay();
        const again = host.querySelector(".choice");
        again.open = true;
        soon();
      };
      label.append(box, one.words);
      list.append(label);
    }
    host.append(choice);
  }
  const STYLES = { dash: "dashed", dashdot: "dashed", dot: "dotted" };
  function inOrder(curves) { // as they stand below each other; what is counted stays in the order of its numbers
    if (curves.every(({ name: words }) => /\d$/.test(words))) return curves;
    const top = ({ y }) => numbersOf(y).reduce((most, one) => Math.max(most, Number.isFinite(one) ? one : most), -Infinity);
    return curves.sort((one, other) => top(other) - top(one));
  }
  /** Says what the curves of a small picture are, where there are several, and which is A's. */
  function name(legend, traces, darker, withA) {
    const named = [...new Map(traces.filter(({ name: words, showlegend }) => words && showlegend !== false).map((one) => [one.name, one])).values()];
    const said = JSON.stringify([fegearFigure.theme(), withA, named.map(({ name: words, line }) => [words, line?.color])]);
    if (legend.dataset.said === said) return;
    legend.dataset.said = said;
    legend.hidden = named.length < 2 && !withA;
    legend.title = named.map((one) => plain(one.name)).join(", ");
    legend.replaceChildren(...inOrder(named).map((one) => {
      const entry = made("span"), key = made("i"), colour = one.line?.color ?? one.marker?.color;
      key.style.borderTop = `${one.type === "bar" ? 7 : 2}px ${STYLES[one.line?.dash] ?? "solid"} ${fegearFigure.theme() === "dark" ? darker[colour] ?? colour : colour}`;
      entry.append(key, plain(one.name).replace(/^(driver|driven) [^,]+, /, "$1, ")); // gears have names of any length
      return entry;
    }));
    if (!withA) return;
    const entry = made("span"), key = made("i");
    key.style.borderTop = "1.4px dashed var(--soft)";
    entry.append(key, "A, pinned");
    legend.append(entry);
  }
  function drawAll() {
    due = 0;
    lay();
    const moving = fegear.isMoving();
    if (view.exercise && view.revealed && !moving) ask(); // its answer is of what has been found meanwhile
    for (const kept of plots.values()) {
      const found = specs.get(kept.key);
      kept.empty.hidden = !!found;
      kept.svg.toggleAttribute("hidden", !found);
      if (!found || (kept.shown === found.spec && kept.theme === fegearFigure.theme() && kept.at === kept.size && kept.against === pinned)) { kept.mark?.(place.marks[kept.name] ?? []); continue; }
      const { spec, darker } = found, y = spec.layout[`yaxis${kept.panel === 1 ? "" : kept.panel}`]?.title?.text ?? "";
      const done = kept.draw(spec, kept.panel, { held: moving && "grows", pinned: pinned?.specs.get(kept.key)?.spec, darker, marks: place.marks[kept.name] ?? [], words: `${spec.heading}. ${spec.caption}` });
      if (!done) continue;
      Object.assign(kept, { shown: spec, theme: fegearFigure.theme(), at: kept.size, against: pinned });
      const unit = /\[[^\]]*\]\s*$/.exec(plain(y))?.[0] ?? "", words = `${told.pictures[kept.name].words} ${unit}`;
      if (kept.title.textContent !== words) kept.title.textContent = words;
      name(kept.legend, ofPanel(spec, kept.panel), darker, !!pinned?.specs.get(kept.key));
      kept.figure.dataset.count = Number(kept.figure.dataset.count ?? 0) + 1; // how often it was drawn
    }
    strip();
    if (view.exercise && view.revealed) ask(); // its answer follows the numbers
  }
  let due = 0;
  const soon = () => { due ||= requestAnimationFrame(drawAll); };
  const watch = new ResizeObserver((entries) => {
    for (const { target } of entries) for (const kept of plots.values()) if (kept.figure.contains(target)) kept.size = `${target.clientWidth} ${target.clientHeight}`;
    soon();
  });
  fegearFigure.dark.addEventListener("change", soon);

  // ---- numbers ------------------------------------------------------------------------------------------------------
  function difference(now, before) { // to A
    if (!before || !Number.isFinite(now.value) || !Number.isFinite(before.value)) return "";
    const off = now.value - before.value;
    if (Math.abs(off) <= 1e-6 * Math.abs(before.value)) return "as A"; // round-off of another way to the same number
    const share = 100 * off / Math.abs(before.value), sign = off > 0 ? "+" : "−";
    return `${sign}${Math.abs(share) < 1000 && before.value ? `${Number(Math.abs(share).toPrecision(2))} %` : Number(Math.abs(off).toPrecision(3))}`;
  }
  const previews = new Map(); // task -> what its first answer was found with
  const cells = new Map(); // name -> elements of the strip
  function strip() {
    const host = $("strip");
    if (!host || !told) return;
    const wanted = told.numbers.map((name) => numbers.get(`${pair}.${name}`)).filter(Boolean);
    const known = kind === "set" ? [] : Object.entries(pairs[pair]?.mesh?.ratios ?? {}), interrupted = known.reduce((sum, [, value]) => sum + value, 0) < 1;
    const ratios = known.map(([name, value]) => ({ name, label: `${RATIOS[name]}${interrupted && name === "transverse" ? ", below 1" : ""}`, told: interrupted ? "Below 1: motion is not transmitted continuously." : "", text: value.toFixed(3), value, unit: "", error: "" }));
    const several = kind === "set" || Object.keys(pairs).length > 1; // then it is said whose numbers and pictures these are
    const undercuts = kind === "set" ? [] : (pairs[pair]?.mesh?.undercut ?? []).map(({ member, lost, shift, enough }) => ({ name: `undercut ${member}`, label: `undercut, ${member}`, text: String(Number(lost.toPrecision(2))), value: lost, unit: "mm", error: "", told: `The tool cuts away ${Number(lost.toPrecision(3))} mm of the involute above the base circle at profile_shift = ${Number(shift.toPrecision(4))}; nothing from ${enough.toFixed(4)} on.` }));
    const all = [...wanted, ...ratios, ...undercuts], [preview] = previews.values(), laid = JSON.stringify([kind, pair, several, preview, all.map((one) => [one.name, one.label])]);
    if (host.dataset.laid !== laid) {
      host.dataset.laid = laid;
      cells.clear();
      host.replaceChildren(...all.map((one) => {
        const cell = made("div", "cell"), parts = [made("span", "label", one.label), made("b"), made("span", "error"), made("span", "from-a")];
        cell.dataset.number = one.name;
        cell.append(...parts);
        cells.set(one.name, parts);
        return cell;
      }));
      if (several) {
        const cell = made("div", "cell subject");
        cell.append(made("span", "label", "shown"), made("b", "", `${kind} ${pair}`));
        host.prepend(cell);
      }
      if (preview) { // not the last word
        const cell = made("div", "cell preview");
        cell.title = preview;
        cell.append(made("span", "label", "follows: full accuracy"), made("b", "", "preview"));
        host.prepend(cell);
      }
    }
    for (const one of all) {
      const [label, value, error, from] = cells.get(one.name), text = view.digits ? one.text : one.short ?? one.text, before = pinned?.numbers.get(`${pair}.${one.name}`);
      for (const [place, words] of [[value, `${text}${one.unit ? ` ${one.unit}` : ""}`], [error, one.error ? `± ${one.error}` : ""], [from, pinned ? difference(one, before) : ""]]) {
        if (place.textContent !== words) place.textContent = words;
      }
      label.parentElement.classList.toggle("rough", !!one.rough);
      label.parentElement.title = one.error ? `${one.text} ± ${one.error} ${one.unit}: estimated numerical error (mesh, positions)` : one.told ?? "";
    }
  }

  // ---- what is heard ------------------------------------------------------------------------------------------------
  function gather({ figures, numbers: values, darker }, into) {
    for (const spec of figures) if (!spec.same) into.specs.set(spec.key, { spec, darker });
    for (const [name, one] of Object.entries(values ?? {})) into.numbers.set(name, one);
  }

  // ---- what is older than the case is dimmed, if it takes a while to be new -----------------------------------------
  const AWHILE = 250; // ms
  let dimming = 0, dimmed = false;
  let awaited = { figures: new Set(), numbers: new Set() }; // keys of figures and names of numbers that are to come
  function dim() {
    for (const kept of plots.values()) kept.figure.classList.toggle("stale", dimmed && awaited.figures.has(kept.key));
    for (const [name, parts] of cells) parts[0].parentElement.classList.toggle("stale", dimmed && awaited.numbers.has(`${pair}.${name}`));
    $("answer")?.classList.toggle("stale", dimmed || fegear.isMoving()); // sentences come when nothing moves
    for (const one of document.querySelectorAll(".mesh-told, .mesh-scale")) one.classList.toggle("stale", dimmed);
    document.getElementById("maps")?.classList.toggle("stale", dimmed && !fegear.isMoving()); // the map is made anew when all is at rest
  }
  return {
    /** What the Harris maps bring of half the load. */
    halved(found) { halves = found; ask(); },
    begin(content) {
      told = content;
      view = { ...content.view };
      specs.clear();
      numbers.clear();
      pinned = null;
      [pairs, pair, kind, halves] = [{}, null, "pair", {}];
      apply();
    },
    view: () => view,
    hides: () => !!view.exercise && !view.revealed, // loads and results, of an exercise
    exercise(content) { Object.assign(view, content); apply(); },
    keep,
    found(content) {
      gather(content, { specs, numbers });
      if (content.draft) previews.set(content.task, content.draft); else previews.delete(content.task);
      for (const { key } of content.figures) awaited.figures.delete(key);
      for (const name of Object.keys(content.numbers ?? {})) awaited.numbers.delete(name);
      soon();
      dim();
    },
    plan(tasks, owners) { // what is computed no longer is shown no longer
      if (!fegear.isMoving()) halves = {}; // of the case before
      for (const key of [...specs.keys()]) if (owners.has(key) && !tasks.includes(owners.get(key))) specs.delete(key);
      awaited = { figures: new Set(specs.keys()), numbers: new Set(numbers.keys()) };
      clearTimeout(dimming);
      if (fegear.isMoving()) dim(); else dimming = setTimeout(() => { dimmed = true; dim(); }, AWHILE); // figures that move would flicker
    },
    hands(content) {
      const before = Object.keys(pairs).length;
      pairs = Object.fromEntries(Object.entries(content).map(([name, one]) => [name, { ...pairs[name], ...one, mesh: one.mesh ?? pairs[name]?.mesh }]));
      if (kind === "pair" && !(pair in pairs)) pair = Object.keys(pairs)[0] ?? null;
      if (before !== Object.keys(pairs).length || !document.body.dataset.pairs) apply();
      document.body.dataset.pairs = Object.keys(pairs).length;
      soon();
    },
    pair: () => pair,
    racks(content) { racks = content; ask(); }, // what is asked of them
    choose(name, of = "pair") { [pair, kind] = [name, of]; soon(); },
    pinned(content) {
      pinned = null;
      if (content.found) { pinned = { specs: new Map(), numbers: new Map() }; for (const one of content.found) gather(one, pinned); for (const [name, value] of Object.entries(content.ratios ?? {})) pinned.numbers.set(name, { value }); }
      soon();
    },
    unpinned() { pinned = null; soon(); },
    spec: (key) => specs.get(key),
    against: (key) => pinned?.specs.get(key),
    at(name, d, share, loads) { // where the gears stand now
      if (name !== pair) return;
      const now = (d.start + share * d.base_pitch) * 1e3, all = loads.map(([, x]) => x * 1e3);
      place = { marks: { te: [now], stiffness: [now], sharing: all, pressure: all, root: all } };
      for (const kept of plots.values()) kept.mark?.(place.marks[kept.name] ?? []);
    },
    soon,
    settle() {
      clearTimeout(dimming);
      dimmed = false;
      awaited = { figures: new Set(), numbers: new Set() };
      previews.clear();
      dim();
      for (const kept of plots.values()) kept.shown = null;
      soon();
    },
    reporting: () => document.body.classList.contains("reporting"),
  };
})();
