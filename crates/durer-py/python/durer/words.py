"""The words of the scene language as classes. Written by `cargo xtask manual` from what the code states; a test holds it to that."""

# fmt: off
from __future__ import annotations

from typing import Literal, Optional, Union

import numpy.typing as npt

from .things import Camera, Light, Material, Shape, Thing

__all__ = ["Background", "Box", "CaveCamera", "Checkerboard", "Cone", "CubeMapCamera", "Cylinder", "CylindricalCamera", "DirectionalLight", "Disc", "Ellipsoid", "EquirectangularCamera", "FisheyeCamera", "Fog", "HairMaterial", "HeightField", "Marble", "Mix", "MultipleCenterCamera", "Noise", "OmnimaxCamera", "OrthographicCamera", "ParabolicCamera", "PerspectiveCamera", "PhongMaterial", "PhotometricLight", "PinholeCamera", "Plane", "PointLight", "PrincipledMaterial", "ProjectiveCamera", "PushBroomCamera", "Quadric", "Rectangle", "Sphere", "SpotLight", "StereoCamera", "Texture", "ThinLensCamera", "Torus", "Triangle", "TriangleMesh", "TwoSided", "Wood"]


class Background(Thing):
    """Background seen by rays that hit nothing, and ambient light.

    color: three numbers; 0.5 0.5 0.5 where it is not given. Colour of rays that hit nothing; 0.5 by default, or black with `path` in a scene of Dürer's own dialect without a `Background`.

    ambient_light: three numbers; 0 0 0 where it is not given. Ambient light on every surface.

    cube_map: path. Folder with six images (left, right, up, down, front, back) that replace the colour.

    environment: path. Environment map that replaces the colour and lights the scene, preferably with high dynamic range (`.exr`, `.hdr`); its centre is at -z. Whitted ray tracing ignores its light.

    sun: three numbers, not 0 0 0. Direction to the sun, of any length, with y up. The sun and a clear sky light the scene, in cd/m^2; set `--exposure`, for example to -13.

    sun_altitude: number, from -90 to 90. Altitude of the sun, in degrees above the horizon; an alternative to `sun`.

    sun_azimuth: number. Azimuth of the sun, in degrees from north (-z) towards east (x): 180 is south.

    latitude: number, from -90 to 90. Latitude, in degrees north of the equator; together with date and time, an alternative to `sun`.

    longitude: number, from -360 to 360. Longitude, in degrees east of Greenwich.

    date: three numbers, whole, 1 to 9999. Year, month and day.

    time: three numbers. Hours, minutes and seconds of the local clock.

    time_zone: number, from -14 to 14. Offset of the local clock from UTC in hours, including daylight saving time; default 0.

    turbidity: number, more than 0. Turbidity of the air: 2 is clear, 3 average, 10 hazy; default 3.

    cie_sky: whole number, from 1 to 16. Number of a CIE standard sky, from 1 to 16 (1 overcast, 5 uniform, 12 clear, 16 traditional overcast), which lights the scene in cd/m^2, without direct sunlight. All except 1, 3, 5 and 16 need the position of the sun, set by `sun`.

    zenith_luminance: number, more than 0. Luminance of the CIE sky at the zenith, in cd/m^2; default 10000.

    ground_reflectance: number, from 0 to 1. Fraction of the light from sun and sky that the ground below the horizon reflects. The default is 0.2 with a CIE sky; with a clear sky, the ground has a fifth of the zenith's light by default.

    environment_rotation: number. Rotation of the environment about y, in degrees.

    environment_scale: three numbers. Factor on the environment.
    """

    def __init__(
        self,
        *,
        color: Optional[npt.ArrayLike] = None,
        ambient_light: Optional[npt.ArrayLike] = None,
        cube_map: Optional[str] = None,
        environment: Optional[str] = None,
        sun: Optional[npt.ArrayLike] = None,
        sun_altitude: Optional[float] = None,
        sun_azimuth: Optional[float] = None,
        latitude: Optional[float] = None,
        longitude: Optional[float] = None,
        date: Optional[npt.ArrayLike] = None,
        time: Optional[npt.ArrayLike] = None,
        time_zone: Optional[float] = None,
        turbidity: Optional[float] = None,
        cie_sky: Optional[Union[int, Material]] = None,
        zenith_luminance: Optional[float] = None,
        ground_reflectance: Optional[float] = None,
        environment_rotation: Optional[float] = None,
        environment_scale: Optional[npt.ArrayLike] = None,
    ) -> None:
        super().__init__("Background", [
            ("color", color),
            ("ambientLight", ambient_light),
            ("cubeMap", cube_map),
            ("environment", environment),
            ("sun", sun),
            ("sunAltitude", sun_altitude),
            ("sunAzimuth", sun_azimuth),
            ("latitude", latitude),
            ("longitude", longitude),
            ("date", date),
            ("time", time),
            ("timeZone", time_zone),
            ("turbidity", turbidity),
            ("cieSky", cie_sky),
            ("zenithLuminance", zenith_luminance),
            ("groundReflectance", ground_reflectance),
            ("environmentRotation", environment_rotation),
            ("environmentScale", environment_scale),
        ])


class Fog(Thing):
    """Fog, smoke or dust in the air, which scatters and absorbs light. It does not fill glass objects, and Whitted ray tracing ignores it.

    extinction: number, more than 0; 0.1 where it is not given. Extinction coefficient per world unit: the transmittance over a distance is e^(-extinction · distance).

    color: three numbers; 1 1 1 where it is not given. Scattering albedo: the fraction of light that is scattered instead of absorbed, from 0 to 1.

    anisotropy: number, more than -1, less than 1; 0 where it is not given. Mean cosine of the scattering angle: -1 is backward, 0 isotropic, 1 forward.

    min: three numbers. Corner of the box that the fog fills; without it, the fog is everywhere.

    max: three numbers. Opposite corner of the box.

    density: path. Density file (Mitsuba's `.vol`) that is fitted to the box and multiplies `extinction`; without `min` and `max`, the box in the file is used.
    """

    def __init__(
        self,
        *,
        extinction: Optional[float] = None,
        color: Optional[npt.ArrayLike] = None,
        anisotropy: Optional[float] = None,
        min: Optional[npt.ArrayLike] = None,
        max: Optional[npt.ArrayLike] = None,
        density: Optional[str] = None,
    ) -> None:
        super().__init__("Fog", [
            ("extinction", extinction),
            ("color", color),
            ("anisotropy", anisotropy),
            ("min", min),
            ("max", max),
            ("density", density),
        ])


class Texture(Thing):
    """A named texture: an image and its mapping onto surfaces. The texture fields of a `PrincipledMaterial` refer to it by name.

    name: path; must be given. Name of the texture.

    picture: path; must be given. Image file.

    wrap_u: `repeat`, `mirror`, `clamp`; repeat where it is not given. Wrap mode beyond the left and right borders: `repeat`, `mirror` or `clamp`.

    wrap_v: `repeat`, `mirror`, `clamp`; repeat where it is not given. Wrap mode beyond the upper and lower borders: `repeat`, `mirror` or `clamp`.

    texels: `linear`, `nearest`; linear where it is not given. Magnification filter: `linear` interpolates the four nearest texels, `nearest` uses one.

    minified: `texels`, `mipmaps`; texels where it is not given. Minification filter of the path tracer: `texels` samples the full-size image, `mipmaps` a smaller version of it.

    uv_set: whole number, at most 1; 0 where it is not given. Texture coordinate set of the mesh: 0 for the first, 1 for the second.

    uv_transform: `{ }` with rows of 3 numbers, 2 of them. Transform from surface to image coordinates, both with v downwards from the upper border, as two rows of a matrix.

    alpha_cutoff: number. Alpha threshold: opacity is 1 at or above it and 0 below. Without it, opacity equals alpha.

    normal_scale: number; 1 where it is not given. Factor on the slope of the normals in a normal map.

    channel: `r`, `g`, `b`, `a`, `angle`. Channel used for a scalar field: `r`, `g`, `b`, `a`, or the `angle` of the direction in red and green. The default is red, or for opacity the alpha channel if there is one.

    texel_range: `{ }` with rows of 2 numbers, 1 of them. Values that texels of 0 and 1 are mapped to in a scalar field.
    """

    def __init__(
        self,
        *,
        name: str,
        picture: str,
        wrap_u: Optional[Literal["repeat", "mirror", "clamp"]] = None,
        wrap_v: Optional[Literal["repeat", "mirror", "clamp"]] = None,
        texels: Optional[Literal["linear", "nearest"]] = None,
        minified: Optional[Literal["texels", "mipmaps"]] = None,
        uv_set: Optional[Union[int, Material]] = None,
        uv_transform: Optional[npt.ArrayLike] = None,
        alpha_cutoff: Optional[float] = None,
        normal_scale: Optional[float] = None,
        channel: Optional[Literal["r", "g", "b", "a", "angle"]] = None,
        texel_range: Optional[npt.ArrayLike] = None,
    ) -> None:
        super().__init__("Texture", [
            ("name", name),
            ("picture", picture),
            ("wrapU", wrap_u),
            ("wrapV", wrap_v),
            ("texels", texels),
            ("minified", minified),
            ("uvSet", uv_set),
            ("uvTransform", uv_transform),
            ("alphaCutoff", alpha_cutoff),
            ("normalScale", normal_scale),
            ("channel", channel),
            ("texelRange", texel_range),
        ])


