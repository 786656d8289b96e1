// Written by `DURER_WRITE=1 cargo test -p durer-session` from crates/durer-session/src/protocol.rs.

export type RequestMessage = { 
/**
 * Number of the session, chosen by the page. A new number opens a new session.
 */
session: number, 
/**
 * Number of the request, from 1.
 */
id: number, 
/**
 * The request.
 */
request: Request, };

export type EventMessage = { 
/**
 * Number of the session.
 */
session: number, 
/**
 * Number of the request that it answers; 0 if unsolicited.
 */
id: number, 
/**
 * The event.
 */
event: Event, };

export type Request = { "kind": "open", 
/**
 * Name of the file; its extension determines the format. Empty for the server's own file.
 */
name: string, 
/**
 * Text of the scene; `None` for a file.
 */
text: string | null, } | { "kind": "give", 
/**
 * Name of the file, as written in the scene.
 */
name: string, 
/**
 * Contents in base64.
 */
base64: string, 
/**
 * True if this is the scene itself.
 */
opens: boolean, } | { "kind": "edit", 
/**
 * The text.
 */
text: string, } | { "kind": "size", 
/**
 * Width in pixels.
 */
width: number, 
/**
 * Height in pixels.
 */
height: number, } | { "kind": "show", 
/**
 * `color`, or the name of an auxiliary picture.
 */
picture: string, 
/**
 * Exposure in stops: radiance is multiplied by 2 to this power.
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
 * The motion.
 */
motion: Motion, 
/**
 * True while the motion continues: only coarse pictures are rendered.
 */
moving: boolean, } | { "kind": "field", 
/**
 * Keyword of the field in the scene language.
 */
name: string, 
/**
 * Numbers of its value.
 */
values: Array<number>, 
/**
 * The value, if it is a word.
 */
word: string | null, 
/**
 * True while the motion continues.
 */
moving: boolean, } | { "kind": "look", 
/**
 * Position of the eye in world space.
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
 * True while the motion continues.
 */
moving: boolean, } | { "kind": "camera", 
/**
 * Keyword of the new camera, from the `cameras` of [`Event::Opened`].
 */
keyword: string, } | { "kind": "write_camera" } | { "kind": "explain", 
/**
 * Column from the left.
 */
x: number, 
/**
 * Row from the top.
 */
y: number, 
/**
 * Index of the sample; `None` selects the sample with the largest contribution.
 */
sample: number | null, } | { "kind": "cast", 
/**
 * Origin of the ray in world space.
 */
origin: [number, number, number], 
/**
 * Direction of the ray, of any length.
 */
direction: [number, number, number], 
/**
 * End of the ray, in lengths of `direction`; `None` for an infinite ray.
 */
t_max: number | null, } | { "kind": "rays", 
/**
 * Number of columns of the raster.
 */
columns: number, 
/**
 * Number of rows of the raster.
 */
rows: number, 
/**
 * The requested row; `None` for all rows.
 */
row: number | null, } | { "kind": "walk", 
/**
 * Structure to traverse.
 */
structure: Structure, 
/**
 * Origin of the ray.
 */
origin: [number, number, number], 
/**
 * Direction of the ray, of any length.
 */
direction: [number, number, number], 
/**
 * End of the ray, in lengths of `direction`; `None` for an infinite ray.
 */
t_max: number | null, 
/**
 * True for a shadow ray, which ends at any hit; false to find the closest hit.
 */
any: boolean, } | { "kind": "boxes" } | { "kind": "values", 
/**
 * First column.
 */
left: number, 
/**
 * First row.
 */
top: number, 
/**
 * Number of columns.
 */
width: number, 
/**
 * Number of rows.
 */
height: number, } | { "kind": "crop", 
/**
 * Part to render; `None` for the full picture.
 */
crop: [number, number, number, number] | null, } | { "kind": "denoise", 
/**
 * True to turn it on.
 */
on: boolean, } | { "kind": "epsilon", 
/**
 * Minimum `t`; `None` for Dürer's exact ray origins.
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
 * Numbers of its value.
 */
values: Array<number>, 
/**
 * The value, if it is a word.
 */
word: string | null, } | { "kind": "as_text" } | { "kind": "pack" } | { "kind": "lesson" } | { "kind": "mistakes" } | { "kind": "mistake", 
/**
 * Name of the mistake; `None` renders the correct picture for comparison.
 */
name: string | null, 
/**
 * Value of the mistake, such as a factor; `None` for its first value.
 */
value: number | null, 
/**
 * Width of the picture in pixels.
 */
width: number, 
/**
 * Height of the picture in pixels.
 */
height: number, } | { "kind": "outlines" } | { "kind": "language" } | { "kind": "export", 
/**
 * Name of the file; its extension selects the format.
 */
name: string, } | { "kind": "save", 
/**
 * True to overwrite changes by other programs.
 */
force: boolean, } | { "kind": "share", 
/**
 * Number of this worker, from 1.
 */
index: number, 
/**
 * Number of workers, at most 64.
 */
count: number, } | { "kind": "pause", 
/**
 * True to pause.
 */
pause: boolean, } | { "kind": "close" };

