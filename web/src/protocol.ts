// Written by `DURER_WRITE=1 cargo test -p durer-session` from crates/durer-session/src/protocol.rs.

export type Ask = { 
/**
 * Number of the session, chosen by the page. A new number makes a new session.
 */
session: number, 
/**
 * Number of the question, from 1.
 */
id: number, 
/**
 * The question.
 */
request: Request, };

export type Answer = { 
/**
 * The session.
 */
session: number, 
/**
 * The question that it answers; 0 where nobody asked.
 */
id: number, 
/**
 * What it says.
 */
event: Event, };

export type Request = { "kind": "open", 
/**
 * The name of the file; its ending says the format.
 */
name: string, 
/**
 * The text; `None` for the file of the server.
 */
text: string | null, } | { "kind": "give", 
/**
 * Its name in the scene.
 */
name: string, 
/**
 * Its bytes in base64.
 */
base64: string, 
/**
 * Whether it is the scene itself.
 */
opens: boolean, } | { "kind": "edit", 
/**
 * The text.
 */
text: string, } | { "kind": "size", 
/**
 * Columns.
 */
width: number, 
/**
 * Rows.
 */
height: number, } | { "kind": "show", 
/**
 * `color`, or the name of another picture.
 */
picture: string, 
/**
 * What multiplies light, in powers of two.
 */
stops: number, 
/**
 * Name of the tone curve.
 */
tone: string, } | { "kind": "options", 
/**
 * Names and values, as on the command line.
 */
options: Array<Setting>, } | { "kind": "move", 
/**
 * How.
 */
motion: Motion, 
/**
 * Whether more is to come at once: then only coarse pictures are made.
 */
moving: boolean, } | { "kind": "field", 
/**
 * Its name.
 */
name: string, 
/**
 * Its numbers.
 */
values: Array<number>, 
/**
 * Whether more is to come at once.
 */
moving: boolean, } | { "kind": "look", 
/**
 * The eye.
 */
center: [number, number, number], 
/**
 * Where it looks.
 */
direction: [number, number, number], 
/**
 * What is up.
 */
up: [number, number, number], 
/**
 * Field of view across the larger side, in degrees.
 */
angle: number, 
/**
 * Whether more is to come at once.
 */
moving: boolean, } | { "kind": "write_camera" } | { "kind": "explain", 
/**
 * Column from the left.
 */
x: number, 
/**
 * Row from the top.
 */
y: number, 
/**
 * Which of its samples; `None`: the one that counts most.
 */
sample: number | null, } | { "kind": "cast", 
/**
 * Where the ray starts.
 */
origin: [number, number, number], 
/**
 * Its direction, of any length.
 */
direction: [number, number, number], 
/**
 * Where it ends.
 */
t_max: number | null, } | { "kind": "outlines" } | { "kind": "language" } | { "kind": "export", 
/**
 * The file's name, whose ending says the format.
 */
name: string, } | { "kind": "save", 
/**
 * Whether what others wrote meanwhile is overwritten.
 */
force: boolean, } | { "kind": "pause", 
/**
 * Whether to stop.
 */
pause: boolean, } | { "kind": "close" };

export type Event = { "kind": "opened", 
/**
 * The program's version.
 */
version: string, 
/**
 * Name of the file.
 */
name: string, 
/**
 * Its text; `None` for a model in a binary format.
 */
text: string | null, 
/**
 * Whether it can be saved.
 */
saves: boolean, 
/**
 * All pictures that can be shown.
 */
pictures: Array<Choice>, 
/**
 * All tone curves.
 */
tones: Array<string>, 
/**
 * All integrators.
 */
integrators: Array<Choice>, } | { "kind": "scene", 
/**
 * What is wrong or odd with it.
 */
findings: Array<Finding>, 
/**
 * What is in it; `None` where it has errors: the picture is that of the last one without.
 */
contents: Contents | null, 
/**
 * Time to read and compile it, in milliseconds.
 */
ms: number, } | { "kind": "checked", 
/**
 * The findings, those of [`Event::Scene`] among them.
 */
findings: Array<Finding>, } | { "kind": "camera", 
/**
 * As it is now.
 */
camera: CameraState, } | { "kind": "picture", 
/**
 * What it is.
 */
head: PictureHead, } | { "kind": "explained", 
/**
 * The pixel.
 */
pixel: PixelAccount, } | { "kind": "cast", 
/**
 * The answer of all.
 */
cast: CastAccount, } | { "kind": "outlines", 
/**
 * One for each object, up to a limit.
 */
outlines: Array<Outline>, 
/**
 * The lights that have a place.
 */
lamps: Array<Lamp>, } | { "kind": "language", 
/**
 * All that begin something.
 */
words: Array<Word>, } | { "kind": "text", 
/**
 * The new text.
 */
text: string, 
/**
 * Whether it was changed on disk.
 */
from_disk: boolean, } | { "kind": "exported", 
/**
 * Its name.
 */
name: string, } | { "kind": "saved" } | { "kind": "conflict" } | { "kind": "refused", 
/**
 * Why.
 */
why: string, };

