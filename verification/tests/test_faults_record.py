"""What is kept of the kills: as many as are claimed, of every scene, and not one run that ended otherwise."""

import json

from verification.faults.__main__ import RECORD
from verification.faults.scenes import KILLED


def test_two_hundred_kills_and_every_run_the_same() -> None:
    record = json.loads(RECORD.read_text(encoding="utf-8"))
    assert record["kills"] >= 200
    assert record["identical"] == record["trials"] > 0
    assert record["from_checkpoint"] > 100
    assert [scene["name"] for scene in record["scenes"]] == [killed.name for killed in KILLED]
    for scene in record["scenes"]:
        assert scene["kills"] >= 30 and scene["problems"] == []
        assert scene["identical"] == scene["trials"] > 10
        assert sum(scene[key] for key in ("from_checkpoint", "from_start", "before_folder", "after_end")) == scene["kills"]
