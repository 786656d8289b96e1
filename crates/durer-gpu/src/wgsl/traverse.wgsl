// Closest hit and occlusion: a tree over the objects, and a tree over the triangles of each mesh.
//
// Loops are bounded by the number of nodes, and stacks by the depth of the trees, which the builder
// limits to MAX_DEPTH.

struct Ray {
    origin: vec3<f32>,
    dir: vec3<f32>,
    t_min: f32,
    t_max: f32,
    // Object and triangle or face on which the ray starts, or NONE.
    object: u32,
    item: u32,
}

struct Hit {
    t: f32,
    uv: vec2<f32>,
    // NONE if nothing was hit.
    object: u32,
    // Number of the triangle in its mesh; 0 for other shapes.
    part: u32,
    // Index of the triangle in its buffer, or number of the face.
    item: u32,
}

fn no_hit(t_max: f32) -> Hit {
    return Hit(t_max, vec2<f32>(0.0), NONE, 0u, 0u);
}

// Hits are ordered by t, then object, then part.
fn offer(best: ptr<function, Hit>, hit: Hit) {
    let b = *best;
    // The interval is open, so a hit at its end does not count.
    let earlier = b.object != NONE && (hit.object < b.object || (hit.object == b.object && hit.part < b.part));
    if hit.t < b.t || (hit.t == b.t && earlier) {
        *best = hit;
    }
}

// Relative error of distances to the planes of a box, doubled.
const BOX_SLACK: f32 = 1e-6f;

fn safe_inverse(x: f32) -> f32 {
    // A tiny component is replaced, because WGSL does not guarantee infinities.
    return 1.0 / select(x, select(1e-18, -1e-18, x < 0.0), abs(x) < 1e-18);
}

// Returns the distance at which a ray enters the box of a node, or FAR if it misses the box.
fn enter_box(node: u32, origin: vec3<f32>, inverse: vec3<f32>, t_min: f32, t_max: f32) -> f32 {
    let low = (nodes[node].min - origin) * inverse;
    let high = (nodes[node].max - origin) * inverse;
    let nearer = min(low, high);
    let farther = max(low, high);
    var near = max(max(nearer.x, nearer.y), nearer.z);
    var far = min(min(farther.x, farther.y), farther.z);
    near -= BOX_SLACK * abs(near);
    far += BOX_SLACK * abs(far);
    return select(FAR, max(near, t_min), max(near, t_min) <= min(far, t_max));
}

fn hit_mesh(number: u32, root: u32, ray: Ray, any: bool, best: ptr<function, Hit>) {
    if root == NONE {
        return;
    }
    let sheared = sheared_ray(ray.origin, ray.dir);
    let inverse = vec3<f32>(safe_inverse(ray.dir.x), safe_inverse(ray.dir.y), safe_inverse(ray.dir.z));
    var stack: array<u32, MAX_DEPTH>;
    var waiting = 0u;
    var at = root;
    if enter_box(root, ray.origin, inverse, ray.t_min, (*best).t) == FAR {
        return;
    }
    loop {
        while at != NONE && nodes[at].count == 0u {
            let first = nodes[at].first;
            let t_0 = enter_box(first, ray.origin, inverse, ray.t_min, (*best).t);
            let t_1 = enter_box(first + 1u, ray.origin, inverse, ray.t_min, (*best).t);
            let near = select(first, first + 1u, t_1 < t_0);
            if min(t_0, t_1) == FAR {
                at = NONE;
                break;
            }
            if max(t_0, t_1) != FAR && waiting < MAX_DEPTH {
                stack[waiting] = 2u * first + 1u - near;
                waiting += 1u;
            }
            at = near;
        }
        if at != NONE {
            let first = nodes[at].first;
            let end = first + nodes[at].count;
            for (var i = first; i < end; i++) {
                if ray.object == number && ray.item == i {
                    continue;
                }
                // Hits at the current distance are still of interest.
                let t_max = (*best).t * (1.0 + 2.0 * ROUNDOFF) + 1e-37;
                let found = cross_triangle(sheared, triangles[i].a, triangles[i].b, triangles[i].c, ray.t_min, t_max);
                if found.is_hit {
                    offer(best, Hit(found.t, found.uv, number, triangles[i].part, i));
                    if any && (*best).object != NONE {
                        return;
                    }
                }
            }
        }
        if waiting == 0u {
            return;
        }
        waiting -= 1u;
        at = stack[waiting];
    }
}

