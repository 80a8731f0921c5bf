"use strict";
// A region is a stop of the tab key only while it scrolls.
const regions = document.querySelectorAll(".scroll, .drawing, pre, math[tabindex]");
const scrolls = new ResizeObserver((entries) => {
  for (const { target } of entries) {
    const moves = target.scrollWidth > target.clientWidth + 1 || target.scrollHeight > target.clientHeight + 1;
    if (moves) target.tabIndex = 0;
    else target.removeAttribute("tabindex");
  }
});
for (const region of regions) scrolls.observe(region);
