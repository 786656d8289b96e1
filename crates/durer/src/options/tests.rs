use super::*;
use durer_render::compile::AccelKind;
use durer_render::render::ShardBy;

fn set(name: &str, text: &str) -> Result<RenderOptions, String> {
    let mut options = RenderOptions::default();
    options.set(name, text).map(|()| options)
}

#[test]
fn every_option_can_be_set_and_is_stated_once() {
    let all = option_descriptions();
    for option in &all {
        assert_eq!(all.iter().filter(|other| other.name == option.name).count(), 1, "{}", option.name);
        assert!(option.help.len() > 10, "{}", option.name);
        let error = set(option.name, "\u{1}").err();
        let free = ["assets", "environment", "view-file", "camera", "variant", "animation"].contains(&option.name);
        assert_eq!(error.is_none(), free, "{}: {error:?}", option.name);
        assert!(error.is_none_or(|error| error.starts_with(&format!("--{} ", option.name))), "{}", option.name);
        if let Some(word) = option.words.first() {
            set(option.name, word).unwrap();
        }
    }
}

#[test]
fn invalid_values_are_refused_with_the_expected_form() {
    for (name, text, error) in [
        ("threads", "0", "--threads cannot be 0: expected a number from 1 to 1024"),
        ("accel", "tree", "--accel cannot be tree: expected one of bvh, grid, none"),
        ("crop", "1,2", "--crop cannot be 1,2: expected LEFT,TOP,WIDTHxHEIGHT, for example 10,20,64x48"),
        ("crop", "1,2,0x4", "--crop cannot be 1,2,0x4: expected LEFT,TOP,WIDTHxHEIGHT, for example 10,20,64x48"),
        ("at", "-1", "--at cannot be -1: expected seconds, 0 or more"),
        ("memory", "8X", "--memory cannot be 8X: expected a size or percentage, for example 8G, 512M or 80%"),
        ("sample", "3", "unknown option `sample`; did you mean `samples`?"),
    ] {
        assert_eq!(set(name, text).unwrap_err(), error);
    }
}

#[test]
fn options_reach_the_job_and_the_loader() {
    assert_eq!(set("grid", "2x3x4").unwrap().load.accel, AccelKind::Grid(Some([2, 3, 4])));
    assert_eq!(set("compat", "no-exit-r0").unwrap().load.compat.len(), 1);
    assert_eq!(set("size", "300x200").unwrap().load_options().scene_defaults.aspect, Some(1.5));
    let mut options = set("shard-by", "samples").unwrap();
    options.set("shard", "2/5").unwrap();
    assert_eq!((options.shard.index, options.shard.count, options.shard.by), (2, 5, ShardBy::Samples));
    options.set("time-limit", "1500ms").unwrap();
    assert_eq!(options.control().time_limit, Some(Duration::from_millis(1500)));
    options.set("assets", "a").unwrap();
    options.set("assets", "b").unwrap();
    assert_eq!(options.load.assets.len(), 2);
}
