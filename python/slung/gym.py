"""Flights for learners, as Gymnasium has them: `gymnasium.make("slung.gym:slung/Follow-v0")`.

An episode is a flight of a campaign: its vehicle, wind, sensors and start are drawn from the campaign's distributions.

**Observation**, 27 numbers: the way from the payload to the path's nearest point, to first order (3, m, at most 10 along an axis); the
wanted velocity there (3, m/s); the payload's velocity (3, m/s); the rod (3) and its rate (3, 1/s); the attitude by rows (9); the body
rate (3, rad/s). Vectors are in N, third axis down, the body rate in body axes; all through the campaign's sensors.

**Action**, 4 numbers from -1 to 1: thrust from none to twice hover's, and torque about the body's axes as shares of the scenario's
limits (of 1 N m where it has none).

**Reward**: time flown, s, times 1 less (distance from the path + 1 s times the error of velocity) / `lost_m`, and never below zero. An
episode is terminated `lost_m` from the path, on the ground, or where a number is not finite, and truncated at the scenario's duration.
"""

from __future__ import annotations

from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces
from gymnasium.vector import AutoresetMode, VectorEnv
from numpy.typing import NDArray

from ._slung import Campaign, Fleet, State

FOLLOW = "slung/Follow-v0"

_CALM = {
    "title": "From about a circle, in calm air, with the true state",
    "ground_p3": 0.0,
    "scenario": {
        "duration_s": 20.0,
        "path": {"kind": "circle", "radius": 5.0, "p3": -10.0, "speed": 1.0},
        "controller": {"rate_hz": 500.0, "limits": {"thrust": [3.0, 60.0], "torque": [3.0, 3.0, 3.0]}},
    },
    "start": {"distance_m": 1.0, "speed": 0.5, "tilt_deg": 5.0, "yaw_deg": 10.0, "rod_deg": 10.0},
}


def _observations(size: int | None = None) -> spaces.Box:
    shape = (27,) if size is None else (size, 27)
    return spaces.Box(-np.inf, np.inf, shape, np.float32)


def _actions(size: int | None = None) -> spaces.Box:
    return spaces.Box(-1.0, 1.0, (4,) if size is None else (size, 4), np.float32)


class FollowEnv(gymnasium.Env[NDArray[Any], NDArray[Any]]):
    """One flight at a time."""

    metadata: dict[str, Any] = {"render_modes": []}

    def __init__(
        self, campaign: Campaign | None = None, *, periods: int = 5, lost_m: float = 10.0, render_mode: str | None = None
    ) -> None:
        if render_mode is not None:
            raise ValueError(f"render_mode = {render_mode!r}: there is none")
        self.render_mode = None
        self._fleet = Fleet(campaign or Campaign(_CALM), 1, periods, lost_m)
        self._seed, self._run = 1, 0
        self.observation_space = _observations()
        self.action_space = _actions()

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        super().reset(seed=seed)
        if seed is not None:
            self._seed, self._run = seed, 0
        observed = self._fleet.begin(0, self._seed, self._run)
        self._run += 1
        return observed, {}

    def step(
        self, action: NDArray[np.float32]
    ) -> tuple[NDArray[np.float32], float, bool, bool, dict[str, Any]]:
        observed, reward, terminated, truncated, distance = self._fleet.step(np.asarray(action, float).reshape(1, 4))
        return observed[0], float(reward[0]), bool(terminated[0]), bool(truncated[0]), {"distance_m": float(distance[0])}

    @property
    def state(self) -> State:
        """The state as it is, for a law that is no learner."""
        return self._fleet.state(0)

    def action_of(self, thrust: float, torque: NDArray[np.float64]) -> NDArray[np.float32]:
        """The action that commands this thrust (N) and torque (N m)."""
        hover, limits = self._fleet.scale(0)
        return np.array([thrust / hover - 1.0, *(np.asarray(torque) / limits)], np.float32).clip(-1.0, 1.0)


class FollowVectorEnv(VectorEnv[NDArray[Any], NDArray[Any], NDArray[Any]]):
    """Many flights side by side, on all cores and without Python's lock. One that has ended begins anew at the next step."""

    metadata: dict[str, Any] = {"render_modes": [], "autoreset_mode": AutoresetMode.NEXT_STEP}

    def __init__(
        self, num_envs: int = 1, campaign: Campaign | None = None, *, periods: int = 5, lost_m: float = 10.0, **_: Any
    ) -> None:
        self.num_envs = num_envs
        self._fleet = Fleet(campaign or Campaign(_CALM), num_envs, periods, lost_m)
        self._seeds = [1 + index for index in range(num_envs)]
        self._runs = [0] * num_envs
        self._ended = np.zeros(num_envs, bool)
        self.single_observation_space, self.single_action_space = _observations(), _actions()
        self.observation_space, self.action_space = _observations(num_envs), _actions(num_envs)

    def _begin(self, index: int) -> NDArray[np.float32]:
        observed = self._fleet.begin(index, self._seeds[index], self._runs[index])
        self._runs[index] += 1
        return observed

    def reset(
        self, *, seed: int | list[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[NDArray[np.float32], dict[str, Any]]:
        if seed is not None:
            seeds = [seed + index for index in range(self.num_envs)] if isinstance(seed, int) else seed
            for index, given in enumerate(seeds):
                if given is not None:
                    self._seeds[index], self._runs[index] = given, 0
        self._ended[:] = False
        return np.stack([self._begin(index) for index in range(self.num_envs)]), {}

    def step(
        self, actions: NDArray[np.float32]
    ) -> tuple[NDArray[np.float32], NDArray[Any], NDArray[Any], NDArray[Any], dict[str, Any]]:
        begun = {int(index): self._begin(int(index)) for index in np.flatnonzero(self._ended)}
        actions = np.asarray(actions, float)
        observed, reward, terminated, truncated, distance = self._fleet.step(actions, skip=self._ended)
        for index, first in begun.items():
            observed[index] = first
        self._ended = terminated | truncated
        return observed, reward, terminated, truncated, {"distance_m": distance}


gymnasium.register(FOLLOW, entry_point="slung.gym:FollowEnv", vector_entry_point="slung.gym:FollowVectorEnv")
