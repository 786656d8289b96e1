// Surface points at hits, with bounds on their rounding errors, and rays that start there.
//
// Source of the bounds: Physically Based Rendering, 4th edition, section 6.8.

struct Surface {
    position: vec3<f32>,
    // Bound on the error of the position along each axis.
    error: vec3<f32>,
    n_geo: vec3<f32>,
    n_shade: vec3<f32>,
    // Offsets to the curved surface that a triangle with normals approximates, for shadow rays; see
    // `durer-scene/src/shape/triangle.rs`.
    offset_front: vec3<f32>,
    offset_back: vec3<f32>,
    object: u32,
    item: u32,
    material: u32,
}

// Distance that points keep from the edges of a triangle, in units of their error.
const INSET: f32 = 16.0;

// Returns barycentric coordinates at least INSET errors away from all edges.
fn inset_weights(a: vec3<f32>, b: vec3<f32>, c: vec3<f32>, weights: vec3<f32>, error: vec3<f32>) -> vec3<f32> {
    let n = cross(b - a, c - a);
    let area2 = dot(n, n);
    let sides = vec3<f32>(dot(c - b, c - b), dot(a - c, a - c), dot(b - a, b - a));
    let least = sides * (INSET * INSET * dot(error, error));
    if !(area2 > 0.0) || !any(area2 * weights * weights < least) {
        return weights;
    }
    let moved = max(weights, min(sqrt(least / area2), vec3<f32>(0.25)));
    return moved / (moved.x + moved.y + moved.z);
}

// Adds the offsets from a point on a triangle to the tangent plane at one corner.
fn add_corner_offset(surface: ptr<function, Surface>, corner: vec3<f32>, n: vec3<f32>, weight: f32) {
    let height = dot(corner - (*surface).position, n);
    if height < 0.0 {
        (*surface).offset_back += weight * height * n;
    } else {
        (*surface).offset_front += weight * height * n;
    }
}

fn triangle_surface(hit: Hit) -> Surface {
    let triangle = triangles[hit.item];
    let a = triangle.a;
    let b = triangle.b;
    let c = triangle.c;
    var weights = vec3<f32>(1.0 - hit.uv.x - hit.uv.y, hit.uv.x, hit.uv.y);
    let error = gamma(8.0) * (abs(weights.x * a) + abs(weights.y * b) + abs(weights.z * c));
    let inner = inset_weights(a, b, c, weights, error);
    let zero = vec3<f32>(0.0);
    let n_geo = unit_or(cross(b - a, c - a), vec3<f32>(0.0, 1.0, 0.0));
    let position = inner.x * a + inner.y * b + inner.z * c;
    var surface = Surface(position, error, n_geo, n_geo, zero, zero, hit.object, hit.item, 0u);
    if triangle.smooth_normals != 0u {
        let n = weights.x * triangle.normal_a + weights.y * triangle.normal_b + weights.z * triangle.normal_c;
        surface.n_shade = unit_or(n, n_geo);
        add_corner_offset(&surface, a, triangle.normal_a, weights.x);
        add_corner_offset(&surface, b, triangle.normal_b, weights.y);
        add_corner_offset(&surface, c, triangle.normal_c, weights.z);
    }
    // The stored normals define the outside, regardless of the order of the corners.
    if dot(n_geo, surface.n_shade) < 0.0 {
        surface.n_geo = -n_geo;
    }
    return surface;
}

// Returns the surface of a shape other than a triangle, near the point p.
fn shape_surface(hit: Hit, p: vec3<f32>) -> Surface {
    let s0 = objects[hit.object].shape_0;
    let s1 = objects[hit.object].shape_1;
    let s2 = objects[hit.object].shape_2;
    var position = p;
    var n = vec3<f32>(0.0, 1.0, 0.0);
    var error = gamma(4.0) * abs(p);
    switch objects[hit.object].kind {
        case SPHERE: {
            n = unit_or(p - s0.xyz, vec3<f32>(0.0, 0.0, 1.0));
            position = s0.xyz + s0.w * n;
            error = gamma(6.0) * (abs(s0.xyz) + s0.w * abs(n));
        }
        case PLANE: {
            position = p - s0.xyz * ((dot(s0.xyz, p) - s0.w) / dot(s0.xyz, s0.xyz));
            n = unit_or(s0.xyz, n);
            error = gamma(8.0) * abs(position);
        }
        case CUBOID: {
            let axis = hit.item / 2u;
            let is_high = hit.item % 2u == 1u;
            let size = max_component(max(abs(s0.xyz), abs(s1.xyz)));
            let margin = min(vec3<f32>(INSET * gamma(2.0) * size), 0.25 * (s1.xyz - s0.xyz));
            position = clamp(p, s0.xyz + margin, s1.xyz - margin);
            position[axis] = select(s0[axis], s1[axis], is_high);
            n = vec3<f32>(0.0);
            n[axis] = select(-1.0, 1.0, is_high);
            error = gamma(2.0) * abs(position);
        }
        case DISC: {
            n = s1.xyz;
            let q = p - s0.xyz;
            position = s0.xyz + (q - dot(n, q) * n);
            error = gamma(8.0) * (abs(s0.xyz) + s0.w);
        }
        case RECTANGLE: {
            n = unit_or(cross(s1.xyz, s2.xyz), n);
            let size = max_component(abs(s0.xyz) + abs(s1.xyz) + abs(s2.xyz));
            let margin = min(INSET * gamma(2.0) * size / vec2<f32>(length(s1.xyz), length(s2.xyz)), vec2<f32>(0.25));
            let uv = clamp(hit.uv, margin, 1.0 - margin);
            position = s0.xyz + uv.x * s1.xyz + uv.y * s2.xyz;
            error = gamma(6.0) * (abs(s0.xyz) + abs(s1.xyz) + abs(s2.xyz));
        }
        case FRUSTUM: {
            if hit.item == SIDE_FACE {
                let around = unit_or(vec3<f32>(p.xy, 0.0), vec3<f32>(1.0, 0.0, 0.0));
                let z = clamp(p.z, 1e-5, 1.0 - 1e-5);
                position = vec3<f32>((1.0 + (s0.x - 1.0) * z) * around.xy, z);
                n = unit_or(vec3<f32>(around.xy, 1.0 - s0.x), around);
            } else {
                let is_top = hit.item == TOP_FACE;
                position = vec3<f32>(p.xy, select(0.0, 1.0, is_top));
                n = vec3<f32>(0.0, 0.0, select(-1.0, 1.0, is_top));
            }
            error = vec3<f32>(gamma(8.0));
        }
        default: {}
    }
    let zero = vec3<f32>(0.0);
    return Surface(position, error, n, n, zero, zero, hit.object, hit.item, 0u);
}

