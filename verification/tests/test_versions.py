"""The version is the same wherever it stands."""

import re

from verification.harness.paths import ROOT


def test_the_version_is_the_same_everywhere() -> None:
    places = {"CMakeLists.txt": r"project\(strata VERSION (\S+)", "CITATION.cff": r"^version: (\S+)", "CHANGELOG.md": r"^## (\S+)"}
    found = {name: re.search(pattern, (ROOT / name).read_text(), re.MULTILINE) for name, pattern in places.items()}
    assert len({match and match.group(1) for match in found.values()}) == 1, found
    assert None not in found.values()
