use super::*;

/// Triangulates a polygon in a tilted plane. Returns the triangles and twice their signed areas,
/// which are positive if the winding agrees with the polygon's normal.
fn cut(outline: &[[f32; 2]]) -> (Vec<[usize; 3]>, Vec<f64>) {
    let corner = |i: usize| {
        let [x, y] = outline[i];
        // The map is affine and keeps x and y, so that areas projected along z are unchanged.
        Vec3::new(x, y, 0.25 * x + 0.5 * y)
    };
    let mut triangles = Vec::new();
    Triangulator::new(0).triangulate(outline.len(), corner, |t| triangles.push(t)).unwrap();
    let point = |i: usize| outline[i].map(f64::from);
    let areas = triangles.iter().map(|&[a, b, c]| area(point(a), point(b), point(c))).collect();
    (triangles, areas)
}

fn shoelace(outline: &[[f32; 2]]) -> f64 {
    let point = |i: usize| outline[i % outline.len()].map(f64::from);
    (1..outline.len() - 1).map(|i| area(point(0), point(i), point(i + 1))).sum()
}

fn check(outline: &[[f32; 2]]) {
    let expected = shoelace(outline);
    let (triangles, areas) = cut(outline);
    assert_eq!(triangles.len(), outline.len() - 2, "{outline:?}");
    assert!(areas.iter().all(|a| a * expected >= 0.0), "a triangle is outside: {outline:?} {triangles:?}");
    let sum: f64 = areas.iter().sum();
    assert!((sum - expected).abs() <= 1e-9 * expected.abs(), "{sum} is not {expected}: {outline:?}");
}

#[test]
fn concave_outlines_keep_area_and_winding() {
    let dart = [[0.0, 0.0], [4.0, 0.0], [1.0, 1.0], [0.0, 4.0]];
    let l = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]];
    let star: Vec<[f32; 2]> = (0..10)
        .map(|i| {
            let (x, y) =
                [(10, 0), (3, 2), (3, 10), (-1, 4), (-8, 6), (-4, 0), (-8, -6), (-1, -4), (3, -10), (3, -2)][i];
            [x as f32, y as f32]
        })
        .collect();
    // The outline is a square with a square hole, and it follows the bridge between them twice.
    let ring =
        [[0, 0], [4, 0], [4, 4], [0, 4], [0, 0], [1, 1], [1, 3], [3, 3], [3, 1], [1, 1]].map(|p| p.map(|c| c as f32));
    let comb: Vec<[f32; 2]> = (0..200)
        .map(|i| [i as f32, if i % 2 == 0 { 0.0 } else { 50.0 }])
        .chain([[200.0, 60.0], [-1.0, 60.0]])
        .collect();
    for outline in [&dart[..], &l, &star, &ring, &comb] {
        let outline = outline.to_vec();
        // Start the outline at every corner, in both winding orders.
        for start in 0..outline.len() {
            let mut turned = outline.clone();
            turned.rotate_left(start);
            check(&turned);
            turned.reverse();
            check(&turned);
        }
    }
}

#[test]
fn collinear_corners_make_no_empty_triangle_if_avoidable() {
    let square = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];
    let triangle = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [0.0, 2.0]];
    for outline in [&square[..], &triangle] {
        check(outline);
        assert!(cut(outline).1.iter().all(|&a| a > 0.0));
    }
}

#[test]
fn convex_outlines_become_fans() {
    let hexagon = [[2.0, 0.0], [1.0, 2.0], [-1.0, 2.0], [-2.0, 0.0], [-1.0, -2.0], [1.0, -2.0]];
    check(&hexagon);
    assert_eq!(cut(&hexagon).0, [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]]);
    assert_eq!(cut(&hexagon[..4]).0, [[0, 1, 2], [0, 2, 3]]);
    assert_eq!(cut(&hexagon[..3]).0, [[0, 1, 2]]);
}

#[test]
fn crossing_and_empty_outlines_are_triangulated() {
    let pentagram = [[0.0, 3.0], [-2.0, -3.0], [3.0, 1.0], [-3.0, 1.0], [2.0, -3.0]];
    assert_eq!(cut(&pentagram).0.len(), 3);
    assert_eq!(cut(&[[1.0, 1.0]; 9]).0.len(), 7);
    let line: Vec<[f32; 2]> = (0..9).map(|i| [i as f32, 0.0]).collect();
    assert_eq!(cut(&line).0.len(), 7);
    let extreme = [[f32::MAX, 0.0], [0.0, f32::MAX], [f32::MIN, 0.0], [0.0, f32::MIN], [1.0, 1.0], [2.0, -1.0]];
    assert_eq!(cut(&extreme).0.len(), 4);
}

#[test]
fn random_outlines_are_cut_completely_and_work_is_bounded() {
    let mut state = 1u32;
    let mut random = || {
        state = state.wrapping_mul(1664525).wrapping_add(1013904223);
        (state >> 24) as f32
    };
    for count in 5..60 {
        let outline: Vec<[f32; 2]> = (0..count).map(|_| [random(), random()]).collect();
        let (triangles, areas) = cut(&outline);
        assert_eq!(triangles.len(), count - 2);
        assert!((areas.iter().sum::<f64>() - shoelace(&outline)).abs() < 1e-6);
    }
    let points: Vec<Vec3> = (0..300).map(|_| Vec3::new(random(), random(), 0.0)).collect();
    let mut triangulator = Triangulator { budget: 1000, ..Triangulator::default() };
    assert_eq!(triangulator.triangulate(points.len(), |i| points[i], |_| {}), Err(TooComplex));
}
