// Watertight ray-triangle intersection, with the edge rule of `durer-bvh/src/watertight`.
//
// A shear transform aligns the ray with one axis. The ray crosses the triangle if the projected
// edges wind around the origin. The sign of each edge function is exact: where single precision
// cannot decide it, the two products are compared as integers. This also holds if the compiler
// fuses multiplications and additions. A ray through an edge or a vertex counts as shifted by
// (e, e^2), so it crosses exactly one of the triangles around it.
//
// Sources: Woop, Benthin, Wald, Watertight Ray/Triangle Intersection, JCGT 2(1), 2013; Edelsbrunner
// and Mücke, Simulation of Simplicity, ACM TOG 9(1), 1990.

// Ray with permuted axes: the longest component of its direction is the third axis.
struct ShearedRay {
    axes: vec3<u32>,
    origin: vec3<f32>,
    // Length of the direction along the third axis.
    along: f32,
    // Sideways displacement per unit along the third axis.
    shear: vec2<f32>,
}

fn permuted(v: vec3<f32>, axes: vec3<u32>) -> vec3<f32> {
    return vec3<f32>(v[axes.x], v[axes.y], v[axes.z]);
}

// The order of the axes preserves the sides of triangles.
fn axis_order(dir: vec3<f32>) -> vec3<u32> {
    let size = abs(dir);
    if size.z >= size.x && size.z >= size.y {
        return select(vec3<u32>(0u, 1u, 2u), vec3<u32>(1u, 0u, 2u), dir.z < 0.0);
    }
    if size.y >= size.x {
        return select(vec3<u32>(2u, 0u, 1u), vec3<u32>(0u, 2u, 1u), dir.y < 0.0);
    }
    return select(vec3<u32>(1u, 2u, 0u), vec3<u32>(2u, 1u, 0u), dir.x < 0.0);
}

fn sheared_ray(origin: vec3<f32>, dir: vec3<f32>) -> ShearedRay {
    let axes = axis_order(dir);
    let d = permuted(dir, axes);
    return ShearedRay(axes, permuted(origin, axes), d.z, d.xy / d.z);
}

// Exact product of two numbers: (high 2^24 + low) 2^exponent, with `high` at least 2^23, and its
// sign, which is 0 for a product of 0. Numbers below the normal range count as 0.
struct ExactProduct {
    sign: i32,
    exponent: u32,
    high: u32,
    low: u32,
}

fn exact_product(a: f32, b: f32) -> ExactProduct {
    let x = bitcast<u32>(a);
    let y = bitcast<u32>(b);
    let exponent_x = (x >> 23u) & 255u;
    let exponent_y = (y >> 23u) & 255u;
    if exponent_x == 0u || exponent_y == 0u {
        return ExactProduct(0, 0u, 0u, 0u);
    }
    let m = (x & 0x7fffffu) | 0x800000u;
    let n = (y & 0x7fffffu) | 0x800000u;
    // Digits in base 2^12.
    let m0 = m & 0xfffu;
    let m1 = m >> 12u;
    let n0 = n & 0xfffu;
    let n1 = n >> 12u;
    let middle = m0 * n1 + m1 * n0;
    let lower = m0 * n0 + ((middle & 0xfffu) << 12u);
    var low = lower & 0xffffffu;
    var high = m1 * n1 + (middle >> 12u) + (lower >> 24u);
    var exponent = exponent_x + exponent_y + 1u;
    if high < 0x800000u {
        high = (high << 1u) | (low >> 23u);
        low = (low << 1u) & 0xffffffu;
        exponent -= 1u;
    }
    let sign = select(1, -1, ((x ^ y) >> 31u) == 1u);
    return ExactProduct(sign, exponent, high, low);
}

// Returns the sign of a b - c d.
fn compare_products(a: f32, b: f32, c: f32, d: f32) -> i32 {
    let p = exact_product(a, b);
    let q = exact_product(c, d);
    if p.sign != q.sign {
        return select(-1, 1, p.sign > q.sign);
    }
    if p.exponent != q.exponent {
        return select(-p.sign, p.sign, p.exponent > q.exponent);
    }
    if p.high != q.high {
        return select(-p.sign, p.sign, p.high > q.high);
    }
    if p.low != q.low {
        return select(-p.sign, p.sign, p.low > q.low);
    }
    return 0;
}

// Returns true if the edge from p to q runs clockwise around the origin.
fn is_front_edge(p: vec2<f32>, q: vec2<f32>) -> bool {
    let left = q.x * p.y;
    let right = q.y * p.x;
    let value = left - right;
    let size = abs(value);
    // Also with a fused operation, the error is below this bound.
    if size > 4.8e-7 * (abs(left) + abs(right)) && size > 1e-30 && size < 1e37 {
        return value > 0.0;
    }
    let order = compare_products(q.x, p.y, q.y, p.x);
    if order != 0 {
        return order > 0;
    }
    // Coefficients of e and e^2 of the edge function at (e, e^2).
    if q.y != p.y {
        return q.y > p.y;
    }
    return p.x > q.x;
}

struct Crossing {
    is_hit: bool,
    t: f32,
    uv: vec2<f32>,
}

// Returns the crossing of a ray with a triangle in the open interval (t_min, t_max).
fn cross_triangle(ray: ShearedRay, a: vec3<f32>, b: vec3<f32>, c: vec3<f32>, t_min: f32, t_max: f32) -> Crossing {
    let miss = Crossing(false, FAR, vec2<f32>(0.0));
    let pa = permuted(a, ray.axes) - ray.origin;
    let pb = permuted(b, ray.axes) - ray.origin;
    let pc = permuted(c, ray.axes) - ray.origin;
    let fa = pa.xy - ray.shear * pa.z;
    let fb = pb.xy - ray.shear * pb.z;
    let fc = pc.xy - ray.shear * pc.z;
    let front = is_front_edge(fb, fc);
    if is_front_edge(fc, fa) != front || is_front_edge(fa, fb) != front {
        return miss;
    }
    // Twice the areas of the triangles from the origin to the edges. Rounding can give a value near
    // 0 the wrong sign.
    var areas = vec3<f32>(fc.x * fb.y - fc.y * fb.x, fa.x * fc.y - fa.y * fc.x, fb.x * fa.y - fb.y * fa.x);
    areas = select(min(areas, vec3<f32>(0.0)), max(areas, vec3<f32>(0.0)), front);
    let sum = areas.x + areas.y + areas.z;
    if sum == 0.0 {
        return miss;
    }
    // A weighted mean of the heights of the corners stays between them.
    let weights = areas / sum;
    let t = dot(weights, vec3<f32>(pa.z, pb.z, pc.z)) / ray.along;
    if !(t > t_min && t < t_max) {
        return miss;
    }
    return Crossing(true, t, weights.yz);
}
