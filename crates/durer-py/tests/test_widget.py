"""Tests of the notebook widget: its camera and its explanations, in a Jupyter kernel, and its page
in a browser."""

import json
import re
import shutil
import subprocess

import numpy as np
import pytest

import durer

pytest.importorskip("anywidget")
from durer.widget import Explorer  # noqa: E402

STILL = {"turn": [0, 0], "zoom": 1, "ask": None}


@pytest.fixture
def explorer(scenes):
    return Explorer(durer.load(scenes / "whitted.txt"), size=(80, 60), samples=1)


def camera(world):
    numbers = lambda name: np.array(re.search(rf"\b{name}((?:\s+\S+){{3}})", world.text)[1].split(), float)  # noqa: E731
    return numbers("center"), numbers("direction")


def test_the_first_picture_is_that_of_the_world(explorer, scenes):
    assert explorer.picture == durer.load(scenes / "whitted.txt").render(size=(80, 60), samples=1).file("a.png")
    assert explorer.picture[:4] == b"\x89PNG" and explorer.handled == 0


def test_camera_orbits_its_target(explorer):
    eye, along = camera(explorer.world)
    first, target = explorer.picture, explorer._camera.target.copy()
    far = np.linalg.norm(eye - target)
    explorer._handle({**STILL, "turn": [0.5, 0]})
    there, looks = camera(explorer.world)
    assert explorer.picture != first and explorer.handled == 1 and explorer.status.startswith("seen from")
    # A quarter turn about the vertical keeps the height and the distance.
    flat = np.array([1, 0, 1])
    assert abs(there[1] - eye[1]) < 1e-4 and abs(np.linalg.norm(there - target) - far) < 1e-4 * far
    assert abs(((eye - target) * flat) @ ((there - target) * flat)) < 1e-3
    assert np.allclose(np.cross(looks, target - there), 0, atol=1e-4)
    explorer._handle({**STILL, "turn": [-0.5, 0]})
    assert np.allclose(camera(explorer.world)[0], eye, atol=1e-4)
    # Dragging to the right turns the scene to the right, so the camera moves left.
    explorer._handle({**STILL, "turn": [0.05, 0]})
    right = np.cross(along, [0, 1, 0])
    assert (camera(explorer.world)[0] - eye) @ right < 0
    explorer._handle({**STILL, "zoom": 0.5})
    assert abs(np.linalg.norm(camera(explorer.world)[0] - target) - far / 2) < 1e-3
    # The camera never turns upside down.
    for _ in range(9):
        explorer._handle({**STILL, "turn": [0, 0.3]})
    assert "Error" not in explorer.status and camera(explorer.world)[0][1] > target[1]


def test_a_click_explains_the_pixel(explorer, scenes):
    explorer._handle({**STILL, "ask": [0.5, 0.5]})
    told = explorer.explanation
    assert explorer.status == "pixel 40, 30" and told["text"].startswith("camera ray to Sphere ")
    assert len(told["terms"]) > 2 and any("PointLight" in term["text"] for term in told["terms"])
    whole = durer.load(scenes / "whitted.txt").explain(40, 30, size=(80, 60), samples=1)
    assert told["value"] == whole["pixel"]["samples"][0]["light"]["value"]
    explorer._handle({**STILL, "turn": [0.1, 0]})
    assert explorer.explanation == {}
    json.dumps(explorer.get_state(["explanation", "status", "handled"]))


def test_worlds_in_code_and_with_comments_have_their_camera_found():
    red = durer.PhongMaterial(diffuse_color=(0.8, 0.2, 0.2))
    eye = durer.PerspectiveCamera(center=(0, 1, 8), direction=(0, -0.1, -1), up=(0, 1, 0), angle=40)
    light = durer.DirectionalLight(direction=(-1, -2, -1), color=(1, 1, 1))
    mesh = durer.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    world = durer.World(eye, [durer.Sphere(center=(0, 0, 0), radius=1).of(red), durer.Model(mesh)], [light])
    shown = Explorer(world, size=(40, 30), samples=1)
    shown._handle({**STILL, "turn": [0.2, 0.1]})
    assert "Error" not in shown.status and shown.handled == 1
    commented = world.rewritten("# not PerspectiveCamera { center 1 1 1 }\n" + world.text.replace("up 0 1 0", "# }\n up 0 1 0", 1))
    shown = Explorer(commented, size=(40, 30), samples=1)
    shown._handle({**STILL, "turn": [0.2, 0.1]})
    assert "Error" not in shown.status and "# not PerspectiveCamera { center 1 1 1 }" in shown.world.text


