// What the page was made with: rows, rules, constants.

export const DATA = JSON.parse(document.getElementById("data").textContent);
export const CONSTANTS = DATA.constants;
