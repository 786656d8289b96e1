//! Builds a tree over custom primitives, which are balls here.
//!
//! Run it with `cargo run --release --example custom_primitive`.

use durer_bvh::Bvh;
use durer_bvh::TraversalStats;
use durer_bvh::math::{Aabb, Ray, Vec3};

struct Ball {
    center: Vec3,
    radius: f32,
}

impl Ball {
    fn bounds(&self) -> Aabb {
        Aabb { min: self.center - self.radius, max: self.center + self.radius }
    }

    /// Returns the first `t` in the ray's interval at which the ray hits the ball, for a direction
    /// of length 1.
    fn intersect(&self, ray: &Ray) -> Option<f32> {
        let from = ray.origin - self.center;
        let b = from.dot(ray.dir);
        let root = (b * b - from.length_squared() + self.radius * self.radius).sqrt();
        [-b - root, -b + root].into_iter().find(|t| ray.contains(*t))
    }
}

/// Returns the closest ball that a ray hits, and the `t` of the hit.
fn closest(bvh: &Bvh, balls: &[Ball], ray: &Ray, stats: &mut TraversalStats) -> Option<(usize, f32)> {
    let mut best = None;
    // The tree calls the closure with the position of each primitive that the ray may hit, roughly
    // from near to far. The closure returns the new end of the ray.
    bvh.traverse(ray, stats, |place, t_max, _| {
        let ball = bvh.primitive_indices()[place] as usize;
        match balls[ball].intersect(&Ray { t_max, ..*ray }) {
            Some(t) => {
                best = Some((ball, t));
                t
            }
            None => t_max,
        }
    });
    best
}

pub(crate) fn main() {
    let mut balls: Vec<Ball> = (0..1000)
        .map(|i| Ball { center: Vec3::new((i % 10) as f32, (i / 10 % 10) as f32, (i / 100) as f32), radius: 0.2 })
        .collect();
    let bounds = |balls: &[Ball]| balls.iter().map(Ball::bounds).collect::<Vec<_>>();
    let mut bvh = Bvh::build(&bounds(&balls));

    let ray = Ray::new(Vec3::new(3.0, 4.1, -5.0), Vec3::Z);
    let mut stats = TraversalStats::default();
    let (ball, t) = closest(&bvh, &balls, &ray, &mut stats).expect("a ball lies ahead");
    println!("ball {ball} at {t}, after {} nodes", stats.nodes);
    assert_eq!(ball, 43);

    // After primitives have moved a little, refitting the tree is enough.
    balls[43].center.x += 0.5;
    bvh.refit(&bounds(&balls));
    let (ball, t) = closest(&bvh, &balls, &ray, &mut stats).expect("another lies behind it");
    println!("ball {ball} at {t}");
    assert_eq!(ball, 143);
}
