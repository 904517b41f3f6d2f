"""Which nodes `halation nodes --check` looks at, with plug-ins that are not installed."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from halation.cli.node_check import _choose_nodes, _find_file_faults
from halation.errors import UsageError
from halation.nodes import catalogue
from halation.nodes.color.exposure import Exposure


class Plugin(SimpleNamespace):
    """A plug-in that is shown as its package and version."""

    def __str__(self) -> str:
        return f"{self.package} 1.0"


GLOW: Any = Plugin(package="acme-glow", namespace="acme_glow", nodes={"acme_glow.glow": Exposure})
HAZE: Any = Plugin(package="fog", namespace="haze", nodes={"haze.fog": Exposure})
BOTH = (GLOW, HAZE)


def test_a_node_is_checked_alone_and_a_plug_in_by_both_of_its_names() -> None:
    assert _choose_nodes("exposure", BOTH) == ({"exposure": catalogue()["exposure"]}, [])
    for name in ("acme-glow", "acme_glow"):
        assert _choose_nodes(name, BOTH) == ({"acme_glow.glow": Exposure}, [GLOW])
    assert _choose_nodes("", BOTH) == ({"acme_glow.glow": Exposure, "haze.fog": Exposure}, [*BOTH])


@pytest.mark.parametrize(
    ("name", "plugins", "sentence"),
    [
        ("", (), "no plug-in is installed: name a node, such as halation nodes bloom --check"),
        ("acme-glo", BOTH, "there is no node and no installed plug-in 'acme-glo'; did you mean 'acme-glow'?"),
        ("exposur", BOTH, "there is no node and no installed plug-in 'exposur'; did you mean 'exposure'?"),
        ("qqqqq", BOTH, "by its package or import name; the plug-ins are acme-glow 1.0, fog 1.0"),
        ("qqqqq", (), "by its package or import name; no plug-in is installed"),
        ("exp-osure", (), "or import name; no plug-in is installed"),
    ],
)
def test_what_is_neither_is_refused(name: str, plugins: tuple[Any, ...], sentence: str) -> None:
    with pytest.raises(UsageError) as fault:
        _choose_nodes(name, plugins)
    assert sentence in str(fault.value)


def test_shaders_of_chosen_nodes_are_looked_at_and_none_of_others() -> None:
    found = dict(_find_file_faults([], {"exposure": catalogue()["exposure"]}))
    assert found == {"exposure": []}
    assert dict(_find_file_faults([GLOW], {"exposure": catalogue()["exposure"]})) == {}
