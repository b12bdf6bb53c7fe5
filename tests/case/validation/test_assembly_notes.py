"""Notes on cases of several bodies."""

from types import SimpleNamespace

import pytest

from thermowear.case.validation.assembly import _note_left_out
from thermowear.errors import CaseNote

FACES = {"a-b": ("a_1", "b_1"), "b-c": ("b_2", "c_1"), "a-c": ("a_2", "c_2")}


def test_contacts_without_a_table():
    """
    requirement: where bodies touch at three places and the case lists two, by whichever name, the
    third one, at which they could pass through each other, is noted.
    """
    given = {"a-b": FACES["a-b"], "other name": FACES["b-c"][::-1]}
    case = SimpleNamespace(
        contacts={name: SimpleNamespace(between=faces) for name, faces in given.items()},
        geometry=SimpleNamespace(contacts=FACES),
    )
    with pytest.warns(CaseNote) as notes:
        _note_left_out(case)
    (note,) = notes
    assert str(note.message).startswith(
        "contacts: 'a-c', where 'a_2' and 'c_2' touch, has no table"
    )
