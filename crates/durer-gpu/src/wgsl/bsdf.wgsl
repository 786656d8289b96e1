// Scattering at a path vertex: lobes with weights and sampling probabilities, in a frame around the
// shading normal. The formulas are those of `durer-scene/src/bsdf` and `world/shading.rs`.

const DIFFUSE_LOBE: u32 = 0u;
const BLINN_LOBE: u32 = 1u;
const PHONG_LOBE: u32 = 2u;
const METAL_LOBE: u32 = 3u;
const DIELECTRIC_LOBE: u32 = 4u;
const MIRROR_LOBE: u32 = 5u;
const STRAIGHT_LOBE: u32 = 6u;
const REFRACTION_LOBE: u32 = 7u;

struct Lobe {
    kind: u32,
    // Factor on the value of the lobe.
    weight: vec3<f32>,
    // Approximate albedo, in proportion to which the lobe is sampled.
    probability: f32,
    // Albedo of a diffuse lobe, strength of a highlight, or reflectance of a metal at right angles.
    color: vec3<f32>,
    // Exponent of a highlight, roughness of a diffuse lobe, alpha of facets, or relative index of
    // refraction.
    parameter: f32,
    // Dip of the reflectance of a metal, or relative index of the facets of a dielectric.
    facet: vec3<f32>,
    // Material whose boundary lies above a diffuse lobe, or NONE.
    boundary: u32,
}

struct Bsdf {
    count: u32,
    total: f32,
    frame: Frame,
    n_geo: vec3<f32>,
    // Local direction to the viewer.
    wo: vec3<f32>,
    // Local normal of diffuse lobes, which is z unless the normal of the frame was bent.
    normal: vec3<f32>,
    lobes: array<Lobe, MAX_LOBES>,
}

struct BsdfValue {
    // Value times cosine.
    value: vec3<f32>,
    // Density per steradian.
    pdf: f32,
}

struct BsdfSample {
    is_valid: bool,
    wi: vec3<f32>,
    // Value times cosine / pdf.
    weight: vec3<f32>,
    // Density per steradian; 0 for a lobe with a single direction.
    pdf: f32,
    transmits: bool,
}

fn add_lobe(bsdf: ptr<function, Bsdf>, lobe: Lobe) {
    if max_component(lobe.weight) > 0.0 && lobe.probability > 0.0 && (*bsdf).count < MAX_LOBES {
        (*bsdf).lobes[(*bsdf).count] = lobe;
        (*bsdf).count += 1u;
        (*bsdf).total += lobe.probability;
    }
}

