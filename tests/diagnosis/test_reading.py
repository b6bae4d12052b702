"""Tables of measurements as a diagnosis reads them: synonyms, labels, and what is refused."""

import numpy as np
import pytest

from asphalt_nscd.diagnosis.observed.reading import PAPER_GEOMETRY, read_observations
from asphalt_nscd.diagnosis.record.statuses import off_target
from asphalt_nscd.files.csvinput import read_csv
from asphalt_nscd.files.errors import InputError
from asphalt_nscd.measurements.campaign import Campaign
from asphalt_nscd.measurements.reduction import reduce_table

ROWS = ["A,a,0,1,9000,20", "A,b,0,1,9100,20.1", "A,a,0,10,12000,16", "A,b,0,10,12100,16.1"]


def table(folder, header, rows):
    path = folder / "m.csv"
    path.write_text("\n".join([header, *rows]) + "\n")
    return path


def test_replicates_may_be_letters_beside_a_specimen(tmp_path):
    path = table(tmp_path, "specimen,replicate,temperature_C,frequency_Hz,E_MPa,phase_deg", ROWS)
    observed, origin = read_observations(path, PAPER_GEOMETRY)
    assert observed.names == ("A",) and observed.size == 4 and origin == "measured"


def test_synonyms_are_the_standard_names(tmp_path):
    rows = [row.partition(",")[2] for row in ROWS]
    path = table(tmp_path, "replicate,T_C,f_Hz,E_MPa,phi_deg", rows)
    observed, _ = read_observations(path, PAPER_GEOMETRY)
    assert observed.names == ("a", "b")
    assert observed.modulus[0].imag / observed.modulus[0].real == pytest.approx(0.36397023)


def test_static_modulus_above_the_softest_test_is_refused(tmp_path):
    path = table(tmp_path, "specimen,replicate,temperature_C,frequency_Hz,E_MPa,phase_deg", ROWS)
    with pytest.raises(
        InputError, match="12000 MPa, is above the storage modulus of the softest test, 8457 MPa"
    ):
        read_observations(path, PAPER_GEOMETRY, static_modulus=12e9)
    softest = 9e9 * np.cos(np.radians(20.0))  # it may scatter below by a quarter
    assert read_observations(path, PAPER_GEOMETRY, 1.24 * softest)[0].static_modulus == 1.24 * softest
    with pytest.raises(InputError, match="is above the storage modulus"):
        read_observations(path, PAPER_GEOMETRY, 1.26 * softest)


@pytest.mark.parametrize(
    ("header", "rows", "amplitude", "by_force"),
    [
        ("E_MPa,phase_deg", ["9000,20", "12000,16"], None, False),
        ("F0_N,z0_m,psi_deg", ["60,6.3e-5,20", "80,6.3e-5,16"], 6.3e-5, True),
    ],
)
def test_what_was_reduced_is_read_as_it_was_measured(tmp_path, header, rows, amplitude, by_force):
    """The workflow diagnoses its reduced table, in which the peaks of ready moduli are empty."""
    tests = [f"A,0,{frequency},{row}" for frequency, row in zip([1, 10], rows)]
    path = table(tmp_path, f"specimen,temperature_C,frequency_Hz,{header}", tests)
    reduced = tmp_path / "reduced.csv"
    reduce_table(path, PAPER_GEOMETRY, reduced)
    for given in (path, reduced):
        observed, _ = read_observations(given, PAPER_GEOMETRY)
        assert (observed.inertia > 0).all() == (observed.inertia > 0).any() == by_force
        assert observed.amplitude is amplitude or set(observed.amplitude) == {amplitude}


GRID = [f"{s},{t},{f},9000,20" for s in "AB" for t in (0, 10) for f in (1, 10)]


def test_a_sweep_noted_at_another_temperature_is_off_its_target(tmp_path):
    grid = [
        f"{s},{t},{f},9000,20,{z}" for s in "AB" for t in (0, 10, 20) for f in (1, 10) for z in (3e-5, 6e-5)
    ]
    rows = [row.replace("B,10,", "B,11.7,") for row in grid]
    header = "specimen,temperature_C,frequency_Hz,E_MPa,phase_deg,amplitude_m"
    observed, _ = read_observations(table(tmp_path, header, rows), PAPER_GEOMETRY)
    assert observed.isotherms.tolist() == [0.0, 10.0, 20.0] and 11.7 in observed.temperature
    assert off_target(observed) == [{"specimen": "B", "temperature_C": 10.0, "measured_C": 11.7}]
    targets = [f"{row},{row.split(',')[1]}" for row in rows]
    meant, _ = read_observations(table(tmp_path, f"{header},nominal_temperature_C", targets), PAPER_GEOMETRY)
    assert meant.isotherms.tolist() == [0.0, 10.0, 11.7, 20.0]


def test_frequencies_that_scatter_by_a_per_cent_are_one(tmp_path):
    rows = [row.replace(",10,9000", ",10.1,9000") if row[0] == "B" else row for row in GRID]
    path = table(tmp_path, "specimen,temperature_C,frequency_Hz,E_MPa,phase_deg", rows)
    assert read_observations(path, PAPER_GEOMETRY)[0].frequencies == pytest.approx([1.0, 10.05])


