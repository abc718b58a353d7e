"""Runs: signals as arrays without a copy, events, quantities, and how they show themselves."""

from __future__ import annotations

import base64
import ctypes
import html
import json
import math
import os
import subprocess
import tempfile
from ctypes import POINTER, byref, c_char_p, c_double, c_size_t, c_void_p
from typing import (TYPE_CHECKING, Any, Callable, Dict, List, Mapping, NamedTuple, Optional,
                    Protocol)

import numpy as np

from . import library
from .library import Callbacks, ErrorStruct, Owner, Table, call, error_of, lib, missing, number, text


if TYPE_CHECKING:
    from ._tables import Quantities
else:
    Quantities = object


class Source(Protocol):
    """What a run is computed from: a scenario."""

    _handle: c_void_p

    @property
    def title(self) -> str:
        """What it shows."""

    @property
    def yaml(self) -> str:
        """The scenario's file."""

    def copy(self) -> Any:
        """A scenario of its own."""


class Signal(NamedTuple):
    """A recorded signal."""

    name: str
    symbol: str
    unit: str
    description: str


class Quantity(NamedTuple):
    """A number that a run comes to."""

    key: str
    label: str
    unit: str
    description: str


class Event(NamedTuple):
    """What happened at an instant: impact, contact, release, stick, slip, change, push ..."""

    time: float
    kind: str
    impulse: float
    speed: float
    loss: float


class Prediction(NamedTuple):
    """What a predictor says of the instant before the first contact; None where it has no answer."""

    method: str
    holds: Optional[bool]
    peak_N: float
    time_to_peak_s: float
    impulse_Ns: float
    message: str


SIGNALS: Dict[str, Signal] = Table(
    (row.name.decode(), Signal(row.name.decode(), row.symbol.decode(), row.unit.decode(),
                               row.description.decode()))
    for row in library.rows("signal_at"))
QUANTITIES: Dict[str, Quantity] = Table(
    (row.key.decode(), Quantity(row.key.decode(), row.label.decode(), row.unit.decode(),
                                row.description.decode()))
    for row in library.rows("quantity_at"))
_NAMED: Dict[str, Any] = Table({**QUANTITIES, **SIGNALS})
_INDEX: Dict[str, int] = Table(
    (key, i) for i, key in enumerate(QUANTITIES))


def _view(owner: Any, address: Optional[int], rows: int, columns: int) -> np.ndarray:
    """An array over memory of the owner, which lives as long as the array does."""
    if not address or rows == 0:
        return np.empty((0, columns))
    buffer = (c_double * (rows * columns)).from_address(address)
    buffer._owner = owner
    array = np.frombuffer(buffer).reshape(rows, columns)
    array.flags.writeable = False
    return array


