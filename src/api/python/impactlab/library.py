"""The shared library: where it is, its functions and structures, its errors as exceptions, and what
owns one of its handles."""

from __future__ import annotations

import ctypes
import difflib
import os
import sys
import threading
from ctypes import POINTER, c_char, c_char_p, c_double, c_int, c_size_t, c_void_p
from pathlib import Path
from typing import TYPE_CHECKING, Any, Callable, Iterable, Iterator, List, Optional

KEEP_ROWS = 1
COMMAND = 2
SONAME = "libimpactlab.so.1"


class Error(Exception):
    """What the library could not do: a sentence, with `status`, the path of the `parameter`, and
    `line` and `column` of the fault in the file or text that was read, from 1 (0: of none)."""

    def __init__(self, sentence: str, status: int = 0, parameter: str = "", line: int = 0,
                 column: int = 0) -> None:
        super().__init__(sentence)
        self.status = status
        self.parameter = parameter
        self.line = line
        self.column = column

    def __reduce__(self) -> Any:
        # a run that came to it stays behind: it cannot be pickled
        return type(self), (str(self), self.status, self.parameter, self.line, self.column)


# --- what callers give ------------------------------------------------------------------------

def missing(what: str, name: Any, names: Iterable[str]) -> str:
    """The sentence about a name that is not known, with the nearest that is: `what` begins it. Of
    names with a dot, the part behind it is one, too."""
    public = [other for other in names if not other.startswith("_")]
    meant = {other.split(".")[-1]: other for other in public} | {other: other for other in public}
    near = [] if str(name).startswith("_") else difflib.get_close_matches(str(name), meant, 1)
    return f"{what} '{name}'" + (f", did you mean '{meant[near[0]]}'?" if near else "")


class Table(dict):  # type: ignore[type-arg]
    """A table by names; one that is not there is told with the nearest."""

    def __missing__(self, name: Any) -> Any:
        raise KeyError(missing("there is no", name, self))


def text(value: Any, what: str) -> bytes:
    """A text as the library takes it, which ends at a NUL: one that holds a NUL is refused."""
    if not isinstance(value, str):
        raise TypeError(f"expected a text for {what}, not {type(value).__name__}")
    if "\0" in value:
        raise ValueError(f"expected a text without NUL for {what}, not {value!r}")
    return value.encode()


def number(value: Any, what: str) -> float:
    """A number. Texts and truth values are none, although float() takes them."""
    if type(value) is float:
        return value
    if not isinstance(value, (str, bytes, bytearray, bool)) and getattr(value, "dtype", 0) != bool:
        try:
            return float(value)
        except OverflowError:
            raise ValueError(f"{what} is too large, expected a finite number") from None
        except (TypeError, ValueError):
            pass
    raise TypeError(f"expected a number for {what}, not {type(value).__name__}")


# --- structures -------------------------------------------------------------------------------


class ErrorStruct(ctypes.Structure):
    _fields_ = [("status", c_int), ("line", c_int), ("column", c_int),
                ("parameter", c_char * 64), ("sentence", c_char * 1024)]


class ParameterStruct(ctypes.Structure):
    _fields_ = [("path", c_char_p), ("type", c_char_p), ("unit", c_char_p), ("choices", c_char_p),
                ("description", c_char_p), ("initial", c_double), ("minimum", c_double),
                ("maximum", c_double), ("timed", c_int)]


class SignalStruct(ctypes.Structure):
    _fields_ = [("name", c_char_p), ("symbol", c_char_p), ("unit", c_char_p),
                ("description", c_char_p)]


class QuantityStruct(ctypes.Structure):
    _fields_ = [("key", c_char_p), ("label", c_char_p), ("unit", c_char_p),
                ("description", c_char_p), ("timing", c_int)]


class SeriesStruct(ctypes.Structure):
    _fields_ = [("values", c_void_p), ("count", c_size_t), ("stride", c_size_t)]


class TableStruct(ctypes.Structure):
    _fields_ = [("values", c_void_p), ("rows", c_size_t), ("columns", c_size_t)]


class EventStruct(ctypes.Structure):
    _fields_ = [("time", c_double), ("kind", c_char_p), ("impulse", c_double),
                ("speed", c_double), ("loss", c_double)]


class Readings:
    """Numbers under names, to be read only."""

    __slots__ = ()
    _fields_: Any

    if not TYPE_CHECKING:  # checkers know the names by themselves

        def __getattr__(self, name: str) -> Any:
            raise AttributeError(missing("a reading has no", name, [field[0] for field in self._fields_]))

        def __setattr__(self, name: str, value: Any) -> None:
            raise AttributeError(f"a reading cannot be set, {name} neither")


