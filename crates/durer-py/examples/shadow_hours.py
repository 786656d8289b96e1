"""Hours of sun: how long each point between the houses of a city is in the sun on a given day.

    python shadow_hours.py [points per side] [hours.pgm]
"""

import sys

import numpy as np
from shapes import box, save_pgm, together

import durer

#: The tilt of the earth's axis, in degrees.
TILT = 23.44


def sun(latitude: float, day: int, minutes: int = 10) -> np.ndarray:
    """Returns directions to the sun (east, north, up) at intervals of `minutes` while it is above
    the horizon. Day 0 is the first of January.

    The declination follows Cooper's cosine (*Solar Energy* 12, 1969). Time is solar time: at
    noon the sun is due south.
    """
    declination = -np.radians(TILT) * np.cos(2 * np.pi * (day + 10) / 365)
    hour = 2 * np.pi * ((np.arange(0, 24 * 60, minutes) + minutes / 2) / (24 * 60) - 0.5)
    north, tilt = np.radians(latitude), np.full(hour.shape, declination)
    ways = np.stack(
        [
            -np.cos(tilt) * np.sin(hour),
            np.cos(north) * np.sin(tilt) - np.sin(north) * np.cos(tilt) * np.cos(hour),
            np.sin(north) * np.sin(tilt) + np.cos(north) * np.cos(tilt) * np.cos(hour),
        ],
        -1,
    )
    return ways[ways[:, 2] > 0]


def hours(city: durer.Mesh, places, latitude: float, day: int, minutes: int = 10) -> np.ndarray:
    """Returns the hours of sun at points of shape (..., 3)."""
    ways = sun(latitude, day, minutes)
    lit = ~city.occluded(np.asarray(places)[..., None, :], ways)
    return lit.sum(-1) * minutes / 60


def main(side: int = 200, output: str = "hours.pgm") -> None:
    rng = np.random.default_rng(3)
    houses = [
        box((x, y, 0), (x + 18, y + 14, rng.uniform(6, 30))) for x in range(-100, 100, 40) for y in range(-100, 100, 36)
    ]
    city = durer.Mesh(*together(*houses))
    x, y = np.meshgrid(np.linspace(-100, 100, side), np.linspace(100, -100, side))
    places = np.stack([x, y, np.full(x.shape, 1.5)], -1)
    free = ~city.contains(places)
    sunny = np.where(free, hours(city, places, 62.2, 80), 0)
    save_pgm(output, sunny / sunny.max())
    print(f"{sunny[free].mean():.1f} hours on average, {sunny.max():.1f} at most; wrote {output}")


if __name__ == "__main__":
    main(*(int(word) if word.isdigit() else word for word in sys.argv[1:]))
