"""The speed at which a launch leaves the ground, as one command in place of two settings."""

from dataclasses import replace

from rotctl.behaviours.aerial.launch import Launch
from rotctl.behaviours.staged.stages import Stage
from rotctl.behaviours.staged.touching import Launched


def at_speed(stage: Stage, up: float | None) -> Stage:
    """The same stage; one that launches takes off upward at that speed [m/s], if there is one.

    The push ends at this speed, and aims above it by as much as without a command: who aims at a
    speed comes to it in the end of the push alone.
    """
    until = stage.until
    if up is None or not isinstance(until, Launched):
        return stage
    tasks = {
        name: replace(task, aim=replace(task.aim, up=task.aim.up * (up / until.up)))
        if isinstance(task.aim, Launch)
        else task
        for name, task in stage.tasks.items()
    }
    return replace(stage, until=replace(until, up=up), tasks=tasks)
