"""A recording cut or changed anywhere: nothing altered passes, and nothing intact is lost."""

from tests.recordings.damage import campaign


def test_damage_costs_what_is_hit_and_never_yields_a_wrong_number():
    done = campaign(cuts=40, flips=40, others=10, holes=10)
    assert done["unnoticed"] == 0
    assert done["chunks_lost"] > 0  # or nothing was tested
