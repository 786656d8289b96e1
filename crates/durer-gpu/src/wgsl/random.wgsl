// Random numbers as a function of the pixel's hash, the sample and the dimension: points of the
// two-dimensional Sobol sequence with hash-based Owen scrambling, as in `sampler.rs` of
// `durer-scene`. Only the hash differs, because WGSL has no 64-bit integers.
//
// Sources: Laine, Karras, Stratified Sampling for Stochastic Transparency, EGSR 2011; Burley,
// Practical Hash-based Owen Scrambling, JCGT 9(4), 2020; Jarzynski, Olano, Hash Functions for GPU
// Rendering, JCGT 9(3), 2020 (pcg3d).

fn pcg3d(value: vec3<u32>) -> vec3<u32> {
    var v = value * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v ^= v >> vec3<u32>(16u);
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return v;
}

// Flips each bit depending on the key and the bits above it.
fn owen_scramble(bits: u32, key: u32) -> u32 {
    var v = reverseBits(bits);
    v ^= v * 0x3d20adeau;
    v += key;
    v *= (key >> 16u) | 1u;
    v ^= v * 0x05526c56u;
    v ^= v * 0x53a22864u;
    return reverseBits(v);
}

// Second coordinate of the Sobol sequence in units of 2^-32.
fn sobol_second(index: u32) -> u32 {
    var v = index;
    v ^= v >> 16u;
    v ^= (v & 0xff00ff00u) >> 8u;
    v ^= (v & 0xf0f0f0f0u) >> 4u;
    v ^= (v & 0xccccccccu) >> 2u;
    v ^= (v & 0xaaaaaaaau) >> 1u;
    return reverseBits(v);
}

// Converts the upper 24 bits to a number in [0, 1).
fn unit_number(bits: u32) -> f32 {
    return f32(bits >> 8u) * ROUNDOFF;
}

// Returns two numbers in [0, 1) that are stratified over the samples of a pixel.
fn random_pair(key: vec2<u32>, sample: u32, dimension: u32) -> vec2<f32> {
    let keys = pcg3d(vec3<u32>(key, dimension));
    let index = owen_scramble(sample, keys.x);
    return vec2<f32>(
        unit_number(owen_scramble(reverseBits(index), keys.y)),
        unit_number(owen_scramble(sobol_second(index), keys.z)),
    );
}
