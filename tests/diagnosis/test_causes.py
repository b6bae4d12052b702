"""Each cause is absent at zero and moves the apparent modulus as its definition says."""

from dataclasses import replace

import numpy as np
import pytest

from asphalt_nscd.bending.rig import KEYS
from asphalt_nscd.diagnosis.causes import CATALOGUE, EVERY
from asphalt_nscd.diagnosis.causes.drifting_reading import READ_TOO_LARGE, SLOPES
from asphalt_nscd.diagnosis.model.bases import BurgersAtEach, FlexibleSpectrum
from asphalt_nscd.diagnosis.observed.observations import Observations
from asphalt_nscd.measurements.twopoint import Geometry, complex_modulus, form_factor, mass_factor
from asphalt_nscd.rheology.as_run import Programme, modulus_as_read
from asphalt_nscd.rheology.chain import KelvinChain

GEOMETRY = Geometry(b=0.025, B=0.056, e=0.025, h=0.25, mass=0.6, mobile_mass=0.235)
GAMMA, MU = form_factor(GEOMETRY), mass_factor(GEOMETRY)
OMEGA = 2 * np.pi * np.tile([3.0, 10, 40], 4)
E = np.repeat([20e9 + 2e9j, 12e9 + 3e9j, 6e9 + 3e9j, 2e9 + 1.5e9j], 3)
TABLE = Observations(
    specimen=np.tile([0, 1, 2], 4),
    names=("a", "b", "c"),
    temperature=np.repeat([-10.0, 0, 10, 30], 3),
    frequency=OMEGA / (2 * np.pi),
    modulus=E,
    form_factor=np.full(12, GAMMA),
    inertia=np.full(12, GAMMA * MU),
    amplitude=np.tile([20e-6, 40e-6, 80e-6], 4),
    order=np.arange(1.0, 13.0),
    time_step=np.full(12, 1e-4),
    static_modulus=1e8,
)
CAUSES = {cause.name: cause for cause in CATALOGUE}
SHAPES = {"secondary_process": (-1.0, 40.0, 0.5)}


def force(modulus):
    """Complex force per displacement at the head that the reduction takes for E*."""
    return modulus / GAMMA - MU * OMEGA**2


def reduced(stiffness):
    return complex_modulus(GEOMETRY, OMEGA / (2 * np.pi), np.abs(stiffness), 1.0, np.angle(stiffness))


ROOT = (
    1j * OMEGA * 0.1 * np.exp(40e3 / 8.314462618 * (1 / (TABLE.temperature + 273.15) - 1 / 278.15))
) ** 0.5
SOFT, STIFF = np.quantile(np.log(np.abs(E)), (0.02, 0.98))
SOFTNESS = np.clip((STIFF - np.log(np.abs(E))) / (STIFF - SOFT), 0, 1)
EFFECTS = {
    "film_softening": (2.0, E * np.exp(2j * np.pi / 180 * SOFTNESS**2)),
    "drifting_reading": (
        0.5,
        E * np.exp(0.5j * np.pi / 180 * np.interp(np.angle(E) / (np.pi / 2), SLOPES, READ_TOO_LARGE)),
    ),
    "channel_delay": (2e-4, reduced(force(E) * np.exp(2e-4j * OMEGA))),
    "phase_offset": (2.0, reduced(force(E) * np.exp(1j * np.pi / 90))),
    "moving_mass": (0.1, reduced(force(E) - 0.1 * OMEGA**2)),
    "guide_stiffness": (3e8, E + 3e8),
    "guide_friction": (2e8, E + 2e8j * 40e-6 / TABLE.amplitude),
    "loose_clamp": (1e-11, 1 / (1 / E + 1e-11)),
    "specimen_geometry": (-0.1, 0.9 * E),
    "strain_softening": (0.1, E * (1 - 0.1 * TABLE.amplitude / 80e-6)),
    "damage": (0.2, E * (1 - 0.2 * np.arange(12) / 11)),
    "secondary_process": (1e9, E + 1e9 * ROOT / (1 + ROOT)),
    "solver": (
        1.0,
        E * ((1 - np.exp(-1e-4j * OMEGA)) / (1e-4j * OMEGA)) ** (np.angle(E) / (np.pi / 2)),
    ),
}