// Bends a shading normal until the mirrored direction points outwards; see `bend_normal` in
// `world/shading.rs`.
fn bend_normal(n: vec3<f32>, n_geo: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {
    let cosine = dot(n, n_geo);
    let z = max(dot(wo, n_geo), 1e-6);
    let least = min(0.9 * z, 0.01);
    if 2.0 * dot(n, wo) * cosine - z >= least && cosine > 0.0 {
        return n;
    }
    var across = n - cosine * n_geo;
    if dot(across, across) < 1e-8 {
        return n_geo;
    }
    across = normalize(across);
    let x = dot(wo, across);
    let square = x * x + z * z;
    let twice = clamp((z * least - x * sqrt(max(square - least * least, 0.0))) / square, -1.0, 1.0);
    return sqrt(0.5 * (1.0 - twice)) * across + sqrt(0.5 * (1.0 + twice)) * n_geo;
}

// Returns the reflectance of a boundary between two dielectrics for unpolarised light (Fresnel's
// equations). `eta` is the index behind divided by the index in front.
fn fresnel_dielectric(cosine: f32, eta: f32) -> f32 {
    let sine2 = max(1.0 - cosine * cosine, 0.0) / (eta * eta);
    if sine2 >= 1.0 {
        return 1.0;
    }
    let behind = sqrt(1.0 - sine2);
    let parallel = (eta * cosine - behind) / (eta * cosine + behind);
    let perpendicular = (cosine - eta * behind) / (cosine + eta * behind);
    return 0.5 * (parallel * parallel + perpendicular * perpendicular);
}

// Returns an upper bound of the albedo of a highlight of strength 1.
fn highlight_bound(exponent: f32) -> f32 {
    return min(8.0 / (exponent + 1.0), 1.0);
}

// Adds the lobes of one material; see `phong_lobes` in `world/shading.rs`.
fn add_material(bsdf: ptr<function, Bsdf>, part: Part, eta: f32) {
    let m = materials[part.material];
    if (m.flags & PRINCIPLED) != 0u {
        add_principled(bsdf, part, eta);
        return;
    }
    let is_fresnel = (m.flags & FRESNEL) != 0u;
    var reflected = 1.0;
    var passing = 1.0;
    if is_fresnel {
        reflected = fresnel_dielectric((*bsdf).wo.z, eta);
        passing = 1.0 - reflected;
    }
    var strength = m.specular;
    var exponent = m.exponent;
    if (m.flags & HIGHLIGHT) == 0u {
        strength = vec3<f32>(0.0);
        exponent = 1.0;
    }
    let mirror = reflected * m.reflective;
    let through = passing * m.transparent;
    let bound = highlight_bound(exponent);
    let all_lobes = part.diffuse + bound * strength + mirror + through;
    let scale = part.share / max(max_component(all_lobes), 1.0);
    let factor = vec3<f32>(scale);
    let none = vec3<f32>(0.0);
    add_lobe(bsdf, Lobe(DIFFUSE_LOBE, factor, scale * max_component(part.diffuse), part.diffuse, 0.0, none, NONE));
    let highlight = select(BLINN_LOBE, PHONG_LOBE, (m.flags & PHONG_HIGHLIGHT) != 0u);
    add_lobe(bsdf, Lobe(highlight, factor, scale * bound * max_component(strength), strength, exponent, none, NONE));
    add_lobe(bsdf, Lobe(MIRROR_LOBE, scale * mirror, scale * max_component(mirror), none, 0.0, none, NONE));
    let kind = select(REFRACTION_LOBE, STRAIGHT_LOBE, eta == 1.0);
    add_lobe(bsdf, Lobe(kind, scale * through, scale * max_component(through), none, eta, none, NONE));
}

// Returns the BSDF at a surface seen along `dir`, without lobes.
fn empty_bsdf(surface: Surface, dir: vec3<f32>) -> Bsdf {
    let inside = dot(dir, surface.n_geo) > 0.0;
    let n_geo = select(surface.n_geo, -surface.n_geo, inside);
    let wo = -unit_or(dir, -n_geo);
    let n = unit_or(select(surface.n_shade, -surface.n_shade, inside), n_geo);
    let bent = bend_normal(n, n_geo, wo);
    var bsdf: Bsdf;
    bsdf.count = 0u;
    bsdf.total = 0.0;
    bsdf.frame = frame_around(bent);
    bsdf.n_geo = n_geo;
    let local = to_local(bsdf.frame, wo);
    bsdf.wo = vec3<f32>(local.xy, max(local.z, 1e-6));
    bsdf.normal = vec3<f32>(0.0, 0.0, 1.0);
    if any(bent != n) {
        bsdf.normal = to_local(bsdf.frame, n);
    }
    return bsdf;
}

fn is_delta(lobe: Lobe) -> bool {
    return lobe.kind >= MIRROR_LOBE;
}

fn has_non_delta(bsdf: ptr<function, Bsdf>) -> bool {
    for (var i = 0u; i < (*bsdf).count; i++) {
        if !is_delta((*bsdf).lobes[i]) {
            return true;
        }
    }
    return false;
}

const EON_C1: f32 = 0.28779341f;
const EON_C2: f32 = 0.07248821f;

// Returns the directional albedo of single scattering at a rough white surface.
fn eon_single(cosine: f32, roughness: f32) -> f32 {
    let mu = clamp(cosine, 1e-6, 1.0);
    let sine = sqrt(max(1.0 - mu * mu, 0.0));
    let angle = atan2(sine, mu);
    let g = sine * (angle - sine * mu) + (2.0 / 3.0) * ((sine / mu) * (1.0 - sine * sine * sine) - sine);
    return (1.0 + roughness / PI * g) / (1.0 + EON_C1 * roughness);
}

// Returns the value of a diffuse lobe. A boundary applies only to the isotropic part.
fn diffuse_value(lobe: Lobe, between: f32, out_cosine: f32, in_cosine: f32) -> vec3<f32> {
    let bare = bare_diffuse_value(lobe, between, out_cosine, in_cosine);
    if lobe.boundary == NONE {
        return bare;
    }
    let even = (1.0 - lobe.parameter) / (PI * (1.0 + EON_C1 * lobe.parameter));
    return bare + lobe.color * (even * (boundary_entering(lobe.boundary, in_cosine) - 1.0));
}

// Returns the value of a diffuse lobe without a boundary (Portsmouth, Kutz and Hill, EON, JCGT 14(1),
// 2025).
fn bare_diffuse_value(lobe: Lobe, between: f32, out_cosine: f32, in_cosine: f32) -> vec3<f32> {
    let roughness = lobe.parameter;
    if roughness == 0.0 {
        return lobe.color / PI;
    }
    let a = 1.0 / (1.0 + EON_C1 * roughness);
    let s = between - out_cosine * in_cosine;
    var ratio = s;
    if s > 0.0 {
        ratio = s / max(out_cosine, in_cosine);
    }
    let single = lobe.color * (a * (1.0 + roughness * ratio) / PI);
    let mean = a * (1.0 + EON_C2 * roughness);
    let lost_out = max(1.0 - eon_single(out_cosine, roughness), 1e-7);
    let lost_in = max(1.0 - eon_single(in_cosine, roughness), 1e-7);
    let again = lobe.color * lobe.color * mean / (1.0 - lobe.color * max(1.0 - mean, 0.0));
    return single + again * (lost_out * lost_in / (PI * max(1.0 - mean, 1e-7)));
}

fn eval_lobe(lobe: Lobe, wo: vec3<f32>, wi: vec3<f32>, normal: vec3<f32>) -> BsdfValue {
    let nothing = BsdfValue(vec3<f32>(0.0), 0.0);
    if is_delta(lobe) || wi.z <= 0.0 {
        return nothing;
    }
    if lobe.kind == DIFFUSE_LOBE {
        let in_cosine = dot(wi, normal);
        if in_cosine <= 0.0 {
            return nothing;
        }
        let out_cosine = max(dot(wo, normal), 1e-6);
        return BsdfValue(in_cosine * diffuse_value(lobe, dot(wo, wi), out_cosine, in_cosine), in_cosine / PI);
    }
    let half = unit_or(wo + wi, vec3<f32>(0.0));
    if lobe.kind == METAL_LOBE || lobe.kind == DIELECTRIC_LOBE {
        let density = ggx_density(lobe.parameter, half) / (4.0 * wo.z);
        let hidden = ggx_lambda(lobe.parameter, wo);
        let cosine = clamp(dot(wo, half), 0.0, 1.0);
        var reflectance = vec3<f32>(fresnel_dielectric(cosine, lobe.facet.x));
        if lobe.kind == METAL_LOBE {
            reflectance = f82_at(lobe.color, lobe.facet, cosine);
        }
        // The density is that of the visible normals, divided by 4 wo·h. The factor wo·h cancels.
        let value = density / (1.0 + hidden + ggx_lambda(lobe.parameter, wi)) * reflectance;
        return BsdfValue(value, density / (1.0 + hidden));
    }
    var base = half.z;
    var spread = 4.0 * dot(wo, half);
    if lobe.kind == PHONG_LOBE {
        base = dot(vec3<f32>(-wo.xy, wo.z), wi);
        spread = 1.0;
    }
    if base <= 0.0 {
        return nothing;
    }
    let power = pow(min(base, 1.0), lobe.parameter) / PI;
    var density = 0.0;
    if spread > 0.0 {
        density = 0.5 * (lobe.parameter + 1.0) * power / spread;
    }
    return BsdfValue(lobe.color * (wi.z * power), density);
}

// Returns the value times cosine and the density of a local direction, summed over all lobes.
fn eval_local(bsdf: ptr<function, Bsdf>, wi: vec3<f32>) -> BsdfValue {
    var sum = BsdfValue(vec3<f32>(0.0), 0.0);
    for (var i = 0u; i < (*bsdf).count; i++) {
        let lobe = (*bsdf).lobes[i];
        let value = eval_lobe(lobe, (*bsdf).wo, wi, (*bsdf).normal);
        sum.value += lobe.weight * value.value;
        sum.pdf += lobe.probability * value.pdf;
    }
    sum.pdf = select(0.0, sum.pdf / (*bsdf).total, sum.pdf > 0.0);
    return sum;
}

// Returns the value times cosine and the density of a direction in world space. A direction above
// the shading surface but below the geometric one carries no light.
fn eval_bsdf(bsdf: ptr<function, Bsdf>, wi: vec3<f32>) -> BsdfValue {
    let local = to_local((*bsdf).frame, wi);
    var value = eval_local(bsdf, local);
    if (local.z > 0.0) != (dot(wi, (*bsdf).n_geo) > 0.0) {
        value.value = vec3<f32>(0.0);
    }
    return value;
}

// Samples a direction of one lobe. The last component is 0 if there is none.
fn sample_lobe(lobe: Lobe, wo: vec3<f32>, normal: vec3<f32>, u: vec2<f32>) -> vec4<f32> {
    let none = vec4<f32>(0.0);
    switch lobe.kind {
        case DIFFUSE_LOBE: {
            var wi = warp_cosine(u);
            if normal.z != 1.0 {
                wi = to_world(frame_around(normal), wi);
            }
            return select(none, vec4<f32>(wi, 1.0), wi.z > 0.0);
        }
        case BLINN_LOBE, PHONG_LOBE: {
            let about = warp_polar(pow(u.x, 1.0 / (lobe.parameter + 1.0)), u.y);
            var wi = 2.0 * dot(wo, about) * about - wo;
            if lobe.kind == PHONG_LOBE {
                wi = to_world(frame_around(vec3<f32>(-wo.xy, wo.z)), about);
            }
            return select(none, vec4<f32>(wi, 1.0), wi.z > 0.0);
        }
        case METAL_LOBE, DIELECTRIC_LOBE: {
            let h = ggx_sample(lobe.parameter, wo, u);
            let wi = 2.0 * dot(wo, h) * h - wo;
            return select(none, vec4<f32>(wi, 1.0), wi.z > 0.0);
        }
        case MIRROR_LOBE: { return vec4<f32>(-wo.xy, wo.z, 1.0); }
        case STRAIGHT_LOBE: { return vec4<f32>(-wo, 1.0); }
        default: {
            let eta = lobe.parameter;
            let sine2 = max(1.0 - wo.z * wo.z, 0.0) / (eta * eta);
            if sine2 >= 1.0 {
                return none;
            }
            let z = wo.z / eta - sqrt(1.0 - sine2);
            return vec4<f32>(vec3<f32>(0.0, 0.0, z) - wo / eta, 1.0);
        }
    }
}

// Samples a direction. `choice` selects the lobe, and `u` the direction.
fn sample_bsdf(bsdf: ptr<function, Bsdf>, choice: f32, u: vec2<f32>) -> BsdfSample {
    let none = BsdfSample(false, vec3<f32>(0.0), vec3<f32>(0.0), 0.0, false);
    if (*bsdf).count == 0u {
        return none;
    }
    var rest = choice * (*bsdf).total;
    var chosen = 0u;
    while chosen + 1u < (*bsdf).count && rest >= (*bsdf).lobes[chosen].probability {
        rest -= (*bsdf).lobes[chosen].probability;
        chosen += 1u;
    }
    let lobe = (*bsdf).lobes[chosen];
    let local = sample_lobe(lobe, (*bsdf).wo, (*bsdf).normal, u);
    if local.w == 0.0 {
        return none;
    }
    let wi = to_world((*bsdf).frame, local.xyz);
    let transmits = dot(wi, (*bsdf).n_geo) < 0.0;
    if transmits != (local.z < 0.0) {
        return none;
    }
    if is_delta(lobe) {
        var weight = lobe.weight * ((*bsdf).total / lobe.probability);
        if lobe.kind == REFRACTION_LOBE {
            // Radiance scales with the square of the index (Veach's thesis, section 5.2).
            weight /= lobe.parameter * lobe.parameter;
        }
        return BsdfSample(true, wi, weight, 0.0, transmits);
    }
    let value = eval_local(bsdf, local.xyz);
    if !(value.pdf > 0.0 && value.pdf < FAR) {
        return none;
    }
    return BsdfSample(true, wi, value.value / value.pdf, value.pdf, transmits);
}
