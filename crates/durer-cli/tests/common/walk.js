// Animate without delay, also in windows that are not visible.
window.requestAnimationFrame = step => setTimeout(() => step(performance.now()), 5);
window.matchMedia = () => ({ matches: true });
const wait = () => new Promise(resolve => setTimeout(resolve, 200));
const go = async (what, act) => { act(); await wait(); see(`${what}: ${word.textContent}, at ${current}`); };
const button = name => [...moves.children].find(child => child.textContent === name);
(async () => {
  await wait();
  see(word.textContent);
  await go("button first", () => button("closer").click());
  await go("strip", () => strip.children[3].click());
  // The photograph fills the window, because the viewer has the photograph's camera.
  const [a, , c] = photographs[3].corners.map(pixel), box = canvas.getBoundingClientRect(), ratio = canvas.width / box.width;
  see(`opacity ${images[3].style.opacity}, marked ${strip.children[3].getAttribute("aria-current")}`);
  see(`fills ${Math.abs((a[0] + c[0]) / 2 - canvas.width / 2) < 2 && Math.abs(c[0] - a[0] - canvas.width) < 2}`);
  await go("left", () => button("from further left").click());
  const left = photographs[3].rotation[0].reduce((sum, v, i) => sum + v * (photographs[current].center[i] - photographs[3].center[i]), 0);
  see(`is left ${left < 0}`);
  const last = current;
  await go("alike", () => button("more like this").click());
  see(`another ${current !== last && current >= 0}`);
  const [, x, y, number] = visible[visible.length >> 1];
  const seers = photographs.filter(photo => photo.points.includes(number)).length;
  mouse(canvas, "pointerdown", x / canvas.width, y / canvas.height);
  mouse(canvas, "pointerup", x / canvas.width, y / canvas.height);
  await wait();
  see(`point in several ${chosen.size > 1}, note ${word.textContent.includes(`is in ${chosen.size} photographs`)}`);
  await go("all", () => button("all of it").click());
  const inside = photographs.filter(p => { const [x, y, z] = pixel(p.center); return z > 0 && x > 0 && y > 0 && x < canvas.width && y < canvas.height; });
  see(`all inside ${inside.length === photographs.length}`);
  // While one photograph fades into another, both are on one plane.
  const [[p, q, r, s], others] = shared(photographs[3], photographs[4]), across = unit(cross(minus(q, p), minus(s, p)));
  see(`one plane ${[r, ...others].every(corner => Math.abs(dot(minus(corner, p), across)) < 1e-6 * reach)}`);
  const before = eye.center.join();
  mouse(canvas, "pointerdown", 0.5, 0.5); mouse(canvas, "pointermove", 0.6, 0.5); mouse(canvas, "pointerup", 0.6, 0.5);
  see(`turned ${before !== eye.center.join()}`);
  done();
})();