class PerspectiveCamera(Camera):
    """A perspective camera.

    center: three numbers; must be given. Position of the eye.

    direction: three numbers, not 0 0 0; must be given. View direction, of any length.

    up: three numbers, not 0 0 0; must be given. Up direction of the picture; need not be perpendicular to the view direction.

    angle: number, more than 0, less than 180; must be given. Field of view across the picture's larger side, in degrees.
    """

    def __init__(
        self,
        *,
        center: npt.ArrayLike,
        direction: npt.ArrayLike,
        up: npt.ArrayLike,
        angle: float,
    ) -> None:
        super().__init__("PerspectiveCamera", [
            ("center", center),
            ("direction", direction),
            ("up", up),
            ("angle", angle),
        ])


class OrthographicCamera(Camera):
    """An orthographic camera.

    center: three numbers; must be given. Centre of the picture.

    direction: three numbers, not 0 0 0; must be given. View direction, of any length.

    up: three numbers, not 0 0 0; must be given. Up direction of the picture; need not be perpendicular to `direction`.

    size: number, more than 0; must be given. Length of the picture's larger side, in world units.

    near: number. Distance from `center` to the near plane, for plans and sections. Without it, objects behind `center` are visible.

    handedness: `right`, `left`; right where it is not given. Handedness of the coordinate system; `left` mirrors the picture horizontally.
    """

    def __init__(
        self,
        *,
        center: npt.ArrayLike,
        direction: npt.ArrayLike,
        up: npt.ArrayLike,
        size: float,
        near: Optional[float] = None,
        handedness: Optional[Literal["right", "left"]] = None,
    ) -> None:
        super().__init__("OrthographicCamera", [
            ("center", center),
            ("direction", direction),
            ("up", up),
            ("size", size),
            ("near", near),
            ("handedness", handedness),
        ])


class PinholeCamera(Camera):
    """A pinhole camera with a hole of finite size instead of a lens.

    center: three numbers; must be given. Centre of the hole.

    direction: three numbers, not 0 0 0; must be given. View direction, of any length.

    up: three numbers, not 0 0 0; must be given. Up direction of the picture; need not be perpendicular to `direction`.

    angle: number, more than 0, less than 180; must be given. Field of view across the picture's larger side, in degrees.

    hole: number, 0 or more; must be given. Diameter of the hole, in world units.

    film_distance: number, more than 0; 1 where it is not given. Distance from the hole to the film, in world units.
    """

    def __init__(
        self,
        *,
        center: npt.ArrayLike,
        direction: npt.ArrayLike,
        up: npt.ArrayLike,
        angle: float,
        hole: float,
        film_distance: Optional[float] = None,
    ) -> None:
        super().__init__("PinholeCamera", [
            ("center", center),
            ("direction", direction),
            ("up", up),
            ("angle", angle),
            ("hole", hole),
            ("filmDistance", film_distance),
        ])


class ThinLensCamera(Camera):
    """A camera with a lens, which has depth of field and a film that can be shifted.

    center: three numbers; must be given. Centre of the lens.

    direction: three numbers, not 0 0 0; must be given. View direction along the lens axis; of any length.

    up: three numbers, not 0 0 0; must be given. Up direction of the picture; need not be perpendicular to `direction`.

    angle: number, more than 0, less than 180; must be given. Field of view across the picture's larger side, in degrees, for an unshifted film.

    aperture: number, 0 or more; 0 where it is not given. Diameter of the aperture: the focal length divided by the f-number. 0 makes everything sharp.

    focus_distance: number, more than 0; 1 where it is not given. Distance of the focus plane along the axis, in world units.

    blades: whole number, at most 64; 0 where it is not given. Number of straight blades of the aperture; 0 makes it round.

    blade_angle: number; 0 where it is not given. Rotation of the aperture about the axis, in degrees.

    shift_right: number; 0 where it is not given. Shift of the view to the right, relative to half the larger side.

    shift_up: number; 0 where it is not given. Shift of the view upwards, relative to half the larger side.

    near: number, 0 or more; 0 where it is not given. Distance to the near clipping plane along the axis.

    far: number, more than 0. Distance to the far clipping plane along the axis; unlimited by default.

    handedness: `right`, `left`; right where it is not given. Handedness of the coordinate system; `left` mirrors the picture horizontally.
    """

    def __init__(
        self,
        *,
        center: npt.ArrayLike,
        direction: npt.ArrayLike,
        up: npt.ArrayLike,
        angle: float,
        aperture: Optional[float] = None,
        focus_distance: Optional[float] = None,
        blades: Optional[Union[int, Material]] = None,
        blade_angle: Optional[float] = None,
        shift_right: Optional[float] = None,
        shift_up: Optional[float] = None,
        near: Optional[float] = None,
        far: Optional[float] = None,
        handedness: Optional[Literal["right", "left"]] = None,
    ) -> None:
        super().__init__("ThinLensCamera", [
            ("center", center),
            ("direction", direction),
            ("up", up),
            ("angle", angle),
            ("aperture", aperture),
            ("focusDistance", focus_distance),
            ("blades", blades),
            ("bladeAngle", blade_angle),
            ("shiftRight", shift_right),
            ("shiftUp", shift_up),
            ("near", near),
            ("far", far),
            ("handedness", handedness),
        ])


class StereoCamera(Camera):
    """A stereo camera: perspective views for both eyes, or for one of them.

    center: three numbers; must be given. Midpoint between the eyes.

    direction: three numbers, not 0 0 0; must be given. View direction, of any length.

    up: three numbers, not 0 0 0; must be given. Up direction of the picture; need not be perpendicular to `direction`.

    angle: number, more than 0, less than 180; must be given. Field of view across the larger side of one eye's picture, in degrees.

    separation: number, 0 or more; must be given. Distance between the eyes, in world units.

    convergence: number, more than 0; 1 where it is not given. Distance at which an object appears at the same position for both eyes; ignored by the method `parallel`.

    method: `offAxis`, `toeIn`, `parallel`; offAxis where it is not given. Method by which the two views converge.

    eyes: `middle`, `left`, `right`, `sideBySide`, `topBottom`; sideBySide where it is not given. Eye to render, or layout of both eyes.

    aspect: number, more than 0; 1 where it is not given. Ratio of the width to the height of one eye's picture.
    """

    def __init__(
        self,
        *,
        center: npt.ArrayLike,
        direction: npt.ArrayLike,
        up: npt.ArrayLike,
        angle: float,
        separation: float,
        convergence: Optional[float] = None,
        method: Optional[Literal["offAxis", "toeIn", "parallel"]] = None,
        eyes: Optional[Literal["middle", "left", "right", "sideBySide", "topBottom"]] = None,
        aspect: Optional[float] = None,
    ) -> None:
        super().__init__("StereoCamera", [
            ("center", center),
            ("direction", direction),
            ("up", up),
            ("angle", angle),
            ("separation", separation),
            ("convergence", convergence),
            ("method", method),
            ("eyes", eyes),
            ("aspect", aspect),
        ])


class FisheyeCamera(Camera):
    """A camera that maps a cone of directions to a disc; the corners of the picture are empty.

    center: three numbers; must be given. Position of the eye.

    direction: three numbers, not 0 0 0; must be given. View direction, of any length.

    up: three numbers, not 0 0 0; must be given. Up direction of the picture; need not be perpendicular to `direction`.

    angle: number, more than 0, at most 360; 180 where it is not given. Field of view across the disc, in degrees: at most 180 for `orthographic`, less than 360 for `stereographic`.

    projection: `equidistant`, `equisolid`, `stereographic`, `orthographic`; equidistant where it is not given. Mapping from the angle off the axis to the radius in the picture.
    """

    def __init__(
        self,
        *,
        center: npt.ArrayLike,
        direction: npt.ArrayLike,
        up: npt.ArrayLike,
        angle: Optional[float] = None,
        projection: Optional[Literal["equidistant", "equisolid", "stereographic", "orthographic"]] = None,
    ) -> None:
        super().__init__("FisheyeCamera", [
            ("center", center),
            ("direction", direction),
            ("up", up),
            ("angle", angle),
            ("projection", projection),
        ])


