"""Scenarios: opened or made, their parameters as attributes, and what is run of them."""

from __future__ import annotations

import ctypes
import operator
import os
from ctypes import POINTER, byref, c_char_p, c_double, c_size_t
from typing import TYPE_CHECKING, Any, Callable, Dict, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np

from . import library
from .library import KEEP_ROWS, Callbacks, Error, Owner, Table, call, lib, missing
from .run import QUANTITIES, Batch, Run, run_with

if TYPE_CHECKING:
    from ._tables import Parameters
else:
    Parameters = object

Value = Union[float, int, bool, str, Sequence[float]]
Controller = Callable[[library.InputStruct], Union[float, Mapping[str, float]]]


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
PARAMETERS: Dict[str, Parameter] = Table(
    (p.path, p) for p in map(Parameter, library.rows("parameter_at")))


class Group:
    """The parameters of one group, such as `scenario.motor`, as attributes."""

    _names: Tuple[str, ...] = ()
    _scenario: "Scenario"

    def __init__(self, scenario: "Scenario") -> None:
        object.__setattr__(self, "_scenario", scenario)

    if not TYPE_CHECKING:  # checkers know the names by their stubs

        def __getattr__(self, name: str) -> Any:
            group = type(self).__name__
            raise AttributeError(missing("there is no parameter", f"{group}.{name}",
                                         [f"{group}.{known}" for known in self._names])
                                 + " There are: " + ", ".join(self._names))

        def __setattr__(self, name: str, value: Value) -> None:
            if name not in self._names:
                getattr(self, name)
            object.__setattr__(self, name, value)

    def __reduce__(self) -> Any:
        return getattr, (self._scenario, type(self).__name__)

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
        # as it is now, whatever a controller or another thread makes of it meanwhile
        scenario = self._scenario.copy()
        if controller is not None:
            return run_with(scenario, KEEP_ROWS if rows else 0, controller)
        return Run._create(scenario, KEEP_ROWS if rows else 0, Callbacks())


def value_of(path: str, value: Value) -> Union[float, str]:
    """A value of a parameter as the library takes it: a text or a number. A truth value is one of a
    boolean parameter only, a sequence of numbers one of a list."""
    kind = PARAMETERS[path].type if path in PARAMETERS else ""
    if isinstance(value, str):
        return value
    if isinstance(value, (bool, np.bool_)) and kind == "boolean":
        return float(value)
    if kind == "list" and isinstance(value, (Sequence, np.ndarray)):
        return ", ".join(repr(library.number(one, path)) for one in value)
    return library.number(value, path)


def _as_text(path: str, value: Value) -> str:
    """The same as a scenario file has it."""
    given = value_of(path, value)
    if not isinstance(given, float):
        return given
    return repr(int(given) if given.is_integer() and abs(given) < 2**53 else given)


def _make_groups() -> Dict[str, type]:
    members: Dict[str, Dict[str, Any]] = {}
    for path, parameter in PARAMETERS.items():
        group, name = path.split(".", 1)
        members.setdefault(group, {})[name] = _attribute(parameter)
    return {group: type(group, (Runner if group == "run" else Group,), {**found, "_names": tuple(found),
                                          "__doc__": f"The parameters {group}.*"})
            for group, found in members.items()}


_GROUPS = _make_groups()


def _restored(kind: type, yaml: str, name: str, allowed: bool) -> "Scenario":
    """What a pickle of a scenario holds as one."""
    made = kind.__new__(kind)
    data = yaml.encode()
    call("scenario_parse_named", byref(made._handle), data, len(data), name.encode())
    return made.allow_code(allowed)


