// Path tracing with next-event estimation, multiple importance sampling and Russian roulette, as in
// `integrator/path`.
//
// Sources: Kajiya, The Rendering Equation, SIGGRAPH 1986; Veach, Robust Monte Carlo Methods for
// Light Transport Simulation, 1997, chapters 9 and 10.

const MAX_SURVIVAL: f32 = 0.95f;

// State of a path between two vertices.
struct PathState {
    ray: Ray,
    throughput: vec3<f32>,
    depth: u32,
    media: Media,
    // Point and density of the last direction, if lights were sampled there; else the density is 0.
    last_point: vec3<f32>,
    last_pdf: f32,
    // Number of vertices so far that did not have a single direction.
    rough_bounces: u32,
    // Product of the squared relative indices of refraction since the camera.
    squared_eta: f32,
}

// Returns the weight of a strategy with density `a` when another one has density `b`.
fn power_heuristic(a: f32, b: f32) -> f32 {
    if b == 0.0 {
        return 1.0;
    }
    let ratio = b / a;
    return 1.0 / (1.0 + ratio * ratio);
}

// Returns throughput times light, limited if the light was scattered more than once.
fn contribution(factor: vec3<f32>, light: vec3<f32>, scatterings: u32) -> vec3<f32> {
    let term = factor * light;
    let brightest = max_component(term);
    if params.clamp >= 0.0 && scatterings > 1u && brightest > params.clamp {
        return term * (params.clamp / brightest);
    }
    return term;
}

// Returns the light of the background and of suns that the ray shows.
fn background_light(state: PathState) -> vec3<f32> {
    var light = params.sky;
    if state.rough_bounces == 0u {
        let dir = unit_or(state.ray.dir, vec3<f32>(0.0));
        for (var i = 0u; i < params.light_count; i++) {
            let offset = lights[i].position - dir;
            if lights[i].chord2 > 0.0 && dot(offset, offset) <= lights[i].chord2 {
                light += lights[i].color / lights[i].chord2;
            }
        }
    }
    return light;
}

// Returns the light that a surface emits towards the ray's origin.
fn emitted_light(state: PathState, surface: Surface, hit: Hit, parts: Parts, inside: bool) -> vec3<f32> {
    var light = vec3<f32>(0.0);
    for (var i = 0u; i < parts.count; i++) {
        let flags = materials[parts.items[i].material].flags;
        if (flags & EMITS) != 0u && ((flags & EMITS_BOTH) != 0u || !inside) {
            light += parts.items[i].share * materials[parts.items[i].material].emission;
        }
    }
    let first = objects[hit.object].first_emitter;
    var weight = 1.0;
    if !is_black(light) && state.last_pdf > 0.0 && first != NONE {
        let number = first + hit.part;
        let chosen = emitters[number].two_sided != 0u || dot(emitters[number].normal, state.ray.dir) <= 0.0;
        if chosen {
            let to = surface.position - state.last_point;
            let distance = length(to);
            let pdf = emitters[number].probability * emitter_pdf(number, state.last_point, to / distance, distance);
            weight = power_heuristic(state.last_pdf, select(0.0, pdf, pdf < FAR));
        }
    }
    return contribution(state.throughput * weight, light, state.depth);
}

// Returns the light that a vertex scatters from one sampled light.
fn direct_light(state: PathState, surface: Surface, bsdf: ptr<function, Bsdf>, choice: f32, u: vec2<f32>) -> vec3<f32> {
    let nothing = vec3<f32>(0.0);
    let light = sample_emitters(surface.position, choice, u);
    if !light.is_valid || is_black(light.radiance) {
        return nothing;
    }
    let scattered = eval_bsdf(bsdf, light.wi);
    if is_black(scattered.value) {
        return nothing;
    }
    let has_extent = light.pdf > 0.0;
    let pdf = light.choice * select(1.0, light.pdf, has_extent);
    // Directions sampled from the BSDF never hit a light without extent.
    var weight = 1.0;
    if has_extent {
        weight = power_heuristic(pdf, scattered.pdf);
    }
    if has_flag(SHADOWS) {
        // The ray ends before the light, also if the light is inclined.
        let bound = 2.0 * (surface.error.x + surface.error.y + surface.error.z);
        let reach = (light.distance - 2.0 * (light.error + bound) / light.cosine) * (1.0 - gamma(16.0));
        let ray = point_ray(surface, light.wi, select(reach, FAR, light.distance >= FAR));
        if ray.t_max <= 0.0 || find_hit(ray, true).object != NONE {
            return nothing;
        }
    }
    return contribution(state.throughput * scattered.value * (weight / pdf), light.radiance, state.depth + 1u);
}

