//! The report of `durer compare`, which is one HTML file that needs no network access.

use super::args::CompareArgs;
use super::compared_pair::{ComparedPair, Outcome, name};
use super::mistakes::words;
use super::pixel_hit::PixelHit;
use super::text;
use crate::failure::Failure;
use crate::page::{
    self, CompareReport, ComparisonReport, LargestDifference, PairPictures, PairReport, RegionHit, RegionReport,
    Report, StudentResult, with_data,
};
use durer::image::compare::{Comparison, Picture, Region, Scale, Verdict, heat_map};
use durer::image::{Image, Layer, Transfer, decode_linear};
use std::path::PathBuf;

/// Encodes the pictures of a pair for the page.
pub fn pair_pictures(reference: &Picture, picture: &Picture, comparison: &Comparison) -> Result<PairPictures, String> {
    let png = |(layer, transfer): (Layer, Transfer)| -> Result<String, String> {
        let png = page::png(layer, transfer).map_err(|_| "the picture is too large for a page")?;
        Ok(page::uri(&png))
    };
    Ok(PairPictures {
        reference: png(screen(reference))?,
        picture: png(screen(picture))?,
        heat: png((heat(comparison), Transfer::Linear))?,
    })
}

/// Returns the heat map as a layer.
pub fn heat(comparison: &Comparison) -> Layer {
    let map = heat_map(comparison.width, comparison.height, &comparison.flip_map);
    let pixels = map.pixels.iter().map(|pixel| pixel.map(decode_linear).into()).collect();
    Layer::data("heat", Image { width: comparison.width, height: comparison.height, pixels })
}

/// Returns a picture as a layer, with the transfer curve used to display it.
fn screen(picture: &Picture) -> (Layer, Transfer) {
    match picture.scale {
        Scale::Display => (Layer::data("", picture.image.clone()), Transfer::Linear),
        Scale::Linear => (Layer::color("", picture.image.clone()), Transfer::Srgb),
    }
}

/// Returns the page as text.
pub fn page(all: &[ComparedPair], extra: &[PathBuf], args: &CompareArgs) -> Result<String, Failure> {
    let students = text::students(all).into_iter();
    with_data(&Report::Compare(CompareReport {
        reference: args.reference.to_string_lossy().into_owned(),
        picture: args.picture.to_string_lossy().into_owned(),
        tolerance: args.tolerance,
        allow: args.allow,
        extra: extra.iter().map(|path| path.to_string_lossy().into_owned()).collect(),
        students: students
            .map(|(name, [same, different, missing, error])| StudentResult { name, same, different, missing, error })
            .collect(),
        csv: text::csv(all),
        pairs: all.iter().map(pair).collect(),
    }))
}

fn pair(compared: &ComparedPair) -> PairReport {
    let ComparedPair { pair, outcome, .. } = compared;
    let explained = compared.diagnosis.as_ref().and_then(|diagnosis| diagnosis.explanations.first());
    let different = compared.verdict() == Verdict::Different.name();
    PairReport {
        title: name(pair),
        name: pair.name.clone(),
        student: pair.student.clone(),
        verdict: compared.verdict().into(),
        error: if let Outcome::Failed(reason) = outcome { Some(reason.clone()) } else { None },
        mistake: explained.filter(|_| different).map(words),
        causes: compared.causes(),
        note: compared.note.clone(),
        comparison: match (outcome, &compared.pictures) {
            (Outcome::Compared(comparison), Some(pictures)) => Some(metrics(comparison, &compared.hits, pictures)),
            _ => None,
        },
    }
}

fn metrics(comparison: &Comparison, hits: &[PixelHit], pictures: &PairPictures) -> ComparisonReport {
    let m = &comparison.measures;
    let region = |(i, region): (usize, &Region)| RegionReport {
        x: region.x,
        y: region.y,
        width: region.width,
        height: region.height,
        text: text::region_text(region),
        there: hits.get(i).map(|hit| RegionHit {
            hit: hit.line(),
            command: hit.command.clone(),
            explanation: hit.explanation.clone(),
        }),
    };
    ComparisonReport {
        width: comparison.width,
        height: comparison.height,
        linear: comparison.scale == Scale::Linear,
        rmse: m.rmse,
        psnr: m.psnr.is_finite().then_some(m.psnr),
        ssim: m.ssim,
        flip: m.flip,
        hdr_flip: m.hdr_flip,
        over_tolerance: m.over_tolerance,
        not_finite: m.not_finite,
        largest: m.largest.map(|largest| LargestDifference {
            difference: largest.difference,
            x: largest.x,
            y: largest.y,
            reference: largest.reference.to_array(),
            picture: largest.test.to_array(),
        }),
        regions: comparison.regions.iter().enumerate().map(region).collect(),
        pictures: pictures.clone(),
    }
}
