"""A run that a program steps: the sensors' readings out, commands and inputs in, states as bytes."""

from __future__ import annotations

import ctypes
import math
from ctypes import byref, c_double, c_void_p
from typing import Any, Dict, Union

import numpy as np

from . import library
from .library import (COMMAND, KEEP_ROWS, Callbacks, ErrorStruct, Owner, call, lib, number,
                      raise_error, text)
from .run import SIGNALS, Run
from .scenario import Scenario, value_of


class Loop(Owner):
    """Steps a scenario. With `command=True` the caller is the controller on the rig:

        loop = Loop(Scenario("corrected/first-impact"), command=True)
        while not loop.ended:
            reading = loop.read_sensors()
            loop.command(1.0 + 0.1 * (1.0 - reading.force))
            loop.step()
    """

    _kind = "loop"
    _instead = "save_state() keeps a state, which another loop of its scenario can go on from"
    _destroy = staticmethod(lib.impactlab_loop_destroy)

    #: what follow_force, the usual reward of an environment, measures by [N]
    wanted_force: float = math.nan

    def __init__(self, scenario: Scenario, command: bool = False, rows: bool = False) -> None:
        if not isinstance(scenario, Scenario):
            raise TypeError(f"expected a Scenario, not {type(scenario).__name__}")
        self._error = ErrorStruct()
        flags = (COMMAND if command else 0) | (KEEP_ROWS if rows else 0)
        self._callbacks = Callbacks()
        self._scenario = scenario.copy()
        self._callbacks.listen(self._scenario)
        call("loop_create", byref(self._handle), self._scenario._handle, flags)

    # what is called at every step has the loop's own place for errors

    def _go(self, function: str, *arguments: float) -> float:
        """Goes on; what stops it, such as ^C, leaves it between two steps."""
        with self._lock:
            with self._callbacks:
                code = getattr(lib, "impactlab_loop_" + function)(self._handle, *arguments,
                                                                  byref(self._error))
            self._callbacks.tell()
            if code != 0:
                raise_error(self._error)
            return lib.impactlab_loop_time(self._handle)

    def step(self) -> float:
        """Goes on to the rig's next sample (without a rig by method.step). Returns the time [s]."""
        return self._go("step")

    def step_until(self, time: float) -> float:
        """Goes on to an instant [s], at most to the end. Returns the time [s]."""
        return self._go("step_until", number(time, "an instant"))

    @property
    def time(self) -> float:
        return lib.impactlab_loop_time(self._handle)

    @property
    def ended(self) -> bool:
        return bool(lib.impactlab_loop_ended(self._handle))

    def command(self, volts: float) -> None:
        """What goes out at the sample due now or next, and is held [V]."""
        given = number(volts, "a command")
        with self._lock:
            if lib.impactlab_loop_command(self._handle, given, byref(self._error)) != 0:
                raise_error(self._error)

    def set_input(self, path: str, value: Union[float, str]) -> None:
        """Gives a parameter that may change during a run another value now: a number, or a text
        such as "2 V" or the mode of control.lock."""
        key, given = text(path, "the path of a parameter"), value_of(path, value)
        if isinstance(given, str):
            self._call("loop_set_text", key, text(given, path))
        else:
            self._call("loop_set_input", key, given)

    def push(self, impulse: float) -> None:
        """Pushes the tip now [N s]."""
        self._call("loop_push", number(impulse, "an impulse"))

    def read_sensors(self) -> library.ReadingStruct:
        """What the sensors read: of the sample due now, else of the last one."""
        reading = library.ReadingStruct()
        with self._lock:
            if lib.impactlab_loop_read_sensors(self._handle, byref(reading),
                                               byref(self._error)) != 0:
                raise_error(self._error)
        return reading

    def __getitem__(self, name: str) -> float:
        """The true value of a signal now."""
        value = c_double()
        self._call("loop_signal", text(name, "the name of a signal"), byref(value))
        return value.value

    @property
    def signals(self) -> Dict[str, float]:
        """The true values of all signals now, by name, at the cost of about one."""
        values = (c_double * len(SIGNALS))()
        with self._lock:
            lib.impactlab_loop_signals(self._handle, values, len(values))
        return dict(zip(SIGNALS, values))

    def __repr__(self) -> str:
        return f"<Loop at {self.time:.6g} s{', ended' if self.ended else ''}>"

    @property
    def state(self) -> np.ndarray:
        """Angles (first row) and velocities of all degrees of freedom now, a copy."""
        table = library.TableStruct()
        with self._lock:
            call("loop_state", self._handle, byref(table))
            count = table.rows * table.columns
            flat = np.array((c_double * count).from_address(table.values))
        return flat.reshape(table.rows, table.columns)

    def save_state(self) -> bytes:
        """The whole state as bytes."""
        size = lib.impactlab_loop_state_size(self._handle)
        buffer = ctypes.create_string_buffer(size)
        self._call("loop_save_state", buffer, size)
        return buffer.raw

    def restore_state(self, state: Union[bytes, bytearray]) -> None:
        """Goes back, or forth, to bytes of save_state; others are refused and change nothing."""
        data: Any = state if isinstance(state, bytes) else memoryview(state).tobytes()
        self._call("loop_restore_state", data, len(data))

    def run(self) -> Run:
        """What the loop has come to so far, as a run."""
        handle = c_void_p()
        self._call("loop_run", byref(handle))
        return Run._of(handle, self._scenario)
