"""An environment of Gymnasium's shape over a loop; it works without Gymnasium being there."""

from __future__ import annotations

from typing import Any, Callable, Dict, Optional, Tuple

import numpy as np

from .library import number
from .loop import Loop
from .run import Run
from .scenario import Scenario


class Box:
    """Numbers between bounds: what is asked of a space where Gymnasium is not there."""

    def __init__(self, low: np.ndarray, high: np.ndarray) -> None:
        self.low, self.high = np.asarray(low, float), np.asarray(high, float)
        self.shape, self.dtype = self.low.shape, np.dtype(float)
        self._random = np.random.default_rng()

    def seed(self, seed: Optional[int] = None) -> None:
        self._random = np.random.default_rng(seed)

    def sample(self) -> np.ndarray:
        low, high = np.maximum(self.low, -1e6), np.minimum(self.high, 1e6)
        return self._random.uniform(low, high)

    def contains(self, x: Any) -> bool:
        x = np.asarray(x, float)
        return x.shape == self.shape and bool(np.all((x >= self.low) & (x <= self.high)))


def follow_force(loop: Loop, volts: float) -> float:
    """The usual reward of a sample: how near the contact force is to the commanded one."""
    return -abs(loop["force"] - loop.wanted_force)


class Environment:
    """Press on the wall with the commanded force: a sample of the rig is a step.

    An observation holds what the rig's sensors read: hub angle [rad], hub velocity [rad/s], contact
    force [N]. An action is the command [V]. The episode is truncated at run.duration. `reward` gets
    the loop and the action.
    """

    metadata: Dict[str, Any] = {"render_modes": []}
    render_mode = None

    def __init__(self, scenario: Optional[Scenario] = None,
                 reward: Callable[[Loop, float], float] = follow_force) -> None:
        if not isinstance(scenario, (Scenario, type(None))):
            raise TypeError(f"expected a Scenario, not {type(scenario).__name__}")
        self.scenario = Scenario("corrected/first-impact") if scenario is None else scenario.copy()
        self.reward = reward
        limit = float(self.scenario["motor.voltage_limit"])
        self.action_space = Box(np.array([-limit]), np.array([limit]))
        self.observation_space = Box(np.full(3, -np.inf), np.full(3, np.inf))
        self._loop: Optional[Loop] = None

    def reset(self, *, seed: Optional[int] = None,
              options: Optional[Dict[str, Any]] = None) -> Tuple[np.ndarray, Dict[str, Any]]:
        """Begins anew; the seed is that of the sensors' noise, options are parameters by path."""
        if seed is not None:
            self.scenario["control.seed"] = seed
        if options:
            self.scenario.set(options)
        self._loop = Loop(self.scenario, command=True)
        self._loop.wanted_force = float(self.scenario["control.force"])
        return self._observation(), {"time": 0.0}

    def _observation(self) -> np.ndarray:
        assert self._loop is not None
        read = self._loop.read_sensors()
        return np.array([read.encoder, read.tachometer, read.force])

    def step(self, action: Any) -> Tuple[np.ndarray, float, bool, bool, Dict[str, Any]]:
        if self._loop is None:
            raise RuntimeError("reset comes before step")
        given = np.asarray(action)
        if given.size != 1:
            raise ValueError(f"expected one command [V] as the action, not {given.size} numbers")
        volts = number(given.reshape(-1)[0], "an action")
        self._loop.command(volts)
        time = self._loop.step()
        reward = float(self.reward(self._loop, volts))
        return self._observation(), reward, False, self._loop.ended, {"time": time}

    def run(self) -> Run:
        """The episode so far as a run."""
        if self._loop is None:
            raise RuntimeError("reset comes before run")
        return self._loop.run()

    def render(self) -> None:
        return None

    def close(self) -> None:
        self._loop = None
