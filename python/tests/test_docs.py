"""The Python programs of README.md and docs/python.md, and the example, run."""
import doctest
import os
import pathlib
import re
import subprocess
import sys

import pytest

import hgmm

SOURCES = pathlib.Path(os.environ["HGMM_SOURCE_DIR"])


@pytest.mark.parametrize("page, blocks", [("README.md", 1), ("docs/python.md", 3)])
def test_programs_of_a_page(page, blocks, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    programs = re.findall(r"```python\n(.*?)```", (SOURCES / page).read_text(), re.DOTALL)
    assert len(programs) == blocks
    names = {}
    for program in programs:
        exec(compile(program, page, "exec"), names)
    if page == "docs/python.md":
        assert names["free"][0] > 0.5 and names["occupied"][1] > 0.5
        assert names["known"][1] and abs(names["mean"][1] - 0.525) < 0.05
        assert names["report"].points_used == 10000 and names["found"].converged
        assert names["same"].to_bytes() == names["room"].to_bytes()
    else:
        assert names["room"].occupancy([[1, 0, 0]]).free > 0.5


def test_doctest_of_the_package():
    done = doctest.testmod(hgmm)
    assert done.attempted > 5 and done.failed == 0


def test_example_draws_a_slice(tmp_path):
    pytest.importorskip("matplotlib")
    file = tmp_path / "slice.png"
    told = subprocess.run([sys.executable, SOURCES / "examples/python/slice.py", file], check=True,
                          stdout=subprocess.PIPE, text=True).stdout
    assert float(re.search(r"the wall at ([0-9.]+) m", told).group(1)) == pytest.approx(4, abs=0.02)
    assert file.read_bytes().startswith(b"\x89PNG")
