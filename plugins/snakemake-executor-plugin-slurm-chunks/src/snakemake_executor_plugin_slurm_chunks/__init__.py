"""Snakemake's Slurm executor, whose jobs run their steps themselves: `executor: slurm-chunks`.

Its own jobs start Snakemake once more for each step of a chunk, two seconds and a half beside steps of three.
"""

from snakemake_executor_plugin_slurm import Executor as SlurmExecutor
from snakemake_executor_plugin_slurm import ExecutorSettings, common_settings

__all__ = ["Executor", "ExecutorSettings", "common_settings"]


class Executor(SlurmExecutor):
    def additional_general_args(self) -> str:
        """What is added to the command of each Slurm job."""
        return "--executor local"
