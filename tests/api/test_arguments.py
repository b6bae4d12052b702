"""What is of the wrong kind is refused at the entry, in a sentence that names the argument."""

from __future__ import annotations

import numpy as np
import pytest

import asphalt_nscd as an

TABLE3 = {"Em_Pa": 24.3e9, "eta_m_Pa_s": 3.71e9, "Ek_Pa": 48.4e9, "eta_k_Pa_s": 0.773e9, "temperature_C": 15}
LAW = an.Law.burgers(**TABLE3)
BOX = (0.04, 0.03, 0.12)


@pytest.mark.parametrize(
    ("ask", "sentence"),
    [
        (lambda: an.bend("s.h5", LAW, "10", 15.0), "bend: frequency_Hz = '10' .str.; give a number"),
        (lambda: an.bend("s.h5", LAW, 10.0, None), "temperature_C = None .NoneType.; give a number"),
        (lambda: an.bend(5, LAW, 10.0, 15.0), "specimen = 5 .int.; give a Specimen or a path"),
        (lambda: an.bend("s.h5", {"law": 1}, 10.0, 15.0), "law = .* .dict.; give a Law or a path"),
        (lambda: an.bend("s.h5", LAW, 10.0, 15.0, load=20e-6), "load = 2e-05 .float.; give a Load"),
        (lambda: an.bend("s.h5", LAW, 10.0, 15.0, load=an.Load("20 um")), "load.amplitude_m = '20 um'"),
        (
            lambda: an.bend("s.h5", LAW, 10.0, 15.0, load=an.Load(frames=2.5)),
            "load.frames = 2.5 .*whole number",
        ),
        (lambda: an.bend("s.h5", LAW, 10.0, 15.0, numerics=an.Numerics("5e-5")), "numerics.time_step"),
        (lambda: an.bend("s.h5", LAW, 10.0, 15.0, bonds=an.Bonds(yield_Pa="2.7e6")), "bonds.yield_Pa"),
        (lambda: an.diagnose({"E_MPa": [1.0]}), "no table .dict.; give a file, a folder"),
        (lambda: an.diagnose(np.eye(3)), "no table .ndarray."),
        (lambda: an.diagnose([]), "no table .list."),
        (lambda: an.diagnose("m.csv", draws=500), "draws = 500 .int.; give a Draws"),
        (lambda: an.diagnose("m.csv", draws=an.Draws("many")), "draws.number = 'many'"),
        (lambda: an.diagnose("m.csv", known=an.Known(scatter=3.0)), "known.scatter = 3.0 .*give 2 numbers"),
        (lambda: an.diagnose("m.csv", known=an.Known(scatter=("3 %", 1))), "known.scatter .*give 2 numbers"),
        (lambda: an.diagnose("m.csv", geometry=25), "geometry = 25 .int.; give a path or a mapping"),
        (lambda: an.fit({"E_MPa": [1.0]}), "no table .dict."),
        (lambda: an.fit("m.csv", 2), "fit: law = 2 .int.; give text"),
        (lambda: an.read(5), "no table .int."),
        (lambda: an.read("m.csv", columns=["E"]), "columns = .* .list.; give a mapping"),
        (lambda: an.read_packing(None), "path = None .NoneType.; give a path"),
        (lambda: an.pour([100], BOX), "counts = .* .list.; give a path or a DataFrame or a mapping"),
        (lambda: an.pour({6.0: "100"}, BOX), "counts: 6.0: '100'; give a diameter in mm and a number"),
        (lambda: an.pour({6.0: 10}, (0.04, "0.03", 0.12)), "box_m = .*give 3 numbers"),
        (lambda: an.pour({6.0: 10}, 0.1), "box_m = 0.1 .float.; give 3 numbers"),
        (lambda: an.pour({6.0: 10}, BOX, seed="a"), "seed = 'a' .str.; give a whole number"),
        (lambda: an.pour({6.0: 10}, BOX, vibration=False), "vibration = False .bool.; give a Vibration"),
        (lambda: an.specimen({"radius": 1}, {}), "packing = .* .dict.; give a Packing or a path"),
        (lambda: an.specimen("d.h5", gap_max_mm="2"), "gap_max_mm = '2' .str.; give a number"),
        (lambda: an.export({"law": 1}, "law.inp", "abaqus"), "cannot write a value of type dict"),
        (
            lambda: an.export(LAW, "law.inp", "abaqus", settings="SI"),
            "settings = 'SI' .str.; give an ExportSettings",
        ),
        (lambda: an.export(LAW, "law.csv", "csv", frequencies_Hz=(1.0, "10")), "frequencies_Hz .* numbers"),
        (lambda: an.solve_contacts(np.eye(3), "abc", 0.5), "q: not numbers"),
        (lambda: an.solve_contacts("W", [-1.0, 0.0, 0.0], 0.5), "contacts: "),
        (lambda: an.Law.burgers(**(TABLE3 | {"Em_Pa": "24.3e9"})), "burgers: Em_Pa = '24.3e9' .str."),
        (lambda: an.Law("law.json"), "'law.json' is no content of a law; give a path to Law.read"),
    ],
)
def test_wrong_kinds_are_one_sentence(ask, sentence):
    with pytest.raises(an.InputError, match=sentence):
        ask()


def test_kinds_that_mean_the_same_are_taken():
    """numpy's numbers, lists for tuples, whole numbers for numbers."""
    some = an.pour(
        {np.int64(8): np.int64(20)}, list(BOX), seed=np.int64(1), vibration=an.Vibration(duration=0)
    )
    assert len(some.spheres) == 20
    with pytest.raises(TypeError, match="unexpected keyword argument 'frequency'"):
        an.bend("s.h5", LAW, 10.0, 15.0, frequency=10.0)
