"""Scenarios: opened or made, their parameters as attributes, and what is run of them."""

from __future__ import annotations

import ctypes
from ctypes import POINTER, byref, c_char_p, c_double, c_size_t, c_void_p
from typing import Any, Callable, Dict, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np

from . import library
from .library import KEEP_ROWS, Error, call, lib
from .run import QUANTITIES, Batch, Run, run_with

Value = Union[float, int, bool, str]
Controller = Callable[[Any], Union[float, Mapping[str, float]]]


class Parameter:
    """A row of the table of parameters: path, type, unit, range, default and meaning."""

    def __init__(self, row: Any) -> None:
        self.path: str = row.path.decode()
        self.type: str = row.type.decode()
        self.unit: str = row.unit.decode()
        self.choices: List[str] = row.choices.decode().split("|") if row.choices else []
        self.description: str = row.description.decode()
        self.initial: float = row.initial
        self.minimum: float = row.minimum
        self.maximum: float = row.maximum
        self.timed: bool = bool(row.timed)

    @property
    def documentation(self) -> str:
        """What it means, with its unit and what it may be."""
        if self.choices:
            allowed = ", ".join(self.choices)
        elif self.type in ("real", "integer"):
            allowed = f"{self.minimum:g} to {self.maximum:g}"
        else:
            allowed = self.type
        unit = f" [{self.unit}]" if self.unit else ""
        return f"{self.path}{unit}: {self.description} ({allowed})"

    def __repr__(self) -> str:
        return f"<{self.documentation}>"


#: every parameter by its path
PARAMETERS: Dict[str, Parameter] = {p.path: p for p in map(Parameter, library.rows("parameter_at"))}


class Group:
    """The parameters of one group, such as `scenario.motor`, as attributes."""

    _names: Tuple[str, ...] = ()

    def __init__(self, scenario: "Scenario") -> None:
        object.__setattr__(self, "_scenario", scenario)

    def __setattr__(self, name: str, value: Value) -> None:
        if name not in self._names:
            group = type(self).__name__
            raise AttributeError(f"there is no parameter {group}.{name}; there are: "
                                 + ", ".join(self._names))
        object.__setattr__(self, name, value)

    def __repr__(self) -> str:
        group = type(self).__name__
        return "\n".join(f"{group}.{name} = {getattr(self, name)!r}" for name in self._names)


def _attribute(parameter: Parameter) -> property:
    def get(group: Any) -> Value:
        return group._scenario[parameter.path]

    def set_(group: Any, value: Value) -> None:
        group._scenario[parameter.path] = value

    return property(get, set_, doc=parameter.documentation)


class Runner(Group):
    """The parameters run.*, and `scenario.run(...)` itself."""

    def __call__(self, rows: bool = True, controller: Optional[Controller] = None) -> Run:
        """Runs the scenario to its end; without `rows` only events and the summary are kept.

        A controller is a function that gets a reading (`reading.encoder`, `.force`, `.time` ...) at
        every sample and returns the command [V], or a mapping with `command` and, if it likes,
        `desired_angle`, `desired_velocity`, `calculated_force`. It takes the place of control.law.
        A run that was stopped on the way raises Error with the run as `error.run`.
        """
        scenario = self._scenario  # type: ignore[attr-defined]
        if controller is not None:
            return run_with(scenario, KEEP_ROWS if rows else 0, controller)
        return Run._create(scenario, KEEP_ROWS if rows else 0)


def _make_groups() -> Dict[str, type]:
    members: Dict[str, Dict[str, Any]] = {}
    for path, parameter in PARAMETERS.items():
        group, name = path.split(".", 1)
        members.setdefault(group, {})[name] = _attribute(parameter)
    return {group: type(group, (Runner if group == "run" else Group,), {**found, "_names": tuple(found),
                                          "__doc__": f"The parameters {group}.*"})
            for group, found in members.items()}


_GROUPS = _make_groups()


