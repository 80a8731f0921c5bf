"use strict";
// Show the entries in which all words of the question occur; the question is part of the address and can be mailed.

const field = document.getElementById("q");
const kinds = [...document.querySelectorAll("input[name=kind]")];
const plain = (text) => text.normalize("NFKD").replace(/\p{M}/gu, "").toLowerCase();
const entries = [...document.querySelectorAll(".hits > li")].map((element) => ({
  element,
  kind: element.dataset.k,
  text: plain(`${element.textContent} ${element.dataset.t}`),
}));

function search() {
  const words = plain(field.value).split(/\s+/).filter(Boolean);
  const wanted = new Set(kinds.filter((box) => box.checked).map((box) => box.value));
  let found = 0;
  for (const { element, kind, text } of entries) {
    const fits = wanted.has(kind) && words.every((word) => text.includes(word));
    element.hidden = !fits;
    found += fits;
  }
  document.getElementById("found").textContent = `${found} of ${entries.length}`;
  history.replaceState(null, "", field.value ? `#q=${encodeURIComponent(field.value)}` : "#");
}

function ask() {
  if (location.hash.startsWith("#q=")) {
    try {
      field.value = decodeURIComponent(location.hash.slice(3));
    } catch {
      field.value = location.hash.slice(3); // an address that was cut in the middle of a letter
    }
  }
  search();
}

document.querySelector(".search").hidden = false;
field.addEventListener("input", search);
for (const box of kinds) box.addEventListener("change", search);
addEventListener("hashchange", ask);
ask();
field.focus();
