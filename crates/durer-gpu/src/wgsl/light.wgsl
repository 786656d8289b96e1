// Lights of the scene, without extent.

// Light that arrives at a point, as the radiance of a white diffuse surface that faces the light.
struct Arriving {
    to_light: vec3<f32>,
    distance: f32,
    color: vec3<f32>,
}

// Raises s between the two angles of a spot light to its fade.
fn spot_fade(fade: u32, s: f32) -> f32 {
    switch fade {
        case 1u: { return s * s * (3.0 - 2.0 * s); }
        case 2u: { return s * s * s * s; }
        default: { return s * s; }
    }
}

fn illuminate(number: u32, point: vec3<f32>) -> Arriving {
    let light = lights[number];
    if light.kind == DIRECTIONAL_LIGHT {
        return Arriving(light.position, FAR, light.color);
    }
    let offset = light.position - point;
    let distance = length(offset);
    let to_light = unit_or(offset, vec3<f32>(0.0, 1.0, 0.0));
    if light.kind == POINT_LIGHT {
        let a = light.attenuation;
        return Arriving(to_light, distance, light.color / (a.x + a.y * distance + a.z * distance * distance));
    }
    let cosine = -dot(to_light, light.axis);
    var share = select(0.0, 1.0, cosine >= light.cos_outer);
    if light.cos_inner > light.cos_outer {
        share = clamp((cosine - light.cos_outer) / (light.cos_inner - light.cos_outer), 0.0, 1.0);
    }
    return Arriving(to_light, distance, light.color * (spot_fade(light.fade, share) / (distance * distance)));
}
