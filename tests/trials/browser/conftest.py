import pytest
from reporting.figures.tiny_results import Results


@pytest.fixture
def results(tmp_path):
    return Results(tmp_path)
