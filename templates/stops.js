"use strict";
// A region is a stop of the tab key only while it scrolls; browsers without scroll-driven animations shade its edge.
const regions = document.querySelectorAll(".scroll, .drawing, pre, math[tabindex]");
const scrolls = new ResizeObserver((entries) => {
  for (const { target } of entries) {
    const wide = target.scrollWidth > target.clientWidth + 1;
    target.classList.toggle("overflows", wide);
    if (wide || target.scrollHeight > target.clientHeight + 1) target.tabIndex = 0;
    else target.removeAttribute("tabindex");
  }
});
for (const region of regions) scrolls.observe(region);
