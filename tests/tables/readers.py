"""Reads the tables that the lab writes for other programs by the formats' own pages: Parquet (thrift
compact, plain pages, levels in runs) and MAT 5. Nothing of the lab is used.

    readers.py CSV FILE.parquet FILE.mat   the same columns, units and numbers in all three, to the bit
    readers.py --rows CSV FILE.parquet...  the rows of the CSV in Parquet files that are one table
"""
import csv
import math
import struct
import sys


def varint(data, at):
    value = shift = 0
    while True:
        byte = data[at]
        at += 1
        value |= (byte & 127) << shift
        shift += 7
        if byte < 128:
            return value, at


def zigzag(data, at):
    value, at = varint(data, at)
    return (value >> 1) ^ -(value & 1), at


def element(data, at, kind):
    if kind in (5, 6):
        return zigzag(data, at)
    if kind == 8:
        size, at = varint(data, at)
        return bytes(data[at:at + size]), at + size
    if kind == 9:
        head = data[at]
        count, at = (head >> 4, at + 1) if head >> 4 != 15 else varint(data, at + 1)
        items = []
        for _ in range(count):
            item, at = element(data, at, head & 15)
            items.append(item)
        return items, at
    if kind == 12:
        return fields_of(data, at)
    raise ValueError(f"thrift type {kind}")


def fields_of(data, at):
    found, number = {}, 0
    while data[at] != 0:
        number += data[at] >> 4
        found[number], at = element(data, at + 1, data[at] & 15)
    return found, at + 1


def levels_of(data, at, count):
    """Definition levels of one bit, in runs."""
    size, = struct.unpack_from("<I", data, at)
    at, end, levels = at + 4, at + 4 + size, []
    while at < end:
        head, at = varint(data, at)
        assert head & 1 == 0, "the lab writes runs only"
        levels += [data[at]] * (head >> 1)
        at += 1
    assert at == end and len(levels) == count
    return levels, end


def plain(data, at, kind, count):
    if kind == 6:
        texts = []
        for _ in range(count):
            size, = struct.unpack_from("<I", data, at)
            texts.append(data[at + 4:at + 4 + size].decode())
            at += 4 + size
        return texts, at
    return struct.unpack_from(f"<{count}{'d' if kind == 5 else 'q'}", data, at), at + 8 * count


def check_range(told, kind, values, rows):
    assert told[3] == rows - len(values)
    if kind != 6 and values:
        code = "<d" if kind == 5 else "<q"
        least, largest = struct.unpack(code, told[6])[0], struct.unpack(code, told[5])[0]
        assert (least, largest) == (min(values), max(values))
        if kind == 5:
            assert least != 0 or told[6][7] == 0x80, "a least zero is -0"
            assert largest != 0 or told[5][7] == 0, "a largest zero is +0"
    else:
        assert 5 not in told and 6 not in told


def read_parquet(path):
    """Columns by name, None where a field is missing, and the notes."""
    data = open(path, "rb").read()
    assert data[:4] == data[-4:] == b"PAR1"
    size, = struct.unpack_from("<I", data, len(data) - 8)
    footer, end = fields_of(data, len(data) - 8 - size)
    assert end == len(data) - 8
    root, *schema = footer[2]
    assert root[5] == len(schema)
    columns = {column[4].decode(): [] for column in schema}
    assert len(columns) == len(schema), "a name stands twice"

    at, rows = 4, 0
    for group in footer[4]:
        begin = at
        assert len(group[1]) == len(schema)
        for chunk, column in zip(group[1], schema):
            about = chunk[3]
            assert about[3] == [column[4]] and about[1] == column[1] and about[9] == at
            assert about[5] == group[3] and about[4] == 0 and column[3] == 1
            page, start = fields_of(data, at)
            assert page[1] == 0 and page[5][1] == group[3] and page[2] == page[3]
            levels, start = levels_of(data, start, group[3])
            values, at = plain(data, start, about[1], sum(levels))
            assert at - about[9] == about[6] == about[7]
            check_range(about[12], about[1], values, group[3])
            each = iter(values)
            columns[column[4].decode()] += [next(each) if level else None for level in levels]
        assert group[2] == at - begin
        rows += group[3]
    assert footer[7] == [{1: {}}] * len(schema)
    assert rows == footer[3] and at == len(data) - 8 - size
    return columns, {note[1].decode(): note[2].decode() for note in footer[5]}


