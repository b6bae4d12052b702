"""The report as a reader sees it, in Chromium: `PYTHONPATH=tests python -m browser results/smoke/report.html`."""
