//! Selects variants of materials (KHR_materials_variants).

use super::Model;
use super::json::JsonRef;
use durer_diag::did_you_mean;

const VARIANTS: &str = "KHR_materials_variants";

impl Model<'_> {
    /// Returns the index of the requested variant.
    pub(super) fn chosen_variant(&self, root: &JsonRef) -> Option<usize> {
        let extensions = root.get("extensions");
        let variants = extensions.as_ref().and_then(|extensions| extensions.get(VARIANTS));
        let variants = variants.as_ref().and_then(|variants| variants.required("variants"));
        let names: Vec<&str> = match &variants {
            Some(variants) => variants.items().filter_map(|one| one.object()?.get("name")?.as_str()).collect(),
            None => Vec::new(),
        };
        let known = format!("`{}`", names.join("`, `"));
        let Some(wanted) = &self.input.scene_defaults.variant else {
            if !names.is_empty() {
                let message = format!("the model has the variants {known}; select one with `--variant NAME`");
                variants.as_ref().unwrap_or(root).note("variants", message);
            }
            return None;
        };
        let by_number = || wanted.parse().ok().filter(|number| *number < names.len());
        let index = names.iter().position(|name| name == wanted).or_else(by_number);
        if index.is_none() {
            let help = match did_you_mean(wanted, names.iter().copied()) {
                Some(suggestion) => format!("did you mean `{suggestion}`?"),
                None if names.is_empty() => "no variants are defined".into(),
                None => format!("the variants are {known}"),
            };
            root.error("no-variant", format!("the file has no variant `{wanted}`: {help}"));
        }
        index
    }

    /// Returns the material that the selected variant defines for a primitive, or otherwise the
    /// primitive's own material.
    pub(super) fn material_of(&self, at: &JsonRef) -> Option<Option<u32>> {
        let number = |material: &JsonRef| material.index(self.material_count).map(|number| Some(number as u32));
        if let Some(variant) = self.variant
            && let Some(mappings) = at
                .get("extensions")
                .as_ref()
                .and_then(|extensions| extensions.get(VARIANTS))
                .as_ref()
                .and_then(|variants| variants.required("mappings"))
        {
            for mapping in mappings.items() {
                let shown = mapping.list("variants", |shown| shown.integer(..));
                if shown.contains(&Some(variant as u64)) {
                    return number(&mapping.required("material")?);
                }
            }
        }
        at.get("material").map_or(Some(None), |material| number(&material))
    }
}
