"""Trajectories and points, as files hold them."""
import pathlib
from typing import NamedTuple

import numpy

PLY_TYPES = {"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4",
             "uint": "u4", "float": "f4", "double": "f8", "int8": "i1", "uint8": "u1",
             "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4", "float32": "f4",
             "float64": "f8"}


class Poses(NamedTuple):
    """A trajectory in the map frame, in the order of time."""

    time: numpy.ndarray
    """shape (N,) [s]"""
    position: numpy.ndarray
    """shape (N, 3) [m]"""
    turn: numpy.ndarray
    """unit quaternions x y z w, shape (N, 4), of the robot in the map"""


def read_numbers(file, columns, exactly=False):
    """The first columns of a file of lines of numbers, apart by blanks or commas. Lines that
    begin with # are left out, and so is a first line of names.

    exactly: lines of more numbers are refused, too.
    """
    rows = []
    lines = pathlib.Path(file).read_text(encoding="utf-8", errors="replace").splitlines()
    for number, line in enumerate(lines, 1):
        words = line.replace(",", " ").split()
        if not words or words[0].startswith("#"):
            continue
        try:
            rows.append([float(word) for word in words[:columns]])
        except ValueError:
            if not rows and number == 1:
                continue
            raise ValueError(f"{file}: line {number} is not {columns} numbers") from None
        if exactly and len(words) != columns:
            raise ValueError(f"{file}: line {number} is not {columns} numbers")
        if len(rows[-1]) < columns or not numpy.isfinite(rows[-1]).all():
            raise ValueError(f"{file}: line {number} is not {columns} finite numbers")
    if not rows:
        raise ValueError(f"{file}: holds no lines of {columns} numbers")
    return numpy.array(rows)


def read_poses(file):
    """Poses from TUM lines: t x y z qx qy qz qw."""
    rows = read_numbers(file, 8, exactly=True)
    rows = rows[numpy.argsort(rows[:, 0], kind="stable")]
    length = numpy.linalg.norm(rows[:, 4:], axis=1, keepdims=True)
    if (length < 1e-6).any():
        raise ValueError(f"{file}: holds a null quaternion")
    return Poses(rows[:, 0], rows[:, 1:4], rows[:, 4:] / length)


def read_ply(file, content):
    """The vertices of a binary little-endian PLY, a structured array by property."""
    head, _, body = content.partition(b"end_header")
    body = body[2:] if body.startswith(b"\r\n") else body[1:]
    lines = [line.split() for line in head.decode("ascii", "replace").splitlines()]
    if ["format", "binary_little_endian", "1.0"] not in lines:
        raise ValueError(f"{file}: only binary little-endian PLY files are read")
    count, fields, element = 0, [], ""
    for words in lines:
        if words[:1] == ["element"]:
            if len(words) != 3 or not words[2].isdigit():
                raise ValueError(f"{file}: its header is damaged")
            if element == "" and words[1] != "vertex":
                raise ValueError(f"{file}: its first element is not vertex")
            element = words[1]
            count = int(words[2]) if element == "vertex" else count
        if words[:1] == ["property"] and element == "vertex":
            if len(words) != 3:
                raise ValueError(f"{file}: its header is damaged")
            if words[1] not in PLY_TYPES:
                raise ValueError(f"{file}: a vertex holds {words[1]}, which is not read")
            fields.append((words[2], "<" + PLY_TYPES[words[1]]))
    kind = numpy.dtype(fields)
    if not {"x", "y", "z"} <= set(kind.names or ()):
        raise ValueError(f"{file}: its vertices have no x, y and z")
    if len(body) < count * kind.itemsize:
        raise ValueError(f"{file}: ends before its {count} vertices do")
    return numpy.frombuffer(body, kind, count)


def read_points(file):
    """Finite points of a PLY file, or of lines x y z, shape (N, 3) [m]."""
    content = pathlib.Path(file).read_bytes()
    if not content.startswith(b"ply"):
        return read_numbers(file, 3)
    vertices = read_ply(file, content)
    points = numpy.stack([vertices[axis].astype(float) for axis in "xyz"], axis=1)
    return points[numpy.isfinite(points).all(axis=1)]
