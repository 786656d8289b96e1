"use strict";
// What all pages share.
const data = @DATA@;
const make = (tag, parent, text, className) => {
  const element = document.createElement(tag);
  if (text !== undefined) element.textContent = text;
  if (className) element.className = className;
  parent?.append(element);
  return element;
};
// What is clicked can be reached by keys as well.
const press = (element, act) => {
  element.tabIndex = 0;
  if (!["BUTTON", "SUMMARY", "A"].includes(element.tagName)) element.setAttribute("role", "button");
  element.addEventListener("click", act);
  element.addEventListener("keydown", event => {
    if (event.target === element && ["Enter", " "].includes(event.key) && element.tagName !== "SUMMARY" && element.tagName !== "BUTTON") { event.preventDefault(); act(event); }
  });
};
