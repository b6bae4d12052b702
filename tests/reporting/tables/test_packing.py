from __future__ import annotations

from asphalt_nscd.bending.collect import COLUMNS
from asphalt_nscd.files.store import save
from asphalt_nscd.reporting.tables import packing


def test_each_test_stands_beside_its_own_deposit(tmp_path):
    layer = {"layer_height_m": 0.06, "coordination": 5.0}
    for name, friction, fraction in (("s1", 0.2, 0.64), ("s1-friction0.5", 0.5, 0.60)):
        own = {"friction": friction, "solid_fraction": fraction}
        save(tmp_path / f"deposits/{name}.h5", "deposit", {}, layer | own)
        row = {column: 1.0 for column in COLUMNS} | {"specimen": name, "law_source": "published"}
        save(tmp_path / f"tests/{name}.h5", "test", {}, row)
    # the order of deposits must not matter
    deposits = sorted(tmp_path.glob("deposits/*.h5"), reverse=True)
    table = packing.make(tests=sorted(tmp_path.glob("tests/*.h5")), deposits=deposits)
    expected = {"s1-friction0.5": (0.5, 0.60), "s1": (0.2, 0.64)}
    assert "mapping" not in table
    both = packing.make(
        tests=[tmp_path / "tests/s1.h5"], deposits=deposits, facets=[tmp_path / "tests/s1.h5"]
    )
    assert list(both["mapping"]) == ["paper", "facets"]
    found = table.set_index("specimen")[["friction", "solid_fraction"]]
    assert {name: tuple(row) for name, row in found.iterrows()} == expected