class OmnimaxCamera(Camera):
    """A camera for pictures projected onto a tilted dome, with an off-centre projector and viewer; the corners are black.

    center: three numbers; must be given. Position of the viewer in the scene.

    direction: three numbers, not 0 0 0; must be given. Horizontal direction that the audience faces; of any length.

    up: three numbers, not 0 0 0; must be given. Up direction of the audience; need not be perpendicular to `direction`.

    tilt: number; 30 where it is not given. Forward tilt of the dome, in degrees: 0 puts its pole overhead, 90 puts it straight ahead.

    dome: number, more than 0, at most 360; 180 where it is not given. Angle of the sphere that the dome covers, in degrees: 180 is a hemisphere.

    angle: number, more than 0, at most 360; 180 where it is not given. Field of view of the projector, in degrees.

    projector: three numbers; 0 0 0 where it is not given. Offset of the projector from the dome's centre: right, up and forwards, in dome radii.

    viewer: three numbers; 0 0 0 where it is not given. Offset of the viewer from the dome's centre: right, up and forwards, in dome radii.
    """

    def __init__(
        self,
        *,
        center: npt.ArrayLike,
        direction: npt.ArrayLike,
        up: npt.ArrayLike,
        tilt: Optional[float] = None,
        dome: Optional[float] = None,
        angle: Optional[float] = None,
        projector: Optional[npt.ArrayLike] = None,
        viewer: Optional[npt.ArrayLike] = None,
    ) -> None:
        super().__init__("OmnimaxCamera", [
            ("center", center),
            ("direction", direction),
            ("up", up),
            ("tilt", tilt),
            ("dome", dome),
            ("angle", angle),
            ("projector", projector),
            ("viewer", viewer),
        ])


class ParabolicCamera(Camera):
    """A camera that looks into a parabolic mirror and sees all around; the corners of the picture are black.

    center: three numbers; must be given. Focus of the mirror: the single viewpoint.

    direction: three numbers, not 0 0 0; must be given. Axis of the mirror, from its focus to the lens, usually upwards; of any length.

    up: three numbers, not 0 0 0; must be given. Up direction of the picture; need not be perpendicular to `direction`.

    angle: number, more than 0, less than 360; 210 where it is not given. Field of view around the axis, in degrees: 180 reaches the horizon, and larger values reach below it.
    """

    def __init__(
        self,
        *,
        center: npt.ArrayLike,
        direction: npt.ArrayLike,
        up: npt.ArrayLike,
        angle: Optional[float] = None,
    ) -> None:
        super().__init__("ParabolicCamera", [
            ("center", center),
            ("direction", direction),
            ("up", up),
            ("angle", angle),
        ])


class EquirectangularCamera(Camera):
    """A camera that sees all directions and maps longitude and latitude to a rectangle, for one eye or a pair.

    center: three numbers; must be given. Position of the eye, or centre of the circle around which both eyes rotate.

    direction: three numbers, not 0 0 0; must be given. Direction to the centre of the picture; of any length.

    up: three numbers, not 0 0 0; must be given. Direction to the north pole; need not be perpendicular to `direction`.

    angle: number, more than 0, at most 360; 360 where it is not given. Field of view from left to right, in degrees.

    vertical_angle: number, more than 0, at most 180; 180 where it is not given. Field of view from bottom to top, in degrees.

    eyes: `middle`, `left`, `right`, `sideBySide`, `topBottom`; middle where it is not given. Eye to render, or layout of both eyes.

    separation: number, 0 or more; 0.065 where it is not given. Distance between the eyes, in world units.

    handedness: `right`, `left`; right where it is not given. Handedness of the coordinate system; `left` mirrors the picture horizontally.
    """

    def __init__(
        self,
        *,
        center: npt.ArrayLike,
        direction: npt.ArrayLike,
        up: npt.ArrayLike,
        angle: Optional[float] = None,
        vertical_angle: Optional[float] = None,
        eyes: Optional[Literal["middle", "left", "right", "sideBySide", "topBottom"]] = None,
        separation: Optional[float] = None,
        handedness: Optional[Literal["right", "left"]] = None,
    ) -> None:
        super().__init__("EquirectangularCamera", [
            ("center", center),
            ("direction", direction),
            ("up", up),
            ("angle", angle),
            ("verticalAngle", vertical_angle),
            ("eyes", eyes),
            ("separation", separation),
            ("handedness", handedness),
        ])


class CylindricalCamera(Camera):
    """A camera that renders a cylindrical panorama, for one eye or a pair.

    center: three numbers; must be given. Position of the eye, or centre of the circle around which both eyes rotate.

    direction: three numbers, not 0 0 0; must be given. Direction to the centre of the picture; of any length.

    up: three numbers, not 0 0 0; must be given. Axis of the cylinder; need not be perpendicular to `direction`.

    angle: number, more than 0, at most 360; 360 where it is not given. Field of view from left to right, in degrees.

    vertical_angle: number, more than 0, less than 180; 90 where it is not given. Field of view from bottom to top, in degrees.

    eyes: `middle`, `left`, `right`, `sideBySide`, `topBottom`; middle where it is not given. Eye to render, or layout of both eyes.

    separation: number, 0 or more; 0.065 where it is not given. Distance between the eyes, in world units.
    """

    def __init__(
        self,
        *,
        center: npt.ArrayLike,
        direction: npt.ArrayLike,
        up: npt.ArrayLike,
        angle: Optional[float] = None,
        vertical_angle: Optional[float] = None,
        eyes: Optional[Literal["middle", "left", "right", "sideBySide", "topBottom"]] = None,
        separation: Optional[float] = None,
    ) -> None:
        super().__init__("CylindricalCamera", [
            ("center", center),
            ("direction", direction),
            ("up", up),
            ("angle", angle),
            ("verticalAngle", vertical_angle),
            ("eyes", eyes),
            ("separation", separation),
        ])


class CubeMapCamera(Camera):
    """A camera that sees all directions, on the six faces of a cube.

    center: three numbers; must be given. Position of the eye.

    direction: three numbers, not 0 0 0; must be given. Direction to the centre of the front face; of any length.

    up: three numbers, not 0 0 0; must be given. Up direction of the front face; need not be perpendicular to `direction`.

    layout: `cross`, `strip`; cross where it is not given. Layout of the faces in the picture.
    """

    def __init__(
        self,
        *,
        center: npt.ArrayLike,
        direction: npt.ArrayLike,
        up: npt.ArrayLike,
        layout: Optional[Literal["cross", "strip"]] = None,
    ) -> None:
        super().__init__("CubeMapCamera", [
            ("center", center),
            ("direction", direction),
            ("up", up),
            ("layout", layout),
        ])


class CaveCamera(Camera):
    """A camera that renders several walls around a viewer into one picture, for one eye or a pair.

    center: three numbers; must be given. Position of the viewer's eye, or the midpoint of both eyes.

    direction: three numbers, not 0 0 0; 0 0 -1 where it is not given. Direction that the viewer faces, which determines left and right; of any length.

    up: three numbers, not 0 0 0; 0 1 0 where it is not given. Up direction of the viewer's head; need not be perpendicular to `direction`.

    walls: `{ }` with rows of 9 numbers, 1 to 64 of them; must be given. Three corners per wall, as seen from inside: lower left, lower right, upper left. Walls are ordered from left to right.

    eyes: `middle`, `left`, `right`, `sideBySide`, `topBottom`; middle where it is not given. Eye to render, or layout of both eyes.

    separation: number, 0 or more; 0.065 where it is not given. Distance between the eyes, in world units.
    """

    def __init__(
        self,
        *,
        center: npt.ArrayLike,
        direction: Optional[npt.ArrayLike] = None,
        up: Optional[npt.ArrayLike] = None,
        walls: npt.ArrayLike,
        eyes: Optional[Literal["middle", "left", "right", "sideBySide", "topBottom"]] = None,
        separation: Optional[float] = None,
    ) -> None:
        super().__init__("CaveCamera", [
            ("center", center),
            ("direction", direction),
            ("up", up),
            ("walls", walls),
            ("eyes", eyes),
            ("separation", separation),
        ])