export type Event = { "kind": "opened", 
/**
 * Version of the program.
 */
version: string, 
/**
 * Name of the file.
 */
name: string, 
/**
 * Text of the scene; `None` for a model in a binary format.
 */
text: string | null, 
/**
 * True if the scene can be saved.
 */
saves: boolean, 
/**
 * Pictures that can be shown.
 */
pictures: Array<NamedChoice>, 
/**
 * Tone curves.
 */
tones: Array<string>, 
/**
 * Integrators.
 */
integrators: Array<NamedChoice>, 
/**
 * Kinds of cameras, by keyword.
 */
cameras: Array<NamedChoice>, } | { "kind": "scene", 
/**
 * Findings of the parser and the compiler.
 */
findings: Array<Finding>, 
/**
 * Contents of the scene; `None` after errors, in which case the previous picture remains.
 */
contents: SceneSummary | null, 
/**
 * Time to read and compile it, in milliseconds.
 */
ms: number, } | { "kind": "checked", 
/**
 * The findings, including those of [`Event::Scene`].
 */
findings: Array<Finding>, } | { "kind": "camera", 
/**
 * The current camera.
 */
camera: CameraState, } | { "kind": "picture", 
/**
 * Description of the payload.
 */
head: PictureInfo, } | { "kind": "explained", 
/**
 * The pixel.
 */
pixel: PixelExplanation, } | { "kind": "cast", 
/**
 * The results.
 */
cast: CastResult, } | { "kind": "rays", 
/**
 * The rays.
 */
rays: Array<CameraRay | null>, } | { "kind": "walk", 
/**
 * The traversal.
 */
walk: Traversal, } | { "kind": "boxes", 
/**
 * Boxes, level by level, up to a limit.
 */
boxes: Array<TreeBox>, } | { "kind": "values", 
/**
 * First column.
 */
left: number, 
/**
 * First row.
 */
top: number, 
/**
 * Number of columns.
 */
width: number, 
/**
 * Number of rows.
 */
height: number, 
/**
 * Linear light, or the values of the picture that is shown instead of colour.
 */
values: Array<number | null>, } | { "kind": "tree", 
/**
 * The objects.
 */
nodes: Array<SceneNode>, 
/**
 * The materials, by number.
 */
materials: Array<MaterialState>, } | { "kind": "packed", 
/**
 * Names of the files; the text is first.
 */
names: Array<string>, 
/**
 * Sizes in bytes.
 */
sizes: Array<number>, } | { "kind": "lesson", 
/**
 * Lesson in Markdown; `None` if the server has none.
 */
text: string | null, } | { "kind": "mistakes", 
/**
 * The mistakes.
 */
mistakes: Array<MistakeChoice>, } | { "kind": "mistaken", 
/**
 * Width in pixels.
 */
width: number, 
/**
 * Height in pixels.
 */
height: number, 
/**
 * Fraction of the pixels whose eight-bit colour differs from the correct picture.
 */
changed: number, 
/**
 * Description and code of the mistake for the requested value; `None` for the correct
 * picture.
 */
mistake: MistakeChoice | null, } | { "kind": "part", 
/**
 * Number of changes to the scene, camera and options before this picture.
 */
revision: number, 
/**
 * Number of the worker, from 1.
 */
index: number, 
/**
 * True if the worker's share is finished.
 */
finished: boolean, } | { "kind": "outlines", 
/**
 * Outlines, one per object, up to a limit.
 */
outlines: Array<Outline>, 
/**
 * Lights that have a position or a direction.
 */
lamps: Array<LightMarker>, } | { "kind": "language", 
/**
 * Keywords that begin a statement.
 */
words: Array<Keyword>, } | { "kind": "text", 
/**
 * The new text.
 */
text: string, 
/**
 * True if the file changed on disk.
 */
from_disk: boolean, } | { "kind": "exported", 
/**
 * Name of the file.
 */
name: string, } | { "kind": "saved" } | { "kind": "conflict" } | { "kind": "refused", 
/**
 * Reason.
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
 * Factor on the distance to the target, 0.01 to 100.
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

export type NamedChoice = { 
/**
 * Name of the item.
 */
name: string, 
/**
 * Meaning of the item.
 */
doc: string, };

