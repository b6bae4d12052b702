from __future__ import annotations

import json
from pathlib import Path

from asphalt_nscd.cli._options import OUTPUT, step


@step
def command(study: str, *, output: Path = OUTPUT) -> None:
    """Write STUDY, the complete configuration in JSON, to a file."""
    from asphalt_nscd.files.errors import InputError
    from asphalt_nscd.files.store import write_json

    try:
        content = json.loads(study)
    except json.JSONDecodeError as error:
        raise InputError(f"STUDY is not valid JSON ({error}); give the configuration as JSON.") from None
    write_json(output, content)