class Run(Owner, Quantities):
    """A run. `run["force"]` is a signal as an array, `run.peak_force_N` one of its quantities.

    It does not change, so that a copy is the run itself; a pickle holds all of it, for the same
    version on the same kind of machine.
    """

    _kind = "run"
    _destroy = staticmethod(lib.impactlab_run_destroy)
    _scenario: Source
    _answers: Optional[List[Dict[str, float]]] = None  # of a controller
    _undrawn = ""  # why the program cannot draw it

    def __init__(self) -> None:
        raise TypeError("a run comes from scenario.run() or loop.run()")

    @classmethod
    def _create(cls, scenario: Source, flags: int, callbacks: Callbacks, law: Any = None,
                answers: Optional[List[Dict[str, float]]] = None) -> "Run":
        """A run of a scenario that nobody else has."""
        run = cls.__new__(cls)
        error = ErrorStruct()
        callbacks.listen(scenario)
        with callbacks:
            code = lib.impactlab_run_create_with(byref(run._handle), scenario._handle, flags,
                                                 None if law is None else byref(law), None,
                                                 byref(error))
        callbacks.tell()
        run._scenario, run._answers = scenario, answers
        run._undrawn = "" if flags else "a figure is drawn of a run with rows"
        run._read()
        if code != 0:
            failure = error_of(error)
            failure.run = run if run._handle else None  # type: ignore[attr-defined]
            raise failure
        return run

    @classmethod
    def _of(cls, handle: c_void_p, scenario: Source) -> "Run":
        run = cls.__new__(cls)
        run._handle, run._scenario = handle, scenario
        run._undrawn = "a figure is drawn of a scenario's run, not of a loop's"
        run._read()
        return run

    def __copy__(self) -> "Run":
        return self

    def __deepcopy__(self, memo: Any) -> "Run":
        return self

    def __reduce_ex__(self, protocol: Any) -> Any:
        saved = ctypes.create_string_buffer(lib.impactlab_run_saved_size(self._handle))
        self._call("run_save", saved, len(saved))
        return _restored, (type(self), self._scenario, saved.raw, self._answers, self._undrawn)

    def _read(self) -> None:
        self._quantities = np.full(len(QUANTITIES), np.nan)
        if self._handle:
            lib.impactlab_run_quantities(self._handle,
                                         self._quantities.ctypes.data_as(POINTER(c_double)),
                                         len(self._quantities))

    @property
    def status(self) -> str:
        """"ok", "inaccurate" or "failed"."""
        return lib.impactlab_run_status(self._handle).decode()

    @property
    def message(self) -> str:
        """What stopped the run, or a remark."""
        return lib.impactlab_run_message(self._handle).decode(errors="replace")

    @property
    def quantities(self) -> Dict[str, float]:
        """Every number that the run comes to, NaN where one did not occur."""
        return dict(zip(QUANTITIES, map(float, self._quantities)))

    if not TYPE_CHECKING:  # checkers know the names by their stubs

        def __getattr__(self, key: str) -> float:
            if key not in _INDEX:
                raise AttributeError(missing("a run has no", key, dir(self)))
            return float(self._quantities[_INDEX[key]])

    def __dir__(self) -> List[str]:
        return [*super().__dir__(), *QUANTITIES]

    def __getitem__(self, name: str) -> np.ndarray:
        series = library.SeriesStruct()
        call("run_signal", self._handle, text(name, "the name of a signal"), byref(series))
        columns = max(series.stride // 8, 1)
        if not series.values or series.count == 0:
            return np.empty(0)
        # the last row ends with the signal itself
        length = (series.count - 1) * columns + 1
        flat = _view(self, series.values, length, 1)[:, 0]
        return flat[::columns]

    @property
    def time(self) -> np.ndarray:
        """Instants of the rows [s]."""
        return self["time"]

    def _table(self, function: str) -> np.ndarray:
        table = library.TableStruct()
        call(function, self._handle, byref(table))
        return _view(self, table.values, table.rows, table.columns)

    @property
    def angles(self) -> np.ndarray:
        """Angles of all degrees of freedom [rad], a row an instant."""
        return self._table("run_angles")

    @property
    def velocities(self) -> np.ndarray:
        """Their velocities [rad/s]."""
        return self._table("run_velocities")

    @property
    def events(self) -> List[Event]:
        found = []
        event = library.EventStruct()
        for i in range(lib.impactlab_run_event_count(self._handle)):
            lib.impactlab_run_event(self._handle, i, byref(event))
            found.append(Event(event.time, event.kind.decode(), event.impulse, event.speed,
                               event.loss))
        return found

    @property
    def predictions(self) -> List[Prediction]:
        """What the predictors say of the instant before the first contact."""
        said, count = (library.PredictionStruct * 16)(), c_size_t()
        call("run_predictions", self._handle, said, len(said), byref(count))
        return [Prediction(p.method.decode(), bool(p.holds) if p.known else None, p.peak,
                           p.time_to_peak, p.impulse, p.message.decode(errors="replace"))
                for p in said[:count.value]]

    @staticmethod
    def unit(name: str) -> str:
        """The unit of a signal or quantity."""
        return _NAMED[name].unit

    @property
    def json(self) -> str:
        """What `impactlab run --json` writes."""
        return library.take_text("run_json", self._handle)

    @property
    def csv(self) -> str:
        """What `impactlab run --csv` writes."""
        return library.take_text("run_csv", self._handle)

    def _columns(self, every: Optional[float]) -> Dict[str, np.ndarray]:
        """The signals that were recorded, the time first: of all rows, or on a uniform grid [s]."""
        if every is None:
            columns = {name: self[name] for name in SIGNALS}
        else:
            interval, count = number(every, "every"), c_size_t()
            self._call("run_grid", interval, None, 0, byref(count))
            grid = np.empty((count.value, len(SIGNALS)))
            self._call("run_grid", interval, grid.ctypes.data_as(POINTER(c_double)), len(grid),
                       byref(count))
            columns = dict(zip(SIGNALS, grid.T))
        return {name: values for name, values in columns.items()
                if name == "time" or not np.isnan(values).all()}

    def _happened(self, times: np.ndarray) -> List[str]:
        """What happened at each of the rows: events since the instant before it."""
        words = [""] * len(times)
        for event in self.events if words else []:
            first = min(np.searchsorted(times, event.time - 1e-12), len(times) - 1)
            last = np.searchsorted(times, times[first], "right") - 1
            words[last] += "+" * bool(words[last]) + event.kind
        return words

    def to_dataframe(self, every: Optional[float] = None, events: bool = False) -> Any:
        """All recorded signals as a pandas DataFrame over time; units are in `frame.attrs`.

        Rows are those of the run, of which there are several at the instant of an event; or, with
        `every` [s], one at each of 0, every, 2 every ... With `events` a column `event` tells what
        happened since the row before, such as "impact+contact".
        """
        import pandas
        columns = self._columns(every)
        times = columns.pop("time")
        frame = pandas.DataFrame(columns, index=pandas.Index(times, name="time"))
        frame.attrs["units"] = {name: SIGNALS[name].unit for name in columns}
        if events:
            frame["event"] = self._happened(times)
        return frame

    def to_xarray(self, every: Optional[float] = None) -> Any:
        """The same as an xarray Dataset, with units and descriptions as attributes."""
        import xarray
        columns = {name: ("time", values, {"units": SIGNALS[name].unit,
                                           "long_name": SIGNALS[name].description})
                   for name, values in self._columns(every).items()}
        return xarray.Dataset(columns, coords={"time": columns.pop("time")},
                              attrs={"title": self._scenario.title, "status": self.status,
                                     "source": f"impactlab {library.version()}"})

    def svg(self) -> str:
        """The figure that `impactlab run --plot` draws, as the text of an SVG file."""
        return self._drawn("svg").decode()

    def png(self, dpi: float = 200) -> bytes:
        """The same figure as the bytes of a PNG file of `dpi` dots per inch."""
        return self._drawn("png", "--dpi", str(dpi))

    def _repr_html_(self) -> Optional[str]:
        """The figure as an image with its data, for Jupyter: ids of its own, whatever page it is in."""
        if library.program() is None or self._undrawn:
            return None
        data = base64.b64encode(self._drawn("svg")).decode()
        return f'<img src="data:image/svg+xml;base64,{data}" alt="{html.escape(repr(self))}">'

    def _drawn(self, kind: str, *options: str) -> bytes:
        """The bytes of the figure that the program draws, or with "csv" of the rows that it writes;
        RuntimeError with its reason."""
        program = library.program()
        if program is None or self._undrawn:
            raise RuntimeError(self._undrawn or "no program impactlab is there to draw the run")
        with tempfile.TemporaryDirectory() as folder:
            path, figure = os.path.join(folder, "run.yaml"), os.path.join(folder, "run." + kind)
            scenario, environment = self._scenario.yaml, {**os.environ}
            if self._answers is not None:
                environment["IMPACTLAB_ANSWERS"] = os.path.join(folder, "answers")
                scenario = self._with_answers(environment["IMPACTLAB_ANSWERS"])
                options = ("--allow-code", *options)
            with open(path, "w", encoding="utf-8") as file:
                file.write(scenario)
            said = subprocess.run([program, "run", path, "--quiet", "--csv" if kind == "csv" else
                                   "--plot", figure, *options], check=False, env=environment,
                                  stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
            if not os.path.exists(figure):
                raise RuntimeError(said.stderr.decode(errors="replace").strip())
            with open(figure, "rb") as drawn:
                return drawn.read()

    def _with_answers(self, path: str) -> str:
        """The scenario's file with a program as its law that gives what the controller answered."""
        with open(path, "w", encoding="utf-8") as file:
            file.writelines(json.dumps(answer) + "\n" for answer in self._answers or [])
        replayed = self._scenario.copy()
        replayed.set({"control.law": "process", "control.command":
                      'while read -r q && read -r a <&3; do echo "$a"; done 3<"$IMPACTLAB_ANSWERS"'})

        # the first line is the title, which the run has without these changes
        return self._scenario.yaml.partition("\n")[0] + "\n" + replayed.yaml.partition("\n")[2]

    def __repr__(self) -> str:
        return (f"<Run {self.status}: first contact {self.first_contact_s:.6g} s, peak force "
                f"{self.peak_force_N:.6g} N, {len(self.time)} rows>")


def _restored(kind: Any, scenario: Source, saved: bytes, answers: Any, undrawn: str) -> Run:
    """What a pickle of a run holds as one."""
    run: Run = kind.__new__(kind)
    call("run_restore", byref(run._handle), scenario._handle, saved, len(saved))
    run._scenario, run._answers, run._undrawn = scenario, answers, undrawn
    run._read()
    return run


class Batch:
    """The outcomes of many runs: `batch["peak_force_N"]` is an array, one number a run."""

    __slots__ = ("parameters", "status", "messages", "_quantities")

    def __init__(self, parameters: Mapping[str, np.ndarray], quantities: np.ndarray,
                 status: List[str], messages: List[str]) -> None:
        self.parameters = dict(parameters)
        self.status = status
        self.messages = messages
        self._quantities = quantities

    def __len__(self) -> int:
        return len(self.status)

    def __getitem__(self, key: str) -> np.ndarray:
        return self._quantities[:, _INDEX[key]]

    def __repr__(self) -> str:
        ok = self.status.count("ok")
        return f"<Batch of {len(self)} runs, {ok} ok, over {', '.join(self.parameters)}>"

    def to_dataframe(self) -> Any:
        """Parameters, status and quantities as a pandas DataFrame, a row a run."""
        import pandas
        return pandas.DataFrame({**self.parameters, "status": self.status,
                                 **{key: self[key] for key in QUANTITIES}})


ANSWERS = ("desired_angle", "desired_velocity", "calculated_force", "command")


def _take_answer(out: Any, answered: Any) -> None:
    """What a controller returned: volts, or a mapping of what it may answer. The command, without
    which there is no answer, comes last."""
    if not isinstance(answered, Mapping):
        out.command = number(answered, "the command of a controller")
        return
    for name in answered:
        if name not in ANSWERS:
            raise KeyError(missing("a controller's answer has no", name, ANSWERS))
    if "command" not in answered:
        raise KeyError("a controller's answer lacks 'command', expected volts")
    for name in ANSWERS:
        if name in answered:
            setattr(out, name, number(answered[name], name))


def run_with(scenario: Source, flags: int, function: Callable[[Any], Any]) -> Run:
    """A run with a Python function as its controller; what it raises is raised again."""
    callbacks = Callbacks()
    if not callable(function):
        raise TypeError(f"expected a function as the controller, not {type(function).__name__}")

    answers: List[Dict[str, float]] = []

    def sample(memory: Any, reading: Any, answer: Any) -> None:
        try:
            # a copy, as the function may keep it; without a command the run ends
            if not callbacks.raised:
                out = answer.contents
                _take_answer(out, function(library.InputStruct.from_buffer_copy(reading.contents)))
                answers.append({name: getattr(out, name) for name in ANSWERS
                                if math.isfinite(getattr(out, name))})
        except BaseException as failure:
            callbacks.raised.append(failure)

    modes = (c_char_p * 2)(b"python", None)
    law = library.ControllerStruct(interface=library.CONTROLLER_INTERFACE, name=b"python",
                                   modes=modes, memory_size=ctypes.sizeof(c_void_p),
                                   sample=library.SampleFunction(sample))
    return Run._create(scenario, flags, callbacks, law, answers)