export type Setting = { 
/**
 * Name on the command line.
 */
name: string, 
/**
 * Value as on the command line.
 */
value: string, };

export type Motion = { "kind": "orbit", 
/**
 * To the right.
 */
right: number, 
/**
 * Upwards.
 */
up: number, } | { "kind": "pan", 
/**
 * To the right.
 */
right: number, 
/**
 * Upwards.
 */
up: number, } | { "kind": "dolly", 
/**
 * The factor.
 */
factor: number, } | { "kind": "walk", 
/**
 * Forwards.
 */
forward: number, 
/**
 * To the right.
 */
right: number, 
/**
 * Upwards.
 */
up: number, } | { "kind": "turn", 
/**
 * To the right.
 */
right: number, 
/**
 * Upwards.
 */
up: number, } | { "kind": "home" } | { "kind": "frame" };

export type Choice = { 
/**
 * Its name.
 */
name: string, 
/**
 * Its meaning.
 */
doc: string, };

export type Place = { 
/**
 * Line from 1.
 */
line: number, 
/**
 * Column from 1, in characters.
 */
column: number, 
/**
 * First byte.
 */
start: number, 
/**
 * One past the last byte.
 */
end: number, };

export type Severity = "note" | "warning" | "error";

export type Finding = { 
/**
 * How bad it is.
 */
severity: Severity, 
/**
 * Its kind, or nothing.
 */
code: string, 
/**
 * In a sentence.
 */
message: string, 
/**
 * What may have been meant.
 */
help: string | null, 
/**
 * What comes of it in the picture.
 */
effect: string | null, 
/**
 * The file, if it is not the scene's.
 */
file: string | null, 
/**
 * Where in it.
 */
place: Place | null, 
/**
 * What mends it.
 */
fix: Array<Change>, };

export type Change = { 
/**
 * First byte that is replaced.
 */
start: number, 
/**
 * One past the last.
 */
end: number, 
/**
 * By what.
 */
text: string, };

export type Contents = { 
/**
 * Name of the dialect.
 */
dialect: string, 
/**
 * The camera.
 */
camera: CameraState, 
/**
 * Objects, by number, up to a limit.
 */
objects: Array<Thing>, 
/**
 * How many objects there are.
 */
object_count: number, 
/**
 * How many triangles they have.
 */
triangles: number, 
/**
 * Lights, by number.
 */
lights: Array<Thing>, 
/**
 * Two opposite corners of the box around all that has an end.
 */
bounds: [[number, number, number], [number, number, number]], 
/**
 * The job, as on the command line, but for its size.
 */
job: JobState, };

export type JobState = { 
/**
 * The size that the scene has by default.
 */
size: [number, number], 
/**
 * Name of the integrator.
 */
integrator: string, 
/**
 * Samples a pixel.
 */
samples: number, 
/**
 * Levels of mirrored and transmitted rays.
 */
bounces: number, 
/**
 * Options that differ from the scene's defaults, as words of a command line.
 */
words: Array<string>, };

export type Thing = { 
/**
 * Its keyword and line.
 */
name: string, 
/**
 * Where it is written, if in the scene's text.
 */
place: Place | null, };

export type CameraState = { 
/**
 * Its keyword.
 */
keyword: string, 
/**
 * The eye.
 */
eye: [number, number, number], 
/**
 * Where it looks, of length 1.
 */
forward: [number, number, number], 
/**
 * To the right in the picture.
 */
right: [number, number, number], 
/**
 * Upwards in the picture.
 */
up: [number, number, number], 
/**
 * Half the width of what is seen at distance 1, by the larger side.
 */
half_width: number, 
/**
 * Distance of what it looks at.
 */
distance: number, 
/**
 * Its fields.
 */
fields: Array<FieldState>, 
/**
 * How it is written.
 */
statement: string, 
/**
 * Whether it was moved.
 */
moved: boolean, };

export type FieldState = { 
/**
 * Its word in the scene language.
 */
name: string, 
/**
 * Meaning and unit.
 */
doc: string, 
/**
 * Its numbers; none for words and files.
 */
values: Array<number>, 
/**
 * What it says where it has no numbers.
 */
text: string, 
/**
 * Least value, if there is one.
 */
least: number | null, 
/**
 * Greatest value, if there is one.
 */
most: number | null, };

export type PictureHead = { 
/**
 * `color`, or the name of another picture.
 */
picture: string, 
/**
 * Columns of what follows.
 */
width: number, 
/**
 * Rows of what follows.
 */
height: number, 
/**
 * Columns of the whole picture: more than `width` where it is coarse.
 */
full_width: number, 
/**
 * Rows of the whole picture.
 */
full_height: number, 
/**
 * Samples that each pixel has.
 */
samples: number, 
/**
 * Samples that each pixel gets.
 */
all_samples: number, 
/**
 * Rays traced for it.
 */
rays: number, 
/**
 * Milliseconds since the change that it shows.
 */
ms: number, 
/**
 * The hash of its sums, once it is finished: that of `durer render --hash`.
 */
hash: string | null, };

