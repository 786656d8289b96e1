//! Explanation of fireflies. It finds the brightest term of a sample, the path to this term, and
//! the improbable choice on the path.

use super::Explanation;
use super::numbers::number;
use crate::film::luminance_of;
use crate::integrator::trace::TermKind;
use crate::integrator::{TraceNode, Tree};

impl Explanation {
    /// Returns the index of the sample that adds the most light, and the luminance that it adds to
    /// the pixel. Returns `None` for a black pixel.
    pub fn brightest(&self) -> Option<(usize, f64)> {
        let all: f64 = self.samples.iter().map(|s| f64::from(s.weight)).sum();
        let adds = |i: usize| {
            let s = &self.samples[i];
            let light = s.light.as_ref().map_or(0.0, |light| luminance_of(light.sum()));
            f64::from(s.weight) * light / all
        };
        let best = (0..self.samples.len()).max_by(|&a, &b| adds(a).total_cmp(&adds(b)).then(b.cmp(&a)))?;
        (adds(best) > 0.0).then(|| (best, adds(best)))
    }

    /// Returns the index of a sample that is far brighter than the others, and its share of the
    /// luminance of the pixel.
    pub fn outlier(&self) -> Option<(usize, f64)> {
        // A share is normal if it is below this value or below four times the average share.
        let usual = (4.0 / self.samples.len() as f64).clamp(0.2, 0.9);
        let (number, adds) = self.brightest()?;
        let share = adds / luminance_of(self.color);
        (self.samples.len() > 1 && share >= usual).then_some((number, share))
    }

    /// Explains in sentences why that sample is so bright. The result is empty if there is no such
    /// sample.
    pub fn firefly(&self) -> Vec<String> {
        let Some((number, share)) = self.outlier() else { return Vec::new() };
        let mut causes = vec![format!("sample {number} alone is {:.0} % of the pixel's luminance", 100.0 * share)];
        causes.extend(self.samples[number].light.iter().flat_map(cause));
        causes.push(
            "more samples make such pixels rarer, not darker; `--clamp 10` limits them but also removes some light"
                .into(),
        );
        causes
    }
}

/// Follows the brightest terms from the root of a tree to their source and explains their weight.
fn cause(light: &Tree) -> Vec<String> {
    let (mut node, mut chosen) = (&light.root, Vec::new());
    let adds = |node: &TraceNode| luminance_of(light.color(node.contribution()));
    loop {
        if let TermKind::Ray { bounce: Some(bounce), .. } = &node.kind {
            chosen.push(bounce);
        }
        let next = node.terms.iter().max_by(|a, b| adds(a).total_cmp(&adds(b)));
        match next.filter(|next| adds(next) > 0.0) {
            Some(next) => node = next,
            None => break,
        }
    }
    let path_text = chosen.iter().map(|bounce| bounce.lobe).collect::<Vec<_>>().join(", then ");
    // Delta lobes have no probability density.
    let single = chosen.last().is_some_and(|last| last.pdf == 0.0);
    let seldom = chosen.iter().filter(|bounce| bounce.pdf > 0.0).min_by(|a, b| a.pdf.total_cmp(&b.pdf));
    let text = |what: &str| match chosen.is_empty() {
        true => format!("{what} is seen directly"),
        false => format!("BSDF sampling hit {what} after {path_text}"),
    };
    let mut causes = Vec::new();
    match &node.kind {
        TermKind::Emission { .. } | TermKind::Sky if single && seldom.is_some() => {
            let what = if matches!(node.kind, TermKind::Sky) { "the sky" } else { "an emitter" };
            causes.push(text(what));
            causes.push(
                "light sampling cannot follow mirrors and glass, so such light is found rarely and then has a large \
                 weight: `--integrator photons` traces it from the light instead"
                    .into(),
            );
        }
        TermKind::Emission { mis } => {
            causes.push(text("an emitter"));
            causes.push(format!(
                "the emitter's MIS weight is {}: light sampling finds this emitter even less often",
                number(*mis)
            ));
        }
        TermKind::Sky => causes.push(text("the sky")),
        TermKind::Direct { choice, pdf, mis, .. } => {
            let path_text = if chosen.is_empty() { "at the first hit".into() } else { format!("after {path_text}") };
            causes.push(format!(
                "light sampling found a light {path_text}, with probability {} and density {} /sr (MIS weight {})",
                number(*choice),
                number(*pdf),
                number(*mis)
            ));
            if *choice < 0.1 {
                causes.push(
                    "the light tree considered this light dim and chose it with a low probability, by which the sample \
                     is divided"
                        .into(),
                );
            }
        }
        _ => {}
    }
    if let Some(seldom) = seldom.filter(|seldom| seldom.pdf < 0.05) {
        causes.push(format!(
            "the direction sampled by {} has a density of only {} /sr: all light from that direction is divided by \
             this density",
            seldom.lobe,
            number(seldom.pdf)
        ));
    }
    causes
}
