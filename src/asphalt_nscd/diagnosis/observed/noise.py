"""Scatter of the tests of a table: replicates, specimens, and any discrepancy beside them; residuals whitened by it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.lapack import dpotrf, dtrtrs

from asphalt_nscd.diagnosis.observed.observations import Complex, Vector


@dataclass(frozen=True)
class Noise:
    """Replicate scatter of ln|E*| and of the phase [rad], the specimens' scale, and any discrepancy beside them.

    `within` and `shared` (2, n): standard deviations of a single test and of what the tests of one block share; `block`
    (n,) numbers the isotherm of a specimen. `sigma`: scatter of one test, mean over the table; `scale`: standard
    deviation of ln|E*| between specimens; `freedom`: degrees of freedom of the estimate. `discrepancy` (2n, q): factor
    R of a covariance R R^T, added where a table holds more than scatter.
    """

    within: NDArray
    shared: NDArray
    block: NDArray[np.int64]
    sigma: tuple[float, float]
    scale: float
    freedom: int
    discrepancy: NDArray | None = None

    def add_discrepancy(self, factor: NDArray) -> Noise:
        """This noise with another discrepancy beside its own; `factor` (2n, q) is that of its covariance."""
        both = factor if self.discrepancy is None else np.hstack([self.discrepancy, factor])
        return replace(self, discrepancy=both)

    def subset(self, rows: NDArray) -> Noise:
        """The noise of some of the tests, given as a mask or an index; their blocks are numbered anew."""
        # rows of ln|E*|, then of the phase
        rows_of_both = np.concatenate(
            [np.arange(self.block.size)[rows] + k * self.block.size for k in (0, 1)]
        )
        discrepancy = None if self.discrepancy is None else self.discrepancy[rows_of_both]
        block = np.unique(self.block[rows], return_inverse=True)[1]
        return replace(
            self,
            within=self.within[:, rows],
            shared=self.shared[:, rows],
            block=block,
            discrepancy=discrepancy,
        )

    def whiten(self, values: Complex) -> Vector:
        """ln E* (n, ...) in units of the scatter: real and of unit scatter (2n, ...)."""
        white = np.concatenate([self._whitened(0, values.real), self._whitened(1, values.imag)])
        if self.discrepancy is None:
            return white
        factor, lower, lower_and_one = self._whitened_discrepancy
        half = dtrtrs(lower, factor.T @ white, lower=1)[0]
        return white - factor @ dtrtrs(lower_and_one, half, lower=1, trans=1)[0]

    def _whitened(self, part: int, values: NDArray) -> NDArray:
        """Values divided by the symmetric root of a variance and a share common to each block."""
        scaled = values / self.within[part].reshape(-1, *[1] * (values.ndim - 1))
        membership, pull = self._pulls[part]
        return scaled if membership is None else scaled - pull @ (membership.T @ scaled)

    @cached_property
    def _pulls(self) -> list[tuple[NDArray | None, NDArray]]:
        """Of modulus and phase: the tests of each block, and what their sum takes off; None where nothing is shared."""
        out: list[tuple[NDArray | None, NDArray]] = []
        count = np.bincount(self.block)
        membership = np.eye(count.size)[self.block]
        for within, shared in zip(self.within, self.shared, strict=True):
            # Within a block the two have one ratio, for both follow the scatter of their isotherm.
            ratio = np.bincount(self.block, (shared / within) ** 2) / count
            pull = (1.0 - 1.0 / np.sqrt(1.0 + count * ratio)) / count
            out.append((membership if shared.any() else None, membership * pull))
        return out

    @cached_property
    def _whitened_discrepancy(self) -> tuple[NDArray, NDArray, NDArray]:
        """F (2n, q), L and 1 + L (q, q): F is the discrepancy's factor in units of the scatter, L L^T = 1 + F^T F.

        M = 1 - F (1 + L)^-T L^-1 F^T is an inverse root: M^T M = (1 + F F^T)^-1. It needs no eigenvectors.
        """
        assert self.discrepancy is not None
        modulus, phase = np.split(self.discrepancy, 2)
        factor = np.concatenate([self._whitened(0, modulus), self._whitened(1, phase)])
        at = np.diag_indices(factor.shape[1])
        gram = factor.T @ factor
        gram[at] += 1.0
        # Transposed, for LAPACK wants columns: the Gram matrix is symmetric, and nothing is copied.
        lower, failed = dpotrf(gram.T, lower=1, overwrite_a=1)
        if failed:
            raise np.linalg.LinAlgError("no discrepancy of finite size")
        lower_and_one = lower.copy(order="F")
        lower_and_one[at] += 1.0
        return factor, lower, lower_and_one

    @cached_property
    def log_determinant(self) -> float:
        """ln of the determinant of the covariance, discrepancy included."""
        own = sum(
            2.0 * float(np.log(within).sum())
            + float(np.log1p(np.bincount(self.block, (shared / within) ** 2)).sum())
            for within, shared in zip(self.within, self.shared, strict=True)
        )
        return own + 2.0 * float(np.log(np.diag(self._whitened_discrepancy[1])).sum())