export type Row = { 
/**
 * What is computed.
 */
name: string, 
/**
 * How, in symbols.
 */
formula: string, 
/**
 * The same in numbers; may be empty.
 */
numbers: string, 
/**
 * What comes of it, in words.
 */
result: string, 
/**
 * What comes of it, as a number.
 */
value: number | null, };

export type Segment = { 
/**
 * What it is.
 */
role: Role, 
/**
 * Where it begins.
 */
from: [number, number, number], 
/**
 * Where it ends.
 */
to: [number, number, number], 
/**
 * Whether it goes on for ever.
 */
escapes: boolean, };

export type Role = "camera" | "reflected" | "transmitted" | "scattered" | "lit" | "shadowed";

export type Term = { 
/**
 * What it is, in a few words.
 */
title: string, 
/**
 * Its formulas.
 */
rows: Array<Row>, 
/**
 * The colour that comes of it.
 */
value: [number, number, number], 
/**
 * What it adds to the pixel.
 */
adds: [number, number, number], 
/**
 * Its share of the pixel's luminance.
 */
share: number, 
/**
 * The value in eight bits.
 */
swatch: [number, number, number], 
/**
 * Where the thing is written that it is about.
 */
place: Place | null, 
/**
 * Its ray.
 */
segment: Segment | null, 
/**
 * Point and normal of what was hit.
 */
normal: [[number, number, number], [number, number, number]] | null, 
/**
 * The ray in numbers, to ask all objects about it: origin, direction.
 */
ray: [[number, number, number], [number, number, number]] | null, 
/**
 * Where that ray ends.
 */
t_max: number | null, 
/**
 * Number of the object that it is about.
 */
object: number | null, 
/**
 * What it is the sum of.
 */
terms: Array<Term>, };

export type PixelAccount = { 
/**
 * Column from the left.
 */
x: number, 
/**
 * Row from the top.
 */
y: number, 
/**
 * The colour, in linear light.
 */
color: [number, number, number], 
/**
 * In eight bits.
 */
bytes: [number, number, number], 
/**
 * How many samples it has.
 */
samples: number, 
/**
 * Which of them the tree is of.
 */
sample: number, 
/**
 * Place in the picture, in pixels from the upper left corner.
 */
at: [number, number], 
/**
 * The weight of that sample, divided by those of all.
 */
weight: number, 
/**
 * The tree; `None` where the camera sees nothing.
 */
tree: Term | null, };

export type Verdict = "closest" | "farther" | "behind" | "beyond" | "missed";

export type ObjectTest = { 
/**
 * Number of the object.
 */
object: number, 
/**
 * Its keyword and line.
 */
name: string, 
/**
 * Where it is written.
 */
place: Place | null, 
/**
 * The answer.
 */
verdict: Verdict, 
/**
 * The answer in words.
 */
why: string, 
/**
 * Where the ray meets it first.
 */
t: number | null, 
/**
 * The formulas, with numbers.
 */
rows: Array<Row>, };

export type CastAccount = { 
/**
 * Where the ray starts.
 */
origin: [number, number, number], 
/**
 * Its direction.
 */
direction: [number, number, number], 
/**
 * All objects, up to a limit, in the order in which they are written.
 */
tests: Array<ObjectTest>, 
/**
 * How many objects were not told about.
 */
left_out: number, 
/**
 * The first hit.
 */
hit: HitAccount | null, };

export type HitAccount = { 
/**
 * Number of the object.
 */
object: number, 
/**
 * Number of the triangle in a mesh, else 0.
 */
part: number, 
/**
 * Where on the ray.
 */
t: number, 
/**
 * The point.
 */
point: [number, number, number], 
/**
 * Normal of the surface.
 */
normal: [number, number, number], 
/**
 * Normal for shading.
 */
shading_normal: [number, number, number], 
/**
 * Texture coordinates.
 */
uv: [number, number] | null, 
/**
 * Barycentric coordinates on a triangle.
 */
barycentric: [number, number, number], };

export type Outline = { 
/**
 * Number of the object.
 */
object: number, 
/**
 * Lines, each a row of points, three numbers each.
 */
lines: Array<Array<number>>, };

export type Lamp = { 
/**
 * Where it is, or from where it comes.
 */
at: [number, number, number], 
/**
 * Whether it is infinitely far.
 */
far: boolean, 
/**
 * Its keyword and line.
 */
name: string, };

export type Word = { 
/**
 * The word.
 */
word: string, 
/**
 * Its chapter in the manual.
 */
chapter: string, 
/**
 * What it is.
 */
doc: string, 
/**
 * Its fields.
 */
fields: Array<WordField>, 
/**
 * How it is written.
 */
example: string, };

export type WordField = { 
/**
 * The word.
 */
word: string, 
/**
 * Type and range.
 */
value: string, 
/**
 * What holds where it is not given.
 */
default: string | null, 
/**
 * Whether it must be given.
 */
required: boolean, 
/**
 * Meaning and unit.
 */
doc: string, };
