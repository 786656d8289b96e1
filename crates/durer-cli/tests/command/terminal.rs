//! Tests pictures in the terminal.

use crate::common::TestFolder;

#[test]
fn drawing_in_the_terminal_changes_no_file() {
    let folder = TestFolder::new();
    let render = "render scene.txt --size 40x30 --samples 8 -o";
    folder.expect_exit(0, &format!("{render} plain.png"));
    for (graphics, begin) in [
        ("kitty", "\x1b_Ga=T,f=100,"),
        ("iterm", "\x1b]1337;File=inline=1;"),
        ("sixel", "\x1bP0;1q\"1;1;40;30#"),
        // The picture is 40 pixels wide, and two rows of pixels are one row of text.
        ("blocks", "\x1b[38;5;"),
    ] {
        let drawn = folder.expect_exit(0, &format!("{render} {graphics}.png --terminal={graphics}")).err;
        assert!(drawn.contains(begin), "{graphics}: {drawn:?}");
        // The last drawing has no status below it, so that the next line of text is complete.
        assert!(drawn.contains("\r\x1b[K\r"), "{graphics}: {drawn:?}");
        assert!(folder.bytes("plain.png") == folder.bytes(&format!("{graphics}.png")), "{graphics}");
    }
}

#[test]
fn terminal_graphics_are_refused_where_they_cannot_be() {
    let folder = TestFolder::new();
    for (options, why) in [
        ("-o a.png --terminal", "standard error is not a terminal"),
        ("-o a.part --terminal=sixel --shard 1/2", "cannot be used with"),
        ("--terminal=sixel --pixel 1,1", "cannot be used with"),
        ("-o a.png --terminal=ascii", "kitty, iterm, sixel, blocks"),
        ("-o a.png --terminal=sixel --turntable 3", "not to an animation"),
    ] {
        folder.expect_failure(2, &format!("render scene.txt {options}"), &[why]);
    }
}
