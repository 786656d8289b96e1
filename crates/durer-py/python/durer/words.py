"""The words of the scene language as classes. Written by `cargo xtask manual` from what the code states; a test holds it to that."""

# fmt: off
from __future__ import annotations

from typing import Literal, Optional, Union

import numpy.typing as npt

from .things import Camera, Light, Material, Shape, Thing

__all__ = ["Background", "Box", "CaveCamera", "Checkerboard", "Cone", "CubeMapCamera", "Cylinder", "CylindricalCamera", "DirectionalLight", "Disc", "Ellipsoid", "EquirectangularCamera", "FisheyeCamera", "Fog", "HairMaterial", "HeightField", "Marble", "Mix", "MultipleCenterCamera", "Noise", "OmnimaxCamera", "OrthographicCamera", "ParabolicCamera", "PerspectiveCamera", "PhongMaterial", "PhotometricLight", "PinholeCamera", "Plane", "PointLight", "PrincipledMaterial", "ProjectiveCamera", "PushBroomCamera", "Quadric", "Rectangle", "Sphere", "SpotLight", "StereoCamera", "Texture", "ThinLensCamera", "Torus", "Triangle", "TriangleMesh", "TwoSided", "Wood"]


class Background(Thing):
    """What a ray sees that hits nothing, and the light that is everywhere.

    color: three numbers; 0.5 0.5 0.5 where it is not given. Colour of rays that hit nothing. A scene of ours without a `Background` is black around under `path`, where light is only what a scene says.

    ambient_light: three numbers; 0 0 0 where it is not given. Light that reaches every surface.

    cube_map: path. Folder with six pictures (left, right, up, down, front, back) that replace the colour.

    environment: path. A picture of all directions that replaces the colour and lights the scene, best of high dynamic range (`.exr`, `.hdr`); its middle is seen towards -z. Whitted's light does not come from it.

    sun: three numbers, not 0 0 0. The way to the sun, of any length, with y upwards: a clear sky and the sun light the scene, in cd/m^2. Such pictures need `--exposure`, -13 say.

    sun_altitude: number, from -90 to 90. The same by angles: how high the sun stands, in degrees above the horizon.

    sun_azimuth: number. And where, in degrees from north (-z) over east (x): 180 is south.

    latitude: number, from -90 to 90. The same by place, date and time: degrees north of the equator.

    longitude: number, from -360 to 360. Degrees east of Greenwich.

    date: three numbers, whole, 1 to 9999. Year, month and day.

    time: three numbers. Hours, minutes and seconds of a clock there.

    time_zone: number, from -14 to 14. Hours that this clock is before that of Greenwich, summer time included; 0 where nothing is written.

    turbidity: number, more than 0. How hazy the air is: from 2 (clear) over 3 (a usual day, where nothing is written) to 10.

    cie_sky: whole number, from 1 to 16. Number of a standard sky of the CIE, 1 to 16 (1 overcast, 5 even, 12 clear, 16 the traditional overcast sky): it lights the scene, in cd/m^2, without the sun itself, whose place `sun` says for all but 1, 3, 5 and 16.

    zenith_luminance: number, more than 0. How bright that sky is at the zenith, in cd/m^2; 10000 where nothing is written.

    ground_reflectance: number, from 0 to 1. What share of the light of sun and sky the ground below the horizon gives back. Where nothing is written it is 0.2 below a standard sky, and below a clear one with `sun` a fifth of the zenith's light.

    environment_rotation: number. How far the environment is turned about y, in degrees.

    environment_scale: three numbers. What multiplies the environment.
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
    """What is in the air: fog, smoke, dust. Light of lamps and of the sky is scattered and absorbed in it. It is not in bodies of glass, and Whitted's light does not see it.

    extinction: number, more than 0; 0.1 where it is not given. How dense it is: of light that goes straight on, a share of e^(-extinction · distance) is left.

    color: three numbers; 1 1 1 where it is not given. The share of light that is scattered, and not absorbed, where it meets the fog; from 0 to 1.

    anisotropy: number, more than -1, less than 1; 0 where it is not given. Where light goes that is scattered: from -1 (back) over 0 (evenly) to 1 (onwards).

    min: three numbers. A corner of the box that the fog is in; without, it is everywhere.

    max: three numbers. The corner across.

    density: path. A file of densities (Mitsuba's `.vol`) that fill the box and multiply `extinction`; without a box, that of the file.
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
    """A picture with a name, and how it lies on surfaces. What takes a picture in a `PrincipledMaterial` takes that name.

    name: path; must be given. Its name.

    picture: path; must be given. The picture's file.

    wrap_u: `repeat`, `mirror`, `clamp`; repeat where it is not given. What is beyond its left and right border: `repeat`, `mirror` or `clamp`.

    wrap_v: `repeat`, `mirror`, `clamp`; repeat where it is not given. What is beyond its upper and lower border.

    texels: `linear`, `nearest`; linear where it is not given. Whether the four texels around a point are mixed (`linear`), or the `nearest` counts alone.

    minified: `texels`, `mipmaps`; texels where it is not given. What is shown where a sample sees many texels at once, under paths: some of them (`texels`), or a smaller version of the picture (`mipmaps`).

    uv_set: whole number, at most 1; 0 where it is not given. The set of a mesh's texture coordinates: 0, or 1 for the second.

    uv_transform: `{ }` of rows of 3 numbers, 2 of them. From the surface's coordinates to the picture's, both with v downwards from the upper border: two rows of a matrix.

    alpha_cutoff: number. Opacity is 1 where the picture's alpha is at least this, and else 0; where nothing is written, as the alpha says.

    normal_scale: number; 1 where it is not given. How far the normals of a normal map lean, times.

    channel: `r`, `g`, `b`, `a`, `angle`. What counts where a number is wanted: `r`, `g`, `b`, `a`, or the `angle` of the direction in red and green; where nothing is written, red, or of opacity what there is.

    texel_range: `{ }` of rows of 2 numbers, 1 of them. What a texel's 0 and 1 stand for, where the picture changes a number.
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
    """A camera that sees in perspective.

    center: three numbers; must be given. The eye.

    direction: three numbers, not 0 0 0; must be given. Where it looks; of any length.

    up: three numbers, not 0 0 0; must be given. What is up in the picture; need not be perpendicular.

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
    """A camera that sees without perspective.

    center: three numbers; must be given. The middle of the picture.

    direction: three numbers, not 0 0 0; must be given. Where it looks; of any length.

    up: three numbers, not 0 0 0; must be given. What is up in the picture; need not be perpendicular.

    size: number, more than 0; must be given. Length of the picture's larger side.

    near: number. How far before `center` sight begins, for plans and sections; where nothing is written all is seen, also what is behind.

    handedness: `right`, `left`; right where it is not given. Which side of the picture is right: `left` makes a mirror image, as in coordinates of the left hand.
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
    """A camera without a lens, whose hole has a size.

    center: three numbers; must be given. The middle of the hole.

    direction: three numbers, not 0 0 0; must be given. Where it looks; of any length.

    up: three numbers, not 0 0 0; must be given. What is up in the picture; need not be perpendicular.

    angle: number, more than 0, less than 180; must be given. Field of view across the picture's larger side, in degrees.

    hole: number, 0 or more; must be given. Diameter of the hole.

    film_distance: number, more than 0; 1 where it is not given. Distance from the hole to the film.
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
    """A camera with a lens: depth of field, and a film that can be shifted.

    center: three numbers; must be given. The middle of the lens.

    direction: three numbers, not 0 0 0; must be given. Where it looks: along the lens's axis; of any length.

    up: three numbers, not 0 0 0; must be given. What is up in the picture; need not be perpendicular.

    angle: number, more than 0, less than 180; must be given. Field of view across the picture's larger side, in degrees, where nothing is shifted.

    aperture: number, 0 or more; 0 where it is not given. Diameter of the opening: focal length over f-number. 0 makes everything sharp.

    focus_distance: number, more than 0; 1 where it is not given. Distance of the plane that is sharp, along the axis.

    blades: whole number, at most 64; 0 where it is not given. Straight blades around the opening; 0 makes it round.

    blade_angle: number; 0 where it is not given. Turn of the opening about the axis, in degrees.

    shift_right: number; 0 where it is not given. What is seen moves to the right by this part of half the larger side.

    shift_up: number; 0 where it is not given. What is seen moves upwards by this part of half the larger side.

    near: number, 0 or more; 0 where it is not given. Distance along the axis before which nothing is seen.

    far: number, more than 0. Distance along the axis beyond which nothing is seen.

    handedness: `right`, `left`; right where it is not given. Which side of the picture is right: `left` makes a mirror image, as in coordinates of the left hand.
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
    """Two perspective views for two eyes, or one of them.

    center: three numbers; must be given. The middle between the eyes.

    direction: three numbers, not 0 0 0; must be given. Where the viewer looks; of any length.

    up: three numbers, not 0 0 0; must be given. What is up in the picture; need not be perpendicular.

    angle: number, more than 0, less than 180; must be given. Field of view across the larger side of one eye's picture, in degrees.

    separation: number, 0 or more; must be given. Distance between the eyes.

    convergence: number, more than 0; 1 where it is not given. Distance at which both eyes see a thing at the same place of the picture; without meaning for `parallel`.

    method: `offAxis`, `toeIn`, `parallel`; offAxis where it is not given. How the views converge.

    eyes: `middle`, `left`, `right`, `sideBySide`, `topBottom`; sideBySide where it is not given. Which eye's picture, or how both are laid out.

    aspect: number, more than 0; 1 where it is not given. Width of one eye's picture over its height.
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
    """A camera that sees a cone of directions as a disc; the corners see nothing.

    center: three numbers; must be given. The eye.

    direction: three numbers, not 0 0 0; must be given. Where it looks; of any length.

    up: three numbers, not 0 0 0; must be given. What is up in the picture; need not be perpendicular.

    angle: number, more than 0, at most 360; 180 where it is not given. Field of view across the disc, in degrees: at most 180 for `orthographic`, less than 360 for `stereographic`.

    projection: `equidistant`, `equisolid`, `stereographic`, `orthographic`; equidistant where it is not given. How the angle from the axis becomes a radius.
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
    """A picture for a tilted dome, with projector and viewer where they are; the corners see nothing.

    center: three numbers; must be given. Where the viewer is in the scene.

    direction: three numbers, not 0 0 0; must be given. Where the audience looks: level to the front; of any length.

    up: three numbers, not 0 0 0; must be given. What is up for the audience; need not be perpendicular.

    tilt: number; 30 where it is not given. Tilt of the dome to the front, in degrees: 0 has its pole overhead, 90 straight ahead.

    dome: number, more than 0, at most 360; 180 where it is not given. How much of a sphere the dome is, in degrees across: 180 is a hemisphere.

    angle: number, more than 0, at most 360; 180 where it is not given. Field of view of the projector, in degrees.

    projector: three numbers; 0 0 0 where it is not given. The projector: to the right of the dome's middle, above and before it, in parts of its radius.

    viewer: three numbers; 0 0 0 where it is not given. The viewer, likewise.
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
    """A lens above a parabolic mirror; the corners see nothing.

    center: three numbers; must be given. The mirror's focus: the single viewpoint.

    direction: three numbers, not 0 0 0; must be given. The mirror's axis, from its focus to the lens: usually upwards; of any length.

    up: three numbers, not 0 0 0; must be given. What is up in the picture; need not be perpendicular.

    angle: number, more than 0, less than 360; 210 where it is not given. Field of view around the axis, in degrees: 180 to the horizon, more below it.
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
    """A camera that sees all around: longitude and latitude as a rectangle, for one eye or a pair.

    center: three numbers; must be given. The eye, or the middle of the circle on which both turn.

    direction: three numbers, not 0 0 0; must be given. What is in the middle of the picture; of any length.

    up: three numbers, not 0 0 0; must be given. The north pole; need not be perpendicular.

    angle: number, more than 0, at most 360; 360 where it is not given. Field of view from left to right, in degrees.

    vertical_angle: number, more than 0, at most 180; 180 where it is not given. Field of view from bottom to top, in degrees.

    eyes: `middle`, `left`, `right`, `sideBySide`, `topBottom`; middle where it is not given. Which eye's picture, or how both are laid out.

    separation: number, 0 or more; 0.065 where it is not given. Distance between the eyes.

    handedness: `right`, `left`; right where it is not given. Which side of the picture is right: `left` makes a mirror image, as in coordinates of the left hand.
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
    """A camera that sees a panorama on a cylinder, for one eye or a pair.

    center: three numbers; must be given. The eye, or the middle of the circle on which both turn.

    direction: three numbers, not 0 0 0; must be given. What is in the middle of the picture; of any length.

    up: three numbers, not 0 0 0; must be given. The cylinder's axis; need not be perpendicular.

    angle: number, more than 0, at most 360; 360 where it is not given. Field of view from left to right, in degrees.

    vertical_angle: number, more than 0, less than 180; 90 where it is not given. Field of view from bottom to top, in degrees.

    eyes: `middle`, `left`, `right`, `sideBySide`, `topBottom`; middle where it is not given. Which eye's picture, or how both are laid out.

    separation: number, 0 or more; 0.065 where it is not given. Distance between the eyes.
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
    """A camera that sees all around, on the six faces of a cube.

    center: three numbers; must be given. The eye.

    direction: three numbers, not 0 0 0; must be given. The middle of the front face; of any length.

    up: three numbers, not 0 0 0; must be given. What is up in the front face; need not be perpendicular.

    layout: `cross`, `strip`; cross where it is not given. How the faces lie in the picture.
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
    """Several walls around a viewer, as one picture; for one eye or a pair.

    center: three numbers; must be given. The viewer's eye, or the middle between both: anywhere in the room.

    direction: three numbers, not 0 0 0; 0 0 -1 where it is not given. Where the viewer's head is turned, which tells his right from his left; of any length.

    up: three numbers, not 0 0 0; 0 1 0 where it is not given. What is up for the viewer's head; need not be perpendicular.

    walls: `{ }` of rows of 9 numbers, 1 to 64 of them; must be given. Three corners for each wall, as seen from inside: lower left, lower right, upper left. From left to right.

    eyes: `middle`, `left`, `right`, `sideBySide`, `topBottom`; middle where it is not given. Which eye's picture, or how both are laid out.

    separation: number, 0 or more; 0.065 where it is not given. Distance between the eyes.
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
    """A camera whose columns are seen one after the other from a straight way.

    start: three numbers; must be given. Where the first column is seen from, at the picture's left.

    end: three numbers; must be given. Where the last column is seen from, at the picture's right.

    direction: three numbers, not 0 0 0; must be given. Where all columns look; of any length.

    up: three numbers, not 0 0 0; must be given. What is up in the picture; need not be perpendicular.

    angle: number, more than 0, less than 180; must be given. Field of view from bottom to top, in degrees.

    aspect: number, more than 0; 2 where it is not given. Width of the picture over its height.
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
    """A camera whose columns are seen one after the other from a path.

    path: `{ }` of rows of 6 numbers, 2 to 1024 of them; must be given. Places along the path, from the picture's left to its right: the eye, and the point that it looks at. Where the last is the first, the path is a smooth loop.

    up: three numbers, not 0 0 0; must be given. What is up in every column; need not be perpendicular.

    angle: number, more than 0, less than 180; must be given. Field of view from bottom to top, in degrees.

    aspect: number, more than 0; 2 where it is not given. Width of the picture over its height.
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
    """A camera recovered from a photograph: a projective matrix and the lens's distortion.

    matrix: `{ }` of rows of 4 numbers, 3 of them; must be given. The 3x4 matrix, row by row: from homogeneous points of the world to pixels, y downwards; at any scale.

    width: number, more than 0; must be given. Width of the photograph in pixels.

    height: number, more than 0; must be given. Height of the photograph in pixels.

    k1: number; 0 where it is not given. Radial distortion by the square of the radius.

    k2: number; 0 where it is not given. Radial distortion by its fourth power.

    p1: number; 0 where it is not given. Tangential distortion, upwards.

    p2: number; 0 where it is not given. Tangential distortion, sideways.

    k3: number; 0 where it is not given. Radial distortion by the sixth power.
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
    """Light that comes from one direction everywhere.

    direction: three numbers, not 0 0 0; must be given. Where the light goes; of any length.

    color: three numbers; must be given. Its colour and strength.

    spread: number, 0 or more. Half the angle in which it is seen, in degrees, for soft shadows under a path tracer, which sees its disc: 0.27 for the sun.

    lux: number, 0 or more. Illuminance in lux of what faces it: how strong it is, of which `color` is the hue.

    spectrum: path. Its measured spectrum, which `color` multiplies: a file (`lamp.csv`, `lamps.csv:column`) or the name of an illuminant (A, D65, F2, 2700K). Under `--color spectral` it is carried as such, else as its colour.
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
    """Light that comes from one point.

    position: three numbers; must be given. Where it is.

    color: three numbers; must be given. Its colour and strength.

    attenuation: three numbers. How it fades: the divisor's constant, its factor of distance and its factor of distance squared.

    falloff: number, 0 or more. How it fades: the divisor's factor of distance squared; what is added to it depends on the dialect.

    candela: number, 0 or more. Luminous intensity in candela: how strong it is, of which `color` is the hue; it fades with the square of the distance.

    lumens: number, 0 or more. The same by its luminous flux in lumen.

    spectrum: path. Its measured spectrum, which `color` multiplies: a file (`lamp.csv`, `lamps.csv:column`) or the name of an illuminant (A, D65, F2, 2700K). Under `--color spectral` it is carried as such, else as its colour.
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
    """Light that comes from one point into a cone, and fades with the square of the distance.

    position: three numbers; must be given. Where it is.

    direction: three numbers, not 0 0 0; must be given. Where the middle of the cone points; of any length.

    color: three numbers; must be given. What arrives in the middle at distance 1.

    angle: number, more than 0, at most 180; 45 where it is not given. Degrees from the middle to where the cone ends.

    inner_angle: number, 0 or more; 0 where it is not given. Degrees from the middle to where it begins to fade; not more than `angle`.

    fade: `squared`, `smooth`, `fourth`; squared where it is not given. How it fades between the two, by the share s of the cosine's way: `squared` is s^2, `smooth` s^2 (3 - 2 s), `fourth` s^4.

    candela: number, 0 or more. Luminous intensity in candela in its middle: how strong it is, of which `color` is the hue.

    lumens: number, 0 or more. The same by its luminous flux in lumen.

    spectrum: path. Its measured spectrum, which `color` multiplies: a file (`lamp.csv`, `lamps.csv:column`) or the name of an illuminant (A, D65, F2, 2700K). Under `--color spectral` it is carried as such, else as its colour.
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
    """A lamp whose light was measured: a point that shines as an IES or EULUMDAT file says, in candela.

    position: three numbers; must be given. Where it is.

    file: path; must be given. The measurement: an IES file (LM-63-1986 to 2019), or EULUMDAT (`.ldt`).

    direction: three numbers, not 0 0 0; 0 -1 0 where it is not given. Where its lower side points.

    front: three numbers, not 0 0 0; 1 0 0 where it is not given. Where its horizontal angle 0 points; made perpendicular to `direction`.

    focal_length: number, 0 or more; 0 where it is not given. How far behind it its light seems to come from, as that of a lamp with a reflector: at a distance d it has faded as at d and this together.

    color: three numbers; 1 1 1 where it is not given. What multiplies what was measured, by colour.

    lumens: number, 0 or more. Its luminous flux in lumen, in the place of that of the file; `color` is its hue then.

    spectrum: path. Its measured spectrum, which `color` multiplies: a file (`lamp.csv`, `lamps.csv:column`) or the name of an illuminant (A, D65, F2, 2700K). Under `--color spectral` it is carried as such, else as its colour.
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
    """A material with diffuse colour and highlight, which may reflect and let through light.

    diffuse_color: three numbers. Share of light scattered evenly; 1 1 1 where nothing is written.

    specular_color: three numbers; 0 0 0 where it is not given. Strength of the highlight; in some dialects also of the mirror.

    exponent: number, 0 or more. Sharpness of Blinn's highlight.

    shininess: number, 0 or more. Sharpness of Phong's highlight.

    reflective_color: three numbers; 0 0 0 where it is not given. Weight of the mirrored ray.

    transparent_color: three numbers; 0 0 0 where it is not given. Weight of the transmitted ray.

    index_of_refraction: number, more than 0. Index of refraction of transmitted rays that are weighed by `transparentColor` alone.

    refraction_index: number, 0 or more. Index of refraction of glass that divides light by Fresnel; 0 means none.

    texture: path. A picture that replaces the diffuse colour on meshes with texture coordinates.

    bump: path. A bump map: read over, as in every year.
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
    """A material of layers: fuzz on a coat on metal, glass or matte. Names and meanings are those of OpenPBR Surface.

    base_weight: number, from 0 to 1; 1 where it is not given. Strength of the base, from 0 to 1: of the matte colour and of the metal's.

    base_weight_texture: path. A picture that multiplies `baseWeight`. Of a picture that multiplies a number, red counts, or the channel after a colon: `file.png:g`.

    base_color: three numbers; 0.8 0.8 0.8 where it is not given. Share of light that the matte base scatters, and what a metal reflects at right angles; from 0 to 1.

    base_spectrum: path. A file with a measured reflectance, which stands in place of `baseColor`: rows of nanometres and shares from 0 to 1; with several columns `file.csv:name` is one of them. `--color spectral` has it by wavelength, else its colour in daylight counts.

    base_color_texture: path. A picture that multiplies `baseColor`; its values are read as sRGB, and its alpha multiplies `opacity`.

    base_diffuse_roughness: number, from 0 to 1; 0 where it is not given. How rough the matte base is, from 0 (Lambert) to 1.

    base_diffuse_roughness_texture: path. A picture that multiplies `baseDiffuseRoughness`.

    base_metalness: number, from 0 to 1; 0 where it is not given. From 0 (glass or matte) to 1 (metal).

    base_metalness_texture: path. A picture that multiplies `baseMetalness`.

    specular_weight: number, 0 or more; 1 where it is not given. Strength of the reflection, from 0 to 1 or more: it scales what reflects at right angles.

    specular_weight_texture: path. A picture that multiplies the whole reflection, at all angles alike.

    specular_color: three numbers; 1 1 1 where it is not given. Tint of the reflection; on metal the colour near grazing angles.

    specular_color_texture: path. A picture that multiplies `specularColor`; its values are read as sRGB.

    specular_roughness: number, from 0 to 1; 0.3 where it is not given. How rough the surface is, from 0 (a mirror) to 1; its square is GGX's alpha.

    specular_roughness_texture: path. A picture that multiplies `specularRoughness`.

    metallic_roughness_texture: path. A picture whose green multiplies `specularRoughness` and whose blue multiplies `baseMetalness`.

    specular_anisotropy: number, from 0 to 1; 0 where it is not given. How much longer than wide the highlight is, from 0 (round) to 1.

    specular_anisotropy_texture: path. A picture that multiplies `specularAnisotropy`.

    specular_rotation: number; 0 where it is not given. Turns the highlight about the normal, in whole turns, from the direction in which u grows.

    specular_rotation_texture: path. A picture that is added to `specularRotation`, in whole turns; `file.png:angle` has it as a direction in red and green.

    specular_ior: number, more than 0; 1.5 where it is not given. Index of refraction inside.

    surroundings: `nested`, `ignored`; nested where it is not given. `nested`: glass in other glass or in water refracts by the indices of both; `ignored`: `specularIor` is the index inside over the index outside, whatever the surface lies in, as pbrt and Mitsuba have it.

    energy_compensation: `on`, `off`; on where it is not given. `on`: light that a rough metal, glass or coat reflects between its facets is given back, so that none is lost; `off`: a ray is reflected or refracted once, as pbrt and Mitsuba have it, and the rougher the surface, the darker it is.

    transmission_weight: number, from 0 to 1; 0 where it is not given. From 0 (matte) to 1 (glass).

    transmission_weight_texture: path. A picture that multiplies `transmissionWeight`.

    transmission_color: three numbers; 1 1 1 where it is not given. Colour of light that went `transmissionDepth` deep; where that is 0, of all that passes the surface. Thin walls are that deep: at an angle more is lost.

    transmission_color_texture: path. A picture that multiplies `transmissionColor` where `transmissionDepth` is 0; its values are read as sRGB.

    transmission_depth: number, 0 or more; 0 where it is not given. How deep light goes until it has `transmissionColor`, in units of the world; 0: the surface tints it. Of thin walls any depth makes the inside absorb, what is reflected there too.

    transmission_scatter: three numbers; 0 0 0 where it is not given. Colour of the light that a body scatters inside, per `transmissionDepth`; 0 0 0: it is clear.

    transmission_scatter_anisotropy: number, more than -1, less than 1; 0 where it is not given. Where that light goes: from -1 (back) over 0 (evenly) to 1 (onwards).

    transmission_density: path. A file of densities (Mitsuba's `.vol`) that multiply what light loses in the body; its box lies in the world.

    transmission_density_box: `{ }` of rows of 3 numbers, 0 to 4 of them. The box that `transmissionDensity` fills in place of the file's, in the world: a corner and the edges from there along the grid's x, y and z.

    transmission_dispersion_scale: number, from 0 to 1; 0 where it is not given. How much glass spreads colours, over what `transmissionDispersionAbbeNumber` says; 0: not at all. Only `--color spectral` shows it.

    transmission_dispersion_abbe_number: number, more than 0; 20 where it is not given. Abbe number of the glass: the lower, the more it spreads colours; 64 is crown glass, 30 flint.

    subsurface_weight: number, from 0 to 1; 0 where it is not given. From 0 (matte) to 1 (light goes into the body, is scattered there and comes out elsewhere: marble, milk, skin).

    subsurface_weight_texture: path. A picture that multiplies `subsurfaceWeight`.

    subsurface_color: three numbers; 0.8 0.8 0.8 where it is not given. The colour that such a body shows.

    subsurface_color_texture: path. A picture that multiplies `subsurfaceColor` where light enters; its values are read as sRGB.

    subsurface_radius: number, more than 0; 1 where it is not given. How far light goes in it until it is scattered, on the mean, in units of the world.

    subsurface_radius_scale: three numbers; 1 0.5 0.25 where it is not given. What multiplies `subsurfaceRadius` for red, green and blue.

    subsurface_scatter_anisotropy: number, more than -1, less than 1; 0 where it is not given. Where light goes that is scattered in it: from -1 (back) over 0 (evenly) to 1 (onwards).

    coat_weight: number, from 0 to 1; 0 where it is not given. Strength of the clear coat, from 0 to 1.

    coat_weight_texture: path. A picture that multiplies `coatWeight`.

    coat_color: three numbers; 1 1 1 where it is not given. Colour of what passes the coat down and up again at right angles.

    coat_color_texture: path. A picture that multiplies `coatColor`; its values are read as sRGB.

    coat_roughness: number, from 0 to 1; 0 where it is not given. How rough the coat is, from 0 to 1.

    coat_roughness_texture: path. A picture that multiplies `coatRoughness`.

    coat_ior: number, more than 0; 1.6 where it is not given. Index of refraction of the coat.

    coat_darkening: number, from 0 to 1; 1 where it is not given. How much a coat darkens what it covers by reflecting light back down, from 0 to 1 (as physics has it).

    coat_darkening_texture: path. A picture that multiplies `coatDarkening`.

    fuzz_weight: number, from 0 to 1; 0 where it is not given. Strength of the fuzz on top, as of velvet or dust, from 0 to 1.

    fuzz_weight_texture: path. A picture that multiplies `fuzzWeight`.

    fuzz_color: three numbers; 1 1 1 where it is not given. Colour of the fuzz.

    fuzz_color_texture: path. A picture that multiplies `fuzzColor`; its values are read as sRGB.

    fuzz_roughness: number, from 0 to 1; 0.5 where it is not given. How rough the fuzz is, from 0 to 1.

    fuzz_roughness_texture: path. A picture that multiplies `fuzzRoughness`.

    thin_film_weight: number, from 0 to 1; 0 where it is not given. How much of the surface below the coat has a thin film on it, from 0 to 1: soap, oil, tempered steel, the layers of a pearl.

    thin_film_weight_texture: path. A picture that multiplies `thinFilmWeight`.

    thin_film_thickness: number, 0 or more; 0.5 where it is not given. How thick the film is, in micrometres.

    thin_film_thickness_texture: path. A picture that multiplies `thinFilmThickness`.

    thin_film_ior: number, more than 0; 1.4 where it is not given. Index of refraction of the film.

    emission_luminance: number, 0 or more; 0 where it is not given. How bright the surface shines, in cd/m^2; a pixel of value 1 shows 1 cd/m^2.

    emission_color: three numbers; 1 1 1 where it is not given. Colour of its own light, which multiplies `emissionLuminance`.

    emission_spectrum: path. The spectrum of its own light, which `emissionColor` multiplies: an illuminant (A, D50, D55, D65, D75, E, F2, F7, F11), a black body (`2700K`), or a file as for `baseSpectrum`, in any unit. `emissionLuminance` still says how bright it is.

    emission_texture: path. A picture that multiplies `emissionColor`; its values are read as sRGB.

    emission_vertex_colors: `on`, `off`; off where it is not given. `on`: the colours of a mesh's vertices multiply `emissionColor`.

    normal_texture: path. A picture of normals in tangent space, as glTF has it: red and green point along u and v, blue outwards.

    bump_texture: path. A picture of heights, which bends the normals as if the surface rose where it is bright: a bump map.

    bump_height: number; 0.01 where it is not given. How far its white lies above its black, in units of the world; negative where white lies deep.

    normal_bending: `on`, `off`; on where it is not given. `on`: normals of pictures that are turned away from who looks are bent until mirrors show what is outside; `off`: such places are black, as in Mitsuba.

    opacity: number, from 0 to 1; 1 where it is not given. Share of the surface that is there, from 0 to 1: the rest lets light through as if nothing were there.

    opacity_texture: path. A picture that multiplies `opacity`: its alpha where it has one, else red.

    opacity_cutoff: number, 0 or more. All is there whose opacity, by `opacity`, pictures and the alpha of vertices together, is at least this, and nothing of the rest; where it is not given, all is there in part.

    walls: `solid`, `thin`; solid where it is not given. `thin`: a sheet without inside, through which light goes straight; `solid`: the skin of a body.

    backs: `shown`, `hidden`, `black`; shown where it is not given. `shown`: both sides are seen; `hidden`: cameras and lights without extent look through faces that are turned away from them; `black`: such faces scatter no light.
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
    """Hair or fur, for paths: what mirrors light, lets it through and colours it on the way. It is meant for thin tubes, along which the texture coordinate u grows, as curves of other programs become them; from inside they are not seen. `absorption` counts, else `color`, else the melanins.

    eumelanin: number, 0 or more; 1.3 where it is not given. How much of brown and black pigment there is: 0.3 in blond hair, 1.3 in brown, 8 in black.

    pheomelanin: number, 0 or more; 0 where it is not given. How much of yellow and red pigment there is: 1.2 or more in red hair.

    color: three numbers. The colour that many fibres show together, from 0 to 1.

    absorption: three numbers. How much light loses inside for each radius of a fibre, for red, green and blue.

    longitudinal_roughness: number, from 0 to 1; 0.3 where it is not given. How much light spreads along a fibre.

    azimuthal_roughness: number, from 0 to 1; 0.3 where it is not given. How much light spreads around a fibre.

    scale_tilt: number, from -45 to 45; 2 where it is not given. By how many degrees the scales of a fibre rise towards its end.

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
    """Unit cubes of two materials in turn.

    material1: whole number; must be given. The material where the sum of the rounded-down coordinates is even.

    material2: whole number; must be given. The other.
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
    """Two materials mixed by noise.

    material1: whole number; must be given. The material where noise is high.

    material2: whole number; must be given. The material where noise is low.

    octaves: whole number, at most 32; must be given. How many frequencies are summed, each twice the one before.
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
    """Two materials in veins across the x axis.

    material1: whole number; must be given. The material where the sine is 1.

    material2: whole number; must be given. The material where the sine is -1.

    octaves: whole number, at most 32; must be given. How many frequencies of noise are summed, each twice the one before.

    frequency: number; must be given. Veins per 2 pi along x.

    amplitude: number; must be given. How much noise bends the veins.
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
    """Two materials in rings around the y axis.

    material1: whole number; must be given. The material where the sine is 1.

    material2: whole number; must be given. The material where the sine is -1.

    octaves: whole number, at most 32; must be given. How many frequencies of noise are summed, each twice the one before.

    frequency: number; must be given. Rings per 2 pi along the radius.

    amplitude: number; must be given. How much noise bends the rings.
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
    """Two materials in the same proportion everywhere, or as a picture says: each scatters its share of the light.

    material1: whole number; must be given. The first material.

    material2: whole number; must be given. The other.

    share: number, from 0 to 1; 0.5 where it is not given. The share of the first, from 0 to 1.

    share_texture: path. A picture that multiplies `share`.
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
    """A surface whose front has one material and whose back, the side that its normal does not point to, another.

    material1: whole number; must be given. The material of the front.

    material2: whole number; must be given. That of the back.
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
    """A ball.

    center: three numbers; must be given. Its middle.

    radius: number, more than 0; must be given. Its radius.
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
    """A plane without end: all points p with normal · p = offset. As a part of a solid, all that is behind it.

    normal: three numbers, not 0 0 0; must be given. Points to its front; of any length.

    offset: number; must be given. Distance from the origin along the normal, where that has length 1.
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
    """A triangle; its front is where its corners go round counter-clockwise.

    vertex0: three numbers; must be given. First corner.

    vertex1: three numbers; must be given. Second corner.

    vertex2: three numbers; must be given. Third corner.
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

    min: three numbers; must be given. Corner of least coordinates.

    max: three numbers; must be given. Corner of greatest coordinates.
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
    """A cylinder with caps, round about the line between two points.

    base: three numbers; must be given. Middle of the cap at one end.

    top: three numbers; must be given. Middle of the cap at the other end.

    radius: number, more than 0; must be given. Its radius.
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
    """A cone with its cap; or, with a radius at its top too, a frustum with both.

    base: three numbers; must be given. Middle of the cap at the base.

    top: three numbers; must be given. The tip, or the middle of the cap there.

    base_radius: number, 0 or more; must be given. Radius at the base; it may be 0 where that at the top is not.

    top_radius: number, 0 or more; 0 where it is not given. Radius at the top; 0, a tip, where none is given.
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
    """A ring: all points within one distance from a circle.

    center: three numbers; must be given. Middle of the circle.

    axis: three numbers, not 0 0 0; 0 1 0 where it is not given. Direction across the circle's plane, of any length.

    major_radius: number, more than 0; must be given. Radius of the circle.

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
    """A ball stretched along the coordinate axes.

    center: three numbers; must be given. Its middle.

    radii: three numbers; must be given. Half its extent along x, y and z.
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
    """Where A x² + B y² + C z² + D xy + E xz + F yz + G x + H y + I z + J is zero; inside, it is less.

    squares: three numbers; must be given. A, B and C.

    products: three numbers; 0 0 0 where it is not given. D, E and F.

    linear: three numbers; 0 0 0 where it is not given. G, H and I.

    constant: number; must be given. J.
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
    """A flat disc.

    center: three numbers; must be given. Its middle.

    normal: three numbers, not 0 0 0; must be given. Points to its front; of any length.

    radius: number, more than 0; must be given. Its radius.

    inner_radius: number, 0 or more; 0 where it is not given. Radius of the hole in its middle.
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
    """A rectangle; with edges that are not at right angles, a parallelogram. Its front is where `edge0` turns counter-clockwise to `edge1`.

    corner: three numbers; must be given. A corner.

    edge0: three numbers, not 0 0 0; must be given. From there to the next corner.

    edge1: three numbers, not 0 0 0; must be given. From there to the corner before.
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
    """A triangle mesh in a file of its own.

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
    """A block whose top is a landscape: a picture's greys are heights, its lower edge is towards z.

    picture: path; must be given. Path of the picture. Black is lowest, and white, or 1 in pictures of floating point, is highest.

    min: three numbers; must be given. Corner of the landscape's box of least coordinates: where heights are 0.

    max: three numbers; must be given. Corner of the landscape's box of greatest coordinates: where heights are 1.

    depth: number, more than 0; 1 where it is not given. How far the block goes on below `min`.
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
