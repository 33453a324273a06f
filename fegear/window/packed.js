"use strict";
// Numbers as they travel to the page: packed, unpacked once, with the ends that axes are laid by.
const fegearPacked = (() => {
  const unpacked = new WeakMap(), bounds = new WeakMap(); // they live as long as the description that they stand in
  function bytes(text) { // by a loop: to map the letters took a third of what the page does while a value moves
    const letters = atob(text), found = new Uint8Array(letters.length);
    for (let i = 0; i < letters.length; i += 1) found[i] = letters.charCodeAt(i);
    return found.buffer;
  }
  function numbers(array) { // of a trace
    if (!array) return [];
    if (!array.bdata) return array;
    if (!unpacked.has(array)) unpacked.set(array, new Float64Array(bytes(array.bdata)));
    return unpacked.get(array);
  }
  function ends(array) { // its least and its largest number; infinity and less than that where it has none
    if (!bounds.has(array)) {
      const found = numbers(array);
      let low = Infinity, high = -Infinity;
      for (let i = 0; i < found.length; i += 1) { if (found[i] < low) low = found[i]; if (found[i] > high) high = found[i]; }
      bounds.set(array, [low, high]);
    }
    return bounds.get(array);
  }
  return { bytes, numbers, ends };
})();