def read_mat(path):
    """Variables by name: lists of numbers, texts, dicts."""
    data = open(path, "rb").read()
    assert data[:19] == b"MATLAB 5.0 MAT-file" and data[124:128] == b"\0\1IM"
    found, at = {}, 128
    while at < len(data):
        name, value, at = mat_matrix(data, at)
        found[name] = value
    return found


def mat_element(data, at):
    kind, size = struct.unpack_from("<II", data, at)
    if kind >> 16:
        return kind & 0xffff, data[at + 4:at + 4 + (kind >> 16)], at + 8
    return kind, data[at + 8:at + 8 + size], at + 8 + (size + 7) // 8 * 8


def mat_matrix(data, at):
    kind, content, end = mat_element(data, at)
    assert kind == 14
    _, flags, at = mat_element(content, 0)
    _, size, at = mat_element(content, at)
    _, name, at = mat_element(content, at)
    rows, columns = struct.unpack("<ii", size)
    shape = flags[0]
    if shape == 2:
        _, width, at = mat_element(content, at)
        width, = struct.unpack("<i", width)
        _, names, at = mat_element(content, at)
        value = {}
        for i in range(0, len(names), width):
            _, text, at = mat_matrix(content, at)
            value[names[i:i + width].rstrip(b"\0").decode()] = text
    else:
        kind, numbers, at = mat_element(content, at)
        if shape == 4:
            assert kind == 16
            value = numbers.decode()
        else:
            assert kind == 9 and shape == 6 and columns == 1
            value = list(struct.unpack(f"<{rows}d", numbers))
        assert len(value) == rows * columns
    assert at == len(content)
    return name.decode(), value, end


def read_csv(path):
    """Columns by name, as texts, and units."""
    heads, *rows = csv.reader(open(path, newline=""))
    names = [head.split("[")[0] for head in heads]
    units = {name: head[len(name):].strip("[]") for name, head in zip(names, heads)}
    return {name: [row[i] for row in rows] for i, name in enumerate(names)}, units


def bits(number):
    return struct.pack("<d", number)


def compare_run(csv_path, parquet_path, mat_path):
    columns, units = read_csv(csv_path)
    parquet, notes = read_parquet(parquet_path)
    mat = read_mat(mat_path)
    assert list(parquet) == list(columns)
    assert list(mat) == list(columns) + ["units", "scenario", "version"]
    assert mat["units"] == units == {name: notes["unit." + name] for name in columns}
    assert mat["scenario"] == notes["impactlab.scenario"] and "title:" in mat["scenario"]
    assert mat["version"] == notes["impactlab.version"]
    fields = 0
    for name, texts in columns.items():
        assert len(texts) == len(parquet[name]) == len(mat[name])
        for text, number, other in zip(texts, parquet[name], mat[name]):
            if text == "":
                assert number is None and math.isnan(other)
            else:
                assert float(text) == number and bits(number) == bits(other)
            fields += 1
    print(fields, "fields in", len(columns), "columns")
    compare_scipy(mat_path, mat)


def compare_scipy(path, mat):
    """The same by scipy, where it is installed."""
    try:
        from scipy.io import loadmat
    except ImportError:
        print("scipy is not installed: MAT is read by this file alone")
        return
    other = loadmat(path)
    for name, value in mat.items():
        if isinstance(value, list):
            assert other[name].shape == (len(value), 1)
            assert other[name].tobytes() == struct.pack(f"<{len(value)}d", *value)
        elif isinstance(value, str):
            assert str(other[name][0]) == value
        else:
            for key, text in value.items():
                assert "".join(other[name][key][0, 0]) == text


def compare_rows(csv_path, paths):
    columns, units = read_csv(csv_path)
    rows, schemas = {}, []
    for path in paths:
        parquet, notes = read_parquet(path)
        assert "title:" in notes["impactlab.scenario"]
        schemas.append([(name, notes["unit." + name]) for name in parquet])
        for row in zip(*parquet.values()):
            assert row[0] not in rows, "a run stands twice"
            rows[row[0]] = row
    assert all(schema == schemas[0] for schema in schemas)
    assert [unit for _, unit in schemas[0]] == list(units.values())
    lines = list(zip(*columns.values()))
    assert len(rows) == len(lines) > 0
    for line in lines:
        for text, field in zip(line, rows[int(line[0])]):
            if isinstance(field, str):
                assert text == field
            else:
                assert text == "" if field is None else float(text) == field
    print(len(rows), "rows in", len(paths), "files")


if __name__ == "__main__":
    if sys.argv[1] == "--rows":
        compare_rows(sys.argv[2], sys.argv[3:])
    else:
        compare_run(*sys.argv[1:])
