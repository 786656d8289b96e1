//! Tests of the traces of paths: the sum of all terms, and the clamp on single terms.

use super::*;
use crate::integrator::{TraceRecorder, Tree};

/// Returns the trace of a sample. Checks that the trace's sum equals the sample's colour bit for
/// bit, and that the product of the factors along each path is the throughput.
pub(super) fn tree(path: &Path, ray: &Ray, sample: u32) -> Tree {
    fn check(node: &TraceNode) {
        assert_eq!(node.sum(), node.value, "{:?}", node.kind);
        let throughput = |node: &TraceNode| node.throughput.unwrap().spectrum();
        for term in &node.terms {
            let expected = throughput(node) * term.factor.spectrum() * term.scale.spectrum();
            let difference = (throughput(term) - expected).abs();
            assert!(
                difference.cmple(1e-5 * expected.abs()).all(),
                "{:?}, expected {expected}: {term:?}",
                term.throughput
            );
            check(term);
        }
    }
    let id = SampleId::new(1, (0, 0), sample);
    let mut account = TraceRecorder::default();
    let seen = path.radiance(ray, id, &mut account);
    let tree = account.into_tree().unwrap();
    assert_eq!((tree.sum(), path.radiance(ray, id, &mut ())), (seen, seen));
    check(&tree.root);
    let nested = tree.color(tree.root.value);
    assert!((nested - seen).abs().max_element() <= 1e-5 * seen.abs().max_element(), "{nested}, expected {seen}");
    tree
}

/// Collects the light sources below a node, in order, each with the number of scattering events on
/// the way to the camera and with its contribution to the pixel.
fn sources(node: &TraceNode, rays: u32, found: &mut Vec<(u32, Spectrum)>) {
    for term in &node.terms {
        let adds = || term.path_contribution().unwrap().spectrum();
        match &term.kind {
            TermKind::Ray { .. } => sources(term, rays + 1, found),
            TermKind::Direct { .. } | TermKind::Photons { .. } => found.push((rays + 1, adds())),
            TermKind::Sky | TermKind::Emission { .. } => found.push((rays, adds())),
            other => panic!("{other:?}"),
        }
    }
}

/// Builds the inside of a matte sphere with a point light and a small emissive sphere, which causes
/// light of all depths.
fn closed_room() -> World {
    scene(
        &format!("{MATTE} PrincipledMaterial {{ baseColor 0 0 0 specularWeight 0 emissionLuminance 3 }}"),
        "PointLight { position 0.5 0.8 0 color 1 1 1 attenuation 0 0 1 }",
        "MaterialIndex 0 Sphere { center 0 0 0 radius 2 } MaterialIndex 1 Sphere { center -0.5 1 0 radius 0.2 }",
    )
}

fn from_center() -> Ray {
    Ray::new(Vec3::ZERO, Vec3::new(-0.6, -0.5, 0.2).normalize())
}

#[test]
fn clamping_limits_contributions_after_more_than_one_scattering() {
    let world = closed_room();
    let settings = RenderSettings { bounces: 6, ..Job::default().settings };
    let limit = 0.02;
    let all = |clamp, sample| {
        let path = Path::new(&world, settings, PathOptions { clamp, ..PathOptions::default() });
        let mut found = Vec::new();
        sources(&tree(&path, &from_center(), sample).root, 0, &mut found);
        found
    };
    let (mut kept, mut clamped) = (0, 0);
    for sample in 0..100 {
        for ((scatterings, with), (_, without)) in all(Some(limit), sample).into_iter().zip(all(None, sample)) {
            if scatterings < 2 || without.max_element() <= limit {
                assert_eq!(with, without);
                kept += u32::from(without.max_element() > limit);
            } else {
                assert!((with.max_element() - limit).abs() < 1e-6 * limit, "{with} of {without}");
                clamped += 1;
            }
        }
    }
    assert!(kept > 20 && clamped > 20, "{kept} {clamped}");
}

#[test]
fn reported_terms_of_a_path_sum_to_its_radiance() {
    let world = closed_room();
    let settings = RenderSettings { bounces: 6, ..Job::default().settings };
    for (sample, color) in (0..200).zip([ColorMode::Rgb, ColorMode::Spectral].into_iter().cycle()) {
        let path = Path::new(&world, settings, PathOptions { clamp: Some(0.02), color, ..PathOptions::default() });
        let tree = tree(&path, &from_center(), sample);
        let lanes = if color == ColorMode::Rgb { 3 } else { 4 };
        assert_eq!(tree.root.value.numbers().len(), lanes);
    }
}
