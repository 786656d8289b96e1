//! Tests with files written by other programs. They check that the reprojection errors match the
//! figures published by the programs or their papers.

use durer_photo::adjust::{Loss, Options, adjust, covariance};
use durer_photo::format::{Output, read, read_project};
use durer_photo::geometry::align::align_points;
use durer_photo::geometry::triangulate::nearest_to_rays;
use durer_photo::model::{Reconstruction, ReprojectionError, rotation_of};
use durer_photo::random::Random;
use durer_photo::resect::from_vanishing_lines;
use durer_photo::solve::solve;
use durer_photo::{matching, photo};
use nalgebra::{Cholesky, DMatrix, DVector, Vector3};
use std::path::{Path, PathBuf};

/// Returns the folder with the shared photographs, if it exists.
fn samples() -> Option<PathBuf> {
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    let folder = std::env::var_os("DURER_CORPUS").map_or_else(beside, PathBuf::from).join("samples/photos");
    if !folder.is_dir() {
        println!("skipped: {} not found", folder.display());
        return None;
    }
    Some(folder)
}

/// Reads a file and checks its numbers of views, points, and observations.
fn sample(
    folder: &Path,
    name: &str,
    views: usize,
    points: usize,
    observations: usize,
) -> (Reconstruction, ReprojectionError) {
    let all = read(&folder.join(name)).unwrap();
    let fit = all.reprojection_error();
    assert_eq!((all.views.len(), all.points.len(), fit.observations), (views, points, observations), "{name}");
    (all, fit)
}

#[track_caller]
fn assert_near(value: f64, expected: f64, tolerance: f64) {
    assert!((value - expected).abs() <= tolerance, "{value} instead of {expected}");
}

#[test]
fn stored_solutions_reproject_as_published() {
    let Some(folder) = samples() else { return };
    let (bal, fit) = sample(&folder, "bal/problem-16-22106-pre.txt", 16, 22106, 83718);
    assert_near(fit.cost, 4.185660e6, 0.5);
    assert_near(fit.rms, 10.0, 0.005);
    assert_eq!(bal.lenses.len(), 16);
    let (_, fit) = sample(&folder, "gtsam/dubrovnik-3-7-pre.txt", 3, 7, 19);
    assert_near(fit.cost, 2.764220e3, 5e-4);
    let (kermit, fit) = sample(&folder, "bundler-kermit/results.example/bundle.out", 11, 634, 2039);
    assert_eq!(kermit.registered_count(), 9);
    assert_near(fit.rms, 0.493, 5e-4);
    assert_near(fit.max, 7.46, 5e-3);
    let before = kermit.points.iter().flat_map(|point| point.track.iter().map(|seen| (point.position, seen.view)));
    assert!(before.into_iter().all(|(point, view)| kermit.views[view].pose.unwrap().depth(&point) > 0.0));
    let (_, fit) = sample(&folder, "gtsam/Balbianello.out", 5, 544, 1417);
    assert_near(fit.rms, 0.423, 5e-4);
    assert_near(fit.max, 6.94, 5e-3);
    let (_, fit) = sample(&folder, "opensfm-berlin/reconstruction_example.json", 3, 1430, 3082);
    assert_near(fit.rms / 3264.0, 0.000755, 1e-6);
    assert_near(fit.rms, 2.47, 0.01);
}

#[test]
fn adjustment_reaches_the_published_costs() {
    let Some(folder) = samples() else { return };
    let mut bal = read(&folder.join("bal/problem-16-22106-pre.txt")).unwrap();
    let report = adjust(&mut bal, &Options::default());
    assert!(report.converged && bal.reprojection_error().cost <= 1.80340e4, "{:?}", report.costs);
    for name in ["gtsam/dubrovnik-3-7-pre.txt", "bundler-kermit/results.example/bundle.out", "gtsam/Balbianello.out"] {
        let mut all = read(&folder.join(name)).unwrap();
        let before = all.reprojection_error().cost;
        let report = adjust(&mut all, &Options::default());
        assert!(report.converged && all.reprojection_error().cost <= before, "{name}");
    }
    // This solution has many outliers, which OpenSfM weights less strongly.
    let mut berlin = read(&folder.join("opensfm-berlin/reconstruction_example.json")).unwrap();
    let before = berlin.reprojection_error().cost;
    adjust(&mut berlin, &Options { loss: Loss::Huber(3.0), ..Options::default() });
    assert!(berlin.reprojection_error().cost <= before);
}

