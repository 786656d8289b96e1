//! Pictures of a scene with common mistakes of student programs.

use crate::document::CompiledDocument;
use crate::protocol::MistakeChoice;
use durer::mistakes::{Formulas, MISTAKES, Mistake, mistake_by_name, mistaken_picture};
use durer::render::{Job, Sampling};

/// Maximum number of pixels of a picture with a mistake.
const MAX_PIXELS: u64 = 1 << 18;
/// Maximum number of samples of a picture with a mistake. Pictures that need more are rendered
/// with one sample per pixel.
const MAX_SAMPLES: u64 = 1 << 20;

/// A picture with a mistake.
pub(crate) struct MistakenPicture {
    /// Four bytes per pixel.
    pub pixels: Vec<u8>,
    /// Fraction of the pixels that differ from the correct picture.
    pub changed: f64,
    /// Description and code of the mistake.
    pub mistake: Option<MistakeChoice>,
}

/// Returns the mistakes of the table.
pub(crate) fn choices(compiled: &CompiledDocument) -> Vec<MistakeChoice> {
    let formulas = Formulas::of(compiled.scene(), compiled.world.rules());
    MISTAKES.iter().copied().flatten().map(|mistake| choice(mistake, compiled, &formulas, None)).collect()
}

/// Returns the description and the code of a mistake for a value, or for its first value.
fn choice(mistake: &Mistake, compiled: &CompiledDocument, formulas: &Formulas, value: Option<f32>) -> MistakeChoice {
    let values = mistake.values.numbers(compiled.world.lights().len());
    let value = value.or(values.first().copied()).unwrap_or_default();
    let [right, wrong] = mistake.code(value, formulas);
    MistakeChoice {
        name: mistake.name.into(),
        description: mistake.describe(value),
        right,
        wrong,
        topic: mistake.step.into(),
        values,
    }
}

/// Renders the scene with a mistake. Without a name, renders the correct picture.
pub(crate) fn picture(
    compiled: &CompiledDocument,
    job: Job,
    name: Option<&str>,
    value: Option<f32>,
) -> Result<MistakenPicture, String> {
    let pixels = u64::from(job.width) * u64::from(job.height);
    if pixels > MAX_PIXELS {
        return Err(format!("pictures with mistakes have at most {MAX_PIXELS} pixels"));
    }
    let is_affordable = pixels.saturating_mul(job.sampling.samples().into()) <= MAX_SAMPLES;
    let job = if is_affordable { job } else { Job { sampling: Sampling::Center, ..job } };
    let by_name = |name| mistake_by_name(name).ok_or_else(|| format!("there is no mistake `{name}`"));
    let mistake = name.map(by_name).transpose()?;
    let first = |mistake: &Mistake| mistake.values.numbers(compiled.world.lights().len()).first().copied();
    let value = value.filter(|value| value.is_finite()).or(mistake.and_then(first)).unwrap_or_default();
    let render = |mistake| mistaken_picture(compiled.scene(), &compiled.world, &job, mistake);
    let right = render(None);
    let wrong = mistake.map_or_else(|| right.clone(), |mistake| render(Some((mistake, value))));
    let changed = right.iter().zip(&wrong).filter(|(right, wrong)| right != wrong).count();
    let formulas = Formulas::of(compiled.scene(), compiled.world.rules());
    Ok(MistakenPicture {
        mistake: mistake.map(|mistake| choice(mistake, compiled, &formulas, Some(value))),
        pixels: wrong.iter().flat_map(|&[r, g, b]| [r, g, b, 255]).collect(),
        changed: changed as f64 / right.len().max(1) as f64,
    })
}