export type TextPosition = { 
/**
 * Line, from 1.
 */
line: number, 
/**
 * Column in characters, from 1.
 */
column: number, 
/**
 * Byte offset of the start.
 */
start: number, 
/**
 * Byte offset of the end of the keyword, exclusive.
 */
end: number, 
/**
 * Byte offset of the end of the statement's block, exclusive; equal to `end` if no block
 * follows the keyword.
 */
block_end: number, };

export type Severity = "note" | "warning" | "error";

export type Finding = { 
/**
 * Severity of the finding.
 */
severity: Severity, 
/**
 * Kind of the finding; may be empty.
 */
code: string, 
/**
 * Message in one sentence.
 */
message: string, 
/**
 * Hint on how to fix the problem.
 */
help: string | null, 
/**
 * Effect on the picture.
 */
effect: string | null, 
/**
 * Name of the file, if it is not the scene's own.
 */
file: string | null, 
/**
 * Place in the file.
 */
place: TextPosition | null, 
/**
 * Edits that fix the problem.
 */
fix: Array<TextEdit>, };

export type TextEdit = { 
/**
 * Byte offset of the start of the replaced range.
 */
start: number, 
/**
 * Byte offset of its end, exclusive.
 */
end: number, 
/**
 * Replacement.
 */
text: string, };

export type SceneSummary = { 
/**
 * Name of the dialect.
 */
dialect: string, 
/**
 * The current camera.
 */
camera: CameraState, 
/**
 * Objects by number, up to a limit.
 */
objects: Array<SceneItem>, 
/**
 * Number of objects.
 */
object_count: number, 
/**
 * Number of triangles.
 */
triangles: number, 
/**
 * Lights by number.
 */
lights: Array<SceneItem>, 
/**
 * Minimum and maximum corner of the bounding box of all bounded objects, in world space.
 */
bounds: [[number, number, number], [number, number, number]], 
/**
 * Options of the job, without its size.
 */
job: JobState, };

export type JobState = { 
/**
 * Default size of the scene, in pixels.
 */
size: [number, number], 
/**
 * Name of the integrator.
 */
integrator: string, 
/**
 * Samples per pixel.
 */
samples: number, 
/**
 * Maximum depth of mirrored and transmitted rays.
 */
bounces: number, 
/**
 * Options that differ from the scene's defaults, as command-line arguments.
 */
words: Array<string>, };

export type SceneItem = { 
/**
 * Keyword and line.
 */
name: string, 
/**
 * Place in the scene's text.
 */
place: TextPosition | null, };

