"""Import of the Python package `durer`, which renders."""

from .units import ExportError

MISSING = (
    "the Python package durer is missing: install the add-on from a zip file that contains it "
    "(`cargo xtask blender --wheel FILE`), or install the package for Blender's Python with `pip install`"
)
OLD = "the Python package durer is too old for this add-on: install both from one version of the repository"


def package():
    """Returns the module `durer`, or raises an ExportError that says how to install it."""
    try:
        import durer
    except ImportError as error:
        raise ExportError(f"{MISSING} ({error})") from None
    if not hasattr(durer.World, "denoise"):
        raise ExportError(OLD)
    return durer
