"""Stage 0: fit the Bessel ratios -> src/viscoroll/kernels/bessel/ratios.npy (kept in git).

    python -m pipeline.evidence.truth.ratios [-o FILE]

r = I1/I0, k = K0/K1 and i2 = I2/I0 are evaluated with 60 digits at the Chebyshev
points of every bin of the layout, interpolated there, and rounded to double once, as
monomials about the centre of the bin.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import mpmath as mp
import numpy as np
from tqdm import tqdm

from viscoroll.core.files import replacing
from viscoroll.kernels.bessel import layout as layout

from .series import of_mpmath

TARGET = Path(__file__).parents[3] / "src/viscoroll/kernels/bessel/ratios.npy"
NODES = layout.COEFFICIENTS + 1


OF = of_mpmath(mp)
EVALUATE = {
    "r(x)/x": lambda x: OF.r(x) / x,
    "x (1 - r(x))": lambda x: x * (1 - OF.r(x)),
    "k(z)/z": lambda z: OF.k(z) / z,
    "z (1 - k(z))": lambda z: z * (1 - OF.k(z)),
    "i2(x)/x^2": lambda x: OF.i2(x) / x**2,
}


def chebyshev_fit(values: list[mp.mpf], half_width: mp.mpf) -> list[mp.mpf]:
    """Monomial coefficients in t of the truncated Chebyshev series on |t| <= half_width."""
    count = len(values)
    angles = [mp.pi * (2 * i + 1) / (2 * count) for i in range(count)]
    series = [
        2 * mp.fsum(v * mp.cos(n * a) for v, a in zip(values, angles, strict=True)) / count
        for n in range(layout.COEFFICIENTS)
    ]
    series[0] /= 2
    monomials = [mp.mpf(0)] * layout.COEFFICIENTS
    previous, current = [mp.mpf(1)], [mp.mpf(0), mp.mpf(1)]
    for n, coefficient in enumerate(series):
        polynomial = previous if n == 0 else current
        for power, factor in enumerate(polynomial):
            monomials[power] += coefficient * factor
        if n > 0:
            doubled = [mp.mpf(0)] + [2 * factor for factor in current]
            for power, factor in enumerate(previous):
                doubled[power] -= factor
            previous, current = current, doubled
    return [m / half_width**power for power, m in enumerate(monomials)]


def fit_segment(segment: layout.Segment, progress: tqdm) -> list[float]:
    """Coefficients of every bin of one segment, in table order."""
    half_width = mp.mpf(1) / (2 * layout.BINS)
    points = [half_width * mp.cos(mp.pi * (2 * i + 1) / (2 * NODES)) for i in range(NODES)]
    coefficients: list[float] = []
    for octave in range(segment.low, segment.high):
        for index in range(layout.BINS):
            centre = 1 + (2 * index + 1) * half_width
            values = [EVALUATE[segment.function]((centre + t) * mp.mpf(2) ** octave) for t in points]
            coefficients += [float(m) for m in chebyshev_fit(values, half_width)]
            progress.update()
    return coefficients


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("-o", "--output", type=Path, default=TARGET)
    output = parser.parse_args().output
    mp.mp.dps = 60
    with tqdm(total=layout.TABLE_SIZE // layout.COEFFICIENTS, desc="bins") as progress:
        table = [c for segment in layout.SEGMENTS for c in fit_segment(segment, progress)]
    with replacing(output) as temporary:
        np.save(temporary, np.array(table))


if __name__ == "__main__":
    main()
