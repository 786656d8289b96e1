"""Cameras of Blender as cameras of Dürer."""

from dataclasses import dataclass
from math import asin, degrees

import numpy as np

from .units import ExportError, block, film_shift, fitted_side, point, view_angle


@dataclass
class View:
    """A camera as text of the scene language, with what is needed for depths along its axis."""

    text: str
    center: np.ndarray
    #: Unit vector of the view direction, in Blender's space; None if depths are distances.
    axis: np.ndarray | None


def _frame(matrix):
    matrix = np.array(matrix, float)
    return matrix[:3, 3], -matrix[:3, 2] / np.linalg.norm(matrix[:3, 2]), matrix[:3, 1] / np.linalg.norm(matrix[:3, 1])


def view(item, matrix, size, report):
    """Returns the view of a camera object for a picture of `size` pixels."""
    camera = item.data
    center, axis, up = _frame(matrix)
    base = [("center", point(center)), ("direction", point(axis)), ("up", point(up))]
    if camera.type == "PANO":
        return View(_panorama(camera, base, size, report), center, None)
    fit = camera.sensor_fit
    shift = [film_shift(value, *size, fit) for value in (camera.shift_x, camera.shift_y)]
    if camera.type == "ORTHO":
        larger = camera.ortho_scale * max(size) / fitted_side(*size, fit)
        right = np.cross(axis, up)
        moved = center + (right * shift[0] + up * shift[1]) * larger / 2
        if camera.dof.use_dof:
            report.add("an orthographic camera has no depth of field here: everything is sharp")
        fields = [("center", point(moved)), *base[1:], ("size", larger), ("near", camera.clip_start), ("far", camera.clip_end)]
        return View(block("OrthographicCamera", fields), center, axis)
    sensor = camera.sensor_height if fit == "VERTICAL" else camera.sensor_width
    fields = [*base, ("angle", view_angle(camera.lens, sensor, *size, fit)), ("shiftRight", shift[0]), ("shiftUp", shift[1])]
    fields += [("near", camera.clip_start), ("far", camera.clip_end)]
    dof = camera.dof
    if dof.use_dof:
        distance = dof.focus_distance
        if dof.focus_object is not None:
            distance = abs(float((np.array(dof.focus_object.matrix_world.translation) - center) @ axis))
        fields += [("aperture", camera.lens / 1000 / dof.aperture_fstop), ("focusDistance", max(distance, 1e-5))]
        if dof.aperture_blades > 2:
            fields += [("blades", dof.aperture_blades), ("bladeAngle", degrees(dof.aperture_rotation))]
        if abs(dof.aperture_ratio - 1) > 1e-3:
            report.add("the aperture ratio of the camera is not translated: the aperture is not stretched")
    return View(block("ThinLensCamera", fields), center, axis)


def _panorama(camera, base, size, report):
    own = camera if hasattr(camera, "panorama_type") else camera.cycles
    kind = own.panorama_type
    if kind == "EQUIRECTANGULAR":
        west, east, south, north = own.longitude_min, own.longitude_max, own.latitude_min, own.latitude_max
        if abs(west + east) > 1e-4 or abs(south + north) > 1e-4:
            raise ExportError("the range of a panoramic camera must be symmetrical about its axis")
        angles = [("angle", min(degrees(east - west), 360)), ("verticalAngle", min(degrees(north - south), 180))]
        return block("EquirectangularCamera", [*base, *angles])
    if size[0] != size[1]:
        report.add("a fisheye camera is rendered as a disc: its picture should be square")
    if kind == "FISHEYE_EQUIDISTANT":
        return block("FisheyeCamera", [*base, ("angle", min(degrees(own.fisheye_fov), 360)), ("projection", "equidistant")])
    if kind == "FISHEYE_EQUISOLID":
        sensor = camera.sensor_height if camera.sensor_fit == "VERTICAL" else camera.sensor_width
        share = sensor / (4 * own.fisheye_lens)
        if share > 1:
            raise ExportError("the lens of the fisheye camera is too short for its sensor")
        angle = degrees(4 * asin(share))
        if degrees(own.fisheye_fov) < angle - 0.1:
            report.add("the fisheye camera shows more than its field of view, up to the border of the sensor")
        return block("FisheyeCamera", [*base, ("angle", angle), ("projection", "equisolid")])
    raise ExportError(f"the panorama type {kind.replace('_', ' ').lower()} is not translated")


def region_view(region, space, region_3d):
    """Returns the view of a 3D viewport and its size in pixels."""
    size = (region.width, region.height)
    matrix = np.linalg.inv(np.array(region_3d.view_matrix, float))
    center, axis, up = _frame(matrix)
    base = [("center", point(center)), ("direction", point(axis)), ("up", point(up))]
    window = np.array(region_3d.window_matrix, float)
    if region_3d.is_perspective:
        # The window matrix has the reciprocal tangents of half the field of view, and the shift.
        half = 1 / min(window[0, 0], window[1, 1])
        shift = [window[0, 2] / window[0, 0] / half, window[1, 2] / window[1, 1] / half]
        angles = [("angle", degrees(2 * np.arctan(half))), ("shiftRight", shift[0]), ("shiftUp", shift[1])]
        return View(block("ThinLensCamera", [*base, *angles]), center, axis), size
    half = 1 / min(window[0, 0], window[1, 1])
    right = np.cross(axis, up)
    moved = center - right * window[0, 3] / window[0, 0] - up * window[1, 3] / window[1, 1]
    return View(block("OrthographicCamera", [("center", point(moved)), *base[1:], ("size", 2 * half)]), center, axis), size
