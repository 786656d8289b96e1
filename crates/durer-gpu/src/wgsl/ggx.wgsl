// Rough reflection by GGX facets, as in `durer-scene/src/bsdf/microfacet.rs`, `lobe/rough.rs` and
// `fresnel.rs`. The surfaces are isotropic.
//
// Sources: Walter and others, Microfacet Models for Refraction through Rough Surfaces, EGSR 2007;
// Heitz, Understanding the Masking-Shadowing Function, JCGT 3(2), 2014; Dupuy and Benyoub, Sampling
// Visible GGX Normals with Spherical Caps, HPG 2023.

fn ggx_density(alpha: f32, h: vec3<f32>) -> f32 {
    let s = dot(h.xy, h.xy) / (alpha * alpha) + h.z * h.z;
    return 1.0 / (PI * alpha * alpha * s * s);
}

// Returns Smith's Lambda, the ratio of hidden to visible area.
fn ggx_lambda(alpha: f32, w: vec3<f32>) -> f32 {
    let s = alpha * alpha * dot(w.xy, w.xy) / max(w.z * w.z, 1e-30);
    return 0.5 * s / (sqrt(1.0 + s) + 1.0);
}

// Samples a facet normal that is visible from `wo`.
fn ggx_sample(alpha: f32, wo: vec3<f32>, u: vec2<f32>) -> vec3<f32> {
    let stretched = normalize(vec3<f32>(alpha * wo.xy, wo.z));
    let z = (1.0 - u.y) * (1.0 + stretched.z) - stretched.z;
    let h = warp_polar(clamp(z, -1.0, 1.0), u.x) + stretched;
    return unit_or(vec3<f32>(alpha * h.xy, max(h.z, 0.0)), vec3<f32>(0.0, 0.0, 1.0));
}

// Returns the amount that is subtracted from Schlick's curve for a metal, in units of
// cos (1 - cos)^6 (Kutz, Hasan and Edmondson, 2021, section 2.3).
fn f82_dip(f0: vec3<f32>, tint: vec3<f32>) -> vec3<f32> {
    let rest = 6.0 / 7.0;
    let rest5 = rest * rest * rest * rest * rest;
    return (f0 + (1.0 - f0) * rest5) * (1.0 - tint) * 7.0 / (rest5 * rest);
}

// Returns the reflectance of a metal at a cosine.
fn f82_at(f0: vec3<f32>, dip: vec3<f32>, cosine: f32) -> vec3<f32> {
    let rest = clamp(1.0 - cosine, 0.0, 1.0);
    let rest5 = rest * rest * rest * rest * rest;
    return clamp(f0 + (1.0 - f0) * rest5 - dip * (cosine * rest5 * rest), vec3<f32>(0.0), vec3<f32>(1.0));
}

// Returns the row of a material's table for a cosine: the reflectance of its boundary, the share of
// the light that single scattering at the boundary keeps, and that of facets that reflect all light.
fn albedo_at(first: u32, cosine: f32) -> vec3<f32> {
    // Rows are evenly spaced in the square root of the cosine.
    let x = sqrt(clamp(cosine, 0.0, 1.0)) * f32(ALBEDO_ROWS - 1u);
    let i = min(u32(x), ALBEDO_ROWS - 2u);
    return mix(albedos[first + i].values.xyz, albedos[first + i + 1u].values.xyz, x - f32(i));
}