#[test]
fn every_format_reads_back_what_it_writes() {
    let Some(folder) = samples() else { return };
    let berlin = read(&folder.join("opensfm-berlin/reconstruction_example.json")).unwrap();
    let place = tempfile::tempdir().unwrap();
    for (name, binary) in [("a.out", false), ("a.txt", false), ("a.json", false), ("text", false), ("binary", true)] {
        let path = place.path().join(name);
        let output = Output::of(&path, binary).unwrap();
        if output.is_folder() {
            std::fs::create_dir(&path).unwrap();
        }
        for (file, bytes) in output.files(&path).iter().zip(output.write(&berlin).unwrap()) {
            std::fs::write(file, bytes).unwrap();
        }
        let mut back = read(&path).unwrap();
        for (i, view) in berlin.views.iter().enumerate() {
            back.set_image(i, &view.name, berlin.lenses[view.lens].size);
        }
        assert!(
            (back.reprojection_error().cost - berlin.reprojection_error().cost).abs()
                < 1e-6 * berlin.reprojection_error().cost,
            "{name}: {:?}",
            back.reprojection_error()
        );
        assert_eq!(back.track_length(), berlin.track_length(), "{name}");
        for (ours, theirs) in back.views.iter().zip(&berlin.views) {
            let distance = (ours.pose.unwrap().center() - theirs.pose.unwrap().center()).norm();
            assert!(distance < 1e-9, "{name}: {distance}");
        }
    }
}

/// glTF has no tracks, and stores positions in single precision, whereas PLY has no cameras.
#[test]
fn gltf_keeps_cameras_and_ply_keeps_points() {
    let Some(folder) = samples() else { return };
    let berlin = read(&folder.join("opensfm-berlin/reconstruction_example.json")).unwrap();
    let place = tempfile::tempdir().unwrap();
    let again = |name: &str| {
        let path = place.path().join(name);
        std::fs::write(&path, &Output::of(&path, false).unwrap().write(&berlin).unwrap()[0]).unwrap();
        read(&path).unwrap()
    };
    let (gltf, ply) = (again("a.gltf"), again("a.ply"));
    assert_eq!(
        (gltf.views.len(), gltf.registered_count(), gltf.lenses[0].size, ply.views.len()),
        (3, 3, [3264, 2448], 0)
    );
    for all in [&gltf, &ply] {
        assert_eq!(all.points.len(), berlin.points.len());
        for (ours, theirs) in all.points.iter().zip(&berlin.points) {
            assert_eq!(ours.color, theirs.color);
            assert_eq!(ours.position, theirs.position.map(|value| f64::from(value as f32)));
        }
    }
    // The projections stay the same with the lens and pose of the glTF file.
    let mut seen = berlin.clone();
    (seen.lenses, seen.views) = (gltf.lenses, gltf.views);
    assert_near(seen.reprojection_error().cost, berlin.reprojection_error().cost, 1e-6);
}

/// Reconstructs the scene from the photographs in a folder.
fn solved(folder: &Path, names: &[String]) -> Reconstruction {
    let options = matching::Options { features: 1500, ..Default::default() };
    let described = names.iter().map(|name| {
        let photo = photo::read(name, &std::fs::read(folder.join(name)).unwrap(), u64::MAX).unwrap();
        matching::describe(&photo, &options)
    });
    let matches = matching::match_all(described.collect(), &options, &|_| {}).unwrap();
    solve(&matches, &Default::default(), &|_| {}).unwrap().reconstruction
}

/// Returns the maximum distance between corresponding camera centres, as a fraction of the largest
/// distance between two centres of `theirs`.
fn max_center_distance(ours: &Reconstruction, theirs: &Reconstruction) -> f64 {
    let both = ours.views.iter().zip(&theirs.views);
    let (ours, theirs): (Vec<_>, Vec<_>) = both.filter_map(|(a, b)| Some((a.pose?.center(), b.pose?.center()))).unzip();
    let there = align_points(&ours, &theirs).unwrap();
    let extent = theirs.iter().flat_map(|a| theirs.iter().map(move |b| (a - b).norm())).fold(0.0, f64::max);
    ours.iter().zip(&theirs).map(|(a, b)| (there.apply(a) - b).norm()).fold(0.0, f64::max) / extent
}

#[test]
fn photographs_become_cameras() {
    let Some(folder) = samples() else { return };
    let folder = folder.join("bundler-kermit");
    let mut bundler = read(&folder.join("results.example/bundle.out")).unwrap();
    let names: Vec<String> = (0..11).map(|i| format!("kermit{i:03}.jpg")).collect();
    for (i, name) in names.iter().enumerate() {
        let photo = photo::read(name, &std::fs::read(folder.join(name)).unwrap(), u64::MAX).unwrap();
        assert_eq!(
            (&*photo.exif.camera, photo.exif.focal.as_ref().unwrap().0.round()),
            ("Canon Canon PowerShot A10", 661.0)
        );
        bundler.set_image(i, name, photo.size());
    }
    let solved = solved(&folder, &names);
    assert_eq!(solved.registered_count(), 11);
    let fit = solved.reprojection_error();
    assert!(fit.rms <= 0.6 && fit.observations > 3000, "{fit:?}");
    assert!((solved.lenses[0].focal - 695.0).abs() < 5.0, "{:?}", solved.lenses[0]);
    assert!(max_center_distance(&solved, &bundler) < 0.03, "{}", max_center_distance(&solved, &bundler));
    stored_places_are_off(&solved, &bundler);
}

