from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import click

from asphalt_nscd.cli import _data
from asphalt_nscd.cli._options import COLUMNS, MEASURED_IN, ONLY_MIX, SHEET, Geometry, option, step
from asphalt_nscd.cli._progress import bars
from asphalt_nscd.diagnosis.settings import Draws, Known, Scatter, Simulated
from asphalt_nscd.reporting.settings import Heading

PAPER = "b_mm=25,B_mm=56,e_mm=25,h_mm=250,mass_kg=0.6,mobile_mass_kg=0.235"


@step
def command(
    measurements: tuple[Path, ...],
    *,
    output: Path = option("Folder for diagnosis.json and residuals.csv."),
    sheet: str | None = SHEET,
    only_mix: str | None = ONLY_MIX,
    columns: tuple[tuple[str, str], ...] = COLUMNS,
    measured_in: str | None = MEASURED_IN,
    geometry: Any = option(
        "Specimens; of ready moduli only the form factor is used.", PAPER, type=Geometry()
    ),
    known: Known,
    scatter: Scatter,
    simulated: Simulated,
    verify_limits: bool = option(
        "Put each cause into these tests at 1, 2 and 3 times its limit; minutes.", False
    ),
    jobs: int | None = option("Processes of --verify-limits; else one for each core.", None, low=1),
    page: bool = option("Whether to write diagnosis.html, report.pdf and corrected.xlsx too.", True),
    heading: Heading,
    details: bool = option("Print the reasons too; diagnosis.html holds them anyway.", False),
    draws: Draws,
) -> None:
    """Say which tests can be trusted, what is wrong with the others, which law they follow and what to test next.

    MEASUREMENTS: files or a folder of them. Read are exports of testing machines (AMPT, UTM) and tables (CSV,
    TSV, workbook) with a row for each test or a column for each temperature or frequency.
    """
    percent, degrees = scatter.modulus_scatter_percent, scatter.phase_scatter_deg
    if (percent is None) != (degrees is None):
        raise click.UsageError("give --modulus-scatter-percent and --phase-scatter-deg together.")
    if simulated.facets is not None and simulated.campaign is None:
        raise click.UsageError(
            "--facets needs --simulations, the same tests with the paper's bonds; give both."
        )
    from asphalt_nscd.api.diagnosis import diagnose
    from asphalt_nscd.api.tables import campaign_in
    from asphalt_nscd.diagnosis.record.stiffness_only import fit_stiffness, has_no_phase

    if percent is not None and degrees is not None:
        known = replace(known, scatter=(percent, degrees))
    campaign = campaign_in(measurements, sheet, dict(columns), measured_in, only_mix)
    heading = replace(
        heading, **{name: text for name, text in campaign.stated.items() if not getattr(heading, name)}
    )
    title = f"Diagnosis of {', '.join(path.name for path in measurements)}"
    if has_no_phase(campaign):
        if known.law != Known.law:
            raise click.UsageError(
                "--law is fitted to |E*| and phase; leave it out, for these tests have no phase."
            )
        curve = fit_stiffness(campaign)
        names = curve.write(output)
        if page:
            # By name: a study, which makes its own page, need not diagnose anew because a figure has changed.
            shown = _data.part("reporting.pages", "stiffness_page")
            names.append(shown.write_page(output, title, curve.rows).name)
        click.echo(f"{curve}\n\nWritten to {output}: {', '.join(names)}.")
        return
    with bars("step", on_terminal=True) as progress:
        diagnosis = diagnose(
            campaign,
            geometry=geometry,
            known=known,
            simulated=simulated,
            draws=draws,
            progress=progress,
        )
        if verify_limits:
            diagnosis = diagnosis.verify_limits(jobs, progress)
    if page:
        names = _data.part("api", "written").write_all(diagnosis.outcome, output, title, heading)
    else:
        names = diagnosis.outcome.write(output)
    click.echo(f"{diagnosis.details if details else diagnosis}\n\nWritten to {output}: {', '.join(names)}.")
    if page:
        click.echo(f"For the reasons and figures, open {output / names[-1]} in a browser.")
