"""The report of a run of hgmm-replay: metrics.json as a page of tables and plots.

python3 -m hgmm.report FOLDER
"""
from hgmm.report.page import make_report
from hgmm.report.plots import plots_of

__all__ = ["make_report", "plots_of"]
