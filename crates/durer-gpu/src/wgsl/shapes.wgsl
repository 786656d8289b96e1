// Intersection of rays with shapes other than triangles, in object space.
//
// A ray that starts on a flat face never hits that face. A ray that starts on a closed convex shape
// hits nothing of it if it leads outwards, and the far crossing if it leads inwards. Rounding errors
// of the origin therefore cannot produce a hit at the start.
//
// | shape | shape_0 | shape_1 | shape_2 |
// | --- | --- | --- | --- |
// | SPHERE | centre, radius | | |
// | PLANE | normal, offset | | |
// | CUBOID | smallest corner | largest corner | |
// | DISC | centre, radius | unit normal, inner radius | |
// | RECTANGLE | corner | first edge | second edge |
// | FRUSTUM | radius at the top | | |

struct ShapeHit {
    is_hit: bool,
    t: f32,
    uv: vec2<f32>,
    // Number of the face.
    face: u32,
}

fn no_shape_hit() -> ShapeHit {
    return ShapeHit(false, FAR, vec2<f32>(0.0), 0u);
}

// Returns the first of two crossings of a closed convex shape that lies in the open interval.
// `leaving` is true if the ray starts on the shape and leads inwards.
fn first_of(t: vec2<f32>, faces: vec2<u32>, leaving: bool, t_min: f32, t_max: f32) -> ShapeHit {
    if !leaving && t.x > t_min && t.x < t_max {
        return ShapeHit(true, t.x, vec2<f32>(0.0), faces.x);
    }
    if t.y > t_min && t.y < t_max {
        return ShapeHit(true, t.y, vec2<f32>(0.0), faces.y);
    }
    return no_shape_hit();
}

// The discriminant is computed from the point of the ray that is nearest to the centre (Haines,
// Günther, Akenine-Möller, Precision Improvements for Ray/Sphere Intersection, Ray Tracing Gems,
// chapter 7).
fn hit_sphere(o: vec3<f32>, d: vec3<f32>, shape: vec4<f32>, starts_here: bool, t_min: f32, t_max: f32) -> ShapeHit {
    let from_center = o - shape.xyz;
    let r = shape.w;
    let dd = dot(d, d);
    let b = -dot(from_center, d);
    let nearest = from_center + (b / dd) * d;
    let distance = length(nearest);
    let discriminant = (r - distance) * (r + distance);
    if starts_here && b <= 0.0 {
        return no_shape_hit();
    }
    if !(discriminant >= 0.0) {
        return no_shape_hit();
    }
    // q has the sign of b, so that neither root suffers from cancellation.
    let root = sqrt(dd * discriminant);
    let q = b + select(root, -root, b < 0.0);
    let outside = length(from_center);
    let c = (outside - r) * (outside + r);
    var t = vec2<f32>(0.0);
    if q != 0.0 {
        t = vec2<f32>(c / q, q / dd);
    }
    if t.x > t.y {
        t = t.yx;
    }
    return first_of(t, vec2<u32>(0u), starts_here, t_min, t_max);
}

fn hit_plane(o: vec3<f32>, d: vec3<f32>, shape: vec4<f32>, starts_here: bool, t_min: f32, t_max: f32) -> ShapeHit {
    let slope = dot(shape.xyz, d);
    if starts_here || slope == 0.0 {
        return no_shape_hit();
    }
    let t = (shape.w - dot(shape.xyz, o)) / slope;
    if !(t > t_min && t < t_max) {
        return no_shape_hit();
    }
    return ShapeHit(true, t, vec2<f32>(0.0), 0u);
}

// Face 2 i lies at the smallest coordinate of axis i, face 2 i + 1 at the largest.
fn hit_cuboid(
    o: vec3<f32>,
    d: vec3<f32>,
    low: vec3<f32>,
    high: vec3<f32>,
    from_face: u32,
    t_min: f32,
    t_max: f32,
) -> ShapeHit {
    var near = -FAR;
    var far = FAR;
    var faces = vec2<u32>(0u);
    for (var axis = 0u; axis < 3u; axis++) {
        if d[axis] == 0.0 {
            if o[axis] < low[axis] || o[axis] > high[axis] {
                return no_shape_hit();
            }
            continue;
        }
        let backwards = d[axis] < 0.0;
        let first = (select(low[axis], high[axis], backwards) - o[axis]) / d[axis];
        let second = (select(high[axis], low[axis], backwards) - o[axis]) / d[axis];
        let lower_face = 2u * axis;
        if first > near {
            near = first;
            faces.x = select(lower_face, lower_face + 1u, backwards);
        }
        if second < far {
            far = second;
            faces.y = select(lower_face + 1u, lower_face, backwards);
        }
    }
    let starts_here = from_face != NONE;
    if starts_here {
        let outward = select(-d[from_face / 2u], d[from_face / 2u], from_face % 2u == 1u);
        if outward >= 0.0 {
            return no_shape_hit();
        }
    } else if !(near < far) {
        return no_shape_hit();
    }
    return first_of(vec2<f32>(near, far), faces, starts_here, t_min, t_max);
}

