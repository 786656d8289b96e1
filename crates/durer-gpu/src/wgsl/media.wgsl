// Transparent objects that contain a ray, for refraction; see `integrator/media.rs`.

struct Media {
    count: u32,
    objects: array<u32, MAX_MEDIA>,
    iors: array<f32, MAX_MEDIA>,
}

struct Transition {
    ior_front: f32,
    ior_behind: f32,
    behind: Media,
    // True if the surface is inside an object that displaces its own object.
    displaced: bool,
}

fn air() -> Media {
    var media: Media;
    media.count = 0u;
    return media;
}

fn media_ior(media: Media) -> f32 {
    var m = media;
    if m.count == 0u {
        return 1.0;
    }
    return m.iors[m.count - 1u];
}

fn media_object(media: Media) -> u32 {
    var m = media;
    if m.count == 0u {
        return NONE;
    }
    return m.objects[m.count - 1u];
}

fn media_contains(media: Media, object: u32) -> bool {
    var m = media;
    for (var i = 0u; i < m.count; i++) {
        if m.objects[i] == object {
            return true;
        }
    }
    return false;
}

// Returns true if object `a` displaces `b` where they overlap: the smaller of two closed objects, or
// else the one that the ray entered later.
fn displaces(a: u32, b: u32, met_later: bool) -> bool {
    let size_a = objects[a].size;
    let size_b = objects[b].size;
    if size_a < 0.0 || size_b < 0.0 {
        return met_later;
    }
    return size_a < size_b || (size_a == size_b && a > b);
}

// Returns the list after a ray enters an object.
fn media_with(media: Media, object: u32, ior: f32) -> Media {
    var m = media;
    if m.count == MAX_MEDIA {
        result_flags |= TOO_MANY_MEDIA;
        return m;
    }
    var place = m.count;
    while place > 0u && !displaces(object, m.objects[place - 1u], true) {
        m.objects[place] = m.objects[place - 1u];
        m.iors[place] = m.iors[place - 1u];
        place -= 1u;
    }
    m.objects[place] = object;
    m.iors[place] = ior;
    m.count += 1u;
    return m;
}

// Returns the list after a ray leaves an object, which was entered last.
fn media_without(media: Media, object: u32) -> Media {
    var m = media;
    var place = m.count;
    while place > 0u && m.objects[place - 1u] != object {
        place -= 1u;
    }
    if place == 0u {
        return m;
    }
    for (var i = place; i < m.count; i++) {
        m.objects[i - 1u] = m.objects[i];
        m.iors[i - 1u] = m.iors[i];
    }
    m.count -= 1u;
    return m;
}

// Returns true if the object is a closed shape, other than a mesh, that contains a point.
fn contains_point(object: u32, point: vec3<f32>) -> bool {
    let here = Ray(point, vec3<f32>(0.0), 0.0, 0.0, NONE, NONE);
    let p = object_ray(object, here).origin;
    let s0 = objects[object].shape_0;
    let s1 = objects[object].shape_1;
    switch objects[object].kind {
        case SPHERE: { return length(p - s0.xyz) < s0.w; }
        case PLANE: { return dot(s0.xyz, p) < s0.w; }
        case CUBOID: { return all(p > s0.xyz) && all(p < s1.xyz); }
        case FRUSTUM: { return p.z > 0.0 && p.z < 1.0 && length(p.xy) < 1.0 + (s0.x - 1.0) * p.z; }
        default: { return false; }
    }
}

// Returns the change of media at the surface of an object with index of refraction `ior`, for a ray
// that starts at `start`.
fn transition_into(media: Media, object: u32, start: vec3<f32>, ior: f32, leaving: bool) -> Transition {
    if !leaving {
        let behind = media_with(media, object, ior);
        let before = media_object(media);
        let displaced = media.count > 0u && media_object(behind) == before && before != object;
        return Transition(media_ior(media), media_ior(behind), behind, displaced);
    }
    var inside = media;
    if !media_contains(media, object) {
        if objects[object].size < 0.0 {
            inside = media_with(media, object, ior);
        } else if contains_point(object, start) {
            // The ray leaves an object that it never entered, so it must have started inside.
            inside = media_with(air(), object, ior);
        } else {
            // The surface is the wall of a cavity in the surrounding medium.
            var behind = air();
            if media.count > 0u {
                behind = media_without(media, media_object(media));
            }
            let front = select(media_ior(media), ior, media.count == 0u);
            return Transition(front, media_ior(behind), behind, false);
        }
    }
    let behind = media_without(inside, object);
    return Transition(media_ior(inside), media_ior(behind), behind, media_object(inside) != object);
}

// Refracts a direction by Snell's law. `n` is on the side of the ray, and `eta` is the index in
// front divided by the index behind. The last component is 0 for total internal reflection.
fn refract_ray(d: vec3<f32>, n: vec3<f32>, eta: f32) -> vec4<f32> {
    let cosine = dot(d, n);
    let radicand = 1.0 - eta * eta * (1.0 - cosine * cosine);
    if !(radicand >= 0.0) {
        return vec4<f32>(0.0);
    }
    return vec4<f32>(eta * (d - cosine * n) - sqrt(radicand) * n, 1.0);
}