@pytest.mark.parametrize("name", EFFECTS)
def test_apparent_modulus(name):
    size, expected = EFFECTS[name]
    shape = SHAPES.get(name, ())
    found = CAUSES[name].apparent(E, np.array([size, *shape]), TABLE)
    assert np.allclose(found, expected, rtol=1e-9)
    assert np.allclose(CAUSES[name].apparent(E, np.array([0.0, *shape]), TABLE), E, rtol=1e-12)
    assert np.abs(expected / E - 1).max() > 2e-3


def test_temperature_causes():
    assert CAUSES["temperature_bias"].temperature_rise([1.5], TABLE) == 1.5
    rise = CAUSES["self_heating"].temperature_rise([2.0], TABLE)
    power = OMEGA * E.imag * TABLE.amplitude**2
    assert np.allclose(rise, 2.0 * power / power.max())
    part = TABLE.subset(np.arange(3))
    assert np.allclose(CAUSES["self_heating"].temperature_rise([2.0], part), rise[:3])


def test_every_cause_has_an_effect_to_be_held_against():
    """Named in CONTRIBUTING: a new cause is entered in EFFECTS, with its effect written down independently."""
    of_temperature = {"temperature_bias", "self_heating"}
    assert set(EFFECTS) | of_temperature == set(CAUSES)


@pytest.mark.parametrize("cause", CATALOGUE, ids=lambda cause: cause.name)
def test_rig_keys_and_parameters(cause):
    values = np.array([parameter.typical for parameter in cause.parameters])
    assert set(cause.rig(values, GAMMA, 63e-6)) <= set(KEYS.values())
    amplitude = cause.parameters[0]
    assert amplitude.low <= 0 < amplitude.typical < amplitude.high
    assert cause.sentence and cause.confirmed_by


# Bounds and typical size of an amplitude; chance and usual size of the prior, with which trust.md was measured.
USUAL = {
    "channel_delay": (-20e-3, 20e-3, 1e-4, 0.06, 2.5e-4),
    "damage": (0.0, 0.8, 0.02, 0.04, 0.12),
    "drifting_reading": (0.0, 1.0, 0.2, 0.15, 0.5),
    "film_softening": (0.0, 15.0, 0.5, 0.15, 1.5),
    "guide_friction": (0.0, 5e9, 2e7, 0.03, 1.2e8),
    "guide_stiffness": (0.0, 5e9, 2e7, 0.03, 1.2e8),
    "loose_clamp": (0.0, 1e-9, 5e-13, 0.02, 8e-12),
    "moving_mass": (-2.0, 2.0, 0.02, 0.04, 0.25),
    "phase_offset": (-30.0, 30.0, 0.5, 0.06, 1.2),
    "secondary_process": (0.0, 2e10, 2e8, 0.02, 2e9),
    "self_heating": (0.0, 15.0, 0.5, 0.03, 1.5),
    "solver": (-20.0, 20.0, 1.0, 0.5, 1.0),
    "specimen_geometry": (-0.8, 3.0, 0.03, 0.06, 0.25),
    "strain_softening": (0.0, 0.8, 0.02, 0.04, 0.12),
    "temperature_bias": (-8.0, 8.0, 0.3, 0.06, 2.0),
    "offset of one specimen": (-30.0, 30.0, 0.5, 0.1, 1.2),
    "delay of one specimen": (-20e-3, 20e-3, 1e-4, 0.03, 2.5e-4),
    "offset of one isotherm": (-30.0, 30.0, 0.5, 0.03, 1.2),
    "temperature of one specimen on one isotherm": (-25.0, 25.0, 0.3, 0.15, 1.5),
    "level of one specimen on one isotherm": (-3.0, 3.0, 0.02, 0.1, 0.25),
    "offset of one specimen on one isotherm": (-30.0, 30.0, 0.5, 0.06, 3.0),
    "level at one frequency": (-3.0, 3.0, 0.02, 0.05, 0.08),
    "offset at one frequency": (-30.0, 30.0, 0.5, 0.05, 2.5),
}
SHAPED = [(-9.0, 4.0, 1.0), (10.0, 120.0, 30.0), (0.3, 1.0, 0.2)]  # of the secondary process


def test_sizes_and_chances_are_those_with_which_names_were_calibrated():
    found = {}
    for cause in EVERY:
        first, prior = cause.parameters[0], cause.expected
        found[cause.name] = first.low, first.high, first.typical, prior.chance, prior.size
    assert found == USUAL
    assert [(one.low, one.high, one.typical) for one in CAUSES["secondary_process"].parameters[1:]] == SHAPED