class ReadingStruct(Readings, ctypes.Structure):
    """What the sensors read; NaN where one is not fitted."""

    __slots__ = ()
    time: float
    encoder: float
    tachometer: float
    force: float
    piezo_force: float
    film: float
    accelerometer: float
    _fields_ = [(name, c_double) for name in
                ("time", "encoder", "tachometer", "force", "piezo_force", "film", "accelerometer")]


class OutcomeStruct(ctypes.Structure):
    _fields_ = [("index", c_size_t), ("status", c_int), ("word", c_char_p), ("message", c_char_p),
                ("quantities", POINTER(c_double)), ("quantity_count", c_size_t)]


class PredictionStruct(ctypes.Structure):
    _fields_ = [("method", c_char_p), ("known", c_int), ("holds", c_int), ("peak", c_double),
                ("time_to_peak", c_double), ("impulse", c_double), ("message", c_char * 1024)]


# controller.h

class InputStruct(Readings, ctypes.Structure):
    """What a controller sees at a sample: the sensors' readings and the command in effect."""

    __slots__ = ()
    time: float
    encoder: float
    tachometer: float
    force: float
    voltage: float
    piezo_force: float
    film: float
    accelerometer: float
    wanted_mode: int
    predicted_force: float
    _fields_ = [("time", c_double), ("encoder", c_double), ("tachometer", c_double),
                ("force", c_double), ("voltage", c_double), ("piezo_force", c_double),
                ("film", c_double), ("accelerometer", c_double), ("wanted_mode", c_int),
                ("predicted_force", c_double)]


class OutputStruct(ctypes.Structure):
    _fields_ = [("command", c_double), ("mode", c_int), ("desired_angle", c_double),
                ("desired_velocity", c_double), ("calculated_force", c_double)]


SampleFunction = ctypes.CFUNCTYPE(None, c_void_p, POINTER(InputStruct), POINTER(OutputStruct))
TakeFunction = ctypes.CFUNCTYPE(c_int, c_void_p, POINTER(OutcomeStruct))
StopFunction = ctypes.CFUNCTYPE(c_int, c_void_p)


class ControllerStruct(ctypes.Structure):
    _fields_ = [("interface", c_int), ("name", c_char_p), ("modes", POINTER(c_char_p)),
                ("lockable", ctypes.c_bool), ("parameters", c_void_p), ("parameter_count", c_int),
                ("memory_size", c_size_t), ("start", c_void_p), ("sample", SampleFunction),
                ("tune", c_void_p)]


CONTROLLER_INTERFACE = 5


def _places() -> Iterator[str]:
    """Where the library may be: as told, in the package, beside an installed one, in a build of the
    tree."""
    told = os.environ.get("IMPACTLAB_LIBRARY")
    if told:
        yield told
        return
    here = Path(__file__).resolve()
    if here.with_name(SONAME).exists():
        yield str(here.with_name(SONAME))
        return
    for folder in list(here.parents)[1:6]:
        for library in sorted(folder.glob("lib*/" + SONAME)) + sorted(folder.glob("*/" + SONAME)):
            yield str(library)
        for library in sorted(folder.glob("lib*/*/" + SONAME)):
            yield str(library)
        if (folder / "meson.build").exists():
            for library in sorted(folder.glob("build*/src/api/" + SONAME)):
                yield str(library)
    yield SONAME


def _load() -> ctypes.CDLL:
    failures = []
    for place in _places():
        try:
            return ctypes.CDLL(place)
        except OSError as failure:
            failures.append(str(failure))
    raise ImportError("libimpactlab cannot be loaded; install it (meson install) or name it in "
                      "IMPACTLAB_LIBRARY: " + "; ".join(failures[:3]))


lib = _load()

