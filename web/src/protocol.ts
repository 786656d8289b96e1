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
 * The event.
 */
event: Event, };

export type Request = { "kind": "open", 
/**
 * The name of the file; its ending says the format. Empty for the server's own file.
 */
name: string, 
/**
 * The text; `None` for a file.
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
 * True for the scene itself.
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
 * Exposure in stops: light is multiplied by this power of two.
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
 * True while the motion lasts: only coarse pictures are made.
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
 * True while the motion lasts.
 */
moving: boolean, } | { "kind": "look", 
/**
 * The eye.
 */
center: [number, number, number], 
/**
 * View direction.
 */
direction: [number, number, number], 
/**
 * Up direction.
 */
up: [number, number, number], 
/**
 * Field of view across the larger side, in degrees.
 */
angle: number, 
/**
 * True while the motion lasts.
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
 * Origin of the ray.
 */
origin: [number, number, number], 
/**
 * Its direction, of any length.
 */
direction: [number, number, number], 
/**
 * End.
 */
t_max: number | null, } | { "kind": "rays", 
/**
 * Columns of the raster.
 */
columns: number, 
/**
 * Rows of the raster.
 */
rows: number, 
/**
 * The only row that is asked for; `None` for all.
 */
row: number | null, } | { "kind": "walk", 
/**
 * The structure.
 */
structure: Structure, 
/**
 * Origin of the ray.
 */
origin: [number, number, number], 
/**
 * Its direction, of any length.
 */
direction: [number, number, number], } | { "kind": "boxes" } | { "kind": "values", 
/**
 * First column.
 */
left: number, 
/**
 * First row.
 */
top: number, 
/**
 * Columns.
 */
width: number, 
/**
 * Rows.
 */
height: number, } | { "kind": "crop", 
/**
 * The part; `None` for the whole picture.
 */
crop: [number, number, number, number] | null, } | { "kind": "denoise", 
/**
 * True for on.
 */
on: boolean, } | { "kind": "epsilon", 
/**
 * Least `t`; `None` for the exact starts of rays.
 */
epsilon: number | null, } | { "kind": "tree" } | { "kind": "material", 
/**
 * Number of the material.
 */
number: number, 
/**
 * Name of the field.
 */
name: string, 
/**
 * Its numbers.
 */
values: Array<number>, } | { "kind": "as_text" } | { "kind": "pack" } | { "kind": "lesson" } | { "kind": "outlines" } | { "kind": "language" } | { "kind": "export", 
/**
 * The file's name, whose ending says the format.
 */
name: string, } | { "kind": "save", 
/**
 * True to overwrite what other programs wrote meanwhile.
 */
force: boolean, } | { "kind": "pause", 
/**
 * True to pause.
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
 * True if it can be saved.
 */
saves: boolean, 
/**
 * Pictures that can be shown.
 */
pictures: Array<Choice>, 
/**
 * Tone curves.
 */
tones: Array<string>, 
/**
 * Integrators.
 */
integrators: Array<Choice>, } | { "kind": "scene", 
/**
 * Findings of the reader.
 */
findings: Array<Finding>, 
/**
 * Contents; `None` if it has errors, and the picture stays the last one.
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
 * Meaning.
 */
head: PictureHead, } | { "kind": "explained", 
/**
 * The pixel.
 */
pixel: PixelAccount, } | { "kind": "cast", 
/**
 * The answer of all.
 */
cast: CastAccount, } | { "kind": "rays", 
/**
 * The rays.
 */
rays: Array<RayAccount | null>, } | { "kind": "walk", 
/**
 * The way.
 */
walk: WalkAccount, } | { "kind": "boxes", 
/**
 * The boxes, level by level, up to a limit.
 */
boxes: Array<BoxState>, } | { "kind": "values", 
/**
 * First column.
 */
left: number, 
/**
 * First row.
 */
top: number, 
/**
 * Columns.
 */
width: number, 
/**
 * Rows.
 */
height: number, 
/**
 * The numbers: linear light, or what another picture shows.
 */
values: Array<number | null>, } | { "kind": "tree", 
/**
 * The objects.
 */
nodes: Array<TreeNode>, 
/**
 * The materials, by number.
 */
materials: Array<MaterialState>, } | { "kind": "packed", 
/**
 * Names; the text comes first.
 */
names: Array<string>, 
/**
 * Numbers of bytes.
 */
sizes: Array<number>, } | { "kind": "lesson", 
/**
 * Its Markdown; `None` if the server has none.
 */
text: string | null, } | { "kind": "outlines", 
/**
 * One for each object, up to a limit.
 */
outlines: Array<Outline>, 
/**
 * The lights that have a place.
 */
lamps: Array<Lamp>, } | { "kind": "language", 
/**
 * Words that begin a statement.
 */
words: Array<Word>, } | { "kind": "text", 
/**
 * The new text.
 */
text: string, 
/**
 * True if it was changed on disk.
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
 * Advice.
 */
help: string | null, 
/**
 * Effect on the picture.
 */
effect: string | null, 
/**
 * The file, if it is not the scene's.
 */
file: string | null, 
/**
 * Place in it.
 */
place: Place | null, 
/**
 * Edits that fix it.
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
 * Number of objects.
 */
object_count: number, 
/**
 * Number of triangles.
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
 * Place in the scene's text.
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
 * View direction, of length 1.
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
 * True if it differs from the text.
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
 * Its value if that is a word or a file name.
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
 * The part that follows, in pixels of the whole picture: first column, first row, width and
 * height. A coarse one may reach beyond the edge.
 */
region: [number, number, number, number], 
/**
 * Visible error, the quantity that `durer render --noise-threshold` limits, once it is known.
 */
noise: number | null, 
/**
 * Milliseconds until it is finished, once they are known.
 */
left_ms: number | null, 
/**
 * True if it is denoised.
 */
denoised: boolean, 
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
 * Name of the result.
 */
name: string, 
/**
 * How, in symbols.
 */
formula: string, 
/**
 * The formula with numbers; may be empty.
 */
numbers: string, 
/**
 * The result as text.
 */
result: string, 
/**
 * The result as a number.
 */
value: number | null, };