def test_where_each_cause_may_sit():
    """What it takes at least, and one isotherm, specimen or frequency less."""

    def places(name, isotherms=4, specimens=3, frequencies=3, **then):
        grid = np.array(
            [(s, t, f) for s in range(specimens) for t in range(isotherms) for f in range(1, frequencies + 1)]
        )
        one = np.ones(len(grid))
        observed = Observations(
            grid[:, 0], tuple("abc"[:specimens]), 10.0 * grid[:, 1], grid[:, 2] * one, E[:1].repeat(len(grid)), one,
            one, **{key: make(one) for key, make in then.items()},
        )  # fmt: skip
        return list({cause.name: cause for cause in EVERY}[name].places(observed))

    warm, names = [0.0, 10.0, 20.0, 30.0], ["a", "b", "c"]
    sweeps = [(name, t) for name in names for t in warm]
    for name, enough, few in (
        ("temperature_bias", warm, {"isotherms": 3}),
        ("temperature_bias", warm, {"specimens": 1, "frequencies": 2}),  # two tests of an isotherm
        ("specimen_geometry", names, {"specimens": 2}),
        ("loose_clamp", names, {"specimens": 1}),
        ("secondary_process", [None], {"isotherms": 2}),
        ("secondary_process", [None], {"frequencies": 2}),
        ("self_heating", [None], {"isotherms": 1}),
        ("self_heating", [None], {"frequencies": 1}),
        ("film_softening", [None], {"isotherms": 1}),
        ("channel_delay", [None], {"frequencies": 1}),
        ("moving_mass", [None], {"frequencies": 1}),
        ("offset of one specimen", names, {"specimens": 1}),
        ("delay of one specimen", names, {"frequencies": 1}),
        ("offset of one isotherm", warm, {"isotherms": 1}),
        ("level of one specimen on one isotherm", sweeps, {"specimens": 1}),
        ("level at one frequency", [(3.0,), (1.0,)], {"frequencies": 2}),
    ):
        assert places(name) == enough and places(name, **few) == [], name
    assert places("temperature_bias", isotherms=4, specimens=1) == warm  # three tests each
    assert places("specimen_geometry", specimens=3) == names and places("loose_clamp", specimens=2) == [
        "a",
        "b",
    ]
    for spread, seen in ((0.21, [None]), (0.19, [])):
        amplitude = {
            "amplitude": lambda one, low=1.0 - spread: np.where(np.arange(one.size) < 9, low, 1.0) * 5e-5
        }
        assert places("strain_softening", **amplitude) == seen
    assert places("damage", order=lambda one: one) == [] and places("damage", order=np.cumsum) == [None]
    assert places("damage", order=lambda one: one, cycles=np.cumsum) == [None] and places("solver") == []


def test_a_cause_of_the_bench_counts_from_the_whole_table():
    part = TABLE.subset(np.array([1, 4, 7]))  # of one amplitude, in the middle of the campaign
    for name, size in (("guide_friction", 2e8), ("strain_softening", 0.1), ("damage", 0.2)):
        whole = CAUSES[name].apparent(E, [size], TABLE)
        assert CAUSES[name].apparent(E[[1, 4, 7]], [size], part) == pytest.approx(whole[[1, 4, 7]])
    lopsided = replace(TABLE, amplitude=np.repeat([20e-6, 90e-6], [8, 4]))
    assert CAUSES["guide_friction"].apparent(E, [2e8], lopsided) == pytest.approx(
        E + 2e8j * np.repeat([1.0, 2.0 / 9.0], [8, 4])
    )
    counted = CAUSES["moving_mass"].impossible
    mixed = replace(TABLE, inertia=TABLE.form_factor * np.repeat([0.2, 0.5], 6))
    assert counted([-0.49], mixed) == "" and counted([-0.51], mixed).endswith("the reduction counts 500 g")
    assert counted([-9.0], replace(TABLE, inertia=np.zeros(12))) == ""
    assert CAUSES["secondary_process"].largest(TABLE) == pytest.approx(0.2 * np.abs(E).max())
    times, energies, exponents = np.array(CAUSES["secondary_process"].shapes(TABLE)).T
    band = np.log10(2.0 * np.pi * np.array([40.0, 3.0]))
    assert (
        np.unique(times) == pytest.approx(np.linspace(-band[0] - 0.5, -band[1] + 0.5, 5)) and times.size == 45
    )
    assert set(energies) == {30.0, 60.0, 90.0} and set(exponents) == {0.5, 0.65, 0.8}