export type CameraState = { 
/**
 * Keyword of the camera.
 */
keyword: string, 
/**
 * Position of the eye in world space.
 */
eye: [number, number, number], 
/**
 * View direction in world space, unit length.
 */
forward: [number, number, number], 
/**
 * Right direction of the picture in world space.
 */
right: [number, number, number], 
/**
 * Up direction of the picture in world space.
 */
up: [number, number, number], 
/**
 * Half the visible width at distance 1, along the larger side.
 */
half_width: number, 
/**
 * Distance from the eye to the target.
 */
distance: number, 
/**
 * True if straight lines in space appear as straight lines in the picture, as with a pinhole.
 * A point at (x, y, z) in the coordinates of `right`, `up` and `forward` is then shown at
 * (x, y) / (z `half_width`).
 */
projects: boolean, 
/**
 * Fields of the camera.
 */
fields: Array<FieldState>, 
/**
 * Statement of the camera in the scene language.
 */
statement: string, 
/**
 * True if the camera differs from the one in the text.
 */
moved: boolean, };

export type FieldState = { 
/**
 * Keyword in the scene language.
 */
name: string, 
/**
 * Meaning and unit.
 */
doc: string, 
/**
 * Numbers of the value; empty for words and files.
 */
values: Array<number>, 
/**
 * Value, if it is a word or a file name.
 */
text: string, 
/**
 * Minimum value, if there is one.
 */
least: number | null, 
/**
 * Maximum value, if there is one.
 */
most: number | null, 
/**
 * True if the value must be greater than `least`.
 */
above_least: boolean, 
/**
 * True if the value must be less than `most`.
 */
below_most: boolean, 
/**
 * True for a whole number.
 */
whole: boolean, 
/**
 * Possible values, if the value is a word; otherwise empty.
 */
choices: Array<string>, };

export type MistakeChoice = { 
/**
 * Name of the mistake.
 */
name: string, 
/**
 * Description in words.
 */
description: string, 
/**
 * Correct code.
 */
right: string, 
/**
 * Wrong code.
 */
wrong: string, 
/**
 * Topic of the lecture that covers the mistake.
 */
topic: string, 
/**
 * Values with which the mistake is tried; a single 0 if it has none.
 */
values: Array<number>, };

export type PictureInfo = { 
/**
 * `color`, or the name of an auxiliary picture.
 */
picture: string, 
/**
 * Width of the payload in pixels.
 */
width: number, 
/**
 * Height of the payload in pixels.
 */
height: number, 
/**
 * Width of the full picture in pixels; more than `width` for a coarse picture.
 */
full_width: number, 
/**
 * Height of the full picture in pixels.
 */
full_height: number, 
/**
 * Samples per pixel so far.
 */
samples: number, 
/**
 * Samples per pixel of the finished picture.
 */
all_samples: number, 
/**
 * Part of the picture that follows, in pixels of the full picture: first column, first row,
 * width and height. A coarse part may extend beyond the edge.
 */
region: [number, number, number, number], 
/**
 * Visible error, which `durer render --noise-threshold` limits; `None` if not yet known.
 */
noise: number | null, 
/**
 * Estimated time until the picture is finished, in milliseconds; `None` if not yet known.
 */
left_ms: number | null, 
/**
 * True if the picture is denoised.
 */
denoised: boolean, 
/**
 * Number of rays traced.
 */
rays: number, 
/**
 * Time since the change that the picture shows, in milliseconds.
 */
ms: number, 
/**
 * Hash of the finished picture, as `durer render --hash` prints it.
 */
hash: string | null, };

export type FormulaRow = { 
/**
 * Name of the result.
 */
name: string, 
/**
 * Formula in symbols.
 */
formula: string, 
/**
 * Formula in numbers; may be empty.
 */
numbers: string, 
/**
 * Result as text.
 */
result: string, 
/**
 * Result as a number, if it is a scalar.
 */
value: number | null, };

