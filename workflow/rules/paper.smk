# What is said of the paper alone: scripts of studies/paper, one rule for each table; and one figure.

for name, data in PAPER_TABLES.items():

    rule:
        name:
            name
        input:
            **data,
            code=studied(f"paper.{name}"),
        output:
            f"<results>/{name}.csv",
        log:
            f"<results>/logs/{name}.log",
        benchmark:
            f"<results>/benchmarks/{name}.tsv"
        priority: 6  # some take half a minute: none may be left alone to the end
        group:
            "contents"
        conda:
            ENVIRONMENT
        params:
            script=f"paper/{name}",
        message:
            f"Make {name}"
        script:
            SCRIPT


if "fig_readings" in FIGURES:

    rule fig_readings:
        """Two readings of the paper that fail."""
        input:
            **FIGURES["fig_readings"][1],
            code=studied("paper.fig_readings"),
        output:
            "<results>/figures/fig_readings.pdf",
            "<results>/figures/fig_readings.svg",
            report(
                "<results>/figures/fig_readings.png",
                caption="../report/fig_readings.rst",
                category=FIGURES["fig_readings"][0],
                labels={"result": title("fig_readings")},
            ),
        log:
            "<results>/logs/fig_readings.log",
        benchmark:
            "<results>/benchmarks/fig_readings.tsv"
        group:
            "contents"
        conda:
            ENVIRONMENT
        params:
            script="paper/fig_readings",
        message:
            "Draw fig_readings"
        script:
            SCRIPT