/// Shows that the camera positions stored by Bundler are off by more than 1 % of their extent.
/// Bundler gave each photograph its own focal length, from 638 to 729 pixels, although EXIF states
/// a single focal length. In addition, its least-squares fit included some outliers.
fn stored_places_are_off(solved: &Reconstruction, bundler: &Reconstruction) {
    // Bundler's observations fit our cameras better than Bundler's cameras, although Bundler used
    // its own cameras to select the observations.
    let (ours, theirs) = (median_residual(solved, bundler), median_residual(bundler, bundler));
    println!("median residual of what Bundler saw: {ours} with our cameras, {theirs} with its own");
    assert!(ours < 0.85 * theirs, "{ours} {theirs}");
    // With a single lens, Bundler's observations reproduce our cameras.
    let mut one = bundler.clone();
    one.lenses = vec![durer_photo::Lens { distortion: [0.0; 2], ..bundler.lenses[0] }];
    one.views.iter_mut().for_each(|view| view.lens = 0);
    adjust(&mut one, &Options { loss: Loss::Cauchy(1.0), ..Options::default() });
    assert!(max_center_distance(solved, &one) < 0.005, "{}", max_center_distance(solved, &one));
    // Bundler's lenses and least squares also reproduce our cameras if the few observations that
    // are off by more than two pixels are dropped.
    let mut clean = bundler.clone();
    let mut dropped = 0;
    for (point, known) in clean.points.iter_mut().zip(&one.points) {
        let before = point.track.len();
        point.track.retain(|seen| one.residual(&known.position, seen).unwrap().norm() < 2.0);
        dropped += before - point.track.len();
    }
    clean.points.retain(|point| point.track.len() > 1);
    adjust(&mut clean, &Options::default());
    let (from_ours, from_stored) = (max_center_distance(solved, &clean), max_center_distance(&clean, bundler));
    println!("without {dropped} of 2039 observations: {from_ours} from ours, {from_stored} from what is stored");
    assert!(dropped < 25 && from_ours < 0.01 && from_stored > 0.015, "{dropped} {from_ours} {from_stored}");
}

/// Returns the median residual of the observations, where each point is triangulated from the rays
/// of `cameras`.
fn median_residual(cameras: &Reconstruction, seen: &Reconstruction) -> f64 {
    let mut all = Vec::new();
    for point in &seen.points {
        let ray = |seen: &durer_photo::Observation| {
            let view = &cameras.views[seen.view];
            let pose = view.pose.unwrap();
            let direction = cameras.lenses[view.lens].unproject(&seen.pixel).unwrap();
            (pose.center(), pose.direction_to_world(&direction).normalize())
        };
        let position = nearest_to_rays(&point.track.iter().map(ray).collect::<Vec<_>>()).unwrap();
        all.extend(point.track.iter().map(|seen| cameras.residual(&position, seen).unwrap().norm()));
    }
    all.sort_by(f64::total_cmp);
    all[all.len() / 2]
}

/// Draws positions from the covariance to check how uncertain the camera positions are. Bundler's
/// observations are assumed to have normally distributed errors as large as their residuals.
#[test]
fn bundler_observations_do_not_determine_positions_to_1_percent() {
    let Some(folder) = samples() else { return };
    let mut bundler = read(&folder.join("bundler-kermit/results.example/bundle.out")).unwrap();
    adjust(&mut bundler, &Options::default());
    let known = covariance(&bundler, &Options::default()).unwrap();
    let free = |i: usize, j: usize| known.matrix[(known.free[i], known.free[j])];
    let factor = Cholesky::new(DMatrix::from_fn(known.free.len(), known.free.len(), free)).unwrap().l();
    let random = &mut Random::new(5);
    let mut draw = || {
        let step = &factor * DVector::from_fn(known.free.len(), |_, _| random.normal());
        let mut all = vec![0.0; known.matrix.nrows()];
        known.free.iter().zip(step.iter()).for_each(|(row, value)| all[*row] = *value);
        let mut moved = bundler.clone();
        for (view, at) in &known.views {
            let three = |i: usize| Vector3::new(all[at + i], all[at + i + 1], all[at + i + 2]);
            let pose = moved.views[*view].pose.as_mut().unwrap();
            pose.rotation = rotation_of(&three(0)) * pose.rotation;
            pose.translation += three(3);
        }
        max_center_distance(&moved, &bundler)
    };
    let mut draws: Vec<f64> = (0..400).map(|_| draw()).collect();
    draws.sort_by(f64::total_cmp);
    println!("median {}, 19 of 20 up to {}", draws[200], draws[380]);
    assert!(draws[200] > 0.008 && draws[380] > 0.015, "{} {}", draws[200], draws[380]);
}