class PushBroomCamera(Camera):
    """A camera that moves along a line and renders each column of the picture from the next point.

    start: three numbers; must be given. Eye position for the first column, at the left of the picture.

    end: three numbers; must be given. Eye position for the last column, at the right of the picture.

    direction: three numbers, not 0 0 0; must be given. View direction of all columns; of any length.

    up: three numbers, not 0 0 0; must be given. Up direction of the picture; need not be perpendicular to `direction`.

    angle: number, more than 0, less than 180; must be given. Field of view from bottom to top, in degrees.

    aspect: number, more than 0; 2 where it is not given. Ratio of the picture's width to its height.
    """

    def __init__(
        self,
        *,
        start: npt.ArrayLike,
        end: npt.ArrayLike,
        direction: npt.ArrayLike,
        up: npt.ArrayLike,
        angle: float,
        aspect: Optional[float] = None,
    ) -> None:
        super().__init__("PushBroomCamera", [
            ("start", start),
            ("end", end),
            ("direction", direction),
            ("up", up),
            ("angle", angle),
            ("aspect", aspect),
        ])


class MultipleCenterCamera(Camera):
    """A camera that moves along a path and renders each column of the picture from the next point.

    path: `{ }` with rows of 6 numbers, 2 to 1024 of them; must be given. One row per point of the path, from the left of the picture to the right: the eye and its target. If the last row equals the first, the path is a smooth loop.

    up: three numbers, not 0 0 0; must be given. Up direction of every column; need not be perpendicular to the view direction.

    angle: number, more than 0, less than 180; must be given. Field of view from bottom to top, in degrees.

    aspect: number, more than 0; 2 where it is not given. Ratio of the picture's width to its height.
    """

    def __init__(
        self,
        *,
        path: npt.ArrayLike,
        up: npt.ArrayLike,
        angle: float,
        aspect: Optional[float] = None,
    ) -> None:
        super().__init__("MultipleCenterCamera", [
            ("path", path),
            ("up", up),
            ("angle", angle),
            ("aspect", aspect),
        ])


class ProjectiveCamera(Camera):
    """A camera recovered from a photograph: a projection matrix and lens distortion.

    matrix: `{ }` with rows of 4 numbers, 3 of them; must be given. 3x4 projection matrix, row by row, from homogeneous world-space points to pixels, with y downwards; its scale is arbitrary.

    width: number, more than 0; must be given. Width of the photograph in pixels.

    height: number, more than 0; must be given. Height of the photograph in pixels.

    k1: number; 0 where it is not given. Radial distortion coefficient of r².

    k2: number; 0 where it is not given. Radial distortion coefficient of r⁴.

    p1: number; 0 where it is not given. Tangential distortion, vertical.

    p2: number; 0 where it is not given. Tangential distortion, horizontal.

    k3: number; 0 where it is not given. Radial distortion coefficient of r⁶.
    """

    def __init__(
        self,
        *,
        matrix: npt.ArrayLike,
        width: float,
        height: float,
        k1: Optional[float] = None,
        k2: Optional[float] = None,
        p1: Optional[float] = None,
        p2: Optional[float] = None,
        k3: Optional[float] = None,
    ) -> None:
        super().__init__("ProjectiveCamera", [
            ("matrix", matrix),
            ("width", width),
            ("height", height),
            ("k1", k1),
            ("k2", k2),
            ("p1", p1),
            ("p2", p2),
            ("k3", k3),
        ])


class DirectionalLight(Light):
    """Light that arrives from the same direction everywhere, like sunlight.

    direction: three numbers, not 0 0 0; must be given. Direction in which the light travels, of any length.

    color: three numbers; must be given. Colour and strength.

    spread: number, 0 or more. Angular radius in degrees, for soft shadows and a visible disc in path tracing; 0.27 for the sun.

    lux: number, 0 or more. Illuminance in lux on a surface that faces the light; `color` then sets only the hue.

    spectrum: path. Measured spectrum, multiplied by `color`: a file (`lamp.csv`, `lamps.csv:column`) or an illuminant (A, D65, F2, 2700K). `--color spectral` uses the spectrum; otherwise its RGB colour is used.
    """

    def __init__(
        self,
        *,
        direction: npt.ArrayLike,
        color: npt.ArrayLike,
        spread: Optional[float] = None,
        lux: Optional[float] = None,
        spectrum: Optional[str] = None,
    ) -> None:
        super().__init__("DirectionalLight", [
            ("direction", direction),
            ("color", color),
            ("spread", spread),
            ("lux", lux),
            ("spectrum", spectrum),
        ])


class PointLight(Light):
    """Light that is emitted from one point in all directions.

    position: three numbers; must be given. Position.

    color: three numbers; must be given. Colour and strength.

    attenuation: three numbers. Coefficients of the distance polynomial that the light is divided by: constant, linear and quadratic.

    falloff: number, 0 or more. Quadratic coefficient of the distance polynomial; the other coefficients depend on the dialect.

    candela: number, 0 or more. Luminous intensity in candela, with falloff by the squared distance; `color` then sets only the hue.

    lumens: number, 0 or more. Luminous flux in lumens, with falloff by the squared distance; `color` then sets only the hue.

    spectrum: path. Measured spectrum, multiplied by `color`: a file (`lamp.csv`, `lamps.csv:column`) or an illuminant (A, D65, F2, 2700K). `--color spectral` uses the spectrum; otherwise its RGB colour is used.
    """

    def __init__(
        self,
        *,
        position: npt.ArrayLike,
        color: npt.ArrayLike,
        attenuation: Optional[npt.ArrayLike] = None,
        falloff: Optional[float] = None,
        candela: Optional[float] = None,
        lumens: Optional[float] = None,
        spectrum: Optional[str] = None,
    ) -> None:
        super().__init__("PointLight", [
            ("position", position),
            ("color", color),
            ("attenuation", attenuation),
            ("falloff", falloff),
            ("candela", candela),
            ("lumens", lumens),
            ("spectrum", spectrum),
        ])


class SpotLight(Light):
    """Light emitted from one point into a cone, with falloff by the squared distance.

    position: three numbers; must be given. Position.

    direction: three numbers, not 0 0 0; must be given. Direction of the cone's axis, of any length.

    color: three numbers; must be given. Colour and strength, as received on the axis at distance 1.

    angle: number, more than 0, at most 180; 45 where it is not given. Angle in degrees from the axis to the edge of the cone.

    inner_angle: number, 0 or more; 0 where it is not given. Angle in degrees from the axis at which the fade begins; at most `angle`.

    fade: `squared`, `smooth`, `fourth`; squared where it is not given. Fade between the two angles, as a function of the fraction s between their cosines: `squared` is s^2, `smooth` is s^2 (3 - 2 s), `fourth` is s^4.

    candela: number, 0 or more. Luminous intensity in candela on the axis; `color` then sets only the hue.

    lumens: number, 0 or more. Luminous flux in lumens; `color` then sets only the hue.

    spectrum: path. Measured spectrum, multiplied by `color`: a file (`lamp.csv`, `lamps.csv:column`) or an illuminant (A, D65, F2, 2700K). `--color spectral` uses the spectrum; otherwise its RGB colour is used.
    """

    def __init__(
        self,
        *,
        position: npt.ArrayLike,
        direction: npt.ArrayLike,
        color: npt.ArrayLike,
        angle: Optional[float] = None,
        inner_angle: Optional[float] = None,
        fade: Optional[Literal["squared", "smooth", "fourth"]] = None,
        candela: Optional[float] = None,
        lumens: Optional[float] = None,
        spectrum: Optional[str] = None,
    ) -> None:
        super().__init__("SpotLight", [
            ("position", position),
            ("direction", direction),
            ("color", color),
            ("angle", angle),
            ("innerAngle", inner_angle),
            ("fade", fade),
            ("candela", candela),
            ("lumens", lumens),
            ("spectrum", spectrum),
        ])


class PhotometricLight(Light):
    """Point light with a measured intensity distribution in candela, from an IES or EULUMDAT file.

    position: three numbers; must be given. Position.

    file: path; must be given. Measurement: an IES file (LM-63-1986 to 2019) or an EULUMDAT file (`.ldt`).

    direction: three numbers, not 0 0 0; 0 -1 0 where it is not given. Direction that the lower side of the light faces, of any length.

    front: three numbers, not 0 0 0; 1 0 0 where it is not given. Direction of horizontal angle 0; made perpendicular to `direction`.

    focal_length: number, 0 or more; 0 where it is not given. Distance behind the position at which the light appears to originate, for example with a reflector: light at distance d fades as if at d + `focalLength`.

    color: three numbers; 1 1 1 where it is not given. Factor on the measured light, per colour channel.

    lumens: number, 0 or more. Luminous flux in lumens, instead of the value in the file; `color` then sets only the hue.

    spectrum: path. Measured spectrum, multiplied by `color`: a file (`lamp.csv`, `lamps.csv:column`) or an illuminant (A, D65, F2, 2700K). `--color spectral` uses the spectrum; otherwise its RGB colour is used.
    """

    def __init__(
        self,
        *,
        position: npt.ArrayLike,
        file: str,
        direction: Optional[npt.ArrayLike] = None,
        front: Optional[npt.ArrayLike] = None,
        focal_length: Optional[float] = None,
        color: Optional[npt.ArrayLike] = None,
        lumens: Optional[float] = None,
        spectrum: Optional[str] = None,
    ) -> None:
        super().__init__("PhotometricLight", [
            ("position", position),
            ("file", file),
            ("direction", direction),
            ("front", front),
            ("focalLength", focal_length),
            ("color", color),
            ("lumens", lumens),
            ("spectrum", spectrum),
        ])


