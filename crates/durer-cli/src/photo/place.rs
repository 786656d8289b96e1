//! Implements `durer photo place`, which inserts objects of a scene into a photograph, with their
//! shadows.
//!
//! The scene is rendered with and without the objects. Where stand-ins are visible, the photograph
//! is multiplied by the ratio of the two renders. Source: Debevec, *Rendering Synthetic Objects
//! into Real Scenes*, SIGGRAPH 1998, section 5.3. Here a ratio replaces the difference of the
//! original method, so that the colours of the stand-ins cancel.

use super::args::PlaceArgs;
use super::inputs::{bytes, from_photo_error};
use crate::failure::from_render_error;
use crate::failure::{Failure, invalid_input};
use crate::file_registry::FileRegistry;
use crate::open::{CompiledInput, load_options, read};
use crate::options::accel;
use crate::output::{encode, format, save};
use crate::{job, progress};
use durer::diag::{Diagnostics, Files};
use durer::film::Filter;
use durer::film::aov::Aov;
use durer::image::{Image, Layer, Transfer, decode_srgb};
use durer::math::Vec3;
use durer::options::memory::Memory;
use durer::render::{Control, Job, PixelRect, Sampling, raster, render};
use durer::scene::{Group, Object, ObjectKind};
use durer::world::World;
use durer_photo::photo;
use std::sync::Arc;

/// Number of rays per pixel along each axis that measure the coverage by inserted objects.
const ACROSS: u32 = 4;
/// Number of pixel rows that are traced at once.
const BAND: u32 = 64;
/// Radius, in pixels, of the neighbourhood from which a partly covered pixel takes its shadow.
const SHADOW_RADIUS: usize = 2;

/// Runs `durer photo place`.
pub fn run(args: &PlaceArgs) -> Result<(), Failure> {
    let mut registry = FileRegistry::default();
    let format = format(&args.output)?;
    let name = args.backplate.to_string_lossy();
    let photo = photo::read(&name, &bytes(&args.backplate, &mut registry)?, Memory::default().limit())
        .map_err(from_photo_error)?;
    let destination = registry.register_output("--output", &args.output)?;
    let [width, height] = photo.size();
    let mut options = load_options(&args.reading);
    let threads = args.threads.map(usize::from);
    (options.accel, options.threads) = (accel(&args.job)?, threads);
    let mut with = read(&args.scene, &options, args.quiet, &mut registry)?.compile(&options, &mut registry)?;
    let stand_in = stand_ins(&with, &args.stand_in)?;
    let mut job = job::job(&args.job, None, &with.loaded, false)?;
    if args.job.options.requested_size().is_some_and(|size| size != (width, height)) {
        return Err(invalid_input(format!("the picture has the photograph's size, {width}x{height}: remove --size")));
    }
    (job.width, job.height) = (width, height);
    if let (Sampling::Filtered { filter, .. }, None) = (&mut job.sampling, args.job.options.get("filter")) {
        // A pixel of a photograph is the mean over the area of the pixel.
        *filter = Filter::Box { radius: 0.5 };
    }
    if raster(&with.world, width, height).empty() != (0, 0) {
        return Err(invalid_input(format!(
            "the scene's camera does not fit `{name}`, which is {width}x{height}: compute the camera with `durer photo \
             camera`"
        )));
    }
    let control = Arc::new(Control { threads, memory: options.memory, ..Control::default() });
    let color = |world: &World| -> Result<Vec<Vec3>, Failure> {
        let rendered =
            progress::watch(&control, args.quiet, || render(world, &job, &control)).map_err(from_render_error)?;
        Ok(rendered.layers.into_iter().next().map(|layer| layer.image.pixels.clone()).unwrap_or_default())
    };
    let colors = color(&with.world)?;
    let covered = coverage(&with.world, &job, &stand_in, &control, args.quiet)?;
    let root = with.loaded.scene.root.take();
    with.loaded.scene.root = root.map(|root| Group { objects: kept(root.objects, &stand_in) });
    let without = with.loaded.compile(&options, &mut Files::default(), &mut Diagnostics::default());
    let empty = color(&without.ok_or_else(|| invalid_input("the scene is not valid without the inserted objects"))?)?;
    let plate: Vec<Vec3> = photo.pixels.pixels().map(|p| Vec3::from(p.0.map(decode_srgb))).collect();
    let pixels = composed(width as usize, &plate, &colors, &empty, &covered);
    let layer =
        Layer::color("color", Image::from_pixels(width, height, pixels).map_err(|e| invalid_input(e.to_string()))?);
    let file = encode(format, &[layer], Transfer::Srgb, &[])?;
    save(&[(&destination, file)], args.quiet)
}

/// Returns a list that says for each material whether it belongs to a stand-in.
fn stand_ins(compiled: &CompiledInput, numbers: &[u32]) -> Result<Vec<bool>, Failure> {
    let count = compiled.loaded.scene.materials.len();
    let mut all = vec![false; count];
    for number in numbers {
        let slot = all.get_mut(*number as usize);
        *slot.ok_or_else(|| {
            invalid_input(format!(
                "--stand-in {number}: the scene has only {count} materials, which are numbered from 0"
            ))
        })? = true;
    }
    let objects = compiled.loaded.scene.root.iter().flat_map(|root| &root.objects);
    let (there, others) = objects.fold((false, false), |(a, b), object| {
        let (c, d) = (has(object, &all, true), has(object, &all, false));
        (a || c, b || d)
    });
    match (there, others) {
        (false, _) => Err(invalid_input("no object has a material given by --stand-in, so nothing can catch a shadow")),
        (_, false) => {
            Err(invalid_input("every object has a material given by --stand-in, so there is nothing to insert"))
        }
        _ => Ok(all),
    }
}

