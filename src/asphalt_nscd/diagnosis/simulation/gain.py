"""What the numerical specimen shows of a law, and how far that is from the measurements."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from asphalt_nscd.diagnosis.model.joint import Fitted, Joint
from asphalt_nscd.diagnosis.observed.observations import Complex
from asphalt_nscd.diagnosis.search.diagnose import Diagnosis
from asphalt_nscd.diagnosis.simulation.simulated import NumericalSpecimen
from asphalt_nscd.measurements.agreement import KEYS, mean_relative_error

ERRORS = ("mre_E_percent", "mre_phase_percent")  # of Table 4
OFF_PHASE = "off_phase_deg"
CLOSE = 0.01  # change of the objective at which a fit that is only compared with the tests ends


def simulated_by(joint: Joint, fitted: Fitted, specimen: NumericalSpecimen) -> Complex:
    """ln E* (n,) of the tests as the numerical specimen shows the law, scales and causes of a fit."""
    observed = joint.observed
    law = joint.apparent(fitted.law, ())[0]
    return fitted.modelled + np.log(specimen.apparent_modulus(observed.omega, law) / law)


def burgers_prediction(diagnosis: Diagnosis, specimen: NumericalSpecimen) -> Complex:
    """ln E* (n,) as the numerical specimen shows a Burgers law fitted at each temperature."""
    return simulated_by(diagnosis.baseline_joint, diagnosis.baseline, specimen)


def joint_alone(diagnosis: Diagnosis) -> Joint:
    """The joint model whose noise is the scatter of single tests, without what a laboratory adds."""
    return Joint(diagnosis.observed, diagnosis.ladder.joint.base, diagnosis.alone)


def nearest(diagnosis: Diagnosis, fitted: Fitted, specimen: NumericalSpecimen) -> Complex:
    """ln E* (n,) as the numerical specimen shows the law and causes of a fit, as near to the tests as they come.

    Beside what the laboratory adds and a discrepancy, a law that lacks a cause is far from the tests. `fitted` is the
    start.
    """
    joint = joint_alone(diagnosis)
    return simulated_by(joint, joint.fit(fitted.law, fitted.scales, fitted.active, CLOSE), specimen)


def _frame(diagnosis: Diagnosis, logarithm: Complex) -> pd.DataFrame:
    observed = diagnosis.observed
    return pd.DataFrame(
        {
            "specimen": np.array(observed.names)[observed.specimen],
            "temperature_C": observed.temperature,
            "frequency_Hz": observed.frequency,
            "E_MPa": np.exp(logarithm.real) * 1e-6,
            "phase_deg": np.degrees(logarithm.imag),
        }
    )


def errors(diagnosis: Diagnosis, logarithm: Complex) -> dict[str, dict[str, float]]:
    """Mean relative errors [%] by quantity and isotherm, as in Table 4, of tests simulated (ln E* (n,) not NaN).

    `OFF_PHASE` is the mean error of the phase in degrees.
    """
    there = ~np.isnan(logarithm)
    at = {"temperature_C": diagnosis.observed.isotherm, "condition": diagnosis.observed.cell}
    simulated = _frame(diagnosis, logarithm).assign(**at)[there]
    if simulated.empty:
        return {name: {} for name in (*ERRORS, OFF_PHASE)}
    scatter = float(np.degrees(diagnosis.noise.sigma[1]))
    measured = _frame(diagnosis, diagnosis.observed.logarithm).assign(**at)[there]
    # Over two amplitudes an average would hide what softens with the strain.
    point = [*KEYS, "condition"]
    found = mean_relative_error(measured, simulated, scatter, point).set_index("temperature_C")
    phases = [table.groupby(point)["phase_deg"].mean() for table in (measured, simulated)]
    found[OFF_PHASE] = (phases[1] - phases[0]).abs().groupby("temperature_C").mean()
    found.index = [f"{t:g}" for t in found.index]
    return {name: found[name].to_dict() for name in (*ERRORS, OFF_PHASE)}


def _misses(diagnosis: Diagnosis, logarithm: Complex, rows: NDArray[np.bool_]) -> dict[str, float]:
    """Mean relative errors of single tests, and the error over the scatter (root mean square), of some rows.

    Not of averages over specimens, as in Table 4: these hide what is wrong with one specimen.
    """
    observed = diagnosis.observed.logarithm[rows]
    left = observed - logarithm[rows]
    sigma = diagnosis.noise.sigma
    squares = np.concatenate([(left.real / sigma[0]) ** 2, (left.imag / sigma[1]) ** 2])
    return {
        "mre_E_percent": 100.0 * float(np.abs(np.expm1(-left.real)).mean()),
        # A phase below its own scatter, of an elastic reference beam say, is nothing to divide by.
        "mre_phase_percent": 100.0
        * float(np.mean(np.abs(left.imag) / np.maximum(np.abs(observed.imag), sigma[1]))),
        "rms_over_scatter": float(np.sqrt(squares.mean())),
    }


def compare_errors(
    diagnosis: Diagnosis, before: Complex, after: Complex, inner: bool = False
) -> dict[str, Any]:
    """Errors before and after (ln E* (n,)): of single tests, and of averages over specimens at each temperature.

    With `inner`, single tests at the temperatures between others only; an isotherm at an end, left out, is
    extrapolated, which tells of the law's end and of no cause.
    """
    temperature = diagnosis.observed.isotherm
    rows = np.full(temperature.size, True)
    if inner:
        rows = (temperature > temperature.min()) & (temperature < temperature.max())
    first, second = _misses(diagnosis, before, rows), _misses(diagnosis, after, rows)
    pairs = {name: {"before": first[name], "after": second[name]} for name in first}
    return pairs | {"averages_by_temperature": averages(diagnosis, before, after)}


def averages(diagnosis: Diagnosis, before: Complex, after: Complex) -> dict[str, dict[str, dict[str, float]]]:
    """Errors [%] by temperature and quantity, before and after, as in Table 4, where neither ln E* (n,) is NaN."""
    before, after = np.where(np.isnan(after), after, before), np.where(np.isnan(before), before, after)
    first, second = (errors(diagnosis, logarithm) for logarithm in (before, after))
    return {
        t: {name: {"before": first[name][t], "after": second[name][t]} for name in first}
        for t in first["mre_E_percent"]
    }


def residual_table(
    diagnosis: Diagnosis, specimen: NumericalSpecimen, before: Complex | None = None
) -> pd.DataFrame:
    """Content of residuals.csv: each test measured, simulated before and after, and ln(measured / simulated), complex.

    `before` is ln E* (n,) of a simulation as it was (NaN: not simulated); else with a Burgers law fitted at each
    temperature.
    """
    observed, ladder = diagnosis.observed, diagnosis.ladder
    frame = _frame(diagnosis, observed.logarithm)
    if before is None:
        before = burgers_prediction(diagnosis, specimen)
    for name, simulated in (("before", before), ("after", nearest(diagnosis, ladder.fitted, specimen))):
        left = observed.logarithm - simulated
        frame[f"E_{name}_MPa"] = np.exp(simulated.real) * 1e-6
        frame[f"phase_{name}_deg"] = np.degrees(simulated.imag)
        frame[f"residual_E_{name}_percent"] = 100.0 * left.real
        frame[f"residual_phase_{name}_deg"] = np.degrees(left.imag)
    return frame
