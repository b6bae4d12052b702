"""What counts as named, told, left out and wrong; rates and their intervals."""

import numpy as np
import pandas as pd
import pytest
from attack import judge, measured, rates
from attack.faults import Fault, put
from attack.laboratory import invented
from attack.plan import Case

CAMPAIGN = invented(1, seed=1)  # cylinder, four specimens, 4, 20, 35 and 50 degC


def entry(cause, value=1.0, error=0.1, where=None, established=True, **more):
    parameters = {"size": {"value": value, "std_error": error, "unit": "deg"}}
    return {"cause": cause, "where": where, "parameters": parameters, "established": established} | more


def content(*ladder, **more):
    return {"verdict": "explained", "ladder": list(ladder)} | more


def row(fault, suite="catalogue", answer="", **said):
    faults = () if fault is None else (fault,)
    found = content(*said.pop("ladder", ()), **said)
    return judge.judged(CAMPAIGN, Case(suite, faults, 3.0), found, answer)[0]


def test_a_name_is_right_by_cause_and_place():
    offset, clamp = Fault("phase_offset", 1.1), Fault("loose_clamp", 2.0, specimen="S2")
    assert row(offset, ladder=[entry("phase_offset")])["named"]
    assert row(offset, ladder=[entry("phase_offset")])["covered"]
    assert not row(Fault("phase_offset", 1.3), ladder=[entry("phase_offset")])["covered"]
    wrong = row(offset, ladder=[entry("channel_delay"), entry("relaxation_spectrum")])
    assert not wrong["named"] and wrong["wrong_confident"] == 1 and wrong["wrong_names"] == "channel_delay!"
    assert row(clamp, ladder=[entry("loose_clamp", where="S2", established=False)])["named"]
    misplaced = row(clamp, ladder=[entry("loose_clamp", where="S1", established=False)])
    assert not misplaced["named"] and misplaced["wrong_possible"] == 1
    bias = Fault("temperature_bias", 1.0, temperature=20.0)
    assert row(bias, ladder=[entry("temperature_bias", where=20.1)])["named"]
    assert not row(bias, ladder=[entry("temperature_bias", where=35.0)])["named"]
    assert not row(bias, ladder=[entry("temperature_bias", -1.0, where=20.0)])["named"]


def test_a_bias_is_what_was_put_in_with_the_chambers_own_error():
    bias = Fault("temperature_bias", 1.0, temperature=20.0)
    truth = 1.0 + CAMPAIGN.warmer[CAMPAIGN.at(None, 20.0)].mean()
    assert abs(truth - 1.0) > 0.02
    told = row(bias, ladder=[entry("temperature_bias", truth, 0.005, where=20.0)])
    assert told["covered"] and told["error_sigma"] == pytest.approx(0.0)


def test_a_group_that_cannot_be_told_apart_names_its_members():
    groups = [["moving_mass", "channel_delay"], ["loose_clamp @ S1", "specimen_geometry @ S1"]]
    assert row(Fault("moving_mass", 1.0), ladder=[entry("channel_delay")], indistinguishable=groups)["named"]
    geometry = Fault("specimen_geometry", 0.3, specimen="S1")
    assert row(geometry, ladder=[entry("loose_clamp", where="S1")], indistinguishable=groups)["named"]
    assert not row(geometry, ladder=[entry("loose_clamp", where="S2")], indistinguishable=groups)["named"]
    bias = Fault("temperature_bias", 1.0, temperature=20.0)
    biases = [["temperature_bias @ 20.0", "temperature_bias @ 35.0"]]
    other = row(bias, ladder=[entry("temperature_bias", -0.9, where=35.0)], indistinguishable=biases)
    assert other["named"] and "covered" not in other  # of another place: its size is no estimate of this one


def suspects(*tests, used=False):
    names = ("specimen", "temperature_C", "frequency_Hz")
    status = {"status": "doubtful" if used else "left out", "decided_by": "its own isotherm", "reasons": []}
    return [dict(zip(names, test)) | status for test in tests]


