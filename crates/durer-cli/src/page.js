"use strict";
// Shared by all pages.
const data = @DATA@;
const make = (tag, parent, text, className) => {
  const element = document.createElement(tag);
  if (text !== undefined) element.textContent = text;
  if (className) element.className = className;
  parent?.append(element);
  return element;
};
// Makes an element that reacts to clicks work with the keyboard too.
const press = (element, act) => {
  element.tabIndex = 0;
  if (!["BUTTON", "SUMMARY", "A"].includes(element.tagName)) element.setAttribute("role", "button");
  element.addEventListener("click", act);
  element.addEventListener("keydown", event => {
    if (event.target === element && ["Enter", " "].includes(event.key) && element.tagName !== "SUMMARY" && element.tagName !== "BUTTON") { event.preventDefault(); act(event); }
  });
};
