"""A run that a program steps: the sensors' readings out, commands and inputs in, states as bytes."""

from __future__ import annotations

import ctypes
from ctypes import byref, c_double, c_void_p
from typing import TYPE_CHECKING, Any, Union

import numpy as np

from . import library
from .library import COMMAND, KEEP_ROWS, ErrorStruct, call, lib, raise_error
from .run import Run

if TYPE_CHECKING:
    from .scenario import Scenario


class Loop:
    """Steps a scenario. With `command=True` the caller is the controller on the rig:

        loop = Loop(Scenario("corrected/first-impact"), command=True)
        while not loop.ended:
            reading = loop.read_sensors()
            loop.command(1.0 + 0.1 * (1.0 - reading.force))
            loop.step()
    """

    def __init__(self, scenario: "Scenario", command: bool = False, rows: bool = False) -> None:
        self._handle = c_void_p()
        self._error = ErrorStruct()
        flags = (COMMAND if command else 0) | (KEEP_ROWS if rows else 0)
        call("loop_create", byref(self._handle), scenario._handle, flags)

    def __del__(self) -> None:
        if getattr(self, "_handle", None):
            lib.impactlab_loop_destroy(self._handle)

    def step(self) -> float:
        """Goes on to the rig's next sample (without a rig by method.step). Returns the time [s]."""
        if lib.impactlab_loop_step(self._handle, byref(self._error)) != 0:
            raise_error(self._error)
        return lib.impactlab_loop_time(self._handle)

    def step_until(self, time: float) -> float:
        """Goes on to an instant [s], at most to the end. Returns the time [s]."""
        if lib.impactlab_loop_step_until(self._handle, time, byref(self._error)) != 0:
            raise_error(self._error)
        return lib.impactlab_loop_time(self._handle)

    @property
    def time(self) -> float:
        return lib.impactlab_loop_time(self._handle)

    @property
    def ended(self) -> bool:
        return bool(lib.impactlab_loop_ended(self._handle))

    def command(self, volts: float) -> None:
        """What goes out at the sample due now or next, and is held [V]."""
        if lib.impactlab_loop_command(self._handle, volts, byref(self._error)) != 0:
            raise_error(self._error)

    def set_input(self, path: str, value: Union[float, str]) -> None:
        """Gives a parameter that may change during a run another value now: a number, or a text
        such as "2 V" or the mode of control.lock."""
        if isinstance(value, str):
            call("loop_set_text", self._handle, path.encode(), value.encode())
            return
        if lib.impactlab_loop_set_input(self._handle, path.encode(), value,
                                        byref(self._error)) != 0:
            raise_error(self._error)

    def push(self, impulse: float) -> None:
        """Pushes the tip now [N s]."""
        call("loop_push", self._handle, impulse)

    def read_sensors(self) -> library.ReadingStruct:
        """What the sensors read: of the sample due now, else of the last one."""
        reading = library.ReadingStruct()
        if lib.impactlab_loop_read_sensors(self._handle, byref(reading), byref(self._error)) != 0:
            raise_error(self._error)
        return reading

    def __getitem__(self, name: str) -> float:
        """The true value of a signal now."""
        value = c_double()
        call("loop_signal", self._handle, name.encode(), byref(value))
        return value.value

    @property
    def state(self) -> np.ndarray:
        """Angles (first row) and velocities of all degrees of freedom now, a copy."""
        table = library.TableStruct()
        call("loop_state", self._handle, byref(table))
        count = table.rows * table.columns
        flat = np.array((c_double * count).from_address(table.values))
        return flat.reshape(table.rows, table.columns)

    def save_state(self) -> bytes:
        """The whole state as bytes."""
        size = lib.impactlab_loop_state_size(self._handle)
        buffer = ctypes.create_string_buffer(size)
        call("loop_save_state", self._handle, buffer, size)
        return buffer.raw

    def restore_state(self, state: Union[bytes, bytearray]) -> None:
        """Goes back, or forth, to bytes of save_state."""
        data: Any = bytes(state)
        call("loop_restore_state", self._handle, data, len(data))

    def run(self) -> Run:
        """What the loop has come to so far, as a run."""
        handle = c_void_p()
        call("loop_run", self._handle, byref(handle))
        return Run._of(handle)
