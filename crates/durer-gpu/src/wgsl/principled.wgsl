// Lobes of principled materials without coat, fuzz, film, thin walls and subsurface scattering; see
// `durer-scene/src/bsdf/layers.rs`.

// Alpha below which a surface is a perfect mirror.
const SMOOTH: f32 = 1e-3f;

// Returns the reflectance of the boundary of an opaque base.
fn boundary_reflectance(m: Material, cosine: f32) -> f32 {
    if m.boundary_ior == 1.0 {
        return 0.0;
    }
    if m.facet_alpha < SMOOTH {
        return fresnel_dielectric(cosine, m.boundary_ior);
    }
    return albedo_at(m.first_albedo, cosine).x;
}

// Returns the transmittance of the boundary for light from one direction, divided by its mean.
fn boundary_entering(material: u32, cosine: f32) -> f32 {
    let m = materials[material];
    return (1.0 - boundary_reflectance(m, cosine)) / (1.0 - m.boundary_mean);
}

fn add_metal(bsdf: ptr<function, Bsdf>, m: Material, weight: vec3<f32>) {
    let mu = (*bsdf).wo.z;
    let dip = f82_dip(m.base, m.tint);
    let reflected = weight * f82_at(m.base, dip, mu);
    if m.facet_alpha < SMOOTH {
        add_lobe(bsdf, Lobe(MIRROR_LOBE, reflected, max_component(reflected), m.base, 0.0, dip, NONE));
        return;
    }
    var again = vec3<f32>(1.0);
    if (m.flags & COMPENSATES) != 0u {
        let albedo = albedo_at(m.first_albedo, mu).z;
        again += m.base * ((1.0 - albedo) / albedo);
    }
    add_lobe(bsdf, Lobe(METAL_LOBE, weight * again, max_component(reflected), m.base, m.facet_alpha, dip, NONE));
}

fn add_smooth_glass(bsdf: ptr<function, Bsdf>, m: Material, weight: f32, eta: f32) {
    let none = vec3<f32>(0.0);
    if eta == 1.0 {
        add_lobe(bsdf, Lobe(STRAIGHT_LOBE, weight * m.transmission, weight, none, 0.0, none, NONE));
        return;
    }
    let reflected = weight * fresnel_dielectric((*bsdf).wo.z, eta);
    let through = weight - reflected;
    add_lobe(bsdf, Lobe(MIRROR_LOBE, reflected * m.tint, reflected, none, 0.0, none, NONE));
    add_lobe(bsdf, Lobe(REFRACTION_LOBE, through * m.transmission, through, none, eta, none, NONE));
}

fn add_opaque(bsdf: ptr<function, Bsdf>, material: u32, weight: f32) {
    let m = materials[material];
    let mu = (*bsdf).wo.z;
    let none = vec3<f32>(0.0);
    let reflectance = boundary_reflectance(m, mu);
    let reflected = weight * reflectance * m.tint;
    if m.boundary_ior != 1.0 {
        if m.facet_alpha < SMOOTH {
            add_lobe(bsdf, Lobe(MIRROR_LOBE, reflected, max_component(reflected), none, 0.0, none, NONE));
        } else {
            var gain = 1.0;
            if (m.flags & COMPENSATES) != 0u {
                gain = 1.0 / albedo_at(m.first_albedo, mu).y;
            }
            let eta = vec3<f32>(m.boundary_ior);
            let factor = weight * gain * m.tint;
            add_lobe(bsdf, Lobe(DIELECTRIC_LOBE, factor, max_component(reflected), none, m.facet_alpha, eta, NONE));
        }
    }
    // The colour of the specular reflection does not change what enters the base.
    let matte = weight * (1.0 - reflectance);
    let boundary = select(NONE, material, m.boundary_ior != 1.0);
    let factor = vec3<f32>(matte);
    add_lobe(bsdf, Lobe(DIFFUSE_LOBE, factor, matte * max_component(m.base), m.base, m.roughness, none, boundary));
}

fn add_principled(bsdf: ptr<function, Bsdf>, part: Part, eta: f32) {
    let m = materials[part.material];
    if m.metalness > 0.0 {
        add_metal(bsdf, m, vec3<f32>(part.share * m.metalness * min(m.specular_weight, 1.0)));
    }
    let dielectric = part.share * (1.0 - m.metalness);
    if dielectric * m.transmission_weight > 0.0 {
        add_smooth_glass(bsdf, m, dielectric * m.transmission_weight, eta);
    }
    let opaque = dielectric * (1.0 - m.transmission_weight);
    if opaque > 0.0 {
        add_opaque(bsdf, part.material, opaque);
    }
}
