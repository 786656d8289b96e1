//! Closed-loop tests with synthetic cameras and points. The tests check that these are
//! reconstructed despite outliers, and that errors match the computed covariance.

use durer_photo::adjust::{Options as Adjust, adjust, covariance};
use durer_photo::geometry::align::{Similarity, align_cameras as aligned};
use durer_photo::matching::{FORMAT, MatchedPhoto, Matches, PhotoPair, Track, TrackObservation};
use durer_photo::model::axis_angle_of;
use durer_photo::random::Random;
use durer_photo::solve::{Options, solve};
use durer_photo::{Lens, Observation, Point, Pose, Reconstruction, View};
use nalgebra::{Cholesky, DMatrix, DVector, Vector2, Vector3};

const SIZE: [u32; 2] = [1000, 750];
const FOCAL: f64 = 950.0;

fn cameras(count: u32) -> Vec<Pose> {
    let camera = |i: u32| {
        let angle = 0.13 * f64::from(i);
        let center = Vector3::new(6.0 * libm::sin(angle), 1.0 + 0.3 * f64::from(i % 3), 6.0 * libm::cos(angle));
        Pose::look_at(&center, &Vector3::zeros(), &Vector3::y())
    };
    (0..count).map(camera).collect()
}

/// Returns cameras and points whose observations have normally distributed errors with a standard
/// deviation of `noise` pixels.
fn scene(views: u32, points: usize, noise: f64, seed: u64) -> Reconstruction {
    let random = &mut Random::new(seed);
    let lens = Lens { distortion: [-0.08, 0.03], ..Lens::new(SIZE, FOCAL) };
    let poses = cameras(views);
    let point = |_| {
        let position = Vector3::from_fn(|_, _| 3.0 * random.unit() - 1.5);
        let mut track = Vec::new();
        for (view, pose) in poses.iter().enumerate() {
            let error = noise * Vector2::new(random.normal(), random.normal());
            let pixel = lens.project(&pose.apply(&position)) + error;
            // Two fifths of the observations are missing, as if they were occluded.
            if random.unit() < 0.6 {
                track.push(Observation { view, feature: 0, pixel });
            }
        }
        Point { position, color: [0; 3], track }
    };
    let points = (0..points).map(point).collect();
    let view = |(i, pose): (usize, &Pose)| View { name: i.to_string(), lens: 0, pose: Some(*pose) };
    Reconstruction { lenses: vec![lens], views: poses.iter().enumerate().map(view).collect(), points }
}

/// Returns the matches of a scene, in which the fraction `outliers` of the observations is false.
fn matches(all: &Reconstruction, focal: f64, outliers: f64) -> Matches {
    let random = &mut Random::new(99);
    let track = |point: &Point| {
        let sighting = |seen: &Observation| {
            let random_pixel = Vector2::new(1000.0 * random.unit(), 750.0 * random.unit());
            let pixel = if random.unit() < outliers { random_pixel } else { seen.pixel };
            TrackObservation(seen.view, 0, pixel.x, pixel.y)
        };
        Track { color: [0; 3], observations: point.track.iter().map(sighting).collect() }
    };
    let tracks: Vec<Track> = all.points.iter().map(track).collect();
    let picture = |view: &View| MatchedPhoto {
        name: view.name.clone(),
        size: SIZE,
        focal,
        focal_source: "a guess".into(),
        lens: 0,
        features: 0,
    };
    let count = all.views.len();
    let common = |a: usize, b: usize| {
        let has = |track: &&Track| [a, b].iter().all(|view| track.observations.iter().any(|seen| seen.0 == *view));
        tracks.iter().filter(has).count()
    };
    let link = |(a, b): (usize, usize)| PhotoPair {
        pictures: [a, b],
        candidates: 0,
        matches: common(a, b),
        planar_fraction: 0.3,
        median_shift: 50.0,
    };
    let pairs = (0..count).flat_map(|a| (a + 1..count).map(move |b| (a, b)));
    let links = pairs.map(link).collect();
    Matches { format: FORMAT.into(), pictures: all.views.iter().map(picture).collect(), links, tracks }
}

/// Aligns the cameras by a similarity. Returns the maximum distance between corresponding cameras,
/// and the maximum angle between them in degrees.
fn differences(found: &Reconstruction, truth: &Reconstruction) -> (f64, f64) {
    let poses = |all: &Reconstruction| all.views.iter().map(|view| view.pose.unwrap()).collect::<Vec<_>>();
    let (found, truth) = (poses(found), poses(truth));
    let there = aligned(&found, &truth).unwrap();
    found.iter().zip(&truth).fold((0.0, 0.0), |(far, angle), (a, b)| {
        let turned = a.rotation * there.rotation.transpose() * b.rotation.transpose();
        let distance = (there.apply(&a.center()) - b.center()).norm();
        (distance.max(far), axis_angle_of(&turned).norm().to_degrees().max(angle))
    })
}