export type Segment = { 
/**
 * Kind of the ray.
 */
role: SegmentKind, 
/**
 * Start in world space.
 */
from: [number, number, number], 
/**
 * End in world space.
 */
to: [number, number, number], 
/**
 * True if the ray leaves the scene.
 */
escapes: boolean, };

export type SegmentKind = "camera" | "reflected" | "transmitted" | "scattered" | "lit" | "shadowed";

export type Term = { 
/**
 * Title.
 */
title: string, 
/**
 * Formulas of the term.
 */
rows: Array<FormulaRow>, 
/**
 * Value of the term, as linear RGB.
 */
value: [number, number, number], 
/**
 * Contribution to the pixel, as linear RGB.
 */
adds: [number, number, number], 
/**
 * Share of the pixel's luminance, 0 to 1.
 */
share: number, 
/**
 * Value as 8-bit sRGB.
 */
swatch: [number, number, number], 
/**
 * Place of the object or light in the text.
 */
place: TextPosition | null, 
/**
 * Segment to draw.
 */
segment: Segment | null, 
/**
 * Position and normal of the hit, in world space.
 */
normal: [[number, number, number], [number, number, number]] | null, 
/**
 * Origin and direction of the ray, for `Request::Cast`.
 */
ray: [[number, number, number], [number, number, number]] | null, 
/**
 * End of the ray, if finite.
 */
t_max: number | null, 
/**
 * Number of the hit or blocking object.
 */
object: number | null, 
/**
 * Lines that derive the numbers of the term from the fields of the scene.
 */
origins: Array<string>, 
/**
 * Terms that sum to this one.
 */
terms: Array<Term>, };

export type PixelExplanation = { 
/**
 * Column from the left.
 */
x: number, 
/**
 * Row from the top.
 */
y: number, 
/**
 * Colour as linear RGB.
 */
color: [number, number, number], 
/**
 * Colour as 8-bit sRGB.
 */
bytes: [number, number, number], 
/**
 * Number of samples.
 */
samples: number, 
/**
 * Index of the sample that `tree` explains.
 */
sample: number, 
/**
 * Position of the sample in the picture, in pixels from the upper left corner.
 */
at: [number, number], 
/**
 * Filter weight of the sample, divided by the sum of all weights.
 */
weight: number, 
/**
 * Tree of terms; `None` if the camera has no ray for this pixel.
 */
tree: Term | null, };

export type Verdict = "closest" | "farther" | "behind" | "beyond" | "missed";

export type ObjectTest = { 
/**
 * Number of the object.
 */
object: number, 
/**
 * Keyword and line of the object.
 */
name: string, 
/**
 * Place of the object in the text.
 */
place: TextPosition | null, 
/**
 * Result of the test.
 */
verdict: Verdict, 
/**
 * Result in words.
 */
why: string, 
/**
 * First crossing along the line, in lengths of the direction.
 */
t: number | null, 
/**
 * Formulas with numbers.
 */
rows: Array<FormulaRow>, };

export type CastResult = { 
/**
 * Origin of the ray in world space.
 */
origin: [number, number, number], 
/**
 * Direction of the ray.
 */
direction: [number, number, number], 
/**
 * Tests in the order of the text, up to a limit.
 */
tests: Array<ObjectTest>, 
/**
 * Number of objects beyond the limit.
 */
left_out: number, 
/**
 * The closest hit.
 */
hit: CastHit | null, };

export type CastHit = { 
/**
 * Number of the object.
 */
object: number, 
/**
 * Index of the triangle in a mesh, else 0.
 */
part: number, 
/**
 * Position along the ray, in lengths of its direction.
 */
t: number, 
/**
 * Position in world space.
 */
point: [number, number, number], 
/**
 * Geometric normal in world space, unit length.
 */
normal: [number, number, number], 
/**
 * Shading normal in world space, unit length.
 */
shading_normal: [number, number, number], 
/**
 * Texture coordinates, if the surface has any.
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
 * Polylines in world space, each as x, y, z of its points.
 */
lines: Array<Array<number>>, };