/// Returns true if an object contains a shape that is a stand-in (if `wanted`) or a shape that is
/// not one (if `!wanted`).
fn has(object: &Object, stand_in: &[bool], wanted: bool) -> bool {
    let own = object.material.is_some_and(|number| stand_in.get(number as usize) == Some(&true));
    match object.node.children() {
        [] => own == wanted,
        parts => parts.iter().any(|part| has(part, stand_in, wanted)),
    }
}

/// Removes all objects except stand-ins. A solid is kept if any of its parts is a stand-in.
fn kept(objects: Vec<Object>, stand_in: &[bool]) -> Vec<Object> {
    let one = |mut object: Object| {
        if !has(&object, stand_in, true) {
            return None;
        }
        object.node = match object.node {
            ObjectKind::Group(group) => ObjectKind::Group(Group { objects: kept(group.objects, stand_in) }),
            ObjectKind::Transform(ops, inner) => {
                ObjectKind::Transform(ops, Box::new(kept(vec![*inner], stand_in).pop()?))
            }
            node => node,
        };
        Some(object)
    };
    objects.into_iter().filter_map(one).collect()
}

/// Returns the fraction of each pixel that inserted objects cover.
fn coverage(
    world: &World,
    job: &Job,
    stand_in: &[bool],
    control: &Arc<Control>,
    quiet: bool,
) -> Result<Vec<f32>, Failure> {
    let (width, height) = (job.width * ACROSS, job.height * ACROSS);
    let mut covered = vec![0.0_f32; job.width as usize * job.height as usize];
    for top in (0..height).step_by((BAND * ACROSS) as usize) {
        let crop = PixelRect { left: 0, top, width, height: (BAND * ACROSS).min(height - top) };
        let aovs = Aov::from_name("material").into_iter().collect();
        let job =
            Job { width, height, crop: Some(crop), sampling: Sampling::Center, color: false, aovs, ..job.clone() };
        let rendered = progress::watch(control, quiet, || render(world, &job, control)).map_err(from_render_error)?;
        let Some(layer) = rendered.layers.first() else { continue };
        for (i, material) in layer.image.pixels.iter().enumerate() {
            let (x, y) = (i as u32 % width, top + i as u32 / width);
            // A negative material number means the background.
            let object = material.x >= 0.0 && stand_in.get(material.x as usize) != Some(&true);
            let pixel = (y / ACROSS) as usize * (width / ACROSS) as usize + (x / ACROSS) as usize;
            covered[pixel] += f32::from(u8::from(object)) / (ACROSS * ACROSS) as f32;
        }
    }
    Ok(covered)
}

/// Composes the final photograph from the render with the objects W, the render without them G, the
/// photograph P, the coverage a and the shadow r = W / G. The result is W + (1 - a) r (P - G),
/// which is W for a = 1 and P W / G for a = 0. In a partly covered pixel, r is the mean over the
/// neighbouring pixels.
fn composed(width: usize, plate: &[Vec3], with: &[Vec3], without: &[Vec3], covered: &[f32]) -> Vec<Vec3> {
    let height = plate.len() / width.max(1);
    let ratio = |w: f32, g: f32| if g > 0.0 { w / g } else { 1.0 };
    let shadow = |i: usize| {
        let (w, g) = (with[i], without[i]);
        Vec3::new(ratio(w.x, g.x), ratio(w.y, g.y), ratio(w.z, g.z))
    };
    let around = |i: usize| {
        let (x, y) = (i % width, i / width);
        let (mut sum, mut count) = (Vec3::ZERO, 0.0);
        for y in y.saturating_sub(SHADOW_RADIUS)..(y + SHADOW_RADIUS + 1).min(height) {
            for j in (x.saturating_sub(SHADOW_RADIUS)..(x + SHADOW_RADIUS + 1).min(width)).map(|x| y * width + x) {
                if covered[j] == 0.0 {
                    (sum, count) = (sum + shadow(j), count + 1.0);
                }
            }
        }
        if count > 0.0 { sum / count } else { Vec3::splat(1.0) }
    };
    let pixel = |i: usize| {
        let r = match covered[i] {
            a if a >= 1.0 => return with[i],
            0.0 => shadow(i),
            _ => around(i),
        };
        let rendered = with[i] + (1.0 - covered[i]) * r * (plate[i] - without[i]);
        Vec3::new(rendered.x.max(0.0), rendered.y.max(0.0), rendered.z.max(0.0))
    };
    (0..plate.len()).map(pixel).collect()
}

#[cfg(test)]
mod tests {
    use super::{Vec3, composed};

    #[test]
    fn shadows_darken_and_objects_cover_the_photograph() {
        let [plate, ground, object] = [0.6, 0.4, 0.9].map(Vec3::splat);
        // The pixels are three lit ones, one in half shadow, one that is half covered and half in
        // shadow, and one that is covered.
        let without = [ground; 6];
        let with = [ground, ground, ground, 0.5 * ground, 0.5 * object + 0.25 * ground, object];
        let covered = [0.0, 0.0, 0.0, 0.0, 0.5, 1.0];
        let placed = composed(1, &[plate; 6], &with, &without, &covered);
        // The neighbours of the half-covered pixel have a mean shadow of three quarters.
        let mixed = 0.5 * object + 0.25 * ground + 0.5 * 0.75 * (plate - ground);
        let expected = [plate, plate, plate, 0.5 * plate, mixed, object];
        assert!(placed.iter().zip(expected).all(|(a, b)| (*a - b).length() < 1e-6), "{placed:?}");
        // A black stand-in does not change the photograph.
        assert_eq!(composed(1, &[plate], &[Vec3::ZERO], &[Vec3::ZERO], &[0.0]), [plate]);
    }
}
