"""The scenes that both programs render, and the judgement of each."""

import dataclasses
import importlib
import re

import mitsuba_xml as x

# Each module in `kinds` is one kind of scenes.
KINDS = [
    "furnaces", "conductors", "dielectrics", "plastics", "principled", "sides", "textures", "bumps", "masks",
    "point_lights", "area_lights", "environments", "spectra", "media", "integrators", "cameras", "meshes", "curves",
]


@dataclasses.dataclass
class Scene:
    """A scene in Mitsuba's XML.

    `variant` is Mitsuba's. `warns` has a part of each warning that Dürer prints. `differs` says why Dürer differs, and
    `mitsuba_is_wrong` why Mitsuba does.
    """
    kind: str
    name: str
    text: str
    warns: tuple = ()
    differs: str = ""
    mitsuba_is_wrong: str = ""
    samples: int = 0
    variant: str = "scalar_rgb"
    options: list = dataclasses.field(default_factory=list)
    extension: str = "xml"

    @property
    def slug(self):
        return re.sub("[^a-z0-9]+", "-", f"{self.kind} {self.name}".lower()).strip("-")

    def load(self, mitsuba, path):
        mitsuba.set_variant(self.variant)
        return mitsuba.load_file(str(path))


def stage(*parts, sensor=None, integrator=None):
    """Returns a document with the usual camera and integrator."""
    return x.document(integrator or x.integrator(), sensor or x.sensor(), *parts)


def scenes():
    for kind in KINDS:
        module = importlib.import_module(f"kinds.{kind}")
        for name, text, *known in module.scenes():
            yield Scene(kind.replace("_", " "), name, text, **(known[0] if known else {}))


@dataclasses.dataclass
class Verdict:
    scene: Scene
    judgement: object
    warnings: list
    seconds: float

    @property
    def agrees(self):
        return self.judgement is not None and self.judgement.agrees

    @property
    def warned(self):
        """True if Dürer warned of exactly what the scene expects, each once."""
        expected, left = list(self.scene.warns), list(self.warnings)
        for part in expected:
            found = [line for line in left if part in line]
            if len(found) != 1:
                return False
            left.remove(found[0])
        return not left

    @property
    def expected(self):
        known = self.scene.differs or self.scene.mitsuba_is_wrong
        return self.warned and self.judgement is not None and self.agrees != bool(known)

    def line(self):
        j, name = self.judgement, f"{self.scene.kind}: {self.scene.name}"
        if j is None:
            return f"| {name} | {self.warnings[0]} | FAILED |"
        found = "agrees" if j.agrees else "differs"
        note = self.scene.mitsuba_is_wrong or self.scene.differs
        mark = "" if self.expected else " UNEXPECTED"
        warnings = "" if self.warned else f" warnings: {self.warnings}"
        return (f"| {name} | {words(j.ratios)} ± {100 * j.error:.2f} % | {j.blocks_off} of {j.block_count} blocks, {j.deviate:.1f} | "
                f"{found}{mark}{'; ' + note if note else ''}{warnings} | {self.seconds:.1f} s |")

    @staticmethod
    def table(verdicts, version):
        """Returns the part of docs/validation.md that this program writes."""
        kinds = list(dict.fromkeys(verdict.scene.kind for verdict in verdicts))
        lines = ["| kind | scenes | agree | largest difference of a mean | scene |", "| --- | ---: | ---: | ---: | --- |"]
        for kind in kinds:
            of = [verdict for verdict in verdicts if verdict.scene.kind == kind and verdict.judgement]
            good = [verdict for verdict in of if verdict.agrees]
            worst = max(of, key=lambda verdict: abs(verdict.judgement.ratio - 1), default=None)
            if worst:
                lines.append(f"| {kind} | {len(of)} | {len(good)} | {100 * (worst.judgement.ratio - 1):+.2f} % | {worst.scene.name} |")
        off = [verdict for verdict in verdicts if not verdict.agrees]
        good = len(verdicts) - len(off)
        text = f"{good} of {len(verdicts)} scenes agree (Mitsuba {version}).\n\n" + "\n".join(lines) + "\n"
        if off:
            text += "\nScenes that differ:\n\n| scene | mean, ours over theirs | blocks that differ | why |\n| --- | ---: | ---: | --- |\n"
        for verdict in off:
            j, scene = verdict.judgement, verdict.scene
            figures = f"{j.ratio:.4f} ± {j.error:.4f} | {j.blocks_off} of {j.block_count}" if j else "none | none"
            why = f"Mitsuba is wrong: {scene.mitsuba_is_wrong}" if scene.mitsuba_is_wrong else scene.differs or "unknown"
            text += f"| {scene.kind}: {scene.name} | {figures} | {why} |\n"
        return text


def words(values):
    return " ".join(f"{v:.4f}" for v in values)
