from __future__ import annotations

from importlib.util import find_spec
from typing import Any

import click

from asphalt_nscd.cli import _data, _options
from asphalt_nscd.cli._progress import bars

PAPER = "b_mm=25,B_mm=56,e_mm=25,h_mm=250,mass_kg=0.6,mobile_mass_kg=0.235"


def _of_several(context: click.Context, _: click.Parameter, wanted: bool) -> None:
    if wanted:
        raise click.UsageError(
            "--same-machine needs several campaigns: asphalt-nscd compare --same-machine FILE FILE ... --output DIR",
            context,
        )


@click.command()
@click.argument("measurements", type=_options.File, nargs=-1, required=True)
@click.option(
    "--output", required=True, type=_options.File, help="Folder for diagnosis.json and residuals.csv."
)
@click.option(
    "--same-machine",
    is_flag=True,
    hidden=True,
    expose_value=False,
    callback=_of_several,
    help="Of several campaigns: see compare.",
)
@click.option("--sheet", help="The only sheet of an XLSX file to read; else all that hold tests.")
@_options.column
@_options.measured_in
@click.option(
    "--geometry",
    default=PAPER,
    type=_options.Geometry(),
    help="Specimens; of ready moduli only the form factor is used.",
)
@click.option(
    "--specimen",
    type=_options.File,
    help="Numerical specimen, a file of `reduced-specimen`; else the one shipped.",
)
@click.option(
    "--static-modulus-mpa", type=_options.NOT_NEGATIVE, help="Modulus of the mix at long times, if known."
)
@click.option(
    "--modulus-scatter-percent",
    type=_options.POSITIVE,
    help="Scatter of |E*| of one test; else from replicates.",
)
@click.option(
    "--phase-scatter-deg",
    type=_options.POSITIVE,
    help="Scatter of the phase of one test; else from replicates.",
)
@click.option(
    "--simulations",
    type=_options.File,
    help="Simulated tests of the campaign, to say what in them is numerics.",
)
@click.option(
    "--facets",
    type=_options.File,
    help="The same tests on specimens bonded by facets, to say what the paper's bonds make of |E*|.",
)
@click.option(
    "--verify-limits",
    is_flag=True,
    help="Put each cause into these tests at 1, 2 and 3 times its limit; minutes.",
)
@click.option("--jobs", type=click.IntRange(1), help="Processes of --verify-limits; else one for each core.")
@click.option(
    "--page/--no-page",
    default=True,
    help="Whether to write diagnosis.html, report.pdf and corrected.xlsx too.",
)
@click.option("--details", is_flag=True, help="Print the reasons too; diagnosis.html holds them anyway.")
@click.option("--draws", default=4000, type=click.IntRange(500, 10**6), help="Draws of the chance level.")
@click.option("--seed", default=0, type=click.IntRange(0), help="Of the draws.")
@_options.gather(
    "table", measurements="measurements", sheet="sheet", columns="columns", measured_in="measured_in"
)
@_options.law
@_options.gather("known", geometry="geometry", static_modulus_MPa="static_modulus_mpa", law="law")
@_options.gather("scatter", modulus="modulus_scatter_percent", phase="phase_scatter_deg")
@_options.gather("simulated", campaign="simulations", facets="facets", specimen="specimen")
@_options.gather("draws", number="draws", seed="seed")
@_options.gather("limits", verify="verify_limits", jobs="jobs")
@_options.gather("written", output="output", page="page", details="details")
def command(
    table: dict[str, Any],
    known: dict[str, Any],
    scatter: dict[str, Any],
    simulated: dict[str, Any],
    draws: dict[str, int],
    limits: dict[str, Any],
    written: dict[str, Any],
) -> None:
    """Say which tests can be trusted, what is wrong with the others, which law they follow and what to test next.

    MEASUREMENTS: files or a folder of them. Read are exports of testing machines (AMPT, UTM) and tables (CSV,
    TSV, XLSX) with a row for each test or a column for each temperature or frequency.
    """
    if (scatter["modulus"] is None) != (scatter["phase"] is None):
        raise click.UsageError("give --modulus-scatter-percent and --phase-scatter-deg together.")
    if simulated["facets"] is not None and simulated["campaign"] is None:
        raise click.UsageError(
            "--facets needs --simulations, the same tests with the paper's bonds; give both."
        )
    from asphalt_nscd.api.diagnosis import Draws, Known, Simulated, diagnose
    from asphalt_nscd.api.tables import campaign_in
    from asphalt_nscd.diagnosis.record.stiffness_only import fit_stiffness, has_no_phase

    output, measurements = written["output"], table["measurements"]
    campaign = campaign_in(measurements, table["sheet"], dict(table["columns"]), table["measured_in"])
    # By name: a study, which makes its own page, need not diagnose anew because a figure has changed.
    title = f"Diagnosis of {', '.join(path.name for path in measurements)}"
    if has_no_phase(campaign):
        if known["law"] != "2s2p1d":
            raise click.UsageError(
                "--law is fitted to |E*| and phase; leave it out, for these tests have no phase."
            )
        curve = fit_stiffness(campaign)
        names = curve.write(output)
        if written["page"]:
            page = _data.part("reporting.pages", "stiffness_page")
            names.append(page.write_page(output, title, str(curve)).name)
        click.echo(f"{curve}\n\nWritten to {output}: {', '.join(names)}.")
        return
    stated = None if scatter["modulus"] is None else (scatter["modulus"], scatter["phase"])
    with bars("step", on_terminal=True) as progress:
        diagnosis = diagnose(
            campaign,
            geometry=known["geometry"],
            known=Known(known["static_modulus_MPa"], stated, known["law"]),
            simulated=Simulated(**simulated),
            draws=Draws(**draws),
            progress=progress,
        )
        if limits["verify"]:
            diagnosis = diagnosis.verify_limits(limits["jobs"], progress)
    names = diagnosis.outcome.write(output)
    if written["page"]:
        names.append(_data.part("exports", "workbook").corrected_workbook(output).name)
        # An extra: the page draws its plots without it.
        if find_spec("matplotlib"):
            names.append(_data.part("reporting.pages", "handout").write_handout(output, title).name)
        names.append(_data.part("reporting.pages", "laboratory").write_page(output, title).name)
    click.echo(
        f"{diagnosis.details if written['details'] else diagnosis}\n\nWritten to {output}: {', '.join(names)}."
    )
    if written["page"]:
        click.echo(f"For the reasons and figures, open {output / names[-1]} in a browser.")
        if not find_spec("matplotlib"):
            click.echo("For report.pdf, pages to hand on: pip install 'asphalt-nscd[figures]'.")
