use super::*;
use durer_scene::material::PrincipledMaterial;
use durer_scene::scene::{Material, RenderDefaults, Spanned};

fn context<'a>(scene: &'a Scene, rules: &'a DialectRules) -> JobContext<'a> {
    JobContext { scene, rules, emulates: false, timed: false }
}

#[test]
fn defaults_follow_from_the_scene() {
    let rules = Dialect::Durer.rules();
    let job = |scene: &Scene| RenderJob::default().resolve(&context(scene, rules), None).unwrap();
    let plain = job(&Scene::default());
    assert_eq!((plain.width, plain.height, plain.method), (512, 512, IntegratorKind::WHITTED));
    assert_eq!(plain.sampling.samples(), 16);
    assert_eq!(plain.settings.bounces, 8);
    let layers = Material::from(PrincipledMaterial::default());
    let render_defaults = RenderDefaults {
        size: Some((64, 32)),
        bounces: Some(3),
        crop: Some((1, 2, 3, 4)),
        ..RenderDefaults::default()
    };
    let materials = vec![Spanned { value: layers, span: Default::default() }];
    let scene = Scene { materials, render_defaults, ..Scene::default() };
    let physical = job(&scene);
    assert_eq!((physical.width, physical.height, physical.method), (64, 32, IntegratorKind::PATH));
    assert_eq!((physical.sampling.samples(), physical.settings.bounces), (64, 3));
    let view = OutputSelection::default();
    let crop = |job: RenderJob| job.resolve(&context(&scene, rules), Some(&view)).unwrap().crop;
    assert_eq!(crop(RenderJob::default()).map(|crop| crop.left), Some(1));
    assert_eq!(crop(RenderJob::default().size((640, 320))), None);
    let old = JobContext { emulates: true, ..context(&scene, rules) };
    let job = RenderJob::default().resolve(&old, None).unwrap();
    assert_eq!((job.sampling, job.settings.min_weight), (Sampling::Center, 0.0));
    let timed = JobContext { timed: true, ..context(&scene, rules) };
    assert_eq!(RenderJob::default().resolve(&timed, None).unwrap().sampling.samples(), 1 << 20);
}

#[test]
fn options_are_set_by_name_and_printed_back() {
    let rules = Dialect::Durer.rules();
    let scene = Scene::default();
    let pairs = [
        ("integrator", "path"),
        ("clamp", "2"),
        ("bounces", "3"),
        ("shadows", "off"),
        ("no-refraction", ""),
        ("min-throughput", "0.25"),
        ("samples", "9"),
        ("filter", "mitchell"),
        ("filter-radius", "3"),
        ("noise-threshold", "0.5"),
        ("seed", "7"),
    ];
    let mut options = RenderJob::default();
    for (name, text) in pairs {
        options.set(name, text).unwrap();
    }
    let job = options.resolve(&context(&scene, rules), None).unwrap();
    let again = RenderJob::of(&job, &context(&scene, rules));
    let words = "--integrator path --clamp 2 --bounces 3 --shadows=off --no-refraction --min-throughput 0.25 \
                 --samples 9 --filter mitchell --filter-radius 3 --noise-threshold 0.5 --seed 7";
    assert_eq!(again.to_arguments().join(" "), words);
    let text = |job: &Job| serde_json::to_string(job).unwrap();
    assert_eq!(text(&again.resolve(&context(&scene, rules), None).unwrap()), text(&job));
    let adaptive = RenderJob::default().samples(32_u32).adaptive(true).resolve(&context(&scene, rules), None).unwrap();
    assert_eq!(RenderJob::of(&adaptive, &context(&scene, rules)).to_arguments(), ["--samples 32", "--adaptive"]);
    let both = RenderJob::default().adaptive(true).noise_threshold(0.5_f32).resolve(&context(&scene, rules), None);
    assert!(both.unwrap_err().contains("remove one of them"));
    // For a job with default options, only the number of samples is written.
    let usual = RenderJob::default().resolve(&context(&scene, rules), None).unwrap();
    assert_eq!(RenderJob::of(&usual, &context(&scene, rules)).to_arguments(), ["--samples 16"]);
}

#[test]
fn invalid_options_are_refused_with_a_message() {
    let wrong = |name: &str, text: &str| RenderJob::default().set(name, text).unwrap_err();
    assert_eq!(wrong("sample", "1"), "unknown option `sample`; did you mean `samples`?");
    assert_eq!(wrong("samples", "0"), "expected a number from 1 to 1048576");
    assert_eq!(wrong("size", "0x3"), "width and height must be at least 1");
    assert_eq!(wrong("noise-threshold", "0"), "expected a number above 0");
    assert!(wrong("filter", "cubic").starts_with("expected one of box, tent"));
    let scene = Scene::default();
    let refused = |job: RenderJob| job.resolve(&context(&scene, Dialect::Durer.rules()), None).unwrap_err();
    assert!(refused(RenderJob::default().integrator("paths")).starts_with("unknown integrator; expected one of"));
    assert!(refused(RenderJob::default().jitter(true).integrator("path")).contains("--jitter"));
    assert!(refused(RenderJob::default().filter_radius(65.0)).contains("--filter-radius"));
    assert!(refused(RenderJob::default().depth_range([1.0, 1.0])).contains("two different"));
}