export type Segment = { 
/**
 * Meaning.
 */
role: Role, 
/**
 * Start.
 */
from: [number, number, number], 
/**
 * End.
 */
to: [number, number, number], 
/**
 * True if it has no end.
 */
escapes: boolean, };

export type Role = "camera" | "reflected" | "transmitted" | "scattered" | "lit" | "shadowed";

export type Term = { 
/**
 * Title.
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
 * Contribution to the pixel.
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
 * Place of its object or light in the text.
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
 * End of the ray.
 */
t_max: number | null, 
/**
 * Number of the object that it is about.
 */
object: number | null, 
/**
 * Terms that sum to it.
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
 * Number of samples.
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
 * Place in the text.
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
 * First crossing along the line.
 */
t: number | null, 
/**
 * The formulas, with numbers.
 */
rows: Array<Row>, };

export type CastAccount = { 
/**
 * Origin of the ray.
 */
origin: [number, number, number], 
/**
 * Its direction.
 */
direction: [number, number, number], 
/**
 * Tests of the objects in the order of the text, up to a limit.
 */
tests: Array<ObjectTest>, 
/**
 * Number of objects beyond the limit.
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
 * Position along the ray.
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
 * Position; of directional lights, a point from where they shine.
 */
at: [number, number, number], 
/**
 * True if it is infinitely far.
 */
far: boolean, 
/**
 * Its keyword and line.
 */
name: string, };

export type Structure = "tree" | "grid" | "nothing";

export type RayAccount = { 
/**
 * Origin.
 */
origin: [number, number, number], 
/**
 * Direction, of length 1.
 */
direction: [number, number, number], 
/**
 * Position of the first hit along the ray.
 */
t: number | null, 
/**
 * Number of the object that is hit.
 */
object: number | null, };

export type WalkTest = { 
/**
 * Number of the object.
 */
object: number, 
/**
 * Position of its first hit along the ray.
 */
t: number | null, };

export type WalkStep = { 
/**
 * Two opposite corners; `None` for objects outside the structure.
 */
bounds: [[number, number, number], [number, number, number]] | null, 
/**
 * Depth of a box in its tree.
 */
level: number, 
/**
 * Objects that are tested there.
 */
tests: Array<WalkTest>, 
/**
 * Least `t` after it.
 */
closest: number | null, };

export type WalkAccount = { 
/**
 * Visited boxes or cells, in order.
 */
steps: Array<WalkStep>, 
/**
 * Number of visited nodes or cells.
 */
visits: number, 
/**
 * Number of tests against objects.
 */
tests: number, 
/**
 * Number of objects.
 */
objects: number, 
/**
 * The first hit.
 */
hit: WalkTest | null, 
/**
 * Boxes of the tree, or cells with objects in them, up to a limit.
 */
boxes: Array<BoxState>, };

export type BoxState = { 
/**
 * Depth; 0 for the box around everything.
 */
level: number, 
/**
 * Its eight corners, three numbers each: bit 0 of a corner's number is x, bit 1 y, bit 2 z.
 */
corners: Array<number>, };

export type TreeNode = { 
/**
 * Its keyword or file.
 */
name: string, 
/**
 * Place in the scene's text.
 */
place: Place | null, 
/**
 * Number of its material.
 */
material: number | null, 
/**
 * Nodes below it.
 */
nodes: Array<TreeNode>, };

export type MaterialState = { 
/**
 * Its keyword.
 */
name: string, 
/**
 * Place in the scene's text.
 */
place: Place | null, 
/**
 * Its fields.
 */
fields: Array<FieldState>, };

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
 * Meaning.
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
 * Default value.
 */
default: string | null, 
/**
 * True if it must be given.
 */
required: boolean, 
/**
 * Meaning and unit.
 */
doc: string, };
