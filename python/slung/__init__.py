"""Path following for a multirotor that carries a payload on a cable: the law, the estimator and the simulator.

N points north, east and **down**, the body's axes forward, right and down; the rod points from the UAV to the payload, whose position
and velocity a state holds; thrust acts along -b3. SI units throughout. What is refused is a `Refused`, a `ValueError` with `field`,
`value` and `range`.
"""

from ._slung import (
    Campaign,
    Entry,
    Estimate,
    Flight,
    Navigation,
    Output,
    Parameters,
    Path,
    PayloadFilter,
    Refused,
    Rig,
    Scenario,
    State,
    Uav,
    World,
    compare,
    replay,
    run,
)
from .formula import path_of

__all__ = [
    "Campaign",
    "Entry",
    "Estimate",
    "Flight",
    "Navigation",
    "Output",
    "Parameters",
    "Path",
    "PayloadFilter",
    "Refused",
    "Rig",
    "Scenario",
    "State",
    "Uav",
    "World",
    "compare",
    "path_of",
    "replay",
    "run",
]
