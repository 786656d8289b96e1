// Whitted ray tracing: direct light, and a reflected and a transmitted ray per hit, with the
// formulas of `integrator/whitted`.

// Ray that waits to be traced.
struct Segment {
    ray: Ray,
    // Product of the weights of the rays since the camera, by channel.
    throughput: vec3<f32>,
    // Product of the largest components of these weights.
    weight: f32,
    bounces: u32,
    media: Media,
}

// Returns x to the power of `exponent`, where x may be 0 or negative.
fn highlight_power(x: f32, exponent: f32) -> f32 {
    if exponent == 0.0 {
        return 1.0;
    }
    return select(0.0, pow(x, exponent), x > 0.0);
}

// Returns the light that a point scatters from one light, without occlusion.
fn scattered(part: Part, n: vec3<f32>, view: vec3<f32>, light: Arriving) -> vec3<f32> {
    let m = materials[part.material];
    let cosine = dot(n, light.to_light);
    var reflected = max(cosine, 0.0) * part.diffuse;
    let shines = cosine > 0.0 || (m.flags & HIGHLIGHT_BEHIND) != 0u;
    if (m.flags & HIGHLIGHT) != 0u && shines {
        var base = dot(n, unit_or(light.to_light - view, vec3<f32>(0.0)));
        if (m.flags & PHONG_HIGHLIGHT) != 0u {
            base = dot(view - 2.0 * dot(view, n) * n, light.to_light);
        }
        reflected += highlight_power(base, m.exponent) * m.specular;
    }
    return reflected * light.color;
}

// Returns the visible share of a light: 0 if something blocks the shadow ray or, with coloured
// shadows, the transmittance of the transparent objects along it.
fn visibility(shadow: Ray) -> vec3<f32> {
    var share = vec3<f32>(1.0);
    if !has_flag(SHADOWS) {
        return share;
    }
    let is_colored = has_flag(TRANSPARENT_SHADOWS);
    var ray = shadow;
    for (var layer = 0u; layer < MAX_LAYERS; layer++) {
        let hit = find_hit(ray, !is_colored);
        if hit.object == NONE {
            return share;
        }
        if !is_colored {
            break;
        }
        let surface = surface_at(ray, hit);
        let parts = parts_at(surface.material, surface.position, dot(ray.dir, surface.n_geo) > 0.0);
        share *= specular_blend(parts).transparent;
        if is_black(share) {
            break;
        }
        ray = spawn_ray(surface, ray.dir, ray.t_max - hit.t);
    }
    return vec3<f32>(0.0);
}

// Returns the ambient and direct light that a point scatters towards the ray's origin.
fn local_light(surface: Surface, parts: Parts, n: vec3<f32>, view: vec3<f32>) -> vec3<f32> {
    var color = vec3<f32>(0.0);
    for (var i = 0u; i < parts.count; i++) {
        let m = parts.items[i].material;
        let has_own = (materials[m].flags & OWN_AMBIENT) != 0u;
        let reflectance = select(parts.items[i].diffuse, materials[m].ambient, has_own);
        color += parts.items[i].share * params.ambient * reflectance;
    }
    for (var number = 0u; number < params.light_count; number++) {
        let light = illuminate(number, surface.position);
        var sum = vec3<f32>(0.0);
        for (var i = 0u; i < parts.count; i++) {
            sum += parts.items[i].share * scattered(parts.items[i], n, view, light);
        }
        if is_black(sum) {
            continue;
        }
        let reach = select(light.distance * (1.0 - gamma(16.0)), FAR, light.distance >= FAR);
        color += visibility(light_ray(surface, light.to_light, reach)) * sum;
    }
    return color;
}

// Returns the reflected share of the light by Schlick's approximation. The cosine is that on the side
// with the lower index.
fn fresnel_share(dir: vec3<f32>, n: vec3<f32>, through: vec3<f32>, here: f32, there: f32) -> f32 {
    let ratio = (there - here) / (there + here);
    let r0 = ratio * ratio;
    let cosine = select(abs(dot(through, n)), abs(dot(dir, n)), here <= there);
    let rest = 1.0 - cosine;
    return r0 + (1.0 - r0) * rest * rest * rest * rest * rest;
}

var<private> waiting: array<Segment, MAX_WAITING>;
var<private> waiting_count: u32 = 0u;

