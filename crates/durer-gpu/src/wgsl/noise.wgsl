// Perlin's gradient noise, as in `durer-scene/src/math/noise.rs`.
//
// Source: Ken Perlin, Improving Noise, SIGGRAPH 2002.

fn permute(i: i32) -> i32 {
    let at = u32(i) & 255u;
    return i32(permutation[at / 4u][at % 4u]);
}

// Returns the dot product with one of the twelve vectors from the centre of a cube to its edges.
fn gradient(hash: i32, p: vec3<f32>) -> f32 {
    let h = hash & 15;
    let u = select(p.y, p.x, h < 8);
    var v = p.z;
    if h < 4 {
        v = p.y;
    } else if h == 12 || h == 14 {
        v = p.x;
    }
    return select(-u, u, (h & 1) == 0) + select(-v, v, (h & 2) == 0);
}

fn perlin(p: vec3<f32>) -> f32 {
    let base = floor(p);
    // The lattice repeats every 256 cells.
    let cell = vec3<i32>(base - 256.0 * floor(base / 256.0));
    let f = p - base;
    let fade = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    var faces = vec2<f32>(0.0);
    for (var z = 0; z < 2; z++) {
        var edges = vec2<f32>(0.0);
        for (var y = 0; y < 2; y++) {
            var corners = vec2<f32>(0.0);
            for (var x = 0; x < 2; x++) {
                let hash = permute(permute(permute(cell.x + x) + cell.y + y) + cell.z + z);
                corners[x] = gradient(hash, f - vec3<f32>(f32(x), f32(y), f32(z)));
            }
            edges[y] = corners.x + fade.x * (corners.y - corners.x);
        }
        faces[z] = edges.x + fade.y * (edges.y - edges.x);
    }
    return faces.x + fade.z * (faces.y - faces.x);
}

// Returns the sum of octaves, where octave i has frequency 2^i and weight 2^-i.
fn turbulence(p: vec3<f32>, octaves: u32) -> f32 {
    var sum = 0.0;
    var frequency = 1.0;
    for (var i = 0u; i < octaves; i++) {
        sum += perlin(frequency * p) / frequency;
        frequency *= 2.0;
    }
    return sum;
}

// Returns (sin(frequency x + amplitude N(p)) + 1) / 2.
fn veins(p: vec3<f32>, x: f32, frequency: f32, amplitude: f32, octaves: u32) -> f32 {
    // Drivers compute sines of large angles with large errors.
    let turns = (frequency * x + amplitude * turbulence(p, octaves)) / (2.0 * PI);
    return 0.5 * (sin(2.0 * PI * (turns - floor(turns + 0.5))) + 1.0);
}