def test_what_a_fault_of_one_place_does():
    effects = {cause.name: cause for cause in EVERY}
    turned = E * np.exp(1j * np.pi / 90.0)
    for name in ("offset of one specimen", "offset of one isotherm", "offset at one frequency"):
        assert effects[name].apparent(E, [2.0], TABLE) == pytest.approx(turned)
    assert effects["delay of one specimen"].apparent(E, [2e-4], TABLE) == pytest.approx(
        E * np.exp(2e-4j * OMEGA)
    )
    assert effects["level at one frequency"].apparent(E, [0.3], TABLE) == pytest.approx(E * np.exp(0.3))
    warmer = effects["temperature of one specimen on one isotherm"]
    assert warmer.temperature_rise([1.5], TABLE) == 1.5 and (warmer.apparent(E, [1.5], TABLE) == E).all()
    assert effects["offset of one isotherm"].temperature_rise([1.5], TABLE) == 0.0
    assert {cause.name for cause in EVERY if cause.part_of} == {"offset of one isotherm"}


@pytest.mark.parametrize("exponent", [0.15, 0.25, 0.4])
def test_a_drift_is_read_as_in_a_test_from_rest(exponent):
    """By a chain of Kelvin elements whose creep is a power of time, loaded by a haversine."""
    times = np.geomspace(1e-9, 1e9, 109)
    compliances = times**exponent
    chain = KelvinChain(1e30, np.inf, tuple(1 / compliances), tuple(times / compliances))
    (as_read,) = modulus_as_read(chain, [1.0], Programme())
    true = 1 / np.sum(compliances / (1 + 2j * np.pi * times))
    slope = np.angle(true) / (np.pi / 2)
    excess = np.degrees(np.angle(as_read / true))
    assert np.interp(slope, SLOPES, READ_TOO_LARGE) == pytest.approx(excess, abs=0.03)


def test_guide_friction_of_the_rig_has_the_loss_of_the_formula():
    (friction,) = CAUSES["guide_friction"].rig([2e8], GAMMA, 63e-6).values()
    assert GAMMA * 4 * friction / (np.pi * 63e-6) == pytest.approx(2e8)


def test_causes_of_a_bench_are_not_looked_for_on_a_cylinder():
    everything = replace(
        TABLE,
        static_modulus=1e6,
        amplitude=np.linspace(1e-5, 9e-5, TABLE.size),
        order=np.arange(1.0, TABLE.size + 1),
    )
    cylinder = replace(everything, test_type="tension-compression")
    seen, on_cylinder = ({c.name for c in CATALOGUE if c.places(one)} for one in (everything, cylinder))
    assert seen - on_cylinder == {"guide_friction", "guide_stiffness", "moving_mass", "loose_clamp"}
    for cause in CATALOGUE:
        assert "tension-compression" in cause.benches or not cause.places(cylinder)
        assert "tension-compression" in cause.benches or "two-point bending" in cause.needs


@pytest.mark.parametrize(
    "base",
    [
        FlexibleSpectrum(np.geomspace(1e-6, 1e6, 12), 10.0, 20.0, 20.0, 0.2),
        FlexibleSpectrum(np.geomspace(1e-6, 1e6, 12), 10.0, 20.0, 20.0, 0.2, static_modulus=1e8),
        BurgersAtEach(np.array([-10.0, 0, 10, 30])),
    ],
)
def test_derivatives_of_the_laws(base):
    random = np.random.default_rng(1)
    x = random.normal(20.0, 0.5, base.parameters)
    if isinstance(base, FlexibleSpectrum):
        x[-3:] = np.log(0.2), 0.3, 0.1
    modulus, slope = base.modulus(x, OMEGA, TABLE.temperature)
    for k in range(x.size):
        step = np.eye(x.size)[k] * 1e-5
        above, below = (base.modulus(x + s * step, OMEGA, TABLE.temperature)[0] for s in (1, -1))
        assert np.allclose((above - below) / 2e-5, slope[:, k], rtol=1e-5, atol=1e-7 * np.abs(modulus))