// Adds a secondary ray to the stack, unless its weight in the pixel is too small.
fn push_ray(parent: Segment, surface: Surface, dir: vec3<f32>, factor: vec3<f32>, media: Media) {
    let weight = parent.weight * max_component(factor);
    if is_black(factor) || weight < params.min_weight || waiting_count >= MAX_WAITING {
        return;
    }
    let ray = spawn_ray(surface, dir, FAR);
    waiting[waiting_count] = Segment(ray, parent.throughput * factor, weight, parent.bounces - 1u, media);
    waiting_count += 1u;
}

// Adds the reflected and the transmitted ray of a hit to the stack.
fn push_secondary(segment: Segment, surface: Surface, blend: SpecularBlend, transition: Transition) {
    let dir = segment.ray.dir;
    let leaving = dot(dir, surface.n_geo) > 0.0;
    // An interpolated normal can point away from the ray, whereas the geometric normal never does.
    var n = select(surface.n_shade, -surface.n_shade, leaving);
    let n_geo = select(surface.n_geo, -surface.n_geo, leaving);
    n = select(n_geo, n, dot(dir, n) < 0.0);
    let mirrored = dir - 2.0 * dot(dir, n) * n;
    var reflective = blend.reflective;
    var transparent = blend.transparent;
    var through = vec4<f32>(0.0);
    if !is_black(transparent) {
        through = refract_ray(dir, n, transition.ior_front / transition.ior_behind);
    }
    if blend.fresnel && has_flag(REFLECTION) && has_flag(REFRACTION) {
        var share = 1.0;
        if through.w != 0.0 {
            share = fresnel_share(dir, n, through.xyz, transition.ior_front, transition.ior_behind);
        }
        reflective *= share;
        transparent *= 1.0 - share;
    }
    if has_flag(REFRACTION) && through.w != 0.0 {
        push_ray(segment, surface, through.xyz, transparent, transition.behind);
    }
    if has_flag(REFLECTION) {
        push_ray(segment, surface, mirrored, reflective, segment.media);
    }
}

// Returns the radiance along a camera ray.
fn whitted_radiance(camera_ray: Ray) -> vec3<f32> {
    waiting[0] = Segment(camera_ray, vec3<f32>(1.0), 1.0, params.bounces, air());
    waiting_count = 1u;
    var radiance = vec3<f32>(0.0);
    for (var step = 0u; waiting_count > 0u; step++) {
        if step == MAX_WHITTED_RAYS {
            result_flags |= TOO_MANY_RAYS;
            break;
        }
        waiting_count -= 1u;
        var segment = waiting[waiting_count];
        let hit = find_hit(segment.ray, false);
        if hit.object == NONE {
            radiance += segment.throughput * params.background;
            continue;
        }
        let surface = surface_at(segment.ray, hit);
        let from_behind = dot(segment.ray.dir, surface.n_geo) > 0.0;
        let parts = parts_at(surface.material, surface.position, from_behind);
        let blend = specular_blend(parts);
        var transition = Transition(1.0, 1.0, air(), false);
        if !is_black(blend.transparent) {
            transition = transition_into(segment.media, hit.object, segment.ray.origin, blend.ior, from_behind);
            if transition.displaced {
                segment.media = transition.behind;
                segment.ray.t_min = hit.t;
                waiting[waiting_count] = segment;
                waiting_count += 1u;
                continue;
            }
        }
        let flips = from_behind && has_flag(SHADE_BACK);
        let n = select(surface.n_shade, -surface.n_shade, flips);
        radiance += segment.throughput * local_light(surface, parts, n, segment.ray.dir);
        if segment.bounces > 0u && !(is_black(blend.reflective) && is_black(blend.transparent)) {
            push_secondary(segment, surface, blend, transition);
        }
    }
    return radiance;
}

@compute @workgroup_size(WORKGROUP)
fn render_whitted(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= params.ray_count {
        return;
    }
    let camera = camera_rays[id.x];
    let ray = Ray(camera.origin, camera.dir, camera.t_min, camera.t_max, NONE, NONE);
    let radiance = whitted_radiance(ray);
    results[id.x] = RayResult(radiance, traced_rays, result_flags, 0u, 0u, 0u);
}