// Returns the index of refraction of the transparent material with the largest share, or 0 if light
// cannot enter.
fn entered_ior(parts: Parts) -> f32 {
    var most = 0.0;
    var ior = 0.0;
    for (var i = 0u; i < parts.count; i++) {
        let part = parts.items[i];
        if !is_black(materials[part.material].transparent) && part.share > most {
            most = part.share;
            ior = materials[part.material].ior;
        }
    }
    return ior;
}

// Returns the probability that a path survives Russian roulette, as `survival` on the CPU.
fn survival_probability(state: PathState, fraction: f32) -> f32 {
    if state.depth < 3u {
        return 1.0;
    }
    if state.rough_bounces < 3u {
        return min(10.0 * fraction, 1.0);
    }
    return min(fraction, MAX_SURVIVAL);
}

fn path_radiance(camera_ray: Ray, key: vec2<u32>, sample: u32) -> vec3<f32> {
    var state = PathState(camera_ray, vec3<f32>(1.0), 0u, air(), vec3<f32>(0.0), 0.0, 0u, 1.0);
    var radiance = vec3<f32>(0.0);
    var passed = 0u;
    loop {
        let hit = find_hit(state.ray, false);
        if hit.object == NONE {
            radiance += contribution(state.throughput, background_light(state), state.depth);
            break;
        }
        let surface = surface_at(state.ray, hit);
        let inside = dot(state.ray.dir, surface.n_geo) > 0.0;
        let parts = parts_at(surface.material, surface.position, inside);
        let ior = entered_ior(parts);
        var transition = Transition(1.0, 1.0, air(), false);
        if ior > 0.0 {
            transition = transition_into(state.media, hit.object, state.ray.origin, ior, inside);
            if transition.displaced {
                passed += 1u;
                if passed > MAX_PASSED {
                    break;
                }
                state.media = transition.behind;
                state.ray.t_min = hit.t;
                continue;
            }
        }
        passed = 0u;
        radiance += emitted_light(state, surface, hit, parts, inside);
        var bsdf = empty_bsdf(surface, state.ray.dir);
        for (var i = 0u; i < parts.count; i++) {
            add_material(&bsdf, parts.items[i], transition.ior_behind / transition.ior_front);
        }
        if bsdf.count == 0u || state.depth > params.bounces {
            break;
        }
        let first = 2u + state.depth * DIMENSIONS;
        let choices = random_pair(key, sample, first);
        if has_non_delta(&bsdf) {
            let u = random_pair(key, sample, first + 2u);
            radiance += direct_light(state, surface, &bsdf, choices.y, u);
        }
        let next = sample_bsdf(&bsdf, choices.x, random_pair(key, sample, first + 1u));
        if !next.is_valid {
            break;
        }
        let throughput = state.throughput * next.weight;
        let passes = ior > 0.0 && dot(next.wi, bsdf.n_geo) < 0.0;
        if passes {
            let eta = transition.ior_behind / transition.ior_front;
            state.squared_eta *= eta * eta;
            state.media = transition.behind;
        }
        let survival = survival_probability(state, max_component(throughput) * state.squared_eta);
        if survival < 1.0 && random_pair(key, sample, first + 3u).x >= survival {
            break;
        }
        state.throughput = throughput / survival;
        state.last_pdf = next.pdf;
        state.last_point = surface.position;
        state.rough_bounces += select(0u, 1u, next.pdf > 0.0);
        state.ray = spawn_ray(surface, next.wi, FAR);
        state.depth += 1u;
    }
    return radiance;
}

@compute @workgroup_size(WORKGROUP)
fn render_path(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= params.ray_count {
        return;
    }
    let camera = camera_rays[id.x];
    let ray = Ray(camera.origin, camera.dir, camera.t_min, camera.t_max, NONE, NONE);
    let radiance = path_radiance(ray, vec2<u32>(camera.key_low, camera.key_high), camera.sample);
    results[id.x] = RayResult(radiance, traced_rays, result_flags, 0u, 0u, 0u);
}
