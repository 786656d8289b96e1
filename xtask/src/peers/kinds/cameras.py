"""Cameras, their films and what they cut off."""

import mitsuba_xml as x
from mitsuba_xml import Point, ball, bsdf, constant, diffuse, floor, lamp, rectangle, sensor, transform, two_balls
from scene import stage


def room(camera):
    row = "".join(ball(diffuse(0.2 + 0.12 * i, 0.6 - 0.1 * i, 0.4), x=-1.2 + 0.6 * i, y=0.25, z=1.6 - 0.8 * i, radius=0.25) for i in range(5))
    return stage(constant(0.5, 0.55, 0.6), floor(), lamp(), row, sensor=camera)


def look(*steps):
    return transform(*steps, ("lookat", x.EYE, x.TARGET))


def crop(**more):
    return "".join(x.value(f"crop_{name}", number) for name, number in more.items())


def scenes():
    yield "fov across x", room(sensor(fov_axis="x", fov=50.0))
    yield "fov across y", room(sensor(fov_axis="y", fov=30.0))
    yield "fov across the diagonal", room(sensor(fov_axis="diagonal", fov=50.0))
    yield "fov across the smaller side", room(sensor(fov_axis="smaller", fov=30.0))
    yield "fov across the larger side", room(sensor(fov_axis="larger", fov=40.0))
    yield "focal length", room(sensor(fov=None, focal_length="35mm"))
    yield "principal point", room(sensor(principal_point_offset_x=0.1, principal_point_offset_y=-0.15))
    yield "clipped near", room(sensor(near_clip=3.2))
    yield "clipped far", room(sensor(far_clip=5.0))
    yield "clipped at both ends", room(sensor(near_clip=3.0, far_clip=5.2))
    yield "mirrored", room(sensor(to_world=look(("scale", (-1, 1, 1)))))
    yield "rolled", room(sensor(to_world=transform(("lookat", x.EYE, x.TARGET, (0.5, 1, 0)))))
    yield "thin lens", room(sensor(kind="thinlens", aperture_radius=0.15, focus_distance=4.0))
    yield "thin lens, near focus", room(sensor(kind="thinlens", aperture_radius=0.3, focus_distance=2.5))
    yield "orthographic", room(sensor(kind="orthographic", to_world=look(("scale", (1.6, 1.6, 1)))))
    yield "orthographic, unequal scale", room(sensor(kind="orthographic", to_world=look(("scale", (1.6, 1.0, 1))))), dict(
        warns=("a scale of an orthographic camera that differs",), differs="pixels of Dürer's camera are square")
    yield "orthographic, clipped", room(sensor(kind="orthographic", to_world=look(("scale", (1.6, 1.6, 1))), near_clip=3.5, far_clip=5.0))
    yield "crop", room(sensor(film_parts=crop(offset_x=10, offset_y=6, width=40, height=32)))
    yield "crop, thin lens", room(sensor(kind="thinlens", aperture_radius=0.15, focus_distance=4.0, film_parts=crop(offset_x=24, offset_y=16, width=40, height=32)))