class PhongMaterial(Material):
    """Material with a diffuse colour and a highlight, which can also reflect and transmit light.

    diffuse_color: three numbers. Diffuse albedo; 1 1 1 by default.

    specular_color: three numbers; 0 0 0 where it is not given. Strength of the highlight, and in some dialects also of the reflection.

    exponent: number, 0 or more. Exponent of the Blinn highlight.

    shininess: number, 0 or more. Exponent of the Phong highlight.

    reflective_color: three numbers; 0 0 0 where it is not given. Weight of the reflected ray.

    transparent_color: three numbers; 0 0 0 where it is not given. Weight of the transmitted ray.

    index_of_refraction: number, more than 0. Index of refraction of transmitted rays weighted by `transparentColor` alone.

    refraction_index: number, 0 or more. Index of refraction of glass that reflects and transmits light by the Fresnel equations; 0 for no glass.

    texture: path. Texture that replaces the diffuse colour on meshes with texture coordinates.

    bump: path. Bump map; ignored, as it is by the official programs of every year.
    """

    def __init__(
        self,
        *,
        diffuse_color: Optional[npt.ArrayLike] = None,
        specular_color: Optional[npt.ArrayLike] = None,
        exponent: Optional[float] = None,
        shininess: Optional[float] = None,
        reflective_color: Optional[npt.ArrayLike] = None,
        transparent_color: Optional[npt.ArrayLike] = None,
        index_of_refraction: Optional[float] = None,
        refraction_index: Optional[float] = None,
        texture: Optional[str] = None,
        bump: Optional[str] = None,
    ) -> None:
        super().__init__("PhongMaterial", [
            ("diffuseColor", diffuse_color),
            ("specularColor", specular_color),
            ("exponent", exponent),
            ("shininess", shininess),
            ("reflectiveColor", reflective_color),
            ("transparentColor", transparent_color),
            ("indexOfRefraction", index_of_refraction),
            ("refractionIndex", refraction_index),
            ("texture", texture),
            ("bump", bump),
        ])


