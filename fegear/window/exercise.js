"use strict";
// An exercise: questions on the pair or set that is shown, and the answer to each in a sentence with rounded numbers.
// What follows from formulas comes with the case; what needs solved gears is asked and answered here.
const fegearExercise = ({ view, shown, number, half, spec, keep, changed }) => {
  const { plain, ofPanel } = fegearPlots, numbersOf = fegearPacked.numbers;
  const $ = (id) => document.getElementById(id);
  const made = (tag, cls, text) => Object.assign(document.createElement(tag), cls ? { className: cls } : {}, text === undefined ? {} : { textContent: text });
  const figures = (value, count = 3) => String(Number(value.toPrecision(count))).replace("-", "−");
  const rounded = ({ value, unit }, count = 3) => `${figures(value, count)}${unit ? ` ${unit}` : ""}`;
  const share = (part) => `${Math.round(100 * part)} %`;

  // ---- answers that follow from solved gears; an empty one where figures alone show it ------------------------------
  function ofError() {
    const one = number("te_peak_to_peak");
    if (!one) return "";
    const at = half(), now = `The peak-to-peak transmission error is ${rounded(one)}`;
    if (!at) return `${now}; that at half the torque follows.`;
    const ratio = at.half / at.full, how = Math.abs(ratio - 1) < 0.01 ? "stays at" : ratio < 1 ? "falls to" : "rises to";
    return `${now}; at half the torque it ${how} ${rounded({ value: ratio * one.value, unit: one.unit })}.`; // both at the positions of the map
  }
  function ofSharing() {
    const { pair, mesh } = shown(), { data, loadAt } = fegearGears.inside(pair);
    if (!data || !loadAt) return "";
    const places = Array.from({ length: 401 }, (_, i) => data.start + (i + 0.5) / 401 * (data.end - data.start));
    const loads = places.map((x) => loadAt(x, 0) ?? 0), most = Math.max(...loads);
    if (!(most > 0)) return "";
    const several = loads.filter((one) => one < 0.999 * most).length / loads.length, ratio = mesh?.ratios?.transverse;
    if (!(ratio < 2)) return "With a contact ratio of 2 or more at least two tooth pairs carry the load everywhere.";
    if (ratio < 1) return `Over none of it: the contact ratio is ${ratio.toFixed(3)}, below 1, and rigid gears are out of contact between two tooth pairs.`;
    const rigid = 2 * (ratio - 1) / ratio, of = `Rigid gears: over 2 (ε − 1)/ε = ${share(rigid)} of the path of contact (contact ratio ε = ${ratio.toFixed(3)})`;
    const single = `over the other ${share(1 - several)} a single one carries all of it`;
    if (Math.abs(several - rigid) < 0.01) return `${of}; ${single}.`;
    const why = several > rigid ? "tip edges of deflected teeth are in contact outside the path of contact, too" : "gaps from reliefs or deviations keep teeth out of contact";
    if (several > 0.995) return `${of}. Under this load: over all of it (${why}).`;
    return `${of}. Under this load: over ${share(several)} (${why}); ${single}.`;
  }
  function ofRoots() {
    const { pair } = shown(), both = ["driver", "driven"].map((gear) => [gear, number(`${gear}.largest_root_tension`)]);
    if (both.some(([, one]) => !one)) return "";
    const [[high, most], [low, least]] = both.sort(([, one], [, other]) => other.value - one.value);
    const drawn = spec(`root_stress_history_${pair}`), curve = drawn && ofPanel(drawn, 1).filter(({ name: words }) => words && plain(words).includes(high) && !/compress/.test(plain(words)))[0];
    let where = "";
    if (curve) {
      const y = numbersOf(curve.y), at = y.reduce((best, one, i) => (one > y[best] || !(y[best] === y[best]) ? i : best), 0), axis = plain(drawn.layout.xaxis?.title?.text ?? "");
      const x = numbersOf(curve.x)[at], { data } = fegearGears.inside(pair);
      const [letter] = (data?.points ?? []).find(([, one]) => Math.abs(one * 1e3 - x) < 0.01 * data.base_pitch * 1e3) ?? [];
      const [before, after] = [(data?.points ?? []).filter(([, one]) => one * 1e3 < x).at(-1), (data?.points ?? []).find(([, one]) => one * 1e3 > x)];
      const near = letter ?? (before && after ? `between ${before[0]} and ${after[0]}` : "");
      where = ` ${letter || !near ? "at " : ""}${near ? `${near}, ` : ""}${figures(x)}${/\[([^\]]*)\]/.exec(axis)?.[1] ? ` ${/\[([^\]]*)\]/.exec(axis)[1]}` : ""} (${axis.replace(/\s*\[[^\]]*\]/, "")})`;
    }
    return `The ${high} gear: ${rounded(most)}${where}${onFace(high)}; the ${low} gear has ${rounded(least)}.`;
  }
  /** Where along the face the root stress of a gear is highest: the map of it over mesh and face has a panel for each gear. */
  function onFace(gear) {
    const { pair, mesh } = shown(), drawn = mesh?.wide ? spec(`root_stress_over_face_${pair}`) : undefined;
    const panel = [1, 2].find((one) => plain(drawn?.layout?.annotations?.[one - 1]?.text ?? "").startsWith(gear));
    const map = panel && ofPanel(drawn, panel).find(({ type }) => type === "heatmap");
    if (!map) return "";
    const values = numbersOf(map.z), at = values.reduce((best, one, i) => (one > values[best] || !(values[best] === values[best]) ? i : best), 0);
    return `, at face position z = ${figures(numbersOf(map.y)[Math.floor(at / numbersOf(map.x).length)])} mm`;
  }
  /** The mean line load over a base pitch at both ends of the face, and K_Hβ, its maximum over the uniform one. */
  function ofFace() {
    const { pair } = shown(), drawn = spec(`load_over_face_${pair}`), called = (words) => drawn?.data.find(({ name: own }) => own && plain(own) === words);
    const [mean, even] = [called("mean over a base pitch"), called("load / face width")];
    if (!mean || !even) return "";
    const z = numbersOf(mean.x), loads = numbersOf(mean.y), uniform = numbersOf(even.y)[0], last = loads.length - 1;
    const top = loads.reduce((best, one, i) => (one > loads[best] ? i : best), 0), place = (i) => `z = ${figures(z[i])} mm`, load = (i) => `${figures(loads[i])} N/mm`;
    const [high, low] = loads[0] > loads[last] ? [0, last] : [last, 0], same = loads[high] - loads[low] < 0.02 * uniform;
    const ends = same ? `At neither (${load(high)} at ${place(high)}, ${load(low)} at ${place(low)}, mean over a base pitch)` : `At ${place(high)}: ${load(high)}, against ${load(low)} at ${place(low)} (mean over a base pitch)`;
    return `${ends}. K_Hβ = ${figures(loads[top])} / ${figures(uniform)} = ${figures(loads[top] / uniform)}: the maximum, at ${place(top)}, over load / face width.`;
  }
  function ofPhases() { // harmonic h of N equal mesh forces with delays d adds up to |sum of exp(2 pi i h d)|
    const delay = fegearSets.of(shown().pair)?.data?.meshes.sun.delay.map((one) => ((one % 1) + 1) % 1);
    if (!delay) return "";
    const sum = (harmonic) => Math.hypot(...[Math.cos, Math.sin].map((part) => delay.reduce((all, one) => all + part(2 * Math.PI * harmonic * one), 0))) / delay.length;
    const early = (one) => (one > 1 - 1e-6 ? 0 : one), order = delay.map((one, n) => [early(one), n + 1]).sort(([one], [other]) => one - other);
    const phases = `phases ${order.map(([one]) => Number(one.toFixed(3))).join(", ")} base pitches`;
    if (order.at(-1)[0] < 1e-6) return `All planets mesh with the sun at the same time (${phases}): all harmonics of their mesh forces add up in the torque.`;
    const first = sum(1), all = Array.from({ length: 12 }, (_, i) => i + 1), whole = all.filter((one) => sum(one) > 0.999);
    const how = first < 1e-3 ? "cancels" : `adds up to ${share(first)} of the sum of amplitudes`;
    return `Planets ${order.map(([, n]) => n).join(", ")} mesh with the sun in this order (${phases}): the first harmonic of their mesh forces ${how} in the torque${whole.length ? `; harmonics ${whole.slice(0, 3).join(", ")}${whole.length > 3 ? ", ..." : ""} add up in full` : ""}.`;
  }
  function ofPlanet() { // the planet whose load changes most; its load is the mean of its two meshes, as in the drawing
    const loads = fegearSets.of(shown().pair)?.loads;
    if (!loads) return "";
    const { shape: [, planets, count], data, step } = loads.force, force = (mesh, n, i) => step * data[(mesh * planets + n) * count + i];
    const all = Array.from({ length: planets }, (_, n) => Array.from({ length: count }, (_, i) => 0.5 * (force(0, n, i) + force(1, n, i))));
    const [n, least, most] = all.map((one, i) => [i + 1, Math.min(...one), Math.max(...one)]).sort(([, a, b], [, c, d]) => (d - c) - (b - a))[0];
    const newtons = (value) => `${Number(value.toPrecision(4))} N`;
    if (most - least < 1e-3 * most) return `It does not change: planet ${n} carries ${newtons(most)} all the time.`;
    return `That of planet ${n} changes most: between ${newtons(least)} and ${newtons(most)}, by ${Number((200 * (most - least) / (most + least)).toPrecision(2))} % of its mean.`;
  }
  const error = ["How large is the peak-to-peak transmission error, and does it rise or fall at half the torque?", ofError];
  const COMPUTED = { // question and answer
    plane: [
      error,
      ["Over what share of the path of contact do two tooth pairs carry the load?", ofSharing],
      ["Which gear has the higher root stress, and at which position in the mesh is it highest?", ofRoots],
    ],
    wide: [
      ["At which end of the face is the load larger, and how large is K_Hβ?", ofFace],
      error,
      ["Which gear has the higher root stress, and at which place on the face is it highest?", ofRoots],
    ],
    set: [
      ["In which order do the planets mesh, and do their mesh forces add up or cancel in the torque?", ofPhases],
      ["How does the load of one planet change over a mesh cycle?", ofPlanet],
    ],
  };
  /** All questions on what is shown: those by computation first. */
  function questions() {
    const { kind, pair, mesh, exercises, racks = {} } = shown();
    if (!pair) return Object.values(racks).flatMap((one) => one.exercises.map((rack) => ({ topic: rack.topic, question: rack.question, of: () => rack.answer }))); // none of a single gear
    const about = kind === "set" ? "set" : mesh?.wide ? "wide" : "plane";
    const byFormula = (kind === "set" ? fegearSets.of(pair)?.data?.exercises : exercises) ?? [];
    const answer = (one) => () => { const found = one.number && number(one.number); return found ? `${one.answer} ${one.words.replace("{}", rounded(found, 4))}` : one.answer; };
    return [
      ...COMPUTED[about].map(([question, of]) => ({ topic: "Under load (computed)", question, of })),
      ...byFormula.map((one) => ({ topic: one.topic, question: one.question, of: answer(one) })),
    ];
  }

  // ---- the question's line ------------------------------------------------------------------------------------------
  let hiding = false;
  const put = (change) => { keep({ words: "", revealed: false, ...change }); changed(); };
  /** The button by which a lecturer writes another question in the place of the one that is asked; an empty one is none. */
  function ownQuestion(asked) {
    const own = Object.assign(made("button", "button own", "Own question"), { type: "button" });
    own.onclick = () => {
      const words = asked.querySelector("p");
      words.contentEditable = "plaintext-only";
      words.setAttribute("role", "textbox");
      words.setAttribute("aria-label", "Own question; Enter to ask it");
      words.onkeydown = (event) => {
        event.stopPropagation();
        if (event.key === "Escape") words.textContent = view().words ?? "";
        if (event.key === "Enter" || event.key === "Escape") { event.preventDefault(); words.blur(); }
      };
      words.onblur = () => {
        words.onblur = words.onkeydown = null;
        for (const name of ["contenteditable", "role", "aria-label"]) words.removeAttribute(name);
        keep({ words: words.textContent.trim() });
        ask();
      };
      words.focus();
      getSelection().selectAllChildren(words);
    };
    return own;
  }
  /** The list from which one question is chosen, by topics. */
  function list(choice, all, number) {
    const said = JSON.stringify(all.map(({ question }) => question));
    if (choice.dataset.said !== said) {
      choice.dataset.said = said;
      const groups = new Map();
      all.forEach(({ topic, question }, i) => {
        if (!groups.has(topic)) groups.set(topic, Object.assign(made("optgroup"), { label: topic }));
        groups.get(topic).append(Object.assign(made("option", "", `${i + 1}. ${question}`), { value: i }));
      });
      choice.replaceChildren(...groups.values());
    }
    choice.value = String(number);
  }
  /** The question of an exercise, and room for the student's own answer, which stands beside the computed one later. */
  function ask() {
    const host = $("question"), asked = $("asked"), now = view();
    if (!host || !asked) return;
    host.hidden = !now.exercise;
    if (!now.exercise) { hiding = false; return; }
    if (!asked.firstChild) {
      const answer = Object.assign(made("textarea"), { rows: 1, placeholder: "Your answer, in one sentence" });
      answer.setAttribute("aria-label", "Your answer");
      answer.addEventListener("keydown", (event) => event.stopPropagation());
      const next = Object.assign(made("button", "button", "Next question"), { type: "button" });
      next.onclick = () => put({ question: (view().question ?? 0) + 1 });
      const choice = Object.assign(made("select", "choose-question"), { title: "All questions" });
      choice.setAttribute("aria-label", "All questions");
      choice.onchange = () => put({ question: Number(choice.value) });
      asked.append(made("p"), answer, choice, next, ownQuestion(asked), made("output"));
    }
    const [words, answer] = [asked.querySelector("p"), asked.querySelector("textarea")], all = questions();
    if (words.isContentEditable) return; // it is being written
    const place = all.length ? Math.abs(now.question ?? 0) % all.length : 0, question = now.words || (all[place]?.question ?? "No question on this case: write your own."), another = words.textContent !== question;
    list(asked.querySelector("select"), all, place);
    for (const one of asked.querySelectorAll("select, button:not(.own)")) one.hidden = all.length < 2;
    words.textContent = question;
    if (another || (!now.revealed && !hiding)) answer.value = ""; // another exercise
    hiding = !now.revealed;
    answer.readOnly = !!now.revealed;
    const computed = asked.querySelector("output"), sentence = now.revealed && !now.words && all.length ? all[place].of() || "The answer follows with the results under load." : "";
    if (computed.textContent !== sentence) computed.textContent = sentence;
    computed.hidden = !sentence;
  }
  return { ask, questions };
};
