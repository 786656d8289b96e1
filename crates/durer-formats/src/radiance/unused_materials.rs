//! Removes materials that are not used, and warns about missing files of types that are not read.

use super::args::RadPrimitive;
use super::state::Reader;
use durer_scene::material::{Pattern, PatternMaterial};
use durer_scene::scene::{Material, Scene};

/// Function files that are part of a Radiance installation.
const LIBRARY: &str = "Ashikhmin LaFortune LaFortune1 WGMDaniso WGMDiso WalterBSDF WalterBTDF ambpos bezier2 \
    blackbody blinds bsdf2rad cct cielab cieluv cieresp cieskyscan circle clamp clouds conv1 \
    conv2 cri cubic denom disk2square equivlum ferwerda filt fisheye_corr fitSH fog fovsample \
    gauss gaussian genSH glass3 glaze1 glaze2 graypatch hermite hsv_rgb illum klems_ang \
    klems_full klems_half klems_quarter landscape log3G10 lumdist macbeth mat3 metals noise \
    noise2 noise3 noise_con norm normcomp patch3w peerless perezlum perezlum_c picdiff \
    polynomial pq printwarp quadratic rambpos rayinit reinhard reinhart reinhartb reinsrc rev \
    rgb rgb_ycc root rskysrc screen sf sky2spectra skybright skyfact source spharm sphsamp \
    spline stdrefl sun sun2 superellipsoid surf testimg tilt tmesh trans trans2 tregenza tregsrc \
    tumblin uniq_rgb veil view360stereo vl vonKries vwparab vwplanis window xyz_rgb xyz_srgb";

impl Reader<'_> {
    /// Warns about files that a primitive names but that do not exist. Only files of types that are
    /// not read are checked.
    pub fn warn_missing_files(&self, primitive: &RadPrimitive) {
        for word in &primitive.texts {
            let Some((name, kind)) = word.text.rsplit_once('.') else { continue };
            let library = kind == "cal" && LIBRARY.split_whitespace().any(|known| known == name);
            if matches!(kind, "cal" | "xml" | "rtm" | "oct") && !library && !self.input.source.contains(&word.text) {
                let message = format!("missing file {}", word.quoted());
                self.report.warn_once("missing-file", word.at, message);
            }
        }
    }
}

/// Removes materials that are not used. Examples are materials of suns, materials of the outer side
/// of glass, and parts of a mixture that was reduced to one of its parts.
pub(super) fn remove_unused(scene: &mut Scene) {
    let mut used = vec![false; scene.materials.len()];
    let objects = || scene.root.iter().flat_map(|root| &root.objects);
    objects().filter_map(|object| object.material).for_each(|number| used[number as usize] = true);
    // A mixture always comes after its parts, so go through the list backwards.
    for i in (0..used.len()).rev() {
        if let (true, Material::Solid(solid, _)) = (used[i], &scene.materials[i].value) {
            solid.materials().into_iter().for_each(|part| used[part as usize] = true);
        }
    }
    let mut number = 0;
    let numbers: Vec<u32> = used
        .iter()
        .map(|used| {
            number += u32::from(*used);
            number.saturating_sub(1)
        })
        .collect();
    let mut i = 0;
    scene.materials.retain(|_| {
        i += 1;
        used[i - 1]
    });
    for material in &mut scene.materials {
        if let Material::Solid(PatternMaterial::Mix(mix), _) = &mut material.value {
            (mix.material1, mix.material2) = (numbers[mix.material1 as usize], numbers[mix.material2 as usize]);
        }
    }
    for object in scene.root.iter_mut().flat_map(|root| &mut root.objects) {
        object.material = object.material.map(|material| numbers[material as usize]);
    }
}