// Returns the ray in object space.
fn object_ray(number: u32, ray: Ray) -> Ray {
    var local = ray;
    if (objects[number].flags & TRANSFORMED) != 0u {
        let x = objects[number].inverse_x;
        let y = objects[number].inverse_y;
        let z = objects[number].inverse_z;
        local.origin = map_point(x, y, z, ray.origin);
        local.dir = map_vector(x, y, z, ray.dir);
    }
    return local;
}

fn hit_object(number: u32, ray: Ray, any: bool, best: ptr<function, Hit>) {
    let local = object_ray(number, ray);
    let kind = objects[number].kind;
    if kind == MESH {
        hit_mesh(number, objects[number].root, local, any, best);
        return;
    }
    let s0 = objects[number].shape_0;
    let s1 = objects[number].shape_1;
    let s2 = objects[number].shape_2;
    let starts_here = ray.object == number;
    let face = select(NONE, ray.item, starts_here);
    let o = local.origin;
    let d = local.dir;
    let t_min = ray.t_min;
    let t_max = (*best).t * (1.0 + 2.0 * ROUNDOFF) + 1e-37;
    var found = no_shape_hit();
    switch kind {
        case SPHERE: { found = hit_sphere(o, d, s0, starts_here, t_min, t_max); }
        case PLANE: { found = hit_plane(o, d, s0, starts_here, t_min, t_max); }
        case CUBOID: { found = hit_cuboid(o, d, s0.xyz, s1.xyz, face, t_min, t_max); }
        case DISC: { found = hit_disc(o, d, s0, s1, starts_here, t_min, t_max); }
        case RECTANGLE: { found = hit_rectangle(o, d, s0.xyz, s1.xyz, s2.xyz, starts_here, t_min, t_max); }
        case FRUSTUM: { found = hit_frustum(o, d, s0.x, face, t_min, t_max); }
        default: {}
    }
    if found.is_hit {
        offer(best, Hit(found.t, found.uv, number, 0u, found.face));
    }
}

// Returns the first hit in the ray's interval or, with `any`, some hit. The objects without bounds
// are tested first, and then those in the tree. The loop tests objects at one place only, because
// compilers copy the called functions to each place.
fn find_hit(ray: Ray, any: bool) -> Hit {
    traced_rays += 1u;
    var best = no_hit(ray.t_max);
    let inverse = vec3<f32>(safe_inverse(ray.dir.x), safe_inverse(ray.dir.y), safe_inverse(ray.dir.z));
    var stack: array<u32, MAX_DEPTH>;
    var waiting = 0u;
    var object = params.first_unbounded;
    var in_tree = false;
    loop {
        if object != NONE {
            hit_object(object, ray, any, &best);
            if any && best.object != NONE {
                return best;
            }
            object = select(objects[object].next_unbounded, NONE, in_tree);
            continue;
        }
        // Take the next node, which is the root at first.
        var at = params.root;
        if in_tree {
            if waiting == 0u {
                return best;
            }
            waiting -= 1u;
            at = stack[waiting];
        } else if at == NONE || enter_box(at, ray.origin, inverse, ray.t_min, best.t) == FAR {
            return best;
        }
        in_tree = true;
        // Descend to the nearest leaf, which holds one object.
        while nodes[at].count == 0u {
            let first = nodes[at].first;
            let t_0 = enter_box(first, ray.origin, inverse, ray.t_min, best.t);
            let t_1 = enter_box(first + 1u, ray.origin, inverse, ray.t_min, best.t);
            let near = select(first, first + 1u, t_1 < t_0);
            if min(t_0, t_1) == FAR {
                at = NONE;
                break;
            }
            if max(t_0, t_1) != FAR && waiting < MAX_DEPTH {
                stack[waiting] = 2u * first + 1u - near;
                waiting += 1u;
            }
            at = near;
        }
        if at != NONE {
            object = nodes[at].first;
        }
    }
    return best;
}
