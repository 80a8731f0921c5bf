// Collect the commands of the ticked figures, and lay the two pictures of a figure over each other.
const ticks = [...document.querySelectorAll("input.accept")];
const box = document.querySelector("#commands"); // what a ticked exhibit is accepted with
const collect = () => {
  const chosen = ticks.filter((tick) => tick.checked).map((tick) => tick.value);
  box.hidden = chosen.length === 0;
  box.querySelector("code").textContent = chosen.join("\n");
};
for (const tick of ticks) {
  tick.closest("label").hidden = false;
  tick.addEventListener("change", collect);
}
for (const pair of document.querySelectorAll(".pair")) {
  const label = document.createElement("label");
  const slider = Object.assign(document.createElement("input"), { type: "range", min: 0, max: 100, value: 50 });
  slider.setAttribute("aria-label", pair.dataset.name + ": how much of the accepted picture covers the new one");
  const show = () => {
    pair.style.setProperty("--cut", slider.value + "%");
    slider.setAttribute("aria-valuetext", slider.value + " % accepted");
  };
  slider.addEventListener("input", show);
  // The accepted picture lies at the left of the seam, the new one at the right.
  const ends = document.createElement("span");
  ends.append("← accepted", Object.assign(document.createElement("span"), { textContent: "new →" }));
  label.append(slider, ends);
  pair.append(label);
  pair.classList.add("swipe");
  show();
}
