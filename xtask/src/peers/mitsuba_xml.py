"""Writes Mitsuba scenes: each function returns the XML of one plugin.

    shape("sphere", bsdf("diffuse", reflectance=(0.2, 0.5, 0.8)), radius=0.5)

Keywords become properties with the type of their value: a tuple is a colour, and an instance of
`Point` is a point. Positional arguments are nested plugins.
"""

EYE, TARGET = (0, 1.3, 4.2), (0, 0.45, 0)
WIDTH, HEIGHT = 64, 48


class Point(tuple):
    """A point or a vector, in contrast to a tuple, which is a colour."""


def words(values):
    return ", ".join(f"{v:.9g}" for v in values)


def value(name, x):
    match x:
        case bool():
            return f'<boolean name="{name}" value="{str(x).lower()}"/>'
        case int():
            return f'<integer name="{name}" value="{x}"/>'
        case float():
            return f'<float name="{name}" value="{x:.9g}"/>'
        case Point():
            return f'<point name="{name}" value="{words(x)}"/>'
        case tuple():
            return f'<rgb name="{name}" value="{words(x)}"/>'
        case str() if x.startswith("<"):
            # A nested plugin gets the name of the property.
            tag, rest = x[1:].split(maxsplit=1)
            return f'<{tag} name="{name}" {rest}'
    return f'<string name="{name}" value="{x}"/>'


def plugin(tag, kind, *parts, **properties):
    inside = "".join(parts) + "".join(value(name.rstrip("_"), x) for name, x in properties.items() if x is not None)
    return f'<{tag} type="{kind}">{inside}</{tag}>'


def of(tag):
    return lambda kind, *parts, **properties: plugin(tag, kind, *parts, **properties)


shape, bsdf, emitter, texture, medium, phase, volume, spectrum, film, sampler = map(
    of, "shape bsdf emitter texture medium phase volume spectrum film sampler".split())


def transform(*steps, name="to_world"):
    """Returns a transform of steps such as `("translate", (1, 2, 3))` or `("rotate", (0, 1, 0), 90)`."""
    def step(kind, *values):
        match kind:
            case "matrix":
                return f'<matrix value="{words(values[0])}"/>'
            case "lookat":
                origin, target, *up = map(words, values)
                return f'<lookat origin="{origin}" target="{target}" up="{up[0] if up else "0, 1, 0"}"/>'
            case "rotate":
                x, y, z = values[0]
                return f'<rotate x="{x}" y="{y}" z="{z}" angle="{values[1]}"/>'
        return f'<{kind} value="{words(values[0])}"/>'
    return f'<transform name="{name}">{"".join(step(*each) for each in steps)}</transform>'


def bitmap(file, *parts, **properties):
    return texture("bitmap", *parts, filename=file, **properties)


def diffuse(*color):
    return bsdf("diffuse", reflectance=color if len(color) == 3 else color * 3)


def constant(*color):
    return emitter("constant", radiance=color if len(color) == 3 else color * 3)


def area(*color):
    return emitter("area", radiance=color if len(color) == 3 else color * 3)


def rectangle(*parts, at=(0, 0, 0), size=(1, 1), turn=(), **properties):
    """Returns a rectangle that faces +z before the turns."""
    steps = [("scale", (*size, 1)), *turn, ("translate", at)]
    return shape("rectangle", transform(*steps), *parts, **properties)


DOWN, UP = ("rotate", (1, 0, 0), 90), ("rotate", (1, 0, 0), -90)


def floor(material=None):
    return rectangle(material or diffuse(0.4, 0.35, 0.3), size=(4, 4), turn=[UP])


def lamp(*color, at=(0.3, 2.6, 0.8), size=(0.7, 0.7)):
    """Returns a square light that faces down."""
    return rectangle(area(*(color or (6, 5.5, 5))), size=size, turn=[DOWN], at=at)


def ball(*parts, x=0.0, y=0.6, z=0.0, radius=0.6, **properties):
    return shape("sphere", *parts, center=Point((x, y, z)), radius=float(radius), **properties)


def two_balls(first, second):
    return ball(first, x=-0.75) + ball(second, x=0.75)


def sensor(*parts, kind="perspective", origin=EYE, target=TARGET, film_parts="", fov=38.0, to_world=None, **properties):
    whole = film("hdrfilm", plugin("rfilter", "box"), film_parts, width=WIDTH, height=HEIGHT, pixel_format="rgb")
    if kind in ("perspective", "thinlens"):
        properties |= {"fov": fov}
    return plugin("sensor", kind, to_world or transform(("lookat", origin, target)), whole, *parts, **properties)


def integrator(kind="path", max_depth=8, **properties):
    return plugin("integrator", kind, max_depth=max_depth, rr_depth=1000, **properties)


def document(*parts):
    return f'<scene version="3.0.0">{"".join(parts)}</scene>\n'