def test_left_out_means_all_that_is_bad_and_nothing_that_is_good():
    pair = Fault("masked pair of bad tests", 0.3, "S2", 20.0, (1.0, 5.0))
    both = suspects(("S2", 20.1, 1.0), ("S2", 20.1, 5.0))
    assert row(pair, "slip", suspect_tests=both)["removed"]
    assert row(pair, "slip", suspect_tests=both)["good_rejected"] == 0
    assert not row(pair, "slip", suspect_tests=both[:1])["removed"]
    assert not row(pair, "slip", suspect_tests=[one | {"status": "doubtful"} for one in both])["removed"]
    assert row(pair, "slip", suspect_tests=[*both, *suspects(("S3", 20.0, 1.0))])["good_rejected"] == 1
    assert row(None, "nothing", suspect_tests=both)["good_rejected"] == 2


OWN = Fault("offset of one specimen", 2.0, specimen="S3")
PHASE = {"specimen": "S3", "temperature_C": None, "phase_deg": 2.0}
WARM = Fault("temperature of one specimen on one isotherm", 2.0, "S3", 20.0)
HOT = Fault("offset of one isotherm", 2.0, temperature=35.0)
TOP = Fault("aliasing", 30.0, frequencies=(25.0,))
AT_TOP = [(s, t, 25.0) for s in CAMPAIGN.specimens for t in CAMPAIGN.isotherms]


@pytest.mark.parametrize(
    ("fault", "answer", "told"),
    [
        (OWN, {"odd_phases": [PHASE]}, True),
        (OWN, {"odd_phases": [PHASE | {"specimen": "S1"}]}, False),
        (OWN, {"odd_phases": [PHASE | {"temperature_C": 20.0}]}, False),
        (WARM, {"odd_temperatures": [{"specimen": "S3", "temperature_C": 20.0}]}, True),
        (WARM, {"odd_temperatures": [{"specimen": "S3", "temperature_C": 35.0}]}, False),
        (HOT, {"contradictory_isotherms": [{"temperature_C": 35.0}]}, True),
        (HOT, {"contradictory_isotherms": [{"temperature_C": 20.0}]}, False),
        (TOP, {"suspect_tests": suspects(*AT_TOP, used=True)}, True),
        (TOP, {"suspect_tests": suspects(*AT_TOP[:3])}, False),
        (TOP, {"highest_frequency": {"frequency_Hz": 25.0}}, True),
        (HOT, {"highest_frequency": {"frequency_Hz": 25.0}}, False),
    ],
)
def test_faults_outside_the_catalogue_are_told_by_what_the_answer_lists(fault, answer, told):
    assert row(fault, "outside", **answer)["told"] == told


def test_faults_outside_the_catalogue_are_told_or_misnamed_by_a_cause():
    named = row(OWN, "outside", ladder=[entry("phase_offset", where="S3")])
    assert named["told"] and not named["wrong_confident"]
    common = row(OWN, "outside", ladder=[entry("phase_offset")])
    assert not common["told"] and common["wrong_confident"] == 1
    late = row(Fault("low-pass filter", 200.0), "outside", ladder=[entry("channel_delay")])
    assert late["told"] and "covered" not in late  # hertz are no seconds
    assert row(Fault("zero drift", 0.1), "outside", ladder=[entry("channel_delay")])["wrong_confident"] == 1


def test_a_wrongly_noted_temperature_must_not_become_a_bias():
    noted = Fault("wrong recorded temperature", 1.7, "S1", 20.0)
    biased = row(noted, "slip", ladder=[entry("temperature_bias", where=20.0, established=False)])
    assert biased["wrong_possible"] == 1 and not biased["told"]
    assert row(noted, "slip", odd_temperatures=[{"specimen": "S1", "temperature_C": 21.7}])["told"]
    off = {"specimen": "S1", "temperature_C": 20.0, "measured_C": 21.7}
    assert row(noted, "slip", reading={"off_target": [off]})["told"]
    assert not row(noted, "slip", reading={"off_target": [off | {"specimen": "S2"}]})["told"]


def test_names_that_a_measured_table_had_before_are_not_added():
    case = Case("catalogue", (Fault("phase_offset", 1.0),), 3.0)
    said = content(entry("phase_offset"), entry("self_heating"))
    assert judge.judged(CAMPAIGN, case, said, "")[0]["wrong_confident"] == 1
    assert judge.judged(CAMPAIGN, case, said, "", [("self_heating", "None")])[0]["wrong_confident"] == 0


