import numpy as np
import pytest
from test_criterion import YamadaSun

import femlam


def test_an_envelope_ends_at_the_strengths(scene: femlam.Scene) -> None:
    material = femlam.material("AS4/3502")
    found = femlam.envelope("AS4/3502", ["max-stress", "tsai-wu:f12=-0.3", YamadaSun()], "s1-s12")
    assert found.units["s1_MPa"] == "MPa"
    for name in ("max-stress", "tsai-wu:f12=-0.3", "yamada-sun"):
        of = found["criterion"] == name
        along, across = found["s1_MPa"][of], found["s12_MPa"][of]
        assert along[np.argmin(abs(across) + (along < 0) * 1e9)] == pytest.approx(material.Xt / 1e6, rel=1e-6)
        assert across.max() >= material.S12 / 1e6 * (1 - 1e-9)
    own = scene.envelope("s2-s12")
    assert set(own["criterion"]) <= set(scene.envelope("s2-s12", criteria=[c for c in set(own["criterion"])])["criterion"])


def test_what_has_no_envelope_is_refused() -> None:
    with pytest.raises(femlam.FemError, match="no material `AS4`") as caught:
        femlam.envelope("AS4", ["puck"])
    assert "AS4/3502" in caught.value.help
    with pytest.raises(femlam.FemError, match="no criterion `pucks`"):
        femlam.envelope("AS4/3502", ["pucks"])
    with pytest.raises(femlam.FemError, match="not a plane"):
        femlam.envelope("AS4/3502", ["puck"], "s2-s2")
    with pytest.raises(ValueError, match="name a material"):
        femlam.envelope("AS4/3502")
