"""Writes the notebooks beside this file: the example programs as cells, with their results as
images.

    python notebooks.py
"""

import ast
import json
from pathlib import Path

HERE = Path(__file__).parent

#: Cells that follow a program's functions: calls, and images of the results.
CALLS = {
    "signed_distance": [
        "mesh = durer.Mesh(*together(ball(1.0, 48), box((1.2, -0.5, -0.5), (2.0, 0.5, 0.5))))\n"
        "distances, start, side = signed_distances(mesh, 60)\ndistances.shape, distances.min(), distances.max()",
        "# A slice through the middle: the surface is where the grey level is one half.\n"
        "from shapes import Picture\n\nPicture(0.5 + 0.5 * distances[:, :, 30].T[::-1], zoom=5)",
    ],
    "ambient_occlusion": [
        "mesh = durer.Mesh(*together(grid(-3, 3, -3, 3, 60), ball(1.0, 24, (0, 0, 1.0)), box((1.2, -1, 0), (2.2, 1, 1.5))))\n"
        "seen = openness(mesh, 64)\nseen.min(), seen.mean()",
        "# The floor's vertices, seen from above.\n"
        "from shapes import Picture\n\nPicture(seen[: 61 * 61].reshape(61, 61).T[::-1], zoom=5)",
    ],
    "xray": [
        "shell, hollow, core = ball(1.0, 64), ball(0.8, 64), ball(0.3, 32, (0.2, 0.1, 0))\n"
        "mesh = durer.Mesh(*together(shell, (hollow[0], hollow[1][:, ::-1]), core))\n"
        "x, y = np.meshgrid(np.linspace(-1.2, 1.2, 300), np.linspace(1.2, -1.2, 300))\n"
        "length = thickness(mesh, np.stack([x, y, np.full(x.shape, 5.0)], -1), [0, 0, -1.0])\nlength.max()",
        "# The Beer-Lambert law: the light that remains.\nfrom shapes import Picture\n\nPicture(1 - np.exp(-1.2 * length))",
    ],
    "lidar": [
        "parked, tree = durer.Mesh(*box((-2.2, -0.9, 0.2), (2.2, 0.9, 1.5))), durer.Mesh(*ball(1.5, 24, (0, 0, 3.5)))\n"
        "road = durer.Mesh(*grid(-80, 80, -80, 80, 2))\n"
        "scene = durer.Scene([road, (parked, [[1, 0, 0, 6], [0, 1, 0, 3], [0, 0, 1, 0]]), (tree, [[1, 0, 0, 4], [0, 1, 0, -8], [0, 0, 1, 0]])])\n"
        "points, objects, power = scan(scene, (0, 0, 1.8), noise=0.02)\nlen(points), np.bincount(objects)",
        "# The points from above, 40 metres across. Objects on the road are brighter than the road.\n"
        "from shapes import Picture\n\nfar = [[-20, 20], [-20, 20]]\n"
        "count, *_ = np.histogram2d(points[:, 0], points[:, 1], 400, far, weights=np.where(objects > 0, 1.0, 0.3))\n"
        "Picture(count.T[::-1])",
    ],
    "depth_data": [
        "one = sample(5)\n{name: array.shape for name, array in one.items()}",
        "# Depth, the motion of each pixel to the other pose, and the objects.\nfrom shapes import Picture\n\n"
        "parts = [1 / one['depth'] * 4, np.linalg.norm(one['flow'], axis=-1) / 10, (one['instances'] + 1) / 10]\n"
        "Picture(np.concatenate(parts, axis=1), zoom=2)",
    ],
    "shadow_hours": [
        "rng = np.random.default_rng(3)\n"
        "houses = [box((x, y, 0), (x + 18, y + 14, rng.uniform(6, 30))) for x in range(-100, 100, 40) for y in range(-100, 100, 36)]\n"
        "city = durer.Mesh(*together(*houses))\n"
        "x, y = np.meshgrid(np.linspace(-100, 100, 200), np.linspace(100, -100, 200))\n"
        "places = np.stack([x, y, np.full(x.shape, 1.5)], -1)\nfree = ~city.contains(places)\n"
        "sunny = np.where(free, hours(city, places, 62.2, 80), 0)\nsunny[free].mean(), sunny.max()",
        "# North is up; houses are black.\nfrom shapes import Picture\n\nPicture(sunny / sunny.max(), zoom=2)",
    ],
}

