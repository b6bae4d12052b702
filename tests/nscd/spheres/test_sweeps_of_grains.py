"""When the sweeps of a step end, and which contacts they visit."""

from __future__ import annotations

import numpy as np
import pytest
from theory.grains import (
    cloud,
    numerics,
)

from asphalt_nscd.nscd.lanes import WIDTH
from asphalt_nscd.nscd.spheres.blocks import deal_blocks
from asphalt_nscd.nscd.spheres.gauss_seidel import (
    COUNT,
    NOTED,
    RELAXATION,
    ROUND,
    sweep_blocks,
    sweep_until,
)
from asphalt_nscd.nscd.spheres.granular import pack_motion, pack_place, pack_planes, pack_slab
from asphalt_nscd.nscd.spheres.laws import ContactLaw
from asphalt_nscd.nscd.spheres.slabs import workspace_for
from asphalt_nscd.nscd.team import Team
from asphalt_nscd.specimen.deposit import settle

ROOM = np.empty((1, 1, WIDTH), np.int32)


@pytest.mark.parametrize("tolerance", [1e-2, 1e-4])
def test_only_a_sweep_over_all_contacts_ends_a_step(tolerance):
    """Grains thrown together: where it ends, one more sweep over all changes no more than the last one;
    rounds cut short leave the change above the tolerance."""
    pile = cloud(3, 0.0, 0.5)
    for _ in range(150):
        pile.advance(numerics(tolerance=1e-3, most_sweeps=60))
    slabs, workspace = pile._slabs, pile._workspace
    numbers = range(slabs.begin.size - 1)
    for most_sweeps in (2 * ROUND - 1, 100 * ROUND):
        pack_motion(pile.velocity, pile.inverse_mass, 0, len(pile.velocity), workspace.motion)
        pack_place(pile.position, pile.radius, 0, len(pile.position), workspace.place)
        workspace.contacts[:, 3:6] = 0.0  # impulses
        for slab in numbers:
            pack_planes(slab, pile.plane_point, pile.plane_normal, workspace)
            pack_slab(slab, slabs, workspace, 1e-4, 0.0, np.inf, 3e-4)
        workspace.contacts[:, 6] = 0.0  # targets
        sweeps, change = sweep_until(
            0,
            1,
            np.zeros(32, int),
            slabs,
            workspace,
            ContactLaw(0.5, 0.5),
            np.zeros(2),
            tolerance,
            np.inf,
            most_sweeps,
            most_sweeps,
        )
        if most_sweeps < 2 * ROUND:
            assert sweeps == most_sweeps
            assert change > tolerance
    assert sweeps % ROUND == 1
    assert change < tolerance
    once_more = [
        sweep_blocks(
            slabs.blocks, workspace.contacts, slabs.begin[slab], slabs.begin[slab + 1] - slabs.begin[slab],
            WIDTH * slabs.begin[slab], ContactLaw(0.5, 0.5), 1.0, 0.0, np.inf, workspace, ROOM,
            len(workspace.noted) - 2,
        )
        for slab in sorted(numbers, key=lambda slab: slab % 2)
    ]  # fmt: skip
    changed, size = np.sum(once_more, axis=0)[:2]
    assert 0.0 < np.sqrt(changed / size) < tolerance


def sweeps_of_a_squeezed_grain(relaxation):
    """Until a light ball on the floor has stopped one 125 times as heavy, to 1e-6 of its speed."""
    bodies = np.array([[1, 0], [0, 2]], np.int32)  # heavy and light, light and floor
    begin, pairs = np.array([0, 2, 2]), np.arange(2, dtype=np.int32)
    slabs, workspace = deal_blocks(Team(), begin, pairs, bodies, workspace_for(0, 3, 1))
    block, lane = np.divmod(np.argsort(slabs.pair)[-2:], WIDTH)
    contacts, motion = workspace.contacts, workspace.motion
    contacts[block, 2, lane] = -1.0  # both normals point down
    contacts[block, 7, lane] = 1.0 / (1.0 + 1.0 / 125.0), 1.0
    motion[:2, 3] = 1.0, 1.0 / 125.0
    motion[:, 7] = 2.5 * motion[:, 3]
    motion[1, 2] = -1.0
    for sweep in range(5000):
        if abs(motion[1, 2]) < 1e-6:
            np.testing.assert_allclose(contacts[block, 5, lane], -125.0, rtol=1e-5)  # both stop it
            return sweep
        sweep_blocks(
            slabs.blocks,
            contacts,
            0,
            slabs.begin[1],
            0,
            ContactLaw(),
            relaxation,
            np.inf,
            np.inf,
            workspace,
            ROOM,
            len(workspace.noted) - 2,
        )
    raise AssertionError("not at rest")


def test_over_relaxation_helps_a_squeezed_grain():
    """Plain sweeps leave 1/(1 + m/M) of the speed each; a third as many do here."""
    plain = sweeps_of_a_squeezed_grain(1.0)
    assert plain == pytest.approx(6.0 * np.log(10.0) / np.log(126.0 / 125.0), rel=0.01)
    assert sweeps_of_a_squeezed_grain(RELAXATION) < 0.35 * plain


def test_the_impulses_of_the_step_before_tell_what_is_quiet():
    """At rest almost no contact changes, and almost none is visited again."""
    pile = cloud(8, 0.0, 0.5)
    settle(pile, numerics(time_step=2e-4, tolerance=1e-6, most_sweeps=200), 1e-5, 3.0, lambda *_: None, "")
    sweeps, _ = pile.advance(numerics(time_step=2e-4, tolerance=1e-3, most_sweeps=60))
    account = pile._workspace.account[: pile._slabs.begin.size - 1]
    assert sweeps == 1
    assert account[:, COUNT].sum() > 50
    assert account[:, NOTED].sum() < 0.1 * account[:, COUNT].sum()
