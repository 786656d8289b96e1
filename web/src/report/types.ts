// Written by `DURER_WRITE=1 cargo test -p durer-cli --lib` from crates/durer-cli/src/page/types.rs.

import type { DrawnScene, ExplainedSample } from "../protocol";

export type Report = { "kind": "explain" } & ExplainReport | { "kind": "compare" } & CompareReport | { "kind": "lesson" } & LessonReport | { "kind": "tour" } & TourReport;

export type ExplainReport = { 
/**
 * Name of the scene's file.
 */
file: string, 
/**
 * The explained pixel; `None` for a ray.
 */
pixel: [number, number] | null, 
/**
 * Name of the transfer curve of eight-bit colours.
 */
transfer: string, 
/**
 * Index of the sample that is shown first.
 */
sample: number, 
/**
 * Samples of the pixel, or a single one for a ray.
 */
samples: Array<ExplainedSample>, 
/**
 * Reasons why a sample is far brighter than the others; usually empty.
 */
notes: Array<string>, 
/**
 * The rendered picture as a data URI; `None` for a ray.
 */
picture: string | null, 
/**
 * Width and height of the picture in pixels.
 */
size: [number, number], 
/**
 * Line drawing of the scene.
 */
scene: DrawnScene, };

export type CompareReport = { 
/**
 * Reference, or folder of references.
 */
reference: string, 
/**
 * Picture, or folder of pictures.
 */
picture: string, 
/**
 * Largest difference per channel that counts as equal.
 */
tolerance: number, 
/**
 * Percentage of pixels that may exceed the tolerance.
 */
allow: number, 
/**
 * Pictures without a reference.
 */
extra: Array<string>, 
/**
 * Number of each student's pictures by verdict; empty if the pictures have no students.
 */
students: Array<StudentResult>, 
/**
 * The results as comma-separated values, as `--csv` prints them.
 */
csv: string, 
/**
 * Pairs of pictures.
 */
pairs: Array<PairReport>, };

export type StudentResult = { 
/**
 * Name of the student's folder.
 */
name: string, 
/**
 * Pictures that are the same or identical.
 */
same: number, 
/**
 * Pictures that differ.
 */
different: number, 
/**
 * Pictures that are missing.
 */
missing: number, 
/**
 * Pictures that cannot be compared.
 */
error: number, };

export type PairReport = { 
/**
 * Name of the picture after the name of the student.
 */
title: string, 
/**
 * Name of the picture.
 */
name: string, 
/**
 * Name of the student.
 */
student: string | null, 
/**
 * `identical`, `same`, `different`, `missing` or `error`.
 */
verdict: string, 
/**
 * Reason why the pictures cannot be compared.
 */
error: string | null, 
/**
 * The mistake that explains the difference, in words.
 */
mistake: string | null, 
/**
 * Lines that explain the difference.
 */
causes: Array<string>, 
/**
 * Note about the options of the reference.
 */
note: string | null, 
/**
 * Metrics and pictures; `None` if the pictures were not compared.
 */
comparison: ComparisonReport | null, };

export type ComparisonReport = { 
/**
 * Width in pixels.
 */
width: number, 
/**
 * Height in pixels.
 */
height: number, 
/**
 * True if linear light was compared, false for display values.
 */
linear: boolean, 
/**
 * Root mean square error.
 */
rmse: number, 
/**
 * Peak signal-to-noise ratio in decibels; `None` if it is infinite.
 */
psnr: number | null, 
/**
 * Structural similarity; `None` if a picture is too small.
 */
ssim: number | null, 
/**
 * Mean FLIP error.
 */
flip: number, 
/**
 * Mean HDR-FLIP error, for linear light.
 */
hdr_flip: number | null, 
/**
 * Number of pixels over the tolerance.
 */
over_tolerance: number, 
/**
 * Number of pixels with a value that is not finite, in the reference and in the picture.
 */
not_finite: [number, number], 
/**
 * Pixel that differs most.
 */
largest: LargestDifference | null, 
/**
 * Regions that differ.
 */
regions: Array<RegionReport>, 
/**
 * The pictures.
 */
pictures: PairPictures, };

export type LargestDifference = { 
/**
 * Absolute difference in one channel.
 */
difference: number, 
/**
 * Column.
 */
x: number, 
/**
 * Row.
 */
y: number, 
/**
 * Colour in the reference.
 */
reference: [number, number, number], 
/**
 * Colour in the picture.
 */
picture: [number, number, number], };

export type RegionReport = { 
/**
 * Leftmost column.
 */
x: number, 
/**
 * Top row.
 */
y: number, 
/**
 * Width in pixels.
 */
width: number, 
/**
 * Height in pixels.
 */
height: number, 
/**
 * Size, place and difference in words.
 */
text: string, 
/**
 * The hit in the scene there; `None` without a scene.
 */
there: RegionHit | null, };

export type RegionHit = { 
/**
 * The hit in words.
 */
hit: string, 
/**
 * Command that explains the pixel.
 */
command: string, 
/**
 * Lines that the command prints for this ray.
 */
explanation: Array<string>, };

export type PairPictures = { 
/**
 * The reference.
 */
reference: string, 
/**
 * The picture.
 */
picture: string, 
/**
 * Heat map of the FLIP error.
 */
heat: string, };

export type LessonReport = { 
/**
 * Name of the scene's file.
 */
scene: string, 
/**
 * Steps in order.
 */
steps: Array<LessonStep>, 
/**
 * Pictures as data URIs, by name.
 */
pictures: { [key in string]?: string }, 
/**
 * Text of the built-in scene, if a step uses it.
 */
own_scene: string | null, };

export type LessonStep = { 
/**
 * Title.
 */
title: string, 
/**
 * Reason why the step uses the built-in scene; `None` if it uses the user's scene.
 */
elsewhere: string | null, 
/**
 * Explanation; `None` if the step continues the topic of the previous one.
 */
words: string | null, 
/**
 * Equations; empty if the step continues a topic.
 */
equations: Array<string>, 
/**
 * Picture before the step.
 */
before: LessonFigure | null, 
/**
 * Picture after the step.
 */
after: LessonFigure, 
/**
 * Name of the picture of the change.
 */
change: string | null, 
/**
 * SVG drawing of the rays from above. It contains no text of the scene.
 */
plan: string | null, 
/**
 * Effect of the step, in numbers.
 */
facts: string, 
/**
 * Files and symbols in the source code.
 */
places: Array<[string, string]>, };

export type LessonFigure = { 
/**
 * Caption.
 */
caption: string, 
/**
 * Name of the picture.
 */
file: string, };

export type TourReport = { 
/**
 * Photographs with a known camera.
 */
photographs: Array<TourPhotograph>, 
/**
 * Positions of the points.
 */
points: Array<[number, number, number]>, 
/**
 * Colours of the points.
 */
colors: Array<[number, number, number]>, };

export type TourPhotograph = { 
/**
 * File name.
 */
name: string, 
/**
 * The photograph as a data URI.
 */
picture: string, 
/**
 * Width and height in pixels.
 */
size: [number, number], 
/**
 * Focal length in pixels.
 */
focal: number, 
/**
 * Position of the camera.
 */
center: [number, number, number], 
/**
 * Right, down and forward directions of the camera.
 */
rotation: [[number, number, number], [number, number, number], [number, number, number]], 
/**
 * Corners of the photograph in space: upper left, upper right, lower right, lower left.
 */
corners: [[number, number, number], [number, number, number], [number, number, number], [number, number, number]], 
/**
 * Indices of the points that the photograph shows.
 */
points: Array<number>, };
