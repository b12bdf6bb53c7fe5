"""Rendering process of a run: started early, and only where it is needed."""

from types import SimpleNamespace

import pytest

import thermowear as tw
from thermowear.app.session import _rendering
from thermowear.case.starters import starter_text
from thermowear.output.rendering import Renderer


@pytest.fixture
def started(tmp_path, monkeypatch):
    """Test whether the run of a starter starts the process."""
    count = []
    monkeypatch.setattr(Renderer, "start", lambda each: count.append(each))

    def call(name, pictures=True, rank=0):
        path = tmp_path / f"{name}.toml"
        path.write_text(starter_text(name), encoding="utf-8")
        count.clear()
        chosen, comm = SimpleNamespace(pictures=pictures), SimpleNamespace(rank=rank)
        with _rendering(tw.load(path), chosen, comm) as renderer:
            assert bool(count) == (renderer is not None)
        return bool(count)

    return call


def test_for_bodies_in_space_only(started):
    """requirement: also for hot spots round a disk, whose bodies are sections."""
    assert started("rectangular-punch")
    assert started("disk-brake-hot-spots")
    assert not started("annular-punch")
    assert not started("disk-brake-stability")


def test_neither_without_pictures_nor_on_other_ranks(started):
    assert not started("rectangular-punch", pictures=False)
    assert not started("rectangular-punch", rank=1)
