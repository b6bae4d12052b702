"""What is counted of a run through Slurm; the run itself is `make cluster`."""

from __future__ import annotations

from cluster.cost import account

SAID = """\
JobId=1 JobName=a Comment=rule_laws
   JobState=COMPLETED Reason=None Dependency=(null)
   Requeue=1 Restarts=0 BatchFlag=1 Reboot=0 ExitCode=0:0
   SubmitTime=2026-11-22T05:00:00 EligibleTime=2026-11-22T05:00:00
   StartTime=2026-11-22T05:00:02 EndTime=2026-11-22T05:01:42 Deadline=N/A
   NumNodes=1 NumCPUs=2 NumTasks=1 CPUs/Task=1

JobId=2 JobName=a Comment=rule_specimen
   JobState=CANCELLED Reason=None Dependency=(null)
   Requeue=1 Restarts=0 BatchFlag=1 Reboot=0 ExitCode=0:15
   SubmitTime=2026-11-22T05:01:50 EligibleTime=2026-11-22T05:01:50
   StartTime=2026-11-22T05:01:51 EndTime=2026-11-22T05:09:00 Deadline=N/A
   NumNodes=1 NumCPUs=1 NumTasks=1 CPUs/Task=1

JobId=3 JobName=a Comment=rule_tests
   JobState=COMPLETED Reason=None Dependency=(null)
   Requeue=1 Restarts=1 BatchFlag=1 Reboot=0 ExitCode=0:0
   SubmitTime=2026-11-22T05:02:00 EligibleTime=2026-11-22T05:04:00
   StartTime=2026-11-22T05:05:00 EndTime=2026-11-22T05:05:50 Deadline=N/A
   NumNodes=1 NumCPUs=1 NumTasks=1 CPUs/Task=1
"""


def test_cores_held_beside_seconds_of_steps():
    counted = account(SAID, [90.0, 90.0, 45.0])
    assert counted["Slurm jobs"] == 2 and counted["steps in them"] == 3
    assert counted["core seconds held by the jobs"] == 250 and counted["seconds of the steps in them"] == 225
    assert counted["own cost, percent of what is held"] == 10.0
    assert counted["own cost, core seconds a job"] == 12.5
    assert counted["seconds in the queue, a job"] == 2.0
    assert counted["jobs killed in mid-run, made again by Snakemake"] == 1
    assert counted["jobs preempted in mid-run, made again by Slurm"] == 1