#: Cells of the notebook that belongs to no example program.
PICTURES = [
    "# Images, and why they look as they do\n\nA scene built in code, its image, possible mistakes in it, why a pixel has its colour, and a view that you can orbit.",
    "import durer\n\nred, white = (durer.PhongMaterial(diffuse_color=c) for c in [(0.8, 0.2, 0.1), (0.8, 0.8, 0.8)])\n"
    "world = durer.World(\n"
    "    durer.PerspectiveCamera(center=(0, 2, 8), direction=(0, -0.2, -1), up=(0, 1, 0), angle=35),\n"
    "    [durer.Sphere(center=(0, 1, 0), radius=1).of(red), durer.Plane(normal=(0, 1, 0), offset=0).of(white)],\n"
    "    [durer.DirectionalLight(direction=(-1, -2, -1), color=(0.9, 0.9, 0.9))],\n"
    "    durer.Background(color=(0.3, 0.4, 0.6), ambient_light=(0.2, 0.2, 0.2)),\n)\n"
    "pictures = world.render(size=(320, 240), samples=16, show='color,depth')\npictures",
    "pictures['depth'].shape, pictures.hash[:16], world.check()",
    "from durer.widget import Explorer\n\nexplorer = Explorer(world, size=(320, 240))\nexplorer",
    "# A click on the shadow gives this explanation.\nexplorer.explain(90, 138)",
]


def cells_of(name: str) -> list[str]:
    """Returns the text of a notebook's cells for a program; the first is prose."""
    source = (HERE / f"{name}.py").read_text()
    tree = ast.parse(source)
    title, _, rest = (ast.get_docstring(tree) or "").partition(":")
    prose = rest.split("\n\n")[0].strip()
    kept = [node for node in tree.body[1:] if not (isinstance(node, ast.FunctionDef) and node.name == "main")]
    lines, code = source.splitlines(), []
    for node in kept:
        if isinstance(node, ast.If) or isinstance(node, ast.Import) and node.names[0].name == "sys":
            continue
        start = node.lineno - 1
        # Include the comments directly above the definition.
        while lines[start - 1].startswith("#"):
            start -= 1
        is_import = isinstance(node, (ast.Import, ast.ImportFrom))
        text = "\n".join(lines[start : node.end_lineno])
        if is_import and code:
            code[-1] += "\n" + text
        else:
            code.append(text)
    return [f"# {title}\n\n{prose[:1].upper()}{prose[1:]}", "\n\n\n".join(code), *CALLS[name]]


def notebook(cells: list[str]) -> str:
    """Returns a notebook in format 4.5, without outputs."""
    made = []
    for i, text in enumerate(cells):
        cell = {"id": f"cell-{i}", "metadata": {}, "source": text.splitlines(keepends=True)}
        made.append({"cell_type": "markdown", **cell} if i == 0 else {"cell_type": "code", "execution_count": None, "outputs": [], **cell})
    kernel = {"kernelspec": {"display_name": "Python 3", "language": "python", "name": "python3"}}
    return json.dumps({"cells": made, "metadata": kernel, "nbformat": 4, "nbformat_minor": 5}, indent=1) + "\n"


def all_notebooks() -> dict[str, str]:
    """Returns the names and contents of all notebooks."""
    return {**{name: notebook(cells_of(name)) for name in CALLS}, "pictures": notebook(PICTURES)}


if __name__ == "__main__":
    for name, text in all_notebooks().items():
        (HERE / f"{name}.ipynb").write_text(text)
