// The browser side of `durer.widget.Explorer`: shows the image, and sends drags, wheel turns, keys
// and clicks.
const element = (name, inside, text) => {
  const child = document.createElement(name);
  if (text !== undefined) child.textContent = text;
  inside.append(child);
  return child;
};

// Adds a node of the explanation: its display colour, its description, and its terms below it.
const branch = (node, inside, open) => {
  const leaf = !node.terms.length;
  const box = element(leaf ? "div" : "details", inside), head = leaf ? box : element("summary", box);
  box.open = open;
  const chip = element("span", head);
  chip.className = "durer-chip";
  chip.style.background = node.color;
  element("span", head, node.text);
  box.classList.add("durer-node");
  node.terms.forEach(term => branch(term, box, open && node.terms.length < 4));
};

function render({ model, el }) {
  el.classList.add("durer");
  const image = element("img", el), status = element("p", el), tree = element("div", el);
  Object.assign(image, { tabIndex: 0, draggable: false, alt: "the scene: drag or use the arrow keys to orbit, plus and minus to zoom, click a pixel to explain it" });
  status.setAttribute("role", "status");
  const draw = () => {
    URL.revokeObjectURL(image.src);
    image.src = URL.createObjectURL(new Blob([model.get("picture")], { type: "image/png" }));
  };
  const show = () => {
    const explanation = model.get("explanation");
    tree.replaceChildren();
    status.textContent = model.get("status");
    if (explanation.terms) branch(explanation, tree, true);
  };
  // Send one request at a time, and accumulate further input until it is answered.
  let busy = false, turn = [0, 0], zoom = 1, ask = null;
  const send = () => {
    if (busy || (!turn[0] && !turn[1] && zoom === 1 && !ask)) return;
    busy = true;
    model.send({ turn, zoom, ask });
    turn = [0, 0]; zoom = 1; ask = null;
  };
  const handled = () => { busy = false; send(); };
  const drag = (x, y) => { turn = [turn[0] + x, turn[1] + y]; send(); };
  let held = null;
  image.addEventListener("pointerdown", e => { held = { x: e.clientX, y: e.clientY, far: 0 }; image.setPointerCapture(e.pointerId); });
  image.addEventListener("pointermove", e => {
    if (!held) return;
    const x = e.clientX - held.x, y = e.clientY - held.y;
    held.far += Math.abs(x) + Math.abs(y);
    if (held.far < 4) return;
    [held.x, held.y] = [e.clientX, e.clientY];
    drag(x / image.clientWidth, y / image.clientWidth);
  });
  image.addEventListener("pointerup", e => {
    const box = image.getBoundingClientRect();
    if (held && held.far < 4) { ask = [(e.clientX - box.left) / box.width, (e.clientY - box.top) / box.height]; send(); }
    held = null;
  });
  image.addEventListener("wheel", e => { e.preventDefault(); zoom *= Math.exp(e.deltaY / 800); send(); }, { passive: false });
  image.addEventListener("keydown", e => {
    const keys = { ArrowLeft: [-0.05, 0], ArrowRight: [0.05, 0], ArrowUp: [0, -0.05], ArrowDown: [0, 0.05] };
    if (keys[e.key]) { e.preventDefault(); drag(...keys[e.key]); }
    if (e.key === "+" || e.key === "-") { zoom *= e.key === "+" ? 0.9 : 1.1; send(); }
  });
  model.on("change:picture", draw);
  model.on("change:explanation", show);
  model.on("change:status", show);
  model.on("change:handled", handled);
  draw();
  show();
  return () => {
    URL.revokeObjectURL(image.src);
    model.off("change:picture", draw); model.off("change:explanation", show); model.off("change:status", show); model.off("change:handled", handled);
  };
}

export default { render };
