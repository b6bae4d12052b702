"""Tables of measurements as a diagnosis reads them: synonyms, labels, and what is refused."""

import pytest

from asphalt_nscd.diagnosis.reading import PAPER_GEOMETRY, read_observations
from asphalt_nscd.errors import InputError

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
        InputError, match="9000 MPa, is not below the storage modulus of the softest test, 8457 MPa"
    ):
        read_observations(path, PAPER_GEOMETRY, static_modulus=9e9)
    assert read_observations(path, PAPER_GEOMETRY, static_modulus=1e7)[0].static_modulus == 1e7