#[test]
fn wrong_exif_focal_length_is_corrected() {
    let Some(folder) = samples() else { return };
    let bundler = read(&folder.join("gtsam/Balbianello.out")).unwrap();
    let names: Vec<String> = (1..6).map(|i| format!("BalbianelloMedium-{i}.jpg")).collect();
    // The photographs were scaled down, but EXIF still gives a focal length of 3767 pixels.
    let solved = solved(&folder.join("gtsam"), &names);
    assert_eq!(solved.registered_count(), 5);
    assert!(
        solved.reprojection_error().rms <= 0.6 && (solved.lenses[0].focal - 520.0).abs() < 15.0,
        "{:?}",
        solved.lenses[0]
    );
    assert!(max_center_distance(&solved, &bundler) < 0.01, "{}", max_center_distance(&solved, &bundler));
}

#[test]
fn three_photographs_of_a_phone_become_cameras() {
    let Some(folder) = samples() else { return };
    let folder = folder.join("opensfm-berlin");
    let opensfm = read(&folder.join("reconstruction_example.json")).unwrap();
    let names: Vec<String> = (1..4).map(|i| format!("0{i}.jpg")).collect();
    let solved = solved(&folder.join("images"), &names);
    assert_eq!(solved.registered_count(), 3);
    let (ours, theirs) = (solved.reprojection_error(), opensfm.reprojection_error());
    // Features are detected in photographs that are reduced by a factor of 3264 / 1600.
    println!("{ours:?} {}", max_center_distance(&solved, &opensfm));
    assert!(ours.rms <= 0.6 * 3264.0 / 1600.0 && ours.rms < 0.5 * theirs.rms, "{ours:?}");
    assert!(max_center_distance(&solved, &opensfm) < 0.01, "{}", max_center_distance(&solved, &opensfm));
}

#[test]
fn fspy_cameras_see_their_vanishing_points() {
    let Some(folder) = samples() else { return };
    let all = read(&folder.join("fspy/json_export.json")).unwrap();
    let (lens, pose) = (all.lenses[0], all.views[0].pose.unwrap());
    // According to the file, the vanishing points are (1.605, 0.001) for -x, (-0.652, 0.003) for z,
    // and (-0.375, -436) for y, where the longer side ranges from -1 to 1.
    for (axis, x, y) in [
        (-nalgebra::Vector3::x(), 1.6051650133994935_f64, 0.001021010320067342_f64),
        (nalgebra::Vector3::z(), -0.652074716204382, 0.0029610261811691915),
        (nalgebra::Vector3::y(), -0.3747357368992343, -436.0110710388304),
    ] {
        let pixel = lens.project(&(pose.rotation * axis));
        let (u, v) = ((pixel.x - lens.principal_point[0]) / 719.5, (lens.principal_point[1] - pixel.y) / 719.5);
        // The y axis is almost perpendicular to the view direction, so its vanishing point is far
        // away and less accurate.
        assert!((u - x).abs() < 1e-3 * (1.0 + y.abs()) && (v - y).abs() < 1e-3 * (1.0 + y.abs()), "{u} {v}");
    }
    let mut found = 0;
    for entry in std::fs::read_dir(folder.join("fspy")).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|end| end != "fspy") {
            continue;
        }
        let bytes = std::fs::read(&path).unwrap();
        let Ok((lines, _)) = read_project("project", &bytes) else { continue };
        let Ok((lens, pose)) = from_vanishing_lines(&lines, 1.0) else { continue };
        found += 1;
        let to = |point: &nalgebra::Vector2<f64>, line: &[nalgebra::Vector2<f64>; 2]| {
            let along = (line[1] - line[0]).normalize();
            (along.x * (point.y - line[0].y) - along.y * (point.x - line[0].x)).abs() / (point - line[0]).norm()
        };
        for (axis, set) in lines.axes.iter().zip(&lines.lines) {
            let direction = nalgebra::Vector3::ith(axis.index, if axis.negative { -1.0 } else { 1.0 });
            let point = lens.project(&(pose.rotation * direction));
            assert!(set.iter().all(|line| to(&point, line) < 1e-6), "{}", path.display());
        }
    }
    assert!(found >= 6, "{found}");
}
