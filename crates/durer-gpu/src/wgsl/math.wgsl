// Vectors, rounding bounds and maps from the unit square.

const PI: f32 = 3.14159265f;
// Half the distance from 1 to the next number.
const ROUNDOFF: f32 = 5.9604645e-8f;

// Returns a bound on the relative error after `n` roundings (Higham, Accuracy and Stability of
// Numerical Algorithms, section 3.1).
fn gamma(n: f32) -> f32 {
    return n * ROUNDOFF / (1.0 - n * ROUNDOFF);
}

fn max_component(v: vec3<f32>) -> f32 {
    return max(v.x, max(v.y, v.z));
}

fn is_black(color: vec3<f32>) -> bool {
    return color.x == 0.0 && color.y == 0.0 && color.z == 0.0;
}

// Returns the unit vector along `v`, or `otherwise` if `v` has no direction.
fn unit_or(v: vec3<f32>, otherwise: vec3<f32>) -> vec3<f32> {
    let scale = max_component(abs(v));
    if !(scale > 0.0 && scale < FAR) {
        return otherwise;
    }
    // Dividing first keeps the squares within range.
    let scaled = v / scale;
    return scaled / sqrt(dot(scaled, scaled));
}

// Maps a point with the rows of an affine map.
fn map_point(x: vec4<f32>, y: vec4<f32>, z: vec4<f32>, p: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(dot(x.xyz, p) + x.w, dot(y.xyz, p) + y.w, dot(z.xyz, p) + z.w);
}

fn map_vector(x: vec4<f32>, y: vec4<f32>, z: vec4<f32>, v: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(dot(x.xyz, v), dot(y.xyz, v), dot(z.xyz, v));
}

// Maps a vector with the transpose of the linear part.
fn map_transposed(x: vec4<f32>, y: vec4<f32>, z: vec4<f32>, v: vec3<f32>) -> vec3<f32> {
    return v.x * x.xyz + v.y * y.xyz + v.z * z.xyz;
}

struct Frame {
    tangent: vec3<f32>,
    bitangent: vec3<f32>,
    normal: vec3<f32>,
}

// Returns a frame around a unit normal (Duff et al., Building an Orthonormal Basis, Revisited,
// JCGT 6(1), 2017).
fn frame_around(n: vec3<f32>) -> Frame {
    let s = select(1.0, -1.0, n.z < 0.0);
    let a = -1.0 / (s + n.z);
    let b = n.x * n.y * a;
    return Frame(
        vec3<f32>(1.0 + s * n.x * n.x * a, s * b, -s * n.x),
        vec3<f32>(b, s + n.y * n.y * a, -n.y),
        n,
    );
}

fn to_local(frame: Frame, v: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(dot(v, frame.tangent), dot(v, frame.bitangent), dot(v, frame.normal));
}

fn to_world(frame: Frame, v: vec3<f32>) -> vec3<f32> {
    return v.x * frame.tangent + v.y * frame.bitangent + v.z * frame.normal;
}

// Maps the unit square uniformly to the unit disc (Shirley and Chiu, A Low Distortion Map Between
// Disk and Square, 1997).
fn warp_disc(u: vec2<f32>) -> vec2<f32> {
    let p = 2.0 * u - 1.0;
    if p.x == 0.0 && p.y == 0.0 {
        return vec2<f32>(0.0);
    }
    let flat = abs(p.x) > abs(p.y);
    let radius = select(p.y, p.x, flat);
    let ratio = select(p.x, p.y, flat) / radius;
    let angle = 0.25 * PI * select(2.0 - ratio, ratio, flat);
    return radius * vec2<f32>(cos(angle), sin(angle));
}

// Returns a direction in the upper hemisphere with density cos / pi.
fn warp_cosine(u: vec2<f32>) -> vec3<f32> {
    let p = warp_disc(u);
    return vec3<f32>(p, sqrt(max(1.0 - dot(p, p), 0.0)));
}

// Returns the direction with a cosine to z and an azimuth in turns.
fn warp_polar(cosine: f32, turn: f32) -> vec3<f32> {
    let sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    let angle = 2.0 * PI * turn;
    return vec3<f32>(sine * cos(angle), sine * sin(angle), cosine);
}
