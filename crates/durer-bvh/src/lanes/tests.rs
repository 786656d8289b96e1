//! Tests that all SIMD levels give the same result, bit for bit, for any numbers.

use super::*;
use crate::math::random::{Random, rounds};
use crate::math::{Doubles, Triple};
use crate::watertight::AxisOrder;
use crate::watertight::axis_order_for;
use glam::Vec3A;

/// Special values for arithmetic: zeros, infinities, NaN, and very large and very small numbers.
const SPECIAL: [f32; 14] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    f32::MIN_POSITIVE,
    -1e-45,
    1e-40,
    f32::MAX,
    f32::MIN,
    f32::INFINITY,
    f32::NEG_INFINITY,
    f32::NAN,
    16777217.0,
    0.1,
];

fn number(random: &mut Random) -> f32 {
    match random.below(4) {
        0 => SPECIAL[random.below(SPECIAL.len())],
        // Signaling NaNs are left out. On ARM, the compiler turns `if a > b { a } else { b }` into
        // one instruction that passes them through.
        1 => match f32::from_bits(random.bits() as u32) {
            x if x.is_nan() => f32::NAN,
            x => x,
        },
        _ => random.between(-2.0, 2.0),
    }
}

/// Random arguments for all operations.
struct Input {
    floats: [[f32; WIDTH]; 3],
    rows: Rows,
    stride: usize,
    turn: AxisOrder,
    order: [u8; WIDTH],
    count: u32,
    mask: u32,
}

impl Input {
    fn random(random: &mut Random) -> Self {
        let mut eight = || std::array::from_fn(|_| number(random));
        let floats = [eight(), eight(), eight()];
        let rows = std::array::from_fn(|_| number(random));
        let turn = axis_order_for(random.below(3), random.below(2));
        let order = std::array::from_fn(|_| random.below(WIDTH) as u8);
        let (count, mask) = (random.below(WIDTH + 1) as u32, random.below(256) as u32);
        Input { floats, rows, stride: 1 + random.below(WIDTH), turn, order, count, mask }
    }
}

/// Kernel that runs all operations except [`FloatLanes::mul_add`] and returns the bits of the
/// results. Every NaN is replaced by a NaN with fixed bits.
struct AllOperations<'a>(&'a Input);

/// Number of vectors computed for each input: arithmetic, double precision, two joined halves,
/// comparisons, a stack before and after, nine rows, columns, and wide vectors.
const OPERATIONS: usize = 12 + 3 * 9 + 2 + 9 + 5 + 2 + 9 + WIDTH + 2 * 11;

impl Kernel for AllOperations<'_> {
    type Output = Vec<u32>;

    #[inline(always)]
    fn run<L: Lanes>(self, lanes: L) -> Vec<u32> {
        let Input { floats, rows, stride, turn, order, count, mask } = self.0;
        let [a, b, c] = [lanes.load(&floats[0]), lanes.load(&floats[1]), lanes.load(&floats[2])];
        let mut results = Vec::with_capacity(WIDTH * OPERATIONS + 16);
        let number = |x: f32| if x.is_nan() { f32::NAN.to_bits() } else { x.to_bits() };
        // Read each vector by pushing it onto a stack.
        let mut record = |v: L::Floats, count: usize| {
            let mut storage = StackStorage::new();
            let mut stack = Stack::new(&mut storage);
            lanes.push(&mut stack, &[7; WIDTH], v, &[0, 1, 2, 3, 4, 5, 6, 7], count as u32);
            let (_, near, height) = stack.all();
            // SAFETY: all entries below the height have been written.
            (0..height).for_each(|i| results.push(number(unsafe { *near.add(i) })));
        };
        record(lanes.add(a, b), WIDTH);
        record(lanes.sub(a, b), WIDTH);
        record(lanes.mul(a, b), WIDTH);
        record(lanes.div(a, b), WIDTH);
        record(lanes.abs(a), WIDTH);
        record(lanes.min(a, c), WIDTH);
        record(lanes.max(a, c), WIDTH);
        record(lanes.min_as_int(a, c), WIDTH);
        record(lanes.max_as_int(a, c), WIDTH);
        lanes.interval([[a, c], [b, a], [c, b]], [b, c]).into_iter().for_each(|end| record(end, WIDTH));
        for corner in lanes.corners(rows, CornerColumns::new(turn, *stride)) {
            corner.into_iter().for_each(|row| record(row, *stride));
        }
        record(lanes.select(*mask, a, b), WIDTH);
        lanes.transpose([a, b, c, b, a, c, a, b]).into_iter().for_each(|row| record(row, WIDTH));
        results.extend(lanes.store(a).map(number));
        results.extend(wide(lanes.wide(), floats, *mask).map(number));
        let (p, q) = (lanes.doubles(a), lanes.doubles(c).mul(lanes.splat_double(0.1)));
        let bits = |x: f64| if x.is_nan() { [0; 2] } else { [x.to_bits() as u32, (x.to_bits() >> 32) as u32] };
        // The language does not specify the sign of a NaN.
        let signed = q.max(lanes.splat_double(f64::MIN));
        let of_one = [p, p.sqrt(), p.copysign(signed)];
        for doubles in of_one.into_iter().chain([p.add(q), p.sub(q), p.mul(q), p.div(q), p.min(q), p.max(q)]) {
            let numbers = lanes.store_doubles(doubles);
            results.extend([lanes.le_doubles(doubles, q), lanes.le_doubles(p, doubles)]);
            results.extend(numbers.into_iter().flat_map(bits));
            let again = lanes.load_doubles(&numbers).add(lanes.splat_double(numbers[0]));
            results.extend(lanes.store(lanes.singles(again)).map(number));
        }
        results.extend(lanes.wide().store(lanes.join([a, b])).map(number));
        let triple = |i: usize| lanes.triple(Vec3A::from_slice(&floats[i]));
        let (p, q) = (triple(0), triple(1).mul(triple(2)));
        for v in [p.add(q), p.sub(q), p.mul(q), p.div(q), p.min(q), p.max(q), p.cross(q)] {
            let all = [v.z(), v.yzx().z(), v.yzx().yzx().z(), v.sum(), v.dot(p)];
            results.extend(all.into_iter().flat_map(bits));
        }
        let turned = lanes.permute(Vec3A::from_slice(&floats[0]), turn);
        results.extend(turned.to_array().map(number));
        results.extend([lanes.le(a, b), lanes.lt(a, b), lanes.le(b, a), lanes.lt(b, a)]);
        // If no lane is hit, the lane is arbitrary.
        let (enter, leave) = (lanes.max_as_int(a, lanes.splat(0.0)), b);
        let before = lanes.lt_as_int(enter, leave);
        let (hits, nearest) = (lanes.signs(before), lanes.nearest(enter, before, &[10, 250, 12, 30, 14, 15, 201, 17]));
        results.extend(if hits == 0 { [0; 2] } else { [hits, nearest] });
        results.push(lanes.signs(a));
        let mut storage = StackStorage::new();
        let mut stack = Stack::new(&mut storage);
        let children = [10, 11, 12, 13, 14, 15, 16, 17];
        lanes.push(&mut stack, &children, a, order, *count);
        lanes.push(&mut stack, &children, b, order, WIDTH as u32 - count);
        results.extend(std::iter::from_fn(|| stack.pop_near()).flat_map(|(child, near)| [child, number(near)]));
        results
    }
}

