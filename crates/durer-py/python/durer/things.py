"""What scenes in code are made of: things that write themselves in the scene language."""

from __future__ import annotations

from typing import Any, Iterable, Mapping, Optional, TypeVar, Union

import numpy as np
import numpy.typing as npt

from ._arrays import finite, matrix, seen
from .rays import Mesh

Self = TypeVar("Self", bound="Object")


def number(value: Any) -> str:
    """A number as the reader takes it: the shortest that is the same in single precision."""
    single = np.float32(value)
    if not np.isfinite(single):
        raise ValueError(f"{value} is not finite in single precision")
    return np.format_float_positional(single, trim="-") if 1e-4 <= abs(single) < 1e7 or single == 0 else repr(float(single))


class Thing:
    """A word of the scene language with its fields."""

    def __init__(self, word: str, fields: Iterable[tuple[str, Any]]) -> None:
        self.word = word
        # Two fields may be spelled alike, as the materials of a pattern are.
        self.fields = [(name, value) for name, value in fields if value is not None]

    def materials(self) -> list[Material]:
        """The materials that its fields name."""
        return [value for _, value in self.fields if isinstance(value, Material)]

    def text(self, numbers: Optional[Mapping[int, int]] = None) -> str:
        """How it is written; `numbers` are those of materials, by identity."""
        parts = [f"{name} {self._value(name, value, numbers or {})}" for name, value in self.fields]
        return f"{self.word} {{ {'  '.join(parts)} }}"

    def _value(self, name: str, value: Any, numbers: Mapping[int, int]) -> str:
        if isinstance(value, str):
            return value
        if isinstance(value, Material):
            return str(numbers[id(value)])
        if isinstance(value, (int, np.integer)) and not isinstance(value, bool):
            return str(int(value))
        array = seen(f"{self.word}: {name}", value)
        if array.ndim == 0:
            return number(array)
        if array.ndim == 1 and array.shape == (3,):
            return " ".join(number(x) for x in array)
        if array.ndim == 2:
            return "{ " + "  ".join(" ".join(number(x) for x in row) for row in array) + " }"
        raise ValueError(f"{self.word}: {name} must be one number, three, or rows of them, but has the shape {array.shape}")

    def __repr__(self) -> str:
        return f"{self.word}({', '.join(f'{name}={value!r}' for name, value in self.fields)})"


class Camera(Thing):
    """What sees."""


class Light(Thing):
    """What shines."""


class Material(Thing):
    """How a surface looks."""

    def materials(self) -> list[Material]:
        return [m for value in super().materials() for m in [*value.materials(), value]]


class Object:
    """Something in a scene: a shape, a mesh, several of them, or one of them moved."""

    material: Optional[Material] = None

    def of(self: Self, material: Material) -> Self:
        """The same, made of a material; what is in it and has one of its own keeps that."""
        import copy

        other = copy.copy(self)
        other.material = material
        return other

    def at(self, place: npt.ArrayLike) -> Moved:
        """The same at another place: moved by three numbers, or by a matrix of 3 x 4 or 4 x 4."""
        return Moved(self, place)

    def parts(self) -> Iterable[Object]:
        """The objects in it."""
        return ()

    def write(self, writer: Writer, material: Optional[Material]) -> str:
        """How it is written, where such a material holds around it."""
        raise NotImplementedError


class Writer:
    """What is known while a scene is written."""

    def __init__(self) -> None:
        self.order: list[Material] = []
        self.numbers: dict[int, int] = {}
        self.meshes: list[Mesh] = []

    def number(self, material: Material) -> int:
        """The number of a material; those that it names come before it."""
        for one in [*material.materials(), material]:
            if id(one) not in self.numbers:
                self.numbers[id(one)] = len(self.order)
                self.order.append(one)
        return self.numbers[id(material)]

    def mesh(self, mesh: Mesh) -> str:
        """The name of a mesh's file."""
        if not any(known is mesh for known in self.meshes):
            self.meshes.append(mesh)
        return f"mesh{next(i for i, known in enumerate(self.meshes) if known is mesh)}.ply"

    def object(self, item: Union[Object, Mesh], around: Optional[Material]) -> str:
        """An object with its material before it."""
        item = Model(item) if isinstance(item, Mesh) else item
        if not isinstance(item, Object):
            raise TypeError(f"objects must be shapes, meshes, groups or solids, but this is {type(item).__name__}: {item!r}")
        material = item.material or around
        words = "" if material is None else f"MaterialIndex {self.number(material)} "
        return words + item.write(self, material)