def test_a_measured_table_is_itself_until_something_is_put_in(tmp_path):
    table = put(CAMPAIGN, ())
    renamed = table.rename(columns={"temperature_C": "T_C", "specimen": "replicate"})
    renamed.to_csv(tmp_path / "t.csv", index=False)
    read = measured.campaign(tmp_path / "t.csv", "t")
    again = put(read, ())
    np.testing.assert_allclose(again["E_MPa"], table["E_MPa"], rtol=1e-9)
    np.testing.assert_allclose(again["phase_deg"], table["phase_deg"], atol=1e-9)
    n = len(table)
    moved = read.response(np.full(n, 2.0), np.ones(n)) - read.response(np.zeros(n), np.ones(n))
    true = CAMPAIGN.response(np.full(n, 2.0), np.ones(n)) - CAMPAIGN.response(np.zeros(n), np.ones(n))
    assert np.median(abs(moved.real / true.real - 1.0)) < 0.3


def test_rates_have_wilsons_interval():
    found = rates.rate([True] * 8 + [False] * 2 + [None])
    assert (found["n"], found["hits"]) == (10, 8)
    # Wilson: roots p of (8/10 - p)^2 = z^2 p (1 - p) / 10
    for p in (found["low"], found["high"]):
        assert (0.8 - p) ** 2 == pytest.approx(1.959964**2 * p * (1.0 - p) / 10.0, rel=1e-5)
    assert rates.rate([])["n"] == 0 and np.isnan(rates.rate([])["rate"])


def test_a_summary_counts_what_it_says_and_puts_earlier_rates_beside():
    rows = [
        row(Fault("phase_offset", 1.1), ladder=[entry("phase_offset")]),
        row(Fault("phase_offset", 1.1)),
        row(None, "nothing", ladder=[entry("self_heating", established=False)]),
        row(None, "nothing"),
        row(Fault("slip of ten", 1.0, "S1", 20.0, (1.0,)), "slip", suspect_tests=suspects(("S1", 20.0, 5.0))),
    ]
    stated = judge.stated(CAMPAIGN, Case("nothing"), content(entry("self_heating", probability=0.97)))
    table, names = rates.frames([{"rows": rows, "names": stated}])
    before = pd.DataFrame({"what": ["slip of ten: left out"], "percent": [25.0]})
    found = rates.summary(table, names, before).set_index("what")
    assert found.loc["causes of the catalogue at 3 limits: named", "percent"] == 50.0
    assert found.loc["nothing put in: a possible name", ["percent", "of", "met"]].tolist() == [50.0, 2, "no"]
    assert found.loc["slip of ten: a good test left out", "percent"] == 100.0
    assert found.loc["slip of ten: left out", ["percent_before", "percent"]].tolist() == [25.0, 0.0]
    assert found.loc["pairs at 3 limits: both named", "met"] == "not tried"


def test_a_table_with_a_broken_isotherm_is_not_one_without_structure():
    rows = [row(None, "nothing", verdict="unexplained_structure"), *(row(None, "nothing") for _ in range(3))]
    for one, broken in zip(rows, (True, True, False, False), strict=True):
        one["broken"] = broken
    rows.append(row(Fault("phase_offset", 1.1), ladder=[entry("phase_offset")]))
    table, names = rates.frames([{"rows": rows, "names": []}])
    found = rates.summary(table, names).set_index("what")
    sound, broken = (
        f"nothing put in, {what}: unexplained" for what in ("no isotherm broken", "an isotherm broken")
    )
    assert found.loc[sound, ["percent", "of", "met"]].tolist() == [0.0, 2, "yes"]
    assert found.loc[broken, ["percent", "of"]].tolist() == [50.0, 2]


def test_probabilities_are_held_against_how_often_they_are_right():
    names = pd.DataFrame(
        [{"established": True, "probability": 0.93, "right": n < 18} for n in range(20)]
        + [{"established": False, "probability": 0.6, "right": n < 2} for n in range(20)]
    )
    table = rates.reliability(names).set_index("stated")
    assert table.loc["0.9 - 0.95", ["mean_stated", "rate"]].tolist() == pytest.approx([0.93, 0.9])
    assert table.loc["0.5 - 0.7", "rate"] == 0.1
    assert rates._off(names) == [False, True]  # the lower group is half as often right as it says