class PrincipledMaterial(Material):
    """Layered material with the parameters of OpenPBR Surface: fuzz over a coat over metal, glass or a diffuse base.

    base_weight: number, from 0 to 1; 1 where it is not given. Strength of the base, from 0 to 1; scales the colours of the diffuse base and the metal.

    base_weight_texture: path. Texture that multiplies `baseWeight`. Textures of scalars use the red channel, or the channel after a colon, for example `file.png:g`.

    base_color: three numbers; 0.8 0.8 0.8 where it is not given. Albedo of the diffuse base, or reflectance of the metal at normal incidence, from 0 to 1.

    base_spectrum: path. File with a measured reflectance that replaces `baseColor`: rows of a wavelength in nanometres and a reflectance from 0 to 1. `file.csv:name` selects one of several columns. `--color spectral` uses the spectrum; otherwise its RGB colour in daylight is used.

    base_color_texture: path. Texture that multiplies `baseColor`, read as sRGB; its alpha multiplies `opacity`.

    base_diffuse_roughness: number, from 0 to 1; 0 where it is not given. Roughness of the diffuse base, from 0 (Lambert) to 1.

    base_diffuse_roughness_texture: path. Texture that multiplies `baseDiffuseRoughness`.

    base_metalness: number, from 0 to 1; 0 where it is not given. Metalness, from 0 (glass or diffuse) to 1 (metal).

    base_metalness_texture: path. Texture that multiplies `baseMetalness`.

    specular_weight: number, 0 or more; 1 where it is not given. Factor on the reflectance at normal incidence, usually from 0 to 1.

    specular_weight_texture: path. Texture that multiplies the reflection equally at all angles.

    specular_color: three numbers; 1 1 1 where it is not given. Tint of the reflection, or for metal the colour near grazing angles.

    specular_color_texture: path. Texture that multiplies `specularColor`, read as sRGB.

    specular_roughness: number, from 0 to 1; 0.3 where it is not given. Roughness of the surface, from 0 (a mirror) to 1; its square is GGX's alpha.

    specular_roughness_texture: path. Texture that multiplies `specularRoughness`.

    metallic_roughness_texture: path. Texture whose green channel multiplies `specularRoughness` and whose blue channel multiplies `baseMetalness`.

    specular_anisotropy: number, from 0 to 1; 0 where it is not given. Elongation of the highlight, from 0 (round) to 1.

    specular_anisotropy_texture: path. Texture that multiplies `specularAnisotropy`.

    specular_rotation: number; 0 where it is not given. Rotation of the highlight about the normal, from the direction of increasing u; 1 is a full turn.

    specular_rotation_texture: path. Texture added to `specularRotation`; 1 is a full turn. `file.png:angle` reads a direction from the red and green channels.

    specular_ior: number, more than 0; 1.5 where it is not given. Index of refraction of the inside of the object.

    surroundings: `nested`, `ignored`; nested where it is not given. `nested`: refraction at glass inside other glass or water uses both indices. `ignored`: `specularIor` is the ratio of the index inside to the index outside, regardless of the surrounding medium, as in pbrt and Mitsuba.

    energy_compensation: `on`, `off`; on where it is not given. `on`: adds the light that is scattered several times between the facets of rough metal, glass or coats, so that no energy is lost. `off`: single scattering only, as in pbrt and Mitsuba, which makes rough surfaces darker.

    transmission_weight: number, from 0 to 1; 0 where it is not given. Blend between a diffuse base at 0 and glass at 1.

    transmission_weight_texture: path. Texture that multiplies `transmissionWeight`.

    transmission_color: three numbers; 1 1 1 where it is not given. Colour of white light after travelling `transmissionDepth` through the material, or after passing the surface if that is 0. Thin walls are treated as `transmissionDepth` thick, so they absorb more at grazing angles.

    transmission_color_texture: path. Texture that multiplies `transmissionColor` if `transmissionDepth` is 0, read as sRGB.

    transmission_depth: number, 0 or more; 0 where it is not given. Distance in world units after which white light has `transmissionColor`. At 0, the surface tints the light instead; with thin walls, any other value makes the wall absorb light, including internal reflections.

    transmission_scatter: three numbers; 0 0 0 where it is not given. Colour of the light scattered inside the material over the distance `transmissionDepth`; 0 0 0 for a clear material.

    transmission_scatter_anisotropy: number, more than -1, less than 1; 0 where it is not given. Mean cosine of the scattering angle inside the material: -1 is backward, 0 isotropic, 1 forward.

    transmission_density: path. Density file (Mitsuba's `.vol`) that multiplies the extinction inside the material; its box is in world space.

    transmission_density_box: `{ }` with rows of 3 numbers, 0 to 4 of them. Box in world space for `transmissionDensity` that replaces the box in the file: a corner, and the edges from it along the grid's x, y and z axes.

    transmission_dispersion_scale: number, from 0 to 1; 0 where it is not given. Strength of the dispersion set by `transmissionDispersionAbbeNumber`, from 0 (none) to 1; only visible with `--color spectral`.

    transmission_dispersion_abbe_number: number, more than 0; 20 where it is not given. Abbe number of the glass, lower for stronger dispersion: 64 for crown glass, 30 for flint.

    subsurface_weight: number, from 0 to 1; 0 where it is not given. Blend between a diffuse base at 0 and subsurface scattering at 1, where light enters the object, scatters and leaves elsewhere, as in marble, milk and skin.

    subsurface_weight_texture: path. Texture that multiplies `subsurfaceWeight`.

    subsurface_color: three numbers; 0.8 0.8 0.8 where it is not given. Perceived colour of an object with subsurface scattering.

    subsurface_color_texture: path. Texture that multiplies `subsurfaceColor` where light enters, read as sRGB.

    subsurface_radius: number, more than 0; 1 where it is not given. Mean free path inside the object, in world units.

    subsurface_radius_scale: three numbers; 1 0.5 0.25 where it is not given. Factors on `subsurfaceRadius` for red, green and blue.

    subsurface_scatter_anisotropy: number, more than -1, less than 1; 0 where it is not given. Mean cosine of the subsurface scattering angle: -1 is backward, 0 isotropic, 1 forward.

    coat_weight: number, from 0 to 1; 0 where it is not given. Strength of the clear coat, from 0 to 1.

    coat_weight_texture: path. Texture that multiplies `coatWeight`.

    coat_color: three numbers; 1 1 1 where it is not given. Transmittance of the coat for light that passes down and up again at normal incidence.

    coat_color_texture: path. Texture that multiplies `coatColor`, read as sRGB.

    coat_roughness: number, from 0 to 1; 0 where it is not given. Roughness of the coat, from 0 to 1.

    coat_roughness_texture: path. Texture that multiplies `coatRoughness`.

    coat_ior: number, more than 0; 1.6 where it is not given. Index of refraction of the coat.

    coat_darkening: number, from 0 to 1; 1 where it is not given. Darkening of the base by internal reflection in the coat, from 0 (none) to 1 (physically correct).

    coat_darkening_texture: path. Texture that multiplies `coatDarkening`.

    fuzz_weight: number, from 0 to 1; 0 where it is not given. Strength of the fuzz layer on top, for example velvet or dust, from 0 to 1.

    fuzz_weight_texture: path. Texture that multiplies `fuzzWeight`.

    fuzz_color: three numbers; 1 1 1 where it is not given. Colour of the fuzz.

    fuzz_color_texture: path. Texture that multiplies `fuzzColor`, read as sRGB.

    fuzz_roughness: number, from 0 to 1; 0.5 where it is not given. Roughness of the fuzz, from 0 to 1.

    fuzz_roughness_texture: path. Texture that multiplies `fuzzRoughness`.

    thin_film_weight: number, from 0 to 1; 0 where it is not given. Fraction of the surface below the coat that is covered by a thin film, from 0 to 1, for example soap, oil, tempered steel or mother-of-pearl.

    thin_film_weight_texture: path. Texture that multiplies `thinFilmWeight`.

    thin_film_thickness: number, 0 or more; 0.5 where it is not given. Thickness of the film in micrometres.

    thin_film_thickness_texture: path. Texture that multiplies `thinFilmThickness`.

    thin_film_ior: number, more than 0; 1.4 where it is not given. Index of refraction of the film.

    emission_luminance: number, 0 or more; 0 where it is not given. Luminance of the emission in cd/m^2; a pixel value of 1 stands for 1 cd/m^2.

    emission_color: three numbers; 1 1 1 where it is not given. Colour of the emission, which multiplies `emissionLuminance`.

    emission_spectrum: path. Spectrum of the emission, multiplied by `emissionColor`: an illuminant (A, D50, D55, D65, D75, E, F2, F7, F11), a black body (`2700K`), or a file as for `baseSpectrum`, in any unit. `emissionLuminance` still sets the brightness.

    emission_texture: path. Texture that multiplies `emissionColor`, read as sRGB.

    emission_vertex_colors: `on`, `off`; off where it is not given. `on`: the vertex colours of a mesh multiply `emissionColor`.

    normal_texture: path. Tangent-space normal map, as in glTF: red and green point along u and v, and blue points outwards.

    bump_texture: path. Bump map: a height texture that tilts the normals as if bright areas were raised.

    bump_height: number; 0.01 where it is not given. Height difference between white and black in the bump map, in world units; negative if white is deeper.

    normal_bending: `on`, `off`; on where it is not given. `on`: bends mapped normals that face away from the viewer, so that mirrored rays leave the surface. `off`: leaves such points black, as in Mitsuba.

    opacity: number, from 0 to 1; 1 where it is not given. Fraction of the surface that is present, from 0 to 1; the remaining light passes through unchanged.

    opacity_texture: path. Texture that multiplies `opacity` by its alpha channel if there is one, otherwise by its red channel.

    opacity_cutoff: number, 0 or more. Threshold for the combined opacity (`opacity`, textures and vertex alpha): the surface is fully present at or above it and absent below. Without it, partial opacity is kept.

    walls: `solid`, `thin`; solid where it is not given. `thin`: a sheet without an inside, which light crosses in a straight line. `solid`: the surface of a solid object.

    backs: `shown`, `hidden`, `black`; shown where it is not given. `shown`: both sides are visible. `hidden`: faces that are turned away from the camera, or from a light without extent, are transparent to it. `black`: faces turned away scatter no light.
    """

    def __init__(
        self,
        *,
        base_weight: Optional[float] = None,
        base_weight_texture: Optional[str] = None,
        base_color: Optional[npt.ArrayLike] = None,
        base_spectrum: Optional[str] = None,
        base_color_texture: Optional[str] = None,
        base_diffuse_roughness: Optional[float] = None,
        base_diffuse_roughness_texture: Optional[str] = None,
        base_metalness: Optional[float] = None,
        base_metalness_texture: Optional[str] = None,
        specular_weight: Optional[float] = None,
        specular_weight_texture: Optional[str] = None,
        specular_color: Optional[npt.ArrayLike] = None,
        specular_color_texture: Optional[str] = None,
        specular_roughness: Optional[float] = None,
        specular_roughness_texture: Optional[str] = None,
        metallic_roughness_texture: Optional[str] = None,
        specular_anisotropy: Optional[float] = None,
        specular_anisotropy_texture: Optional[str] = None,
        specular_rotation: Optional[float] = None,
        specular_rotation_texture: Optional[str] = None,
        specular_ior: Optional[float] = None,
        surroundings: Optional[Literal["nested", "ignored"]] = None,
        energy_compensation: Optional[Literal["on", "off"]] = None,
        transmission_weight: Optional[float] = None,
        transmission_weight_texture: Optional[str] = None,
        transmission_color: Optional[npt.ArrayLike] = None,
        transmission_color_texture: Optional[str] = None,
        transmission_depth: Optional[float] = None,
        transmission_scatter: Optional[npt.ArrayLike] = None,
        transmission_scatter_anisotropy: Optional[float] = None,
        transmission_density: Optional[str] = None,
        transmission_density_box: Optional[npt.ArrayLike] = None,
        transmission_dispersion_scale: Optional[float] = None,
        transmission_dispersion_abbe_number: Optional[float] = None,
        subsurface_weight: Optional[float] = None,
        subsurface_weight_texture: Optional[str] = None,
        subsurface_color: Optional[npt.ArrayLike] = None,
        subsurface_color_texture: Optional[str] = None,
        subsurface_radius: Optional[float] = None,
        subsurface_radius_scale: Optional[npt.ArrayLike] = None,
        subsurface_scatter_anisotropy: Optional[float] = None,
        coat_weight: Optional[float] = None,
        coat_weight_texture: Optional[str] = None,
        coat_color: Optional[npt.ArrayLike] = None,
        coat_color_texture: Optional[str] = None,
        coat_roughness: Optional[float] = None,
        coat_roughness_texture: Optional[str] = None,
        coat_ior: Optional[float] = None,
        coat_darkening: Optional[float] = None,
        coat_darkening_texture: Optional[str] = None,
        fuzz_weight: Optional[float] = None,
        fuzz_weight_texture: Optional[str] = None,
        fuzz_color: Optional[npt.ArrayLike] = None,
        fuzz_color_texture: Optional[str] = None,
        fuzz_roughness: Optional[float] = None,
        fuzz_roughness_texture: Optional[str] = None,
        thin_film_weight: Optional[float] = None,
        thin_film_weight_texture: Optional[str] = None,
        thin_film_thickness: Optional[float] = None,
        thin_film_thickness_texture: Optional[str] = None,
        thin_film_ior: Optional[float] = None,
        emission_luminance: Optional[float] = None,
        emission_color: Optional[npt.ArrayLike] = None,
        emission_spectrum: Optional[str] = None,
        emission_texture: Optional[str] = None,
        emission_vertex_colors: Optional[Literal["on", "off"]] = None,
        normal_texture: Optional[str] = None,
        bump_texture: Optional[str] = None,
        bump_height: Optional[float] = None,
        normal_bending: Optional[Literal["on", "off"]] = None,
        opacity: Optional[float] = None,
        opacity_texture: Optional[str] = None,
        opacity_cutoff: Optional[float] = None,
        walls: Optional[Literal["solid", "thin"]] = None,
        backs: Optional[Literal["shown", "hidden", "black"]] = None,
    ) -> None:
        super().__init__("PrincipledMaterial", [
            ("baseWeight", base_weight),
            ("baseWeightTexture", base_weight_texture),
            ("baseColor", base_color),
            ("baseSpectrum", base_spectrum),
            ("baseColorTexture", base_color_texture),
            ("baseDiffuseRoughness", base_diffuse_roughness),
            ("baseDiffuseRoughnessTexture", base_diffuse_roughness_texture),
            ("baseMetalness", base_metalness),
            ("baseMetalnessTexture", base_metalness_texture),
            ("specularWeight", specular_weight),
            ("specularWeightTexture", specular_weight_texture),
            ("specularColor", specular_color),
            ("specularColorTexture", specular_color_texture),
            ("specularRoughness", specular_roughness),
            ("specularRoughnessTexture", specular_roughness_texture),
            ("metallicRoughnessTexture", metallic_roughness_texture),
            ("specularAnisotropy", specular_anisotropy),
            ("specularAnisotropyTexture", specular_anisotropy_texture),
            ("specularRotation", specular_rotation),
            ("specularRotationTexture", specular_rotation_texture),
            ("specularIor", specular_ior),
            ("surroundings", surroundings),
            ("energyCompensation", energy_compensation),
            ("transmissionWeight", transmission_weight),
            ("transmissionWeightTexture", transmission_weight_texture),
            ("transmissionColor", transmission_color),
            ("transmissionColorTexture", transmission_color_texture),
            ("transmissionDepth", transmission_depth),
            ("transmissionScatter", transmission_scatter),
            ("transmissionScatterAnisotropy", transmission_scatter_anisotropy),
            ("transmissionDensity", transmission_density),
            ("transmissionDensityBox", transmission_density_box),
            ("transmissionDispersionScale", transmission_dispersion_scale),
            ("transmissionDispersionAbbeNumber", transmission_dispersion_abbe_number),
            ("subsurfaceWeight", subsurface_weight),
            ("subsurfaceWeightTexture", subsurface_weight_texture),
            ("subsurfaceColor", subsurface_color),
            ("subsurfaceColorTexture", subsurface_color_texture),
            ("subsurfaceRadius", subsurface_radius),
            ("subsurfaceRadiusScale", subsurface_radius_scale),
            ("subsurfaceScatterAnisotropy", subsurface_scatter_anisotropy),
            ("coatWeight", coat_weight),
            ("coatWeightTexture", coat_weight_texture),
            ("coatColor", coat_color),
            ("coatColorTexture", coat_color_texture),
            ("coatRoughness", coat_roughness),
            ("coatRoughnessTexture", coat_roughness_texture),
            ("coatIor", coat_ior),
            ("coatDarkening", coat_darkening),
            ("coatDarkeningTexture", coat_darkening_texture),
            ("fuzzWeight", fuzz_weight),
            ("fuzzWeightTexture", fuzz_weight_texture),
            ("fuzzColor", fuzz_color),
            ("fuzzColorTexture", fuzz_color_texture),
            ("fuzzRoughness", fuzz_roughness),
            ("fuzzRoughnessTexture", fuzz_roughness_texture),
            ("thinFilmWeight", thin_film_weight),
            ("thinFilmWeightTexture", thin_film_weight_texture),
            ("thinFilmThickness", thin_film_thickness),
            ("thinFilmThicknessTexture", thin_film_thickness_texture),
            ("thinFilmIor", thin_film_ior),
            ("emissionLuminance", emission_luminance),
            ("emissionColor", emission_color),
            ("emissionSpectrum", emission_spectrum),
            ("emissionTexture", emission_texture),
            ("emissionVertexColors", emission_vertex_colors),
            ("normalTexture", normal_texture),
            ("bumpTexture", bump_texture),
            ("bumpHeight", bump_height),
            ("normalBending", normal_bending),
            ("opacity", opacity),
            ("opacityTexture", opacity_texture),
            ("opacityCutoff", opacity_cutoff),
            ("walls", walls),
            ("backs", backs),
        ])