def test_a_frequency_that_is_the_same_everywhere_keeps_its_digits(tmp_path):
    rows = [f"A,{t},{f},{6000 + f},20" for t in (0, 10, 20) for f in (0.1, 1)]
    path = table(tmp_path, "specimen,temperature_C,frequency_Hz,E_MPa,phase_deg", rows)
    # the mean of three 0.1 is another 0.1
    assert read_observations(path, PAPER_GEOMETRY)[0].frequencies.tolist() == [0.1, 1.0]


def test_fine_sweeps_keep_their_frequencies(tmp_path):
    rows = [row.replace(",1,9000", ",10.1,9000") for row in GRID]
    path = table(tmp_path, "specimen,temperature_C,frequency_Hz,E_MPa,phase_deg", rows)
    assert read_observations(path, PAPER_GEOMETRY)[0].frequencies == pytest.approx([10.0, 10.1])


def exported(folder, **options):
    header = "specimen,temperature_C,nominal_temperature_C,frequency_Hz,E_MPa,phase_deg"
    rows = [
        "A,4.1,4,10,12000,16,100,7.9",
        "A,4.0,4,1,9000,20,90,",
        "B,3.9,4,10,12100,16.1,104,0.2",
        "B,4,4,1,9100,20,,1",
    ]
    path = table(folder, header + ",microstrain,phase_uniformity_deg", rows)
    return Campaign(read_csv(path), (path,), **options)


def test_isotherm_strain_quality_and_test_type_reach_the_observations(tmp_path):
    observed, _ = read_observations(exported(tmp_path, test_type="tension-compression"), PAPER_GEOMETRY)
    assert observed.test_type == "tension-compression"
    assert observed.temperature.tolist() == [4.1, 4.0, 3.9, 4.0]
    assert observed.isotherm.tolist() == [4.0] * 4 and observed.isotherms.tolist() == [4.0]
    # T 378 sets the strain from peak to peak.
    assert observed.strain == pytest.approx([50e-6, 45e-6, 52e-6, np.nan], nan_ok=True)
    assert observed.quality["phase_uniformity_deg"] == pytest.approx([7.9, np.nan, 0.2, 1.0], nan_ok=True)
    assert list(observed.quality) == ["phase_uniformity_deg"]


def test_measured_temperatures_of_a_plain_table_are_isotherms(tmp_path):
    rows = [row.replace(",0,1,", ",0.1,1,") for row in GRID]
    path = table(tmp_path, "specimen,temperature_C,frequency_Hz,E_MPa,phase_deg", rows)
    observed, _ = read_observations(path, PAPER_GEOMETRY)
    assert observed.isotherms.tolist() == [0.1, 10.0] and set(observed.temperature) == {0.0, 0.1, 10.0}
    same, _ = read_observations(
        table(tmp_path, "specimen,temperature_C,frequency_Hz,E_MPa,phase_deg", GRID), PAPER_GEOMETRY
    )
    assert same.nominal_temperature is None and same.strain is None and same.quality == {}


def test_forces_of_a_cylinder_are_not_reduced_as_bending(tmp_path):
    rows = [f"A,0,{f},60,6.3e-5,20" for f in (1, 10)]
    path = table(tmp_path, "specimen,temperature_C,frequency_Hz,F0_N,z0_m,psi_deg", rows)
    with pytest.raises(InputError, match="give the moduli of a tension-compression test"):
        read_observations(Campaign(read_csv(path), (path,), "tension-compression"), PAPER_GEOMETRY)


def test_a_phase_with_the_wrong_sign_is_refused_with_its_line(tmp_path):
    rows = [
        f"A,{t},{f},{round(9000 * f**0.2)},{phase}"
        for t in (0, 10)
        for f, phase in ((1, 20), (3, 19), (10, 18))
    ]
    rows[1] = rows[1].replace(",19", ",-19")
    path = table(tmp_path, "specimen,temperature_C,frequency_Hz,E_MPa,phase_deg", rows)
    with pytest.raises(InputError) as error:
        read_observations(path, PAPER_GEOMETRY)
    assert str(error.value) == (
        f"{path}, line 3: the phase at 3 Hz is -19 deg, and the other frequencies of specimen A at 0 degC say about "
        "+19 deg: the sign is wrong; remove the minus sign."
    )


def test_strains_of_one_setting_are_one_and_of_two_are_two(tmp_path):
    rows = [f"A,0,{f},9000,20,{z}" for f, z in ((1, 60e-6), (3, 62e-6), (10, 64e-6), (30, 68e-6))]
    path = table(tmp_path, "specimen,temperature_C,frequency_Hz,E_MPa,phase_deg,amplitude_m", rows)
    assert read_observations(path, PAPER_GEOMETRY)[0].amplitude == pytest.approx([62e-6, 62e-6, 62e-6, 68e-6])