_handle, _error, _text = c_void_p, POINTER(ErrorStruct), c_char_p
_SIGNATURES: dict[str, tuple[Any, list[Any]]] = {
    "version": (_text, []),
    "parameter_at": (POINTER(ParameterStruct), [c_size_t]),
    "signal_at": (POINTER(SignalStruct), [c_size_t]),
    "quantity_at": (POINTER(QuantityStruct), [c_size_t]),
    "scenario_names": (c_int, [POINTER(POINTER(c_char_p)), POINTER(c_size_t), _error]),
    "names_free": (None, [POINTER(c_char_p), c_size_t]),
    "scenario_open": (c_int, [POINTER(_handle), _text, _error]),
    "scenario_parse": (c_int, [POINTER(_handle), _text, c_size_t, _error]),
    "scenario_parse_named": (c_int, [POINTER(_handle), _text, c_size_t, _text, _error]),
    "scenario_create": (c_int, [POINTER(_handle), _error]),
    "scenario_copy": (c_int, [POINTER(_handle), _handle, _error]),
    "scenario_destroy": (None, [_handle]),
    "scenario_name": (_text, [_handle]),
    "scenario_title": (_text, [_handle]),
    "scenario_description": (_text, [_handle]),
    "scenario_set": (c_int, [_handle, _text, _text, _error]),
    "scenario_set_number": (c_int, [_handle, _text, c_double, _error]),
    "scenario_set_all": (c_int, [_handle, POINTER(c_char_p), c_size_t, _error]),
    "scenario_number": (c_int, [_handle, _text, POINTER(c_double), _error]),
    "scenario_text": (c_int, [_handle, _text, _text, c_size_t, _error]),
    "scenario_is_set": (c_int, [_handle, _text]),
    "scenario_add_change": (c_int, [_handle, c_double, _text, _text, _error]),
    "scenario_add_push": (c_int, [_handle, c_double, c_double, _error]),
    "scenario_allow_code": (None, [_handle, c_int]),
    "scenario_stop_when": (None, [_handle, StopFunction, c_void_p]),
    "scenario_yaml": (c_int, [_handle, POINTER(c_void_p), _error]),
    "text_free": (None, [c_void_p]),
    "run_create": (c_int, [POINTER(_handle), _handle, c_int, _error]),
    "run_create_with": (c_int, [POINTER(_handle), _handle, c_int, POINTER(ControllerStruct),
                                c_void_p, _error]),
    "run_destroy": (None, [_handle]),
    "run_status": (_text, [_handle]),
    "run_message": (_text, [_handle]),
    "run_quantities": (c_size_t, [_handle, POINTER(c_double), c_size_t]),
    "run_signal": (c_int, [_handle, _text, POINTER(SeriesStruct), _error]),
    "run_angles": (c_int, [_handle, POINTER(TableStruct), _error]),
    "run_velocities": (c_int, [_handle, POINTER(TableStruct), _error]),
    "run_event_count": (c_size_t, [_handle]),
    "run_event": (c_int, [_handle, c_size_t, POINTER(EventStruct)]),
    "run_json": (c_int, [_handle, POINTER(c_void_p), _error]),
    "run_csv": (c_int, [_handle, POINTER(c_void_p), _error]),
    "run_grid": (c_int, [_handle, c_double, POINTER(c_double), c_size_t, POINTER(c_size_t), _error]),
    "run_saved_size": (c_size_t, [_handle]),
    "run_save": (c_int, [_handle, c_void_p, c_size_t, _error]),
    "run_restore": (c_int, [POINTER(_handle), _handle, c_void_p, c_size_t, _error]),
    "run_predictions": (c_int, [_handle, POINTER(PredictionStruct), c_size_t, POINTER(c_size_t),
                                _error]),
    "loop_create": (c_int, [POINTER(_handle), _handle, c_int, _error]),
    "loop_destroy": (None, [_handle]),
    "loop_step": (c_int, [_handle, _error]),
    "loop_step_until": (c_int, [_handle, c_double, _error]),
    "loop_time": (c_double, [_handle]),
    "loop_ended": (c_int, [_handle]),
    "loop_command": (c_int, [_handle, c_double, _error]),
    "loop_set_input": (c_int, [_handle, _text, c_double, _error]),
    "loop_set_text": (c_int, [_handle, _text, _text, _error]),
    "loop_push": (c_int, [_handle, c_double, _error]),
    "loop_read_sensors": (c_int, [_handle, POINTER(ReadingStruct), _error]),
    "loop_signal": (c_int, [_handle, _text, POINTER(c_double), _error]),
    "loop_signals": (c_size_t, [_handle, POINTER(c_double), c_size_t]),
    "loop_state": (c_int, [_handle, POINTER(TableStruct), _error]),
    "loop_state_size": (c_size_t, [_handle]),
    "loop_save_state": (c_int, [_handle, c_void_p, c_size_t, _error]),
    "loop_restore_state": (c_int, [_handle, c_void_p, c_size_t, _error]),
    "loop_run": (c_int, [_handle, POINTER(_handle), _error]),
    "batch": (c_int, [_handle, POINTER(c_char_p), c_size_t, POINTER(c_double), c_size_t, c_int,
                      TakeFunction, c_void_p, _error]),
    "freedoms": (c_size_t, [_handle]),
    "modes": (c_int, [_handle, c_int, c_int, POINTER(c_double), POINTER(c_double), c_size_t,
                      POINTER(c_size_t), _error]),
}
for _name, (_result, _arguments) in _SIGNATURES.items():
    _function = getattr(lib, "impactlab_" + _name)
    _function.restype, _function.argtypes = _result, _arguments