class HairMaterial(Material):
    """Hair or fur for path tracing, on thin tubes along which the texture coordinate u increases, such as converted curves; their inside is not visible. `absorption` takes precedence over `color`, and `color` over the melanins.

    eumelanin: number, 0 or more; 1.3 where it is not given. Amount of brown and black pigment: 0.3 in blond hair, 1.3 in brown, 8 in black.

    pheomelanin: number, 0 or more; 0 where it is not given. Amount of yellow and red pigment: 1.2 or more in red hair.

    color: three numbers. Colour of a bundle of many fibres, from 0 to 1.

    absorption: three numbers. Absorption coefficient inside a fibre, per fibre radius, for red, green and blue.

    longitudinal_roughness: number, from 0 to 1; 0.3 where it is not given. Roughness along a fibre, from 0 to 1.

    azimuthal_roughness: number, from 0 to 1; 0.3 where it is not given. Roughness around a fibre, from 0 to 1.

    scale_tilt: number, from -45 to 45; 2 where it is not given. Tilt in degrees of the cuticle scales of a fibre towards its tip.

    ior: number, from 1 to 4; 1.55 where it is not given. Index of refraction.
    """

    def __init__(
        self,
        *,
        eumelanin: Optional[float] = None,
        pheomelanin: Optional[float] = None,
        color: Optional[npt.ArrayLike] = None,
        absorption: Optional[npt.ArrayLike] = None,
        longitudinal_roughness: Optional[float] = None,
        azimuthal_roughness: Optional[float] = None,
        scale_tilt: Optional[float] = None,
        ior: Optional[float] = None,
    ) -> None:
        super().__init__("HairMaterial", [
            ("eumelanin", eumelanin),
            ("pheomelanin", pheomelanin),
            ("color", color),
            ("absorption", absorption),
            ("longitudinalRoughness", longitudinal_roughness),
            ("azimuthalRoughness", azimuthal_roughness),
            ("scaleTilt", scale_tilt),
            ("ior", ior),
        ])


class Checkerboard(Material):
    """A 3D checkerboard: unit cubes that alternate between two materials.

    material1: whole number; must be given. Material of the cubes whose integer coordinates have an even sum.

    material2: whole number; must be given. Material of the other cubes.
    """

    def __init__(
        self,
        *,
        material1: Union[int, Material],
        material2: Union[int, Material],
    ) -> None:
        super().__init__("Checkerboard", [
            ("materialIndex", material1),
            ("materialIndex", material2),
        ])


class Noise(Material):
    """A mix of two materials by a noise function.

    material1: whole number; must be given. Material where the noise is high.

    material2: whole number; must be given. Material where the noise is low.

    octaves: whole number, at most 32; must be given. Number of noise octaves, each with twice the frequency of the previous one.
    """

    def __init__(
        self,
        *,
        material1: Union[int, Material],
        material2: Union[int, Material],
        octaves: Union[int, Material],
    ) -> None:
        super().__init__("Noise", [
            ("materialIndex", material1),
            ("materialIndex", material2),
            ("octaves", octaves),
        ])


class Marble(Material):
    """A marble pattern: two materials in veins across the x axis.

    material1: whole number; must be given. Material where the sine is 1.

    material2: whole number; must be given. Material where the sine is -1.

    octaves: whole number, at most 32; must be given. Number of noise octaves, each with twice the frequency of the previous one.

    frequency: number; must be given. Number of veins per 2 pi along x.

    amplitude: number; must be given. Strength of the noise that distorts the veins.
    """

    def __init__(
        self,
        *,
        material1: Union[int, Material],
        material2: Union[int, Material],
        octaves: Union[int, Material],
        frequency: float,
        amplitude: float,
    ) -> None:
        super().__init__("Marble", [
            ("materialIndex", material1),
            ("materialIndex", material2),
            ("octaves", octaves),
            ("frequency", frequency),
            ("amplitude", amplitude),
        ])


class Wood(Material):
    """A wood pattern: two materials in rings around the y axis.

    material1: whole number; must be given. Material where the sine is 1.

    material2: whole number; must be given. Material where the sine is -1.

    octaves: whole number, at most 32; must be given. Number of noise octaves, each with twice the frequency of the previous one.

    frequency: number; must be given. Number of rings per 2 pi along the radius.

    amplitude: number; must be given. Strength of the noise that distorts the rings.
    """

    def __init__(
        self,
        *,
        material1: Union[int, Material],
        material2: Union[int, Material],
        octaves: Union[int, Material],
        frequency: float,
        amplitude: float,
    ) -> None:
        super().__init__("Wood", [
            ("materialIndex", material1),
            ("materialIndex", material2),
            ("octaves", octaves),
            ("frequency", frequency),
            ("amplitude", amplitude),
        ])


