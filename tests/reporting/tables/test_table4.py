"""Table 4 against hand calculation."""

from __future__ import annotations

import numpy as np
import pytest

from asphalt_nscd.reporting.tables.table4 import make


@pytest.fixture
def data(tmp_path):
    (simulations := tmp_path / "simulations.csv").write_text(
        "specimen,temperature_C,frequency_Hz,E_MPa,phase_deg,E_law_MPa,phase_law_deg\n"
        "s1,0,3,101,21,98,22\ns2,0,3,105,23,98,22\ns1,0,10,220,11,200,10\n"
        "s1,20,3,45,30,50,30\n"
    )
    (measured := tmp_path / "measured.csv").write_text(
        "specimen,temperature_C,frequency_Hz,origin,E_MPa,phase_deg\n"
        "1,0,3,reconstructed,90,19\n2,0,3,reconstructed,110,21\n1,0,10,reconstructed,200,10\n"
        "1,20,3,measured,50,40\n"
    )
    (published := tmp_path / "table4.csv").write_text(
        "temperature_C,mre_E_percent,mre_phase_percent\n0,1.33,9.75\n10,3.82,9.81\n"
    )
    return {"simulations": [simulations], "measured": [measured], "published": [published]}


def test_errors_by_hand(data):
    table = make(**data).set_index("temperature_C")
    assert list(table["compared_with"]) == ["reconstructed", "measured"]
    # 0 degC: simulated 103 and 220 against 100 and 200, 22 and 11 deg against 20 and 10.
    assert table.loc[0, "mre_E_simulated_percent"] == pytest.approx((3 + 10) / 2)
    assert table.loc[0, "mre_phase_simulated_percent"] == pytest.approx(10.0)
    assert table.loc[0, "mre_E_law_percent"] == pytest.approx((2 + 0) / 2)
    assert table.loc[0, "mre_phase_law_percent"] == pytest.approx((10 + 0) / 2)
    assert table.loc[20, "mre_E_simulated_percent"] == pytest.approx(10.0)
    assert table.loc[20, "mre_phase_law_percent"] == pytest.approx(25.0)


def test_published_errors_stand_beside_where_there_are_some(data):
    table = make(**data).set_index("temperature_C")
    assert table.loc[0, ["mre_E_published_percent", "mre_phase_published_percent"]].tolist() == [1.33, 9.75]
    assert np.isnan(table.loc[20, "mre_E_published_percent"])
    assert not any("published" in name for name in make(data["simulations"], data["measured"]))
