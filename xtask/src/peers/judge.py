"""Statistics of two sets of pictures: equal means, and no structure in the difference."""

from math import erfc, sqrt

import numpy as np

RUNS = 8
BLOCK = 8
MEAN_LIMIT = 0.005
SIGNIFICANCE = 0.01


def deviate(share):
    """Returns the normal deviate with a given upper tail probability, by bisection."""
    low, high = 0.0, 10.0
    for _ in range(80):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if 0.5 * erfc(middle / sqrt(2)) > share else (low, middle)
    return low


class Judgement:
    """Compares pictures of one scene, in arrays of runs, rows, columns and channels."""

    def __init__(self, ours, theirs):
        if ours.shape != theirs.shape:
            raise RuntimeError(f"pictures of {ours.shape[2]} x {ours.shape[1]} and {theirs.shape[2]} x {theirs.shape[1]} pixels")
        runs = len(ours)
        # The mean of each channel.
        a, b = ours.mean((1, 2)), theirs.mean((1, 2))
        scale = np.maximum(b.mean(0), 1e-3 * b.mean() + 1e-9)
        # Two black pictures are equal.
        self.ratios = np.where(a.mean(0) == b.mean(0), 1, a.mean(0) / scale)
        errors = np.sqrt((a.var(0, ddof=1) + b.var(0, ddof=1)) / runs) / scale
        off = np.abs(a.mean(0) - b.mean(0)) / scale
        self.means_agree = bool((off <= np.maximum(MEAN_LIMIT, 3 * errors)).all())
        self.worst = int(off.argmax())
        self.ratio, self.error = self.ratios[self.worst], errors.max()
        # The means of blocks of pixels.
        a, b = (self.blocks(pictures) for pictures in (ours, theirs))
        square = (a.var(0, ddof=1) + b.var(0, ddof=1)) / runs
        difference = a.mean(0) - b.mean(0)
        # Pictures without randomness differ by rounding.
        t2 = difference**2 / np.maximum(square, (1e-4 * b.mean()) ** 2 + 1e-18)
        freedom = 2 * (runs - 1)
        # Convert Student's t to a normal deviate: Wallace 1959.
        z = np.sqrt(freedom * np.log1p(t2 / freedom)) * (8 * freedom + 1) / (8 * freedom + 3)
        limit = deviate((1 - (1 - SIGNIFICANCE) ** (1 / z.size)) / 2)
        z = np.where(np.abs(difference) > MEAN_LIMIT * b.mean(0), z, 0)
        self.blocks_off, self.block_count = int((z > limit).any(-1).sum()), z.size // 3
        self.deviate = float(z.max())

    def blocks(self, pictures):
        """Returns the means of the blocks, the last of which may be smaller."""
        rows, columns = (np.arange(0, n, BLOCK) for n in pictures.shape[1:3])
        sums = np.add.reduceat(np.add.reduceat(pictures, rows, 1), columns, 2)
        counts = np.add.reduceat(np.add.reduceat(np.ones_like(pictures[0]), rows, 0), columns, 1)
        return sums / counts

    @property
    def agrees(self):
        return self.means_agree and self.blocks_off == 0