class Mix(Material):
    """Mix of two materials in a proportion that is constant or set by a texture.

    material1: whole number; must be given. First material.

    material2: whole number; must be given. Second material.

    share: number, from 0 to 1; 0.5 where it is not given. Share of the first material, from 0 to 1.

    share_texture: path. Texture that multiplies `share`.
    """

    def __init__(
        self,
        *,
        material1: Union[int, Material],
        material2: Union[int, Material],
        share: Optional[float] = None,
        share_texture: Optional[str] = None,
    ) -> None:
        super().__init__("Mix", [
            ("materialIndex", material1),
            ("materialIndex", material2),
            ("share", share),
            ("shareTexture", share_texture),
        ])


class TwoSided(Material):
    """Surface with one material on its front, where the normal points, and another on its back.

    material1: whole number; must be given. Material of the front.

    material2: whole number; must be given. Material of the back.
    """

    def __init__(
        self,
        *,
        material1: Union[int, Material],
        material2: Union[int, Material],
    ) -> None:
        super().__init__("TwoSided", [
            ("materialIndex", material1),
            ("materialIndex", material2),
        ])


class Sphere(Shape):
    """A sphere.

    center: three numbers; must be given. Centre of the sphere.

    radius: number, more than 0; must be given. Radius, in world units.
    """

    def __init__(
        self,
        *,
        center: npt.ArrayLike,
        radius: float,
    ) -> None:
        super().__init__("Sphere", [
            ("center", center),
            ("radius", radius),
        ])


class Plane(Shape):
    """An infinite plane: all points p with normal · p = offset. As part of a solid, it is the half space behind the plane.

    normal: three numbers, not 0 0 0; must be given. Normal on the front side; of any length.

    offset: number; must be given. Distance from the origin along the normal, for a unit normal.
    """

    def __init__(
        self,
        *,
        normal: npt.ArrayLike,
        offset: float,
    ) -> None:
        super().__init__("Plane", [
            ("normal", normal),
            ("offset", offset),
        ])


class Triangle(Shape):
    """A triangle; its corners are counter-clockwise when seen from the front.

    vertex0: three numbers; must be given. Position of the first corner.

    vertex1: three numbers; must be given. Position of the second corner.

    vertex2: three numbers; must be given. Position of the third corner.
    """

    def __init__(
        self,
        *,
        vertex0: npt.ArrayLike,
        vertex1: npt.ArrayLike,
        vertex2: npt.ArrayLike,
    ) -> None:
        super().__init__("Triangle", [
            ("vertex0", vertex0),
            ("vertex1", vertex1),
            ("vertex2", vertex2),
        ])


class Box(Shape):
    """A box whose faces are parallel to the coordinate planes.

    min: three numbers; must be given. Corner with the smallest coordinates.

    max: three numbers; must be given. Corner with the largest coordinates.
    """

    def __init__(
        self,
        *,
        min: npt.ArrayLike,
        max: npt.ArrayLike,
    ) -> None:
        super().__init__("Box", [
            ("min", min),
            ("max", max),
        ])


class Cylinder(Shape):
    """A cylinder with caps, around the line between two points.

    base: three numbers; must be given. Centre of the cap at one end.

    top: three numbers; must be given. Centre of the cap at the other end.

    radius: number, more than 0; must be given. Radius, in world units.
    """

    def __init__(
        self,
        *,
        base: npt.ArrayLike,
        top: npt.ArrayLike,
        radius: float,
    ) -> None:
        super().__init__("Cylinder", [
            ("base", base),
            ("top", top),
            ("radius", radius),
        ])


class Cone(Shape):
    """A cone with a cap, or a frustum with both caps if the top has a radius too.

    base: three numbers; must be given. Centre of the cap at the base.

    top: three numbers; must be given. The tip, or the centre of the cap at the top.

    base_radius: number, 0 or more; must be given. Radius at the base; can be 0 if the radius at the top is not.

    top_radius: number, 0 or more; 0 where it is not given. Radius at the top; default 0 for a tip.
    """

    def __init__(
        self,
        *,
        base: npt.ArrayLike,
        top: npt.ArrayLike,
        base_radius: float,
        top_radius: Optional[float] = None,
    ) -> None:
        super().__init__("Cone", [
            ("base", base),
            ("top", top),
            ("baseRadius", base_radius),
            ("topRadius", top_radius),
        ])


class Torus(Shape):
    """A torus: all points within `minorRadius` of a circle.

    center: three numbers; must be given. Centre of the circle.

    axis: three numbers, not 0 0 0; 0 1 0 where it is not given. Normal of the circle's plane; of any length.

    major_radius: number, more than 0; must be given. Radius of the circle, in world units.

    minor_radius: number, more than 0; must be given. Distance from the circle: half the ring's thickness.
    """

    def __init__(
        self,
        *,
        center: npt.ArrayLike,
        axis: Optional[npt.ArrayLike] = None,
        major_radius: float,
        minor_radius: float,
    ) -> None:
        super().__init__("Torus", [
            ("center", center),
            ("axis", axis),
            ("majorRadius", major_radius),
            ("minorRadius", minor_radius),
        ])


class Ellipsoid(Shape):
    """A sphere stretched along the coordinate axes.

    center: three numbers; must be given. Centre of the ellipsoid.

    radii: three numbers; must be given. Semi-axes along x, y and z.
    """

    def __init__(
        self,
        *,
        center: npt.ArrayLike,
        radii: npt.ArrayLike,
    ) -> None:
        super().__init__("Ellipsoid", [
            ("center", center),
            ("radii", radii),
        ])


class Quadric(Shape):
    """A quadric surface: the zeros of A x² + B y² + C z² + D xy + E xz + F yz + G x + H y + I z + J. The polynomial is negative inside.

    squares: three numbers; must be given. Coefficients A, B and C.

    products: three numbers; 0 0 0 where it is not given. Coefficients D, E and F.

    linear: three numbers; 0 0 0 where it is not given. Coefficients G, H and I.

    constant: number; must be given. Coefficient J.
    """

    def __init__(
        self,
        *,
        squares: npt.ArrayLike,
        products: Optional[npt.ArrayLike] = None,
        linear: Optional[npt.ArrayLike] = None,
        constant: float,
    ) -> None:
        super().__init__("Quadric", [
            ("squares", squares),
            ("products", products),
            ("linear", linear),
            ("constant", constant),
        ])


class Disc(Shape):
    """A flat disc, optionally with a hole.

    center: three numbers; must be given. Centre of the disc.

    normal: three numbers, not 0 0 0; must be given. Normal on the front side; of any length.

    radius: number, more than 0; must be given. Radius, in world units.

    inner_radius: number, 0 or more; 0 where it is not given. Radius of the hole at the centre.
    """

    def __init__(
        self,
        *,
        center: npt.ArrayLike,
        normal: npt.ArrayLike,
        radius: float,
        inner_radius: Optional[float] = None,
    ) -> None:
        super().__init__("Disc", [
            ("center", center),
            ("normal", normal),
            ("radius", radius),
            ("innerRadius", inner_radius),
        ])


class Rectangle(Shape):
    """A rectangle, or a parallelogram if its edges are not perpendicular. Seen from the front, `edge1` is counter-clockwise from `edge0`.

    corner: three numbers; must be given. Position of a corner.

    edge0: three numbers, not 0 0 0; must be given. Edge from the corner to the next one.

    edge1: three numbers, not 0 0 0; must be given. Edge from the corner to the previous one.
    """

    def __init__(
        self,
        *,
        corner: npt.ArrayLike,
        edge0: npt.ArrayLike,
        edge1: npt.ArrayLike,
    ) -> None:
        super().__init__("Rectangle", [
            ("corner", corner),
            ("edge0", edge0),
            ("edge1", edge1),
        ])


class TriangleMesh(Shape):
    """A triangle mesh in a separate file.

    obj_file: path; must be given. Path of the mesh file: `.obj`, `.ply` or `.stl`.
    """

    def __init__(
        self,
        *,
        obj_file: str,
    ) -> None:
        super().__init__("TriangleMesh", [
            ("obj_file", obj_file),
        ])


class HeightField(Shape):
    """A block whose top is a terrain. The grey values of an image are the heights, and its lower edge is towards +z.

    picture: path; must be given. Path of the height image. Black is lowest; white, or 1 in floating-point images, is highest.

    min: three numbers; must be given. Corner of the terrain's box with the smallest coordinates; heights there are 0.

    max: three numbers; must be given. Corner of the terrain's box with the largest coordinates; heights there are 1.

    depth: number, more than 0; 1 where it is not given. Depth of the block below `min`.
    """

    def __init__(
        self,
        *,
        picture: str,
        min: npt.ArrayLike,
        max: npt.ArrayLike,
        depth: Optional[float] = None,
    ) -> None:
        super().__init__("HeightField", [
            ("picture", picture),
            ("min", min),
            ("max", max),
            ("depth", depth),
        ])
