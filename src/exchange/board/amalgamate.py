#!/usr/bin/env python3
"""Writes control laws as one C file each, as text for the program to hold:

    amalgamate.py ROOT OUTPUT LAW...

LAW is a path within ROOT. Its includes from src are put in its place, once each, with the
.c beside them where there is one; but for the interface of a controller, which the
exported header has. A second text has float for double, except in src/base, whose
elementary functions keep their accuracy.
"""
import pathlib
import re
import sys

# what <math.h> has beyond C99
PROLOGUE = '''
#include "law.h"

#ifndef M_PI
#define M_PI 3.14159265358979323846
#define M_SQRT1_2 0.70710678118654752440
#endif
#define sincos(x, sine, cosine) (*(sine) = sin(x), *(cosine) = cos(x))
#ifdef __GNUC__ // a law does not call all that it may
#pragma GCC diagnostic ignored "-Wunused-function"
#endif
'''
INTERFACE = 'src/rig/controller.h'
# functions of <math.h> that laws call, with their single twins' names
FUNCTIONS = r'\b(fmin|fmax|fabs|sqrt|copysign|floor|ceil)\('
NUMBER = r'(?<![\w.])((?:\d+\.\d*|\.\d+)(?:[eE][+-]?\d+)?|\d+[eE][+-]?\d+)(?![\w.])'


def single(text):
    """The text with float for double; comments and names of files stay."""
    parts = re.split(r'(//[^\n]*|"(?:\\.|[^"\\])*")', text)
    for i in range(0, len(parts), 2):
        code = re.sub(r'\bdouble\b', 'float', parts[i])
        code = re.sub(FUNCTIONS, r'\1f(', code)
        code = re.sub(r'\bHUGE_VAL\b', 'HUGE_VALF', code)
        code = re.sub(r'\bM_PI\b', '(float)M_PI', code)
        parts[i] = re.sub(NUMBER, r'\1F', code)
    return ''.join(parts)


class Amalgam:
    """A law's file with all that it includes."""

    def __init__(self, root):
        self.root = root
        self.seen = {INTERFACE}
        self.system = []
        self.parts = []  # (path, text)

    def take(self, path):
        """A file behind all that it includes."""
        if path in self.seen:
            return
        self.seen.add(path)
        own = []
        for line in (self.root / path).read_text(encoding='ascii').splitlines():
            include = re.match(r'#include ([<"])([^>"]+)[>"]', line)
            if line == '#pragma once' or (include and include[1] == '"'):
                if include:
                    self.take(include[2])
            elif include:
                self.system.append(include[2])
            else:
                own.append(line)
        self.parts.append((path, '\n'.join(own).strip('\n')))
        twin = re.sub(r'\.h$', '.c', path)
        if path.endswith('.h') and (self.root / twin).exists():
            self.take(twin)

    def text(self, convert):
        """The whole, with one precision or the other."""
        out = [f'#include <{name}>\n' for name in sorted(set(self.system))]
        out.append(PROLOGUE)
        for path, text in self.parts:
            if not path.startswith('src/base/'):
                text = convert(text)
            out.append(f'\n// --- {path}\n\n{text}\n')
        return ''.join(out)


def array(name, text):
    """A text as a C array; string literals have a limit."""
    codes = ', '.join(str(byte) for byte in text.encode())
    return f'static const char {name}[] = {{{codes}, 0}};\n'


root, output, paths = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3:]
arrays, rows = [], []
controller = (root / INTERFACE).read_text(encoding='ascii')
for path in paths:
    amalgam = Amalgam(root)
    amalgam.take(path)
    law = pathlib.Path(path).stem
    arrays.append(array(f'{law}_double', amalgam.text(lambda text: text)))
    arrays.append(array(f'{law}_single', amalgam.text(single)))
arrays.append(array('interface_double', controller))
arrays.append(array('interface_single', single(controller)))
arrays.append(array('replay_program', (pathlib.Path(__file__).parent / 'replay.c')
                    .read_text(encoding='ascii')))
output.write_text('// Made by amalgamate.py.\n' + ''.join(arrays))