fn hit_disc(
    o: vec3<f32>,
    d: vec3<f32>,
    disc: vec4<f32>,
    normal: vec4<f32>,
    starts_here: bool,
    t_min: f32,
    t_max: f32,
) -> ShapeHit {
    let slope = dot(normal.xyz, d);
    if starts_here || slope == 0.0 {
        return no_shape_hit();
    }
    let from_center = o - disc.xyz;
    let t = -dot(normal.xyz, from_center) / slope;
    if !(t > t_min && t < t_max) {
        return no_shape_hit();
    }
    let distance = length(from_center + t * d);
    if distance > disc.w || distance < normal.w {
        return no_shape_hit();
    }
    return ShapeHit(true, t, vec2<f32>(0.0), 0u);
}

// Coordinates outside [0, 1] by less than their rounding error count as on the rectangle, so that
// no ray passes between two rectangles with a common edge.
fn hit_rectangle(
    o: vec3<f32>,
    d: vec3<f32>,
    corner: vec3<f32>,
    e: vec3<f32>,
    f: vec3<f32>,
    starts_here: bool,
    t_min: f32,
    t_max: f32,
) -> ShapeHit {
    let n = cross(e, f);
    let slope = dot(n, d);
    if starts_here || slope == 0.0 {
        return no_shape_hit();
    }
    let from_corner = o - corner;
    let t = -dot(n, from_corner) / slope;
    if !(t > t_min && t < t_max) {
        return no_shape_hit();
    }
    let q = from_corner + t * d;
    let uv = vec2<f32>(dot(cross(q, f), n), dot(cross(e, q), n)) / dot(n, n);
    let reach = max_component(abs(from_corner) + abs(corner) + abs(t * d));
    let slack = 8.0 * ROUNDOFF * reach / vec2<f32>(length(e), length(f));
    if any(uv < -slack) || any(uv > 1.0 + slack) {
        return no_shape_hit();
    }
    return ShapeHit(true, t, uv, 0u);
}

// Cone along z from 0 to 1 whose radius falls from 1 to `top`. The chord is the part of the line
// between the two planes and inside the cone |(x, y)|^2 = (1 + (top - 1) z)^2, whose other nappe has
// a negative radius.
fn hit_frustum(o: vec3<f32>, d: vec3<f32>, top: f32, from_face: u32, t_min: f32, t_max: f32) -> ShapeHit {
    // Distances are measured from the point nearest to the middle of the axis.
    let dd = dot(d, d);
    let shift = dot(vec3<f32>(0.0, 0.0, 0.5) - o, d) / dd;
    let p = o + shift * d;
    let growth = top - 1.0;
    var near = -FAR;
    var far = FAR;
    var faces = vec2<u32>(0u);
    if d.z != 0.0 {
        let planes = vec2<f32>(-p.z, 1.0 - p.z) / d.z;
        near = min(planes.x, planes.y);
        far = max(planes.x, planes.y);
        faces = select(vec2<u32>(TOP_FACE, BASE_FACE), vec2<u32>(BASE_FACE, TOP_FACE), d.z > 0.0);
    } else if p.z < 0.0 || p.z > 1.0 {
        return no_shape_hit();
    }
    let r = 1.0 + growth * p.z;
    let dr = growth * d.z;
    let a = dot(d.xy, d.xy) - dr * dr;
    let b = dot(p.xy, d.xy) - r * dr;
    let c = dot(p.xy, p.xy) - r * r;
    let discriminant = b * b - a * c;
    if abs(a) <= 1e-7 * dd {
        // The line is parallel to the side or, if b is 0 too, to the axis.
        if abs(b) <= 1e-7 * sqrt(dd) {
            if c > 0.0 {
                return no_shape_hit();
            }
        } else if b > 0.0 {
            let cut = -0.5 * c / b;
            if cut < far {
                far = cut;
                faces.y = SIDE_FACE;
            }
        } else {
            let cut = -0.5 * c / b;
            if cut > near {
                near = cut;
                faces.x = SIDE_FACE;
            }
        }
    } else if discriminant < 0.0 {
        if a > 0.0 {
            return no_shape_hit();
        }
    } else {
        let q = -(b + select(sqrt(discriminant), -sqrt(discriminant), b < 0.0));
        var roots = vec2<f32>(0.0);
        if q != 0.0 {
            roots = vec2<f32>(q / a, c / q);
        }
        if roots.x > roots.y {
            roots = roots.yx;
        }
        if a > 0.0 {
            if roots.x > near {
                near = roots.x;
                faces.x = SIDE_FACE;
            }
            if roots.y < far {
                far = roots.y;
                faces.y = SIDE_FACE;
            }
        } else if dr > 0.0 {
            if roots.y > near {
                near = roots.y;
                faces.x = SIDE_FACE;
            }
        } else if roots.x < far {
            far = roots.x;
            faces.y = SIDE_FACE;
        }
    }
    let starts_here = from_face != NONE;
    if starts_here {
        var outward = d.z;
        if from_face == BASE_FACE {
            outward = -d.z;
        } else if from_face == SIDE_FACE {
            outward = dot(unit_or(vec3<f32>(o.xy, 0.0), vec3<f32>(1.0, 0.0, 0.0)), d) - growth * d.z;
        }
        if outward >= 0.0 {
            return no_shape_hit();
        }
    } else if !(near < far) {
        return no_shape_hit();
    }
    return first_of(vec2<f32>(near, far) + shift, faces, starts_here, t_min, t_max);
}
