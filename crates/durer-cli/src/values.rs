//! What may stand after options.

use durer::dialect::Compat;

pub fn compat(text: &str) -> Result<(Compat, bool), String> {
    let (name, on) = text.strip_prefix("no-").map_or((text, true), |name| (name, false));
    Compat::from_name(name).map(|compat| (compat, on)).ok_or_else(|| {
        let names = Compat::ALL.iter().map(|row| row.1);
        match durer::diag::did_you_mean(name, names) {
            Some(near) => format!("there is no such quirk; did you mean `{near}`?"),
            None => "there is no such quirk; see `durer dialects`".into(),
        }
    })
}

/// A weight below which rays are left out.
pub fn weight(text: &str) -> Result<f32, String> {
    text.parse().ok().filter(|w: &f32| w.is_finite() && *w >= 0.0).ok_or_else(|| "say a number, 0 or more".into())
}

pub fn pixel(text: &str) -> Result<(u32, u32), String> {
    let numbers = text.split_once(',').and_then(|(x, y)| Some((x.trim().parse().ok()?, y.trim().parse().ok()?)));
    numbers.ok_or_else(|| "say it as 200,150: column and row from the upper left corner".into())
}

pub fn size(text: &str) -> Result<(u32, u32), String> {
    let parse = || {
        let (width, height) = text.split_once(['x', 'X'])?;
        Some((width.parse().ok()?, height.parse().ok()?))
    };
    let size: (u32, u32) = parse().ok_or("say it as 640x480")?;
    if size.0 == 0 || size.1 == 0 { Err("a picture has at least one pixel".into()) } else { Ok(size) }
}

pub fn crop(text: &str) -> Result<(u32, u32, u32, u32), String> {
    let mut parts = text.splitn(3, ',');
    let mut number = || parts.next()?.trim().parse().ok();
    let corner: Option<(u32, u32)> = number().zip(number());
    let ((left, top), (width, height)) =
        corner.zip(parts.next().and_then(|s| size(s).ok())).ok_or("say it as 10,20,64x48")?;
    Ok((left, top, width, height))
}

pub fn cells(text: &str) -> Result<[u32; 3], String> {
    let numbers: Option<Vec<u32>> = text.split(['x', 'X']).map(|n| n.parse().ok()).collect();
    let cells: Option<[u32; 3]> = numbers.and_then(|n| n.try_into().ok());
    cells.filter(|c| !c.contains(&0)).ok_or("say it as 10x10x10".into())
}

pub fn tolerance(text: &str) -> Result<f32, String> {
    let value: Option<f32> = match text.split_once('/') {
        Some((n, of)) => n.trim().parse().ok().zip(of.trim().parse::<f32>().ok()).map(|(n, of): (f32, f32)| n / of),
        None => text.parse().ok(),
    };
    value.filter(|t| t.is_finite() && *t >= 0.0).ok_or_else(|| "say it as 2/255 or as a number, 0 or more".into())
}

pub fn percent(text: &str) -> Result<f64, String> {
    text.trim_end_matches('%')
        .parse()
        .ok()
        .filter(|p| (0.0..=100.0).contains(p))
        .ok_or_else(|| "say a number from 0 to 100".into())
}
