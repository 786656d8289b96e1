"""Runs the `durer` command, which is part of the package:
`python -m durer render scene.txt -o picture.png`."""

import sys

from ._durer import command


def main() -> int:
    """Runs the command line and returns the exit code."""
    return command(["durer", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
