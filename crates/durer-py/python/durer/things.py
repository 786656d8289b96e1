"""Classes for building scenes in code. A scene is written in the scene language and then read like
a file."""

from __future__ import annotations

import copy
from typing import Any, Iterable, Mapping, Optional, TypeVar, Union

import numpy as np
import numpy.typing as npt

from ._arrays import as_array, as_matrix, finite
from ._errors import check_type
from .rays import Mesh

Self = TypeVar("Self", bound="Object")


def number(value: Any) -> str:
    """Formats a number as the shortest text that reads back as the same single-precision value."""
    single = np.float32(value)
    if not np.isfinite(single):
        raise ValueError(f"{value} is not finite in single precision")
    return np.format_float_positional(single, trim="-") if 1e-4 <= abs(single) < 1e7 or single == 0 else repr(float(single))


class Thing:
    """Block of the scene language: a keyword with its fields. Base class of cameras, lights,
    materials and shapes."""

    def __init__(self, word: str, fields: Iterable[tuple[str, Any]]) -> None:
        self.word = word
        # Fields are a list because two can have the same name, such as the materials of a pattern.
        self.fields = [(name, value) for name, value in fields if value is not None]

    def materials(self) -> list[Material]:
        """Returns the materials that the fields refer to."""
        return [value for _, value in self.fields if isinstance(value, Material)]

    def text(self, numbers: Optional[Mapping[int, int]] = None) -> str:
        """Returns the block as text. `numbers` maps the `id` of each material to its index."""
        parts = [f"{name} {self._value(name, value, numbers or {})}" for name, value in self.fields]
        return f"{self.word} {{ {'  '.join(parts)} }}"

    def _value(self, name: str, value: Any, numbers: Mapping[int, int]) -> str:
        if isinstance(value, str):
            return value
        if isinstance(value, Material):
            return str(numbers[id(value)])
        if isinstance(value, (int, np.integer)) and not isinstance(value, bool):
            return str(int(value))
        array = as_array(f"{self.word}: {name}", value)
        if array.ndim == 0:
            return number(array)
        if array.ndim == 1 and array.shape == (3,):
            return " ".join(number(x) for x in array)
        if array.ndim == 2:
            return "{ " + "  ".join(" ".join(number(x) for x in row) for row in array) + " }"
        raise ValueError(f"{self.word}: {name} must be one number, three numbers, or rows of numbers, but has the shape {array.shape}")

    def __repr__(self) -> str:
        return f"{self.word}({', '.join(f'{name}={value!r}' for name, value in self.fields)})"


class Camera(Thing):
    """A camera."""


class Light(Thing):
    """A light source."""


class Material(Thing):
    """A surface material."""

    def materials(self) -> list[Material]:
        return [m for value in super().materials() for m in [*value.materials(), value]]


class Object:
    """Object of a scene: a shape, a mesh, a group, a solid, or a transformed object."""

    material: Optional[Material] = None

    def of(self: Self, material: Material) -> Self:
        """Returns the object with a material. Parts that have a material keep it."""
        check_type("material", material, Material, "a material such as PhongMaterial")
        other = copy.copy(self)
        other.material = material
        return other

    def at(self, place: npt.ArrayLike) -> Moved:
        """Returns the object translated by a vector, or transformed by a matrix, 3 x 4 or 4 x 4."""
        return Moved(self, place)

    def parts(self) -> Iterable[Object]:
        """Returns the objects directly inside this one."""
        return ()

    def write(self, writer: Writer, material: Optional[Material]) -> str:
        """Returns the object as text. `material` is the material that applies at that position in
        the file."""
        raise NotImplementedError


class Writer:
    """State of writing a scene: the materials and meshes collected so far."""

    def __init__(self) -> None:
        self.order: list[Material] = []
        self.numbers: dict[int, int] = {}
        self.meshes: list[Mesh] = []

    def number(self, material: Material) -> int:
        """Returns the index of a material, and adds it if it is new. Materials that it refers to
        are added before it."""
        for one in [*material.materials(), material]:
            if id(one) not in self.numbers:
                self.numbers[id(one)] = len(self.order)
                self.order.append(one)
        return self.numbers[id(material)]

    def mesh(self, mesh: Mesh) -> str:
        """Returns the file name of a mesh, and adds the mesh if it is new."""
        if not any(known is mesh for known in self.meshes):
            self.meshes.append(mesh)
        return f"mesh{next(i for i, known in enumerate(self.meshes) if known is mesh)}.ply"

    def object(self, item: Union[Object, Mesh], around: Optional[Material]) -> str:
        """Returns an object as text, preceded by its material."""
        item = as_object(item)
        material = item.material or around
        words = "" if material is None else f"MaterialIndex {self.number(material)} "
        return words + item.write(self, material)