def test_scene_without_orbitable_camera_is_refused(scenes, tmp_path):
    camera = durer.ProjectiveCamera(matrix=[[100, 0, -50, 0], [0, -100, -50, 0], [0, 0, -1, 0]], width=100, height=100)
    measured = durer.World(camera, [durer.Sphere(center=(0, 0, -3), radius=1)])
    with pytest.raises(ValueError, match="a camera without `center` cannot orbit: ProjectiveCamera"):
        Explorer(measured)
    with pytest.raises(ValueError, match="no camera in the scene language"):
        (tmp_path / "model.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        Explorer(durer.load(tmp_path / "model.obj"))
    without = durer.load(scenes / "whitted.txt")
    with pytest.raises(TypeError, match="no option sample_count: did you mean"):
        Explorer(without, sample_count=3)
    shown = Explorer(without, size=(20, 20), samples=1)
    shown._handle({"turn": None})
    assert shown.status == "KeyError: zoom" and shown.handled == 1


def test_widget_in_kernel(scenes, tmp_path):
    nbformat = pytest.importorskip("nbformat")
    client = pytest.importorskip("nbclient")
    cells = [
        f"import durer\nfrom durer.widget import Explorer\nshown = Explorer(durer.load({str(scenes / 'whitted.txt')!r}), size=(40, 30))\nshown",
        "shown.explain(20, 15)['text']",
    ]
    notebook = nbformat.v4.new_notebook(cells=[nbformat.v4.new_code_cell(cell) for cell in cells])
    ran = client.NotebookClient(notebook, timeout=120, kernel_name="python3", resources={"metadata": {"path": tmp_path}})
    ran.execute()
    [shown] = notebook.cells[0].outputs
    view = shown["data"]["application/vnd.jupyter.widget-view+json"]
    state = notebook.metadata.widgets["application/vnd.jupyter.widget-state+json"]["state"][view["model_id"]]
    assert "model.send({ turn, zoom, ask })" in state["state"]["_esm"] and state["buffers"][0]["path"] == ["picture"]
    assert "camera ray to Sphere" in notebook.cells[1].outputs[0]["data"]["text/plain"]


PAGE = """<!DOCTYPE html><title></title><body><div id=el></div>
<script type=module>
@WIDGET@
const seen = [], see = text => seen.push(text), heard = {}, state = @STATE@;
state.picture = Uint8Array.from(atob(state.picture), c => c.charCodeAt(0));
const model = { get: name => state[name], on: (name, f) => heard[name] = f, off: () => see("off"), send: wish => see("sent " + JSON.stringify(wish)) };
const put = (name, value) => { state[name] = value; heard["change:" + name](); };
window.addEventListener("error", e => see("ERROR " + e.message));
Element.prototype.setPointerCapture = () => {};
const el = document.getElementById("el"), end = widget.render({ model, el }), image = el.querySelector("img");
const mouse = (type, x, y) => {
  const box = image.getBoundingClientRect();
  image.dispatchEvent(new PointerEvent(type, { clientX: box.left + x * box.width, clientY: box.top + y * box.height, bubbles: true, pointerId: 1 }));
};
image.decode().then(() => {
  see(`picture ${image.naturalWidth}x${image.naturalHeight}`);
  mouse("pointerdown", 0.25, 0.5); mouse("pointerup", 0.25, 0.5);
  put("handled", 1);
  mouse("pointerdown", 0.25, 0.5); mouse("pointermove", 0.75, 0.5); mouse("pointermove", 0.5, 0.5); mouse("pointerup", 0.5, 0.5);
  see("waits"); put("handled", 2); put("handled", 3);
  image.dispatchEvent(new KeyboardEvent("keydown", { key: "+" }));
  put("handled", 4);
  put("explanation", @TOLD@); put("status", "pixel 1, 2");
  see(el.querySelector("p").textContent);
  see(`tree ${el.querySelectorAll(".durer-node").length} ${el.querySelector("summary").textContent} ${el.querySelector(".durer-chip").style.background}`);
  end();
  document.title = "SEEN " + seen.join(" | ") + " END";
});
</script>"""


def test_page_in_browser(explorer, tmp_path):
    browser = next(filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None)
    if browser is None:
        pytest.skip("there is no chromium to open the page in")
    import base64

    state = {"picture": base64.b64encode(explorer.picture).decode(), "explanation": {}, "status": "seen from", "handled": 0}
    code = explorer._esm if isinstance(explorer._esm, str) else str(explorer._esm)
    page = PAGE.replace("@WIDGET@", code.replace("export default { render };", "const widget = { render };"))
    page = page.replace("@STATE@", json.dumps(state)).replace("@TOLD@", json.dumps(explorer.explain(40, 30)))
    (tmp_path / "page.html").write_text(page)
    words = [browser, "--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={tmp_path / 'profile'}", "--virtual-time-budget=5000"]
    done = subprocess.run([*words, "--dump-dom", f"file://{tmp_path / 'page.html'}"], capture_output=True, text=True, timeout=120)
    title = re.search(r"<title>(.*?)</title>", done.stdout, re.DOTALL)[1]
    nodes = 0
    waiting = [explorer.explanation]
    while waiting:
        node = waiting.pop()
        nodes += 1
        waiting += node["terms"]
    for wanted in (
        "picture 80x60",
        'sent {"turn":[0,0],"zoom":1,"ask":[0.25,0.5]}',
        'sent {"turn":[0.5,0],"zoom":1,"ask":null} | waits | sent {"turn":[-0.25,0],"zoom":1,"ask":null}',
        'sent {"turn":[0,0],"zoom":0.9,"ask":null}',
        "pixel 1, 2",
        f"tree {nodes} camera ray to Sphere",
        "off END",
    ):
        assert wanted in title, title
    assert "ERROR" not in title
