"""The report as a reader sees it, in Chromium: `PYTHONPATH=trials python -m browser results/smoke/report.html`."""