class Scenario(Owner, Parameters):
    """A scenario: `Scenario("corrected/first-impact")`, a file, or without a name one of defaults.

    Its parameters are attributes (`scenario.motor.voltage = 2`) and items
    (`scenario["motor.voltage"] = "2 V"`); what is wrong raises Error and changes nothing.
    `scenario.run()` runs it, `scenario.run.duration` is a parameter like the others. It can be
    copied and, without what its file expects, pickled.
    """

    _kind = "scenario"
    _destroy = staticmethod(lib.impactlab_scenario_destroy)
    _allowed = False

    def __init__(self, name: Union[str, "os.PathLike[str]", None] = None,
                 **parameters: Value) -> None:
        if name is None:
            call("scenario_create", byref(self._handle))
        else:
            library.text(os.fspath(name), "the name of a scenario")
            call("scenario_open", byref(self._handle), os.fsencode(name))
        if parameters:
            self.set({path.replace("__", "."): value for path, value in parameters.items()})

    @classmethod
    def from_yaml(cls, text: str) -> "Scenario":
        """A scenario from the text of a scenario file."""
        made = cls.__new__(cls)
        data = library.text(text, "a scenario")
        call("scenario_parse", byref(made._handle), data, len(data))
        return made

    def copy(self) -> "Scenario":
        """A scenario of its own with the same parameters and script."""
        made = type(self).__new__(type(self))
        with self._lock:
            call("scenario_copy", byref(made._handle), self._handle)
            made._allowed = self._allowed
        return made

    __copy__ = copy

    def __deepcopy__(self, memo: Any) -> "Scenario":
        return self.copy()

    def __reduce_ex__(self, protocol: Any) -> Any:
        with self._lock:
            return _restored, (type(self), self.yaml, self.name, self._allowed)

    if not TYPE_CHECKING:  # checkers know the names by their stubs

        def __getattr__(self, name: str) -> Any:
            raise AttributeError(missing("a scenario has no", name, [*dir(self), *PARAMETERS]))

        def __setattr__(self, name: str, value: Any) -> None:
            if name in _GROUPS:
                raise AttributeError(f"{name} is a group of parameters, expected one of them, such as "
                                     f"scenario.{name}.{_GROUPS[name]._names[0]} = ...")
            super().__setattr__(name, value)

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
        with self._lock:
            return library.take_text("scenario_yaml", self._handle)

    def __getitem__(self, path: str) -> Value:
        number, key = c_double(), library.text(path, "the path of a parameter")
        self._call("scenario_number", key, byref(number))
        kind = PARAMETERS[path].type
        if kind in ("choice", "text", "list"):
            text = ctypes.create_string_buffer(256)
            self._call("scenario_text", key, text, len(text))
            said = text.value.decode(errors="replace")
            return said if kind != "list" else [float(word) for word in said.split(",") if word]
        if kind == "boolean":
            return number.value != 0
        return int(number.value) if kind == "integer" else number.value

    def __setitem__(self, path: str, value: Value) -> None:
        key, given = library.text(path, "the path of a parameter"), value_of(path, value)
        if isinstance(given, str):
            self._call("scenario_set", key, library.text(given, path))
        else:
            self._call("scenario_set_number", key, given)

    def set(self, parameters: Mapping[str, Value]) -> "Scenario":
        """Sets several parameters at once, in any order that makes sense together."""
        texts = []
        for path, value in parameters.items():
            if path not in PARAMETERS:
                self[path]  # says what there is
            texts.append(library.text(f"{path}={_as_text(path, value)}", path))
        array = (c_char_p * len(texts))(*texts)
        self._call("scenario_set_all", array, len(texts))
        return self

    def change_at(self, time: float, path: str, value: Value) -> "Scenario":
        """Adds to the script: at `time` [s] the parameter gets another value."""
        self._call("scenario_add_change", library.number(time, "the time of a change"),
                   library.text(path, "the path of a parameter"),
                   library.text(_as_text(path, value), path))
        return self

    def push_at(self, time: float, impulse: float) -> "Scenario":
        """Adds to the script: at `time` [s] the tip gets an impulse [N s]."""
        self._call("scenario_add_push", library.number(time, "the time of a push"),
                   library.number(impulse, "an impulse"))
        return self

    def allow_code(self, allowed: bool = True) -> "Scenario":
        """Lets the scenario start the program or load the plug-in that it names."""
        if not isinstance(allowed, bool):
            raise TypeError(f"expected True or False, not {type(allowed).__name__}")
        with self._lock:
            lib.impactlab_scenario_allow_code(self._handle, allowed)
            self._allowed = allowed
        return self

    def batch(self, parameters: Mapping[str, Sequence[float]], jobs: int = 0) -> Batch:
        """Runs it once for every row of the parameters' values, on `jobs` threads (0: all cores)."""
        paths, given = list(parameters), []
        threads = operator.index(jobs)
        if not paths or not 0 <= threads <= 0x7fffffff:
            raise ValueError("a batch varies at least one parameter, on 0 (all cores) or more jobs")
        for path in paths:
            column = np.asarray(parameters[path])
            boolean = path in PARAMETERS and PARAMETERS[path].type == "boolean"
            if column.size and column.dtype.kind not in ("biuf" if boolean else "iuf"):
                raise TypeError(f"expected numbers for {path}, not {column.dtype}")
            given.append(column.astype(float))
        columns = np.broadcast_arrays(*given)
        values = np.ascontiguousarray(np.stack([c.ravel() for c in columns], axis=1))
        count = len(values)
        found = np.full((count, len(QUANTITIES)), np.nan)
        words, messages = [""] * count, [""] * count
        callbacks, error = Callbacks(), library.ErrorStruct()

        def take(context: Any, outcome: Any) -> int:
            one = outcome.contents
            try:
                ctypes.memmove(found[one.index].ctypes.data, one.quantities, 8 * one.quantity_count)
                words[one.index] = one.word.decode()
                messages[one.index] = one.message.decode(errors="replace")
            except BaseException as failure:
                callbacks.raised.append(failure)
            return len(callbacks.raised)

        array = (c_char_p * len(paths))(*[library.text(p, "the path of a parameter") for p in paths])
        base = self.copy()  # whatever another thread makes of it meanwhile
        callbacks.listen(base)
        with callbacks:
            code = lib.impactlab_batch(base._handle, array, len(paths),
                                       values.ctypes.data_as(POINTER(c_double)), count, threads,
                                       library.TakeFunction(take), None, byref(error))
        callbacks.tell()
        if code != 0:
            library.raise_error(error)
        return Batch({p: values[:, k] for k, p in enumerate(paths)}, found, words, messages)

    def modes(self, hub: str = "free", tip: str = "free") -> Tuple[np.ndarray, np.ndarray]:
        """Natural frequencies [rad/s] and shapes (one a row) of the straight arm without damping.

        hub: "free" or "locked"; tip: "free" or "pinned".
        """
        if hub not in ("free", "locked") or tip not in ("free", "pinned"):
            raise ValueError("expected hub free or locked, tip free or pinned")
        count = c_size_t()
        with self._lock:
            freedoms = lib.impactlab_freedoms(self._handle)
            frequencies, shapes = np.zeros(max(freedoms, 1)), np.zeros((max(freedoms, 1),) * 2)
            call("modes", self._handle, int(hub == "locked"), int(tip == "pinned"),
                 frequencies.ctypes.data_as(POINTER(c_double)),
                 shapes.ctypes.data_as(POINTER(c_double)), freedoms, byref(count))
        return frequencies[:count.value], shapes[:count.value]

    def __repr__(self) -> str:
        return f"<Scenario {self.name}: {self.title}>"


for _group, _members in _GROUPS.items():
    setattr(Scenario, _group, property(_members, doc=_members.__doc__))


def scenarios() -> List[str]:
    """The names of all scenarios."""
    names, count = POINTER(c_char_p)(), c_size_t()
    call("scenario_names", byref(names), byref(count))
    try:
        return [names[i].decode(errors="replace") for i in range(count.value)]
    finally:
        lib.impactlab_names_free(names, count)


__all__ = ["PARAMETERS", "Error", "Parameter", "Scenario", "scenarios"]
