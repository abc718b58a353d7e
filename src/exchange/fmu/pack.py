#!/usr/bin/env python3
"""Packs what every FMU has in it, as C arrays for the program to hold:

    pack.py ROOT OUTPUT DEPENDENCIES BINARY

The sources are the lab's own files: whole rooms, some files of others, and all the headers
that they include, side by side in one folder, so that a compiler needs no search path.
BINARY is the shared object, or "" where there is none. DEPENDENCIES gets the list of what was read.
"""
import pathlib
import re
import sys
import textwrap
import zlib

ROOMS = ('tables arm thesis contact engines engines/newmark engines/pair engines/stiff rig '
         'rig/estimation rig/laws').split()
FILES = '''base/chunks_plain base/csv_layout base/csv_table base/csv_units base/dense base/expression base/fault base/numbers base/plain_math base/random
    base/sample_clock base/sha256 base/shared_array base/stop base/words predict/impact_dynamics predict/two_link rig/external/played_command
    run/saved_block run/arm_run run/arm_run_events run/arm_run_forces run/arm_run_inputs run/arm_run_rows
    run/arm_run_summary run/force_history run/force_sensed run/printed_run run/recording run/resume
    run/run_driver run/run_loop run/run_result run/trace scenario/action scenario/scenario
    exchange/fmu/fmu exchange/fmu/surroundings'''.split()
LICENCES = {'documentation/licenses/license.txt': 'LICENSE',
            'documentation/licenses/fmi-standard.txt': 'src/exchange/fmu/fmi2/LICENSE.txt'}


def collect(root):
    """The paths of all sources and of what they include, within ROOT."""
    found = [path.relative_to(root) for room in ROOMS for path in sorted((root / 'src' / room).glob('*.c'))]
    found += [pathlib.Path('src') / f'{name}.c' for name in FILES]
    found += [pathlib.Path('src/exchange/fmu/portable.h')]
    for path in found:
        for name in re.findall(r'^#include "([^"]+)"', (root / path).read_text(encoding='utf-8'), re.M):
            beside = path.parent / name
            include = beside if (root / beside).exists() else pathlib.Path(name)
            if include not in found:
                found.append(include)
    return found


def flat(path, text):
    """A file as it stands in the FMU: includes without folders, in a source what goes before all."""
    text = re.sub(r'^#include "(?:[^"]*/)?([^"/]+)"', r'#include "\1"', text, flags=re.M)
    if path.suffix == '.c':
        text = '#include "portable.h"\n' + text
    return text


def array(name, content):
    """A C array of the content as zlib packs it, and its row in the table."""
    packed = zlib.compress(content, 9)
    label = 'packed_' + re.sub(r'\W', '_', name)
    codes = textwrap.fill(', '.join(str(byte) for byte in packed), 1000)
    return (f'static const unsigned char {label}[] = {{\n{codes}}};\n',
            f'{{"{name}", {len(content)}, {zlib.crc32(content)}u, sizeof {label}, {label}}}')


root, output, dependencies, binary = pathlib.Path(sys.argv[1]), *sys.argv[2:]
paths = collect(root)
names = [path.name for path in paths]
assert len(set(names)) == len(names), 'two files of one name'
parts = [array('sources/' + path.name, flat(path, (root / path).read_text(encoding='utf-8')).encode())
         for path in sorted(paths, key=lambda path: path.name)]
parts += [array(name, (root / path).read_bytes()) for name, path in LICENCES.items()]
arrays = ''.join(part[0] for part in parts)
table = ',\n    '.join(part[1] for part in parts)
code, row = array('binary', pathlib.Path(binary).read_bytes() if binary else b'')
pathlib.Path(output).write_text(f'// Made by pack.py.\n#include "src/exchange/fmu/zip_writer.h"\n\n{arrays}{code}'
                                f'static const zip_entry fmu_parts[] = {{\n    {table}}};\n'
                                f'static const zip_entry fmu_binary = {row};\n')
pathlib.Path(dependencies).write_text(f'{output}: ' + ' '.join(str(root / path) for path in paths))
