use super::*;
use crate::compile::testing;
use crate::film::Filter;
use crate::integrator::{Integrate as _, IntegratorKind};
use crate::render::{Job, Sampling, Shard};

/// Device that computes colours with the job's own integrator.
struct Processor<'w> {
    world: &'w World,
    job: Job,
    capacity: usize,
    fails: bool,
}

impl RayDevice for Processor<'_> {
    fn name(&self) -> &str {
        "a processor"
    }

    fn capacity(&self) -> usize {
        self.capacity
    }

    fn trace(&mut self, rays: &[CameraRay], results: &mut [TracedRay]) -> Result<(), String> {
        if self.fails {
            return Err("the processor was lost".into());
        }
        let integrator = self.job.integrator(self.world, None);
        for (ray, result) in rays.iter().zip(results) {
            let mut count = durer_bvh::RayCount::default();
            let color = integrator.radiance(&ray.ray, ray.id, &mut count);
            *result = TracedRay { color, rays: count.0 as u32 };
        }
        Ok(())
    }
}

fn world() -> World {
    testing::read(
        "PerspectiveCamera { center 0 1 6 direction 0 -0.1 -1 up 0 1 0 angle 40 } Background { color 0.2 0.3 0.4 }
        Lights { PointLight { position 3 4 5 color 1 1 1 } } Materials { PhongMaterial { diffuseColor 0.7 0.5 0.3 } }
        Group { MaterialIndex 0 Plane { normal 0 1 0 offset -1 } Sphere { center 0 0 0 radius 1 } }",
    )
}

fn job(method: IntegratorKind) -> Job {
    let sampling = Sampling::Filtered { samples: 32, filter: Filter::Tent { radius: 1.0 } };
    Job { width: 19, height: 13, sampling, method, device: Some("a processor".into()), ..Job::default() }
}

#[test]
fn film_equals_that_of_the_cpu_for_any_capacity() {
    let world = world();
    for (method, adaptive, noise) in [
        (IntegratorKind::WHITTED, false, None),
        (IntegratorKind::PATH, false, Some(0.05)),
        (IntegratorKind::PATH, true, None),
    ] {
        let job = Job { adaptive, noise, ..job(method) };
        let plain = Job { device: None, ..job.clone() };
        let expected = PartialRender::new(&world, &plain, Shard::WHOLE).unwrap();
        expected.render(&world, &Control::default(), &mut |_, _| {}).unwrap();
        for capacity in [1, 1000, usize::MAX] {
            let mut device = Processor { world: &world, job: job.clone(), capacity, fails: false };
            let part = PartialRender::new(&world, &job, Shard::WHOLE).unwrap();
            let outcome = part.render_on(&world, &Control::default(), &mut device, &mut |_, _| {}).unwrap();
            assert_eq!(outcome, RenderOutcome::Finished);
            assert_eq!(part.hash(), expected.hash(), "{method:?} {capacity}");
            assert_eq!(part.statistics(), expected.statistics());
            assert!(part.is_finished());
        }
    }
}

#[test]
fn device_is_part_of_the_identity() {
    let world = world();
    let own = job(IntegratorKind::WHITTED);
    let [part, plain, other] = [own.device.clone(), None, Some("another".into())]
        .map(|device| PartialRender::new(&world, &Job { device, ..own.clone() }, Shard::WHOLE).unwrap());
    assert!(part.identity() != plain.identity() && part.identity() != other.identity());
    assert!(part.same_work(&plain).unwrap_err().to_string().contains("`device`"));
    let mut device = Processor { world: &world, job: own, capacity: 100, fails: false };
    // A part is continued only by the device that began it.
    let control = Control::default();
    assert!(part.render(&world, &control, &mut |_, _| {}).unwrap_err().to_string().contains("not on the CPU"));
    let error = plain.render_on(&world, &control, &mut device, &mut |_, _| {}).unwrap_err();
    assert_eq!(error.to_string(), "this part was rendered on the CPU, not on a processor");
    assert!(other.render_on(&world, &control, &mut device, &mut |_, _| {}).is_err());
}

#[test]
fn failed_device_is_an_error_and_leaves_the_part_unchanged() {
    let world = world();
    let job = job(IntegratorKind::WHITTED);
    let part = PartialRender::new(&world, &job, Shard::WHOLE).unwrap();
    let mut device = Processor { world: &world, job, capacity: 100, fails: true };
    let error = part.render_on(&world, &Control::default(), &mut device, &mut |_, _| {}).unwrap_err();
    assert_eq!(error.to_string(), "the processor was lost");
    assert_eq!(part.work().1, 0);
}