class Scenario:
    """A scenario: `Scenario("corrected/first-impact")`, a file, or without a name one of defaults.

    Its parameters are attributes (`scenario.motor.voltage = 2`) and items
    (`scenario["motor.voltage"] = "2 V"`); what is wrong raises Error and changes nothing.
    `scenario.run()` runs it, `scenario.run.duration` is a parameter like the others.
    """

    def __init__(self, name: Optional[str] = None, **parameters: Value) -> None:
        self._handle = c_void_p()
        if name is None:
            call("scenario_create", byref(self._handle))
        else:
            call("scenario_open", byref(self._handle), str(name).encode())
        self._finish(parameters)

    def _finish(self, parameters: Mapping[str, Value]) -> None:
        for group, kind in _GROUPS.items():
            setattr(self, group, kind(self))
        if parameters:
            self.set({path.replace("__", "."): value for path, value in parameters.items()})

    @classmethod
    def from_yaml(cls, text: str) -> "Scenario":
        """A scenario from the text of a scenario file."""
        made = cls.__new__(cls)
        made._handle = c_void_p()
        data = text.encode()
        call("scenario_parse", byref(made._handle), data, len(data))
        made._finish({})
        return made

    def copy(self) -> "Scenario":
        """A scenario of its own with the same parameters and script."""
        made = Scenario.__new__(Scenario)
        made._handle = c_void_p()
        call("scenario_copy", byref(made._handle), self._handle)
        made._finish({})
        return made

    def __del__(self) -> None:
        if getattr(self, "_handle", None):
            lib.impactlab_scenario_destroy(self._handle)

    @property
    def name(self) -> str:
        return lib.impactlab_scenario_name(self._handle).decode(errors="replace")

    @property
    def title(self) -> str:
        return lib.impactlab_scenario_title(self._handle).decode(errors="replace")

    @property
    def description(self) -> str:
        return lib.impactlab_scenario_description(self._handle).decode(errors="replace")

    @property
    def yaml(self) -> str:
        """The scenario as a file would have it."""
        return library.take_text("scenario_yaml", self._handle)

    def __getitem__(self, path: str) -> Value:
        number = c_double()
        call("scenario_number", self._handle, path.encode(), byref(number))
        kind = PARAMETERS[path].type
        if kind in ("choice", "text"):
            text = ctypes.create_string_buffer(256)
            call("scenario_text", self._handle, path.encode(), text, len(text))
            return text.value.decode(errors="replace")
        if kind == "boolean":
            return number.value != 0
        return int(number.value) if kind == "integer" else number.value

    def __setitem__(self, path: str, value: Value) -> None:
        if isinstance(value, str):
            call("scenario_set", self._handle, path.encode(), value.encode())
        else:
            call("scenario_set_number", self._handle, path.encode(), float(value))

    def set(self, parameters: Mapping[str, Value]) -> "Scenario":
        """Sets several parameters at once, in any order that makes sense together."""
        def as_text(value: Value) -> str:
            if isinstance(value, (bool, np.bool_)):
                return "true" if value else "false"
            return value if isinstance(value, str) else repr(float(value))

        texts = [f"{path}={as_text(value)}".encode() for path, value in parameters.items()]
        array = (c_char_p * len(texts))(*texts)
        call("scenario_set_all", self._handle, array, len(texts))
        return self

    def change_at(self, time: float, path: str, value: Value) -> "Scenario":
        """Adds to the script: at `time` [s] the parameter gets another value."""
        text = value if isinstance(value, str) else repr(value)
        call("scenario_add_change", self._handle, time, path.encode(), text.encode())
        return self

    def push_at(self, time: float, impulse: float) -> "Scenario":
        """Adds to the script: at `time` [s] the tip gets an impulse [N s]."""
        call("scenario_add_push", self._handle, time, impulse)
        return self

    def allow_code(self, allowed: bool = True) -> "Scenario":
        """Lets the scenario start the program or load the plug-in that it names."""
        lib.impactlab_scenario_allow_code(self._handle, int(allowed))
        return self

    def batch(self, parameters: Mapping[str, Sequence[float]], jobs: int = 0) -> Batch:
        """Runs it once for every row of the parameters' values, on `jobs` threads (0: all cores)."""
        paths = list(parameters)
        columns = np.broadcast_arrays(*[np.asarray(parameters[p], dtype=float) for p in paths])
        values = np.ascontiguousarray(np.stack([c.ravel() for c in columns], axis=1))
        count = len(values)
        found = np.full((count, len(QUANTITIES)), np.nan)
        words: List[str] = []
        messages: List[str] = []

        def take(context: Any, outcome: Any) -> int:
            one = outcome.contents
            ctypes.memmove(found[one.index].ctypes.data, one.quantities, 8 * one.quantity_count)
            words.append(one.word.decode())
            messages.append(one.message.decode(errors="replace"))
            return 0

        array = (c_char_p * len(paths))(*[p.encode() for p in paths])
        call("batch", self._handle, array, len(paths),
             values.ctypes.data_as(POINTER(c_double)), count, jobs, library.TakeFunction(take), None)
        return Batch({p: values[:, k] for k, p in enumerate(paths)}, found, words, messages)

    def modes(self, hub: str = "free", tip: str = "free") -> Tuple[np.ndarray, np.ndarray]:
        """Natural frequencies [rad/s] and shapes (one a row) of the straight arm without damping.

        hub: "free" or "locked"; tip: "free" or "pinned".
        """
        if hub not in ("free", "locked") or tip not in ("free", "pinned"):
            raise ValueError("expected hub free or locked, tip free or pinned")
        freedoms = lib.impactlab_freedoms(self._handle)
        frequencies, shapes = np.zeros(max(freedoms, 1)), np.zeros((max(freedoms, 1),) * 2)
        count = c_size_t()
        call("modes", self._handle, int(hub == "locked"), int(tip == "pinned"),
             frequencies.ctypes.data_as(POINTER(c_double)),
             shapes.ctypes.data_as(POINTER(c_double)), freedoms, byref(count))
        return frequencies[:count.value], shapes[:count.value]

    def __repr__(self) -> str:
        return f"<Scenario {self.name}: {self.title}>"


def scenarios() -> List[str]:
    """The names of all scenarios."""
    names, count = POINTER(c_char_p)(), c_size_t()
    call("scenario_names", byref(names), byref(count))
    try:
        return [names[i].decode(errors="replace") for i in range(count.value)]
    finally:
        lib.impactlab_names_free(names, count)


__all__ = ["PARAMETERS", "Error", "Parameter", "Scenario", "scenarios"]
