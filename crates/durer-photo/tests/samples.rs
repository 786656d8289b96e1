//! What other programs wrote is read as they meant it: reprojection gives the figures that they, or their papers, give.

use durer_photo::adjust::{Loss, Options, adjust};
use durer_photo::format::{Output, read};
use durer_photo::model::{Fit, Reconstruction};
use std::path::{Path, PathBuf};

/// The shared photographs, if they are here.
fn samples() -> Option<PathBuf> {
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    let folder = std::env::var_os("DURER_CORPUS").map_or_else(beside, PathBuf::from).join("samples/photos");
    if !folder.is_dir() {
        println!("skipped: there is no {}", folder.display());
        return None;
    }
    Some(folder)
}

/// A file's reconstruction, with how many views, points and observations it must have.
fn sample(folder: &Path, name: &str, views: usize, points: usize, observations: usize) -> (Reconstruction, Fit) {
    let all = read(&folder.join(name)).unwrap();
    let fit = all.fit();
    assert_eq!((all.views.len(), all.points.len(), fit.observations), (views, points, observations), "{name}");
    (all, fit)
}

#[track_caller]
fn near(value: f64, expected: f64, tolerance: f64) {
    assert!((value - expected).abs() <= tolerance, "{value} instead of {expected}");
}

#[test]
fn stored_solutions_reproject_as_published() {
    let Some(folder) = samples() else { return };
    let (bal, fit) = sample(&folder, "bal/problem-16-22106-pre.txt", 16, 22106, 83718);
    near(fit.cost, 4.185660e6, 0.5);
    near(fit.rms, 10.0, 0.005);
    assert_eq!(bal.lenses.len(), 16);
    let (_, fit) = sample(&folder, "gtsam/dubrovnik-3-7-pre.txt", 3, 7, 19);
    near(fit.cost, 2.764220e3, 5e-4);
    let (kermit, fit) = sample(&folder, "bundler-kermit/results.example/bundle.out", 11, 634, 2039);
    assert_eq!(kermit.registered(), 9);
    near(fit.rms, 0.493, 5e-4);
    near(fit.max, 7.46, 5e-3);
    let before = kermit.points.iter().flat_map(|point| point.track.iter().map(|seen| (point.position, seen.view)));
    assert!(before.into_iter().all(|(point, view)| kermit.views[view].pose.unwrap().depth(&point) > 0.0));
    let (_, fit) = sample(&folder, "gtsam/Balbianello.out", 5, 544, 1417);
    near(fit.rms, 0.423, 5e-4);
    near(fit.max, 6.94, 5e-3);
    let mut parts = Vec::new();
    let berlin = folder.join("opensfm-berlin");
    // The tracks' file has a name that no reader would guess from the reconstruction's: both end in `_example`.
    parts.push(sample(&berlin, "reconstruction_example.json", 3, 1430, 3082));
    near(parts[0].1.rms / 3264.0, 0.000755, 1e-6);
    near(parts[0].1.rms, 2.47, 0.01);
}

#[test]
fn adjusting_reaches_the_published_ends() {
    let Some(folder) = samples() else { return };
    let mut bal = read(&folder.join("bal/problem-16-22106-pre.txt")).unwrap();
    let start = std::time::Instant::now();
    let report = adjust(&mut bal, &Options::default());
    println!("{:?} in {:?}", report.costs, start.elapsed());
    assert!(report.converged && bal.fit().cost <= 1.80340e4, "{:?}", report.costs);
    for name in ["gtsam/dubrovnik-3-7-pre.txt", "bundler-kermit/results.example/bundle.out", "gtsam/Balbianello.out"] {
        let mut all = read(&folder.join(name)).unwrap();
        let before = all.fit().cost;
        let report = adjust(&mut all, &Options::default());
        println!("{name}: {before} to {} in {} steps", all.fit().cost, report.costs.len() - 1);
        assert!(all.fit().cost <= before);
    }
    let mut berlin = read(&folder.join("opensfm-berlin/reconstruction_example.json")).unwrap();
    let before = berlin.fit().cost;
    adjust(&mut berlin, &Options { loss: Loss::Huber(3.0), ..Options::default() });
    println!("berlin: {before} to {}", berlin.fit().cost);
}

#[test]
fn every_format_gives_back_what_it_was_given() {
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
            back.set_picture(i, &view.name, berlin.lenses[view.lens].size);
        }
        assert!((back.fit().cost - berlin.fit().cost).abs() < 1e-6 * berlin.fit().cost, "{name}: {:?}", back.fit());
        assert_eq!(back.track_length(), berlin.track_length(), "{name}");
        for (ours, theirs) in back.views.iter().zip(&berlin.views) {
            let distance = (ours.pose.unwrap().center() - theirs.pose.unwrap().center()).norm();
            assert!(distance < 1e-9, "{name}: {distance}");
        }
    }
}
