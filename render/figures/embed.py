#!/usr/bin/env python3
"""Writes a text file as a C array, so that the program can hold it: embed.py INPUT OUTPUT

report.css becomes report_css. Lines that are comments of a script are left out.
"""
import pathlib
import sys

source, output = map(pathlib.Path, sys.argv[1:])
lines = source.read_text(encoding='utf-8').splitlines(keepends=True)
text = ''.join(line for line in lines if not line.lstrip().startswith('// '))
codes = ', '.join(str(byte) if byte < 128 else f"'\\x{byte:02x}'" for byte in text.encode())
name = source.name.replace('.', '_')
output.write_text(f'static const char {name}[] = {{{codes}, 0}};\n')