#[test]
fn cameras_are_found_from_correspondences() {
    let truth = scene(20, 400, 0.2, 1);
    for (focal, outliers) in [(1000.0, 0.0), (1000.0, 0.3), (4000.0, 0.0)] {
        let solved = solve(&matches(&truth, focal, outliers), &Options::default(), &|_| {}).unwrap();
        assert_eq!(solved.reconstruction.registered_count(), 20, "{:?}", solved.notes);
        let (far, angle) = differences(&solved.reconstruction, &truth);
        let wrong = (solved.reconstruction.lenses[0].focal / FOCAL - 1.0).abs();
        println!("{focal} {outliers}: {far} {angle} {wrong}");
        // The scene is 3 units wide.
        assert!(far < 0.003 && angle < 0.05 && wrong < 0.002, "{far} {angle} {wrong}");
    }
}

#[test]
fn solution_is_independent_of_threads() {
    let given = matches(&scene(8, 200, 0.5, 2), 1000.0, 0.1);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| solve(&given, &Options::default(), &|_| {}).unwrap().reconstruction)
    };
    let one = on(1);
    assert!(one == on(2) && one == on(5));
}

#[test]
fn missing_depth_is_reported() {
    let why =
        |all: &Reconstruction| solve(&matches(all, FOCAL, 0.0), &Options::default(), &|_| {}).err().unwrap().message;
    // The camera only rotates.
    let mut turned = scene(4, 300, 0.2, 3);
    let center = turned.views[0].pose.unwrap().center();
    for (i, view) in turned.views.iter_mut().enumerate() {
        let pose = Pose::look_at(&center, &Vector3::new(0.1 * i as f64, 0.0, 0.0), &Vector3::y());
        view.pose = Some(pose);
        for point in &mut turned.points {
            let pixel = turned.lenses[0].project(&pose.apply(&point.position));
            point.track.iter_mut().filter(|seen| seen.view == i).for_each(|seen| seen.pixel = pixel);
        }
    }
    assert!(why(&turned).contains("the camera only rotated"), "{}", why(&turned));
    // In this scene, all matches are false.
    let chance = matches(&scene(4, 300, 0.2, 3), FOCAL, 1.0);
    let error = solve(&chance, &Options::default(), &|_| {}).err().unwrap();
    assert!(error.message.contains("enough points that agree"), "{error}");
}

/// Transforms the reconstruction so that the first camera, and one component of another camera's
/// translation, equal the true values.
fn in_frame(found: &mut Reconstruction, truth: &Reconstruction, far: usize, component: usize) {
    let pose = |all: &Reconstruction, i: usize| all.views[i].pose.unwrap();
    let rotation = pose(truth, 0).rotation.transpose() * pose(found, 0).rotation;
    let (from, to) = (pose(found, 0).center(), pose(truth, 0).center());
    Similarity { scale: 1.0, rotation, translation: to - rotation * from }.apply_to(found);
    // Scaling by s about the first camera changes the translation of the other camera from a + b to
    // a + s b.
    let there = pose(found, far);
    let a = -(there.rotation * to)[component];
    let scale = (pose(truth, far).translation[component] - a) / (there.translation[component] - a);
    Similarity { scale, rotation: nalgebra::Matrix3::identity(), translation: to - scale * to }.apply_to(found);
}

#[test]
fn errors_match_their_covariance() {
    let options = Adjust { radial: false, tolerance: 1e-12, ..Adjust::default() };
    let (mut sum, mut count) = (0.0, 0);
    for seed in 0..6 {
        let truth = scene(7, 150, 1.0, 100 + seed);
        let mut found = truth.clone();
        assert!(adjust(&mut found, &options).converged);
        let known = covariance(&found, &options).unwrap();
        assert!((known.sigma - 1.0).abs() < 0.08, "{}", known.sigma);
        let size = known.matrix.nrows();
        let held = (6..size - 3).find(|i| !known.free.contains(i)).unwrap();
        in_frame(&mut found, &truth, held / 6, held % 6 - 3);
        let known = covariance(&found, &options).unwrap();
        let mut error = DVector::zeros(size);
        for i in 0..7 {
            let (a, b) = (found.views[i].pose.unwrap(), truth.views[i].pose.unwrap());
            error.fixed_rows_mut::<3>(6 * i).copy_from(&axis_angle_of(&(b.rotation * a.rotation.transpose())));
            error.fixed_rows_mut::<3>(6 * i + 3).copy_from(&(b.translation - a.translation));
        }
        error[size - 3] = truth.lenses[0].focal - found.lenses[0].focal;
        let n = known.free.len();
        let part = DMatrix::from_fn(n, n, |i, j| known.matrix[(known.free[i], known.free[j])]);
        let error = DVector::from_fn(n, |i, _| error[known.free[i]]);
        sum += error.dot(&Cholesky::new(part).unwrap().solve(&error));
        count += n;
    }
    // χ² with n degrees of freedom has the mean n and the variance 2 n.
    let off = (sum - count as f64) / (2.0 * count as f64).sqrt();
    println!("χ² {sum} of {count}: {off} standard deviations");
    assert!(off.abs() < 4.0, "{sum} of {count}");
}
