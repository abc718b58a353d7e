"""Writes the types of parameters and quantities for checkers such as mypy, of the library's tables.

    IMPACTLAB_LIBRARY=LIBRARY stubs.py LIBRARY.PY OUTPUT
"""

import importlib.util
import sys

# the module alone, as the package wants more than the tables
found = importlib.util.spec_from_file_location("library", sys.argv[1])
library = importlib.util.module_from_spec(found)
found.loader.exec_module(library)

HEAD = '''\
"""Types of the parameters and quantities, written of the library's tables by stubs.py."""
from typing import Generic, List, Literal, Sequence, TypeVar, Union

from .scenario import Group, Runner

Given = TypeVar("Given")
Taken = TypeVar("Taken", contravariant=True)

class Value(Generic[Given, Taken]):
    def __get__(self, group: object, kind: object = ...) -> Given: ...
    def __set__(self, group: object, value: Taken) -> None: ...
'''
TYPES = {"real": "float, Union[float, str]", "integer": "int, Union[int, str]", "text": "str, str",
         "boolean": "bool, Union[bool, str]", "list": "List[float], Union[Sequence[float], str]"}


def type_of(row):
    """What a parameter gives and what it takes; a choice is one of its words."""
    if row.type.decode() == "choice":
        words = f"Literal{row.choices.decode().split('|')!r}"
        return f"{words}, {words}"
    return TYPES[row.type.decode()]


def class_name(group):
    return group.capitalize() + "Parameters"


groups = {}
for row in library.rows("parameter_at"):
    group, name = row.path.decode().split(".")
    groups.setdefault(group, []).append(
        f"    {name}: Value[{type_of(row)}]\n    {row.description.decode()!r}\n")

with open(sys.argv[2], "w", encoding="utf-8") as stub:
    stub.write(HEAD)
    for group, members in groups.items():
        base = "Runner" if group == "run" else "Group"
        stub.write(f"\nclass {class_name(group)}({base}):\n{''.join(members)}")
    stub.write("\nclass Parameters:\n")
    for group in groups:
        stub.write(f"    @property\n    def {group}(self) -> {class_name(group)}: ...\n")
    stub.write("\nclass Quantities:\n")
    for row in library.rows("quantity_at"):
        stub.write(f"    @property\n    def {row.key.decode()}(self) -> float: ...\n")