class Shape(Thing, Object):
    """What can be hit."""

    def write(self, writer: Writer, material: Optional[Material]) -> str:
        return self.text(writer.numbers)


class Model(Object):
    """A mesh in a scene."""

    def __init__(self, mesh: Mesh) -> None:
        self.mesh = mesh

    def write(self, writer: Writer, material: Optional[Material]) -> str:
        mesh, (x, y, z) = f"TriangleMesh {{ obj_file {writer.mesh(self.mesh)} }}", self.mesh._center.tolist()
        if not self.mesh._far:
            return mesh
        return f"Transform {{ Matrix {{ 1 0 0 {x!r}  0 1 0 {y!r}  0 0 1 {z!r}  0 0 0 1 }} {mesh} }}"


class Group(Object):
    """Several objects."""

    word = "Group"

    def __init__(self, *objects: Union[Object, Mesh]) -> None:
        self.objects = objects

    def write(self, writer: Writer, material: Optional[Material]) -> str:
        lines = [writer.object(item, material).replace("\n", "\n    ") for item in self.objects]
        return f"{self.word} {{\n    " + "\n    ".join(lines) + "\n}"


class Union_(Group):
    """All that is in some part; surfaces inside other parts stay."""

    word = "Union"


class Merge(Group):
    """All that is in some part, as one solid."""

    word = "Merge"


class Intersection(Group):
    """What is in every part."""

    word = "Intersection"


class Difference(Group):
    """What is in the first part and in no other."""

    word = "Difference"


class Xor(Group):
    """What is in an odd number of parts."""

    word = "Xor"


class Moved(Object):
    """An object at another place."""

    def __init__(self, item: Union[Object, Mesh], place: npt.ArrayLike) -> None:
        array = seen("place", place)
        if array.shape == (3,):
            array = np.concatenate([np.eye(3), array[:, None]], axis=1)
        self.item, self.matrix = item, matrix("place", array)
        self.material = None if isinstance(item, Mesh) else item.material

    def write(self, writer: Writer, material: Optional[Material]) -> str:
        rows = "  ".join(" ".join(number(x) for x in row) for row in self.matrix)
        inner = Model(self.item) if isinstance(self.item, Mesh) else self.item
        # A transform holds one object, without a word about its material.
        return f"Transform {{ Matrix {{ {rows}  0 0 0 1 }} {inner.write(writer, material)} }}"


def ply(mesh: Mesh) -> bytes:
    """A mesh as a binary PLY file, as it is seen from the middle of what is far away."""
    vertices, corners = mesh._own, mesh.faces
    is_finite = finite(vertices)
    if not is_finite.all():
        # Such triangles are not there, but keep their numbers: they are points.
        vertices = np.where(is_finite[:, None], vertices, np.float32(0))
        corners = np.where(is_finite[corners].all(axis=1, keepdims=True), corners, corners[:, :1])
    head = (
        "ply\nformat binary_little_endian 1.0\n"
        f"element vertex {len(vertices)}\nproperty float x\nproperty float y\nproperty float z\n"
        f"element face {len(corners)}\nproperty list uchar uint vertex_indices\nend_header\n"
    )
    faces = np.zeros(len(corners), [("count", "u1"), ("corners", "<u4", 3)])
    faces["count"], faces["corners"] = 3, corners
    return head.encode() + vertices.astype("<f4").tobytes() + faces.tobytes()
