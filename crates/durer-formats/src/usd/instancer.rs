//! Point instancers: many copies of a few prototypes.

use super::primvar::{DISPLAY_COLOR, Interpolation, Primvar};
use super::reader::{Inherited, Reader};
use super::stage::Prim;
use durer_scene::scene::{Group, Object, ObjectKind};
use glam::{DAffine3, DQuat, DVec3};

impl Reader<'_, '_> {
    /// Adds the copies of a `PointInstancer`.
    pub fn instances(&mut self, prim: &Prim, here: &Inherited, objects: &mut Vec<Object>, depth: u32) {
        let (files, at) = (self.stage.files, prim.span());
        let numbers = |name: &str| prim.numbers(self.stage, name);
        let (positions, indices) = (numbers("positions"), numbers("protoIndices"));
        let (turns, scales) = (numbers("orientations"), numbers("scales"));
        let (ids, inactive) = (numbers("ids"), prim.numbers_of("inactiveIds"));
        let hidden = numbers("invisibleIds").into_iter().chain(inactive);
        let hidden: std::collections::HashSet<u64> = hidden.map(f64::to_bits).collect();
        let colors = Primvar::read(self.stage, prim, DISPLAY_COLOR, 3, Interpolation::Constant);
        if colors.is_some_and(|colors| colors.interpolation != Interpolation::Constant) {
            let message = "the display colours of a PointInstancer have no counterpart: they are left out";
            files.report.unsupported_once(at, message);
        }
        let paths = prim.targets("prototypes");
        let mut prototypes = Vec::with_capacity(paths.len());
        for path in &paths {
            let Some(prototype) = self.stage.prim(path) else {
                files.report.unsupported_once(at, format!("the prototype `{path}` does not exist: it is left out"));
                prototypes.push(None);
                continue;
            };
            let before = files.limits.object_count();
            let mut parts = Vec::new();
            let start = Inherited { to_world: DAffine3::IDENTITY, skeleton: Default::default(), ..here.clone() };
            self.visit(&prototype, &start, &mut parts, depth + 1);
            let count = files.limits.object_count() - before;
            prototypes.push((!parts.is_empty()).then_some((parts, count)));
        }
        for (i, (position, index)) in positions.as_chunks::<3>().0.iter().zip(&indices).enumerate() {
            let id = ids.get(i).copied().unwrap_or(i as f64);
            if hidden.contains(&id.to_bits()) {
                continue;
            }
            let Some(prototype) = prototypes.get(*index as usize).filter(|_| *index >= 0.0) else {
                files
                    .report
                    .unsupported_once(at, format!("`protoIndices` names prototype {index}, which does not exist"));
                continue;
            };
            let Some((parts, count)) = prototype else { continue };
            let chunk = |list: &[f64], i: usize| list.as_chunks::<3>().0.get(i).copied().map(DVec3::from_array);
            let turn = turns.as_chunks::<4>().0.get(i).map_or(DQuat::IDENTITY, |[w, x, y, z]| {
                let turn = DQuat::from_xyzw(*x, *y, *z, *w);
                if turn.length() > 1e-9 { turn.normalize() } else { DQuat::IDENTITY }
            });
            let scale = chunk(&scales, i).unwrap_or(DVec3::ONE);
            let place = DAffine3::from_scale_rotation_translation(scale, turn, DVec3::from_array(*position));
            if !files.limits.count_objects_or_report(*count, files.report, at) {
                return;
            }
            let node = match &parts[..] {
                [only] => only.node.clone(),
                _ => ObjectKind::Group(Group { objects: parts.clone() }),
            };
            self.add(node, parts[0].material, here.to_world * place, at, objects);
        }
    }
}