// Returns the surface at a hit, in world space.
fn surface_at(ray: Ray, hit: Hit) -> Surface {
    var surface: Surface;
    if objects[hit.object].kind == MESH {
        surface = triangle_surface(hit);
    } else {
        let local = object_ray(hit.object, ray);
        surface = shape_surface(hit, local.origin + hit.t * local.dir);
    }
    surface.material = objects[hit.object].material;
    if (objects[hit.object].flags & TRANSFORMED) == 0u {
        return surface;
    }
    let x = objects[hit.object].forward_x;
    let y = objects[hit.object].forward_y;
    let z = objects[hit.object].forward_z;
    let size = map_vector(abs(x), abs(y), abs(z), abs(surface.position)) + abs(vec3<f32>(x.w, y.w, z.w));
    surface.error = map_vector(abs(x), abs(y), abs(z), surface.error) * (1.0 + gamma(4.0)) + gamma(5.0) * size;
    surface.position = map_point(x, y, z, surface.position);
    surface.offset_front = map_vector(x, y, z, surface.offset_front);
    surface.offset_back = map_vector(x, y, z, surface.offset_back);
    // Normals are transformed by the inverse transpose.
    let ix = objects[hit.object].inverse_x;
    let iy = objects[hit.object].inverse_y;
    let iz = objects[hit.object].inverse_z;
    surface.n_geo = unit_or(map_transposed(ix, iy, iz, surface.n_geo), surface.n_geo);
    surface.n_shade = unit_or(map_transposed(ix, iy, iz, surface.n_shade), surface.n_shade);
    return surface;
}

// Returns the point from which rays leave a surface on the side of the unit normal `side`.
fn spawn_origin(surface: Surface, lift: vec3<f32>, side: vec3<f32>) -> vec3<f32> {
    let p = surface.position + lift;
    let distance = 2.0 * dot(abs(side), surface.error + gamma(2.0) * (abs(lift) + abs(p)));
    return p + distance * side;
}

// Returns a ray that starts on a surface, on the side to which it leads.
fn spawn_ray(surface: Surface, dir: vec3<f32>, t_max: f32) -> Ray {
    let side = select(surface.n_geo, -surface.n_geo, dot(dir, surface.n_geo) < 0.0);
    let origin = spawn_origin(surface, vec3<f32>(0.0), side);
    return Ray(origin, dir, 0.0, t_max, surface.object, surface.item);
}

// Returns a shadow ray that starts on the curved surface, on the side of the geometric normal or, if
// `behind`, on the other side.
fn curved_ray(surface: Surface, dir: vec3<f32>, distance: f32, behind: bool) -> Ray {
    let lift = select(surface.offset_front, surface.offset_back, behind);
    let side = select(surface.n_geo, -surface.n_geo, behind);
    // A ray that leads through its own triangle is blocked by it, so the triangle is not skipped.
    let through = dot(dir, side) < 0.0;
    let item = select(surface.item, NONE, through);
    return Ray(spawn_origin(surface, lift, side), dir, 0.0, distance - dot(lift, dir), surface.object, item);
}

// Returns the shadow ray to a light at a distance; see `to_light` in `integrator/spawn.rs`.
fn light_ray(surface: Surface, dir: vec3<f32>, distance: f32) -> Ray {
    return curved_ray(surface, dir, distance, dot(dir, surface.n_shade) < 0.0);
}

// Returns the shadow ray to a point on a surface. A ray that starts on a curved surface is aimed at
// the point again.
fn point_ray(surface: Surface, dir: vec3<f32>, distance: f32) -> Ray {
    let ray = curved_ray(surface, dir, distance, dot(dir, surface.n_geo) < 0.0);
    let is_flat = is_black(surface.offset_front) && is_black(surface.offset_back);
    if is_flat || distance >= FAR {
        return ray;
    }
    let to = surface.position + distance * dir - ray.origin;
    let reach = length(to);
    return Ray(ray.origin, to / reach, 0.0, reach * (1.0 - gamma(4.0)), ray.object, ray.item);
}
