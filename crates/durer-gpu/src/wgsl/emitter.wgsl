// Light sampling: emissive surfaces and lights, each chosen with a fixed probability.

struct LightSample {
    is_valid: bool,
    wi: vec3<f32>,
    distance: f32,
    // Absolute cosine between the light's normal and the direction.
    cosine: f32,
    // Bound on the distance between the sampled and the traced surface.
    error: f32,
    // Radiance or, for a light without extent, the irradiance of a surface that faces it.
    radiance: vec3<f32>,
    // Density per steradian, without the choice; 0 for a light without extent.
    pdf: f32,
    // Probability of choosing the light.
    choice: f32,
}

// A point whose squared distance from the centre exceeds the squared radius by no more than this
// share counts as on the sphere.
const ON_SPHERE: f32 = 1e-5f;

fn is_in_sphere(d2: f32, r2: f32) -> bool {
    return d2 <= r2 * (1.0 + ON_SPHERE);
}

// Returns 1 - cos for the angle with the given squared sine.
fn one_minus_cosine(sine2: f32) -> f32 {
    return sine2 / (1.0 + sqrt(max(1.0 - sine2, 0.0)));
}

// Returns the density per steradian with which a point at `distance` in direction `wi` is sampled.
fn emitter_pdf(number: u32, origin: vec3<f32>, wi: vec3<f32>, distance: f32) -> f32 {
    let kind = emitters[number].kind;
    if kind == HIDDEN_EMITTER {
        return 0.0;
    }
    if kind == SPHERE_EMITTER {
        let to = emitters[number].point - origin;
        let r = emitters[number].radius;
        let d2 = dot(to, to);
        if is_in_sphere(d2, r * r) {
            let cosine = max(abs(dot((distance * wi - to) / r, wi)), 1e-6);
            return distance * distance / (emitters[number].area * cosine);
        }
        return 1.0 / (2.0 * PI * one_minus_cosine(r * r / d2));
    }
    return distance * distance / (abs(dot(wi, emitters[number].normal)) * emitters[number].area);
}

// Samples a point on a sphere, uniformly over the solid angle in which it is visible (Physically
// Based Rendering, 4th edition, section 6.2.4).
fn sample_sphere(number: u32, origin: vec3<f32>, u: vec2<f32>, choice: f32) -> LightSample {
    let emitter = emitters[number];
    let to = emitter.point - origin;
    let r = emitter.radius;
    let d2 = dot(to, to);
    let d = sqrt(d2);
    if is_in_sphere(d2, r * r) {
        let at = to + r * warp_polar(1.0 - 2.0 * u.x, u.y);
        let distance = length(at);
        let wi = at / distance;
        let cosine = max(abs(dot((distance * wi - to) / r, wi)), 1e-6);
        let pdf = distance * distance / (emitter.area * cosine);
        let seen = emitter.two_sided != 0u && pdf < FAR;
        return LightSample(seen, wi, distance, cosine, emitter.error, emitter.radiance, pdf, choice);
    }
    let all_angles = one_minus_cosine(r * r / d2);
    let below = all_angles * u.x;
    let sine2 = max(below * (2.0 - below), 0.0);
    let angle = 2.0 * PI * u.y;
    let local = vec3<f32>(sqrt(sine2) * cos(angle), sqrt(sine2) * sin(angle), 1.0 - below);
    let wi = normalize(to_world(frame_around(to / d), local));
    let half = sqrt(max(r * r - d2 * sine2, 0.0));
    let pdf = 1.0 / (2.0 * PI * all_angles);
    let distance = d * (1.0 - below) - half;
    return LightSample(true, wi, distance, max(half / r, 1e-3), emitter.error, emitter.radiance, pdf, choice);
}

// Samples a light without extent, or a direction within the extent of a directional light.
fn sample_light(number: u32, origin: vec3<f32>, u: vec2<f32>, choice: f32) -> LightSample {
    let arriving = illuminate(number, origin);
    var wi = arriving.to_light;
    if lights[number].chord2 > 0.0 {
        let cosine = 1.0 - u.x * (1.0 - lights[number].cos_extent);
        wi = to_world(frame_around(wi), warp_polar(cosine, u.y));
    }
    return LightSample(true, wi, arriving.distance, 1.0, 0.0, PI * arriving.color, 0.0, choice);
}

// Returns the number of the first emitter whose cumulative probability exceeds `u`.
fn choose_emitter(u: f32) -> u32 {
    var low = 0u;
    var high = params.emitter_count - 1u;
    // 32 halvings suffice for any count.
    for (var i = 0u; i < 32u && low < high; i++) {
        let middle = (low + high) / 2u;
        if u < emitters[middle].cumulative {
            high = middle;
        } else {
            low = middle + 1u;
        }
    }
    return low;
}

// Chooses a light with `choice` and samples a direction towards it with `u`.
fn sample_emitters(origin: vec3<f32>, choice: f32, u: vec2<f32>) -> LightSample {
    let none = LightSample(false, vec3<f32>(0.0), 0.0, 1.0, 0.0, vec3<f32>(0.0), 0.0, 0.0);
    if params.emitter_count == 0u {
        return none;
    }
    let number = choose_emitter(choice);
    let probability = emitters[number].probability;
    let kind = emitters[number].kind;
    if !(probability > 0.0) {
        return none;
    }
    if kind == LIGHT_EMITTER {
        return sample_light(emitters[number].light, origin, u, probability);
    }
    if kind == SPHERE_EMITTER {
        return sample_sphere(number, origin, u, probability);
    }
    let emitter = emitters[number];
    var weights = u;
    if kind == TRIANGLE_EMITTER {
        // Heitz, A Low-Distortion Map Between Triangle and Square, 2019.
        var b = vec2<f32>(u.x - 0.5 * u.y, 0.5 * u.y);
        if u.x < u.y {
            b = vec2<f32>(0.5 * u.x, u.y - 0.5 * u.x);
        }
        weights = vec2<f32>(b.y, max(1.0 - b.x - b.y, 0.0));
    } else if kind == ELLIPSE_EMITTER {
        // The area of a ring grows with the square of its outer radius.
        let d = warp_disc(u);
        let inner2 = emitter.radius * emitter.radius;
        weights = d;
        if inner2 > 0.0 {
            let direction = select(vec2<f32>(1.0, 0.0), normalize(d), any(d != vec2<f32>(0.0)));
            weights = direction * sqrt(inner2 + (1.0 - inner2) * dot(d, d));
        }
    }
    let to = emitter.point - origin + weights.x * emitter.edge_0 + weights.y * emitter.edge_1;
    let distance = length(to);
    let wi = to / distance;
    let cosine = -dot(wi, emitter.normal);
    let pdf = distance * distance / (abs(cosine) * emitter.area);
    let faces = cosine > 0.0 || emitter.two_sided != 0u;
    if !(faces && pdf > 0.0 && pdf < FAR) {
        return none;
    }
    let error = emitter.error + gamma(8.0) * distance;
    return LightSample(true, wi, distance, max(abs(cosine), 1e-3), error, emitter.radiance, pdf, probability);
}
