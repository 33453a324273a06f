"use strict";
// What stands in the middle of the glance: the gears of a pair, a planetary set, the gearbox, or a cracked tooth; one at a time.
const fegearMiddle = (() => {
  const parts = new Map(); // key -> { host, words, taken }
  let shown = null; // key of the one in the middle
  const RANK = (key) => (key.startsWith("set ") ? 0 : key === "gearbox" ? 1 : key.startsWith("crack ") ? 3 : 2);
  const ordered = () => [...parts.keys()].sort((a, b) => RANK(a) - RANK(b));
  function usual() { // what the reader chose; else the whole before its parts
    const wanted = fegearGlance.view().middle;
    return parts.has(wanted) ? wanted : ordered()[0];
  }
  function lay() {
    const next = parts.has(shown) && shown === fegearGlance.view().middle ? shown : usual();
    const changed = next !== shown;
    shown = next ?? null;
    const names = ordered();
    for (const [key, { host, words }] of parts) {
      host.hidden = key !== shown;
      const title = host.querySelector("h2"), laid = names.join();
      if (title.dataset.laid === laid) continue;
      title.dataset.laid = laid;
      if (names.length < 2) { title.textContent = words; continue; }
      const choice = document.createElement("select");
      choice.setAttribute("aria-label", "Shown in the middle");
      choice.append(...names.map((name) => Object.assign(document.createElement("option"), { value: name, textContent: parts.get(name).words, selected: name === key })));
      choice.onchange = () => { const { value } = choice; choice.value = key; choose(value); };
      title.replaceChildren(choice);
    }
    if (changed && shown !== null) parts.get(shown).taken();
  }
  function choose(key) {
    if (!parts.has(key)) return;
    fegearGlance.keep({ middle: key });
    lay();
  }
  return {
    add(key, host, words, taken) {
      parts.set(key, { host, words, taken });
      document.getElementById("hands").append(host);
      lay();
    },
    remove(key) { parts.get(key)?.host.remove(); parts.delete(key); if (parts.size) lay(); },
    clear() { parts.clear(); shown = null; },
    choose,
    shown: () => shown,
  };
})();