def call(name: str, *arguments: Any) -> None:
    """Calls a function that can fail; raises Error with its sentence."""
    error = ErrorStruct()
    if getattr(lib, "impactlab_" + name)(*arguments, ctypes.byref(error)) != 0:
        raise_error(error)


def raise_error(error: ErrorStruct) -> None:
    raise error_of(error)


def error_of(error: ErrorStruct) -> Error:
    """The exception of what the library says."""
    return Error(error.sentence.decode(errors="replace"), error.status, error.parameter.decode(),
                 error.line, error.column)


class Callbacks:
    """What is raised while the library calls back, by ^C too, cannot pass through it: it is kept
    in `raised`, stops what the library does, and is raised by `tell` once that is over.

        with callbacks:
            code = lib.impactlab_...
        callbacks.tell()
    """

    def __init__(self) -> None:
        raised: List[BaseException] = []
        self.raised = raised
        self._question = StopFunction(lambda context: len(raised) > 0)

    def listen(self, scenario: Any) -> None:
        """Runs, loops and batches made of the scenario's handle ask from now on; they hold no
        reference to this object."""
        lib.impactlab_scenario_stop_when(scenario._handle, self._question, None)

    def _keep(self, unraisable: Any) -> None:
        # a signal's handler runs before the first line of a callback, outside of any `try` there
        here = threading.current_thread() is threading.main_thread()
        if here and "ctypes callback" in (unraisable.err_msg or ""):
            self.raised.append(unraisable.exc_value)
        else:
            self._hook(unraisable)

    def __enter__(self) -> None:
        self.raised.clear()
        self._hook: Any = None
        if threading.current_thread() is threading.main_thread():  # others get no signals
            self._hook = sys.unraisablehook
            sys.unraisablehook = self._keep

    def __exit__(self, *ignored: Any) -> None:
        if self._hook is not None:
            sys.unraisablehook = self._hook

    def tell(self) -> None:
        """Raises what was raised first, with its traceback."""
        if self.raised:
            raise self.raised.pop(0)


class Owner:
    """What owns a handle of the library, and destroys it. One thread at a time gets at the handle.

    It has the attributes that its class has, and what is set is there to be set: another name is
    refused with the nearest.
    """

    _kind = "object"
    _instead = ""
    _destroy: Callable[[Any], None]

    _handle: c_void_p
    _lock: Any

    def __new__(cls, *arguments: Any, **named: Any) -> Any:
        made = super().__new__(cls)
        made._handle, made._lock = c_void_p(), threading.RLock()
        return made

    def __del__(self) -> None:
        if self._handle:
            self._destroy(self._handle)

    def _call(self, name: str, *arguments: Any) -> None:
        """Calls a function of the handle that can fail."""
        with self._lock:
            call(name, self._handle, *arguments)

    def __reduce_ex__(self, protocol: Any) -> Any:
        raise TypeError(f"a {self._kind} can be neither copied nor pickled: {self._instead}")

    if not TYPE_CHECKING:  # checkers know the names by themselves

        def __getattr__(self, name: str) -> Any:
            raise AttributeError(missing(f"a {self._kind} has no", name, dir(self)))

        def __setattr__(self, name: str, value: Any) -> None:
            if not name.startswith("_"):
                there = getattr(type(self), name, None)
                if there is None or callable(there) or getattr(there, "fset", self) is None:
                    getattr(self, name)
                    raise AttributeError(f"{name} of a {self._kind} cannot be set")
            object.__setattr__(self, name, value)


def take_text(name: str, handle: Any) -> str:
    """The text that a function makes, which is freed."""
    place = c_void_p()
    call(name, handle, ctypes.byref(place))
    try:
        return ctypes.string_at(place).decode(errors="replace")
    finally:
        lib.impactlab_text_free(place)


def rows(function: str) -> Iterator[Any]:
    """The rows of one of the library's tables."""
    index = 0
    while row := getattr(lib, "impactlab_" + function)(index):
        yield row.contents
        index += 1


def version() -> str:
    """The version of the library."""
    return lib.impactlab_version().decode()


def program() -> Optional[str]:
    """The program `impactlab` beside the library, in the build tree or on the path."""
    import shutil
    told = os.environ.get("IMPACTLAB_PROGRAM")
    if told:
        return told
    for folder in Path(lib._name).resolve().parents if os.sep in str(lib._name) else []:
        for place in (folder / "bin" / "impactlab", folder / "impactlab"):
            if place.is_file() and os.access(place, os.X_OK):
                return str(place)
    return shutil.which("impactlab")
