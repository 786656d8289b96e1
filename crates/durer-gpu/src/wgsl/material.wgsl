// Materials at a surface point. A pattern mixes two materials, which can be patterns too.

struct Part {
    material: u32,
    share: f32,
    diffuse: vec3<f32>,
}

struct Parts {
    count: u32,
    items: array<Part, MAX_PARTS>,
}

// Returns the share of the first material of a pattern.
fn first_share(material: u32, position: vec3<f32>, inside: bool) -> f32 {
    let m = materials[material];
    if m.kind == TWO_SIDED {
        return select(1.0, 0.0, inside);
    }
    let q = map_point(m.pattern_x, m.pattern_y, m.pattern_z, position);
    switch m.kind {
        case CHECKERBOARD: {
            let cell = floor(q);
            let odd = cell - 2.0 * floor(0.5 * cell);
            let sum = odd.x + odd.y + odd.z;
            return select(0.0, 1.0, sum - 2.0 * floor(0.5 * sum) == 0.0);
        }
        case MARBLE: { return veins(q, q.x, m.frequency, m.amplitude, m.octaves); }
        case WOOD: { return veins(q, length(q.xz), m.frequency, m.amplitude, m.octaves); }
        case SOLID_NOISE: { return clamp(turbulence(q, m.octaves) + 0.5, 0.0, 1.0); }
        default: { return m.share; }
    }
}

fn diffuse_color(material: u32, position: vec3<f32>) -> vec3<f32> {
    let m = materials[material];
    if (m.flags & NOISE) == 0u {
        return m.diffuse;
    }
    let share = veins(position, position.x, m.frequency, m.amplitude, m.octaves);
    return share * m.diffuse + (1.0 - share) * m.second_diffuse;
}

// Returns the materials at a point that have a share above 0.
fn parts_at(material: u32, position: vec3<f32>, inside: bool) -> Parts {
    var parts: Parts;
    parts.count = 0u;
    var waiting: array<Part, MAX_PARTS>;
    waiting[0] = Part(material, 1.0, vec3<f32>(0.0));
    var count = 1u;
    // Each step ends a material or replaces a pattern by its two materials. Materials refer only to
    // earlier ones, and `tables.rs` counts them in advance.
    for (var step = 0u; step < 2u * MAX_PARTS && count > 0u; step++) {
        count -= 1u;
        let part = waiting[count];
        if materials[part.material].kind == PHONG {
            if parts.count < MAX_PARTS {
                let diffuse = diffuse_color(part.material, position);
                parts.items[parts.count] = Part(part.material, part.share, diffuse);
                parts.count += 1u;
            } else {
                result_flags |= TOO_MANY_PARTS;
            }
            continue;
        }
        let share = first_share(part.material, position, inside);
        if share != 1.0 && count < MAX_PARTS {
            waiting[count] = Part(materials[part.material].second, part.share * (1.0 - share), part.diffuse);
            count += 1u;
        }
        if share != 0.0 && count < MAX_PARTS {
            waiting[count] = Part(materials[part.material].first, part.share * share, part.diffuse);
            count += 1u;
        }
    }
    if count > 0u {
        result_flags |= TOO_MANY_PARTS;
    }
    return parts;
}

// Mirror and glass properties at a point, averaged over its materials. The index of refraction is
// that of the material with the largest share.
struct SpecularBlend {
    reflective: vec3<f32>,
    transparent: vec3<f32>,
    ior: f32,
    fresnel: bool,
}

fn specular_blend(parts: Parts) -> SpecularBlend {
    var blend = SpecularBlend(vec3<f32>(0.0), vec3<f32>(0.0), 1.0, false);
    var most = 0.0;
    for (var i = 0u; i < parts.count; i++) {
        let part = parts.items[i];
        blend.reflective += part.share * materials[part.material].reflective;
        blend.transparent += part.share * materials[part.material].transparent;
        if part.share > most {
            most = part.share;
            blend.ior = materials[part.material].ior;
            blend.fresnel = (materials[part.material].flags & FRESNEL) != 0u;
        }
    }
    return blend;
}
