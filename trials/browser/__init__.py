"""The report as a reader sees it, in Chromium: `PYTHONPATH=trials python -m browser results/smoke/report.html`.

Playwright 1.65.2 is a wheel of 53 MB and brings a browser beside the system's; it was not tried.
"""
