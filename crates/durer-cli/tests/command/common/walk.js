// Animate without delay, also in windows that are not visible.
window.requestAnimationFrame = step => setTimeout(() => step(performance.now()), 5);
window.matchMedia = () => ({ matches: true, addEventListener() {} });
const { photographs, points } = JSON.parse(find("#report").textContent);
const slow = () => new Promise(resolve => setTimeout(resolve, 150));
const word = () => find(".moves [role=status]").textContent;
const strip = () => [...document.querySelectorAll(".strip button")];
const current = () => strip().findIndex(button => button.getAttribute("aria-current") === "true");
const go = async (what, act) => { act(); await slow(); see(`${what}: ${word()}, at ${current()}`); };
const button = name => [...document.querySelectorAll(".moves button")].find(child => child.textContent === name);
const dot = (a, b) => a.reduce((sum, v, i) => sum + v * b[i], 0);
const minus = (a, b) => a.map((v, i) => v - b[i]);
(async () => {
  await slow();
  see(word());
  const canvas = find(".tour-space canvas"), images = [...document.querySelectorAll(".tour-space img")];
  await go("button first", () => button("closer").click());
  await go("strip", () => strip()[3].click());
  // The photograph fits into the window, because the viewer has the photograph's camera.
  const box = canvas.getBoundingClientRect(), own = images[3].getBoundingClientRect();
  see(`opacity ${images[3].style.opacity}, at ${current()}`);
  see(`fills ${Math.abs(own.left + own.right - box.left - box.right) < 4 && Math.min(Math.abs(own.width - box.width), Math.abs(own.height - box.height)) < 2}`);
  await go("left", () => button("from further left").click());
  const left = photographs[current()];
  see(`is left ${dot(photographs[3].rotation[0], minus(left.center, photographs[3].center)) < 0}`);
  const last = current();
  await go("alike", () => button("more like this").click());
  see(`another ${current() !== last && current() >= 0}`);
  // A click on a point that the photograph shows near its middle.
  const { center, rotation, focal, size, points: seen } = photographs[current()];
  const scale = focal * Math.min(box.width / size[0], box.height / size[1]);
  const places = seen.map(i => rotation.map(row => dot(row, minus(points[i], center)))).map(([x, y, z]) => [scale * x / z, scale * y / z]);
  const [x, y] = places.sort((a, b) => Math.hypot(...a) - Math.hypot(...b))[0];
  mouse(canvas, "pointerdown", 0.5 + x / box.width, 0.5 + y / box.height);
  mouse(canvas, "pointerup", 0.5 + x / box.width, 0.5 + y / box.height);
  await slow();
  see(`point in several ${/^point \d+ is in ([2-9]|\d\d) photographs: /.test(word())}`);
  await go("all", () => button("all of it").click());
  const still = canvas.toDataURL();
  mouse(canvas, "pointerdown", 0.5, 0.5); mouse(canvas, "pointermove", 0.6, 0.5); mouse(canvas, "pointerup", 0.6, 0.5);
  see(`turned ${canvas.toDataURL() !== still}`);
  const turned = canvas.toDataURL();
  canvas.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowUp", bubbles: true }));
  see(`keys ${canvas.toDataURL() !== turned}`);
  done();
})();