export type LightMarker = { 
/**
 * Position in world space; for a directional light, a point in the direction from which its
 * light comes.
 */
at: [number, number, number], 
/**
 * True for a directional light.
 */
far: boolean, 
/**
 * Keyword and line of the light.
 */
name: string, };

export type Structure = "tree" | "grid" | "nothing";

export type CameraRay = { 
/**
 * Origin.
 */
origin: [number, number, number], 
/**
 * Direction, of length 1.
 */
direction: [number, number, number], 
/**
 * Ray parameter of the first hit.
 */
t: number | null, 
/**
 * Number of the hit object.
 */
object: number | null, };

export type TraversalTest = { 
/**
 * Number of the object.
 */
object: number, 
/**
 * Ray parameter of the first hit on the object.
 */
t: number | null, };

export type TraversalStep = { 
/**
 * Two opposite corners; `None` for objects outside the structure.
 */
bounds: [[number, number, number], [number, number, number]] | null, 
/**
 * Depth of the box in its tree.
 */
level: number, 
/**
 * Tests of the objects in it.
 */
tests: Array<TraversalTest>, 
/**
 * Ray parameter of the nearest hit after this step.
 */
closest: number | null, };

export type Traversal = { 
/**
 * Visited boxes or cells, in visiting order.
 */
steps: Array<TraversalStep>, 
/**
 * Number of visited nodes or cells.
 */
visits: number, 
/**
 * Number of object tests.
 */
tests: number, 
/**
 * Number of objects.
 */
objects: number, 
/**
 * The first hit.
 */
hit: TraversalTest | null, 
/**
 * Boxes of the tree, or cells that contain objects, up to a limit.
 */
boxes: Array<TreeBox>, };

export type TreeBox = { 
/**
 * Depth; 0 for the root's box.
 */
level: number, 
/**
 * The eight corners, three coordinates each: bits 0, 1 and 2 of a corner's number select x, y
 * and z.
 */
corners: Array<number>, };

export type SceneNode = { 
/**
 * Keyword or file name of the node.
 */
name: string, 
/**
 * Position in the scene's text.
 */
place: TextPosition | null, 
/**
 * Number of the object in the list of [`super::SceneSummary`]; `None` for groups, transforms
 * and objects that are rendered as several.
 */
object: number | null, 
/**
 * Number of the node's material.
 */
material: number | null, 
/**
 * Child nodes.
 */
nodes: Array<SceneNode>, };

export type MaterialState = { 
/**
 * Keyword of the material.
 */
name: string, 
/**
 * Position in the scene's text.
 */
place: TextPosition | null, 
/**
 * Fields of the material.
 */
fields: Array<FieldState>, };

export type Keyword = { 
/**
 * The keyword.
 */
word: string, 
/**
 * Chapter of the manual.
 */
chapter: string, 
/**
 * Meaning.
 */
doc: string, 
/**
 * Fields of its block.
 */
fields: Array<KeywordField>, 
/**
 * Example.
 */
example: string, };

export type KeywordField = { 
/**
 * The keyword.
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
 * True if the field is required.
 */
required: boolean, 
/**
 * Meaning and unit.
 */
doc: string, };

export type DrawnScene = { 
/**
 * Outlines of the objects.
 */
outlines: Array<Outline>, 
/**
 * Marks for the lights.
 */
lights: Array<LightMarker>, 
/**
 * The camera.
 */
camera: CameraState, };

export type TermCast = { 
/**
 * Path of the term in the tree, such as `0.2.1`.
 */
path: string, 
/**
 * The tests.
 */
cast: CastResult, };

export type ExplainedSample = { 
/**
 * The pixel, and the tree of this sample.
 */
explanation: PixelExplanation, 
/**
 * Pixel to which the sample belongs.
 */
of: [number, number], 
/**
 * Tests of the rays in the tree; empty if the page has no room for those of this sample.
 */
casts: Array<TermCast>, };