class Shape(Thing, Object):
    """Shape of the scene language, such as a sphere."""

    def write(self, writer: Writer, material: Optional[Material]) -> str:
        return self.text(writer.numbers)


class Model(Object):
    """Mesh as an object of a scene. Like `Mesh`, accepts an object with vertices and faces, such as
    a `trimesh.Trimesh`."""

    def __init__(self, mesh: Any) -> None:
        if not _is_mesh(mesh):
            raise TypeError(f"mesh must be a Mesh, or an object with vertices and faces, but is of type {type(mesh).__name__}")
        self.mesh = mesh if isinstance(mesh, Mesh) else Mesh(mesh)

    def write(self, writer: Writer, material: Optional[Material]) -> str:
        mesh, (x, y, z) = f"TriangleMesh {{ obj_file {writer.mesh(self.mesh)} }}", self.mesh._center.tolist()
        if not self.mesh._far:
            return mesh
        return f"Transform {{ Matrix {{ 1 0 0 {x!r}  0 1 0 {y!r}  0 0 1 {z!r}  0 0 0 1 }} {mesh} }}"


def _is_mesh(item: Any) -> bool:
    return isinstance(item, Mesh) or hasattr(item, "vertices") and hasattr(item, "faces")


def as_object(item: Any) -> Object:
    """Returns a shape, group or solid unchanged, and a mesh as a `Model`."""
    if isinstance(item, Object):
        return item
    if not _is_mesh(item):
        raise TypeError(f"objects must be shapes, meshes, groups or solids, but {item!r} is of type {type(item).__name__}")
    return Model(item)


class Group(Object):
    """Group of objects."""

    word = "Group"

    def __init__(self, *objects: Union[Object, Mesh]) -> None:
        self.objects = objects

    def write(self, writer: Writer, material: Optional[Material]) -> str:
        lines = [writer.object(item, material).replace("\n", "\n    ") for item in self.objects]
        return f"{self.word} {{\n    " + "\n    ".join(lines) + "\n}"


class Union_(Group):
    """Union of solids that keeps surfaces inside other parts."""

    word = "Union"


class Merge(Group):
    """Union of solids without the surfaces inside other parts."""

    word = "Merge"


class Intersection(Group):
    """Solid that consists of the points in all parts."""

    word = "Intersection"


class Difference(Group):
    """Solid that consists of the first part without all others."""

    word = "Difference"


class Xor(Group):
    """Solid that consists of the points in an odd number of parts."""

    word = "Xor"


class Moved(Object):
    """Object with a transform."""

    def __init__(self, item: Union[Object, Mesh], place: npt.ArrayLike) -> None:
        array = as_array("place", place)
        if array.shape not in ((3,), (3, 4), (4, 4)):
            raise ValueError(f"place must be three numbers, or a matrix, 3 x 4 or 4 x 4, but has the shape {array.shape}")
        if array.shape == (3,):
            array = np.concatenate([np.eye(3), array[:, None]], axis=1)
        self.item, self.matrix = as_object(item), as_matrix("place", array)
        self.material = self.item.material

    def write(self, writer: Writer, material: Optional[Material]) -> str:
        rows = "  ".join(" ".join(number(x) for x in row) for row in self.matrix)
        # A transform contains one object, without a material keyword.
        return f"Transform {{ Matrix {{ {rows}  0 0 0 1 }} {self.item.write(writer, material)} }}"


def ply(mesh: Mesh) -> bytes:
    """Returns a mesh as a binary PLY file. Vertices are relative to the mesh's centre if it is far
    from the origin."""
    vertices, corners = mesh._own, mesh.faces
    is_finite = finite(vertices)
    if not is_finite.all():
        # Collapse them to points, so that the other triangles keep their indices.
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