/// Returns the results of all operations on sixteen lanes.
#[inline(always)]
fn wide<W: WideLanes>(lanes: W, [a, b, c]: &[[f32; WIDTH]; 3], mask: u32) -> [f32; 8 * WIDE + 6] {
    let join =
        |a: &[f32; WIDTH], b: &[f32; WIDTH]| std::array::from_fn(|i| if i < WIDTH { a[i] } else { b[i - WIDTH] });
    let (a, b) = (lanes.load(&join(a, b)), lanes.load(&join(b, c)));
    let vectors = [
        lanes.add(a, b),
        lanes.sub(a, b),
        lanes.mul(a, b),
        lanes.div(a, b),
        lanes.abs(a),
        lanes.min(a, b),
        lanes.max(a, b),
        lanes.select(mask | !mask << WIDTH, a, b),
    ];
    // `max` replaces NaN by its second operand.
    let ordered = lanes.max(a, lanes.splat(f32::MIN));
    let masks = [lanes.le(a, b), lanes.lt(a, b), lanes.le(b, a), lanes.lt(b, a)].map(|mask| mask as f32);
    let [p, q, r, s] = masks;
    // Zeros of either sign compare as equal.
    let others = [lanes.least(ordered) + 0.0, lanes.greatest(ordered) + 0.0, p, q, r, s];
    let mut results = [0.0; 8 * WIDE + 6];
    let all = vectors.into_iter().flat_map(|v| lanes.store(v)).chain(others);
    results.iter_mut().zip(all).for_each(|(to, x)| *to = x);
    results
}

/// Tests 10^6 lanes, or 10^9 lanes in the long run.
#[test]
fn every_level_gives_the_same_bits() {
    let mut random = Random(31);
    let inputs = rounds(1_000_000 / (WIDTH * OPERATIONS));
    for round in 0..inputs {
        let input = Input::random(&mut random);
        let expected = AllOperations(&input).run(scalar::Scalar);
        for level in SimdLevel::available() {
            assert_eq!(AvailableLevel::or_scalar(level).run(AllOperations(&input)), expected, "{round} {level:?}");
        }
    }
    println!("{} lanes at {} levels", inputs * WIDTH * OPERATIONS, SimdLevel::available().count());
}

/// Kernel with sums and products that a compiler might fuse or reorder.
struct Sums([[f32; 24]; 3]);

impl PlainKernel for Sums {
    type Output = [u32; 24];

    #[inline(always)]
    fn run(self) -> [u32; 24] {
        let [a, b, c] = self.0;
        let (mut bits, mut sum) = ([0; 24], 0.0);
        for i in 0..24 {
            let double = f64::from(a[i]) * f64::from(b[i]) + f64::from(c[i]);
            sum += (a[i] * b[i] + c[i]).abs().sqrt() / (b[i] * c[i] + a[i]) + double as f32;
            bits[i] = sum.to_bits();
        }
        bits
    }
}

#[test]
fn plain_code_has_the_same_bits_on_every_level() {
    let mut random = Random(27);
    for _ in 0..rounds(10_000) {
        let numbers = std::array::from_fn(|_| std::array::from_fn(|_| random.between(-2.0, 2.0)));
        for level in SimdLevel::available() {
            assert_eq!(AvailableLevel::or_scalar(level).run_plain(Sums(numbers)), Sums(numbers).run(), "{level:?}");
        }
    }
}
